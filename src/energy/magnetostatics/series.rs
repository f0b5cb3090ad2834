//! The interaction of distant cells of a row as a series in 1/n, and its sums over the images of a ring.
//!
//! ```text
//! N_xx(n) = −(wt/π) ∫₀^∞ sinh²(u/2) ⟨S⟩ e^(−nu) du          w × t: cross-section, in units of the spacing
//! N_yy(n) =  (wt/π) ∫₀^∞ sinh²(u/2) ⟨S cos²φ⟩ e^(−nu) du     (N_zz with sin²φ)
//! S = sinc²(½uw cos φ) sinc²(½ut sin φ),   ⟨·⟩: mean over φ
//! ```
//! This is Newell's tensor with the two transverse integrals as Fourier transforms: 1/4πr = ∫ d²k e^(ik·ρ − k|x|)/(8π²k).
//! Expanding the integrand in powers of u gives Σ_k c_k/n^(2k+3), convergent where n is greater than a cell's diagonal; c₀ is
//! the dipole. The images of a ring of N cells add up to Hurwitz zeta functions, Σ_p (n + pN)^(−s) = N^(−s) ζ(s, n/N).

use super::section::Section;

/// Terms of the series.
const TERMS: usize = 14;
/// The series is used from this many diagonals of a cell on: (1/6)²⁸ is 2e-22.
const DIAGONALS: f64 = 6.0;

/// What distant cells of a row do to each other, per volume of a cell.
#[derive(Clone, Debug)]
pub struct Series {
    /// `coefficients[c][k]` of 1/n^(2k+3), for xx, yy, zz.
    coefficients: [Vec<f64>; 3],
    first: usize,
}

impl Series {
    /// Point dipoles in cells of volume 1.
    pub fn of_dipoles() -> Series {
        let c = 0.25 / std::f64::consts::PI;
        Series { coefficients: [vec![-2.0 * c], vec![c], vec![c]], first: 1 }
    }

    /// Cells of 1 × width × thickness.
    pub fn of_cells(width: f64, thickness: f64) -> Series {
        let scale = width * thickness / std::f64::consts::PI;
        let column = |c: usize| (0..TERMS).map(|k| scale * coefficient(c, k, width, thickness)).collect();
        let diagonal = (1.0 + width * width + thickness * thickness).sqrt();
        Series { coefficients: [0, 1, 2].map(column), first: (DIAGONALS * diagonal).ceil() as usize }
    }

    /// Two cells of unequal sections on one axis: G = N/V, as in [`super::Pairs`].
    pub fn of_unequal_cells(a: Section, b: Section, multipoles: &Multipoles) -> Series {
        let diagonal = (1.0 + power(0.5 * (a[0] + b[0]), 2) + power(0.5 * (a[1] + b[1]), 2)).sqrt();
        Series { coefficients: multipoles.coefficients(a, b), first: (DIAGONALS * diagonal).ceil() as usize }
    }

    /// From how many cells apart on the series is exact to rounding.
    pub fn first(&self) -> usize {
        self.first
    }

    /// N of two cells n apart.
    pub fn at(&self, n: f64) -> [f64; 3] {
        let square = 1.0 / (n * n);
        let sum = |c: &Vec<f64>| c.iter().rev().fold(0.0, |sum, c| sum * square + c) * square / n;
        [0, 1, 2].map(|c: usize| sum(&self.coefficients[c]))
    }

    /// Σ N(n + pN) over p = 0, 1, 2, … for a ring of N cells.
    pub fn images(&self, n: f64, ring: f64) -> [f64; 3] {
        let mut sums = [0.0; 3];
        for k in 0..self.coefficients[0].len() {
            let s = 2 * k as i32 + 3;
            let images = power(1.0 / ring, s) * hurwitz_zeta(s, n / ring);
            for (sum, c) in sums.iter_mut().zip(&self.coefficients) {
                *sum += c[k] * images;
            }
        }
        sums
    }
}

/// Coefficient of 1/n^(2k+3): (2k+2)! times that of u^(2k+2) in ∓ sinh²(u/2) ⟨S …⟩.
fn coefficient(component: usize, k: usize, width: f64, thickness: f64) -> f64 {
    let sinc = |p: usize, edge: f64| {
        let sign = if p.is_multiple_of(2) { 2.0 } else { -2.0 };
        sign * power(edge, 2 * p as i32) / factorial(2 * p + 2)
    };
    let mut sum = 0.0;
    for m in 1..=k + 1 {
        for p in 0..=k + 1 - m {
            let q = k + 1 - m - p;
            let mean = match component {
                0 => -angular_mean(p, q),
                1 => angular_mean(p + 1, q),
                _ => angular_mean(p, q + 1),
            };
            sum += sinc(p, width) * sinc(q, thickness) * mean / (2.0 * factorial(2 * m));
        }
    }
    factorial(2 * k + 2) * sum
}

/// Numbers that the series of all pairs of sections share.
#[derive(Clone, Debug)]
pub struct Multipoles {
    /// ⟨cos^(2p) φ sin^(2q) φ⟩, p and q up to [`TERMS`].
    means: Vec<Vec<f64>>,
    /// 1/(2 (2m)!), the coefficients of sinh²(u/2).
    steps: Vec<f64>,
    /// (−1)^p/(2p + 1)!, the coefficients of sinc.
    sinc: Vec<f64>,
    /// (2k + 2)!.
    factorials: Vec<f64>,
}

impl Multipoles {
    /// Computed once.
    #[allow(clippy::new_without_default)]
    pub fn new() -> Multipoles {
        let sign = |p: usize| if p.is_multiple_of(2) { 1.0 } else { -1.0 };
        Multipoles {
            means: (0..=TERMS).map(|p| (0..=TERMS).map(|q| angular_mean(p, q)).collect()).collect(),
            steps: (0..=TERMS).map(|m| 0.5 / factorial(2 * m)).collect(),
            sinc: (0..TERMS).map(|p| sign(p) / factorial(2 * p + 1)).collect(),
            factorials: (0..TERMS).map(|k| factorial(2 * k + 2)).collect(),
        }
    }

    /// Of 1/n^(2k+3) for xx, yy, zz: as those of equal cells, with S = Π sinc(½uw_i cos φ) sinc(½ut_i sin φ) and per volume.
    fn coefficients(&self, a: Section, b: Section) -> [Vec<f64>; 3] {
        let (w, t) = (self.product(0.5 * a[0], 0.5 * b[0]), self.product(0.5 * a[1], 0.5 * b[1]));
        let of = |c: usize| {
            let mean = |p: usize, q: usize| match c {
                0 => -self.means[p][q],
                1 => self.means[p + 1][q],
                _ => self.means[p][q + 1],
            };
            let moments: Vec<f64> =
                (0..TERMS).map(|s| (0..=s).map(|p| w[p] * t[s - p] * mean(p, s - p)).sum()).collect();
            let term = |k: usize| (1..=k + 1).map(|m| self.steps[m] * moments[k + 1 - m]).sum::<f64>();
            (0..TERMS).map(|k| self.factorials[k] * term(k) / std::f64::consts::PI).collect()
        };
        [of(0), of(1), of(2)]
    }

    /// Coefficients of x^(2p) in sinc(ax) sinc(bx).
    fn product(&self, a: f64, b: f64) -> Vec<f64> {
        let powers = |x: f64| {
            let mut power = 1.0;
            let next = |s: &f64| {
                let value = s * power;
                power *= x * x;
                value
            };
            self.sinc.iter().map(next).collect::<Vec<f64>>()
        };
        let (a, b) = (powers(a), powers(b));
        (0..TERMS).map(|p| (0..=p).map(|i| a[i] * b[p - i]).sum()).collect()
    }
}

/// Mean of cos^(2p) φ sin^(2q) φ: (2p−1)!! (2q−1)!!/(2^(p+q) (p+q)!).
fn angular_mean(p: usize, q: usize) -> f64 {
    let odd = |n: usize| (0..n).fold(1.0, |f, i| f * (2 * i + 1) as f64);
    odd(p) * odd(q) / (1..=p + q).fold(1.0, |f, i| f * 2.0 * i as f64)
}

fn factorial(n: usize) -> f64 {
    (2..=n).fold(1.0, |f, i| f * i as f64)
}

/// xⁿ by squaring, the same bits everywhere.
fn power(x: f64, n: i32) -> f64 {
    let (mut result, mut square, mut left) = (1.0, x, n);
    while left > 0 {
        if left % 2 == 1 {
            result *= square;
        }
        square *= square;
        left /= 2;
    }
    result
}

/// ζ(s, x) = Σ_{k ≥ 0} (x + k)^(−s) for x > 0, s ≥ 3, by the Euler–Maclaurin formula.
pub fn hurwitz_zeta(s: i32, x: f64) -> f64 {
    /// B_2j/(2j)!.
    const BERNOULLI: [f64; 8] = [
        1.0 / 12.0,
        -1.0 / 720.0,
        1.0 / 30240.0,
        -1.0 / 1_209_600.0,
        1.0 / 47_900_160.0,
        -691.0 / 1_307_674_368_000.0,
        1.0 / 74_724_249_600.0,
        -3617.0 / 10_670_622_842_880_000.0,
    ];
    let start = 12.0 + f64::from(s);
    let terms = if x < start { (start - x).ceil() as usize } else { 0 };
    let y = x + terms as f64;
    let inverse = power(1.0 / y, s);
    let mut tail = inverse * (y / f64::from(s - 1) + 0.5);
    let mut factor = f64::from(s) * inverse / y;
    for (j, b) in BERNOULLI.iter().enumerate() {
        tail += b * factor;
        let next = f64::from(s + 2 * j as i32 + 1);
        factor *= next * (next + 1.0) / (y * y);
    }
    (0..terms).rev().fold(tail, |sum, k| sum + power(1.0 / (x + k as f64), s))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hurwitz_zeta_has_its_known_values_and_its_recurrence() {
        for (s, x, exact) in [
            (3, 1.0, 1.2020569031595942),
            (5, 1.0, 1.03692775514337),
            (3, 0.5, 8.41439832211716),
            (3, 0.01, 1000001.1701993386),
        ] {
            let found = hurwitz_zeta(s, x);
            assert!((found / exact - 1.0).abs() < 4e-16, "{s} {x} {found}");
        }
        for s in [3, 9, 29] {
            for x in [0.003, 0.4, 1.0, 7.5, 60.0] {
                let (a, b) = (hurwitz_zeta(s, x), hurwitz_zeta(s, x + 1.0) + power(1.0 / x, s));
                assert!((a / b - 1.0).abs() < 1e-14, "{s} {x}: {a:e} {b:e}");
            }
        }
    }

    #[test]
    fn the_first_term_is_the_dipole_of_a_cell() {
        let (cells, dipoles) = (Series::of_cells(2.0, 3.0), Series::of_dipoles());
        for c in 0..3 {
            assert!((cells.coefficients[c][0] / (6.0 * dipoles.coefficients[c][0]) - 1.0).abs() < 1e-15);
        }
    }
}
