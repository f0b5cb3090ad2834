//! From each minimum along its softest modes, in both senses, to where the energy begins to fall, a quarter turn at most.

use super::{Cut, Rival};
use crate::energy::Evaluator;
use crate::landscape::pass::SOFTEST;
use crate::linalg::slab;
use crate::sphere::rotation_of;
use crate::stationary::{FAR, FEW, State};
use rand_chacha::ChaCha8Rng;
use std::collections::{BTreeSet, VecDeque};

/// Which orbits were left, and the starts that wait.
#[derive(Debug, Default)]
pub struct Modes {
    left: BTreeSet<usize>,
    next: VecDeque<Vec<f64>>,
}

impl Rival for Modes {
    fn start(&mut self, cut: &Cut, _: &mut ChaCha8Rng) -> Option<Vec<f64>> {
        let h = cut.land.evaluator();
        // what is stopped has no modes, of no minimum
        while self.next.is_empty() && !h.is_stopped() {
            // from an image of a minimum its modes lead to images of what they lead to from that
            let minimum = cut.starts().find(|k| !self.left.contains(&cut.land.orbit(*k)))?;
            self.left.insert(cut.land.orbit(minimum));
            let state = State::at(h, cut.land.minima()[minimum].spins.as_slice().to_vec());
            for mode in state.lowest_modes_beside(h, SOFTEST, &[]) {
                let along = state.field(&mode.vector);
                self.next.extend([1.0, -1.0].map(|sense| top(h, &state, &along, sense)));
            }
        }
        self.next.pop_front()
    }
}

/// Where the energy is highest, in a few steps, on the way along a field from a state, or how far that is followed.
fn top(h: Evaluator, state: &State, along: &[f64], sense: f64) -> Vec<f64> {
    let size = rotation_of(along);
    let (mut highest, mut there) = (f64::NEG_INFINITY, state.m.clone());
    for k in 1..=FEW {
        let mut turn = along.to_vec();
        slab::scale(&mut turn, sense * FAR * k as f64 / (FEW as f64 * size));
        let next = state.moved(&h, &turn);
        let height = h.difference_mev(&next, &state.m);
        if height < highest {
            break;
        }
        (highest, there) = (height, next);
    }
    there
}
