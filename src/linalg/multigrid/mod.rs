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
//! that B is symmetric. Where those of the first level that follow hang on the others alone, they are eliminated instead (see
//! `eliminated`).

mod coarse;
mod eliminated;
mod rows;
mod runs;

pub use coarse::Coarsening;
pub use rows::Rows;

use super::invert_dense;
use eliminated::Eliminated;
use multiversion::multiversion;
use runs::Runs;
use std::sync::Arc;

/// Numbers of an unknown that are worked on together: a field has three components, and four fill a register.
type Wide = [f64; 4];
/// So few unknowns are solved for at once.
const FEW: usize = 40;

/// A matrix, level after level.
#[derive(Debug)]
pub struct Multigrid {
    coarsening: Arc<Coarsening>,
    /// A_FF⁻¹ of the unknowns that are eliminated first.
    eliminated: Vec<f64>,
    levels: Vec<Level>,
    last: Last,
    #[cfg(test)]
    matrix: Rows,
}

/// One matrix.
#[derive(Debug)]
struct Level {
    matrix: Runs,
    /// ω / A_ii.
    damped: Vec<f64>,
}

/// The last matrix.
#[derive(Debug)]
struct Last {
    matrix: Rows,
    /// Row after row, if it has few unknowns.
    inverse: Vec<f64>,
    /// ω / A_ii, if it has many: they hardly couple.
    damped: Vec<f64>,
}

/// Memory of a solution: what it takes on every level.
#[derive(Clone, Debug, Default)]
pub struct Room(Vec<[Vec<Wide>; 4]>);

impl Multigrid {
    /// Of a symmetric positive definite matrix that differs in its diagonal alone from the one of which this is the coarsening.
    pub fn of(matrix: Rows, coarsening: Arc<Coarsening>) -> Multigrid {
        let first = coarsening.eliminated.as_ref();
        let eliminated = first.map(|first| first.inverse(&matrix)).unwrap_or_default();
        let mut here = first.map_or_else(|| matrix.clone(), |first| first.parted.on_the_next(&matrix));
        let mut levels = Vec::new();
        for step in &coarsening.steps {
            levels.push(Level::of(step.runs(&here)));
            here = step.parted.on_the_next(&here);
        }
        Multigrid {
            eliminated,
            levels,
            last: Last::of(here),
            coarsening,
            #[cfg(test)]
            matrix,
        }
    }

    /// Of the matrix + s·1.
    pub fn shifted(&self, s: f64) -> Multigrid {
        let levels = self.levels.iter().zip(&self.coarsening.steps);
        Multigrid {
            eliminated: self.eliminated.iter().map(|d| d / (1.0 + s * d)).collect(),
            levels: levels.map(|(level, step)| Level::of(level.matrix.plus(s, &step.square))).collect(),
            last: Last::of(self.last.matrix.plus(s, &self.coarsening.square)),
            coarsening: self.coarsening.clone(),
            #[cfg(test)]
            matrix: self.matrix.shifted(s),
        }
    }

    /// The matrix.
    #[cfg(test)]
    pub fn matrix(&self) -> &Rows {
        &self.matrix
    }

    /// Writes B v for a field of three numbers an unknown, component-major.
    pub fn solve(&self, v: &[f64], out: &mut [f64], room: &mut Room) {
        let n = v.len() / 3;
        room.0.resize_with(self.levels.len() + 1, Default::default);
        let Some(first) = &self.coarsening.eliminated else {
            let ([b, x, _, _], below) = fitted(&mut room.0, [n, n, 0, 0]);
            interleave(0..n, v, b);
            self.cycle(0, b, x, below);
            return spread(0..n, x, out);
        };
        let few = first.parted.stay.len();
        let ([rest, found, b, x], below) = fitted(&mut room.0, [few, few, n - few, n - few]);
        first.leave(&self.eliminated, v, [b, x], rest);
        self.cycle(0, rest, found, below);
        first.follow(&self.eliminated, found, [b, x], out);
    }

    /// x ← B b for the matrix of a level; `room` is its and of those below it.
    fn cycle(&self, k: usize, b: &[Wide], x: &mut [Wide], room: &mut [[Vec<Wide>; 4]]) {
        let Some(level) = self.levels.get(k) else { return self.last.solve(b, x) };
        let step = &self.coarsening.steps[k];
        let few = step.parted.stay.len();
        let ([rest, down, up, follow], below) = fitted(room, [b.len(), few, few, b.len() - few]);
        scaled(&level.damped, b, x);
        level.residual(b, x, rest);
        step.down(rest, follow, down);
        self.cycle(k + 1, down, up, below);
        step.up(up, follow, x);
        level.residual(b, x, rest);
        add_scaled(&level.damped, rest, x);
    }
}

impl Level {
    fn of(matrix: Runs) -> Level {
        let (mut own, mut others) = (vec![0.0; matrix.order()], vec![0.0; matrix.order()]);
        matrix.each(|i, j, a| if i == j { own[i] = a } else { others[i] += a.abs() });
        Level { damped: damped(own, &others), matrix }
    }

    /// b − A x.
    fn residual(&self, b: &[Wide], x: &[Wide], rest: &mut [Wide]) {
        rest.copy_from_slice(b);
        self.matrix.add(-1.0, x, rest);
    }
}

impl Last {
    fn of(matrix: Rows) -> Last {
        let own: Vec<f64> = (0..matrix.order()).map(|i| matrix.diagonal(i)).collect();
        let row = |i: usize| matrix.row(i).filter(|(j, _)| *j != i).map(|(_, a)| a.abs()).sum();
        let others: Vec<f64> = (0..matrix.order()).map(row).collect();
        Last { inverse: inverse(&matrix), damped: damped(own, &others), matrix }
    }

    fn solve(&self, b: &[Wide], x: &mut [Wide]) {
        match self.inverse.is_empty() {
            true => scaled(&self.damped, b, x),
            false => invert(&self.inverse, b, x),
        }
    }
}

/// ω / A_ii, of the entries of the diagonal and the sums of the others' sizes.
fn damped(mut own: Vec<f64>, others: &[f64]) -> Vec<f64> {
    own.iter_mut().for_each(|d| *d = d.max(f64::MIN_POSITIVE));
    let largest = own.iter().zip(others).map(|(d, others)| 1.0 + others / d).fold(1.0, f64::max);
    let omega = (4.0 / 3.0 / largest).min(1.0);
    own.iter_mut().for_each(|d| *d = omega / *d);
    own
}

/// Row after row; nothing of many unknowns, or where there is none.
fn inverse(matrix: &Rows) -> Vec<f64> {
    let n = matrix.order();
    if n > FEW {
        return Vec::new();
    }
    let mut full = vec![0.0; n * n];
    (0..n).for_each(|i| matrix.row(i).for_each(|(j, a)| full[i * n + j] = a));
    invert_dense(&full, n).unwrap_or_default()
}

/// The first room, with so many unknowns each, and the others.
fn fitted(room: &mut [[Vec<Wide>; 4]], sizes: [usize; 4]) -> (&mut [Vec<Wide>; 4], &mut [[Vec<Wide>; 4]]) {
    let (here, below) = room.split_first_mut().expect("a room a level");
    here.iter_mut().zip(sizes).for_each(|(v, size)| v.resize(size, [0.0; 4]));
    (here, below)
}

/// Unknowns of a component-major field.
fn interleave(those: impl Iterator<Item = usize>, v: &[f64], out: &mut [Wide]) {
    let (x, others) = v.split_at(v.len() / 3);
    let (y, z) = others.split_at(x.len());
    out.iter_mut().zip(those).for_each(|(out, i)| *out = [x[i], y[i], z[i], 0.0]);
}

/// And back.
fn spread(those: impl Iterator<Item = usize>, v: &[Wide], out: &mut [f64]) {
    let (x, others) = out.split_at_mut(out.len() / 3);
    let (y, z) = others.split_at_mut(x.len());
    v.iter().zip(those).for_each(|(v, i)| (x[i], y[i], z[i]) = (v[0], v[1], v[2]));
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

/// x ← D b.
fn scaled(d: &[f64], b: &[Wide], x: &mut [Wide]) {
    x.iter_mut().zip(b).zip(d).for_each(|((x, b), d)| *x = b.map(|b| d * b));
}

/// x ← x + D b.
fn add_scaled(d: &[f64], b: &[Wide], x: &mut [Wide]) {
    x.iter_mut().zip(b).zip(d).for_each(|((x, b), d)| (0..4).for_each(|c| x[c] += d * b[c]));
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
        // of weak and strong couplings not every second unknown stays
        for (size, disorder, eliminates) in [([20, 15, 1], 0.3, true), ([100, 100, 1], 0.9, false)] {
            let matrix = lattice(size, -1.0, disorder, 0.0, 0.1);
            let grid = alone(matrix.clone());
            let [one, other] = [grid.shifted(0.7), Multigrid::of(matrix.shifted(0.7), grid.coarsening.clone())];
            assert!(one.coarsening.eliminated.is_some() == eliminates && !one.levels.is_empty());
            let v: Vec<f64> = (0..3 * matrix.order()).map(|i| f64::from(i as u32 % 7)).collect();
            let [x, y] = [one, other].map(|grid| {
                let mut x = vec![0.0; v.len()];
                grid.solve(&v, &mut x, &mut Room::default());
                x
            });
            assert!(x.iter().zip(&y).all(|(x, y)| (x - y).abs() < 1e-13 * y.abs().max(1.0)));
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
