//! The stochastic Landau–Lifshitz–Gilbert equation, by a semi-implicit midpoint rule that keeps the length of every spin.
//!
//! ```text
//! dm/dt = m × A,   A = −Γ (B + α m × B)/(1 + α²),   B = −∂E/∂m + η        ⟨η_a(t) η_b(t')⟩ = 2α k_BT/Γ δ_ab δ(t − t')  (Stratonovich)
//! m' = m + ½(m + m̃) × hA(m),   m → m + ½(m + m_new) × hA(½(m + m'))       both with one η, each a rotation (Cayley)
//! ```
//! Γ = γ/μ in rad/s per meV. The rule (its SIB) is of first order in distribution with a small error, and of second order without noise:
//! J. H. Mentink, M. V. Tretyakov, A. Fasolino, M. I. Katsnelson, Th. Rasing, J. Phys.: Condens. Matter 22, 176001 (2010),
//! doi:10.1088/0953-8984/22/17/176001; the noise: J. L. García-Palacios, F. J. Lázaro, Phys. Rev. B 58, 14937 (1998),
//! doi:10.1103/PhysRevB.58.14937. Its equilibrium is Boltzmann's, whatever α is.

use crate::energy::Hamiltonian;
use crate::field::{Components, ComponentsMut};
use crate::geometry::{Vector, vector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::PI;

/// Spins, their bath and the length of a time step.
#[derive(Clone, Debug)]
pub struct Bath<'a> {
    h: &'a Hamiltonian,
    /// Γ h/(1 + α²) of each site (1/meV); 0 where a spin is frozen.
    turn_per_mev: Vec<f64>,
    /// Size of the noise of each site over a step (meV).
    noise_mev: Vec<f64>,
    damping: f64,
    step_s: f64,
}

impl<'a> Bath<'a> {
    /// Γ (rad/s per meV) of each site, Gilbert damping α > 0, k_BT (meV) and the time step (s).
    pub fn new(h: &'a Hamiltonian, gyration: &[f64], damping: f64, thermal_mev: f64, step_s: f64) -> Bath<'a> {
        let free = |i: usize| if h.is_frozen(i) { 0.0 } else { gyration[i] };
        let turn_per_mev = (0..h.sites()).map(|i| free(i) * step_s / (1.0 + damping * damping)).collect();
        let noise_mev = gyration.iter().map(|g| (2.0 * damping * thermal_mev / (g * step_s)).sqrt()).collect();
        Bath { h, turn_per_mev, noise_mev, damping, step_s }
    }

    /// The length of a step (s).
    pub fn step_s(&self) -> f64 {
        self.step_s
    }

    /// One step.
    pub fn step(&self, walker: &mut Walker) {
        let n = self.h.sites();
        let Walker { m, random, gradient, middle, next, noise } = walker;
        normals(random, noise);
        self.h.energy_gradient(m, gradient);
        self.turned(m, m, gradient, noise, next);
        (0..3 * n).for_each(|k| middle[k] = 0.5 * (m[k] + next[k]));
        self.h.energy_gradient(middle, gradient);
        self.turned(m, middle, gradient, noise, next);
        std::mem::swap(m, next);
    }

    /// The spins after a step with the field at `at`, into `to`.
    fn turned(&self, m: &[f64], at: &[f64], gradient: &[f64], noise: &[f64], to: &mut [f64]) {
        let [m, at, gradient, noise] = [m, at, gradient, noise].map(Components::new);
        let mut to = ComponentsMut::new(to);
        for i in 0..m.sites() {
            let own = at.get(i);
            let field = vector::sub(vector::scale(self.noise_mev[i], noise.get(i)), gradient.get(i));
            let a = vector::add(field, vector::scale(self.damping, vector::cross(own, field)));
            to.set(i, rotated(m.get(i), vector::scale(-0.5 * self.turn_per_mev[i], a)));
        }
    }
}

/// m' with m' = m + (m + m') × a: a rotation about a.
fn rotated(m: Vector, a: Vector) -> Vector {
    let square = vector::dot(a, a);
    let along = vector::scale(2.0 * vector::dot(a, m), a);
    let across = vector::scale(2.0, vector::cross(m, a));
    let sum = vector::add(vector::scale(1.0 - square, m), vector::add(along, across));
    vector::scale(1.0 / (1.0 + square), sum)
}

/// Spins on their way, with their random numbers.
#[derive(Clone, Debug)]
pub struct Walker {
    /// Component-major spins (3N numbers).
    pub m: Vec<f64>,
    random: ChaCha8Rng,
    gradient: Vec<f64>,
    middle: Vec<f64>,
    next: Vec<f64>,
    noise: Vec<f64>,
}

impl Walker {
    /// From these spins (component-major, 3N numbers), with the random numbers of a seed.
    pub fn new(m: &[f64], seed: u64) -> Walker {
        let zeros = || vec![0.0; m.len()];
        let random = ChaCha8Rng::seed_from_u64(seed);
        Walker { m: m.to_vec(), random, gradient: zeros(), middle: zeros(), next: zeros(), noise: zeros() }
    }

    /// A whole number below a limit.
    pub(super) fn below(&mut self, limit: usize) -> usize {
        self.random.random_range(0..limit)
    }

    /// Puts other spins in its place; its random numbers go on.
    pub(super) fn put(&mut self, m: &[f64]) {
        self.m.copy_from_slice(m);
    }
}

/// Independent normal numbers of mean 0 and variance 1 (G. E. P. Box, M. E. Muller, Ann. Math. Stat. 29, 610 (1958)).
fn normals(random: &mut ChaCha8Rng, into: &mut [f64]) {
    for pair in into.chunks_mut(2) {
        let radius = (-2.0 * libm::log(1.0 - random.random_range(0.0..1.0))).sqrt();
        let (sine, cosine) = libm::sincos(2.0 * PI * random.random_range(0.0..1.0));
        pair[0] = radius * cosine;
        if let Some(second) = pair.get_mut(1) {
            *second = radius * sine;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::{Anisotropy, EnergyTerm, Exchange, Zeeman};
    use crate::geometry::Direction;
    use crate::lattice::Chain;
    use crate::spins::Spins;

    fn chain(sites: usize, terms: impl Fn(&crate::lattice::Lattice) -> Vec<Box<dyn EnergyTerm>>) -> Hamiltonian {
        let lattice = Chain::open(sites).resolve().unwrap();
        Hamiltonian::new(&lattice, terms(&lattice)).unwrap()
    }

    /// Mean and standard error from the means of blocks.
    fn mean(blocks: &[f64]) -> (f64, f64) {
        let n = blocks.len() as f64;
        let mean = blocks.iter().sum::<f64>() / n;
        let variance = blocks.iter().map(|b| (b - mean).powi(2)).sum::<f64>() / (n - 1.0);
        (mean, (variance / n).sqrt())
    }

    /// The mean of a number over time, after a start that is left out.
    fn average(bath: &Bath, start: &[f64], steps: usize, of: impl Fn(&[f64]) -> f64) -> (f64, f64) {
        let block = |seed: u64| {
            let mut walker = Walker::new(start, seed);
            (0..steps / 10).for_each(|_| bath.step(&mut walker));
            let sum: f64 = (0..steps)
                .map(|_| {
                    bath.step(&mut walker);
                    of(&walker.m)
                })
                .sum();
            sum / steps as f64
        };
        mean(&(0..24).map(block).collect::<Vec<f64>>())
    }

    #[test]
    fn a_spin_in_a_field_points_along_it_as_langevin_says_at_any_damping() {
        let field = 1.5;
        let h = chain(1, |_| vec![Box::new(Zeeman::uniform(1, [0.0, 0.0, field]))]);
        for (damping, thermal) in [(0.1, 1.0), (1.0, 0.5)] {
            let bath = Bath::new(&h, &[1.0], damping, thermal, 0.02);
            let (found, error) = average(&bath, &[0.0, 0.0, 1.0], 40_000, |m| m[2]);
            let x: f64 = field / thermal;
            let expected = 1.0 / x.tanh() - 1.0 / x;
            assert!(
                (found - expected).abs() < 3.0 * error && error < 0.03,
                "α = {damping}: {found} ± {error}, {expected}"
            );
        }
    }

    #[test]
    fn two_spins_are_as_parallel_as_boltzmann_says() {
        let h = chain(2, |lattice| vec![Box::new(Exchange::uniform(lattice, &[1.0]))]);
        let bath = Bath::new(&h, &[1.0, 0.5], 0.5, 0.4, 0.02);
        let (found, error) =
            average(&bath, &[0.0, 0.0, 0.0, 0.0, 1.0, 1.0], 40_000, |m| m[0] * m[1] + m[2] * m[3] + m[4] * m[5]);
        let x: f64 = 1.0 / 0.4;
        let expected = 1.0 / x.tanh() - 1.0 / x;
        assert!((found - expected).abs() < 3.0 * error && error < 0.02, "{found} ± {error}, {expected}");
    }

    #[test]
    fn lengths_are_kept_and_a_seed_says_all() {
        let h = chain(7, |lattice| {
            let terms: Vec<Box<dyn EnergyTerm>> =
                vec![Box::new(Exchange::uniform(lattice, &[1.0])), Box::new(Anisotropy::uniform(7, 0.3, Direction::Z))];
            terms
        });
        let bath = Bath::new(&h, &[1.0; 7], 0.3, 0.8, 0.05);
        let [mut one, mut two, mut other] = [5, 5, 6].map(|seed| Walker::new(Spins::random(7, 1).as_slice(), seed));
        for _ in 0..20_000 {
            [&mut one, &mut two, &mut other].into_iter().for_each(|walker| bath.step(walker));
        }
        assert!(one.m == two.m && one.m != other.m);
        let m = Components::new(&one.m);
        assert!((0..7).all(|i| (vector::norm(m.get(i)) - 1.0).abs() < 1e-11));
    }

    #[test]
    fn without_bath_a_spin_precesses_at_its_rate_and_energy_stays() {
        let field = 2.0;
        let h = chain(1, |_| vec![Box::new(Zeeman::uniform(1, [0.0, 0.0, field]))]);
        let turn = |step: f64| {
            let bath = Bath::new(&h, &[3.0], 0.0, 0.0, step);
            let mut walker = Walker::new(&[0.6, 0.0, 0.8], 1);
            (0..(1.0 / step).round() as usize).for_each(|_| bath.step(&mut walker));
            assert!((walker.m[2] - 0.8).abs() < 1e-12);
            libm::atan2(walker.m[1], walker.m[0])
        };
        // Γ B = 6 rad in a unit of time, less 2π; dm/dt = −Γ m × B turns with the right hand about B
        let expected = 6.0 - 2.0 * PI;
        let errors = [0.01, 0.005].map(|step| (turn(step) - expected).abs());
        assert!(errors[0] < 2e-3 && (errors[0] / errors[1] - 4.0).abs() < 0.1, "{errors:?}");
    }
}
