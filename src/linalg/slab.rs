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

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
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

/// Makes a vector one of unit length, unless it is zero; the length that it had.
pub fn normalise(a: &mut [f64]) -> f64 {
    let size = norm(a);
    scale(a, 1.0 / size.max(f64::MIN_POSITIVE));
    size
}

/// Adds a vector of this length, roughly, that has a part of every mode: the multiples of the golden ratio, less their whole parts.
pub fn stir(a: &mut [f64], length: f64) {
    let each = length * (12.0 / a.len() as f64).sqrt();
    for (k, a) in a.iter_mut().enumerate() {
        *a += each * (((k + 1) as f64 * 0.618_033_988_749_894_9).fract() - 0.5);
    }
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

/// v ← v + Σ w_k v_k, tile by tile, four vectors at a time.
pub fn add_all(v: &mut [f64], weights: &[f64], vectors: &[Vec<f64>]) {
    for (k, tile) in v.chunks_mut(WORK).enumerate() {
        let here = k * WORK..k * WORK + tile.len();
        let (fours, rest) = (weights.chunks_exact(4), weights.chunks_exact(4).remainder());
        for (w, b) in fours.zip(vectors.chunks_exact(4)) {
            add_four(tile, [w[0], w[1], w[2], w[3]], [0, 1, 2, 3].map(|j| &b[j][here.clone()]));
        }
        for (w, b) in rest.iter().zip(&vectors[weights.len() - rest.len()..]) {
            add_scaled(tile, *w, &b[here.clone()]);
        }
    }
}

/// y ← (((y + s_0 x_0) + s_1 x_1) + s_2 x_2) + s_3 x_3.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn add_four(y: &mut [f64], s: [f64; 4], [a, b, c, d]: [&[f64]; 4]) {
    for ((((y, a), b), c), d) in y.iter_mut().zip(a).zip(b).zip(c).zip(d) {
        *y = *y + s[0] * a + s[1] * b + s[2] * c + s[3] * d;
    }
}

/// Numbers in a tile that stays in the first cache.
const WORK: usize = 2048;

/// y ← y + s x.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
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
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
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
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
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

/// v minus its parts along orthonormal vectors, all taken at once; these parts.
pub fn without(v: &mut [f64], space: &[Vec<f64>]) -> Vec<f64> {
    let parts = overlaps(space, v);
    let away: Vec<f64> = parts.iter().map(|o| -o).collect();
    add_all(v, &away, space);
    parts
}

/// Columns side by side: a_0, b_0, …, a_1, b_1, …
pub fn interleave(columns: &[Vec<f64>], together: &mut Vec<f64>) {
    let k = columns.len();
    together.resize(columns.iter().map(|c| c.len()).sum(), 0.0);
    for (j, column) in columns.iter().enumerate() {
        together[j..].iter_mut().step_by(k).zip(column).for_each(|(t, c)| *t = *c);
    }
}

/// A column beside one of zeros: a_0, 0, a_1, 0, …
pub fn spread(a: &[f64], both: &mut Vec<f64>) {
    both.resize(2 * a.len(), 0.0);
    for (pair, a) in both.chunks_exact_mut(2).zip(a) {
        (pair[0], pair[1]) = (*a, 0.0);
    }
}

/// Column j of k columns side by side.
pub fn one_of(together: &[f64], k: usize, j: usize, column: &mut Vec<f64>) {
    column.clear();
    column.extend(together.chunks_exact(k).map(|row| row[j]));
}

/// Calls `act` with each of so many columns side by side in turn.
pub fn one_by_one(together: &mut [f64], columns: usize, mut act: impl FnMut(&mut [f64])) {
    if columns == 1 {
        return act(together);
    }
    let mut one = Vec::new();
    for c in 0..columns {
        one_of(together, columns, c, &mut one);
        act(&mut one);
        together[c..].iter_mut().step_by(columns).zip(&one).for_each(|(x, o)| *x = *o);
    }
}

/// The products of `a` with two columns side by side.
pub fn dot_pairs(a: &[f64], both: &[f64]) -> [f64; 2] {
    if a.len() > 4096 {
        let half = (a.len() / 2).next_multiple_of(8);
        let [p, q] = dot_pairs(&a[..half], &both[..2 * half]);
        let [r, s] = dot_pairs(&a[half..], &both[2 * half..]);
        return [p + r, q + s];
    }
    dot_pairs_short(a, both)
}

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn dot_pairs_short(a: &[f64], both: &[f64]) -> [f64; 2] {
    let mut sums = [0.0; 16];
    let (a8, both8) = (a.chunks_exact(8), both.chunks_exact(16));
    let (a_rest, both_rest) = (a8.remainder(), both8.remainder());
    for (a, both) in a8.zip(both8) {
        for l in 0..16 {
            sums[l] += a[l / 2] * both[l];
        }
    }
    for (a, pair) in a_rest.iter().zip(both_rest.chunks_exact(2)) {
        sums[0] += a * pair[0];
        sums[1] += a * pair[1];
    }
    [0, 1].map(|c| fold([0, 1, 2, 3, 4, 5, 6, 7].map(|l| sums[2 * l + c])))
}

/// Adds the products of `a` with k columns side by side to `sums`.
pub fn add_dots(a: &[f64], together: &[f64], sums: &mut [f64]) {
    match sums {
        [] => {}
        [sum] => *sum += dot(a, together),
        [first, second] => {
            let [p, q] = dot_pairs(a, together);
            (*first, *second) = (*first + p, *second + q);
        }
        _ => {
            for (a, row) in a.iter().zip(together.chunks_exact(sums.len())) {
                sums.iter_mut().zip(row).for_each(|(sum, x)| *sum += a * x);
            }
        }
    }
}

/// x ← x + s_0 a + s_1 b of two columns side by side.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
pub fn add_pairs(x: &mut [f64], s: [f64; 2], both: &[f64]) {
    for (x, pair) in x.iter_mut().zip(both.chunks_exact(2)) {
        *x += s[0] * pair[0] + s[1] * pair[1];
    }
}

/// The same for any number of columns.
pub fn add_columns(x: &mut [f64], s: &[f64], together: &[f64]) {
    match *s {
        [] => {}
        [s] => add_scaled(x, s, together),
        [s, t] => add_pairs(x, [s, t], together),
        _ => {
            for (x, row) in x.iter_mut().zip(together.chunks_exact(s.len())) {
                *x += s.iter().zip(row).map(|(s, c)| s * c).sum::<f64>();
            }
        }
    }
}

/// Of two columns side by side and two others: a·c, b·c and b·d.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
pub fn cross_pairs(ab: &[f64], cd: &[f64]) -> [f64; 3] {
    let (mut straight, mut crossed) = ([0.0; 16], [0.0; 16]);
    let (ab16, cd16) = (ab.chunks_exact(16), cd.chunks_exact(16));
    let rest = ab16.remainder().chunks_exact(2).zip(cd16.remainder().chunks_exact(2));
    for (ab, cd) in ab16.zip(cd16) {
        for l in 0..16 {
            straight[l] += ab[l] * cd[l];
            crossed[l] += ab[l] * cd[l ^ 1];
        }
    }
    for (ab, cd) in rest {
        for l in 0..2 {
            straight[l] += ab[l] * cd[l];
            crossed[l] += ab[l] * cd[l ^ 1];
        }
    }
    let every_second = |sums: &[f64; 16], c: usize| fold([0, 1, 2, 3, 4, 5, 6, 7].map(|l| sums[2 * l + c]));
    [every_second(&straight, 0), every_second(&crossed, 1), every_second(&straight, 1)]
}

/// Of two columns side by side, the second ← s times it plus t times the first; and a copy of both.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
pub fn turn_second(both: &mut [f64], s: f64, t: f64, copy: &mut [f64]) {
    let (own, other) = ([1.0, s, 1.0, s, 1.0, s, 1.0, s], [0.0, t, 0.0, t, 0.0, t, 0.0, t]);
    let turn = |both: &mut [f64], copy: &mut [f64]| {
        for l in 0..both.len().min(8) {
            copy[l] = own[l] * both[l] + other[l] * both[l & !1];
        }
        both.copy_from_slice(copy);
    };
    let (eights, copies) = (both.chunks_exact_mut(8), copy.chunks_exact_mut(8));
    eights.zip(copies).for_each(|(both, copy)| turn(both, copy));
    let done = both.len() / 8 * 8;
    turn(&mut both[done..], &mut copy[done..]);
}

/// Σ (a − b).
pub fn sum_of_differences(a: &[f64], b: &[f64]) -> f64 {
    let mut room = [0.0; 256];
    let sums = a.chunks(256).zip(b.chunks(256)).map(|(a, b)| {
        room[..a.len()].iter_mut().zip(a.iter().zip(b)).for_each(|(d, (a, b))| *d = a - b);
        sum(&room[..a.len()])
    });
    sum(&sums.collect::<Vec<f64>>())
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
        for n in [1, 7, 8, 29, 5000] {
            let a: Vec<f64> = (0..n).map(|k| (k % 5) as f64).collect();
            let columns: Vec<Vec<f64>> = (1..4).map(|c| (0..n).map(|k| ((k * c) % 7) as f64).collect()).collect();
            let dots: Vec<f64> = columns.iter().map(|c| dot(&a, c)).collect();
            for k in 1..4 {
                let (mut together, mut sums, mut one) = (Vec::new(), vec![0.0; k], Vec::new());
                interleave(&columns[..k], &mut together);
                add_dots(&a, &together, &mut sums);
                assert_eq!(sums, dots[..k]);
                one_of(&together, k, k - 1, &mut one);
                assert_eq!(one, columns[k - 1]);
                let (mut x, mut expected) = (a.clone(), a.clone());
                add_columns(&mut x, &[1.0, -2.0, 3.0][..k], &together);
                (0..k).for_each(|c| add_scaled(&mut expected, [1.0, -2.0, 3.0][c], &columns[c]));
                assert_eq!(x, expected);
                if k == 2 {
                    let ([p, q], mut copy) = ([&columns[0], &columns[1]], vec![0.0; 2 * n]);
                    assert_eq!(cross_pairs(&together, &together), [dot(p, p), dot(p, q), dot(q, q)]);
                    turn_second(&mut together, 3.0, -1.0, &mut copy);
                    let turned: Vec<f64> = p.iter().zip(q).flat_map(|(p, q)| [*p, 3.0 * q - p]).collect();
                    assert_eq!((&together, &copy), (&turned, &turned));
                }
            }
            let mut pairs = Vec::new();
            spread(&a, &mut pairs);
            assert_eq!(dot_pairs(&columns[0], &pairs), [dots[0], 0.0]);
            assert_eq!(sum_of_differences(&a, &columns[0]), sum(&a) - sum(&columns[0]));
        }
        let mut many: Vec<f64> = (0..99).map(|k| -k as f64).collect();
        assert_eq!(max_abs(&many), 98.0);
        many[17] = f64::NAN;
        assert!(max_abs(&many).is_nan());
    }
}
