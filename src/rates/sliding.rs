//! States that slide over their lattice: soft translations, and the volume of the places that they reach.
//!
//! ```text
//! E(x) = Σ_a ½ U_a (1 − cos 2πx_a)               x_a in shifts of the lattice that keep the energy;  U_a = v_a·Hv_a/2π² in soft modes
//! ∫ e^(−E/k_BT) dV = V · Π e^(−u_a) I₀(u_a)      u = U/2k_BT: 1 where it slides freely, √(k_BT/πU) where it is held
//! V = P √det G,   G_ab = v_a · v_b               P places, as many as free shifts make of the state
//! ```
//! Where the v_a are not orthogonal, all U_a are scaled so that the integral is the harmonic one where the state is held (a factor of
//! ¾ on a triangular lattice); where not all ways are soft, there is one U for each soft mode, along the way that it moves the state
//! farthest. v_a is what a shift does to the spins, by one of two definitions: the derivative, v_a = ∂m/∂x_a (to sixth order in the distance of two sites), which rates are made of; and
//! the finite hop, v_a = Log_m(T_a m), the geodesic to the state in the next place, which cuts the corner. On a fine lattice they are
//! the same. Volumes of skyrmions by a hop: P. F. Bessarab et al., Sci. Rep. 8, 3433 (2018), doi:10.1038/s41598-018-21623-3; the
//! integral over a cosine: K. S. Pitzer, W. D. Gwinn, J. Chem. Phys. 10, 428 (1942), doi:10.1063/1.1723744.
//!
//! A mode is integrated so where its U is below the largest k_BT of interest. Which shifts are free: all that keep each minimum beside the
//! saddle that does not itself slide.

use super::unstable::nearest_mode;
use super::{UnknownModes, ZeroKind, ZeroMode, ZeroModes};
use crate::energy::Hamiltonian;
use crate::field::{Components, ComponentsMut};
use crate::geometry::{log, vector};
use crate::lattice::Lattice;
use crate::linalg::{eigen_symmetric, orthonormal, rayleigh_ritz, remove, slab};
use crate::stationary::{Spectrum, State};
use crate::symmetry::{Group, Shift};
use crate::units::K_B;
use std::f64::consts::PI;

/// Part of a mode in the span of the translations from which it is one of them.
const SLIDES: f64 = 0.9;
/// Fewer sites along a direction leave nothing room to slide.
const FEWEST: usize = 7;
/// A state that nothing but the edges of its lattice holds may be moved by k_BT over this part of it.
const ROOM: f64 = 0.25;

/// Eigenvalues that differ by less than this part of them are of modes that any rotation mixes: what they are is told of all together.
const ALIKE: f64 = 1e-6;

/// Inverse iterations towards soft modes, and from how far below zero, in parts of the stiffest translation.
const ITERATIONS: usize = 4;
const BELOW: f64 = 0.01;

/// A mode that may be a translation.
struct Candidate {
    eigenvalue_mev: f64,
    mode: Vec<f64>,
    /// Of the mode, in the span of the translations.
    part: f64,
    pinning_mev: f64,
}

/// How a stationary state slides.
#[derive(Debug, Default)]
pub struct Sliding {
    modes: Vec<Vec<f64>>,
    eigenvalues_mev: Vec<f64>,
    pinning_mev: Vec<f64>,
    /// Which of the group's shifts move the state, each in a way of its own.
    ways: Vec<usize>,
    /// v_a by the derivative and by the hop, tangent coordinates (2N), one a way.
    moves: [Vec<Vec<f64>>; 2],
    /// States that free shifts, and turns that slide on, make of this one.
    places: usize,
}

impl Sliding {
    /// Of a state, at temperatures up to `hottest_k` (K). An error where it slides freely and nobody knows how far.
    pub fn of(
        h: &Hamiltonian,
        state: &State,
        group: &Group,
        spectrum: &Spectrum,
        hottest_k: f64,
    ) -> Result<Sliding, UnknownModes> {
        let shifts: Vec<(usize, usize)> = (0..group.shifts().len())
            .filter_map(|k| Some((k, direction(&group.shifts()[k])?)))
            .filter(|(_, d)| h.lattice().grid.size[*d] >= FEWEST)
            .collect();
        wanders(h, state, &shifts, hottest_k)?;
        let mut found = Sliding::along(h.lattice(), state, group, &shifts);
        let span = orthonormal(found.moves[0].clone(), 0.0);
        let (mut known, mut candidates) = (state.zeros.clone(), Vec::new());
        let near = softened(state, span.clone());
        for _ in 0..span.len() {
            // of two modes of one eigenvalue the search finds any mixture: the next start is the softest of what is left beside it
            let rest = near.iter().map(|v| without(v, &known)).collect();
            let Some(start) = softest(state, &orthonormal(rest, 1e-6)) else { break };
            let Some((eigenvalue_mev, mode)) = nearest_mode(state, start, &known) else { break };
            known.push(mode.clone());
            let part = slab::norm(&slab::overlaps(&span, &mode));
            let hop = found.moves[0].iter().map(|v| slab::dot(v, &mode).abs()).fold(0.0, f64::max);
            candidates.push(Candidate { pinning_mev: pinning_mev(eigenvalue_mev, hop), eigenvalue_mev, part, mode });
        }
        let mut pinning = Vec::new();
        let equal = |a: &Candidate, b: &Candidate| {
            (a.eigenvalue_mev - b.eigenvalue_mev).abs() < ALIKE * b.eigenvalue_mev.abs() + spectrum.floor_mev
        };
        for alike in candidates.chunk_by(equal) {
            let mean = |of: fn(&Candidate) -> f64| alike.iter().map(of).sum::<f64>() / alike.len() as f64;
            let is_translation = mean(|c| c.part * c.part) > SLIDES * SLIDES;
            let is_soft = mean(|c| c.eigenvalue_mev) > -spectrum.floor_mev && mean(|c| c.pinning_mev) < K_B * hottest_k;
            for c in alike.iter().filter(|_| is_translation && is_soft) {
                found.modes.push(c.mode.clone());
                found.eigenvalues_mev.push(c.eigenvalue_mev);
                pinning.push(c.pinning_mev);
            }
        }
        found.pinning_mev = if found.modes.len() == found.ways.len() { found.pinning_by_way() } else { pinning };
        Ok(found)
    }

    /// U_a where all ways are soft.
    fn pinning_by_way(&self) -> Vec<f64> {
        let part = |a: &Vec<f64>, b: &Vec<f64>| -> f64 {
            let of = |(e, mode): (&f64, &Vec<f64>)| e.abs() * slab::dot(a, mode) * slab::dot(b, mode);
            self.eigenvalues_mev.iter().zip(&self.modes).map(of).sum()
        };
        let ways = &self.moves[0];
        let curvature: Vec<f64> = ways.iter().flat_map(|a| ways.iter().map(move |b| part(a, b))).collect();
        let own: Vec<f64> = (0..ways.len()).map(|k| curvature[k * ways.len() + k]).collect();
        let all: f64 = eigen_symmetric(&curvature, ways.len()).0.iter().product();
        let share = all.max(0.0) / own.iter().product::<f64>().max(f64::MIN_POSITIVE);
        let scale = libm::pow(share, 1.0 / ways.len().max(1) as f64) / (2.0 * PI * PI);
        own.into_iter().map(|e| scale * e).collect()
    }

    /// The ways in which shifts move a state.
    fn along(lattice: &Lattice, state: &State, group: &Group, shifts: &[(usize, usize)]) -> Sliding {
        let mut found = Sliding { places: 1, ..Sliding::default() };
        for &(k, d) in shifts {
            let shift = &group.shifts()[k];
            let cells = shift.operation.motion.shifts_by().map_or(1, |by| by[d]) as f64;
            let Some(mut derivative) = tangent(state, &derivative(lattice, &state.m, d)) else { continue };
            let mut own = derivative.clone();
            remove(&mut own, &orthonormal(found.moves[0].clone(), 0.0));
            if slab::norm(&own) < 1e-3 * slab::norm(&derivative) {
                continue;
            }
            slab::scale(&mut derivative, cells);
            let Some(hop) = tangent(state, &hop(&state.m, &shift.operation.apply(&state.m))) else { continue };
            found.ways.push(k);
            found.moves[0].push(derivative);
            found.moves[1].push(hop);
        }
        found
    }

    /// Whether it slides at all.
    pub fn slides(&self) -> bool {
        !self.modes.is_empty()
    }

    /// How many of its modes are flat to rounding.
    pub fn flat(&self, floor_mev: f64) -> usize {
        self.eigenvalues_mev.iter().filter(|e| e.abs() <= floor_mev).count()
    }

    /// So many places it has.
    pub fn with_places(self, places: usize) -> Sliding {
        Sliding { places, ..self }
    }

    /// Its zero modes, where so many times each shift is free.
    pub fn zero_modes(&self, steps: &[usize]) -> Option<ZeroMode> {
        if !self.slides() {
            return None;
        }
        let volume = |moves: &[Vec<f64>]| self.places as f64 * self.between(moves, steps);
        let said = ZeroModes {
            kind: ZeroKind::Translation,
            count: self.modes.len(),
            volume: volume(&self.moves[0]),
            hop_volume: Some(volume(&self.moves[1])),
            pinning_mev: self.pinning_mev.clone(),
        };
        Some(ZeroMode { modes: self.modes.clone(), said })
    }

    /// The volume from a place to the next: of all ways, or, where some of them are not soft, along the modes that are.
    fn between(&self, moves: &[Vec<f64>], steps: &[usize]) -> f64 {
        let scaled = |(v, k): (&Vec<f64>, &usize)| {
            let mut v = v.clone();
            slab::scale(&mut v, steps[*k] as f64);
            v
        };
        let moves: Vec<Vec<f64>> = moves.iter().zip(&self.ways).map(scaled).collect();
        if self.modes.len() < self.ways.len() {
            let longest = |mode: &Vec<f64>| moves.iter().map(|v| slab::dot(v, mode).abs()).fold(0.0, f64::max);
            return self.modes.iter().map(longest).product();
        }
        let gram: Vec<f64> = moves.iter().flat_map(|a| moves.iter().map(|b| slab::dot(a, b))).collect();
        let (values, _) = eigen_symmetric(&gram, moves.len());
        values.iter().map(|l| l.max(0.0).sqrt()).product()
    }
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

/// The direction along which a shift moves sites and nothing else.
fn direction(shift: &Shift) -> Option<usize> {
    let by = shift.operation.motion.shifts_by().filter(|_| shift.operation.moves_sites_alone())?;
    (0..3).find(|d| by[*d] != 0)
}

/// The space of the soft modes that are nearest to a space, nearly: by inverse iteration, from a little below zero.
fn softened(state: &State, mut space: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let Some(stiffest) = rayleigh_ritz(&state.hessian, &space).into_iter().next_back() else { return space };
    let mut matrix = state.hessian.clone();
    matrix.shift(BELOW * stiffest.value.abs());
    let factors = matrix.factor();
    for _ in 0..ITERATIONS {
        for v in &mut space {
            factors.solve(v, 1);
            remove(v, &state.zeros);
        }
        space = orthonormal(space, 1e-9);
    }
    space
}

/// The softest combination of orthonormal vectors.
fn softest(state: &State, span: &[Vec<f64>]) -> Option<Vec<f64>> {
    rayleigh_ritz(&state.hessian, span).into_iter().next().map(|mode| mode.vector)
}

/// What a vector has beside some orthonormal ones.
fn without(v: &[f64], known: &[Vec<f64>]) -> Vec<f64> {
    let mut rest = v.to_vec();
    remove(&mut rest, known);
    rest
}

/// An error where the state slides along a direction that no shift of the energy goes along, and k_BT moves it far: what holds it is
/// no row of places, and may be anything.
fn wanders(h: &Hamiltonian, state: &State, shifts: &[(usize, usize)], hottest_k: f64) -> Result<(), UnknownModes> {
    let lattice = h.lattice();
    let open = |d: &usize| !lattice.is_row() && lattice.grid.size[*d] >= FEWEST && shifts.iter().all(|s| s.1 != *d);
    for d in (0..3).filter(open) {
        let Some(mut along) = tangent(state, &derivative(lattice, &state.m, d)) else { continue };
        let size = slab::norm(&along);
        slab::scale(&mut along, 1.0 / size);
        let Some((eigenvalue_mev, mode)) = nearest_mode(state, along.clone(), &state.zeros) else { continue };
        let cells = (K_B * hottest_k / eigenvalue_mev.max(f64::MIN_POSITIVE)).sqrt() / size;
        if eigenvalue_mev > 0.0 && slab::dot(&mode, &along).abs() > SLIDES && cells > ROOM * lattice.grid.size[d] as f64
        {
            return Err(UnknownModes::Wanders { cells, kelvin: hottest_k });
        }
    }
    Ok(())
}

/// U = ε ℓ²/2π² (meV) of one mode, the spins turning by ℓ from a place to the next.
fn pinning_mev(eigenvalue_mev: f64, hop: f64) -> f64 {
    eigenvalue_mev.abs() * hop * hop / (2.0 * PI * PI)
}

/// A field (3N) in tangent coordinates (2N), but for the rotations; nothing where that is no motion.
fn tangent(state: &State, field: &[f64]) -> Option<Vec<f64>> {
    let mut along = state.basis.coordinates(field);
    let whole = slab::norm(&along);
    remove(&mut along, &state.zeros);
    let size = slab::norm(&along);
    (size > 1e-3 * whole && size > 1e-6).then_some(along)
}

/// The geodesic from a state to another (3N), spin by spin.
fn hop(from: &[f64], to: &[f64]) -> Vec<f64> {
    let (a, b) = (Components::new(from), Components::new(to));
    let mut field = vec![0.0; from.len()];
    (0..a.sites()).for_each(|i| ComponentsMut::new(&mut field).set(i, log(a.get(i), b.get(i))));
    field
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
