//! Velocity projection (quick-min): masses that roll along the force and stop where it turns against them.
//!
//! ```text
//! v ← F (v·F)/(F·F) if v·F > 0, else 0;   v ← v + Δt F;   m ← Exp_m(Δt v)
//! ```
//! Jónsson, Mills, Jacobsen, in Classical and Quantum Dynamics in Condensed Phase Simulations (World Scientific 1998),
//! doi:10.1142/9789812839664_0016; on spheres: Bessarab et al. (2015), doi:10.1016/j.cpc.2015.07.001. Here to compare with.

use super::{Follows, Method, Optimiser};
use crate::linalg::slab;
use crate::registry::Described;
use crate::sphere::{move_points, rotation_of};
use schemars::JsonSchema;
use serde::Deserialize;

/// Largest rotation of a spin in one step (rad).
const CAP: f64 = 0.1;

/// `{"velocity_projection": {}}`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VelocityProjection {}

impl Described for VelocityProjection {
    const NAME: &'static str = "velocity_projection";
    const SUMMARY: &'static str = "damped masses along the spring forces: the field's usual method, to compare with";
    const EXAMPLE: &'static str = r#"{"velocity_projection": {}}"#;
}

impl Method for VelocityProjection {
    fn follows(&self) -> Follows {
        Follows::Springs
    }

    fn start(&self, stiffness_mev: f64) -> Box<dyn Optimiser> {
        Box::new(Rolling { time: (0.5 / stiffness_mev).sqrt(), velocity: Vec::new() })
    }
}

#[derive(Debug)]
struct Rolling {
    time: f64,
    velocity: Vec<f64>,
}

impl Optimiser for Rolling {
    fn advance(&mut self, points: &mut [f64], slab: usize, force: &[f64]) {
        self.velocity.resize(force.len(), 0.0);
        let work = slab::dot(&self.velocity, force);
        let keep = if work > 0.0 { work / slab::dot(force, force) } else { 0.0 };
        for (v, f) in self.velocity.iter_mut().zip(force) {
            *v = (keep + self.time) * f;
        }
        let rotation = self.velocity.chunks(slab).map(rotation_of).fold(0.0, f64::max) * self.time;
        let step = if rotation > CAP { self.time * CAP / rotation } else { self.time };
        move_points(points, &self.velocity, slab, step);
    }

    fn memory(&self) -> Vec<Vec<f64>> {
        vec![self.velocity.clone()]
    }

    fn remember(&mut self, memory: Vec<Vec<f64>>) {
        self.velocity = memory.into_iter().next().unwrap_or_default();
    }
}
