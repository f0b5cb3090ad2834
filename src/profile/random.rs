//! Values drawn from a distribution, the same ones for the same seed on every machine.
//!
//! ```text
//! normal       mean + σ g                 g normal with deviation 1 (Box and Muller, Ann. Math. Stat. 29, 610 (1958))
//! uniform      mean + σ √3 (2u − 1)       u even between 0 and 1: from mean − √3 σ to mean + √3 σ
//! log_normal   mean exp(s g − s²/2)       s² = ln(1 + (σ/mean)²): of the sign of the mean
//! ```
//! All three have this mean and the standard deviation σ. With `length` that many neighbours of a chain, or a cube of so
//! many spacings a side, a grain, share one draw. The draw of grain k is block k of the ChaCha8 stream of the seed: profiles with one
//! seed vary together, whatever they are.

use crate::error::{Error, Result};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::{self, Deserialize, Deserializer};
use std::borrow::Cow;
use std::f64::consts::TAU;

/// Words of a block of ChaCha.
const BLOCK: u128 = 16;

/// `{"mean": "0.5 meV", "relative_deviation": 0.1, "seed": 1}`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Random<T> {
    /// Mean of the distribution.
    pub mean: T,
    /// Its standard deviation σ.
    pub deviation: Deviation<T>,
    /// Its kind.
    pub distribution: Distribution,
    /// Seed of the generator.
    pub seed: u64,
    /// How many neighbours share one draw: of a chain, or of each side of a cube.
    pub length: usize,
}

/// A standard deviation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Deviation<T> {
    /// As such.
    Absolute(T),
    /// As a share of the mean.
    Relative(f64),
}

/// Kinds of distributions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Distribution {
    /// Gaussian.
    #[default]
    Normal,
    /// Even between two bounds.
    Uniform,
    /// The logarithm is Gaussian.
    LogNormal,
}

/// Values drawn from a distribution, for each site or bond, or for grains of them.
#[derive(serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, bound(deserialize = "T: Deserialize<'de>"))]
struct Written<T> {
    /// Mean of the distribution.
    mean: T,
    /// Its standard deviation.
    #[serde(default)]
    deviation: Option<T>,
    /// Its standard deviation as a share of the mean, in place of the deviation.
    #[serde(default)]
    #[schemars(range(min = 0))]
    relative_deviation: Option<f64>,
    /// Its kind.
    #[serde(default)]
    distribution: Distribution,
    /// Seed of the generator.
    seed: u64,
    /// How many neighbours of a chain share one draw, elsewhere those of a cube with so many spacings a side; 1 if absent.
    #[serde(default)]
    #[schemars(range(min = 1))]
    length: Option<usize>,
}

impl<T: JsonSchema> JsonSchema for Random<T> {
    fn schema_name() -> Cow<'static, str> {
        format!("Random_of_{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        Written::<T>::json_schema(generator)
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Random<T> {
    fn deserialize<D: Deserializer<'de>>(d: D) -> std::result::Result<Self, D::Error> {
        let Written { mean, deviation, relative_deviation, distribution, seed, length } = Written::deserialize(d)?;
        let deviation = match (deviation, relative_deviation) {
            (Some(sigma), None) => Deviation::Absolute(sigma),
            (None, Some(share)) if share.is_finite() && share >= 0.0 => Deviation::Relative(share),
            (None, Some(share)) => {
                return Err(de::Error::custom(format!(
                    "found a relative_deviation of {share}, but a deviation is 0 or more"
                )));
            }
            _ => {
                let message = "a random profile has a \"relative_deviation\" (0.1) or a \"deviation\" with a unit: give one of the two";
                return Err(de::Error::custom(message));
            }
        };
        match length {
            Some(0) => Err(de::Error::custom("found a length of 0, but a grain has 1 or more sites")),
            _ => Ok(Random { mean, deviation, distribution, seed, length: length.unwrap_or(1) }),
        }
    }
}

impl<T: Copy> Random<T> {
    /// The value of a grain, from the numbers that `convert` makes of mean and deviation.
    pub(super) fn value(&self, grain: usize, convert: impl Fn(T) -> Result<f64>) -> Result<f64> {
        let mean = convert(self.mean).map_err(|e| e.within("random.mean"))?;
        let sigma = match self.deviation {
            Deviation::Absolute(sigma) => convert(sigma).map_err(|e| e.within("random.deviation"))?,
            Deviation::Relative(share) => share * mean.abs(),
        };
        if !(sigma.is_finite() && sigma >= 0.0) {
            return Err(Error::invalid("random.deviation", "found a negative value, but a deviation is 0 or more"));
        }
        let [u, v] = self.draw(grain);
        let normal = || (-2.0 * libm::log(u)).sqrt() * libm::cos(TAU * v);
        Ok(match self.distribution {
            Distribution::Normal => mean + sigma * normal(),
            Distribution::Uniform => mean + sigma * 3f64.sqrt() * (2.0 * u - 1.0),
            Distribution::LogNormal if mean == 0.0 => {
                let message = "found 0, but the logarithm of a log_normal quantity needs a mean other than 0";
                return Err(Error::invalid("random.mean", message));
            }
            Distribution::LogNormal => {
                let s2 = libm::log1p((sigma / mean).powi(2));
                mean * libm::exp(s2.sqrt() * normal() - 0.5 * s2)
            }
        })
    }

    /// Two numbers even between 0 and 1, neither of them 0 or 1.
    fn draw(&self, grain: usize) -> [f64; 2] {
        let mut stream = ChaCha8Rng::seed_from_u64(self.seed);
        stream.set_word_pos(BLOCK * grain as u128);
        let mut even = || ((stream.next_u64() >> 12) as f64 + 0.5) / (1u64 << 52) as f64;
        [even(), even()]
    }
}

#[cfg(test)]
mod tests {
    use crate::error::{Error, Result};
    use crate::profile::Profile;
    use crate::units::{Energy, Length};

    fn read(text: &str, count: usize) -> Result<Vec<f64>> {
        let profile: Profile<Energy> = serde_json::from_str(text).map_err(|e| Error::Numerical(e.to_string()))?;
        profile.values(count, "site", |e, _| Ok(e.0))
    }

    fn moments(values: &[f64]) -> (f64, f64) {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        (mean, (values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n).sqrt())
    }

    #[test]
    fn every_distribution_has_the_mean_and_the_deviation_that_it_is_given() {
        for kind in ["normal", "uniform", "log_normal"] {
            for given in [r#""relative_deviation": 0.1"#, r#""deviation": "50 ueV""#] {
                let text =
                    format!(r#"{{"random": {{"mean": "0.5 meV", {given}, "distribution": "{kind}", "seed": 3}}}}"#);
                let values = read(&text, 100_000).unwrap();
                let (mean, deviation) = moments(&values);
                assert!((mean - 0.5).abs() < 6e-4 && (deviation - 0.05).abs() < 4e-4, "{kind}: {mean} {deviation}");
                let far = values.iter().filter(|x| (*x - 0.5f64).abs() > 0.05 * 3f64.sqrt()).count();
                assert_eq!(far > 0, kind != "uniform", "{kind}");
            }
        }
        let wide =
            r#"{"random": {"mean": "-2 meV", "relative_deviation": 3, "distribution": "log_normal", "seed": 3}}"#;
        assert!(read(wide, 10_000).unwrap().iter().all(|x| *x < 0.0));
    }

    #[test]
    fn the_same_seed_gives_the_same_values_and_another_seed_others() {
        let of = |seed: u32, count: usize| {
            let text = format!(r#"{{"random": {{"mean": "1 meV", "relative_deviation": 0.1, "seed": {seed}}}}}"#);
            read(&text, count).unwrap()
        };
        assert_eq!(of(7, 50), of(7, 100)[..50]);
        assert!(of(7, 50).iter().zip(of(8, 50)).all(|(a, b)| *a != b));
        // from another implementation of ChaCha8, so that no release draws otherwise
        let known = [1.1180694150218984, 0.9860763816556966, 1.0114381032703905];
        assert!(of(1, 3).iter().zip(known).all(|(a, b)| (a - b).abs() < 1e-15), "{:?}", of(1, 3));
    }

    #[test]
    fn neighbours_of_a_grain_share_a_value() {
        let text = r#"{"random": {"mean": "1 meV", "deviation": "0.1 meV", "seed": 1, "length": 4}}"#;
        let (grains, single) = (read(text, 10).unwrap(), read(&text.replace(r#", "length": 4"#, ""), 3).unwrap());
        assert_eq!(grains, [[single[0]; 4].as_slice(), &[single[1]; 4], &[single[2]; 2]].concat());
    }

    #[test]
    fn a_length_along_the_chain_may_be_random_too() {
        let text = r#"{"random": {"mean": "20 nm", "relative_deviation": 0.02, "seed": 5}}"#;
        let profile: Profile<Length> = serde_json::from_str(text).unwrap();
        let all = profile.values(6, "site", |l, _| Ok(l.0)).unwrap();
        assert!(
            all.iter().all(|nm| (nm - 20.0).abs() < 2.0) && all.windows(2).all(|pair| pair[0] != pair[1]),
            "{all:?}"
        );
    }

    #[test]
    fn nonsense_is_refused_in_words() {
        let said =
            |keys: &str| read(&format!(r#"{{"random": {{"mean": "1 meV", {keys}}}}}"#), 3).unwrap_err().to_string();
        assert!(said(r#""seed": 1"#).contains("give one of the two"));
        assert!(said(r#""seed": 1, "deviation": "1 meV", "relative_deviation": 1"#).contains("give one of the two"));
        assert!(said(r#""seed": 1, "relative_deviation": -0.1"#).contains("0 or more"));
        assert!(said(r#""seed": 1, "deviation": "-1 meV""#).starts_with("random.deviation: found a negative value"));
        assert!(said(r#""seed": 1, "deviation": "1 meV", "length": 0"#).contains("1 or more sites"));
        assert!(said(r#""deviation": "1 meV""#).contains("seed"));
        assert!(said(r#""seed": -1, "deviation": "1 meV""#).contains("u64"));
        let both = r#"{"from": "1 meV", "to": "2 meV", "random": {"mean": "1 meV", "deviation": "1 meV", "seed": 1}}"#;
        assert!(read(both, 3).unwrap_err().to_string().contains("stands alone"));
        let nothing = r#"{"random": {"mean": "0 meV", "deviation": "1 meV", "seed": 1, "distribution": "log_normal"}}"#;
        assert!(read(nothing, 3).unwrap_err().to_string().contains("other than 0"));
    }
}
