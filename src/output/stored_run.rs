//! A result read back from its directory, as far as figures need it.
//!
//! `summary.json` and one of `path.csv` and `path.npz` must be there. Without `profile.csv` the curve joins the images; without
//! `history.csv`, or a file of spins, some figures cannot be drawn, and `notes` say so. A file that is there must be whole.

use super::columns::Columns;
use super::disk::{self, MARK};
use super::folder::stored_result;
use super::plot_data::above_first;
use super::read::{bytes, read_spins, shown, text};
use super::staggered::SiteKinds;
use super::summary::{Saddle, Summary};
use super::{EnergyPath, Lifetimes, Places, PlotData};
use crate::drive::{Barrier, HistoryRow};
use crate::error::{Error, Result};
use crate::files;
use crate::lattice::Lattice;
use crate::path::Path as SpinPath;
use std::path::Path;

/// Files of spins, best first.
const SPINS: [&str; 4] = ["path.npz", "path.ovf", "path_text.ovf", "spins.csv"];

/// How names of figures end.
const PICTURES: [&str; 2] = [".svg", ".png"];

/// A result as its files tell.
#[derive(Clone, Debug)]
pub struct StoredRun {
    /// What could not be read because it is not there, and what that means.
    pub notes: Vec<String>,
    /// Sites without a spin, and those that a staggered state reverses, as the config says.
    pub kinds: SiteKinds,
    /// Where the sites are, as the config says.
    pub places: Option<Places>,
    /// The lattice as the config says, where that is no row.
    pub lattice: Option<Lattice>,
    summary: Summary,
    images: Vec<(f64, f64)>,
    terms_mev: Vec<(String, Vec<f64>)>,
    terms_profile_mev: Vec<Vec<f64>>,
    profile: Vec<(f64, f64)>,
    history: Vec<HistoryRow>,
    path: Option<SpinPath>,
}

impl StoredRun {
    /// Reads the result in `dir` but for its spins.
    pub fn read(dir: &Path) -> Result<StoredRun> {
        let mut notes = Vec::new();
        let summary = summary(dir)?;
        // a figure that somebody changed is not read
        stored_result(dir, |name| !PICTURES.iter().any(|ending| name.ends_with(ending)))?;
        let images = summary.path.images;
        let table = path_table(dir)?;
        agree(&table.0, table.1.rows(), images)?;
        let table = table.1;
        let points = table.points("reaction_coordinate_rad", "energy_above_initial_meV")?;
        let terms_mev = terms(&table);
        let (profile, terms_profile_mev) = match text(dir, "profile.csv")? {
            Some(text) => {
                let table = Columns::read(&shown(dir, "profile.csv"), &text)?;
                let profile = table.points("reaction_coordinate_rad", "energy_above_initial_meV")?;
                // results of earlier versions have the whole alone
                let term =
                    |(name, _): &(String, _)| table.named(&format!("{name}_above_initial_meV")).map(<[f64]>::to_vec);
                (profile, terms_mev.iter().map(term).collect::<Result<_>>().unwrap_or_default())
            }
            None => {
                notes.push("there is no profile.csv: curves join the images by straight lines".into());
                (Vec::new(), Vec::new())
            }
        };
        let history = match text(dir, "history.csv")? {
            Some(text) => history(&Columns::read(&shown(dir, "history.csv"), &text)?)?,
            None => {
                notes.push("there is no history.csv: the convergence cannot be drawn".into());
                Vec::new()
            }
        };
        Ok(StoredRun {
            notes,
            kinds: SiteKinds::default(),
            places: None,
            lattice: None,
            summary,
            images: points,
            terms_mev,
            terms_profile_mev,
            profile,
            history,
            path: None,
        })
    }

    /// With the spins of its lattice, and where they are.
    pub fn with_spins(mut self, dir: &Path, lattice: &Lattice) -> Result<StoredRun> {
        self.path = spins(dir, self.summary.path.images, lattice)?;
        if self.path.is_none() {
            let files = SPINS.join(", ");
            self.notes.push(format!("there is no file of spins ({files}): spins and magnetisation cannot be drawn"));
        }
        (self.places, self.lattice) = (Places::of(lattice), Some(lattice.clone()).filter(|lattice| !lattice.is_row()));
        self.kinds = SiteKinds::of(lattice);
        Ok(self)
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.summary.name
    }

    /// What its figures are drawn from.
    pub fn data(&self) -> PlotData<'_> {
        let saddle = |s: &Saddle| (s.reaction_coordinate_rad.0, s.energy_above_initial_meV.0);
        PlotData {
            name: self.summary.name.clone(),
            energy: EnergyPath {
                name: self.summary.name.clone(),
                images: self.images.clone(),
                profile: self.profile.clone(),
                saddles: self.summary.saddles.iter().map(saddle).collect(),
                barrier: self.summary.barrier_meV.map(Barrier::from),
                certainty: self.summary.certainty(),
            },
            terms_mev: self.terms_mev.clone(),
            terms_profile_mev: self.terms_profile_mev.clone(),
            path: self.path.as_ref(),
            kinds: self.kinds.clone(),
            places: self.places,
            lattice: self.lattice.as_ref(),
            history: self.history.clone(),
            lifetimes: self.summary.transition_rates.iter().flatten().map(Lifetimes::of).collect(),
        }
    }
}

fn summary(dir: &Path) -> Result<Summary> {
    let place = dir.display().to_string();
    if !dir.exists() {
        return Err(Error::invalid(
            place,
            "there is no such directory; name the directory of a result, such as results/wall",
        ));
    }
    if !dir.is_dir() {
        return Err(Error::invalid(place, "is a file; name the directory of a result, such as results/wall"));
    }
    if disk::kind(&dir.join(MARK))? == disk::Kind::Nothing {
        let message =
            format!("holds no finished result: there is no {MARK}. Run its config first: spinneb run CONFIG.json");
        return Err(Error::invalid(place, message));
    }
    Summary::read(dir)
}

/// The table of the images, with the file it is from.
fn path_table(dir: &Path) -> Result<(String, Columns)> {
    let file = shown(dir, "path.csv");
    if let Some(text) = text(dir, "path.csv")? {
        return Ok((file.clone(), Columns::read(&file, &text)?));
    }
    let Some(bytes) = bytes(dir, "path.npz")? else {
        let message = "there is neither this nor path.npz, so there are no energies to draw: run the config again with \
                       \"csv\" or \"npz\" in output.formats";
        return Err(Error::invalid(file, message));
    };
    let file = shown(dir, "path.npz");
    let arrays = files::read_npz_columns(&file, &bytes)?;
    Ok((file.clone(), Columns::from_arrays(&file, arrays)?))
}

fn terms(table: &Columns) -> Vec<(String, Vec<f64>)> {
    const OTHERS: [&str; 3] = ["energy", "max_perpendicular_torque", "energy_above_initial"];
    let term = |(name, column): &(String, Vec<f64>)| {
        let term = name.strip_suffix("_meV").filter(|term| !OTHERS.contains(term))?;
        Some((term.to_string(), above_first(column)))
    };
    table.all().iter().filter_map(term).collect()
}

pub(super) fn history(table: &Columns) -> Result<Vec<HistoryRow>> {
    let [iteration, images] = ["iteration", "images"].map(|name| table.named(name));
    let (iteration, images) = (iteration?, images?);
    let torque = table.named("max_perpendicular_torque_meV")?;
    let rotation = table.named("largest_predicted_rotation_rad")?;
    let highest = table.named("highest_image_above_initial_meV")?;
    let length = table.named("length_rad")?;
    let row = |k: usize| HistoryRow {
        iteration: iteration[k] as usize,
        images: images[k] as usize,
        max_perpendicular_torque_mev: torque[k],
        largest_predicted_rotation_rad: rotation[k],
        highest_image_mev: highest[k],
        length_rad: length[k],
        hessian_products: 0,
    };
    Ok((0..table.rows()).map(row).collect())
}

/// The spins of all images from the best file there is.
fn spins(dir: &Path, images: usize, lattice: &Lattice) -> Result<Option<SpinPath>> {
    for name in SPINS {
        let Some(bytes) = bytes(dir, name)? else { continue };
        let states = read_spins(dir, name, &bytes, lattice)?;
        agree(&shown(dir, name), states.len(), images)?;
        return Ok(Some(SpinPath::new(&states)));
    }
    Ok(None)
}

/// Files of one result have the same number of images.
fn agree(file: &str, found: usize, images: usize) -> Result<()> {
    if found == images {
        return Ok(());
    }
    Err(Error::invalid(
        file,
        format!("has {found} images, but {MARK} says {images}: the files are not of one result; {RERUN}"),
    ))
}

const RERUN: &str = "`spinneb run` with --force on the result's config.json writes them anew";
