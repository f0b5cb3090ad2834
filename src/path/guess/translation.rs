//! What a state holds is [carried](super::carried) to where the other state has it: a skyrmion moves along a track.
//!
//! What lies under it is filled in from around, cell by cell from like cells on either side. The shift s, in whole cells, is the one after
//! which what each state has beside that is the other's, a_i = b_{i+s}, by the shortest way.

use super::carried::{Carried, SEEN};
use super::difference::{DIFFERS, Difference};
use super::{FirstGuess, GuessContext};
use crate::error::{Error, Result};
use crate::geometry::{Vector, angle, vector};
use crate::lattice::{Lattice, Shift};
use crate::path::Path;
use crate::registry::Described;
use crate::spins::Spins;
use schemars::JsonSchema;
use serde::Deserialize;

/// What has moved is the same but for so much of its scalar products, in the mean.
const ALIKE: f64 = 0.2;
/// Sites of each state that are compared.
const COMPARED: usize = 32;

/// `{"translation": {}}`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Translation {}

impl Described for Translation {
    const NAME: &'static str = "translation";
    const SUMMARY: &'static str = "what is in one place in the initial state is carried to its place in the final one: a skyrmion moves along a track";
    const EXAMPLE: &'static str = r#"{"translation": {}}"#;
}

impl FirstGuess for Translation {
    fn path(&self, a: &Spins, b: &Spins, images: usize, context: &GuessContext) -> Result<Path> {
        let lattice = context.states.lattice;
        let Some((shift, rest)) = moved(a, b, lattice) else {
            let message = "nothing that has its end all round is in one place in the initial state and in another in the final one";
            return Err(Error::invalid("", message));
        };
        let way = along(lattice, shift);
        Ok(Carried::new(a, &rest, lattice).path([a, b], images, |gone| vector::scale(gone, way)))
    }
}

/// From a cell to another one, in spacings.
fn along(lattice: &Lattice, shift: Shift) -> Vector {
    let cells = lattice.cell_vectors();
    (0..3).fold([0.0; 3], |sum, d| vector::add(sum, vector::scale(shift[d] as f64, cells[d])))
}

/// By what a spot of a state has moved in the other one, and what lies under it; nothing if they are no such two states.
pub(super) fn moved(a: &Spins, b: &Spins, lattice: &Lattice) -> Option<(Shift, Spins)> {
    let rest = around(a, b, &lattice.is_frozen(), lattice)?;
    let spot =
        |m: &Spins| -> Vec<usize> { (0..m.sites()).filter(|i| angle(m.get(*i), rest.get(*i)) > DIFFERS).collect() };
    let spots = [spot(a), spot(b)];
    if spots.iter().any(Vec::is_empty) || !Difference::between(a, &rest, lattice).is_spot() {
        return None;
    }
    Some((best_shift([a, b], &spots, lattice)?, rest))
}

/// The shift after which what is in the spots is most alike, of equally good ones the shortest.
fn best_shift([a, b]: [&Spins; 2], spots: &[Vec<usize>; 2], lattice: &Lattice) -> Option<Shift> {
    let compared = spots.each_ref().map(|spot| spot.iter().copied().step_by(spot.len().div_ceil(COMPARED)));
    let pairs = |shift: Shift| {
        let [of_a, of_b] = compared.clone();
        let back = shift.map(|n| -n);
        let to_b = of_a.map(move |i| (Some(i), lattice.shifted(i, shift)));
        to_b.chain(of_b.map(move |i| (lattice.shifted(i, back), Some(i))))
    };
    // what goes outside is as unlike as can be
    let unlike =
        |(i, j): (Option<usize>, Option<usize>)| 1.0 - i.zip(j).map_or(-1.0, |(i, j)| vector::dot(a.get(i), b.get(j)));
    let most = ALIKE * pairs([0; 3]).count() as f64;
    let mut best: Option<(f64, f64, Shift)> = None;
    for shift in shifts(lattice) {
        let limit = best.map_or(most, |(least, ..)| least + 1e-9);
        let mut apart = 0.0;
        if pairs(shift).any(|pair| {
            apart += unlike(pair);
            apart > limit
        }) {
            continue;
        }
        let far = vector::norm(along(lattice, shift));
        let is_better = match best {
            None => true,
            Some((least, nearest, _)) => apart < least - 1e-9 || apart < least + 1e-9 && far < nearest - 1e-9,
        };
        if is_better {
            best = Some((apart, far, shift));
        }
    }
    best.map(|(.., shift)| shift)
}

/// All shifts of the lattice, over periodic borders the shorter way.
fn shifts(lattice: &Lattice) -> impl Iterator<Item = Shift> {
    let range = |d: usize| {
        let (size, periodic) = (lattice.grid.size[d] as isize, lattice.grid.periodic[d]);
        if periodic { -((size - 1) / 2)..size / 2 + 1 } else { 1 - size..size }
    };
    let [x, y, z] = [0, 1, 2].map(range);
    let rows = z.flat_map(move |z| y.clone().map(move |y| [y, z]));
    rows.flat_map(move |[y, z]| x.clone().map(move |x| [x, y, z]))
}

/// The state where two are the same; the rest filled in from there, layer by layer, each site with the mean of the like sites two cells
/// away that are known, so that staggered states stay staggered.
fn around(a: &Spins, b: &Spins, frozen: &[bool], lattice: &Lattice) -> Option<Spins> {
    let apart = |i: usize| !frozen[i] && vector::norm(vector::sub(a.get(i), b.get(i))) > SEEN;
    let mut known: Vec<Option<Vector>> = (0..a.sites()).map(|i| (!apart(i)).then(|| a.get(i))).collect();
    let mut open: Vec<usize> = (0..a.sites()).filter(|i| known[*i].is_none()).collect();
    while !open.is_empty() {
        let layer: Vec<(usize, Vector)> =
            open.iter().filter_map(|i| Some((*i, between(*i, &known, lattice)?))).collect();
        if layer.is_empty() {
            return None;
        }
        layer.into_iter().for_each(|(i, v)| known[i] = Some(v));
        open.retain(|i| known[*i].is_none());
    }
    let rest: Vec<Vector> = known.into_iter().flatten().collect();
    Spins::from_vectors(&rest).ok()
}

/// The mean of what is known two cells away.
fn between(i: usize, known: &[Option<Vector>], lattice: &Lattice) -> Option<Vector> {
    let steps = (0..3).flat_map(|d| [(d, -2), (d, 2)]);
    let there = steps.filter_map(|(d, by)| known[lattice.step_from(i, d, by).filter(|j| *j != i)?]);
    let sum = there.fold([0.0; 3], vector::add);
    (vector::norm(sum) > SEEN).then(|| vector::unit_or(sum, sum))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::test_terms::lattice;
    use crate::geometry::Direction;
    use crate::state::StateContext;

    fn context(lattice: &Lattice) -> GuessContext<'_> {
        GuessContext { states: StateContext::new(lattice, 1.4), default_axis: Direction::Y }
    }

    /// Up, or staggered up, and a round spot of a skyrmion's kind about a place.
    fn spot(lattice: &Lattice, center: Vector, staggered: bool) -> Spins {
        let periods = lattice.periods();
        let spin = |i: usize| {
            let way = periods.shortest(vector::sub(lattice.place(i), center));
            let r = vector::norm(way);
            let theta = 2.0 * libm::atan2(libm::exp(3.0 - r), 1.0);
            let out = if r > 0.0 { vector::scale(libm::sin(theta) / r, way) } else { [0.0; 3] };
            let sign = if staggered && lattice.is_odd(i) { -1.0 } else { 1.0 };
            vector::scale(sign, [out[0], out[1], libm::cos(theta)])
        };
        Spins::from_vectors(&(0..lattice.sites).map(spin).collect::<Vec<_>>()).unwrap()
    }

    #[test]
    fn a_spot_is_carried_the_shortest_way_to_where_it_is_in_the_other_state() {
        let cases = [
            (r#"{"square": {"cells": [40, 24]}}"#, [[10, 12], [30, 12]], [20, 0], false),
            (r#"{"square": {"cells": [40, 24]}}"#, [[12, 12], [18, 14]], [6, 2], false),
            (r#"{"square": {"cells": [40, 24], "periodic": true}}"#, [[4, 12], [34, 12]], [-10, 0], false),
            (r#"{"triangular": {"cells": [32, 32], "periodic": true}}"#, [[8, 8], [20, 18]], [12, 10], false),
            (r#"{"square": {"cells": [40, 24]}}"#, [[10, 12], [30, 12]], [20, 0], true),
        ];
        for (text, at, shift, staggered) in cases {
            let lattice = lattice(text);
            let place = |[x, y]: [usize; 2]| lattice.place(x + y * lattice.grid.size[0]);
            let [a, b] = at.map(|cell| spot(&lattice, place(cell), staggered));
            let (found, rest) = moved(&a, &b, &lattice).unwrap();
            assert_eq!(found, [shift[0], shift[1], 0], "{text}");
            let free = spot(&lattice, [1e3, 1e3, 0.0], staggered);
            let off = (0..lattice.sites).map(|i| vector::norm(vector::sub(rest.get(i), free.get(i))));
            assert!(lattice.grid.periodic[0] || off.fold(0.0, f64::max) < 0.1, "{text}");
            let path = Translation {}.path(&a, &b, 9, &context(&lattice)).unwrap();
            assert!(path.image(0) == a.as_slice() && path.image(8) == b.as_slice());
            // half-way it is half-way
            let [x, y] = at[0];
            let middle = lattice.shifted(x + y * lattice.grid.size[0], found.map(|n| n / 2)).unwrap();
            assert!(vector::dot(path.spins(4).get(middle), free.get(middle)) < -0.5, "{text}");
            // what is carried stays what it is: as many spins point down half-way
            let down = |k: usize| path.spins(k).vectors().iter().filter(|m| m[2] < -0.5).count() as f64;
            assert!(staggered || (down(4) / down(0) - 1.0).abs() < 0.25, "{text}: {} {}", down(4), down(0));
        }
    }

    #[test]
    fn what_has_not_moved_is_not_carried() {
        let lattice = lattice(r#"{"square": {"cells": [30, 20]}}"#);
        let spot = spot(&lattice, lattice.place(15 + 30 * 10), false);
        let [up, down] = [Direction::Z, Direction::Z.reversed()].map(|d| Spins::uniform(lattice.sites, d));
        for (a, b) in [(&spot, &up), (&up, &spot), (&up, &down), (&spot, &spot), (&spot, &down)] {
            assert!(moved(a, b, &lattice).is_none());
        }
        assert!(Translation {}.path(&spot, &up, 9, &context(&lattice)).is_err());
    }
}
