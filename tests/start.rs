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
    schema_of("config")
}

fn schema_of(what: &str) -> Validator {
    let printed = spinneb(&root(), &["schema", what]);
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
fn shipped_sweeps_and_landscapes_are_valid_by_their_schemas_and_misspelt_ones_are_not() {
    let (sweep, landscape) = (schema_of("sweep"), schema_of("landscape"));
    let examples = json_files("examples/sweeps").into_iter().chain(json_files("configs/sweeps"));
    let files: Vec<_> = examples
        .map(|f| (&sweep, f))
        .chain(json_files("configs/landscapes").into_iter().map(|f| (&landscape, f)))
        .collect();
    assert!(files.len() >= 7, "{}", files.len());
    for (schema, (file, content)) in &files {
        let wrong: Vec<String> = schema.iter_errors(content).map(|e| format!("{}: {e}", e.instance_path())).collect();
        assert!(wrong.is_empty(), "{file}: {wrong:?}");
        let mut misspelt = content.clone();
        misspelt["gird"] = json!({});
        assert!(!schema.is_valid(&misspelt), "{file}");
    }
    let range = |from: Value, points: Value| json!({"config": "a.json", "grid": {"x": {"from": from, "to": "1 T", "points": points}}});
    for (file, valid) in [
        (range(json!("-1 T"), json!(3)), true),
        (range(json!("-1 Tesla"), json!(3)), false),
        (range(json!("-1 T"), json!(1)), false),
        (json!({"config": "a.json", "grid": {"x": []}}), false),
        (json!({"config": "a.json"}), false),
        (json!({"config": "a.json", "grid": {"x": [1]}, "zip": {"x": [1]}}), false),
        (json!({"grid": {"x": [1]}}), false),
    ] {
        assert_eq!(sweep.is_valid(&file), valid, "{file}");
    }
    let without_ends = json!({"material": "toy", "lattice": {"chain": {"sites": 3}}});
    assert!(landscape.is_valid(&without_ends) && !schema().is_valid(&without_ends));
}

#[test]
fn every_key_is_described_and_has_a_value_that_the_schema_takes() {
    let whole: Value = serde_json::from_slice(&spinneb(&root(), &["schema"]).stdout).unwrap();
    let (mut keys, mut wrong) = (0, Vec::new());
    for section in spinneb::config::reference::sections() {
        let fits = |part: &Value, example: &str| {
            let schema = json!({"allOf": [part], "definitions": whole["definitions"]});
            jsonschema::validator_for(&schema).unwrap().is_valid(&serde_json::from_str(example).unwrap())
        };
        if section.summary.is_empty() || !fits(&section.schema, &section.example) {
            wrong.push(format!("{}: {:?} {}", section.path, section.summary, section.example));
        }
        for (key, example) in &section.keys {
            let told = !key.meaning.is_empty() && !key.value.is_empty();
            if !told || !fits(&section.schema["properties"][&key.name], example) {
                wrong.push(format!("{}.{}: {} {example}", section.path, key.name, key.meaning));
            }
            keys += 1;
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(keys > 200, "{keys}");
    // every object of the schema is in the reference
    let parts: Vec<Value> = spinneb::config::reference::sections().into_iter().map(|section| section.schema).collect();
    for (name, part) in whole["definitions"].as_object().unwrap() {
        // those of one kind of value are told of once
        let once = name.contains("_of_");
        assert!(!part["properties"].is_object() || once || parts.contains(part), "{name} is not in the reference");
    }
}

#[test]
fn the_reference_of_a_key_is_printed_and_an_unknown_one_is_refused_with_a_near_one() {
    let docs = |name: &str| {
        let done = spinneb(&root(), &["docs", name]);
        (done.status.code(), said(&done))
    };
    for (name, words) in [
        ("anisotropy.K", &["energy.anisotropy.K (required)", "positive: easy axis", "J/m^3", "\"K\": \"0.5 meV\""][..]),
        ("energy[0].anisotropy.K", &["energy.anisotropy.K (required)"]),
        ("energy.0.anisotropy.K", &["energy.anisotropy.K (required)"]),
        ("material.energy[1].anisotropy.K", &["energy.anisotropy.K (required)"]),
        ("final.domain_wall.center", &["initial.domain_wall.center (required)"]),
        ("final.skyrmion", &["initial.skyrmion: ", "initial.skyrmion.radius (may be left out)"]),
        ("landscape.states[1].skyrmion", &["initial.skyrmion: "]),
        ("center", &["initial.domain_wall.center", "initial.skyrmion.center", "shape.disc.center"]),
        ("path.images", &["path.images (may be left out)"]),
        ("neb.tolerance", &["neb.tolerance (1e-6 if left out)", "a number"]),
        ("lattice.chain", &["lattice.chain: a row", "lattice.chain.sites (required)", "lattice.chain.periodic (false"]),
        ("random.seed", &["value.random.seed (required)"]),
    ] {
        let (code, text) = docs(name);
        assert_eq!(code, Some(0), "{name}: {text}");
        words.iter().for_each(|word| assert!(text.contains(word), "{name}: {word} is not in {text}"));
    }
    for (name, hint) in [
        ("anistropy.K", "did you mean \"anisotropy.K\"?"),
        ("neb.tolerence", "did you mean \"neb.tolerance\"?"),
        ("enery[0].anisotropy.K", "did you mean \"energy.anisotropy.K\"?"),
        ("neb.sites", "error: there is no key \"neb.sites\""),
        ("xyzzyxyzzy", "`spinneb docs` prints all of them"),
    ] {
        let (code, text) = docs(name);
        assert!(code == Some(2) && text.contains(hint), "{name}: {text}");
    }
    assert!(said(&spinneb(&root(), &["docs"])).lines().count() > 200);
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
    let commands = [
        "run",
        "relax",
        "sweep",
        "collect",
        "check",
        "list",
        "docs",
        "rate",
        "import",
        "init",
        "schema",
        "completions",
        "man",
    ];
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
