//! The nucleus that reverses a ring against Braun's formula, at 200 points over field and anisotropy.
//!
//! A ring of spins, J a bond, easy axis K, in a field B against them: two walls around a reversed stretch form and run apart. With
//! the reduced field h = μB/2K and the wall width δ = √(J/2K) (in sites) the continuum has the saddle and the barrier
//!
//! ```text
//! tan θ/2 = sinh R / cosh(u tanh R),   u = x/δ,   sech² R = h
//! E = 4 √(2JK) (tanh R − R sech² R)
//! ```
//! (H.-B. Braun, Phys. Rev. Lett. 71, 3557 (1993), doi:10.1103/PhysRevLett.71.3557; Phys. Rev. B 50, 16501 (1994),
//! doi:10.1103/PhysRevB.50.16501.) What a lattice changes at first order follows without solving anything: a bond's angle is
//! θ' + θ'''/24 at its middle, a sum over smooth terms is its integral but for e^(−π²δ), and the saddle is stationary, so that
//!
//! ```text
//! J Σ (1 − cos Δθ) = J ∫ ½θ'² − (J/24) ∫ (θ''² + θ'⁴) dx + …
//! E_lattice / E − 1 = −C(h)/δ² + O(1/δ⁴),   C(h) = ∫ (θ_uu² + θ_u⁴) du / (96 (tanh R − R sech² R)),   C(0) = 1/24
//! ```
//!
//! ```text
//! cargo run --release --example 09_braun_nucleus
//! ```
//! runs `configs/sweeps/braun_nucleus.json`, as `spinneb sweep` does, and writes a table and two figures to
//! `results/gallery/09_braun_nucleus/`.

use anyhow::{Context, Result, ensure};
use rayon::prelude::*;
use spinneb::config::sweep::Sweep;
use spinneb::drive::{Silent, run};
use spinneb::output::canvas::{BLACK, LinePlot, Marker, Series, sequential};
use spinneb::units::{AnyQuantity, MU_B_MEV_PER_T};
use std::fmt::Write;
use std::path::Path;

const SWEEP: &str = "configs/sweeps/braun_nucleus.json";
const FOLDER: &str = "results/gallery/09_braun_nucleus";
/// J (meV) and μ (μ_B) of `configs/ring_nucleus.json`.
const J_MEV: f64 = 10.0;
const MOMENT: f64 = 2.0;

/// A point of the sweep.
struct Row {
    k_mev: f64,
    b_tesla: f64,
    barrier_mev: f64,
    certified: bool,
}

impl Row {
    /// h = μB/2K.
    fn field(&self) -> f64 {
        MOMENT * MU_B_MEV_PER_T * self.b_tesla / (2.0 * self.k_mev)
    }

    /// δ² = J/2K, in sites².
    fn width_squared(&self) -> f64 {
        J_MEV / (2.0 * self.k_mev)
    }

    /// Of the barrier from the continuum's, in parts of it.
    fn deviation(&self) -> f64 {
        self.barrier_mev / braun_mev(self.k_mev, self.field()) - 1.0
    }
}

fn main() -> Result<()> {
    let rows = rows(|_| true)?;
    let said = compared(&rows);
    println!("{said}");
    std::fs::create_dir_all(FOLDER)?;
    std::fs::write(format!("{FOLDER}/compared.txt"), said + "\n")?;
    std::fs::write(format!("{FOLDER}/barriers.csv"), table(&rows))?;
    for (name, plot) in [("barrier_against_field", barriers(&rows)), ("deviation", deviations(&rows))] {
        let canvas = plot.draw()?;
        std::fs::write(format!("{FOLDER}/{name}.svg"), canvas.svg()?)?;
        std::fs::write(format!("{FOLDER}/{name}.png"), canvas.png()?)?;
    }
    Ok(())
}

/// The chosen points of the sweep, run.
fn rows(chosen: impl Fn(usize) -> bool) -> Result<Vec<Row>> {
    let sweep = Sweep::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join(SWEEP))?;
    let points: Vec<usize> = (0..sweep.len()).filter(|k| chosen(*k)).collect();
    points.into_par_iter().map(|k| row(&sweep, k)).collect()
}

fn row(sweep: &Sweep, point: usize) -> Result<Row> {
    let values: Vec<AnyQuantity> =
        sweep.values(point).map(|v| Ok(AnyQuantity::new(v.as_str().context("a quantity")?)?)).collect::<Result<_>>()?;
    ensure!(values.len() == 2 && values[0].unit == "meV" && values[1].unit == "T", "the sweep is another one");
    let outcome = run(&sweep.problem(point, &sweep.load_point(point)?)?, &mut Silent)?;
    Ok(Row {
        k_mev: values[0].value,
        b_tesla: -values[1].value,
        barrier_mev: outcome.barrier.context("a barrier")?.forward_mev,
        certified: outcome.converged && outcome.certified,
    })
}

/// Braun's barrier (meV).
fn braun_mev(k_mev: f64, h: f64) -> f64 {
    4.0 * (2.0 * J_MEV * k_mev).sqrt() * reduced(h)
}

/// tanh R − R sech² R.
fn reduced(h: f64) -> f64 {
    let tanh = (1.0 - h).sqrt();
    tanh - h * libm::atanh(tanh)
}

/// C(h): minus the lattice's first correction, times δ².
fn lattice_term(h: f64) -> f64 {
    // the trapezoidal rule is exact but for rounding on a function that falls off like this one
    const STEPS: i32 = 400;
    let tanh = (1.0 - h).sqrt();
    let step = 40.0 / tanh / f64::from(STEPS);
    let sum: f64 = (-STEPS / 2..=STEPS / 2)
        .map(|i| {
            let u = step * f64::from(i);
            let theta = 2.0 * libm::atan(((1.0 - h) / h).sqrt() / libm::cosh(u * tanh));
            let (sin, cos) = (libm::sin(theta), libm::cos(theta));
            let slope_squared = sin * sin - 2.0 * h * (1.0 - cos);
            let bend = sin * (cos - h);
            bend * bend + slope_squared * slope_squared
        })
        .sum();
    sum * step / (96.0 * reduced(h))
}

fn compared(rows: &[Row]) -> String {
    let certified = rows.iter().filter(|r| r.certified).count();
    let sure = || rows.iter().filter(|r| r.certified);
    let most = |f: fn(&Row) -> f64| sure().map(f).fold(0.0, f64::max);
    let least = sure().map(|r| -r.deviation()).fold(f64::INFINITY, f64::min);
    let beyond = most(|r| (r.deviation() + lattice_term(r.field()) / r.width_squared()).abs());
    let second = most(|r| (r.deviation() * r.width_squared() + lattice_term(r.field())).abs() * r.width_squared());
    format!(
        "{certified} of {} points are certified. Their barriers lie {:.3} % to {:.3} % below Braun's formula; with the lattice's \
         first correction, −C(h)/δ², what remains is at most {:.1e} of the barrier, {second:.3}/δ⁴.",
        rows.len(),
        100.0 * least,
        100.0 * most(|r| -r.deviation()),
        beyond
    )
}

fn table(rows: &[Row]) -> String {
    let mut text = String::from(
        "K_meV,B_T,reduced_field,wall_width_sites,barrier_meV,braun_meV,relative_deviation,lattice_term,certified\n",
    );
    for r in rows {
        let h = r.field();
        let _ = writeln!(
            text,
            "{},{},{h:.6},{:.4},{:.9},{:.9},{:.4e},{:.4e},{}",
            r.k_mev,
            r.b_tesla,
            r.width_squared().sqrt(),
            r.barrier_mev,
            braun_mev(r.k_mev, h),
            r.deviation(),
            -lattice_term(h) / r.width_squared(),
            r.certified
        );
    }
    text
}

/// The anisotropies, each with its points.
fn families(rows: &[Row]) -> Vec<&[Row]> {
    rows.chunk_by(|a, b| a.k_mev == b.k_mev).collect()
}

fn shown(k: usize, count: usize) -> bool {
    k == 0 || k == count - 1 || k == count / 2
}

fn barriers(rows: &[Row]) -> LinePlot {
    let families = families(rows);
    let mut plot = LinePlot::new("Field (T)", "Barrier (meV)").y_range(0.0, 15.0).x_range(0.0, 1.58);
    for (n, family) in families.iter().enumerate() {
        let colour = sequential(n as f64 / (families.len() - 1).max(1) as f64);
        let k = family[0].k_mev;
        let end = 2.0 * k / (MOMENT * MU_B_MEV_PER_T);
        let field = |i: usize| 1.55f64.min(end) * (i as f64 + 0.02) / 100.02;
        let curve = (0..=100).map(|i| (field(i), braun_mev(k, (field(i) / end).min(1.0 - 1e-12)))).collect();
        plot = plot.with(Series::line(curve).colour(colour).width(0.6));
        let mut points =
            Series::markers(family.iter().map(|r| (r.b_tesla, r.barrier_mev)).collect(), Marker::Dot).colour(colour);
        if shown(n, families.len()) {
            points = points.label(format!("K = {k} meV"));
        }
        plot = plot.with(points);
    }
    plot.with(Series::line(Vec::new()).colour(BLACK).width(0.6).label("Braun's formula"))
}

fn deviations(rows: &[Row]) -> LinePlot {
    let families = families(rows);
    let title = "Deviation × (width/spacing)²";
    let mut plot = LinePlot::new("Reduced field μB/2K", title).x_range(0.0, 0.9).y_range(-0.047, 0.0);
    for (n, family) in families.iter().enumerate() {
        let colour = sequential(n as f64 / (families.len() - 1).max(1) as f64);
        let points: Vec<(f64, f64)> =
            (family.iter().filter(|r| r.certified)).map(|r| (r.field(), r.deviation() * r.width_squared())).collect();
        let mut points = Series::markers(points, Marker::Dot).colour(colour);
        if shown(n, families.len()) {
            points = points.label(format!("K = {} meV", family[0].k_mev));
        }
        plot = plot.with(points);
    }
    let curve = (0..=100).map(|i| 1e-4 + 0.9 * f64::from(i) / 100.0).map(|h| (h, -lattice_term(h))).collect();
    plot.with(Series::line(curve).colour(BLACK).width(0.6).label("first correction, −C(h)"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_a_field_the_nucleus_is_two_walls_far_apart() {
        assert!((reduced(1e-12) - 1.0).abs() < 1e-9);
        assert!((24.0 * lattice_term(1e-9) - 1.0).abs() < 1e-6, "{}", lattice_term(1e-9));
    }

    #[test]
    fn a_point_in_twenty_lies_below_braun_s_barrier_by_the_lattice_s_first_correction() {
        let rows = rows(|k| k % 20 == 7).unwrap();
        assert_eq!(rows.len(), 10);
        for r in rows {
            let (found, first) = (r.deviation() * r.width_squared(), -lattice_term(r.field()));
            assert!(r.certified);
            assert!((found / first - 1.0).abs() < 0.3 / r.width_squared(), "{found} {first}");
        }
    }
}
