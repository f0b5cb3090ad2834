//! What may be missing: what the random starts say of minima that none of them led to.
//!
//! ```text
//! chance that a further start leads to a kind that none did        f₁/n
//! kinds that starts lead to, at least about                        S + f₁(f₁ − 1)/2(f₂ + 1)
//! ```
//! n starts led to S kinds, f₁ of them once and f₂ twice. I. J. Good, Biometrika 40, 237 (1953), doi:10.1093/biomet/40.3-4.237; A. Chao,
//! Scand. J. Stat. 11, 265 (1984), in the form without bias that also stands where f₂ = 0 (A. Chao, Biometrics 43, 783 (1987),
//! doi:10.2307/2531532). Of minima with a narrow basin, and of saddles, it says nothing.

use std::collections::BTreeMap;

/// How often random starts led to each kind of minimum.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Unseen {
    /// n: starts that led to a minimum in the window.
    pub starts: usize,
    /// S.
    pub kinds: usize,
    /// f₁.
    pub once: usize,
    /// f₂.
    pub twice: usize,
}

impl Unseen {
    /// From the kind that each start led to.
    pub(super) fn of(reached: &[usize]) -> Unseen {
        let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
        reached.iter().for_each(|kind| *counts.entry(*kind).or_default() += 1);
        let with = |times: usize| counts.values().filter(|n| **n == times).count();
        Unseen { starts: reached.len(), kinds: counts.len(), once: with(1), twice: with(2) }
    }

    /// The chance that a further start leads to a kind that none of them did; nothing without starts.
    pub fn chance(&self) -> Option<f64> {
        (self.starts > 0).then(|| self.once as f64 / self.starts as f64)
    }

    /// How many kinds such starts lead to, at least about.
    pub fn estimated_kinds(&self) -> f64 {
        let pairs = (self.once * self.once.saturating_sub(1)) as f64;
        self.kinds as f64 + pairs / (2 * (self.twice + 1)) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn what_was_reached_once_says_what_was_not_reached() {
        assert_eq!(Unseen::of(&[]).chance(), None);
        let found = Unseen::of(&[0, 0, 0, 1, 1, 2, 3, 4]);
        assert_eq!((found.starts, found.kinds, found.once, found.twice), (8, 5, 3, 1));
        assert_eq!((found.chance(), found.estimated_kinds()), (Some(0.375), 6.5));
    }

    #[test]
    fn of_kinds_that_are_equally_likely_the_number_is_estimated() {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(2);
        let mean = (0..400)
            .map(|_| {
                let reached: Vec<usize> = (0..60).map(|_| random.random_range(0..50)).collect();
                Unseen::of(&reached).estimated_kinds()
            })
            .sum::<f64>()
            / 400.0;
        // 60 starts lead to 35 of 50 kinds
        assert!((mean - 50.0).abs() < 3.0, "{mean}");
    }
}
