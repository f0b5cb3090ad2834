//! Two chains side by side, a lattice for tests alone: what is written for any lattice is compared with a dense computation on it.

use super::{Atom, Grid, Lattice};
use crate::geometry::Direction;

impl Lattice {
    /// A ladder of so many rungs, open or closed, as wide as its rungs are apart.
    pub fn ladder(rungs: usize, closed: bool) -> Lattice {
        let grid = Grid { size: [rungs, 2, 1], periodic: [closed, false, false] };
        let steps = [Direction::X, Direction::Y, Direction::Z].map(|along| (1.0, along));
        Lattice::of_atoms("ladder", grid, steps, vec![Atom { at: [0.0; 3], species: 0 }])
    }
}

#[test]
fn the_shells_of_a_ladder_are_legs_and_rungs_then_diagonals() {
    for (closed, legs) in [(false, 8), (true, 10)] {
        let ladder = Lattice::ladder(5, closed);
        assert_eq!([1, 2, 3].map(|shell| ladder.bonds(shell).len()), [legs + 5, legs, if closed { 10 } else { 6 }]);
        for shell in 1..4 {
            let distance = [1.0, 2.0, 4.0][shell - 1];
            for bond in ladder.bonds(shell).iter().filter(|_| !closed) {
                let [p, q] = bond.sites.map(|i| ladder.position(i));
                let apart: f64 = (0..3).map(|c| (p[c] - q[c]) * (p[c] - q[c])).sum();
                assert_eq!(apart, distance);
            }
        }
    }
}
