//! Triangles of neighbouring sites in the layers of a lattice, and the topological charge of spins on them.
//!
//! A layer is the sites at one height over the plane of two directions of cells: the first two, or those two that have more than one
//! cell. Without borders its sites are the corners of polygons on circles that hold no site inside (B. Delaunay, Bull. Acad. Sci. URSS,
//! Classe sci. math. nat. 7, 793 (1934)): squares, triangles, hexagons. Each is cut into triangles from the first of its corners, a
//! square along one diagonal, the same in every cell; where corners are missing, what is left of it is.
//!
//! ```text
//! Q = (1/4π) Σ Ω,  tan(Ω/2) = a·(b × c) / (1 + a·b + b·c + c·a)          triangles abc counterclockwise seen against the normal
//! ```
//! B. Berg, M. Lüscher, Nucl. Phys. B 190, 412 (1981), doi:10.1016/0550-3213(81)90568-X: the spherical triangle of the three spins, with
//! its sign. In the continuum (1/4π) ∫ m·(∂ₓm × ∂ᵧm) dx dy: a skyrmion whose core points to −z in a background along +z has −1, its
//! antiskyrmion +1. A turn of all spins leaves it, a reversal of all changes its sign. It is whole where the film has no border or
//! its border is uniform.

use super::Lattice;
use crate::field::Components;
use crate::geometry::{Vector, vector};
use std::f64::consts::PI;

/// Sites of one layer are at one height, and corners of a polygon on one circle, to this part of a cell.
const ALIKE: f64 = 1e-7;

/// Triangles of neighbouring sites.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Triangles {
    /// Their corners, counterclockwise seen against the normal.
    pub corners: Vec<[usize; 3]>,
    /// In how many layers they are.
    pub layers: usize,
}

impl Triangles {
    /// The topological charge of each of some states (3N); nothing in a row, which has none.
    pub fn charges<'m>(&self, states: impl Iterator<Item = &'m [f64]>) -> Option<Vec<f64>> {
        (!self.corners.is_empty()).then(|| states.map(|m| self.charge(Components::new(m))).collect())
    }

    /// The topological charge; of several layers the mean, so that a tube through all has that of each.
    pub fn charge(&self, m: Components) -> f64 {
        let solid = |corners: &[usize; 3]| {
            let [a, b, c] = corners.map(|i| m.get(i));
            let below = 1.0 + vector::dot(a, b) + vector::dot(b, c) + vector::dot(c, a);
            2.0 * libm::atan2(vector::dot(a, vector::cross(b, c)), below)
        };
        self.corners.iter().map(solid).sum::<f64>() / (4.0 * PI * self.layers.max(1) as f64)
    }
}

impl Lattice {
    /// The triangles between the spins of all layers; none in a row.
    pub fn triangles(&self) -> Triangles {
        let mut triangles = Triangles::default();
        if self.is_row() {
            return triangles;
        }
        let plane = Plane::of(self);
        for atoms in plane.atoms_by_height(self) {
            let sheet = Sheet::new(self, &plane, atoms);
            let faces: Vec<Vec<Corner>> = (0..sheet.atoms.len()).flat_map(|p| sheet.faces_of(p)).collect();
            for height in 0..self.grid.size[plane.across] {
                let before = triangles.corners.len();
                faces.iter().for_each(|face| plane.tile(self, face, height, &mut triangles.corners));
                triangles.layers += usize::from(triangles.corners.len() > before);
            }
        }
        triangles
    }
}

/// An atom, and how many cells on along the two directions it is.
type Corner = (usize, [isize; 2]);

/// Two directions of cells, and the third.
struct Plane {
    along: [usize; 2],
    across: usize,
    /// Right-handed with the plane's normal.
    axes: [Vector; 3],
}

impl Plane {
    fn of(lattice: &Lattice) -> Plane {
        let along = match [0, 1, 2].map(|d| lattice.grid.extends(d)) {
            [true, false, true] => [2, 0],
            [false, true, true] => [1, 2],
            _ => [0, 1],
        };
        let [a, b] = along.map(|d| lattice.steps[d].1.vector());
        let normal = vector::unit_or(vector::cross(a, b), [0.0, 0.0, 1.0]);
        Plane { along, across: 3 - along[0] - along[1], axes: [a, vector::cross(normal, a), normal] }
    }

    /// The atoms of a cell that are in one layer, lowest first.
    fn atoms_by_height(&self, lattice: &Lattice) -> Vec<Vec<usize>> {
        let height = |s: usize| vector::dot(lattice.to(lattice.atoms[s].at), self.axes[2]);
        let mut atoms: Vec<usize> = (0..lattice.atoms.len()).collect();
        atoms.sort_by(|p, q| height(*p).total_cmp(&height(*q)));
        let step = lattice.steps[self.along[0]].0;
        let layers = atoms.chunk_by(|p, q| height(*q) - height(*p) <= ALIKE * step);
        layers.map(|layer| layer.to_vec()).collect()
    }

    /// A polygon in every cell of a layer, cut into triangles between the sites that are there.
    fn tile(&self, lattice: &Lattice, face: &[Corner], height: usize, out: &mut Vec<[usize; 3]>) {
        let [a, b] = self.along;
        // where a border is open, the first corner may be beyond it
        let cells = |k: usize| {
            let (size, periodic) = (lattice.grid.size[self.along[k]] as isize, lattice.grid.periodic[self.along[k]]);
            let (low, high) = face.iter().fold((0, 0), |(l, h), (_, by)| (by[k].min(l), by[k].max(h)));
            if periodic { 0..size } else { -high..size - low }
        };
        for second in cells(1) {
            for first in cells(0) {
                let site = |(atom, by): &Corner| {
                    let mut cell = [0; 3];
                    cell[self.across] = height;
                    cell[a] = lattice.grid.step(0, first + by[0], a)?;
                    cell[b] = lattice.grid.step(0, second + by[1], b)?;
                    lattice.site(*atom, cell).filter(|i| !lattice.vacant[*i])
                };
                let there: Vec<usize> = face.iter().filter_map(site).collect();
                out.extend(there.windows(2).skip(1).map(|pair| [there[0], pair[0], pair[1]]));
            }
        }
    }
}

/// One layer without borders, in its plane.
struct Sheet {
    vectors: [[f64; 2]; 2],
    /// The atoms, and where they are in the first cell.
    atoms: Vec<(usize, [f64; 2])>,
    /// Where they are in units of the vectors.
    parts: Vec<[f64; 2]>,
}

fn cross([a, b]: [f64; 2], [c, d]: [f64; 2]) -> f64 {
    a * d - b * c
}

fn dot([a, b]: [f64; 2], [c, d]: [f64; 2]) -> f64 {
    a * c + b * d
}

impl Sheet {
    fn new(lattice: &Lattice, plane: &Plane, atoms: Vec<usize>) -> Sheet {
        let flat = |v: Vector| [vector::dot(v, plane.axes[0]), vector::dot(v, plane.axes[1])];
        let step = |d: usize| flat(vector::scale(lattice.steps[d].0, lattice.steps[d].1.vector()));
        let at = |s: usize| flat(lattice.to(lattice.atoms[s].at));
        let parts = atoms.iter().map(|s| plane.along.map(|d| lattice.atoms[*s].at[d])).collect();
        Sheet { vectors: plane.along.map(step), atoms: atoms.iter().map(|s| (*s, at(*s))).collect(), parts }
    }

    /// The polygons around the p-th atom of which it is the first corner: the least by atom, then by cell.
    fn faces_of(&self, p: usize) -> Vec<Vec<Corner>> {
        let near = self.near(p);
        let own = (self.atoms[p].0, [0, 0]);
        let mut faces = Vec::new();
        let Some(first) = near.first().copied() else { return faces };
        let mut edge = first;
        for _ in 0..near.len() {
            let Some(face) = left_of(edge.1, &near) else { break };
            edge = face[face.len() - 1];
            if face.iter().all(|(corner, _)| *corner > own) {
                faces.push([own].into_iter().chain(face.iter().map(|(corner, _)| *corner)).collect());
            }
            if edge.0 == first.0 {
                break;
            }
        }
        faces
    }

    /// What can share a polygon with the p-th atom, nearest first, and the way there: no empty circle is wider than the diagonal of
    /// the cell of shortest vectors.
    fn near(&self, p: usize) -> Vec<(Corner, [f64; 2])> {
        let [a, b] = self.vectors;
        let widest = self.diagonal() * (1.0 + ALIKE);
        let area = cross(a, b).abs();
        let reach = [dot(b, b).sqrt(), dot(a, a).sqrt()].map(|side| widest * side / area);
        let mut near = Vec::new();
        for (q, (atom, at)) in self.atoms.iter().enumerate() {
            let cells = |k: usize| {
                let apart = self.parts[q][k] - self.parts[p][k];
                (-reach[k] - apart).ceil() as isize..=(reach[k] - apart).floor() as isize
            };
            for n in cells(1) {
                for m in cells(0) {
                    let way = [0, 1].map(|c| at[c] - self.atoms[p].1[c] + m as f64 * a[c] + n as f64 * b[c]);
                    if (q, m, n) != (p, 0, 0) && dot(way, way) <= widest * widest {
                        near.push(((*atom, [m, n]), way));
                    }
                }
            }
        }
        near.sort_by(|(c, p), (d, q)| dot(*p, *p).total_cmp(&dot(*q, *q)).then(c.cmp(d)));
        near
    }

    /// The diagonal of a box of the shortest vectors (Gauss).
    fn diagonal(&self) -> f64 {
        let [mut u, mut v] = self.vectors;
        loop {
            if dot(u, u) > dot(v, v) {
                (u, v) = (v, u);
            }
            let times = (dot(u, v) / dot(u, u)).round();
            let w = [v[0] - times * u[0], v[1] - times * u[1]];
            // of a triangular lattice u and v − u are as long as v, and rounding would lead from one to the other for ever
            if dot(w, w) > dot(v, v) * (1.0 - ALIKE) {
                return (dot(u, u) + dot(v, v)).sqrt();
            }
            v = w;
        }
    }
}

/// The polygon to the left of the way from the origin to q, from q on counterclockwise, without the origin: of the circles through both
/// and another site the one that holds no site on that side, centred at q/2 + t q⊥ with the least t.
fn left_of(q: [f64; 2], near: &[(Corner, [f64; 2])]) -> Option<Vec<(Corner, [f64; 2])>> {
    let side = |r: [f64; 2]| cross(q, r);
    let centre = |r: [f64; 2]| (dot(r, r) - dot(q, r)) / (2.0 * side(r));
    let is_left = |r: [f64; 2]| side(r) > ALIKE * (dot(q, q) * dot(r, r)).sqrt();
    let left = || near.iter().filter(|(_, r)| is_left(*r));
    let least = left().map(|(_, r)| centre(*r)).min_by(f64::total_cmp)?;
    let on_it = left().filter(|(_, r)| centre(*r) <= least + ALIKE);
    let mut face: Vec<_> = on_it.chain(near.iter().filter(|(_, r)| *r == q)).copied().collect();
    let angle = |r: [f64; 2]| libm::atan2(side(r), dot(q, r));
    face.sort_by(|(_, p), (_, r)| angle(*p).total_cmp(&angle(*r)));
    Some(face)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::LatticeSpec;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn the_shortest_vectors_of_a_turned_triangular_lattice_are_found_whichever_way_they_are_rounded() {
        let mut r = ChaCha8Rng::seed_from_u64(7);
        for _ in 0..2000 {
            let (angle, size) = (r.random_range(0.0..6.3), r.random_range(0.5..2.0));
            let [u, v] = [angle, angle + PI / 3.0].map(|a: f64| [size * a.cos(), size * a.sin()]);
            let by = f64::from(r.random_range(-3..4i32));
            let sheet = Sheet { vectors: [u, [v[0] + by * u[0], v[1] + by * u[1]]], atoms: vec![], parts: vec![] };
            assert!((sheet.diagonal() - 2f64.sqrt() * size).abs() < 1e-12 * size);
        }
    }

    fn lattice(text: &str) -> Lattice {
        serde_json::from_str::<LatticeSpec>(text).unwrap().resolve().unwrap()
    }

    /// Area of a triangle against the z axis, where no corner is over a border.
    fn area(lattice: &Lattice, [i, j, k]: [usize; 3]) -> f64 {
        let [p, q, r] = [i, j, k].map(|i| lattice.position(i));
        0.5 * vector::cross(vector::sub(q, p), vector::sub(r, p))[2]
    }

    #[test]
    fn the_triangles_of_an_open_film_cover_it_once_and_are_counterclockwise() {
        let sixty = 0.75f64.sqrt();
        for (text, whole) in [
            (r#"{"square": {"cells": [5, 4]}}"#, 12.0),
            (r#"{"triangular": {"cells": [5, 4]}}"#, 12.0 * sixty),
            (r#"{"square": {"cells": [5, 4], "shape": {"not": {"box": {"from": [0, 0], "to": [0, 0]}}}}}"#, 11.5),
            (r#"{"square": {"cells": [5, 4], "vacant": [6]}}"#, 10.0),
            (r#"{"cubic": {"cells": [4, 4, 3]}}"#, 27.0),
            (r#"{"bcc": {"cells": [4, 4, 2]}}"#, 36.0),
            (r#"{"hcp": {"cells": [4, 4, 2]}}"#, 36.0 * sixty),
        ] {
            let lattice = lattice(text);
            let areas: Vec<f64> = lattice.triangles().corners.iter().map(|t| area(&lattice, *t)).collect();
            assert!(areas.iter().all(|a| *a > 1e-6), "{text}: {areas:?}");
            let sum: f64 = areas.iter().sum();
            assert!((sum - whole).abs() < 1e-9, "{text}: {sum}, not {whole}");
        }
    }

    #[test]
    fn a_film_without_borders_has_two_triangles_a_site_in_every_layer() {
        for (text, layers) in [
            (r#"{"square": {"cells": [5, 4], "periodic": true}}"#, 1),
            (r#"{"triangular": {"cells": [5, 4], "periodic": true}}"#, 1),
            (r#"{"honeycomb": {"cells": [5, 4], "periodic": true}}"#, 1),
            (r#"{"kagome": {"cells": [3, 4], "periodic": true}}"#, 1),
            (r#"{"fcc": {"cells": [3, 3, 2], "periodic": [true, true, false]}}"#, 4),
            (r#"{"hcp": {"cells": [3, 4, 2], "periodic": true}}"#, 4),
            (r#"{"grid": {"cells": [4, 1, 3], "cell": ["2 nm", "3 nm", "9 nm"], "periodic": [true, false, true]}}"#, 1),
            (
                r#"{"crystal": {"vectors": [[1, 0, 0], [7.2, 1, 0], [0, 0, 1]], "basis": [{"at": [0, 0, 0]}, {"at": [3.3, -2.4, 0]}], "cells": [19, 6, 1], "periodic": [true, true, false]}}"#,
                1,
            ),
        ] {
            let lattice = lattice(text);
            let triangles = lattice.triangles();
            assert_eq!((triangles.corners.len(), triangles.layers), (2 * lattice.sites, layers), "{text}");
            let mut edges: Vec<[usize; 2]> =
                triangles.corners.iter().flat_map(|[i, j, k]| [[*i, *j], [*j, *k], [*k, *i]]).collect();
            edges.sort_unstable();
            // every edge is gone along once each way
            assert!(edges.iter().all(|[i, j]| edges.binary_search(&[*j, *i]).is_ok()), "{text}");
        }
    }

    #[test]
    fn a_row_has_no_triangles() {
        assert_eq!(lattice(r#"{"chain": {"sites": 9}}"#).triangles(), Triangles::default());
    }
}
