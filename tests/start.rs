//! What helps to start: the schema agrees with the program, starter configs run, completions and man pages tell of everything.

use jsonschema::Validator;
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn spinneb(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_spinneb")).current_dir(folder).args(arguments).output().unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

fn json_files(folder: &str) -> Vec<(String, Value)> {
    let paths = fs::read_dir(root().join(folder)).unwrap().map(|e| e.unwrap().path());
    let files = paths.filter(|p| p.extension().is_some_and(|e| e == "json"));
    let read = |p: PathBuf| Some((p.display().to_string(), serde_json::from_slice(&fs::read(p).unwrap()).ok()?));
    files.filter_map(read).collect()
}

fn schema() -> Validator {
    let printed = spinneb(&root(), &["schema"]);
    assert_eq!(printed.status.code(), Some(0));
    let schema: Value = serde_json::from_slice(&printed.stdout).unwrap();
    assert!(jsonschema::meta::is_valid(&schema));
    jsonschema::validator_for(&schema).unwrap()
}

/// Bad configs of these names are misspelt, or have values of a wrong type: that is for a schema to find. What a config means, such
/// as which units fit, is not.
const FOR_A_SCHEMA: &[&str] = &[
    "array_",
    "evaluations_",
    "format_",
    "images_f",
    "images_t",
    "images_w",
    "key_",
    "kind_",
    "name_with",
    "plot_",
    "quantity_bare",
    "quantity_not",
    "quantity_without",
    "rates_key",
    "rates_theory",
    "smooth_too",
    "tolerance_",
    "type_",
];

#[test]
fn every_shipped_config_is_valid_by_the_schema_and_misspelt_ones_are_not() {
    let schema = schema();
    for (file, config) in json_files("configs") {
        let wrong: Vec<String> = schema.iter_errors(&config).map(|e| format!("{}: {e}", e.instance_path())).collect();
        assert!(wrong.is_empty(), "{file}: {wrong:?}");
    }
    let for_a_schema = |name: &str| name != "key_twice" && FOR_A_SCHEMA.iter().any(|start| name.starts_with(start));
    let mut refused = 0;
    for (file, config) in json_files("tests/configs/bad") {
        let name = Path::new(&file).file_stem().unwrap().to_str().unwrap();
        if for_a_schema(name) {
            assert!(!schema.is_valid(&config), "{file} passes");
            refused += 1;
        }
    }
    assert!(refused > 40, "{refused}");
}

#[test]
fn the_schema_takes_every_example_of_the_lists_and_refuses_misspelt_ones() {
    use spinneb::energy::TermSpec;
    use spinneb::optimise::OptimiserSpec;
    use spinneb::path::guess::GuessSpec;
    use spinneb::state::StateSpec;
    let schema = schema();
    let up = json!({"uniform": {"direction": [0, 0, 1]}});
    let base = json!({"material": "m.json", "lattice": {"chain": {"sites": 9}}, "initial": up, "final": up});
    let with = |key: &str, value: Value| {
        let mut config = base.clone();
        config[key] = value;
        config
    };
    let lists = [
        ("energy", TermSpec::ENTRIES),
        ("initial", StateSpec::ENTRIES),
        ("path", GuessSpec::ENTRIES),
        ("neb", OptimiserSpec::ENTRIES),
    ];
    let place = |key: &str, example: Value| match key {
        "energy" => json!([example]),
        "path" => json!({"guess": example}),
        "neb" => json!({"optimiser": example}),
        _ => example,
    };
    for (key, entries) in lists {
        for entry in entries {
            let example: Value = serde_json::from_str(entry.example).unwrap();
            let config = with(key, place(key, example));
            let wrong: Vec<String> = schema.iter_errors(&config).map(|e| e.to_string()).collect();
            assert!(wrong.is_empty(), "{}: {wrong:?}", entry.example);
            let misspelt: Value = serde_json::from_str(&entry.example.replacen(entry.name, "misspelt", 1)).unwrap();
            assert!(!schema.is_valid(&with(key, place(key, misspelt))), "{}", entry.name);
        }
    }
    assert!(schema.is_valid(&with("comment", json!(["two", "lines"]))));
    assert!(!schema.is_valid(&with("initail", json!(1))));
    for (quantity, valid) in [("10 meV", true), ("-0.5e-3 Ry", true), ("13 pJ/m", false), ("10", false), ("meV", false)]
    {
        let material = json!({"name": "m", "energy": [{"exchange": {"J": [quantity]}}]});
        assert_eq!(schema.is_valid(&with("material", material)), valid, "{quantity}");
    }
}

#[test]
fn starter_configs_are_valid_and_find_certified_paths() {
    let folder = tempfile::tempdir().unwrap();
    let schema = schema();
    for template in ["chain", "nanowire", "lifetime", "film", "crystal"] {
        let written = spinneb(folder.path(), &["init", template]);
        assert_eq!(written.status.code(), Some(0), "{}", said(&written));
        let file = format!("{template}.json");
        let config: Value = serde_json::from_slice(&fs::read(folder.path().join(&file)).unwrap()).unwrap();
        assert!(schema.is_valid(&config), "{template}");
        assert!(config["comment"].as_array().unwrap().len() >= 3, "{template}: explanations");
        assert_eq!(config["$schema"], "spinneb.schema.json");
        let printed = spinneb(folder.path(), &["schema"]).stdout;
        assert_eq!(fs::read(folder.path().join("spinneb.schema.json")).unwrap(), printed);
        let run = spinneb(folder.path(), &["run", &file, "--json", "--quiet"]);
        assert_eq!(run.status.code(), Some(0), "{template}: {}", said(&run));
    }
    let again = spinneb(folder.path(), &["init"]);
    assert_eq!(again.status.code(), Some(2));
    assert!(said(&again).contains("chain.json exists already"), "{}", said(&again));
    assert_eq!(spinneb(folder.path(), &["init", "--force"]).status.code(), Some(0));
    let deep = spinneb(folder.path(), &["init", "nanowire", "--out", "wires/first.json"]);
    assert_eq!(deep.status.code(), Some(0), "{}", said(&deep));
    assert!(folder.path().join("wires/spinneb.schema.json").is_file());
}

#[test]
fn completions_and_man_pages_tell_of_every_command() {
    let commands =
        ["run", "relax", "sweep", "collect", "check", "list", "rate", "init", "schema", "completions", "man"];
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = said(&spinneb(&root(), &["completions", shell]));
        for command in commands {
            assert!(script.contains(command), "{shell}: {command}");
        }
    }
    let page = said(&spinneb(&root(), &["man"]));
    assert!(page.contains(".TH spinneb 1"), "{page}");
    for command in commands {
        assert!(page.contains(&format!("spinneb\\-{command}")), "{command}");
        let own = spinneb(&root(), &["man", command]);
        assert_eq!(own.status.code(), Some(0));
        assert!(said(&own).contains(&format!(".TH spinneb-{command} 1")), "{}", said(&own));
    }
    let unknown = spinneb(&root(), &["man", "walk"]);
    assert_eq!(unknown.status.code(), Some(2));
    assert!(said(&unknown).contains("unknown command \"walk\""));
}
