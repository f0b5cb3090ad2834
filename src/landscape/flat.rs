//! Ways between minima that flat valleys join.

use super::{Bands, Landscape, is_same_state, turned, turns};
use crate::band::Band;
use crate::energy::Evaluator;
use crate::error::Result;
use crate::geometry::Direction;
use crate::path::{COARSE, Path, largest_angle};
use crate::sphere::SAME;
use crate::spins::Spins;
use crate::stationary::STEP;

/// A way that is lower than this part of c after a little relaxation may be flat.
const LOW: f64 = 1e-3;
/// How often a flat way's images are doubled until they are.
const DOUBLINGS: usize = 6;

/// A part of a path between two stationary states.
pub enum Stretch {
    /// One that is to be relaxed.
    Way(Path),
    /// A turn about the axis of symmetry, all states of which are stationary.
    Turn {
        /// Some states of it.
        path: Path,
        /// By what angle (rad) about which axis.
        by: (Direction, f64),
    },
}

impl Stretch {
    /// Some states of it.
    pub fn path(&self) -> &Path {
        let (Stretch::Way(path) | Stretch::Turn { path, .. }) = self;
        path
    }
}

/// So many states of a turn, from one state to another that it makes of it.
pub fn turning(from: &Spins, to: Spins, (axis, angle): (Direction, f64), images: usize) -> Path {
    let part = |k: usize| turned(from, &[(axis, angle * k as f64 / (images - 1) as f64)]);
    Path::new(&(0..images - 1).map(part).chain([to]).collect::<Vec<_>>())
}

/// The ways from a minimum to one that is joined with it, end to end: over as few flat valleys as lead there, as they were found or
/// their images, and a turn about the axis of symmetry where that is left; the geodesic where nothing is known.
pub fn flat_ways(land: &Landscape, from: &Spins, to: &Spins) -> Vec<Stretch> {
    let h = land.evaluator();
    // states in the order in which they are reached, each with the one before it and the valley from there
    let mut reached: Vec<(Spins, Option<(usize, Path)>)> = vec![(from.clone(), None)];
    let mut k = 0;
    while k < reached.len() {
        if let Some(turn) = turn(land, &reached[k].0, to) {
            let mut ways = Vec::new();
            let mut here = k;
            while let Some((before, valley)) = &reached[here].1 {
                ways.push(Stretch::Way(valley.clone()));
                here = *before;
            }
            ways.reverse();
            ways.extend(turn);
            return ways;
        }
        for valley in land.valleys_from(&reached[k].0).collect::<Vec<_>>() {
            let end = valley.spins(valley.images() - 1);
            if !reached.iter().any(|(known, _)| is_same_state(h, known.as_slice(), end.as_slice())) {
                reached.push((end, Some((k, valley))));
            }
        }
        k += 1;
    }
    vec![Stretch::Way(Path::new(&[from.clone(), to.clone()]))]
}

/// The turn about the axis of symmetry that makes one state the other, as of states of one cone: none where they are the same; nothing
/// where no turn does.
fn turn(land: &Landscape, from: &Spins, to: &Spins) -> Option<Option<Stretch>> {
    let near = |a: &Spins| largest_angle(a.as_slice(), to.as_slice()) < SAME;
    if near(from) {
        return Some(None);
    }
    let turns = turns(land.evaluator(), from, to);
    match turns[..] {
        [by] if near(&turned(from, &turns)) => {
            Some(Some(Stretch::Turn { path: turning(from, to.clone(), by, COARSE), by }))
        }
        _ => None,
    }
}

/// A way between two minima that is level to so much (meV): a soliton on a ring, moved along it. None if it is not.
pub fn flat_way(bands: &dyn Bands, band: &Band, c: f64, level_mev: f64) -> Result<Option<Path>> {
    let h: Evaluator = band.evaluator();
    let level = |band: &Band, k: usize| h.difference_mev(band.path().image(k), band.path().image(0)).abs() < level_mev;
    let e = band.energies_mev();
    let low = e.iter().all(|x| (x - e[0]).abs() < LOW * c);
    if !low || !level(band, band.images() - 1) {
        return Ok(None);
    }
    // images that lie in one minimum each hide what is between these
    let mut path = band.path().clone();
    for _ in 0..DOUBLINGS {
        let mut band = Band::new(h, path);
        bands.tightly(&mut band)?;
        if !(0..band.images()).all(|k| level(&band, k)) {
            break;
        }
        path = band.into_path();
        // nearer than minima of a lattice that holds a wall or a soliton fast: one that is broader than five sites it does not hold
        if path.largest_rotation() < STEP {
            return Ok(Some(path));
        }
        path = path.doubled();
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::{Anisotropy, EnergyTerm, Hamiltonian};
    use crate::geometry::Direction;
    use crate::landscape::Minimum;
    use crate::landscape::connect::tests::{AsTheyAre, firm_chain, wall};
    use crate::lattice::Chain;
    use crate::stationary::relax_to_minimum;

    #[test]
    fn a_way_leads_over_several_valleys_where_it_has_to() {
        let lattice = Chain::open(1).resolve().unwrap();
        // without an axis of symmetry, about which one valley would be turned to lead the whole way
        let along = |k: f64, axis: Direction| Box::new(Anisotropy::uniform(1, k, axis)) as Box<dyn EnergyTerm>;
        let terms = vec![along(1.0, Direction::Z), along(-0.5, Direction::X)];
        let h = Hamiltonian::new(&lattice, terms).unwrap();
        let state = |v: [f64; 3]| Spins::from_vectors(&[v]).unwrap();
        let [a, b, c] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(state);
        let middle = |p: [f64; 3]| state(p);
        let mut land = Landscape::new((&h).into(), a.as_slice());
        let [i, j, k] = [&a, &b, &c].map(|s| land.add_minimum(&Minimum::examine((&h).into(), s)));
        land.merge([i, j], Path::new(&[a.clone(), middle([1.0, 1.0, 0.0]), b.clone()]));
        land.merge([k, j], Path::new(&[c.clone(), middle([0.0, 1.0, 1.0]), b.clone()]));
        let ways = flat_ways(&land, &a, &c);
        let [first, second] = &ways[..] else { panic!("{} ways", ways.len()) };
        let at = |way: &Stretch, k: usize| way.path().spins(k);
        assert_eq!((at(first, 0), at(first, 2), at(second, 0), at(second, 2)), (a.clone(), b.clone(), b, c));
        assert!(flat_ways(&land, &a, &a).is_empty());
    }

    #[test]
    fn images_that_all_lie_in_minima_are_no_flat_way() {
        let hamiltonian = firm_chain(60);
        let h = (&hamiltonian).into();
        let wall = |center: f64| relax_to_minimum(h, &wall(60, center), 1e-12).unwrap().spins;
        let path = Path::new(&[28.5, 29.5, 30.5].map(wall));
        assert!(path.largest_rotation() > 0.5 && path.is_resolved());
        let mut band = Band::new(h, path);
        band.evaluate();
        assert!(band.energies_mev().iter().all(|e| (e - band.energies_mev()[0]).abs() < 1e-10));
        assert!(flat_way(&AsTheyAre, &band, 10.0, 1e-10).unwrap().is_none());
        // a turn about the axis is flat however it is looked at
        let from = wall(29.5);
        let by = (Direction::Z, 1.0);
        let turn = turning(&from, turned(&from, &[by]), by, 9);
        let mut band = Band::new(h, turn);
        band.evaluate();
        assert!(flat_way(&AsTheyAre, &band, 10.0, 1e-10).unwrap().is_some_and(|path| path.images() == 9));
    }
}
