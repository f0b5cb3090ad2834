//! How high a path rises, its images apart or not: an upper bound of the lowest barrier.

use crate::energy::Evaluator;
use crate::path::Path;

/// How often both sides of a maximum are halved to tell how high it is.
const HALVINGS: usize = 16;

/// The highest of the energy on the great circles between a path's images (meV above the first image): the lowest way from end to end
/// rises no higher.
pub fn highest_between(h: Evaluator, path: &Path) -> f64 {
    let height = |m: &[f64]| h.difference_mev(m, path.image(0));
    let fine = path.doubled().doubled();
    let e: Vec<f64> = (0..fine.images()).map(|k| height(fine.image(k))).collect();
    let last = e.len() - 1;
    let tops = (1..last).filter(|k| e[*k] >= e[k - 1].max(e[k + 1]));
    let tops = tops.map(|k| {
        let around = |path: &Path, k: usize| Path::new(&[k - 1, k, k + 1].map(|k| path.spins(k)));
        let (mut near, mut top) = (around(&fine, k), e[k]);
        for _ in 0..HALVINGS {
            let finer = near.doubled();
            let e = [1, 2, 3].map(|k| height(finer.image(k)));
            let k = (0..3).max_by(|i, j| e[*i].total_cmp(&e[*j])).unwrap_or(1);
            (near, top) = (around(&finer, k + 1), e[k]);
        }
        top
    });
    tops.fold(e[last].max(0.0), f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::{Anisotropy, EnergyTerm, Hamiltonian};
    use crate::geometry::Direction;
    use crate::lattice::Chain;
    use crate::spins::Spins;

    #[test]
    fn a_maximum_between_images_is_told_to_rounding() {
        let lattice = Chain::open(1).resolve().unwrap();
        let easy = Box::new(Anisotropy::uniform(1, 0.7, Direction::Z)) as Box<dyn EnergyTerm>;
        let h = Hamiltonian::new(&lattice, vec![easy]).unwrap();
        let at = |angle: f64| Spins::from_vectors(&[[angle.sin(), 0.0, angle.cos()]]).unwrap();
        let path = Path::new(&[0.0, 0.4, 1.3, 1.9, 2.8, 3.1].map(at));
        assert!((highest_between((&h).into(), &path) - 0.7).abs() < 1e-9);
        // the higher end, where nothing between is higher
        let path = Path::new(&[0.0, 0.4, 1.3].map(at));
        assert!((highest_between((&h).into(), &path) - 0.7 * 1.3_f64.sin().powi(2)).abs() < 1e-12);
    }
}
