use super::*;
use std::fs;

const CONFIG: &str = r#"{
  "material": "toy.json",
  "lattice": {"chain": {"sites": 4}},
  "initial": {"uniform": {"direction": [0, 0, 1]}},
  "final": {"uniform": {"direction": [0, 0, -1]}}
}"#;
const TOY: &str = r#"{"name": "toy", "energy": [{"exchange": {"J": ["10 meV"]}}]}"#;

/// A folder with a config and its material.
fn folder() -> (tempfile::TempDir, PathBuf) {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("toy.json"), TOY).unwrap();
    let path = dir.path().join("wall.json");
    fs::write(&path, CONFIG).unwrap();
    (dir, path)
}

#[test]
fn a_config_as_run_runs_by_itself_and_is_its_own_form() {
    let (dir, path) = folder();
    let first = load(&path, &["path.images=7".into()]).unwrap();
    assert_eq!(first.name, "wall");
    let other = dir.path().join("deeper");
    fs::create_dir(&other).unwrap();
    let copy = other.join("config.json");
    fs::write(&copy, &first.as_run).unwrap();
    let second = load(&copy, &[]).unwrap();
    assert_eq!(second.as_run, first.as_run);
    assert_eq!(second.sha256, first.sha256);
    assert_eq!(second.parts[0].material, first.parts[0].material);
    assert_eq!(second.name, "wall");
}

#[test]
fn the_hash_does_not_depend_on_layout_order_of_keys_or_schema_but_on_every_value() {
    let (_dir, path) = folder();
    let hash = |text: &str, sets: &[&str]| {
        fs::write(&path, text).unwrap();
        load(&path, &sets.iter().map(|s| s.to_string()).collect::<Vec<_>>()).unwrap().sha256
    };
    let plain = hash(CONFIG, &[]);
    assert_eq!(plain.len(), 64);
    let lattice = r#""lattice": {"chain": {"sites": 4}},"#;
    let moved = CONFIG.replace(lattice, "").replacen('{', &format!("{{\"$schema\": \"x\", {lattice}\n\n"), 1);
    assert_eq!(hash(&moved, &[]), plain);
    assert_ne!(hash(CONFIG, &["path.images=7"]), plain);
    assert_ne!(hash(CONFIG, &["name=\"other\""]), plain);
}

#[test]
fn an_error_in_the_material_s_file_names_that_file() {
    let (dir, path) = folder();
    fs::write(dir.path().join("toy.json"), TOY.replace("exchange", "exchnage")).unwrap();
    let said = load(&path, &[]).unwrap_err().to_string();
    let file = dir.path().join("toy.json").display().to_string();
    assert!(said.starts_with(&format!("{file}:1:29: energy[0].exchnage: ")), "{said}");
    assert!(said.contains("did you mean \"exchange\"?"), "{said}");
}

#[test]
fn a_missing_material_says_where_it_was_looked_for() {
    let (_dir, path) = folder();
    let said = load(&path, &["material=\"tyo.json\"".into()]).unwrap_err().to_string();
    assert!(said.starts_with("--set material: no material \"tyo.json\": there is no file "), "{said}");
    assert!(said.contains("(did you mean \"toy.json\"?)"), "{said}");
}
