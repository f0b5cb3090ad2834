//! What is written: each format is a pure function of the outcome, from [`RunReport`] to bytes; only
//! [`disk`] touches the disk, with the [`folder`] of a result.
//!
//! Energies are in meV, angles and path lengths in rad, and every outer name carries its unit. The same outcome gives the same
//! bytes: there are no time stamps.

mod arrhenius_plot;
pub mod canvas;
mod certainty;
mod columns;
mod config_copy;
mod convergence_plot;
mod csv;
mod energy_path_plot;
mod energy_terms_plot;
pub mod folder;
mod font;
mod head;
mod landscape;
mod magnetisation_plot;
mod manifest;
mod number;
mod ovf_mesh;
mod partial;
mod plot;
mod plot_data;
mod rates_csv;
mod rates_summary;
mod read;
mod relaxed;
mod report;
mod site_cells;
mod spin_files;
mod spin_maps;
mod spins_plot;
mod staggered;
mod stored_outcome;
mod stored_run;
mod summary;
pub mod sweep;

pub use arrhenius_plot::{ArrheniusPlot, draw_lifetimes};
pub use certainty::Certainty;
pub use config_copy::ConfigCopy;
pub use convergence_plot::ConvergencePlot;
pub use csv::{HistoryCsv, PathCsv, ProfileCsv};
pub use energy_path_plot::{EnergyPath, EnergyPathPlot, draw_energy_paths};
pub use energy_terms_plot::EnergyTermsPlot;
pub use head::Head;
pub use landscape::{LandscapeReport, landscape_file_names};
pub use magnetisation_plot::MagnetisationPlot;
pub use manifest::Manifest;
pub use number::Number;
pub use partial::{StoppedRun, discard_partial, is_partial_left, partial_files, write_partial};
pub use plot::{PLOTS, Plot, PlotFile, PlotTable, WriteTable, describe};
pub use plot_data::{Lifetimes, Places, PlotData, RateRow};
pub use rates_csv::RatesCsv;
pub use relaxed::{RelaxReport, StateReport, formats_of_paths, relaxed_file_names};
pub use report::ReportPage;
pub use spin_files::{MinimaOvf, OvfImages, PathNpz, PathOvf, SaddleOvf, SpinsCsv, Vtk};
pub use spin_maps::draw_spin_maps;
pub use spins_plot::{SpinsPlot, draw_spins};
pub use stored_outcome::StoredOutcome;
pub use stored_run::StoredRun;
pub use summary::{BothWays, Summary, SummaryJson, Told};

use crate::drive::Outcome;
use crate::error::Result;
use crate::files::{OvfData, disk};
use crate::lattice::Lattice;
use rayon::prelude::*;

/// Everything that a format may know about a run.
#[derive(Clone, Copy, Debug)]
pub struct RunReport<'a> {
    /// Name of the run.
    pub name: &'a str,
    /// Version of the program.
    pub version: &'a str,
    /// Hash of the config.
    pub config_sha256: &'a str,
    /// The config as run.
    pub config_text: &'a str,
    /// Files of spins that the config names, as they are kept with the result.
    pub inputs: &'a [disk::File],
    /// The chain.
    pub lattice: &'a Lattice,
    /// How figures look.
    pub look: canvas::Look,
    /// What was found.
    pub outcome: &'a Outcome,
}

/// The folder of a result with the files of spins that its config names.
pub const INPUTS: &str = "inputs";

/// One file of a result, perhaps with companions in a folder: a pure function of the outcome.
pub trait Format: Sync {
    /// Its name in the directory of the result.
    fn file_name(&self) -> String;

    /// The folder of its companions; whatever of their kind is in it is this format's.
    fn folder(&self) -> Option<&'static str> {
        None
    }

    /// Files that belong to it, in its folder.
    fn companions(&self, _: &RunReport) -> Result<Vec<disk::File>> {
        Ok(Vec::new())
    }

    /// Whether the run has something to write in it.
    fn applies(&self, _: &RunReport) -> bool {
        true
    }

    /// Its bytes.
    fn render(&self, run: &RunReport) -> Result<Vec<u8>>;
}

/// How a figure is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Picture {
    /// Vector graphics.
    Svg,
    /// Pixels.
    Png,
}

impl Picture {
    /// The ending of its file names.
    pub fn extension(self) -> &'static str {
        match self {
            Picture::Svg => "svg",
            Picture::Png => "png",
        }
    }

    /// The figure as a file.
    pub fn render(self, canvas: &canvas::Canvas) -> Result<Vec<u8>> {
        match self {
            Picture::Svg => canvas.svg(),
            Picture::Png => canvas.png(),
        }
    }
}

/// When a kind of file is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// Always.
    Always,
    /// If named in `output.formats`, or if that is absent.
    Formats,
    /// Only if named in `output.formats`.
    OnRequest,
    /// If named in `output.plots`.
    Plots,
}

/// A name in the config with the files that it stands for.
pub struct Kind {
    /// The name.
    pub name: &'static str,
    /// In which list it is named.
    pub group: Group,
    /// What it is, in a line.
    pub summary: &'static str,
    /// Its files.
    pub formats: fn() -> Vec<Box<dyn Format>>,
}

/// All kinds of files, in the order in which they are listed.
pub const KINDS: &[Kind] = &[
    Kind { name: "csv", group: Group::Formats, summary: csv::SUMMARY, formats: csv::formats },
    Kind {
        name: "npz",
        group: Group::Formats,
        summary: "path.npz: the spins (image, site, xyz) and the columns of path.csv as NumPy arrays; of films and crystals the positions \
                  of the sites too, positions_nm or positions_a (lattice constants)",
        formats: || vec![Box::new(PathNpz)],
    },
    Kind {
        name: "ovf",
        group: Group::Formats,
        summary: "path.ovf, saddle.ovf, minima.ovf: spins as OVF 2.0 binary 8, a segment an image, saddle or minimum (with both ends)",
        formats: || {
            let mut formats = ovf(OvfData::Binary8);
            formats.push(Box::new(MinimaOvf));
            formats
        },
    },
    Kind {
        name: "html",
        group: Group::Formats,
        summary: "report.html: all of it in one page for a browser, with the spins in 3D along the path; needs no network",
        formats: || vec![Box::new(ReportPage)],
    },
    Kind {
        name: "ovf_binary4",
        group: Group::OnRequest,
        summary: "path_binary4.ovf, saddle_binary4.ovf: the same in single precision (if named)",
        formats: || ovf(OvfData::Binary4),
    },
    Kind {
        name: "ovf_text",
        group: Group::OnRequest,
        summary: "path_text.ovf, saddle_text.ovf: the same as text, with all digits (if named)",
        formats: || ovf(OvfData::Text),
    },
    Kind {
        name: "ovf_images",
        group: Group::OnRequest,
        summary: "ovf/image_000.ovf …: a file an image as text, for programs that read one segment (if named)",
        formats: || vec![Box::new(OvfImages)],
    },
    Kind {
        name: "spins_csv",
        group: Group::OnRequest,
        summary: "spins.csv: a row a site and image (if named)",
        formats: || vec![Box::new(SpinsCsv)],
    },
    Kind {
        name: "vtk",
        group: Group::OnRequest,
        summary: "path.pvd with vtk/image_000.vtp … (crystals: .vtu): for ParaView (if named)",
        formats: || vec![Box::new(Vtk)],
    },
    Kind {
        name: "svg",
        group: Group::Plots,
        summary: "energy_path.svg, energy_terms.svg, spins.svg, magnetisation.svg, convergence.svg as vector graphics; with rates \
                  arrhenius.svg",
        formats: || plots(Picture::Svg),
    },
    Kind {
        name: "png",
        group: Group::Plots,
        summary: "energy_path.png and the others: the same figures as pixels, 300 an inch",
        formats: || plots(Picture::Png),
    },
    Kind {
        name: "config",
        group: Group::Always,
        summary: "config.json: the config as run; inputs/ with the files of spins that it names",
        formats: || vec![Box::new(ConfigCopy)],
    },
    Kind {
        name: "summary",
        group: Group::Always,
        summary: "summary.json: barrier, saddles, ends, rates, work and whether they are certified",
        formats: || vec![Box::new(SummaryJson)],
    },
];

fn plots(picture: Picture) -> Vec<Box<dyn Format>> {
    PLOTS.iter().map(|plot| Box::new(PlotFile { plot: *plot, picture }) as Box<dyn Format>).collect()
}

fn ovf(data: OvfData) -> Vec<Box<dyn Format>> {
    vec![Box::new(PathOvf(data)), Box::new(SaddleOvf(data))]
}

/// The files of a run that names these kinds.
pub fn render_files(run: &RunReport, wanted: impl Fn(&Kind) -> bool) -> Result<Vec<disk::File>> {
    let kinds = KINDS.iter().filter(|kind| kind.group == Group::Always || wanted(kind));
    let formats: Vec<Box<dyn Format>> =
        kinds.flat_map(|kind| (kind.formats)()).filter(|format| format.applies(run)).collect();
    let files = |format: &dyn Format| -> Result<Vec<disk::File>> {
        let mut files = vec![disk::File { name: format.file_name(), bytes: format.render(run)? }];
        files.extend(format.companions(run)?);
        Ok(files)
    };
    let files: Vec<Vec<disk::File>> = formats.par_iter().map(|format| files(&**format)).collect::<Result<_>>()?;
    Ok(files.concat())
}

/// Names of all files that a result of these kinds can have; a name that ends in `/` is a folder of them.
pub fn file_names(wanted: impl Fn(&Kind) -> bool) -> Vec<String> {
    let kinds = KINDS.iter().filter(|kind| wanted(kind));
    let formats: Vec<Box<dyn Format>> = kinds.flat_map(|kind| (kind.formats)()).collect();
    let folders = formats.iter().filter_map(|format| format.folder()).map(|folder| format!("{folder}/"));
    formats.iter().map(|format| format.file_name()).chain(folders).collect()
}
