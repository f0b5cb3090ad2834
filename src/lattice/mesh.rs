//! Cells of a continuum in a box: `grid`. The center of the first one is half a cell from the origin in each direction.

use super::kind::{UnitCell, common};
use super::sites::{Frozen, Periodic, SiteMoment, positive};
use super::{Lattice, LatticeKind, Selection, Shape};
use crate::error::Result;
use crate::registry::Described;
use crate::units::Length;
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;

/// `{"cells": [40, 40, 1], "cell": ["2 nm", "2 nm", "0.6 nm"]}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mesh {
    /// Cells along x, y and z.
    pub cells: [usize; 3],
    /// Edges of a cell.
    pub cell: [Length; 3],
    /// Whether the last cell in a direction is followed by the first: a flag a direction, or one for all.
    #[serde(default)]
    pub periodic: Periodic,
    /// Cells outside do not exist; all are there if not given.
    #[serde(default)]
    pub shape: Option<Shape>,
    /// Spins that never move.
    #[serde(default)]
    pub frozen: Vec<Frozen>,
    /// Cells without a spin: nothing acts on them, and they on nothing.
    #[serde(default)]
    pub vacant: Option<Selection>,
    /// Cells whose moment is not the material's.
    #[serde(default)]
    pub moments: Vec<SiteMoment>,
    /// Cells with a name, to be chosen by it, and to be made of another material.
    #[serde(default)]
    pub regions: BTreeMap<String, Selection>,
}

impl Described for Mesh {
    const NAME: &'static str = "grid";
    const SUMMARY: &'static str = "cells of a continuum in a box";
    const EXAMPLE: &'static str = r#"{"grid": {"cells": [40, 40, 1], "cell": ["2 nm", "2 nm", "0.6 nm"]}}"#;
}

impl Mesh {
    fn unit_cell(&self) -> UnitCell {
        let [x, y, z] = self.cell.map(|edge| edge.0);
        UnitCell::new([[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]], &[[0.5; 3]])
    }
}

impl LatticeKind for Mesh {
    fn checked_sites(&self) -> Result<usize> {
        self.unit_cell().sites(&self.cells)
    }

    fn resolve(&self) -> Result<Lattice> {
        for (d, edge) in self.cell.iter().enumerate() {
            positive(edge.0, &format!("cell[{d}]"))?;
        }
        let common = common!(self);
        let mut lattice = self.unit_cell().resolve(Mesh::NAME, &self.cells, &self.periodic, 1.0)?;
        let [x, y, z] = self.cell.map(|edge| edge.0);
        (lattice.spacing_nm, lattice.sections_nm) = (Some(x), Some(vec![[y, z]; lattice.sites]));
        let mut lattice = lattice.cut(self.shape.as_ref())?;
        lattice.sections_nm = Some(vec![[y, z]; lattice.sites]);
        common.name_regions(&mut lattice)?;
        common.complete(lattice)
    }
}
