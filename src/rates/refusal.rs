//! Where a saddle has no rate, and what would give it one.

use super::{Crossing, RateSettings};
use crate::energy::Hamiltonian;
use crate::field::Components;
use crate::geometry::{Vector, vector};
use crate::linalg::slab;
use crate::saddle::Spectrum;
use crate::spins::Spins;

/// A total moment that changes by less than this part of the sum of all is the same.
const SAME_MOMENT: f64 = 1e-6;

/// Why a saddle has no rate by any theory: no certificate, or not one descending mode. Nothing if it may have one.
pub fn unfit(crossing: &Crossing) -> Option<String> {
    let s = crossing.spectrum;
    if s.negative > 1 {
        return Some(format!(
            "the saddle has {} negative modes: a rate belongs to a saddle with one; another first path (\"path.guess\") may \
             pass a lower one",
            s.negative
        ));
    }
    if s.negative == 0 {
        return Some(format!(
            "the saddle's descending mode is flat to {:.1e} meV, the rounding error of its Hessian, so the curvature that a \
             rate is made of is not known; a shorter chain, a field or a defect gives the top of the path a shape",
            s.floor_mev
        ));
    }
    let doubt = crossing.doubt?;
    Some(format!("the saddle is not certified: {doubt}; a rate belongs to a proven saddle between two proven minima"))
}

/// Why a state is not one to be left at a rate, such as an end that was kept as given; nothing if it is a minimum.
pub fn no_minimum(spectrum: &Spectrum, torque_mev: f64) -> Option<String> {
    if spectrum.negative > 0 {
        return Some(format!("it has {} descending modes", spectrum.negative));
    }
    (!spectrum.is_stationary(torque_mev)).then(|| format!("a torque of {torque_mev:.1e} meV is left on it"))
}

/// Why precession alone cannot cross: a symmetry axis along which the total moment is conserved, and it differs between the saddle
/// and a minimum. Nothing if no such axis stands in the way.
pub fn conserved_moment(
    h: &Hamiltonian,
    saddle: &[f64],
    minima: [&Spins; 2],
    settings: &RateSettings,
) -> Option<String> {
    let total: f64 = settings.moments_mub.iter().sum();
    let changes = |axis: &Vector| {
        let at = |m: &[f64]| moment_along(h, m, *axis, &settings.moments_mub);
        let here = at(saddle);
        minima.iter().any(|m| (at(m.as_slice()) - here).abs() > SAME_MOMENT * total)
    };
    let axis = h.symmetry_axes_at(saddle).into_iter().find(changes)?;
    Some(format!(
        "the energy is the same for all turns about ({:.3}, {:.3}, {:.3}), so without damping the moment along that axis is \
         conserved and no spin crosses the saddle: what transition-state theory counts is not there; use \"langer\" with a \
         damping above 0, or a second anisotropy that breaks the symmetry",
        axis[0], axis[1], axis[2]
    ))
}

/// Total moment (μ_B) along an axis, frozen sites apart.
fn moment_along(h: &Hamiltonian, m: &[f64], axis: Vector, moments: &[f64]) -> f64 {
    let m = Components::new(m);
    let part = |i: usize| moments[i] * vector::dot(axis, m.get(i));
    slab::sum(&(0..m.sites()).filter(|&i| !h.is_frozen(i)).map(part).collect::<Vec<f64>>())
}
