//! Where the values of a profile stand: one after the other in a row, or at places in space.

use crate::geometry::Vector;

/// Grains that are looked up by their place: so many, along each direction, at the most.
const MOST: usize = 1 << 20;
/// A place on the border of two grains belongs to the second, to this part of a spacing.
const BORDER: f64 = 1e-9;

/// Where sites or bonds stand.
#[derive(Clone, Debug, PartialEq)]
pub enum Places {
    /// So many in a row, each one spacing from the last.
    Row(usize),
    /// At places in spacings.
    Points {
        /// The places.
        at: Vec<Vector>,
        /// The corners of the box of all of them, of least and of greatest coordinates.
        bounds: [Vector; 2],
    },
}

impl From<usize> for Places {
    fn from(count: usize) -> Places {
        Places::Row(count)
    }
}

impl From<Vec<Vector>> for Places {
    fn from(at: Vec<Vector>) -> Places {
        let start = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        let bounds = at.iter().fold(start, |[low, high], p| {
            [[0, 1, 2].map(|c| f64::min(low[c], p[c])), [0, 1, 2].map(|c| f64::max(high[c], p[c]))]
        });
        Places::Points { at, bounds }
    }
}

impl Places {
    /// How many there are.
    pub(super) fn count(&self) -> usize {
        match self {
            Places::Row(count) => *count,
            Places::Points { at, .. } => at.len(),
        }
    }

    /// Where number k is on the way of a ramp, from 0 to 1: along the row, or along x.
    pub(super) fn share(&self, k: usize) -> f64 {
        match self {
            Places::Row(count) if *count > 1 => k as f64 / (count - 1) as f64,
            Places::Points { at, bounds: [low, high] } if high[0] > low[0] => (at[k][0] - low[0]) / (high[0] - low[0]),
            _ => 0.0,
        }
    }

    /// The grain of number k: of so many in the row, or in a cube of so many spacings a side. Grains are counted from the first place,
    /// x fastest.
    pub(super) fn grain(&self, k: usize, length: usize) -> usize {
        match self {
            Places::Row(_) => k / length,
            Places::Points { .. } if length == 1 => k,
            Places::Points { at, bounds: [low, high] } => {
                let number = |x: f64, c: usize| (((x - low[c] + BORDER) / length as f64) as usize).min(MOST - 1);
                let [x, y, z] = [0, 1, 2].map(|c| number(at[k][c], c));
                let [many_x, many_y] = [0, 1].map(|c| number(high[c], c) + 1);
                x + many_x * (y + many_y * z)
            }
        }
    }
}
