//! The points of a descent that are kept.

use super::tolerances::{FEW, STEP};
use crate::path::largest_angle;

/// Numbers that all points of one trail may have together.
const MOST_NUMBERS: usize = 24_000_000;

/// States on a way, a [`STEP`] or more apart; twice as far, and so on, when they become too many to store.
#[derive(Clone, Debug)]
pub struct Trail {
    start: Vec<f64>,
    points: Vec<Vec<f64>>,
    apart: f64,
}

impl Trail {
    /// Of a way that begins at `start`, which is not one of its points.
    pub fn from(start: &[f64]) -> Trail {
        Trail { start: start.to_vec(), points: Vec::new(), apart: STEP }
    }

    /// Keeps a point that is far from the last one kept.
    pub fn pass(&mut self, m: &[f64]) {
        if largest_angle(self.points.last().unwrap_or(&self.start), m) < self.apart {
            return;
        }
        if self.points.len() >= (MOST_NUMBERS / m.len().max(1)).max(FEW) {
            self.apart *= 2.0;
            let mut kept = 0;
            self.points.retain(|_| {
                kept += 1;
                kept % 2 == 0
            });
        }
        self.points.push(m.to_vec());
    }

    /// The last point that is farther than this (rad, any spin) from a state, or the start.
    pub fn last_beyond(&self, m: &[f64], angle: f64) -> &[f64] {
        self.points.iter().rev().find(|point| largest_angle(point, m) > angle).unwrap_or(&self.start)
    }

    /// The points, first to last.
    pub fn into_points(self) -> Vec<Vec<f64>> {
        self.points
    }
}

#[cfg(test)]
mod tests {
    use super::{FEW, MOST_NUMBERS, Trail};

    #[test]
    fn a_long_trail_is_thinned_and_keeps_its_order() {
        let sites = MOST_NUMBERS / FEW / 3 / 4;
        let at = |angle: f64| {
            let (s, c) = (libm::sin(angle), libm::cos(angle));
            [vec![s; sites], vec![0.0; sites], vec![c; sites]].concat()
        };
        let mut trail = Trail::from(&at(0.0));
        for k in 1..=12 * FEW {
            trail.pass(&at(0.4 * k as f64));
        }
        let points = trail.into_points();
        assert!(points.len() <= 4 * FEW && points.len() > FEW, "{}", points.len());
    }
}
