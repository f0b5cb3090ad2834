//! The rates over one saddle, forward and backward.

use super::determinant::PinnedHessian;
use super::passage::{TEN_YEARS_S, blocking_temperature};
use super::refusal::{conserved_moment, unfit};
use super::validity::{Fluctuations, warnings};
use super::zero_modes::ZeroMode;
use super::{
    Equivalents, RateSettings, Theory, Unstable, ZeroKind, equivalent_saddles, growth_rate, unstable_mode, zero_modes,
};
use crate::energy::Hamiltonian;
use crate::saddle::{Spectrum, State};
use crate::spins::Spins;
use crate::units::K_B;
use std::f64::consts::PI;

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
    /// What stands against its certificate; nothing if it has one.
    pub doubt: Option<&'a str>,
}

/// A direction along the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
    /// It grows as T to this power.
    pub exponent: f64,
}

impl Prefactor {
    /// ln of the prefactor in Hz at a temperature (K).
    pub fn ln_hz_at(&self, temperature_k: f64) -> f64 {
        match self.exponent {
            0.0 => self.ln_hz,
            e => self.ln_hz + e * libm::log(2.0 * PI * K_B * temperature_k),
        }
    }

    /// The prefactor in Hz at a temperature (K).
    pub fn hz_at(&self, temperature_k: f64) -> f64 {
        libm::exp(self.ln_hz_at(temperature_k))
    }
}

/// Rates at one temperature, as logarithms: a lifetime may exceed what a double holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Temperature (K).
    pub temperature_k: f64,
    /// Δ = ΔE/k_BT; over several saddles that of the highest.
    pub barrier_over_kt: f64,
    /// ln of the rate in 1/s by HTST.
    pub ln_htst_per_s: Option<f64>,
    /// ln of the rate in 1/s by Langer.
    pub ln_langer_per_s: Option<f64>,
}

impl Row {
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
    /// Zero modes of the minimum: kind, number, volume (rad to that number).
    pub minimum_zeros: Vec<(ZeroKind, usize, f64)>,
    /// Zero modes of the saddle, likewise.
    pub saddle_zeros: Vec<(ZeroKind, usize, f64)>,
    /// Saddles of the same kind out of the same minimum; the rates are over all of them.
    pub equivalents: Equivalents,
    /// One row a temperature.
    pub rows: Vec<Row>,
    /// Temperature (K) at which the mean lifetime is 1 s, and at which it is ten years.
    pub blocking_k: [Option<f64>; 2],
    /// Theories that give no rate here, and why.
    pub refused: Vec<(Theory, String)>,
    /// Where the numbers are rough.
    pub warnings: Vec<String>,
}

impl SaddleRate {
    /// ln of the rate in 1/s by a theory at a temperature (K), over all equivalent saddles.
    pub fn ln_rate_per_s(&self, theory: Theory, temperature_k: f64) -> Option<f64> {
        let prefactor = match theory {
            Theory::Htst => self.htst,
            Theory::Langer => self.langer,
        }?;
        let many = libm::log(self.equivalents.count as f64);
        Some(prefactor.ln_hz_at(temperature_k) + many - self.barrier_mev? / (K_B * temperature_k))
    }

    fn fill(&mut self, settings: &RateSettings) {
        let row = |t: f64| Row {
            temperature_k: t,
            barrier_over_kt: self.barrier_mev.map_or(0.0, |e| e / (K_B * t)),
            ln_htst_per_s: self.ln_rate_per_s(Theory::Htst, t),
            ln_langer_per_s: self.ln_rate_per_s(Theory::Langer, t),
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

/// A saddle without rates, in both directions, and the reason.
pub fn refused(
    saddle: usize,
    settings: &RateSettings,
    barriers_mev: [Option<f64>; 2],
    reason: &str,
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
        rows: Vec::new(),
        blocking_k: [None, None],
        refused: settings.theories.iter().map(|t| (*t, reason.to_string())).collect(),
        warnings: Vec::new(),
    })
}

/// The rates over a saddle, forward and backward.
pub fn saddle_rates(h: &Hamiltonian, number: usize, crossing: &Crossing, settings: &RateSettings) -> [SaddleRate; 2] {
    let barriers = crossing.minima.map(|m| h.difference_mev(&crossing.saddle.m, m.as_slice()));
    let mut rates = match computed(h, number, crossing, settings, barriers) {
        Ok(rates) => rates,
        Err(reason) => refused(number, settings, barriers.map(Some), &reason),
    };
    rates.iter_mut().for_each(|r| r.fill(settings));
    rates
}

/// A stationary state, ready for its partition function.
struct Well {
    state: State,
    zeros: Vec<ZeroMode>,
    /// The descending mode of a saddle.
    unstable: Option<Unstable>,
    pinned: PinnedHessian,
}

impl Well {
    fn new(
        h: &Hamiltonian,
        state: State,
        settings: &RateSettings,
        spectrum: &Spectrum,
        valley: Option<&[f64]>,
    ) -> Result<Well, String> {
        let thermal_mev = K_B * settings.temperatures_k.iter().copied().fold(f64::INFINITY, f64::min);
        let zeros = zero_modes(h, &state, &settings.moments_mub, spectrum.flat, spectrum.floor_mev, thermal_mev)?;
        let directions: Vec<Vec<f64>> = zeros.iter().flat_map(|z| z.modes.clone()).collect();
        let unstable = match valley {
            None => None,
            Some(valley) => {
                Some(unstable_mode(&state, valley, &directions).ok_or("a descending mode that could not be computed")?)
            }
        };
        let pinned = PinnedHessian::new(&state.hessian, &directions, unstable.as_ref(), h.stiffness_mev() / 3.0);
        Ok(Well { state, zeros, unstable, pinned })
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
        self.zeros.iter().map(|z| libm::log(z.volume)).sum()
    }

    fn listed(&self) -> Vec<(ZeroKind, usize, f64)> {
        self.zeros.iter().map(|z| (z.kind, z.modes.len(), z.volume)).collect()
    }
}

fn computed(
    h: &Hamiltonian,
    number: usize,
    crossing: &Crossing,
    settings: &RateSettings,
    barriers: [f64; 2],
) -> Result<[SaddleRate; 2], String> {
    if let Some(reason) = unfit(crossing) {
        return Err(reason);
    }
    let top = Well::new(h, crossing.saddle.clone(), settings, crossing.spectrum, Some(crossing.valley))
        .map_err(|e| format!("the saddle has {e}"))?;
    let well = |side: usize| {
        let state = State::at(h, crossing.minima[side].as_slice().to_vec());
        Well::new(h, state, settings, crossing.minima_spectra[side], None)
            .map_err(|e| format!("the minimum {} it has {e}", ["before", "after"][side]))
    };
    let wells = [well(0)?, well(1)?];
    let Some(unstable) = top.unstable.clone() else {
        return Err("the saddle has no descending mode".into());
    };
    let gyration = settings.gyration_per_s_mev();
    let mut refusals = Vec::new();
    let conserved = conserved_moment(h, &top.state.m, crossing.minima, settings);
    let mut frequency = |theory: Theory| -> Option<f64> {
        if !settings.wants(theory) {
            return None;
        }
        if let Some(reason) = conserved.as_ref().filter(|_| theory == Theory::Htst || settings.damping == 0.0) {
            refusals.push((theory, reason.clone()));
            return None;
        }
        if theory == Theory::Langer && h.long_range().is_some() && h.sites() > MOST_DENSE {
            let reason =
                format!("where every spin acts on every other it takes a dense matrix, of {MOST_DENSE} sites at most");
            refusals.push((theory, reason));
            return None;
        }
        let found = match theory {
            Theory::Htst => {
                let size = (-unstable.eigenvalue_mev).sqrt();
                Some(size * unstable.dynamical_factor(&top.state, &gyration))
            }
            Theory::Langer => growth_rate(h, &top.state, &unstable, &gyration, settings.damping),
        };
        let found = found.filter(|f| f.is_finite() && *f > 0.0);
        if found.is_none() {
            let reason =
                "the crossing has no frequency that can be told from zero: the spins do not precess across the saddle";
            refusals.push((theory, reason.into()));
        }
        found
    };
    let frequencies = Theory::ALL.map(&mut frequency);
    let translating = top.zeros.iter().any(|z| z.kind == ZeroKind::Translation);
    let minima = crossing.minima.map(|m| m.as_slice());
    let equivalents = equivalent_saddles(h, &top.state.m, minima, &settings.moments_mub, translating);
    let spread_top = Fluctuations::of_saddle(h, &top.state, &top.pinned, &unstable);
    let vague = crossing.spectrum.floor_mev / -unstable.eigenvalue_mev;
    Ok([0, 1].map(|side| {
        let bottom = &wells[side];
        let entropy = 0.5 * (bottom.log_determinant() - top.log_determinant());
        let exponent = 0.5 * (bottom.count() as f64 - top.count() as f64);
        let volumes = top.ln_volume() - bottom.ln_volume();
        let prefactor = |frequency_per_s: f64| Prefactor {
            frequency_per_s,
            ln_hz: libm::log(frequency_per_s / (2.0 * PI)) + entropy + volumes,
            exponent,
        };
        let [htst, langer] = frequencies.map(|f| f.map(prefactor));
        let spread = Fluctuations::of_minimum(h, &bottom.state, &bottom.pinned, &unstable);
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
            rows: Vec::new(),
            blocking_k: [None, None],
            refused: refusals.clone(),
            warnings: warnings(settings, barriers[side], [htst, langer], &spread, &spread_top, vague),
        }
    }))
}
