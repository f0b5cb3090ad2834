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
const STARTS: [f64; 2] = [0.6, 1.2];

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
                let along = state.field(&mode.vector);
                for far in STARTS.into_iter().flat_map(|far| [far, -far]) {
                    let mut turn = along.clone();
                    slab::scale(&mut turn, far / rotation_of(&along));
                    self.next.push_back(state.moved(&turn));
                }
            }
        }
        self.next.pop_front()
    }

    fn goes_first(&self) -> bool {
        true
    }
}
