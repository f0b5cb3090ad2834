//! `check`: whether configs are right, and what they would run.

use super::drawing::drawing;
use super::{Check, USAGE, report, worse};
use crate::config::estimate::Estimate;
use crate::config::neighbours::{Shell, shells};
use crate::config::physics::Physics;
use crate::config::{Loaded, PartMaterial, Source, expected_images, memory, needed_bytes};
use crate::drive::survey::SurveyProblem;
use crate::drive::{Images, Problem, Scales};
use crate::lattice::Lattice;
use crate::rates::RateSettings;
use crate::units::Length;
use crate::words::counted;
use anyhow::Result;
use std::io::{self, Write};
use std::path::Path;

/// Checks all configs and prints what each would run.
pub fn check(arguments: &Check) -> Result<u8> {
    let mut code = 0;
    for path in &arguments.configs {
        let out = &mut io::stdout().lock();
        match checked(path, &arguments.set) {
            Ok(Checked::Run(loaded, problem)) => print(out, &loaded, "valid", &report_of(&loaded, &problem))?,
            Ok(Checked::Landscape(loaded, asked)) => {
                print(out, &loaded, "valid for `spinneb landscape`", &report_of_landscape(&loaded, &asked))?;
            }
            Err(error) => code = worse(code, report(&error.into()).max(USAGE)),
        }
    }
    Ok(code)
}

/// What a config is for.
enum Checked {
    /// A path between its two ends.
    Run(Box<Loaded>, Box<Problem>),
    /// A landscape alone: it has no two ends.
    Landscape(Box<Loaded>, Box<SurveyProblem>),
}

fn checked(path: &Path, set: &[String]) -> crate::error::Result<Checked> {
    let source = Source::file(path)?.set(set)?;
    if source.is_of_a_landscape_alone()? {
        let loaded = source.load_landscape()?;
        let asked = loaded.survey()?;
        return Ok(Checked::Landscape(Box::new(loaded), Box::new(asked)));
    }
    let loaded = source.load()?;
    let problem = loaded.problem()?;
    Ok(Checked::Run(Box::new(loaded), Box::new(problem)))
}

fn print(out: &mut impl Write, loaded: &Loaded, verdict: &str, rows: &[(&'static str, String)]) -> io::Result<()> {
    writeln!(out, "{}: {verdict}", loaded.text.file)?;
    rows.iter().try_for_each(|(key, value)| writeln!(out, "  {key:<13}{value}"))
}

/// What a landscape's config asks for, as rows of a key and a value.
fn report_of_landscape(loaded: &Loaded, asked: &SurveyProblem) -> Vec<(&'static str, String)> {
    let problem = &asked.problem;
    let scales = Scales::of_terms(&problem.hamiltonian);
    let mut rows = lattice_rows(loaded, problem);
    rows.extend(scale_rows(&Physics::of(loaded, problem, &scales), problem, &scales));
    let given = loaded.config.landscape.as_ref().map_or(0, |own| own.states.len());
    if given > 0 {
        rows.push(("states", format!("{given} to start from")));
    }
    if asked.window_mev.is_finite() {
        rows.push(("window", format!("{} meV above the lowest minimum", asked.window_mev)));
    }
    if !asked.groups.is_empty() {
        let names: Vec<&str> = asked.groups.iter().map(|(name, _)| name.as_str()).collect();
        rows.push(("groups", names.join(", ")));
    }
    rows.extend(asked.rates.as_ref().map(|rates| ("rates", asked_for(rates))));
    rows
}

/// What a config would run, as rows of a key and a value; a row without a key goes on with the one before.
pub fn report_of(loaded: &Loaded, problem: &Problem) -> Vec<(&'static str, String)> {
    let h = &problem.hamiltonian;
    let scales = Scales::of_terms(h);
    let mut rows = lattice_rows(loaded, problem);
    let mut row = |key: &'static str, value: String| rows.push((key, value));
    let states = [problem.initial.as_slice(), problem.final_state.as_slice()].map(|m| h.energies_mev(m));
    // long numbers and names keep apart too
    let numbers = |x: f64| format!(" {x:>15.6}");
    row("energies", format!("{:<20}{:>16}{:>16}", "as given (meV)", "initial", "final"));
    for ((term, a), (_, b)) in states[0].iter().zip(&states[1]) {
        row("", format!("{term:<20}{}{}", numbers(*a), numbers(*b)));
    }
    let total = |k: usize| numbers(states[k].iter().map(|(_, e)| e).sum());
    row("", format!("{:<20}{}{}", "total", total(0), total(1)));
    let physics = Physics::of(loaded, problem, &scales);
    rows.extend(scale_rows(&physics, problem, &scales));
    let mut row = |key: &'static str, value: String| rows.push((key, value));
    row("ends", if problem.relax_ends { "relaxed to minima first" } else { "kept as given" }.into());
    row("guess", problem.guess.as_ref().map_or("all natural ones".into(), |g| g.name().into()));
    row("images", images(problem, &scales));
    row("optimiser", format!("{} to {:e} rad", problem.neb.optimiser.name(), problem.neb.tolerance));
    if let Some(rates) = &problem.rates {
        row("rates", asked_for(rates));
    }
    let grows = if problem.images == Images::Auto { " to begin with" } else { "" };
    row("memory", format!("about {}{grows}", memory::shown(needed_bytes(problem, &scales))));
    let estimate = Estimate::of(problem, &scales);
    let seconds = estimate.processor_seconds(loaded, problem, &scales);
    row("time", format!("about {} of one processor, by a measured step", duration(seconds)));
    let mut said: Vec<&String> = Vec::new();
    for warning in physics.warnings.iter().chain(&loaded.warnings).chain(&problem.warnings) {
        if !said.contains(&warning) {
            said.push(warning);
            row("warning", warning.clone());
        }
    }
    rows
}

/// What there is: name, material, lattice, bonds.
fn lattice_rows(loaded: &Loaded, problem: &Problem) -> Vec<(&'static str, String)> {
    let h = &problem.hamiltonian;
    let mut rows = vec![("name", loaded.name.clone()), ("material", material(loaded)), ("lattice", lattice(loaded))];
    let mut list = |key: &'static str, lines: Vec<String>| {
        rows.extend(lines.into_iter().enumerate().map(|(k, line)| (if k == 0 { key } else { "" }, line)));
    };
    list("geometry", drawing(&loaded.lattice));
    list("shells", shells(h).iter().map(|shell| neighbours(h.lattice(), shell)).collect());
    rows
}

/// How stiff it is, and what walls in it are like.
fn scale_rows(physics: &Physics, problem: &Problem, scales: &Scales) -> Vec<(&'static str, String)> {
    let h = &problem.hamiltonian;
    let mut rows = Vec::new();
    let mut row = |key: &'static str, value: String| rows.push((key, value));
    row("stiffness", format!("{:.6} meV (softest mode of a stable spin)", scales.stiffness_mev));
    row("exchange", format!("{:.6} meV {}", scales.exchange_mev, stiffness_of(h.lattice())));
    if let Some(length) = physics.exchange_length_nm {
        row("l_ex", format!("{length:.4} nm (exchange length √(2A/μ₀Ms²))"));
    }
    row("wall width", wall_width(physics, h.lattice()));
    row("wall energy", wall_energy(physics));
    row("site barrier", site_barrier(physics));
    row("dominant", dominant(physics));
    rows
}

fn asked_for(rates: &RateSettings) -> String {
    let t = &rates.temperatures_k;
    let (low, high) = t.iter().fold((f64::INFINITY, 0.0f64), |(l, h), t| (l.min(*t), h.max(*t)));
    let temperatures =
        if t.len() == 1 { format!("at {low} K") } else { format!("at {} temperatures, {low} K to {high} K", t.len()) };
    let theories: Vec<&str> = rates.theories.iter().map(|t| t.name()).collect();
    format!("{temperatures}, by {}, damping {}, g {}", theories.join(" and "), rates.damping, rates.g_factor)
}

fn material(loaded: &Loaded) -> String {
    let one = |part: &PartMaterial| {
        let file = part.text.as_ref().map_or(String::new(), |text| format!(" ({})", text.file));
        let region = part.region.as_ref().map_or(String::new(), |name| format!("{name}: "));
        format!("{region}{}{file}", part.material.name)
    };
    loaded.parts.iter().map(one).collect::<Vec<_>>().join(", ")
}

fn lattice(loaded: &Loaded) -> String {
    let lattice = &loaded.lattice;
    let spacing = lattice.spacing_nm.map_or(String::new(), |a| format!(", {} apart", Length(a)));
    let frozen = match lattice.frozen.len() {
        0 => String::new(),
        _ => ", some frozen".to_string(),
    };
    let sites = counted(lattice.sites, "site", "sites");
    match (lattice.kind, lattice.is_ring()) {
        ("chain", true) => format!("ring of {sites}{spacing}{frozen}"),
        ("chain", false) => format!("open chain of {sites}{spacing}{frozen}"),
        _ => lattice.words() + &frozen,
    }
}

/// "1: 1.0000 × a apart, 480 bonds (1.875 for each site), J 1.000000 meV".
fn neighbours(lattice: &Lattice, shell: &Shell) -> String {
    let there = lattice.vacant.iter().filter(|vacant| !**vacant).count();
    let [from, to] = shell.exchange_mev;
    let range = |[low, high]: [f64; 2]| match high - low > 1e-9 * high.abs().max(low.abs()) {
        true => format!("{low:.6} to {high:.6} meV"),
        false => format!("{high:.6} meV"),
    };
    let species = shell.species.as_ref().map_or(String::new(), |[a, b]| format!("{a}–{b}, "));
    let exchange = if from == 0.0 && to == 0.0 { String::new() } else { format!(", J {}", range([from, to])) };
    let dmi = if shell.dmi_mev[1] == 0.0 { String::new() } else { format!(", |D| {}", range(shell.dmi_mev)) };
    let unit = if lattice.spacing_nm.is_some() { "nm" } else { "× a" };
    let a_site = shell.bonds as f64 / there as f64;
    format!(
        "{}: {species}{:.4} {unit} apart, {} ({a_site:.3} for each site){exchange}{dmi}",
        shell.number,
        shell.distance,
        counted(shell.bonds, "bond", "bonds")
    )
}

/// Of what the exchange is.
fn stiffness_of(lattice: &Lattice) -> &'static str {
    if lattice.is_row() { "a bond" } else { "(½ Σ J r²/a² of a site, along one direction)" }
}

fn wall_width(physics: &Physics, lattice: &Lattice) -> String {
    let nm = physics.wall_width_nm.map_or(String::new(), |nm| format!(", {nm:.4} nm"));
    match physics.wall_width_sites {
        Some(width) => format!("{width:.4} {}{nm} (√(exchange/stiffness))", lattice.counted()),
        None => "none: there is no easy axis, or no exchange".into(),
    }
}

fn wall_energy(physics: &Physics) -> String {
    let area = physics.wall_energy_mj_per_m2.map_or(String::new(), |e| format!(", {e:.4} mJ/m²"));
    match physics.wall_energy_mev {
        Some(energy) => format!("{energy:.4} meV{area} (2 √(exchange × stiffness), of a row of spins)"),
        None => "none".into(),
    }
}

fn site_barrier(physics: &Physics) -> String {
    let [low, high] = physics.site_barriers_mev;
    let range = if high - low > 1e-9 * high { format!("{low:.6} to {high:.6} meV") } else { format!("{high:.6} meV") };
    format!("{range} (a single spin from one easy direction to the other, by its own anisotropy)")
}

fn dominant(physics: &Physics) -> String {
    let Some((name, torque)) = physics.terms_mev.first() else { return "none".into() };
    let others: Vec<String> = physics.terms_mev[1..].iter().map(|(name, t)| format!("{name} {t:.4}")).collect();
    let beside = if others.is_empty() { String::new() } else { format!("; {}", others.join(", ")) };
    format!("{name} (meV, torque where neighbours disagree: {torque:.4}{beside})")
}

/// Seconds as a person would say them.
fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 0.05 => "0.05 s".into(),
        s if s < 100.0 => format!("{s:.1} s"),
        s if s < 6000.0 => format!("{:.0} minutes", s / 60.0),
        s => format!("{:.0} hours", s / 3600.0),
    }
}

fn images(problem: &Problem, scales: &Scales) -> String {
    let n = expected_images(problem, scales);
    match problem.images {
        Images::Count(_) => format!("{n}, both ends counted"),
        Images::Auto => format!("auto: {n} to begin with, then as many as the path needs"),
    }
}
