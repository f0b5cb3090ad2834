//! A Hessian that is multiplied and never written, whatever the couplings; without entries it has no factors.

use super::TangentBasis;
use crate::energy::Hamiltonian;

/// The Riemannian Hessian at `m`, where the Euclidean gradient is `g`, in the coordinates of a basis there.
#[derive(Clone, Copy, Debug)]
pub struct Free<'a> {
    /// The energy.
    pub h: &'a Hamiltonian,
    /// Spins (3N).
    pub m: &'a [f64],
    /// ∂E/∂m there (3N, meV).
    pub g: &'a [f64],
    /// The tangent basis there.
    pub basis: &'a TangentBasis,
}

impl Free<'_> {
    /// y ← H x (2N, meV), with a stiff diagonal on frozen sites as in [`assemble`](super::assemble).
    pub fn multiply(&self, x: &[f64], y: &mut Vec<f64>) {
        let (mut v, mut image) = (vec![0.0; self.m.len()], vec![0.0; self.m.len()]);
        self.basis.field(x, &mut v);
        self.h.hold_frozen(&mut v);
        self.h.hessian_product(self.m, self.g, &v, &mut image);
        self.basis.write_coordinates(&image, y);
        for i in (0..self.h.sites()).filter(|i| self.h.is_frozen(*i)) {
            (0..2).for_each(|a| y[2 * i + a] = self.h.stiffness_mev() * x[2 * i + a]);
        }
    }
}
