//! Langer's rates against spins that are seen to escape: `cargo bench --bench dynamics`.
//!
//! Three problems at barriers from 4 k_BT on: one spin with an easy and a hard axis (also the lowest eigenvalue of its Fokker–Planck
//! equation), a chain of ten spins that reverses in a field by a wall from one of its ends, and a skyrmion that
//! collapses and slides over a periodic film. Rates by forward flux (`spinneb::dynamics`), at the lowest barrier of the first two also by waiting for escapes. Times
//! are in units of μ/γ per meV. The table and a figure go to `results/gallery/dynamics/`. With the word `quick` after
//! `--` little is simulated.

#[allow(dead_code, unused_imports)]
#[path = "../examples/04_rates_of_one_spin.rs"]
mod one_spin;

use cpu_time::ProcessTime;
use spinneb::config::load_text;
use spinneb::drive::{Outcome, Problem, Silent, run};
use spinneb::dynamics::{Bath, Flux, FluxRate, escape_rate, forward_flux};
use spinneb::output::canvas::{BLACK, BLUE, Colour, GREEN, GREY, LinePlot, Marker, Series, VERMILLION};
use spinneb::units::{HBAR, K_B};
use std::fmt::Write;
use std::path::Path;

const FOLDER: &str = "results/gallery/dynamics";

/// A problem, and how its escapes are looked at.
struct Case {
    name: &'static str,
    config: &'static str,
    colour: Colour,
    damping: f64,
    /// Δ.
    barriers: &'static [f64],
    /// Grows from A to the other side, from all m_z.
    order: fn(&[f64]) -> f64,
    /// How many λ there are beyond the first one, and what part of the way to the other side the last one is.
    interfaces: usize,
    reach: f64,
    /// Time step.
    step: f64,
    /// Crossings and trials of a block, and blocks.
    amount: [usize; 2],
    /// Escapes that are waited for at the lowest barrier; none where that would take too long.
    escapes: usize,
}

const CASES: [Case; 3] = [
    Case {
        name: "one spin",
        config: r#"{"material": {"name": "one spin", "moment": "1 mu_B", "energy": [{"anisotropy": {"K": "1 meV", "axis": [0, 0, 1]}},
            {"anisotropy": {"K": "-2 meV", "axis": [1, 0, 0]}}]}, "lattice": {"chain": {"sites": 1}},
            "initial": {"uniform": {"direction": [0, 0, 1]}}, "final": {"uniform": {"direction": [0, 0, -1]}}"#,
        colour: BLUE,
        damping: 1.0,
        barriers: &[4.0, 6.0, 8.0, 10.0, 12.0],
        order: |z| -mean(z),
        interfaces: 12,
        reach: 0.8,
        step: 0.01,
        amount: [1000, 24],
        escapes: 2000,
    },
    Case {
        name: "ten spins, a wall",
        config: r#"{"material": {"name": "ten spins", "moment": "1 mu_B", "energy": [{"exchange": {"J": ["1 meV"]}},
            {"anisotropy": {"K": "0.2 meV", "axis": [0, 0, 1]}}, {"anisotropy": {"K": "-0.2 meV", "axis": [1, 0, 0]}}]},
            "lattice": {"chain": {"sites": 10}}, "energy": [{"zeeman": {"B": ["0 T", "0 T", "-2.5 T"]}}],
            "initial": {"uniform": {"direction": [0, 0, 1]}}, "final": {"uniform": {"direction": [0, 0, -1]}}"#,
        colour: VERMILLION,
        damping: 1.0,
        barriers: &[4.0, 7.0, 10.0],
        order: |z| -mean(z),
        interfaces: 12,
        reach: 0.8,
        step: 0.04,
        amount: [600, 24],
        escapes: 600,
    },
    Case {
        name: "skyrmion, 144 spins",
        config: r#"{"material": {"name": "skyrmion", "moment": "1 mu_B", "energy": [{"exchange": {"J": ["1 meV"]}},
            {"dmi": {"D": "0.5 meV", "kind": "interfacial"}}, {"anisotropy": {"K": "0.35 meV", "axis": [0, 0, 1]}}]},
            "lattice": {"square": {"cells": [12, 12], "periodic": true}},
            "initial": {"skyrmion": {"radius": 2}}, "final": {"uniform": {"direction": [0, 0, 1]}}"#,
        colour: GREEN,
        damping: 1.0,
        barriers: &[6.0, 9.0],
        order: |z| z.iter().map(|z| z.min(0.0)).sum(),
        interfaces: 14,
        reach: 0.99,
        step: 0.04,
        amount: [60, 8],
        escapes: 0,
    },
];

fn mean(z: &[f64]) -> f64 {
    z.iter().sum::<f64>() / z.len() as f64
}

/// One barrier of a case, rates in γ/μ per meV.
struct Row {
    name: &'static str,
    delta: f64,
    langer: f64,
    flux: FluxRate,
    waited: Option<FluxRate>,
    exact: Option<f64>,
    seconds: f64,
}

fn main() {
    let quick = std::env::args().any(|word| word == "quick");
    let mut all = Vec::new();
    for case in &CASES {
        all.extend(rows(case, quick));
        if !quick {
            write(&all);
        }
    }
    print!("{}", table(&all));
}

fn write(rows: &[Row]) {
    std::fs::create_dir_all(FOLDER).expect("a folder");
    std::fs::write(format!("{FOLDER}/table.md"), table(rows)).expect("a table");
    let canvas = figure(rows).draw().expect("a figure");
    std::fs::write(format!("{FOLDER}/langer_by_dynamics.svg"), canvas.svg().expect("a figure")).expect("a figure");
    std::fs::write(format!("{FOLDER}/langer_by_dynamics.png"), canvas.png().expect("a figure")).expect("a figure");
}

fn rows(case: &Case, quick: bool) -> Vec<Row> {
    let asked = |kelvin: &[f64]| -> (Problem, Outcome) {
        let kelvin: Vec<String> = kelvin.iter().map(|t| format!("\"{t} K\"")).collect();
        let rates = format!(r#", "rates": {{"temperatures": [{}], "damping": {}}}}}"#, kelvin.join(", "), case.damping);
        let problem = load_text(Path::new("case.json"), format!("{}{rates}", case.config)).expect("a config");
        let problem = problem.problem().expect("a problem");
        let outcome = run(&problem, &mut Silent).expect("an outcome");
        assert!(outcome.certified, "{}: {:?}", case.name, outcome.warnings);
        (problem, outcome)
    };
    let barrier = asked(&[1.0]).1.barrier.expect("a barrier").forward_mev;
    let (problem, outcome) = asked(&case.barriers.iter().map(|d| barrier / (K_B * d)).collect::<Vec<_>>());
    eprintln!("{}: {barrier} meV, {:?}", case.name, outcome.rates.as_ref().map(|r| r.saddles[0].equivalents.clone()));
    let barriers = case.barriers.iter().enumerate();
    barriers.map(|(k, delta)| row(case, &problem, &outcome, k, barrier / delta, quick)).collect()
}

fn row(case: &Case, problem: &Problem, outcome: &Outcome, k: usize, thermal: f64, quick: bool) -> Row {
    let begun = ProcessTime::now();
    let (h, delta) = (&problem.hamiltonian, case.barriers[k]);
    let start = outcome.path.spins(0);
    let order = |m: &[f64]| (case.order)(&m[2 * h.sites()..]);
    let bath = Bath::new(h, &vec![1.0; h.sites()], case.damping, thermal, case.step);
    let goal = order(outcome.path.spins(outcome.path.images() - 1).as_slice());
    let interfaces = interfaces(case, &bath, start.as_slice(), &order, goal);
    let [trials, blocks] = if quick { [40, 4] } else { case.amount };
    let flux = Flux { crossings: trials, trials, blocks, seed: 1000 * k as u64, interfaces: interfaces.clone() };
    let found = forward_flux(&bath, start.as_slice(), &order, &flux);
    let last = interfaces[interfaces.len() - 1];
    let escapes = if quick { 20 } else { case.escapes };
    let waited =
        (k == 0 && case.escapes > 0).then(|| escape_rate(&bath, start.as_slice(), &order, last, escapes, 7000));
    let rates = outcome.rates.as_ref().expect("rates");
    let passage = &rates.transitions[0].rows[k].passage;
    let langer = libm::exp(passage.ln_langer_per_s.expect("a rate")) / (1e12 * 2.0 / HBAR);
    let exact = (h.sites() == 1)
        .then(|| one_spin::slowest_decay(delta, case.damping, one_spin::harmonics(delta)))
        .flatten()
        .map(|decay| 0.5 * decay);
    let row =
        Row { name: case.name, delta, langer, flux: found, waited, exact, seconds: begun.elapsed().as_secs_f64() };
    eprintln!("{}", line(&row));
    row
}

/// λ₀ and λ₁ where the fluctuations in A have their mean and their upper end, then evenly to the last one.
fn interfaces(case: &Case, bath: &Bath, start: &[f64], order: &dyn Fn(&[f64]) -> f64, goal: f64) -> Vec<f64> {
    let mut walker = spinneb::dynamics::Walker::new(start, 99);
    let mut seen: Vec<f64> = (0..20_000)
        .filter_map(|step| {
            bath.step(&mut walker);
            let own = order(&walker.m);
            // what has left A says nothing of it
            (step > 1000 && own < order(start) + 0.3 * (goal - order(start))).then_some(own)
        })
        .collect();
    seen.sort_by(f64::total_cmp);
    let at = |part: f64| seen[(part * (seen.len() - 1) as f64) as usize];
    let (middle, upper) = (at(0.6), at(0.92));
    let last = order(start) + case.reach * (goal - order(start));
    let further = (0..case.interfaces).map(|k| upper + (last - upper) * k as f64 / (case.interfaces - 1) as f64);
    std::iter::once(middle).chain(further).collect()
}

fn line(row: &Row) -> String {
    let ratio = row.flux.per_s / row.langer;
    let error = row.flux.error_per_s / row.langer;
    let other = |rate: Option<f64>| rate.map_or("–".into(), |r| format!("{:.4}", r / row.langer));
    let waited =
        row.waited.map_or("–".into(), |w| format!("{:.3} ± {:.3}", w.per_s / row.langer, w.error_per_s / row.langer));
    format!(
        "| {} | {} | {:.4e} | {ratio:.3} ± {error:.3} | {waited} | {} | {:.0} |",
        row.name,
        row.delta,
        row.langer,
        other(row.exact),
        row.seconds
    )
}

fn table(rows: &[Row]) -> String {
    let mut text = String::from(
        "| | Δ | Langer (γ/μ meV) | forward flux / Langer | waiting / Langer | Fokker–Planck / Langer | processor (s) |\n|---|---|---|---|---|---|---|\n",
    );
    rows.iter().for_each(|row| {
        // writing into a string cannot fail
        let _ = writeln!(text, "{}", line(row));
    });
    text
}

fn figure(rows: &[Row]) -> LinePlot {
    let mut plot = LinePlot::new("ΔE/k_BT", "rate / Langer").x_range(3.0, 13.0).y_range(0.4, 1.6).legend_above();
    let bound =
        |sign: f64| (0..=100).map(|k| 3.0 + 0.1 * f64::from(k)).map(|x| (x, 1.0 + sign * 2.0 / x)).collect::<Vec<_>>();
    plot = plot.with(Series::line(vec![(3.0, 1.0), (13.0, 1.0)]).colour(BLACK));
    for sign in [1.0, -1.0] {
        let line = Series::line(bound(sign)).colour(GREY).dash(3.0, 2.0);
        plot = plot.with(if sign > 0.0 { line.label("1 ± 2/Δ") } else { line });
    }
    let exact: Vec<(f64, f64)> = rows.iter().filter_map(|r| Some((r.delta, r.exact? / r.langer))).collect();
    plot = plot.with(Series::line(exact).colour(BLUE).label("one spin, Fokker–Planck"));
    for case in CASES.iter().filter(|case| rows.iter().any(|r| r.name == case.name)) {
        let own = || rows.iter().filter(|r| r.name == case.name);
        let points: Vec<(f64, f64)> = own().map(|r| (r.delta, r.flux.per_s / r.langer)).collect();
        plot = plot.with(Series::markers(points, Marker::Disc).colour(case.colour).label(case.name));
        for r in own() {
            let (y, e) = (r.flux.per_s / r.langer, r.flux.error_per_s / r.langer);
            plot = plot.with(Series::line(vec![(r.delta, y - e), (r.delta, y + e)]).colour(case.colour));
        }
        let waited: Vec<(f64, f64)> = own().filter_map(|r| Some((r.delta, r.waited?.per_s / r.langer))).collect();
        plot = plot.with(Series::markers(waited, Marker::Ring).colour(case.colour));
    }
    plot
}
