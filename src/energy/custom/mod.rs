//! Terms of a program's own: an energy and its gradient as functions of all spins at once, of which a config knows the name only.
//!
//! ```text
//! A v = d/dε g(exp_m(ε v)) at ε = 0          g = ∂E/∂m, v tangent; exp_m turns each spin along its great circle
//! ```
//! Where no product with the Hessian is given it is this derivative, by central differences of sixth order; its blocks are products
//! with the tangent vectors of sites so far apart that no site feels two of them ([`colours`]; A. R. Curtis, M. J. D. Powell,
//! J. K. Reid, J. Inst. Math. Appl. 13, 117 (1974), doi:10.1093/imamat/13.1.117). All evaluations are on the spheres, so that a
//! gradient needs to be right in its tangential part only: the term −(m·g) v of the Hessian makes up for the rest of it.

mod check;
mod colours;
mod curvature;
mod found;

pub use check::check_term;

use super::{Blocks, EnergyTerm};
use crate::error::{Error, Result};
use crate::field::{Components, ComponentsMut};
use crate::geometry::Vector;
use crate::lattice::{BondFamily, Lattice};
use crate::linalg::slab;
use curvature::Neighbours;
use std::fmt::Debug;
use std::ops::Range;
use std::sync::Arc;

/// The energy of all spins as a program computes it.
///
/// The vectors that it is asked at are of unit length, but where it [is quadratic](Self::is_quadratic). What is not finite ends a
/// run with an error.
pub trait CustomEnergy: Debug + Send + Sync {
    /// Its name in configs and results.
    fn name(&self) -> &str;

    /// Writes each site's share of the energy (meV) to `density`; how the sum is shared out does not matter.
    fn energy(&self, m: Components, density: &mut [f64]);

    /// Writes ∂E/∂m (meV) to `g`; its part along the spins does not matter.
    fn gradient(&self, m: Components, g: ComponentsMut);

    /// Whether E is a polynomial of second degree in the components, so that its Hessian is computed once; found out if not said. A
    /// gradient that is made tangent to the spheres is none of such an energy.
    fn is_quadratic(&self) -> Option<bool>;

    /// Which sites act on each other.
    fn reach(&self) -> Reach {
        Reach::Unknown
    }

    /// Writes (∂²E/∂m∂m) v (meV) to `out` for a tangent field v, up to parts along the spins, and says so; `false` where there is no
    /// formula, and differences of the gradient do.
    fn hessian_product(&self, _m: Components, _v: Components, _out: ComponentsMut) -> bool {
        false
    }
}

/// How far apart sites are that act on each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reach {
    /// It is found out: within a few lattice constants, else any two.
    Unknown,
    /// So many lattice constants at most (in a chain, sites; in a grid, cells along x); 0 where each site is alone.
    Within(f64),
    /// Any two act on each other.
    All,
}

/// A [`CustomEnergy`] on a lattice.
#[derive(Debug)]
pub struct Custom {
    energy: Arc<dyn CustomEnergy>,
    sites: usize,
    quadratic: bool,
    families: Vec<BondFamily>,
    neighbours: Neighbours,
    error_mev: f64,
}

impl Custom {
    /// The term, checked as by [`check_term`]; an error where it is not what it says it is.
    pub fn new(lattice: &Lattice, energy: Arc<dyn CustomEnergy>) -> Result<Custom> {
        let quadratic = found::is_quadratic(&*energy, lattice.sites)?;
        let mut term = Custom {
            energy,
            sites: lattice.sites,
            quadratic,
            families: Vec::new(),
            neighbours: Neighbours::none(lattice.sites),
            error_mev: 0.0,
        };
        check::check_gradient(&term, lattice.sites)?;
        term.find_families(lattice)?;
        check_term(&term, lattice)?;
        if !quadratic {
            term.error_mev = term.difference_error_mev();
        }
        Ok(term)
    }

    /// All that acts, within these families.
    fn set_families(&mut self, families: Vec<BondFamily>) {
        self.neighbours = Neighbours::new(self.sites, &families);
        self.families = families;
    }

    fn gradient(&self, m: &[f64]) -> Vec<f64> {
        let mut g = vec![0.0; m.len()];
        self.energy.gradient(Components::new(m), ComponentsMut::new(&mut g));
        g
    }
}

impl EnergyTerm for Custom {
    fn name(&self) -> &str {
        self.energy.name()
    }

    fn sites(&self) -> Option<usize> {
        Some(self.sites)
    }

    fn reference_mev(&self) -> f64 {
        0.0
    }

    fn add_gradient(&self, m: Components, mut g: ComponentsMut, density: &mut [f64], range: Range<usize>) {
        let n = self.sites;
        let (mut own, mut energy) = (vec![0.0; 3 * n], vec![0.0; n]);
        self.energy.gradient(m, ComponentsMut::new(&mut own));
        self.energy.energy(m, &mut energy);
        // an energy that is not finite is noticed, whatever the gradient comes to
        if !own.iter().all(|x| x.is_finite()) {
            energy.fill(f64::NAN);
        }
        slab::add_scaled(density, 1.0, &energy[range.clone()]);
        let own = Components::new(&own).range(range);
        slab::add_scaled(g.reborrow().x, 1.0, own.x);
        slab::add_scaled(g.reborrow().y, 1.0, own.y);
        slab::add_scaled(g.reborrow().z, 1.0, own.z);
    }

    fn add_hessian_product(&self, m: Components, v: Components, mut out: ComponentsMut) {
        let [m, v] = [m, v].map(|c| [c.x, c.y, c.z].concat());
        let product = self.product(&m, &v);
        let product = Components::new(&product);
        (0..self.sites).for_each(|i| out.add(i, product.get(i)));
    }

    fn add_blocks(&self, m: Components, blocks: &mut Blocks) {
        self.add_curvature(&[m.x, m.y, m.z].concat(), blocks);
    }

    fn families(&self) -> Vec<&BondFamily> {
        self.families.iter().collect()
    }

    fn is_quadratic(&self) -> bool {
        self.quadratic
    }

    fn axes(&self) -> Vec<Vector> {
        Vec::new()
    }

    fn is_whole(&self) -> bool {
        true
    }

    fn hessian_error_mev(&self) -> f64 {
        self.error_mev
    }
}

/// What is wrong with a term, with its name.
fn wrong(name: &str, message: impl Into<String>) -> Error {
    Error::invalid("", format!("\"{name}\": {}", message.into()))
}
