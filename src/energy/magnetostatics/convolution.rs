//! Σ_j k(|i − j|) x_j for all sites i: directly for short chains, by zero-padded Fourier transforms for long ones.
//!
//! ```text
//! C_j = x_2j + i x_2j+1 → transform of n points, n a power of two, 2n ≥ 2N − 1 → C'_j = α_j C_j + iβ_j C̄_{n−j} → back
//! α = ½(K_j + K_{n−j}) − ½(K_j − K_{n−j}) sin θ,   β = ½(K_j − K_{n−j}) cos θ,   θ = πj/n
//! ```
//! K is the transform (length 2n, real since k is even) of k laid out on both sides of 0; unpacking the transform of a real
//! sequence, multiplying by K and packing it again are one step, α and β. The kernel of a ring holds its images already, so
//! open chains and rings are padded alike.

use super::Kernel;
use crate::linalg::Fft;
use multiversion::multiversion;
use std::cell::RefCell;

/// Up to this many sites the direct sum is the quicker, by `benches/longrange.rs`.
const SHORT: usize = 24;

thread_local! {
    /// Room of this thread's transforms.
    static ROOM: RefCell<Vec<f64>> = const { RefCell::new(Vec::new()) };
}

/// A kernel made ready.
#[derive(Clone, Debug)]
pub struct Convolution {
    kernel: [Vec<f64>; 3],
    fft: Fft,
    alpha: [Vec<f64>; 3],
    beta: [Vec<f64>; 3],
}

impl Convolution {
    /// Of a kernel.
    pub fn new(kernel: &Kernel) -> Convolution {
        let fft = Fft::new(kernel.table[0].len().next_power_of_two());
        let weights = [0, 1, 2].map(|c: usize| packed_weights(&kernel.table[c], fft.length()));
        let [x, y, z] = weights;
        Convolution { kernel: kernel.table.clone(), fft, alpha: [x.0, y.0, z.0], beta: [x.1, y.1, z.1] }
    }

    /// y_i ← Σ_j k_c(|i − j|) x_j with the kernel's component c.
    pub fn apply(&self, c: usize, x: &[f64], y: &mut [f64]) {
        if x.len() <= SHORT { self.direct(c, x, y) } else { self.transformed(c, x, y) }
    }

    /// [`apply`](Self::apply), pair by pair.
    pub fn direct(&self, c: usize, x: &[f64], y: &mut [f64]) {
        add_pairs(&self.kernel[c], x, y);
    }

    /// [`apply`](Self::apply), by Fourier transforms.
    pub fn transformed(&self, c: usize, x: &[f64], y: &mut [f64]) {
        let n = self.fft.length();
        ROOM.with_borrow_mut(|room| {
            room.resize(4 * n, 0.0);
            let (re, rest) = room.split_at_mut(n);
            let (im, rest) = rest.split_at_mut(n);
            let packed = x.len().div_ceil(2);
            for ((re, im), pair) in re.iter_mut().zip(im.iter_mut()).zip(x.chunks(2)) {
                (*re, *im) = (pair[0], pair.get(1).copied().unwrap_or(0.0));
            }
            re[packed..].fill(0.0);
            im[packed..].fill(0.0);
            self.fft.transform(re, im, rest);
            weigh(re, im, &self.alpha[c], &self.beta[c]);
            self.fft.transform(im, re, rest);
            for ((re, im), pair) in re.iter().zip(im.iter()).zip(y.chunks_mut(2)) {
                pair[0] = *re;
                if let Some(second) = pair.get_mut(1) {
                    *second = *im;
                }
            }
        });
    }
}

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn add_pairs(k: &[f64], x: &[f64], y: &mut [f64]) {
    let n = x.len();
    for (y, x) in y.iter_mut().zip(x) {
        *y = k[0] * x;
    }
    for d in 1..n {
        for (y, x) in y[..n - d].iter_mut().zip(&x[d..]) {
            *y += k[d] * x;
        }
        for (y, x) in y[d..].iter_mut().zip(&x[..n - d]) {
            *y += k[d] * x;
        }
    }
}

/// α and β of an even kernel, over n.
fn packed_weights(kernel: &[f64], n: usize) -> (Vec<f64>, Vec<f64>) {
    let (mut re, mut im, mut room) = (vec![0.0; 2 * n], vec![0.0; 2 * n], vec![0.0; 4 * n]);
    for (j, k) in kernel.iter().enumerate() {
        re[j] = *k;
        re[(2 * n - j) % (2 * n)] = *k;
    }
    Fft::new(2 * n).transform(&mut re, &mut im, &mut room);
    let weight = |j: usize| {
        let (sum, difference) = (0.5 * (re[j] + re[n - j]), 0.5 * (re[j] - re[n - j]));
        let (sin, cos) = libm::sincos(std::f64::consts::PI * j as f64 / n as f64);
        ((sum - difference * sin) / n as f64, difference * cos / n as f64)
    };
    (0..n).map(weight).unzip()
}

/// C_j ← α_j C_j + iβ_j C̄_{n−j}.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn weigh(re: &mut [f64], im: &mut [f64], alpha: &[f64], beta: &[f64]) {
    let n = re.len();
    let turn = |a: f64, b: f64, (x, y): (f64, f64), (u, v): (f64, f64)| (a * x + b * v, a * y + b * u);
    (re[0], im[0]) = turn(alpha[0], beta[0], (re[0], im[0]), (re[0], im[0]));
    for j in 1..n.div_ceil(2) {
        let (p, q) = ((re[j], im[j]), (re[n - j], im[n - j]));
        (re[j], im[j]) = turn(alpha[j], beta[j], p, q);
        (re[n - j], im[n - j]) = turn(alpha[n - j], beta[n - j], q, p);
    }
    if n > 1 {
        let h = n / 2;
        (re[h], im[h]) = turn(alpha[h], beta[h], (re[h], im[h]), (re[h], im[h]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::magnetostatics::Shape;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn transforms_and_direct_sums_agree_for_every_number_of_sites() {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        for shape in [Shape::Dipoles, Shape::Cells { width: 4.0, thickness: 1.0 }] {
            for periodic in [false, true] {
                for sites in if periodic { 3..=300 } else { 1..=300 } {
                    let kernel = Kernel::new(shape, sites, periodic);
                    let convolution = Convolution::new(&kernel);
                    let x: Vec<f64> = (0..sites).map(|_| r.random_range(-1.0..1.0)).collect();
                    for c in 0..3 {
                        let (mut fast, mut slow) = (vec![0.0; sites], vec![0.0; sites]);
                        convolution.transformed(c, &x, &mut fast);
                        convolution.direct(c, &x, &mut slow);
                        let scale: f64 = kernel.table[c].iter().map(|k| k.abs()).sum();
                        for i in 0..sites {
                            let sum: f64 = (0..sites).map(|j| kernel.table[c][i.abs_diff(j)] * x[j]).sum();
                            assert!((fast[i] - sum).abs() <= 1e-14 * scale, "{sites}: {} {sum}", fast[i]);
                            assert!((slow[i] - sum).abs() <= 1e-14 * scale, "{sites}: {} {sum}", slow[i]);
                        }
                    }
                }
            }
        }
    }
}
