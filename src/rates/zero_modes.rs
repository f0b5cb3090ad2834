//! Directions in which the energy does not change, and the volume of the states that they sweep.
//!
//! ```text
//! rotation about one axis a            2π √(Σ |a × m_i|²)
//! any rotation, spins along one line   4π √(λλ'),   else 8π² √(λλ'λ″)     λ: eigenvalues of Σ (1 − m_i m_iᵀ)
//! translation along a ring             N √(Σ |dm_i/dx|²)                  x in sites, N the number after which the state repeats
//! ```
//! Rotations are exact zero modes. A translation is one where the lattice is so fine that the energy changes by less than
//! [`PINNING`] k_BT while the state moves by a site; its eigenvalue ε gives that energy, ε Σ|dm/dx|²/2π² (a cosine).

use super::UnknownModes;
use super::symmetry::period;
use super::unstable::nearest_mode;
use crate::energy::Hamiltonian;
use crate::field::{Components, ComponentsMut};
use crate::geometry::{Vector, vector};
use crate::lattice::Lattice;
use crate::linalg::remove;
use crate::linalg::{eigen_symmetric, slab};
use crate::stationary::State;
use crate::symmetry::Group;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// A state that moves freely feels its lattice with less than this part of k_BT.
const PINNING: f64 = 0.05;
/// Overlap with the translation's own direction above which a mode is the translation.
const IS_TRANSLATION: f64 = 0.99;

/// What kind of zero mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ZeroKind {
    /// All spins turn about a symmetry axis.
    Rotation,
    /// The state moves along a ring.
    Translation,
}

/// Zero modes of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct ZeroMode {
    /// Their kind.
    pub kind: ZeroKind,
    /// Orthonormal directions, tangent coordinates (2N).
    pub modes: Vec<Vec<f64>>,
    /// Volume of the states they sweep (rad to the power of their number).
    pub volume: f64,
}

/// All zero modes of a stationary state. `group`: that of the energy and the moments. `flat` is how many more eigenvalues than the rotations' are below the rounding error
/// `floor_mev`; an error, in words, where one of them is no translation, so that nobody knows its volume. `thermal_mev` is the
/// smallest k_BT of interest.
pub fn zero_modes(
    h: &Hamiltonian,
    state: &State,
    group: &Group,
    flat: usize,
    floor_mev: f64,
    thermal_mev: f64,
) -> Result<Vec<ZeroMode>, UnknownModes> {
    let mut found = Vec::new();
    if !state.zeros.is_empty() {
        let volume = rotation_volume(h, state);
        found.push(ZeroMode { kind: ZeroKind::Rotation, modes: state.zeros.clone(), volume });
    }
    let mut explained = 0;
    if let Some((mode, eigenvalue_mev)) = translation(h, state, group, thermal_mev) {
        explained = usize::from(eigenvalue_mev.abs() <= floor_mev);
        found.push(mode);
    }
    match flat.saturating_sub(explained) {
        0 => Ok(found),
        modes => Err(UnknownModes { modes, floor_mev }),
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

/// The translation of a ring's state as a zero mode, with its eigenvalue (meV), if it is nearly free.
fn translation(h: &Hamiltonian, state: &State, group: &Group, thermal_mev: f64) -> Option<(ZeroMode, f64)> {
    if !h.lattice().is_ring() || h.sites() < 7 {
        return None;
    }
    let period = period(group, &state.m)?;
    let mut along = state.basis.coordinates(&derivative(h.lattice(), &state.m));
    let whole = slab::norm(&along);
    remove(&mut along, &state.zeros);
    let size = slab::norm(&along);
    if size < 1e-3 * whole || size < 1e-6 {
        return None;
    }
    slab::scale(&mut along, 1.0 / size);
    let (eigenvalue_mev, mode) = nearest_mode(state, along.clone(), &state.zeros)?;
    let pinning_mev = eigenvalue_mev.abs() * size * size / (2.0 * PI * PI);
    let free = slab::dot(&mode, &along).abs() > IS_TRANSLATION && pinning_mev < PINNING * thermal_mev;
    let volume = period as f64 * size;
    free.then_some((ZeroMode { kind: ZeroKind::Translation, modes: vec![mode], volume }, eigenvalue_mev))
}

/// dm/dx on a ring (3N numbers a site), to sixth order in the distance of two sites.
fn derivative(ring: &Lattice, m: &[f64]) -> Vec<f64> {
    let m = Components::new(m);
    let n = m.sites();
    let mut d = vec![0.0; 3 * n];
    for i in 0..n {
        let mut sum = [0.0; 3];
        for (k, weight) in [(1, 45.0), (2, -9.0), (3, 1.0)] {
            let [ahead, behind] = [k, -k].map(|by| m.get(ring.along_ring(i, by)));
            sum = vector::add(sum, vector::scale(weight / 60.0, vector::sub(ahead, behind)));
        }
        ComponentsMut::new(&mut d).set(i, sum);
    }
    d
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::{Anisotropy, Exchange};
    use crate::geometry::Direction;
    use crate::lattice::Chain;

    #[test]
    fn the_derivative_of_a_spiral_is_its_wave_number() {
        let n = 60;
        let k = 2.0 * PI / n as f64;
        let m: Vec<f64> = (0..3 * n)
            .map(|c| match c / n {
                0 => libm::cos(k * (c % n) as f64),
                1 => libm::sin(k * (c % n) as f64),
                _ => 0.0,
            })
            .collect();
        assert!((slab::norm(&derivative(&Chain::ring(n).resolve().unwrap(), &m)) - k * (n as f64).sqrt()).abs() < 1e-8);
    }

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
