//! The rates over one saddle, forward and backward.

use super::passage::{TEN_YEARS_S, blocking_temperature};
use super::refusal::{conserved_moment, unfit};
use super::sliding::{Pinning, Turn};
use super::switches::ln_open;
use super::validity::{Bath, Fluctuations, Validity, of_cells, warnings};
use super::wells::{Beside, Found};
use super::{
    Equivalents, RateSettings, Refusal, Siblings, Symmetry, Theory, Unstable, ZeroModes, crossover_temperature,
    growth_rate, ln_cut, unstable_mode,
};
use crate::energy::Evaluator;
use crate::spins::Spins;
use crate::stationary::{Spectrum, State};
use crate::units::K_B;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Below so many k_BT a barrier holds nothing back, and there is no rate over it.
pub const LEAST_BARRIER: f64 = 1.0;

/// Three translations and a turn.
const MOST_VALLEYS: usize = 4;

/// A saddle between two minima.
#[derive(Clone, Copy, Debug)]
pub struct Crossing<'a> {
    /// The saddle.
    pub saddle: &'a State,
    /// A field (3N) near its descending mode.
    pub valley: &'a [f64],
    /// Its modes.
    pub spectrum: &'a Spectrum,
    /// The minima before and after it.
    pub minima: [&'a Spins; 2],
    /// Their modes.
    pub minima_spectra: [&'a Spectrum; 2],
    /// The symmetry of the energy and the moments, and what it nearly is.
    pub symmetry: &'a Symmetry,
    /// What stands against its certificate; nothing if it has one.
    pub doubt: Option<&'a str>,
}

/// A direction along the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Way {
    /// From the initial to the final state.
    Forward,
    /// From the final to the initial state.
    Backward,
}

impl Way {
    /// Both.
    pub const BOTH: [Way; 2] = [Way::Forward, Way::Backward];

    /// Its name in results.
    pub fn name(self) -> &'static str {
        match self {
            Way::Forward => "forward",
            Way::Backward => "backward",
        }
    }
}

/// The factor before e^(−ΔE/k_BT), for one saddle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prefactor {
    /// ω (rad/s): the frequency that the theory gives the crossing.
    pub frequency_per_s: f64,
    /// ln of the prefactor in Hz where 2πk_BT is 1 meV.
    pub ln_hz: f64,
    /// It grows as T to this power, soft translations and rotations apart.
    pub exponent: f64,
    /// What places cost along soft modes of the saddle and of the minimum.
    pub pinning: [[Option<Pinning>; MOST_VALLEYS]; 2],
}

impl Prefactor {
    /// ln of the prefactor in Hz at a temperature (K).
    pub fn ln_hz_at(&self, temperature_k: f64) -> f64 {
        let free = match self.exponent {
            0.0 => self.ln_hz,
            e => self.ln_hz + e * libm::log(2.0 * PI * K_B * temperature_k),
        };
        let mean = |pinning: &Pinning| pinning.ln_mean(K_B * temperature_k);
        let [saddle, minimum] = self.pinning.each_ref().map(|all| all.iter().flatten().map(mean).sum::<f64>());
        free + saddle - minimum
    }

    /// The prefactor in Hz at a temperature (K).
    pub fn hz_at(&self, temperature_k: f64) -> f64 {
        libm::exp(self.ln_hz_at(temperature_k))
    }
}

/// Rates at one temperature, as logarithms: a lifetime may exceed what a double holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Row {
    /// Temperature (K).
    pub temperature_k: f64,
    /// Δ = ΔE/k_BT; over several saddles that of the highest.
    pub barrier_over_kt: f64,
    /// ln of the rate in 1/s by HTST.
    pub ln_htst_per_s: Option<f64>,
    /// ln of the rate in 1/s by Langer.
    pub ln_langer_per_s: Option<f64>,
    /// The rate may be larger or smaller by this factor; nothing where there is no rate, or nothing known of its error.
    pub known_within: Option<f64>,
    /// Why there is no rate at this temperature, where there is one at others.
    pub reason: Option<String>,
}

impl Row {
    /// Without rates if the barrier is lower than k_BT.
    pub fn held(self) -> Row {
        if self.barrier_over_kt >= LEAST_BARRIER {
            return self;
        }
        let reason = format!("ΔE is below {LEAST_BARRIER} k_BT");
        let (temperature_k, barrier_over_kt) = (self.temperature_k, self.barrier_over_kt);
        Row { temperature_k, barrier_over_kt, reason: Some(reason), ..Row::default() }
    }

    /// ln of the mean lifetime in s: Langer's where there is one, else that of HTST.
    pub fn ln_lifetime_s(&self) -> Option<f64> {
        self.ln_langer_per_s.or(self.ln_htst_per_s).map(|ln| -ln)
    }
}

/// What rates over one saddle in one direction are made of above a temperature, until the next of its kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Regime {
    /// The temperature (K).
    pub above_k: f64,
    /// HTST, if asked for and not refused.
    pub htst: Option<Prefactor>,
    /// Langer, if asked for and not refused.
    pub langer: Option<Prefactor>,
    /// ½ ln(det'H_m/|det'H_s|), energies in meV.
    pub entropy_factor: Option<f64>,
    /// Zero modes of the minimum, and those that are soft against k_BT.
    pub minimum_zeros: Vec<ZeroModes>,
    /// Of the saddle.
    pub saddle_zeros: Vec<ZeroModes>,
    /// Saddles of the same kind out of the same minimum; the rates are over all of them. Where something slides, the places of
    /// a minimum are one state, which is left over the saddles at all places.
    pub equivalents: Equivalents,
    /// Saddles of all but the same kind, as many as their heights let through; the rates are over them too.
    pub siblings: Siblings,
    /// Where something slides: ln of the states of the minimum that are places of one over those of the saddle.
    pub ln_places: f64,
    /// Where the minimum on the other side slides: ln of the places of it that the rate leads to, over those of this minimum.
    pub ln_targets: f64,
    /// ln of the places of the minimum on the other side that shifts make which keep this one, where the rate leads to one of them.
    pub ln_beyond: f64,
    /// The turn along which the saddle or a minimum slides.
    pub turn: Option<Turn>,
    /// What the errors hang on, where there is a rate.
    pub validity: Option<Validity>,
    /// Theories that give no rate here, and why.
    pub refused: Vec<(Theory, Refusal)>,
}

impl Regime {
    fn refused(above_k: f64, settings: &RateSettings, reason: &Refusal) -> Regime {
        Regime {
            above_k,
            htst: None,
            langer: None,
            entropy_factor: None,
            minimum_zeros: Vec::new(),
            saddle_zeros: Vec::new(),
            equivalents: Equivalents { count: 1, by: "not sought".into() },
            siblings: Siblings::default(),
            ln_places: 0.0,
            ln_targets: 0.0,
            ln_beyond: 0.0,
            turn: None,
            validity: None,
            refused: settings.theories.iter().map(|t| (*t, reason.clone())).collect(),
        }
    }

    /// ln of the number of saddles that the rates at a temperature (K) are over, and by how much that may be off.
    pub fn ln_saddles(&self, temperature_k: f64) -> [f64; 2] {
        self.siblings.ln_number(self.equivalents.count, K_B * temperature_k)
    }

    /// The prefactor by a theory.
    pub fn prefactor(&self, theory: Theory) -> Option<Prefactor> {
        match theory {
            Theory::Htst => self.htst,
            Theory::Langer => self.langer,
        }
    }
}

/// The rates over one saddle in one direction.
#[derive(Clone, Debug, PartialEq)]
pub struct SaddleRate {
    /// Which saddle, counted along the path.
    pub saddle: usize,
    /// In which direction.
    pub way: Way,
    /// Saddle above the minimum (meV).
    pub barrier_mev: Option<f64>,
    /// What they are made of, by ascending temperature from 0 K on.
    pub regimes: Vec<Regime>,
    /// Temperature (K) below which tunnelling takes over, see [`crossover_temperature`]; nothing where the spins do not precess
    /// over the saddle.
    pub crossover_k: Option<f64>,
    /// One row a temperature.
    pub rows: Vec<Row>,
    /// Temperature (K) at which the mean lifetime is 1 s, and at which it is ten years.
    pub blocking_k: [Option<f64>; 2],
    /// Where the numbers are rough.
    pub warnings: Vec<String>,
}

impl SaddleRate {
    /// What the rates at a temperature (K) are made of.
    pub fn at(&self, temperature_k: f64) -> &Regime {
        ruling(&self.regimes, |regime| regime.above_k, temperature_k)
    }

    /// ln of the rate in 1/s by a theory at a temperature (K), over all saddles that are equivalent, or nearly so; what the formula gives,
    /// however low the barrier.
    pub fn ln_rate_per_s(&self, theory: Theory, temperature_k: f64) -> Option<f64> {
        let regime = self.at(temperature_k);
        let many = regime.ln_saddles(temperature_k)[0];
        let prefactor = regime.prefactor(theory)?.ln_hz_at(temperature_k);
        Some(prefactor + many - self.barrier_mev? / (K_B * temperature_k))
    }

    /// ln of the rate in 1/s by a theory at a temperature (K) over one of the equivalent saddles alone, out of one place of the minimum.
    pub fn ln_rate_of_one_per_s(&self, theory: Theory, temperature_k: f64) -> Option<f64> {
        let (all, regime) = (self.ln_rate_per_s(theory, temperature_k)?, self.at(temperature_k));
        Some(all - regime.ln_saddles(temperature_k)[0] + regime.ln_places)
    }

    /// Whether what is on both sides of the saddle slides, and the saddle holds it on neither side: two places of one state, whose integral
    /// over the valley each side has in full already. `back`: the rate over the same saddle from its other side; a temperature (K).
    pub fn is_within_one(&self, back: &SaddleRate, temperature_k: f64) -> bool {
        [self, back].iter().all(|side| {
            let slides = side.at(temperature_k).minimum_zeros.iter().any(ZeroModes::slides);
            slides && side.barrier_mev.is_some_and(|barrier| barrier < LEAST_BARRIER * K_B * temperature_k)
        })
    }

    /// ln of the factor within which the rate is known at a temperature (K).
    pub fn ln_known_within(&self, temperature_k: f64) -> f64 {
        let regime = self.at(temperature_k);
        let [_, vague] = regime.ln_saddles(temperature_k);
        let open = libm::hypot(vague, ln_open(&self.regimes, temperature_k));
        regime.validity.map_or(f64::INFINITY, |v| libm::hypot(v.ln_factor(temperature_k), open))
    }

    fn fill(&mut self, settings: &RateSettings) {
        let row = |t: f64| {
            let all = Row {
                temperature_k: t,
                barrier_over_kt: self.barrier_mev.map_or(0.0, |e| e / (K_B * t)),
                ln_htst_per_s: self.ln_rate_per_s(Theory::Htst, t),
                ln_langer_per_s: self.ln_rate_per_s(Theory::Langer, t),
                known_within: factor(self.ln_known_within(t)),
                reason: self.none_at(t),
            };
            all.held()
        };
        let rows: Vec<Row> = match self.barrier_mev {
            Some(_) => settings.temperatures_k.iter().map(|t| row(*t)).collect(),
            None => Vec::new(),
        };
        let lifetime = |t: f64| row(t).ln_lifetime_s();
        let scale = self.barrier_mev.unwrap_or(0.0);
        let blocking = [1.0, TEN_YEARS_S].map(|s| blocking_temperature(lifetime, scale, s));
        (self.rows, self.blocking_k) = (rows, blocking);
    }

    /// Why there is no rate at a temperature (K) where there are some at others.
    fn none_at(&self, temperature_k: f64) -> Option<String> {
        let rated = |regime: &Regime| regime.htst.or(regime.langer).is_some();
        let here = self.at(temperature_k);
        if rated(here) || !self.regimes.iter().any(rated) {
            return None;
        }
        here.refused.first().map(|(_, reason)| reason.to_string())
    }
}

/// What holds at a temperature (K), of what begins to hold above others, by ascending ones; at least one of it.
pub(super) fn ruling<T>(all: &[T], above_k: impl Fn(&T) -> f64, temperature_k: f64) -> &T {
    let begun = all.partition_point(|one| above_k(one) < temperature_k);
    &all[begun.max(1) - 1]
}

/// A factor from its logarithm, if it is one.
pub(super) fn factor(ln: f64) -> Option<f64> {
    Some(libm::exp(ln)).filter(|f| f.is_finite())
}

/// A saddle without rates, in both directions, and the reason.
pub fn refused(
    saddle: usize,
    settings: &RateSettings,
    barriers_mev: [Option<f64>; 2],
    reason: &Refusal,
) -> [SaddleRate; 2] {
    [0, 1].map(|side| SaddleRate {
        saddle,
        way: Way::BOTH[side],
        barrier_mev: barriers_mev[side],
        regimes: vec![Regime::refused(0.0, settings, reason)],
        crossover_k: None,
        rows: Vec::new(),
        blocking_k: [None, None],
        warnings: Vec::new(),
    })
}

/// The rates over a saddle, forward and backward.
pub fn saddle_rates(h: Evaluator, number: usize, crossing: &Crossing, settings: &RateSettings) -> [SaddleRate; 2] {
    let barriers = crossing.minima.map(|m| h.difference_mev(&crossing.saddle.m, m.as_slice()));
    let mut rates = match computed(h, number, crossing, settings, barriers) {
        Ok(rates) => rates,
        Err(reason) => refused(number, settings, barriers.map(Some), &reason),
    };
    rates.iter_mut().for_each(|r| r.fill(settings));
    rates
}

/// ω of both theories, λ₊ where there is one, and why there is none.
struct Frequencies {
    of: [Option<f64>; 2],
    growth: Option<f64>,
    bath: Option<Bath>,
    conserved: bool,
    refused: Vec<(Theory, Refusal)>,
}

fn frequencies(h: Evaluator, crossing: &Crossing, unstable: &Unstable, settings: &RateSettings) -> Frequencies {
    let top = crossing.saddle;
    let gyration = settings.gyration_per_s_mev();
    let mut refused = Vec::new();
    let conserved = conserved_moment(&h, &top.m, crossing.minima, settings);
    let growth = growth_rate(h, top, unstable, &gyration, settings.damping);
    let frequency = |theory: Theory| -> Option<f64> {
        if !settings.wants(theory) {
            return None;
        }
        if let Some(reason) = conserved.as_ref().filter(|_| theory == Theory::Htst || settings.damping == 0.0) {
            refused.push((theory, reason.clone()));
            return None;
        }
        let found = match theory {
            Theory::Htst => {
                let size = (-unstable.eigenvalue_mev).sqrt();
                Some(size * unstable.dynamical_factor(top, &gyration, crossing.spectrum.floor_mev))
            }
            Theory::Langer => growth,
        };
        let found = found.filter(|f| f.is_finite() && *f > 0.0);
        if found.is_none() {
            refused.push((theory, Refusal::NoFrequency));
        }
        found
    };
    let of = Theory::ALL.map(frequency);
    let bath = growth.map(|growth| {
        let falls = unstable.gyration(top, &gyration) * -unstable.eigenvalue_mev;
        let precession =
            (-unstable.eigenvalue_mev).sqrt() * unstable.dynamical_factor(top, &gyration, crossing.spectrum.floor_mev);
        let damping = settings.damping;
        Bath {
            damping,
            share: (precession / falls).min(1.0).sqrt(),
            precesses: growth * (1.0 + damping * damping) / (damping * falls),
            slides: false,
        }
    });
    Frequencies { of, growth, bath, conserved: conserved.is_some(), refused }
}

fn computed(
    h: Evaluator,
    number: usize,
    crossing: &Crossing,
    settings: &RateSettings,
    barriers: [f64; 2],
) -> Result<[SaddleRate; 2], Refusal> {
    if h.is_stopped() {
        return Err(Refusal::Stopped);
    }
    if let Some(reason) = unfit(crossing) {
        return Err(reason);
    }
    let unstable = unstable_mode(crossing.saddle, crossing.valley, &crossing.saddle.zeros).ok_or(Refusal::LostMode)?;
    let beside = Beside::new(h, crossing, unstable)?;
    let frequencies = frequencies(h, crossing, &beside.unstable, settings);
    let mut regimes = [Vec::new(), Vec::new()];
    for wells in beside.wells(barriers[0].max(barriers[1])) {
        let above_k = wells.above_mev / K_B;
        let both = match wells.found {
            Ok(found) => {
                let made = Made { h, crossing, settings, beside: &beside, frequencies: &frequencies, found: &found };
                made.regimes(above_k, barriers)
            }
            Err(reason) => [(); 2].map(|()| Regime::refused(above_k, settings, &reason)),
        };
        regimes.iter_mut().zip(both).for_each(|(all, regime)| all.push(regime));
    }
    let crossover_k = frequencies.growth.filter(|g| *g > 0.0 && !frequencies.conserved).map(crossover_temperature);
    let [forward, backward] = regimes;
    Ok([(0, forward), (1, backward)].map(|(side, regimes)| {
        let mut rate = SaddleRate {
            saddle: number,
            way: Way::BOTH[side],
            barrier_mev: Some(barriers[side]),
            regimes,
            crossover_k,
            rows: Vec::new(),
            blocking_k: [None, None],
            warnings: Vec::new(),
        };
        rate.warnings = warnings(settings, barriers[side], rate.at(settings.hottest_k()));
        rate.warnings.extend(of_cells(h.lattice()));
        rate
    }))
}

/// Of what the rates in a range of temperatures are made.
struct Made<'a> {
    h: Evaluator<'a>,
    crossing: &'a Crossing<'a>,
    settings: &'a RateSettings,
    beside: &'a Beside<'a>,
    frequencies: &'a Frequencies,
    found: &'a Found,
}

impl Made<'_> {
    /// Langer's λ₊ (rad/s), where it is asked for, and the bath: where the saddle slides along a turn, of what precesses past all of its
    /// places.
    fn over_the_saddle(&self) -> (Option<f64>, Option<Bath>) {
        let Frequencies { of: [_, langer], bath, .. } = *self.frequencies;
        let (Some(held), Some(turn)) = (langer, &self.found.saddle.turn) else { return (langer, bath) };
        let settings = self.settings;
        let gyration = settings.gyration_per_s_mev();
        match self.beside.growth_between_places(turn, &gyration, settings.damping) {
            Some(free) if free < held => (Some(free), bath.map(|bath| bath.sliding(held / free))),
            _ => (langer, bath),
        }
    }

    fn regimes(&self, above_k: f64, barriers: [f64; 2]) -> [Regime; 2] {
        let Made { h, found, beside, frequencies, .. } = self;
        let top = &found.saddle;
        let saddle = Fluctuations::of_saddle(h, &beside.states[0], &top.pinned, &beside.unstable);
        let vague = self.crossing.spectrum.floor_mev / -beside.unstable.eigenvalue_mev;
        let (langer, bath) = self.over_the_saddle();
        [0, 1].map(|side| {
            let bottom = match &found.minima[side] {
                Ok(bottom) => bottom,
                Err(reason) => return Regime::refused(above_k, self.settings, reason),
            };
            let entropy = 0.5 * (bottom.log_determinant - top.log_determinant);
            let ln_beyond = found.ln_beyond[side];
            let ln_number = if found.one_of[side] { ln_beyond } else { 0.0 };
            let volumes = top.ln_volume - bottom.ln_volume - ln_number;
            let prefactor = |frequency_per_s: f64| Prefactor {
                frequency_per_s,
                ln_hz: libm::log(frequency_per_s / (2.0 * PI)) + entropy + volumes,
                exponent: 0.5 * (bottom.count as f64 - top.count as f64),
                pinning: [top, bottom].map(|well| std::array::from_fn(|k| well.pinning.get(k).copied())),
            };
            let [htst, langer] = [frequencies.of[0], langer].map(|f| f.map(prefactor));
            let validity = Validity {
                barrier_mev: barriers[side],
                bath: langer.and(bath),
                ln_htst_over_langer: htst.zip(langer).map(|(h, l)| h.ln_hz - l.ln_hz),
                minimum: Fluctuations::of_minimum(h, &beside.states[1 + side], &bottom.pinned, &beside.unstable),
                saddle,
                vague,
                uneven: libm::hypot(top.uneven, bottom.uneven),
                cut: (ln_cut(&top.zeros) - ln_cut(&bottom.zeros)).abs(),
            };
            let beyond = found.minima[1 - side].as_ref().map_or(0.0, |other| other.ln_places);
            Regime {
                above_k,
                htst,
                langer,
                entropy_factor: Some(entropy),
                minimum_zeros: bottom.zeros.clone(),
                saddle_zeros: top.zeros.clone(),
                equivalents: found.equivalents.clone(),
                siblings: found.siblings.clone(),
                ln_places: bottom.ln_places - top.ln_places + ln_number,
                ln_targets: (beyond - bottom.ln_places - ln_number).max(0.0),
                ln_beyond,
                turn: found.turn,
                validity: htst.or(langer).map(|_| validity),
                refused: frequencies.refused.clone(),
            }
        })
    }
}
