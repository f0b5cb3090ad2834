//! The files of a landscape: `landscape.json` (kinds of states), tables, arrays and graphs (all states), figures.

mod disconnectivity;
pub(super) mod document;
mod graphml;
mod lifetimes;
mod network;
mod pygt;
mod tables;

pub(super) use network::Network;

use super::Picture;
use super::canvas::{Canvas, Look};
use super::disk::{File, MARK};
use super::head::Head;
use crate::drive::survey::Survey;
use crate::error::{Error, Result};
use crate::lattice::Lattice;
use crate::words::counted;
use serde::Serialize;

/// What of a survey goes into files.
#[derive(Clone, Copy, Debug)]
pub struct LandscapeReport<'a> {
    /// Name of the config.
    pub name: &'a str,
    /// Version of the program.
    pub version: &'a str,
    /// Hash of the config.
    pub config_sha256: &'a str,
    /// The config as run.
    pub config_text: &'a str,
    /// The files of spins that it names.
    pub inputs: &'a [File],
    /// Where the spins are.
    pub lattice: &'a Lattice,
    /// How figures look.
    pub look: Look,
    /// Kinds of figures, as in a config's `output.plots`.
    pub plots: &'a [String],
    /// What was found.
    pub survey: &'a Survey,
}

/// A file with numbers.
struct DataFile {
    name: &'static str,
    /// Whether it needs rates.
    of_rates: bool,
    render: fn(&LandscapeReport) -> Result<Vec<u8>>,
}

static DATA: &[DataFile] = &[
    DataFile { name: "landscape.json", of_rates: false, render: document::render },
    DataFile { name: "minima.csv", of_rates: false, render: tables::minima },
    DataFile { name: "saddles.csv", of_rates: false, render: tables::saddles },
    DataFile { name: "lifetimes.csv", of_rates: true, render: tables::lifetimes },
    DataFile { name: "landscape.npz", of_rates: false, render: tables::npz },
    DataFile { name: "landscape.graphml", of_rates: false, render: graphml::render },
    DataFile { name: "report.html", of_rates: false, render: super::report::landscape_page },
    DataFile { name: "min.data", of_rates: true, render: pygt::minima },
    DataFile { name: "ts.data", of_rates: true, render: pygt::saddles },
];

/// A figure; nothing where there is nothing to draw.
struct Figure {
    name: &'static str,
    draw: fn(&LandscapeReport) -> Result<Option<Canvas>>,
}

static FIGURES: &[Figure] = &[
    Figure { name: "disconnectivity", draw: disconnectivity::draw },
    Figure { name: "network", draw: network::draw },
    Figure { name: "lifetimes", draw: lifetimes::draw },
];

/// `summary.json` of a landscape.
#[derive(Serialize)]
struct Summary<'a> {
    name: &'a str,
    #[serde(flatten)]
    head: Head,
    kind: &'a str,
    stop_reason: String,
    kinds_of_minima: usize,
    kinds_of_saddles: usize,
    minima: usize,
    saddles: usize,
    warnings: Vec<String>,
}

impl LandscapeReport<'_> {
    /// What the search came to, in words.
    pub fn stop_reason(&self) -> String {
        let s = self.survey;
        let searches = counted(s.searched.searches, "search", "searches");
        match s.is_finished() {
            true => format!("the last {} of {} brought nothing new", s.searched.quiet, searches),
            false => format!("the work that it may do, or the states that it may find, were spent after {searches}"),
        }
    }

    /// What is to be said of it: what the search says, and which groups hold the same minima.
    pub fn warnings(&self) -> Vec<String> {
        let groups = self.survey.lifetimes.as_ref().map_or(&[][..], |lifetimes| &lifetimes.groups);
        let shared = |k: usize| {
            let (name, states) = &groups[k];
            groups[k + 1..].iter().filter_map(move |(other, others)| {
                let both = states.iter().filter(|state| others.contains(state)).count();
                (both > 0).then(|| {
                    let minima = if both == 1 { "minimum" } else { "minima" };
                    format!(
                        "the groups {name} and {other} hold {both} {minima} in common: a state that is in both takes no time \
                         from one to the other, so none is told"
                    )
                })
            })
        };
        self.survey.warnings.iter().cloned().chain((0..groups.len()).flat_map(shared)).collect()
    }

    /// All files, `summary.json` last.
    pub fn files(&self) -> Result<Vec<File>> {
        let mut files: Vec<File> = self.inputs.to_vec();
        files.push(File { name: "config.json".into(), bytes: self.config_text.into() });
        let with_rates = self.survey.lifetimes.is_some();
        for file in DATA.iter().filter(|file| with_rates || !file.of_rates) {
            files.push(File { name: file.name.into(), bytes: (file.render)(self)? });
        }
        for figure in FIGURES {
            let Some(canvas) = (figure.draw)(self)? else { continue };
            let canvas = canvas.describe(super::describe(figure.name, &[self.name]));
            for picture in pictures(self.plots) {
                let name = format!("{}.{}", figure.name, picture.extension());
                files.push(File { name, bytes: picture.render(&canvas)? });
            }
        }
        files.push(File { name: MARK.into(), bytes: self.summary()? });
        Ok(files)
    }

    fn summary(&self) -> Result<Vec<u8>> {
        let s = self.survey;
        let summary = Summary {
            name: self.name,
            head: Head {
                version: self.version.into(),
                config_sha256: self.config_sha256.into(),
                converged: s.is_finished(),
                certified: true,
            },
            kind: "landscape",
            stop_reason: self.stop_reason(),
            kinds_of_minima: s.minimum_kinds.len(),
            kinds_of_saddles: s.saddle_kinds.len(),
            minima: s.minima.len(),
            saddles: s.saddles.len(),
            warnings: self.warnings(),
        };
        json(MARK, &summary)
    }
}

/// The names of all files that a landscape may have.
pub fn landscape_file_names(plots: &[String]) -> Vec<String> {
    let data = DATA.iter().map(|file| file.name.to_string());
    let figures =
        FIGURES.iter().flat_map(|figure| pictures(plots).map(|p| format!("{}.{}", figure.name, p.extension())));
    data.chain(figures).chain(["config.json".into(), MARK.into()]).collect()
}

fn pictures(plots: &[String]) -> impl Iterator<Item = Picture> + '_ {
    [Picture::Svg, Picture::Png].into_iter().filter(|p| plots.iter().any(|name| name == p.extension()))
}

fn json(name: &str, document: &impl Serialize) -> Result<Vec<u8>> {
    let text = serde_json::to_string_pretty(document);
    Ok((text.map_err(|e| Error::Numerical(format!("{name}: {e}")))? + "\n").into_bytes())
}
