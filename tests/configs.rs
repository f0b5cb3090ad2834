//! The shipped configs run and give the barriers they are known for; the bad ones are refused in the words beside them.

use serde_json::Value;
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

/// Runs a shipped config; its line of JSON.
fn shipped(name: &str) -> Value {
    let out = tempfile::tempdir().unwrap();
    let config = format!("configs/{name}.json");
    let done = spinneb(&root(), &["run", &config, "--out", out.path().to_str().unwrap(), "--json", "--quiet"]);
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    assert_eq!(done.status.code(), Some(0), "{name}: {said}");
    assert_eq!(said, "", "{name}: --quiet");
    let files = ["summary.json", "config.json", "path.csv", "profile.csv", "history.csv"];
    for file in files.iter().chain(&["energy_path.svg", "energy_path.png", "spins.svg", "spins.png"]) {
        assert!(out.path().join(file).metadata().is_ok_and(|m| m.len() > 0), "{name}: {file}");
    }
    serde_json::from_slice(&done.stdout).unwrap()
}

fn barriers(line: &Value) -> (f64, f64) {
    let number = |way: &str| line["barrier_meV"][way].as_f64().unwrap();
    (number("forward"), number("backward"))
}

#[test]
fn shipped_configs_give_the_barriers_they_are_known_for() {
    for &(name, forward, backward, tolerance) in SHIPPED {
        let found = barriers(&shipped(name));
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
    let found = barriers(&shipped("ring_nucleus"));
    assert!((found.0 - forward).abs() < 1e-3 * forward, "{found:?}, {forward}");
    assert!((found.1 - backward).abs() < 1e-3 * forward, "{found:?}, {backward}");
}

#[test]
fn a_wall_in_a_nanowire_leaves_its_pinning_region_over_less_than_the_region_s_depth() {
    // Wall energy 4 S √(A K); the region lowers it by no more than the factor √(0.4/0.6); the field helps.
    let wall = 4.0 * 20e-18 * (15e-12f64 * 0.6e6).sqrt() / 1.602176634e-22;
    let depth = wall * (1.0 - (0.4f64 / 0.6).sqrt());
    let (forward, backward) = barriers(&shipped("nanowire_pinning"));
    assert!(0.4 * depth < forward && forward < depth, "{forward}, {depth}");
    assert!(backward > forward);
}

#[test]
fn a_permalloy_wire_is_reversed_by_a_wall_that_enters_at_one_end() {
    let (forward, backward) = barriers(&shipped("permalloy_wire"));
    assert!((forward - backward).abs() < 1e-9 * forward);
    // Above that of the same wire of 200 nm, 3298.70 meV, and below that of 700 nm, 3386.21 meV.
    assert!(3298.8 < forward && forward < 3386.1, "{forward}");
}

#[test]
fn a_wall_in_a_permalloy_wire_is_moved_past_a_shallow_notch_from_one_deep_one_to_another() {
    let (forward, backward) = barriers(&shipped("permalloy_notch"));
    // the two deep notches are alike but for the halves of the shallow one between them
    assert!((forward - backward).abs() < 0.01 * forward, "{forward} {backward}");
    // of the 3.3 eV of a wall in the wide wire, less than the share of the section that a deep notch lacks, 40 %
    assert!(0.1 * 3340.0 < forward && forward < 0.4 * 3340.0, "{forward}");
}

#[test]
fn a_cobalt_chain_holds_its_magnetisation_for_minutes_at_4_kelvin_and_not_at_20() {
    let out = tempfile::tempdir().unwrap();
    let done = spinneb(&root(), &["run", "configs/cobalt_chain.json", "--out", out.path().to_str().unwrap(), "--json"]);
    assert_eq!(done.status.code(), Some(0), "{}", String::from_utf8_lossy(&done.stderr));
    // the walls of a chain with J and K of this size sit on its sites, hard axis K/10: between the continuum's 4 √(JK/2) and 2J
    let (forward, backward) = barriers(&serde_json::from_slice(&done.stdout).unwrap());
    let (j, k) = (7.5f64, 2.0);
    assert!(0.95 * 4.0 * (j * k / 2.0).sqrt() < forward && forward < 2.0 * j, "{forward}");
    assert!((forward - backward).abs() < 1e-9 * forward);
    let summary: Value = serde_json::from_slice(&fs::read(out.path().join("summary.json")).unwrap()).unwrap();
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
        assert!(out.path().join(file).metadata().is_ok_and(|m| m.len() > 1000), "{file}");
    }
}

#[test]
fn every_shipped_config_is_tested_and_checks() {
    let configs = root().join("configs");
    let mut tested: BTreeSet<String> = SHIPPED.iter().map(|(name, ..)| name.to_string()).collect();
    tested.extend(
        ["ring_nucleus", "nanowire_pinning", "permalloy_wire", "permalloy_notch", "cobalt_chain"].map(String::from),
    );
    assert_eq!(names(&configs, ".json"), tested);
    for name in tested {
        let done = spinneb(&configs, &["check", &format!("{name}.json")]);
        assert_eq!(done.status.code(), Some(0), "{name}");
        assert!(String::from_utf8_lossy(&done.stdout).starts_with(&format!("{name}.json: valid\n")), "{name}");
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
        "wall width   2.5000 sites, 5.0000 nm",
        "wall energy  1497.9622 meV, 12.0000 mJ/m²",
        "site barrier 99.864145 to 149.796218 meV",
        "dominant     exchange",
        "memory       about",
        "time         about",
        "warning      a wall is only 2.50 cells wide",
    ] {
        assert!(wire.contains(row), "{row}\n{wire}");
    }
    let notch = said("permalloy_notch");
    assert!(
        notch.contains("warning      cells of 5 nm are longer than half the exchange length of 5.69 nm"),
        "{notch}"
    );
    let toy = said("wall_nucleation");
    assert!(toy.contains("wall energy  6.3246 meV") && !toy.contains("warning"), "{toy}");
    let listed = spinneb(&root(), &["list", "materials"]);
    let listed = String::from_utf8(listed.stdout).unwrap();
    assert!(listed.lines().count() >= 18 && listed.contains("5.69 nm") && listed.contains("15.80 mJ/m²"), "{listed}");
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
