//! A first path that was followed to its end.

use super::first_path::FirstPath;
use crate::landscape::{Doubt, Minimum, Pass, Saddle};

/// What was proven of a path.
pub struct Proof {
    /// The two ends, examined.
    pub ends: [Minimum; 2],
    /// Saddles in path order, with the minima beside them.
    pub links: Vec<Pass>,
    /// What stands against a certificate; nothing if it is given.
    pub doubts: Vec<Doubt>,
}

/// A path with what is known of it.
pub(super) struct Settled<'a> {
    pub(super) first: FirstPath<'a>,
    pub(super) found: Vec<Saddle>,
    pub(super) proof: Proof,
}

impl Settled<'_> {
    /// The highest that the path is known to pass above its first image (meV): an image or a saddle.
    pub(super) fn seen_mev(&self) -> f64 {
        let reference = self.first.band.energies_mev()[0];
        let saddles = self.proof.links.iter().map(|l| l.saddle.refined.state.energy_mev - reference);
        saddles.fold(self.first.top_mev(), f64::max)
    }
}
