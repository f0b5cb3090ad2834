//! Factors of a sparse matrix, and their computation, front by front.

use super::assembly::{add_entries, add_left};
use super::front::eliminate;
use super::{SparseMatrix, Symbolic};

/// Factors, and what their computation needs.
#[derive(Clone, Debug, Default)]
pub(super) struct Memory {
    /// The columns of L, front by front in panels; see `Front::entries`.
    pub l: Vec<f64>,
    /// D, front by front, 1 where a panel has more columns than its front.
    pub d: Vec<f64>,
    /// What fronts leave until the next one takes it: two stacks, by turns level by level of the tree.
    pub waiting: [Vec<f64>; 2],
    work: Vec<f64>,
}

impl Memory {
    pub fn fit(&mut self, plan: &Symbolic) {
        for (numbers, length) in [(&mut self.l, plan.entries), (&mut self.d, plan.pivots)] {
            fit(numbers, length);
        }
        for (stack, length) in self.waiting.iter_mut().zip(plan.waiting) {
            fit(stack, length);
        }
    }

    pub fn eliminate(&mut self, matrix: &SparseMatrix, floor: f64) {
        let plan = &matrix.plan;
        let [even, odd] = &mut self.waiting;
        let mut tops = [0; 2];
        for front in &plan.fronts {
            let children = plan.children[front.children.clone()].iter().map(|c| &plan.fronts[*c as usize]);
            let (above, below, stack) = if front.stack == 0 { (&mut *even, &*odd, 0) } else { (&mut *odd, &*even, 1) };
            let top = tops[stack];
            let rest = &mut above[top..top + front.left()];
            tops[stack] += rest.len();
            let l = &mut self.l[front.entries.clone()];
            let d = &mut self.d[front.pivot..front.pivot + front.own_rows()];
            l.fill(0.0);
            rest.fill(0.0);
            add_entries(front, &plan.targets[front.targets.clone()], &matrix.blocks, l);
            let mut at = tops[1 - stack] - children.clone().map(|c| c.left()).sum::<usize>();
            tops[1 - stack] = at;
            for child in children {
                let slots = &plan.slots[child.others.clone()];
                add_left(&below[at..at + child.left()], slots, front, l, rest);
                at += child.left();
            }
            eliminate(l, front.rows(), rest, d, floor, &mut self.work);
        }
    }
}

/// So many numbers, whichever.
fn fit(numbers: &mut Vec<f64>, length: usize) {
    if numbers.len() < length {
        *numbers = vec![0.0; length];
    }
    numbers.truncate(length);
}
