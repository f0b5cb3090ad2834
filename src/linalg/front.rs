//! The elimination of the own columns of a front, dense: LDLᵀ by panels, and A ← A − L D Lᵀ on all that is left; and substitution.

use super::panels::{self, WIDTH};
use super::pivot::guarded;
use crate::threads::{READ, apiece};
use multiversion::multiversion;
use rayon::prelude::*;
use std::ops::Range;

/// Panels that are eliminated before the rest is brought up to date.
const BLOCK: usize = 16;
/// Rows that go through all panels of the rest together, and stay in the first cache.
const ROWS: usize = 36;
/// Rows of a tile in registers.
const TILE: usize = 12;
/// Multiplications that are worth waking a thread for.
const WORTH: usize = 1 << 20;

/// Numbers of a square of a panel.
const SQUARE: usize = WIDTH * WIDTH;

/// Eliminates all `columns` panels of a front of so many rows; the factors take the place of the entries, the pivots those of
/// `d`, and `rest` is the lower half of what is left. A pivot smaller than `floor` is replaced by that size, sign kept.
pub(super) fn eliminate(l: &mut [f64], rows: usize, rest: &mut [f64], d: &mut [f64], floor: f64, work: &mut Vec<f64>) {
    let columns = d.len() / WIDTH;
    let others = rows - d.len();
    for first in (0..columns).step_by(BLOCK) {
        let end = columns.min(first + BLOCK);
        for p in first..end {
            let (done, here) = l.split_at_mut(panels::first(rows, p));
            let here = &mut here[..WIDTH * (rows - WIDTH * p)];
            let sources = Sources { l: done, d, rows, first, end: p };
            sources.subtract(here, rows - WIDTH * p, 1, work);
            eliminate_panel(here, &mut d[WIDTH * p..WIDTH * (p + 1)], floor);
        }
        let (done, later) = l.split_at_mut(panels::first(rows, end));
        let sources = Sources { l: done, d, rows, first, end };
        sources.subtract(later, rows - WIDTH * end, columns - end, work);
        sources.subtract(rest, others, others.div_ceil(WIDTH), work);
    }
}

/// LDLᵀ of a panel: the square on the diagonal, then the rows below.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn eliminate_panel(panel: &mut [f64], d: &mut [f64], floor: f64) {
    let (square, below) = panel.split_at_mut(SQUARE);
    let mut inverse = [0.0; WIDTH];
    for k in 0..WIDTH {
        d[k] = guarded(square[WIDTH * k + k], floor);
        inverse[k] = 1.0 / d[k];
        for i in k + 1..WIDTH {
            let l = square[WIDTH * i + k] * inverse[k];
            for j in k + 1..=i {
                square[WIDTH * i + j] -= l * square[WIDTH * j + k];
            }
        }
        for i in k + 1..WIDTH {
            square[WIDTH * i + k] *= inverse[k];
        }
    }
    let l = |i: usize, j: usize| square[WIDTH * i + j];
    let [l10, l20, l21, l30, l31, l32] = [l(1, 0), l(2, 0), l(2, 1), l(3, 0), l(3, 1), l(3, 2)];
    for row in below.chunks_exact_mut(WIDTH) {
        let a = row[0];
        let b = row[1] - a * l10;
        let c = row[2] - a * l20 - b * l21;
        let e = row[3] - a * l30 - b * l31 - c * l32;
        row[0] = a * inverse[0];
        row[1] = b * inverse[1];
        row[2] = c * inverse[2];
        row[3] = e * inverse[3];
    }
}

/// Columns of L that were eliminated: panels `first` to `end` of a front of so many rows.
struct Sources<'a> {
    l: &'a [f64],
    d: &'a [f64],
    rows: usize,
    first: usize,
    end: usize,
}

impl Sources<'_> {
    /// A ← A − L D Lᵀ of the last `rows` rows of the front, panels of so many rows.
    fn subtract(&self, target: &mut [f64], rows: usize, columns: usize, work: &mut Vec<f64>) {
        let depth = SQUARE * (self.end - self.first);
        if depth == 0 || columns == 0 {
            return;
        }
        let above = self.rows - rows;
        work.resize(depth * columns, 0.0);
        let scaled = work.par_chunks_exact_mut(depth).enumerate().with_min_len(apiece(depth, READ));
        scaled.for_each(|(q, scaled)| self.scale(above + WIDTH * q, scaled));
        self.subtract_panels(target, rows, 0..columns, work);
    }

    /// The same of some of the panels, where the columns of all are scaled; several at a time where they are long.
    fn subtract_panels(&self, target: &mut [f64], rows: usize, columns: Range<usize>, scaled: &[f64]) {
        let depth = SQUARE * (self.end - self.first);
        if target.len() * depth / WIDTH > WORTH && columns.len() > 1 {
            let middle = columns.start.midpoint(columns.end);
            let (before, after) = target.split_at_mut(panels::first(rows, middle) - panels::first(rows, columns.start));
            rayon::join(
                || self.subtract_panels(before, rows, columns.start..middle, scaled),
                || self.subtract_panels(after, rows, middle..columns.end, scaled),
            );
            return;
        }
        let (above, from_here) = (self.rows - rows, panels::first(rows, columns.start));
        for start in (WIDTH * columns.start..rows).step_by(ROWS) {
            let end = rows.min(start + ROWS);
            for q in columns.start..columns.end.min(end.div_ceil(WIDTH)) {
                let (scaled, top) = (&scaled[depth * q..depth * (q + 1)], WIDTH * q);
                let from = start.max(top);
                let panel =
                    &mut target[panels::first(rows, q) - from_here..][WIDTH * (from - top)..WIDTH * (end - top)];
                subtract_tiles(panel, self.l, [self.rows, self.first, above + from], scaled);
            }
        }
    }

    /// D Lᵀ of the four rows from `row` on, where there are so many: column after column of L.
    fn scale(&self, row: usize, scaled: &mut [f64]) {
        for (p, square) in (self.first..self.end).zip(scaled.chunks_exact_mut(SQUARE)) {
            let source = &self.l[panels::first(self.rows, p)..][WIDTH * (row - WIDTH * p)..];
            let d = &self.d[WIDTH * p..WIDTH * (p + 1)];
            let there = WIDTH.min(self.rows - row);
            square.fill(0.0);
            for c in 0..there {
                for k in 0..WIDTH {
                    square[WIDTH * k + c] = d[k] * source[WIDTH * c + k];
                }
            }
        }
    }
}

/// The rows of a panel from `row` of the front on; its eliminated panels begin with `first`.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn subtract_tiles(panel: &mut [f64], l: &[f64], [rows, first, mut row]: [usize; 3], scaled: &[f64]) {
    let mut tiles = panel.chunks_exact_mut(TILE * WIDTH);
    for tile in &mut tiles {
        subtract_tile::<TILE>(tile, l, [rows, first, row], scaled);
        row += TILE;
    }
    for tile in tiles.into_remainder().chunks_exact_mut(2 * WIDTH) {
        subtract_tile::<2>(tile, l, [rows, first, row], scaled);
        row += 2;
    }
}

/// R rows of a panel, in registers.
#[inline(always)]
fn subtract_tile<const R: usize>(tile: &mut [f64], l: &[f64], [rows, first, row]: [usize; 3], scaled: &[f64]) {
    let mut sums = [[0.0; WIDTH]; R];
    for (p, x) in scaled.chunks_exact(SQUARE).enumerate() {
        let p = first + p;
        let source = &l[panels::first(rows, p) + WIDTH * (row - WIDTH * p)..][..R * WIDTH];
        for k in 0..WIDTH {
            for r in 0..R {
                for c in 0..WIDTH {
                    sums[r][c] += source[WIDTH * r + k] * x[WIDTH * k + c];
                }
            }
        }
    }
    for r in 0..R {
        for c in 0..WIDTH {
            tile[WIDTH * r + c] -= sums[r][c];
        }
    }
}

/// w ← L⁻¹ w, where the unknowns that are not the front's own take −L w.
#[inline(always)]
pub(super) fn forward<const C: usize>(l: &[f64], panels: usize, w: &mut [[f64; C]]) {
    let rows = w.len();
    for p in 0..panels {
        let (square, below) = l[panels::first(rows, p)..panels::first(rows, p + 1)].split_at(WIDTH * WIDTH);
        let (own, rest) = w[WIDTH * p..].split_at_mut(WIDTH);
        for r in 1..WIDTH {
            for k in 0..r {
                (0..C).for_each(|c| own[r][c] -= square[WIDTH * r + k] * own[k][c]);
            }
        }
        for (l, w) in below.as_chunks::<WIDTH>().0.iter().zip(rest) {
            for c in 0..C {
                w[c] -= (l[0] * own[0][c] + l[1] * own[1][c]) + (l[2] * own[2][c] + l[3] * own[3][c]);
            }
        }
    }
}

/// w ← L⁻ᵀ w of the front's own unknowns, where the others are known.
#[inline(always)]
pub(super) fn backward<const C: usize>(l: &[f64], panels: usize, w: &mut [[f64; C]]) {
    let rows = w.len();
    for p in (0..panels).rev() {
        let (square, below) = l[panels::first(rows, p)..panels::first(rows, p + 1)].split_at(WIDTH * WIDTH);
        let (own, rest) = w[WIDTH * p..].split_at_mut(WIDTH);
        let mut sums = [[0.0; C]; WIDTH];
        for (l, w) in below.as_chunks::<WIDTH>().0.iter().zip(rest) {
            for k in 0..WIDTH {
                (0..C).for_each(|c| sums[k][c] += l[k] * w[c]);
            }
        }
        for k in (0..WIDTH).rev() {
            for r in k + 1..WIDTH {
                (0..C).for_each(|c| sums[k][c] += square[WIDTH * r + k] * own[r][c]);
            }
            (0..C).for_each(|c| own[k][c] -= sums[k][c]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn fronts_of_all_sizes_are_eliminated_as_by_the_textbook() {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(41);
        for columns in [1, 2, 3, BLOCK - 1, BLOCK, BLOCK + 1, 2 * BLOCK + 3] {
            for others in [0, 2, 4, 6, 14, ROWS + 2] {
                let rows = WIDTH * columns + others;
                let mut a = vec![0.0; rows * rows];
                for i in 0..rows {
                    for j in 0..=i {
                        let level = if i != j {
                            0.0
                        } else if i % 3 == 0 {
                            -2.0
                        } else {
                            2.0
                        } * rows as f64;
                        a[i * rows + j] = r.random_range(-1.0..1.0) + level;
                    }
                }
                let mut l = vec![0.0; panels::length(rows, columns)];
                let mut rest = vec![0.0; panels::length(others, others.div_ceil(WIDTH))];
                let own = WIDTH * columns;
                let at = |rows: usize, i: usize, j: usize| {
                    panels::first(rows, j / WIDTH) + WIDTH * (i - j / WIDTH * WIDTH) + j % WIDTH
                };
                for i in 0..rows {
                    for j in 0..=i {
                        let to = if j < own { &mut l[at(rows, i, j)] } else { &mut rest[at(others, i - own, j - own)] };
                        *to = a[i * rows + j];
                    }
                }
                let mut d = vec![0.0; own];
                eliminate(&mut l, rows, &mut rest, &mut d, 0.0, &mut Vec::new());
                for k in 0..own {
                    for i in k + 1..rows {
                        let factor = a[i * rows + k] / a[k * rows + k];
                        for j in k + 1..=i {
                            a[i * rows + j] -= factor * a[j * rows + k];
                        }
                    }
                    for i in k + 1..rows {
                        a[i * rows + k] /= a[k * rows + k];
                    }
                }
                for i in 0..rows {
                    for j in 0..=i {
                        let got = match (i == j, j < own) {
                            (true, true) => d[j],
                            (false, true) => l[at(rows, i, j)],
                            _ => rest[at(others, i - own, j - own)],
                        };
                        let error = (got - a[i * rows + j]).abs();
                        assert!(error < 1e-12 * rows as f64, "{columns} {others}: ({i}, {j}) {error:e}");
                    }
                }
            }
        }
    }
}
