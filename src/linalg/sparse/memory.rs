//! The memory of the factors of a sparse matrix.

use std::sync::{Mutex, MutexGuard, PoisonError};

/// Most entries of L in memory that a plan keeps: 1 GB.
const KEPT: usize = 1 << 27;

/// Factors, and what their computation needs.
#[derive(Clone, Debug, Default)]
pub(super) struct Memory {
    /// The columns of L, front by front in panels; see `Front::entries`.
    pub l: Vec<f64>,
    /// D, front by front, 1 where a panel has more columns than its front.
    pub d: Vec<f64>,
    /// What the fronts of the trunk leave until the next one takes it.
    pub waiting: Stacks,
}

/// What fronts leave until the next one takes it: two stacks, by turns level by level of the tree.
pub(super) type Stacks = [Vec<f64>; 2];

/// The memory that factors of a plan left, for the next: to have it anew takes a tenth of the time of factors that are small.
#[derive(Debug, Default)]
pub(super) struct Spare(Mutex<Vec<Memory>>);

impl Clone for Spare {
    fn clone(&self) -> Spare {
        Spare::default()
    }
}

impl Spare {
    fn all(&self) -> MutexGuard<'_, Vec<Memory>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What is kept, if anything is.
    pub fn any(&self) -> Memory {
        self.all().pop().unwrap_or_default()
    }

    /// Keeps it, unless that is so much that others may need it.
    pub fn keep(&self, memory: Memory) {
        let size = memory.l.len();
        if size == 0 {
            return;
        }
        let mut all = self.all();
        if size * (all.len() + 1) <= KEPT {
            all.push(memory);
        }
    }
}

impl Memory {
    /// With room for so many entries of L, so many of D and so many on each stack, whatever is there.
    pub fn fitting(mut self, entries: usize, pivots: usize, waiting: [usize; 2]) -> Memory {
        let [even, odd] = &mut self.waiting;
        for (numbers, length) in [(&mut self.l, entries), (&mut self.d, pivots), (even, waiting[0]), (odd, waiting[1])]
        {
            fit(numbers, length);
        }
        self
    }
}

/// So many numbers, whichever.
fn fit(numbers: &mut Vec<f64>, length: usize) {
    if numbers.len() < length {
        *numbers = vec![0.0; length];
    }
    numbers.truncate(length);
}
