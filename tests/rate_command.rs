//! Rates as a user meets them: in a run's files, and by `spinneb rate` for a result that is there.

use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// A short chain with two anisotropies; site 1 has a moment of its own.
const CONFIG: &str = r#"{
  "material": {"name": "toy", "moment": "2 mu_B", "energy": [
    {"exchange": {"J": ["10 meV"]}},
    {"anisotropy": {"K": "0.5 meV", "axis": [0, 0, 1]}},
    {"anisotropy": {"K": "-0.25 meV", "axis": [1, 0, 0]}}
  ]},
  "lattice": {"chain": {"sites": 3, "moments": [{"sites": [1], "moment": "4 mu_B"}]}},
  "initial": {"uniform": {"direction": [0, 0, 1]}},
  "final": {"uniform": {"direction": [0, 0, -1]}},
  "rates": {"temperatures": ["1 K", "3 K"], "damping": 0.2}
}"#;

fn spinneb(folder: &Path, arguments: &[&str]) -> (Option<i32>, String, String) {
    let Output { status, stdout, stderr } =
        Command::new(env!("CARGO_BIN_EXE_spinneb")).current_dir(folder).args(arguments).output().unwrap();
    (status.code(), String::from_utf8(stdout).unwrap(), String::from_utf8(stderr).unwrap())
}

fn folder(config: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("chain.json"), config).unwrap();
    folder
}

fn summary(folder: &Path) -> Value {
    serde_json::from_slice(&fs::read(folder.join("results/chain/summary.json")).unwrap()).unwrap()
}

#[test]
fn a_run_with_rates_writes_the_keys_the_table_and_the_figure() {
    let folder = folder(CONFIG);
    let (code, _, said) = spinneb(folder.path(), &["run", "chain.json"]);
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("chain: mean lifetime of the initial state: "), "{said}");
    let summary = summary(folder.path());
    let rates = summary["rates"].as_array().unwrap();
    let names: Vec<_> =
        rates.iter().map(|r| (r["saddle"].as_u64().unwrap(), r["direction"].as_str().unwrap())).collect();
    assert_eq!(names, [(0, "forward"), (0, "backward")]);
    let number = |v: &Value| v.as_f64().unwrap_or_else(|| panic!("{v} is no number"));
    for r in rates {
        // all three turn together: through +y or −y, with the mean of the inverse frequencies 1/γ of the three
        assert_eq!(r["equivalent_saddles"], 2);
        let (k, hard, moment) = (0.5, 0.25, (2.0 + 4.0 + 2.0) / 3.0);
        let unit = 1e12 * 2.0 / (0.6582119569 * moment);
        let langer = number(&r["growth_rate_per_s"]) / unit;
        // the positive root of (1 + α²)λ² + α(ε₂ − |ε₁|)λ − |ε₁|ε₂: the uniform mode is exact if moments are equal, near if not
        let (a, b, c) = (1.04, 0.2 * (2.0 * hard - 2.0 * k), -4.0 * k * hard);
        let root = (-b + f64::sqrt(b * b - 4.0 * a * c)) / (2.0 * a);
        assert!((langer / root - 1.0).abs() < 0.01, "{langer} {root}");
        for t in r["temperatures"].as_array().unwrap() {
            let (kelvin, delta) = (number(&t["temperature_K"]), number(&t["barrier_over_kT"]));
            assert!((delta - 1.5 / (8.617333262e-2 * kelvin)).abs() < 1e-9 * delta);
            for theory in ["htst", "langer"] {
                let prefactor = number(&r[format!("{theory}_prefactor_Hz")]);
                let rate = number(&t[format!("{theory}_rate_per_s")]);
                assert!((rate / (2.0 * prefactor * (-delta).exp()) - 1.0).abs() < 1e-10);
            }
            let lifetime = number(&t["lifetime_s"]);
            assert!((lifetime * number(&t["langer_rate_per_s"]) - 1.0).abs() < 1e-12);
            assert!((lifetime.log10() - number(&t["log10_lifetime_s"])).abs() < 1e-10);
        }
        let [short, long] = ["1_s", "10_years"].map(|t| number(&r[format!("blocking_temperature_{t}_K")]));
        assert!(0.0 < long && long < short && short < 1.0, "{long} {short}");
        assert_eq!(
            (&r["damping"], &r["g_factor"], r["refused"].as_object().unwrap().len()),
            (&0.2.into(), &2.0.into(), 0)
        );
    }
    let transitions = summary["transition_rates"].as_array().unwrap();
    assert_eq!(transitions.len(), 2);
    for (whole, own) in
        transitions[0]["temperatures"].as_array().unwrap().iter().zip(rates[0]["temperatures"].as_array().unwrap())
    {
        // one saddle: all three are one time
        assert_eq!((&whole["escape_lifetime_s"], &whole["first_passage_s"]), (&own["lifetime_s"], &own["lifetime_s"]));
        assert_eq!(whole["log10_first_passage_s"], own["log10_lifetime_s"]);
        for key in ["htst_rate_per_s", "langer_rate_per_s", "barrier_over_kT", "known_within_factor", "reason"] {
            assert_eq!(whole[key], own[key], "{key}");
        }
        assert!(number(&own["known_within_factor"]) > 1.0 && own["reason"].is_null());
    }
    assert_eq!(summary["highest_climb_meV"], summary["barrier_meV"]);
    // ħλ₊/(2πk_B)
    let crossover =
        0.6582119569e-12 * number(&rates[0]["growth_rate_per_s"]) / (2.0 * std::f64::consts::PI * 8.617333262e-2);
    assert!((number(&rates[0]["crossover_temperature_K"]) / crossover - 1.0).abs() < 1e-9);
    let csv = fs::read_to_string(folder.path().join("results/chain/rates.csv")).unwrap();
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(
        lines[0],
        "saddle,direction,temperature_K,barrier_over_kT,htst_rate_per_s,langer_rate_per_s,lifetime_s,log10_lifetime_s,\
         escape_lifetime_s,log10_escape_lifetime_s,first_passage_s,log10_first_passage_s,known_within_factor"
    );
    let starts: Vec<String> = lines[1..].iter().map(|l| l.split(',').take(3).collect::<Vec<_>>().join(",")).collect();
    let expected = ["0,forward,", "0,backward,", "all,forward,", "all,backward,"];
    assert_eq!(starts, expected.iter().flat_map(|s| [format!("{s}1.0"), format!("{s}3.0")]).collect::<Vec<_>>());
    let svg = fs::read_to_string(folder.path().join("results/chain/arrhenius.svg")).unwrap();
    assert!(svg.starts_with("<svg") && !svg.contains("NaN") && !svg.contains("inf"));
    assert!(fs::metadata(folder.path().join("results/chain/arrhenius.png")).unwrap().len() > 1000);
}

#[test]
fn lifetimes_beyond_what_a_double_holds_are_null_with_their_logarithm() {
    let folder = folder(&CONFIG.replace("\"1 K\", \"3 K\"", "\"10 mK\""));
    assert_eq!(spinneb(folder.path(), &["run", "chain.json", "--quiet"]).0, Some(0));
    let summary = summary(folder.path());
    let cold = &summary["rates"][0]["temperatures"][0];
    assert_eq!((&cold["htst_rate_per_s"], &cold["lifetime_s"]), (&0.0.into(), &Value::Null));
    assert!(cold["log10_lifetime_s"].as_f64().unwrap() > 700.0);
    let csv = fs::read_to_string(folder.path().join("results/chain/rates.csv")).unwrap();
    assert!(csv.lines().nth(1).unwrap().contains(",0.0,0.0,,7"), "{csv}");
}

#[test]
fn what_is_asked_for_later_has_the_damping_and_the_theory_of_the_config() {
    let folder = folder(&CONFIG.replace("\"damping\": 0.2", "\"damping\": 0.2, \"theory\": [\"langer\"]"));
    assert_eq!(spinneb(folder.path(), &["run", "chain.json", "--quiet"]).0, Some(0));
    for (more, damping) in [(&[][..], 0.2), (&["--damping", "0.4"][..], 0.4)] {
        let asked = ["rate", "results/chain", "-T", "2 K", "--quiet"];
        assert_eq!(spinneb(folder.path(), &[&asked[..], more].concat()).0, Some(0));
        let rates = &summary(folder.path())["rates"][0];
        assert_eq!((&rates["damping"], &rates["temperatures"][0]["htst_rate_per_s"]), (&damping.into(), &Value::Null));
        assert_eq!(rates["temperatures"].as_array().unwrap().len(), 1);
    }
}

/// Two values are the same, numbers to rounding.
fn agree(a: &Value, b: &Value) {
    match (a, b) {
        (Value::Number(x), Value::Number(y)) => {
            let (x, y) = (x.as_f64().unwrap(), y.as_f64().unwrap());
            assert!((x - y).abs() <= 1e-10 * y.abs().max(1e-300), "{x} {y}");
        }
        (Value::Array(x), Value::Array(y)) => {
            assert_eq!(x.len(), y.len());
            x.iter().zip(y).for_each(|(x, y)| agree(x, y));
        }
        (Value::Object(x), Value::Object(y)) => {
            assert!(x.keys().eq(y.keys()));
            x.iter().for_each(|(key, x)| agree(x, &y[key]));
        }
        _ => assert_eq!(a, b),
    }
}

#[test]
fn below_the_temperatures_of_the_run_it_is_said_that_other_ways_were_not_looked_for() {
    let run = folder(CONFIG);
    assert_eq!(spinneb(run.path(), &["run", "chain.json", "--quiet"]).0, Some(0));
    let said = |kelvin: &str| spinneb(run.path(), &["rate", "results/chain", "-T", kelvin]).2;
    let words = "were looked for at 1 K and above, not at 0.5 K";
    assert!(said("0.5 K").contains(words) && said("0.5 K").contains(words) && !said("1 K").contains(words));
}

#[test]
fn without_the_stored_states_the_saddles_are_found_anew() {
    let plain = folder(&CONFIG.replace(",\n  \"rates\": {\"temperatures\": [\"1 K\", \"3 K\"], \"damping\": 0.2}", ""));
    assert_eq!(spinneb(plain.path(), &["run", "chain.json", "--quiet"]).0, Some(0));
    let result = plain.path().join("results/chain");
    let asked = || {
        let (found, _, said) = spinneb(plain.path(), &["rate", "results/chain", "-T", "3 K", "--damping", "0.2"]);
        assert_eq!(found, Some(0), "{said}");
        (summary(plain.path())["rates"].clone(), said)
    };
    let (wanted, said) = asked();
    assert!(!said.contains("found anew"), "{said}");
    fs::remove_file(result.join("minima.ovf")).unwrap();
    let (found, said) = asked();
    assert!(said.contains("found anew from its config: there is no minima.ovf with the result"), "{said}");
    agree(&found, &wanted);
    // what was changed is not used at all
    fs::copy(result.join("minima.ovf"), result.join("saddle.ovf")).unwrap();
    let (code, _, said) = spinneb(plain.path(), &["rate", "results/chain", "-T", "3 K"]);
    assert!(code == Some(2) && said.contains("damaged: saddle.ovf"), "{said}");
}

#[test]
fn rates_of_a_finished_result_are_those_of_a_run_that_asks_for_them() {
    let asked = folder(CONFIG);
    assert_eq!(spinneb(asked.path(), &["run", "chain.json", "--quiet"]).0, Some(0));
    let plain = folder(&CONFIG.replace(",\n  \"rates\": {\"temperatures\": [\"1 K\", \"3 K\"], \"damping\": 0.2}", ""));
    assert_eq!(spinneb(plain.path(), &["run", "chain.json", "--quiet"]).0, Some(0));
    let before = summary(plain.path());
    assert!(before.get("rates").is_none() && !plain.path().join("results/chain/rates.csv").exists());
    let arguments = ["rate", "results/chain", "--temperature", "1 K", "-T", "3K", "--damping", "0.2"];
    let (code, out, said) = spinneb(plain.path(), &arguments);
    assert_eq!(code, Some(0), "{said}");
    assert!(!said.contains("found anew") && !said.contains("first path"), "{said}");
    assert_eq!(out.lines().count(), 5, "{out}");
    let (after, mut wanted) = (summary(plain.path()), summary(asked.path()));
    // over other saddles times are those of the run that looked for them
    for row in wanted["transition_rates"]
        .as_array_mut()
        .unwrap()
        .iter_mut()
        .flat_map(|way| way["temperatures"].as_array_mut().unwrap())
    {
        row.as_object_mut().unwrap().retain(|key, _| !key.contains("network"));
    }
    for key in ["rates", "transition_rates"] {
        agree(&after[key], &wanted[key]);
    }
    // nothing but the rates is another
    let (mut old, mut new) = (before.clone(), after.clone());
    for key in ["rates", "transition_rates", "warnings", "manifest"] {
        for summary in [&mut old, &mut new] {
            summary.as_object_mut().unwrap().remove(key);
        }
    }
    assert_eq!(old, new);
    assert_eq!(after["config_sha256"], before["config_sha256"]);
    assert_eq!(after["barrier_meV"], before["barrier_meV"]);
    for file in [
        "path.csv",
        "profile.csv",
        "history.csv",
        "path.npz",
        "path.ovf",
        "saddle.ovf",
        "minima.ovf",
        "energy_path.svg",
    ] {
        let read = |folder: &Path| fs::read(folder.join("results/chain").join(file)).unwrap();
        assert_eq!(read(plain.path()), read(asked.path()));
    }
    let (code, out, said) =
        spinneb(plain.path(), &["rate", "results/chain", "-T", "2 K", "--theory", "langer", "--json", "--quiet"]);
    assert_eq!((code, said.as_str()), (Some(0), ""));
    let line: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(
        (&line["forward"][0]["temperature_K"], &line["forward"][0]["htst_rate_per_s"]),
        (&2.0.into(), &Value::Null)
    );
    assert!(line["forward"][0]["langer_rate_per_s"].as_f64().unwrap() > 0.0);
}

#[test]
fn a_folder_without_a_result_or_without_moments_is_refused_in_words() {
    let folder = folder(
        &CONFIG
            .replace("\"moment\": \"2 mu_B\", ", "")
            .replace(",\n  \"rates\": {\"temperatures\": [\"1 K\", \"3 K\"], \"damping\": 0.2}", ""),
    );
    let (code, _, said) = spinneb(folder.path(), &["rate", "results/chain", "-T", "3 K"]);
    assert_eq!(
        (code, said.as_str()),
        (Some(2), "error: results/chain holds no finished result: run its config first, then ask for its rates\n")
    );
    assert_eq!(spinneb(folder.path(), &["run", "chain.json", "--quiet"]).0, Some(0));
    let (code, _, said) = spinneb(folder.path(), &["rate", "results/chain", "-T", "3 K"]);
    assert_eq!(code, Some(2));
    assert!(said.contains("a rate needs the moments of the sites"), "{said}");
    // a number below zero is a number and no option
    for (asked, words) in [(["-T", "-3 K"], "temperature"), (["--damping", "-1"], "damping")] {
        let (code, _, said) = spinneb(folder.path(), &["rate", "results/chain", "-T", "3 K", asked[0], asked[1]]);
        assert!(code == Some(2) && said.contains(words) && !said.contains("unexpected argument"), "{said}");
    }
    let config = folder.path().join("results/chain/config.json");
    let changed = fs::read_to_string(&config).unwrap().replace("0.5 meV", "0.6 meV");
    fs::write(&config, changed).unwrap();
    let (code, _, said) = spinneb(folder.path(), &["rate", "results/chain", "-T", "3 K"]);
    assert_eq!(code, Some(2));
    assert!(said.contains("the result here is damaged: config.json is not as the run wrote it"), "{said}");
}

#[test]
fn a_refused_theory_is_said_and_does_not_fail_the_run() {
    let uniaxial = CONFIG.replace(",\n    {\"anisotropy\": {\"K\": \"-0.25 meV\", \"axis\": [1, 0, 0]}}", "");
    let folder = folder(&uniaxial);
    let (code, _, said) = spinneb(folder.path(), &["run", "chain.json"]);
    assert_eq!(code, Some(0), "{said}");
    assert!(
        said.contains("warning: no rate by htst: the energy is the same for all turns about (0.000, 0.000, 1.000)")
    );
    let summary = summary(folder.path());
    let r = &summary["rates"][0];
    assert!(r["htst_prefactor_Hz"].is_null() && r["langer_prefactor_Hz"].as_f64().unwrap() > 0.0);
    assert!(r["refused"]["htst"].as_str().unwrap().contains("conserved"));
    assert_eq!((&r["prefactor_temperature_K"], &r["prefactor_temperature_exponent"]), (&1.0.into(), &(-0.5).into()));
    let zero = &r["saddle_zero_modes"][0];
    assert_eq!((&zero["kind"], &zero["modes"]), (&"rotation".into(), &1.into()));
    assert!((zero["volume_rad"].as_f64().unwrap() - 2.0 * std::f64::consts::PI * 3f64.sqrt()).abs() < 1e-9);
    // undamped, nothing is left: the command says so with another code
    let (code, out, _) = spinneb(folder.path(), &["rate", "results/chain", "-T", "1 K", "--damping", "0"]);
    assert_eq!(code, Some(3));
    assert!(out.contains("none: the energy is the same for all turns"), "{out}");
}

#[test]
fn a_barrier_below_kt_leaves_the_entry_with_nulls_and_a_reason() {
    let folder = folder(&CONFIG.replace("\"1 K\", \"3 K\"", "\"3 K\", \"20 K\""));
    let (code, _, said) = spinneb(folder.path(), &["run", "chain.json"]);
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("mean lifetime of the initial state: 6e-10 s at 3 K (within a factor of "), "{said}");
    let summary = summary(folder.path());
    let hot = &summary["rates"][0]["temperatures"][1];
    let keys = ["htst_rate_per_s", "langer_rate_per_s", "lifetime_s", "log10_lifetime_s", "known_within_factor"];
    assert!(keys.iter().all(|key| hot[key].is_null()) && hot["temperature_K"] == 20.0, "{hot}");
    assert!(hot["reason"].as_str().unwrap().contains("below 1 k_BT"), "{hot}");
    assert!(summary["rates"][0]["langer_prefactor_Hz"].as_f64().unwrap() > 0.0);
    let whole = &summary["transition_rates"][0]["temperatures"][1];
    assert!(
        whole["first_passage_s"].is_null() && whole["escape_lifetime_s"].is_null() && whole["reason"] == hot["reason"]
    );
    let csv = fs::read_to_string(folder.path().join("results/chain/rates.csv")).unwrap();
    assert!(
        csv.lines().nth(2).unwrap().starts_with("0,forward,20.0,0.8")
            && csv.lines().nth(2).unwrap().ends_with(",,,,,,,,,"),
        "{csv}"
    );
    // what is left at 3 K alone makes no figure; in one of more, what lies below 5 k_BT is grey
    let svg = |folder: &Path| fs::read_to_string(folder.join("results/chain/arrhenius.svg")).unwrap();
    assert!(!folder.path().join("results/chain/arrhenius.svg").exists());
    let (code, out, _) = spinneb(folder.path(), &["rate", "results/chain", "-T", "3 K", "-T", "10 K", "-T", "20 K"]);
    assert_eq!(code, Some(0));
    assert!(out.contains("none: ΔE is below 1 k_BT"), "{out}");
    assert!(svg(folder.path()).contains("Barrier below 5 k\n"));
}
