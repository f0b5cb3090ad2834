//! The hexagonal close-packed lattice: a₁ = x̂, a₂ = ½x̂ + (√3/2)ŷ, a₃ = (c/a) ẑ, two sites in each cell.

use super::kind::{SIXTY, UnitCell, cells_of};
use crate::error::{Error, Result};
use crate::registry::Described;

cells_of! {
    /// `{"cells": [6, 6, 4], "c_over_a": 1.62}`.
    Hcp[3] {
        /// Height of the cell over its edge; that of close-packed spheres, √(8/3), if not given.
        #[serde(default)]
        c_over_a: Option<f64>,
    }
}

impl Described for Hcp {
    const NAME: &'static str = "hcp";
    const SUMMARY: &'static str = "a hexagonal close-packed lattice, two sites a cell";
    const EXAMPLE: &'static str = r#"{"hcp": {"cells": [6, 6, 4], "c_over_a": 1.62}}"#;
}

impl Hcp {
    fn unit_cell(&self) -> Result<UnitCell> {
        let height = self.c_over_a.unwrap_or((8.0f64 / 3.0).sqrt());
        if !(height > 0.0 && height.is_finite()) {
            return Err(Error::invalid("c_over_a", format!("found {height}, but c/a is greater than 0")));
        }
        let vectors = [[1.0, 0.0, 0.0], [0.5, SIXTY, 0.0], [0.0, 0.0, height]];
        Ok(UnitCell::new(vectors, &[[0.0; 3], [1.0 / 3.0, 1.0 / 3.0, 0.5]]))
    }
}
