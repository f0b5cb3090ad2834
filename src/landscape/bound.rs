//! How high a path rises, its images apart or not: an upper bound of the lowest barrier.

use crate::band::Band;
use crate::path::blend;

/// How many parts of a great circle between two images are looked at.
const PARTS: usize = 4;
/// How often both sides of a maximum are halved to tell how high it is: a parabola's top to rounding.
const TO_ROUNDING: usize = 16;

/// The highest of the energy on the great circles between a band's images (meV above the first image), which the lowest way from end to
/// end does not exceed; or the first that is found not to lie below `enough_mev`.
pub fn highest_between(band: &Band, enough_mev: f64) -> f64 {
    let e = band.energies_mev();
    let higher = |k: usize| e[k].max(e[k + 1]);
    let mut gaps: Vec<usize> = (0..band.images() - 1).collect();
    gaps.sort_by(|i, j| higher(*j).total_cmp(&higher(*i)));
    let mut highest = f64::NEG_INFINITY;
    for k in gaps {
        if highest >= enough_mev {
            break;
        }
        highest = highest.max(highest_in_gap(band, k, enough_mev));
    }
    highest
}

/// The highest on the great circle from image k to the next.
fn highest_in_gap(band: &Band, k: usize, enough_mev: f64) -> f64 {
    let (h, path) = (band.evaluator(), band.path());
    let mut m = vec![0.0; path.image(k).len()];
    let mut height = |t: f64| {
        blend(path.image(k), path.image(k + 1), t, &mut m);
        h.difference_mev(&m, path.image(0))
    };
    let e: Vec<f64> = (0..=PARTS).map(|i| height(i as f64 / PARTS as f64)).collect();
    let mut highest = f64::NEG_INFINITY;
    for i in (0..=PARTS).filter(|i| e[*i] >= e[i.saturating_sub(1)].max(e[PARTS.min(i + 1)])) {
        let (mut at, mut top) = (i as f64 / PARTS as f64, e[i]);
        let mut width = 1.0 / PARTS as f64;
        for _ in 0..TO_ROUNDING {
            if top >= enough_mev {
                return top;
            }
            width *= 0.5;
            for t in [at - width, at + width].into_iter().filter(|t| (0.0..=1.0).contains(t)) {
                let e = height(t);
                if e > top {
                    (at, top) = (t, e);
                }
            }
        }
        highest = highest.max(top);
    }
    highest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::{Anisotropy, EnergyTerm, Hamiltonian};
    use crate::geometry::Direction;
    use crate::lattice::Chain;
    use crate::path::Path;
    use crate::spins::Spins;

    #[test]
    fn a_maximum_between_images_is_told_to_rounding() {
        let lattice = Chain::open(1).resolve().unwrap();
        let easy = Box::new(Anisotropy::uniform(1, 0.7, Direction::Z)) as Box<dyn EnergyTerm>;
        let h = Hamiltonian::new(&lattice, vec![easy]).unwrap();
        let at = |angle: f64| Spins::from_vectors(&[[angle.sin(), 0.0, angle.cos()]]).unwrap();
        let highest = |angles: &[f64], enough_mev: f64| {
            let path = Path::new(&angles.iter().map(|a| at(*a)).collect::<Vec<_>>());
            let mut band = Band::new(&h, path);
            band.evaluate();
            highest_between(&band, enough_mev)
        };
        let angles = [0.0, 0.4, 1.3, 1.9, 2.8, 3.1];
        assert!((highest(&angles, f64::INFINITY) - 0.7).abs() < 1e-9);
        // beside an image too
        assert!((highest(&[0.0, 1.57, 3.1], f64::INFINITY) - 0.7).abs() < 1e-9);
        // no more is looked at than is asked for
        assert!((0.65..0.7).contains(&highest(&angles, 0.65)));
        // the higher end, where nothing between is higher
        assert!((highest(&[0.0, 0.4, 1.3], f64::INFINITY) - 0.7 * 1.3_f64.sin().powi(2)).abs() < 1e-12);
    }
}
