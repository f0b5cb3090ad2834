//! What is around a part of a state while its sense and its size are chosen.
//!
//! The sites of parts that have nothing to choose are as they will be. On those of parts that have a choice too the part goes on as
//! if they were its own, and their energy does not count: two layers that are coupled do not hinder each other's textures, and neither
//! part waits for the other.

use crate::geometry::Vector;

/// The sites of a part, and the spins of others that are settled.
#[derive(Clone, Debug)]
pub struct Surroundings {
    own: Vec<bool>,
    settled: Vec<Option<Vector>>,
}

impl Surroundings {
    /// Those of a part with these sites; `settled` has nothing at sites of parts that have a choice.
    pub(super) fn new(sites: &[usize], settled: &[Option<Vector>]) -> Surroundings {
        let mut own = vec![false; settled.len()];
        sites.iter().for_each(|i| own[*i] = true);
        Surroundings { own, settled: settled.to_vec() }
    }

    /// Whether a site is one of the part's own.
    pub(super) fn is_own(&self, i: usize) -> bool {
        self.own[i]
    }

    /// The part as it goes on for ever, with what is settled in its place.
    pub(super) fn surrounded(&self, mut vectors: Vec<Vector>) -> Vec<Vector> {
        for (v, settled) in vectors.iter_mut().zip(&self.settled) {
            *v = settled.unwrap_or(*v);
        }
        vectors
    }

    /// What counts of the energies of all sites.
    pub(super) fn counted(&self, density: Vec<f64>) -> Vec<f64> {
        let counts = |i: usize| self.own[i] || self.settled[i].is_some();
        density.into_iter().enumerate().filter(|(i, _)| counts(*i)).map(|(_, e)| e).collect()
    }
}
