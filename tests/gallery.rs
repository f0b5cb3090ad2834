//! The gallery tells what the program finds today: the committed results against a run of every shipped config.

use serde_json::Value;
use spinneb::config::{Loaded, load, load_landscape};
use spinneb::drive::survey::survey;
use spinneb::drive::{Silent, run};
use spinneb::output::render_files;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Too slow to be run once more: their barriers are compared with those of the book, which another test compares with a run.
const SLOW: [&str; 3] = ["cobalt_chain", "permalloy_notch", "pd_fe_ir111_skyrmion"];
/// The results whose `report.html` is committed.
const REPORTS: [&str; 2] = ["ring_nucleus", "wall_nucleation"];
const ANEW: &str = "make the gallery anew: cargo run --release --example gallery";

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn gallery(name: &str) -> PathBuf {
    root().join("results/gallery").join(name)
}

fn names() -> BTreeSet<String> {
    let files = fs::read_dir(root().join("configs")).unwrap().map(|e| e.unwrap().path());
    let configs = files.filter(|path| path.extension().is_some_and(|e| e == "json"));
    configs.map(|path| path.file_stem().unwrap().to_str().unwrap().to_string()).collect()
}

fn config(name: &str) -> Loaded {
    load(&root().join("configs").join(format!("{name}.json")), &[]).unwrap()
}

/// A summary without what depends on time and machine.
fn timeless(summary: &[u8]) -> Value {
    let mut value: Value = serde_json::from_slice(summary).unwrap();
    let work = value["work"].as_object_mut().unwrap();
    assert!(work.remove("seconds").is_some() && work.remove("threads").is_some());
    value
}

fn text(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}; {ANEW}", path.display())).replace("\r\n", "\n")
}

#[test]
fn committed_summaries_and_tables_are_those_of_a_run_to_the_last_digit() {
    let mut compared = 0;
    for name in names().into_iter().filter(|name| !SLOW.contains(&name.as_str())) {
        let loaded = config(&name);
        let outcome = run(&loaded.problem().unwrap(), &mut Silent).unwrap();
        let reported = REPORTS.contains(&name.as_str());
        let report = loaded.report(&outcome).unwrap();
        for file in render_files(&report, |kind| kind.name == "csv" || (kind.name == "html" && reported)).unwrap() {
            let stored = gallery(&name).join(&file.name);
            let shown = stored.display();
            match file.name.as_str() {
                "profile.csv" | "rates.csv" => continue,
                "summary.json" => {
                    let stored = text(&stored);
                    assert_eq!(timeless(stored.as_bytes()), timeless(&file.bytes), "{shown}: {ANEW}");
                }
                _ => assert!(text(&stored).as_bytes() == file.bytes, "{shown} is not what a run gives; {ANEW}"),
            }
            compared += 1;
        }
    }
    // summary, config and four tables each, and the reports
    assert_eq!(compared, 6 * (names().len() - SLOW.len()) + REPORTS.len());
}

#[test]
fn the_slow_ones_are_of_todays_configs_and_have_the_barriers_of_the_book() {
    let book = text(&root().join("docs/src/configs.md"));
    for name in SLOW {
        let summary: Value = serde_json::from_str(&text(&gallery(name).join("summary.json"))).unwrap();
        assert_eq!(summary["config_sha256"], config(name).sha256, "{name}: {ANEW}");
        assert_eq!(summary["version"], env!("CARGO_PKG_VERSION"), "{name}: {ANEW}");
        assert!(summary["certified"] == true && summary["converged"] == true, "{name}");
        let [forward, backward] = ["forward", "backward"].map(|way| summary["barrier_meV"][way].as_f64().unwrap());
        let row = format!("| [`{name}`](../../configs/{name}.json) | {forward:.6} / {backward:.6} |");
        assert!(book.contains(&row), "{row}; {ANEW}");
        // the tables beside it are of the same run
        let rows = text(&gallery(name).join("path.csv")).lines().count() - 1;
        assert_eq!(summary["path"]["images"], rows, "{name}: {ANEW}");
        let highest =
            summary["saddles"].as_array().unwrap().iter().map(|s| s["energy_above_initial_meV"].as_f64().unwrap());
        assert!((highest.fold(f64::MIN, f64::max) - forward).abs() < 1e-9, "{name}");
    }
}

#[test]
fn the_page_shows_every_config_with_its_barrier_and_figures_that_are_there() {
    let page = text(&root().join("results/gallery/README.md"));
    for name in names() {
        let summary: Value = serde_json::from_str(&text(&gallery(&name).join("summary.json"))).unwrap();
        let [forward, backward] = ["forward", "backward"].map(|way| summary["barrier_meV"][way].as_f64().unwrap());
        let section = page.split(&format!("\n## {name}\n")).nth(1).unwrap_or_else(|| panic!("{name}: {ANEW}"));
        let section = section.split("\n## ").next().unwrap();
        assert!(section.contains(&format!("{forward:.6} meV forward, {backward:.6} meV backward")), "{name}: {ANEW}");
        assert!(section.trim_start().len() > 400 && section.matches("<img ").count() >= 5, "{name}: {ANEW}");
    }
    let sources = page.split("src=\"").skip(1).map(|rest| rest.split('"').next().unwrap());
    let links = page.split("](").skip(1).map(|rest| rest.split(')').next().unwrap());
    for file in sources.chain(links) {
        assert!(gallery(file).is_file(), "{file}: {ANEW}");
    }
}

#[test]
fn committed_landscapes_have_the_kinds_of_states_that_a_survey_finds() {
    for entry in fs::read_dir(root().join("configs/landscapes")).unwrap() {
        let loaded = load_landscape(&entry.unwrap().path(), &[]).unwrap();
        let found = survey(&loaded.survey().unwrap(), &mut Silent).unwrap();
        let stored = text(&gallery("landscapes").join(&loaded.name).join("landscape.json"));
        let stored: Value = serde_json::from_str(&stored).unwrap();
        assert_eq!(stored["config_sha256"], loaded.sha256, "{}: {ANEW}", loaded.name);
        for (of, kinds) in [("minima", &found.minimum_kinds), ("saddles", &found.saddle_kinds)] {
            let entry = |e: &Value| (e["energy_meV"].as_f64().unwrap(), e["multiplicity"].as_u64().unwrap());
            let listed: Vec<(f64, u64)> = stored[of].as_array().unwrap().iter().map(entry).collect();
            let own: Vec<(f64, u64)> = kinds.iter().map(|kind| (kind.energy_mev, kind.multiplicity as u64)).collect();
            let alike = |(a, b): (&(f64, u64), &(f64, u64))| (a.0 - b.0).abs() < 1e-9 * a.0.abs() && a.1 == b.1;
            let same = listed.len() == own.len() && listed.iter().zip(&own).all(alike);
            assert!(same, "{}: {of}: {listed:?} {own:?}; {ANEW}", loaded.name);
        }
    }
}

#[test]
fn the_gallery_is_small() {
    fn size(folder: &Path) -> u64 {
        let committed = |path: &Path| {
            let of = path.parent().and_then(Path::file_name).and_then(|name| name.to_str()).unwrap_or_default();
            !path.ends_with("report.html") || REPORTS.contains(&of)
        };
        let entries = fs::read_dir(folder).unwrap().map(|e| e.unwrap()).filter(|e| committed(&e.path()));
        entries.map(|e| if e.path().is_dir() { size(&e.path()) } else { e.metadata().unwrap().len() }).sum()
    }
    assert!(size(&gallery("")) < 4_500_000, "{} bytes", size(&gallery("")));
}
