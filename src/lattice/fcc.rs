//! The face-centred cubic lattice, in cubes of four sites. Nearest sites are 1/√2 apart.

use super::kind::{UnitCell, cells_of};
use crate::error::Result;
use crate::registry::Described;

cells_of! {
    /// `{"cells": [8, 8, 8]}`.
    Fcc[3] {}
}

impl Described for Fcc {
    const NAME: &'static str = "fcc";
    const SUMMARY: &'static str = "a face-centred cubic lattice, four sites a cube";
    const EXAMPLE: &'static str = r#"{"fcc": {"cells": [8, 8, 8]}}"#;
}

impl Fcc {
    fn unit_cell(&self) -> Result<UnitCell> {
        Ok(UnitCell::cube(&[[0.0; 3], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5]]))
    }
}
