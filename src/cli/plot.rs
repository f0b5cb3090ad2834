//! `plot`: figures of results that are there already, from their files alone.

use super::{Plot, USAGE, note, report, worse};
use crate::config::{Config, Loaded, load};
use crate::error::Error;
use crate::files::disk::File;
use crate::output::canvas::{Canvas, Look, SMALL_PT, Style, Text, description};
use crate::output::folder;
use crate::output::{
    EnergyPath, PLOTS, Picture, PlotData, PlotFile, PlotTable, StoredRun, describe, draw_energy_paths,
};
use crate::units::Length;
use anyhow::Result;
use rayon::prelude::*;
use std::path::{Path, PathBuf};

/// All figures of one result, or one figure of several.
pub fn plot(arguments: &Plot) -> Result<u8> {
    if let Some((out, ending)) = arguments.out.as_ref().and_then(|out| Some((out, not_drawn(out)?))) {
        note(&format!(
            "error: --out {}: found {ending:?}, expected svg or png, or a folder (whose name may end in /)",
            out.display()
        ));
        return Ok(USAGE);
    }
    match &arguments.results[..] {
        [one] => single(arguments, one),
        _ => several(arguments),
    }
}

fn single(arguments: &Plot, dir: &Path) -> Result<u8> {
    if !arguments.labels.is_empty() {
        note("error: --labels are for several results; one has no legend");
        return Ok(USAGE);
    }
    if let Some(out) = arguments.out.as_ref().filter(|out| picture_of(out).is_some()) {
        let shown = out.display();
        note(&format!("error: --out {shown}: one result has several figures; give a folder for them"));
        return Ok(USAGE);
    }
    let stored = StoredRun::read(dir)?;
    let config = config_of(dir)?;
    let look = look_of(arguments, &config.config)?;
    let stored = stored.with_spins(dir, &config.lattice)?;
    let data = stored.data();
    let files = figures(arguments, &data, &look)?;
    let out = arguments.out.as_deref().unwrap_or(dir);
    folder::add(out, &files, same_file, arguments.force)?;
    if !arguments.quiet {
        stored.notes.iter().for_each(|words| note(&format!("{}: {words}", data.name)));
        let names: Vec<&str> = files.iter().map(|file| file.name.as_str()).collect();
        note(&format!("{}: drawn in {}: {}", data.name, out.display(), names.join(", ")));
    }
    Ok(0)
}

/// Every figure that the result has something for, and the tables that go with them.
fn figures(arguments: &Plot, data: &PlotData, look: &Look) -> Result<Vec<File>> {
    let pictures = pictures(arguments);
    let wanted: Vec<PlotFile> = (PLOTS.iter().filter(|plot| plot.applies(data)))
        .flat_map(|plot| pictures.iter().map(|picture| PlotFile { plot: *plot, picture: *picture }))
        .collect();
    let drawn = wanted.par_iter().map(|file| Ok(File { name: file.name(), bytes: file.bytes(data, look)? }));
    let mut files = drawn.collect::<crate::error::Result<Vec<File>>>()?;
    for table in PlotTable::all() {
        files.extend(table.bytes(data)?.map(|bytes| File { name: table.name(), bytes }));
    }
    Ok(files)
}

fn several(arguments: &Plot) -> Result<u8> {
    let (mut code, mut stored) = (0, Vec::new());
    for dir in &arguments.results {
        match StoredRun::read(dir) {
            Ok(one) => stored.push(one),
            Err(error) => code = worse(code, report(&error.into())),
        }
    }
    if code != 0 {
        return Ok(code);
    }
    let Some(labels) = labels(arguments, &stored) else { return Ok(USAGE) };
    if let Some((label, c)) = labels.iter().find_map(|l| crate::output::canvas::unknown_letter(l).map(|c| (l, c))) {
        note(&format!("error: --labels: the figures' font has no {c:?}, found in {label:?}; give another label"));
        return Ok(USAGE);
    }
    let look = Look::new(arguments.style.unwrap_or_default(), arguments.width).map_err(flagged)?;
    if let Some(label) = arguments.labels.iter().find(|label| !fits(label, &look)) {
        note(&format!("error: --labels: {label:?} is wider than the figure: give a shorter one, or a larger --width"));
        return Ok(USAGE);
    }
    let paths: Vec<EnergyPath> = (stored.iter().zip(&labels))
        .map(|(one, label)| EnergyPath { name: label.clone(), ..one.data().energy })
        .collect();
    let names: Vec<&str> = stored.iter().map(StoredRun::name).collect();
    let canvas = draw_energy_paths(&paths, &look)?.describe(describe("energy_paths", &names));
    let (out, stem, pictures) = place(arguments);
    let file = |picture: &Picture| -> crate::error::Result<File> {
        Ok(File { name: format!("{stem}.{}", picture.extension()), bytes: picture.render(&canvas)? })
    };
    let files = pictures.iter().map(file).collect::<crate::error::Result<Vec<File>>>()?;
    folder::add(&out, &files, same_file, arguments.force)?;
    if !arguments.quiet {
        for (one, label) in stored.iter().zip(&labels) {
            one.notes.iter().filter(|n| n.contains("profile")).for_each(|words| note(&format!("{label}: {words}")));
        }
        files.iter().for_each(|file| note(&format!("{} is drawn", out.join(&file.name).display())));
    }
    Ok(0)
}

/// Whether a label has room in a legend, its barrier beside it.
fn fits(label: &str, look: &Look) -> bool {
    let text = Text::new(format!("{label}: 0.000000 meV"), SMALL_PT);
    text.width().is_ok_and(|wide| wide < 0.7 * Canvas::styled(look, 10.0).width())
}

/// Folder, name without its ending, and formats of the one figure of several results.
fn place(arguments: &Plot) -> (PathBuf, String, Vec<Picture>) {
    let named = arguments.out.as_deref().and_then(|out| Some((out, picture_of(out)?, out.file_stem()?)));
    match named {
        Some((out, picture, stem)) => {
            let folder = out.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
            (folder.into(), stem.to_string_lossy().into_owned(), vec![picture])
        }
        None => {
            let folder = arguments.out.clone().unwrap_or_else(|| PathBuf::from("."));
            (folder, "energy_paths".into(), pictures(arguments))
        }
    }
}

/// One label a result, all different; nothing, with an error said, where they cannot be.
fn labels(arguments: &Plot, stored: &[StoredRun]) -> Option<Vec<String>> {
    let labels = &arguments.labels;
    if !labels.is_empty() && labels.len() != stored.len() {
        let (found, wanted) = (labels.len(), stored.len());
        note(&format!("error: --labels: found {found} for {wanted} results; give one for each, separated by commas"));
        return None;
    }
    if !labels.is_empty() {
        return Some(labels.clone());
    }
    let names: Vec<String> = stored.iter().map(|one| one.name().to_string()).collect();
    let twice = |k: usize| names.iter().filter(|n| **n == names[k]).count() > 1;
    let label = |k: usize| if twice(k) { arguments.results[k].display().to_string() } else { names[k].clone() };
    Some((0..names.len()).map(label).collect())
}

/// The config of a result.
fn config_of(dir: &Path) -> Result<Loaded> {
    let path = dir.join("config.json");
    if !path.exists() {
        let message = "there is no such file: the directory holds no whole result; run its config again";
        return Err(Error::invalid(path.display().to_string(), message).into());
    }
    Ok(load(&path, &[])?)
}

/// What the result's config says of its figures, unless the command line says otherwise.
fn look_of(arguments: &Plot, config: &Config) -> Result<Look> {
    let output = &config.output;
    let width = arguments.width.or_else(|| output.look().ok().filter(|_| output.width.is_some()).map(|l| l.width_mm()));
    Ok(Look::new(arguments.style.unwrap_or(output.style), width).map_err(flagged)?)
}

/// An error about a width that the command line gave.
fn flagged(error: Error) -> Error {
    match error {
        Error::Invalid { place, message } => Error::Invalid { place: format!("--{place}"), message },
        other => other,
    }
}

/// Whether a file that is there is an earlier one of the same: a figure of the same results, or a table with the same columns.
fn same_file(new: &File, old: &[u8]) -> bool {
    if new.name.ends_with(".csv") {
        let header = |bytes: &[u8]| bytes.split(|b| *b == b'\n').next().map(<[u8]>::to_vec);
        return header(&new.bytes) == header(old);
    }
    description(old).is_some_and(|words| Some(words) == description(&new.bytes))
}

/// The formats asked for, each once.
fn pictures(arguments: &Plot) -> Vec<Picture> {
    let all = [Picture::Svg, Picture::Png];
    all.into_iter().filter(|p| arguments.format.is_empty() || arguments.format.contains(p)).collect()
}

/// The format that a file's name stands for.
fn picture_of(path: &Path) -> Option<Picture> {
    path.extension().and_then(|ending| picture(&ending.to_string_lossy()).ok())
}

/// The ending of a file that cannot be drawn: letters alone, where no folder is there. The name of a folder to be may end in `/`.
fn not_drawn(path: &Path) -> Option<String> {
    let ending = path.extension()?.to_string_lossy().to_ascii_lowercase();
    let is_of_a_file = ending.bytes().all(|b| b.is_ascii_alphabetic()) && picture(&ending).is_err();
    let is_folder = path.is_dir() || path.as_os_str().to_string_lossy().ends_with('/');
    (is_of_a_file && !is_folder).then_some(ending)
}

/// `svg` or `png`.
pub fn picture(name: &str) -> Result<Picture, String> {
    let known = [Picture::Svg, Picture::Png];
    let found = known.into_iter().find(|p| p.extension().eq_ignore_ascii_case(name));
    found.ok_or_else(|| format!("found {name:?}, expected svg or png"))
}

/// The name of a style.
pub fn style(name: &str) -> Result<Style, String> {
    let known = Style::ALL.map(Style::name).join(", ");
    Style::ALL.into_iter().find(|s| s.name() == name).ok_or_else(|| format!("found {name:?}, expected one of {known}"))
}

/// A width: a number of mm, or a length with its unit.
pub fn width_mm(text: &str) -> Result<f64, String> {
    if let Ok(mm) = text.trim().parse::<f64>() {
        return Ok(mm);
    }
    let length: Length = text.parse().map_err(|e: Error| format!("{e}; or a number of mm"))?;
    Look::new(Style::Paper, Some(length.0 / 1e6)).map(|look| look.width_mm()).map_err(|e| e.to_string())
}
