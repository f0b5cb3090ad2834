use super::*;
use crate::config::load_text;
use crate::drive::{Silent, run};
use crate::geometry::Vector;
use crate::path::guess::{FirstGuess, Waypoints};
use serde_json::{Value, json};
use std::path::Path;

/// A chain with exchange J = 10 meV, a DMI along y, and two stretches of weaker anisotropy.
fn pinned(through: Value) -> Value {
    let weak = |from: usize| json!({"anisotropy": {"K": "-0.1 meV", "axis": [0, 0, 1], "sites": {"from": from, "to": from + 11}}});
    let wall = |center: f64| json!({"domain_wall": {"center": center, "through": through}});
    json!({
        "material": {"name": "toy", "energy": [
            {"exchange": {"J": ["10 meV"]}},
            {"anisotropy": {"K": "0.5 meV", "axis": [0, 0, 1]}},
            {"dmi": {"D": "1.2 meV", "direction": [0, 1, 0]}},
        ]},
        "lattice": {"chain": {"sites": 64}},
        "energy": [weak(12), weak(40)],
        "initial": wall(17.5),
        "final": wall(45.5),
    })
}

fn problem(config: &Value) -> Problem {
    load_text(Path::new("wall.json"), config.to_string()).unwrap().problem().unwrap()
}

/// The direction on the way that the initial wall of a config took.
fn chosen(config: &Value) -> Vector {
    problem(config).senses.first().unwrap().through
}

#[test]
fn a_wall_between_opposite_domains_passes_where_it_is_cheapest() {
    let mut config = pinned(json!("auto"));
    assert_eq!(chosen(&config), [-1.0, 0.0, 0.0]);
    config["material"]["energy"][2]["dmi"]["D"] = "-1.2 meV".into();
    assert_eq!(chosen(&config), [1.0, 0.0, 0.0]);
    config["material"]["energy"][2]["dmi"]["direction"] = json!([1, 0, 0]);
    assert_eq!(chosen(&config), [0.0, -1.0, 0.0]);
    config["material"]["energy"][2]["dmi"]["D"] = "1.2 meV".into();
    assert_eq!(chosen(&config), [0.0, 1.0, 0.0]);
    for key in ["initial", "final"] {
        config[key]["domain_wall"].as_object_mut().unwrap().remove("through");
    }
    assert_eq!(chosen(&config), [0.0, 1.0, 0.0]);
}

#[test]
fn a_default_wall_with_an_interaction_that_has_a_handedness_leads_to_the_barrier_of_the_cheap_sense() {
    let [auto, given] = [json!("auto"), json!([-1, 0, 0])].map(|t| run(&problem(&pinned(t)), &mut Silent).unwrap());
    let forward = auto.barrier.unwrap().forward_mev;
    assert!(auto.certified, "{:?}", auto.warnings);
    assert!((forward - 0.5994182999086545).abs() < 1e-9, "{forward}");
    assert!((forward - given.barrier.unwrap().forward_mev).abs() < 1e-12, "{forward}");
}

#[test]
fn the_library_s_cobalt_on_platinum_has_walls_through_minus_x() {
    let mut config = pinned(json!("auto"));
    config["material"] = "cobalt_platinum".into();
    config["lattice"] = json!({"chain": {"sites": 64, "spacing": "1 nm", "cross_section": ["50 nm", "0.4 nm"]}});
    config["energy"] = json!([{"demag": {}}]);
    assert_eq!(chosen(&config), [-1.0, 0.0, 0.0]);
}

#[test]
fn senses_that_are_equal_to_rounding_are_the_usual_one() {
    let mut config = pinned(json!("auto"));
    config["material"]["energy"][2]["dmi"]["D"] = "0 meV".into();
    let auto = problem(&config);
    assert_eq!(auto.senses.first().unwrap().through, [1.0, 0.0, 0.0]);
    for key in ["initial", "final"] {
        config[key]["domain_wall"]["through"] = json!([1, 0, 0]);
    }
    let given = problem(&config);
    assert_eq!((auto.initial, auto.final_state), (given.initial, given.final_state));
    // y and z are the same to a square bar, but for the last digits of its demagnetising tensors
    let bar = json!({
        "material": "permalloy",
        "lattice": {"chain": {"sites": 60, "spacing": "5 nm", "cross_section": ["20 nm", "20 nm"]}},
        "energy": [{"demag": {}}],
        "initial": {"domain_wall": {"center": 20, "left": [1, 0, 0], "right": [-1, 0, 0]}},
        "final": {"domain_wall": {"center": 40, "left": [1, 0, 0], "right": [-1, 0, 0]}},
    });
    assert_eq!(chosen(&bar), [0.0, 1.0, 0.0]);
    let mut hard = config.clone();
    hard["initial"]["domain_wall"]["through"] = "auto".into();
    hard["energy"] = json!([{"anisotropy": {"K": "-0.2 meV", "axis": [1, 0, 0]}}]);
    // +y and −y cost the same, and less than ±x
    assert_eq!(chosen(&hard), [0.0, 1.0, 0.0]);
}

#[test]
fn the_final_wall_and_walls_on_the_way_take_the_sense_of_the_initial_one() {
    let mut config = pinned(json!("auto"));
    config["material"]["energy"][2]["dmi"]["D"] = "0 meV".into();
    // a wall by itself would pass through x on the left and through y on the right
    let hard = |axis: [f64; 3], from: usize| json!({"anisotropy": {"K": "-0.2 meV", "axis": axis, "sites": {"from": from, "to": from + 31}}});
    config["energy"] = json!([hard([0.0, 1.0, 0.0], 0), hard([1.0, 0.0, 0.0], 32)]);
    let found = problem(&config);
    let middle = |spins: &Spins, i: usize| spins.get(i)[0];
    assert!(middle(&found.initial, 17) > 0.9 && middle(&found.final_state, 45) > 0.9);
    let waypoint: Waypoints = serde_json::from_value(json!({"states": [{"domain_wall": {"center": 40}}]})).unwrap();
    let context =
        GuessContext { states: found.states(&Scales::of_terms(&found.hamiltonian)), default_axis: Direction::X };
    let path = waypoint.path(&found.initial, &found.final_state, 21, &context).unwrap();
    let most = (0..21).map(|k| middle(&path.spins(k), 40)).fold(0.0, f64::max);
    assert!(most > 0.9, "{most}");
    // a wall of the other kind has senses of its own
    config["final"]["domain_wall"]["left"] = json!([0, 0, -1]);
    config["final"]["domain_wall"]["right"] = json!([0, 0, 1]);
    assert!(problem(&config).final_state.get(45)[1].abs() > 0.9);
}

/// A helimagnet of one axis, x, with an easy plane across it, in a field along z: a ring, so that no end pulls.
fn helimagnet(d: &str, state: Value) -> Value {
    json!({
        "material": {"name": "helimagnet", "moment": "2 mu_B", "energy": [
            {"exchange": {"J": ["10 meV"]}},
            {"dmi": {"D": d, "direction": [1, 0, 0]}},
            {"anisotropy": {"K": "-1 meV", "axis": [1, 0, 0]}},
        ]},
        "lattice": {"chain": {"sites": 80, "periodic": true}},
        "energy": [{"zeeman": {"B": ["0 T", "0 T", "3.4552 T"]}}],
        "initial": {"soliton": state},
        "final": {"uniform": {"direction": [0, 0, 1]}},
    })
}

/// Turns about x from site 0 round the ring and back to it.
fn winding(spins: &Spins) -> f64 {
    let n = spins.sites();
    let step = |i: usize| {
        let ([_, ay, az], [_, by, bz]) = (spins.get(i), spins.get((i + 1) % n));
        libm::atan2(ay * bz - az * by, ay * by + az * bz)
    };
    (0..n).map(step).sum::<f64>() / std::f64::consts::TAU
}

#[test]
fn a_soliton_in_a_helimagnet_takes_its_handedness_and_stays() {
    for (d, turns) in [("1 meV", -1.0), ("-1 meV", 1.0)] {
        let built = problem(&helimagnet(d, json!({"center": 39.5})));
        assert!((winding(&built.initial) - turns).abs() < 1e-12, "{d}");
        let h = &built.hamiltonian;
        let relaxed = crate::stationary::relax_to_minimum(h.into(), &built.initial, 1e-12 * h.stiffness_mev()).unwrap();
        assert!((winding(&relaxed.spins) - turns).abs() < 1e-12, "{d}");
        // 8 √(J μB) − 2π |D|, and the lattice's correction of that
        let energy = h.difference_mev(relaxed.spins.as_slice(), built.final_state.as_slice());
        let expected = 8.0 * (10.0f64 * 0.4).sqrt() - std::f64::consts::TAU;
        assert!((energy - expected).abs() < 0.1, "{d}: {energy} {expected}");
    }
}

#[test]
fn a_soliton_is_as_wide_as_the_field_makes_it_and_goes_round_the_chain_where_nothing_else_is_cheaper() {
    let built = problem(&helimagnet("0 meV", json!({"center": 40})));
    // √(10/0.4) = 5 sites, so φ = 4 atan(1/e) that far before the center
    let angle = |i: usize| libm::atan2(built.initial.get(i)[1], built.initial.get(i)[2]);
    let expected = 4.0 * libm::atan(libm::exp(-1.0));
    assert!((angle(35) - expected).abs() < 1e-4, "{} {expected}", angle(35));
    assert!(built.initial.vectors().iter().all(|v| v[0].abs() < 1e-15));
    // an easy plane that holds the chain's direction is turned in
    let mut plane = helimagnet("0 meV", json!({"center": 40}));
    plane["energy"].as_array_mut().unwrap().push(json!({"anisotropy": {"K": "-2 meV", "axis": [0, 1, 0]}}));
    assert!(problem(&plane).initial.vectors().iter().all(|v| v[1].abs() < 1e-15));
}

#[test]
fn a_soliton_that_nothing_holds_together_asks_for_a_width() {
    let mut config = helimagnet("1 meV", json!({"center": 40}));
    config["energy"] = json!([]);
    let said = load_text(Path::new("s.json"), config.to_string()).unwrap().problem().unwrap_err().to_string();
    assert!(said.contains("initial.soliton.width: nothing holds the spins"), "{said}");
    config["initial"]["soliton"]["width"] = json!(5);
    assert!((winding(&problem(&config).initial) + 1.0).abs() < 1e-12);
}

/// A soft chain with a hard end of eight sites, as two materials.
fn two_materials() -> Value {
    let wall = |center: f64| json!({"domain_wall": {"center": center}});
    json!({
        "material": {
            "default": {"name": "soft", "moment": "2 mu_B", "energy": [
                {"exchange": {"J": ["10 meV", "1 meV"]}},
                {"anisotropy": {"K": "0.5 meV", "axis": [0, 0, 1]}},
                {"dmi": {"D": "1 meV", "direction": [0, 1, 0]}},
            ]},
            "top": {"name": "hard", "moment": "3 mu_B", "energy": [
                {"exchange": {"J": ["30 meV"]}},
                {"anisotropy": {"K": "2 meV", "axis": [0, 0, 1]}},
            ]},
        },
        "lattice": {"chain": {"sites": 20, "regions": {"top": {"from": 12, "to": 19}}}},
        "energy": [{"zeeman": {"B": ["0 T", "0 T", "1 T"]}}],
        "initial": wall(4.5),
        "final": wall(14.5),
    })
}

fn refusal(config: &Value) -> String {
    let loaded = load_text(Path::new("two.json"), config.to_string());
    loaded.and_then(|loaded| loaded.problem()).unwrap_err().to_string()
}

/// The energies of some states.
fn energies(problem: &Problem) -> Vec<f64> {
    let state = |seed: u64| -> Spins {
        let spec: StateSpec = serde_json::from_value(json!({"random": {"seed": seed}})).unwrap();
        spec.build(&StateContext::new(problem.hamiltonian.lattice(), 1.0)).unwrap()
    };
    (0..5).map(|seed| problem.hamiltonian.energy_mev(state(seed).as_slice())).collect()
}

fn same_energies(a: &Value, b: &Value) {
    let (a, b) = (energies(&problem(a)), energies(&problem(b)));
    assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-10), "{a:?} {b:?}");
}

#[test]
fn each_region_has_the_terms_of_its_material_and_a_bond_between_two_their_means() {
    let mut by_hand = two_materials();
    let list = |inside: f64, between: f64, beyond: f64, count: usize, mixed: std::ops::Range<usize>| -> Vec<String> {
        let value = |i: usize| {
            if i < mixed.start {
                inside
            } else if mixed.contains(&i) {
                between
            } else {
                beyond
            }
        };
        (0..count).map(|i| format!("{:?} meV", value(i))).collect()
    };
    // 2 × 10 × 30/40; the second shell of the soft part has no partner in the hard one; D × 30/40
    by_hand["material"] = json!({"name": "both", "moment": "2 mu_B", "energy": [
        {"exchange": {"J": [list(10.0, 15.0, 30.0, 19, 11..12), list(1.0, 0.0, 0.0, 18, 10..12)]}},
        {"anisotropy": {"K": list(0.5, 0.5, 2.0, 20, 12..12), "axis": [0, 0, 1]}},
        {"dmi": {"D": list(1.0, 0.75, 0.0, 19, 11..12), "direction": [0, 1, 0]}},
    ]});
    by_hand["lattice"] =
        json!({"chain": {"sites": 20, "moments": [{"sites": {"from": 12, "to": 19}, "moment": "3 mu_B"}]}});
    same_energies(&two_materials(), &by_hand);
    // a site's own moment is its own, whatever it is made of
    let mut own = two_materials();
    own["lattice"]["chain"]["moments"] =
        json!([{"sites": [3], "moment": "7 mu_B"}, {"sites": [15], "moment": "1 mu_B"}]);
    by_hand["lattice"]["chain"]["moments"] = json!([
        {"sites": [3], "moment": "7 mu_B"}, {"sites": [15], "moment": "1 mu_B"},
        {"sites": [12, 13, 14, 16, 17, 18, 19], "moment": "3 mu_B"},
    ]);
    same_energies(&own, &by_hand);
}

#[test]
fn library_materials_share_a_chain_and_its_magnetostatics_and_the_config_as_run_runs_by_itself() {
    let mut config = two_materials();
    config["material"] = json!({"default": "permalloy", "top": "fept"});
    config["lattice"]["chain"]["spacing"] = "1 nm".into();
    config["lattice"]["chain"]["cross_section"] = json!(["20 nm", "5 nm"]);
    config["energy"] = json!([{"demag": {}}]);
    let loaded = load_text(Path::new("two.json"), config.to_string()).unwrap();
    let moments = loaded.moments_mub().unwrap();
    let ratio = moments[12] / moments[11];
    let ms = |key: &str| crate::config::library::find(key).unwrap().unwrap().material.Ms.unwrap().written()[0].0;
    assert!((ratio - ms("fept") / ms("permalloy")).abs() < 1e-12, "{ratio}");
    let again = load_text(Path::new("config.json"), loaded.as_run.clone()).unwrap();
    assert_eq!((&again.as_run, &again.sha256), (&loaded.as_run, &loaded.sha256));
    assert_eq!(energies(&again.problem().unwrap()), energies(&loaded.problem().unwrap()));
    // magnetostatics that both materials bring along count once
    let mut each = serde_json::from_str::<Value>(&loaded.as_run).unwrap();
    each["energy"] = json!([]);
    for part in ["default", "top"] {
        each["material"][part]["energy"].as_array_mut().unwrap().push(json!({"demag": {}}));
    }
    same_energies(&config, &each);
}

#[test]
fn materials_whose_exchange_has_no_mean_need_a_term_between_them() {
    let mut config = two_materials();
    config["material"]["top"]["energy"][0]["exchange"]["J"][0] = "-30 meV".into();
    let said = refusal(&config);
    assert!(said.contains("material: sites 11 and 12 are of the regions \"default\" and \"top\""), "{said}");
    assert!(said.contains("\"bonds\": [11]"), "{said}");
    config["energy"].as_array_mut().unwrap().push(json!({"exchange": {"J": ["-2 meV"], "bonds": [11]}}));
    let built = problem(&config);
    let blocks = built.hamiltonian.constant_blocks();
    assert!((blocks.bond[0].mean(11) - 2.0).abs() < 1e-12 && (blocks.bond[0].mean(10) + 10.0).abs() < 1e-12);
}

#[test]
fn regions_that_overlap_or_are_not_there_are_refused() {
    let mut config = two_materials();
    config["lattice"]["chain"]["regions"]["base"] = json!([0, 12]);
    config["material"]["base"] = config["material"]["top"].clone();
    let said = refusal(&config);
    assert!(said.contains("lattice.chain.regions.top: site 12 is in the region \"base\" too"), "{said}");
    let mut config = two_materials();
    let top = config["material"].as_object_mut().unwrap().remove("top").unwrap();
    config["material"]["tpo"] = top;
    let said = refusal(&config);
    assert!(said.contains("material.tpo: no region \"tpo\" in the lattice: did you mean \"top\"?"), "{said}");
    let mut config = two_materials();
    config["material"]["top"] = "feptt".into();
    assert!(refusal(&config).contains("material.top: no library material \"feptt\": did you mean \"fept\"?"));
    let mut config = two_materials();
    config["lattice"]["chain"]["regions"]["default"] = json!([0]);
    assert!(refusal(&config).contains("lattice.chain.regions.default: \"default\" is what is in no region"));
    let mut config = two_materials();
    config["material"]["top"]["energy"][1]["anisotropy"]["axis"] = json!([0, 0, 0]);
    assert!(refusal(&config).contains("material.top.energy[1].anisotropy.axis"), "{}", refusal(&config));
}

#[test]
fn the_name_of_a_region_chooses_its_sites() {
    let mut named = two_materials();
    named["energy"] = json!([{"anisotropy": {"K": "-0.1 meV", "axis": [1, 0, 0], "sites": "top"}}]);
    named["lattice"]["chain"]["frozen"] = json!([{"sites": "top", "direction": [0, 0, -1]}]);
    named["initial"] = json!({"domain_wall": {"center": 2.5}});
    named["final"] = json!({"domain_wall": {"center": 6.5}});
    let mut listed = named.clone();
    let range = json!({"from": 12, "to": 19});
    listed["energy"][0]["anisotropy"]["sites"] = range.clone();
    listed["lattice"]["chain"]["frozen"][0]["sites"] = range;
    same_energies(&named, &listed);
    let frozen = problem(&named);
    assert!((0..20).all(|i| frozen.hamiltonian.is_frozen(i) == (i >= 12)));
    let mut wrong = named.clone();
    wrong["energy"][0]["anisotropy"]["sites"] = "tip".into();
    assert!(refusal(&wrong).contains("energy[0].anisotropy.sites: no region \"tip\""), "{}", refusal(&wrong));
    let mut wrong = named.clone();
    wrong["energy"] = json!([{"exchange": {"J": ["1 meV"], "bonds": "top"}}]);
    assert!(refusal(&wrong).contains("bonds are chosen here by number"), "{}", refusal(&wrong));
}
