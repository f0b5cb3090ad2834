//! A whole path from a file. With as many images as the file has, they are taken as they are; otherwise images stand at equal
//! distances along the geodesics through them. The file's first and last image give way to the two ends; frozen spins stay.

use super::waypoints::through;
use super::{FirstGuess, GuessContext};
use crate::error::{Error, Result};
use crate::field::ComponentsMut;
use crate::files::{self, Stored};
use crate::geometry::Vector;
use crate::lattice::Lattice;
use crate::path::Path;
use crate::registry::Described;
use crate::spins::Spins;
use schemars::JsonSchema;
use serde::Deserialize;
use std::sync::Arc;

/// `{"file": {"path": "results/wall/path.npz"}}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PathFile {
    /// The file, looked for beside the config.
    pub path: String,
    /// SHA-256 that the file must have, in hexadecimal.
    #[serde(default)]
    pub sha256: Option<String>,
    /// What the file holds, once it is read.
    #[serde(skip)]
    pub stored: Option<Arc<Stored>>,
}

impl Described for PathFile {
    const NAME: &'static str = "file";
    const SUMMARY: &'static str = "a path from a file beside the config (OVF 2.0, npz, npy, csv)";
    const EXAMPLE: &'static str = r#"{"file": {"path": "earlier/path.npz"}}"#;
}

impl PathFile {
    /// Reads the file, looked for in `folder`, for the sites of a lattice if one is given.
    pub fn load(&mut self, folder: &std::path::Path, lattice: Option<&Lattice>) -> Result<&Stored> {
        let stored = files::open(folder, &self.path, self.sha256.as_deref())?;
        let stored = lattice.map_or(Ok(stored.clone()), |lattice| stored.on(lattice))?;
        Ok(self.stored.insert(stored))
    }
}

impl FirstGuess for PathFile {
    fn path(&self, a: &Spins, b: &Spins, images: usize, context: &GuessContext) -> Result<Path> {
        let stored = match &self.stored {
            Some(stored) => stored.clone(),
            None => files::open(std::path::Path::new(""), &self.path, self.sha256.as_deref())?,
        };
        let stored = stored.on(context.states.lattice)?;
        let given = &stored.content.images;
        let (count, sites) = (given.len(), a.sites());
        if count < 3 {
            let message = format!("{} holds {count} of the at least 3 images of a path", stored.file);
            return Err(Error::invalid("path", message));
        }
        let frozen = context.states.lattice.is_frozen();
        let held = |image: &Vec<Vector>| -> Result<Spins> {
            let mut m = Spins::from_vectors(image)?.as_slice().to_vec();
            let mut out = ComponentsMut::new(&mut m);
            (0..sites).filter(|i| frozen[*i]).for_each(|i| out.set(i, a.get(i)));
            Ok(Spins::from_unit_components(&m))
        };
        let mut stops = vec![a.clone()];
        for image in &given[1..count - 1] {
            stops.push(held(image)?);
        }
        stops.push(b.clone());
        Ok(if images == count { Path::new(&stops) } else { through(&stops, images, context.default_axis) })
    }
}
