//! Full steps of the implicit sweep, no spin more than 0.3 rad at a time.

use super::{Follows, Method, Optimiser};
use crate::registry::Described;
use crate::sphere::{move_points, rotation_of};
use crate::threads::{READ, apiece};
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Deserialize;

/// Largest rotation of a spin in one step (rad).
const CAP: f64 = 0.3;

/// `{"implicit": {}}`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Implicit {}

impl Described for Implicit {
    const NAME: &'static str = "implicit";
    const SUMMARY: &'static str =
        "the implicit uphill sweep on true banded Hessians: about ten evaluations at any length (default)";
    const EXAMPLE: &'static str = r#"{"implicit": {}}"#;
}

impl Method for Implicit {
    fn follows(&self) -> Follows {
        Follows::Sweep
    }

    fn start(&self, _: f64) -> Box<dyn Optimiser> {
        Box::new(Implicit {})
    }
}

impl Optimiser for Implicit {
    fn advance(&mut self, points: &mut [f64], slab: usize, direction: &[f64]) {
        let images = points.par_chunks_mut(slab).zip(direction.par_chunks(slab)).with_min_len(apiece(slab, READ));
        images.for_each(|(m, v)| {
            let rotation = rotation_of(v);
            move_points(m, v, slab, if rotation > CAP { CAP / rotation } else { 1.0 });
        });
    }
}
