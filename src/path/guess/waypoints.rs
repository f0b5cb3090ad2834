//! Geodesics through given states, images at equal distances along them; frozen spins stay on the way.

use super::clock::{Way, fraction, ways};
use super::{FirstGuess, GuessContext};
use crate::error::Result;
use crate::field::ComponentsMut;
use crate::geometry::Direction;
use crate::linalg::slab;
use crate::path::Path;
use crate::registry::Described;
use crate::spins::Spins;
use crate::state::StateSpec;
use schemars::JsonSchema;
use serde::Deserialize;

/// `{"waypoints": {"states": [{"domain_wall": {"center": 3}}]}}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Waypoints {
    /// The states on the way, in order; the two ends are not repeated.
    pub states: Vec<StateSpec>,
}

impl Described for Waypoints {
    const NAME: &'static str = "waypoints";
    const SUMMARY: &'static str = "geodesics through given states";
    const EXAMPLE: &'static str =
        r#"{"waypoints": {"states": [{"domain_wall": {"center": 3}}, {"domain_wall": {"center": 7}}]}}"#;
}

impl FirstGuess for Waypoints {
    fn path(&self, a: &Spins, b: &Spins, images: usize, context: &GuessContext) -> Result<Path> {
        let frozen = context.states.lattice.is_frozen();
        let mut stops = vec![a.clone()];
        for (k, state) in self.states.iter().enumerate() {
            let at_stop =
                state.build(&context.states).map_err(|e| e.within(&format!("states[{k}].{}", state.name())))?;
            let mut m = at_stop.as_slice().to_vec();
            let mut held = ComponentsMut::new(&mut m);
            for i in (0..a.sites()).filter(|i| frozen[*i]) {
                held.set(i, a.get(i));
            }
            stops.push(Spins::from_unit_components(&m));
        }
        stops.push(b.clone());
        Ok(through(&stops, images, context.default_axis))
    }
}

/// Images at equal distances along the geodesics through at least two stops.
pub(super) fn through(stops: &[Spins], images: usize, axis: Direction) -> Path {
    let legs: Vec<Vec<Way>> = stops.windows(2).map(|s| ways(&s[0], &s[1], axis)).collect();
    let mut reached = vec![0.0];
    for leg in &legs {
        let squares: Vec<f64> = leg.iter().map(|w| w.length().powi(2)).collect();
        reached.push(reached[reached.len() - 1] + slab::sum(&squares).sqrt());
    }
    let total = reached[legs.len()];
    let (a, b) = (&stops[0], &stops[stops.len() - 1]);
    Path::build(images, a.sites(), |k, out| {
        if k == 0 || k + 1 == images {
            return out.copy_from_slice(if k == 0 { a.as_slice() } else { b.as_slice() });
        }
        let place = total * fraction(k, images);
        let leg = reached.partition_point(|s| *s <= place).clamp(1, legs.len()) - 1;
        let length = reached[leg + 1] - reached[leg];
        let u = if length > 0.0 { ((place - reached[leg]) / length).min(1.0) } else { 0.0 };
        let mut out = ComponentsMut::new(out);
        for (i, way) in legs[leg].iter().enumerate() {
            out.set(i, way.at(u));
        }
    })
}
