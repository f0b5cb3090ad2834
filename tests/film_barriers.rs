//! Barriers of films and crystals against independent values, and the traps on the way to them.

use spinneb::band::Band;
use spinneb::config::load_text;
use spinneb::drive::{Outcome, Problem, Scales, Silent, run};
use spinneb::energy::Hamiltonian;
use spinneb::files::{Images, Stored};
use spinneb::geometry::{Direction, Vector, rotate, vector};
use spinneb::landscape::{Effort, Peak, Saddle, peaks};
use spinneb::lattice::Lattice;
use spinneb::path::guess::{GuessSpec, PathFile};
use spinneb::path::{Path, largest_angle};
use spinneb::spins::Spins;
use spinneb::stationary::{Downhill, Spectrum, State, descend, refine, relax_to_minimum};
use std::sync::Arc;

/// Images of a first path.
const IMAGES: usize = 17;

fn references() -> Vec<serde_json::Value> {
    let text = std::fs::read_to_string("tests/reference/lattices.json").unwrap();
    serde_json::from_str::<serde_json::Value>(&text).unwrap()["cases"].as_array().unwrap().clone()
}

fn problem(config: &str) -> Problem {
    load_text(std::path::Path::new("film.json"), config.to_string()).unwrap().problem().unwrap()
}

/// A film with so many cells, terms of the energy, and a skyrmion about `center` or a uniform state up at first.
fn film(cells: [usize; 2], periodic: bool, energy: &str, initial: &str, end: &str) -> Problem {
    problem(&format!(
        r#"{{"material": {{"name": "test", "moment": "1 mu_B", "energy": [{energy}]}},
            "lattice": {{"square": {{"cells": [{}, {}], "periodic": {periodic}}}}}, "initial": {initial}, "final": {end}}}"#,
        cells[0], cells[1]
    ))
}

const UP: &str = r#"{"uniform": {"direction": [0, 0, 1]}}"#;
const DOWN: &str = r#"{"uniform": {"direction": [0, 0, -1]}}"#;

/// J = 1, D = 0.6 q, K = 0.1 q², b = 0.2 q² meV: the same skyrmion on a lattice finer by q, about a site or between four.
fn skyrmion(cells: usize, q: f64, center: f64) -> Problem {
    let energy = format!(
        r#"{{"exchange": {{"J": ["1 meV"]}}}}, {{"dmi": {{"D": "{} meV", "kind": "interfacial"}}}},
           {{"anisotropy": {{"K": "{} meV", "axis": [0, 0, 1]}}}}, {{"zeeman": {{"B": ["0 T", "0 T", "{} T"]}}}}"#,
        0.6 * q,
        0.1 * q * q,
        0.2 * q * q / 0.057883817982
    );
    let initial = format!(r#"{{"skyrmion": {{"radius": {}, "center": [{center}, {center}]}}}}"#, 3.0 / q);
    film([cells, cells], true, &energy, &initial, UP)
}

fn reversal(cells: usize, k: f64) -> Problem {
    let energy =
        format!(r#"{{"exchange": {{"J": ["1 meV"]}}}}, {{"anisotropy": {{"K": "{k} meV", "axis": [0, 0, 1]}}}}"#);
    film([cells, cells], false, &energy, UP, DOWN)
}

/// Every spin turns along its own great circle while a front of that width passes its key; opposite ones about `axis`.
fn clock(a: &Spins, b: &Spins, key: &[f64], width: f64, axis: impl Fn(usize) -> Vector) -> Path {
    let least = key.iter().copied().fold(f64::INFINITY, f64::min);
    let length = key.iter().copied().fold(f64::NEG_INFINITY, f64::max) - least + 1e-9;
    let spin = |i: usize, time: f64| {
        let (p, q) = (a.get(i), b.get(i));
        let turn = vector::cross(p, q);
        let angle = vector::norm(turn).atan2(vector::dot(p, q));
        let chosen = [turn, axis(i), [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(|v| vector::normal_part(v, p));
        let about = chosen.into_iter().find(|v| vector::norm(*v) > 1e-6).unwrap();
        let gone = ((time * (length + width) - (key[i] - least)) / width).clamp(0.0, 1.0);
        rotate(p, Direction::new(about).unwrap(), gone * gone * (3.0 - 2.0 * gone) * angle)
    };
    let image = |k: usize| {
        let time = k as f64 / (IMAGES - 1) as f64;
        let spins: Vec<Vector> = (0..a.sites()).map(|i| spin(i, time)).collect();
        Spins::from_vectors(&spins).unwrap()
    };
    let inner = (1..IMAGES - 1).map(image);
    Path::new(&[a.clone()].into_iter().chain(inner).chain([b.clone()]).collect::<Vec<_>>()).resampled(IMAGES)
}

/// A first path in the reference's words: a straight front from an edge or a face, or a round one inwards about a hollow.
fn first_path(h: &Hamiltonian, a: &Spins, b: &Spins, kind: &str, wall: f64, center: Vector) -> Path {
    let lattice = h.lattice();
    let key = |of: &dyn Fn(Vector) -> f64| -> Vec<f64> { (0..h.sites()).map(|i| of(lattice.place(i))).collect() };
    let along = |d: usize| clock(a, b, &key(&|p| p[d]), wall, |_| [1.0, 0.0, 0.0]);
    let off = |p: Vector| vector::sub([p[0], p[1], 0.0], [center[0], center[1], 0.0]);
    match kind {
        "edge x" | "face" => along(0),
        "edge y" => along(1),
        "round" => clock(a, b, &key(&|p| -vector::norm(off(p))), 6.0, |i| {
            vector::cross([0.0, 0.0, 1.0], off(lattice.place(i)))
        }),
        _ => clock(a, b, &vec![0.0; h.sites()], 1.0, |_| [1.0, 0.0, 0.0]),
    }
}

/// Runs a problem from a first path of that kind between its relaxed ends, without a search for others.
fn from_path(mut problem: Problem, kind: &str, wall: f64, center: Vector) -> Outcome {
    let h = &problem.hamiltonian;
    let tolerance = 1e-14 * h.stiffness_mev();
    let [a, b] =
        [&problem.initial, &problem.final_state].map(|end| relax_to_minimum(h.into(), end, tolerance).unwrap().spins);
    let path = first_path(h, &a, &b, kind, wall, center);
    let images = (0..IMAGES).map(|k| path.spins(k).vectors()).collect();
    let stored = Stored { file: "path".into(), content: Images { images, ..Images::default() } };
    let file = PathFile { path: "path".into(), sha256: None, stored: Some(Arc::new(stored)) };
    (problem.initial, problem.final_state) = (a, b);
    problem.guess = Some(GuessSpec::File(file));
    problem.search = Effort::None;
    run(&problem, &mut Silent).unwrap()
}

/// The site nearest to the middle of a lattice.
fn middle_site(lattice: &Lattice) -> Vector {
    let mean = (0..lattice.sites).map(|i| lattice.place(i)).fold([0.0; 3], vector::add);
    let mean = vector::scale(1.0 / lattice.sites as f64, mean);
    let far = |p: &Vector| vector::norm(vector::sub(*p, mean));
    (0..lattice.sites).map(|i| lattice.place(i)).min_by(|p, q| far(p).total_cmp(&far(q))).unwrap()
}

/// The middle of the largest hole beside that.
fn hollow(lattice: &Lattice) -> Vector {
    let [a, b, _] = lattice.cell_vectors();
    let part = if lattice.kind == "triangular" { 1.0 / 3.0 } else { 0.5 };
    vector::add(middle_site(lattice), vector::scale(part, vector::add(a, b)))
}

#[test]
fn reference_barriers_are_certified_with_their_lowest_modes() {
    let mut compared = Vec::new();
    for case in references() {
        let name = case["name"].as_str().unwrap();
        let Some(kind) = case["first_path"].as_str() else { continue };
        let mut config = case["config"].clone();
        let Ok(loaded) = load_text(std::path::Path::new(name), config.to_string()) else { continue };
        let mut problem = loaded.problem().unwrap();
        if let Some(skyrmion) = config["initial"]["skyrmion"].as_object_mut().filter(|s| !s.contains_key("center")) {
            // a skyrmion about the hexagon beside the middle is another minimum, 8e-6 meV higher
            let [x, y, _] = middle_site(problem.hamiltonian.lattice());
            skyrmion.insert("center".into(), serde_json::json!([x, y]));
            problem = self::problem(&config.to_string());
        }
        let wall = 4.0 * Scales::of_terms(&problem.hamiltonian).wall_width_sites;
        let center = hollow(problem.hamiltonian.lattice());
        let scale = problem.hamiltonian.stiffness_mev();
        let found = from_path(problem, kind, wall, center);
        assert!(found.certified, "{name}: {:?}", found.warnings);
        let barrier = found.barrier.unwrap();
        for (direction, mev) in [("forward", barrier.forward_mev), ("backward", barrier.backward_mev)] {
            let expected = case["barrier_meV"][direction].as_f64().unwrap();
            let within = case["tolerance_relative"].as_f64().unwrap() * expected + 1e-13 * scale;
            assert!((mev - expected).abs() < within, "{name}: {direction} {mev} {expected}");
        }
        let highest = found.saddles.iter().max_by(|p, q| p.above_initial_mev.total_cmp(&q.above_initial_mev)).unwrap();
        let listed: Vec<f64> = case["lowest_eigenvalues_meV"]["saddle"].as_array().map_or(Vec::new(), |all| {
            all.iter().filter_map(|v| v.as_f64()).filter(|v| v.abs() > 1e-12 * scale).collect()
        });
        let largest = listed.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        for (mode, expected) in highest.lowest_eigenvalues_mev.iter().zip(&listed) {
            assert!((mode - expected).abs() < 1e-6 * largest, "{name}: {mode} {expected}");
        }
        compared.push(name.to_string());
    }
    assert!(compared.len() == 15, "{compared:?}");
}

/// Runs a problem from its natural first paths without a search for others.
fn by_default(mut problem: Problem) -> Outcome {
    problem.search = Effort::None;
    run(&problem, &mut Silent).unwrap()
}

#[test]
fn natural_first_paths_find_the_reference_barriers() {
    let mut compared = 0;
    for case in references() {
        let found = by_default(problem(&case["config"].to_string()));
        let (name, barrier) = (&case["name"], found.barrier.unwrap());
        assert!(found.certified, "{name}: {:?}", found.warnings);
        for (direction, mev) in [("forward", barrier.forward_mev), ("backward", barrier.backward_mev)] {
            let expected = case["barrier_meV"][direction].as_f64().unwrap();
            let within = case["tolerance_relative"].as_f64().unwrap() * expected;
            assert!((mev - expected).abs() < within, "{name}: {direction} {mev} {expected}");
        }
        compared += 1;
    }
    assert_eq!(compared, 22);
}

/// A reference problem with other keys at its root.
fn reference_with(name: &str, key: &str, value: serde_json::Value) -> Problem {
    let case = references().into_iter().find(|case| case["name"] == name).unwrap();
    let mut config = case["config"].clone();
    config[key] = value;
    problem(&config.to_string())
}

#[test]
fn disorder_asks_for_every_edge_and_every_top_of_a_path_is_refined() {
    // from y over 18.966; from x over three saddles, of which the last one alone would be 18.884
    for (side, expected) in [([-1, 0, 0], 19.231164476956), ([0, -1, 0], 18.966186443395)] {
        let guess = serde_json::json!({"guess": {"sweep": {"from": side}}});
        let found = by_default(reference_with("grains24", "path", guess));
        assert!(found.certified && found.saddles.len() > 1);
        assert!((found.barrier.unwrap().forward_mev - expected).abs() < 1e-9, "{side:?}: {:?}", found.barrier);
        let highest = found.saddles.iter().map(|s| s.above_initial_mev).fold(f64::MIN, f64::max);
        assert!((highest - expected).abs() < 1e-9 && found.saddles.iter().any(|s| s.above_initial_mev < 18.9));
    }
}

#[test]
fn a_band_too_coarse_for_its_peak_comes_to_the_same_saddle() {
    for images in [5, 7] {
        let path = serde_json::json!({"images": images});
        let found = by_default(reference_with("square20_collapse", "path", path));
        let barrier = found.barrier.unwrap().forward_mev;
        assert!(found.certified && (barrier - 4.329255887059).abs() < 1e-9, "{images}: {barrier}");
    }
}

#[test]
fn a_minimum_half_way_splits_the_path_into_two_equal_saddles() {
    // with a Dzyaloshinskii–Moriya interaction the wall across the film is a true minimum
    let case = references().into_iter().find(|case| case["name"] == "square24_dmi").unwrap();
    let found = by_default(problem(&case["config"].to_string()));
    assert!(found.certified && found.saddles.len() == 2 && found.intermediate_minima.len() == 1);
    let [first, second] = [0, 1].map(|k| found.saddles[k].above_initial_mev);
    assert!((first - second).abs() < 1e-9 && found.intermediate_minima[0].state.energy_mev < -1125.849);
}

#[test]
fn natural_first_paths_take_few_evaluations_at_any_number_of_sites() {
    for cells in [16, 32, 64] {
        let found = by_default(reversal(cells, 0.1 * (16.0 / cells as f64).powi(2)));
        assert!(found.certified && found.work.iterations <= 15, "{cells}: {}", found.work.iterations);
        assert!(found.hessian_products_an_image() <= 150.0, "{cells}: {}", found.hessian_products_an_image());
    }
    for cells in [20, 32, 44, 64] {
        let found = by_default(skyrmion(cells, 1.0, (cells / 2) as f64));
        assert!(found.certified && found.work.iterations <= 25, "{cells}: {}", found.work.iterations);
        assert!(
            (1.0..=150.0).contains(&found.hessian_products_an_image()) || cells < 32,
            "{cells}: {}",
            found.hessian_products_an_image()
        );
    }
    // the way down after a nucleus relaxes slowly, and no barrier depends on it
    let nucleus = reference_with("square24_field", "name", "nucleus".into());
    let found = by_default(nucleus);
    assert!(found.certified && found.work.iterations <= 15, "{}", found.work.iterations);
}

/// Band evaluations of a run, and its barrier.
fn evaluations(problem: Problem, kind: &str) -> (usize, f64) {
    let wall = 4.0 * Scales::of_terms(&problem.hamiltonian).wall_width_sites;
    let center = hollow(problem.hamiltonian.lattice());
    let found = from_path(problem, kind, wall, center);
    assert!(found.certified, "{:?}", found.warnings);
    (found.work.iterations, found.barrier.unwrap().forward_mev)
}

#[test]
fn a_band_takes_as_many_evaluations_on_a_finer_and_on_a_larger_film() {
    for cells in [16, 32, 48] {
        let (count, barrier) = evaluations(reversal(cells, 0.1 * (16.0 / cells as f64).powi(2)), "edge x");
        assert!(count <= 15 && (14.1..14.3).contains(&barrier), "{cells}: {count} {barrier}");
    }
    for cells in [20, 32, 44] {
        let (count, barrier) = evaluations(skyrmion(cells, 1.0, (cells / 2) as f64), "round");
        assert!(count <= 25 && (4.329..4.333).contains(&barrier), "{cells}: {count} {barrier}");
    }
}

#[test]
fn a_large_skyrmion_that_slides_freely_has_a_certified_barrier_on_a_narrow_peak() {
    // translational eigenvalues of 2.7e-10 meV beside a gap of 0.02; the peak is a few images wide
    let (count, barrier) = evaluations(skyrmion(40, 0.5, 20.0), "round");
    assert!((barrier - 6.289025321835).abs() < 1e-9 && count <= 45, "{count} {barrier}");
}

#[test]
fn a_skyrmion_put_between_four_sites_is_no_minimum_and_is_left() {
    let [site, hole] = [10.0, 10.5].map(|center| skyrmion(20, 1.0, center));
    let h = &site.hamiltonian;
    let [a, b] = [&site, &hole].map(|p| relax_to_minimum(h.into(), &p.initial, 1e-14 * h.stiffness_mev()).unwrap());
    for end in [&a, &b] {
        let state = State::at(h.into(), end.spins.as_slice().to_vec());
        let spectrum = Spectrum::of(h.into(), &state, 2);
        assert_eq!((spectrum.negative, spectrum.flat), (0, 0));
        assert!((spectrum.lowest_mev[0] - 6.8397e-5).abs() < 1e-8, "{:?}", spectrum.lowest_mev);
    }
    assert!(h.difference_mev(a.spins.as_slice(), b.spins.as_slice()).abs() < 1e-12);
}

#[test]
fn the_last_digits_of_a_film_take_the_factors_of_one_step_and_rest_as_exactly() {
    let problem = skyrmion(40, 1.0, 20.0);
    let h = problem.evaluator();
    let tolerance = 1e-14 * h.stiffness_mev();
    let minimum = &problem.final_state;
    let turned = |i: usize| rotate(minimum.get(i), Direction::X, 0.02 * (0.7 * i as f64).sin());
    let beside = Spins::from_vectors(&(0..minimum.sites()).map(turned).collect::<Vec<_>>()).unwrap();
    let before = h.evaluated();
    let again = relax_to_minimum(h, &beside, tolerance).unwrap();
    let count = h.evaluated().since(before);
    // one to begin with, one whose factors serve to the end, and that of the spectrum
    assert!(count.hessians <= 3 && count.evaluations > count.hessians, "{count:?}");
    assert!(again.max_torque_mev <= tolerance && again.spectrum.unwrap().negative == 0);
    assert!(largest_angle(again.spins.as_slice(), minimum.as_slice()) < 1e-9);
}

#[test]
fn a_descent_that_forks_at_the_end_goes_to_the_place_that_was_given() {
    for cells in [16, 20, 22] {
        let found = by_default(skyrmion(cells, 1.0, (cells / 2) as f64));
        assert!(found.certified && found.saddles.len() == 1, "{cells}: {} saddles", found.saddles.len());
    }
}

#[test]
fn a_descent_ends_at_a_minimum_beside_it_where_it_has_reached_that_and_nowhere_else() {
    let problem = skyrmion(20, 1.0, 10.0);
    let h = &problem.hamiltonian;
    let tolerance = 1e-14 * h.stiffness_mev();
    let [skyrmion, up] =
        [&problem.initial, &problem.final_state].map(|end| relax_to_minimum(h.into(), end, tolerance).unwrap().spins);
    let found = by_default(self::skyrmion(20, 1.0, 10.0));
    let saddle = State::at(h.into(), found.saddles[0].spins.as_slice().to_vec());
    let valley = saddle.field(&saddle.lowest_mode(h.into()).unwrap().vector);
    for beside in [&[][..], &[&up], &[&skyrmion], &[&skyrmion, &up]] {
        let ends = [-1.0, 1.0].map(|sense| {
            let down: Vec<f64> = valley.iter().map(|v| sense * v).collect();
            let descent =
                descend(h.into(), &saddle, &down, Downhill { c: 0.2, level_mev: 0.0, beside, most: usize::MAX });
            assert!(descent.arrived && descent.fallen_mev > 4.0, "{}", descent.fallen_mev);
            descent.m
        });
        let is_up = |end: &[f64]| h.difference_mev(end, up.as_slice()).abs() < 1e-9;
        let is_skyrmion = |end: &[f64]| h.difference_mev(end, skyrmion.as_slice()).abs() < 1e-9;
        let [a, b] = &ends;
        assert!(is_up(a) && is_skyrmion(b) || is_skyrmion(a) && is_up(b), "{} beside", beside.len());
        let is_there = |end: &Spins| a == end.as_slice() || b == end.as_slice();
        assert!(!beside.contains(&&up) || is_there(&up), "it is that minimum to the bit");
    }
}

#[test]
fn a_cube_whose_descents_go_without_factors_takes_the_way_and_the_work_of_one_with_them() {
    let k = 0.1;
    let found = by_default(problem(&format!(
        r#"{{"material": {{"name": "cube", "moment": "1 mu_B", "energy": [{{"exchange": {{"J": ["1 meV"]}}}},
            {{"anisotropy": {{"K": "{k} meV", "axis": [0, 0, 1]}}}}]}},
            "lattice": {{"cubic": {{"cells": [16, 16, 16]}}}}, "initial": {UP}, "final": {DOWN}}}"#
    )));
    assert!(found.certified, "{:?}", found.warnings);
    // with factors: 226.2930114606627 meV in 4 evaluations and 698 gradients
    assert!((found.barrier.unwrap().forward_mev - 226.29301146066).abs() < 1e-9, "{:?}", found.barrier);
    assert!(found.work.iterations <= 8 && found.work.force_evaluations < 900, "{:?}", found.work);
}

#[test]
fn a_search_that_slides_down_the_path_to_the_hop_of_a_skyrmion_finds_no_saddle() {
    let problem = skyrmion(20, 1.0, 10.0);
    let h = &problem.hamiltonian;
    let tolerance = 1e-14 * h.stiffness_mev();
    let [a, b] =
        [&problem.initial, &problem.final_state].map(|end| relax_to_minimum(h.into(), end, tolerance).unwrap().spins);
    let path = first_path(h, &a, &b, "round", 4.0, hollow(h.lattice()));
    let mut band = Band::new(h, path);
    band.evaluate();
    // a start far down the path, as that of a peak that it is not
    let start = 3;
    let tau = band.tangent(start).to_vec();
    let energy_mev = band.energies_mev()[start];
    let slid = refine(h.into(), band.path().image(start), &tau, f64::NEG_INFINITY);
    let above = h.difference_mev(&slid.state.m, a.as_slice());
    assert!(above < 0.1 * (energy_mev - band.energies_mev()[0]), "the search slides down: {above}");
    let top = peaks(&band, 0.4).remove(0);
    let peak = Peak { m: band.path().image(start).to_vec(), tau, energy_mev, ..top };
    let found = Saddle::at(h.into(), Peak { floor_mev: energy_mev - 0.1, ..peak });
    assert!(!found.is_saddle(0.4) || found.refined.state.energy_mev > energy_mev - 0.1);
}

#[test]
fn islands_without_bonds_between_them_and_films_of_four_sites_have_barriers() {
    let energy = r#"{"exchange": {"J": ["1 meV"]}}, {"anisotropy": {"K": "0.3 meV", "axis": [0, 0, 1]}},
        {"anisotropy": {"K": "-0.2 meV", "axis": [1, 0, 0]}}"#;
    let four = film([2, 2], false, energy, UP, DOWN);
    let found = run(&four, &mut Silent).unwrap();
    assert!(found.certified && (found.barrier.unwrap().forward_mev - 1.2).abs() < 1e-12, "{:?}", found.barrier);
    let islands = problem(&format!(
        r#"{{"material": {{"name": "test", "moment": "1 mu_B", "energy": [{energy}]}},
            "lattice": {{"square": {{"cells": [5, 3], "vacant": [2, 7, 12]}}}}, "initial": {UP}, "final": {DOWN}}}"#
    ));
    let found = run(&islands, &mut Silent).unwrap();
    // one island after the other: 6 spins, K each
    assert!(found.certified && (found.barrier.unwrap().forward_mev - 1.8).abs() < 1e-9, "{:?}", found.barrier);
}

/// A film in which a skyrmion rests at a barrier of some 25 meV from going out.
fn easy_film(cells: [usize; 2], keys: &str, initial: &str, end: &str, effort: Effort) -> Outcome {
    let energy = r#"{"exchange": {"J": ["10 meV"]}}, {"dmi": {"D": "4 meV", "kind": "interfacial"}},
        {"anisotropy": {"K": "2.2 meV", "axis": [0, 0, 1]}}"#;
    let mut problem = problem(&format!(
        r#"{{"material": {{"name": "test", "moment": "2 mu_B", "energy": [{energy}]}},
            "lattice": {{"square": {{"cells": {cells:?}{keys}}}}}, "initial": {initial}, "final": {end}}}"#
    ));
    problem.search = effort;
    run(&problem, &mut Silent).unwrap()
}

/// A certified barrier that is no higher than one of a path made by hand, and as high as its certificate says (meV).
fn is_no_higher(found: &Outcome, expected_mev: f64) {
    let barrier = found.barrier.unwrap().forward_mev;
    assert!(found.certified && (barrier - expected_mev).abs() < 1e-5, "{barrier} {expected_mev}");
}

#[test]
fn a_skyrmion_moves_along_a_track_from_place_to_place() {
    let at = |x: f64| format!(r#"{{"skyrmion": {{"radius": 4, "center": [{x}, 7.5]}}}}"#);
    for effort in [Effort::None, Effort::Normal] {
        // out over an edge and in again it is 76.6 meV
        let found = easy_film([36, 16], "", &at(10.0), &at(24.0), effort);
        assert!(found.certified && found.barrier.unwrap().forward_mev < 0.02, "{:?}", found.barrier);
    }
}

#[test]
fn more_effort_leaves_no_higher_path_and_a_skyrmion_leaves_over_an_edge() {
    let spot = r#"{"skyrmion": {"radius": 4}}"#;
    // where it collapses it is 26.328 meV: to that its drift relaxes too, after some evaluations
    for effort in [Effort::None, Effort::Normal] {
        is_no_higher(&easy_film([30, 30], "", spot, UP, effort), 20.588116);
    }
}

#[test]
fn a_skyrmion_goes_out_in_a_hole_of_a_film_without_edges() {
    let hole = r#", "periodic": true, "shape": {"not": {"disc": {"center": [6, 6], "radius": 3.2}}}"#;
    let spot = r#"{"skyrmion": {"radius": 4, "center": [17, 17]}}"#;
    // beside it 26.931 meV
    for (a, b) in [(spot, UP), (UP, spot)] {
        let found = easy_film([30, 30], hole, a, b, Effort::Normal);
        let [forward, backward] = found.barrier.map(|b| [b.forward_mev, b.backward_mev]).unwrap();
        let out = if a == spot { forward } else { backward };
        assert!(found.certified && (out - 8.317754).abs() < 1e-5, "{forward} {backward}");
    }
}
