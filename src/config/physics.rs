//! The physics of a config before it runs: lengths, energies, and what is too coarse.
//!
//! ```text
//! l_ex = √(2A/μ₀Ms²)      δ = √(A/K) = √(J/c) sites      σ = 4√(AK) S = 2√(Jc)      K V = c/2
//! ```
//! J is the exchange of a bond and c the softest mode of a stable spin, 2KV for an easy axis (see [`Scales`]); the magnetostatics
//! of a straight chain of equal spins count as anisotropy of its shape.

use super::Loaded;
use crate::drive::{Problem, Scales};
use crate::energy::magnetostatics::MU_0_MU_B_SQUARED;
use crate::energy::{EnergyTerm, Hamiltonian, TermSpec, site_anisotropies};
use crate::field::{Components, ComponentsMut};
use crate::geometry::{Vector, vector};
use crate::lattice::Lattice;

/// A wall of less than this many sites feels every one of them.
const NARROW: f64 = 3.0;

/// What a config's numbers come to.
#[derive(Clone, Debug, PartialEq)]
pub struct Physics {
    /// Exchange length (nm), of a continuum with an exchange and a magnetisation.
    pub exchange_length_nm: Option<f64>,
    /// Wall width δ in sites; nothing without an easy axis or without exchange.
    pub wall_width_sites: Option<f64>,
    /// The same in nm.
    pub wall_width_nm: Option<f64>,
    /// Energy of a wall (meV).
    pub wall_energy_mev: Option<f64>,
    /// The same over the cross-section (mJ/m²).
    pub wall_energy_mj_per_m2: Option<f64>,
    /// Smallest and largest barrier that a single site has of itself (meV).
    pub site_barriers_mev: [f64; 2],
    /// The terms by the torque of a site whose neighbours point elsewhere (meV, middle one of all sites), largest first.
    pub terms_mev: Vec<(String, f64)>,
    /// What may be too coarse, in words.
    pub warnings: Vec<String>,
}

impl Physics {
    /// Of a problem.
    pub fn of(loaded: &Loaded, problem: &Problem, scales: &Scales) -> Physics {
        let (h, lattice) = (&problem.hamiltonian, &loaded.lattice);
        let width = wall_width_sites(scales, floor_mev(h));
        let spacing = lattice.spacing_nm;
        let energy = width.map(|_| 2.0 * (scales.exchange_mev * scales.stiffness_mev).sqrt());
        Physics {
            exchange_length_nm: exchange_length_nm(loaded, scales),
            wall_width_sites: width,
            wall_width_nm: width.and_then(|w| Some(w * spacing?)),
            wall_energy_mev: energy,
            // 1 meV/nm² is 0.1602… mJ/m²
            wall_energy_mj_per_m2: energy.and_then(|e| Some(e * 1e-1 * 1.602176634 / lattice.middle_section_nm2()?)),
            site_barriers_mev: site_barriers(h),
            terms_mev: by_torque(h),
            warnings: warnings(loaded, h, scales),
        }
    }
}

/// What is too coarse, in words: cells of a continuum against the exchange length and the width of a wall. A chain of atoms is as
/// discrete as it is: a narrow wall there is physics. So are single cells, and layers that nothing but an exchange between them joins.
pub fn warnings(loaded: &Loaded, h: &Hamiltonian, scales: &Scales) -> Vec<String> {
    let Some([cell_nm, cells]) = longest_cell(&loaded.lattice).filter(|_| is_continuum(loaded)) else {
        return Vec::new();
    };
    let mut warnings = Vec::new();
    if let Some(length) = exchange_length_nm(loaded, scales)
        && cell_nm > 0.5 * length
    {
        warnings.push(format!(
            "cells of {cell_nm} nm are longer than half the exchange length of {length:.2} nm: halve the spacing and see whether \
             the barrier changes"
        ));
    }
    let width = wall_width_sites(scales, floor_mev(h)).map(|sites| sites / cells);
    if let Some(width) = width.filter(|w| *w < NARROW) {
        warnings.push(format!(
            "a wall is only {width:.2} cells wide, so it sticks to the cells: a continuum needs at least {NARROW}, with a \
             smaller spacing"
        ));
    }
    warnings
}

/// The longest cell in the directions in which there are several: in nm, and in lattice constants.
fn longest_cell(lattice: &Lattice) -> Option<[f64; 2]> {
    let spacing = lattice.spacing_nm?;
    let steps = (0..3).filter(|d| lattice.grid.extends(*d)).map(|d| lattice.steps[d].0);
    steps.max_by(f64::total_cmp).map(|step| [step, step / spacing])
}

/// Whether the numbers are those of a continuum: densities, which cells make numbers, and an exchange inside it.
fn is_continuum(loaded: &Loaded) -> bool {
    let density = |term: &TermSpec| matches!(term, TermSpec::Exchange(exchange) if exchange.A.is_some());
    let between_layers = |term: &TermSpec| matches!(term, TermSpec::Exchange(exchange) if exchange.J_area.is_some());
    let inside = |term: &TermSpec| matches!(term, TermSpec::Exchange(_) | TermSpec::Pairs(_)) && !between_layers(term);
    let materials = || loaded.parts.iter().map(|part| &part.material);
    let terms = || materials().flat_map(|material| &material.energy).chain(&loaded.config.energy);
    let layers = terms().any(between_layers) && !terms().any(inside);
    !layers && (materials().any(|material| material.Ms.is_some()) || terms().any(density))
}

/// Width of a wall, where there is an easy axis and exchange above rounding.
fn wall_width_sites(scales: &Scales, floor_mev: f64) -> Option<f64> {
    let wall = scales.stiffness_mev > 2.0 * floor_mev && scales.exchange_mev > floor_mev;
    wall.then(|| (scales.exchange_mev / scales.stiffness_mev).sqrt())
}

/// Energies under this (meV) are rounding.
fn floor_mev(h: &Hamiltonian) -> f64 {
    1e-9 * h.stiffness_mev()
}

/// √(2A/μ₀Ms²) with A = J a/2S and Ms = μ/aS, of the middle cell.
fn exchange_length_nm(loaded: &Loaded, scales: &Scales) -> Option<f64> {
    let (a, section) = (loaded.lattice.spacing_nm?, loaded.lattice.middle_section_nm2()?);
    let mut moments = loaded.moments_mub()?;
    moments.sort_by(f64::total_cmp);
    let moment = moments.get(moments.len() / 2).copied().filter(|m| *m > 0.0)?;
    let length = (scales.exchange_mev * a * a * a * section / (MU_0_MU_B_SQUARED * moment * moment)).sqrt();
    (length > 0.0 && length.is_finite()).then_some(length)
}

/// The barrier of each site alone, to the reverse of its lowest minimum: smallest and largest.
fn site_barriers(h: &Hamiltonian) -> [f64; 2] {
    let barriers = site_anisotropies(h, false).into_iter().map(|site| site.barrier_mev);
    let [low, high] = barriers.fold([f64::INFINITY, 0.0], |[low, high], b| [low.min(b), high.max(b)]);
    [low.min(high), high]
}

/// The terms by the middle torque of all sites where no two neighbours are alike, those of one name together.
fn by_torque(h: &Hamiltonian) -> Vec<(String, f64)> {
    let directions: [Vector; 3] = [[0.8, 0.48, 0.36], [-0.48, 0.36, 0.8], [0.36, -0.8, -0.48]];
    let n = h.sites();
    let step = |i: usize| {
        let (atom, cell) = h.lattice().cell(i);
        (atom + cell[0] + cell[1] + cell[2]) % 3
    };
    let m: Vec<f64> = (0..3).flat_map(|c| (0..n).map(move |i| directions[step(i)][c])).collect();
    let mut gradients: Vec<(&str, Vec<f64>)> = Vec::new();
    for term in h.terms() {
        let place = gradients.iter().position(|(name, _)| *name == term.name());
        let k = place.unwrap_or_else(|| {
            gradients.push((term.name(), vec![0.0; 3 * n]));
            gradients.len() - 1
        });
        add_gradient(term.as_ref(), &m, &mut gradients[k].1);
    }
    let middle = |g: &Vec<f64>| {
        let (m, g) = (Components::new(&m), Components::new(g));
        let torque = |i: usize| vector::norm(vector::cross(m.get(i), g.get(i)));
        let mut torques: Vec<f64> = (0..n).map(torque).collect();
        torques.sort_by(f64::total_cmp);
        torques[n / 2]
    };
    let mut terms: Vec<(String, f64)> = gradients.iter().map(|(name, g)| (name.to_string(), middle(g))).collect();
    terms.sort_by(|a, b| b.1.total_cmp(&a.1));
    terms
}

fn add_gradient(term: &dyn EnergyTerm, m: &[f64], g: &mut [f64]) {
    let mut density = vec![0.0; m.len() / 3];
    term.add_gradient(Components::new(m), ComponentsMut::new(g), &mut density, 0..m.len() / 3);
}
