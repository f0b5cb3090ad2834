//! The complex Fourier transform of a power of two, by Stockham's radix-4 passes.
//!
//! Real and imaginary parts are apart, so that every pass vectorises; factors come from `libm` and nothing is fused, so the bits
//! are the same on every machine, which the transforms at hand (chosen by processor, factors from the system) do not promise.
//! Stockham's ordering: Cochran et al., IEEE Trans. Audio Electroacoust. 15, 45 (1967), doi:10.1109/TAU.1967.1161899.

use multiversion::multiversion;

/// The factors of one length.
#[derive(Clone, Debug)]
pub struct Fft {
    length: usize,
    /// For every pass: cos and −sin of p, 2p and 3p units, p = 0 … quarter − 1.
    passes: Vec<[Vec<f64>; 6]>,
}

impl Fft {
    /// For `length`, a power of two.
    pub fn new(length: usize) -> Fft {
        let mut passes = Vec::new();
        let mut left = length;
        while left >= 4 {
            let factor = |multiple: usize, p: usize| {
                let angle = 2.0 * std::f64::consts::PI * (multiple * p) as f64 / left as f64;
                let (sin, cos) = libm::sincos(angle);
                [cos, -sin]
            };
            let column = |k: usize| (0..left / 4).map(|p| factor(k / 2 + 1, p)[k % 2]).collect();
            passes.push([0, 1, 2, 3, 4, 5].map(column));
            left /= 4;
        }
        Fft { length, passes }
    }

    /// Number of points.
    pub fn length(&self) -> usize {
        self.length
    }

    /// X_k = Σ_j x_j e^(−2πi jk/n), in place; `room` holds 2n numbers. Exchange `re` and `im` for the inverse (times n).
    pub fn transform(&self, re: &mut [f64], im: &mut [f64], room: &mut [f64]) {
        let n = self.length;
        let (room_re, room_im) = room[..2 * n].split_at_mut(n);
        let (mut from, mut to) = ((&mut re[..n], &mut im[..n]), (room_re, room_im));
        let mut stride = 1;
        for pass in &self.passes {
            match stride {
                1 => first_pass(from.0, from.1, to.0, to.1, pass),
                4 => pass_of_four(from.0, from.1, to.0, to.1, pass),
                _ => quarter_pass(from.0, from.1, to.0, to.1, pass, stride),
            }
            std::mem::swap(&mut from, &mut to);
            stride *= 4;
        }
        let mut swapped = self.passes.len() % 2 == 1;
        if stride < n {
            half_pass(from.0, from.1, to.0, to.1, stride);
            std::mem::swap(&mut from, &mut to);
            swapped = !swapped;
        }
        if swapped {
            to.0.copy_from_slice(from.0);
            to.1.copy_from_slice(from.1);
        }
    }
}

/// Four points to four: sums and differences turned by the three factors.
#[inline(always)]
fn butterfly(x: [f64; 4], y: [f64; 4], w: [f64; 6]) -> ([f64; 4], [f64; 4]) {
    let (sx, sy) = (x[0] + x[2], y[0] + y[2]);
    let (dx, dy) = (x[0] - x[2], y[0] - y[2]);
    let (tx, ty) = (x[1] + x[3], y[1] + y[3]);
    let (ex, ey) = (x[1] - x[3], y[1] - y[3]);
    let turn = |a: f64, b: f64, c: f64, s: f64| (a * c - b * s, a * s + b * c);
    let one = turn(dx + ey, dy - ex, w[0], w[1]);
    let two = turn(sx - tx, sy - ty, w[2], w[3]);
    let three = turn(dx - ey, dy + ex, w[4], w[5]);
    ([sx + tx, one.0, two.0, three.0], [sy + ty, one.1, two.1, three.1])
}

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn first_pass(re: &[f64], im: &[f64], to_re: &mut [f64], to_im: &mut [f64], w: &[Vec<f64>; 6]) {
    let m = re.len() / 4;
    let part = |v: &[f64], k: usize, p: usize| v[k * m + p];
    let w = [0, 1, 2, 3, 4, 5].map(|k: usize| &w[k][..m]);
    for (p, (a, b)) in to_re.chunks_exact_mut(4).zip(to_im.chunks_exact_mut(4)).enumerate().take(m) {
        let x = [0, 1, 2, 3].map(|k| part(re, k, p));
        let y = [0, 1, 2, 3].map(|k| part(im, k, p));
        let (x, y) = butterfly(x, y, [w[0][p], w[1][p], w[2][p], w[3][p], w[4][p], w[5][p]]);
        a.copy_from_slice(&x);
        b.copy_from_slice(&y);
    }
}

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn pass_of_four(re: &[f64], im: &[f64], to_re: &mut [f64], to_im: &mut [f64], w: &[Vec<f64>; 6]) {
    strided(re, im, to_re, to_im, w, 4);
}

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn quarter_pass(re: &[f64], im: &[f64], to_re: &mut [f64], to_im: &mut [f64], w: &[Vec<f64>; 6], stride: usize) {
    strided(re, im, to_re, to_im, w, stride);
}

/// One radix-4 pass over runs of `s` neighbours.
#[inline(always)]
fn strided(re: &[f64], im: &[f64], to_re: &mut [f64], to_im: &mut [f64], w: &[Vec<f64>; 6], s: usize) {
    let m = re.len() / (4 * s);
    for p in 0..m {
        let factors = [w[0][p], w[1][p], w[2][p], w[3][p], w[4][p], w[5][p]];
        let at = |k: usize| s * (p + m * k)..s * (p + m * k) + s;
        let (x0, x1, x2, x3) = (&re[at(0)], &re[at(1)], &re[at(2)], &re[at(3)]);
        let (y0, y1, y2, y3) = (&im[at(0)], &im[at(1)], &im[at(2)], &im[at(3)]);
        let four = 4 * s * p..4 * s * (p + 1);
        let (a0, rest) = to_re[four.clone()].split_at_mut(s);
        let (a1, rest) = rest.split_at_mut(s);
        let (a2, a3) = rest.split_at_mut(s);
        let (b0, rest) = to_im[four].split_at_mut(s);
        let (b1, rest) = rest.split_at_mut(s);
        let (b2, b3) = rest.split_at_mut(s);
        for q in 0..s {
            let (x, y) = butterfly([x0[q], x1[q], x2[q], x3[q]], [y0[q], y1[q], y2[q], y3[q]], factors);
            (a0[q], a1[q], a2[q], a3[q]) = (x[0], x[1], x[2], x[3]);
            (b0[q], b1[q], b2[q], b3[q]) = (y[0], y[1], y[2], y[3]);
        }
    }
}

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn half_pass(re: &[f64], im: &[f64], to_re: &mut [f64], to_im: &mut [f64], s: usize) {
    for (from, to) in [(re, to_re), (im, to_im)] {
        let (a, b) = from.split_at(s);
        let (sum, difference) = to.split_at_mut(s);
        for q in 0..s {
            sum[q] = a[q] + b[q];
            difference[q] = a[q] - b[q];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn the_transform_is_its_defining_sum_and_the_exchanged_one_its_inverse() {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        for n in [1, 2, 4, 8, 16, 32, 64, 128, 256, 512] {
            let x: Vec<f64> = (0..n).map(|_| r.random_range(-1.0..1.0)).collect();
            let y: Vec<f64> = (0..n).map(|_| r.random_range(-1.0..1.0)).collect();
            let fft = Fft::new(n);
            let (mut re, mut im, mut room) = (x.clone(), y.clone(), vec![0.0; 2 * n]);
            fft.transform(&mut re, &mut im, &mut room);
            for k in 0..n {
                let (mut a, mut b) = (0.0, 0.0);
                for j in 0..n {
                    let (s, c) = libm::sincos(-2.0 * std::f64::consts::PI * ((j * k) % n) as f64 / n as f64);
                    a += x[j] * c - y[j] * s;
                    b += x[j] * s + y[j] * c;
                }
                assert!((a - re[k]).abs() + (b - im[k]).abs() < 1e-14 * n as f64, "{n} {k}");
            }
            fft.transform(&mut im, &mut re, &mut room);
            for j in 0..n {
                assert!((re[j] / n as f64 - x[j]).abs() + (im[j] / n as f64 - y[j]).abs() < 2e-15);
            }
        }
    }
}
