//! The honeycomb lattice: two sites in each cell of the triangular one. Nearest sites are 1/√3 apart.

use super::kind::{SIXTY, UnitCell, cells_of};
use crate::error::Result;
use crate::registry::Described;

cells_of! {
    /// `{"cells": [14, 14]}`.
    Honeycomb[2] {}
}

impl Described for Honeycomb {
    const NAME: &'static str = "honeycomb";
    const SUMMARY: &'static str = "a honeycomb lattice in the plane, two sites a cell";
    const EXAMPLE: &'static str = r#"{"honeycomb": {"cells": [14, 14], "periodic": [true, true]}}"#;
}

impl Honeycomb {
    fn unit_cell(&self) -> Result<UnitCell> {
        Ok(UnitCell::film([0.5, SIXTY], &[[0.0, 0.0], [1.0 / 3.0, 1.0 / 3.0]]))
    }
}
