//! Spins from a file: OVF 2.0, npz, npy or csv; one image of it.

use super::{StateBuilder, StateContext};
use crate::error::Result;
use crate::files::{self, Stored};
use crate::geometry::Vector;
use crate::lattice::Lattice;
use crate::registry::Described;
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::Path;
use std::sync::Arc;

/// `{"file": {"path": "relaxed.ovf", "segment": 0}}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct File {
    /// The file, looked for beside the config.
    pub path: String,
    /// Which image of several, counted from 0; from the end if negative, −1 the last.
    #[serde(default)]
    pub segment: Option<i64>,
    /// SHA-256 that the file must have, in hexadecimal.
    #[serde(default)]
    pub sha256: Option<String>,
    /// Reverse odd sites, of a cell with several atoms every other one.
    #[serde(default)]
    pub staggered: bool,
    /// What the file holds, once it is read.
    #[serde(skip)]
    pub stored: Option<Arc<Stored>>,
}

impl Described for File {
    const NAME: &'static str = "file";
    const SUMMARY: &'static str = "spins from a file beside the config (OVF 2.0, npz, npy, csv)";
    const EXAMPLE: &'static str = r#"{"file": {"path": "relaxed.ovf", "segment": 0}}"#;
}

impl File {
    /// Reads the file, looked for in `folder`; the image that is taken of it, for the sites of a lattice if one is given.
    pub fn load(&mut self, folder: &Path, lattice: Option<&Lattice>) -> Result<Vec<Vector>> {
        let stored = self.stored.insert(files::open(folder, &self.path, self.sha256.as_deref())?);
        let image = stored.image(self.segment)?;
        lattice.map_or(Ok(image.to_vec()), |lattice| stored.placed(image, lattice))
    }
}

impl StateBuilder for File {
    fn vectors(&self, context: &StateContext) -> Result<Vec<Vector>> {
        let stored = match &self.stored {
            Some(stored) => stored.clone(),
            None => files::open(Path::new(""), &self.path, self.sha256.as_deref())?,
        };
        stored.placed(stored.image(self.segment)?, context.lattice)
    }

    fn staggered(&self) -> bool {
        self.staggered
    }
}
