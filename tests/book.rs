//! The book in `docs/` tells the truth: its commands, configs, tables, keys, numbers and links are those of the program.

use crate::common::shipped;
use crate::pages::{Page, quoted, root, run};
use serde_json::Value;
use spinneb::output::canvas::{Colour, diverging};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

fn page(name: &str) -> Page {
    Page::read(&format!("docs/src/{name}.md"))
}

fn json(file: &Path) -> Value {
    serde_json::from_slice(&fs::read(file).unwrap()).unwrap()
}

/// All keys of objects in a JSON value.
fn keys(value: &Value, found: &mut BTreeSet<String>) {
    match value {
        Value::Object(members) => members.iter().for_each(|(key, value)| {
            found.insert(key.clone());
            keys(value, found);
        }),
        Value::Array(values) => values.iter().for_each(|value| keys(value, found)),
        _ => {}
    }
}

#[test]
fn every_page_is_in_the_contents_once_and_its_links_lead_somewhere() {
    let (pages, contents) = Page::book();
    let listed: Vec<&str> = contents.links();
    let names: Vec<&str> = pages.iter().map(|page| page.file.strip_prefix("docs/src/").unwrap()).collect();
    for page in pages.iter().chain([&contents]) {
        page.check_links();
        assert!(page.text.starts_with("# "), "{}: a page begins with its title", page.file);
        for link in page.links().into_iter().filter(|link| link.ends_with(".md") && !link.contains('/')) {
            assert!(listed.contains(&link), "{}: {link} is not in the contents", page.file);
        }
    }
    assert_eq!(listed.iter().collect::<BTreeSet<_>>(), names.iter().collect());
    assert_eq!(listed.len(), names.len());
}

#[test]
fn the_reference_is_what_the_program_prints() {
    let (printed, committed) = (spinneb::config::reference::page(), page("reference").text);
    let differs = printed.lines().zip(committed.lines()).find(|(a, b)| a != b);
    assert!(!printed.contains("an object"), "a value is told by its keys or choices");
    assert!(printed == committed, "{differs:?}: spinneb docs --page > docs/src/reference.md");
}

#[test]
#[cfg_attr(windows, ignore = "needs a shell")]
fn every_command_and_config_of_the_book_does_what_it_says() {
    let (pages, _) = Page::book();
    let commands: usize = pages.iter().map(Page::follow).sum();
    assert!(commands >= 30, "{commands}");
}

#[test]
fn the_table_of_configs_has_every_shipped_config_and_its_barriers() {
    let mut listed = BTreeMap::new();
    for row in page("configs").rows().into_iter().skip(2) {
        let name = quoted(&row[0]).remove(0);
        assert_eq!(row[0], format!("[`{name}`](../../configs/{name}.json)"));
        assert!(row[2].len() > 60, "{name}: a purpose is a paragraph");
        listed.insert(name, row[1].clone());
    }
    assert_eq!(listed.keys().cloned().collect::<BTreeSet<_>>(), shipped::names());
    for (name, stated) in listed {
        let (forward, backward) = shipped::shipped(&name).barriers();
        assert_eq!(stated, format!("{forward:.6} / {backward:.6}"), "{name}");
    }
}

#[test]
fn the_explained_config_is_the_shipped_one_and_every_key_of_it_is_explained() {
    let page = page("config");
    let [config, material] = &page.blocks_of("json")[..] else { panic!("a config and its material") };
    let [explained, own]: [Value; 2] = [config, material].map(|text| serde_json::from_str(text).unwrap());
    let shipped = json(&root().join("configs/wall_depinning.json"));
    for (key, value) in explained.as_object().unwrap() {
        // what it writes out is what the shipped one leaves to the defaults, or says too
        assert!(shipped.get(key).is_none_or(|said| said == value) || key == "output", "{key}");
    }
    assert_eq!(own, json(&root().join("configs/materials/toy.json")));
    let told: Vec<String> = page.rows().iter().flat_map(|row| quoted(&row[0])).collect();
    assert_eq!(explained.as_object().unwrap().keys().collect::<BTreeSet<_>>(), told.iter().collect());
}

#[test]
fn a_run_writes_the_files_and_the_keys_that_are_told() {
    let temporary = tempfile::tempdir().unwrap();
    let out = temporary.path().join("wall_nucleation");
    run(&root().join("configs/wall_nucleation.json"), &out);
    let tables = page("results").rows();
    let first = |from: &str| tables.iter().position(|row| row[0] == from).unwrap_or_else(|| panic!("no table {from}"));
    let (files, keys_from, codes) = (first("file"), first("key"), first("exit code"));

    let told: BTreeSet<String> = tables[files..keys_from].iter().flat_map(|row| quoted(&row[0])).collect();
    let written = fs::read_dir(&out).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    assert_eq!(told, written);

    let summary = json(&out.join("summary.json"));
    let told: BTreeSet<String> = tables[keys_from..codes].iter().flat_map(|row| quoted(&row[0])).collect();
    assert_eq!(told, summary.as_object().unwrap().keys().cloned().collect());
    let inner: BTreeSet<String> = tables[keys_from..codes].iter().flat_map(|row| quoted(&row.join(" "))).collect();
    let mut all = BTreeSet::new();
    let mut without = summary.clone();
    // the keys of this one are names of files
    without["manifest"]["files"].take();
    keys(&without, &mut all);
    assert_eq!(all.difference(&inner).collect::<Vec<_>>(), Vec::<&String>::new(), "keys the page does not explain");

    let forward = |summary: &Value| summary["barrier_meV"]["forward"].as_f64().unwrap();
    let stored = json(&root().join("results/gallery/wall_nucleation/summary.json"));
    assert!((forward(&stored) - forward(&summary)).abs() < 1e-9, "the result in the gallery is another one");
    assert_eq!((&stored["config_sha256"], &stored["version"]), (&summary["config_sha256"], &summary["version"]));
    assert_eq!(stored["certified"], summary["certified"]);
}

#[test]
fn the_colours_of_the_python_example_are_those_of_the_figures() {
    let examples = page("python").blocks_of("python");
    let (_, rest) = examples.iter().find_map(|example| example.split_once("hues = \"")).unwrap();
    let hues: Vec<&str> = rest.split('"').next().unwrap().split(' ').collect();
    let own = |k: usize| {
        let Colour(r, g, b) = diverging(2.0 * k as f64 / (hues.len() - 1) as f64 - 1.0);
        format!("#{r:02x}{g:02x}{b:02x}")
    };
    assert!(hues.len() >= 9 && (0..hues.len()).all(|k| hues[k] == own(k)), "{hues:?}");
}
