//! Paths on which every spin moves along its own great circle, each by its own clock.

use crate::geometry::{Arc, Direction, vector};
use crate::path::Path;
use crate::spins::Spins;

/// Ends whose spins are farther apart than this (rad) turn in the sense of the axis, not in their own plane.
const NEARLY_OPPOSITE: f64 = 3.0;

/// The arc of each spin from a to b. A spin that is nearly reversed goes by the waypoint that a turn about `axis` gives, so that
/// neighbours with slightly different ends turn together.
pub fn arcs(a: &Spins, b: &Spins, axis: Direction) -> Vec<[Arc; 2]> {
    let one = |i: usize| {
        let (p, q) = (a.get(i), b.get(i));
        let direct = Arc::new(p, q, axis);
        if direct.angle() < NEARLY_OPPOSITE {
            let middle = direct.middle();
            return [Arc::new(p, middle, axis), Arc::new(middle, q, axis)];
        }
        // the middle of a turn about the axis between the exactly opposite ends nearest to these
        let line = vector::unit_or(vector::sub(p, q), p);
        let middle = Arc::new(line, line.map(|c| -c), axis).middle();
        [Arc::new(p, middle, axis), Arc::new(middle, q, axis)]
    };
    (0..a.sites()).map(one).collect()
}

/// The path with spin i at fraction `clock(t, i)` of its way, t from 0 to 1 over the images; ends exact.
pub fn clocked(a: &Spins, b: &Spins, images: usize, axis: Direction, clock: impl Fn(f64, usize) -> f64 + Sync) -> Path {
    let arcs = arcs(a, b, axis);
    let last = images - 1;
    Path::build(images, a.sites(), |k, out| {
        if k == 0 || k == last {
            return out.copy_from_slice(if k == 0 { a.as_slice() } else { b.as_slice() });
        }
        let t = k as f64 / last as f64;
        let mut out = crate::field::ComponentsMut::new(out);
        for (i, [first, second]) in arcs.iter().enumerate() {
            let u = clock(t, i);
            out.set(i, if u <= 0.5 { first.at(2.0 * u) } else { second.at(2.0 * u - 1.0) });
        }
    })
}
