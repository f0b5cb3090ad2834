//! Limited-memory BFGS on spheres, without line search (a band's force is no gradient, so there is no function to search).
//!
//! Pairs of differences ([`Secants`]) are kept in the embedding space and projected by use. To compare with.

use super::{Follows, Method, Optimiser};
use crate::field::project;
use crate::linalg::{Secants, slab};
use crate::registry::Described;
use crate::sphere::{move_points, rotation_of};
use schemars::JsonSchema;
use serde::Deserialize;

/// Largest rotation of a spin in one step (rad).
const CAP: f64 = 0.1;

/// `{"lbfgs": {"memory": 5}}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Lbfgs {
    /// Pairs of differences to keep.
    #[serde(default = "default_memory")]
    pub memory: usize,
}

fn default_memory() -> usize {
    5
}

impl Described for Lbfgs {
    const NAME: &'static str = "lbfgs";
    const SUMMARY: &'static str = "limited-memory BFGS along the spring forces, to compare with";
    const EXAMPLE: &'static str = r#"{"lbfgs": {"memory": 5}}"#;
}

impl Method for Lbfgs {
    fn follows(&self) -> Follows {
        Follows::Springs
    }

    fn start(&self, stiffness_mev: f64) -> Box<dyn Optimiser> {
        Box::new(Memory { first: 1.0 / stiffness_mev, secants: Secants::of(self.memory), last: None })
    }
}

#[derive(Debug)]
struct Memory {
    first: f64,
    secants: Secants,
    last: Option<(Vec<f64>, Vec<f64>)>,
}

impl Optimiser for Memory {
    fn advance(&mut self, points: &mut [f64], slab: usize, force: &[f64]) {
        if let Some((step, before)) = self.last.take() {
            let change = before.iter().zip(force).map(|(b, f)| b - f).collect();
            self.secants.learn(step, change);
        }
        let mut step = force.to_vec();
        if !self.secants.apply(&mut step) {
            slab::scale(&mut step, self.first);
        }
        for (m, v) in points.chunks(slab).zip(step.chunks_mut(slab)) {
            project(m, v);
        }
        let rotation = step.chunks(slab).map(rotation_of).fold(0.0, f64::max);
        if rotation > CAP {
            slab::scale(&mut step, CAP / rotation);
        }
        move_points(points, &step, slab, 1.0);
        self.last = Some((step, force.to_vec()));
    }

    /// The last step and force, then the pairs, oldest first; nothing before the first step.
    fn memory(&self) -> Vec<Vec<f64>> {
        let rows = self.last.iter().chain(self.secants.pairs());
        rows.flat_map(|(a, b)| [a.clone(), b.clone()]).collect()
    }

    fn remember(&mut self, memory: Vec<Vec<f64>>) {
        let mut rows = memory.into_iter();
        let mut pairs = std::iter::from_fn(|| Some((rows.next()?, rows.next()?)));
        self.last = pairs.next();
        self.secants.remember(pairs);
    }
}
