//! Directions in which the energy does not change, and the volume of the states that they sweep.
//!
//! ```text
//! rotation about one axis a            2π √(Σ |a × m_i|²)
//! any rotation, spins along one line   4π √(λλ'),   else 8π² √(λλ'λ″)     λ: eigenvalues of Σ (1 − m_i m_iᵀ)
//! translation along a ring             N √(Σ |dm_i/dx|²)                  x in sites, N the number after which the state repeats
//! ```
//! Rotations are exact zero modes. A translation is one where the lattice is so fine that the energy changes by less than
//! [`PINNING`] k_BT while the state moves by a site; its eigenvalue ε gives that energy, ε Σ|dm/dx|²/2π² (a cosine). On a film or a
//! crystal a state with such a translation has no rate yet.

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
use crate::units::K_B;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// A state that moves freely feels its lattice with less than this part of k_BT.
pub(super) const PINNING: f64 = 0.05;
/// Overlap with the translation's own direction above which a mode is the translation.
const IS_TRANSLATION: f64 = 0.99;
/// The same on films and crystals, where edges and a few sites across blur the direction.
const SLIDES: f64 = 0.9;
/// Fewer sites along a direction leave nothing room to slide.
const FEWEST: usize = 7;

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
/// smallest k_BT of interest, `hottest_k` the highest temperature (K).
pub fn zero_modes(
    h: &Hamiltonian,
    state: &State,
    group: &Group,
    flat: usize,
    floor_mev: f64,
    [thermal_mev, hottest_k]: [f64; 2],
) -> Result<Vec<ZeroMode>, UnknownModes> {
    let mut found = Vec::new();
    if let Some(pinning_mev) = sliding_mev(h, state).filter(|mev| *mev < PINNING * K_B * hottest_k) {
        return Err(UnknownModes::Slides { pinning_mev, kelvin: hottest_k });
    }
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
        modes => Err(UnknownModes::Flat { modes, floor_mev }),
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
    if !h.lattice().is_ring() || h.sites() < FEWEST {
        return None;
    }
    let period = period(group, &state.m)?;
    let (along, size) = sliding_direction(h.lattice(), state, 0)?;
    let (eigenvalue_mev, mode) = nearest_mode(state, along.clone(), &state.zeros)?;
    let pinning_mev = pinning_mev(eigenvalue_mev, size);
    let free = slab::dot(&mode, &along).abs() > IS_TRANSLATION && pinning_mev < PINNING * thermal_mev;
    let volume = period as f64 * size;
    free.then_some((ZeroMode { kind: ZeroKind::Translation, modes: vec![mode], volume }, eigenvalue_mev))
}

/// By how much the energy changes (meV) as a state of a film or a crystal slides from one site to the next, along the direction in which
/// it is freest; nothing if no stable mode slides it.
fn sliding_mev(h: &Hamiltonian, state: &State) -> Option<f64> {
    let lattice = h.lattice();
    let along = |d: usize| -> Option<f64> {
        let (along, size) = sliding_direction(lattice, state, d)?;
        let (eigenvalue_mev, mode) = nearest_mode(state, along.clone(), &state.zeros)?;
        let slides = eigenvalue_mev > 0.0 && slab::dot(&mode, &along).abs() > SLIDES;
        slides.then(|| pinning_mev(eigenvalue_mev, size))
    };
    let long = (0..3).filter(|d| !lattice.is_row() && lattice.grid.size[*d] >= FEWEST);
    long.filter_map(along).min_by(f64::total_cmp)
}

/// ε Σ|dm/dx|²/2π² (meV).
fn pinning_mev(eigenvalue_mev: f64, size: f64) -> f64 {
    eigenvalue_mev.abs() * size * size / (2.0 * PI * PI)
}

/// dm/dx along a direction of the lattice but for the rotations, of unit length in tangent coordinates (2N), and √Σ|dm/dx|²; nothing
/// where that is no motion.
fn sliding_direction(lattice: &Lattice, state: &State, direction: usize) -> Option<(Vec<f64>, f64)> {
    let mut along = state.basis.coordinates(&derivative(lattice, &state.m, direction));
    let whole = slab::norm(&along);
    remove(&mut along, &state.zeros);
    let size = slab::norm(&along);
    if size < 1e-3 * whole || size < 1e-6 {
        return None;
    }
    slab::scale(&mut along, 1.0 / size);
    Some((along, size))
}

/// dm/dx (3N numbers a site) along a direction, to sixth order in the distance of two sites, to second order near an edge; 0 at it.
fn derivative(lattice: &Lattice, m: &[f64], direction: usize) -> Vec<f64> {
    const SIXTH: [f64; 3] = [45.0, -9.0, 1.0];
    let m = Components::new(m);
    let mut d = vec![0.0; 3 * m.sites()];
    for i in 0..m.sites() {
        let beside = |k: isize| {
            let [ahead, behind] = [k, -k].map(|by| lattice.step_from(i, direction, by));
            Some(vector::sub(m.get(ahead?), m.get(behind?)))
        };
        let sum = match (beside(1), beside(2), beside(3)) {
            (Some(one), Some(two), Some(three)) => [one, two, three]
                .iter()
                .zip(SIXTH)
                .fold([0.0; 3], |sum, (v, w)| vector::add(sum, vector::scale(w / 60.0, *v))),
            (Some(one), ..) => vector::scale(0.5, one),
            _ => continue,
        };
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
        assert!(
            (slab::norm(&derivative(&Chain::ring(n).resolve().unwrap(), &m, 0)) - k * (n as f64).sqrt()).abs() < 1e-8
        );
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
