//! Long vectors: sums in eight lanes, in a fixed order, so that they vectorise and give the same bits everywhere.

use multiversion::multiversion;

/// a · b.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    if a.len() > 4096 {
        let half = (a.len() / 2).next_multiple_of(8);
        return dot(&a[..half], &b[..half]) + dot(&a[half..], &b[half..]);
    }
    dot_short(a, b)
}

#[multiversion(targets("x86_64+avx2"))]
fn dot_short(a: &[f64], b: &[f64]) -> f64 {
    let (mut low, mut high) = ([0.0; 8], [0.0; 8]);
    let (a16, b16) = (a.chunks_exact(16), b.chunks_exact(16));
    let rest: f64 = a16.remainder().iter().zip(b16.remainder()).map(|(x, y)| x * y).sum();
    for (x, y) in a16.zip(b16) {
        for l in 0..8 {
            low[l] += x[l] * y[l];
            high[l] += x[8 + l] * y[8 + l];
        }
    }
    fold(low) + fold(high) + rest
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

/// The overlaps of `v` with all of `vectors`, tile by tile, so that v is read once.
pub fn overlaps(vectors: &[Vec<f64>], v: &[f64]) -> Vec<f64> {
    let mut sums = vec![0.0; vectors.len()];
    for first in (0..v.len()).step_by(WORK) {
        let tile = first..v.len().min(first + WORK);
        for (sum, b) in sums.iter_mut().zip(vectors) {
            *sum += dot_short(&b[tile.clone()], &v[tile.clone()]);
        }
    }
    sums
}

/// v ← v + Σ w_k v_k, tile by tile.
pub fn add_all(v: &mut [f64], weights: &[f64], vectors: &[Vec<f64>]) {
    for (k, tile) in v.chunks_mut(WORK).enumerate() {
        for (w, b) in weights.iter().zip(vectors) {
            add_scaled(tile, *w, &b[k * WORK..k * WORK + tile.len()]);
        }
    }
}

/// Numbers in a tile that stays in the first cache.
const WORK: usize = 2048;

/// |a − b|, the straight distance.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    let tile = |(a, b): (&[f64], &[f64])| {
        let mut difference = [0.0; 256];
        for (d, (a, b)) in difference.iter_mut().zip(a.iter().zip(b)) {
            *d = a - b;
        }
        dot(&difference, &difference)
    };
    let squares: f64 = a.chunks(256).zip(b.chunks(256)).map(tile).sum();
    squares.sqrt()
}

/// y ← y + s x.
#[multiversion(targets("x86_64+avx2"))]
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

/// The largest |a_k|; NaN if any entry is NaN or infinite.
#[multiversion(targets("x86_64+avx2"))]
pub fn max_abs(a: &[f64]) -> f64 {
    let (mut largest, mut poison) = ([0.0; 8], [0.0; 8]);
    let mut look = |lane: usize, x: f64| {
        largest[lane] = if x.abs() > largest[lane] { x.abs() } else { largest[lane] };
        poison[lane] += 0.0 * x;
    };
    for eight in a.chunks_exact(8) {
        for l in 0..8 {
            look(l, eight[l]);
        }
    }
    for x in a.chunks_exact(8).remainder() {
        look(0, *x);
    }
    largest.iter().fold(0.0, |m: f64, x| m.max(*x)) + fold(poison)
}

/// The largest |a_k|; entries that are no numbers do not count.
#[multiversion(targets("x86_64+avx2"))]
pub fn largest(a: &[f64]) -> f64 {
    let mut largest = [0.0; 16];
    let chunks = a.chunks_exact(16);
    let rest = chunks.remainder();
    for c in chunks {
        for l in 0..16 {
            largest[l] = if c[l].abs() > largest[l] { c[l].abs() } else { largest[l] };
        }
    }
    largest.iter().chain(rest).fold(0.0, |m: f64, x| m.max(x.abs()))
}

/// v minus its parts along orthonormal vectors, all taken at once.
pub fn without(v: &mut [f64], space: &[Vec<f64>]) {
    let parts: Vec<f64> = overlaps(space, v).iter().map(|o| -o).collect();
    add_all(v, &parts, space);
}

/// Two columns side by side: a_0, b_0, a_1, b_1, …
pub fn interleave(a: &[f64], b: &[f64], both: &mut Vec<f64>) {
    both.resize(2 * a.len(), 0.0);
    for ((pair, a), b) in both.chunks_exact_mut(2).zip(a).zip(b) {
        (pair[0], pair[1]) = (*a, *b);
    }
}

/// The two columns of [`interleave`].
pub fn deinterleave(both: &[f64], a: &mut Vec<f64>, b: &mut Vec<f64>) {
    a.resize(both.len() / 2, 0.0);
    b.resize(both.len() / 2, 0.0);
    for ((pair, a), b) in both.chunks_exact(2).zip(a).zip(b) {
        (*a, *b) = (pair[0], pair[1]);
    }
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
        assert_eq!(largest(&[[1.0; 20], [-3.0; 20], [f64::NAN; 20]].concat()), 3.0);
        let (mut v, columns) = (vec![1.0; 5000], [vec![2.0; 5000], (0..5000).map(f64::from).collect()]);
        let sums = overlaps(&columns, &v);
        assert_eq!(sums, [10_000.0, 12_497_500.0]);
        add_all(&mut v, &[0.5, -1.0], &columns);
        assert_eq!((v[0], v[4999]), (2.0, -4997.0));
        let mut many: Vec<f64> = (0..99).map(|k| -k as f64).collect();
        assert_eq!((max_abs(&many), distance(&many, &[0.0; 99])), (98.0, norm(&many)));
        many[17] = f64::NAN;
        assert!(max_abs(&many).is_nan());
    }
}
