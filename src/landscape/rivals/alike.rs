//! From what a symmetry that the energy nearly has makes of known saddles: beside it, as a rule, is one of about the same height. Where a
//! route is looked for, of those that are as high as it.

use super::{Cut, Rival};
use crate::landscape::graph::IMAGES;
use crate::symmetry::{Group, Operation, WEAK};
use rand_chacha::ChaCha8Rng;

/// What was tried.
#[derive(Debug, Default)]
pub struct Alike {
    /// None until they are asked for.
    operations: Option<Vec<Operation>>,
    /// The next of all operations on all passes.
    next: usize,
}

impl Rival for Alike {
    fn start(&mut self, cut: &Cut, _: &mut ChaCha8Rng) -> Option<Vec<f64>> {
        let (land, h) = (cut.land, cut.land.evaluator());
        let found = || {
            let group = Group::nearly(&h, land.reference(), &[]);
            group.operations().take(IMAGES).collect()
        };
        let operations = self.operations.get_or_insert_with(found);
        let ways = land.passes().len() * operations.len();
        while self.next < ways {
            let (pass, by) = (&land.passes()[self.next / operations.len()], &operations[self.next % operations.len()]);
            self.next += 1;
            let (image, own) = (by.apply(pass.saddle.spins()), land.height_mev(pass.saddle.spins()));
            let height = land.height_mev(&image);
            let is_beside = (height - own).abs() < WEAK * h.stiffness_mev();
            let is_wanted = cut.ends.is_none() || own >= cut.top_mev;
            if is_beside && is_wanted && height < cut.top_mev && !land.has_saddle(&image, height) {
                return Some(image);
            }
        }
        None
    }
}
