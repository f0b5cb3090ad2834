//! The mean spin and the staggered one, and which of them a path is about.

use crate::geometry::vector::Vector;
use crate::lattice::Lattice;
use crate::path::Path;

/// The staggered mean is shown if it changes so many times more.
const MORE: f64 = 1.5;

/// Which sites have no spin, and which are of the sublattice that a staggered state reverses.
#[derive(Clone, Debug, Default)]
pub struct SiteKinds {
    /// Sites without a spin; empty if there are none.
    pub vacant: Vec<bool>,
    /// Sites that a staggered state reverses; empty for every other site of a row.
    pub odd: Vec<bool>,
}

impl SiteKinds {
    /// Of a lattice.
    pub fn of(lattice: &Lattice) -> SiteKinds {
        let odd = if lattice.is_row() { Vec::new() } else { (0..lattice.sites).map(|i| lattice.is_odd(i)).collect() };
        SiteKinds { vacant: lattice.vacant.clone(), odd }
    }

    /// The sign with which site i is counted.
    pub(super) fn sign(&self, staggered: bool, site: usize) -> f64 {
        let is_odd = self.odd.get(site).copied().unwrap_or(site % 2 == 1);
        if staggered && is_odd { -1.0 } else { 1.0 }
    }
}

/// Σ ± m_i / N of every image, over the sites with a spin.
pub(super) fn means(path: &Path, staggered: bool, kinds: &SiteKinds) -> Vec<Vector> {
    (0..path.images()).map(|k| mean(path, k, staggered, kinds)).collect()
}

fn mean(path: &Path, k: usize, staggered: bool, kinds: &SiteKinds) -> Vector {
    let (m, n) = (path.image(k), path.sites());
    let (mut sum, mut count) = ([0.0; 3], 0.0);
    for i in (0..n).filter(|i| !kinds.vacant.get(*i).copied().unwrap_or(false)) {
        (0..3).for_each(|c| sum[c] += kinds.sign(staggered, i) * m[c * n + i]);
        count += 1.0;
    }
    sum.map(|s| s / f64::max(count, 1.0))
}

/// Whether the staggered mean changes more along the path than the mean does, as in an antiferromagnet.
pub(super) fn is_staggered(path: &Path, kinds: &SiteKinds) -> bool {
    let change = |staggered: bool| largest_change(&means(path, staggered, kinds)).1;
    change(true) > MORE * change(false)
}

/// The Cartesian axis along which a mean changes most, and by how much.
pub(super) fn largest_change(means: &[Vector]) -> (usize, f64) {
    let change = |c: usize| {
        let (lo, hi) =
            means.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), m| (lo.min(m[c]), hi.max(m[c])));
        (c, (hi - lo).max(0.0))
    };
    // z before y before x where they are equal
    [2, 1, 0].map(change).into_iter().reduce(|a, b| if b.1 > a.1 { b } else { a }).unwrap_or((2, 0.0))
}
