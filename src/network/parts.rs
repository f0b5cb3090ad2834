//! Sets that are joined bit by bit.

/// So many numbers, each in a set of its own at first.
#[derive(Clone, Debug)]
pub struct Parts(Vec<usize>);

impl Parts {
    /// Of so many.
    pub fn of(count: usize) -> Parts {
        Parts((0..count).collect())
    }

    /// The number that all of its set share: the least of them.
    pub fn root(&mut self, mut k: usize) -> usize {
        while self.0[k] != k {
            self.0[k] = self.0[self.0[k]];
            k = self.0[k];
        }
        k
    }

    /// Makes the sets of two numbers one.
    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b)] = a.min(b);
    }
}
