//! The descending mode of a saddle, and how fast the spins cross the plane normal to it.

use crate::field::{Components, ComponentsMut};
use crate::geometry::vector;
use crate::linalg::remove;
use crate::linalg::{lowest_modes, slab};
use crate::stationary::State;

/// Most factorisations of a search.
const ROUNDS: usize = 30;
/// A residual of more than so many times the rounding error of a product still falls, and a form of more is told from zero.
const ROUGH: f64 = 64.0;

/// A negative eigenvalue of the Hessian with its eigenvector.
#[derive(Clone, Debug)]
pub struct Unstable {
    /// λ₁ (meV), negative.
    pub eigenvalue_mev: f64,
    /// e₁, unit, tangent coordinates (2N).
    pub mode: Vec<f64>,
}

/// The one descending mode of a saddle, refined from its valley (a field of 3N numbers) or found anew. Nothing if the Hessian has no
/// negative eigenvalue apart from the zero modes `zeros`.
pub fn unstable_mode(saddle: &State, valley: &[f64], zeros: &[Vec<f64>]) -> Option<Unstable> {
    let start = saddle.basis.coordinates(valley);
    let negative = |(eigenvalue_mev, mode)| (eigenvalue_mev < 0.0).then_some(Unstable { eigenvalue_mev, mode });
    nearest_mode(saddle, start, zeros).and_then(negative).or_else(|| {
        let lowest = lowest_modes(&saddle.hessian, 1, zeros).into_iter().next()?;
        nearest_mode(saddle, lowest.vector, zeros).and_then(negative)
    })
}

/// The eigenvalue (meV) and mode to which Rayleigh-quotient iteration leads from x, apart from the modes `zeros`:
/// x ← (H − ρ)⁻¹ x, ρ = xᵀHx, of cubic convergence.
fn nearest_mode(saddle: &State, mut x: Vec<f64>, zeros: &[Vec<f64>]) -> Option<(f64, Vec<f64>)> {
    remove(&mut x, zeros);
    unit(&mut x)?;
    let noise = f64::EPSILON * saddle.hessian.norm1();
    let mut image = vec![0.0; x.len()];
    let mut residual = f64::INFINITY;
    for _ in 0..ROUNDS {
        saddle.hessian.multiply(&x, &mut image);
        let quotient = slab::dot(&x, &image);
        slab::add_scaled(&mut image, -quotient, &x);
        let now = slab::norm(&image);
        // as good as it gets: the residual is rounding, or no longer falls
        if now <= 0.5 * noise || (now <= ROUGH * noise && now >= 0.5 * residual) {
            return Some((quotient, x));
        }
        residual = now;
        let mut matrix = saddle.hessian.clone();
        matrix.shift(-quotient);
        matrix.factor().solve(&mut x, 1);
        remove(&mut x, zeros);
        unit(&mut x)?;
    }
    None
}

fn unit(x: &mut [f64]) -> Option<()> {
    let largest = slab::max_abs(x);
    if !(largest.is_finite() && largest > 0.0) {
        return None;
    }
    slab::scale(x, 1.0 / largest);
    let size = slab::norm(x);
    slab::scale(x, 1.0 / size);
    Some(())
}

impl Unstable {
    /// √(Σ Γ_i² |e₁,i|²) (rad/s per meV): Γ, as the mode has it.
    pub fn gyration(&self, saddle: &State, gyration: &[f64]) -> f64 {
        let e = saddle.field(&self.mode);
        let e = Components::new(&e);
        let square = |i: usize| gyration[i] * gyration[i] * vector::dot(e.get(i), e.get(i));
        (0..e.sites()).map(square).sum::<f64>().sqrt()
    }

    /// √(wᵀHw) with w_i = Γ_i m_i × e₁,i, in rad/s per √meV: the spread of the velocity across the dividing plane is √(k_BT) times it.
    /// `gyration` is Γ (rad/s per meV), a number a site. 0 where wᵀHw is rounding: eigenvalues below `floor_mev` have no sign.
    pub fn dynamical_factor(&self, saddle: &State, gyration: &[f64], floor_mev: f64) -> f64 {
        let e = saddle.field(&self.mode);
        let (e, m) = (Components::new(&e), Components::new(&saddle.m));
        let mut w = vec![0.0; saddle.m.len()];
        let scale = gyration.iter().fold(0.0f64, |s, g| s.max(*g));
        for i in 0..m.sites() {
            ComponentsMut::new(&mut w).set(i, vector::scale(gyration[i] / scale, vector::cross(m.get(i), e.get(i))));
        }
        let w = saddle.basis.coordinates(&w);
        let mut image = vec![0.0; w.len()];
        saddle.hessian.multiply(&w, &mut image);
        // w is orthogonal to e₁, the one direction in which the quadratic form is negative
        let spread_mev = slab::dot(&w, &image);
        if spread_mev > ROUGH * floor_mev * slab::dot(&w, &w) { scale * spread_mev.sqrt() } else { 0.0 }
    }
}
