//! Whether a way along a valley is back where it began: a valley that closes falls nowhere, as a helix that slides by its own length.

use super::tolerances::{LARGER, STEP};
use crate::path::largest_angle;

/// A way along a valley, seen from where it began.
pub(super) struct Circuit {
    start: Vec<f64>,
    is_away: bool,
}

impl Circuit {
    /// Of a way that begins at a state (3N).
    pub fn from(start: &[f64]) -> Circuit {
        Circuit { start: start.to_vec(), is_away: false }
    }

    /// Whether it closes at this state: less than a step from its start, and farther away before.
    pub fn closes(&mut self, m: &[f64]) -> bool {
        let far = largest_angle(&self.start, m);
        let closes = self.is_away && far < STEP;
        self.is_away |= far > LARGER * STEP;
        closes
    }
}

#[cfg(test)]
mod tests {
    use super::Circuit;

    #[test]
    fn a_way_closes_where_it_comes_back_and_not_where_it_begins() {
        let at = |angle: f64| [libm::sin(angle), 0.0, libm::cos(angle)];
        let mut circuit = Circuit::from(&at(0.0));
        assert!([0.1, 0.2, 0.8, 0.2].iter().all(|angle| !circuit.closes(&at(*angle))));
        assert!([1.0, 2.0, 4.0, 5.9].iter().all(|angle| !circuit.closes(&at(*angle))));
        assert!(circuit.closes(&at(6.2)));
    }
}
