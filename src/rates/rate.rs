//! The rates over one saddle, forward and backward.

use super::determinant::PinnedHessian;
use super::passage::{TEN_YEARS_S, blocking_temperature};
use super::refusal::{conserved_moment, no_minimum, unfit};
use super::sliding::{Sliding, ln_pinned};
use super::symmetry::{free_shifts, places, states_on_the_way};
use super::validity::{Fluctuations, Validity, warnings};
use super::zero_modes::ZeroMode;
use super::{
    Equivalents, RateSettings, Refusal, Theory, Unstable, ZeroKind, ZeroModes, crossover_temperature,
    equivalent_saddles, growth_rate, unstable_mode, zero_modes,
};
use crate::energy::Evaluator;
use crate::spins::Spins;
use crate::stationary::{Spectrum, State};
use crate::symmetry::Group;
use crate::units::K_B;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Below so many k_BT a barrier holds nothing back, and there is no rate over it.
pub const LEAST_BARRIER: f64 = 1.0;

/// Most sites of a chain with a long-ranged term for Langer's theory, whose matrix is then dense.
const MOST_DENSE: usize = 1000;

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
    /// The symmetry of the energy and the moments.
    pub group: &'a Group,
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
    /// It grows as T to this power, soft translations apart.
    pub exponent: f64,
    /// By how much soft translations of the saddle and of the minimum are pinned (meV), 0 where there are none.
    pub pinning_mev: [[f64; 3]; 2],
}

impl Prefactor {
    /// ln of the prefactor in Hz at a temperature (K).
    pub fn ln_hz_at(&self, temperature_k: f64) -> f64 {
        let free = match self.exponent {
            0.0 => self.ln_hz,
            e => self.ln_hz + e * libm::log(2.0 * PI * K_B * temperature_k),
        };
        let pinned = |mev: &f64| if *mev > 0.0 { ln_pinned(*mev, K_B * temperature_k) } else { 0.0 };
        let [saddle, minimum] = self.pinning_mev.each_ref().map(|all| all.iter().map(pinned).sum::<f64>());
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

/// The rates over one saddle in one direction, and what they are made of.
#[derive(Clone, Debug, PartialEq)]
pub struct SaddleRate {
    /// Which saddle, counted along the path.
    pub saddle: usize,
    /// In which direction.
    pub way: Way,
    /// Saddle above the minimum (meV).
    pub barrier_mev: Option<f64>,
    /// HTST, if asked for and not refused.
    pub htst: Option<Prefactor>,
    /// Langer, if asked for and not refused.
    pub langer: Option<Prefactor>,
    /// ½ ln(det'H_m/|det'H_s|), energies in meV.
    pub entropy_factor: Option<f64>,
    /// Zero modes of the minimum.
    pub minimum_zeros: Vec<ZeroModes>,
    /// Zero modes of the saddle.
    pub saddle_zeros: Vec<ZeroModes>,
    /// Saddles of the same kind out of the same minimum; the rates are over all of them. Where something slides, the places of
    /// a minimum are one state, which is left over the saddles at all places.
    pub equivalents: Equivalents,
    /// Where something slides: ln of the states of the minimum that are places of one over those of the saddle.
    pub ln_places: f64,
    /// Temperature (K) below which tunnelling takes over, see [`crossover_temperature`]; nothing where the spins do not precess
    /// over the saddle.
    pub crossover_k: Option<f64>,
    /// What the errors hang on, where there is a rate.
    pub validity: Option<Validity>,
    /// One row a temperature.
    pub rows: Vec<Row>,
    /// Temperature (K) at which the mean lifetime is 1 s, and at which it is ten years.
    pub blocking_k: [Option<f64>; 2],
    /// Theories that give no rate here, and why.
    pub refused: Vec<(Theory, Refusal)>,
    /// Where the numbers are rough.
    pub warnings: Vec<String>,
}

impl SaddleRate {
    /// ln of the rate in 1/s by a theory at a temperature (K), over all equivalent saddles; what the formula gives, however low the
    /// barrier.
    pub fn ln_rate_per_s(&self, theory: Theory, temperature_k: f64) -> Option<f64> {
        let prefactor = match theory {
            Theory::Htst => self.htst,
            Theory::Langer => self.langer,
        }?;
        let many = libm::log(self.equivalents.count as f64);
        Some(prefactor.ln_hz_at(temperature_k) + many - self.barrier_mev? / (K_B * temperature_k))
    }

    /// ln of the rate in 1/s by a theory at a temperature (K) over one of the equivalent saddles alone, out of one place of the minimum.
    pub fn ln_rate_of_one_per_s(&self, theory: Theory, temperature_k: f64) -> Option<f64> {
        let all = self.ln_rate_per_s(theory, temperature_k)?;
        Some(all - libm::log(self.equivalents.count as f64) + self.ln_places)
    }

    /// Whether what is on both sides of the saddle slides, and the saddle holds it on neither side: two places of one state, whose integral
    /// over the valley each side has in full already. `back`: the rate over the same saddle from its other side; a temperature (K).
    pub fn is_within_one(&self, back: &SaddleRate, temperature_k: f64) -> bool {
        [self, back].iter().all(|side| {
            let slides = side.minimum_zeros.iter().any(|zeros| zeros.kind == ZeroKind::Translation);
            slides && side.barrier_mev.is_some_and(|barrier| barrier < LEAST_BARRIER * K_B * temperature_k)
        })
    }

    /// ln of the factor within which the rate is known at a temperature (K).
    pub fn ln_known_within(&self, temperature_k: f64) -> f64 {
        self.validity.map_or(f64::INFINITY, |v| v.ln_factor(temperature_k))
    }

    fn fill(&mut self, settings: &RateSettings) {
        let row = |t: f64| {
            let all = Row {
                temperature_k: t,
                barrier_over_kt: self.barrier_mev.map_or(0.0, |e| e / (K_B * t)),
                ln_htst_per_s: self.ln_rate_per_s(Theory::Htst, t),
                ln_langer_per_s: self.ln_rate_per_s(Theory::Langer, t),
                known_within: factor(self.ln_known_within(t)),
                reason: None,
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
        htst: None,
        langer: None,
        entropy_factor: None,
        minimum_zeros: Vec::new(),
        saddle_zeros: Vec::new(),
        equivalents: Equivalents { count: 1, by: "not sought".into() },
        ln_places: 0.0,
        crossover_k: None,
        validity: None,
        rows: Vec::new(),
        blocking_k: [None, None],
        refused: settings.theories.iter().map(|t| (*t, reason.clone())).collect(),
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

/// A stationary state, and how it slides.
struct Place<'a> {
    state: State,
    spectrum: &'a Spectrum,
    /// The descending mode of a saddle.
    unstable: Option<Unstable>,
    sliding: Sliding,
    name: &'static str,
}

/// A stationary state, ready for its partition function.
struct Well {
    state: State,
    zeros: Vec<ZeroMode>,
    /// The descending mode of a saddle.
    unstable: Option<Unstable>,
    pinned: PinnedHessian,
    /// Where anything slides: ln of its places, if it does not slide itself.
    ln_kept: f64,
    /// Where anything slides: ln of the states alike that are its places.
    ln_places: f64,
}

impl Well {
    /// Of a place, where so many times each shift is free, if anything slides.
    fn new(h: Evaluator, place: Place, group: &Group, free: Option<&[usize]>) -> Result<Well, Refusal> {
        let Place { state, spectrum, unstable, sliding, name } = place;
        let held = free.filter(|_| !sliding.slides()).map_or(1, |steps| places(group, &state.m, steps));
        let alike = match free {
            Some(steps) if sliding.slides() => states_on_the_way(h.lattice(), group, &state.m, steps),
            _ => held,
        };
        let steps = free.unwrap_or(&[]);
        let count = if sliding.slides() { places(group, &state.m, steps) } else { 1 };
        let zeros = zero_modes(&h, &state, &sliding.with_places(count), spectrum)
            .map_err(|unknown| Refusal::Volume(name, unknown))?;
        let directions: Vec<Vec<f64>> = zeros.iter().flat_map(|z| z.modes.clone()).collect();
        let pinned = PinnedHessian::new(&state.hessian, &directions, unstable.as_ref(), h.stiffness_mev() / 3.0);
        let [ln_kept, ln_places] = [held, alike].map(|n| libm::log(n as f64));
        Ok(Well { state, zeros, unstable, pinned, ln_kept, ln_places })
    }

    /// ln|det'H|, the descending mode's |λ₁| included.
    fn log_determinant(&self) -> f64 {
        let own = self.unstable.as_ref().map_or(0.0, |u| libm::log(-u.eigenvalue_mev));
        self.pinned.log_determinant() + own
    }

    fn count(&self) -> usize {
        self.zeros.iter().map(|z| z.modes.len()).sum()
    }

    fn ln_volume(&self) -> f64 {
        self.zeros.iter().map(|z| libm::log(z.said.volume)).sum::<f64>() + self.ln_kept
    }

    fn listed(&self) -> Vec<ZeroModes> {
        self.zeros.iter().map(|z| z.said.clone()).collect()
    }

    /// By how much its soft translations are pinned (meV).
    fn pinning_mev(&self) -> [f64; 3] {
        let all: Vec<f64> = self.zeros.iter().flat_map(|z| z.said.pinning_mev.iter().copied()).collect();
        [0, 1, 2].map(|k| all.get(k).copied().unwrap_or(0.0))
    }
}

/// A crossing, ready for its rates.
struct Prepared {
    top: Well,
    unstable: Unstable,
    wells: [Well; 2],
    /// Whether the saddle and each minimum slide.
    sliding: [bool; 3],
}

fn prepared(h: Evaluator, crossing: &Crossing, settings: &RateSettings) -> Result<Prepared, Refusal> {
    if let Some(reason) = unfit(crossing) {
        return Err(reason);
    }
    let (group, hottest) = (crossing.group, settings.temperatures_k.iter().copied().fold(0.0, f64::max));
    let place = |state: State, unstable: Option<Unstable>, spectrum, name, free: &[bool]| {
        let sliding = Sliding::of(h, &state, unstable.as_ref(), group, free, hottest);
        Ok(Place {
            sliding: sliding.map_err(|unknown| Refusal::Volume(name, unknown))?,
            state,
            spectrum,
            unstable,
            name,
        })
    };
    let unstable = unstable_mode(crossing.saddle, crossing.valley, &crossing.saddle.zeros).ok_or(Refusal::LostMode)?;
    let minimum = |side: usize, free: &[bool]| {
        let (state, spectrum) =
            (State::at(h, crossing.minima[side].as_slice().to_vec()), crossing.minima_spectra[side]);
        if let Some(reason) = no_minimum(spectrum, state.max_torque_mev(), ["before", "after"][side]) {
            return Err(reason);
        }
        place(state, None, spectrum, ["the minimum before it", "the minimum after it"][side], free)
    };
    let mut free = vec![true; group.shifts().len()];
    let (minima, steps) = loop {
        let minima = [minimum(0, &free)?, minimum(1, &free)?];
        let slide = minima.each_ref().map(|minimum| minimum.sliding.slides());
        let steps = free_shifts(group, crossing.minima.map(|m| m.as_slice()), slide);
        // a shift that does not keep both leads to a saddle between other minima
        let keep: Vec<bool> = steps.iter().zip(&free).map(|(steps, free)| *free && *steps == 1).collect();
        let settled = keep == free || !slide.contains(&true);
        free = keep;
        if settled {
            break (minima, steps);
        }
    };
    let top = place(crossing.saddle.clone(), Some(unstable.clone()), crossing.spectrum, "the saddle", &free)?;
    let sliding = [top.sliding.slides(), minima[0].sliding.slides(), minima[1].sliding.slides()];
    let free = Some(&steps[..]).filter(|_| sliding.contains(&true));
    let top = Well::new(h, top, group, free)?;
    let [before, after] = minima;
    let wells = [Well::new(h, before, group, free)?, Well::new(h, after, group, free)?];
    Ok(Prepared { top, unstable, wells, sliding })
}

/// ω of both theories, λ₊ where there is one, and why there is none.
struct Frequencies {
    of: [Option<f64>; 2],
    growth: Option<f64>,
    conserved: bool,
    refused: Vec<(Theory, Refusal)>,
}

fn frequencies(h: Evaluator, crossing: &Crossing, prepared: &Prepared, settings: &RateSettings) -> Frequencies {
    let Prepared { top, unstable, .. } = prepared;
    let gyration = settings.gyration_per_s_mev();
    let mut refused = Vec::new();
    let conserved = conserved_moment(&h, &top.state.m, crossing.minima, settings);
    let dense = h.coupling().pairs().is_some() && h.sites() > MOST_DENSE;
    let growth = match dense {
        true => None,
        false => growth_rate(&h, &top.state, unstable, &gyration, settings.damping),
    };
    let frequency = |theory: Theory| -> Option<f64> {
        if !settings.wants(theory) {
            return None;
        }
        if let Some(reason) = conserved.as_ref().filter(|_| theory == Theory::Htst || settings.damping == 0.0) {
            refused.push((theory, reason.clone()));
            return None;
        }
        if theory == Theory::Langer && dense {
            refused.push((theory, Refusal::Dense(MOST_DENSE)));
            return None;
        }
        let found = match theory {
            Theory::Htst => {
                let size = (-unstable.eigenvalue_mev).sqrt();
                Some(size * unstable.dynamical_factor(&top.state, &gyration))
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
    Frequencies { of, growth, conserved: conserved.is_some(), refused }
}

fn computed(
    h: Evaluator,
    number: usize,
    crossing: &Crossing,
    settings: &RateSettings,
    barriers: [f64; 2],
) -> Result<[SaddleRate; 2], Refusal> {
    let prepared = prepared(h, crossing, settings)?;
    let found = frequencies(h, crossing, &prepared, settings);
    let Prepared { top, unstable, wells, sliding } = &prepared;
    let minima = crossing.minima.map(|m| m.as_slice());
    let equivalents = equivalent_saddles(h.lattice(), crossing.group, &top.state.m, minima, *sliding);
    let spread_top = Fluctuations::of_saddle(&h, &top.state, &top.pinned, unstable);
    let vague = crossing.spectrum.floor_mev / -unstable.eigenvalue_mev;
    let crossover_k = found.growth.filter(|g| *g > 0.0 && !found.conserved).map(crossover_temperature);
    Ok([0, 1].map(|side| {
        let bottom = &wells[side];
        let entropy = 0.5 * (bottom.log_determinant() - top.log_determinant());
        let exponent = 0.5 * (bottom.count() as f64 - top.count() as f64);
        let volumes = top.ln_volume() - bottom.ln_volume();
        let prefactor = |frequency_per_s: f64| Prefactor {
            frequency_per_s,
            ln_hz: libm::log(frequency_per_s / (2.0 * PI)) + entropy + volumes,
            exponent,
            pinning_mev: [top.pinning_mev(), bottom.pinning_mev()],
        };
        let [htst, langer] = found.of.map(|f| f.map(prefactor));
        let spread = Fluctuations::of_minimum(&h, &bottom.state, &bottom.pinned, unstable);
        let validity = Validity {
            barrier_mev: barriers[side],
            damping: langer.map(|_| settings.damping),
            ln_htst_over_langer: htst.zip(langer).map(|(h, l)| h.ln_hz - l.ln_hz),
            minimum: spread,
            saddle: spread_top,
            vague,
        };
        SaddleRate {
            saddle: number,
            way: Way::BOTH[side],
            barrier_mev: Some(barriers[side]),
            htst,
            langer,
            entropy_factor: Some(entropy),
            minimum_zeros: bottom.listed(),
            saddle_zeros: top.listed(),
            equivalents: equivalents.clone(),
            ln_places: bottom.ln_places - top.ln_places,
            crossover_k,
            validity: htst.or(langer).map(|_| validity),
            rows: Vec::new(),
            blocking_k: [None, None],
            refused: found.refused.clone(),
            warnings: warnings(settings, barriers[side], [htst, langer], &spread, &spread_top, vague),
        }
    }))
}
