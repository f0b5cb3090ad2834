//! How near joins have brought two minima to each other, and how many in a row brought them no nearer.
//!
//! It is remembered from one examination of a path to the next: where joins led no nearer, more images of the same path do not either.

use crate::sphere::SAME;

/// How joins of two minima get on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearing {
    /// Which minima, and below what height (meV) they are to be joined.
    of: ([usize; 2], f64),
    /// The shortest way between them so far, a sum of squared distances.
    nearest: f64,
    quiet: usize,
    /// All joins so far.
    pub tried: usize,
}

impl Nearing {
    /// Of two minima that are to be joined below a height (meV), with nothing tried yet.
    pub fn of(ends: [usize; 2], below_mev: f64) -> Nearing {
        Nearing { of: (ends, below_mev), nearest: f64::INFINITY, quiet: 0, tried: 0 }
    }

    /// Whether it is of these minima and this height (meV).
    pub fn is_of(&self, ends: [usize; 2], below_mev: f64) -> bool {
        self.of == (ends, below_mev)
    }

    /// Whether another join is of use where the way is so far now, and so many in a row may bring the two no nearer; it counts as tried.
    pub fn goes_on(&mut self, far: f64, most_quiet: usize) -> bool {
        let is_nearer = far < (1.0 - SAME) * self.nearest;
        if is_nearer {
            (self.nearest, self.quiet) = (far, 0);
        } else if self.quiet < most_quiet {
            self.quiet += 1;
        } else {
            return false;
        }
        self.tried += 1;
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const QUIET: usize = 24;

    #[test]
    fn joins_go_on_while_they_bring_two_minima_nearer_and_a_little_longer() {
        let mut nearing = Nearing::of([0, 1], f64::INFINITY);
        let lasts =
            |nearing: &mut Nearing, far: f64| (0..2 * QUIET).take_while(|_| nearing.goes_on(far, QUIET)).count();
        assert_eq!(lasts(&mut nearing, 4.0), 1 + QUIET);
        assert_eq!([lasts(&mut nearing, 4.0), lasts(&mut nearing, 5.0)], [0, 0]);
        assert_eq!(lasts(&mut nearing, 3.0), 1 + QUIET);
        assert_eq!(nearing.tried, 2 * (1 + QUIET));
        assert!(nearing.is_of([0, 1], f64::INFINITY) && !nearing.is_of([0, 1], 2.0));
    }
}
