//! Any crystal: three vectors and the atoms of a cell.

use super::kind::{UnitAtom, UnitCell, cells_of};
use crate::error::{Error, Result};
use crate::geometry::Vector;
use crate::registry::Described;
use crate::units::Moment;
use schemars::JsonSchema;
use serde::Deserialize;

cells_of! {
    /// `{"vectors": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "basis": [{"at": [0, 0, 0]}], "cells": [4, 4, 4]}`.
    Crystal[3] {
        /// The vectors of the cell, in units of `spacing`.
        vectors: [Vector; 3],
        /// Its atoms.
        basis: Vec<BasisAtom>,
    }
}

/// An atom of the cell.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BasisAtom {
    /// Where it stands, in units of the vectors.
    pub at: Vector,
    /// What it is; atoms of one species have shells of neighbours of their own with each species.
    #[serde(default)]
    pub species: Option<String>,
    /// Its moment, if it is not the material's.
    #[serde(default)]
    pub moment: Option<Moment>,
}

impl Described for Crystal {
    const NAME: &'static str = "crystal";
    const SUMMARY: &'static str = "any crystal, from the vectors of its cell and the atoms in it";
    const EXAMPLE: &'static str = r#"{"crystal": {"vectors": [[1, 0, 0], [0, 1, 0], [0, 0, 0.9]], "basis": [{"at": [0, 0, 0], "species": "Fe"}, {"at": [0.5, 0.5, 0.5], "species": "Pt"}], "cells": [4, 4, 2]}}"#;
}

/// An atom may be written as one of a cell so many further on.
const FURTHEST: f64 = 10.0;

impl Crystal {
    fn unit_cell(&self) -> Result<UnitCell> {
        if self.basis.is_empty() {
            return Err(Error::invalid(
                "basis",
                "the list is empty: give the atoms of the cell, [{\"at\": [0, 0, 0]}]",
            ));
        }
        let mut atoms: Vec<UnitAtom> = Vec::new();
        for (k, BasisAtom { at, species, moment }) in self.basis.iter().enumerate() {
            let place = |key: &str| format!("basis[{k}].{key}");
            let apart =
                |other: &UnitAtom| (0..3).any(|d| ((at[d] - other.at[d]) - (at[d] - other.at[d]).round()).abs() > 1e-9);
            if let Some(first) = atoms.iter().position(|other| !apart(other)) {
                let message = format!("found an atom where basis[{first}] is already, in this cell or another one");
                return Err(Error::invalid(place("at"), message));
            }
            if at.iter().any(|f| f.abs() > FURTHEST) {
                let message =
                    format!("found {at:?}, but an atom stands in its cell, from 0 to 1 (at most {FURTHEST} away)");
                return Err(Error::invalid(place("at"), message));
            }
            if moment.is_some_and(|m| m.0 < 0.0) {
                let message = "found a negative value: a spin is the direction of its moment, so this is not negative";
                return Err(Error::invalid(place("moment"), message));
            }
            atoms.push(UnitAtom { at: *at, species: species.clone(), moment_mub: moment.map(|m| m.0) });
        }
        Ok(UnitCell { vectors: self.vectors, atoms })
    }
}
