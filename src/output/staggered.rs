//! The mean spin and the staggered one, and which of them a path is about.

use crate::geometry::vector::Vector;
use crate::path::Path;

/// The staggered mean is shown if it changes so many times more.
const MORE: f64 = 1.5;

/// (±1)^i: the sign with which site i is counted.
pub(super) fn sign(staggered: bool, site: usize) -> f64 {
    if staggered && site % 2 == 1 { -1.0 } else { 1.0 }
}

/// Σ (±1)^i m_i / N of every image, over the sites with a spin.
pub(super) fn means(path: &Path, staggered: bool, vacant: &[bool]) -> Vec<Vector> {
    (0..path.images()).map(|k| mean(path, k, staggered, vacant)).collect()
}

fn mean(path: &Path, k: usize, staggered: bool, vacant: &[bool]) -> Vector {
    let (m, n) = (path.image(k), path.sites());
    let (mut sum, mut count) = ([0.0; 3], 0.0);
    for i in (0..n).filter(|i| !vacant.get(*i).copied().unwrap_or(false)) {
        (0..3).for_each(|c| sum[c] += sign(staggered, i) * m[c * n + i]);
        count += 1.0;
    }
    sum.map(|s| s / f64::max(count, 1.0))
}

/// Whether the staggered mean changes more along the path than the mean does, as in an antiferromagnet.
pub(super) fn is_staggered(path: &Path, vacant: &[bool]) -> bool {
    let change = |staggered: bool| largest_change(&means(path, staggered, vacant)).1;
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
