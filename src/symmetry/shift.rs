//! Shifts along periodic directions.

use super::operation::Operation;
use crate::geometry::matrix::{UNIT, product};

/// Any of the orthogonal matrices tried becomes 1 after so many times.
const ORDER: usize = 12;

/// The shortest shift along a direction.
#[derive(Clone, Debug)]
pub struct Shift {
    /// Once.
    pub operation: Operation,
    /// After how many times every site is where it was.
    pub order: usize,
}

impl Shift {
    /// So many times, less than its order.
    pub fn times(&self, count: usize) -> Operation {
        let once = &self.operation;
        let motion = once.motion.times(count, &once.lattice);
        let spin = (0..count % ORDER).fold(UNIT, |r, _| product(&r, &once.spin));
        Operation { motion, spin, ..once.clone() }
    }
}
