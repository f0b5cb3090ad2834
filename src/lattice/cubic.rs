//! The simple cubic lattice.

use super::kind::{UnitCell, cells_of};
use crate::error::Result;
use crate::registry::Described;

cells_of! {
    /// `{"cells": [8, 8, 8]}`.
    Cubic[3] {}
}

impl Described for Cubic {
    const NAME: &'static str = "cubic";
    const SUMMARY: &'static str = "a simple cubic lattice, one site a cell";
    const EXAMPLE: &'static str = r#"{"cubic": {"cells": [8, 8, 8]}}"#;
}

impl Cubic {
    fn unit_cell(&self) -> Result<UnitCell> {
        Ok(UnitCell::cube(&[[0.0; 3]]))
    }
}
