//! Places and lengths as configs count them: in spacings.
//!
//! A number counts spacings; in a chain sites, of which the first stands at 0. All places here are in spacings too, whatever the
//! spacing is.

use super::{Chain, Lattice};
use crate::error::{Error, Result};
use crate::geometry::{Direction, Vector, vector};
use crate::profile::Places;
use crate::registry::Described;
use crate::units::{Extent, Length, Place};

/// A way over a border is shorter if it is so by more than this part.
const SHORTER: f64 = 1e-9;
/// So many turns round are walked one by one; of longer ways whole turns are taken off, so many times at most.
const FEW_TURNS: f64 = 2.0;
const MOST_TURNS: usize = 1000;

impl Lattice {
    /// Whether its places are the numbers of its sites: that of a chain.
    pub fn counts_sites(&self) -> bool {
        self.kind == Chain::NAME && self.is_row()
    }

    /// Where site i is, in spacings.
    pub fn place(&self, i: usize) -> Vector {
        match self.counts_sites() {
            true => vector::scale(i as f64, self.direction().vector()),
            false => vector::scale(1.0 / self.spacing_nm.unwrap_or(1.0), self.position(i)),
        }
    }

    /// Where some sites are to a profile: in a row one after the other, elsewhere at their places.
    pub fn places_of(&self, sites: &[usize]) -> Places {
        match self.is_row() {
            true => Places::Row(sites.len()),
            false => sites.iter().map(|i| self.place(*i)).collect::<Vec<Vector>>().into(),
        }
    }

    /// Coordinates of all sites along a normal, +x if it is left out; in a chain then the sites' numbers.
    pub fn coordinates(&self, normal: Option<Direction>) -> Vec<f64> {
        if normal.is_none() && self.counts_sites() {
            return (0..self.sites).map(|i| i as f64).collect();
        }
        let n = normal.unwrap_or(Direction::X).vector();
        (0..self.sites).map(|i| vector::dot(self.place(i), n)).collect()
    }

    /// From a cell to the next along each direction, in spacings; across the others where there is only one place.
    pub fn cell_vectors(&self) -> [Vector; 3] {
        let (length, extents) = (self.spacing_nm.unwrap_or(1.0), self.extents());
        let given = [0, 1, 2].map(|d| {
            let (step, along) = self.steps[d];
            extents[d].then(|| vector::scale(step / length, along.vector()))
        });
        let mut made = given;
        for d in 0..3 {
            let across = |v: Vector| {
                let others = (0..3).filter_map(|k| made[k]);
                let mut found: Vec<Vector> = Vec::new();
                others
                    .for_each(|w| found.extend(vector::unit(found.iter().fold(w, |w, e| vector::normal_part(w, *e)))));
                found.iter().fold(v, |v, e| vector::normal_part(v, *e))
            };
            let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
            let first = [0, 1, 2].map(|k| across(axes[(d + k) % 3])).into_iter().find(|v| vector::norm(*v) > 0.5);
            made[d] = made[d].or(first.and_then(vector::unit));
        }
        made.map(Option::unwrap_or_default)
    }

    /// Once round along each periodic direction, in spacings.
    pub fn periods(&self) -> Periods {
        let cells = self.cell_vectors();
        let round = |d: usize| vector::scale(self.grid.size[d] as f64, cells[d]);
        Periods::new((0..3).filter(|d| self.grid.periodic[*d]).map(round).collect())
    }

    /// The corners of the box of all sites, of least and of greatest coordinates, in spacings.
    pub fn bounds(&self) -> [Vector; 2] {
        let start = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        (0..self.sites).map(|i| self.place(i)).fold(start, |[low, high], p| {
            [[0, 1, 2].map(|c| f64::min(low[c], p[c])), [0, 1, 2].map(|c| f64::max(high[c], p[c]))]
        })
    }

    /// So many sites, a spacing apart, are as long as the lattice is along x, y or z, whichever is most; of a row, all its sites.
    pub fn sites_along(&self) -> usize {
        let [low, high] = if self.is_row() { [[0.0; 3]; 2] } else { self.bounds() };
        let longest = vector::sub(high, low).into_iter().fold(0.0, f64::max);
        if self.is_row() { self.sites } else { longest.round() as usize + 1 }
    }

    /// The middle of the box of all sites, in spacings.
    pub fn middle(&self) -> Vector {
        let [low, high] = self.bounds();
        vector::lerp(low, high, 0.5)
    }

    /// A length in spacings.
    pub fn spacings(&self, extent: Extent) -> Result<f64> {
        let spacings = match extent {
            Extent::Spacings(x) => x,
            Extent::Length(Length(nm)) => nm / self.needed_spacing_nm()?,
        };
        match spacings.is_finite() {
            true => Ok(spacings),
            false => Err(Error::invalid("", format!("found {spacings}, but a length is a finite number of spacings"))),
        }
    }

    /// A coordinate in spacings, of those of [`coordinates`](Self::coordinates).
    pub fn coordinate(&self, extent: Extent) -> Result<f64> {
        let from_origin = matches!(extent, Extent::Length(_)) && self.counts_sites();
        Ok(self.spacings(extent)? - if from_origin { self.first() } else { 0.0 })
    }

    /// A place in spacings; z where it is left out is that of the middle.
    pub fn point(&self, place: &Place) -> Result<Vector> {
        let mut point = self.middle();
        for (c, extent) in place.0.iter().enumerate() {
            point[c] = self.coordinate_along(c, *extent).map_err(|e| e.within(&format!("[{c}]")))?;
        }
        Ok(point)
    }

    /// A point in spacings as a config has it: the place of which [`point`](Self::point) is this.
    pub fn place_of(&self, point: Vector) -> Place {
        let number = |axis: usize| {
            let one = self.coordinate_along(axis, Extent::Spacings(1.0)).unwrap_or(1.0);
            Extent::Spacings(point[axis] / one)
        };
        Place([0, 1, 2].map(number).into())
    }

    /// x, y or z of a place, in spacings; cells of a grid are counted by their own edges.
    pub fn coordinate_along(&self, axis: usize, extent: Extent) -> Result<f64> {
        let edge = match (extent, &self.sections_nm) {
            (Extent::Spacings(_), Some(_)) if !self.counts_sites() => self.steps[axis].0 / self.steps[0].0,
            _ => 1.0,
        };
        Ok(edge * self.coordinate(extent)?)
    }

    fn needed_spacing_nm(&self) -> Result<f64> {
        let missing = || Error::invalid("", "a length with a unit needs the lattice's \"spacing\" (\"0.25 nm\")");
        self.spacing_nm.ok_or_else(missing)
    }
}

/// Space repeats itself after each of these.
#[derive(Clone, Debug)]
pub struct Periods {
    once: Vec<Vector>,
    /// Sums of at most one each, there or back.
    turns: Vec<Vector>,
    /// Ways no longer than this are shortest: half of the least of these sums.
    short: f64,
}

impl Periods {
    /// Of none, one, two or three directions.
    pub fn new(once: Vec<Vector>) -> Periods {
        let turn = |k: usize| {
            let turns = (0..once.len()).map(|d| vector::scale((k / 3usize.pow(d as u32) % 3) as f64 - 1.0, once[d]));
            turns.fold([0.0; 3], vector::add)
        };
        let turns: Vec<Vector> = (0..3usize.pow(once.len() as u32)).map(turn).collect();
        let least = turns.iter().map(|t| vector::norm(*t)).filter(|t| *t > 0.0).fold(f64::INFINITY, f64::min);
        Periods { once, turns, short: 0.5 * least }
    }

    /// The way by the shortest of all images.
    pub fn shortest(&self, way: Vector) -> Vector {
        if vector::norm(way) <= self.short {
            return way;
        }
        let mut way = by_whole_turns(way, &self.once);
        loop {
            let mut best = way;
            for image in self.turns.iter().map(|turn| vector::add(way, *turn)) {
                if vector::norm(image) < vector::norm(best) * (1.0 - SHORTER) {
                    best = image;
                }
            }
            if best == way {
                return way;
            }
            way = best;
        }
    }
}

/// A way less whole turns round, until few are left: what is a million times round is not walked round a million times.
fn by_whole_turns(mut way: Vector, periods: &[Vector]) -> Vector {
    for _ in 0..MOST_TURNS {
        let before = way;
        for p in periods {
            let turns = (vector::dot(way, *p) / vector::dot(*p, *p)).round();
            if turns.abs() > FEW_TURNS {
                way = vector::sub(way, vector::scale(turns, *p));
            }
        }
        if way == before {
            break;
        }
    }
    way
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::{Chain, Grid};

    fn oblique(periodic: bool) -> Lattice {
        let grid = Grid { size: [6, 5, 1], periodic: [periodic, periodic, false] };
        let second = Direction::new([0.5, 0.75f64.sqrt(), 0.0]).unwrap();
        Lattice::bare(grid, [(1.0, Direction::X), (1.0, second), (1.0, Direction::Z)])
    }

    #[test]
    fn places_and_lengths_count_spacings_and_in_a_chain_sites() {
        let chain = Chain { spacing: Some(Length(0.25)), direction: Some(Direction::Y), ..Chain::open(9) };
        let chain = chain.resolve().unwrap();
        assert_eq!((chain.place(4), chain.coordinates(None)[7]), ([0.0, 4.0, 0.0], 7.0));
        assert_eq!(chain.coordinates(Some(Direction::X)), [0.0; 9]);
        assert_eq!(chain.spacings(Extent::Length(Length(1.0))).unwrap(), 4.0);
        let bare = Chain::open(9).resolve().unwrap();
        assert!(bare.spacings(Extent::Length(Length(1.0))).unwrap_err().to_string().contains("\"spacing\""));
        let [low, high] = oblique(false).bounds();
        assert_eq!((low, high[0]), ([0.0; 3], 7.0));
        let [a, b, c] = oblique(false).cell_vectors();
        assert!(vector::dot(a, c) == 0.0 && vector::dot(b, c).abs() < 1e-15 && vector::norm(c) == 1.0);
    }

    #[test]
    fn a_place_any_number_of_times_round_is_found_at_once() {
        let periods = oblique(true).periods();
        for far in [1e3, 1e9, 1e15, 1e200, -1e300] {
            let way = periods.shortest([far, 0.7 * far, 0.0]);
            assert!(vector::norm(way) < 6.0, "{far}: {way:?}");
        }
        let far = vector::add([0.5, 0.25, 0.0], vector::scale(1e6, vector::add(periods.once[0], periods.once[1])));
        assert!(vector::norm(vector::sub(periods.shortest(far), [0.5, 0.25, 0.0])) < 1e-8);
    }

    #[test]
    fn the_shortest_way_is_the_least_over_all_images() {
        let periods = oblique(true).periods();
        assert_eq!(periods.once.len(), 2);
        for i in 0..30 {
            let way = vector::sub(oblique(true).place(i), [3.1, 7.7, 0.2]);
            let far = vector::norm(periods.shortest(way));
            for (m, n) in (-4..5).flat_map(|m| (-4..5).map(move |n| (m, n))) {
                let by =
                    vector::add(vector::scale(m as f64, periods.once[0]), vector::scale(n as f64, periods.once[1]));
                assert!(vector::norm(vector::add(way, by)) >= far * (1.0 - 1e-8), "{way:?}");
            }
        }
        assert_eq!(Periods::new(vec![]).shortest([9.0, 1.0, 2.0]), [9.0, 1.0, 2.0]);
    }
}
