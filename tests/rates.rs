//! Rates against closed forms, the reference and dense eigenvalues; what has no rate is refused.

use crate::common::{Build, cases, number, solve};
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::Deserialize;
use spinneb::config::load_text;
use spinneb::drive::survey::{IMAGES, survey};
use spinneb::drive::{Outcome, Problem, Silent};
use spinneb::energy::{Anisotropy, Exchange, Hamiltonian};
use spinneb::geometry::{Direction, tangent_basis, vector};
use spinneb::landscape::Effort;
use spinneb::lattice::Chain;
use spinneb::linalg::eigen_symmetric;
use spinneb::rates::{Pinning, RateSettings, Regime, SaddleRate, Theory, Way, ZeroKind, ZeroModes};
use spinneb::spins::Spins;
use spinneb::units::{HBAR, K_B};
use std::f64::consts::PI;

/// Both theories at one temperature, moments of n μ_B each.
pub fn settings(sites: usize, moment: f64, damping: f64, kelvin: f64) -> RateSettings {
    RateSettings {
        temperatures_k: vec![kelvin],
        damping,
        g_factor: 2.0,
        theories: Theory::ALL.to_vec(),
        moments_mub: vec![moment; sites],
    }
}

/// γ/μ times 1 meV, in Hz.
pub fn unit_hz(moment: f64) -> f64 {
    1e12 * 2.0 / (HBAR * moment)
}

pub fn with(mut problem: Problem, settings: RateSettings) -> Problem {
    problem.rates = Some(settings);
    problem
}

pub fn rate(outcome: &Outcome, way: Way) -> &SaddleRate {
    let rates = outcome.rates.as_ref().expect("rates");
    rates.saddles.iter().find(|r| r.way == way && r.saddle == 0).expect("a saddle")
}

/// What a rate is made of where nothing is soft.
pub fn cold(rate: &SaddleRate) -> &Regime {
    &rate.regimes[0]
}

/// What a rate is made of at the first temperature.
pub fn made(rate: &SaddleRate) -> &Regime {
    rate.at(rate.rows.first().map_or(f64::INFINITY, |row| row.temperature_k))
}

#[test]
fn the_reference_is_met_by_both_theories_at_all_dampings() {
    let reference = cases();
    let tolerance = number(&reference["rates"], "tolerance");
    for case in reference["rates"]["cases"].as_array().expect("cases") {
        let n = case["N"].as_u64().expect("N") as usize;
        let build = || Build::open(n).easy(number(case, "K")).hard(number(case, "K_hard"));
        for (damping, expected) in case["langer"].as_object().expect("langer") {
            let alpha: f64 = damping.parse().expect("a damping");
            let outcome = solve(&with(build().reversal(), settings(n, 1.5, alpha, 10.0)));
            assert!(outcome.certified);
            let r = rate(&outcome, Way::Forward);
            let htst = cold(r).htst.expect("HTST").hz_at(10.0) / unit_hz(1.5);
            let langer = cold(r).langer.expect("Langer").hz_at(10.0) / unit_hz(1.5);
            let expected = expected.as_f64().expect("a number");
            assert!((htst / number(case, "htst") - 1.0).abs() < tolerance, "N = {n}: {htst}");
            assert!((langer / expected - 1.0).abs() < tolerance, "N = {n}, α = {alpha}: {langer}, {expected}");
        }
    }
}

#[test]
fn a_moment_twice_as_large_halves_the_prefactor_and_the_closed_form_is_met() {
    for (k, hard) in [(2.0, 0.7), (1.0, 2.0), (1.0, 1.0), (0.3, 5.0)] {
        one_spin(k, hard);
    }
}

fn one_spin(k: f64, hard: f64) {
    let prefactors = [1.0, 2.0].map(|moment| {
        let problem = Build::open(1).easy(k).hard(hard).reversal();
        let outcome = solve(&with(problem, settings(1, moment, 0.3, 5.0)));
        let r = rate(&outcome, Way::Forward).clone();
        [cold(&r).htst, cold(&r).langer].map(|p| p.expect("a prefactor").hz_at(5.0))
    });
    for (one, two) in prefactors[0].iter().zip(&prefactors[1]) {
        assert!((one / two - 2.0).abs() < 1e-13, "{one} {two}");
    }
    let closed = (k * (k + hard)).sqrt() / PI * unit_hz(1.0);
    assert!((prefactors[0][0] / closed - 1.0).abs() < 1e-12);
    // Langer's λ₊ of one spin: the positive root of (1 + α²) λ² + α (ε₂ − |ε₁|) λ − |ε₁| ε₂, in units of γ/μ
    let (down, up, alpha) = (2.0 * k, 2.0 * hard, 0.3f64);
    let (a, b, c) = (1.0 + alpha * alpha, alpha * (up - down), -up * down);
    let growth = (-b + (b * b - 4.0 * a * c).sqrt()) / (2.0 * a);
    let langer = growth / (2.0 * PI) * (2.0 * k * 2.0 * (k + hard) / (up * down)).sqrt() * unit_hz(1.0);
    assert!((prefactors[0][1] / langer - 1.0).abs() < 1e-12);
}

/// A state that slides in two ways.
struct Slid {
    /// ℓ_a·ℓ_b of the ways' parts along the valleys.
    gram: [f64; 3],
    /// ℓ_aᵀKℓ_b.
    stiffness_mev: [f64; 3],
    /// ln of the Hessian's determinant on the space normal to the valleys.
    log_determinant: f64,
}

/// Of the symmetric matrix [[a, b], [b, c]].
fn determinant([a, b, c]: [f64; 3]) -> f64 {
    a * c - b * b
}

pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub fn unit(v: Vec<f64>) -> Vec<f64> {
    let size = dot(&v, &v).sqrt();
    v.into_iter().map(|x| x / size).collect()
}

/// A stationary state in dense arithmetic: its tangent Hessian from products with single vectors, and its eigenvalues.
pub struct Dense {
    pub m: Spins,
    basis: Vec<f64>,
    hessian: Vec<f64>,
    pub values: Vec<f64>,
    pub vectors: Vec<Vec<f64>>,
}

impl Dense {
    pub fn new(h: &Hamiltonian, m: Spins) -> Dense {
        let n = m.sites();
        let mut g = vec![0.0; 3 * n];
        h.energy_gradient(m.as_slice(), &mut g);
        // basis[k] is the k-th tangent unit vector as a field of 3N numbers
        let mut basis = vec![0.0; 2 * n * 3 * n];
        for i in 0..n {
            let (u, v) = tangent_basis(m.get(i));
            for c in 0..3 {
                basis[2 * i * 3 * n + c * n + i] = u[c];
                basis[(2 * i + 1) * 3 * n + c * n + i] = v[c];
            }
        }
        let mut hessian = vec![0.0; 4 * n * n];
        let mut out = vec![0.0; 3 * n];
        for k in 0..2 * n {
            h.hessian_product(m.as_slice(), &g, &basis[k * 3 * n..(k + 1) * 3 * n], &mut out);
            for j in 0..2 * n {
                hessian[j * 2 * n + k] = basis[j * 3 * n..(j + 1) * 3 * n].iter().zip(&out).map(|(a, b)| a * b).sum();
            }
        }
        for j in 0..2 * n {
            for k in 0..j {
                let mean = 0.5 * (hessian[j * 2 * n + k] + hessian[k * 2 * n + j]);
                (hessian[j * 2 * n + k], hessian[k * 2 * n + j]) = (mean, mean);
            }
        }
        let (values, vectors) = eigen_symmetric(&hessian, 2 * n);
        Dense { m, basis, hessian, values, vectors }
    }

    /// Eigenvalues without the `zeros` smallest ones in size, with their place.
    fn without_zeros(&self, zeros: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.values.len()).collect();
        order.sort_by(|a, b| self.values[*a].abs().total_cmp(&self.values[*b].abs()));
        let mut kept = order.split_off(zeros);
        kept.sort_unstable();
        kept
    }

    pub fn log_determinant(&self, zeros: usize) -> f64 {
        self.without_zeros(zeros).iter().map(|k| self.values[*k].abs().ln()).sum()
    }

    /// A tangent field in tangent coordinates.
    pub fn coordinates(&self, field: &[[f64; 3]]) -> Vec<f64> {
        let n = self.m.sites();
        let along = |k: usize| (0..3 * n).map(|c| self.basis[k * 3 * n + c] * field[c % n][c / n]).sum();
        (0..2 * n).map(along).collect()
    }

    /// The valleys along two directions: H⁻¹ of them.
    fn slid(&self, ways: [Vec<f64>; 2]) -> Slid {
        let inverse = |v: &Vec<f64>| {
            let part = |(u, value): (&Vec<f64>, &f64)| dot(u, v) / value;
            let parts: Vec<f64> = self.vectors.iter().zip(&self.values).map(part).collect();
            (0..v.len()).map(|i| self.vectors.iter().zip(&parts).map(|(u, p)| p * u[i]).sum()).collect::<Vec<f64>>()
        };
        let [w, x] = ways.each_ref().map(inverse).map(unit);
        let overlap = dot(&w, &x);
        let x = unit(x.iter().zip(&w).map(|(x, w)| x - overlap * w).collect());
        let symmetric = |f: &dyn Fn(usize, usize) -> f64| [f(0, 0), f(0, 1), f(1, 1)];
        let valleys = [w, x];
        let solved = valleys.each_ref().map(inverse);
        let softness = symmetric(&|a, b| dot(&valleys[a], &solved[b]));
        let all = determinant(softness);
        let stiffness = [softness[2] / all, -softness[1] / all, softness[0] / all];
        let lengths = ways.each_ref().map(|v| valleys.each_ref().map(|w| dot(v, w)));
        let energy = |a: usize, b: usize| {
            let [[p, q], [r, s]] = [lengths[a], lengths[b]];
            stiffness[0] * p * r + stiffness[1] * (p * s + q * r) + stiffness[2] * q * s
        };
        Slid {
            gram: symmetric(&|a, b| dot(&lengths[a], &lengths[b])),
            stiffness_mev: symmetric(&energy),
            log_determinant: self.log_determinant(0) + all.ln(),
        }
    }

    /// m × (H e_k), weighted site by site, in tangent coordinates.
    fn velocity(&self, k: usize, gyration: &[f64]) -> Vec<f64> {
        let n = self.m.sites();
        let size = 2 * n;
        let image: Vec<f64> =
            (0..size).map(|j| (0..size).map(|l| self.hessian[j * size + l] * self.vectors[k][l]).sum()).collect();
        let mut field = vec![[0.0; 3]; n];
        for j in 0..size {
            for (i, f) in field.iter_mut().enumerate() {
                for c in 0..3 {
                    f[c] += image[j] * self.basis[j * 3 * n + c * n + i];
                }
            }
        }
        let turned: Vec<_> =
            (0..n).map(|i| vector::scale(gyration[i], vector::cross(self.m.get(i), field[i]))).collect();
        (0..size)
            .map(|j| {
                (0..n).map(|i| (0..3).map(|c| turned[i][c] * self.basis[j * 3 * n + c * n + i]).sum::<f64>()).sum()
            })
            .collect()
    }

    /// √(Σ' a_j²/ε_j) √|ε₁| as Bessarab, Uzdin and Jónsson write it (rad/s for Γ in rad/s per meV).
    fn htst_frequency(&self, zeros: usize, gyration: &[f64]) -> f64 {
        let kept = self.without_zeros(zeros);
        let squares = kept[1..].iter().map(|&j| {
            let a: f64 = self.velocity(j, gyration).iter().zip(&self.vectors[kept[0]]).map(|(v, e)| v * e).sum();
            a * a / self.values[j]
        });
        (squares.sum::<f64>() * self.values[kept[0]].abs()).sqrt()
    }

    /// The eigenvalue with a positive real part of −Γ(α + R)H/(1 + α²): the limit of tr(A e^{At})/tr(e^{At}).
    pub fn growth_rate(&self, gyration: &[f64], alpha: f64) -> f64 {
        let size = self.values.len();
        let scale =
            gyration.iter().fold(0.0f64, |s, g| s.max(*g)) * self.values.iter().fold(0.0f64, |s, v| s.max(v.abs()));
        let mut a = vec![0.0; size * size];
        for i in 0..size / 2 {
            let s = gyration[i] / (1.0 + alpha * alpha) / scale;
            for k in 0..size {
                let (p, q) = (self.hessian[2 * i * size + k], self.hessian[(2 * i + 1) * size + k]);
                a[2 * i * size + k] = -s * (alpha * p - q);
                a[(2 * i + 1) * size + k] = -s * (alpha * q + p);
            }
        }
        let multiply = |a: &[f64], b: &[f64]| -> Vec<f64> {
            (0..size * size)
                .map(|k| (0..size).map(|l| a[k / size * size + l] * b[l * size + k % size]).sum::<f64>())
                .collect()
        };
        let trace = |a: &[f64]| (0..size).map(|k| a[k * size + k]).sum::<f64>();
        // e^A by its series, then squared until nothing but the growing mode is left
        let mut power: Vec<f64> = (0..size * size).map(|k| f64::from(u8::from(k / size == k % size))).collect();
        let mut exponential = power.clone();
        for order in 1..40 {
            power = multiply(&power, &a).iter().map(|v| v / f64::from(order)).collect();
            exponential.iter_mut().zip(&power).for_each(|(e, p)| *e += p);
        }
        for _ in 0..40 {
            exponential = multiply(&exponential, &exponential);
            let largest = exponential.iter().fold(0.0f64, |m, v| m.max(v.abs()));
            exponential.iter_mut().for_each(|v| *v /= largest);
        }
        scale * trace(&multiply(&a, &exponential)) / trace(&exponential)
    }
}

/// A short chain of random terms with unequal moments, and whether turns about z leave its energy as it is.
fn random_chain(r: &mut impl Rng, uniaxial: bool) -> (Problem, RateSettings) {
    let n = r.random_range(2..7);
    let chain = if n > 3 && r.random_bool(0.3) { Chain::ring(n) } else { Chain::open(n) };
    let lattice = chain.resolve().unwrap();
    let mut exchange = Exchange::uniform(&lattice, &[1.0]);
    let mut easy = Anisotropy::uniform(n, 0.0, Direction::Z);
    let mut hard = Anisotropy::uniform(n, 0.0, Direction::X);
    exchange.families[0].mev[..lattice.bonds(1).len()].iter_mut().for_each(|j| *j = r.random_range(0.5..1.5));
    easy.k.iter_mut().for_each(|k| *k = r.random_range(0.2..0.8));
    hard.k.iter_mut().for_each(|k| *k = -r.random_range(0.1..0.6));
    let mut build = Build { lattice, terms: vec![Box::new(exchange), Box::new(easy)] };
    if uniaxial {
        build = build.field([0.0, 0.0, r.random_range(-0.1..0.1)]);
    } else {
        let field = [0, 1, 2].map(|_| r.random_range(-0.1..0.1));
        build = build.with(hard).field(field);
    }
    let moments_mub = (0..n).map(|_| r.random_range(0.5..4.0)).collect();
    let damping = r.random_range(0.02..1.5);
    (build.reversal(), RateSettings { moments_mub, damping, ..settings(n, 1.0, 0.0, 3.0) })
}

#[test]
fn a_hundred_random_chains_agree_with_dense_eigenvalues() {
    let mut r = ChaCha8Rng::seed_from_u64(11);
    let (mut plain, mut turning, mut left) = (0, 0, 0);
    while plain < 60 || turning < 40 {
        let uniaxial = turning < 40 && (plain >= 60 || turning <= plain);
        let (problem, settings) = random_chain(&mut r, uniaxial);
        let problem = with(problem, settings.clone());
        let outcome = solve(&problem);
        if !outcome.certified {
            left += 1;
            continue;
        }
        check_against_dense(&problem.hamiltonian, &outcome, &settings, uniaxial);
        (plain, turning) = if uniaxial { (plain, turning + 1) } else { (plain + 1, turning) };
    }
    assert!(left <= 5, "{left} random chains could not be certified");
}

fn check_against_dense(h: &Hamiltonian, outcome: &Outcome, settings: &RateSettings, uniaxial: bool) {
    let found = rate(outcome, Way::Forward);
    let top = Dense::new(h, outcome.saddles[0].spins.clone());
    let bottom = Dense::new(h, outcome.path.spins(0));
    let zeros = usize::from(uniaxial);
    let gyration: Vec<f64> = settings.moments_mub.iter().map(|n| unit_hz(*n)).collect();
    let sines: f64 = (0..top.m.sites()).map(|i| 1.0 - top.m.get(i)[2].powi(2)).sum();
    let t = settings.temperatures_k[0];
    let volume = if uniaxial { 2.0 * PI * sines.sqrt() / (2.0 * PI * K_B * t).sqrt() } else { 1.0 };
    let entropy = 0.5 * (bottom.log_determinant(0) - top.log_determinant(zeros));
    let expected = |frequency: f64| frequency / (2.0 * PI) * entropy.exp() * volume;
    let langer = expected(top.growth_rate(&gyration, settings.damping));
    let own = made(found)
        .langer
        .as_ref()
        .unwrap_or_else(|| {
            panic!("no Langer rate: {:?} {:?} {:?}", made(found).refused, outcome.saddles, outcome.warnings)
        })
        .hz_at(t);
    assert!((own / langer - 1.0).abs() < 1e-9, "Langer {own} {langer}");
    assert!((made(found).entropy_factor.expect("entropy") - entropy).abs() < 1e-9);
    if uniaxial {
        assert!(made(found).htst.is_none() && made(found).refused.len() == 1);
        assert_eq!((made(found).saddle_zeros.len(), made(found).saddle_zeros[0].kind), (1, ZeroKind::Rotation));
    } else {
        let (own, htst) = (made(found).htst.expect("HTST").hz_at(t), expected(top.htst_frequency(0, &gyration)));
        assert!((own / htst - 1.0).abs() < 1e-9, "HTST {own} {htst}");
    }
}

/// A film or an island of moments of 2 μ_B, with rates at a temperature.
fn film(lattice: &str, energy: &str, ends: [&str; 2], kelvin: f64) -> Problem {
    let text = format!(
        r#"{{"material": {{"name": "test", "moment": "2 mu_B", "energy": [{energy}]}}, "lattice": {lattice},
            "initial": {}, "final": {}, "rates": {{"temperatures": ["{kelvin} K"], "damping": 0.2, "theory": ["htst", "langer"]}}}}"#,
        ends[0], ends[1]
    );
    load_text(std::path::Path::new("film.json"), text).unwrap().problem().unwrap()
}

const UP: &str = r#"{"uniform": {"direction": [0, 0, 1]}}"#;
const DOWN: &str = r#"{"uniform": {"direction": [0, 0, -1]}}"#;

#[test]
fn islands_pinned_walls_discs_with_an_axis_in_the_plane_and_rows_of_dipoles_agree_with_dense_eigenvalues() {
    let axes = |easy: &str, hard: &str| {
        format!(
            r#"{{"exchange": {{"J": ["1 meV"]}}}}, {{"anisotropy": {{"K": "0.3 meV", "axis": {easy}}}}},
               {{"anisotropy": {{"K": "-0.2 meV", "axis": {hard}}}}}"#
        )
    };
    let normal = axes("[0, 0, 1]", "[1, 0, 0]");
    let island = film(r#"{"square": {"cells": [9, 3]}}"#, &normal, [UP, DOWN], 1.0);
    let weak = r#"{"anisotropy": {"K": "-0.2 meV", "axis": [0, 0, 1], "sites": {"any": [
        {"box": {"from": [3, 0], "to": [3, 2]}}, {"box": {"from": [8, 0], "to": [8, 2]}}]}}}"#;
    let walls = [3, 8].map(|center| format!(r#"{{"domain_wall": {{"center": {center}}}}}"#));
    let ends = [walls[0].as_str(), walls[1].as_str()];
    let pinned = film(r#"{"square": {"cells": [12, 3]}}"#, &format!("{normal}, {weak}"), ends, 1.0);
    let disc = r#"{"triangular": {"cells": [7, 7], "shape": {"disc": {"radius": 2.6}}}}"#;
    let along = [1, -1].map(|x| format!(r#"{{"uniform": {{"direction": [{x}, 0, 0]}}}}"#));
    let disc = film(disc, &axes("[1, 0, 0]", "[0, 0, 1]"), [&along[0], &along[1]], 1.0);
    let dipoles = format!(r#"{normal}, {{"dipolar": {{}}}}"#);
    let row = film(r#"{"chain": {"sites": 14, "spacing": "0.2 nm"}}"#, &dipoles, [UP, DOWN], 1.0);
    // by either end of the island, and in either sense; the disc's spins turn as one
    for (problem, alike) in [(island, Some(4)), (pinned, None), (disc, Some(2)), (row, None)] {
        let outcome = solve(&problem);
        assert!(outcome.certified, "{:?}", outcome.warnings);
        check_against_dense(&problem.hamiltonian, &outcome, problem.rates.as_ref().unwrap(), false);
        if let Some(alike) = alike {
            assert_eq!(made(rate(&outcome, Way::Forward)).equivalents.count, alike);
        }
    }
}

/// The mean of e^(−E/k_BT) over a place, E(x) = A sin²πx + ¼(U − A) sin²2πx.
pub fn mean(pinning: &Pinning, thermal_mev: f64) -> f64 {
    let Pinning { curved_mev, top_mev } = *pinning;
    let at = |k: u32| {
        let x = PI * f64::from(k) / 2000.0;
        (-(top_mev * x.sin().powi(2) + 0.25 * (curved_mev - top_mev) * (2.0 * x).sin().powi(2)) / thermal_mev).exp()
    };
    (0..2000).map(at).sum::<f64>() / 2000.0
}

/// ∂m/∂x of a periodic square film, x along the first or the second direction, to sixth order, on the tangent planes.
fn slope(m: &Spins, size: usize, second: bool) -> Vec<[f64; 3]> {
    let at = |i: usize, by: usize| {
        let (x, y) = (i % size, i / size);
        if second { x + size * ((y + size + by - 3) % size) } else { (x + size + by - 3) % size + size * y }
    };
    let weights = [-1.0, 9.0, -45.0, 0.0, 45.0, -9.0, 1.0].map(|w| w / 60.0);
    let along = |i: usize| {
        let sum = (0..7).fold([0.0; 3], |sum, by| vector::add(sum, vector::scale(weights[by], m.get(at(i, by)))));
        vector::normal_part(sum, m.get(i))
    };
    (0..m.sites()).map(along).collect()
}

#[test]
fn a_skyrmion_that_slides_over_its_film_agrees_with_dense_eigenvalues_and_the_volume_of_its_places() {
    let energy = r#"{"exchange": {"J": ["1 meV"]}}, {"dmi": {"D": "0.6 meV", "kind": "interfacial"}},
        {"anisotropy": {"K": "0.1 meV", "axis": [0, 0, 1]}}, {"zeeman": {"B": ["0 T", "0 T", "1.7 T"]}}"#;
    let (size, kelvin) = (10, 2.0);
    let lattice = format!(r#"{{"square": {{"cells": [{size}, {size}], "periodic": true}}}}"#);
    let skyrmion = r#"{"skyrmion": {"radius": 3, "center": [5, 5]}}"#;
    let problem = film(&lattice, energy, [skyrmion, UP], kelvin);
    let outcome = solve(&problem);
    assert!(outcome.certified, "{:?}", outcome.warnings);
    let [forward, backward] = Way::BOTH.map(|way| rate(&outcome, way));
    let [top, bottom, up] =
        [outcome.saddles[0].spins.clone(), outcome.path.spins(0), Spins::uniform(size * size, Direction::Z)]
            .map(|m| Dense::new(&problem.hamiltonian, m));
    let thermal = K_B * kelvin;
    let held = |pinning: &Pinning| mean(pinning, thermal);
    // ∫ e^(−E/k_BT) over two translations, in units of 2πk_BT, and their parts of the determinant
    let integral = |state: &Dense, zeros: &ZeroModes| {
        let slopes = [false, true].map(|second| slope(&state.m, size, second));
        let slid = state.slid(slopes.map(|slope| state.coordinates(&slope)));
        let cell = determinant(slid.gram).sqrt();
        assert_eq!((zeros.kind, zeros.count), (ZeroKind::Translation, 2));
        assert!((zeros.volume / (cell * (size * size) as f64) - 1.0).abs() < 1e-12, "{zeros:?}");
        // ε ℓ²/2π² along one direction and the other, which symmetry makes the same
        let both = zeros.pinning.iter().map(|p| p.curved_mev).product::<f64>();
        assert!((both / (determinant(slid.stiffness_mev) / (2.0 * PI * PI).powi(2)) - 1.0).abs() < 1e-8, "{zeros:?}");
        if zeros == &made(forward).minimum_zeros[0] {
            let soft = state.values.iter().copied().fold(f64::INFINITY, f64::min);
            assert!(
                (zeros.pinning[0].curved_mev / (soft * slid.gram[0] / (2.0 * PI * PI)) - 1.0).abs() < 0.05,
                "{zeros:?}"
            );
        }
        let free: f64 = zeros.pinning.iter().map(held).product::<f64>() * cell / (2.0 * PI * thermal);
        free * (-0.5 * slid.log_determinant).exp()
    };
    let (zeros, above) = (&made(forward).minimum_zeros[0], &made(forward).saddle_zeros[0]);
    assert!(made(backward).minimum_zeros.is_empty());
    let hop = zeros.hop_volume.expect("a hop") / zeros.volume;
    assert!((0.8..1.1).contains(&hop) && hop != 1.0, "{hop}");
    let [over, before] = [(&top, above), (&bottom, zeros)].map(|(state, zeros)| integral(state, zeros));
    let after = (-0.5 * up.log_determinant(0)).exp() / (size * size) as f64;
    let gyration = vec![unit_hz(2.0); size * size];
    for (theory, frequency) in
        [(Theory::Htst, top.htst_frequency(0, &gyration)), (Theory::Langer, top.growth_rate(&gyration, 0.2))]
    {
        let expected = [before, after].map(|minimum| over / minimum * frequency / (2.0 * PI));
        for (r, expected) in [forward, backward].into_iter().zip(expected) {
            let rate = r.ln_rate_per_s(theory, kelvin).expect("a rate") - libm::log(made(r).equivalents.count as f64);
            let found = (rate + r.barrier_mev.expect("a barrier") / thermal).exp();
            assert!((found / expected - 1.0).abs() < 1e-8, "{theory:?} {found} {expected}");
        }
    }
    // with nothing but k_BT made small, what slides becomes harmonic, but for (4U − 3A)/4U² k_BT of each translation
    let mev = 1e-6 * zeros.pinning[0].curved_mev.min(above.pinning[0].curved_mev);
    let prefactor = made(forward).htst.expect("a prefactor").hz_at(mev / K_B);
    let entropy = 0.5 * (bottom.log_determinant(0) - top.log_determinant(0));
    let harmonic = entropy.exp() * top.htst_frequency(0, &gyration) / (2.0 * PI);
    let more = |p: &Pinning| mev * (4.0 * p.curved_mev - 3.0 * p.top_mev) / (4.0 * p.curved_mev.powi(2));
    let [less, more] = [zeros, above].map(|z| z.pinning.iter().map(more).sum::<f64>());
    assert!((prefactor / harmonic - 1.0 + less - more).abs() < 1e-8, "{prefactor} {harmonic} {less} {more}");
    // cold enough, a minimum is one place
    let cold = solve(&film(&lattice, energy, [skyrmion, UP], 1e-4));
    assert!(made(rate(&cold, Way::Forward)).minimum_zeros.is_empty() && made(rate(&cold, Way::Forward)).htst.is_some());
}

#[test]
fn the_top_between_two_places_is_the_barrier_of_the_hop() {
    let energy = r#"{"exchange": {"J": ["1 meV"]}}, {"dmi": {"D": "0.6 meV", "kind": "interfacial"}},
        {"anisotropy": {"K": "0.1 meV", "axis": [0, 0, 1]}}, {"zeeman": {"B": ["0 T", "0 T", "2.6 T"]}}"#;
    let lattice = r#"{"square": {"cells": [10, 10], "periodic": true}}"#;
    let at = |x: usize| format!(r#"{{"skyrmion": {{"radius": 2, "center": [{x}, 5]}}}}"#);
    let [here, next] = [5, 6].map(at);
    let collapse = solve(&film(lattice, energy, [&here, UP], 5.0));
    let hop = solve(&film(lattice, energy, [&here, &next], 5.0));
    assert!(collapse.certified && hop.certified, "{:?}", hop.warnings);
    let pinning = made(rate(&collapse, Way::Forward)).minimum_zeros[0].pinning.clone();
    let barrier = hop.barrier.expect("a barrier").forward_mev;
    assert!(pinning.iter().all(|p| (p.top_mev / barrier - 1.0).abs() < 0.02), "{pinning:?} {barrier}");
}

#[derive(Deserialize)]
#[allow(non_snake_case)]
struct NineShells {
    barrier_meV: [f64; 2],
    htst_per_s: f64,
    langer_per_s: f64,
    skyrmion: Translations,
    saddle: Translations,
    ferromagnet_ln_determinant: f64,
}

#[derive(Deserialize)]
#[allow(non_snake_case)]
struct Translations {
    pinning_meV: [f64; 2],
    volume_rad: f64,
    ln_determinant: f64,
}

impl Translations {
    /// Whether these are its two translations.
    fn check(&self, zeros: &[ZeroModes]) {
        assert!(zeros.len() == 1 && zeros[0].count == 2 && zeros[0].kind == ZeroKind::Translation, "{zeros:?}");
        assert!((zeros[0].volume / self.volume_rad - 1.0).abs() < 1e-8, "{zeros:?}");
        // of the skyrmion nothing but rounding
        let near = |(found, own): (&f64, &f64)| (found - own).abs() < 1e-8 * own.max(1e-3);
        assert!(zeros[0].pinning.iter().map(|p| &p.curved_mev).zip(&self.pinning_meV).all(near), "{zeros:?}");
    }
}

#[test]
fn a_skyrmion_of_nine_shells_agrees_with_a_dense_computation_outside_of_this_program() {
    let expected: NineShells = serde_json::from_str(include_str!("reference/nine_shells.json")).unwrap();
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/pd_fe_ir111_skyrmion.json");
    let text = std::fs::read_to_string(&path).unwrap();
    let more = r#"{ "search": {"effort": "none"}, "rates": {"temperatures": ["60 K"], "damping": 0.3},"#;
    let problem = load_text(&path, text.replacen('{', more, 1)).unwrap().problem().unwrap();
    let outcome = solve(&problem);
    assert!(outcome.certified, "{:?}", outcome.warnings);
    let minima = [expected.skyrmion.ln_determinant, expected.ferromagnet_ln_determinant];
    for (side, way) in Way::BOTH.into_iter().enumerate() {
        let r = rate(&outcome, way);
        let barrier = r.barrier_mev.unwrap();
        assert!((barrier / expected.barrier_meV[side] - 1.0).abs() < 1e-10, "{barrier}");
        let entropy = 0.5 * (minima[side] - expected.saddle.ln_determinant);
        assert!((made(r).entropy_factor.unwrap() - entropy).abs() < 1e-8, "{:?} {entropy}", made(r).entropy_factor);
        let [htst, langer] = [made(r).htst, made(r).langer].map(|p| p.unwrap().frequency_per_s);
        assert!((htst / expected.htst_per_s - 1.0).abs() < 1e-8, "{htst}");
        assert!((langer / expected.langer_per_s - 1.0).abs() < 1e-8, "{langer}");
        expected.saddle.check(&made(r).saddle_zeros);
    }
    expected.skyrmion.check(&made(rate(&outcome, Way::Forward)).minimum_zeros);
    assert!(made(rate(&outcome, Way::Backward)).minimum_zeros.is_empty());
}

#[test]
fn saddles_of_walls_that_hop_do_not_slide_though_the_ring_repeats_and_k_bt_is_above_their_pinning() {
    let down = |from: usize, to: usize| {
        let up = |i: usize| [0.0, 0.0, if (from..to).contains(&i) { -1.0 } else { 1.0 }];
        Spins::from_vectors(&(0..10).map(up).collect::<Vec<_>>()).expect("unit vectors")
    };
    let ring = || {
        let mut ring = Build::ring(10);
        ring.terms[0] = Box::new(Exchange::uniform(&ring.lattice, &[2.0]));
        ring.easy(1.5).hard(0.3)
    };
    for to in [5, 6] {
        let outcome = solve(&with(ring().problem(down(2, to), down(2, to + 1)), settings(10, 2.0, 0.1, 12.0)));
        for r in outcome.rates.expect("rates").saddles {
            let slides = |z: &ZeroModes| z.kind == ZeroKind::Translation;
            assert!(made(&r).htst.is_some() && !made(&r).saddle_zeros.iter().any(slides), "{to}: {r:?}");
            assert!(made(&r).minimum_zeros.is_empty(), "{to}: {r:?}");
        }
    }
}

#[test]
fn two_translations_of_one_eigenvalue_are_both_found_wherever_the_state_stands() {
    let energy = r#"{"exchange": {"J": ["10 meV"]}}, {"dmi": {"D": "4 meV", "kind": "interfacial"}},
        {"anisotropy": {"K": "1.5 meV", "axis": [0, 0, 1]}}, {"zeeman": {"B": ["0 T", "0 T", "4 T"]}}"#;
    let lattice = r#"{"triangular": {"cells": [16, 16], "periodic": true}}"#;
    let found = ["[8, 4.3]", "[12, 6.9]", "[9.1, 5.5]"].map(|center| {
        let skyrmion = format!(r#"{{"skyrmion": {{"radius": 4, "center": {center}}}}}"#);
        let mut problem = film(lattice, energy, [&skyrmion, UP], 20.0);
        problem.search = Effort::None;
        let outcome = solve(&problem);
        assert!(outcome.certified, "{:?}", outcome.warnings);
        let saddles = outcome.saddles.iter().map(|s| s.above_initial_mev).enumerate();
        let collapse = saddles.max_by(|a, b| a.1.total_cmp(&b.1)).expect("a saddle").0;
        let of = |r: &&SaddleRate| r.saddle == collapse && r.way == Way::Forward;
        let rate = outcome.rates.as_ref().expect("rates").saddles.iter().find(of).expect("a rate");
        assert_eq!(
            made(rate).saddle_zeros.iter().map(|z| (z.kind, z.count)).collect::<Vec<_>>(),
            [(ZeroKind::Translation, 2)]
        );
        rate.ln_rate_per_s(Theory::Htst, 20.0).expect("a rate")
    });
    assert!(found.iter().all(|ln| (ln - found[0]).abs() < 1e-8), "{found:?}");
}

#[test]
fn a_state_that_wanders_between_the_edges_of_its_film_has_no_rate_and_what_comes_to_it_has_one() {
    let energy = r#"{"exchange": {"J": ["1 meV"]}}, {"anisotropy": {"K": "0.02 meV", "axis": [0, 0, 1]}},
        {"anisotropy": {"K": "-0.01 meV", "axis": [1, 0, 0]}}, {"anisotropy": {"K": "-0.004 meV", "axis": [0, 0, 1], "sites": {"box": {"from": [20, 0], "to": [20, 1]}}}}"#;
    let walls = r#"{"domain_wall": {"center": 20}}"#;
    let lattice = r#"{"square": {"cells": [41, 2]}}"#;
    let outcome = solve(&film(lattice, energy, [walls, UP], 3.0));
    assert!(outcome.certified, "{:?}", outcome.warnings);
    let why = refusal(&outcome, Theory::Htst);
    assert!(why.contains("a translation that nothing holds") && why.contains("does not repeat"), "{why}");
    // over the same saddle the uniform state is left at a rate that the wall's volume has no part in
    let back = rate(&outcome, Way::Backward).rows[0].ln_htst_per_s.expect("a rate");
    let [forward, backward] = [0, 1].map(|way| outcome.rates.as_ref().expect("rates").transitions[way].rows[0].clone());
    assert!(forward.passage.ln_htst_per_s.is_none() && forward.escape.ln_htst_per_s.is_none());
    assert_eq!((backward.passage.ln_htst_per_s, backward.escape.ln_htst_per_s), (Some(back), Some(back)));
    // of the whole reversal only the escape is known: by a wall from one of two edges; the wall has one place, the next saddle two
    let outcome = solve(&film(lattice, energy, [UP, DOWN], 3.0));
    assert!(outcome.certified && outcome.saddles.len() == 2, "{:?}", outcome.warnings);
    let whole = &outcome.rates.as_ref().expect("rates").transitions[0];
    assert!(whole.rows[0].passage.ln_htst_per_s.is_none() && whole.refused.is_some(), "{whole:?}");
    let escape = whole.rows[0].escape.ln_htst_per_s.expect("a rate");
    assert!((escape - back - f64::ln(2.0)).abs() < 1e-6, "{escape} {back}");
    let said = outcome.warnings.iter().filter(|w| w.contains("forward over saddle 1: the minimum before it"));
    assert_eq!(said.count(), 1, "{:?}", outcome.warnings);
}

#[test]
fn a_row_of_spins_that_are_all_but_alike_has_rates_along_whatever_direction_it_lies() {
    let energy = r#"{"exchange": {"J": ["3 meV"]}}, {"anisotropy": {"K": "0.8 meV", "axis": [0, 0, 1]}},
        {"anisotropy": {"K": "-0.2 meV", "axis": [1, 0, 0]}}, {"zeeman": {"B": ["0.01 T", "0 T", "0 T"], "sites": [0]}}"#;
    let lattices = [
        r#"{"chain": {"sites": 7}}"#,
        r#"{"square": {"cells": [7, 1]}}"#,
        r#"{"square": {"cells": [1, 7]}}"#,
        r#"{"cubic": {"cells": [1, 1, 7]}}"#,
    ];
    let found = lattices.map(|lattice| {
        let mut problem = film(lattice, energy, [UP, DOWN], 3.0);
        // each spin precesses at a speed of its own
        problem.rates.as_mut().unwrap().moments_mub = (0..7).map(|i| 1.0 + 0.3 * i as f64).collect();
        let outcome = solve(&problem);
        Theory::ALL.map(|theory| rate(&outcome, Way::Forward).ln_rate_per_s(theory, 3.0).expect(lattice))
    });
    for (of, lattice) in found.iter().zip(lattices) {
        assert!(of.iter().zip(&found[0]).all(|(a, b)| (a - b).abs() < 1e-9), "{lattice}: {of:?} {:?}", found[0]);
    }
}

#[test]
fn a_pair_of_opposite_dipoles_has_its_rates_along_whatever_direction_it_lies() {
    // the saddle's ring is about the easy axis, which is normal to the row; in the plane normal to the row dipoles single out no axis
    let unit = |v: [f64; 3]| vector::scale(1.0 / vector::norm(v), v);
    let easy = unit([0.29, 0.37, -0.88]);
    let rows = [[0.0, 0.88, 0.37], [-0.84, -0.33, -0.41], [1.0, 1.0, 1.0], [0.2, -0.9, 0.3]];
    let pair = |row: [f64; 3], easy: [f64; 3]| {
        let end = |sign: f64| {
            format!(r#"{{"uniform": {{"direction": {:?}, "staggered": true}}}}"#, vector::scale(sign, easy))
        };
        let energy = format!(
            r#"{{"anisotropy": {{"K": "3 meV", "axis": {easy:?}}}}}, {{"exchange": {{"J": ["-5 meV"]}}}}, {{"dipolar": {{}}}}"#
        );
        let lattice = format!(r#"{{"chain": {{"sites": 2, "spacing": "0.25 nm", "direction": {row:?}}}}}"#);
        let outcome = solve(&film(&lattice, &energy, [&end(1.0), &end(-1.0)], 8.0));
        rate(&outcome, Way::Forward).ln_rate_per_s(Theory::Langer, 8.0).expect("a rate")
    };
    let along_x = pair([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
    for row in rows {
        let across = unit(vector::sub(row, vector::scale(vector::dot(row, easy), easy)));
        let found = pair(across, easy);
        assert!((found - along_x).abs() < 1e-9, "{row:?}: {found} {along_x}");
    }
}

#[test]
fn a_crossing_along_a_ring_that_is_flat_by_accident_has_no_frequency() {
    let energy = r#"{"exchange": {"J": ["10 meV"]}}, {"dmi": {"D": "1 meV", "kind": "interfacial"}},
        {"anisotropy": {"K": "0.3 meV", "axis": [0, 0, 1]}}"#;
    let outcome = solve(&film(r#"{"square": {"cells": [6, 6], "periodic": true}}"#, energy, [UP, DOWN], 5.0));
    assert!(refusal(&outcome, Theory::Htst).contains("no frequency"), "{}", refusal(&outcome, Theory::Htst));
    assert!(rate(&outcome, Way::Forward).ln_rate_per_s(Theory::Langer, 5.0).is_some());
}

#[test]
fn the_lifetime_of_a_skyrmion_goes_smoothly_with_the_field() {
    let lives = [2.85, 2.95, 3.05, 3.15, 3.25].map(|tesla| {
        let energy = format!(
            r#"{{"exchange": {{"J": ["10 meV"]}}}}, {{"dmi": {{"D": "4 meV", "kind": "interfacial"}}}},
            {{"anisotropy": {{"K": "1 meV", "axis": [0, 0, 1]}}}}, {{"zeeman": {{"B": ["0 T", "0 T", "{} T"]}}}}"#,
            1.5 * tesla
        );
        let lattice = r#"{"square": {"cells": [20, 20], "periodic": true}}"#;
        let mut problem = film(lattice, &energy, [r#"{"skyrmion": {"radius": 4}}"#, UP], 30.0);
        problem.search = Effort::None;
        let outcome = solve(&problem);
        let row = &outcome.rates.as_ref().expect("rates").transitions[0].rows[0];
        row.passage.ln_lifetime_s().expect("a lifetime")
    });
    for three in lives.windows(3) {
        assert!((three[0] - 2.0 * three[1] + three[2]).abs() < 0.1, "{lives:?}");
    }
}

/// The stationary point of index two between two places of the saddle is 1.2113024 meV above it (Newton's method in NumPy); a minimum that is
/// wide against its lattice is held by a cosine, whose top is what its curvature says.
#[test]
fn the_top_half_way_is_that_of_the_point_between_two_places() {
    let film_of = |lattice: &str, dmi: f64, more: &str| {
        let energy = format!(
            r#"{{"exchange": {{"J": ["10 meV"]}}}}, {{"dmi": {{"D": "{dmi} meV", "kind": "interfacial"}}}}, {more}"#
        );
        let mut problem = film(lattice, &energy, [r#"{"skyrmion": {"radius": 4}}"#, UP], 30.0);
        problem.search = Effort::None;
        let outcome = solve(&problem);
        let regime = made(rate(&outcome, Way::Forward));
        [&regime.saddle_zeros, &regime.minimum_zeros].map(|zeros| zeros[0].pinning.clone())
    };
    let narrow = r#"{"zeeman": {"B": ["0 T", "0 T", "25 T"]}}"#;
    let [saddle, _] = film_of(r#"{"square": {"cells": [21, 21], "periodic": true}}"#, 6.0, narrow);
    for Pinning { top_mev, .. } in saddle {
        assert!((top_mev / 1.2113024 - 1.0).abs() < 0.1, "{top_mev}");
    }
    let wide = r#"{"anisotropy": {"K": "1.5 meV", "axis": [0, 0, 1]}}, {"zeeman": {"B": ["0 T", "0 T", "7.2 T"]}}"#;
    let [_, minimum] = film_of(r#"{"triangular": {"cells": [24, 24], "periodic": true}}"#, 4.0, wide);
    for Pinning { top_mev, curved_mev } in minimum {
        assert!((top_mev / curved_mev - 1.0).abs() < 0.05, "{top_mev} {curved_mev}");
    }
}

#[test]
fn two_bonds_round_a_periodic_film_have_the_rates_of_one_that_is_twice_as_strong() {
    let energy = |pairs: &str| {
        format!(
            r#"{{"exchange": {{"J": ["1.5 meV"]}}}}, {{"anisotropy": {{"K": "0.8 meV", "axis": [0, 0, 1]}}}},
               {{"anisotropy": {{"K": "-0.3 meV", "axis": [1, 0.5, 0]}}}}, {{"zeeman": {{"B": ["1 T", "0.4 T", "-0.5 T"]}}}},
               {{"anisotropy": {{"K": "0.3 meV", "axis": [0, 1, 1], "sites": [0]}}}}{pairs}"#
        )
    };
    let round = r#"{"square": {"cells": [5, 2], "periodic": [false, true]}}"#;
    let pairs = r#", {"pairs": {"bonds": [{"from": 0, "to": 0, "cell": [0, 1, 0], "J": "1.5 meV"}]}}"#;
    let ways = [(round, ""), (r#"{"square": {"cells": [5, 2]}}"#, pairs)];
    let [round, open] = ways.map(|(lattice, pairs)| {
        let outcome = solve(&film(lattice, &energy(pairs), [UP, DOWN], 3.0));
        Theory::ALL.map(|theory| rate(&outcome, Way::Forward).ln_rate_per_s(theory, 3.0).expect(lattice))
    });
    assert!(round.iter().zip(&open).all(|(a, b)| (a - b).abs() < 1e-9), "{round:?} {open:?}");
}

#[test]
fn a_nucleus_that_slides_has_no_rate_where_its_ring_is_all_but_regular() {
    let energy = |field: &str| {
        format!(
            r#"{{"exchange": {{"J": ["3 meV"]}}}}, {{"anisotropy": {{"K": "0.8 meV", "axis": [0, 0, 1]}}}},
               {{"anisotropy": {{"K": "-0.5 meV", "axis": [1, 0, 0]}}}}{field}"#
        )
    };
    let ring = r#"{"chain": {"sites": 9, "periodic": true}}"#;
    let outcome = solve(&film(ring, &energy(""), [UP, DOWN], 3.0));
    let zeros = &made(rate(&outcome, Way::Forward)).saddle_zeros;
    assert!(zeros.iter().any(|z| z.kind == ZeroKind::Translation), "{zeros:?}");
    // what holds it now is of no size beside k_BT, and says nothing of how far it slides
    let field = r#", {"zeeman": {"B": ["0 T", "0.0001 T", "0 T"], "sites": [0]}}"#;
    let outcome = solve(&film(ring, &energy(field), [UP, DOWN], 3.0));
    let why = refusal(&outcome, Theory::Htst);
    assert!(why.contains("the saddle has a translation that nothing holds"), "{why}");
}

#[test]
fn forward_and_backward_rates_are_in_detailed_balance() {
    let mut r = ChaCha8Rng::seed_from_u64(12);
    let mut checked = 0;
    while checked < 10 {
        let (problem, settings) = random_chain(&mut r, checked % 2 == 1);
        let problem = with(problem, settings.clone());
        let (outcome, h) = (solve(&problem), &problem.hamiltonian);
        if !outcome.certified || outcome.saddles.len() > 1 {
            continue;
        }
        checked += 1;
        let t = settings.temperatures_k[0];
        // F = E − k_BT Σ ln √(2π k_BT/ε), from the dense eigenvalues of both minima
        let ends = [0, outcome.path.images() - 1].map(|k| Dense::new(h, outcome.path.spins(k)));
        let difference_mev = h.difference_mev(ends[0].m.as_slice(), ends[1].m.as_slice());
        let entropy = 0.5 * (ends[0].log_determinant(0) - ends[1].log_determinant(0));
        // ln(k_f/k_b) = −(F_final − F_initial)/k_BT
        let expected = difference_mev / (K_B * t) + entropy;
        let row = |way: Way| rate(&outcome, way).rows[0].clone();
        let balance = |ln: fn(&spinneb::rates::Row) -> Option<f64>| {
            ln(&row(Way::Forward)).zip(ln(&row(Way::Backward))).map(|(f, b)| f - b)
        };
        let langer = balance(|r| r.ln_langer_per_s).expect("Langer");
        assert!((langer - expected).abs() < 1e-10 * expected.abs().max(1.0), "{langer} {expected}");
        if let Some(htst) = balance(|r| r.ln_htst_per_s) {
            assert!((htst - expected).abs() < 1e-10 * expected.abs().max(1.0), "{htst} {expected}");
        }
    }
}

#[test]
fn saddles_that_symmetry_makes_alike_are_counted() {
    let count = |problem: Problem, kelvin: f64| {
        let n = problem.hamiltonian.sites();
        let outcome = solve(&with(problem, settings(n, 2.0, 0.1, kelvin)));
        let r = rate(&outcome, Way::Forward);
        (made(r).equivalents.count, made(r).equivalents.by.clone())
    };
    // one spin goes through +y or −y
    assert_eq!(count(Build::open(1).easy(1.0).hard(0.5).reversal(), 5.0), (2, "m_y → −m_y".into()));
    // a wall enters from the left or the right, through +y or −y
    assert_eq!(count(Build::open(20).easy(0.05).hard(0.05).reversal(), 1.0).0, 4);
    // turned about z the two planes are one saddle with a zero mode
    assert_eq!(count(Build::open(20).easy(0.05).reversal(), 1.0), (2, "mirrored chain".into()));
    // over a defect next to one end a wall comes from either: what time reversal makes of the way there is the way back
    let (count_at_defect, by) = count(Build::open(20).easy(0.05).defect(2, -0.02).reversal(), 1.0);
    assert!(count_at_defect == 2 && by != "mirrored chain", "{by}");
    // in a field it does not
    let held = Build::open(20).easy(0.05).defect(2, -0.02).field([0.0, 0.0, -0.01]);
    assert_eq!(count(held.reversal(), 1.0), (1, "none found".into()));
    // a narrow nucleus on a ring can be at each of the 30 sites
    let (places, by) = count(Build::ring(30).easy(0.6).field([0.0, 0.0, -0.5]).reversal(), 1e-3);
    assert_eq!(places, 30, "{by}");
}

#[test]
fn a_nucleus_on_a_ring_counts_at_every_place_that_the_energy_and_the_ends_allow() {
    let paths = |problem: Problem| {
        let sites = problem.hamiltonian.sites();
        let outcome = solve(&with(problem, settings(sites, 2.0, 0.1, 1e-2)));
        outcome.rates.expect("rates").transitions[0].equivalents.clone()
    };
    // of an antiferromagnet, whose ends a shift by one site exchanges, and with m_z ↦ −m_z keeps: at each of 16 sites
    let mut antiferromagnet = Build::ring(16);
    antiferromagnet.terms[0] = Box::new(Exchange::uniform(&antiferromagnet.lattice, &[-1.0]));
    let neel = |sign: f64| {
        let up = |i: usize| [0.0, 0.0, if i.is_multiple_of(2) { sign } else { -sign }];
        Spins::from_vectors(&(0..16).map(up).collect::<Vec<_>>()).expect("unit vectors")
    };
    let found = paths(antiferromagnet.easy(0.5).problem(neel(1.0), neel(-1.0)));
    assert_eq!((found.count, found.by.as_str()), (16, "mirrored chain with m_z → −m_z, 8 shifts of the ring"));
    // every other site stronger: a pair of a strong and a weak spin, either one first, at 12 places
    let mut uneven = Build::ring(24).easy(0.6);
    for site in (0..24).step_by(2) {
        uneven = uneven.defect(site, 0.1);
    }
    let found = paths(uneven.reversal());
    assert_eq!((found.count, found.by.as_str()), (24, "mirrored chain, shifted by a site, 12 shifts of the ring"));
}

#[test]
fn a_nucleus_that_slides_freely_has_a_translation_for_a_zero_mode() {
    let k = 0.02;
    let problem = Build::ring(120).easy(k).field([0.0, 0.0, -k]).reversal();
    let outcome = solve(&with(problem, settings(120, 2.0, 0.1, 0.3)));
    let r = rate(&outcome, Way::Forward);
    let kinds: Vec<_> = made(r).saddle_zeros.iter().map(|z| z.kind).collect();
    assert_eq!(kinds, [ZeroKind::Rotation, ZeroKind::Translation], "{:?}", made(r).refused);
    let m = &outcome.saddles[0].spins;
    let slopes: f64 = (0..120)
        .map(|i| {
            let d = vector::sub(m.get((i + 1) % 120), m.get(i));
            vector::dot(d, d)
        })
        .sum();
    let volume = made(r).saddle_zeros[1].volume;
    // differences over a whole site miss (δ'^2)/12 of the slope
    assert!((volume / (120.0 * slopes.sqrt()) - 1.0).abs() < 0.02, "{volume} {slopes}");
    assert_eq!(made(r).equivalents.count, 1, "{}", made(r).equivalents.by);
    assert_eq!(made(r).langer.expect("Langer").exponent, -1.0);
}

#[test]
fn a_chain_of_minima_is_crossed_at_the_rate_of_its_mean_first_passage() {
    // two equal hops of a wall pinned at three sites: from the middle it goes either way
    let chain = || Build::between_walls(21).easy(0.1).hard(0.1).defect(5, -0.02).defect(11, -0.02).defect(17, -0.02);
    let build = chain();
    let width = (0.5f64 / 0.1).sqrt();
    let (a, b) = (build.wall(5.0, width, Direction::Y), build.wall(17.0, width, Direction::Y));
    let outcome = solve(&with(build.problem(a, b), settings(23, 2.0, 0.2, 0.01)));
    assert!(outcome.certified, "{:?}", outcome.warnings);
    let rates = outcome.rates.as_ref().expect("rates");
    let n = outcome.saddles.len();
    assert!(n >= 2, "{n} saddles");
    let ln = |way: Way, k: usize| {
        let r = rates.saddles.iter().find(|r| r.way == way && r.saddle == k).expect("a saddle");
        r.rows[0].ln_langer_per_s.expect("Langer")
    };
    // solved as equations for the mean times
    let (mut step, mut total) = (0.0, 0.0);
    assert_eq!(rates.transitions[0].equivalents.count, 1);
    for k in 0..n {
        let back = if k == 0 { 0.0 } else { ln(Way::Backward, k - 1).exp() };
        step = (1.0 + back * step) / ln(Way::Forward, k).exp();
        total += step;
    }
    let whole = &rates.transitions[0];
    assert_eq!((whole.way, whole.saddles), (Way::Forward, n));
    let found = whole.rows[0].passage.ln_langer_per_s.expect("Langer");
    assert!((found + f64::ln(total)).abs() < 1e-10, "{found} {total}");
    // leaving the first minimum is the first saddle's matter alone
    let escape = whole.rows[0].escape.ln_langer_per_s.expect("Langer");
    assert!((escape - ln(Way::Forward, 0)).abs() < 1e-12 && escape > found + 0.1, "{escape} {found}");
    assert!(whole.blocking_k[0] > whole.blocking_k[1] && whole.blocking_k[1] > Some(0.0));
}

/// Why the first saddle has no rate by a theory.
fn refusal(outcome: &Outcome, theory: Theory) -> String {
    let r = rate(outcome, Way::Forward);
    let found = made(r).refused.iter().find(|(t, _)| *t == theory).map(|(_, reason)| reason.to_string());
    found.unwrap_or_else(|| panic!("{} was not refused", theory.name()))
}

#[test]
fn a_saddle_without_a_certificate_has_no_rate() {
    let mut problem = with(Build::open(3).easy(0.5).hard(0.5).reversal(), settings(3, 2.0, 0.1, 10.0));
    problem.certify = false;
    let outcome = solve(&problem);
    for theory in Theory::ALL {
        assert!(refusal(&outcome, theory).contains("not certified"), "{}", refusal(&outcome, theory));
    }
    let whole = &outcome.rates.as_ref().expect("rates").transitions[0];
    assert!(
        whole.refused.is_some()
            && whole.rows.iter().all(|r| r.passage.ln_lifetime_s().is_none() && r.escape.ln_lifetime_s().is_none())
    );
}

#[test]
fn a_saddle_of_higher_index_has_no_rate() {
    // held to the coherent rotation by its symmetry, a long chain passes a saddle of index 3
    let mut problem = with(Build::open(20).easy(0.05).hard(0.05).reversal(), settings(20, 2.0, 0.1, 10.0));
    problem.guess = Some(serde_json::from_str(r#"{"geodesic": {"axis": [1, 0, 0]}}"#).expect("a guess"));
    let state = |v: [f64; 3]| Spins::from_vectors(&vec![v; 20]).expect("unit vectors");
    let h = &problem.hamiltonian;
    let top = spinneb::stationary::State::at(h.into(), state([0.0, 1.0, 0.0]).as_slice().to_vec());
    let spectrum = spinneb::stationary::Spectrum::of(h.into(), &top, 6);
    assert!(spectrum.negative > 1);
    let minima = [state([0.0, 0.0, 1.0]), state([0.0, 0.0, -1.0])];
    let spectra = minima.clone().map(|m| spinneb::landscape::Minimum::examine(h.into(), &m).spectrum);
    let valley: Vec<f64> = (0..60).map(|k| if k / 20 == 2 { 1.0 } else { 0.0 }).collect();
    let crossing = spinneb::rates::Crossing {
        saddle: &top,
        valley: &valley,
        spectrum: &spectrum,
        minima: [&minima[0], &minima[1]],
        minima_spectra: [&spectra[0], &spectra[1]],
        symmetry: &spinneb::rates::Symmetry::exactly(&spinneb::symmetry::Group::of(h, minima[0].as_slice(), &[])),
        doubt: None,
    };
    let [forward, backward] =
        spinneb::rates::saddle_rates(h.into(), 0, &crossing, problem.rates.as_ref().expect("rates"));
    for r in [forward, backward] {
        assert!(made(&r).htst.is_none() && made(&r).langer.is_none());
        assert!(
            made(&r).refused.len() == 2
                && made(&r).refused.iter().all(|(_, why)| why.to_string().contains("negative modes")),
            "{:?}",
            made(&r).refused
        );
    }
}

#[test]
fn without_damping_a_conserved_moment_forbids_the_crossing() {
    let outcome = |damping| solve(&with(Build::open(4).easy(0.2).reversal(), settings(4, 2.0, damping, 5.0)));
    let damped = outcome(0.1);
    assert!(refusal(&damped, Theory::Htst).contains("conserved"));
    assert!(made(rate(&damped, Way::Forward)).langer.is_some());
    let undamped = outcome(0.0);
    for theory in Theory::ALL {
        assert!(refusal(&undamped, theory).contains("conserved"));
    }
    // coherent rotation of a uniaxial chain: λ₊ = α γ/μ 2K/(1 + α²), a zero mode of volume 2π √N
    let (n, k, alpha) = (4.0, 0.2, 0.1);
    let growth = alpha * 2.0 * k / (1.0 + alpha * alpha) * unit_hz(2.0);
    let langer = made(rate(&damped, Way::Forward)).langer.expect("Langer");
    assert!((langer.frequency_per_s / growth - 1.0).abs() < 1e-12, "{} {growth}", langer.frequency_per_s);
    assert!((made(rate(&damped, Way::Forward)).saddle_zeros[0].volume - 2.0 * PI * f64::sqrt(n)).abs() < 1e-12);
    assert_eq!(langer.exponent, -0.5);
}

#[test]
fn a_néel_chain_of_no_total_moment_may_cross_without_damping() {
    let n = 6;
    let chain = Chain::open(n).resolve().unwrap();
    let terms: Vec<Box<dyn spinneb::energy::EnergyTerm>> =
        vec![Box::new(Exchange::uniform(&chain, &[-1.0])), Box::new(Anisotropy::uniform(n, 0.1, Direction::Z))];
    let h = Hamiltonian::new(&chain, terms).expect("a chain");
    let state = |s: f64| {
        let v: Vec<[f64; 3]> = (0..n).map(|i| [0.0, 0.0, if i % 2 == 0 { s } else { -s }]).collect();
        Spins::from_vectors(&v).expect("unit vectors")
    };
    let outcome = solve(&with(Problem::new(h, state(1.0), state(-1.0)), settings(n, 2.0, 0.1, 5.0)));
    let r = rate(&outcome, Way::Forward);
    assert!(made(r).htst.is_some() && made(r).langer.is_some(), "{:?}", made(r).refused);
}

#[test]
fn low_barriers_and_weak_damping_are_warned_of_with_a_range() {
    let problem = Build::open(1).easy(1.0).hard(0.5).reversal();
    let outcome = solve(&with(problem, settings(1, 2.0, 0.01, 1.0 / (3.0 * K_B))));
    let said = rate(&outcome, Way::Forward).warnings.join("\n");
    assert!(said.contains("below 5 k_BT") && said.contains("within a factor of about 1.33"), "{said}");
    assert!(said.contains("where damping times ΔE/k_BT is small") && said.contains("about 0.025 times"), "{said}");
    let cold = solve(&with(Build::open(1).easy(1.0).hard(0.5).reversal(), settings(1, 2.0, 0.5, 1.0 / (20.0 * K_B))));
    assert_eq!(rate(&cold, Way::Forward).warnings, Vec::<String>::new());
}

#[test]
fn walls_that_enter_a_chain_at_either_end_and_turn_either_way_are_four_paths() {
    // walls of little more than a site, which stop at every site on their way
    let outcome = solve(&with(Build::open(8).easy(0.4).hard(0.1).reversal(), settings(8, 2.0, 0.2, 0.5)));
    assert!(outcome.certified && outcome.saddles.len() > 1, "{:?}", outcome.warnings);
    let rates = outcome.rates.as_ref().expect("rates");
    assert!(rates.transitions.iter().all(|t| t.equivalents.count == 4), "{:?}", rates.transitions[0].equivalents);
    let [f, b] = [0, 1].map(|k| rates.transitions[k].rows[0].passage.ln_langer_per_s.expect("Langer"));
    assert!((f - b).abs() < 1e-9, "{f} {b}");
}

#[test]
fn the_determinant_of_a_hundred_thousand_spins_is_the_product_of_its_spin_waves() {
    let n = 100_000;
    let (easy, hard) = (0.05, 0.02);
    let problem = Build::open(n).easy(easy).hard(hard).reversal();
    let state = spinneb::stationary::State::at((&problem.hamiltonian).into(), problem.initial.as_slice().to_vec());
    let found = spinneb::rates::log_determinant(&state.hessian, &[], 1.0);
    // free ends: 2K + 2J (1 − cos(πk/N)), and the same with the hard axis on top
    let wave = |k: usize| 4.0 * (PI * k as f64 / (2 * n) as f64).sin().powi(2) + 2.0 * easy;
    let logs: Vec<f64> = (0..n).map(|k| wave(k).ln() + (wave(k) + 2.0 * hard).ln()).collect();
    let expected = spinneb::linalg::slab::sum(&logs);
    assert!((found - expected).abs() < 1e-8, "{found} {expected}");
}

/// Three pinning sites; the frozen ends draw the wall into the middle one, the deepest.
fn deep_in_the_middle(temperatures_k: Vec<f64>) -> Problem {
    let chain = || Build::between_walls(21).easy(0.1).hard(0.1).defect(5, -0.02).defect(11, -0.02).defect(17, -0.02);
    let build = chain();
    let width = (0.5f64 / 0.1).sqrt();
    let (a, b) = (build.wall(5.0, width, Direction::Y), build.wall(17.0, width, Direction::Y));
    let settings = RateSettings { temperatures_k, ..settings(23, 2.0, 0.2, 0.1) };
    with(build.problem(a, b), settings)
}

#[test]
fn the_time_to_the_other_end_goes_with_the_highest_climb_and_not_with_the_barrier() {
    let (cold, colder) = (0.005, 0.004);
    let outcome = solve(&deep_in_the_middle(vec![cold, colder]));
    assert!(outcome.certified && outcome.saddles.len() == 2, "{} saddles", outcome.saddles.len());
    let (barrier, climb) = (outcome.barrier.expect("a barrier"), outcome.highest_climb.expect("a climb"));
    let deep = outcome.intermediate_minima[0].state.energy_mev - outcome.initial.energy_mev;
    let closed = [outcome.saddles[1].above_initial_mev - deep, outcome.saddles[0].above_initial_mev - deep];
    assert!((climb.forward_mev - closed[0]).abs() < 1e-12, "{climb:?} {closed:?}");
    assert!((climb.backward_mev - closed[1].max(barrier.backward_mev)).abs() < 1e-12, "{climb:?} {closed:?}");
    assert!(climb.forward_mev > 1.5 * barrier.forward_mev, "{climb:?} {barrier:?}");
    let ways = [(barrier.forward_mev, climb.forward_mev), (barrier.backward_mev, climb.backward_mev)];
    let deeper = ways.iter().filter(|(barrier, climb)| *climb > barrier + K_B * cold).count();
    let said = outcome.warnings.iter().filter(|w| w.contains("leads through a minimum")).count();
    assert!(deeper > 0 && said == deeper, "{:?}", outcome.warnings);
    for (t, climb) in outcome.rates.expect("rates").transitions.iter().zip([climb.forward_mev, climb.backward_mev]) {
        let [near, far] = [0, 1].map(|k| t.rows[k].passage.ln_lifetime_s().expect("a time"));
        let slope = (far - near) / (1.0 / (K_B * colder) - 1.0 / (K_B * cold));
        assert!((slope / climb - 1.0).abs() < 1e-3, "{slope} {climb}");
        // the escape goes with the first saddle
        let [near, far] = [0, 1].map(|k| t.rows[k].escape.ln_lifetime_s().expect("a time"));
        let slope = (far - near) / (1.0 / (K_B * colder) - 1.0 / (K_B * cold));
        assert!((slope / t.rows[0].escape.barrier_over_kt / (K_B * cold) - 1.0).abs() < 1e-9, "{slope}");
    }
}

#[test]
fn paths_that_symmetry_makes_alike_are_one_network() {
    // walls enter at either end and turn either way; each of the four kinds of minima on the way is one of four alike
    let outcome = solve(&with(Build::open(8).easy(0.4).hard(0.1).reversal(), settings(8, 2.0, 0.2, 0.5)));
    let rates = outcome.rates.as_ref().expect("rates");
    let n = outcome.saddles.len();
    let ln = |way: Way, k: usize| {
        let r = rates.saddles.iter().find(|r| r.way == way && r.saddle == k).expect("a saddle");
        assert_eq!(made(r).equivalents.count, 1);
        r.ln_rate_per_s(Theory::Langer, 0.5).expect("Langer").exp()
    };
    // all 4 (n − 1) + 2 minima, and the equations of the mean times to the last one, solved by elimination
    let size = 4 * (n - 1) + 1;
    let state = |path: usize, k: usize| if k == 0 { 0 } else { 1 + path * (n - 1) + k - 1 };
    let mut q = vec![0.0; size * size];
    for path in 0..4 {
        for k in 0..n {
            let (from, f, b) = (state(path, k), ln(Way::Forward, k), ln(Way::Backward, k));
            q[from * size + from] -= f;
            if k + 1 < n {
                let to = state(path, k + 1);
                q[from * size + to] += f;
                q[to * size + to] -= b;
                q[to * size + from] += b;
            }
        }
    }
    let times = spinneb::linalg::solve_dense(&q, &vec![-1.0; size], size).expect("a solution");
    let row = &rates.transitions[0].rows[0];
    let found = row.passage.ln_lifetime_s().expect("a time").exp();
    assert!((found / times[0] - 1.0).abs() < 1e-9, "{found} {}", times[0]);
    let escape = row.escape.ln_lifetime_s().expect("a time").exp();
    assert!((escape * 4.0 * ln(Way::Forward, 0) - 1.0).abs() < 1e-12);
}

#[test]
fn below_one_kt_there_is_no_rate_and_the_prefactor_stays() {
    let barrier = 1.0;
    let temperatures_k = [0.999, 1.001].map(|delta| barrier / (delta * K_B)).to_vec();
    let settings = RateSettings { temperatures_k, ..settings(1, 2.0, 0.3, 1.0) };
    let outcome = solve(&with(Build::open(1).easy(barrier).hard(0.5).reversal(), settings));
    let rates = outcome.rates.as_ref().expect("rates");
    for (rows, prefactor) in
        rates.saddles.iter().map(|r| (r.rows.clone(), made(r).langer.is_some() && made(r).htst.is_some()))
    {
        assert!(prefactor);
        assert!(rows[0].ln_htst_per_s.is_none() && rows[0].ln_lifetime_s().is_none() && rows[0].known_within.is_none());
        assert!(rows[0].reason.as_ref().expect("a reason").contains("below 1 k_BT"), "{:?}", rows[0].reason);
        assert!(rows[1].ln_htst_per_s.is_some() && rows[1].ln_lifetime_s().is_some() && rows[1].reason.is_none());
        assert!(rows[1].known_within.expect("a range") > 2.0);
    }
    for t in &rates.transitions {
        assert!(t.refused.is_none() && t.rows[0].passage.ln_lifetime_s().is_none());
        assert!(t.rows[1].passage.ln_lifetime_s().is_some() && t.rows[1].escape.ln_lifetime_s().is_some());
    }
}

#[test]
fn tunnelling_takes_over_where_the_closed_form_of_one_spin_says() {
    let kelvin = |k: f64, hard: f64, moment: f64, damping: f64| {
        let outcome = solve(&with(Build::open(1).easy(k).hard(hard).reversal(), settings(1, moment, damping, 1.0)));
        rate(&outcome, Way::Forward).crossover_k.expect("a temperature")
    };
    // a moment of n μ_B with g = 2 is a spin of n/2: k_B T = √(K K_hard)/(π S)
    for (k, hard, moment) in [(1.0, 0.5, 2.0), (0.3, 5.0, 20.0)] {
        let closed = f64::sqrt(k * hard) / (PI * 0.5 * moment * K_B);
        assert!((kelvin(k, hard, moment, 0.0) / closed - 1.0).abs() < 1e-12);
        // damping slows the soft direction down: ε₂ > |ε₁| lowers λ₊, ε₂ < |ε₁| raises it
        assert_eq!(kelvin(k, hard, moment, 0.1) < closed, hard > k);
        // a damping so large that precession is nothing: λ₊ = (γ/μ) 2K/α
        let (alpha, unit) = (1e6, HBAR * 1e-12 * unit_hz(moment));
        let overdamped = 2.0 * k * unit / (alpha * 2.0 * PI * K_B);
        assert!((kelvin(k, hard, moment, alpha) / overdamped - 1.0).abs() < 1e-6);
    }
    // the moment along z is conserved: no way through
    let uniaxial = solve(&with(Build::open(4).easy(0.2).reversal(), settings(4, 2.0, 0.1, 5.0)));
    let r = rate(&uniaxial, Way::Forward);
    assert!(r.crossover_k.is_none() && made(r).langer.is_some());
}

#[test]
fn a_state_beside_a_saddle_that_is_no_minimum_has_no_rate() {
    let problem = with(Build::open(1).easy(1.0).hard(0.5).reversal(), settings(1, 2.0, 0.3, 1.0));
    let h = &problem.hamiltonian;
    let state = |v: [f64; 3]| Spins::from_vectors(&[v]).expect("a unit vector");
    let top = spinneb::stationary::State::at(h.into(), state([0.0, 1.0, 0.0]).as_slice().to_vec());
    let spectrum = spinneb::stationary::Spectrum::of(h.into(), &top, 2);
    let refused = |before: [f64; 3]| {
        let minima = [state(before), state([0.0, 0.0, -1.0])];
        let spectra = minima.clone().map(|m| spinneb::landscape::Minimum::examine(h.into(), &m).spectrum);
        let crossing = spinneb::rates::Crossing {
            saddle: &top,
            valley: &[0.0, 0.0, 1.0],
            spectrum: &spectrum,
            minima: [&minima[0], &minima[1]],
            minima_spectra: [&spectra[0], &spectra[1]],
            symmetry: &spinneb::rates::Symmetry::exactly(&spinneb::symmetry::Group::of(h, minima[0].as_slice(), &[])),
            doubt: None,
        };
        let [forward, _] = spinneb::rates::saddle_rates(h.into(), 0, &crossing, problem.rates.as_ref().expect("rates"));
        assert_eq!(made(&forward).refused.is_empty(), forward.rows[0].ln_lifetime_s().is_some());
        made(&forward).refused.first().map(|(_, why)| why.to_string())
    };
    assert_eq!(refused([0.0, 0.0, 1.0]), None);
    // an end kept on a slope, and one on top of the hard axis
    let tilted = refused([0.0, 0.6, 0.8]).expect("a reason");
    assert!(tilted.contains("the state before the saddle is no minimum: a torque of"), "{tilted}");
    let hard = refused([1.0, 0.0, 0.0]).expect("a reason");
    assert!(hard.contains("no minimum: it has 2 descending modes"), "{hard}");
}

#[test]
fn stored_states_give_the_rates_of_the_run_and_must_prove_themselves() {
    let problem = with(Build::open(8).easy(1.2).hard(0.1).reversal(), settings(8, 2.0, 0.2, 0.5));
    let outcome = solve(&problem);
    let last = outcome.path.images() - 1;
    let mut minima = vec![outcome.path.spins(0)];
    minima.extend(outcome.intermediate_minima.iter().map(|m| m.spins.clone()));
    minima.push(outcome.path.spins(last));
    let (h, settings) = (&problem.hamiltonian, problem.rates.as_ref().expect("settings"));
    let again = |saddles: &[spinneb::drive::SaddlePoint], minima: &[Spins]| {
        spinneb::drive::stored_rates(h.into(), saddles, minima, settings)
    };
    let (found, run) = (again(&outcome.saddles, &minima).expect("rates"), outcome.rates.as_ref().expect("rates"));
    assert!(outcome.saddles.len() > 2 && found.saddles.len() == run.saddles.len(), "{}", outcome.saddles.len());
    for (a, b) in found.transitions.iter().zip(&run.transitions) {
        for pick in [
            |t: &spinneb::rates::TransitionRow| t.passage.clone(),
            |t: &spinneb::rates::TransitionRow| t.escape.clone(),
        ] {
            let [a, b] = [a, b].map(|t| pick(&t.rows[0]).ln_lifetime_s().expect("a time"));
            assert!((a - b).abs() < 1e-9, "{a} {b}");
        }
        assert_eq!(a.equivalents, b.equivalents);
    }
    // a saddle of which a spin was turned, two saddles exchanged, a minimum less, a minimum that is a saddle
    let turned = |k: usize| {
        let mut saddles = outcome.saddles.clone();
        let mut v = saddles[k].spins.vectors();
        v[3] = vector::add(v[3], [0.0, 1e-4, 1e-4]);
        saddles[k].spins = Spins::from_vectors(&v).expect("unit vectors");
        saddles
    };
    let why = |r: Result<spinneb::rates::Rates, String>| r.expect_err("a reason");
    assert!(why(again(&turned(1), &minima)).starts_with("saddle 1: a torque of"));
    let mut exchanged = outcome.saddles.clone();
    exchanged.swap(0, 1);
    (exchanged[0].above_initial_mev, exchanged[1].above_initial_mev) =
        (outcome.saddles[0].above_initial_mev, outcome.saddles[1].above_initial_mev);
    assert!(why(again(&exchanged, &minima)).contains("summary.json says otherwise"));
    assert!(why(again(&outcome.saddles, &minima[1..])).contains("do not lie between"));
    minima[1] = outcome.saddles[0].spins.clone();
    assert!(why(again(&outcome.saddles, &minima)).starts_with("saddle 0: "));
}

#[test]
fn a_square_thin_cell_lives_as_long_as_a_spin_with_an_easy_axis_of_its_barrier() {
    let config = r#"{
      "material": {"name": "thin cell", "source": "this test", "Ms": "1 MA/m",
        "energy": [{"exchange": {"A": "15 pJ/m"}}, {"anisotropy": {"K": "0.8 MJ/m^3", "axis": [0, 0, 1]}}, {"demag": {}}]},
      "lattice": {"chain": {"sites": 1, "spacing": "20 nm", "cross_section": ["20 nm", "1.2 nm"]}},
      "initial": {"uniform": {"direction": [0, 0, 1]}},
      "final": {"uniform": {"direction": [0, 0, -1]}},
      "rates": {"temperatures": ["300 K"], "damping": 0.1}
    }"#;
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("cell.json");
    std::fs::write(&path, config).expect("a config");
    let cell = solve(&spinneb::config::load(&path, &[]).expect("a config").problem().expect("a problem"));
    assert!(cell.certified && cell.saddles[0].zero_modes == Some(1), "{:?}", cell.warnings);
    let barrier = cell.barrier.expect("a barrier").forward_mev;
    // Ms V in μ_B, CODATA 2022
    let moment = 1e6 * 20e-9 * 20e-9 * 1.2e-9 / 9.2740100657e-24;
    let spin = solve(&with(Build::open(1).easy(barrier).reversal(), settings(1, moment, 0.1, 300.0)));
    let [cell, spin] =
        [&cell, &spin].map(|outcome| made(rate(outcome, Way::Forward)).langer.expect("Langer").hz_at(300.0));
    assert!((cell / spin - 1.0).abs() < 1e-9, "{cell} {spin}");
}

#[test]
fn a_network_of_all_places_of_a_skyrmion_says_what_its_path_says() {
    // in the lower field it rests between the atoms: two places for each of them, and half as many saddles as places
    for (tesla, places, kelvin) in [(5.5, 144, 0.5), (4.8, 288, 0.7)] {
        let text = format!(
            r#"{{"material": {{"name": "skyrmion", "moment": "1 mu_B", "energy": [{{"exchange": {{"J": ["1 meV", "1 meV"]}}}},
            {{"dmi": {{"D": "1 meV", "kind": "interfacial"}}}}]}}, "energy": [{{"zeeman": {{"B": ["0 T", "0 T", "{tesla} T"]}}}}],
            "lattice": {{"triangular": {{"cells": [12, 12], "periodic": true}}}}, "initial": {{"skyrmion": {{"radius": 3}}}},
            "final": {{"uniform": {{"direction": [0, 0, 1]}}}}, "rates": {{"temperatures": ["{kelvin} K"], "damping": 1}},
            "landscape": {{"effort": "quick", "energy_window": "41 meV"}}}}"#
        );
        let loaded = load_text("skyrmion.json".as_ref(), text).unwrap();
        let outcome = solve(&loaded.problem().unwrap());
        let escape = &outcome.rates.as_ref().unwrap().transitions[0].rows[0].escape;
        let mut ways_there: Vec<[f64; 2]> = Vec::new();
        // every place by itself, and all that translations make of one as one
        for (images, minima) in [(IMAGES, 1 + places), (1, 1 + places / 144)] {
            let mut asked = loaded.survey().unwrap();
            asked.images = images;
            let found = survey(&asked, &mut Silent).unwrap();
            assert!(found.is_whole() && found.has_places() == (images == 1));
            assert_eq!(found.minima.len(), minima);
            assert_eq!(found.minimum_kinds.iter().map(|kind| kind.multiplicity).sum::<usize>(), 1 + places);
            let rows = &found.lifetimes.as_ref().unwrap().rows;
            let row =
                |from: &str, to: Option<&str>| rows.iter().find(|r| r.from == from && r.to.as_deref() == to).unwrap();
            for to in [None, Some("minimum 0")] {
                let times = row("minimum 1", to).ln_time_s.map(Option::unwrap);
                for (time, rate) in times.into_iter().zip([escape.ln_htst_per_s, escape.ln_langer_per_s]) {
                    assert!((time + rate.unwrap()).abs() < 1e-8, "{tesla} T: {time} {escape:?}");
                }
            }
            // from the state without one over each of the places
            ways_there.push(row("minimum 0", None).ln_time_s.map(Option::unwrap));
            if minima > 2 {
                let hop = row("minimum 1", Some("minimum 2"));
                assert!(hop.ln_time_s == [None, None] && hop.reason.as_ref().unwrap().contains("one state"), "{hop:?}");
            }
        }
        let [each, one] = ways_there[..] else { panic!("{ways_there:?}") };
        assert!(each.iter().zip(one).all(|(each, one)| (each - one).abs() < 1e-9), "{tesla} T: {each:?} {one:?}");
    }
}

/// Without a field time reversal makes each end the other, and of a wall that comes from one edge one that comes from the other.
#[test]
fn the_way_back_of_what_time_reversal_makes_is_another_way_there() {
    for (sites, saddles, cant) in [(10, 2, -0.46), (1, 1, 0.0)] {
        let text = format!(
            r#"{{"material": {{"name": "tilted", "moment": "2 mu_B", "energy": [{{"exchange": {{"J": ["3.79 meV"]}}}},
            {{"anisotropy": {{"K": "0.489 meV", "axis": [0.2, {cant}, 1]}}}}, {{"dmi": {{"D": "1.136 meV", "kind": "interfacial"}}}},
            {{"anisotropy": {{"K": "-0.111 meV", "axis": [1, -0.24, 0.3]}}}}, {{"cubic_anisotropy": {{"K": "0.1 meV", "axes": [[1, 2, 2], [2, 1, -2]]}}}}]}},
            "lattice": {{"chain": {{"sites": {sites}}}}}, "initial": {{"uniform": {{"direction": [0, 0, 1]}}}},
            "final": {{"uniform": {{"direction": [0, 0, -1]}}}}, "rates": {{"temperatures": ["1 K"]}}, "landscape": {{}}}}"#
        );
        let loaded = load_text("tilted.json".as_ref(), text).unwrap();
        let outcome = solve(&loaded.problem().unwrap());
        assert_eq!(outcome.saddles.len(), saddles);
        let [forward, backward] = &outcome.rates.as_ref().unwrap().transitions[..] else { panic!() };
        let found = survey(&loaded.survey().unwrap(), &mut Silent).unwrap();
        let rows = &found.lifetimes.as_ref().unwrap().rows;
        let row = rows.iter().find(|r| r.from == "minimum 0" && r.to.as_deref() == Some("minimum 1")).unwrap();
        for way in [forward, backward] {
            let passage = &way.rows[0].passage;
            for (time, rate) in row.ln_time_s.into_iter().zip([passage.ln_htst_per_s, passage.ln_langer_per_s]) {
                assert!((time.unwrap() + rate.unwrap()).abs() < 1e-3, "{sites}: {time:?} {rate:?} {row:?}");
            }
        }
    }
}

/// A cube's easy axis is left for four others over saddles of one height, and the path leads to one of them.
#[test]
fn saddles_beside_the_path_are_told_and_warned_of_where_they_are_no_higher() {
    let cube = |more: &str, end: &str| {
        let text = format!(
            r#"{{"material": {{"name": "cube", "moment": "2 mu_B", "energy": [{{"cubic_anisotropy": {{"K": "60 meV"}}}}{more}]}},
            "lattice": {{"chain": {{"sites": 1}}}}, "initial": {{"uniform": {{"direction": [0, 0, 1]}}}},
            "final": {{"uniform": {{"direction": {end}}}}}, "rates": {{"temperatures": ["20 K"], "damping": 0.1}}}}"#
        );
        let outcome = solve(&load_text("cube.json".as_ref(), text).unwrap().problem().unwrap());
        let said = outcome.warnings.iter().filter(|w| w.contains("over other saddles too")).count();
        (outcome.search.lowest_exits_mev, said, outcome.saddles.len())
    };
    // the four ways to the opposite side are one path's, which symmetry makes and the rates count
    assert_eq!(cube("", "[0, 0, -1]"), ([None; 2], 0, 2));
    let (exits, said, _) = cube("", "[1, 0, 0]");
    assert!(exits.iter().all(|exit| (exit.unwrap() - 15.0).abs() < 1e-9) && said == 2, "{exits:?} {said}");
    // a hard axis y holds the ways by y back, those to the other side over ±x are left
    let (exits, said, _) = cube(r#", {"anisotropy": {"K": "-20 meV", "axis": [0, 1, 0]}}"#, "[1, 0, 0]");
    assert!(exits.iter().all(|exit| (exit.unwrap() - 15.0).abs() < 1e-9) && said == 2, "{exits:?} {said}");
    // what is one state at a high temperature is several at a low one, and told of all the same
    let wells = |temperatures: &str| {
        let text = format!(
            r#"{{"material": {{"name": "wells", "moment": "2 mu_B", "energy": [{{"anisotropy": {{"K": "0.4 meV", "axis": [0, 0, 1]}}}},
            {{"cubic_anisotropy": {{"K": "-2 meV"}}}}]}}, "lattice": {{"chain": {{"sites": 1}}}}, "initial": {{"uniform": {{"direction":
            [1, 1, 1.5]}}}}, "final": {{"uniform": {{"direction": [-1, 1, -1.5]}}}}, "rates": {{"temperatures": {temperatures}}}}}"#
        );
        let outcome = solve(&load_text("wells.json".as_ref(), text).unwrap().problem().unwrap());
        let said = outcome.warnings.iter().filter(|w| w.contains("over other saddles too")).count();
        (outcome.search.lowest_exits_mev, said)
    };
    assert!(wells(r#"["0.1 K"]"#).1 == 2);
    assert_eq!(wells(r#"["0.1 K"]"#), wells(r#"["0.1 K", "1.3 K"]"#));
    // one spin with two minima has no others
    let text = r#"{"material": {"name": "one", "moment": "2 mu_B", "energy": [{"anisotropy": {"K": "9 meV", "axis": [0, 0, 1]}},
        {"anisotropy": {"K": "-3 meV", "axis": [1, 0, 0]}}]}, "lattice": {"chain": {"sites": 1}},
        "initial": {"uniform": {"direction": [0, 0, 1]}}, "final": {"uniform": {"direction": [0, 0, -1]}},
        "rates": {"temperatures": ["20 K"]}}"#;
    let outcome = solve(&load_text("one.json".as_ref(), text.into()).unwrap().problem().unwrap());
    assert_eq!(outcome.search.lowest_exits_mev, [None; 2]);
    assert!(!outcome.warnings.iter().any(|w| w.contains("over other saddles too")));
}
