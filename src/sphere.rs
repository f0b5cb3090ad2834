//! Products of spheres: moving many unit vectors along tangent vectors by the exponential map, and angles between them.

use crate::field::{Components, ComponentsMut, TILE, tiles};
use crate::geometry::{Direction, Vector, exp, exp_short, log, rotate, vector};
use crate::linalg::slab;
use crate::threads::{MADE, apiece};
use multiversion::multiversion;
use rayon::prelude::*;

/// Spins of two states that are the same differ by less (rad): relaxed states to far below it, and distinct ones by far more.
pub const SAME: f64 = 1e-3;
/// Spins of two states that are given as one and the same differ by less (rad).
pub const IDENTICAL: f64 = 1e-9;

/// Each spin m ← Exp_m(s v), image by image (slabs of 3N numbers).
pub fn move_points(points: &mut [f64], v: &[f64], slab: usize, s: f64) {
    let images = points.par_chunks_mut(slab).zip(v.par_chunks(slab)).with_min_len(apiece(slab, MADE));
    images.for_each(|(m, v)| {
        let v = Components::new(v);
        for (first, m) in tiles(m) {
            let v = v.range(first..first + m.x.len());
            if slab::max_abs(v.x).max(slab::max_abs(v.y)).max(slab::max_abs(v.z)) * s.abs() <= 0.25 {
                move_short(m.x, m.y, m.z, v, s);
            } else {
                move_far(m, v, s);
            }
        }
    });
}

/// Rotates the spins of some sites of one image by the same angle (rad, right-handed) about an axis.
pub fn rotate_sites(m: &mut [f64], sites: impl Iterator<Item = usize>, axis: Direction, angle: f64) {
    let mut m = ComponentsMut::new(m);
    for i in sites {
        let v = rotate(m.as_read().get(i), axis, angle);
        m.set(i, vector::unit_or(v, v));
    }
}

/// The turn about the unit axis k that brings a nearest to b, by its sine and cosine times one size: Σ k·(a × b) and
/// Σ (a·b − (k·a)(k·b)). The size is what Σ (a·b − (k·a)(k·b)) is after it.
pub fn turn_towards(a: Components, b: Components, axis: Vector) -> (f64, f64) {
    let (mut sine, mut cosine) = ([0.0; TILE], [0.0; TILE]);
    let (mut sines, mut cosines) = (0.0, 0.0);
    for first in (0..a.sites()).step_by(TILE) {
        let range = first..a.sites().min(first + TILE);
        let (sine, cosine) = (&mut sine[..range.len()], &mut cosine[..range.len()]);
        turns(a.range(range.clone()), b.range(range), axis, sine, cosine);
        (sines, cosines) = (sines + slab::sum(sine), cosines + slab::sum(cosine));
    }
    (sines, cosines)
}

/// Σ a·b after the turn about the unit axis k that makes it largest.
pub fn best_overlap(a: Components, b: Components, axis: Vector) -> f64 {
    let (sine, cosine) = turn_towards(a, b, axis);
    let fixed = |i: usize| vector::dot(axis, a.get(i)) * vector::dot(axis, b.get(i));
    (sine * sine + cosine * cosine).sqrt() + (0..a.sites()).map(fixed).sum::<f64>()
}

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn turns(a: Components, b: Components, [x, y, z]: Vector, sine: &mut [f64], cosine: &mut [f64]) {
    let n = sine.len();
    let (ax, ay, az) = (&a.x[..n], &a.y[..n], &a.z[..n]);
    let (bx, by, bz) = (&b.x[..n], &b.y[..n], &b.z[..n]);
    let cosine = &mut cosine[..n];
    for i in 0..n {
        let turn = (ay[i] * bz[i] - az[i] * by[i], az[i] * bx[i] - ax[i] * bz[i], ax[i] * by[i] - ay[i] * bx[i]);
        sine[i] = x * turn.0 + y * turn.1 + z * turn.2;
        let along = (x * ax[i] + y * ay[i] + z * az[i]) * (x * bx[i] + y * by[i] + z * bz[i]);
        cosine[i] = ax[i] * bx[i] + ay[i] * by[i] + az[i] * bz[i] - along;
    }
}

/// No component over ¼, so that |s v| ≤ √3/4 < ½.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn move_short(x: &mut [f64], y: &mut [f64], z: &mut [f64], v: Components, s: f64) {
    let n = v.x.len();
    let (x, y, z) = (&mut x[..n], &mut y[..n], &mut z[..n]);
    let (vx, vy, vz) = (&v.x[..n], &v.y[..n], &v.z[..n]);
    for i in 0..n {
        let (m, step) = ([x[i], y[i], z[i]], [s * vx[i], s * vy[i], s * vz[i]]);
        let moved = exp_short(m, step);
        let still = step[0] == 0.0 && step[1] == 0.0 && step[2] == 0.0;
        x[i] = if still { m[0] } else { moved[0] };
        y[i] = if still { m[1] } else { moved[1] };
        z[i] = if still { m[2] } else { moved[2] };
    }
}

fn move_far(mut m: ComponentsMut, v: Components, s: f64) {
    for i in 0..v.sites() {
        let step = vector::scale(s, v.get(i));
        if step != [0.0; 3] {
            m.set(i, exp([m.x[i], m.y[i], m.z[i]], step));
        }
    }
}

/// The largest |v_i| of any spin (rad); NaN if any entry is NaN or infinite.
pub fn rotation_of(v: &[f64]) -> f64 {
    let v = Components::new(v);
    let mut squares = [0.0; TILE];
    let mut largest: f64 = 0.0;
    for first in (0..v.sites()).step_by(TILE) {
        let v = v.range(first..v.sites().min(first + TILE));
        let squares = &mut squares[..v.sites()];
        for (i, s) in squares.iter_mut().enumerate() {
            *s = vector::dot(v.get(i), v.get(i));
        }
        let here = slab::max_abs(squares);
        largest = if here.is_nan() { f64::NAN } else { largest.max(here) };
        if largest.is_nan() {
            break;
        }
    }
    largest.sqrt()
}

/// Coefficients of atan(x)/x in x², least relative error on 0 ≤ x ≤ √2 − 1: 5e-20, far below the rounding.
const ATAN: [f64; 13] = [
    1.0,
    -0.33333333333333326,
    0.19999999999997015,
    -0.14285714285329706,
    0.11111111085322088,
    -0.09090908059030459,
    0.07692281099921489,
    -0.06666205259739774,
    0.05876834002319731,
    -0.052173125594086316,
    0.044995006697646826,
    -0.03338782312896798,
    0.015113763707864538,
];

/// The angle of two unit vectors (rad): |a − b| = 2 sin ½θ and |a + b| = 2 cos ½θ give
/// tan ¼θ = |a − b|/(2 + |a + b|) ≤ 1; once more tan ½x = tan x/(1 + √(1 + tan² x)) gives tan ⅛θ ≤ √2 − 1.
#[inline(always)]
fn angle_of_units(a: Vector, b: Vector) -> f64 {
    let (apart, together) = (vector::norm(vector::sub(a, b)), vector::norm(vector::add(a, b)));
    let quarter = apart / (2.0 + together);
    let eighth = quarter / (1.0 + (1.0 + quarter * quarter).sqrt());
    let square = eighth * eighth;
    let mut series = 0.0;
    for c in ATAN.iter().rev() {
        series = series * square + c;
    }
    8.0 * eighth * series
}

/// Coefficients of θ²/s in s = |a − b|² = 4 sin² ½θ, least relative error on 0 ≤ s ≤ 2 (θ ≤ 90°), below the rounding.
const SQUARE: [f64; 21] = [
    1.0,
    0.08333333333333294,
    0.0111111111111402,
    0.0017857142848710001,
    0.0003174603303771956,
    6.0124939310048e-05,
    1.1893621167338934e-05,
    2.424831019933979e-06,
    5.184123119356661e-07,
    8.279073594608675e-08,
    7.037898121825609e-08,
    -6.194206171651381e-08,
    7.590373614597171e-08,
    -6.486941851949638e-08,
    4.422776565682041e-08,
    -2.3084570898487092e-08,
    9.144111137450756e-09,
    -2.6517506706955373e-09,
    5.339877478403367e-10,
    -6.688160791222576e-11,
    3.985929821014925e-12,
];

/// Writes |a − b|² of every site.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn chords_squared(a: Components, b: Components, out: &mut [f64]) {
    let n = out.len();
    let (ax, ay, az) = (&a.x[..n], &a.y[..n], &a.z[..n]);
    let (bx, by, bz) = (&b.x[..n], &b.y[..n], &b.z[..n]);
    for i in 0..n {
        let (x, y, z) = (ax[i] - bx[i], ay[i] - by[i], az[i] - bz[i]);
        out[i] = x * x + y * y + z * z;
    }
}

/// |a − b|² ≤ 2 → θ² (rad²), in place.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn angles_squared(values: &mut [f64]) {
    for v in values {
        let s = *v;
        let mut series = 0.0;
        for c in SQUARE.iter().rev() {
            series = series * s + c;
        }
        *v = s * series;
    }
}

/// Writes θ² (rad²) of every site, of any size.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn wide_angles_squared(a: Components, b: Components, out: &mut [f64]) {
    let n = out.len();
    let (ax, ay, az) = (&a.x[..n], &a.y[..n], &a.z[..n]);
    let (bx, by, bz) = (&b.x[..n], &b.y[..n], &b.z[..n]);
    for i in 0..n {
        let angle = angle_of_units([ax[i], ay[i], az[i]], [bx[i], by[i], bz[i]]);
        out[i] = angle * angle;
    }
}

/// Σ θ² over the sites of two rows of unit vectors (rad²), and the largest θ (rad).
pub fn angles_between(a: Components, b: Components) -> (f64, f64) {
    let mut theta2 = [0.0; TILE];
    let (mut sum, mut largest) = (0.0, 0.0f64);
    for first in (0..a.sites()).step_by(TILE) {
        let range = first..a.sites().min(first + TILE);
        let (a, b, theta2) = (a.range(range.clone()), b.range(range.clone()), &mut theta2[..range.len()]);
        chords_squared(a, b, theta2);
        if slab::max_abs(theta2) <= 2.0 {
            angles_squared(theta2);
        } else {
            wide_angles_squared(a, b, theta2);
        }
        sum += slab::sum(theta2);
        largest = largest.max(slab::max_abs(theta2));
    }
    (sum, largest.sqrt())
}

/// Writes the tangent vectors (rad) along the great circles from the spins of `a` to those of `b`: their [`log`].
pub fn write_logs(a: Components, b: Components, out: &mut [f64]) {
    let mut chords = [0.0; TILE];
    for (first, out) in tiles(out) {
        let range = first..first + out.x.len();
        let (a, b, chords) = (a.range(range.clone()), b.range(range.clone()), &mut chords[..range.len()]);
        chords_squared(a, b, chords);
        if slab::max_abs(chords) <= 2.0 {
            logs_of_chords(a, b, chords, out.x, out.y, out.z);
        } else {
            far_logs(a, b, out);
        }
    }
}

/// For s = |a − b|² ≤ 2: θ/sin θ of the part of b − a across a; sin² θ = s (1 − ¼ s).
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn logs_of_chords(a: Components, b: Components, chords: &[f64], x: &mut [f64], y: &mut [f64], z: &mut [f64]) {
    let n = chords.len();
    let (ax, ay, az) = (&a.x[..n], &a.y[..n], &a.z[..n]);
    let (bx, by, bz) = (&b.x[..n], &b.y[..n], &b.z[..n]);
    let (x, y, z) = (&mut x[..n], &mut y[..n], &mut z[..n]);
    for i in 0..n {
        let step = [bx[i] - ax[i], by[i] - ay[i], bz[i] - az[i]];
        let along = ax[i] * step[0] + ay[i] * step[1] + az[i] * step[2];
        let mut series = 0.0;
        for c in SQUARE.iter().rev() {
            series = series * chords[i] + c;
        }
        let longer = (series / (1.0 - 0.25 * chords[i])).sqrt();
        x[i] = longer * (step[0] - along * ax[i]);
        y[i] = longer * (step[1] - along * ay[i]);
        z[i] = longer * (step[2] - along * az[i]);
    }
}

fn far_logs(a: Components, b: Components, mut out: ComponentsMut) {
    for i in 0..a.sites() {
        out.set(i, log(a.get(i), b.get(i)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::angle;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn angles_of_unit_vectors_are_right_from_the_smallest_to_half_a_turn() {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(3);
        for k in 0..20_000 {
            let mut one = || [(); 3].map(|()| r.random_range(-1.0..1.0));
            let (a, across) = (vector::unit(one()).unwrap(), one());
            let size = libm::exp10(-(k % 17) as f64);
            let near = vector::unit(vector::add(a, vector::scale(size, across))).unwrap();
            let opposite = vector::scale(-1.0, near);
            for b in [near, opposite] {
                let wrong = (angle_of_units(a, b) - angle(a, b)).abs();
                assert!(wrong <= 4e-15, "{a:?} {b:?} {wrong}");
                let all: Vec<f64> = a.into_iter().chain(b).collect();
                let (sum, largest) = angles_between(Components::new(&all[..3]), Components::new(&all[3..]));
                assert!((largest - angle(a, b)).abs() <= 4e-15 && sum.sqrt() == largest);
                let mut v = [0.0; 3];
                write_logs(Components::new(&all[..3]), Components::new(&all[3..]), &mut v);
                let wrong = vector::norm(vector::sub(v, log(a, b)));
                assert!(wrong <= 1e-15 * largest.max(0.1), "{a:?} {b:?} {wrong}");
            }
        }
        assert_eq!(angle_of_units([0.0, 0.0, 1.0], [0.0, 0.0, 1.0]), 0.0);
        assert!((angle_of_units([0.0, 0.0, 1.0], [0.0, 0.0, -1.0]) - std::f64::consts::PI).abs() < 1e-15);
    }

    #[test]
    fn a_row_moves_to_the_same_bits_as_its_spins_one_by_one() {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(4);
        for size in [1e-9, 0.1, 2.0] {
            let n = 1030;
            let mut m = vec![0.0; 3 * n];
            for i in 0..n {
                let one = vector::unit([(); 3].map(|()| r.random_range(-1.0..1.0))).unwrap();
                ComponentsMut::new(&mut m).set(i, one);
            }
            let v: Vec<f64> = (0..3 * n).map(|i| if i % 7 == 0 { 0.0 } else { r.random_range(-size..size) }).collect();
            let mut moved = m.clone();
            move_points(&mut moved, &v, 3 * n, 0.9);
            for i in 0..n {
                let step = vector::scale(0.9, Components::new(&v).get(i));
                assert_eq!(Components::new(&moved).get(i), exp(Components::new(&m).get(i), step));
            }
        }
    }
}
