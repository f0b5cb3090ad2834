//! The square lattice: a₁ = x̂, a₂ = ŷ.

use super::kind::{UnitCell, cells_of};
use crate::error::Result;
use crate::registry::Described;

cells_of! {
    /// `{"cells": [20, 20]}`.
    Square[2] {}
}

impl Described for Square {
    const NAME: &'static str = "square";
    const SUMMARY: &'static str = "a square lattice in the plane, one site a cell";
    const EXAMPLE: &'static str = r#"{"square": {"cells": [20, 20], "periodic": [true, true]}}"#;
}

impl Square {
    fn unit_cell(&self) -> Result<UnitCell> {
        Ok(UnitCell::film([0.0, 1.0], &[[0.0, 0.0]]))
    }
}
