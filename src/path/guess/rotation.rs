//! The whole configuration turned rigidly, by quaternion slerp.
//!
//! About a given axis the angle is the one that brings the initial state nearest to the final one,
//! φ = atan2(Σ k·(a × b), Σ a·b − (k·a)(k·b)); where no angle is better than another it is a half turn. What the turn leaves over is closed evenly
//! along the way by every spin's own geodesic. The sense is that of the axis (right-handed) for a half turn.

use super::{FirstGuess, GuessContext};
use crate::error::Result;
use crate::field::ComponentsMut;
use crate::geometry::{Arc, Direction, Quaternion, vector};
use crate::path::Path;
use crate::registry::Described;
use crate::spins::Spins;
use serde::Deserialize;
use std::f64::consts::PI;

/// `{"rotation": {"axis": [0, 0, 1]}}`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rotation {
    /// Axis of the turn; of x, y and z the one that brings the states nearest together if absent.
    #[serde(default)]
    pub axis: Option<Direction>,
}

impl Described for Rotation {
    const NAME: &'static str = "rotation";
    const SUMMARY: &'static str = "the whole configuration turned rigidly about an axis";
    const EXAMPLE: &'static str = r#"{"rotation": {"axis": [0, 0, 1]}}"#;
}

/// The angle of the turn about an axis that brings a nearest to b (rad, −π to π), and Σ b·R a after it.
pub fn best_turn(a: &Spins, b: &Spins, axis: Direction) -> (f64, f64) {
    let k = axis.vector();
    let (mut sine, mut cosine, mut fixed) = (0.0, 0.0, 0.0);
    for i in 0..a.sites() {
        let (p, q) = (a.get(i), b.get(i));
        let along = vector::dot(k, p) * vector::dot(k, q);
        sine += vector::dot(k, vector::cross(p, q));
        cosine += vector::dot(p, q) - along;
        fixed += along;
    }
    let size = sine.hypot(cosine);
    let angle = if size < 1e-9 * a.sites() as f64 { PI } else { libm::atan2(sine, cosine) };
    // a half turn that rounding made −π is right-handed
    let angle = if angle < -PI + 1e-9 { angle + 2.0 * PI } else { angle };
    (angle, size + fixed)
}

impl FirstGuess for Rotation {
    fn path(&self, a: &Spins, b: &Spins, images: usize, context: &GuessContext) -> Result<Path> {
        let axis = self.axis.unwrap_or_else(|| {
            let better =
                |p: Direction, q: Direction| if best_turn(a, b, q).1 > best_turn(a, b, p).1 + 1e-9 { q } else { p };
            [Direction::X, Direction::Y, Direction::Z].into_iter().fold(context.default_axis, better)
        });
        let (angle, _) = best_turn(a, b, axis);
        // a quarter at a time: quaternion slerp goes the short way
        let half = Quaternion::from_axis_angle(axis, 0.5 * angle);
        let back = Quaternion::from_axis_angle(axis, -angle);
        let rests: Vec<Arc> = (0..a.sites()).map(|i| Arc::new(a.get(i), back.rotate(b.get(i)), axis)).collect();
        let last = images - 1;
        Ok(Path::build(images, a.sites(), |k, out| {
            if k == 0 || k == last {
                return out.copy_from_slice(if k == 0 { a.as_slice() } else { b.as_slice() });
            }
            let t = k as f64 / last as f64;
            let q = if t <= 0.5 {
                Quaternion::IDENTITY.slerp(half, 2.0 * t)
            } else {
                half.mul(Quaternion::IDENTITY.slerp(half, 2.0 * t - 1.0))
            };
            let mut out = ComponentsMut::new(out);
            for (i, rest) in rests.iter().enumerate() {
                let p = rest.at(t);
                out.set(i, vector::unit_or(q.rotate(p), p));
            }
        }))
    }
}
