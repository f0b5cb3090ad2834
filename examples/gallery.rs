//! Makes the gallery anew: every shipped config is run, and its results go to `results/gallery/`, with a page that shows them.
//!
//! ```sh
//! cargo run --release --example gallery
//! ```
//!
//! Only what is small is kept: `summary.json`, `config.json`, tables, and figures as SVG. Where nothing but the time of a run has
//! changed, its `summary.json` stays as it is, so that a gallery without news is the same bytes.

use serde_json::Value;
use spinneb::config::sweep::Sweep;
use spinneb::config::{Loaded, load, load_landscape};
use spinneb::drive::survey::survey;
use spinneb::drive::{Outcome, Silent, run};
use spinneb::files::disk::{self, File};
use spinneb::output::sweep::{draw_map, lifetime_table, look};
use spinneb::output::{LandscapeReport, render_files};
use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// Files that are too large to keep, or that others hold already.
const LEFT_OUT: [&str; 2] = ["rates.csv", "profile.csv"];
/// A summary of more bytes than this is kept without most of its white space.
const LONG: usize = 100_000;
/// The results whose `report.html` is committed; the others' are there only where the gallery was made.
const REPORTS: [&str; 2] = ["ring_nucleus", "wall_nucleation"];
/// The figure of the README, which is kept as pixels too.
const SHOWN: (&str, &str) = ("wall_nucleation", "energy_path.png");

fn main() -> Result<()> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let purposes = purposes(&fs::read_to_string(root.join("docs/src/configs.md"))?);
    let mut page = String::from(HEAD);
    for config in configs(&root.join("configs"))? {
        let loaded = load(&config, &[])?;
        let started = Instant::now();
        let mut outcome = run(&loaded.problem()?, &mut Silent)?;
        outcome.work.seconds = started.elapsed().as_secs_f64();
        let dir = root.join("results/gallery").join(&loaded.name);
        let files = files(&loaded, &outcome, &dir)?;
        disk::replace(&dir, &files, |_, _| true, true)?;
        let purpose = purposes.iter().find(|(name, _)| *name == loaded.name).map_or("", |(_, words)| words);
        section(&mut page, &loaded.name, purpose, &outcome, &files)?;
        println!("{}: {:.1} s", loaded.name, outcome.work.seconds);
    }
    page.push_str(&landscapes(root)?);
    page.push_str(&lifetime_map(root)?);
    page.push_str(&examples(root)?);
    fs::write(root.join("results/gallery/README.md"), page)?;
    Ok(())
}

/// The configs of a folder in the order of their names.
fn configs(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut found: Vec<PathBuf> =
        fs::read_dir(folder)?.map(|e| e.map(|e| e.path())).collect::<std::result::Result<_, _>>()?;
    found.retain(|path| path.extension().is_some_and(|e| e == "json"));
    found.sort();
    Ok(found)
}

/// The files of a result that are kept.
fn files(loaded: &Loaded, outcome: &Outcome, dir: &Path) -> Result<Vec<File>> {
    let mut files = render_files(&loaded.report(outcome)?, |kind| ["csv", "svg", "png", "html"].contains(&kind.name))?;
    let shown = |file: &File| (loaded.name.as_str(), file.name.as_str()) == SHOWN;
    files.retain(|file| shown(file) || !file.name.ends_with(".png") && !LEFT_OUT.contains(&file.name.as_str()));
    for file in files.iter_mut().filter(|file| file.name == disk::MARK) {
        if file.bytes.len() > LONG {
            file.bytes = dense(&file.bytes);
        }
        let old = fs::read(dir.join(disk::MARK)).unwrap_or_default();
        if timeless(&old).is_some_and(|old| Some(old) == timeless(&file.bytes)) {
            file.bytes = old;
        }
    }
    Ok(files)
}

/// JSON with the lines deeper than two levels joined.
fn dense(json: &[u8]) -> Vec<u8> {
    let mut text = String::new();
    for line in String::from_utf8_lossy(json).split('\n') {
        let inner = line.trim_start_matches(' ');
        let joined = line.len() - inner.len() > 4;
        text.push_str(if joined || text.is_empty() { "" } else { "\n" });
        text.push_str(if joined { inner } else { line });
    }
    text.into_bytes()
}

/// A summary without what depends on time and machine.
fn timeless(summary: &[u8]) -> Option<Value> {
    let mut value: Value = serde_json::from_slice(summary).ok()?;
    let work = value.get_mut("work")?.as_object_mut()?;
    work.remove("seconds");
    work.remove("threads");
    Some(value)
}

/// The names and purposes of the shipped configs, as the book's table has them.
fn purposes(readme: &str) -> Vec<(String, String)> {
    let row = |line: &str| {
        let cells: Vec<&str> = line.strip_prefix("| [`")?.split(" | ").collect();
        Some((cells.first()?.split('`').next()?.to_string(), cells.get(2)?.trim_end_matches(" |").to_string()))
    };
    readme.lines().filter_map(row).collect()
}

const HEAD: &str = "\
# Gallery

Every shipped config as it is run, drawn by

```sh
cargo run --release --example gallery
```

which makes this page too. A test compares the committed numbers with a run. Beside each `summary.json` lie its tables, the
figures shown here and, where the command has run, `report.html` (two of them are committed); `spinneb run` writes more: the spins
as `path.npz` and `path.ovf`, the interpolated energies, and pixels.
";

fn section(page: &mut String, name: &str, purpose: &str, outcome: &Outcome, files: &[File]) -> Result<()> {
    let (certified, reached) = (if outcome.certified { "certified" } else { "not certified" }, outcome.converged);
    let barrier = match outcome.barrier {
        Some(b) => format!("{:.6} meV forward, {:.6} meV backward", b.forward_mev, b.backward_mev),
        None => "none".into(),
    };
    let saddles = match outcome.saddles.len() {
        1 => "1 saddle".into(),
        n => format!("{n} saddles"),
    };
    let reached = if reached { "" } else { ", not converged" };
    writeln!(page, "\n## {name}\n")?;
    writeln!(page, "{purpose}\n")?;
    writeln!(
        page,
        "Barrier: {barrier}; {certified}{reached}; {saddles}, {} images. [Config](../../configs/{name}.json), \
         [summary]({name}/summary.json){}.\n",
        outcome.path.images(),
        if REPORTS.contains(&name) { format!(", [report]({name}/report.html)") } else { String::new() }
    )?;
    let titles = [
        ("energy_path.svg", "Energy path"),
        ("energy_terms.svg", "Its terms"),
        ("spins.svg", "Spins"),
        ("magnetisation.svg", "Mean spin"),
        ("convergence.svg", "Convergence"),
        ("arrhenius.svg", "Lifetime"),
    ];
    let there: Vec<_> = titles.iter().filter(|(file, _)| files.iter().any(|f| f.name == *file)).collect();
    for row in there.chunks(3) {
        for (file, title) in row {
            writeln!(page, "<img src=\"{name}/{file}\" alt=\"{title} of {name}\" width=\"32%\">")?;
        }
    }
    Ok(())
}

/// What is kept of a landscape.
const OF_LANDSCAPES: [&str; 4] = ["landscape.json", "disconnectivity.svg", "network.svg", "lifetimes.svg"];

/// Surveys every shipped landscape; what was found, and its figures.
fn landscapes(root: &Path) -> Result<String> {
    let mut page = String::from("\n## Landscapes\n\nWhat `spinneb landscape` finds.\n");
    for config in configs(&root.join("configs/landscapes"))? {
        let loaded = load_landscape(&config, &[])?;
        let found = survey(&loaded.survey()?, &mut Silent)?;
        let report = LandscapeReport {
            name: &loaded.name,
            version: env!("CARGO_PKG_VERSION"),
            config_sha256: &loaded.sha256,
            config_text: &loaded.as_run,
            inputs: &loaded.inputs,
            lattice: &loaded.lattice,
            look: loaded.look()?,
            plots: &["svg".to_string()],
            survey: &found,
        };
        let mut files = report.files()?;
        files.retain(|file| OF_LANDSCAPES.contains(&file.name.as_str()));
        let name = &loaded.name;
        let dir = root.join("results/gallery/landscapes").join(name);
        fs::create_dir_all(&dir)?;
        for file in &files {
            fs::write(dir.join(&file.name), &file.bytes)?;
        }
        let [minima, saddles] = [&found.minimum_kinds, &found.saddle_kinds].map(Vec::len);
        writeln!(page, "\n### {name}\n")?;
        writeln!(
            page,
            "{} minima of {minima} kinds, {} saddles of {saddles} kinds; {}. [Config](../../configs/landscapes/{name}.json), \
             [numbers](landscapes/{name}/landscape.json).\n",
            found.minima.len(),
            found.saddles.len(),
            report.stop_reason(),
        )?;
        for file in OF_LANDSCAPES[1..].iter().filter(|figure| files.iter().any(|f| f.name == **figure)) {
            let title = file.trim_end_matches(".svg");
            writeln!(page, "<img src=\"landscapes/{name}/{file}\" alt=\"{title} of {name}\" width=\"32%\">")?;
        }
        println!("landscape {name}");
    }
    Ok(page)
}

/// The sweep over field and temperature, its table and its figure.
const MAP: &str = "skyrmion_lifetime";

/// Runs the sweep as `spinneb sweep` does; how long a skyrmion lives over field and temperature.
fn lifetime_map(root: &Path) -> Result<String> {
    let sweep = Sweep::load(&root.join("configs/sweeps").join(format!("{MAP}.json")))?;
    let results = tempfile::tempdir()?;
    let mut hashes = Vec::new();
    for point in 0..sweep.len() {
        let loaded = sweep.load_point(point)?;
        let outcome = run(&sweep.problem(point, &loaded)?, &mut Silent)?;
        let files = render_files(&loaded.report(&outcome)?, |kind| kind.name == "csv")?;
        disk::replace(&results.path().join(sweep.directory(point)), &files, |_, _| true, true)?;
        hashes.push(loaded.sha256);
    }
    let index = sweep.index(hashes);
    let states =
        (0..sweep.len()).map(|k| look(results.path(), &index, k)).collect::<std::result::Result<Vec<_>, _>>()?;
    let table = lifetime_table(&index, &states)?.ok_or("no lifetimes")?;
    let figure = draw_map(&index, &states)?.ok_or("no map of lifetimes")?.svg()?;
    let dir = root.join("results/gallery/sweeps").join(MAP);
    fs::create_dir_all(&dir)?;
    fs::write(dir.join("lifetimes.csv"), table)?;
    fs::write(dir.join("lifetime_map.svg"), figure)?;
    println!("sweep {MAP}");
    Ok(format!(
        "\n## Lifetimes over field and temperature\n\nWhat `spinneb sweep` makes of \
         [`{MAP}`](../../configs/sweeps/{MAP}.json): [numbers](sweeps/{MAP}/lifetimes.csv).\n\n\
         <img src=\"sweeps/{MAP}/lifetime_map.svg\" alt=\"Mean time until a skyrmion collapses, over field and temperature\" width=\"48%\">\n"
    ))
}

/// Links to what the numbered examples wrote.
fn examples(root: &Path) -> Result<String> {
    let mut folders: Vec<String> = Vec::new();
    for entry in fs::read_dir(root.join("results/gallery"))? {
        let name = entry?.file_name().to_string_lossy().into_owned();
        folders.extend(name.starts_with(|c: char| c.is_ascii_digit()).then_some(name));
    }
    folders.sort();
    let mut page = String::from("\n## Examples\n\nWritten by `cargo run --release --example NAME`:\n\n");
    for name in folders {
        let mut files: Vec<String> = Vec::new();
        for entry in fs::read_dir(root.join("results/gallery").join(&name))? {
            files.push(entry?.file_name().to_string_lossy().into_owned());
        }
        files.sort();
        let links: Vec<String> = files.iter().map(|file| format!("[{file}]({name}/{file})")).collect();
        writeln!(page, "- [`{name}`](../../examples/{name}.rs): {}", links.join(", "))?;
    }
    Ok(page)
}
