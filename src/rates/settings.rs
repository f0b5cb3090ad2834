//! What rates are asked for.

use crate::error::{Error, Result};
use crate::units::{HBAR, Temperature};
use crate::words::number;
use serde::{Deserialize, Serialize};

/// Lowest and highest temperature that are taken for meant (K).
const COLDEST_K: f64 = 1e-9;
const HOTTEST_K: f64 = 1e9;

/// A theory of rates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Theory {
    /// Harmonic transition-state theory, without damping.
    Htst,
    /// Langer's theory, with damping.
    Langer,
}

impl Theory {
    /// All of them.
    pub const ALL: [Theory; 2] = [Theory::Htst, Theory::Langer];

    /// Its name in configs and results.
    pub fn name(self) -> &'static str {
        match self {
            Theory::Htst => "htst",
            Theory::Langer => "langer",
        }
    }
}

/// Temperatures, dynamics and theories.
#[derive(Clone, Debug, PartialEq)]
pub struct RateSettings {
    /// Temperatures (K), greater than 0.
    pub temperatures_k: Vec<f64>,
    /// Gilbert damping α.
    pub damping: f64,
    /// g factor: γ = g μ_B/ħ.
    pub g_factor: f64,
    /// Which theories.
    pub theories: Vec<Theory>,
    /// Moment of each site (μ_B), greater than 0.
    pub moments_mub: Vec<f64>,
}

impl RateSettings {
    /// An error where there are no rates of such settings for so many sites.
    pub fn check(&self, sites: usize) -> Result<()> {
        let at = |place: &str, found: std::result::Result<(), String>| found.map_err(|m| Error::invalid(place, m));
        for (k, t) in self.temperatures_k.iter().enumerate() {
            at(&format!("temperatures_k[{k}]"), checked_temperature(Temperature(*t)).map(drop))?;
        }
        at("damping", checked_damping(self.damping).map(drop))?;
        at("g_factor", checked_g_factor(self.g_factor).map(drop))?;
        let moments = &self.moments_mub;
        if moments.len() != sites {
            return at("moments_mub", Err(format!("found {} of {sites} sites", moments.len())));
        }
        let none = moments.iter().position(|n| !(n.is_finite() && *n > 0.0));
        none.map_or(Ok(()), |i| {
            at(
                &format!("moments_mub[{i}]"),
                Err(format!("found {}, but a moment is greater than 0", number(moments[i]))),
            )
        })
    }

    /// γ/μ of each site in rad/s per meV: g/(ħ n) for n Bohr magnetons.
    pub fn gyration_per_s_mev(&self) -> Vec<f64> {
        self.moments_mub.iter().map(|n| 1e12 * self.g_factor / (HBAR * n)).collect()
    }

    /// The first temperature (K); 0 where there is none.
    pub fn first_k(&self) -> f64 {
        self.temperatures_k.first().copied().unwrap_or(0.0)
    }

    /// The highest temperature (K).
    pub fn hottest_k(&self) -> f64 {
        self.temperatures_k.iter().copied().fold(0.0, f64::max)
    }

    /// The lowest temperature (K).
    pub fn coldest_k(&self) -> f64 {
        self.temperatures_k.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// Whether a theory is asked for.
    pub fn wants(&self, theory: Theory) -> bool {
        self.theories.contains(&theory)
    }
}

/// The damping, if it can be one.
pub fn checked_damping(x: f64) -> std::result::Result<f64, String> {
    match x.is_finite() && x >= 0.0 {
        true => Ok(x),
        false => Err(format!("found {}, but a damping is 0 or greater, such as 0.1", number(x))),
    }
}

/// The g factor, if it can be one.
pub fn checked_g_factor(x: f64) -> std::result::Result<f64, String> {
    match x.is_finite() && x > 0.0 {
        true => Ok(x),
        false => Err(format!("found {}, but a g factor is greater than 0, such as 2.0", number(x))),
    }
}

/// A temperature that a rate can have.
pub fn checked_temperature(t: Temperature) -> std::result::Result<Temperature, String> {
    match (COLDEST_K..=HOTTEST_K).contains(&t.0) {
        true => Ok(t),
        false => {
            Err(format!("found {t}, but a temperature here is {COLDEST_K:e} K at least and {HOTTEST_K:e} K at most"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_moment_of_one_bohr_magneton_with_g_of_2_precesses_with_28_ghz_in_a_tesla() {
        let settings = RateSettings {
            temperatures_k: vec![300.0],
            damping: 0.1,
            g_factor: 2.0,
            theories: Theory::ALL.to_vec(),
            moments_mub: vec![1.0, 2.0],
        };
        let [one, two] = settings.gyration_per_s_mev()[..] else { panic!("two sites") };
        // 2 μ_B/h = 27.992 GHz/T
        let ghz = one * crate::units::MU_B_MEV_PER_T / (2.0 * std::f64::consts::PI) * 1e-9;
        assert!((ghz - 27.9925).abs() < 1e-3, "{ghz}");
        assert_eq!(two, 0.5 * one);
    }
}
