//! The page of a landscape: the network that one clicks, the spins of the state that was clicked, and tables.

use super::pack::{self, column, packed};
use super::shown::sites_shown;
use super::{LONGEST_CONFIG, Material, Spins, material, page, places, script};
use crate::error::Result;
use crate::geometry::Direction;
use crate::output::canvas::{Colour, sequential};
use crate::output::landscape::{LandscapeReport, Network, document};
use crate::path::Path;
use crate::words::counted;
use serde::Serialize;
use serde_json::Value;

/// Template, style and script.
pub(super) const PARTS: [&str; 3] = [
    concat!(include_str!("head.html"), include_str!("landscape.html")),
    concat!(include_str!("page.css"), include_str!("landscape.css")),
    script!("summary.js", "choices.js", "landscape.js"),
];
/// With more spins, states times sites, only those of the first state of each kind are in the page.
const MOST_SPINS: usize = 1_000_000;
/// How many colours energies have.
const COLOURS: usize = 33;

/// What the scripts read; the names of numbers have their units.
#[derive(Serialize)]
#[allow(non_snake_case)]
struct Data<'a> {
    summary: Head<'a>,
    words: String,
    material: Material,
    config: Option<&'a str>,
    finished: bool,
    stop_reason: String,
    warnings: Vec<String>,
    minimum_kinds: Vec<Value>,
    saddle_kinds: Vec<Value>,
    lifetimes: Option<Value>,
    minima: Vec<Minimum>,
    saddles: Vec<Saddle>,
    all_shown: bool,
    colours: Vec<String>,
    top_meV: f64,
    sites: usize,
    images: usize,
    periodic: bool,
    direction: [f64; 3],
    lattice: Option<Film>,
    vacant: Vec<usize>,
    frozen: Vec<usize>,
    sites_shown: Vec<usize>,
    spins: Spins,
}

#[derive(Serialize)]
struct Head<'a> {
    name: &'a str,
    version: &'a str,
    config_sha256: &'a str,
}

#[derive(Serialize)]
struct Film {
    words: String,
    places: String,
}

/// Where it is in the network, if it is drawn; the image that shows it.
#[derive(Serialize)]
struct Minimum {
    kind: usize,
    image: usize,
    colour: usize,
    place: Option<[f32; 2]>,
}

#[derive(Serialize)]
struct Saddle {
    kind: usize,
    image: usize,
    colour: usize,
    minima: [usize; 2],
    bend: Option<[f32; 2]>,
}

/// `report.html` of a landscape.
pub fn landscape_page(report: &LandscapeReport) -> Result<Vec<u8>> {
    page(PARTS, report.name, &data(report)?)
}

fn data<'a>(report: &LandscapeReport<'a>) -> Result<Data<'a>> {
    let (s, lattice) = (report.survey, report.lattice);
    let all_shown = (s.minima.len() + s.saddles.len()) * lattice.sites <= MOST_SPINS;
    let images =
        if all_shown { s.minima.len() + s.saddles.len() } else { s.minimum_kinds.len() + s.saddle_kinds.len() };
    let (sites, stride) = sites_shown(lattice, lattice.sites, images);
    let film = || Ok(Film { words: lattice.words(), places: places(lattice, &sites, stride)? });
    let network = Network::of(s);
    let mut kinds: Value = serde_json::from_slice(&document::render(report)?)
        .map_err(|e| crate::error::Error::Numerical(format!("report.html: {e}")))?;
    let row = lattice.is_row();
    let words = if row {
        let sites = counted(lattice.sites, "site", "sites");
        format!("{} of {sites}", if lattice.is_ring() { "ring" } else { "chain" })
    } else {
        lattice.words()
    };
    let (minima, saddles) = states(report, &network, all_shown);
    Ok(Data {
        summary: Head { name: report.name, version: report.version, config_sha256: report.config_sha256 },
        words,
        material: material(report.config_text),
        config: Some(report.config_text).filter(|text| text.len() <= LONGEST_CONFIG),
        finished: s.is_finished(),
        stop_reason: report.stop_reason(),
        warnings: report.warnings(),
        minimum_kinds: numbered(kinds["minima"].take()),
        saddle_kinds: numbered(kinds["saddles"].take()),
        lifetimes: Some(kinds["lifetimes"].take()).filter(|l| !l.is_null()),
        minima,
        saddles,
        all_shown,
        colours: (0..COLOURS).map(|k| hex(sequential(k as f64 / (COLOURS - 1) as f64))).collect(),
        top_meV: network.top_mev,
        sites: lattice.sites,
        images,
        periodic: lattice.is_ring(),
        direction: if row { lattice.direction() } else { Direction::X }.vector(),
        lattice: (!row).then(film).transpose()?,
        vacant: sites.iter().copied().filter(|i| lattice.vacant[*i]).collect(),
        frozen: lattice
            .frozen
            .iter()
            .flat_map(|f| &f.sites)
            .copied()
            .filter(|i| sites.binary_search(i).is_ok())
            .collect(),
        spins: Spins { scale: pack::SCALE, packed: spins(report, all_shown, &sites)? },
        sites_shown: sites,
    })
}

/// All states, with what shows them.
fn states(report: &LandscapeReport, network: &Network, all_shown: bool) -> (Vec<Minimum>, Vec<Saddle>) {
    let s = report.survey;
    let colour = |mev: f64| (network.fraction(mev).clamp(0.0, 1.0) * (COLOURS - 1) as f64).round() as usize;
    let short = |p: &[f64; 2]| p.map(|x| x as f32);
    let minimum = |(k, m): (usize, &crate::drive::survey::FoundMinimum)| Minimum {
        kind: m.kind,
        image: if all_shown { k } else { m.kind },
        colour: colour(s.minimum_kind(k).above_lowest_mev),
        place: network.minima.get(k).map(short),
    };
    let first = if all_shown { s.minima.len() } else { s.minimum_kinds.len() };
    let mut bends = vec![None; s.saddles.len()];
    network.saddles.iter().for_each(|(k, bend)| bends[*k] = Some(short(bend)));
    let saddle = |(k, x): (usize, &crate::drive::survey::FoundSaddle)| Saddle {
        kind: x.kind,
        image: first + if all_shown { k } else { x.kind },
        colour: colour(s.saddle_kind(k).above_lowest_mev),
        minima: x.minima,
        bend: bends[k],
    };
    (s.minima.iter().enumerate().map(minimum).collect(), s.saddles.iter().enumerate().map(saddle).collect())
}

/// The spins of all states, or of the first of each kind.
fn spins(report: &LandscapeReport, all_shown: bool, sites: &[usize]) -> Result<String> {
    let s = report.survey;
    let minima =
        (0..s.minima.len()).filter(|k| all_shown || s.minimum_kind(*k).first == *k).map(|k| &s.minima[k].spins);
    let saddles =
        (0..s.saddles.len()).filter(|k| all_shown || s.saddle_kind(*k).first == *k).map(|k| &s.saddles[k].spins);
    let states: Vec<crate::spins::Spins> = minima.chain(saddles).cloned().collect();
    match states.is_empty() {
        true => column("spins", std::iter::empty()),
        false => packed(&Path::new(&states), &(0..states.len()).collect::<Vec<_>>(), sites),
    }
}

/// Entries of kinds, each with the number of its first state.
fn numbered(kinds: Value) -> Vec<Value> {
    let Value::Array(mut kinds) = kinds else { return Vec::new() };
    kinds.iter_mut().for_each(|kind| kind["first"] = kind["states"][0].clone());
    kinds
}

fn hex(Colour(r, g, b): Colour) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}
