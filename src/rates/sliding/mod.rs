//! States that slide over their lattice: soft translations, and the volume of the places that they reach.
//!
//! ```text
//! v_a           what a shift along way a does to the spins;  Z: an orthonormal basis of all v_a
//! w             the valleys along Z: of all moves by 1 along Z_k and by 0 along the others that of least energy, orthonormal
//! K = (wᵀH⁻¹w)⁻¹,  ℓ_a = wᵀv_a,   U_a = ℓ_aᵀKℓ_a/2π²
//! E(x) = Σ_a ½ U_a (1 − cos 2πx_a)               x_a in shifts of the lattice that keep the energy
//! ∫ e^(−E/k_BT) dV = V · Π e^(−u_a) I₀(u_a)      u = U/2k_BT: 1 where it slides freely, √(k_BT/πU) where it is held
//! V = P √det G,   G_ab = ℓ_a · ℓ_b               P places, as many as free shifts make of the state
//! ```
//! The Hessian's determinant is that on the space normal to w. Where the state is held, the product of both is the determinant of all
//! of the Hessian, however little of a translation its soft modes are; where it slides freely, w are these modes.
//!
//! Where the ℓ_a are not orthogonal, all U_a are scaled so that the integral is the harmonic one where the state is held (a factor of
//! ¾ on a triangular lattice); where not all ways are soft, there is one U for each soft valley, along the way that it moves the state
//! farthest. v_a is one of two: the derivative, ∂m/∂x_a (to sixth order in the distance of two sites), which rates are made of; and
//! the finite hop, Log_m(T_a m), the geodesic to the state in the next place, which cuts the corner. On a fine lattice they are
//! the same. Volumes of skyrmions by a hop: P. F. Bessarab et al., Sci. Rep. 8, 3433 (2018), doi:10.1038/s41598-018-21623-3; the
//! integral over a cosine: K. S. Pitzer, W. D. Gwinn, J. Chem. Phys. 10, 428 (1942), doi:10.1063/1.1723744.
//!
//! A valley is integrated so where its U is below the largest k_BT of interest. So must be the top between two places, which is higher
//! than U where a state is narrow: the energy half-way along the hop, after a step of Newton normal to it. And the hop to the next
//! place must go on from the hop from the one before: a state as narrow as a spin or two jumps, and each of its places is a state.
//! Nor does a state slide along a way that is mostly its descent or a turn. Which shifts are free: those that keep each minimum beside the
//! saddle that does not itself slide; the others lead to a saddle between other minima.

mod moves;
mod valleys;

use super::{UnknownModes, Unstable, ZeroKind, ZeroMode, ZeroModes};
use crate::energy::{Evaluator, Hamiltonian};
use crate::linalg::{eigen_symmetric, orthonormal, remove, slab};
use crate::stationary::State;
use crate::symmetry::Group;
use crate::units::K_B;
use moves::Moves;
use std::f64::consts::PI;
use valleys::{Held, Valley};

/// Fewer sites along a direction leave nothing room to slide.
const FEWEST: usize = 7;
/// A state that nothing but the edges of its lattice holds may be moved by k_BT over this part of it.
const ROOM: f64 = 0.25;

/// How a stationary state slides.
#[derive(Debug)]
pub struct Sliding {
    /// The soft ones.
    valleys: Vec<Valley>,
    pinning_mev: Vec<f64>,
    /// v_a, of the derivative what lies along the valleys.
    moves: Moves,
    /// States that free shifts, and turns that slide on, make of this one.
    places: usize,
}

impl Sliding {
    /// Of a state with its descending mode, at temperatures up to `hottest_k` (K), along those of the group's shifts that are free.
    /// An error where it slides freely and nobody knows how far.
    pub fn of(
        h: Evaluator,
        state: &State,
        unstable: Option<&Unstable>,
        group: &Group,
        free: &[bool],
        hottest_k: f64,
    ) -> Result<Sliding, UnknownModes> {
        let held = Held::new(state, unstable, h.stiffness_mev() / 3.0);
        let roomy = (0..3).filter(|d| h.lattice().grid.size[*d] >= FEWEST);
        let (along, across): (Vec<usize>, Vec<usize>) = roomy.partition(|d| moves::shift_along(group, *d).is_some());
        for d in across.into_iter().filter(|_| !h.lattice().is_row()) {
            wanders(&h, &held, d, hottest_k)?;
        }
        let mut moves = Moves::of(h, &held, group, &along, free, K_B * hottest_k);
        let mut valleys = held.valleys(&orthonormal(moves.derivatives.clone(), 0.0));
        let span: Vec<Vec<f64>> = valleys.iter().map(|w| w.along.clone()).collect();
        for v in &mut moves.derivatives {
            let mut beside = v.clone();
            remove(&mut beside, &span);
            slab::add_scaled(v, -1.0, &beside);
        }
        let by_way = pinning_by_way(&moves.derivatives, &valleys);
        if by_way.iter().all(|mev| *mev < K_B * hottest_k) {
            return Ok(Sliding { valleys, pinning_mev: by_way, moves, places: 1 });
        }
        let farthest = moves.derivatives.iter().map(|v| slab::norm(v)).fold(0.0, f64::max);
        valleys.retain(|w| pinning_mev(w.stiffness_mev, farthest) < K_B * hottest_k);
        let own = |w: &Valley| pinning_mev(w.stiffness_mev, moves::longest(&moves.derivatives, &w.along));
        let pinning_mev = valleys.iter().map(own).collect();
        Ok(Sliding { valleys, pinning_mev, moves, places: 1 })
    }

    /// Whether it slides at all.
    pub fn slides(&self) -> bool {
        !self.valleys.is_empty()
    }

    /// How many of its valleys are flat to rounding.
    pub fn flat(&self, floor_mev: f64) -> usize {
        self.valleys.iter().filter(|w| w.curvature_mev.abs() <= floor_mev).count()
    }

    /// So many places it has.
    pub fn with_places(self, places: usize) -> Sliding {
        Sliding { places, ..self }
    }

    /// Its zero modes.
    pub fn zero_modes(&self) -> Option<ZeroMode> {
        if !self.slides() {
            return None;
        }
        let volume = |moves: &[Vec<f64>]| self.places as f64 * self.between(moves);
        let said = ZeroModes {
            kind: ZeroKind::Translation,
            count: self.valleys.len(),
            volume: volume(&self.moves.derivatives),
            hop_volume: Some(volume(&self.moves.hops)),
            pinning_mev: self.pinning_mev.clone(),
        };
        Some(ZeroMode { modes: self.valleys.iter().map(|w| w.along.clone()).collect(), said })
    }

    /// The volume from a place to the next: of all ways, or, where some of them are not soft, along the valleys that are.
    fn between(&self, moves: &[Vec<f64>]) -> f64 {
        if self.valleys.len() < moves.len() {
            return self.valleys.iter().map(|w| moves::longest(moves, &w.along)).product();
        }
        let gram: Vec<f64> = moves.iter().flat_map(|a| moves.iter().map(|b| slab::dot(a, b))).collect();
        let (values, _) = eigen_symmetric(&gram, moves.len());
        values.iter().map(|l| l.max(0.0).sqrt()).product()
    }
}

/// An error where the state slides along a direction that no shift of the energy goes along, and k_BT moves it far: what holds it is
/// no row of places, and may be anything.
fn wanders(h: &Hamiltonian, held: &Held, direction: usize, hottest_k: f64) -> Result<(), UnknownModes> {
    let Some(v) = held.tangent(&moves::derivative(h.lattice(), &held.state.m, direction)) else { return Ok(()) };
    for valley in held.valleys(&orthonormal(vec![v.clone()], 0.0)) {
        let by = slab::dot(&v, &valley.along);
        let cells = (K_B * hottest_k / valley.stiffness_mev.max(f64::MIN_POSITIVE)).sqrt() / by.abs();
        // what is mostly something else may be soft: it moves the state nowhere
        let is_translation = by * by > 0.5 * slab::dot(&v, &v);
        if is_translation && cells > ROOM * h.lattice().grid.size[direction] as f64 {
            return Err(UnknownModes::Wanders { cells, kelvin: hottest_k });
        }
    }
    Ok(())
}

/// U_a where all ways are soft.
fn pinning_by_way(ways: &[Vec<f64>], valleys: &[Valley]) -> Vec<f64> {
    let part = |a: &Vec<f64>, b: &Vec<f64>| -> f64 {
        valleys.iter().map(|w| w.stiffness_mev * slab::dot(a, &w.along) * slab::dot(b, &w.along)).sum()
    };
    let curvature: Vec<f64> = ways.iter().flat_map(|a| ways.iter().map(move |b| part(a, b))).collect();
    let own: Vec<f64> = (0..ways.len()).map(|k| curvature[k * ways.len() + k]).collect();
    let all: f64 = eigen_symmetric(&curvature, ways.len()).0.iter().product();
    let share = all.max(0.0) / own.iter().product::<f64>().max(f64::MIN_POSITIVE);
    let scale = libm::pow(share, 1.0 / ways.len().max(1) as f64) / (2.0 * PI * PI);
    own.into_iter().map(|e| scale * e).collect()
}

/// U = ε ℓ²/2π² (meV) of one valley, the spins turning by ℓ from a place to the next.
fn pinning_mev(stiffness_mev: f64, hop: f64) -> f64 {
    stiffness_mev * hop * hop / (2.0 * PI * PI)
}

/// ln of e^(−u) I₀(u), u = U/2k_BT, of a mode that is pinned by U at a k_BT (both meV): the mean of e^(u (cos φ − 1)) over all φ, by
/// points so dense that the rule is exact to rounding.
pub fn ln_pinned(pinning_mev: f64, thermal_mev: f64) -> f64 {
    let u = 0.5 * pinning_mev / thermal_mev;
    let points = 24 + (6.0 * u.sqrt()) as usize;
    let part = |k: usize| {
        let half = libm::sin(PI * (k as f64 + 0.5) / points as f64 / 2.0);
        libm::exp(-2.0 * u * half * half)
    };
    libm::log((0..points).map(part).sum::<f64>() / points as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pinned_mode_is_free_when_hot_and_a_well_when_cold() {
        // e^(−u) I₀(u): tables of M. Abramowitz, I. A. Stegun (1964), 9.8
        for (u, expected) in [(1.0, 0.465_759_607_593_640_4), (5.0, 0.183_540_812_609_328_37), (0.0, 1.0)] {
            assert!((libm::exp(ln_pinned(2.0 * u, 1.0)) - expected).abs() < 1e-15, "{u}");
        }
        // a well of curvature ε = U (2π)²/2 in each period
        let (pinning, thermal) = (5e4, 1.0);
        let well = 0.5 * libm::log(2.0 * PI * thermal / (2.0 * PI * PI * pinning));
        assert!((ln_pinned(pinning, thermal) - well).abs() < 1e-5);
    }
}
