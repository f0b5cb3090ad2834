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
use super::ldl::guarded;

/// The two ends.
type Lanes = [f64; 2];

/// The half-bandwidth, if a matrix of this shape is eliminated from both ends.
pub fn width(m: &Banded) -> Option<usize> {
    ([1, 3, 5].contains(&m.width) && m.border == 0 && m.inner >= 8 * (m.width + 1)).then_some(m.width)
}

/// Number of unknowns in each half.
fn half(m: &Banded) -> usize {
    (m.inner - m.width) / 2
}

/// Entries of the i-th unknowns from both ends: the diagonal, then the couplings to the k-th unknowns further in.
#[inline(always)]
fn column<const S: usize>(band: &[f64], n: usize, i: usize) -> [Lanes; S] {
    let (top, bottom) = (&band[i * S..(i + 1) * S], &band[(n - i - S) * S..(n - i) * S]);
    let mut c = [[0.0; 2]; S];
    for k in 0..S {
        c[k] = [top[k], bottom[(S - 1 - k) * S + k]];
    }
    c
}

/// Elimination in place; W is the half-bandwidth, S = W + 1.
pub fn eliminate<const W: usize, const S: usize>(m: &mut Banded, floor: f64) {
    let (n, h) = (m.inner, half(m));
    let band = &mut m.band[..];
    let mut window = [[[0.0; 2]; S]; S];
    for k in 0..W {
        window[k] = column::<S>(band, n, k);
    }
    for i in 0..h {
        window[W] = column::<S>(band, n, i + W);
        let c = window[0];
        let d = [guarded(c[0][0], floor), guarded(c[0][1], floor)];
        let inverse = [1.0 / d[0], 1.0 / d[1]];
        for k in 1..S {
            for q in k..S {
                for l in 0..2 {
                    window[k][q - k][l] -= c[k][l] * c[q][l] * inverse[l];
                }
            }
        }
        let top = &mut band[i * S..(i + 1) * S];
        top[0] = d[0];
        for k in 1..S {
            top[k] = c[k][0] * inverse[0];
        }
        let bottom = &mut band[(n - i - S) * S..(n - i) * S];
        bottom[(S - 1) * S] = d[1];
        for k in 1..S {
            bottom[(S - 1 - k) * S + k] = c[k][1] * inverse[1];
        }
        for k in 1..S {
            window[k - 1] = window[k];
        }
    }
    // what the two ends have taken from the middle
    let middle = n - 2 * h;
    for p in 0..W {
        for q in 0..W - p {
            let (top, bottom) = ((h + p) * S + q, (n - 1 - h - p - q) * S + q);
            let taken = [window[p][q][0] - band[top], window[p][q][1] - band[bottom]];
            window[p][q] = taken;
        }
    }
    for p in 0..W {
        for q in 0..W - p {
            band[(h + p) * S + q] += window[p][q][0];
            band[(n - 1 - h - p - q) * S + q] += window[p][q][1];
        }
    }
    eliminate_middle::<S>(band, h, middle, floor);
}

/// Dense elimination of the `middle` unknowns from h on, which are all within the band.
fn eliminate_middle<const S: usize>(band: &mut [f64], h: usize, middle: usize, floor: f64) {
    for j in 0..middle {
        let d = guarded(band[(h + j) * S], floor);
        band[(h + j) * S] = d;
        for b in j + 1..middle {
            for a in b..middle {
                let (cb, ca) = (band[(h + j) * S + b - j], band[(h + j) * S + a - j]);
                band[(h + b) * S + a - b] -= cb * ca / d;
            }
        }
        for a in j + 1..middle {
            band[(h + j) * S + a - j] /= d;
        }
    }
}

/// Rows of C interleaved right-hand sides, the i-th from both ends.
#[inline(always)]
fn row<const C: usize>(x: &[f64], n: usize, i: usize) -> [Lanes; C] {
    let (top, bottom) = (&x[i * C..(i + 1) * C], &x[(n - 1 - i) * C..(n - i) * C]);
    let mut r = [[0.0; 2]; C];
    for q in 0..C {
        r[q] = [top[q], bottom[q]];
    }
    r
}

/// Substitution for C interleaved right-hand sides.
pub fn substitute<const W: usize, const S: usize, const C: usize>(m: &Banded, x: &mut [f64]) {
    let (n, h, band) = (m.inner, half(m), &m.band[..]);
    let mut window = [[[0.0; 2]; C]; S];
    for k in 0..W {
        window[k] = row::<C>(x, n, k);
    }
    for i in 0..h {
        window[W] = row::<C>(x, n, i + W);
        let (here, l) = (window[0], column::<S>(band, n, i));
        for k in 1..S {
            for q in 0..C {
                for e in 0..2 {
                    window[k - 1][q][e] = window[k][q][e] - l[k][e] * here[q][e];
                }
            }
        }
        for q in 0..C {
            (x[i * C + q], x[(n - 1 - i) * C + q]) = (here[q][0], here[q][1]);
        }
    }
    for p in 0..W {
        let before = row::<C>(x, n, h + p);
        for q in 0..C {
            window[p][q] = [window[p][q][0] - before[q][0], window[p][q][1] - before[q][1]];
        }
    }
    for p in 0..W {
        for q in 0..C {
            x[(h + p) * C + q] += window[p][q][0];
            x[(n - 1 - h - p) * C + q] += window[p][q][1];
        }
    }
    substitute_middle::<S, C>(band, h, n - 2 * h, x);
    for k in 0..W {
        window[k + 1] = row::<C>(x, n, h + k);
    }
    for i in (0..h).rev() {
        let (mut here, l) = (row::<C>(x, n, i), column::<S>(band, n, i));
        let inverse = [1.0 / l[0][0], 1.0 / l[0][1]];
        for q in 0..C {
            for e in 0..2 {
                here[q][e] *= inverse[e];
                for k in (1..S).rev() {
                    here[q][e] -= l[k][e] * window[k][q][e];
                }
            }
        }
        for k in (1..W).rev() {
            window[k + 1] = window[k];
        }
        window[1] = here;
        for q in 0..C {
            (x[i * C + q], x[(n - 1 - i) * C + q]) = (here[q][0], here[q][1]);
        }
    }
}

/// Solves for the middle.
fn substitute_middle<const S: usize, const C: usize>(band: &[f64], h: usize, middle: usize, x: &mut [f64]) {
    let l = |a: usize, b: usize| band[(h + b) * S + a - b];
    for q in 0..C {
        let at = |a: usize| (h + a) * C + q;
        for b in 0..middle {
            for a in b + 1..middle {
                x[at(a)] -= l(a, b) * x[at(b)];
            }
        }
        for b in (0..middle).rev() {
            let later: f64 = (b + 1..middle).map(|a| l(a, b) * x[at(a)]).sum();
            x[at(b)] = x[at(b)] / l(b, b) - later;
        }
    }
}
