//! The gallery tells what the program finds today: the committed results against a run of every shipped config.

use crate::common::shipped::{names, shipped};
use serde_json::Value;
use spinneb::config::load_landscape;
use spinneb::drive::Silent;
use spinneb::drive::survey::{Survey, survey};
use spinneb::spins::Spins;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The results whose `report.html` is committed.
const REPORTS: [&str; 2] = ["ring_nucleus", "wall_nucleation"];
const ANEW: &str = "make the gallery anew: cargo run --release --example gallery";

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn gallery(name: &str) -> PathBuf {
    root().join("results/gallery").join(name)
}

/// A summary without what depends on time and machine, and without the list of the files beside it.
fn timeless(summary: &[u8]) -> Value {
    let mut value: Value = serde_json::from_slice(summary).unwrap();
    let work = value["work"].as_object_mut().unwrap();
    assert!(work.remove("seconds").is_some() && work.remove("threads").is_some());
    value.as_object_mut().unwrap().remove("manifest");
    value
}

fn text(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}; {ANEW}", path.display())).replace("\r\n", "\n")
}

#[test]
fn committed_summaries_and_tables_are_those_of_a_run_to_the_last_digit() {
    let mut compared = 0;
    for name in names() {
        for (file, bytes) in &shipped(&name).files {
            let stored = gallery(&name).join(file);
            let shown = stored.display();
            match file.rsplit_once('.').unwrap() {
                ("profile" | "rates", "csv") => continue,
                ("summary", "json") => {
                    assert_eq!(timeless(text(&stored).as_bytes()), timeless(bytes), "{shown}: {ANEW}");
                }
                (_, "csv" | "json") => {
                    assert!(text(&stored).as_bytes() == bytes, "{shown} is not what a run gives; {ANEW}");
                }
                (_, "html") if REPORTS.contains(&name.as_str()) => {
                    assert!(text(&stored).as_bytes() == bytes, "{shown} is not what a run gives; {ANEW}");
                }
                _ => continue,
            }
            compared += 1;
        }
    }
    // summary, config and four tables each, and the reports
    assert_eq!(compared, 6 * names().len() + REPORTS.len());
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
        if loaded.name == "skyrmion" {
            holds_collapse_escape_and_duplication(&found, [18, 10]);
        }
    }
}

/// How many spins each connected piece has that points down, and whether it lies at an edge.
fn pieces(spins: &Spins, [nx, ny]: [usize; 2]) -> Vec<(usize, bool)> {
    let vectors = spins.vectors();
    let mut left: BTreeSet<usize> = (0..nx * ny).filter(|i| vectors[*i][2] < 0.3).collect();
    let mut found = Vec::new();
    while let Some(first) = left.pop_first() {
        let (mut front, mut size, mut at_edge) = (vec![first], 0, false);
        while let Some(i) = front.pop() {
            let (x, y) = (i % nx, i / nx);
            (size, at_edge) = (size + 1, at_edge || x == 0 || y == 0 || x + 1 == nx || y + 1 == ny);
            let near = |j: &usize| (j % nx).abs_diff(x) <= 1 && (j / nx).abs_diff(y) <= 1;
            let beside: Vec<usize> = left.iter().copied().filter(near).collect();
            left.retain(|j| !near(j));
            front.extend(beside);
        }
        found.push((size, at_edge));
    }
    found
}

/// From one skyrmion: over a saddle of a few spins inside the film, over one at an edge, and to two over one long piece.
fn holds_collapse_escape_and_duplication(found: &Survey, cells: [usize; 2]) {
    let groups = &found.lifetimes.as_ref().unwrap().groups;
    let is_in = |name: &str, k: usize| groups.iter().any(|(own, minima)| own == name && minima.contains(&k));
    let between = |a: &str, b: &str| -> Vec<Vec<(usize, bool)>> {
        let joins = |[p, q]: [usize; 2]| is_in(a, p) && is_in(b, q) || is_in(a, q) && is_in(b, p);
        found.saddles.iter().filter(|s| joins(s.minima)).map(|s| pieces(&s.spins, cells)).collect()
    };
    let (out, twice) = (between("one", "none"), between("one", "two"));
    assert!(out.iter().any(|all| matches!(all[..], [(1..=4, false)])), "collapse: {out:?}");
    assert!(out.iter().any(|all| matches!(all[..], [(10.., true)])), "escape: {out:?}");
    assert!(twice.iter().any(|all| matches!(all[..], [(16.., false)])), "duplication: {twice:?}");
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
