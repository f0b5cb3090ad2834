//! Long vectors: sums in eight lanes, in a fixed order, so that they vectorise and give the same bits everywhere.

/// a · b.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    if a.len() > 4096 {
        let half = (a.len() / 2).next_multiple_of(8);
        return dot(&a[..half], &b[..half]) + dot(&a[half..], &b[half..]);
    }
    let mut lanes = [0.0; 8];
    let (a8, b8) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest: f64 = a8.remainder().iter().zip(b8.remainder()).map(|(x, y)| x * y).sum();
    for (x, y) in a8.zip(b8) {
        for l in 0..8 {
            lanes[l] += x[l] * y[l];
        }
    }
    fold(lanes) + rest
}

/// Σ a.
pub fn sum(values: &[f64]) -> f64 {
    if values.len() > 256 {
        let half = (values.len() / 2).next_multiple_of(8);
        return sum(&values[..half]) + sum(&values[half..]);
    }
    let mut lanes = [0.0; 8];
    let chunks = values.chunks_exact(8);
    let rest: f64 = chunks.remainder().iter().sum();
    for c in chunks {
        for l in 0..8 {
            lanes[l] += c[l];
        }
    }
    fold(lanes) + rest
}

/// The sum of eight lanes, in a fixed order.
#[inline]
pub fn fold(a: [f64; 8]) -> f64 {
    ((a[0] + a[4]) + (a[1] + a[5])) + ((a[2] + a[6]) + (a[3] + a[7]))
}

/// |a|.
pub fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

/// y ← y + s x.
pub fn add_scaled(y: &mut [f64], s: f64, x: &[f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += s * x;
    }
}

/// y ← s y.
pub fn scale(y: &mut [f64], s: f64) {
    for y in y {
        *y *= s;
    }
}

/// The largest |a_k|; NaN if any entry is NaN.
pub fn max_abs(a: &[f64]) -> f64 {
    a.iter().fold(0.0, |m: f64, x| if m.is_nan() || x.is_nan() { f64::NAN } else { m.max(x.abs()) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_of_any_length_are_right() {
        for n in [0, 1, 7, 8, 9, 255, 257, 4095, 4099, 20_001] {
            let a: Vec<f64> = (0..n).map(|k| k as f64).collect();
            let expected = (n as f64 - 1.0) * n as f64 / 2.0;
            assert_eq!(sum(&a), expected.max(0.0));
            let ones = vec![1.0; n];
            assert_eq!(dot(&a, &ones), expected.max(0.0));
        }
        assert!(max_abs(&[1.0, f64::NAN, 2.0]).is_nan());
        assert_eq!(max_abs(&[1.0, -3.0]), 3.0);
    }
}
