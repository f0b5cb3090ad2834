//! Sparse matrices to be multiplied by: rows one after another whose columns each follow those of the row before are a run, and are
//! worked on together.

use super::{Rows, Wide};
use multiversion::multiversion;
use std::sync::Arc;

/// A matrix, run after run.
#[derive(Clone, Debug)]
pub struct Runs {
    pattern: Arc<Pattern>,
    /// Of every run the entries of its first column row after row, then those of the next.
    entries: Vec<f64>,
}

/// Where its entries are.
#[derive(Debug, Default)]
struct Pattern {
    rows: usize,
    columns: usize,
    runs: Vec<Run>,
    /// The columns of the first row of every run.
    at: Vec<u32>,
}

/// Rows with as many columns each.
#[derive(Clone, Copy, Debug)]
struct Run {
    rows: u32,
    columns: u32,
}

impl Runs {
    /// The same matrix.
    pub fn of(matrix: &Rows) -> Runs {
        let mut pattern = Pattern { rows: matrix.order(), columns: matrix.columns(), ..Pattern::default() };
        let mut first = 0;
        while first < matrix.order() {
            let columns = |t: usize| matrix.row(first + t).map(move |(j, _)| j);
            let follows = |t: &usize| columns(*t).eq(columns(0).map(|j| j + t));
            let rows = (0..matrix.order() - first).take_while(follows).count();
            pattern.at.extend(columns(0).map(|j| j as u32));
            pattern.runs.push(Run { rows: rows as u32, columns: columns(0).count() as u32 });
            first += rows;
        }
        pattern.runs.shrink_to_fit();
        pattern.at.shrink_to_fit();
        Runs { pattern: Arc::new(pattern), entries: Vec::new() }.with(matrix)
    }

    /// Another matrix that has entries only where this one has some.
    pub fn with(&self, matrix: &Rows) -> Runs {
        let mut entries = Vec::with_capacity(self.pattern.entries());
        let mut first = 0;
        for (run, at) in self.pattern.each() {
            let (len, here) = (run.rows as usize, entries.len());
            entries.resize(here + len * at.len(), 0.0);
            for t in 0..len {
                let mut columns = at.iter().enumerate();
                for (j, a) in matrix.row(first + t) {
                    let k = columns.find(|(_, first)| **first as usize + t == j).expect("a column of the run").0;
                    entries[here + k * len + t] = a;
                }
            }
            first += len;
        }
        Runs { pattern: self.pattern.clone(), entries }
    }

    /// This + s times one of the same pattern.
    pub fn plus(&self, s: f64, other: &Runs) -> Runs {
        let entries = self.entries.iter().zip(&other.entries).map(|(a, b)| a + s * b).collect();
        Runs { pattern: self.pattern.clone(), entries }
    }

    /// Number of rows.
    pub fn order(&self) -> usize {
        self.pattern.rows
    }

    /// Tells row, column and entry of each.
    pub fn each(&self, mut tell: impl FnMut(usize, usize, f64)) {
        let (mut first, mut left) = (0, &self.entries[..]);
        for (run, at) in self.pattern.each() {
            let len = run.rows as usize;
            for j in at {
                let (entries, rest) = left.split_at(len);
                entries.iter().enumerate().for_each(|(t, a)| tell(first + t, *j as usize + t, *a));
                left = rest;
            }
            first += len;
        }
    }

    /// out ← out + sign A x.
    pub fn add(&self, sign: f64, x: &[Wide], out: &mut [Wide]) {
        add(&self.pattern, &self.entries, sign, &x[..self.pattern.columns], &mut out[..self.pattern.rows]);
    }
}

impl Pattern {
    /// How many.
    fn entries(&self) -> usize {
        self.runs.iter().map(|run| run.rows as usize * run.columns as usize).sum()
    }

    fn each(&self) -> impl Iterator<Item = (Run, &[u32])> {
        let mut left = &self.at[..];
        self.runs.iter().map(move |run| {
            let (at, rest) = left.split_at(run.columns as usize);
            left = rest;
            (*run, at)
        })
    }
}

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn add(pattern: &Pattern, entries: &[f64], sign: f64, x: &[Wide], out: &mut [Wide]) {
    let (mut left, mut out) = (entries, out);
    for (run, at) in pattern.each() {
        let len = run.rows as usize;
        let (entries, rest) = left.split_at(len * at.len());
        let (here, others) = out.split_at_mut(len);
        // rows without columns have nothing to add
        let mut t = if at.is_empty() { len } else { 0 };
        while t + TILE <= len {
            tile(&mut here[t..t + TILE], t, len, at, entries, sign, x);
            t += TILE;
        }
        for (t, out) in here.iter_mut().enumerate().skip(t) {
            row(out, t, len, at, entries, sign, x);
        }
        (left, out) = (rest, others);
    }
}

/// Rows of a run that are worked on side by side.
const TILE: usize = 4;

#[inline(always)]
fn tile(out: &mut [Wide], t: usize, len: usize, at: &[u32], entries: &[f64], sign: f64, x: &[Wide]) {
    let mut sums = [[0.0; 4]; TILE];
    for (j, entries) in at.iter().zip(entries.chunks_exact(len)) {
        let (x, a) = (&x[*j as usize + t..][..TILE], &entries[t..][..TILE]);
        for r in 0..TILE {
            (0..4).for_each(|c| sums[r][c] += a[r] * x[r][c]);
        }
    }
    for (out, sum) in out.iter_mut().zip(sums) {
        (0..4).for_each(|c| out[c] += sign * sum[c]);
    }
}

/// One row of a run.
#[inline(always)]
fn row(out: &mut Wide, t: usize, len: usize, at: &[u32], entries: &[f64], sign: f64, x: &[Wide]) {
    let mut sum = [0.0; 4];
    let mut k = t;
    for j in at {
        let (x, a) = (&x[*j as usize + t], entries[k]);
        (0..4).for_each(|c| sum[c] += a * x[c]);
        k += len;
    }
    (0..4).for_each(|c| out[c] += sign * sum[c]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn products_are_those_of_the_same_matrix_row_by_row() {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(2);
        // runs of 11 rows and of one, some rows without entries
        let columns = |i: usize| match i {
            0..11 => vec![i, i + 1, i + 7],
            11 | 16 => vec![],
            12..=15 => vec![i - 12, i - 3],
            _ => vec![3 * i % 18],
        };
        let mut row = |i: usize| -> Vec<(usize, f64)> {
            columns(i).into_iter().map(|j| (j, r.random_range(-1.0..1.0))).collect()
        };
        let matrix = Rows::new(18, (0..20).map(&mut row).collect::<Vec<_>>());
        let runs = Runs::of(&matrix);
        assert!(runs.pattern.runs.len() < 9 && runs.order() == 20, "{:?}", runs.pattern);
        let twice = runs.plus(1.0, &runs.with(&matrix));
        let x: Vec<Wide> = (0..18).map(|j| [0, 1, 2, 3].map(|c| f64::from(j * 4 + c).sin())).collect();
        let mut out = vec![[1.0; 4]; 20];
        twice.add(-0.5, &x, &mut out);
        for (i, out) in out.iter().enumerate() {
            for c in 0..4 {
                let exact = 1.0 - matrix.row(i).map(|(j, a)| a * x[j][c]).sum::<f64>();
                assert!((out[c] - exact).abs() < 1e-14, "{i} {c}");
            }
        }
        let mut told = Vec::new();
        runs.each(|i, j, a| told.push((i, j, a)));
        told.sort_by_key(|(i, j, _)| (*i, *j));
        let exact: Vec<_> = (0..20).flat_map(|i| matrix.row(i).map(move |(j, a)| (i, j, a))).collect();
        assert_eq!(told, exact);
    }
}
