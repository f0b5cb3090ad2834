//! Numbers of about 31 digits, as sums of two doubles: for closed forms whose terms nearly cancel.
//!
//! Dekker, Numer. Math. 18, 224 (1971), doi:10.1007/BF01397083 (exact sums and products); logarithm and arctangent by square
//! roots that bring the argument near 1 or 0, and their power series there.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// ln 2.
const LN_2: DoubleDouble = DoubleDouble { hi: std::f64::consts::LN_2, lo: 2.3190468138462996e-17 };
/// π/2.
const HALF_PI: DoubleDouble = DoubleDouble { hi: std::f64::consts::FRAC_PI_2, lo: 6.123233995736766e-17 };

/// hi + lo, |lo| at most half a unit in the last place of hi.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubleDouble {
    hi: f64,
    lo: f64,
}

impl From<f64> for DoubleDouble {
    fn from(x: f64) -> DoubleDouble {
        DoubleDouble { hi: x, lo: 0.0 }
    }
}

/// a + b and its rounding error.
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    let c = s - a;
    (s, (a - (s - c)) + (b - c))
}

/// a + b and its rounding error, where |a| ≥ |b|.
fn quick_two_sum(a: f64, b: f64) -> DoubleDouble {
    let s = a + b;
    DoubleDouble { hi: s, lo: b - (s - a) }
}

/// The upper and the lower half of the digits.
fn halves(a: f64) -> (f64, f64) {
    let t = 134_217_729.0 * a;
    let hi = t - (t - a);
    (hi, a - hi)
}

/// a b and its rounding error.
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let p = a * b;
    let ((ah, al), (bh, bl)) = (halves(a), halves(b));
    (p, ((ah * bh - p) + ah * bl + al * bh) + al * bl)
}

impl Add for DoubleDouble {
    type Output = DoubleDouble;
    fn add(self, b: DoubleDouble) -> DoubleDouble {
        let (s, e) = two_sum(self.hi, b.hi);
        let (t, f) = two_sum(self.lo, b.lo);
        let v = quick_two_sum(s, e + t);
        quick_two_sum(v.hi, v.lo + f)
    }
}

impl Neg for DoubleDouble {
    type Output = DoubleDouble;
    fn neg(self) -> DoubleDouble {
        DoubleDouble { hi: -self.hi, lo: -self.lo }
    }
}

impl Sub for DoubleDouble {
    type Output = DoubleDouble;
    fn sub(self, b: DoubleDouble) -> DoubleDouble {
        self + (-b)
    }
}

impl Mul for DoubleDouble {
    type Output = DoubleDouble;
    fn mul(self, b: DoubleDouble) -> DoubleDouble {
        let (p, e) = two_product(self.hi, b.hi);
        quick_two_sum(p, e + (self.hi * b.lo + self.lo * b.hi))
    }
}

impl Div for DoubleDouble {
    type Output = DoubleDouble;
    fn div(self, b: DoubleDouble) -> DoubleDouble {
        let mut quotient = DoubleDouble::from(0.0);
        let mut rest = self;
        for _ in 0..3 {
            let digit = DoubleDouble::from(rest.hi / b.hi);
            quotient = quotient + digit;
            rest = rest - b * digit;
        }
        quotient
    }
}

impl DoubleDouble {
    /// The nearest double.
    pub fn to_f64(self) -> f64 {
        self.hi + self.lo
    }

    /// √x; 0 for what is not positive.
    pub fn sqrt(self) -> DoubleDouble {
        if self.hi <= 0.0 {
            return DoubleDouble::from(0.0);
        }
        let root = DoubleDouble::from(self.hi.sqrt());
        let rest = self - root * root;
        root + DoubleDouble::from(rest.hi / (2.0 * root.hi))
    }

    /// ln x for x > 0.
    pub fn ln(self) -> DoubleDouble {
        let (fraction, mut exponent) = libm::frexp(self.hi);
        if fraction < std::f64::consts::FRAC_1_SQRT_2 {
            exponent -= 1;
        }
        let power = DoubleDouble::from(libm::ldexp(1.0, -exponent));
        let mut x = self * power;
        for _ in 0..3 {
            x = x.sqrt();
        }
        let one = DoubleDouble::from(1.0);
        let z = (x - one) / (x + one);
        DoubleDouble::from(16.0) * odd_series(z, z * z) + DoubleDouble::from(f64::from(exponent)) * LN_2
    }

    /// arctan x for x ≥ 0.
    pub fn atan(self) -> DoubleDouble {
        let one = DoubleDouble::from(1.0);
        if self.hi > 1.0 {
            return HALF_PI - (one / self).atan();
        }
        let mut x = self;
        for _ in 0..4 {
            x = x / (one + (one + x * x).sqrt());
        }
        DoubleDouble::from(16.0) * odd_series(x, -(x * x))
    }
}

/// z (1 + s/3 + s²/5 + …), for |s| < 0.003: artanh z with s = z², arctan z with s = −z².
fn odd_series(z: DoubleDouble, s: DoubleDouble) -> DoubleDouble {
    let mut sum = DoubleDouble::from(0.0);
    for k in (0..14).rev() {
        sum = sum * s + DoubleDouble::from(1.0) / DoubleDouble::from(f64::from(2 * k + 1));
    }
    z * sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// |x − (hi + lo)| in parts of hi.
    fn error(x: DoubleDouble, hi: f64, lo: f64) -> f64 {
        ((x - DoubleDouble { hi, lo }).to_f64() / hi).abs()
    }

    #[test]
    fn thirty_digits_of_arithmetic_roots_logarithms_and_arctangents() {
        let third = DoubleDouble::from(1.0) / DoubleDouble::from(3.0);
        assert!(error(third, 0.3333333333333333, 1.850371707708594e-17) < 1e-31);
        assert!(error(DoubleDouble::from(2.0).sqrt(), std::f64::consts::SQRT_2, -9.667293313452913e-17) < 1e-31);
        assert!(error(DoubleDouble::from(10.0).ln(), std::f64::consts::LN_10, -2.1707562233822494e-16) < 1e-30);
        assert!(error(DoubleDouble::from(1.0).atan(), std::f64::consts::FRAC_PI_4, 3.061616997868383e-17) < 1e-31);
        assert!(
            error(DoubleDouble::from(1e-3).atan() + DoubleDouble::from(1e3).atan(), HALF_PI.hi, HALF_PI.lo) < 1e-17
        );
        let (a, b) = (DoubleDouble::from(0.3).atan(), (DoubleDouble::from(1.0) / DoubleDouble::from(0.3)).atan());
        assert!(error(a + b, HALF_PI.hi, HALF_PI.lo) < 1e-31);
        for x in [1e-6, 0.7, 0.71, 1.0 + 1e-9, 123.456] {
            let x = DoubleDouble::from(x);
            let sum = x.ln() + (x * x).ln() - (x * x * x).ln();
            assert!(sum.to_f64().abs() < 1e-29 * (1.0 + x.ln().to_f64().abs()), "{sum:?}");
        }
    }
}
