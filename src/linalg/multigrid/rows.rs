//! Sparse matrices row by row.

/// Entries by row, columns ascending in each.
#[derive(Clone, Debug, Default)]
pub struct Rows {
    starts: Vec<u32>,
    at: Vec<u32>,
    entries: Vec<f64>,
    columns: usize,
}

impl Rows {
    /// From the entries of every row, in any order; those of one column are added.
    pub fn new(columns: usize, rows: impl IntoIterator<Item = Vec<(usize, f64)>>) -> Rows {
        let mut matrix = Rows { starts: vec![0], columns, ..Rows::default() };
        rows.into_iter().for_each(|mut row| matrix.push(&mut row));
        matrix.fitted()
    }

    /// Row after row, each written by `fill` into a list that is empty.
    pub(super) fn filled(order: usize, columns: usize, mut fill: impl FnMut(usize, &mut Vec<(usize, f64)>)) -> Rows {
        let mut matrix = Rows { starts: Vec::with_capacity(order + 1), columns, ..Rows::default() };
        matrix.starts.push(0);
        let mut row = Vec::new();
        for i in 0..order {
            row.clear();
            fill(i, &mut row);
            matrix.push(&mut row);
        }
        matrix.fitted()
    }

    /// In no more memory than it needs.
    fn fitted(mut self) -> Rows {
        self.at.shrink_to_fit();
        self.entries.shrink_to_fit();
        self
    }

    /// One row more.
    fn push(&mut self, row: &mut [(usize, f64)]) {
        row.sort_by_key(|(j, _)| *j);
        let first = self.at.len();
        for (j, a) in row {
            if self.at.len() > first && self.at.last() == Some(&(*j as u32)) {
                *self.entries.last_mut().expect("as many as columns") += *a;
            } else {
                self.at.push(*j as u32);
                self.entries.push(*a);
            }
        }
        self.starts.push(self.at.len() as u32);
    }

    /// Number of rows.
    pub fn order(&self) -> usize {
        self.starts.len() - 1
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// The columns and entries of a row.
    pub fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let here = self.starts[i] as usize..self.starts[i + 1] as usize;
        self.at[here.clone()].iter().map(|j| *j as usize).zip(self.entries[here].iter().copied())
    }

    /// The entry (i, i).
    pub fn diagonal(&self, i: usize) -> f64 {
        self.own(i).map_or(0.0, |place| self.entries[place])
    }

    /// Where the entry (i, i) lies.
    fn own(&self, i: usize) -> Option<usize> {
        let here = self.starts[i] as usize..self.starts[i + 1] as usize;
        here.clone().zip(&self.at[here]).find(|(_, j)| **j as usize == i).map(|(place, _)| place)
    }

    /// The same with `s` added to every entry (i, i), which must be there.
    #[cfg(test)]
    pub fn shifted(&self, s: f64) -> Rows {
        let mut shifted = self.clone();
        for i in 0..self.order() {
            self.own(i).into_iter().for_each(|place| shifted.entries[place] += s);
        }
        shifted
    }

    /// The same with other entries (i, i), which must be there.
    pub fn with_diagonal(&self, own: &[f64]) -> Rows {
        let mut changed = self.clone();
        for (i, own) in own.iter().enumerate() {
            self.own(i).into_iter().for_each(|place| changed.entries[place] = *own);
        }
        changed
    }

    /// The same + s times a matrix that has entries only where this has some.
    pub(super) fn plus(&self, s: f64, other: &Rows) -> Rows {
        let mut sum = self.clone();
        for i in 0..self.order() {
            let mut places = self.starts[i] as usize..self.starts[i + 1] as usize;
            for (j, a) in other.row(i) {
                let place = places.find(|place| self.at[*place] as usize == j);
                sum.entries[place.expect("an entry there")] += s * a;
            }
        }
        sum
    }

    /// The same with rows and columns exchanged.
    pub fn transposed(&self) -> Rows {
        let mut starts = vec![0u32; self.columns + 1];
        self.at.iter().for_each(|j| starts[*j as usize + 1] += 1);
        (0..self.columns).for_each(|j| starts[j + 1] += starts[j]);
        let mut next = starts.clone();
        let (mut at, mut entries) = (vec![0; self.at.len()], vec![0.0; self.at.len()]);
        for i in 0..self.order() {
            for (j, a) in self.row(i) {
                let place = next[j] as usize;
                (at[place], entries[place]) = (i as u32, a);
                next[j] += 1;
            }
        }
        Rows { starts, at, entries, columns: self.order() }
    }

    /// This times another matrix.
    pub fn product(&self, other: &Rows) -> Rows {
        let mut place = vec![usize::MAX; other.columns];
        Rows::filled(self.order(), other.columns, |i, row| {
            for (k, a) in self.row(i) {
                for (j, b) in other.row(k) {
                    if place[j] == usize::MAX {
                        place[j] = row.len();
                        row.push((j, 0.0));
                    }
                    row[place[j]].1 += a * b;
                }
            }
            row.iter().for_each(|(j, _)| place[*j] = usize::MAX);
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn products_and_transposes_are_those_of_full_matrices() {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        let mut some = |rows: usize, columns: usize| {
            let full: Vec<Vec<f64>> = (0..rows)
                .map(|_| {
                    (0..columns).map(|_| if r.random_bool(0.4) { r.random_range(-1.0..1.0) } else { 0.0 }).collect()
                })
                .collect();
            let entries = |row: &Vec<f64>| row.iter().copied().enumerate().filter(|(_, a)| *a != 0.0).rev().collect();
            (Rows::new(columns, full.iter().map(entries)), full)
        };
        let ((a, full_a), (b, full_b)) = (some(7, 5), some(5, 9));
        let (product, back) = (a.product(&b), a.transposed());
        assert_eq!([product.order(), product.columns(), back.order(), back.columns()], [7, 9, 5, 7]);
        for i in 0..7 {
            back_and_forth(&a, &back, i);
            let mut row = [0.0; 9];
            product.row(i).for_each(|(j, v)| row[j] = v);
            for (j, entry) in row.iter().enumerate() {
                let exact: f64 = (0..5).map(|k| full_a[i][k] * full_b[k][j]).sum();
                assert!((entry - exact).abs() < 1e-14);
            }
        }
    }

    fn back_and_forth(a: &Rows, back: &Rows, i: usize) {
        for (j, v) in a.row(i) {
            assert_eq!(back.row(j).find(|(k, _)| *k == i), Some((i, v)));
        }
    }

    #[test]
    fn entries_of_one_place_are_added() {
        let a = Rows::new(3, [vec![(2, 1.0), (0, 3.0), (2, 0.5)], vec![]]);
        assert_eq!(a.row(0).collect::<Vec<_>>(), [(0, 3.0), (2, 1.5)]);
        assert_eq!([a.diagonal(0), a.diagonal(1)], [3.0, 0.0]);
    }
}
