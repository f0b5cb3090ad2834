//! One image of the linearised band: its factorised Hessian, bordered by the tangent and the zero modes, in memory that is
//! used again for the next image.

use super::Band;
use super::upwind::straight_rate;
use crate::field::{Components, ComponentsMut};
use crate::geometry::Vector;
use crate::hessian::{Assembly, TangentBasis};
use crate::linalg::{Factors, Matrix, eigenvalues_symmetric, orthonormal, slab, solve_dense};
use std::mem::take;

/// μ never falls below this part of c in a row, nor elsewhere where the force is larger than that part.
pub const SHIFT_FLOOR: f64 = 1e-3;
/// μ never falls below this part of the stiffness: rounding errors of the force, undamped, turn no spin by a tolerance.
const SHIFT_LEAST: f64 = 1e-8;
/// Most growth steps of μ in one evaluation.
pub const SHIFT_TRIES: usize = 14;
/// Sites in one pass: all that belongs to them stays in the second cache.
const ROW: usize = 512;
/// A border column of which less than this is left beside the others is none.
pub const LEAST: f64 = 1e-6;

/// [A C; Cᵀ 0] of one image, A = H + (σ + μ)·1, ready for its right-hand side.
#[derive(Debug, Default)]
pub struct Linearised {
    basis: TangentBasis,
    factors: Factors,
    /// Number of columns of C.
    columns: usize,
    /// C, orthonormal columns side by side, τ first.
    border: Vec<f64>,
    /// A⁻¹ C.
    solved: Vec<f64>,
    /// CᵀA⁻¹C.
    schur: Vec<f64>,
    /// The right-hand side, then the solution.
    x: Vec<f64>,
    sigma: f64,
    shift: f64,
    tries: usize,
}

/// What an image's move amounts to.
#[derive(Clone, Copy, Debug, Default)]
pub struct Move {
    /// Largest rotation of any spin across the path (rad).
    pub rotation: f64,
    /// The shift μ used (meV).
    pub shift: f64,
    /// Factorisations used.
    pub factorisations: usize,
    /// Products with the Hessian in their place.
    pub products: usize,
}

impl Linearised {
    /// Factorises image k, with symmetry axes `axes`, the stiffness scale c and the shift μ of its last visit (meV).
    pub fn prepare(&mut self, band: &Band, k: usize, axes: &[Vector], c: f64, old: f64) {
        self.sigma = straight_rate(band, k);
        self.shift = first_shift(band, k, c, old);
        self.tries = 1;
        self.factor_anew(band, k, axes);
        while !self.is_positive() && self.tries < SHIFT_TRIES {
            self.shift = (4.0 * self.shift).max(c);
            self.tries += 1;
            let mut matrix = take(&mut self.factors).into_memory();
            let assembly = self.assembly(band, k, &mut matrix);
            assembly.write_rows(&self.basis, 0..band.path().sites(), &mut matrix);
            assembly.finish(&self.basis, &mut matrix);
            self.factor(band, matrix);
        }
    }

    /// Whether A is positive definite in the complement of C.
    fn is_positive(&self) -> bool {
        let positive = eigenvalues_symmetric(&self.schur, self.columns).iter().filter(|e| **e > 0.0).count();
        self.factors.negatives() + positive <= self.columns
    }

    fn assembly<'a>(&self, band: &'a Band, k: usize, matrix: &mut Matrix) -> Assembly<'a> {
        let shift = self.sigma + self.shift;
        Assembly::begin(band.hamiltonian(), band.path().image(k), band.gradient(k), shift, matrix)
    }

    /// The basis, the border and the factors, row by row of sites.
    fn factor_anew(&mut self, band: &Band, k: usize, axes: &[Vector]) {
        let (m, n) = (band.path().image(k), band.path().sites());
        let tangent = Components::new(band.tangent(k));
        let mut matrix = take(&mut self.factors).into_memory();
        let assembly = self.assembly(band, k, &mut matrix);
        self.basis.resize(n);
        self.columns = 1 + axes.len();
        self.border.resize(2 * n * self.columns, 0.0);
        let (mut known, mut products) = (0, [0.0; 3]);
        for first in (0..n).step_by(ROW) {
            let row = first..n.min(first + ROW);
            let ahead = n.min(row.end + band.hamiltonian().reach());
            self.basis.set_row(known..ahead, m);
            known = ahead;
            let border = &mut self.border[2 * row.start * self.columns..2 * row.end * self.columns];
            match axes {
                [] => self.basis.write_row_coordinates(row.clone(), tangent.range(row.clone()), border),
                [axis] => {
                    self.basis.write_row_pair(row.clone(), tangent.range(row.clone()), *axis, border);
                    let here = slab::cross_pairs(border, border);
                    products.iter_mut().zip(here).for_each(|(sum, here)| *sum += here);
                }
                _ => {}
            }
            assembly.write_rows(&self.basis, row, &mut matrix);
        }
        assembly.finish(&self.basis, &mut matrix);
        match axes {
            [] => self.solved.clone_from(&self.border),
            [_] => self.make_orthonormal(products),
            _ => self.set_border(band, k, axes),
        }
        self.factor(band, matrix);
    }

    /// Makes the second of two columns a unit vector across the first, which is one; their products are known.
    fn make_orthonormal(&mut self, [_, overlap, square]: [f64; 3]) {
        let rest = (square - overlap * overlap).max(0.0).sqrt();
        if rest <= LEAST * square.sqrt().max(LEAST) {
            slab::one_of(&self.border, 2, 0, &mut self.solved);
            self.border.clone_from(&self.solved);
            self.columns = 1;
            return;
        }
        self.solved.resize(self.border.len(), 0.0);
        slab::turn_second(&mut self.border, 1.0 / rest, -overlap / rest, &mut self.solved);
    }

    /// Orthonormal tangent coordinates of τ and of the rotations about the symmetry axes, as far as they are independent.
    fn set_border(&mut self, band: &Band, k: usize, axes: &[Vector]) {
        let mut columns = vec![self.basis.coordinates(band.tangent(k))];
        columns.extend(axes.iter().map(|axis| {
            let mut z = self.basis.rotation(*axis);
            let size = slab::norm(&z);
            slab::scale(&mut z, 1.0 / size.max(LEAST));
            z
        }));
        let columns = orthonormal(columns, LEAST);
        self.columns = columns.len();
        slab::interleave(&columns, &mut self.border);
        self.solved.clone_from(&self.border);
    }

    /// The factors of A, A⁻¹ C, which is C at first, and CᵀA⁻¹C.
    fn factor(&mut self, band: &Band, matrix: Matrix) {
        if self.tries > 1 {
            self.solved.clone_from(&self.border);
        }
        let size = band.hamiltonian().stiffness_mev() + self.sigma + self.shift;
        let k = self.columns;
        self.factors = Factors::solving_sized(matrix, size, &mut self.solved, k);
        self.schur.clear();
        match k {
            1 => self.schur.push(slab::dot(&self.border, &self.solved)),
            2 => {
                let [tt, tz, zz] = slab::cross_pairs(&self.border, &self.solved);
                self.schur.extend([tt, tz, tz, zz]);
            }
            _ => {
                self.schur.resize(k * k, 0.0);
                for (c, z) in self.border.chunks_exact(k).zip(self.solved.chunks_exact(k)) {
                    for (entry, ij) in self.schur.iter_mut().zip(0..) {
                        *entry += c[ij / k] * z[ij % k];
                    }
                }
            }
        }
    }

    /// Writes the move `y` (3N, rad) of image k, pushed across the path, shifted along it by d, and dragged by σ times the move
    /// y_u of its uphill neighbour, if that moves: for b = F⊥ + σ y_u
    ///
    /// ```text
    /// [A C; Cᵀ 0] (y, ν) = (b, d e_τ):   y = A⁻¹b − A⁻¹C ν,   CᵀA⁻¹C ν = (A⁻¹C)ᵀb − d e_τ
    /// ```
    pub fn relax(&mut self, band: &Band, k: usize, uphill: Option<&[f64]>, y: &mut [f64]) -> Move {
        let (columns, n) = (self.columns, band.path().sites());
        let along = band.local_shift(k);
        let mut nu = self.set_right_side(band, k, uphill);
        nu[0] -= along;
        let mut nu = solve_dense(&self.schur, &nu, columns).unwrap_or_else(|| vec![0.0; columns]);
        slab::scale(&mut nu, -1.0);
        self.factors.solve(&mut self.x, 1);
        let mut y = ComponentsMut::new(y);
        let (mut rotation, mut across) = (0.0, Vec::new());
        for first in (0..n).step_by(ROW) {
            let row = first..n.min(first + ROW);
            let x = &mut self.x[2 * row.start..2 * row.end];
            let wide = 2 * row.start * columns..2 * row.end * columns;
            slab::add_columns(x, &nu, &self.solved[wide.clone()]);
            let here = if along == 0.0 {
                largest_pair(x)
            } else {
                slab::one_of(&self.border[wide], columns, 0, &mut across);
                slab::scale(&mut across, -along);
                slab::add_scaled(&mut across, 1.0, x);
                largest_pair(&across)
            };
            rotation = if here > rotation || here.is_nan() { here } else { rotation };
            self.basis.row_field(row.clone(), x, y.reborrow().into_range(row));
        }
        Move { rotation, shift: self.shift, factorisations: self.tries, products: 0 }
    }

    /// Sets x to b; returns (A⁻¹C)ᵀb.
    fn set_right_side(&mut self, band: &Band, k: usize, uphill: Option<&[f64]>) -> Vec<f64> {
        let n = band.path().sites();
        let (push, drag) = (Components::new(band.perpendicular(k)), uphill.map(Components::new));
        let mut sums = vec![0.0; self.columns];
        self.x.resize(2 * n, 0.0);
        for first in (0..n).step_by(ROW) {
            let row = first..n.min(first + ROW);
            let (x, push) = (&mut self.x[2 * row.start..2 * row.end], push.range(row.clone()));
            match drag {
                Some(drag) => {
                    self.basis.write_row_sum(row.clone(), push, self.sigma, drag.range(row.clone()), x);
                }
                None => self.basis.write_row_coordinates(row.clone(), push, x),
            }
            let solved = &self.solved[2 * row.start * self.columns..2 * row.end * self.columns];
            slab::add_dots(x, solved, &mut sums);
        }
        sums
    }
}

/// The μ to begin with, from that of the last visit (meV).
pub fn first_shift(band: &Band, k: usize, c: f64, old: f64) -> f64 {
    let floor = shift_floor(band, k, c);
    if old < 0.26 * c { floor } else { (old / 4.0).max(floor) }
}

/// The least μ of an image (meV). A row has no soft mode but the path's own; any other lattice has modes across the path that are
/// all but free (a skyrmion moves sideways), along which a shift makes steps short. There it falls with the force, so that the last
/// steps are Newton's. (D.-H. Li, M. Fukushima, L. Qi, N. Yamashita, Comput. Optim. Appl. 28, 131 (2004),
/// doi:10.1023/B:COAP.0000026881.96694.32, for regularised Newton methods.)
fn shift_floor(band: &Band, k: usize, c: f64) -> f64 {
    let h = band.hamiltonian();
    match h.lattice().is_row() {
        true => SHIFT_FLOOR * c,
        false => (SHIFT_FLOOR * c).min(band.force(k)).max(SHIFT_LEAST * h.stiffness_mev()),
    }
}

/// The longest of the pairs (x₀, x₁), (x₂, x₃), …; NaN if any entry is NaN or infinite.
fn largest_pair(x: &[f64]) -> f64 {
    let (mut largest, mut poison) = (0.0, 0.0);
    for pair in x.chunks_exact(2) {
        let square = pair[0] * pair[0] + pair[1] * pair[1];
        largest = if square > largest { square } else { largest };
        poison += 0.0 * square;
    }
    largest.sqrt() + poison
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::{Anisotropy, EnergyTerm, Exchange, Hamiltonian};
    use crate::geometry::Direction;
    use crate::hessian::assemble_into;
    use crate::lattice::Chain;
    use crate::path::Path;
    use crate::spins::Spins;
    use rand::{RngExt, SeedableRng};

    /// Chains with no symmetry axis, one and three.
    fn chains(sites: usize) -> Vec<Hamiltonian> {
        let chain = Chain::open(sites).resolve().unwrap();
        let exchange = || Box::new(Exchange::uniform(&chain, &[1.0, 0.2])) as Box<dyn EnergyTerm>;
        let along = |axis| Box::new(Anisotropy::uniform(sites, 0.3, axis)) as Box<dyn EnergyTerm>;
        let all = [
            vec![exchange(), along(Direction::Z), along(Direction::X)],
            vec![exchange(), along(Direction::Z)],
            vec![exchange()],
        ];
        all.into_iter().map(|terms| Hamiltonian::new(&chain, terms).unwrap()).collect()
    }

    fn path(r: &mut impl rand::Rng, sites: usize, images: usize) -> Path {
        let mut start: Vec<f64> = (0..3 * sites).map(|_| r.random_range(-1.0..1.0)).collect();
        let drift: Vec<f64> = (0..3 * sites).map(|_| r.random_range(-0.3..0.3)).collect();
        let image = |k: usize| {
            slab::add_scaled(&mut start, if k.is_multiple_of(2) { 0.2 } else { 1.0 }, &drift);
            Spins::from_components(&start).unwrap()
        };
        Path::new(&(0..images).map(image).collect::<Vec<_>>())
    }

    #[test]
    fn a_move_solves_the_bordered_equations_of_its_image() {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(5);
        let (mut shifted, mut tried) = (0, 0);
        for sites in [3, 40, ROW + 3] {
            for h in chains(sites) {
                let mut band = Band::new(&h, path(&mut r, sites, 5));
                band.evaluate();
                let dragged: Vec<f64> = (0..3 * sites).map(|_| r.random_range(-0.1..0.1)).collect();
                let mut room = Linearised::default();
                for k in 1..4 {
                    room.prepare(&band, k, h.symmetry_axes(), 0.6, 0.0);
                    let mut y = vec![0.0; 3 * sites];
                    let done = room.relax(&band, k, Some(&dragged), &mut y);
                    shifted += usize::from(band.local_shift(k) != 0.0);
                    tried += usize::from(done.factorisations > 1);
                    let (m, g) = (band.path().image(k), band.gradient(k));
                    let basis = TangentBasis::at(m);
                    let (mut a, mut image) = (Matrix::default(), vec![0.0; 2 * sites]);
                    assemble_into(&h, m, g, &basis, room.sigma + done.shift, &mut a);
                    let t = basis.coordinates(&y);
                    a.multiply(&t, &mut image);
                    slab::add_scaled(&mut image, -1.0, &basis.coordinates(band.perpendicular(k)));
                    slab::add_scaled(&mut image, -room.sigma, &basis.coordinates(&dragged));
                    let tau = basis.coordinates(band.tangent(k));
                    let mut columns = vec![tau.clone()];
                    columns.extend(h.symmetry_axes().iter().map(|axis| basis.rotation(*axis)));
                    let columns = orthonormal(columns, 1e-9);
                    assert_eq!(room.columns, columns.len());
                    crate::linalg::remove(&mut image, &columns);
                    assert!(slab::max_abs(&image) < 1e-11, "{sites} {k}: {}", slab::max_abs(&image));
                    for (j, c) in columns.iter().enumerate() {
                        let asked = if j == 0 { band.local_shift(k) } else { 0.0 };
                        assert!((slab::dot(c, &t) - asked).abs() < 1e-11, "{sites} {k} {j}");
                    }
                    let mut across = t.clone();
                    slab::add_scaled(&mut across, -band.local_shift(k), &tau);
                    assert!((done.rotation - largest_pair(&across)).abs() < 1e-12);
                }
            }
        }
        assert!(shifted > 5 && (5..27).contains(&tried), "{shifted} {tried}");
    }
}
