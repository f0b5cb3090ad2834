//! Whether a term's gradient is that of its energy, and its Hessian that of its gradient.

use super::curvature::{times_blocks, turned};
use super::wrong;
use crate::energy::{Blocks, EnergyTerm, density_of};
use crate::error::Result;
use crate::field::{Components, ComponentsMut, project};
use crate::lattice::{BondFamily, Lattice};
use crate::linalg::slab;
use crate::spins::Spins;

/// Random states that a term is asked at.
const STATES: u64 = 2;
/// Directions from each.
const DIRECTIONS: u64 = 3;
/// Step of differences of energies (rad).
const STEP: f64 = 1.0 / 64.0;
/// A gradient is right to this part of what a random direction makes of it.
const OF_GRADIENT: f64 = 1e-6;
/// A Hessian is right to this part.
const OF_HESSIAN: f64 = 1e-6;

/// An error where the energy or the gradient of a term is not finite, the gradient is not that of the energy, the Hessian not that of
/// the gradient, or depends on the spins where it is said not to: on random states, by differences. Of a term that joins all pairs
/// the blocks are not looked at.
pub fn check_term(term: &dyn EnergyTerm, lattice: &Lattice) -> Result<()> {
    let n = lattice.sites;
    check_gradient(term, n)?;
    let families: Vec<BondFamily> = term.families().into_iter().cloned().collect();
    let mut constant: Option<Vec<f64>> = None;
    for seed in 0..STATES {
        let m = Spins::random(n, 31 + seed);
        let v = random_tangent(m.as_slice(), 41);
        if !is_derivative(term, m.as_slice(), &v) {
            return Err(wrong(term.name(), "its Hessian is not the derivative of its gradient"));
        }
        if term.coupling().pairs().is_none() && !acts_as_its_blocks(term, &families, m.as_slice(), &v) {
            return Err(wrong(
                term.name(),
                "the blocks of its Hessian are not the whole of it: it acts further than it says",
            ));
        }
        if term.is_quadratic() {
            let fixed = random_tangent(Spins::random(n, 51).as_slice(), 52);
            let product = product(term, m.as_slice(), &fixed);
            let before = constant.get_or_insert_with(|| product.clone());
            if apart(before, &product) > OF_HESSIAN * slab::max_abs(before) {
                return Err(wrong(term.name(), "it is said to be quadratic, but its Hessian depends on the spins"));
            }
        }
    }
    Ok(())
}

/// The part of [`check_term`] that is about the energy and the gradient alone.
pub(super) fn check_gradient(term: &dyn EnergyTerm, sites: usize) -> Result<()> {
    for seed in 0..STATES {
        let m = Spins::random(sites, 31 + seed);
        let (energy, gradient, size) = evaluated(term, m.as_slice());
        if !energy.is_finite() {
            return Err(wrong(term.name(), "its energy or gradient is not finite in a random state"));
        }
        for direction in 0..DIRECTIONS {
            let v = random_tangent(m.as_slice(), 61 + direction);
            let energy = |by: f64| slab::sum(&density_of(term, &turned(m.as_slice(), &v, by)));
            let slope = (1..=3).zip([45.0, -9.0, 1.0]).map(|(k, weight)| {
                let by = f64::from(k) * STEP;
                weight * (energy(by) - energy(-by)) / (60.0 * STEP)
            });
            let (found, told) = (slope.sum::<f64>(), slab::dot(&gradient, &v));
            let spread = slab::norm(&tangent(m.as_slice(), &gradient)) * slab::norm(&v) / (sites as f64).sqrt();
            let allowed = OF_GRADIENT * spread + 1e3 * f64::EPSILON * size / STEP;
            if (found - told).abs() > allowed || !found.is_finite() {
                let message = format!(
                    "its gradient is not that of its energy: along a random direction the energy changes by {found:.9e} meV a rad, \
                     the gradient says {told:.9e}"
                );
                return Err(wrong(term.name(), message));
            }
        }
    }
    Ok(())
}

/// Energy, gradient and the sum of the sizes of all shares.
fn evaluated(term: &dyn EnergyTerm, m: &[f64]) -> (f64, Vec<f64>, f64) {
    let n = m.len() / 3;
    let (mut g, mut density) = (vec![0.0; 3 * n], vec![0.0; n]);
    term.add_gradient(Components::new(m), ComponentsMut::new(&mut g), &mut density, 0..n);
    let energy = slab::sum(&density) + if g.iter().all(|x| x.is_finite()) { 0.0 } else { f64::NAN };
    (energy, g, density.iter().map(|e| e.abs()).sum())
}

/// A random field tangent to the spheres.
pub(super) fn random_tangent(m: &[f64], seed: u64) -> Vec<f64> {
    let field = Spins::random(m.len() / 3, seed);
    tangent(m, field.as_slice())
}

fn tangent(m: &[f64], field: &[f64]) -> Vec<f64> {
    let mut v = field.to_vec();
    project(m, &mut v);
    v
}

fn product(term: &dyn EnergyTerm, m: &[f64], v: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; m.len()];
    term.add_hessian_product(Components::new(m), Components::new(v), ComponentsMut::new(&mut out));
    out
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Whether the product with the Hessian is how the gradient changes.
fn is_derivative(term: &dyn EnergyTerm, m: &[f64], v: &[f64]) -> bool {
    let step = 1e-3;
    let gradient = |by: f64| evaluated(term, &turned(m, v, by)).1;
    let mut difference = vec![0.0; m.len()];
    for (k, weight) in [45.0, -9.0, 1.0].into_iter().enumerate() {
        let by = (k + 1) as f64 * step;
        slab::add_scaled(&mut difference, weight / (60.0 * step), &gradient(by));
        slab::add_scaled(&mut difference, -weight / (60.0 * step), &gradient(-by));
    }
    agree(m, &product(term, m, v), &difference, slab::max_abs(&evaluated(term, m).1))
}

/// Whether the blocks of these bonds make the whole of the product.
pub(super) fn acts_as_its_blocks(term: &dyn EnergyTerm, families: &[BondFamily], m: &[f64], v: &[f64]) -> bool {
    let mut blocks = Blocks::zeros(m.len() / 3, families.to_vec());
    term.add_blocks(Components::new(m), &mut blocks);
    let whole = times_blocks(&blocks, Components::new(v));
    agree(m, &product(term, m, v), &whole, 1e-6 * slab::max_abs(&evaluated(term, m).1))
}

/// Whether two fields are the same in their tangential parts.
fn agree(m: &[f64], a: &[f64], b: &[f64], size: f64) -> bool {
    let [a, b] = [a, b].map(|field| tangent(m, field));
    apart(&a, &b) <= OF_HESSIAN * (slab::max_abs(&a) + size) && b.iter().all(|x| x.is_finite())
}
