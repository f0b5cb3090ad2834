//! How a matrix of a lattice is kept, and where its sites stand in the order of elimination.

use super::Symbolic;
use std::sync::Arc;

/// What the matrices of a lattice are, two unknowns a site.
#[derive(Clone, Debug)]
pub enum Layout {
    /// A band.
    Band {
        /// How many places partners are apart at most.
        span: usize,
        /// Where the sites stand.
        places: Places,
    },
    /// Blocks of coupled sites, with the plan of their factorisation.
    Sparse(Arc<Symbolic>),
    /// All pairs.
    Dense,
}

/// Where each site stands in a band: as they are counted, if nothing else is said.
#[derive(Clone, Debug, Default)]
pub struct Places(Option<Arc<[usize]>>);

impl Places {
    /// Of sites that stand there.
    pub fn new(places: Vec<usize>) -> Places {
        Places((!places.is_sorted()).then(|| places.into()))
    }

    /// The place of every site, where they do not stand as they are counted.
    pub fn moved(&self) -> Option<&[usize]> {
        self.0.as_deref()
    }

    /// The place of a site.
    #[inline]
    pub fn of(&self, site: usize) -> usize {
        self.0.as_ref().map_or(site, |places| places[site])
    }

    /// Where unknown i of so many stands.
    #[inline]
    pub(super) fn unknown(&self, i: usize, order: usize) -> usize {
        let Some(places) = &self.0 else { return i };
        let each = order / places.len();
        each * places[i / each] + i % each
    }

    /// Calls `act` with a vector of as many numbers for each site, put in the order of the band; it comes back as it went.
    pub(super) fn within<R>(&self, x: &mut [f64], act: impl FnOnce(&mut [f64]) -> R) -> R {
        let Some(places) = self.moved().filter(|_| !x.is_empty()) else { return act(x) };
        let mut placed = self.placed(x);
        let done = act(&mut placed);
        let each = x.len() / places.len();
        for (x, place) in x.chunks_exact_mut(each).zip(places) {
            let from = &placed[each * place..][..each];
            x.iter_mut().zip(from).for_each(|(x, p)| *x = *p);
        }
        done
    }

    /// A vector in the order of the band.
    pub(super) fn placed(&self, x: &[f64]) -> Vec<f64> {
        let mut placed = vec![0.0; x.len()];
        let Some(places) = self.moved() else { return x.to_vec() };
        let each = x.len() / places.len();
        for (x, place) in x.chunks_exact(each).zip(places) {
            let to = &mut placed[each * place..][..each];
            to.iter_mut().zip(x).for_each(|(p, x)| *p = *x);
        }
        placed
    }
}
