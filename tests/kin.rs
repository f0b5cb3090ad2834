//! Saddles that a broken symmetry leaves all but alike: rates count them, searches start from them. And circles about an axis that are no
//! valleys.

use serde_json::{Value, json};
use spinneb::config::load_text;
use spinneb::drive::survey::{Label, survey};
use spinneb::drive::{Outcome, Problem, Silent};
use spinneb::rates::{Sibling, Siblings, Theory};

/// The config of a reversal along z, or of another end, with terms, a lattice and a temperature.
fn config(energy: Value, lattice: Value, initial: Value, kelvin: f64) -> String {
    json!({
        "material": {"name": "kin", "moment": "2 mu_B", "energy": energy},
        "lattice": lattice,
        "initial": initial,
        "final": {"uniform": {"direction": [0, 0, if initial.get("skyrmion").is_some() { 1 } else { -1 }]}},
        "rates": {"temperatures": [format!("{kelvin} K")], "damping": 1.0},
    })
    .to_string()
}

fn up() -> Value {
    json!({"uniform": {"direction": [0, 0, 1]}})
}

fn anisotropy(k: &str, axis: [i32; 3]) -> Value {
    json!({"anisotropy": {"K": k, "axis": axis}})
}

fn field(tesla: [f64; 3]) -> Value {
    json!({"zeeman": {"B": tesla.map(|b| format!("{b} T"))}})
}

fn problem(config: &str) -> Problem {
    load_text("kin.json".as_ref(), config.into()).unwrap().problem().unwrap()
}

fn solve(config: &str) -> Outcome {
    let outcome = crate::common::solve(&problem(config));
    assert!(outcome.certified, "{:?}", outcome.warnings);
    outcome
}

/// 1/s out of the first minimum, and to the other end.
fn rates(outcome: &Outcome) -> [f64; 2] {
    let row = &outcome.rates.as_ref().unwrap().transitions[0].rows[0];
    [&row.escape, &row.passage].map(|row| row.ln_langer_per_s.expect("a rate").exp())
}

/// One spin with four saddles side by side, in a field.
fn four_ways(tesla: [f64; 3]) -> String {
    let cubic = json!({"cubic_anisotropy": {"K": "0.5 meV"}});
    let energy = json!([anisotropy("1 meV", [0, 0, 1]), cubic, field(tesla)]);
    config(energy, json!({"chain": {"sites": 1}}), up(), 0.58)
}

#[test]
fn a_stray_field_leaves_a_rate_as_it_is_without_one() {
    let [free, _] = rates(&solve(&four_ways([0.0; 3])));
    for tesla in [1e-9, 1e-5, 1e-3] {
        let outcome = solve(&four_ways([tesla, 0.4 * tesla, 0.0]));
        let [rate, _] = rates(&outcome);
        assert!((rate / free - 1.0).abs() < 1e-3 * (1.0 + 1e3 * tesla), "{tesla}: {rate} {free}");
        let regime = &outcome.rates.as_ref().unwrap().saddles[0].regimes[0];
        assert_eq!((regime.equivalents.count, regime.siblings.0.len()), (1, 3));
        // in the field a saddle lies lower by what it is magnetised along it
        let moved = 2.0 * 0.057_883_818 * tesla;
        let mut heights: Vec<f64> = regime.siblings.0.iter().map(|s| s.above_mev / moved).chain([0.0]).collect();
        heights.sort_by(f64::total_cmp);
        for (height, expected) in heights.iter().zip([0.0, 0.6, 1.4, 2.0]) {
            assert!((height - heights[0] - expected).abs() < 1e-3 + 10.0 * tesla, "{tesla}: {heights:?}");
        }
    }
}

#[test]
fn siblings_at_their_own_saddles_give_what_a_landscape_tells_of_all() {
    // by the four saddles of a landscape, each with its own prefactor and height
    for tesla in [0.01, 0.05] {
        let text = four_ways([tesla, 0.4 * tesla, 0.0]);
        let [_, rate] = rates(&solve(&text));
        let named = text.replace("\"rates\"", r#""landscape": {"groups": {"up": {"axis": [0, 0, 1], "from": 0.5}, "down": {"axis": [0, 0, -1], "from": 0.5}}}, "rates""#);
        let loaded = load_text("kin.json".as_ref(), named).unwrap().survey().unwrap();
        assert!(matches!(loaded.groups[0].1, Label::MeanSpin { .. }));
        let found = survey(&loaded, &mut Silent).unwrap();
        let rows = found.lifetimes.unwrap().rows;
        let row = rows.iter().find(|row| row.from == "up" && row.to.as_deref() == Some("down")).unwrap();
        let expected = (-row.ln_time_s[1].unwrap()).exp();
        // the prefactors of the others differ from the path's by as much as the field moves the spins
        assert!((rate / expected - 1.0).abs() < 0.2 * tesla, "{tesla}: {rate} {expected}");
    }
}

#[test]
fn a_film_is_left_over_all_its_corners_however_weak_what_tells_them_apart() {
    let film = |bx: f64| {
        let exchange = json!({"exchange": {"J": ["6 meV"]}});
        let [easy, hard] = [anisotropy("1.5 meV", [0, 0, 1]), anisotropy("-0.2 meV", [0, 1, 0])];
        let energy = json!([exchange, easy, hard, field([bx, 0.4 * bx, 0.0])]);
        rates(&solve(&config(energy, json!({"square": {"cells": [6, 6]}}), up(), 8.0)))
    };
    let free = film(0.0);
    let stray = film(1e-5);
    assert!((0..2).all(|k| (stray[k] / free[k] - 1.0).abs() < 1e-3), "{stray:?} {free:?}");
}

#[test]
fn a_ring_turns_over_at_any_of_its_sites_over_either_side() {
    let ring = |by: f64, disorder: f64| {
        let k: Vec<String> = (0..6).map(|i| format!("{} meV", 10.0 * (1.0 + disorder * f64::from(i)))).collect();
        let easy =
            json!({"anisotropy": {"K": if disorder == 0.0 { json!("10 meV") } else { json!(k) }, "axis": [0, 0, 1]}});
        let energy =
            json!([{"exchange": {"J": ["0.5 meV"]}}, easy, anisotropy("-4 meV", [0, 1, 0]), field([by, 0.0, 0.0])]);
        rates(&solve(&config(energy, json!({"chain": {"sites": 6, "periodic": true}}), up(), 8.0)))
    };
    let free = ring(0.0, 0.0);
    // with its shifts, and without them
    for (stray, off) in [(ring(1e-5, 0.0), 1e-3), (ring(0.0, 1e-6), 1e-3), (ring(1e-5, 1e-6), 1e-3)] {
        assert!((0..2).all(|k| (stray[k] / free[k] - 1.0).abs() < off), "{stray:?} {free:?}");
    }
}

#[test]
fn a_skyrmion_leaves_a_film_over_all_its_edges_and_a_quick_landscape_has_them_all() {
    let film = |bx: f64| {
        let terms = [
            json!({"exchange": {"J": ["10 meV"]}}),
            json!({"dmi": {"D": ["4 meV"], "kind": "interfacial"}}),
            anisotropy("1.5 meV", [0, 0, 1]),
            field([bx, 0.37 * bx, 4.0]),
        ];
        let skyrmion = json!({"skyrmion": {"radius": 3}});
        config(json!(terms), json!({"square": {"cells": [16, 16]}}), skyrmion, 5.0)
    };
    let free = rates(&solve(&film(0.0)));
    let outcome = solve(&film(1e-4));
    let stray = rates(&outcome);
    assert!((0..2).all(|k| (stray[k] / free[k] - 1.0).abs() < 1e-3), "{stray:?} {free:?}");
    // what is counted is no exit that is not
    assert_eq!(outcome.search.lowest_exits_mev, [None; 2]);
    let quick = r#""landscape": {"effort": "quick", "energy_window": "80 meV"}, "rates""#;
    for bx in [1e-4, 0.05] {
        let outcome = solve(&film(bx));
        let loaded = load_text("kin.json".as_ref(), film(bx).replace("\"rates\"", quick)).unwrap();
        let found = survey(&loaded.survey().unwrap(), &mut Silent).unwrap();
        let above = found.saddle_kinds.iter().map(|kind| kind.above_lowest_mev);
        let lowest = above.clone().fold(f64::INFINITY, f64::min);
        let mut heights: Vec<f64> = above.map(|height| height - lowest).filter(|height| *height < 0.01).collect();
        let regime = &outcome.rates.as_ref().unwrap().saddles[0].regimes[0];
        let own = regime.siblings.0.iter().map(|sibling| sibling.above_mev).chain([0.0]);
        let mut told: Vec<f64> = own.collect();
        [&mut heights, &mut told].into_iter().for_each(|all| all.sort_by(f64::total_cmp));
        let least = told[0];
        // each is where a landscape finds it: in 50 mT by second order alone
        assert_eq!((heights.len(), told.len()), (4, 4));
        for (height, told) in heights.iter().zip(&told) {
            assert!((height - (told - least)).abs() < 1e-4, "{bx}: {heights:?} {told:?}");
        }
    }
}

#[test]
fn a_number_of_saddles_goes_with_their_heights() {
    let siblings = Siblings(vec![
        Sibling { above_mev: 0.0, off_mev: 0.0, places: 1 },
        Sibling { above_mev: 2.0, off_mev: 0.5, places: 2 },
        Sibling { above_mev: 1e3, off_mev: 1e3, places: 1 },
    ]);
    let [ln, vague] = siblings.ln_number(2, 1.0);
    let number = 3.0 + 2.0 * (-2.0f64).exp();
    assert!((ln - number.ln()).abs() < 1e-15);
    assert!((vague - ((-2.0f64).exp() / number).ln_1p()).abs() < 1e-15);
    assert_eq!(Siblings::default().ln_number(4, 1.0), [4f64.ln(), 0.0]);
}

#[test]
fn what_a_near_symmetry_makes_of_a_saddle_in_its_own_basin_is_no_other_one() {
    // a hard axis at any angle to the cells of a film that shows it its edges alone
    let film = |degrees: f64| {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let hard = json!({"anisotropy": {"K": "-0.25 meV", "axis": [cosine, sine, 0.0]}});
        let energy = json!([{"exchange": {"J": ["1.6 meV"]}}, anisotropy("0.31 meV", [0, 0, 1]), hard]);
        let outcome = solve(&config(energy, json!({"square": {"cells": [4, 4]}}), up(), 6.0));
        let siblings =
            outcome.rates.as_ref().unwrap().saddles.iter().map(|r| r.at(6.0).siblings.0.len()).sum::<usize>();
        (rates(&outcome), siblings)
    };
    let (straight, _) = film(0.0);
    for degrees in [36.0, 40.0] {
        let (turned, siblings) = film(degrees);
        assert_eq!(siblings, 0, "{degrees}°");
        assert!((turned[0] / straight[0] - 1.0).abs() < 0.01, "{degrees}°: {turned:?} {straight:?}");
    }
}

#[test]
fn a_small_circle_about_an_axis_is_no_valley() {
    let rate = |tesla: [f64; 3], kelvin: f64| {
        let energy = json!([anisotropy("10 meV", [0, 0, 1]), anisotropy("7 meV", [0, 1, 0]), field(tesla)]);
        let outcome = solve(&config(energy, json!({"chain": {"sites": 1}}), up(), kelvin));
        outcome
            .rates
            .unwrap()
            .saddles
            .iter()
            .map(|r| r.ln_rate_per_s(Theory::Langer, kelvin).unwrap().exp())
            .sum::<f64>()
    };
    for kelvin in [4.0, 6.0] {
        let free = rate([0.0; 3], kelvin);
        // the field itself changes the barriers by 1e-3 of k_BT
        for tesla in [[0.02, 0.0, 0.0], [0.02, 0.0, 0.01], [1e-4, 0.0, 1.3e-4], [0.02, 0.02, 0.01]] {
            let tilted = rate(tesla, kelvin);
            assert!((tilted / free - 1.0).abs() < 0.02, "{tesla:?} {kelvin}: {tilted} {free}");
        }
    }
}

#[test]
fn images_that_are_too_few_for_the_lowest_route_do_not_decide_the_barrier() {
    let energy = json!([
        {"exchange": {"J": ["1 meV", "-0.58378085691110648 meV"]}},
        anisotropy("0.28710902622455114 meV", [0, 0, 1]),
    ]);
    let text = config(energy, json!({"honeycomb": {"cells": [3, 4]}}), up(), 1.0);
    let barrier = |images: Option<usize>| {
        let mut config: Value = serde_json::from_str(&text).unwrap();
        if let Some(images) = images {
            config["path"] = json!({"images": images});
        }
        let outcome = solve(&config.to_string());
        (outcome.barrier.unwrap().forward_mev, outcome.path.images(), outcome.warnings)
    };
    let (lowest, ..) = barrier(None);
    for asked in [9, 14] {
        let (found, images, warnings) = barrier(Some(asked));
        assert!((found / lowest - 1.0).abs() < 1e-9, "{asked}: {found} {lowest}");
        let said = warnings.iter().any(|w| w.starts_with(&format!("path.images is {asked}: ")));
        assert!(images > asked && said, "{images} {warnings:?}");
    }
}
