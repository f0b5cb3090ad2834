//! The shipped configs run and give the barriers they are known for; the bad ones are refused in the words beside them.

use crate::common::shipped::shipped;
use serde_json::Value;
use spinneb::config::estimate::Estimate;
use spinneb::config::load;
use spinneb::drive::Scales;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The shipped configs with their forward and backward barriers (meV) and a relative tolerance.
///
/// J = 10 meV and K = 0.5 meV unless said otherwise. Chain values are 50-digit Newton solutions of the exact gradient in
/// units of J; the others are closed forms.
const SHIPPED: &[(&str, f64, f64, f64)] = &[
    ("antiferromagnet", 6.297777507200488, 6.297777507200488, 1e-6),
    ("chirality_reversal", 1.3985869842388868, 1.3985869842388868, 1e-6),
    // N K for a chain that is too short for a wall.
    ("coherent_reversal", 4.5, 4.5, 1e-9),
    ("dmi_chain", 3.5050521158925413, 3.5050521158925413, 1e-6),
    // 259 atoms: N K/4 twice, one climb after the other.
    ("cubic_nanoparticle", 259.0 * 5.65e-3 / 1.602176634 / 4.0, 259.0 * 5.65e-3 / 1.602176634 / 4.0, 1e-9),
    ("perpendicular_disc", 1569.8217044098747, 1569.8217044098747, 1e-8),
    // of an independent computation: sparse Newton iterations on the saddle and both minima
    ("skyrmion_collapse", 38.792191458280286, 49.36624297574053, 1e-9),
    ("skyrmion_tube", 15.020395413461605, 11.209751185080979, 1e-8),
    ("strip_depinning", 1.6470898086858778, 1.6470898086858778, 1e-8),
    ("wall_depinning", 0.170008526447, 0.170008526447, 1e-6),
    ("wall_nucleation", 6.297777507200488, 6.297777507200488, 1e-6),
];

fn spinneb(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_spinneb")).current_dir(folder).args(arguments).output().unwrap()
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Names of the files with this ending in a folder.
fn names(folder: &Path, ending: &str) -> BTreeSet<String> {
    let entries = fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
    entries.filter_map(|name| name.strip_suffix(ending).map(String::from)).collect()
}

#[test]
fn shipped_configs_give_the_barriers_they_are_known_for() {
    for &(name, forward, backward, tolerance) in SHIPPED {
        let run = shipped(name);
        let files = ["summary.json", "config.json", "path.csv", "profile.csv", "history.csv"];
        for file in files.iter().chain(&["energy_path.svg", "energy_path.png", "spins.svg", "spins.png"]) {
            assert!(run.files.get(*file).is_some_and(|bytes| !bytes.is_empty()), "{name}: {file}");
        }
        let found = run.barriers();
        for (found, known) in [(found.0, forward), (found.1, backward)] {
            assert!((found - known).abs() <= tolerance * known, "{name}: {found} instead of {known}");
        }
    }
}

#[test]
fn a_nucleus_on_a_ring_has_the_barrier_of_the_continuum_but_for_a_thousandth() {
    // H.-B. Braun, Phys. Rev. B 50, 16501 (1994): 4 √(2JK) (tanh R − R sech² R), sech² R = h = μB/2K.
    let (j, k) = (10.0f64, 0.1);
    let h: f64 = 2.0 * 5.7883817982e-2 * 0.8 / (2.0 * k);
    let tanh = (1.0 - h).sqrt();
    let forward = 4.0 * (2.0 * j * k).sqrt() * (tanh - tanh.atanh() * h);
    // The two uniform states differ by 2 μB a site, 4 K h.
    let backward = forward + 200.0 * 4.0 * k * h;
    let found = shipped("ring_nucleus").barriers();
    assert!((found.0 - forward).abs() < 1e-3 * forward, "{found:?}, {forward}");
    assert!((found.1 - backward).abs() < 1e-3 * forward, "{found:?}, {backward}");
}

#[test]
fn a_wall_in_a_nanowire_leaves_its_pinning_region_over_less_than_the_region_s_depth() {
    // Wall energy 4 S √(A K); the region lowers it by no more than the factor √(0.4/0.6); the field helps.
    let wall = 4.0 * 20e-18 * (15e-12f64 * 0.6e6).sqrt() / 1.602176634e-22;
    let depth = wall * (1.0 - (0.4f64 / 0.6).sqrt());
    let (forward, backward) = shipped("nanowire_pinning").barriers();
    assert!(0.4 * depth < forward && forward < depth, "{forward}, {depth}");
    assert!(backward > forward);
}

#[test]
fn a_permalloy_wire_is_reversed_by_a_wall_that_enters_at_one_end() {
    let (forward, backward) = shipped("permalloy_wire").barriers();
    assert!((forward - backward).abs() < 1e-9 * forward);
    // cells of 1.25 nm give 3318.6 meV, a change a quarter of that from cells of 5 nm (3340.0 meV) to these
    assert!((forward - 3323.44).abs() < 0.01, "{forward}");
}

#[test]
fn a_wall_in_a_permalloy_wire_is_moved_past_a_shallow_notch_from_one_deep_one_to_another() {
    let (forward, backward) = shipped("permalloy_notch").barriers();
    // the two deep notches are alike but for the halves of the shallow one between them
    assert!((forward - backward).abs() < 0.01 * forward, "{forward} {backward}");
    // of the 3.3 eV of a wall in the wide wire, less than the share of the section that a deep notch lacks, 40 %
    assert!(0.1 * 3320.0 < forward && forward < 0.4 * 3320.0, "{forward}");
}

#[test]
fn a_skyrmion_leaves_over_an_edge_and_its_collapse_in_the_same_film_is_told_too() {
    let run = shipped("skyrmion_escape");
    let (forward, backward) = run.barriers();
    assert!((forward - 35.35091176887428).abs() < 1e-8 && (backward - 33.57829023058889).abs() < 1e-8, "{forward}");
    let summary = run.summary();
    let others = summary["rejected_paths"].as_array().unwrap();
    let collapse = others.iter().find(|p| p["guess"].as_str().unwrap().starts_with("shrink")).unwrap();
    assert!((collapse["barrier_meV"].as_f64().unwrap() - 50.06544395590881).abs() < 1e-8, "{collapse}");
    assert_eq!(collapse["negative_modes"], 1);
}

#[test]
fn a_skyrmion_of_nine_shells_vanishes_over_a_barrier_of_a_hundred_and_forty_mev() {
    // 138.107 meV in a film of 32 × 32, where its images by the boundaries are further away
    let (forward, backward) = shipped("pd_fe_ir111_skyrmion").barriers();
    assert!((forward - 140.24947101955644).abs() < 1e-7, "{forward}");
    assert!((backward - 175.4810149227455).abs() < 1e-7, "{backward}");
}

#[test]
fn an_island_of_atoms_is_reversed_by_a_wall_with_rates_of_harmonic_modes() {
    let run = shipped("island_reversal");
    let (forward, backward) = run.barriers();
    assert!((forward - 39.78602507820903).abs() < 1e-8 && (forward - backward).abs() < 1e-9, "{forward}");
    // all 124 atoms together: 124 K
    assert!(forward < 0.6 * 124.0 * 0.6);
    let summary = run.summary();
    let rate = &summary["rates"][0];
    assert!(
        rate["saddle_zero_modes"].as_array().unwrap().is_empty() && rate["refused"].as_object().unwrap().is_empty()
    );
    let prefactor = rate["htst_prefactor_Hz"].as_f64().unwrap();
    assert!((prefactor / 16218654745579.803 - 1.0).abs() < 1e-6, "{prefactor}");
}

#[test]
fn a_cobalt_chain_holds_its_magnetisation_for_minutes_at_4_kelvin_and_not_at_20() {
    let run = shipped("cobalt_chain");
    // the walls of a chain with J and K of this size sit on its sites, hard axis K/10: between the continuum's 4 √(JK/2) and 2J
    let (forward, backward) = run.barriers();
    let (j, k) = (7.5f64, 2.0);
    assert!(0.95 * 4.0 * (j * k / 2.0).sqrt() < forward && forward < 2.0 * j, "{forward}");
    assert!((forward - backward).abs() < 1e-9 * forward);
    let summary = run.summary();
    let whole = &summary["transition_rates"][0];
    assert_eq!((whole["direction"].as_str(), whole["equivalent_paths"].as_u64()), (Some("forward"), Some(4)));
    let at = |k: usize, key: &str| whole["temperatures"][k][key].as_f64();
    let passage = |k: usize| at(k, "first_passage_s").unwrap();
    assert!(100.0 < passage(0) && passage(0) < 1000.0, "{}", passage(0));
    assert!(passage(7) < 1e-6);
    // most walls that enter leave again at once, and hops of less than k_BT leave little but the order of magnitude
    assert!(at(0, "escape_lifetime_s").unwrap() < 0.05 * passage(0));
    assert!((10.0..1e4).contains(&at(0, "known_within_factor").unwrap()), "{:?}", at(0, "known_within_factor"));
    // 10.7 meV are 124 K
    assert!(
        at(10, "first_passage_s").is_some()
            && at(11, "first_passage_s").is_none()
            && at(12, "htst_rate_per_s").is_none()
    );
    assert!(whole["temperatures"][11]["reason"].as_str().unwrap().contains("below 1 k_BT"));
    assert!(summary["rates"][0]["langer_prefactor_Hz"].is_f64());
    for file in ["rates.csv", "arrhenius.svg", "arrhenius.png"] {
        assert!(run.files.get(file).is_some_and(|bytes| bytes.len() > 1000), "{file}");
    }
}

#[test]
fn every_shipped_config_is_tested_and_checks() {
    let configs = root().join("configs");
    let mut tested: BTreeSet<String> = SHIPPED.iter().map(|(name, ..)| name.to_string()).collect();
    tested.extend(
        ["ring_nucleus", "nanowire_pinning", "permalloy_wire", "permalloy_notch", "cobalt_chain"].map(String::from),
    );
    tested.extend(["skyrmion_escape", "pd_fe_ir111_skyrmion", "island_reversal"].map(String::from));
    assert_eq!(names(&configs, ".json"), tested);
    for name in tested {
        let done = spinneb(&configs, &["check", &format!("{name}.json")]);
        assert_eq!(done.status.code(), Some(0), "{name}");
        let said = String::from_utf8(done.stdout).unwrap();
        assert!(said.starts_with(&format!("{name}.json: valid\n")) && !said.contains("warning"), "{said}");
    }
}

#[test]
fn a_check_prints_the_physics_before_a_run() {
    let said = |name: &str| {
        let done = spinneb(&root().join("configs"), &["check", &format!("{name}.json")]);
        String::from_utf8(done.stdout).unwrap()
    };
    let wire = said("nanowire_pinning");
    for row in [
        // √(2A/μ₀Ms²), √(A/K), 4√(AK) S, KV of the weak stretch and of the others
        "l_ex         8.4242 nm",
        "wall width   5.0000 sites, 5.0000 nm",
        "wall energy  1497.9622 meV, 12.0000 mJ/m²",
        "site barrier 49.932073 to 74.898109 meV",
        "dominant     exchange",
        "memory       about",
        "time         about",
    ] {
        assert!(wire.contains(row), "{row}\n{wire}");
    }
    // 2K and K/4 of a cubic anisotropy of 5.65e-25 J
    let ball = said("cubic_nanoparticle");
    for row in ["stiffness    0.007053 meV", "site barrier 0.000882 meV"] {
        assert!(ball.contains(row), "{row}\n{ball}");
    }
    let toy = said("wall_nucleation");
    assert!(toy.contains("wall energy  6.3246 meV") && !toy.contains("warning"), "{toy}");
    let listed = spinneb(&root(), &["list", "materials"]);
    let listed = String::from_utf8(listed.stdout).unwrap();
    assert!(listed.lines().count() >= 18 && listed.contains("5.69 nm") && listed.contains("15.80 mJ/m²"), "{listed}");
}

#[test]
fn a_wall_of_a_cubic_material_is_as_wide_as_the_list_of_materials_says() {
    let folder = tempfile::tempdir().unwrap();
    let config = r#"{
        "material": "iron",
        "lattice": {"chain": {"sites": 200, "spacing": "2 nm", "cross_section": ["2 nm", "2 nm"]}},
        "initial": {"domain_wall": {"center": 99.5}},
        "final": {"uniform": {"direction": [0, 0, 1]}}
    }"#;
    fs::write(folder.path().join("iron.json"), config).unwrap();
    let said = String::from_utf8(spinneb(folder.path(), &["check", "iron.json"]).stdout).unwrap();
    let listed = String::from_utf8(spinneb(folder.path(), &["list", "materials"]).stdout).unwrap();
    let width = |text: &str| {
        let before = text.split(" nm").find(|part| part.contains("20.9")).unwrap_or_else(|| panic!("{text}"));
        before.rsplit(' ').next().unwrap().parse::<f64>().unwrap()
    };
    assert!((width(&said) - width(&listed)).abs() < 0.06, "{said}\n{listed}");
    // a wall without a width of its own has that one: uniform but for some 20 sites
    let spins = load(&folder.path().join("iron.json"), &[]).unwrap().problem().unwrap().initial;
    assert!(spins.get(50)[2] > 0.999 && spins.get(150)[2] < -0.999, "{:?} {:?}", spins.get(50), spins.get(150));
}

#[test]
fn a_check_expects_the_work_of_every_shipped_config_within_a_factor_of_3() {
    for name in names(&root().join("configs"), ".json") {
        let loaded = load(&root().join(format!("configs/{name}.json")), &[]).unwrap();
        let problem = loaded.problem().unwrap();
        let scales = Scales::of_terms(&problem.hamiltonian);
        let estimate = Estimate::of(&problem, &scales);
        let summary = fs::read(root().join(format!("results/gallery/{name}/summary.json"))).unwrap();
        let summary: Value = serde_json::from_slice(&summary).unwrap();
        let taken = summary["work"]["force_evaluations"].as_f64().unwrap();
        let factor = estimate.evaluations as f64 / taken;
        assert!((1.0 / 3.0..=3.0).contains(&factor), "{name}: {estimate:?}, {taken}");
        assert!(estimate.processor_seconds(&loaded, &problem, &scales) > 0.2, "two kinds of figures take longer");
    }
}

/// Long cells for the Permalloy wire, which are warned of.
const COARSE: [&str; 8] = [
    "--set",
    "lattice.chain.sites=60",
    "--set",
    "lattice.chain.spacing=\"5 nm\"",
    "--set",
    "output.formats=[]",
    "--set",
    "output.plots=[]",
];

#[test]
fn what_a_check_warns_of_a_run_warns_of_too_in_the_terminal_in_json_and_in_the_summary() {
    let out = tempfile::tempdir().unwrap();
    let (config, folder) = ("configs/permalloy_wire.json", out.path().to_str().unwrap());
    let check = spinneb(&root(), &[&["check", config], &COARSE[..]].concat());
    let check = String::from_utf8(check.stdout).unwrap();
    let warnings: Vec<&str> = check.lines().filter_map(|l| l.trim().strip_prefix("warning").map(str::trim)).collect();
    assert_eq!(warnings.len(), 2, "{check}");
    assert!(warnings[0].starts_with("cells of 5 nm are longer than half the exchange length of 5.69 nm"), "{check}");
    assert!(warnings[1].starts_with("a wall is only 2.3"), "{check}");
    let run = spinneb(&root(), &[&["run", config, "--out", folder, "--json"], &COARSE[..]].concat());
    let said = String::from_utf8(run.stderr).unwrap();
    let line: Value = serde_json::from_slice(&run.stdout).unwrap();
    let summary: Value = serde_json::from_slice(&fs::read(out.path().join("summary.json")).unwrap()).unwrap();
    for warning in warnings {
        assert!(said.contains(&format!("warning: {warning}")), "{said}");
        for list in [&line["warnings"], &summary["warnings"]] {
            assert!(list.as_array().unwrap().iter().any(|w| w == warning), "{list}: {warning}");
        }
    }
}

#[test]
fn single_cells_that_an_exchange_between_layers_joins_are_no_coarse_continuum() {
    let folder = tempfile::tempdir().unwrap();
    let config = |cells: &str, inside: &str| {
        format!(
            r#"{{
            "material": {{"name": "m", "Ms": "1000 kA/m", "energy": [{{"anisotropy": {{"K": "0.3 MJ/m^3", "axis": [0, 0, 1]}}}}]}},
            "lattice": {{"grid": {{"cells": {cells}, "cell": ["5 nm", "5 nm", "1 nm"]}}}},
            "energy": [{inside}],
            "initial": {{"uniform": {{"direction": [0, 0, 1]}}}}, "final": {{"uniform": {{"direction": [0, 0, -1]}}}}
        }}"#
        )
    };
    let (layers, stiff) = (r#"{"exchange": {"J_area": "-2 mJ/m^2"}}"#, r#"{"exchange": {"A": "4 pJ/m"}}"#);
    for (cells, inside, warned) in [
        ("[1, 1, 2]", layers, None),
        ("[1, 1, 1]", stiff, None),
        // one cell across, and nothing too coarse along the others
        ("[1, 1, 9]", stiff, None),
        ("[9, 1, 1]", stiff, Some("cells of 5 nm are longer than half")),
    ] {
        fs::write(folder.path().join("c.json"), config(cells, inside)).unwrap();
        let done = spinneb(folder.path(), &["check", "c.json"]);
        let said = String::from_utf8(done.stdout).unwrap();
        assert!(done.status.success(), "{said}");
        let found = said.lines().find_map(|line| line.trim().strip_prefix("warning")).map(str::trim);
        assert_eq!(found.is_some(), warned.is_some(), "{cells}: {said}");
        assert!(warned.is_none_or(|words| said.contains(words)), "{said}");
    }
}

#[test]
fn templates_check_without_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    for template in ["chain", "lifetime", "nanowire", "film", "crystal"] {
        assert_eq!(spinneb(folder.path(), &["init", template]).status.code(), Some(0));
        let done = spinneb(folder.path(), &["check", &format!("{template}.json")]);
        let said = String::from_utf8(done.stdout).unwrap();
        assert!(done.status.success() && !said.contains("warning"), "{said}");
    }
}

#[test]
fn all_that_is_wrong_is_told_at_once_and_each_as_an_error_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("wall.json"),
        r#"{
  "material": {"name": "toy", "energy": [{"exchange": {"J": "10 meV"}}, {"anistropy": {"K": 0.5, "axis": [0, 0, 1]}}]},
  "latice": {"chain": {"sites": 20, "spacing": "0.25 mev"}},
  "initial": {"domain_wall": {}},
  "final": {"uniform": {"direction": [0, 0]}},
  "path": {"images": 2}
}"#,
    )
    .unwrap();
    let wrong = |arguments: &[&str]| {
        let done = spinneb(folder.path(), arguments);
        assert_eq!(done.status.code(), Some(2));
        String::from_utf8(done.stderr).unwrap()
    };
    let all = r#"error: wall.json:2:61: material.energy[0].exchange.J: found the string "10 meV", expected an array, such as ["10 meV"]
error: wall.json:2:74: material.energy[1].anistropy: unknown kind "anistropy": did you mean "anisotropy"? (known kinds: exchange, anisotropy, cubic_anisotropy, dmi, pairs, biquadratic, four_spin, zeeman, dipolar, demag)
error: wall.json:2:93: material.energy[1].anistropy.K: found the number 0.5, but an energy per site or per volume needs its unit: write "0.5 meV" or "0.5 J/m^3" (J, eV, Ry or erg for a site, J/m^3 or erg/cm^3 for a volume, with SI prefixes)
error: wall.json:3:3: latice: unknown key "latice": did you mean "lattice"? (known keys: $schema, comment, name, material, lattice, energy, custom_terms, initial, final, relax_ends, path, search, neb, saddle, rates, landscape, output)
error: wall.json:3:48: latice.chain.spacing: "0.25 mev" is an energy
"#;
    let said = wrong(&["check", "wall.json"]);
    let places: Vec<&str> = said.lines().map(|line| line.split(": ").nth(1).unwrap()).collect();
    let expected: Vec<&str> = all.lines().map(|line| line.split(": ").nth(1).unwrap()).collect();
    assert_eq!(places[..5], expected[..], "{said}");
    assert_eq!(places[5..], ["wall.json:4:30", "wall.json:5:38", "wall.json:6:22"], "{said}");
    for (said, expected) in said.lines().zip(all.lines().take(4)) {
        assert_eq!(said, expected);
    }

    let said = wrong(&["run", "wall.json", "--set", "path.images=1", "--set", "latice.chain.sites=10000000"]);
    assert!(
        said.contains(
            "
error: wall.json:3:48: latice.chain.spacing: "
        ),
        "{said}"
    );
    assert!(said.contains("error: --set path.images: found 1, but a path has at least 3 images"), "{said}");
    // what is only wrong together is told together too
    let config = root().join("configs/wall_depinning.json");
    let said = wrong(&[
        "check",
        config.to_str().unwrap(),
        "--set",
        r#"energy=[{"anisotropy": {"K": "1 meV", "axis": [0, 0, 1], "sites": [1000]}}, {"dipolar": {}}, {"demag": {}}]"#,
    ]);
    assert_eq!(said.lines().count(), 2, "{said}");
    assert!(said.starts_with("error: --set energy: energy[0].anisotropy.sites[0]: found site 1000"), "{said}");
    assert!(
        said.contains(
            "
error: --set energy: energy[2].demag"
        ),
        "{said}"
    );
}

#[test]
fn a_file_of_another_kind_is_called_what_it_is() {
    let config = root().join("configs");
    let summary = root().join("results/gallery/dmi_chain/summary.json");
    for (arguments, words) in [
        (
            ["run", "sweeps/braun_nucleus.json"],
            "sweeps/braun_nucleus.json:1:1: .: this is a sweep, not a config: `spinneb sweep` runs it",
        ),
        (["check", "sweeps/braun_nucleus.json"], "this is a sweep, not a config"),
        (["sweep", "dmi_chain.json"], "dmi_chain.json:1:1: .: this is a config, not a sweep: `spinneb run` runs it"),
        (
            ["run", summary.to_str().unwrap()],
            "this is a result's summary, not a config: the config that made it is config.json beside it",
        ),
        (["run", "materials/toy.json"], "this is a material, not a config: a config names it as its \"material\""),
    ] {
        let done = spinneb(&config, &arguments);
        let said = String::from_utf8(done.stderr).unwrap().replace('\\', "/");
        assert!(done.status.code() == Some(2) && said.contains(words) && said.lines().count() == 1, "{said}");
    }
}

#[test]
fn the_schema_takes_the_shipped_configs_and_refuses_units_that_do_not_fit() {
    let schema = spinneb(&root(), &["schema"]).stdout;
    let schema: Value = serde_json::from_slice(&schema).unwrap();
    let validator = jsonschema::validator_for(&schema).unwrap();
    let folder = root().join("configs");
    let read = |path: PathBuf| -> Value { serde_json::from_slice(&fs::read(path).unwrap()).unwrap() };
    for name in names(&folder, ".json") {
        let config = read(folder.join(format!("{name}.json")));
        assert!(validator.is_valid(&config), "{name}: {:?}", validator.iter_errors(&config).next());
    }
    let good = read(folder.join("nanowire_pinning.json"));
    for (pointer, wrong) in [
        ("/lattice/chain/spacing", "0.5 meters"),
        ("/lattice/chain/spacing", "1"),
        ("/lattice/chain/spacing", "1 meV"),
        ("/lattice/chain/cross_section/1", "1 nm^2"),
        ("/material/Ms", "580 kA"),
        ("/material/Ms", "0.7 T"),
        ("/material/energy/0/exchange/A", "15 pJ/m^2"),
        ("/material/energy/1/anisotropy/K", "0.6 MJ/m"),
        ("/energy/1/zeeman/B/2", "25 mev"),
    ] {
        for wrong in [Value::from(wrong), Value::from(2.5)] {
            let mut config = good.clone();
            *config.pointer_mut(pointer).unwrap() = wrong.clone();
            assert!(!validator.is_valid(&config), "{pointer}: {wrong}");
        }
    }
    for (pointer, right) in [
        ("/lattice/chain/spacing", "10 Å"),
        ("/material/Ms", "580 emu/cm^3"),
        ("/material/energy/1/anisotropy/K", "6e6 erg/cc"),
        ("/energy/1/zeeman/B/2", "20 kA/m"),
        ("/energy/0/anisotropy/K", "-0.2 meV"),
    ] {
        let mut config = good.clone();
        *config.pointer_mut(pointer).unwrap() = right.into();
        assert!(validator.is_valid(&config), "{pointer}: {right}");
    }
}

#[test]
fn one_entry_of_a_list_has_all_its_keys_and_an_unknown_one_is_refused() {
    let said = |arguments: &[&str]| {
        let done = spinneb(&root(), &[&["list"], arguments].concat());
        (done.status.code(), String::from_utf8(done.stdout).unwrap() + &String::from_utf8(done.stderr).unwrap())
    };
    let (code, wall) = said(&["states", "domain_wall"]);
    assert_eq!(code, Some(0));
    for key in ["center", "width", "left", "right", "through", "staggered"] {
        assert!(wall.lines().any(|line| line.starts_with(key)), "{key}: {wall}");
    }
    assert!(wall.contains("(required)") && wall.contains("a number"), "{wall}");
    // of every entry of every family, all keys of the schema
    let schema: Value = serde_json::from_slice(&spinneb(&root(), &["schema"]).stdout).unwrap();
    let mut entries = 0;
    for (kind, family) in
        [("terms", "TermSpec"), ("states", "StateSpec"), ("guesses", "GuessSpec"), ("optimisers", "OptimiserSpec")]
    {
        for choice in schema["definitions"][family]["oneOf"].as_array().unwrap() {
            let (name, member) = choice["properties"].as_object().unwrap().iter().next().unwrap();
            let member = schema.pointer(member["$ref"].as_str().unwrap().strip_prefix('#').unwrap()).unwrap();
            let (code, entry) = said(&[kind, name]);
            assert!(code == Some(0) && entry.starts_with(&format!("{name}: ")), "{entry}");
            let keys = member["properties"].as_object().into_iter().flatten();
            keys.for_each(|(key, _)| assert!(entry.lines().any(|line| line.starts_with(key)), "{key}: {entry}"));
            entries += 1;
        }
    }
    assert!(entries > 18, "{entries}");
    let (_, exchange) = said(&["terms", "exchange"]);
    assert!(exchange.contains("J, eV, Ry or erg") && exchange.contains(r#"{"exchange":"#), "{exchange}");
    let (_, fept) = said(&["materials", "fept"]);
    assert!(fept.starts_with("fept: ") && fept.contains("wall width") && fept.contains("references"), "{fept}");
    assert!(said(&["formats", "vtk"]).1.contains("ParaView") && said(&["formats", "npy"]).0 == Some(0));
    for (arguments, hint) in [
        (["states", "domain_wal"], "did you mean \"domain_wall\"?"),
        (["materials", "permaloy"], "did you mean \"permalloy\"?"),
        (["optimisers", "magic"], "known are implicit, "),
        (["formats", "cvs"], "did you mean \"csv\"?"),
    ] {
        let (code, said) = said(&arguments);
        assert!(code == Some(2) && said.contains(hint), "{said}");
    }
}

#[test]
fn bad_configs_are_refused_in_the_words_beside_them_before_anything_is_written() {
    let folder = root().join("tests/configs/bad");
    let configs = names(&folder, ".json");
    assert!(configs.len() >= 30);
    assert_eq!(configs, names(&folder, ".expected"), "every config has its expected message");
    let others = fs::read_dir(&folder).unwrap().filter(|e| e.as_ref().unwrap().file_type().unwrap().is_file()).count();
    assert_eq!(others, 2 * configs.len(), "nothing else is there");
    let temporary = tempfile::tempdir().unwrap();
    let out = temporary.path().join("out");
    let wrong: Vec<String> = configs.iter().filter_map(|name| refused(&folder, name, &out).err()).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Whether both commands refuse a config as expected.
fn refused(folder: &Path, name: &str, out: &Path) -> Result<(), String> {
    let config = format!("{name}.json");
    let expected = fs::read_to_string(folder.join(format!("{name}.expected"))).unwrap();
    for arguments in [&["run", &config, "--out", out.to_str().unwrap()][..], &["check", &config]] {
        let done = spinneb(folder, arguments);
        // Windows writes paths the other way.
        let said = String::from_utf8(done.stderr).unwrap().replace('\\', "/");
        if done.status.code() != Some(2) || said != expected.replace('\\', "/") || !done.stdout.is_empty() {
            let (code, what) = (done.status, arguments[0]);
            return Err(format!("{what} {config}: {code}\n  said     {said}  expected {expected}"));
        }
        if out.exists() || folder.join("results").exists() {
            return Err(format!("{config}: a folder was made"));
        }
    }
    Ok(())
}
