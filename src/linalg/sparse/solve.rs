//! Substitution with sparse factors: up the tree with L, down with Lᵀ.

use super::Symbolic;
use super::memory::Memory;
use crate::linalg::front::{backward, forward};
use multiversion::multiversion;
use std::ops::Range;

/// Solves L D Lᵀ X = B in place for `columns` interleaved right-hand sides, up to four in a pass.
pub(super) fn solve(plan: &Symbolic, factors: &Memory, x: &mut [f64], columns: usize) {
    for first in (0..columns).step_by(4) {
        let those = first..columns.min(first + 4);
        match those.len() {
            1 => pass::<1>(plan, factors, x, columns, those),
            2 => pass::<2>(plan, factors, x, columns, those),
            _ => pass::<4>(plan, factors, x, columns, those),
        }
    }
}

/// At most C columns.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn pass<const C: usize>(plan: &Symbolic, factors: &Memory, x: &mut [f64], columns: usize, those: Range<usize>) {
    let there = those.len();
    let mut y = vec![[[0.0; C]; 2]; plan.place.len()];
    for (i, place) in plan.place.iter().enumerate() {
        for u in 0..2 {
            copy(&mut y[*place as usize][u], &x[(2 * i + u) * columns + those.start..][..there]);
        }
    }
    let mut w = vec![[0.0; C]; plan.most_rows];
    for front in &plan.fronts {
        let w = &mut w[..front.rows()];
        w.fill([0.0; C]);
        pairs(w, 0).iter_mut().zip(&y[front.own.clone()]).for_each(|(w, y)| *w = *y);
        forward(&factors.l[front.entries.clone()], front.panels, w);
        y[front.own.clone()].iter_mut().zip(pairs(w, 0)).for_each(|(y, w)| *y = *w);
        for (place, w) in plan.others[front.others.clone()].iter().zip(pairs(w, front.own_rows())) {
            let y = y[*place as usize].as_flattened_mut();
            y.iter_mut().zip(w.as_flattened()).for_each(|(y, w)| *y += w);
        }
    }
    for front in plan.fronts.iter().rev() {
        let w = &mut w[..front.rows()];
        w[..front.own_rows()].fill([0.0; C]);
        pairs(w, 0).iter_mut().zip(&y[front.own.clone()]).for_each(|(w, y)| *w = *y);
        let others = &plan.others[front.others.clone()];
        pairs(w, front.own_rows()).iter_mut().zip(others).for_each(|(w, place)| *w = y[*place as usize]);
        let d = &factors.d[front.pivot..front.pivot + front.own_rows()];
        w.iter_mut().zip(d).for_each(|(w, d)| w.iter_mut().for_each(|w| *w /= d));
        backward(&factors.l[front.entries.clone()], front.panels, w);
        y[front.own.clone()].iter_mut().zip(pairs(w, 0)).for_each(|(y, w)| *y = *w);
    }
    for (i, place) in plan.place.iter().enumerate() {
        for u in 0..2 {
            copy(&mut x[(2 * i + u) * columns + those.start..][..there], &y[*place as usize][u]);
        }
    }
}

/// Copies numbers as far as both go: too few to call for.
#[inline(always)]
fn copy(to: &mut [f64], from: &[f64]) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to = *from);
}

/// The two rows of every site from `first` on.
#[inline(always)]
fn pairs<const C: usize>(w: &mut [[f64; C]], first: usize) -> &mut [[[f64; C]; 2]] {
    w[first..].as_chunks_mut().0
}
