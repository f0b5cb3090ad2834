//! The kagome lattice: three sites in each cell of the triangular one. Nearest sites are ½ apart.

use super::kind::{SIXTY, UnitCell, cells_of};
use crate::error::Result;
use crate::registry::Described;

cells_of! {
    /// `{"cells": [10, 10]}`.
    Kagome[2] {}
}

impl Described for Kagome {
    const NAME: &'static str = "kagome";
    const SUMMARY: &'static str = "a kagome lattice in the plane, three sites a cell";
    const EXAMPLE: &'static str = r#"{"kagome": {"cells": [10, 10], "periodic": [true, true]}}"#;
}

impl Kagome {
    fn unit_cell(&self) -> Result<UnitCell> {
        Ok(UnitCell::film([0.5, SIXTY], &[[0.0, 0.0], [0.5, 0.0], [0.0, 0.5]]))
    }
}
