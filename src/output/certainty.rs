//! How certain a barrier is, and how it may therefore be told: with all digits where it is certified; otherwise as *not certified*,
//! with the digits that are known and at most three.
//!
//! What is unknown of a barrier that rests on an image is at least the gap between the top of the interpolated path and its highest
//! image, and what the band would still have gained, ½ Σ F·θ ≤ ½ · 3N · |F⊥|∞ · |θ|∞ with θ the rotation that the relaxation still
//! predicted. The energy of a refined saddle is exact, but a proof that the path needs no more is missing: three digits.
//! Where an end relaxed far from where it was put, the barrier may be between other states than meant, which is said beside it.

use super::canvas::significant;
use crate::drive::{Barrier, MOVED_FAR_RAD, Outcome};

/// Most digits of what is not certified.
const DIGITS: i32 = 3;

/// How certain the barrier of a result is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Certainty {
    /// What is unknown of a barrier that is not certified, at least (meV); nothing where it is certified.
    pub unknown_mev: Option<f64>,
    /// Largest rotation of a spin while the initial and the final state relaxed, where that is far (rad).
    pub moved_far_rad: [Option<f64>; 2],
}

impl Certainty {
    /// Of a barrier of which so much is unknown (meV), nothing if it is certified, between ends that relaxed by these rotations (rad).
    pub fn new(unknown_mev: Option<f64>, moved_rad: [Option<f64>; 2]) -> Certainty {
        let far = |angle: Option<f64>| angle.filter(|angle| *angle > MOVED_FAR_RAD);
        Certainty { unknown_mev, moved_far_rad: moved_rad.map(far) }
    }

    /// Of an outcome.
    pub fn of(outcome: &Outcome) -> Certainty {
        let moved = [&outcome.initial, &outcome.final_state].map(|end| end.moved_rad);
        Certainty::new((!outcome.certified).then(|| unknown_mev(outcome)), moved)
    }

    /// Whether nothing is in doubt.
    pub fn is_certified(&self) -> bool {
        self.unknown_mev.is_none()
    }

    /// An energy in a unit of which there are `per_mev` to the meV: to `digits` significant ones, or with "≈" to those that are known.
    pub fn number(&self, mev: f64, per_mev: f64, digits: usize) -> String {
        match self.unknown_mev {
            None => significant(mev * per_mev, digits),
            Some(unknown) => format!("≈ {}", known_digits(mev * per_mev, unknown * per_mev)),
        }
    }

    /// The barrier of a result in a line of text.
    pub fn barrier_words(&self, barrier: Option<Barrier>) -> String {
        let proof = if self.is_certified() { "certified" } else { "not certified" };
        let number = |mev: f64| match self.unknown_mev {
            // six decimals, of which a pinned wall may have none
            None if mev.abs() < 1e-3 && mev != 0.0 => significant(mev, 4),
            None => format!("{mev:.6}"),
            Some(unknown) => known_digits(mev, unknown),
        };
        let about = if self.is_certified() { "" } else { "about " };
        let words = match barrier.map(|b| (number(b.forward_mev), number(b.backward_mev))) {
            Some((forward, backward)) => {
                format!("barrier {about}{forward} meV forward, {backward} meV backward, {proof}")
            }
            None => format!("no barrier, {proof}"),
        };
        self.moved_words().fold(words, |words, moved| format!("{words}; {moved}"))
    }

    /// Which ends relaxed far from where they were put.
    pub(super) fn moved_words(&self) -> impl Iterator<Item = String> {
        let ends = ["initial", "final"].into_iter().zip(self.moved_far_rad);
        ends.filter_map(|(end, moved)| {
            let degrees = moved?.to_degrees();
            Some(format!("the {end} state relaxed far from where it was put (a spin turned by {degrees:.0}°)"))
        })
    }

    /// What must be said beside every figure; nothing where nothing is in doubt.
    pub fn notes(&self) -> Vec<String> {
        let proof = (!self.is_certified()).then(|| "not certified".to_string());
        proof.into_iter().chain(self.moved_words()).collect()
    }
}

/// The least that is unknown of an uncertified barrier (meV).
fn unknown_mev(outcome: &Outcome) -> f64 {
    let Some(barrier) = outcome.barrier else { return 0.0 };
    let top = barrier.forward_mev;
    if outcome.saddles.iter().any(|s| s.max_torque_mev.is_some() && s.above_initial_mev == top) {
        return 0.0;
    }
    let highest = outcome.images.above_initial_mev.iter().copied().fold(0.0, f64::max);
    // before the first iteration nothing is predicted
    let rotation = if outcome.history.is_empty() { 1.0 } else { outcome.largest_predicted_rotation_rad };
    let left = 1.5 * outcome.path.sites() as f64 * outcome.max_perpendicular_torque_mev * rotation;
    let unknown = (top - highest).abs() + left;
    if unknown.is_finite() { unknown } else { top.abs() }
}

/// A number rounded where its digits are no longer known: at least one digit, at most three.
fn known_digits(value: f64, unknown: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return significant(value, 1);
    }
    let first = libm::log10(value.abs()).floor() as i32;
    let doubtful = if unknown > 0.0 { libm::log10(unknown).ceil() as i32 } else { i32::MIN };
    let last = doubtful.max(first + 1 - DIGITS).min(first);
    let place = libm::pow(10.0, f64::from(last.abs()));
    // dividing by a whole power of ten keeps decimals exact
    let rounded = if last < 0 { (value * place).round() / place } else { (value / place).round() * place };
    significant(rounded, (first - last + 1) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_certified_has_the_digits_that_are_known_and_at_most_three() {
        for (value, unknown, told) in [
            (0.170008526, 0.0, "0.170"),
            (0.170008526, 1e-9, "0.170"),
            (0.170008526, 2e-3, "0.17"),
            (0.170008526, 0.04, "0.2"),
            (0.170008526, 5.0, "0.2"),
            (3323.4, 0.0, "3320"),
            (3323.4, 20.0, "3300"),
            (93_874.5, 1.0, "93900"),
            (9.996, 0.0, "10.0"),
            (1.234e-9, 0.0, "1.23×10⁻⁹"),
            (-0.0412, 0.0, "−0.0412"),
            (0.0, 0.1, "0"),
        ] {
            assert_eq!(known_digits(value, unknown), told, "{value} ± {unknown}");
        }
    }

    #[test]
    fn a_barrier_is_told_with_all_digits_only_where_it_is_certified() {
        let barrier = Some(Barrier { forward_mev: 0.170008526447, backward_mev: 0.25 });
        let (certified, open) = (Certainty::default(), Certainty::new(Some(2e-3), [None; 2]));
        let words = "barrier 0.170009 meV forward, 0.250000 meV backward, certified";
        assert_eq!(certified.barrier_words(barrier), words);
        let small = Some(Barrier { forward_mev: 6.600376e-8, backward_mev: 0.0 });
        assert_eq!(certified.barrier_words(small), "barrier 6.600×10⁻⁸ meV forward, 0.000000 meV backward, certified");
        assert_eq!(open.barrier_words(barrier), "barrier about 0.17 meV forward, 0.25 meV backward, not certified");
        assert_eq!(open.barrier_words(None), "no barrier, not certified");
        assert_eq!((certified.notes(), open.notes()), (vec![], vec!["not certified".to_string()]));
        let moved = Certainty::new(None, [Some(1.5), Some(2.7)]);
        let told = "the final state relaxed far from where it was put (a spin turned by 155°)";
        assert_eq!(moved.notes(), [told]);
        assert_eq!(moved.barrier_words(None), format!("no barrier, certified; {told}"));
        assert_eq!(certified.number(0.170008526447, 1e3, 4), "170.0");
        assert_eq!(open.number(0.170008526447, 1e3, 4), "≈ 170");
    }
}
