//! The states of a crossing with all that their partition functions take, over the range of temperatures where nothing of it changes:
//! along which valleys each state slides, and which states are then places of one.

use super::determinant::PinnedHessian;
use super::refusal::no_minimum;
use super::sliding::{Generator, LEAST, Pinning, Slide, Sliding, Turn};
use super::symmetry::{free_shifts, places, states_along_turn, states_on_the_way};
use super::{
    Crossing, Equivalents, Family, KEPT_OR_EXCHANGED, OneState, Refusal, Siblings, Symmetry, UnknownModes, Unstable,
    ZeroModes, equivalent_saddles, growth_rate, zero_modes,
};
use crate::energy::Evaluator;
use crate::linalg::{orthonormal, remove, slab};
use crate::stationary::{ALIKE, Spectrum, State};
use crate::symmetry::Group;
use std::f64::consts::PI;

/// Places at which is looked, all round a turn.
const AROUND: usize = 8;

const NAMES: [&str; 3] = ["the saddle", "the minimum before it", "the minimum after it"];

/// A saddle with its descending mode, and the minima beside it.
pub(super) struct Beside<'a> {
    h: Evaluator<'a>,
    symmetry: &'a Symmetry,
    pub unstable: Unstable,
    /// The saddle, the minimum before it and that after it.
    pub states: [State; 3],
    spectra: [&'a Spectrum; 3],
}

/// How all three slide at a temperature.
#[derive(Clone, Debug, PartialEq)]
struct Choice {
    sliding: [Sliding; 3],
    /// Of each shift the first multiple that is free.
    steps: Vec<usize>,
    /// The minimum (1 or 2) that is held while the saddle slides past its places, which shifts make that keep the other minimum.
    held: Option<usize>,
    /// The turn along which some of them slide.
    turn: Option<Turn>,
    /// Along what each goes nobody knows how far.
    unknown: [Option<UnknownModes>; 3],
}

/// The three states above a k_BT, until the next.
pub(super) struct Wells {
    pub above_mev: f64,
    pub found: Result<Found, Refusal>,
}

/// What the states have.
pub(super) struct Found {
    pub saddle: Well,
    /// The minimum before it and that after it; over the saddle out of one it takes no volume of the other.
    pub minima: [Result<Well, Refusal>; 2],
    pub equivalents: Equivalents,
    pub siblings: Siblings,
    /// Out of the minimum before the saddle and out of that after it: ln of the places of the other that shifts make which keep this one, of which
    /// a rate leads to one.
    pub ln_beyond: [f64; 2],
    /// Whether the saddles are counted at all of these places, though a rate leads to one.
    pub one_of: [bool; 2],
    pub turn: Option<Turn>,
}

/// A stationary state, ready for its partition function.
pub(super) struct Well {
    /// Without its zero modes, its valleys and a descending mode.
    pub pinned: PinnedHessian,
    /// ln|det'H|, the descending mode's |λ₁| included.
    pub log_determinant: f64,
    pub zeros: Vec<ZeroModes>,
    /// Zero modes and valleys.
    pub count: usize,
    /// ln of the volume of the states like it.
    pub ln_volume: f64,
    /// What its places cost along its soft modes.
    pub pinning: Vec<Pinning>,
    /// ln of the states alike that are its places.
    pub ln_places: f64,
    /// The turn along which it slides.
    pub turn: Option<Turn>,
    /// By how much ½ ln|det'H| differs at most, all round that.
    pub uneven: f64,
}

/// Whether all places of each minimum are counted as one: of those that slide, and of the one that is held while others do.
fn one(shifts: [bool; 3], held: Option<usize>) -> [bool; 2] {
    [1, 2].map(|k| shifts[k] || held == Some(k))
}

impl<'a> Beside<'a> {
    pub fn new(h: Evaluator<'a>, crossing: &Crossing<'a>, unstable: Unstable) -> Result<Beside<'a>, Refusal> {
        let minima = crossing.minima.map(|m| State::at(h, m.as_slice().to_vec()));
        for (side, name) in ["before", "after"].into_iter().enumerate() {
            let torque = minima[side].max_torque_mev();
            no_minimum(crossing.minima_spectra[side], torque, name).map_or(Ok(()), Err)?;
        }
        let [before, after] = minima;
        let [b, a] = crossing.minima_spectra;
        let states = [crossing.saddle.clone(), before, after];
        Ok(Beside { h, symmetry: crossing.symmetry, unstable, states, spectra: [crossing.spectrum, b, a] })
    }

    /// The states at all temperatures, by ascending k_BT from 0 on; `most_mev`: the higher of the two barriers.
    pub fn wells(&self, most_mev: f64) -> Vec<Wells> {
        let of = |k: usize| Slide::of(self.h, &self.states[k], self.descending(k), self.group(), most_mev);
        let mut slides = [of(0), of(1), of(2)];
        let mut levels: Vec<f64> = Vec::new();
        // what is chosen somewhere may change elsewhere than what was known before
        let choices = loop {
            let choices: Vec<_> = (0..=levels.len()).map(|k| self.choice(&mut slides, &levels, k)).collect();
            let known = levels.len();
            levels.extend(self.levels_mev(&slides));
            levels.sort_by(f64::total_cmp);
            // those of states that are alike differ by rounding; at the lowest of them none slides yet
            levels.dedup_by(|next, last| *next - *last <= ALIKE * *last);
            if levels.len() == known {
                break choices;
            }
        };
        let from = std::iter::once(0.0).chain(levels);
        let mut different: Vec<(f64, Choice)> = Vec::new();
        for (above_mev, choice) in from.zip(choices) {
            if different.last().is_none_or(|(_, last)| *last != choice) {
                different.push((above_mev, choice));
            }
        }
        let wells = |(above_mev, choice): (f64, Choice)| Wells { above_mev, found: self.found(&choice) };
        different.into_iter().map(wells).collect()
    }

    fn group(&self) -> &'a Group {
        &self.symmetry.exact
    }

    fn descending(&self, k: usize) -> Option<&Unstable> {
        (k == 0).then_some(&self.unstable)
    }

    /// Each positive k_BT (meV) at which something may change.
    fn levels_mev(&self, slides: &[Slide; 3]) -> Vec<f64> {
        let turns = slides.iter().filter_map(Slide::turn);
        let turned = turns.flat_map(|turn| slides.iter().map(move |s| s.turned_mev(&turn)));
        slides
            .iter()
            .flat_map(Slide::levels_mev)
            .chain(slides[0].tops_mev())
            .chain(turned)
            .filter(|mev| *mev > 0.0)
            .collect()
    }

    /// Between two of some levels.
    fn choice(&self, slides: &mut [Slide; 3], levels: &[f64], k: usize) -> Choice {
        // a state slides above a level, not at it
        let last = levels.last().map_or(1.0, |last| 2.0 * last);
        let thermal_mev = levels.get(k).copied().unwrap_or(last);
        let (mut free, mut turns) = (vec![true; self.group().shifts().len()], true);
        loop {
            let is_free = |generator: &Generator| match generator {
                Generator::Shift(k) => free[*k],
                Generator::Turn(_) => turns,
            };
            let sliding = slides.each_mut().map(|slide| slide.at(thermal_mev, &is_free));
            let shifts = sliding.each_ref().map(Sliding::shifts);
            let goes_past = sliding[0].top_mev() <= thermal_mev;
            let held = if goes_past { self.held(shifts) } else { None };
            let steps = free_shifts(self.group(), self.minima(), one(shifts, held));
            let turn = sliding.iter().find_map(Sliding::turn);
            // a shift that keeps neither leads to a saddle between other minima, and a turn that does not keep both
            let shifts = shifts.contains(&true);
            let keep: Vec<bool> =
                steps.iter().zip(&free).map(|(steps, free)| *free && (*steps == 1 || !shifts)).collect();
            let kept = |turn: &Turn| {
                (1..3).all(|k| match sliding[k].turn() {
                    Some(own) => own == *turn,
                    None => slides[k].turned_mev(turn) < thermal_mev,
                })
            };
            let turning = turns && turn.as_ref().is_none_or(kept);
            if keep == free && turning == turns {
                let unknown = slides.each_ref().map(|slide| slide.unknown(thermal_mev));
                return Choice { sliding, steps, held, turn, unknown };
            }
            (free, turns) = (keep, turning);
        }
    }

    fn minima(&self) -> [&[f64]; 2] {
        [&self.states[1].m, &self.states[2].m]
    }

    /// Of each shift the first multiple that keeps minimum k (1 or 2), whatever it makes of the other.
    fn steps_that_keep(&self, k: usize) -> Vec<usize> {
        free_shifts(self.group(), self.minima(), [k != 1, k != 2])
    }

    /// The one minimum (1 or 2) that is held while the saddle slides (`shifts`), past places of it which shifts make that keep the other
    /// minimum. What slides past all of its places has an equal share in each. Of a saddle that is narrow, held flatly under a high top, each
    /// place is one beside one of the minimum's as long as k_BT is below that top.
    fn held(&self, shifts: [bool; 3]) -> Option<usize> {
        let moved = |k: usize| !shifts[k] && self.steps_that_keep(k).iter().any(|steps| *steps > 1);
        let kept = |k: usize| !shifts[k] && !moved(k);
        if shifts[0] { [1, 2].into_iter().find(|k| moved(*k) && kept(3 - k)) } else { None }
    }

    fn found(&self, choice: &Choice) -> Result<Found, Refusal> {
        let Choice { sliding, steps, held, turn, unknown } = choice;
        if self.h.is_stopped() {
            return Err(Refusal::Stopped);
        }
        let symmetry = self.symmetry.along(*turn);
        let along = &symmetry.exact;
        let shifts = sliding.each_ref().map(Sliding::shifts);
        let (saddle, minima, one) = (&self.states[0].m, self.minima(), one(shifts, *held));
        let as_one = OneState { slide: shifts, minima: one, along: &sliding[0].lines(&self.states[0]) };
        let equivalents = equivalent_saddles(self.h.lattice(), along, saddle, minima, as_one, KEPT_OR_EXCHANGED);
        let family = Family::of(self.h, &symmetry, minima, one, KEPT_OR_EXCHANGED);
        let own = (&self.states[0], Some(&self.unstable), sliding[0].modes.len());
        let siblings = family.map(|family| family.siblings(own, shifts[0], &[])).unwrap_or_default();
        let free = Some(&steps[..]).filter(|_| shifts.contains(&true));
        let well = |k: usize| {
            let well = unknown[k].map_or_else(|| self.well(k, &sliding[k], free, along), Err);
            well.map_err(|unknown| Refusal::Volume(NAMES[k], unknown))
        };
        let ln_beyond = [1, 2].map(|k| self.ln_beyond(k, shifts));
        let one_of = [1, 2].map(|k| *held == Some(3 - k));
        Ok(Found {
            saddle: well(0)?,
            minima: [well(1), well(2)],
            equivalents,
            siblings,
            ln_beyond,
            one_of,
            turn: *turn,
        })
    }

    /// Out of minimum k (1 or 2), where some of the three slide: all places are one of a minimum that slides, and a rate out of one leads to all.
    fn ln_beyond(&self, k: usize, shifts: [bool; 3]) -> f64 {
        let other = 3 - k;
        if shifts[k] || shifts[other] {
            return 0.0;
        }
        libm::log(places(self.group(), &self.states[other].m, &self.steps_that_keep(k)) as f64)
    }

    /// λ₊ (rad/s) on the way to the saddle's next place by a turn, where the energy along that first has no curvature (of a cosine a quarter of
    /// the way): as it is for what precesses past place after place while it crosses. `gyration` and damping as in [`growth_rate`].
    pub fn growth_between_places(&self, turn: &Turn, gyration: &[f64], damping: f64) -> Option<f64> {
        let saddle = &self.states[0];
        let angle = turn.straightens(&self.h, &saddle.m)?;
        let there = State::at(self.h, turn.by(&self.h, saddle.m.clone(), angle));
        let mut mode = there.basis.coordinates(&turn.by(&self.h, saddle.field(&self.unstable.mode), angle));
        slab::normalise(&mut mode);
        let eigenvalue_mev = there.curvature_mev(&mode);
        let unstable = Some(Unstable { eigenvalue_mev, mode }).filter(|unstable| unstable.eigenvalue_mev < 0.0)?;
        growth_rate(self.h, &there, &unstable, gyration, damping)
    }

    /// By how much ½ ln|det'H| of state k differs at most, all round a turn: one that keeps the energy need not keep what lies across it.
    fn uneven(&self, k: usize, turn: &Turn) -> f64 {
        let (h, state) = (self.h, &self.states[k]);
        let descent = self.descending(k).map(|unstable| state.field(&unstable.mode));
        let log_determinant = |part: usize| -> Option<f64> {
            let angle = 2.0 * PI * part as f64 / (AROUND * turn.fold) as f64;
            let here = State::at(h, turn.by(&h, state.m.clone(), angle));
            let along = here.basis.coordinates(&turn.along(&h, &here.m));
            let left_out = orthonormal(here.zeros.iter().cloned().chain([along]).collect(), LEAST);
            let mut unstable = None;
            if let Some(descent) = &descent {
                let mut mode = here.basis.coordinates(&turn.by(&h, descent.clone(), angle));
                remove(&mut mode, &left_out);
                slab::normalise(&mut mode);
                let eigenvalue_mev = here.curvature_mev(&mode);
                unstable = Some(Unstable { eigenvalue_mev, mode }).filter(|unstable| unstable.eigenvalue_mev < 0.0);
                unstable.as_ref()?;
            }
            let pinned = PinnedHessian::new(&here.hessian, &left_out, unstable.as_ref(), h.stiffness_mev() / 3.0);
            let falls = unstable.map_or(0.0, |unstable| libm::log(-unstable.eigenvalue_mev));
            Some(pinned.log_determinant() + falls).filter(|log| log.is_finite())
        };
        let Some(own) = log_determinant(0) else { return 0.0 };
        (1..AROUND).filter_map(log_determinant).map(|other| 0.5 * (other - own).abs()).fold(0.0, f64::max)
    }

    /// Of state k, where so many times each shift is free, if anything slides over the lattice.
    fn well(&self, k: usize, sliding: &Sliding, free: Option<&[usize]>, along: &Group) -> Result<Well, UnknownModes> {
        let (h, state, unstable) = (self.h, &self.states[k], self.descending(k));
        let number = |steps: &[usize]| places(self.group(), &state.m, steps);
        let turned = states_along_turn(self.group(), along, &state.m);
        let (own, kept, alike) = match free {
            Some(steps) if sliding.shifts() => {
                (number(steps), 1, states_on_the_way(h.lattice(), self.group(), &state.m, &sliding.lines(state), steps))
            }
            Some(steps) => (1, number(steps), number(steps)),
            None => (1, 1, 1),
        };
        let kept = if sliding.turn().is_some() { kept } else { kept * turned };
        let zeros = zero_modes(&h, state, sliding, own, self.spectra[k])?;
        let left_out: Vec<Vec<f64>> = state.zeros.iter().chain(&sliding.modes).cloned().collect();
        let pinned = PinnedHessian::new(&state.hessian, &left_out, unstable, h.stiffness_mev() / 3.0);
        let descent = unstable.map_or(0.0, |u| libm::log(-u.eigenvalue_mev));
        let ln_volume = zeros.iter().map(|z| libm::log(z.volume)).sum::<f64>() + libm::log(kept as f64);
        let uneven = sliding.turn().map_or(0.0, |turn| self.uneven(k, &turn));
        Ok(Well {
            turn: sliding.turn(),
            uneven,
            log_determinant: pinned.log_determinant() + descent,
            pinned,
            zeros,
            count: left_out.len(),
            ln_volume,
            pinning: sliding.pinning().collect(),
            ln_places: libm::log((alike * turned) as f64),
        })
    }
}
