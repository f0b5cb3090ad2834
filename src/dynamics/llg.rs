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

use super::field::{Field, at, of_lane, to_lane};
use super::{LANES, Lanes, Order, Spin, noise};
use crate::energy::Hamiltonian;
use crate::geometry::{Vector, vector};
use multiversion::multiversion;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// The bath of all spins, and the length of a time step.
#[derive(Clone, Debug)]
pub struct Bath<'a> {
    field: Field<'a>,
    sites: Vec<Site>,
    damping: f64,
    step_s: f64,
}

#[derive(Clone, Copy, Debug)]
struct Site {
    /// Γ h/(1 + α²) (1/meV); 0 where a spin is frozen.
    turn_per_mev: f64,
    /// Size of the noise over a step (meV).
    noise_mev: f64,
}

impl<'a> Bath<'a> {
    /// Γ (rad/s per meV) of each site, Gilbert damping α > 0, k_BT (meV) and the time step (s).
    pub fn new(h: &'a Hamiltonian, gyration: &[f64], damping: f64, thermal_mev: f64, step_s: f64) -> Bath<'a> {
        let site = |i: usize| {
            let free = if h.is_frozen(i) { 0.0 } else { gyration[i] };
            Site {
                turn_per_mev: free * step_s / (1.0 + damping * damping),
                noise_mev: (2.0 * damping * thermal_mev / (gyration[i] * step_s)).sqrt(),
            }
        };
        Bath { field: Field::new(h), sites: (0..h.sites()).map(site).collect(), damping, step_s }
    }

    /// The length of a step (s).
    pub fn step_s(&self) -> f64 {
        self.step_s
    }

    /// One step of all walkers.
    pub fn step(&self, walkers: &mut Walkers) {
        let Walkers { m, random, gradient, middle, next, noise } = walkers;
        noise::fill_all(random, noise);
        self.field.gradient(m, gradient);
        turn(&self.sites, self.damping, [m, m, gradient, noise], next);
        middle_of(m, next, middle);
        self.field.gradient(middle, gradient);
        turn(&self.sites, self.damping, [m, middle, gradient, noise], next);
        std::mem::swap(m, next);
    }
}

/// Spins `m` after a step with the field at `at`, into `to`.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn turn(sites: &[Site], damping: f64, [m, at, gradient, noise]: [&[Spin]; 4], to: &mut [Spin]) {
    let spins = m.iter().zip(at).zip(gradient.iter().zip(noise));
    for ((site, to), ((m, own), (gradient, noise))) in sites.iter().zip(to).zip(spins) {
        for l in 0..LANES {
            let [m, own, gradient, noise] = [m, own, gradient, noise].map(|spin| self::at(spin, l));
            let field = vector::sub(vector::scale(site.noise_mev, noise), gradient);
            let a = vector::add(field, vector::scale(damping, vector::cross(own, field)));
            let turned = rotated(m, vector::scale(-0.5 * site.turn_per_mev, a));
            (0..3).for_each(|c| to[c][l] = turned[c]);
        }
    }
}

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn middle_of(a: &[Spin], b: &[Spin], into: &mut [Spin]) {
    for ((a, b), into) in a.iter().zip(b).zip(into) {
        (0..3).for_each(|c| (0..LANES).for_each(|l| into[c][l] = 0.5 * (a[c][l] + b[c][l])));
    }
}

/// m' with m' = m + (m + m') × a: a rotation about a.
#[inline(always)]
fn rotated(m: Vector, a: Vector) -> Vector {
    let square = vector::dot(a, a);
    let along = vector::scale(2.0 * vector::dot(a, m), a);
    let across = vector::scale(2.0, vector::cross(m, a));
    let sum = vector::add(vector::scale(1.0 - square, m), vector::add(along, across));
    vector::scale(1.0 / (1.0 + square), sum)
}

/// Spins on their way, side by side, each with random numbers of its own.
#[derive(Clone, Debug)]
pub struct Walkers {
    m: Vec<Spin>,
    random: [ChaCha8Rng; LANES],
    gradient: Vec<Spin>,
    middle: Vec<Spin>,
    next: Vec<Spin>,
    noise: Vec<Spin>,
}

impl Walkers {
    /// All from these spins (component-major, 3N numbers), with the first streams of a seed's random numbers.
    pub fn new(m: &[f64], seed: u64) -> Walkers {
        let zeros = || vec![[[0.0; LANES]; 3]; m.len() / 3];
        let random = std::array::from_fn(|lane| stream(seed, lane as u64));
        let mut walkers =
            Walkers { m: zeros(), random, gradient: zeros(), middle: zeros(), next: zeros(), noise: zeros() };
        (0..LANES).for_each(|lane| walkers.put(lane, m));
        walkers
    }

    /// Spins of the walker in a lane (component-major, 3N numbers).
    pub fn spins(&self, lane: usize) -> Vec<f64> {
        of_lane(&self.m, lane)
    }

    /// Puts other spins in a lane; its random numbers go on.
    pub fn put(&mut self, lane: usize, m: &[f64]) {
        to_lane(m, lane, &mut self.m);
    }

    /// Begins anew in a lane, with a stream of a seed's random numbers.
    pub(super) fn begin(&mut self, lane: usize, m: &[f64], seed: u64, number: u64) {
        self.put(lane, m);
        self.random[lane] = stream(seed, number);
    }

    /// λ of all walkers.
    pub fn orders(&self, order: &Order) -> Lanes {
        let mut sums = [0.0; LANES];
        for spin in &self.m {
            (0..LANES).for_each(|l| sums[l] += order(at(spin, l)));
        }
        sums
    }
}

fn stream(seed: u64, number: u64) -> ChaCha8Rng {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(number);
    random
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::{Anisotropy, EnergyTerm, Exchange, Zeeman};
    use crate::geometry::Direction;
    use crate::lattice::Chain;
    use crate::spins::Spins;
    use std::f64::consts::PI;

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

    /// The mean of a number of all walkers over time, after a start that is left out: in blocks of a lane each.
    fn average(bath: &Bath, start: &[f64], steps: usize, of: impl Fn(&Walkers) -> Lanes) -> (f64, f64) {
        let block = |seed: u64| {
            let mut walkers = Walkers::new(start, seed);
            (0..steps / 10).for_each(|_| bath.step(&mut walkers));
            let mut sums = [0.0; LANES];
            for _ in 0..steps {
                bath.step(&mut walkers);
                of(&walkers).iter().zip(&mut sums).for_each(|(own, sum)| *sum += own / steps as f64);
            }
            sums
        };
        mean((0..3).map(block).collect::<Vec<_>>().as_flattened())
    }

    #[test]
    fn a_spin_in_a_field_points_along_it_as_langevin_says_at_any_damping() {
        let field = 1.5;
        let h = chain(1, |_| vec![Box::new(Zeeman::uniform(1, [0.0, 0.0, field]))]);
        for (damping, thermal) in [(0.1, 1.0), (1.0, 0.5)] {
            let bath = Bath::new(&h, &[1.0], damping, thermal, 0.02);
            let (found, error) = average(&bath, &[0.0, 0.0, 1.0], 40_000, |w| w.orders(&|m| m[2]));
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
        let start = [0.0, 0.0, 0.0, 0.0, 1.0, 1.0];
        let parallel = |w: &Walkers| std::array::from_fn(|l| vector::dot(at(&w.m[0], l), at(&w.m[1], l)));
        let (found, error) = average(&bath, &start, 40_000, parallel);
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
        let [mut one, mut two, mut other] = [5, 5, 6].map(|seed| Walkers::new(Spins::random(7, 1).as_slice(), seed));
        for _ in 0..20_000 {
            [&mut one, &mut two, &mut other].into_iter().for_each(|walkers| bath.step(walkers));
        }
        assert!(one.m == two.m && one.m != other.m && one.spins(0) != one.spins(1));
        let unit = |spin: &Spin| (0..LANES).all(|l| (vector::norm(at(spin, l)) - 1.0).abs() < 1e-11);
        assert!(one.m.iter().all(unit));
    }

    #[test]
    fn without_bath_a_spin_precesses_at_its_rate_and_energy_stays() {
        let field = 2.0;
        let h = chain(1, |_| vec![Box::new(Zeeman::uniform(1, [0.0, 0.0, field]))]);
        let turn = |step: f64| {
            let bath = Bath::new(&h, &[3.0], 0.0, 0.0, step);
            let mut walkers = Walkers::new(&[0.6, 0.0, 0.8], 1);
            (0..(1.0 / step).round() as usize).for_each(|_| bath.step(&mut walkers));
            let m = walkers.spins(3);
            assert!((m[2] - 0.8).abs() < 1e-12);
            libm::atan2(m[1], m[0])
        };
        // Γ B = 6 rad in a unit of time, less 2π; dm/dt = −Γ m × B turns with the right hand about B
        let expected = 6.0 - 2.0 * PI;
        let errors = [0.01, 0.005].map(|step| (turn(step) - expected).abs());
        assert!(errors[0] < 2e-3 && (errors[0] / errors[1] - 4.0).abs() < 0.1, "{errors:?}");
    }
}
