//! Dense symmetric matrices, and their LDLᵀ without pivoting.

use super::pivot::guarded;
use super::slab;
use multiversion::multiversion;

/// A symmetric matrix all of whose entries count.
#[derive(Clone, Debug, Default)]
pub struct Dense {
    order: usize,
    /// Row by row: entry (i, j) at i n + j, lower half used.
    entries: Vec<f64>,
}

impl Dense {
    /// The zero matrix.
    pub fn zeros(order: usize) -> Dense {
        Dense { order, entries: vec![0.0; order * order] }
    }

    /// Makes it a zero matrix of the given order, in the memory it has.
    pub fn reset(&mut self, order: usize) {
        self.order = order;
        self.entries.clear();
        self.entries.resize(order * order, 0.0);
    }

    /// Makes it a copy of another matrix, in the memory it has.
    pub(super) fn copy_from(&mut self, other: &Dense) {
        self.order = other.order;
        self.entries.clone_from(&other.entries);
    }

    /// Number of unknowns.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Adds `v` to the entry (i, j) and, off the diagonal, to its mirror image.
    #[inline]
    pub fn add(&mut self, i: usize, j: usize, v: f64) {
        self.entries[i.max(j) * self.order + i.min(j)] += v;
    }

    /// Adds a block to the rows 2i, 2i + 1 and the columns 2j, 2j + 1, another site's, and to its mirror image.
    #[inline]
    pub fn add_block(&mut self, i: usize, j: usize, block: [[f64; 2]; 2]) {
        let [[a, b], [c, d]] = block;
        let (i, j, block) = if i > j { (i, j, block) } else { (j, i, [[a, c], [b, d]]) };
        for (r, [first, second]) in block.into_iter().enumerate() {
            let at = (2 * i + r) * self.order + 2 * j;
            self.entries[at] += first;
            self.entries[at + 1] += second;
        }
    }

    /// Adds to the rows 2i, 2i + 1 the block that each site j before i gives, and to its mirror image.
    #[inline]
    pub fn add_blocks_before(&mut self, i: usize, block: impl Fn(usize) -> [[f64; 2]; 2]) {
        let (first, second) = self.entries[2 * i * self.order..].split_at_mut(self.order);
        let pairs = first[..2 * i].as_chunks_mut().0.iter_mut().zip(second[..2 * i].as_chunks_mut().0);
        for (j, ([a, b], [c, d])) in pairs.enumerate() {
            let [above, below] = block(j);
            (*a, *b) = (*a + above[0], *b + above[1]);
            (*c, *d) = (*c + below[0], *d + below[1]);
        }
    }

    /// Entry (i, j).
    pub fn get(&self, i: usize, j: usize) -> f64 {
        self.entries[i.max(j) * self.order + i.min(j)]
    }

    /// A ← A + s·1.
    pub fn shift(&mut self, s: f64) {
        self.entries.iter_mut().step_by(self.order + 1).for_each(|d| *d += s);
    }

    /// The smallest diagonal entry.
    pub fn smallest_diagonal(&self) -> f64 {
        self.diagonal().fold(f64::INFINITY, f64::min)
    }

    /// The diagonal.
    pub(super) fn diagonal(&self) -> impl Iterator<Item = f64> + '_ {
        self.entries.iter().step_by(self.order + 1).copied()
    }

    /// y ← A x.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        y.fill(0.0);
        for (r, row) in self.entries.chunks_exact(self.order.max(1)).enumerate() {
            for (s, a) in row[..r].iter().enumerate() {
                y[r] += a * x[s];
                y[s] += a * x[r];
            }
            y[r] += row[r] * x[r];
        }
    }

    /// The largest column sum of absolute values, ‖A‖₁.
    pub fn norm1(&self) -> f64 {
        let mut sums = vec![0.0; self.order];
        for (r, row) in self.entries.chunks_exact(self.order.max(1)).enumerate() {
            for (s, a) in row[..r].iter().enumerate() {
                sums[r] += a.abs();
                sums[s] += a.abs();
            }
            sums[r] += row[r].abs();
        }
        sums.into_iter().fold(0.0, f64::max)
    }

    /// The largest entry; those that are no numbers do not count.
    pub(super) fn size(&self) -> f64 {
        slab::largest(&self.entries)
    }

    /// A = L D Lᵀ in place, D on the diagonal; pivots smaller than the floor are replaced by that.
    pub(super) fn eliminate(&mut self, floor: f64) {
        eliminate(&mut self.entries, self.order, floor);
    }

    /// Substitution, of what [`eliminate`](Self::eliminate) has made; c interleaved right-hand sides.
    pub(super) fn substitute(&self, x: &mut [f64], c: usize) {
        let mut first = 0;
        while first < c {
            match c - first {
                1 => substitute::<1>(&self.entries, self.order, x, c, first),
                2 => substitute::<2>(&self.entries, self.order, x, c, first),
                3 => substitute::<3>(&self.entries, self.order, x, c, first),
                _ => substitute::<4>(&self.entries, self.order, x, c, first),
            }
            first += 4;
        }
    }
}

/// Columns that are eliminated before the rest of the matrix is passed over once for all of them.
const PANEL: usize = 8;
/// Rows of which a substitution takes the products side by side.
const ROWS: usize = 4;

/// Elimination of a matrix of n rows, lower half: each entry has its products subtracted in the order of the columns, a panel of them
/// at a time.
fn eliminate(entries: &mut [f64], n: usize, floor: f64) {
    let mut columns = vec![0.0; PANEL * n];
    for first in (0..n).step_by(PANEL) {
        let end = (first + PANEL).min(n);
        for (j, column) in (first..end).zip(columns.chunks_exact_mut(n)) {
            let d = guarded(entries[j * n + j], floor);
            entries[j * n + j] = d;
            for r in j + 1..n {
                column[r] = entries[r * n + j];
            }
            for r in j + 1..n {
                let l = column[r] / d;
                let within = entries[r * n + j + 1..r * n + end.min(r + 1)].iter_mut().zip(&column[j + 1..]);
                within.for_each(|(x, c)| *x -= l * c);
                entries[r * n + j] = l;
            }
        }
        if end < n {
            let columns: [&[f64]; PANEL] = std::array::from_fn(|k| &columns[k * n..(k + 1) * n]);
            subtract(entries, n, first, &columns);
        }
    }
}

/// Subtracts the products of a whole panel of columns from what is behind it.
#[multiversion(targets("x86_64+avx2"))]
fn subtract(entries: &mut [f64], n: usize, first: usize, columns: &[&[f64]; PANEL]) {
    let end = first + PANEL;
    for r in end..n {
        let (left, rest) = entries[r * n + first..=r * n + r].split_at_mut(PANEL);
        let l: [f64; PANEL] = std::array::from_fn(|k| left[k]);
        let [c0, c1, c2, c3, c4, c5, c6, c7] = columns.map(|column| &column[end..=r]);
        for (k, x) in rest.iter_mut().enumerate() {
            let low = *x - l[0] * c0[k] - l[1] * c1[k] - l[2] * c2[k] - l[3] * c3[k];
            *x = low - l[4] * c4[k] - l[5] * c5[k] - l[6] * c6[k] - l[7] * c7[k];
        }
    }
}

/// Substitution of Q of c interleaved right-hand sides, from one of them on: each number has its products subtracted in the order of
/// the rows.
fn substitute<const Q: usize>(entries: &[f64], n: usize, x: &mut [f64], c: usize, first: usize) {
    let row = |r: usize| &entries[r * n..(r + 1) * n];
    let own = |x: &[f64], r: usize| -> [f64; Q] { std::array::from_fn(|q| x[r * c + first + q]) };
    for top in (0..n).step_by(ROWS) {
        let end = (top + ROWS).min(n);
        let rows: [&[f64]; ROWS] = std::array::from_fn(|k| &row((top + k).min(n - 1))[..end]);
        let mut sums: [[f64; Q]; ROWS] = std::array::from_fn(|k| own(x, (top + k).min(n - 1)));
        for s in 0..top {
            let known = own(x, s);
            for (sum, row) in sums.iter_mut().zip(&rows) {
                sum.iter_mut().zip(&known).for_each(|(sum, known)| *sum -= row[s] * known);
            }
        }
        for r in top..end {
            let done = sums[r - top];
            x[r * c + first..r * c + first + Q].copy_from_slice(&done);
            for (sum, row) in sums.iter_mut().zip(&rows).skip(r - top + 1) {
                sum.iter_mut().zip(&done).for_each(|(sum, done)| *sum -= row[r] * done);
            }
        }
    }
    for r in 0..n {
        x[r * c + first..r * c + first + Q].iter_mut().for_each(|x| *x /= entries[r * n + r]);
    }
    for s in (0..n).rev() {
        let done = own(x, s);
        for (x, l) in x.chunks_exact_mut(c).zip(&row(s)[..s]) {
            x[first..first + Q].iter_mut().zip(&done).for_each(|(x, done)| *x -= l * done);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One column after the other.
    fn plainly(entries: &mut [f64], n: usize, x: &mut [f64], c: usize) {
        for j in 0..n {
            let column: Vec<f64> = (0..n).map(|r| entries[r * n + j]).collect();
            for r in j + 1..n {
                let l = column[r] / column[j];
                (j + 1..=r).for_each(|k| entries[r * n + k] -= l * column[k]);
                entries[r * n + j] = l;
            }
        }
        for q in 0..c {
            for r in 0..n {
                (0..r).for_each(|s| x[r * c + q] -= entries[r * n + s] * x[s * c + q]);
            }
            (0..n).for_each(|r| x[r * c + q] /= entries[r * n + r]);
            for s in (0..n).rev() {
                (0..s).for_each(|r| x[r * c + q] -= entries[s * n + r] * x[s * c + q]);
            }
        }
    }

    #[test]
    fn panels_and_rows_side_by_side_give_the_bits_of_one_column_after_the_other() {
        for (n, c) in [(1, 1), (3, 2), (7, 5), (8, 1), (9, 3), (16, 4), (37, 6), (50, 1)] {
            let mut matrix = Dense::zeros(n);
            for i in 0..n {
                (0..i).for_each(|j| matrix.add(i, j, libm::sin((3 * i + 7 * j) as f64)));
                matrix.add(i, i, if i % 3 == 0 { -4.0 } else { 5.0 });
            }
            let mut x: Vec<f64> = (0..n * c).map(|i| libm::cos(i as f64)).collect();
            let (mut entries, mut expected) = (matrix.entries.clone(), x.clone());
            plainly(&mut entries, n, &mut expected, c);
            matrix.eliminate(1e-12);
            matrix.substitute(&mut x, c);
            for r in 0..n {
                assert_eq!(matrix.entries[r * n..=r * n + r], entries[r * n..=r * n + r], "{n}: row {r}");
            }
            assert_eq!(x, expected, "{n} {c}");
        }
    }
}
