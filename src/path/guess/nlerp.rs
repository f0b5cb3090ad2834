//! Normalised component-wise interpolation, to compare with: the geodesic's points at uneven speed.

use super::{FirstGuess, GuessContext};
use crate::error::Result;
use crate::geometry::{Direction, lerp, nlerp, vector};
use crate::path::Path;
use crate::registry::Described;
use crate::spins::Spins;
use serde::Deserialize;

/// `{"nlerp": {}}`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
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
        let axis = self.axis.unwrap_or(context.default_axis);
        let last = images - 1;
        Ok(Path::build(images, a.sites(), |k, out| {
            if k == 0 || k == last {
                return out.copy_from_slice(if k == 0 { a.as_slice() } else { b.as_slice() });
            }
            let mut out = crate::field::ComponentsMut::new(out);
            for i in 0..a.sites() {
                out.set(i, nlerp(a.get(i), b.get(i), k as f64 / last as f64, axis));
            }
        }))
    }
}

/// The shortest vector |m| that component-wise interpolation without normalising passes through: 1 is on the sphere, 0 its
/// middle.
pub fn component_sag(a: &Spins, b: &Spins) -> f64 {
    (0..a.sites()).map(|i| vector::norm(lerp(a.get(i), b.get(i), 0.5))).fold(1.0, f64::min)
}
