//! The physics of a config before it runs: lengths, energies, what is too coarse, and how long it will take.
//!
//! ```text
//! l_ex = √(2A/μ₀Ms²)      δ = √(A/K) = √(J/c) sites      σ = 4√(AK) S = 2√(Jc)      K V = c/2
//! ```
//! J is the exchange of a bond and c the softest mode of a stable spin, 2KV for an easy axis (see [`Scales`]); the magnetostatics
//! of a straight chain of equal spins count as anisotropy of its shape.

use super::{Loaded, expected_images};
use crate::drive::{Problem, Scales};
use crate::energy::magnetostatics::MU_0_MU_B_SQUARED;
use crate::energy::{EnergyTerm, Hamiltonian, TangentBasis, assemble_shifted};
use crate::field::{Components, ComponentsMut};
use crate::geometry::{Vector, vector};
use crate::lattice::Chain;
use crate::linalg::{Banded, eigenvalues_symmetric};
use std::time::Instant;

/// Gradients of each image in a usual run, everything counted: between 10 and 70 in the shipped configs.
const EVALUATIONS: f64 = 20.0;
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
    pub terms_mev: Vec<(&'static str, f64)>,
    /// What may be too coarse, in words.
    pub warnings: Vec<String>,
}

impl Physics {
    /// Of a problem.
    pub fn of(loaded: &Loaded, problem: &Problem, scales: &Scales) -> Physics {
        let (h, chain) = (&problem.hamiltonian, loaded.chain());
        let floor = 1e-9 * h.stiffness_mev();
        let wall = scales.stiffness_mev > 2.0 * floor && scales.exchange_mev > floor;
        let spacing = chain.spacing.map(|a| a.0);
        let energy = wall.then(|| 2.0 * (scales.exchange_mev * scales.stiffness_mev).sqrt());
        let width = wall.then(|| (scales.exchange_mev / scales.stiffness_mev).sqrt());
        let mut physics = Physics {
            exchange_length_nm: exchange_length_nm(loaded, chain, scales),
            wall_width_sites: width,
            wall_width_nm: width.and_then(|w| Some(w * spacing?)),
            wall_energy_mev: energy,
            // 1 meV/nm² is 0.1602… mJ/m²
            wall_energy_mj_per_m2: energy.and_then(|e| Some(e * 1e-1 * 1.602176634 / chain.section_nm2()?)),
            site_barriers_mev: site_barriers(h),
            terms_mev: by_torque(h),
            warnings: Vec::new(),
        };
        physics.warnings = physics.too_coarse(chain);
        physics
    }

    fn too_coarse(&self, chain: &Chain) -> Vec<String> {
        let mut warnings = Vec::new();
        if let (Some(length), Some(cell)) = (self.exchange_length_nm, chain.spacing)
            && cell.0 > 0.5 * length
        {
            warnings.push(format!(
                "cells of {} nm are longer than half the exchange length of {length:.2} nm: halve the spacing and see whether \
                 the barrier changes",
                cell.0
            ));
        }
        if let Some(width) = self.wall_width_sites.filter(|w| *w < NARROW) {
            let continuum = chain.cross_section.is_some();
            warnings.push(match continuum {
                true => format!(
                    "a wall is only {width:.2} cells wide, so it sticks to the cells: a continuum needs at least {NARROW}, with \
                     a smaller spacing"
                ),
                false => format!(
                    "a wall is only {width:.2} sites wide, so it sticks to single sites: right for atoms, too coarse for a \
                     continuum"
                ),
            });
        }
        warnings
    }
}

/// √(2A/μ₀Ms²) with A = J a/2S and Ms = μ/aS, of the middle cell.
fn exchange_length_nm(loaded: &Loaded, chain: &Chain, scales: &Scales) -> Option<f64> {
    let (a, section) = (chain.spacing?.0, chain.section_nm2()?);
    let mut moments = loaded.moments_mub(chain)?;
    moments.sort_by(f64::total_cmp);
    let moment = moments.get(moments.len() / 2).copied().filter(|m| *m > 0.0)?;
    let length = (scales.exchange_mev * a * a * a * section / (MU_0_MU_B_SQUARED * moment * moment)).sqrt();
    (length > 0.0 && length.is_finite()).then_some(length)
}

/// Half the gap between the two lowest curvatures of each site alone: smallest and largest.
fn site_barriers(h: &Hamiltonian) -> [f64; 2] {
    let zero = vec![0.0; 3 * h.sites()];
    let own = h.varying_blocks(Components::new(&zero));
    let gaps = own.as_ref().unwrap_or(h.constant_blocks()).sites().map(|b| {
        let e = eigenvalues_symmetric(&b.concat(), 3);
        0.5 * (e[1] - e[0])
    });
    let [low, high] = gaps.fold([f64::INFINITY, 0.0], |[low, high], g| [low.min(g), high.max(g)]);
    [low.min(high), high]
}

/// The terms by the middle torque of all sites where no two neighbours are alike, those of one name together.
fn by_torque(h: &Hamiltonian) -> Vec<(&'static str, f64)> {
    let directions: [Vector; 3] = [[0.8, 0.48, 0.36], [-0.48, 0.36, 0.8], [0.36, -0.8, -0.48]];
    let n = h.sites();
    let m: Vec<f64> = (0..3).flat_map(|c| (0..n).map(move |i| directions[i % 3][c])).collect();
    let mut gradients: Vec<(&'static str, Vec<f64>)> = Vec::new();
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
    let mut terms: Vec<(&'static str, f64)> = gradients.iter().map(|(name, g)| (*name, middle(g))).collect();
    terms.sort_by(|a, b| b.1.total_cmp(&a.1));
    terms
}

fn add_gradient(term: &dyn EnergyTerm, m: &[f64], g: &mut [f64]) {
    let mut density = vec![0.0; m.len() / 3];
    term.add_gradient(Components::new(m), ComponentsMut::new(g), &mut density, 0..m.len() / 3);
}

/// How long a run may take (s): the time of one gradient with its factorised Hessian, measured, times what usual runs need.
/// Paths with many minima take several times as long.
pub fn estimated_seconds(problem: &Problem, scales: &Scales) -> f64 {
    let (h, m) = (&problem.hamiltonian, problem.initial.as_slice());
    let mut g = vec![0.0; m.len()];
    let basis = TangentBasis::at(m);
    let mut matrix = Banded::default();
    let mut once = || {
        let start = Instant::now();
        let _ = h.energy_gradient(m, &mut g);
        assemble_shifted(h, m, &g, &basis, scales.stiffness_mev, &mut matrix);
        matrix = std::mem::take(&mut matrix).factor().into_memory();
        start.elapsed().as_secs_f64()
    };
    let first = once();
    // the first is slowed by memory that is touched for the first time
    let one = if first < 1.0 { once().min(first) } else { first };
    let images = expected_images(problem, scales);
    one * EVALUATIONS * images as f64 / rayon::current_num_threads().min(images).max(1) as f64
}
