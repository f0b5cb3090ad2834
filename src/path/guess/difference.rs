//! Where two states differ: in a spot, in a band across the lattice, or everywhere.

use super::outline::orthonormal;
use crate::geometry::{Vector, angle, vector};
use crate::lattice::Lattice;
use crate::linalg::solve_dense;
use crate::spins::Spins;
use std::f64::consts::TAU;

/// Spins that differ by less (rad) do not count.
pub(super) const DIFFERS: f64 = 1.0;
/// A difference goes all the way through along a direction if it is in this part of the rows across it.
const THROUGH: f64 = 0.9;
/// Points nearest to the middle among which a hollow is looked for, by the number of dimensions.
const NEAR: [usize; 4] = [0, 6, 16, 32];
/// Distances that differ by less than this part are equal.
const EQUAL: f64 = 1e-6;

/// Where two states differ.
pub(super) struct Difference {
    /// Its middle, in spacings.
    pub(super) middle: Vector,
    /// Orthonormal directions along which it goes all the way through.
    pub(super) through: Vec<Vector>,
    /// Orthonormal directions along which it does not.
    pub(super) across: Vec<Vector>,
}

impl Difference {
    /// Between two states; of the whole lattice where none of their spins is far from the other.
    pub(super) fn between(a: &Spins, b: &Spins, lattice: &Lattice) -> Difference {
        let grid = &lattice.grid;
        let differ: Vec<usize> = (0..a.sites()).filter(|i| angle(a.get(*i), b.get(*i)) > DIFFERS).collect();
        let sites: Vec<usize> = if differ.is_empty() { (0..a.sites()).collect() } else { differ };
        let cells = lattice.cell_vectors();
        let (places, extents) = (lattice.places_in_cell(), lattice.extents());
        let goes_through = |d: usize| {
            let rows = grid.size[d] * places[d];
            let row = |i: usize| ((lattice.steps_to(i)[d] * places[d] as f64 + EQUAL).floor() as usize).min(rows - 1);
            let (mut any, mut here) = (vec![false; rows], vec![false; rows]);
            (0..a.sites()).for_each(|i| any[row(i)] = true);
            sites.iter().for_each(|i| here[row(*i)] = true);
            let count = |cells: &[bool]| cells.iter().filter(|c| **c).count() as f64;
            count(&here) >= THROUGH * count(&any)
        };
        let extended = (0..3).filter(|d| extents[*d]);
        let (through, local): (Vec<usize>, Vec<usize>) = extended.partition(|d| goes_through(*d));
        let vectors = |of: &[usize]| of.iter().map(|d| cells[*d]).collect::<Vec<Vector>>();
        let through = orthonormal(&vectors(&through));
        let all = orthonormal(&[through.clone(), vectors(&local)].concat());
        let across = all[through.len()..].to_vec();
        Difference { middle: middle(lattice, &sites, a, b), through, across }
    }

    /// Whether it is a spot, or a tube: with an end in two directions at least.
    pub(super) fn is_spot(&self) -> bool {
        self.across.len() >= 2
    }

    /// The way from a place to each site by the shortest images, without the directions along which the difference goes through.
    pub(super) fn from<'l>(&self, place: Vector, lattice: &'l Lattice) -> impl Fn(usize) -> Vector + Sync + 'l {
        let (through, periods) =
            (if self.across.is_empty() { Vec::new() } else { self.through.clone() }, lattice.periods());
        move |i| {
            let way = periods.shortest(vector::sub(lattice.place(i), place));
            through.iter().fold(way, |v, e| vector::normal_part(v, *e))
        }
    }

    /// The largest hollow between the sites that is nearest to a place; the place itself where there is none.
    pub(super) fn hollow(&self, place: Vector, lattice: &Lattice) -> Vector {
        let axes = if self.across.is_empty() { &self.through } else { &self.across };
        let from = self.from(place, lattice);
        let sites = (0..lattice.sites).filter(|i| !lattice.vacant[*i]);
        let mut points: Vec<Vector> = sites.map(|i| axes_of(axes, from(i))).collect();
        points.sort_by(|p, q| {
            vector::norm(*p).total_cmp(&vector::norm(*q)).then(p.partial_cmp(q).unwrap_or(std::cmp::Ordering::Equal))
        });
        let mut near: Vec<Vector> = Vec::new();
        for p in points {
            if near.iter().all(|q| vector::norm(vector::sub(p, *q)) > EQUAL) {
                near.push(p);
            }
            if near.len() == NEAR[axes.len()] {
                break;
            }
        }
        let Some(found) = nearest_hollow(&near, axes.len()) else { return place };
        axes.iter().zip(found).fold(place, |sum, (e, x)| vector::add(sum, vector::scale(x, *e)))
    }
}

/// Whether neighbours differ more in one state than in another; parallel and antiparallel ones are alike.
pub(super) fn is_rougher(a: &Spins, b: &Spins, lattice: &Lattice) -> bool {
    let bends = |m: &Spins, [i, j]: [usize; 2]| 1.0 - vector::dot(m.get(i), m.get(j)).powi(2);
    let families = lattice.shell(1);
    let bonds = families.iter().flat_map(|family| family.bonds());
    bonds.map(|bond| bends(a, bond) - bends(b, bond)).sum::<f64>() > 0.0
}

/// Coordinates along orthonormal axes.
fn axes_of(axes: &[Vector], v: Vector) -> Vector {
    [0, 1, 2].map(|d| axes.get(d).map_or(0.0, |e| vector::dot(*e, v)))
}

/// The mean place of some sites, each with the weight 1 − a·b; around a periodic direction that of the mean angle.
fn middle(lattice: &Lattice, sites: &[usize], a: &Spins, b: &Spins) -> Vector {
    let (periods, size) = (lattice.periods(), lattice.grid.size);
    let weight = |i: usize| (1.0 - vector::dot(a.get(i), b.get(i))).max(1e-12);
    let mut turn: Vec<[f64; 2]> = vec![[0.0; 2]; 3];
    for &i in sites {
        let steps = lattice.steps_to(i);
        for d in 0..3 {
            let (sin, cos) = libm::sincos(TAU * steps[d] / size[d] as f64);
            turn[d] = [turn[d][0] + weight(i) * cos, turn[d][1] + weight(i) * sin];
        }
    }
    // near enough to the middle that the shortest ways from there are those around it
    let cells = lattice.cell_vectors();
    let first = (0..3).filter(|d| lattice.grid.periodic[*d]).fold([0.0; 3], |sum, d| {
        let angle = libm::atan2(turn[d][1], turn[d][0]);
        vector::add(sum, vector::scale(angle / TAU * size[d] as f64, cells[d]))
    });
    let way = |i: usize| periods.shortest(vector::sub(lattice.place(i), first));
    let total: f64 = sites.iter().map(|i| weight(*i)).sum();
    let sum = sites.iter().fold([0.0; 3], |sum, i| vector::add(sum, vector::scale(weight(*i) / total, way(*i))));
    vector::add(first, sum)
}

/// Of the centers of all empty spheres through points in so many dimensions the one nearest to the origin, among those of the largest
/// spheres; of equally near ones the least in x, then y, then z.
fn nearest_hollow(points: &[Vector], dimensions: usize) -> Option<Vector> {
    let furthest = points.iter().map(|p| vector::norm(*p)).fold(0.0, f64::max);
    let mut found: Vec<(f64, Vector)> = Vec::new();
    let mut chosen = Vec::new();
    subsets(points.len(), dimensions + 1, &mut chosen, &mut |corners| {
        let Some(center) = center(points, corners, dimensions) else { return };
        let radius = vector::norm(vector::sub(points[corners[0]], center));
        let inside = vector::norm(center) + radius <= furthest * (1.0 + EQUAL);
        let empty = || points.iter().all(|p| vector::norm(vector::sub(*p, center)) > radius * (1.0 - EQUAL));
        if inside && empty() {
            found.push((radius, center));
        }
    });
    let largest = found.iter().map(|(radius, _)| *radius).fold(0.0, f64::max);
    let largest =
        found.into_iter().filter(|(radius, _)| *radius > largest * (1.0 - 1e3 * EQUAL)).map(|(_, center)| center);
    let rounded = |v: Vector| v.map(|x| (x / EQUAL).round());
    let order = |v: &Vector| {
        let [x, y, z] = rounded(*v);
        [(vector::norm(*v) / EQUAL).round(), x, y, z]
    };
    largest.min_by(|p, q| order(p).partial_cmp(&order(q)).unwrap_or(std::cmp::Ordering::Equal))
}

/// All choices of so many of a number of things.
fn subsets(of: usize, count: usize, chosen: &mut Vec<usize>, each: &mut impl FnMut(&[usize])) {
    if chosen.len() == count {
        return each(chosen);
    }
    for k in chosen.last().map_or(0, |last| last + 1)..of {
        chosen.push(k);
        subsets(of, count, chosen, each);
        chosen.pop();
    }
}

/// The point as far from all of dimensions + 1 points.
fn center(points: &[Vector], corners: &[usize], dimensions: usize) -> Option<Vector> {
    let first = points[corners[0]];
    let others = corners[1..].iter().map(|k| vector::sub(points[*k], first));
    let (mut rows, mut right) = (Vec::new(), Vec::new());
    for way in others {
        rows.extend(&way[..dimensions]);
        right.push(0.5 * vector::dot(way, way));
    }
    let found = solve_dense(&rows, &right, dimensions)?;
    let finite = found.iter().all(|x| x.abs() < 1e6);
    let at = |d: usize| found.get(d).copied().unwrap_or(0.0);
    finite.then(|| vector::add(first, [at(0), at(1), at(2)]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Direction;
    use crate::lattice::Grid;

    fn lattice(size: [usize; 3], periodic: bool, second: [f64; 3]) -> Lattice {
        let grid = Grid { size, periodic: [periodic, periodic, false] };
        let second = Direction::new(second).unwrap();
        Lattice::bare(grid, [(1.0, Direction::X), (1.0, second), (1.0, Direction::Z)])
    }

    /// Up, and down within a radius of a place in the plane.
    fn spot(lattice: &Lattice, center: Vector, radius: f64) -> [Spins; 2] {
        let periods = lattice.periods();
        let down = |i: usize| {
            let [x, y, _] = periods.shortest(vector::sub(lattice.place(i), center));
            [0.0, 0.0, if x * x + y * y < radius * radius { -1.0 } else { 1.0 }]
        };
        let vectors: Vec<Vector> = (0..lattice.sites).map(down).collect();
        [Spins::from_vectors(&vectors).unwrap(), Spins::uniform(lattice.sites, Direction::Z)]
    }

    #[test]
    fn a_spot_has_its_middle_where_it_is_over_borders_too_and_a_hollow_beside_it() {
        let triangular = [0.5, 0.75f64.sqrt(), 0.0];
        for (second, hollow) in [([0.0, 1.0, 0.0], 0.5f64.sqrt()), (triangular, 1.0 / 3f64.sqrt())] {
            for periodic in [false, true] {
                for (nz, at) in [(1, 5 + 12 * 6), (3, 6 + 12 * 5), (1, if periodic { 0 } else { 5 + 12 * 5 })] {
                    let lattice = lattice([12, 12, nz], periodic, second);
                    let center = lattice.place(at);
                    let [a, b] = spot(&lattice, center, 2.1);
                    let found = Difference::between(&a, &b, &lattice);
                    assert!(found.is_spot() && found.across.len() == 2 && found.through.len() == usize::from(nz > 1));
                    let way = lattice.periods().shortest(vector::sub(found.middle, center));
                    assert!(vector::norm([way[0], way[1], 0.0]) < 1e-9, "{way:?}");
                    let beside = vector::sub(found.hollow(found.middle, &lattice), found.middle);
                    assert!((vector::norm(beside) - hollow).abs() < 1e-9, "{beside:?}");
                    let nearest = (0..lattice.sites).map(|i| {
                        let [x, y, _] = found.from(vector::add(found.middle, beside), &lattice)(i);
                        (x * x + y * y).sqrt()
                    });
                    assert!((nearest.fold(f64::MAX, f64::min) - hollow).abs() < 1e-9);
                }
            }
        }
    }

    #[test]
    fn a_band_and_a_reversal_are_no_spots_and_the_hollow_of_a_cube_is_its_middle() {
        let film = lattice([12, 8, 1], false, [0.0, 1.0, 0.0]);
        let up = Spins::uniform(96, Direction::Z);
        let down = |i: usize| [0.0, 0.0, if (4..8).contains(&(i % 12)) { -1.0 } else { 1.0 }];
        let band = Spins::from_vectors(&(0..96).map(down).collect::<Vec<_>>()).unwrap();
        let found = Difference::between(&band, &up, &film);
        assert_eq!(
            (found.across, found.through, found.middle),
            (vec![[1.0, 0.0, 0.0]], vec![[0.0, 1.0, 0.0]], [5.5, 3.5, 0.0])
        );
        let cube = lattice([6, 6, 6], false, [0.0, 1.0, 0.0]);
        let [up, down] = [Direction::Z, Direction::Z.reversed()].map(|d| Spins::uniform(216, d));
        let found = Difference::between(&up, &down, &cube);
        assert!(found.across.is_empty() && !found.is_spot());
        assert!(vector::norm(vector::sub(found.hollow([2.1, 2.2, 3.1], &cube), [2.5, 2.5, 3.5])) < 1e-9);
        assert!(vector::norm(vector::sub(found.hollow([2.1, 2.2, 2.3], &cube), [2.5; 3])) < 1e-9);
    }
}
