//! Directions in which the energy does not change, or by less than k_BT, and the volume of the states that they sweep.
//!
//! ```text
//! rotation about one axis a            2π √(Σ |a × m_i|²)
//! any rotation, spins along one line   4π √(λλ'),   else 8π² √(λλ'λ″)     λ: eigenvalues of Σ (1 − m_i m_iᵀ)
//! translation, soft rotation           see the module `sliding`
//! ```

use super::UnknownModes;
use super::sliding::{Pinning, Sliding};
use crate::energy::Hamiltonian;
use crate::field::Components;
use crate::geometry::{Vector, vector};
use crate::linalg::{eigen_symmetric, slab};
use crate::stationary::{Spectrum, State};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// What kind of zero mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ZeroKind {
    /// All spins turn about a symmetry axis.
    Rotation,
    /// The state slides over its lattice.
    Translation,
}

/// Zero modes of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct ZeroModes {
    /// Their kind.
    pub kind: ZeroKind,
    /// How many.
    pub count: usize,
    /// Volume of the states that they sweep (rad to the power of their number); of a translation by the derivative dm/dx.
    pub volume: f64,
    /// Of a translation: the volume by the hop from a place to the next like it.
    pub hop_volume: Option<f64>,
    /// Of soft ones: what a place costs, one each mode.
    pub pinning: Vec<Pinning>,
}

impl ZeroModes {
    /// Whether the state slides along them from place to place: no exact rotation.
    pub fn slides(&self) -> bool {
        !self.pinning.is_empty()
    }
}

/// ln of the volume of translations by the hop over that by the derivative: a hop cuts the corner, and a derivative takes sites for a continuum.
pub fn ln_cut(zeros: &[ZeroModes]) -> f64 {
    let own = zeros.iter().filter_map(|z| Some(libm::log(z.hop_volume? / z.volume)));
    own.filter(|ln| ln.is_finite()).sum()
}

/// What is said of all zero modes of a stationary state: rotations, and how it slides, over so many places of the lattice. An error, in
/// words, where more modes are flat to rounding than these, so that nobody knows their volume.
pub fn zero_modes(
    h: &Hamiltonian,
    state: &State,
    sliding: &Sliding,
    places: usize,
    spectrum: &Spectrum,
) -> Result<Vec<ZeroModes>, UnknownModes> {
    let mut found = Vec::new();
    if !state.zeros.is_empty() {
        found.push(ZeroModes {
            kind: ZeroKind::Rotation,
            count: state.zeros.len(),
            volume: rotation_volume(h, state),
            hop_volume: None,
            pinning: Vec::new(),
        });
    }
    found.extend(sliding.said(places));
    match spectrum.flat.saturating_sub(sliding.flat(spectrum.floor_mev)) {
        0 => Ok(found),
        modes => Err(UnknownModes::Flat { modes, floor_mev: spectrum.floor_mev }),
    }
}

/// Volume of all states that rotations about the symmetry axes make of this one.
fn rotation_volume(h: &Hamiltonian, state: &State) -> f64 {
    let axes = h.symmetry_axes_at(&state.m);
    let gram: Vec<f64> = axes.iter().flat_map(|a| axes.iter().map(|b| overlap(h, &state.m, *a, *b))).collect();
    let (values, _) = eigen_symmetric(&gram, axes.len());
    let count = state.zeros.len();
    let stretch: f64 = values.iter().rev().take(count).map(|l| l.max(0.0).sqrt()).product();
    let turns = match count {
        1 => 2.0 * PI,
        2 => 4.0 * PI,
        _ => 8.0 * PI * PI,
    };
    turns * stretch
}

/// Σ (a × m_i)·(b × m_i) over the spins that can move.
fn overlap(h: &Hamiltonian, m: &[f64], a: Vector, b: Vector) -> f64 {
    let m = Components::new(m);
    let product = |i: usize| vector::dot(vector::cross(a, m.get(i)), vector::cross(b, m.get(i)));
    let products: Vec<f64> = (0..m.sites()).filter(|&i| !h.is_frozen(i)).map(product).collect();
    slab::sum(&products)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::{Anisotropy, Exchange};
    use crate::geometry::Direction;
    use crate::lattice::Chain;

    #[test]
    fn rotations_of_a_line_and_of_a_plane_of_spins_sweep_a_sphere_and_all_rotations() {
        let chain = Chain::open(4).resolve().unwrap();
        let h = Hamiltonian::new(&chain, vec![Box::new(Exchange::uniform(&chain, &[1.0]))]).unwrap();
        let volume = |m: [[f64; 3]; 4]| {
            let flat: Vec<f64> = (0..3).flat_map(|c| m.iter().map(move |v| v[c])).collect();
            rotation_volume(&h, &State::at((&h).into(), flat))
        };
        let (x, z) = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
        assert!((volume([z; 4]) - 16.0 * PI).abs() < 1e-12);
        // Σ (1 − mmᵀ) = diag(2, 4, 2)
        assert!((volume([x, z, x, z]) - 32.0 * PI * PI).abs() < 1e-10);
    }

    #[test]
    fn a_turn_about_one_axis_sweeps_a_circle() {
        let chain = Chain::open(2).resolve().unwrap();
        let terms: Vec<Box<dyn crate::energy::EnergyTerm>> =
            vec![Box::new(Exchange::uniform(&chain, &[1.0])), Box::new(Anisotropy::uniform(2, 0.1, Direction::Z))];
        let h = Hamiltonian::new(&chain, terms).unwrap();
        let (s, c) = libm::sincos(0.4);
        let state = State::at((&h).into(), vec![s, 1.0, 0.0, 0.0, c, 0.0]);
        assert!((rotation_volume(&h, &state) - 2.0 * PI * (1.0 + s * s).sqrt()).abs() < 1e-12);
    }
}
