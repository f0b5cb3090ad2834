//! Configs that take their ends or their path from files, and results whose files serve as such.

use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn spinneb(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_spinneb")).current_dir(folder).args(arguments).output().unwrap()
}

fn summary(folder: &Path, name: &str) -> Value {
    serde_json::from_slice(&fs::read(folder.join("results").join(name).join("summary.json")).unwrap()).unwrap()
}

/// Runs a config that must succeed; its warnings as they were said.
fn run(folder: &Path, arguments: &[&str]) -> String {
    let done = spinneb(folder, &[&["run"], arguments].concat());
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    assert_eq!(done.status.code(), Some(0), "{arguments:?}: {said}");
    said
}

fn write(folder: &Path, file: &str, config: &Value) {
    fs::write(folder.join(file), config.to_string()).unwrap();
}

/// A config without its ends and its path.
fn base() -> Value {
    json!({
        "material": {"name": "toy", "moment": "2 mu_B",
            "energy": [{"exchange": {"J": ["10 meV"]}}, {"anisotropy": {"K": "0.5 meV", "axis": [0, 0, 1]}}]},
        "lattice": {"chain": {"sites": 30, "spacing": "0.3 nm"}},
        "output": {"formats": ["csv", "npz", "ovf", "ovf_binary4", "ovf_text", "ovf_images", "spins_csv", "vtk"], "plots": []}
    })
}

/// `base` from all up to all down.
fn wall_from_the_left() -> Value {
    let mut config = base();
    config["initial"] = json!({"uniform": {"direction": [0, 0, 1]}});
    config["final"] = json!({"uniform": {"direction": [0, 0, -1]}});
    config["path"] = json!({"images": 9, "guess": {"sweep": {"from": "left"}}});
    config
}

fn barrier(summary: &Value) -> f64 {
    summary["barrier_meV"]["forward"].as_f64().unwrap()
}

#[test]
fn the_files_of_a_result_are_ends_and_paths_of_another_which_runs_by_itself() {
    let temporary = tempfile::tempdir().unwrap();
    let folder = temporary.path();
    let first = wall_from_the_left();
    write(folder, "first.json", &first);
    run(folder, &["first.json"]);
    let of_first = summary(folder, "first");

    let files = ["path.npz", "path.ovf", "path_binary4.ovf", "path_text.ovf", "spins.csv"];
    for (k, file) in files.iter().enumerate() {
        let path = format!("results/first/{file}");
        let mut second = base();
        second["initial"] = json!({"file": {"path": path, "segment": 0}});
        second["final"] = json!({"file": {"path": path, "segment": -1}});
        second["path"] =
            json!({"images": if k == 0 { json!(9) } else { json!("auto") }, "guess": {"file": {"path": path}}});
        let name = format!("second_{k}");
        write(folder, &format!("{name}.json"), &second);
        run(folder, &[&format!("{name}.json")]);
        let of_second = summary(folder, &name);
        let change = barrier(&of_second) - barrier(&of_first);
        assert!(change.abs() < 1e-9 * barrier(&of_first), "{file}: {change}");
        assert_eq!(of_second["warnings"], json!([]), "{file}");

        // config.json names its own copies of the files and has the same hash, wherever it is
        let moved = folder.join(format!("elsewhere_{k}"));
        fs::rename(folder.join("results").join(&name), &moved).unwrap();
        let again = format!("again_{k}");
        run(folder, &[&format!("elsewhere_{k}/config.json"), "--out", &format!("results/{again}")]);
        let of_again = summary(folder, &again);
        assert_eq!(of_again["config_sha256"], of_second["config_sha256"], "{file}");
        assert_eq!(of_again["barrier_meV"], of_second["barrier_meV"], "{file}");
        for input in ["initial", "final", "guess"] {
            let bytes = |folder: &Path| fs::read(folder.join(format!("inputs/{input}.npy"))).unwrap();
            assert_eq!(bytes(&moved), bytes(&folder.join("results").join(&again)), "{file}: {input}");
        }
    }

    // another file of the same name is another config
    let config = folder.join("elsewhere_0/config.json");
    fs::copy(folder.join("elsewhere_0/inputs/final.npy"), folder.join("elsewhere_0/inputs/initial.npy")).unwrap();
    let refused = spinneb(folder, &["check", config.to_str().unwrap()]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("initial.file.sha256: the file "));
}

#[test]
fn files_of_an_older_result_do_not_stay_and_others_are_left_alone() {
    let temporary = tempfile::tempdir().unwrap();
    let folder = temporary.path();
    let config = wall_from_the_left();
    write(folder, "wall.json", &config);
    run(folder, &["wall.json"]);
    let result = folder.join("results/wall");
    let count = |name: &str| fs::read_dir(result.join(name)).map_or(0, Iterator::count);
    assert_eq!((count("ovf"), count("vtk")), (9, 9));
    fs::write(result.join("notes.txt"), "mine").unwrap();
    run(folder, &["wall.json", "--force", "--set", "path.images=7", "--set", r#"output.formats=["vtk"]"#]);
    assert_eq!((count("ovf"), count("vtk")), (0, 7));
    assert!(!result.join("ovf").exists() && !result.join("path.npz").exists() && result.join("notes.txt").exists());
}

#[test]
fn what_is_wrong_with_a_file_is_said_at_its_place_in_the_config_and_warnings_reach_the_summary() {
    let temporary = tempfile::tempdir().unwrap();
    let folder = temporary.path();
    let mut config = base();
    config["lattice"]["chain"]["sites"] = json!(2);
    config["initial"] = json!({"file": {"path": "m.csv"}});
    config["final"] = json!({"uniform": {"direction": [0, 0, -1]}});
    write(folder, "wall.json", &config);
    for (content, words) in [
        ("0 0 1\n0 0 0\n", "initial.file.path: m.csv: line 2: the vector is zero"),
        ("0 0 1\n", "initial.file.path: m.csv has 1 spin, but the chain has 2 sites"),
    ] {
        fs::write(folder.join("m.csv"), content).unwrap();
        for command in ["check", "run"] {
            let done = spinneb(folder, &[command, "wall.json"]);
            let said = String::from_utf8_lossy(&done.stderr).into_owned();
            assert_eq!(done.status.code(), Some(2), "{said}");
            assert!(said.starts_with("error: wall.json:1:") && said.contains(words), "{said}");
        }
        assert!(!folder.join("results").exists());
    }
    fs::write(folder.join("m.csv"), "0 0 8e5\n0 0 8e5\n").unwrap();
    let said = run(folder, &["wall.json"]);
    assert!(said.contains("warning: m.csv: all vectors are 800000 long"), "{said}");
    assert!(summary(folder, "wall")["warnings"][0].as_str().unwrap().contains("m.csv"));
}

/// A PNG of so many grey pixels a row, 0 black.
fn png(columns: u32, grey: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, columns, grey.len() as u32 / columns);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.write_header().unwrap().write_image_data(grey).unwrap();
    bytes
}

#[test]
fn an_image_is_a_shape_and_a_region_and_the_config_as_run_needs_it_no_more() {
    let temporary = tempfile::tempdir().unwrap();
    let folder = temporary.path();
    // the left half of a film, and of that the upper row
    fs::write(folder.join("left.png"), png(2, &[0, 255])).unwrap();
    fs::write(folder.join("top.png"), png(1, &[0, 255, 255])).unwrap();
    let mut config = wall_from_the_left();
    config["lattice"] = json!({"square": {"cells": [6, 3], "shape": {"image": {"path": "left.png"}},
        "regions": {"top": {"image": {"path": "top.png"}}}}});
    config["energy"] = json!([{"anisotropy": {"K": "0.1 meV", "axis": [0, 0, 1], "sites": "top"}}]);
    config["path"] = json!({"images": 5, "guess": {"sweep": {"from": "left"}}});
    write(folder, "film.json", &config);
    let checked = spinneb(folder, &["check", "film.json"]);
    let said = String::from_utf8_lossy(&checked.stdout).into_owned();
    for words in ["square, 6 × 3 cells, open, 9 sites (9 left out)", "a a a", "o o o", "a 3 of region top"] {
        assert!(said.contains(words), "{words}: {said}");
    }
    run(folder, &["film.json", "--quiet"]);
    fs::create_dir(folder.join("elsewhere")).unwrap();
    fs::copy(folder.join("results/film/config.json"), folder.join("elsewhere/film.json")).unwrap();
    run(&folder.join("elsewhere"), &["film.json", "--quiet"]);
    let [first, again] = [folder.to_path_buf(), folder.join("elsewhere")].map(|f| summary(&f, "film"));
    assert_eq!((&first["config_sha256"], barrier(&first)), (&again["config_sha256"], barrier(&again)));
    for (path, bytes, said) in [
        ("none.png", None, "lattice.square.shape.image.path: the image none.png cannot be read"),
        ("text.png", Some(b"no image".to_vec()), "lattice.square.shape.image.path: text.png is no PNG image"),
        ("white.png", Some(png(1, &[255])), "lattice.square.shape: no site of the lattice is inside"),
    ] {
        if let Some(bytes) = bytes {
            fs::write(folder.join(path), bytes).unwrap();
        }
        config["lattice"]["square"]["shape"]["image"]["path"] = json!(path);
        write(folder, "bad.json", &config);
        let refused = spinneb(folder, &["run", "bad.json"]);
        let message = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert_eq!(refused.status.code(), Some(2), "{message}");
        assert!(message.contains(said), "{message}");
    }
}

#[test]
fn a_film_is_read_back_from_its_own_files_and_drawn_anew_from_them() {
    let temporary = tempfile::tempdir().unwrap();
    let folder = temporary.path();
    let mut config = wall_from_the_left();
    config["lattice"] =
        json!({"square": {"cells": [5, 4], "spacing": "0.3 nm", "vacant": [7], "shape": {"disc": {"radius": 2.2}}}});
    config["path"] = json!({"images": 5, "guess": {"sweep": {"from": "left"}}});
    write(folder, "film.json", &config);
    run(folder, &["film.json", "--quiet"]);
    let of_film = summary(folder, "film");
    for (k, file) in ["path.npz", "path.ovf", "path_text.ovf"].into_iter().enumerate() {
        let path = format!("results/film/{file}");
        config["initial"] = json!({"file": {"path": path, "segment": 0}});
        config["path"]["guess"] = json!({"file": {"path": path}});
        let name = format!("again_{k}.json");
        write(folder, &name, &config);
        run(folder, &[&name, "--quiet"]);
        let again = barrier(&summary(folder, &format!("again_{k}")));
        assert!((again - barrier(&of_film)).abs() < 1e-9, "{file}: {again}");
    }
    // on another lattice
    config["lattice"]["square"]["cells"] = json!([4, 4]);
    write(folder, "other.json", &config);
    let message = String::from_utf8_lossy(&spinneb(folder, &["run", "other.json"]).stderr).into_owned();
    assert!(message.contains("path_text.ovf has 5 × 4 × 1 nodes, but the lattice has 4 × 4 × 1 cells"), "{message}");
    // figures from the mesh alone, rates from the meshes of saddles and minima
    let rate = spinneb(folder, &["rate", "results/film", "-T", "300K"]);
    assert!(!String::from_utf8_lossy(&rate.stderr).contains("anew"), "{}", String::from_utf8_lossy(&rate.stderr));
}
