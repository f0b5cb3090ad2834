//! Normalised component-wise interpolation, to compare with: the geodesic's points at uneven speed.
//!
//! ```text
//! ((1−t) a + t b)/|…| is the great circle's point at fraction ½ − atan((1 − 2t) tan h)/2h,   h = θ/2
//! ```
//! h = π/2 where a spin goes around by a common axis: it waits at one end, then at the other.

use super::clock::{Ways, clocked, fraction};
use super::{FirstGuess, GuessContext};
use crate::error::Result;
use crate::geometry::{Direction, lerp, vector};
use crate::path::Path;
use crate::registry::Described;
use crate::spins::Spins;
use schemars::JsonSchema;
use serde::Deserialize;
use std::f64::consts::FRAC_PI_2;

/// `{"nlerp": {}}`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Nlerp {
    /// Axis about which opposite spins turn.
    #[serde(default)]
    pub axis: Option<Direction>,
}

impl Described for Nlerp {
    const NAME: &'static str = "nlerp";
    const SUMMARY: &'static str = "components interpolated and normalised, to compare with";
    const EXAMPLE: &'static str = r#"{"nlerp": {}}"#;
}

impl FirstGuess for Nlerp {
    fn path(&self, a: &Spins, b: &Spins, images: usize, context: &GuessContext) -> Result<Path> {
        let ways = Ways::between(a, b);
        let about = ways.about(self.axis.unwrap_or(context.default_axis));
        Ok(clocked(&ways, &about, images, |k, i| uneven(fraction(k, images), 0.5 * about.of(i).length())))
    }
}

/// The fraction of an arc of half-angle h that the normalised lerp has reached at t.
fn uneven(t: f64, h: f64) -> f64 {
    let h = h.min(FRAC_PI_2);
    if h < 1e-4 || t == 0.5 {
        return t;
    }
    0.5 - libm::atan((1.0 - 2.0 * t) * libm::tan(h)) / (2.0 * h)
}

/// The shortest vector |m| that component-wise interpolation without normalising passes through: 1 is on the sphere, 0 its
/// middle.
pub fn component_sag(a: &Spins, b: &Spins) -> f64 {
    (0..a.sites()).map(|i| vector::norm(lerp(a.get(i), b.get(i), 0.5))).fold(1.0, f64::min)
}
