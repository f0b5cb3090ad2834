//! The body-centred cubic lattice, in cubes of two sites. Nearest sites are √3/2 apart.

use super::kind::{UnitCell, cells_of};
use crate::error::Result;
use crate::registry::Described;

cells_of! {
    /// `{"cells": [8, 8, 8]}`.
    Bcc[3] {}
}

impl Described for Bcc {
    const NAME: &'static str = "bcc";
    const SUMMARY: &'static str = "a body-centred cubic lattice, two sites a cube";
    const EXAMPLE: &'static str = r#"{"bcc": {"cells": [8, 8, 8]}}"#;
}

impl Bcc {
    fn unit_cell(&self) -> Result<UnitCell> {
        Ok(UnitCell::cube(&[[0.0; 3], [0.5; 3]]))
    }
}
