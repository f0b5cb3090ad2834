//! The ends of a path: relaxed, or kept as they were given.

use super::outcome::MOVED_FAR_RAD;
use crate::energy::Evaluator;
use crate::spins::Spins;
use crate::stationary::{ALIKE, Point, Relaxed, Spectrum, WayDown};

/// An end that stays as it is.
pub fn kept(spins: &Spins, max_torque_mev: f64, spectrum: Option<Spectrum>) -> Relaxed {
    let spins = spins.clone();
    Relaxed {
        spins,
        max_torque_mev,
        steps: 0,
        largest_rotation_rad: 0.0,
        left: None,
        converged: true,
        spectrum,
        stiffness_mev: None,
    }
}

/// The largest component of the force on a state (meV).
pub fn torque_mev(h: Evaluator, spins: &Spins) -> f64 {
    Point::at(h, spins.as_slice().to_vec()).max_torque_mev()
}

/// What a user should know of how an end relaxed.
pub fn judge_end(h: Evaluator, r: &Relaxed, which: &str) -> Vec<String> {
    let mut warnings = Vec::new();
    let far = (r.largest_rotation_rad > MOVED_FAR_RAD).then(|| {
        let degrees = r.largest_rotation_rad.to_degrees();
        format!(
            "far from where it was put: a spin turned by {degrees:.0} degrees, so it may be another state than meant"
        )
    });
    let falls = |way: &&WayDown| way.fallen_mev > ALIKE * h.stiffness_mev();
    if let Some(WayDown { site, direction: [x, y, z], fallen_mev }) = r.left.as_ref().filter(falls) {
        warnings.push(format!(
            "the {which} state came to rest where it is no minimum: the energy falls by {fallen_mev:.3e} meV on the way that \
             turns site {site} most, towards ({x:.2}, {y:.2}, {z:.2}); it was relaxed further that way{}",
            far.map_or(String::new(), |far| format!(", {far}"))
        ));
    } else if let Some(far) = far {
        warnings.push(format!("the {which} state relaxed {far}"));
    }
    if !r.converged {
        warnings
            .push(format!("the {which} state did not relax fully: a torque of {:.1e} meV remains", r.max_torque_mev));
    }
    warnings
}
