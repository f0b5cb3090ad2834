//! Langer's rates against spins that are seen to escape: `cargo bench --bench dynamics`.
//!
//! Three problems at barriers from 4 k_BT on: one spin with an easy and a hard axis (also the lowest eigenvalue of its Fokker–Planck
//! equation), a chain of ten spins that reverses in a field by a wall from one of its ends, and a skyrmion of 144 spins near the field
//! in which it collapses, which slides over a periodic film: k_BT is 0.06 to 0.03 of the nearest exchange. Rates by forward flux
//! (`spinneb::dynamics`), at the lowest barrier also by waiting for escapes. Times are in units of μ/γ per meV. The table and a figure
//! go to `results/gallery/dynamics/`. The whole campaign takes 18 minutes of one processor. With the name of a problem after
//! `--` that one is done anew, with the word `quick` little is simulated and nothing written, with the word `langer` nothing is
//! simulated: Langer's rates are computed anew, and the table's are told over these.

#[allow(dead_code, unused_imports)]
#[path = "../examples/04_rates_of_one_spin.rs"]
mod one_spin;

use cpu_time::ProcessTime;
use spinneb::config::load_text;
use spinneb::drive::{Outcome, Problem, Silent, run};
use spinneb::dynamics::{Bath, Flux, FluxRate, Walkers, escape_rate, forward_flux, total};
use spinneb::output::canvas::{BLACK, BLUE, Colour, GREEN, GREY, LinePlot, Marker, Series, VERMILLION};
use spinneb::units::{HBAR, K_B};
use std::fmt::Write;
use std::path::Path;

const FOLDER: &str = "results/gallery/dynamics";
/// How far the rings of a figure are beside their discs, those of the next case further (Δ).
const BESIDE: f64 = 0.12;
/// A problem, and how its escapes are looked at.
struct Case {
    name: &'static str,
    config: &'static str,
    colour: Colour,
    damping: f64,
    /// Δ.
    barriers: &'static [f64],
    /// A spin's share of λ, which grows from A to the other side.
    order: fn([f64; 3]) -> f64,
    /// How many λ there are beyond the first one, and what part of the way to the other side the last one is.
    interfaces: usize,
    reach: f64,
    /// Time step, and how many of them trajectories in A are left to themselves before they count.
    step: f64,
    settle: usize,
    /// Crossings and trials of a block, and blocks.
    amount: [usize; 2],
    /// Escapes that are waited for at the lowest barrier; none, and nothing is.
    escapes: usize,
}

const SKYRMION: Case = Case {
    name: "skyrmion, 144 spins",
    config: r#"{"material": {"name": "skyrmion", "moment": "1 mu_B", "energy": [{"exchange": {"J": ["1 meV", "1 meV"]}},
        {"dmi": {"D": "1 meV", "kind": "interfacial"}}]}, "energy": [{"zeeman": {"B": ["0 T", "0 T", "5.5 T"]}}],
        "lattice": {"triangular": {"cells": [12, 12], "periodic": true}},
        "initial": {"skyrmion": {"radius": 3}}, "final": {"uniform": {"direction": [0, 0, 1]}}"#,
    colour: GREEN,
    damping: 1.0,
    barriers: &[4.0, 6.0, 8.0],
    order: |m| (m[2] - 0.5).min(0.0),
    interfaces: 32,
    reach: 0.95,
    step: 0.05,
    settle: 1000,
    amount: [320, 64],
    escapes: 800,
};

const CASES: [Case; 3] = [
    Case {
        name: "one spin",
        config: r#"{"material": {"name": "one spin", "moment": "1 mu_B", "energy": [{"anisotropy": {"K": "1 meV", "axis": [0, 0, 1]}},
            {"anisotropy": {"K": "-2 meV", "axis": [1, 0, 0]}}]}, "lattice": {"chain": {"sites": 1}},
            "initial": {"uniform": {"direction": [0, 0, 1]}}, "final": {"uniform": {"direction": [0, 0, -1]}}"#,
        colour: BLUE,
        damping: 1.0,
        barriers: &[4.0, 6.0, 8.0, 10.0, 12.0],
        order: |m| -m[2],
        interfaces: 12,
        reach: 0.8,
        step: 0.01,
        settle: 1000,
        amount: [4000, 24],
        escapes: 6000,
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
        order: |m| -0.1 * m[2],
        interfaces: 20,
        reach: 0.8,
        step: 0.04,
        settle: 1000,
        amount: [2000, 24],
        escapes: 6000,
    },
    SKYRMION,
];

/// The skyrmion's highest barrier again: of the rate in units of Langer's neither the damping nor the step should tell.
const CHECKS: [Case; 2] = [
    Case { name: "skyrmion, α = 0.3", damping: 0.3, settle: 4000, barriers: &[8.0], escapes: 0, ..SKYRMION },
    Case { name: "skyrmion, half the step", step: 0.025, settle: 2000, barriers: &[8.0], escapes: 0, ..SKYRMION },
];

/// One barrier of a case, a line of the table. Rates are over Langer's, with their standard errors.
struct Row {
    name: String,
    delta: f64,
    /// γ/μ per meV.
    langer: f64,
    flux: [f64; 2],
    waited: Option<[f64; 2]>,
    exact: Option<f64>,
    seconds: f64,
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let is_said = |word: &str| words.iter().any(|own| own == word);
    let names: Vec<&String> = words.iter().filter(|word| !["quick", "langer"].contains(&word.as_str())).collect();
    let asked = |case: &&Case| names.is_empty() || names.iter().any(|name| case.name.starts_with(name.as_str()));
    let known = std::fs::read_to_string(format!("{FOLDER}/table.md")).unwrap_or_default();
    let known: Vec<Row> = known.lines().filter_map(Row::read).collect();
    let mut found: Vec<Row> = Vec::new();
    for case in cases().filter(asked) {
        found.extend(match is_said("langer") {
            true => over_langer(case, &known),
            false => rows(case, is_said("quick")),
        });
    }
    if !is_said("quick") {
        // of cases that were not asked for what is known stays
        let other: Vec<Row> = known.into_iter().filter(|row| found.iter().all(|own| own.name != row.name)).collect();
        found.extend(other);
        found.sort_by_key(|row| cases().position(|case| case.name == row.name));
        write(&found);
    }
    print!("{}", table(&found));
}

fn cases() -> impl Iterator<Item = &'static Case> {
    CASES.iter().chain(&CHECKS)
}

fn write(rows: &[Row]) {
    let text = table(rows);
    // of the digits that are told
    let rows: Vec<Row> = text.lines().filter_map(Row::read).collect();
    let canvas = figure(&rows).draw().expect("a figure");
    std::fs::create_dir_all(FOLDER).expect("a folder");
    std::fs::write(format!("{FOLDER}/table.md"), text).expect("a table");
    std::fs::write(format!("{FOLDER}/langer_by_dynamics.svg"), canvas.svg().expect("a figure")).expect("a figure");
    std::fs::write(format!("{FOLDER}/langer_by_dynamics.png"), canvas.png().expect("a figure")).expect("a figure");
}

impl Row {
    /// From a line of the table.
    fn read(line: &str) -> Option<Row> {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let [_, name, delta, langer, flux, waited, exact, seconds, _] = cells[..] else { return None };
        let pair = |cell: &str| -> Option<[f64; 2]> {
            let (value, error) = cell.split_once(" ± ")?;
            Some([value.parse().ok()?, error.parse().ok()?])
        };
        Some(Row {
            name: name.into(),
            delta: delta.parse().ok()?,
            langer: langer.parse().ok()?,
            flux: pair(flux)?,
            waited: pair(waited),
            exact: exact.parse().ok(),
            seconds: seconds.parse().ok()?,
        })
    }

    /// As a line of the table.
    fn line(&self) -> String {
        let pair = |[value, error]: [f64; 2]| format!("{value:.3} ± {error:.3}");
        let (waited, exact) = (self.waited.map(pair), self.exact.map(|exact| format!("{exact:.4}")));
        let [waited, exact] = [waited, exact].map(|cell| cell.unwrap_or("–".into()));
        let Row { name, delta, langer, flux, seconds, .. } = self;
        format!("| {name} | {delta} | {langer:.4e} | {} | {waited} | {exact} | {seconds:.0} |", pair(*flux))
    }
}

/// The problem of a case, and what a run makes of it: its barrier (meV), and rates at all Δ.
fn solved(case: &Case) -> (f64, Problem, Outcome) {
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
    (barrier, problem, outcome)
}

fn rows(case: &Case, quick: bool) -> Vec<Row> {
    let (barrier, problem, outcome) = solved(case);
    eprintln!(
        "{}: {barrier} meV, {:?}",
        case.name,
        outcome.rates.as_ref().map(|r| r.told(&r.saddles[0]).equivalents.clone())
    );
    let barriers = case.barriers.iter().enumerate();
    barriers.map(|(k, delta)| row(case, &problem, &outcome, k, barrier / delta, quick)).collect()
}

/// What is known of a case, over Langer's rates of now.
fn over_langer(case: &Case, known: &[Row]) -> Vec<Row> {
    let (_, problem, outcome) = solved(case);
    let now = |k: usize, delta: f64| -> Option<Row> {
        let row = known.iter().find(|row| row.name == case.name && row.delta == delta)?;
        let langer = langer(&outcome, k);
        let part = row.langer / langer;
        // of the digits that a table keeps
        let part = if (part - 1.0).abs() < 1e-4 { 1.0 } else { part };
        let exact = exact(case, &problem, delta).map(|exact| exact / langer);
        let times = |rate: [f64; 2]| rate.map(|x| part * x);
        Some(Row {
            name: row.name.clone(),
            langer,
            flux: times(row.flux),
            waited: row.waited.map(times),
            exact,
            ..*row
        })
    };
    case.barriers.iter().enumerate().filter_map(|(k, delta)| now(k, *delta)).collect()
}

/// Langer's rate at the k-th Δ (γ/μ per meV).
fn langer(outcome: &Outcome, k: usize) -> f64 {
    let rates = outcome.rates.as_ref().expect("rates");
    let passage = &rates.transitions[0].rows[k].passage;
    libm::exp(passage.ln_langer_per_s.expect("a rate")) / (1e12 * 2.0 / HBAR)
}

/// The rate of one spin by its Fokker–Planck equation (γ/μ per meV).
fn exact(case: &Case, problem: &Problem, delta: f64) -> Option<f64> {
    let is_one = problem.hamiltonian.sites() == 1;
    let decay = is_one.then(|| one_spin::slowest_decay(delta, case.damping, one_spin::harmonics(delta))).flatten()?;
    Some(0.5 * decay)
}

fn row(case: &Case, problem: &Problem, outcome: &Outcome, k: usize, thermal: f64, quick: bool) -> Row {
    let begun = ProcessTime::now();
    let (h, delta) = (&problem.hamiltonian, case.barriers[k]);
    let start = outcome.path.spins(0);
    let order = case.order;
    let bath = Bath::new(h, &vec![1.0; h.sites()], case.damping, thermal, case.step);
    let goal = total(&order, outcome.path.spins(outcome.path.images() - 1).as_slice());
    let interfaces = interfaces(case, &bath, start.as_slice(), goal);
    let [trials, blocks] = if quick { [40, 4] } else { case.amount };
    let flux = Flux {
        crossings: trials,
        trials,
        blocks,
        settle: case.settle,
        seed: 1000 * k as u64,
        interfaces: interfaces.clone(),
    };
    let found = forward_flux(&bath, start.as_slice(), &order, &flux);
    let last = interfaces[interfaces.len() - 1];
    let escapes = if quick { case.escapes.min(20) } else { case.escapes };
    let waited = (k == 0 && escapes > 0)
        .then(|| escape_rate(&bath, start.as_slice(), &order, [interfaces[0], last], case.settle, escapes, 7000));
    let langer = langer(outcome, k);
    let over = |rate: FluxRate| [rate.per_s / langer, rate.error_per_s / langer];
    let row = Row {
        name: case.name.into(),
        delta,
        langer,
        flux: over(found),
        waited: waited.map(over),
        exact: exact(case, problem, delta).map(|exact| exact / langer),
        seconds: begun.elapsed().as_secs_f64(),
    };
    eprintln!("{}", row.line());
    row
}

/// λ₀ and λ₁ where the fluctuations in A have their mean and their upper end, then evenly to the last one.
fn interfaces(case: &Case, bath: &Bath, start: &[f64], goal: f64) -> Vec<f64> {
    let (mut walkers, begin) = (Walkers::new(start, 99), total(&case.order, start));
    let mut seen = Vec::new();
    for step in 0..10 * case.settle {
        bath.step(&mut walkers);
        // what has left A says nothing of it
        let inside = walkers.orders(&case.order).into_iter().filter(|own| *own < begin + 0.3 * (goal - begin));
        seen.extend(inside.filter(|_| step > case.settle));
    }
    seen.sort_by(f64::total_cmp);
    let at = |part: f64| seen[(part * (seen.len() - 1) as f64) as usize];
    let (middle, upper) = (at(0.6), at(0.92));
    let last = begin + case.reach * (goal - begin);
    let further = (0..case.interfaces).map(|k| upper + (last - upper) * k as f64 / (case.interfaces - 1) as f64);
    std::iter::once(middle).chain(further).collect()
}

fn table(rows: &[Row]) -> String {
    let mut text = String::from(
        "| | Δ | Langer (γ/μ meV) | forward flux / Langer | waiting / Langer | Fokker–Planck / Langer | processor (s) |\n|---|---|---|---|---|---|---|\n",
    );
    rows.iter().for_each(|row| {
        // writing into a string cannot fail
        let _ = writeln!(text, "{}", row.line());
    });
    text
}

fn figure(rows: &[Row]) -> LinePlot {
    let mut plot =
        LinePlot::new("ΔE/k_{B}T", "rate / Langer’s rate").x_range(3.0, 13.0).y_range(0.4, 1.6).legend_above();
    let bound =
        |sign: f64| (0..=100).map(|k| 3.0 + 0.1 * f64::from(k)).map(|x| (x, 1.0 + sign * 2.0 / x)).collect::<Vec<_>>();
    plot = plot.with(Series::line(vec![(3.0, 1.0), (13.0, 1.0)]).colour(BLACK));
    for sign in [1.0, -1.0] {
        let line = Series::line(bound(sign)).colour(GREY).dash(3.0, 2.0);
        plot = plot.with(if sign > 0.0 { line.label("1 ± 2/Δ") } else { line });
    }
    let exact: Vec<(f64, f64)> = rows.iter().filter_map(|r| Some((r.delta, r.exact?))).collect();
    plot = plot.with(Series::line(exact).colour(BLUE).label("one spin, Fokker–Planck"));
    let by_waiting = Series::markers(Vec::new(), Marker::Ring).colour(BLACK).label("by waiting");
    for (k, case) in CASES.iter().enumerate().filter(|(_, case)| rows.iter().any(|r| r.name == case.name)) {
        let own = || rows.iter().filter(|r| r.name == case.name);
        let points: Vec<(f64, f64)> = own().map(|r| (r.delta, r.flux[0])).collect();
        plot = plot.with(Series::markers(points, Marker::Disc).colour(case.colour).label(case.name));
        for r in own() {
            let [y, e] = r.flux;
            plot = plot.with(Series::line(vec![(r.delta, y - e), (r.delta, y + e)]).colour(case.colour));
        }
        // beside the discs, which they would hide
        let waited = || own().filter_map(|r| Some((r.delta + BESIDE * (k + 1) as f64, r.waited?)));
        plot =
            plot.with(Series::markers(waited().map(|(x, [y, _])| (x, y)).collect(), Marker::Ring).colour(case.colour));
        for (x, [y, e]) in waited() {
            plot = plot.with(Series::line(vec![(x, y - e), (x, y + e)]).colour(case.colour));
        }
    }
    plot.with(by_waiting)
}
