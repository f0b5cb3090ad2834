//! The factors of a sparse matrix, front by front.

use super::SparseMatrix;
use super::assembly::{add_entries, add_left};
use super::memory::{Memory, Stacks};
use crate::linalg::front::eliminate;
use rayon::prelude::*;
use std::mem::take;
use std::ops::Range;

impl Memory {
    /// Branches side by side, then the trunk. What a front computes depends on no other than those below it, so that the bits are those
    /// of one after the other.
    pub fn eliminate(&mut self, matrix: &SparseMatrix, floor: f64) {
        let plan = &matrix.plan;
        let (mut branches, mut trunk) = (Vec::new(), Vec::new());
        let (mut l, mut d, mut next) = (&mut self.l[..], &mut self.d[..], 0);
        let mut fronts_to = |end: usize| {
            let fronts = std::mem::replace(&mut next, end)..end;
            let mine = &plan.fronts[fronts.clone()];
            let entries = mine.iter().map(|front| front.entries.len()).sum();
            let pivots = mine.iter().map(|front| front.own_rows()).sum();
            let (l, d) = (split_off(&mut l, entries), split_off(&mut d, pivots));
            Run { matrix, floor, fronts, l, d }
        };
        for branch in &plan.branches {
            trunk.push(fronts_to(branch.fronts.start));
            branches.push((branch, fronts_to(branch.fronts.end)));
        }
        trunk.push(fronts_to(plan.fronts.len()));
        let left = branches.into_par_iter().map(|(branch, run)| {
            let mut stacks = branch.waiting.map(|length| vec![0.0; length]);
            let (root, tops) = (branch.fronts.end - 1, run.eliminate(&mut stacks, [0; 2], &[]));
            let front = &plan.fronts[root];
            debug_assert_eq!(tops[front.stack], front.left());
            let mut left = take(&mut stacks[front.stack]);
            left.truncate(front.left());
            left.shrink_to_fit();
            (root, left)
        });
        let left: Vec<(usize, Vec<f64>)> = left.collect();
        trunk.into_iter().fold([0; 2], |tops, run| run.eliminate(&mut self.waiting, tops, &left));
    }
}

/// The first so many of some numbers.
fn split_off<'a>(numbers: &mut &'a mut [f64], length: usize) -> &'a mut [f64] {
    let (first, rest) = take(numbers).split_at_mut(length);
    *numbers = rest;
    first
}

/// Fronts that are eliminated one after the other, with their columns of L and their pivots.
struct Run<'a> {
    matrix: &'a SparseMatrix,
    floor: f64,
    fronts: Range<usize>,
    l: &'a mut [f64],
    d: &'a mut [f64],
}

impl Run<'_> {
    /// What the fronts leave goes on the stacks, which reach to `tops`; `branches` have left the rest. How far the stacks reach then.
    fn eliminate(mut self, stacks: &mut Stacks, mut tops: [usize; 2], branches: &[(usize, Vec<f64>)]) -> [usize; 2] {
        let plan = &self.matrix.plan;
        let [even, odd] = stacks;
        let mut work = Vec::new();
        for front in &plan.fronts[self.fronts] {
            let children = || plan.children[front.children.clone()].iter().map(|c| *c as usize);
            let of_branch =
                |c: usize| branches.binary_search_by_key(&c, |(root, _)| *root).ok().map(|b| &branches[b].1[..]);
            let (above, below, stack) = if front.stack == 0 { (&mut *even, &*odd, 0) } else { (&mut *odd, &*even, 1) };
            let top = tops[stack];
            let rest = &mut above[top..top + front.left()];
            tops[stack] += rest.len();
            let l = split_off(&mut self.l, front.entries.len());
            let d = split_off(&mut self.d, front.own_rows());
            l.fill(0.0);
            rest.fill(0.0);
            add_entries(front, &plan.targets[front.targets.clone()], &self.matrix.blocks, l);
            let on_stack = children().filter(|c| of_branch(*c).is_none());
            let mut at = tops[1 - stack] - on_stack.map(|c| plan.fronts[c].left()).sum::<usize>();
            tops[1 - stack] = at;
            for c in children() {
                let child = &plan.fronts[c];
                let left = of_branch(c).unwrap_or_else(|| {
                    at += child.left();
                    &below[at - child.left()..at]
                });
                add_left(left, &plan.slots[child.others.clone()], front, l, rest);
            }
            eliminate(l, front.rows(), rest, d, self.floor, &mut work);
        }
        tops
    }
}
