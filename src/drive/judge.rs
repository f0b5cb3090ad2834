//! What a path shows of its barrier.

use super::first_path::FirstPath;
use super::heights::{height, slack};
use super::outcome::{Barrier, SaddlePoint};
use super::{Problem, Verdict};
use crate::band::Band;
use crate::landscape::{Doubt, Minimum, PathEnd};
use crate::stationary::ALIKE;

/// What a path shows.
pub struct Seen<'a> {
    pub problem: &'a Problem,
    pub saddles: &'a [SaddlePoint],
    /// Final above initial state (meV).
    pub above_final: f64,
    pub ends: &'a [Minimum; 2],
}

/// What is said of it.
pub struct Judgement {
    pub verdict: Verdict,
    pub barrier: Option<Barrier>,
    /// What stands against a certificate.
    pub doubts: Vec<Doubt>,
}

impl Seen<'_> {
    /// Energy to climb, from the highest saddle or, where the path has an image above all of them, from that. The `doubts` are those
    /// about its saddles.
    pub fn judge(&self, c: &FirstPath, mut doubts: Vec<Doubt>) -> Judgement {
        if self.is_flat(&c.band) {
            return of_flat(&c.band);
        }
        if self.is_of_higher_index(c) {
            doubts.push(Doubt::HigherIndex);
            return Judgement { verdict: Verdict::HigherIndex(c.stop), barrier: None, doubts };
        }
        let mut highest = self.saddles.iter().map(|s| s.above_initial_mev).fold(f64::NEG_INFINITY, f64::max);
        let (seen, ends, height) = (c.top_mev(), self.above_final.max(0.0), height(&c.band));
        if seen > highest + slack(&c.band) && seen > ends + ALIKE * height {
            highest = seen;
            doubts.extend(self.problem.seeks_saddles().then_some(Doubt::HigherImage));
        }
        if highest <= ends && !self.problem.relax_ends {
            let end = if self.above_final > 0.0 { PathEnd::Final } else { PathEnd::Initial };
            doubts.push(Doubt::KeptEnd(end));
            return Judgement { verdict: Verdict::KeptEnd(c.stop, end), barrier: None, doubts };
        }
        let (verdict, forward_mev) = match highest <= ends {
            true => (Verdict::NoMaximum(c.stop), ends),
            false => (Verdict::Path(c.stop), highest),
        };
        let barrier = Some(Barrier { forward_mev, backward_mev: forward_mev - self.above_final });
        Judgement { verdict, barrier, doubts }
    }

    /// Whether the path joins two proven minima and no image of it differs from the first by more than rounding.
    fn is_flat(&self, band: &Band) -> bool {
        let (h, path) = (band.hamiltonian(), band.path());
        let rounding = h.rounding_mev();
        let level = |k: usize| h.difference_mev(path.image(k), path.image(0)).abs() <= rounding;
        self.problem.relax_ends
            && self.ends.iter().all(Minimum::is_proven)
            && path.is_resolved()
            && (1..path.images()).all(level)
    }

    fn is_of_higher_index(&self, c: &FirstPath) -> bool {
        self.problem.seeks_saddles()
            && c.found.as_ref().is_some_and(|f| f.refined.index() > 1)
            && self.saddles.iter().all(|s| s.negative_modes != Some(1))
    }
}

/// Of a path that is flat to rounding: what no saddle search could find or prove there does not count against it, but rounding that
/// may hide a barrier does.
fn of_flat(band: &Band) -> Judgement {
    let (h, path) = (band.hamiltonian(), band.path());
    let images = (0..path.images()).map(|k| path.image(k));
    let (verdict, barrier) = match h.hiding_rounding_mev(images) {
        Some(rounding_mev) => (Verdict::BelowRounding { rounding_mev }, None),
        None => {
            let none = Barrier { forward_mev: 0.0, backward_mev: 0.0 };
            (Verdict::FlatValley { rounding_mev: h.rounding_mev() }, Some(none))
        }
    };
    Judgement { verdict, barrier, doubts: Vec::new() }
}
