//! LDLᵀ of a long open chain from both ends at once, meeting in the middle: two eliminations that wait for nothing but their own
//! last pivots, side by side in the lanes of one register, with the next columns in registers too.
//!
//! ```text
//! unknowns   0 … h−1  │  h … n−h−1  │  n−h … n−1         (the middle has w or w + 1 of them)
//!            ───────▶ │ dense LDLᵀ  │ ◀─────────
//! ```
//! It is LDLᵀ of the matrix with its unknowns in another order: pivots, inertia and determinant are had as from any other.
//! The lower half keeps its multipliers where the entries were, in the columns of the unknowns they lead to. Meurant, SIAM J.
//! Matrix Anal. Appl. 13, 707 (1992), doi:10.1137/0613045, §2, has the factorisation under this name.

use super::Banded;
use super::pivot::guarded;
use wide::f64x2;

/// The two ends.
type Lanes = f64x2;

/// The half-bandwidth, if a matrix of this shape is eliminated from both ends.
pub fn width(m: &Banded) -> Option<usize> {
    ([1, 3, 5].contains(&m.width) && m.order >= 8 * (m.width + 1)).then_some(m.width)
}

/// Number of unknowns in each half.
fn half(m: &Banded) -> usize {
    (m.order - m.width) / 2
}

/// Entries of the i-th unknowns from both ends: the diagonal, then the couplings to the k-th unknowns further in.
#[inline(always)]
fn column<const S: usize>(band: &[f64], n: usize, i: usize) -> [Lanes; S] {
    // lengths that are plain to the compiler, so that it need not check each index
    let (top, bottom) = (&band[i * S..][..S], &band[(n - i - S) * S..][..S * S]);
    let mut c = [Lanes::ZERO; S];
    for k in 0..S {
        c[k] = Lanes::new([top[k], bottom[(S - 1 - k) * S + k]]);
    }
    c
}

/// Writes [`column`].
#[inline(always)]
fn set_column<const S: usize>(band: &mut [f64], n: usize, i: usize, c: [Lanes; S]) {
    let top = &mut band[i * S..][..S];
    for k in 0..S {
        top[k] = c[k].as_array()[0];
    }
    let bottom = &mut band[(n - i - S) * S..][..S * S];
    for k in 0..S {
        bottom[(S - 1 - k) * S + k] = c[k].as_array()[1];
    }
}

/// Elimination in place, with the forward half of the substitution for C interleaved right-hand sides on the way: it fits into
/// the time that the pivots take. W is the half-bandwidth, S = W + 1. The inverse pivots stand on the diagonal; returns how many
/// of them are negative.
pub fn eliminate<const W: usize, const S: usize, const C: usize>(m: &mut Banded, floor: f64, x: &mut [f64]) -> usize {
    let (n, h) = (m.order, half(m));
    let band = &mut m.band[..];
    let mut window = [[Lanes::ZERO; S]; S];
    let mut rows = [[Lanes::ZERO; C]; S];
    let mut negatives = 0;
    for k in 0..W {
        window[k] = column::<S>(band, n, k);
        rows[k] = row::<C>(x, n, k);
    }
    for i in 0..h {
        window[W] = column::<S>(band, n, i + W);
        rows[W] = row::<C>(x, n, i + W);
        let (c, here) = (window[0], rows[0]);
        let inverse = inverses(c[0], floor);
        negatives += inverse.as_array().iter().filter(|p| **p < 0.0).count();
        let mut l = [inverse; S];
        for k in 1..S {
            l[k] = c[k] * inverse;
            for q in k..S {
                window[k][q - k] -= c[k] * c[q] * inverse;
            }
        }
        set_column(band, n, i, l);
        for k in 1..S {
            window[k - 1] = window[k];
        }
        advance(&mut rows, &l);
        set_row(x, n, i, here);
    }
    // what the two ends have taken from the middle
    let middle = n - 2 * h;
    for p in 0..W {
        for q in 0..W - p {
            let (top, bottom) = ((h + p) * S + q, (n - 1 - h - p - q) * S + q);
            window[p][q] -= Lanes::new([band[top], band[bottom]]);
        }
    }
    for p in 0..W {
        for q in 0..W - p {
            let [top, bottom] = window[p][q].to_array();
            band[(h + p) * S + q] += top;
            band[(n - 1 - h - p - q) * S + q] += bottom;
        }
    }
    negatives += match middle == W {
        true => eliminate_middle::<W, S>(&mut band[h * S..], floor),
        false => eliminate_middle::<S, S>(&mut band[h * S..], floor),
    };
    take_from_middle::<W, S, C>(x, n, h, rows);
    negatives
}

/// 1/d; a pivot below the floor is replaced by that.
#[inline(always)]
fn inverses(d: Lanes, floor: f64) -> Lanes {
    let [top, bottom] = d.to_array();
    if top.abs() < floor || bottom.abs() < floor {
        return Lanes::ONE / Lanes::new([guarded(top, floor), guarded(bottom, floor)]);
    }
    Lanes::ONE / d
}

/// Dense elimination of the M unknowns in the middle, where `band` begins; they are all within the band.
fn eliminate_middle<const M: usize, const S: usize>(band: &mut [f64], floor: f64) -> usize {
    let band = &mut band[..M * S];
    let mut negatives = 0;
    for j in 0..M {
        let mut column = [0.0; S];
        column.copy_from_slice(&band[j * S..][..S]);
        let inverse = 1.0 / guarded(column[0], floor);
        negatives += usize::from(inverse < 0.0);
        band[j * S] = inverse;
        for b in j + 1..M {
            for a in b..M {
                band[b * S + a - b] -= column[b - j] * column[a - j] * inverse;
            }
            band[j * S + b - j] = column[b - j] * inverse;
        }
    }
    negatives
}

/// Rows of C interleaved right-hand sides, the i-th from both ends.
#[inline(always)]
fn row<const C: usize>(x: &[f64], n: usize, i: usize) -> [Lanes; C] {
    let (top, bottom) = (&x[i * C..][..C], &x[(n - 1 - i) * C..][..C]);
    let mut r = [Lanes::ZERO; C];
    for q in 0..C {
        r[q] = Lanes::new([top[q], bottom[q]]);
    }
    r
}

/// Writes [`row`].
#[inline(always)]
fn set_row<const C: usize>(x: &mut [f64], n: usize, i: usize, r: [Lanes; C]) {
    let top = &mut x[i * C..][..C];
    for q in 0..C {
        top[q] = r[q].as_array()[0];
    }
    let bottom = &mut x[(n - 1 - i) * C..][..C];
    for q in 0..C {
        bottom[q] = r[q].as_array()[1];
    }
}

/// Takes the first row of a window from the others, and moves on by one.
#[inline(always)]
fn advance<const S: usize, const C: usize>(rows: &mut [[Lanes; C]; S], l: &[Lanes; S]) {
    let here = rows[0];
    for k in 1..S {
        for q in 0..C {
            rows[k - 1][q] = rows[k][q] - l[k] * here[q];
        }
    }
}

/// Substitution for C interleaved right-hand sides.
pub fn substitute<const W: usize, const S: usize, const C: usize>(m: &Banded, x: &mut [f64]) {
    let (n, h, band) = (m.order, half(m), &m.band[..]);
    let mut rows = [[Lanes::ZERO; C]; S];
    for k in 0..W {
        rows[k] = row::<C>(x, n, k);
    }
    for i in 0..h {
        rows[W] = row::<C>(x, n, i + W);
        let here = rows[0];
        advance(&mut rows, &column::<S>(band, n, i));
        set_row(x, n, i, here);
    }
    take_from_middle::<W, S, C>(x, n, h, rows);
    substitute_back::<W, S, C>(m, x);
}

/// Adds to the middle rows what the two ends have made of them.
#[inline(always)]
fn take_from_middle<const W: usize, const S: usize, const C: usize>(
    x: &mut [f64],
    n: usize,
    h: usize,
    mut rows: [[Lanes; C]; S],
) {
    for p in 0..W {
        let before = row::<C>(x, n, h + p);
        for q in 0..C {
            rows[p][q] -= before[q];
        }
    }
    for p in 0..W {
        for q in 0..C {
            let [top, bottom] = rows[p][q].to_array();
            x[(h + p) * C + q] += top;
            x[(n - 1 - h - p) * C + q] += bottom;
        }
    }
}

/// The rest of the substitution: the middle, and from there to both ends.
pub fn substitute_back<const W: usize, const S: usize, const C: usize>(m: &Banded, x: &mut [f64]) {
    let (n, h, band) = (m.order, half(m), &m.band[..]);
    match n - 2 * h == W {
        true => substitute_middle::<W, S, C>(&band[h * S..], &mut x[h * C..]),
        false => substitute_middle::<S, S, C>(&band[h * S..], &mut x[h * C..]),
    }
    let mut rows = [[Lanes::ZERO; C]; S];
    for k in 0..W {
        rows[k + 1] = row::<C>(x, n, h + k);
    }
    for i in (0..h).rev() {
        let (mut here, l) = (row::<C>(x, n, i), column::<S>(band, n, i));
        for q in 0..C {
            here[q] *= l[0];
            for k in (1..S).rev() {
                here[q] -= l[k] * rows[k][q];
            }
        }
        for k in (1..W).rev() {
            rows[k + 1] = rows[k];
        }
        rows[1] = here;
        set_row(x, n, i, here);
    }
}

/// Solves for the M unknowns in the middle, where `band` and `x` begin.
fn substitute_middle<const M: usize, const S: usize, const C: usize>(band: &[f64], x: &mut [f64]) {
    let (band, x) = (&band[..M * S], &mut x[..M * C]);
    let l = |a: usize, b: usize| band[b * S + a - b];
    for q in 0..C {
        for b in 0..M {
            for a in b + 1..M {
                x[a * C + q] -= l(a, b) * x[b * C + q];
            }
        }
        for b in (0..M).rev() {
            let later: f64 = (b + 1..M).map(|a| l(a, b) * x[a * C + q]).sum();
            x[b * C + q] = x[b * C + q] * l(b, b) - later;
        }
    }
}
