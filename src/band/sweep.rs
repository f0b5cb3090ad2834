//! The implicit uphill sweep: nearly a Newton step for the whole band, without springs or step sizes.
//!
//! With upwind tangents a band is steepest descent integrated by implicit Euler, each image depending on its uphill neighbour
//! u alone; one pass from high to low energy solves the linearised band:
//!
//! ```text
//! for images a by descending energy:
//!   σ = |F·τ|/|m_u − m_a| (0 at extrema),   A = H + (σ + μ) 1,   C = [τ, zero modes]
//!   [A  C ] [x]   [F⊥ + σ P y_u − A x₀]
//!   [Cᵀ 0 ] [·] = [0                  ],    x₀ = d τ,    y_a = x₀ + x
//! ```
//! H is the banded Riemannian Hessian of the image. μ starts at a small part of the stiffness scale c and grows while A has a
//! negative direction in the complement of C; the count is exact (inertia of the bordered matrix).

use super::Band;
use crate::energy::{TangentBasis, assemble};
use crate::geometry::Vector;
use crate::linalg::{Banded, Ldl, eigenvalues_symmetric, slab, solve_dense};
use crate::sphere::rotation_of;
use rayon::prelude::*;

/// μ never falls below this part of c.
const SHIFT_FLOOR: f64 = 1e-3;
/// Most growth steps of μ in one evaluation.
const SHIFT_TRIES: usize = 14;

/// The sweep's memory between evaluations: the shifts μ.
#[derive(Clone, Debug)]
pub struct Sweep {
    stiffness: f64,
    shifts: Vec<f64>,
}

/// What one sweep proposes.
#[derive(Debug)]
pub struct SweepStep {
    /// Tangent moves (rad) of the images between the ends, slab after slab.
    pub moves: Vec<f64>,
    /// Largest rotation of any spin across the path (rad).
    pub rotation: f64,
    /// Banded factorisations used.
    pub factorisations: usize,
}

/// One image's linear algebra, ready for its right-hand side.
struct Solver {
    basis: TangentBasis,
    factors: Ldl,
    matrix: Banded,
    border: Vec<Vec<f64>>,
    solved: Vec<Vec<f64>>,
    schur: Vec<f64>,
    sigma: f64,
    shift: f64,
    tries: usize,
}

impl Sweep {
    /// With stiffness scale c (meV).
    pub fn new(stiffness: f64) -> Sweep {
        Sweep { stiffness, shifts: Vec::new() }
    }

    /// The moves of all images for an evaluated band.
    pub fn step(&mut self, band: &Band, axes: &[Vector]) -> SweepStep {
        let (images, slab) = (band.images(), 3 * band.path().sites());
        self.shifts.resize(images, SHIFT_FLOOR * self.stiffness);
        let c = self.stiffness;
        let solvers: Vec<Solver> =
            (1..images - 1).into_par_iter().map(|k| Solver::new(band, k, axes, c, self.shifts[k])).collect();
        for (k, s) in solvers.iter().enumerate() {
            self.shifts[k + 1] = s.shift;
        }
        let mut moves = vec![0.0; (images - 2) * slab];
        let mut order: Vec<usize> = (1..images - 1).collect();
        order.sort_by(|&a, &b| band.energies_mev()[b].total_cmp(&band.energies_mev()[a]).then(a.cmp(&b)));
        let mut step = SweepStep { moves: Vec::new(), rotation: 0.0, factorisations: 0 };
        let mut pushed = vec![0.0; slab];
        for k in order.into_iter().filter(|&k| !band.is_held(k)) {
            let solver = &solvers[k - 1];
            pushed.copy_from_slice(band.perpendicular(k));
            if let Some(u) = band.uphill(k).filter(|u| (1..images - 1).contains(u)) {
                slab::add_scaled(&mut pushed, solver.sigma, &moves[(u - 1) * slab..u * slab]);
            }
            let y = &mut moves[(k - 1) * slab..k * slab];
            let rotation = solver.relax(band, k, &pushed, y);
            step.rotation = if rotation.is_nan() { f64::NAN } else { step.rotation.max(rotation) };
            step.factorisations += solver.tries;
        }
        step.moves = moves;
        step
    }
}

impl Solver {
    fn new(band: &Band, k: usize, axes: &[Vector], c: f64, old: f64) -> Solver {
        let (h, m) = (band.hamiltonian(), band.path().image(k));
        let basis = TangentBasis::at(m);
        let hessian = assemble(h, m, band.gradient(k), &basis);
        let border = border(band, k, axes, &basis);
        let sigma = upwind_rate(band, k);
        let mut shift = if old < 0.26 * c { SHIFT_FLOOR * c } else { (old / 4.0).max(SHIFT_FLOOR * c) };
        let mut tries = 0;
        loop {
            tries += 1;
            let mut matrix = hessian.clone();
            matrix.shift(sigma + shift);
            let factors = matrix.clone().factor();
            let solved: Vec<Vec<f64>> = border.iter().map(|b| solve(&factors, b)).collect();
            let schur = gram(&border, &solved);
            let positive = eigenvalues_symmetric(&schur, border.len()).iter().filter(|e| **e > 0.0).count();
            if factors.negatives() + positive <= border.len() || tries >= SHIFT_TRIES {
                return Solver { basis, factors, matrix, border, solved, schur, sigma, shift, tries };
            }
            shift = (4.0 * shift).max(c);
        }
    }

    /// The x of [A C; Cᵀ 0] (x, ·) = (r, 0): the solution orthogonal to C.
    fn bordered(&self, r: &[f64]) -> Vec<f64> {
        let mut x = solve(&self.factors, r);
        let rhs: Vec<f64> = self.border.iter().map(|b| slab::dot(b, &x)).collect();
        let nu = solve_dense(&self.schur, &rhs, rhs.len()).unwrap_or_else(|| vec![0.0; rhs.len()]);
        for (z, n) in self.solved.iter().zip(&nu) {
            slab::add_scaled(&mut x, -n, z);
        }
        x
    }

    /// The move of an image that is pushed across the path and shifted along it; returns its largest rotation across.
    fn relax(&self, band: &Band, k: usize, pushed: &[f64], y: &mut [f64]) -> f64 {
        let mut r = self.basis.coordinates(pushed);
        let d = band.local_shift(k);
        if d != 0.0 {
            let mut ax = vec![0.0; r.len()];
            self.matrix.multiply(&self.border[0], &mut ax);
            slab::add_scaled(&mut r, -d, &ax);
        }
        for b in &self.border {
            let overlap = slab::dot(b, &r);
            slab::add_scaled(&mut r, -overlap, b);
        }
        let mut x = self.bordered(&r);
        self.basis.field(&x, y);
        let rotation = rotation_of(y);
        if d != 0.0 {
            slab::add_scaled(&mut x, d, &self.border[0]);
            self.basis.field(&x, y);
        }
        rotation
    }
}

/// Orthonormal tangent coordinates of τ and of the rotations about the symmetry axes, as far as they are independent.
fn border(band: &Band, k: usize, axes: &[Vector], basis: &TangentBasis) -> Vec<Vec<f64>> {
    let mut columns = vec![basis.coordinates(band.tangent(k))];
    for z in band.hamiltonian().rotation_modes(band.path().image(k), axes) {
        let mut z = basis.coordinates(&z);
        let size = slab::norm(&z);
        for b in &columns {
            let overlap = slab::dot(b, &z);
            slab::add_scaled(&mut z, -overlap, b);
        }
        let rest = slab::norm(&z);
        if rest > 1e-6 * size.max(1e-6) {
            slab::scale(&mut z, 1.0 / rest);
            columns.push(z);
        }
    }
    columns
}

/// σ = |F·τ|/|m_u − m| (meV), 0 at extrema.
fn upwind_rate(band: &Band, k: usize) -> f64 {
    let Some(u) = band.uphill(k) else { return 0.0 };
    let (a, b) = (band.path().image(k), band.path().image(u));
    let difference: Vec<f64> = a.iter().zip(b).map(|(x, y)| x - y).collect();
    band.along(k).abs() / slab::norm(&difference).max(1e-12)
}

fn solve(factors: &Ldl, b: &[f64]) -> Vec<f64> {
    let mut x = b.to_vec();
    factors.solve(&mut x, 1);
    x
}

/// CᵀA⁻¹C, symmetric, row by row.
fn gram(border: &[Vec<f64>], solved: &[Vec<f64>]) -> Vec<f64> {
    let n = border.len();
    let mut s = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..=i {
            let v = 0.5 * (slab::dot(&border[i], &solved[j]) + slab::dot(&border[j], &solved[i]));
            (s[i * n + j], s[j * n + i]) = (v, v);
        }
    }
    s
}
