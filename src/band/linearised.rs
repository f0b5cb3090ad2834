//! One image of the linearised band: its factorised Hessian, bordered by the tangent and the zero modes, in memory that is
//! used again for the next image.

use super::Band;
use crate::energy::{TangentBasis, assemble_shifted};
use crate::geometry::Vector;
use crate::linalg::{Banded, Ldl, eigenvalues_symmetric, slab, solve_dense};

/// μ never falls below this part of c.
pub const SHIFT_FLOOR: f64 = 1e-3;
/// Most growth steps of μ in one evaluation.
const SHIFT_TRIES: usize = 14;

/// [A C; Cᵀ 0] of one image, A = H + (σ + μ)·1, ready for its right-hand side.
#[derive(Debug, Default)]
pub struct Linearised {
    basis: TangentBasis,
    factors: Ldl,
    /// Orthonormal columns of C, τ first.
    border: Vec<Vec<f64>>,
    /// A⁻¹ C.
    solved: Vec<Vec<f64>>,
    /// Room for two columns side by side.
    interleaved: Vec<f64>,
    /// CᵀA⁻¹C.
    schur: Vec<f64>,
    /// A τ, where the image is also shifted along τ.
    pulled: Vec<f64>,
    /// The right-hand side, then the solution.
    x: Vec<f64>,
    along: f64,
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
}

impl Linearised {
    /// Factorises image k, with symmetry axes `axes`, the stiffness scale c and the shift μ of its last visit (meV).
    pub fn prepare(&mut self, band: &Band, k: usize, axes: &[Vector], c: f64, old: f64) {
        self.basis.set(band.path().image(k));
        self.set_border(band, k, axes);
        self.along = band.local_shift(k);
        self.sigma = upwind_rate(band, k);
        self.shift = if old < 0.26 * c { SHIFT_FLOOR * c } else { (old / 4.0).max(SHIFT_FLOOR * c) };
        for tries in 1.. {
            self.tries = tries;
            let matrix = self.matrix(band, k);
            self.factor(matrix);
            let columns = self.border.len();
            let positive = eigenvalues_symmetric(&self.schur, columns).iter().filter(|e| **e > 0.0).count();
            if self.factors.negatives() + positive <= columns || tries >= SHIFT_TRIES {
                return;
            }
            self.shift = (4.0 * self.shift).max(c);
        }
    }

    /// A, in the memory of the last factors; A τ on the way where it is needed.
    fn matrix(&mut self, band: &Band, k: usize) -> Banded {
        let mut matrix = std::mem::take(&mut self.factors).into_memory();
        let (m, g) = (band.path().image(k), band.gradient(k));
        assemble_shifted(band.hamiltonian(), m, g, &self.basis, self.sigma + self.shift, &mut matrix);
        if self.along != 0.0 {
            self.pulled.resize(matrix.order(), 0.0);
            matrix.multiply(&self.border[0], &mut self.pulled);
        }
        matrix
    }

    /// Orthonormal tangent coordinates of τ and of the rotations about the symmetry axes, as far as they are independent.
    fn set_border(&mut self, band: &Band, k: usize, axes: &[Vector]) {
        let mut memory = std::mem::take(&mut self.border).into_iter();
        let mut tangent = memory.next().unwrap_or_default();
        self.basis.write_coordinates(band.tangent(k), &mut tangent);
        let mut columns = vec![tangent];
        for axis in axes {
            let mut z = memory.next().unwrap_or_default();
            self.basis.write_rotation(*axis, &mut z);
            let size = slab::norm(&z);
            let mut left = size * size;
            for b in &columns {
                let overlap = slab::dot(b, &z);
                slab::add_scaled(&mut z, -overlap, b);
                left -= overlap * overlap;
            }
            // by Pythagoras, unless that loses digits
            let rest = if left > 0.1 * size * size { left.sqrt() } else { slab::norm(&z) };
            if rest > 1e-6 * size.max(1e-6) {
                slab::scale(&mut z, 1.0 / rest);
                columns.push(z);
            }
        }
        self.border = columns;
    }

    /// The factors of A, A⁻¹ C and CᵀA⁻¹C.
    fn factor(&mut self, matrix: Banded) {
        let columns = self.border.len();
        self.solved.resize(columns, Vec::new());
        let (first, rest) = self.solved.split_at_mut(columns.min(2));
        match (first, &self.border[..]) {
            ([s, t], [b, c, ..]) => {
                slab::interleave(b, c, &mut self.interleaved);
                self.factors = Ldl::solving(matrix, &mut self.interleaved, 2);
                slab::deinterleave(&self.interleaved, s, t);
            }
            (first, border) => {
                let Some((s, b)) = first.first_mut().zip(border.first()) else { return };
                s.clone_from(b);
                self.factors = Ldl::solving(matrix, s, 1);
            }
        }
        for (s, b) in rest.iter_mut().zip(&self.border[columns.min(2)..]) {
            s.clone_from(b);
            self.factors.solve(s, 1);
        }
        self.schur.resize(columns * columns, 0.0);
        for i in 0..columns {
            for j in 0..=i {
                let v = slab::dot(&self.border[i], &self.solved[j]);
                (self.schur[i * columns + j], self.schur[j * columns + i]) = (v, v);
            }
        }
    }

    /// Writes the move `y` (3N, rad) of image k, pushed across the path, shifted along it, and dragged by σ times the move
    /// of its uphill neighbour, if that moves.
    pub fn relax(&mut self, band: &Band, k: usize, uphill: Option<&[f64]>, y: &mut [f64]) -> Move {
        self.basis.write_coordinates(band.perpendicular(k), &mut self.x);
        if let Some(moved) = uphill {
            self.basis.add_coordinates(self.sigma, moved, &mut self.x);
        }
        if self.along != 0.0 {
            slab::add_scaled(&mut self.x, -self.along, &self.pulled);
        }
        slab::without(&mut self.x, &self.border);
        self.solve_bordered();
        let rotation = largest_pair(&self.x);
        if self.along != 0.0 {
            slab::add_scaled(&mut self.x, self.along, &self.border[0]);
        }
        self.basis.field(&self.x, y);
        Move { rotation, shift: self.shift, factorisations: self.tries }
    }

    /// x ← the x of [A C; Cᵀ 0] (x, ·) = (x, 0): the solution orthogonal to C.
    fn solve_bordered(&mut self) {
        self.factors.solve(&mut self.x, 1);
        let rhs = slab::overlaps(&self.border, &self.x);
        let mut nu = solve_dense(&self.schur, &rhs, rhs.len()).unwrap_or_else(|| vec![0.0; rhs.len()]);
        slab::scale(&mut nu, -1.0);
        slab::add_all(&mut self.x, &nu, &self.solved);
    }
}

/// σ = |F·τ|/|m_u − m| (meV), 0 at extrema.
fn upwind_rate(band: &Band, k: usize) -> f64 {
    let Some(u) = band.uphill(k) else { return 0.0 };
    let apart = slab::distance(band.path().image(k), band.path().image(u));
    band.along(k).abs() / apart.max(1e-12)
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
