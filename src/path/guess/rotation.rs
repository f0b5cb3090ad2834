//! The whole configuration turned rigidly: quaternion slerp from no rotation to the one that brings the states together.
//!
//! ```text
//! m_i(t) = R(t φ, k) r_i(t)      r_i: spin i's own geodesic from a_i to R(−φ, k) b_i, what the turn leaves over
//! φ = atan2(Σ k·(a_i × b_i), Σ a_i·b_i − (k·a_i)(k·b_i))      maximises Σ b_i·R a_i about a given axis k
//! ```
//! Without an axis, R is the best rotation of all: the eigenvector of the largest eigenvalue of the 4 × 4 matrix of
//! B. K. P. Horn, J. Opt. Soc. Am. A 4, 629 (1987), doi:10.1364/JOSAA.4.000629; where several are as good, the one nearest to a
//! turn about the axis for opposite spins. A half turn is right-handed about the axis. Frozen spins stay.

use super::clock::{fraction, next_axis, ways};
use super::{FirstGuess, GuessContext};
use crate::error::Result;
use crate::field::{Components, ComponentsMut};
use crate::geometry::{Direction, Quaternion, Vector, vector};
use crate::linalg::eigen_symmetric;
use crate::path::Path;
use crate::registry::Described;
use crate::sphere::turn_towards;
use crate::spins::Spins;
use schemars::JsonSchema;
use serde::Deserialize;
use std::f64::consts::PI;

/// `{"rotation": {"axis": [0, 0, 1]}}`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rotation {
    /// Axis of the turn; that of the best rotation if absent.
    #[serde(default)]
    pub axis: Option<Direction>,
}

impl Described for Rotation {
    const NAME: &'static str = "rotation";
    const SUMMARY: &'static str = "the whole configuration turned rigidly about an axis";
    const EXAMPLE: &'static str = r#"{"rotation": {"axis": [0, 0, 1]}}"#;
}

/// Turns and eigenvalues that differ by less, relative to what they are made of, are as good as one another.
const AS_GOOD: f64 = 1e-9;
/// One rotation is better than all others where its overlap is larger by this much a spin; sines of half angles below it are no turn.
const ONE: f64 = 0.01;

/// The angle of the turn about an axis that brings a nearest to b (rad, −π to π). Where no angle is better than another it is a half turn, or none if no spin has a part normal to the axis.
pub fn best_turn(a: &Spins, b: &Spins, axis: Direction) -> f64 {
    turn(Components::new(a.as_slice()), Components::new(b.as_slice()), axis)
}

fn turn(a: Components, b: Components, axis: Direction) -> f64 {
    let k = axis.vector();
    let (sine, cosine) = turn_towards(a, b, k);
    let levers = |m: Components, i: usize| vector::norm(vector::cross(k, m.get(i)));
    let lever: f64 = (0..a.sites()).map(|i| levers(a, i) * levers(b, i)).sum();
    let size = (sine * sine + cosine * cosine).sqrt();
    let angle = if lever < AS_GOOD * a.sites() as f64 {
        0.0
    } else if size < AS_GOOD * lever {
        PI
    } else {
        libm::atan2(sine, cosine)
    };
    // a half turn that rounding made −π is right-handed
    if angle < AS_GOOD - PI { PI } else { angle }
}

/// Axis and angle of the rotation that brings the free spins of a nearest to b: about an axis, or the best of all.
pub(super) fn rotation_between(
    a: &Spins,
    b: &Spins,
    axis: Option<Direction>,
    context: &GuessContext,
) -> (Direction, f64) {
    let frozen = context.states.lattice.is_frozen();
    let is_free = |k: usize| !frozen[k % frozen.len()];
    let free = |s: &Spins| -> Vec<f64> {
        s.as_slice().iter().enumerate().filter(|(k, _)| is_free(*k)).map(|(_, x)| *x).collect()
    };
    let (p, q) = (free(a), free(b));
    let (p, q) = (Components::new(&p), Components::new(&q));
    match axis {
        Some(axis) => (axis, turn(p, q, axis)),
        None => best_rotation(p, q, context.default_axis),
    }
}

/// Axis and angle of the rotation that brings a nearest to b; of several as good, one near a turn about `axis`.
fn best_rotation(a: Components, b: Components, axis: Direction) -> (Direction, f64) {
    let (values, vectors) = rotations(a, b);
    let tolerance = AS_GOOD * a.sites() as f64;
    let best: Vec<&Vec<f64>> =
        values.iter().zip(&vectors).filter(|(v, _)| **v >= values[3] - tolerance).map(|(_, q)| q).collect();
    let mut rotation = [0.0; 4];
    for k in [axis, next_axis(axis), next_axis(next_axis(axis))] {
        let wanted = Quaternion::from_axis_angle(k, turn(a, b, k)).components();
        rotation = [0.0; 4];
        for q in &best {
            let overlap: f64 = q.iter().zip(&wanted).map(|(x, y)| x * y).sum();
            (0..4).for_each(|c| rotation[c] += overlap * q[c]);
        }
        if rotation.iter().map(|x| x * x).sum::<f64>() > 0.01 {
            break;
        }
    }
    let [w, x, y, z] = rotation;
    let sign = if w < -AS_GOOD { -1.0 } else { 1.0 };
    match Direction::new([sign * x, sign * y, sign * z]) {
        Ok(k) => (k, 2.0 * libm::atan2(vector::norm([x, y, z]), (sign * w).max(0.0))),
        Err(_) => (axis, 0.0),
    }
}

/// The axis of the best rotation, and what Σ b·R a is after it; none where another is nearly as good, or none needed.
pub(super) fn one_rotation(a: &Spins, b: &Spins) -> Option<(Direction, f64)> {
    let (values, vectors) = rotations(Components::new(a.as_slice()), Components::new(b.as_slice()));
    if values[3] - values[2] < ONE * a.sites() as f64 {
        return None;
    }
    let [w, x, y, z] = vectors[3][..] else { return None };
    let sign = if w < 0.0 { -1.0 } else { 1.0 };
    let axis = Direction::new([sign * x, sign * y, sign * z]).ok()?;
    (vector::norm([x, y, z]) > ONE).then_some((axis, values[3]))
}

/// The eigenvalues of Horn's matrix, ascending, and its eigenvectors: what Σ b·R a is after each of these rotations, a quaternion.
fn rotations(a: Components, b: Components) -> (Vec<f64>, Vec<Vec<f64>>) {
    let mut s = [[0.0; 3]; 3];
    for i in 0..a.sites() {
        for (row, x) in s.iter_mut().zip(a.get(i)) {
            *row = vector::add(*row, vector::scale(x, b.get(i)));
        }
    }
    let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = s;
    let horn = [
        [xx + yy + zz, yz - zy, zx - xz, xy - yx],
        [yz - zy, xx - yy - zz, xy + yx, zx + xz],
        [zx - xz, xy + yx, yy - xx - zz, yz + zy],
        [xy - yx, zx + xz, yz + zy, zz - xx - yy],
    ];
    eigen_symmetric(&horn.concat(), 4)
}

impl FirstGuess for Rotation {
    fn path(&self, a: &Spins, b: &Spins, images: usize, context: &GuessContext) -> Result<Path> {
        let frozen = context.states.lattice.is_frozen();
        let (axis, angle) = rotation_between(a, b, self.axis, context);
        let back = Quaternion::from_axis_angle(axis, -angle);
        let unturned: Vec<Vector> = (0..a.sites()).map(|i| back.rotate(b.get(i))).collect();
        let rests = ways(a, &Spins::from_vectors(&unturned)?, context.default_axis);
        Ok(Path::build(images, a.sites(), |k, out| {
            out.copy_from_slice(if k + 1 == images { b.as_slice() } else { a.as_slice() });
            if k == 0 || k + 1 == images {
                return;
            }
            let t = fraction(k, images);
            // the slerp from no rotation: the same axis, a part of the angle
            let part = Quaternion::from_axis_angle(axis, t * angle);
            let mut out = ComponentsMut::new(out);
            for i in (0..rests.len()).filter(|i| !frozen[*i]) {
                let p = rests[i].at(t);
                out.set(i, vector::unit_or(part.rotate(p), p));
            }
        }))
    }
}
