//! What a geodesic start is worth: first paths by slerp, by nlerp, by component-wise lerp and by rigid rotation.
//!
//! Three wall problems on a chain of 60 spins, J = 10 meV, K = 0.5 meV, frozen domains at both ends:
//! the wall is moved from one weak site to another; its plane is turned over a hard axis; both at once.
//! For every start: length √Σθ² of the path (rad), largest over smallest image spacing, highest energy above the initial state
//! before any relaxation (meV), shortest vector, and band evaluations until no spin is predicted to turn by more than 1e-5 rad,
//! with the implicit sweep and with velocity projection (17 images, no saddle refinement).
//!
//! ```text
//! cargo run --release --example 02_first_paths
//! ```
//! prints the table and writes it with one figure a problem to `results/gallery/02_first_paths/`.

use anyhow::{Context, Result};
use spinneb::drive::{Images, Problem, Silent, run};
use spinneb::energy::{Anisotropy, EnergyTerm, Exchange, Hamiltonian};
use spinneb::geometry::Direction;
use spinneb::lattice::{Chain, Frozen, Selection};
use spinneb::output::canvas::{BLUE, LinePlot, Series, VERMILLION};
use spinneb::path::Path;
use spinneb::path::guess::{Geodesic, GuessContext, GuessSpec, Nlerp, Rotation, component_sag};
use spinneb::spins::Spins;
use spinneb::state::{DomainWall, StateContext, StateSpec};
use std::fmt::Write;

const SITES: usize = 60;
const J: f64 = 10.0;
const K: f64 = 0.5;
const IMAGES: usize = 17;
const FOLDER: &str = "results/gallery/02_first_paths";

/// A wall problem: its ends, and what is put on the chain.
struct Case {
    name: &'static str,
    hard_mev: f64,
    weak_sites: &'static [usize],
    from: (f64, Direction),
    to: (f64, Direction),
}

/// One start, measured.
struct Row {
    problem: &'static str,
    start: &'static str,
    length_rad: f64,
    unevenness: f64,
    highest_mev: f64,
    shortest: f64,
    implicit: String,
    velocity_projection: String,
    profile: Vec<(f64, f64)>,
}

fn main() -> Result<()> {
    let y = Direction::Y;
    let cases = [
        Case { name: "wall moved by 6 sites", hard_mev: 0.0, weak_sites: &[27, 33], from: (27.0, y), to: (33.0, y) },
        Case {
            name: "wall plane turned over a hard axis",
            hard_mev: 0.25,
            weak_sites: &[],
            from: (29.5, y),
            to: (29.5, y.reversed()),
        },
        Case {
            name: "wall moved and turned",
            hard_mev: 0.25,
            weak_sites: &[27, 33],
            from: (27.0, y),
            to: (33.0, y.reversed()),
        },
    ];
    std::fs::create_dir_all(FOLDER)?;
    let mut rows = Vec::new();
    for (k, case) in cases.iter().enumerate() {
        let measured = measure(case)?;
        let canvas = figure(&measured).draw()?;
        std::fs::write(format!("{FOLDER}/first_energies_{}.svg", k + 1), canvas.svg()?)?;
        std::fs::write(format!("{FOLDER}/first_energies_{}.png", k + 1), canvas.png()?)?;
        rows.extend(measured);
    }
    let text = table(&rows);
    print!("{text}");
    std::fs::write(format!("{FOLDER}/table.md"), &text)?;
    println!("\nwritten: {FOLDER}");
    Ok(())
}

/// The chain of a case.
fn problem(case: &Case) -> Result<Problem> {
    let frozen = |site, direction| Frozen { sites: Selection::List(vec![site]), direction: Some(direction) };
    let ends = vec![frozen(0, Direction::Z), frozen(SITES - 1, Direction::Z.reversed())];
    let chain = Chain { frozen: ends, ..Chain::open(SITES) }.resolve()?;
    let mut easy = Anisotropy::uniform(SITES, K, Direction::Z);
    for &i in case.weak_sites {
        easy.k[i] = 0.5 * K;
    }
    let hard = Anisotropy::uniform(SITES, -case.hard_mev, Direction::X);
    let terms: Vec<Box<dyn EnergyTerm>> =
        vec![Box::new(Exchange::uniform(&chain, &[J])), Box::new(easy), Box::new(hard)];
    let context = StateContext::new(&chain, (J / (2.0 * K)).sqrt());
    let wall = |(center, through): (f64, Direction)| {
        let wall = DomainWall {
            center: center.into(),
            width: None,
            normal: None,
            left: None,
            right: None,
            through: Some(through),
            staggered: false,
        };
        StateSpec::DomainWall(wall).build(&context)
    };
    let (a, b) = (wall(case.from)?, wall(case.to)?);
    let hamiltonian = Hamiltonian::new(&chain, terms)?;
    let mut problem = Problem::new(hamiltonian, a, b);
    problem.images = Images::Count(IMAGES);
    (problem.refine, problem.certify, problem.neb.climb) = (false, false, false);
    problem.neb.tolerance = 1e-5;
    Ok(problem)
}

/// All starts of a case, between its relaxed ends.
fn measure(case: &Case) -> Result<Vec<Row>> {
    let relaxed = run(&problem(case)?, &mut Silent)?.path;
    let (a, b) = (relaxed.spins(0), relaxed.spins(relaxed.images() - 1));
    let axis = Some(Direction::Z);
    let starts = [
        ("slerp", GuessSpec::Geodesic(Geodesic { axis })),
        ("nlerp", GuessSpec::Nlerp(Nlerp { axis })),
        ("lerp", GuessSpec::Nlerp(Nlerp { axis })),
        ("rotation", GuessSpec::Rotation(Rotation { axis })),
    ];
    starts.into_iter().map(|(name, guess)| row(case, name, guess, &a, &b)).collect()
}

fn row(case: &Case, start: &'static str, guess: GuessSpec, a: &Spins, b: &Spins) -> Result<Row> {
    let of = problem(case)?;
    let states = StateContext::new(of.hamiltonian.lattice(), (J / (2.0 * K)).sqrt());
    let context = GuessContext { states, default_axis: Direction::Z };
    let path: Path = guess.member().path(a, b, IMAGES, &context)?;
    let spacing = path.spacings();
    let (low, high) = spacing.iter().fold((f64::MAX, 0.0f64), |(l, h), s| (l.min(*s), h.max(*s)));
    let h = &of.hamiltonian;
    let energies: Vec<f64> = (0..IMAGES).map(|k| h.difference_mev(path.image(k), path.image(0))).collect();
    let fine: Path = guess.member().path(a, b, 129, &context)?;
    let energy = |k: usize| h.difference_mev(fine.image(k), fine.image(0));
    let profile = fine.reaction_coordinate().into_iter().enumerate().map(|(k, s)| (s, energy(k))).collect();
    let shortest = if start == "lerp" { component_sag(a, b) } else { 1.0 };
    Ok(Row {
        problem: case.name,
        start,
        length_rad: path.length(),
        unevenness: high / low,
        highest_mev: energies.iter().copied().fold(0.0, f64::max),
        shortest,
        implicit: evaluations(case, &guess, r#"{"implicit": {}}"#)?,
        velocity_projection: evaluations(case, &guess, r#"{"velocity_projection": {}}"#)?,
        profile,
    })
}

/// Band evaluations to convergence, and the barrier reached.
fn evaluations(case: &Case, guess: &GuessSpec, optimiser: &str) -> Result<String> {
    let mut problem = problem(case)?;
    problem.guess = Some(guess.clone());
    problem.neb.optimiser = serde_json::from_str(optimiser)?;
    problem.neb.max_evaluations = 20_000;
    let outcome = run(&problem, &mut Silent)?;
    let barrier = outcome.barrier.context("a barrier")?.forward_mev;
    let mark = if outcome.converged { "" } else { ", not converged" };
    Ok(format!("{}{mark} → {barrier:.4} meV", outcome.work.iterations))
}

fn table(rows: &[Row]) -> String {
    let mut t = String::from(
        "| problem | start | length (rad) | spacing max/min | highest first energy (meV) | shortest vector | implicit: evaluations → barrier | velocity projection |\n|---|---|---|---|---|---|---|---|\n",
    );
    for r in rows {
        let _ = writeln!(
            t,
            "| {} | {} | {:.4} | {:.3} | {:.4} | {:.3} | {} | {} |",
            r.problem,
            r.start,
            r.length_rad,
            r.unevenness,
            r.highest_mev,
            r.shortest,
            r.implicit,
            r.velocity_projection
        );
    }
    let pair = |problem: &str, start: &str| rows.iter().find(|r| r.problem == problem && r.start == start);
    for r in rows.iter().filter(|r| r.start == "slerp") {
        if let (Some(n), Some(q)) = (pair(r.problem, "nlerp"), pair(r.problem, "rotation")) {
            let _ = writeln!(
                t,
                "\n{}: the geodesic is {:.1} % shorter than nlerp, whose spacings differ by a factor {:.2}; its highest first energy is {:.1} times that of the rigid rotation, which is {:.0} % longer.",
                r.problem,
                100.0 * (1.0 - r.length_rad / n.length_rad),
                n.unevenness,
                r.highest_mev / q.highest_mev,
                (100.0 * (q.length_rad / r.length_rad - 1.0)).max(0.0)
            );
        }
    }
    t.push_str(
        "\nRead with the table: in these three problems no start is shorter or more even than the geodesic, though the rigid rotation \
         often equals it in evenness, and is the geodesic itself where the wall only moves. In evaluations the geodesic gains little: \
         where the wall only moves, all starts need about as many. Where the wall turns its plane the geodesic is the wrong start: it \
         leads every spin through a pole, and its band converges to a path whose barrier is far above that of the rotation. In the \
         third problem it is the only start that meets the tolerance with the implicit sweep, at a barrier above those at which the \
         others stop unconverged, so it is not shown to be the lowest. A converged band is not the lowest path: that is why several \
         starts are tried by default, and saddles are refined and certified, which is switched off here.\n",
    );
    t.push_str(
        "\nThe lerp row is normalised before it is measured and relaxed, all but its shortest vector: its points are those of nlerp, made with the same rule for opposite spins.\n",
    );
    t
}

/// First energies along the path; nlerp and lerp pass through the slerp's points at other paces.
fn figure(rows: &[Row]) -> LinePlot {
    let mut plot = LinePlot::new("Reaction coordinate (rad)", "First energy (meV)");
    for (r, colour) in rows.iter().filter(|r| ["slerp", "rotation"].contains(&r.start)).zip([BLUE, VERMILLION]) {
        plot = plot.with(Series::line(r.profile.clone()).colour(colour).label(r.start));
    }
    plot
}
