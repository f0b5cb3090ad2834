//! Ways to move points on spheres along given directions.
//!
//! An optimiser sees points (unit vectors, slab after slab) and, at each visit, a direction there (tangent, same shape). It
//! knows neither energies nor bands; the loop, the counting and the stopping are the driver's. One file a method.

mod implicit;
mod lbfgs;
mod preconditioned;
mod velocity_projection;

pub use implicit::Implicit;
pub use lbfgs::Lbfgs;
pub use preconditioned::Preconditioned;
pub use velocity_projection::VelocityProjection;

use crate::registry::family;
use std::fmt::Debug;

family! {
    /// An optimiser as written in a config: `{"implicit": {}}`.
    OptimiserSpec as Method {
        Implicit(Implicit),
        Preconditioned(Preconditioned),
        VelocityProjection(VelocityProjection),
        Lbfgs(Lbfgs),
    }
}

/// Which direction an optimiser wants to be shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Follows {
    /// The moves of the implicit uphill sweep (rad).
    Sweep,
    /// Q M⁻¹ Q F with shifts to equal distances (rad).
    Preconditioned,
    /// The force with springs (meV).
    Springs,
}

/// The role of an optimiser's config.
pub trait Method {
    /// The direction it follows.
    fn follows(&self) -> Follows;

    /// Starts afresh; `stiffness_mev` is the largest curvature of the energy (for steps along forces).
    fn start(&self, stiffness_mev: f64) -> Box<dyn Optimiser>;
}

/// A method at work.
pub trait Optimiser: Debug + Send {
    /// Moves `points` (slabs of `slab` numbers) to where they are to be looked at next, given the direction where they are.
    fn advance(&mut self, points: &mut [f64], slab: usize, direction: &[f64]);

    /// Everything it remembers between visits, in rows.
    fn memory(&self) -> Vec<Vec<f64>> {
        Vec::new()
    }

    /// Takes over the memory of another one of its kind, and goes on as that would.
    fn remember(&mut self, _memory: Vec<Vec<f64>>) {}
}
