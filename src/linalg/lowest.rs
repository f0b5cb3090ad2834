//! The lowest eigenvalues of a matrix: slice by slice, or by block Lanczos on the inverse; those of a matrix that is factorised
//! already by the latter alone.

use super::krylov::{Krylov, MOST, Modes};
use super::ritz::{Mode, none_is_missed, rayleigh_ritz};
use super::slices::sliced;
use super::together::together;
use super::{Factors, Matrix, Wanted};

/// A vector with |A⁻¹v − θv| ≤ this part of θ is an eigenvector.
const SHARP: f64 = 1e-8;
/// Vectors in a block: as many as modes are often degenerate, and for the rare case in which that was too few.
const BLOCKS: [usize; 2] = [2, 4];
/// Most vectors from the factors of the matrix itself, whose modes may be far from zero. (Of 24 a survey of an 18 × 10 film finds a
/// fifth of its saddles, of 32 what it finds of 60.)
const MOST_AS_IT_IS: usize = 32;

/// The `count` lowest modes of `matrix` in the space orthogonal to `known` (orthonormal vectors, invariant under it),
/// ascending. Fewer where the space is smaller. Deterministic.
///
/// By Rayleigh-quotient iteration in brackets that the inertia gives (see `slices`); of sparse matrices, whose factors are dearer
/// than solutions by them, block Lanczos on (A − s)⁻¹ (see `together`). The inertia tells whether one was missed. Either way takes the other's place where that does not
/// arrive.
pub fn lowest_modes(matrix: &Matrix, count: usize, known: &[Vec<f64>]) -> Vec<Mode> {
    lowest_modes_beside(matrix, count, known, (Wanted::Vectors, &[]))
}

/// What is wanted of the lowest modes, where the vectors of the first of them are given, perhaps roughly: of sparse matrices these are
/// not looked for anew.
pub fn lowest_modes_beside(
    matrix: &Matrix,
    count: usize,
    known: &[Vec<f64>],
    (wanted, given): (Wanted, &[Vec<f64>]),
) -> Vec<Mode> {
    those_below(matrix, Modes { count, below: f64::INFINITY, part: wanted.residual() }, known, given)
}

/// The modes among the `count` lowest that are below a limit, but one at least; as [`lowest_modes`], without the time that the
/// modes above the limit take, which on long chains are close together.
pub fn soft_modes(matrix: &Matrix, count: usize, known: &[Vec<f64>], below: f64) -> Vec<Mode> {
    those_below(matrix, Modes { count, below, part: Wanted::Values.residual() }, known, &[])
}

impl Wanted {
    /// What |A⁻¹v − θv| may be in parts of θ: the eigenvalue is right to the square of it.
    pub fn residual(self) -> f64 {
        self.part().sqrt().max(SHARP)
    }
}

fn those_below(matrix: &Matrix, wanted: Modes, known: &[Vec<f64>], given: &[Vec<f64>]) -> Vec<Mode> {
    let n = matrix.order();
    let room = n.saturating_sub(known.len());
    let wanted = Modes { count: wanted.count.min(room), ..wanted };
    if wanted.count == 0 {
        return Vec::new();
    }
    let slices = || sliced(matrix, wanted.count, known, wanted.below);
    let found = match matrix {
        Matrix::Tail(_) => None,
        Matrix::Sparse(_) => {
            let (modes, complete) = together(matrix, known, given, wanted);
            if complete { Some(modes) } else { slices().or(Some(modes)) }
        }
        _ => slices(),
    };
    found.unwrap_or_else(|| lanczos(matrix, wanted, known))
}

/// The vectors of all negative modes of a factorised matrix, or, where there are none, of the lowest mode; ascending, in the space
/// orthogonal to `known` (orthonormal, invariant). From `starts`, which should have something of them, by block Lanczos on the
/// inverse: as many as the inertia counts, each with |A⁻¹v − v/λ| ≤ `part`/|λ|. Nothing where so many are not found soon.
pub fn modes_by_factors(
    factors: &Factors,
    known: &[Vec<f64>],
    starts: Vec<Vec<f64>>,
    part: f64,
) -> Option<Vec<Vec<f64>>> {
    let negatives = factors.negatives();
    // where several starts are at hand two solutions for all of them at once may do
    let block = starts.len().max(1);
    let mut look = if block > 1 { 2 * block } else { 2 * negatives + 4 };
    let mut krylov = Krylov::new(factors, known, block);
    (krylov.starts, krylov.passes) = (starts, 1);
    loop {
        let last = !krylov.grow() || krylov.is_full(MOST_AS_IT_IS);
        if last || krylov.is_full(look) {
            let found = krylov.negative(negatives, part);
            if last || found.is_some() {
                return found;
            }
            look += (look / 5).max(2);
        }
    }
}

/// Some of the `count` lowest modes, at least one, by block Lanczos.
fn lanczos(matrix: &Matrix, wanted: Modes, known: &[Vec<f64>]) -> Vec<Mode> {
    let scale = matrix.norm1().max(1e-280);
    let shift = shift_below(matrix, scale);
    let mut shifted = matrix.clone();
    shifted.shift(shift);
    let factors = shifted.factor();
    let mut modes = Vec::new();
    for block in BLOCKS {
        let mut krylov = Krylov::new(&factors, known, block);
        let (space, _) = krylov.largest(Modes { below: wanted.below + shift, ..wanted }, MOST);
        modes = rayleigh_ritz(matrix, &space);
        if none_is_missed(matrix, &modes, known, scale) {
            break;
        }
    }
    modes
}

/// s with A + s·1 positive definite and its lowest eigenvalue small beside that of A: halves an interval by the inertia.
/// The nearer the lowest eigenvalue is to zero, the fewer blocks the others take.
fn shift_below(matrix: &Matrix, scale: f64) -> f64 {
    let positive = |s: f64| {
        let mut a = matrix.clone();
        a.shift(s);
        a.factor().negatives() == 0
    };
    let least = 1e-11 * scale;
    let mut enough = least;
    while !positive(enough) && enough < 4.0 * scale {
        enough *= 16.0;
    }
    let mut too_little = if enough > least { enough / 16.0 } else { -matrix.smallest_diagonal().max(least) };
    for _ in 0..12 {
        let same_sign = enough * too_little > 0.0;
        let near = (enough - too_little).abs() <= 0.1 * too_little.abs().min(enough.abs());
        if same_sign && near || enough - too_little <= least {
            break;
        }
        // in steps of size where the sign is settled, else towards the smallest size that counts
        let middle = match same_sign {
            true => (enough * too_little).sqrt().copysign(enough),
            false => -(too_little.abs() * least).sqrt().max(least),
        };
        if positive(middle) {
            enough = middle;
        } else {
            too_little = middle;
        }
    }
    enough
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::sparse::samples::Lattice;
    use crate::linalg::{Banded, slab};
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// By slices and by Lanczos, far from the modes and near them, with and without the other's help.
    fn all_ways(matrix: &Matrix, count: usize, known: &[Vec<f64>]) -> [Vec<Mode>; 4] {
        let slices = sliced(matrix, count, known, f64::INFINITY).expect("slices converge");
        let all = Modes { count, below: f64::INFINITY, part: Wanted::Values.residual() };
        let (near, complete) = together(matrix, known, &[], all);
        assert!(complete);
        [slices, lanczos(matrix, all, known), near, lowest_modes(matrix, count, known)]
    }

    #[test]
    fn the_modes_of_a_vibrating_string_are_found_with_and_without_a_known_one() {
        let n = 200;
        let mut a = Matrix::from(Banded::zeros(n, 1));
        for i in 0..n {
            a.add(i, i, 2.0);
            if i > 0 {
                a.add(i, i - 1, -1.0);
            }
        }
        a.shift(-0.01);
        let exact = |k: usize| 2.0 - 2.0 * libm::cos(k as f64 * std::f64::consts::PI / (n as f64 + 1.0)) - 0.01;
        for modes in all_ways(&a, 6, &[]) {
            assert_eq!(modes.len(), 6);
            for (k, m) in modes.iter().enumerate() {
                assert!((m.value - exact(k + 1)).abs() < 1e-10, "{k}: {} {}", m.value, exact(k + 1));
            }
            for rest in all_ways(&a, 2, &[modes[0].vector.clone()]) {
                assert!((rest[0].value - exact(2)).abs() < 1e-10 && (rest[1].value - exact(3)).abs() < 1e-10);
            }
        }
        let limit = 0.5 * (exact(3) + exact(4));
        let below = |limit: f64| sliced(&a, 6, &[], limit).map(|modes| modes.len());
        assert_eq!([below(limit), below(-1.0)], [Some(3), Some(1)]);
    }

    #[test]
    fn degenerate_modes_are_all_found() {
        let (rows, copies) = (20, 4);
        let mut a = Matrix::from(Banded::zeros(rows * copies, copies));
        for i in 0..rows * copies {
            a.add(i, i, 2.0);
            if i >= copies {
                a.add(i, i - copies, -1.0);
            }
        }
        let exact = |k: usize| 2.0 - 2.0 * libm::cos(k as f64 * std::f64::consts::PI / (rows as f64 + 1.0));
        for modes in all_ways(&a, 6, &[]) {
            for (k, mode) in modes.iter().enumerate() {
                assert!((mode.value - exact(1 + k / copies)).abs() < 1e-12, "{k}: {}", mode.value);
            }
            assert_eq!(modes.len(), 6);
        }
    }

    #[test]
    fn modes_beside_given_ones_are_those_that_are_found_without_whatever_is_given() {
        let mut r = ChaCha8Rng::seed_from_u64(22);
        let lattice = Lattice::grid([12, 10, 1], [true, false, false], 1.0, &mut r);
        let mut sparse = lattice.random(&mut r);
        sparse.shift(1.0);
        let a = Matrix::Sparse(sparse);
        let exact = lowest_modes(&a, 5, &[]);
        assert!(exact[1].value < 0.0 && exact[4].value > exact[3].value);
        let size = lowest_modes_beside(&a, 1, &[], (Wanted::Size, &[]));
        assert!((size[0].value / exact[0].value - 1.0).abs() < 1e-3, "{} {}", size[0].value, exact[0].value);
        let mut stirred = exact[0].vector.clone();
        slab::stir(&mut stirred, 0.2);
        let size = slab::norm(&stirred);
        slab::scale(&mut stirred, 1.0 / size);
        let vector = |k: usize| exact[k].vector.clone();
        // the lowest two, roughly the lowest, and modes of which lower ones are not given
        for given in [vec![vector(0), vector(1)], vec![stirred], vec![vector(3)], vec![vector(2), vector(4)]] {
            for wanted in [Wanted::Vectors, Wanted::Values] {
                let found = lowest_modes_beside(&a, 5, &[], (wanted, &given));
                assert_eq!(found.len(), 5);
                for (mode, exact) in found.iter().zip(&exact) {
                    assert!((mode.value - exact.value).abs() < 1e-10, "{wanted:?}: {} {}", mode.value, exact.value);
                    let along = slab::dot(&mode.vector, &exact.vector).abs();
                    assert!((along - 1.0).abs() < 1e-7, "{wanted:?} {}: {along}", mode.value);
                }
            }
        }
    }

    #[test]
    fn factors_tell_a_lone_negative_mode_and_the_lowest_where_none_is_negative() {
        let mut r = ChaCha8Rng::seed_from_u64(23);
        let lattice = Lattice::grid([12, 10, 1], [true, false, false], 1.0, &mut r);
        let sparse = lattice.random(&mut r);
        let exact = lowest_modes(&Matrix::Sparse(sparse.clone()), 2, &[]);
        for shift in [-0.5 * (exact[0].value + exact[1].value), 0.1 - exact[0].value] {
            let mut matrix = sparse.clone();
            matrix.shift(shift);
            let factors = Matrix::Sparse(matrix).factor();
            let found = |wanted: Wanted| {
                let modes = modes_by_factors(&factors, &[], Vec::new(), wanted.residual()).expect("it is told");
                assert_eq!(modes.len(), 1);
                slab::dot(&modes[0], &exact[0].vector).abs()
            };
            assert!(found(Wanted::Vectors) > 1.0 - 1e-12);
            let roughly = found(Wanted::Size);
            assert!((0.99..1.0 - 1e-12).contains(&roughly), "{roughly}");
        }
    }

    #[test]
    fn unknowns_without_couplings_give_their_diagonal() {
        let mut a = Matrix::from(Banded::zeros(50, 1));
        (0..50).for_each(|i| a.add(i, i, if i == 7 { -2.0 } else { 1.0 }));
        let values: Vec<f64> = lowest_modes(&a, 3, &[]).iter().map(|m| m.value).collect();
        assert!((values[0] + 2.0).abs() < 1e-12 && values[1..].iter().all(|v| (v - 1.0).abs() < 1e-12), "{values:?}");
    }

    #[test]
    fn the_modes_of_random_matrices_agree_with_a_dense_solver() {
        let mut r = ChaCha8Rng::seed_from_u64(8);
        for round in 0..60 {
            let (n, width) = (3 + round, 1 + round % 5);
            let mut a = Matrix::from(Banded::zeros(n, width.min(n - 1)));
            let level = [0.0, 3.0, -3.0, 2.5][round % 4];
            for j in 0..n {
                for i in j..n.min(j + 1 + width.min(n - 1)) {
                    a.add(i, j, r.random_range(-1.0..1.0) + if i == j { level } else { 0.0 });
                }
            }
            let full: Vec<f64> = (0..n * n).map(|e| a.get(e / n, e % n)).collect();
            let exact = crate::linalg::eigenvalues_symmetric(&full, n);
            for count in [1, 2, 6] {
                let count = count.min(n);
                let found = all_ways(&a, count, &[]);
                assert!(found.iter().all(|modes| modes.len() == count));
                for (mode, value) in found.iter().flat_map(|modes| modes.iter().zip(&exact)) {
                    assert!((mode.value - value).abs() < 1e-9, "n {n} count {count}: {} {value}", mode.value);
                    let mut rest = vec![0.0; n];
                    a.multiply(&mode.vector, &mut rest);
                    slab::add_scaled(&mut rest, -mode.value, &mode.vector);
                    assert!(slab::norm(&rest) < 1e-4, "n {n} count {count}: residual {}", slab::norm(&rest));
                }
            }
        }
    }

    #[test]
    fn a_matrix_of_one_unknown_has_one_mode() {
        let mut a = Matrix::from(Banded::zeros(1, 0));
        a.add(0, 0, -3.0);
        let modes = lowest_modes(&a, 4, &[]);
        assert_eq!(modes.len(), 1);
        assert_eq!(modes[0].value, -3.0);
    }
}
