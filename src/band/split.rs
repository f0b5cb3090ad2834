//! One image's tangent, and its force split along and across it, in two passes over tiles of sites.

use crate::energy::Hamiltonian;
use crate::field::{Components, project_row, tiles};
use crate::linalg::slab;
use crate::sphere::angles_between;
use multiversion::multiversion;

/// What a split says besides its two fields.
#[derive(Clone, Copy, Debug)]
pub struct Split {
    /// F·τ (meV/rad).
    pub along: f64,
    /// The largest component of the force across (meV); NaN if one is not finite.
    pub largest: f64,
    /// Distance to the next image, and the largest rotation of a spin to there (rad).
    pub after: (f64, f64),
    /// |τ| before it is projected and scaled, and after it is projected: on a slope the straight distance to the neighbour uphill, and √Σ sin²
    /// of the angles to there.
    pub chord: [f64; 2],
}

/// Writes the unit tangent `t` and the force across it `f` of the image in the middle of `images`, where the Euclidean
/// gradient is `g`; `weights` are those of the steps forwards and backwards.
pub fn image(
    h: &Hamiltonian,
    images: [&[f64]; 3],
    weights: (f64, f64),
    g: &[f64],
    t: &mut [f64],
    f: &mut [f64],
) -> Split {
    let [before, here, after] = images.map(Components::new);
    let g = Components::new(g);
    let (mut tt, mut ft, mut squares, mut widest, mut raw) = (0.0, 0.0, 0.0, 0.0f64, 0.0);
    for ((first, mut t), (_, mut f)) in tiles(t).zip(tiles(f)) {
        let range = first..first + t.x.len();
        let [before, here, after] = [before, here, after].map(|m| m.range(range.clone()));
        let g = g.range(range);
        chord(weights, before.x, here.x, after.x, t.x);
        chord(weights, before.y, here.y, after.y, t.y);
        chord(weights, before.z, here.z, after.z, t.z);
        raw += slab::dot(t.x, t.x) + slab::dot(t.y, t.y) + slab::dot(t.z, t.z);
        project_row(here, t.reborrow());
        h.hold_frozen_row(first, t.reborrow());
        h.force_row(first, here, g, f.reborrow());
        tt += slab::dot(t.x, t.x) + slab::dot(t.y, t.y) + slab::dot(t.z, t.z);
        ft += slab::dot(f.x, t.x) + slab::dot(f.y, t.y) + slab::dot(f.z, t.z);
        let (sum, largest) = angles_between(here, after);
        squares += sum;
        widest = widest.max(largest);
    }
    let shrink = 1.0 / tt.sqrt().max(f64::MIN_POSITIVE);
    let along = ft * shrink;
    let largest = take_apart(t, f, shrink, along);
    Split { along, largest, after: (squares.sqrt(), widest), chord: [raw.sqrt(), tt.sqrt()] }
}

/// t = w⁺ (after − here) + w⁻ (here − before), one component.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn chord((plus, minus): (f64, f64), before: &[f64], here: &[f64], after: &[f64], t: &mut [f64]) {
    let n = t.len();
    let (before, here, after) = (&before[..n], &here[..n], &after[..n]);
    for i in 0..n {
        t[i] = plus * (after[i] - here[i]) + minus * (here[i] - before[i]);
    }
}

/// t ← shrink t, then f ← f − along t; the largest component of f.
fn take_apart(t: &mut [f64], f: &mut [f64], shrink: f64, along: f64) -> f64 {
    let mut largest: f64 = 0.0;
    for (t, f) in t.chunks_mut(1024).zip(f.chunks_mut(1024)) {
        slab::scale(t, shrink);
        slab::add_scaled(f, -along, t);
        let here = slab::max_abs(f);
        largest = if here.is_nan() { f64::NAN } else { largest.max(here) };
        if largest.is_nan() {
            return f64::NAN;
        }
    }
    largest
}
