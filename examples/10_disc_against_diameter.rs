//! How a perpendicular disc reverses, against its diameter: all spins together, or by a wall through the middle.
//!
//! All spins together cost K times the volume V, that of the cells inside the disc's edge. A straight wall through the middle costs
//! 4 √(AK) a unit of area, over the diameter d and the thickness t, where the disc is much larger than its width √(A/K), here 9 nm;
//! in a smaller disc it costs less. The two estimates cross at d = 16/π √(A/K).
//!
//! ```text
//! cargo run --release --example 10_disc_against_diameter
//! ```
//! runs `configs/sweeps/disc_diameter.json`, as `spinneb sweep` does, and writes a table and a figure to
//! `results/gallery/10_disc_against_diameter/`.

use anyhow::{Context, Result};
use rayon::prelude::*;
use spinneb::config::sweep::Sweep;
use spinneb::drive::{Silent, run};
use spinneb::output::canvas::{BLACK, LinePlot, Marker, Series, VERMILLION};
use spinneb::units::E_CHARGE;
use std::fmt::Write;
use std::path::Path;

const SWEEP: &str = "configs/sweeps/disc_diameter.json";
const FOLDER: &str = "results/gallery/10_disc_against_diameter";
/// A (J/m), K (J/m³) and the thickness (nm) of `configs/perpendicular_disc.json`.
const A: f64 = 20e-12;
const K: f64 = 0.25e6;
const THICKNESS_NM: f64 = 1.0;
/// 1 meV in J.
const MEV: f64 = 1e-3 * E_CHARGE;
/// A barrier closer than this part to K times the volume is that of all spins together.
const TOGETHER: f64 = 1e-9;

/// A point of the sweep.
struct Row {
    diameter_nm: f64,
    cells: usize,
    barrier_mev: f64,
    certified: bool,
}

impl Row {
    /// K V (meV), in cells of 1 nm³.
    fn coherent_mev(&self) -> f64 {
        K * 1e-27 / MEV * self.cells as f64
    }

    /// Whether all its spins turn together.
    fn is_coherent(&self) -> bool {
        (self.barrier_mev / self.coherent_mev() - 1.0).abs() < TOGETHER
    }
}

/// 4 √(AK) d t (meV).
fn wall_mev(diameter_nm: f64) -> f64 {
    4.0 * (A * K).sqrt() * diameter_nm * THICKNESS_NM * 1e-18 / MEV
}

fn main() -> Result<()> {
    let rows = rows(|_| true)?;
    std::fs::create_dir_all(FOLDER)?;
    std::fs::write(format!("{FOLDER}/barriers.csv"), table(&rows))?;
    let canvas = figure(&rows).draw()?;
    std::fs::write(format!("{FOLDER}/barrier_against_diameter.svg"), canvas.svg()?)?;
    std::fs::write(format!("{FOLDER}/barrier_against_diameter.png"), canvas.png()?)?;
    Ok(())
}

/// The chosen points of the sweep, run.
fn rows(chosen: impl Fn(usize) -> bool) -> Result<Vec<Row>> {
    let sweep = Sweep::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join(SWEEP))?;
    let points: Vec<usize> = (0..sweep.len()).filter(|k| chosen(*k)).collect();
    points.into_par_iter().map(|k| row(&sweep, k)).collect()
}

fn row(sweep: &Sweep, point: usize) -> Result<Row> {
    let problem = sweep.problem(point, &sweep.load_point(point)?)?;
    let radius = sweep.values(point).find_map(|v| v.as_str()?.strip_suffix(" nm")?.parse::<f64>().ok());
    let outcome = run(&problem, &mut Silent)?;
    Ok(Row {
        diameter_nm: 2.0 * radius.context("a radius in nm")?,
        cells: problem.hamiltonian.sites(),
        barrier_mev: outcome.barrier.context("a barrier")?.forward_mev,
        certified: outcome.converged && outcome.certified,
    })
}

fn table(rows: &[Row]) -> String {
    let mut text = String::from("diameter_nm,cells,barrier_meV,coherent_meV,wall_meV,reversal,certified\n");
    for r in rows {
        let reversal = if r.is_coherent() { "coherent" } else { "wall" };
        let (coherent, wall) = (r.coherent_mev(), wall_mev(r.diameter_nm));
        let Row { diameter_nm, cells, barrier_mev, certified } = r;
        let _ = writeln!(text, "{diameter_nm},{cells},{barrier_mev:.9},{coherent:.9},{wall:.9},{reversal},{certified}");
    }
    text
}

fn figure(rows: &[Row]) -> LinePlot {
    let chosen = |coherent: bool| {
        rows.iter().filter(|r| r.is_coherent() == coherent).map(|r| (r.diameter_nm, r.barrier_mev)).collect::<Vec<_>>()
    };
    let area = |d: f64| std::f64::consts::FRAC_PI_4 * d * d;
    let along = |f: &dyn Fn(f64) -> f64| (0..=100).map(|i| 0.5 * f64::from(i)).map(|d| (d, f(d))).collect::<Vec<_>>();
    let volume = along(&|d| K * area(d) * THICKNESS_NM * 1e-27 / MEV);
    LinePlot::new("Diameter (nm)", "Barrier (meV)")
        .x_range(0.0, 50.0)
        .y_range(0.0, 3200.0)
        .with(Series::line(volume).colour(BLACK).width(0.6).label("all spins together, KV"))
        .with(Series::line(along(&wall_mev)).colour(VERMILLION).width(0.6).label("a straight wall, 4√(AK) d t"))
        .with(Series::markers(chosen(true), Marker::Disc).colour(BLACK).label("found, all spins together"))
        .with(Series::markers(chosen(false), Marker::Disc).colour(VERMILLION).label("found, a wall"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_disc_of_16_nm_turns_as_one_and_one_of_36_nm_by_a_wall() {
        let rows = rows(|k| k == 1 || k == 6).unwrap();
        assert!(rows.iter().all(|r| r.certified));
        assert!(rows[0].is_coherent() && !rows[1].is_coherent());
        // references of an independent computation
        assert!((rows[0].barrier_mev - 324.558471872).abs() < 1e-8, "{}", rows[0].barrier_mev);
        assert!((rows[1].barrier_mev - 1569.1107123283).abs() < 1e-8, "{}", rows[1].barrier_mev);
        assert!(rows[1].barrier_mev < rows[1].coherent_mev() && rows[1].barrier_mev < wall_mev(36.0));
    }
}
