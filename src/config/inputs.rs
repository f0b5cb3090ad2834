//! The files that a config names as states or as a path: read once, and kept with the result.
//!
//! A config as run names them as `inputs/initial.npy` and so on, with their hashes: it runs by itself, and its own hash is that of
//! the spins and not of the place where a file was.

use super::Config;
use crate::energy::TermSpec;
use crate::error::{Error, Result};
use crate::files::disk::File;
use crate::files::{Stored, open_file};
use crate::lattice::Lattice;
use crate::output::INPUTS;
use crate::path::guess::GuessSpec;
use crate::state::StateSpec;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The folder where files are looked for, and the lattice whose spins they hold, where that is known.
type From<'a> = (&'a Path, Option<&'a Lattice>);

/// What was read.
#[derive(Clone, Debug, Default)]
pub(super) struct Inputs {
    /// The files to keep.
    pub(super) files: Vec<File>,
    /// What the user should know of them.
    pub(super) warnings: Vec<String>,
    /// Where they were.
    pub(super) read: Vec<PathBuf>,
    /// Where in the config each is named, as a JSON pointer, and its hash.
    places: Vec<(String, String)>,
    /// Where in the config tables of pairs are named, as JSON pointers, and their bonds.
    tables: Vec<(String, Value)>,
}

impl Inputs {
    /// Reads all files of a config, looked for in `folder`, spins for the sites of its lattice.
    pub(super) fn read(config: &mut Config, folder: &Path, lattice: Option<&Lattice>) -> Result<Inputs> {
        let mut inputs = Inputs::default();
        inputs.pairs(&mut config.energy, "/energy", folder)?;
        let from = (folder, lattice);
        inputs.state(&mut config.initial, "initial", "/initial", "initial", from)?;
        inputs.state(&mut config.final_state, "final", "/final", "final", from)?;
        for (k, state) in config.landscape.iter_mut().flat_map(|own| &mut own.states).enumerate() {
            let place = format!("landscape.states[{k}]");
            inputs.state(state, &place, &format!("/landscape/states/{k}"), &format!("state_{k}"), from)?;
        }
        match &mut config.path.guess {
            Some(GuessSpec::File(file)) => {
                let here = |e: Error| e.within("path.guess.file");
                let stored = file.load(folder, lattice).map_err(here)?.clone();
                inputs.keep(&stored, &stored.content.images, false, "guess", "/path/guess/file".into());
            }
            Some(GuessSpec::Waypoints(waypoints)) => {
                for (k, state) in waypoints.states.iter_mut().enumerate() {
                    let place = format!("path.guess.waypoints.states[{k}]");
                    let pointer = format!("/path/guess/waypoints/states/{k}");
                    inputs.state(state, &place, &pointer, &format!("waypoint_{k}"), from)?;
                }
            }
            _ => {}
        }
        Ok(inputs)
    }

    /// Reads the tables of pairs among these terms, whose list stands at a JSON pointer.
    pub(super) fn pairs(&mut self, terms: &mut [TermSpec], pointer: &str, folder: &Path) -> Result<()> {
        for (k, term) in terms.iter_mut().enumerate() {
            let TermSpec::Pairs(pairs) = term else { continue };
            let Some(file) = pairs.file.clone() else { continue };
            let path = folder.join(&file);
            let here = |e: Error| e.within(&format!("energy[{k}].pairs"));
            let refused = |e: std::io::Error| Error::invalid("file", format!("{}: {e}", path.display()));
            let text = open_file(&path).and_then(std::io::read_to_string).map_err(|e| here(refused(e)))?;
            pairs.fill(&text).map_err(here)?;
            let bonds = serde_json::to_value(&pairs.bonds).map_err(|e| Error::Numerical(e.to_string()))?;
            self.tables.push((format!("{pointer}/{k}/pairs"), bonds));
            self.read.push(path);
        }
        Ok(())
    }

    fn state(&mut self, state: &mut StateSpec, place: &str, pointer: &str, name: &str, from: From) -> Result<()> {
        if let StateSpec::Regions(regions) = state {
            for (k, (region, state)) in regions.states.iter_mut().enumerate() {
                let key = region.replace('~', "~0").replace('/', "~1");
                let (place, pointer) = (format!("{place}.regions.{region}"), format!("{pointer}/regions/{key}"));
                self.state(state, &place, &pointer, &format!("{name}_{k}"), from)?;
            }
        }
        let StateSpec::File(file) = state else { return Ok(()) };
        let here = |e: Error| e.within(&format!("{place}.file"));
        let image = file.load(from.0, from.1).map_err(here)?;
        if let Some(stored) = file.stored.clone() {
            self.keep(&stored, &[image], true, name, format!("{pointer}/file"));
        }
        Ok(())
    }

    fn keep(&mut self, stored: &Stored, images: &[Vec<[f64; 3]>], single: bool, name: &str, pointer: String) {
        let (bytes, hash) = Stored::portable(images, single);
        self.read.push(PathBuf::from(&stored.file));
        self.files.push(File { name: format!("{INPUTS}/{name}.npy"), bytes });
        self.places.push((pointer, hash));
        for warning in &stored.content.warnings {
            if !self.warnings.contains(warning) {
                self.warnings.push(warning.clone());
            }
        }
    }

    /// Names the kept files in a config as run, and writes tables out.
    pub(super) fn rename(&self, config: &mut Value) {
        for (pointer, bonds) in &self.tables {
            if let Some(spec) = config.pointer_mut(pointer).and_then(Value::as_object_mut) {
                spec.remove("file");
                spec.insert("bonds".into(), bonds.clone());
            }
        }
        for ((pointer, hash), file) in self.places.iter().zip(&self.files) {
            if let Some(spec) = config.pointer_mut(pointer).and_then(Value::as_object_mut) {
                spec.remove("segment");
                spec.insert("path".into(), file.name.as_str().into());
                spec.insert("sha256".into(), hash.as_str().into());
            }
        }
    }
}
