//! What a site colours in a map: its Wigner–Seitz cell, the places that are nearer to it than to any other place of the lattice where a
//! site stands or would stand. Sites that a shape leaves out bound the cells beside them all the same, so that an edge is made of whole
//! cells: squares, rectangles, hexagons.

use crate::geometry::Vector;
use crate::lattice::Lattice;

/// A cell in the plane, around its site.
#[derive(Clone, Debug, PartialEq)]
pub struct SiteCell {
    /// From the site to the places around it; the cell ends halfway to each.
    steps: Vec<[f64; 2]>,
    /// Its least and its greatest coordinates, from the site.
    pub low: [f64; 2],
    /// See `low`.
    pub high: [f64; 2],
}

impl SiteCell {
    /// The cells of the atoms of a lattice, in their order.
    pub fn of(lattice: &Lattice) -> Vec<SiteCell> {
        let at = |atom: usize, cell: [isize; 3]| {
            let f = lattice.atoms[atom].at;
            lattice.to([0, 1, 2].map(|d| f[d] + cell[d] as f64))
        };
        let cells = (-2..=2).flat_map(|a| (-2..=2).flat_map(move |b| (-2..=2).map(move |c| [a, b, c])));
        let others: Vec<Vector> =
            cells.flat_map(|cell| (0..lattice.atoms.len()).map(move |atom| at(atom, cell))).collect();
        let around = |own: Vector| others.iter().map(move |p| [0, 1, 2].map(|d| p[d] - own[d]));
        (0..lattice.atoms.len()).map(|atom| SiteCell::between(around(at(atom, [0; 3])))).collect()
    }

    /// Bounded by what is in the same plane. A row alone has cells as high as they are wide.
    fn between(around: impl Iterator<Item = Vector>) -> SiteCell {
        let flat = around.filter(|d| d[2].abs() < 1e-6).map(|d| [d[0], d[1]]);
        let mut steps = bounding(flat.filter(|d| libm::hypot(d[0], d[1]) > 1e-6).collect());
        if steps.is_empty() {
            steps = vec![[1.0, 0.0], [-1.0, 0.0]];
        }
        if corners(&steps).len() < 3 {
            steps.extend(steps.clone().iter().map(|d| [-d[1], d[0]]));
        }
        let corners = corners(&steps);
        let bound = |c: usize, sign: f64| sign * corners.iter().map(|p| sign * p[c]).fold(f64::NEG_INFINITY, f64::max);
        // the others bound nothing
        let ends = |d: &[f64; 2]| corners.iter().any(|p| (2.0 * dot(*p, *d) - dot(*d, *d)).abs() < 1e-9 * dot(*d, *d));
        let [low, high] = [-1.0, 1.0].map(|sign| [bound(0, sign), bound(1, sign)]);
        SiteCell { steps: steps.into_iter().filter(|d| ends(d)).collect(), low, high }
    }

    /// Whether a place is in it, from the site.
    pub fn holds(&self, place: [f64; 2]) -> bool {
        is_inside(&self.steps, place)
    }
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn is_inside(steps: &[[f64; 2]], place: [f64; 2]) -> bool {
    steps.iter().all(|d| 2.0 * dot(place, *d) <= dot(*d, *d) * (1.0 + 1e-9))
}

/// Those steps, in their order, to which the line halfway touches the cell: few, however many there are.
fn bounding(steps: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let furthest = steps.iter().map(|d| dot(*d, *d).sqrt()).fold(0.0, f64::max);
    let cell = steps.iter().fold(Polygon::square(1e3 * furthest), |cell, d| cell.cut(*d));
    steps.into_iter().filter(|d| cell.reaches(*d, 1.0 - TOUCHES)).collect()
}

/// So near its line halfway, as a part of its length, a step still touches a cell.
const TOUCHES: f64 = 1e-6;

/// What is left of a cell by the lines halfway to some places.
struct Polygon {
    /// In their order round.
    corners: Vec<[f64; 2]>,
    /// Twice the distance of the furthest corner, squared: a place beyond cuts nothing off.
    reach: f64,
}

impl Polygon {
    fn of(corners: Vec<[f64; 2]>) -> Polygon {
        let reach = corners.iter().map(|p| 4.0 * dot(*p, *p)).fold(0.0, f64::max);
        Polygon { corners, reach }
    }

    fn square(half: f64) -> Polygon {
        Polygon::of(vec![[half, half], [-half, half], [-half, -half], [half, -half]])
    }

    /// Whether it reaches so much of the way to the line halfway to a place.
    fn reaches(&self, d: [f64; 2], part: f64) -> bool {
        let square = dot(d, d);
        square * part * part <= self.reach && self.corners.iter().any(|p| 2.0 * dot(*p, d) > part * square)
    }

    /// Without what is nearer to a place than to the site.
    fn cut(self, d: [f64; 2]) -> Polygon {
        if !self.reaches(d, 1.0) {
            return self;
        }
        let beyond = |p: [f64; 2]| 2.0 * dot(p, d) - dot(d, d);
        let next = self.corners.iter().cycle().skip(1);
        let edges = self.corners.iter().zip(next).map(|(p, q)| (*p, *q, beyond(*p), beyond(*q)));
        let kept = edges.flat_map(|(p, q, from, to)| {
            let crossing = || [0, 1].map(|c| (p[c] * to - q[c] * from) / (to - from));
            let crosses = (from > 0.0) != (to > 0.0);
            [(from <= 0.0).then_some(p), crosses.then(crossing)]
        });
        Polygon::of(kept.flatten().collect())
    }
}

/// Where lines halfway to two places cross, and none is nearer.
fn corners(steps: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let crossing = |a: [f64; 2], b: [f64; 2]| {
        let (across, a2, b2) = (a[0] * b[1] - a[1] * b[0], 0.5 * dot(a, a), 0.5 * dot(b, b));
        let place = [(a2 * b[1] - b2 * a[1]) / across, (b2 * a[0] - a2 * b[0]) / across];
        (across.abs() > 1e-9 * (a2 + b2)).then_some(place)
    };
    let pairs = steps.iter().enumerate().flat_map(|(k, a)| steps[k + 1..].iter().map(move |b| (*a, *b)));
    pairs.filter_map(|(a, b)| crossing(a, b)).filter(|p| is_inside(steps, *p)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::LatticeSpec;

    fn cells(lattice: &str) -> Vec<SiteCell> {
        SiteCell::of(&serde_json::from_str::<LatticeSpec>(lattice).unwrap().resolve().unwrap())
    }

    /// The part of a cell's frame that it fills.
    fn filled(cell: &SiteCell) -> f64 {
        let at = |k: usize, c: usize| cell.low[c] + (k as f64 + 0.5) / 200.0 * (cell.high[c] - cell.low[c]);
        let held = (0..40_000).filter(|k| cell.holds([at(k % 200, 0), at(k / 200, 1)])).count();
        held as f64 / 40_000.0
    }

    fn assert_box(cell: &SiteCell, half: [f64; 2], part: f64) {
        for c in 0..2 {
            assert!((cell.low[c] + half[c]).abs() < 1e-9 && (cell.high[c] - half[c]).abs() < 1e-9, "{cell:?}");
        }
        assert!((filled(cell) - part).abs() < 0.01, "{cell:?}: {}", filled(cell));
    }

    #[test]
    fn cells_are_squares_rectangles_and_hexagons_whatever_a_shape_leaves_of_the_lattice() {
        assert_box(&cells(r#"{"square": {"cells": [9, 9], "shape": {"disc": {"radius": 4}}}}"#)[0], [0.5, 0.5], 1.0);
        let flat = r#"{"grid": {"cells": [4, 4, 1], "cell": ["2 nm", "7 nm", "1 nm"]}}"#;
        assert_box(&cells(flat)[0], [1.0, 3.5], 1.0);
        assert_box(&cells(r#"{"triangular": {"cells": [5, 5]}}"#)[0], [0.5, 1.0 / 3f64.sqrt()], 0.75);
        // layers of a face-centred lattice are squares on their corners
        assert_box(&cells(r#"{"fcc": {"cells": [3, 3, 3]}}"#)[0], [0.5, 0.5], 0.5);
        assert_eq!(cells(r#"{"honeycomb": {"cells": [3, 3]}}"#).len(), 2);
    }

    #[test]
    fn a_row_alone_has_squares_and_so_has_a_site_alone() {
        assert_box(
            &SiteCell::between([[2.0, 0.0, 0.0], [-2.0, 0.0, 0.0], [0.0, 0.0, 1.0]].into_iter()),
            [1.0, 1.0],
            1.0,
        );
        assert_box(&SiteCell::between(std::iter::empty()), [0.5, 0.5], 1.0);
    }

    #[test]
    fn hundreds_of_sites_of_one_cell_are_those_of_a_lattice_at_no_more_cost() {
        let n = 20;
        let part = |k: usize| (k as f64 + 0.5) / n as f64;
        let atoms: Vec<String> =
            (0..n * n).map(|i| format!(r#"{{"at": [{}, {}, 0]}}"#, part(i % n), part(i / n))).collect();
        let vectors = format!("[[{n}, 0, 0], [0, {n}, 0], [0, 0, 1]]");
        let start = std::time::Instant::now();
        let found = cells(&format!(
            r#"{{"crystal": {{"vectors": {vectors}, "basis": [{}], "cells": [1, 1, 1]}}}}"#,
            atoms.join(", ")
        ));
        assert_eq!(found.len(), n * n);
        found.iter().step_by(57).for_each(|cell| assert_box(cell, [0.5, 0.5], 1.0));
        // with all pairs of all sites around it each cell took a second
        assert!(start.elapsed().as_secs() < 20);
    }
}
