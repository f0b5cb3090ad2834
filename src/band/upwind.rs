//! What ties an image on a slope to its neighbour uphill, towards which its tangent looks.
//!
//! ```text
//! τ = ± v/|v|,  v = P (m_u − m),  F⊥ = F − (F·τ) τ
//! δF⊥ = −(H + σ m·m_u) x + σ P y_u,  σ = |F·τ|/|v|        across τ: x moves the image, y_u the neighbour
//! ```
//! (m·m_u is told spin by spin.) H + σ m·m_u is the Hessian of E − σ Σ m·m_u: a Newton step of an image is one towards the least of
//! E + ½ σ |m − m_u|², implicit Euler's step of length 1/σ from its neighbour. With σ alone in its place the error of soft modes falls to
//! 0.4 a step, of images 1 rad apart. Where a spin turns by more the derivative tells little, and σ alone holds the image.

use super::Band;
use crate::path::RESOLVED;

/// A neighbour is not nearer than this.
const NEAREST: f64 = 1e-12;

/// σ (meV), 0 at extrema.
pub fn upwind_rate(band: &Band, k: usize) -> f64 {
    rate(band, k, 1)
}

/// σ with |m_u − m| for |v| (meV), 0 at extrema: what images are held by whose Hessians are factorised, whatever the
/// distance. (With the derivative some rings take 7 evaluations for 11, but hard chains lost their lowest barriers.)
pub fn straight_rate(band: &Band, k: usize) -> f64 {
    rate(band, k, 0)
}

fn rate(band: &Band, k: usize, chord: usize) -> f64 {
    if band.uphill(k).is_some() { band.along(k).abs() / band.chord(k)[chord].max(NEAREST) } else { 0.0 }
}

/// The gradient (meV) of the energy with the pull, of which a Hessian is made: g − σ m_u, or g − σ m where m_u is far; g where nothing
/// pulls. `room` is memory.
pub fn pulled<'a>(band: &'a Band, k: usize, sigma: f64, room: &'a mut Vec<f64>) -> &'a [f64] {
    let g = band.gradient(k);
    let Some(u) = band.uphill(k) else { return g };
    let is_near = band.widest(k.min(u)) <= RESOLVED;
    let to = band.path().image(if is_near { u } else { k });
    room.clear();
    room.extend(g.iter().zip(to).map(|(g, m)| g - sigma * m));
    room
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::test_terms::{hamiltonian, lattice};
    use crate::field::project;
    use crate::linalg::slab;
    use crate::path::Path;
    use crate::sphere::move_points;
    use crate::spins::Spins;

    /// Spins of a film on their way from up to down, some far ahead of others.
    fn image(sites: usize, k: usize) -> Spins {
        let spin = |i: usize| {
            let (angle, turn) = (0.5 * k as f64 + 0.3 + 0.7 * (i as f64).sin(), 0.06 * (k * i) as f64);
            [angle.sin() * turn.cos(), angle.sin() * turn.sin(), angle.cos()]
        };
        Spins::from_vectors(&(0..sites).map(spin).collect::<Vec<_>>()).unwrap()
    }

    #[test]
    fn with_the_pull_the_hessian_is_the_derivative_of_the_force_across() {
        let film = lattice(r#"{"square": {"cells": [4, 3]}}"#);
        let easy = r#"{"anisotropy": {"K": "0.3 meV", "axis": [0.2, 0, 1]}}"#;
        let h = hamiltonian(&film, &[r#"{"exchange": {"J": ["1 meV"]}}"#, easy]);
        let path = Path::new(&(0..6).map(|k| image(film.sites, k)).collect::<Vec<_>>());
        let mut band = Band::new(&h, path.clone());
        band.evaluate();
        let slopes: Vec<(usize, usize)> = (1..5).filter_map(|k| Some((k, band.uphill(k)?))).collect();
        assert!(slopes.iter().any(|(k, u)| u > k) && slopes.iter().any(|(k, u)| u < k), "{slopes:?}");
        for (k, u) in slopes {
            assert!((0.6..1.0).contains(&band.widest(k.min(u))), "{}", band.widest(k.min(u)));
            let mut moves = [3, 4].map(|seed| Spins::random(film.sites, seed).as_slice().to_vec());
            for (v, at) in moves.iter_mut().zip([k, u]) {
                project(path.image(at), v);
            }
            // what is along the tangent is no move across the path
            let tau = band.tangent(k);
            let along = slab::dot(&moves[0], tau);
            slab::add_scaled(&mut moves[0], -along, tau);
            let force = |by: f64| {
                let states = (0..6).map(|i| {
                    let mut m = path.image(i).to_vec();
                    let v = if i == k {
                        Some(&moves[0])
                    } else if i == u {
                        Some(&moves[1])
                    } else {
                        None
                    };
                    if let Some(v) = v {
                        let size = v.len();
                        move_points(&mut m, v, size, by);
                    }
                    Spins::from_unit_components(&m)
                });
                let mut band = Band::new(&h, Path::new(&states.collect::<Vec<_>>()));
                band.evaluate();
                assert_eq!(band.uphill(k), Some(u));
                let mut force = band.perpendicular(k).to_vec();
                across(&mut force, path.image(k), tau);
                force
            };
            let (step, mut change) = (1e-5, force(1e-5));
            slab::add_scaled(&mut change, -1.0, &force(-step));
            slab::scale(&mut change, 0.5 / step);
            let (sigma, mut room) = (upwind_rate(&band, k), Vec::new());
            let mut told = vec![0.0; change.len()];
            h.hessian_product(path.image(k), pulled(&band, k, sigma, &mut room), &moves[0], &mut told);
            slab::scale(&mut told, -1.0);
            slab::add_scaled(&mut told, sigma, &moves[1]);
            across(&mut told, path.image(k), tau);
            slab::add_scaled(&mut told, -1.0, &change);
            assert!(
                slab::norm(&told) < 1e-8 * slab::norm(&change),
                "{k}: {:e}",
                slab::norm(&told) / slab::norm(&change)
            );
            assert!(sigma > 0.1, "{sigma}");
        }
    }

    /// P of a field, without what is along τ.
    fn across(field: &mut [f64], m: &[f64], tau: &[f64]) {
        project(m, field);
        let along = slab::dot(field, tau);
        slab::add_scaled(field, -along, tau);
    }
}
