//! The triangular lattice: a₁ = x̂, a₂ = ½x̂ + (√3/2)ŷ.

use super::kind::{SIXTY, UnitCell, cells_of};
use crate::error::Result;
use crate::registry::Described;

cells_of! {
    /// `{"cells": [20, 20]}`.
    Triangular[2] {}
}

impl Described for Triangular {
    const NAME: &'static str = "triangular";
    const SUMMARY: &'static str = "a triangular lattice in the plane, one site a cell";
    const EXAMPLE: &'static str = r#"{"triangular": {"cells": [20, 20], "periodic": [true, true]}}"#;
}

impl Triangular {
    fn unit_cell(&self) -> Result<UnitCell> {
        Ok(UnitCell::film([0.5, SIXTY], &[[0.0, 0.0]]))
    }
}
