//! From each minimum along its softest modes, in both senses.

use super::{Cut, Rival};
use crate::linalg::{lowest_modes, slab};
use crate::sphere::rotation_of;
use crate::stationary::State;
use rand_chacha::ChaCha8Rng;
use std::collections::{BTreeSet, VecDeque};

/// How many modes.
const MODES: usize = 4;
/// How far (rad, the spin that turns most).
const START: f64 = 0.6;

/// Which minima were left, and the starts that wait.
#[derive(Debug, Default)]
pub struct Modes {
    left: BTreeSet<usize>,
    next: VecDeque<Vec<f64>>,
}

impl Rival for Modes {
    fn start(&mut self, cut: &Cut, _: &mut ChaCha8Rng) -> Option<Vec<f64>> {
        while self.next.is_empty() {
            let minimum = cut.starts().find(|k| !self.left.contains(k))?;
            self.left.insert(minimum);
            let state = State::at(cut.land.evaluator(), cut.land.minima()[minimum].spins.as_slice().to_vec());
            for mode in lowest_modes(&state.hessian, MODES, &state.zeros) {
                let mut along = state.field(&mode.vector);
                let size = rotation_of(&along);
                slab::scale(&mut along, START / size);
                for sense in [1.0, -1.0] {
                    slab::scale(&mut along, sense);
                    self.next.push_back(state.moved(&along));
                }
            }
        }
        self.next.pop_front()
    }
}
