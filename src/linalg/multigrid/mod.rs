//! Algebraic multigrid: a symmetric positive definite matrix of a lattice inverted roughly, in work and memory that grow as the
//! number of its sites, for conjugate gradients.
//!
//! ```text
//! x ← ω D⁻¹ b                        what neighbours tell one another
//! x ← x + P B Pᵀ (b − A x)           the rest, on fewer unknowns: B the same of Pᵀ A P, exact on the last few
//! x ← x + ω D⁻¹ (b − A x)            ω = 4/3 over a bound on the eigenvalues of D⁻¹A, at most 1
//! ```
//! Which unknowns stay and how the others follow from them is told by the entries alone (J. W. Ruge, K. Stüben, "Algebraic multigrid",
//! SIAM 1987, doi:10.1137/1.9781611971057.ch4), so that boundaries, vacancies, several atoms a cell and disorder need no care. An entry of
//! either sign couples: unknowns of antiferromagnets follow one another with the sign reversed. Steps before and after are the same, so
//! that B is symmetric.

mod coarse;
mod rows;

pub use coarse::Coarsening;
pub use rows::Rows;

use super::solve_dense;
use coarse::Step;
use multiversion::multiversion;
use std::sync::Arc;

/// Numbers of an unknown that are worked on together: a field has three components, and four fill a register.
type Wide = [f64; 4];
/// So few unknowns are solved for at once.
const FEW: usize = 40;

/// A matrix, level after level.
#[derive(Debug)]
pub struct Multigrid {
    levels: Vec<Level>,
    coarsening: Arc<Coarsening>,
    /// The inverse of the last matrix, row after row, if it has few unknowns.
    inverse: Vec<f64>,
}

/// One matrix.
#[derive(Debug)]
struct Level {
    matrix: Rows,
    /// ω / A_ii.
    damped: Vec<f64>,
}

impl Level {
    fn of(matrix: Rows) -> Level {
        Level { damped: damped(&matrix), matrix }
    }
}

/// Memory of a solution: right-hand sides, solutions and residuals of every level.
#[derive(Clone, Debug, Default)]
pub struct Room(Vec<[Vec<Wide>; 3]>);

impl Multigrid {
    /// Of a symmetric positive definite matrix with entries where the one has them of which this is the coarsening.
    pub fn of(matrix: Rows, coarsening: Arc<Coarsening>) -> Multigrid {
        let mut levels = vec![Level::of(matrix)];
        for step in coarsening.steps() {
            let fine = &levels.last().expect("a level").matrix;
            levels.push(Level::of(step.back.product(fine).product(&step.p)));
        }
        Multigrid::new(levels, coarsening)
    }

    /// Of the matrix + s·1.
    pub fn shifted(&self, s: f64) -> Multigrid {
        let squares = self.coarsening.steps().iter().map(|step| &step.square);
        let mut levels = vec![Level::of(self.levels[0].matrix.shifted(s))];
        levels.extend(self.levels[1..].iter().zip(squares).map(|(l, square)| Level::of(l.matrix.plus(s, square))));
        Multigrid::new(levels, self.coarsening.clone())
    }

    fn new(levels: Vec<Level>, coarsening: Arc<Coarsening>) -> Multigrid {
        let inverse = levels.last().map(|level| inverse(&level.matrix)).unwrap_or_default();
        Multigrid { levels, coarsening, inverse }
    }

    /// The matrix.
    #[cfg(test)]
    pub fn matrix(&self) -> &Rows {
        &self.levels[0].matrix
    }

    /// Number of unknowns.
    pub fn order(&self) -> usize {
        self.levels[0].matrix.order()
    }

    /// Writes B v for a field of three numbers an unknown, component-major.
    pub fn solve(&self, v: &[f64], out: &mut [f64], room: &mut Room) {
        let n = self.order();
        room.0.resize_with(self.levels.len(), Default::default);
        for (level, vectors) in self.levels.iter().zip(&mut room.0) {
            vectors.iter_mut().for_each(|v| v.resize(level.matrix.order(), [0.0; 4]));
        }
        for (i, b) in room.0[0][0].iter_mut().enumerate() {
            *b = [v[i], v[n + i], v[2 * n + i], 0.0];
        }
        self.cycle(0, &mut room.0);
        for (i, x) in room.0[0][1].iter().enumerate() {
            (out[i], out[n + i], out[2 * n + i]) = (x[0], x[1], x[2]);
        }
    }

    /// Solves on a level and those below it; `room` is theirs.
    fn cycle(&self, k: usize, room: &mut [[Vec<Wide>; 3]]) {
        let level = &self.levels[k];
        let ([b, x, rest], below) = room.split_first_mut().expect("a room a level");
        match self.coarsening.steps().get(k) {
            Some(Step { back, p, .. }) => {
                first(&level.damped, b, x);
                residual(&level.matrix, b, x, rest);
                multiply(back, rest, &mut below[0][0]);
                self.cycle(k + 1, below);
                add_product(p, &below[0][1], x);
                again(&level.matrix, &level.damped, b, x, rest);
                std::mem::swap(x, rest);
            }
            None if self.inverse.is_empty() => first(&level.damped, b, x),
            None => invert(&self.inverse, b, x),
        }
    }
}

/// ω / A_ii.
fn damped(matrix: &Rows) -> Vec<f64> {
    let diagonal: Vec<f64> = (0..matrix.order()).map(|i| matrix.diagonal(i).max(f64::MIN_POSITIVE)).collect();
    let row = |i: usize| matrix.row(i).map(|(_, a)| a.abs()).sum::<f64>() / diagonal[i];
    let largest = (0..matrix.order()).map(row).fold(1.0, f64::max);
    let omega = (4.0 / 3.0 / largest).min(1.0);
    diagonal.into_iter().map(|d| omega / d).collect()
}

/// Row after row; nothing of many unknowns, or where there is none.
fn inverse(matrix: &Rows) -> Vec<f64> {
    let n = matrix.order();
    if n > FEW {
        return Vec::new();
    }
    let mut full = vec![0.0; n * n];
    (0..n).for_each(|i| matrix.row(i).for_each(|(j, a)| full[i * n + j] = a));
    let unit = |k: usize| (0..n).map(|i| f64::from(u8::from(i == k))).collect::<Vec<f64>>();
    let columns: Option<Vec<Vec<f64>>> = (0..n).map(|k| solve_dense(&full, &unit(k), n)).collect();
    columns.unwrap_or_default().concat()
}

fn first(damped: &[f64], b: &[Wide], x: &mut [Wide]) {
    for ((x, b), d) in x.iter_mut().zip(b).zip(damped) {
        *x = b.map(|b| d * b);
    }
}

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn invert(inverse: &[f64], b: &[Wide], x: &mut [Wide]) {
    for (x, row) in x.iter_mut().zip(inverse.chunks_exact(b.len())) {
        *x = [0.0; 4];
        for (b, a) in b.iter().zip(row) {
            (0..4).for_each(|c| x[c] += a * b[c]);
        }
    }
}

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn multiply(matrix: &Rows, x: &[Wide], out: &mut [Wide]) {
    for (i, out) in out.iter_mut().enumerate() {
        *out = matrix.times(i, x);
    }
}

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn add_product(matrix: &Rows, x: &[Wide], out: &mut [Wide]) {
    for (i, out) in out.iter_mut().enumerate() {
        let here = matrix.times(i, x);
        (0..4).for_each(|c| out[c] += here[c]);
    }
}

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn residual(matrix: &Rows, b: &[Wide], x: &[Wide], out: &mut [Wide]) {
    for (i, (out, b)) in out.iter_mut().zip(b).enumerate() {
        let here = matrix.times(i, x);
        (0..4).for_each(|c| out[c] = b[c] - here[c]);
    }
}

/// x + ω D⁻¹ (b − A x).
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn again(matrix: &Rows, damped: &[f64], b: &[Wide], x: &[Wide], out: &mut [Wide]) {
    for (i, out) in out.iter_mut().enumerate() {
        let here = matrix.times(i, x);
        (0..4).for_each(|c| out[c] = x[i][c] + damped[i] * (b[i][c] - here[c]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::slab;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// Nearest neighbours of a box, periodic along x, with couplings of this sign and this disorder, some sites left out, and `own`
    /// stiffness on each.
    fn lattice([nx, ny, nz]: [usize; 3], sign: f64, disorder: f64, vacant: f64, own: f64) -> Rows {
        let mut r = ChaCha8Rng::seed_from_u64(3);
        let n = nx * ny * nz;
        let there: Vec<bool> = (0..n).map(|_| !r.random_bool(vacant)).collect();
        let mut rows: Vec<Vec<(usize, f64)>> = (0..n).map(|i| vec![(i, own)]).collect();
        for i in 0..n {
            let (x, y, z) = (i % nx, i / nx % ny, i / (nx * ny));
            let next = [(true, (x + 1) % nx + nx * (y + ny * z)), (y + 1 < ny, i + nx), (z + 1 < nz, i + nx * ny)];
            for (_, j) in next.into_iter().filter(|(inside, j)| *inside && there[i] && there[*j]) {
                let a = 1.0 + disorder * r.random_range(-1.0..1.0);
                rows[i].extend([(i, a), (j, sign * a)]);
                rows[j].extend([(j, a), (i, sign * a)]);
            }
        }
        Rows::new(n, rows)
    }

    fn alone(matrix: Rows) -> Multigrid {
        let coarsening = Arc::new(Coarsening::of(&matrix));
        Multigrid::of(matrix, coarsening)
    }

    #[test]
    fn what_is_shifted_is_what_is_made_of_the_shifted_matrix() {
        let matrix = lattice([20, 15, 1], -1.0, 0.3, 0.1, 0.01);
        let grid = alone(matrix.clone());
        let [one, other] = [grid.shifted(0.7), Multigrid::of(matrix.shifted(0.7), grid.coarsening.clone())];
        assert!(one.levels.len() > 2);
        for (p, q) in one.levels.iter().zip(&other.levels) {
            for i in 0..q.matrix.order() {
                for ((j, a), (k, b)) in p.matrix.row(i).zip(q.matrix.row(i)) {
                    assert!(j == k && (a - b).abs() < 1e-14, "{i} {j} {k} {a} {b}");
                }
            }
        }
    }

    fn product(matrix: &Rows, x: &[f64]) -> Vec<f64> {
        let n = matrix.order();
        (0..3 * n).map(|k| matrix.row(k % n).map(|(j, a)| a * x[k / n * n + j]).sum()).collect()
    }

    /// Steps of conjugate gradients to a part 1e-8 of the residual.
    fn steps(matrix: &Rows) -> usize {
        let grid = alone(matrix.clone());
        let mut r = ChaCha8Rng::seed_from_u64(4);
        let exact: Vec<f64> = (0..3 * matrix.order()).map(|_| r.random_range(-1.0..1.0)).collect();
        let mut rest = product(matrix, &exact);
        let (mut x, mut towards) = (vec![0.0; rest.len()], vec![0.0; rest.len()]);
        let mut room = Room::default();
        grid.solve(&rest, &mut towards, &mut room);
        let mut direction = towards.clone();
        let mut fall = slab::dot(&rest, &towards);
        let enough = 1e-8 * slab::norm(&rest);
        for step in 1..200 {
            let image = product(matrix, &direction);
            let by = fall / slab::dot(&direction, &image);
            slab::add_scaled(&mut x, by, &direction);
            slab::add_scaled(&mut rest, -by, &image);
            if slab::norm(&rest) < enough {
                return step;
            }
            grid.solve(&rest, &mut towards, &mut room);
            let before = std::mem::replace(&mut fall, slab::dot(&rest, &towards));
            assert!(fall > 0.0);
            slab::scale(&mut direction, fall / before);
            slab::add_scaled(&mut direction, 1.0, &towards);
        }
        200
    }

    #[test]
    fn conjugate_gradients_take_as_many_steps_at_any_size() {
        for (sign, disorder, vacant) in [(-1.0, 0.0, 0.0), (1.0, 0.0, 0.0), (-1.0, 0.9, 0.0), (-1.0, 0.0, 0.2)] {
            for (small, large) in [([16, 16, 1], [90, 100, 1]), ([8, 8, 8], [20, 19, 21])] {
                let steps = [small, large].map(|size| steps(&lattice(size, sign, disorder, vacant, 1e-3)));
                assert!(steps[0] <= 16 && steps[1] <= 20, "{sign} {disorder} {vacant} {large:?}: {steps:?}");
            }
        }
    }

    #[test]
    fn what_neighbours_do_not_couple_is_inverted_by_itself() {
        let grid = alone(lattice([60, 2, 1], -1.0, 0.0, 1.0, 0.5));
        let v: Vec<f64> = (0..360).map(f64::from).collect();
        let mut x = vec![0.0; 360];
        grid.solve(&v, &mut x, &mut Room::default());
        assert!(v.iter().zip(&x).all(|(v, x)| (2.0 * v - x).abs() < 1e-12 * v.max(1.0)));
    }

    #[test]
    fn the_rough_inverse_is_symmetric_and_that_of_few_unknowns_exact() {
        let mut r = ChaCha8Rng::seed_from_u64(5);
        for size in [[5, 4, 2], [30, 31, 1]] {
            let matrix = lattice(size, -1.0, 0.3, 0.1, 0.01);
            let grid = alone(matrix.clone());
            let [v, w]: [Vec<f64>; 2] =
                [(); 2].map(|()| (0..3 * matrix.order()).map(|_| r.random_range(-1.0..1.0)).collect());
            let [bv, bw] = [&v, &w].map(|v| {
                let mut x = vec![0.0; v.len()];
                grid.solve(v, &mut x, &mut Room::default());
                x
            });
            let (one, other) = (slab::dot(&bv, &w), slab::dot(&bw, &v));
            assert!((one - other).abs() < 1e-12 * slab::norm(&bv) * slab::norm(&w), "{size:?}: {one} {other}");
            if matrix.order() <= FEW {
                let back = product(&matrix, &bv);
                assert!(v.iter().zip(&back).all(|(v, b)| (v - b).abs() < 1e-9));
            }
        }
    }
}
