//! Langer's rate of one spin against the truth.
//!
//! A spin with an easy axis z and a hard axis x, E = −K m_z² + K_hard m_x², switches between up and down over two saddles at ±y.
//! In units of K for energies and μ/(γK) for times its distribution obeys the Fokker–Planck equation (W. F. Brown, Phys. Rev. 130,
//! 1677 (1963), doi:10.1103/PhysRev.130.1677), whose adjoint acts on a function f of the direction as
//!
//! ```text
//! L f = [−α ∇E·∇f + (m × ∇E)·∇f + α k_BT ∇²f]/(1 + α²)
//! ```
//! Its lowest non-zero eigenvalue is λ = 2k, k the rate out of one well: here from the matrix of −L in spherical harmonics, and,
//! independently of it, from the decay of ⟨m_z(0) m_z(t)⟩ in a simulation of the stochastic Landau–Lifshitz–Gilbert equation (Heun's
//! method, Stratonovich). Both are compared with the crate's Langer rate over Δ = K/k_BT = 4 … 20 and α = 0.1 … 1.
//!
//! ```text
//! cargo run --release --example 04_rates_of_one_spin
//! ```
//! prints a table and writes it with a figure to `results/gallery/04_rates_of_one_spin/`.

use anyhow::{Context, Result};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use spinneb::drive::{Problem, Silent, run};
use spinneb::energy::{Anisotropy, EnergyTerm, Hamiltonian};
use spinneb::geometry::{Direction, Vector, vector};
use spinneb::lattice::Chain;
use spinneb::linalg::{General, slab};
use spinneb::output::canvas::{BLACK, BLUE, Colour, GREEN, LinePlot, Marker, Series, VERMILLION};
use spinneb::rates::{RateSettings, Theory, Way};
use spinneb::spins::Spins;
use spinneb::units::{HBAR, K_B};
use std::fmt::Write;

/// The hard axis, in units of K.
const HARD: f64 = 2.0;
const DAMPINGS: [(f64, Colour); 3] = [(0.1, BLUE), (0.3, GREEN), (1.0, VERMILLION)];
const BARRIERS: [f64; 10] = [4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0, 18.0, 20.0];
/// Barriers at which the spin is also simulated.
const SIMULATED: [f64; 2] = [4.0, 5.0];
const FOLDER: &str = "results/gallery/04_rates_of_one_spin";

/// One barrier and damping.
struct Row {
    alpha: f64,
    delta: f64,
    langer: f64,
    exact: f64,
    /// Rate of the simulation and its standard error.
    simulated: Option<(f64, f64)>,
}

fn main() -> Result<()> {
    let mut rows = Vec::new();
    for (alpha, _) in DAMPINGS {
        let langer = langer_rates(alpha, &BARRIERS)?;
        let decays: Vec<_> = BARRIERS.par_iter().map(|d| slowest_decay(*d, alpha, harmonics(*d))).collect();
        for ((&delta, langer), decay) in BARRIERS.iter().zip(langer).zip(decays) {
            let exact = 0.5 * decay.context("an eigenvalue")?;
            let amount = Amount { spins: 64, decays: 80.0, step: 0.01, seed: 64 * rows.len() as u64 };
            let simulated = SIMULATED.contains(&delta).then(|| simulate(delta, alpha, 2.0 * exact, &amount));
            rows.push(Row { alpha, delta, langer, exact, simulated });
        }
    }
    let text = table(&rows);
    print!("{text}");
    std::fs::create_dir_all(FOLDER)?;
    std::fs::write(format!("{FOLDER}/table.md"), &text)?;
    let canvas = figure(&rows).draw()?;
    std::fs::write(format!("{FOLDER}/langer_over_exact.svg"), canvas.svg()?)?;
    std::fs::write(format!("{FOLDER}/langer_over_exact.png"), canvas.png()?)?;
    println!("\nwritten: {FOLDER}");
    Ok(())
}

/// Rates out of one well by Langer's theory, over both saddles, in units of γK/μ.
fn langer_rates(alpha: f64, barriers: &[f64]) -> Result<Vec<f64>> {
    let chain = Chain::open(1).resolve()?;
    let easy: Box<dyn EnergyTerm> = Box::new(Anisotropy::uniform(1, 1.0, Direction::Z));
    let hard = Box::new(Anisotropy::uniform(1, -HARD, Direction::X));
    let hamiltonian = Hamiltonian::new(&chain, vec![easy, hard])?;
    let [up, down] = [Direction::Z, Direction::Z.reversed()].map(|d| Spins::uniform(1, d));
    let mut problem = Problem::new(hamiltonian, up, down);
    problem.rates = Some(RateSettings {
        temperatures_k: barriers.iter().map(|delta| 1.0 / (delta * K_B)).collect(),
        damping: alpha,
        g_factor: 2.0,
        theories: vec![Theory::Langer],
        moments_mub: vec![1.0],
    });
    let rates = run(&problem, &mut Silent)?.rates.context("rates")?;
    let forward = rates.saddles.iter().find(|r| r.way == Way::Forward).context("a saddle")?;
    let unit_per_s = 1e12 * 2.0 / HBAR;
    let rate = |delta: &f64| {
        let ln = forward.ln_rate_per_s(Theory::Langer, 1.0 / (delta * K_B)).context("a rate")?;
        Ok(libm::exp(ln) / unit_per_s)
    };
    barriers.iter().map(rate).collect()
}

/// A function on the sphere by its coefficients of Y_lm, real and imaginary parts; l up to `top`.
#[derive(Clone)]
struct Function {
    top: usize,
    re: Vec<f64>,
    im: Vec<f64>,
}

impl Function {
    fn zero(top: usize) -> Function {
        let size = (top + 1) * (top + 1);
        Function { top, re: vec![0.0; size], im: vec![0.0; size] }
    }

    /// Where the coefficient of Y_lm stands; nothing beyond the highest l or |m|.
    fn at(&self, l: i64, m: i64) -> Option<usize> {
        (l >= 0 && l <= self.top as i64 && m.abs() <= l).then(|| (l * l + l + m) as usize)
    }

    /// Σ over terms: each coefficient goes to the (l, m) that `terms` names, times a real factor.
    fn mapped<const N: usize>(&self, terms: impl Fn(f64, f64) -> [(i64, i64, f64); N]) -> Function {
        let mut out = Function::zero(self.top);
        for l in 0..=self.top as i64 {
            for m in -l..=l {
                let k = (l * l + l + m) as usize;
                if self.re[k] == 0.0 && self.im[k] == 0.0 {
                    continue;
                }
                for (dl, dm, factor) in terms(l as f64, m as f64) {
                    if let Some(to) = self.at(l + dl, m + dm) {
                        out.re[to] += factor * self.re[k];
                        out.im[to] += factor * self.im[k];
                    }
                }
            }
        }
        out
    }

    /// m_z f.
    fn times_z(&self) -> Function {
        let a = |l: f64, m: f64| ((l * l - m * m).max(0.0) / (4.0 * l * l - 1.0)).sqrt();
        self.mapped(|l, m| [(1, 0, a(l + 1.0, m)), (-1, 0, if l > 0.0 { a(l, m) } else { 0.0 })])
    }

    /// m_x f = ½ sin θ (e^{iφ} + e^{−iφ}) f.
    fn times_x(&self) -> Function {
        let up = |l: f64, m: f64| ((l + m + 1.0) * (l + m + 2.0) / ((2.0 * l + 1.0) * (2.0 * l + 3.0))).sqrt();
        let down = |l: f64, m: f64| ((l - m) * (l - m - 1.0) / ((2.0 * l - 1.0) * (2.0 * l + 1.0))).max(0.0).sqrt();
        self.mapped(|l, m| {
            [(1, 1, -0.5 * up(l, m)), (1, -1, 0.5 * up(l, -m)), (-1, 1, 0.5 * down(l, m)), (-1, -1, -0.5 * down(l, -m))]
        })
    }

    /// (m × ∇)_z f = i L_z f.
    fn turned_about_z(&self) -> Function {
        self.mapped(|_, m| [(0, 0, m)]).times_i()
    }

    /// (m × ∇)_x f = i L_x f.
    fn turned_about_x(&self) -> Function {
        let ladder = |l: f64, m: f64| 0.5 * ((l - m) * (l + m + 1.0)).sqrt();
        self.mapped(|l, m| [(0, 1, ladder(l, m)), (0, -1, ladder(l, -m))]).times_i()
    }

    fn times_i(self) -> Function {
        Function { top: self.top, re: self.im.iter().map(|v| -v).collect(), im: self.re }
    }

    /// ∇² f.
    fn laplacian(&self) -> Function {
        self.mapped(|l, _| [(0, 0, -l * (l + 1.0))])
    }

    /// self + s other.
    fn plus(mut self, s: f64, other: &Function) -> Function {
        slab::add_scaled(&mut self.re, s, &other.re);
        slab::add_scaled(&mut self.im, s, &other.im);
        self
    }
}

/// L f for the energy −m_z² + K_hard m_x² and k_BT = 1/Δ.
fn generator(f: &Function, delta: f64, alpha: f64) -> Function {
    let quadratic = |f: &Function, z: f64, x: f64, one: f64| {
        let (zz, xx) = (f.times_z().times_z(), f.times_x().times_x());
        Function::zero(f.top).plus(z, &zz).plus(x, &xx).plus(one, f)
    };
    let energy = |f: &Function| quadratic(f, -1.0, HARD, 0.0);
    // ∇²E, since ∇² m_z² = 2 − 6 m_z²
    let curvature = |f: &Function| quadratic(f, 6.0, -6.0 * HARD, 2.0 * HARD - 2.0);
    // ∇E·∇f = ½[∇²(Ef) − E ∇²f − f ∇²E]
    let slope = energy(f).laplacian().plus(-1.0, &energy(&f.laplacian())).plus(-1.0, &curvature(f));
    // (m × ∇E)·∇f = −∂E/∂m · (m × ∇)f
    let precession =
        Function::zero(f.top).plus(2.0, &f.turned_about_z().times_z()).plus(-2.0 * HARD, &f.turned_about_x().times_x());
    let sum = precession.plus(-0.5 * alpha, &slope).plus(alpha / delta, &f.laplacian());
    Function::zero(f.top).plus(1.0 / (1.0 + alpha * alpha), &sum)
}

/// Highest l that the slowest mode needs.
pub fn harmonics(delta: f64) -> usize {
    30 + (2.5 * delta) as usize
}

/// The lowest eigenvalue of −L among functions that a half turn about z leaves as they are and one about x reverses: real
/// combinations of Y_lm of even m, cos mφ with odd l and sin mφ with even l. It is the decay rate of m_z.
pub fn slowest_decay(delta: f64, alpha: f64, top: usize) -> Option<f64> {
    let even = |l: usize| (usize::from(l.is_multiple_of(2)) * 2..=l).step_by(2);
    let basis: Vec<(usize, usize)> = (1..=top).flat_map(|l| even(l).map(move |m| (l, m))).collect();
    let number: std::collections::BTreeMap<(usize, usize), usize> =
        basis.iter().enumerate().map(|(k, lm)| (*lm, k)).collect();
    let weight = |m: usize| if m == 0 { 1.0 } else { std::f64::consts::FRAC_1_SQRT_2 };
    let mut entries = Vec::new();
    for (column, &(l, m)) in basis.iter().enumerate() {
        let mut f = Function::zero(top + 4);
        for sign in if m == 0 { vec![1i64] } else { vec![1, -1] } {
            let k = f.at(l as i64, sign * m as i64)?;
            if l % 2 == 1 { f.re[k] = weight(m) } else { f.im[k] = sign as f64 * weight(m) }
        }
        let image = generator(&f, delta, alpha);
        let near = l.saturating_sub(2).max(1)..=(l + 2).min(top);
        for (row, lm) in near.flat_map(|l| even(l).map(move |m| (l, m))).map(|lm| (number[&lm], lm)) {
            let k = image.at(lm.0 as i64, lm.1 as i64)?;
            let value = -(if lm.0 % 2 == 1 { image.re[k] } else { image.im[k] }) / weight(lm.1);
            if value != 0.0 {
                entries.push((row, column, value));
            }
        }
    }
    let width = entries.iter().map(|(i, j, _)| i.abs_diff(*j)).max()?;
    let mut matrix = General::zeros(basis.len(), width);
    entries.iter().for_each(|(i, j, v)| matrix.add(*i, *j, *v));
    let factors = matrix.factor();
    let mut x = vec![0.0; basis.len()];
    x[0] = 1.0;
    let mut before = f64::INFINITY;
    for _ in 0..200 {
        let mut y = x.clone();
        factors.solve(&mut y);
        let size = slab::norm(&y);
        let rate = slab::dot(&x, &x) / slab::dot(&x, &y);
        slab::scale(&mut y, 1.0 / size);
        x = y;
        if (rate - before).abs() <= 1e-12 * rate {
            return Some(rate);
        }
        before = rate;
    }
    None
}

/// The decay is read off between one and so many lags.
const LAGS: usize = 5;
/// Values of m_z that are kept in a lag.
const SAMPLES: usize = 20;

/// How much is simulated.
struct Amount {
    /// Independent spins.
    spins: u64,
    /// Length of each trajectory, in decay times 1/λ.
    decays: f64,
    /// Time step in units of μ/(γK).
    step: f64,
    /// Seed of the first spin; each has its own.
    seed: u64,
}

/// The rate out of a well, half the decay rate of ⟨m_z(0) m_z(t)⟩, with its standard error; `lambda` sets the time scale.
fn simulate(delta: f64, alpha: f64, lambda: f64, amount: &Amount) -> (f64, f64) {
    // from a quarter of the decay time on the faster modes are gone
    let lag = ((0.25 / (lambda * amount.step)) as usize).next_multiple_of(SAMPLES);
    let sums: Vec<[f64; 2]> = (amount.seed..amount.seed + amount.spins)
        .into_par_iter()
        .map(|seed| correlations(delta, alpha, amount, lag, lambda, ChaCha8Rng::seed_from_u64(seed)))
        .collect();
    let rate = |pairs: &[[f64; 2]]| {
        let total = |k: usize| pairs.iter().map(|p| p[k]).sum::<f64>();
        0.5 * libm::log(total(0) / total(1)) / ((LAGS - 1) as f64 * lag as f64 * amount.step)
    };
    // jackknife over the spins
    let n = sums.len();
    let left_out: Vec<f64> = (0..n).map(|k| rate(&[&sums[..k], &sums[k + 1..]].concat())).collect();
    let mean = left_out.iter().sum::<f64>() / n as f64;
    let variance = left_out.iter().map(|r| (r - mean).powi(2)).sum::<f64>() * (n - 1) as f64 / n as f64;
    (rate(&sums), variance.sqrt())
}

/// Mean of m_z(0) m_z(t) along one trajectory for t of one and of [`LAGS`] lags (in steps).
fn correlations(delta: f64, alpha: f64, amount: &Amount, lag: usize, lambda: f64, mut random: ChaCha8Rng) -> [f64; 2] {
    let steps = (amount.decays / (lambda * amount.step)) as usize;
    // m_z is kept twenty times a lag
    let every = lag / SAMPLES;
    let noise = (2.0 * alpha / (delta * amount.step)).sqrt();
    let mut m = [0.0, 0.0, if random.random_bool(0.5) { 1.0 } else { -1.0 }];
    let mut spare = None;
    let mut kept = Vec::with_capacity(steps / every + 1);
    for step in 0..steps + 4 * lag {
        let [a, b] = gaussian_pair(&mut random);
        let c = spare.take().unwrap_or_else(|| {
            let [c, d] = gaussian_pair(&mut random);
            spare = Some(d);
            c
        });
        m = heun(m, vector::scale(noise, [a, b, c]), alpha, amount.step);
        // a few lags to forget the start
        if step >= 4 * lag && step.is_multiple_of(every) {
            kept.push(m[2]);
        }
    }
    let product = |shift: usize| {
        let pairs = kept.len().saturating_sub(LAGS * SAMPLES);
        (0..pairs).map(|k| kept[k] * kept[k + shift]).sum::<f64>() / pairs as f64
    };
    [product(SAMPLES), product(LAGS * SAMPLES)]
}

/// One step of Heun's method for dm/dt = −[m × h + α m × (m × h)]/(1 + α²), h = −∂E/∂m + noise.
fn heun(m: Vector, noise: Vector, alpha: f64, step: f64) -> Vector {
    let velocity = |m: Vector| {
        let h = vector::add([-2.0 * HARD * m[0], 0.0, 2.0 * m[2]], noise);
        let across = vector::cross(m, h);
        let sum = vector::add(across, vector::scale(alpha, vector::cross(m, across)));
        vector::scale(-1.0 / (1.0 + alpha * alpha), sum)
    };
    let first = velocity(m);
    let guess = vector::unit_or(vector::add(m, vector::scale(step, first)), m);
    let mean = vector::scale(0.5, vector::add(first, velocity(guess)));
    vector::unit_or(vector::add(m, vector::scale(step, mean)), m)
}

/// Two independent normal numbers, by Box and Muller.
fn gaussian_pair(random: &mut ChaCha8Rng) -> [f64; 2] {
    let u: f64 = 1.0 - random.random::<f64>();
    let (s, c) = libm::sincos(2.0 * std::f64::consts::PI * random.random::<f64>());
    let r = (-2.0 * libm::log(u)).sqrt();
    [r * c, r * s]
}

fn table(rows: &[Row]) -> String {
    let mut t = String::from(
        "| α | Δ | Langer (γK/μ) | Fokker–Planck (γK/μ) | Langer/Fokker–Planck | simulated/Fokker–Planck |\n|---|---|---|---|---|---|\n",
    );
    for r in rows {
        let simulated =
            r.simulated.map_or("–".into(), |(k, error)| format!("{:.3} ± {:.3}", k / r.exact, error / r.exact));
        let _ = writeln!(
            t,
            "| {} | {} | {:.6e} | {:.6e} | {:.4} | {simulated} |",
            r.alpha,
            r.delta,
            r.langer,
            r.exact,
            r.langer / r.exact
        );
    }
    t
}

/// Langer's rate and the simulated one over the exact one.
fn figure(rows: &[Row]) -> LinePlot {
    let mut plot = LinePlot::new("Δ = K / k_{B}T", "Rate / exact rate").x_range(3.0, 21.0);
    plot = plot.with(Series::line(vec![(3.0, 1.0), (21.0, 1.0)]).colour(BLACK).width(0.5));
    for (k, (alpha, colour)) in DAMPINGS.into_iter().enumerate() {
        let own = || rows.iter().filter(|r| r.alpha == alpha);
        let langer = own().map(|r| (r.delta, r.langer / r.exact)).collect();
        plot = plot.with(Series::line(langer).colour(colour).label(format!("Langer, α = {alpha}")));
        // beside each other, with the standard error
        let shift = 0.25 * (k as f64 - 1.0);
        let simulated: Vec<(f64, f64, f64)> =
            own().filter_map(|r| r.simulated.map(|(v, e)| (r.delta + shift, v / r.exact, e / r.exact))).collect();
        for &(x, y, e) in &simulated {
            plot = plot.with(Series::line(vec![(x, y - e), (x, y + e)]).colour(colour).width(0.7));
        }
        let points = simulated.iter().map(|&(x, y, _)| (x, y)).collect();
        let marks = Series::markers(points, Marker::Disc).colour(colour);
        plot = plot.with(if k == 2 { marks.label("simulated") } else { marks });
    }
    plot
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_eigenvalue_no_longer_depends_on_the_number_of_harmonics() {
        for (delta, alpha) in [(4.0, 0.1), (12.0, 1.0)] {
            let few = slowest_decay(delta, alpha, harmonics(delta)).unwrap();
            let more = slowest_decay(delta, alpha, harmonics(delta) + 8).unwrap();
            assert!((few / more - 1.0).abs() < 1e-6, "Δ = {delta}, α = {alpha}: {few} {more}");
        }
    }

    #[test]
    fn langer_s_rate_becomes_exact_where_the_barrier_is_high() {
        for (alpha, _) in DAMPINGS {
            let barriers = [5.0, 10.0, 20.0];
            let langer = langer_rates(alpha, &barriers).unwrap();
            let off: Vec<f64> = barriers
                .iter()
                .zip(langer)
                .map(|(d, k)| (k / (0.5 * slowest_decay(*d, alpha, harmonics(*d)).unwrap()) - 1.0).abs())
                .collect();
            assert!(off[2] < off[1] && off[1] < off[0] && off[2] < 0.08, "α = {alpha}: {off:?}");
        }
    }

    #[test]
    fn a_simulated_spin_switches_as_often_as_the_eigenvalue_says() {
        let (delta, alpha) = (3.0, 0.5);
        let exact = 0.5 * slowest_decay(delta, alpha, harmonics(delta)).unwrap();
        let few = Amount { spins: 16, decays: 60.0, step: 0.01, seed: 0 };
        let (rate, error) = simulate(delta, alpha, 2.0 * exact, &few);
        assert!((rate - exact).abs() < 4.0 * error && error < 0.2 * exact, "{rate} ± {error}, {exact}");
    }
}
