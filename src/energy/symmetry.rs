//! Axes about which all spins can be turned together without a change of energy, found from the energy itself, not from what
//! its terms are called.
//!
//! ```text
//! dE/dφ = e · Σ m_i × ∂E/∂m_i      a turn of all spins about e
//! ```
//! The axis e is one of symmetry just where this vanishes for every state. A few random states decide: each has a total torque
//! Σ m_i × ∂E/∂m_i, to which every axis of symmetry is normal.

use super::EnergyTerm;
use crate::field::{Components, ComponentsMut};
use crate::geometry::{Vector, vector};
use crate::spins::Spins;

/// How many states decide: two torques give the axis that is normal to both, the others are the test.
const STATES: u64 = 4;
/// Torques below this part of ‖∂E/∂m‖₂ are rounding error.
const ROUNDING: f64 = 256.0 * f64::EPSILON;

/// A random state's total torque, and what it is certain to (both meV).
struct Torque {
    total: Vector,
    noise: f64,
}

/// Unit vectors about which a rotation of all spins leaves the sum of the terms as it is: none, one, or x, y and z. An axis that
/// a term names is given as it is written there.
pub fn symmetry_axes(terms: &[Box<dyn EnergyTerm>], sites: usize) -> Vec<Vector> {
    let cartesian = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let torques: Vec<Torque> = (1..=STATES).map(|seed| torque(terms, &Spins::random(sites, seed))).collect();
    if torques.iter().all(|t| vector::norm(t.total) <= t.noise) {
        return cartesian.to_vec();
    }
    let is_normal = |axis: &Vector| torques.iter().all(|t| vector::dot(*axis, t.total).abs() <= t.noise);
    let named = terms.iter().flat_map(|t| t.axes()).chain(cartesian);
    named.chain(normal_to(&torques)).find(is_normal).into_iter().collect()
}

fn torque(terms: &[Box<dyn EnergyTerm>], state: &Spins) -> Torque {
    let m = Components::new(state.as_slice());
    let n = state.sites();
    let (mut gradient, mut density) = (vec![0.0; 3 * n], vec![0.0; n]);
    for t in terms {
        t.add_gradient(m, ComponentsMut::new(&mut gradient), &mut density, 0..n);
    }
    let g = Components::new(&gradient);
    let total = (0..n).fold([0.0; 3], |sum, i| vector::add(sum, vector::cross(m.get(i), g.get(i))));
    Torque { total, noise: ROUNDING * crate::linalg::slab::norm(&gradient) }
}

/// The direction normal to two of the torques, to those that determine it best.
fn normal_to(torques: &[Torque]) -> Option<Vector> {
    let pairs = torques.iter().enumerate().flat_map(|(k, a)| torques[..k].iter().map(move |b| (a, b)));
    let crossed = pairs.map(|(a, b)| vector::cross(a.total, b.total));
    let longest = crossed.max_by(|p, q| vector::norm(*p).total_cmp(&vector::norm(*q)))?;
    let length = vector::norm(longest);
    (length > 0.0).then(|| vector::scale(1.0 / length, longest))
}
