//! What a barrier of a film costs on ever more sites, with everything a default but the effort (none: no lower pass is looked for).
//!
//! `cargo bench --bench films` runs walls that cross open films, K = 0.1 (16/L)² J (the same wall on a finer lattice), and collapses
//! of one skyrmion in ever larger periodic films (J = 1, D = 0.6, K = 0.1, B = 0.2 meV); `cargo bench --bench films -- wall 256 512`
//! or `-- skyrmion 256` those of the sizes that are given. Iterations are band evaluations of the reported path, products those with the
//! Hessian of an image in it, gradients those of one image, all that is done counted; CPU time is that of all threads.

use cpu_time::ProcessTime;
use spinneb::config::load_text;
use spinneb::drive::{Problem, Silent, run};
use spinneb::landscape::Effort;
use std::path::Path;

#[path = "shared/memory.rs"]
mod memory;
use memory::peak_gb;

/// The allocator of the binary.
#[cfg(feature = "mimalloc")]
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// A series: its name, the problem of so many cells a side, and the numbers of cells.
type Series = (&'static str, fn(usize) -> Problem, [usize; 4]);

const SERIES: [Series; 2] = [("wall", wall, [16, 32, 64, 128]), ("skyrmion", skyrmion, [20, 40, 64, 96])];

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with("--")).collect();
    let sizes: Vec<usize> = words.iter().filter_map(|word| word.parse().ok()).collect();
    let wanted = |kind: &str| words.iter().all(|word| word.parse::<usize>().is_ok() || word == kind);
    for (kind, problem, by_default) in SERIES.into_iter().filter(|(kind, ..)| wanted(kind)) {
        println!(
            "{:>9} {:>9} {:>10} {:>8} {:>9} {:>20} {:>9} {:>8} {:>8} {:>7} {:>8}",
            kind,
            "sites",
            "iterations",
            "products",
            "gradients",
            "barrier_meV",
            "certified",
            "CPU_s",
            "wall_s",
            "us/site",
            "peak_GB"
        );
        for cells in if sizes.is_empty() { &by_default[..] } else { &sizes } {
            tell(*cells, &problem(*cells));
        }
    }
}

/// Runs it and prints a line.
fn tell(cells: usize, problem: &Problem) {
    let (sites, clock) = (problem.hamiltonian.sites(), ProcessTime::now());
    let found = run(problem, &mut Silent).expect("a valid problem");
    let cpu = clock.elapsed().as_secs_f64();
    println!(
        "{:>9} {sites:>9} {:>10} {:>8.1} {:>9} {:>20.14} {:>9} {cpu:>8.2} {:>8.2} {:>7.0} {:>8}",
        format!("{cells}²"),
        found.work.iterations,
        found.hessian_products_an_image(),
        found.work.force_evaluations,
        found.barrier.map_or(f64::NAN, |barrier| barrier.forward_mev),
        if found.certified { "yes" } else { "no" },
        found.work.seconds,
        1e6 * cpu / sites as f64,
        peak_gb().map_or("unknown".into(), |gb| format!("{gb:.2}")),
    );
    found.warnings.iter().for_each(|warning| println!("{:>9} {warning}", ""));
}

fn problem(cells: usize, periodic: bool, energy: &str, initial: &str, end: &str) -> Problem {
    let config = format!(
        r#"{{"material": {{"name": "film", "moment": "1 mu_B", "energy": [{{"exchange": {{"J": ["1 meV"]}}}}, {energy}]}},
            "lattice": {{"square": {{"cells": [{cells}, {cells}], "periodic": {periodic}}}}}, "initial": {initial}, "final": {end}}}"#
    );
    let mut problem = load_text(Path::new("film.json"), config).expect("a valid config").problem().expect("a problem");
    problem.search = Effort::None;
    problem
}

const UP: &str = r#"{"uniform": {"direction": [0, 0, 1]}}"#;
const DOWN: &str = r#"{"uniform": {"direction": [0, 0, -1]}}"#;

fn wall(cells: usize) -> Problem {
    let k = 0.1 * (16.0 / cells as f64).powi(2);
    problem(cells, false, &format!(r#"{{"anisotropy": {{"K": "{k} meV", "axis": [0, 0, 1]}}}}"#), UP, DOWN)
}

fn skyrmion(cells: usize) -> Problem {
    let energy = r#"{"dmi": {"D": "0.6 meV", "kind": "interfacial"}}, {"anisotropy": {"K": "0.1 meV", "axis": [0, 0, 1]}},
                    {"zeeman": {"B": ["0 T", "0 T", "3.4551970995 T"]}}"#;
    let middle = cells / 2;
    let initial = format!(r#"{{"skyrmion": {{"radius": 3, "center": [{middle}, {middle}]}}}}"#);
    problem(cells, true, energy, &initial, UP)
}
