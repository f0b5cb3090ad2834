//! Limited-memory BFGS on spheres, without line search (a band's force is no gradient, so there is no function to search).
//!
//! Nocedal, Math. Comp. 35, 773 (1980), doi:10.1090/S0025-5718-1980-0572855-7 (two-loop recursion). Pairs of differences are
//! kept in the embedding space and projected by use; a pair without positive curvature empties the memory. To compare with.

use super::{Follows, Method, Optimiser};
use crate::field::project;
use crate::linalg::slab;
use crate::registry::Described;
use crate::sphere::{move_points, rotation_of};
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::VecDeque;

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
        Box::new(Memory { limit: self.memory, first: 1.0 / stiffness_mev, pairs: VecDeque::new(), last: None })
    }
}

#[derive(Debug)]
struct Memory {
    limit: usize,
    first: f64,
    pairs: VecDeque<(Vec<f64>, Vec<f64>)>,
    last: Option<(Vec<f64>, Vec<f64>)>,
}

impl Memory {
    /// Remembers the step taken and the change of force it made.
    fn learn(&mut self, force: &[f64]) {
        let Some((step, before)) = self.last.take() else { return };
        let change: Vec<f64> = before.iter().zip(force).map(|(b, f)| b - f).collect();
        if slab::dot(&step, &change) <= 1e-12 * slab::norm(&step) * slab::norm(&change) {
            self.pairs.clear();
            return;
        }
        self.pairs.push_back((step, change));
        if self.pairs.len() > self.limit {
            self.pairs.pop_front();
        }
    }

    fn direction(&self, force: &[f64]) -> Vec<f64> {
        let mut q = force.to_vec();
        let mut weights = Vec::new();
        for (s, y) in self.pairs.iter().rev() {
            let a = slab::dot(s, &q) / slab::dot(s, y);
            slab::add_scaled(&mut q, -a, y);
            weights.push(a);
        }
        let scale = self.pairs.back().map_or(self.first, |(s, y)| slab::dot(s, y) / slab::dot(y, y));
        slab::scale(&mut q, scale);
        for ((s, y), a) in self.pairs.iter().zip(weights.iter().rev()) {
            let b = slab::dot(y, &q) / slab::dot(s, y);
            slab::add_scaled(&mut q, a - b, s);
        }
        q
    }
}

impl Optimiser for Memory {
    fn advance(&mut self, points: &mut [f64], slab: usize, force: &[f64]) {
        self.learn(force);
        let mut step = self.direction(force);
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
        let rows = self.last.iter().chain(&self.pairs);
        rows.flat_map(|(a, b)| [a.clone(), b.clone()]).collect()
    }

    fn remember(&mut self, memory: Vec<Vec<f64>>) {
        let mut rows = memory.into_iter();
        let mut pairs = std::iter::from_fn(|| Some((rows.next()?, rows.next()?)));
        self.last = pairs.next();
        self.pairs = pairs.collect();
    }
}
