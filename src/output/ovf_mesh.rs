//! Spins of a lattice as OVF: the box of its cells where these stand side by side along x, y and z, else points with their positions.

use crate::files::{self, Mesh, OvfData, Segment};
use crate::geometry::{Direction, Vector, vector};
use crate::lattice::Lattice;

/// Directions this near to x, y and z are along them.
const ALONG: f64 = 1e-9;

/// How the spins of a lattice become those of nodes.
pub(super) struct OvfMesh {
    mesh: Mesh,
    /// Number of nodes.
    nodes: usize,
    /// The node of each site; none where there is no spin.
    node_of: Vec<Option<usize>>,
}

impl OvfMesh {
    /// A row is one of cells, x along it whichever way it points, with its idle spins.
    pub(super) fn of(lattice: &Lattice) -> OvfMesh {
        if lattice.is_row() {
            return OvfMesh {
                mesh: row(lattice),
                nodes: lattice.sites,
                node_of: (0..lattice.sites).map(Some).collect(),
            };
        }
        let there = |i: usize| !lattice.vacant[i];
        let of = |mesh, nodes, node: &dyn Fn(usize) -> usize| OvfMesh {
            mesh,
            nodes,
            node_of: (0..lattice.sites).map(|i| there(i).then(|| node(i))).collect(),
        };
        match cells(lattice) {
            Some(mesh) => of(mesh, lattice.grid.cells(), &|i| lattice.slots.slot(i)),
            None => of(points(lattice), lattice.sites, &|i| i),
        }
    }

    /// A file of these images, each with what it is in a line.
    pub(super) fn file(&self, data: OvfData, images: Vec<(String, Vec<Vector>)>) -> Vec<u8> {
        let placed: Vec<Vec<Vector>> = images.iter().map(|(_, spins)| self.placed(spins)).collect();
        let named = images.iter().map(|(description, _)| description).zip(&placed);
        let segments: Vec<Segment> = named.map(|(description, spins)| Segment { description, spins }).collect();
        files::write_ovf(data, &self.mesh, &segments)
    }

    fn placed(&self, spins: &[Vector]) -> Vec<Vector> {
        let mut nodes = vec![[0.0; 3]; self.nodes];
        for (node, m) in self.node_of.iter().zip(spins) {
            if let Some(node) = node {
                nodes[*node] = *m;
            }
        }
        nodes
    }
}

/// Lengths of a file for one of the lattice, and their unit.
fn unit(lattice: &Lattice) -> (f64, &'static str) {
    match lattice.spacing_nm {
        Some(_) => (1e-9, "m"),
        None if lattice.is_row() => (1.0, "site"),
        None => (1.0, "a"),
    }
}

/// Cells in m, or in sites where the lattice has no length; their centers are the positions of the sites.
fn row(lattice: &Lattice) -> Mesh {
    let step = match lattice.spacing_nm {
        Some(a) => {
            // OVF knows one size of cells: the largest, where they differ
            let larger = |p: [f64; 2], q: [f64; 2]| [p[0].max(q[0]), p[1].max(q[1])];
            let sections = lattice.sections_nm.iter().flatten().copied();
            let [width, thickness] = sections.reduce(larger).unwrap_or([a; 2]);
            [a, width, thickness].map(|nm| nm * 1e-9)
        }
        None => [1.0; 3],
    };
    let base = [lattice.first() * step[0], 0.0, 0.0];
    Mesh::Cells { base, step, nodes: [lattice.sites, 1, 1], unit: unit(lattice).1 }
}

/// One atom a cell, and cells along x, y and z in more than a row; nothing where that is not so.
fn cells(lattice: &Lattice) -> Option<Mesh> {
    let nodes = lattice.grid.size;
    let axes = [Direction::X, Direction::Y, Direction::Z];
    let is_along = |d: usize| vector::dot(lattice.steps[d].1.vector(), axes[d].vector()) > 1.0 - ALONG;
    let rows = nodes.iter().filter(|n| **n > 1).count() > 1;
    if !(rows && lattice.atoms.len() == 1 && (0..3).all(is_along)) {
        return None;
    }
    let (scale, unit) = unit(lattice);
    let step = lattice.steps.map(|(length, _)| scale * length);
    let at = lattice.atoms[0].at;
    Some(Mesh::Cells { base: [0, 1, 2].map(|c| at[c] * step[c]), step, nodes, unit })
}

fn points(lattice: &Lattice) -> Mesh {
    let (scale, unit) = unit(lattice);
    Mesh::Points { at: (0..lattice.sites).map(|i| vector::scale(scale, lattice.position(i))).collect(), unit }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::{Chain, LatticeSpec};
    use crate::output::spin_files::vtk_points;

    fn numbers(text: &str) -> Vec<f64> {
        text.split_whitespace().map(|word| word.parse().unwrap()).collect()
    }

    fn text_of(lattice: &Lattice, spins: Vec<Vector>) -> String {
        String::from_utf8(OvfMesh::of(lattice).file(OvfData::Text, vec![("test".into(), spins)])).unwrap()
    }

    /// The centers that an OVF file gives its cells, in nm where it is in m, and where each cell begins and ends.
    fn ovf_cells(lattice: &Lattice) -> Vec<[f64; 3]> {
        let text = text_of(lattice, vec![[0.0, 0.0, 1.0]; lattice.sites]);
        let value = |key: &str| {
            let line = text.lines().find_map(|l| l.strip_prefix(&format!("# {key}: "))).unwrap();
            line.parse::<f64>().unwrap_or_else(|_| panic!("{key}: {line}"))
        };
        let scale = if text.contains("meshunit: m\n") { 1e9 } else { 1.0 };
        let (base, step, nodes) = (value("xbase"), value("xstepsize"), value("xnodes"));
        assert!((value("xmin") + 0.5 * step - base).abs() < 1e-12 * step);
        assert!((value("xmax") - value("xmin") - nodes * step).abs() < 1e-12 * nodes * step);
        for axis in ["y", "z"] {
            assert_eq!(value(&format!("{axis}base")), 0.0);
            assert_eq!(value(&format!("{axis}min")), -value(&format!("{axis}max")));
        }
        (0..nodes as usize).map(|i| [scale * (base + i as f64 * step), 0.0, 0.0]).collect()
    }

    fn vtp_points(lattice: &Lattice) -> Vec<[f64; 3]> {
        let spins = vec![[0.0, 0.0, 1.0]; lattice.sites];
        let text = String::from_utf8(vtk_points(lattice).file(&spins)).unwrap();
        let (_, from) = text.split_once("<Points>").unwrap();
        let (_, from) = from.split_once("format=\"ascii\">").unwrap();
        let (points, _) = from.split_once("</DataArray>").unwrap();
        numbers(points).chunks(3).map(|p| [p[0], p[1], p[2]]).collect()
    }

    #[test]
    fn vtk_and_ovf_have_every_site_at_the_same_place() {
        let chain = |text: &str| serde_json::from_str::<Chain>(text).unwrap().resolve().unwrap();
        for (text, first, step) in [
            (r#"{"sites": 5}"#, 0.0, 1.0),
            (r#"{"sites": 5, "spacing": "0.25 nm"}"#, 0.0, 0.25),
            (r#"{"sites": 5, "spacing": "2 nm", "cross_section": ["20 nm", "5 nm"]}"#, 1.0, 2.0),
        ] {
            let (cells, points) = (ovf_cells(&chain(text)), vtp_points(&chain(text)));
            assert_eq!((cells.len(), points.len()), (5, 5));
            for (i, (cell, point)) in cells.iter().zip(&points).enumerate() {
                assert!((0..3).all(|c| (cell[c] - point[c]).abs() < 1e-12), "{text}: {cell:?} {point:?}");
                assert!((point[0] - first - step * i as f64).abs() < 1e-12, "{text}: {point:?}");
            }
        }
    }

    fn lattice(text: &str) -> Lattice {
        serde_json::from_str::<LatticeSpec>(text).unwrap().resolve().unwrap()
    }

    /// Different unit vectors.
    fn fan(sites: usize) -> Vec<Vector> {
        (0..sites).map(|i| 0.1 * i as f64).map(|a| [libm::cos(a), libm::sin(a), 0.0]).collect()
    }

    #[test]
    fn a_film_is_a_mesh_of_its_cells_with_nothing_where_there_is_no_spin() {
        for (text, steps) in [
            (r#"{"square": {"cells": [4, 3], "spacing": "0.5 nm", "shape": {"disc": {"radius": 1.3}}}}"#, [0.5; 3]),
            (r#"{"cubic": {"cells": [4, 3, 2], "vacant": [5], "spacing": "0.5 nm"}}"#, [0.5; 3]),
            (
                r#"{"grid": {"cells": [4, 3, 2], "cell": ["2 nm", "3 nm", "0.6 nm"], "vacant": [0, 7]}}"#,
                [2.0, 3.0, 0.6],
            ),
        ] {
            let lattice = lattice(text);
            let spins = fan(lattice.sites);
            let written = text_of(&lattice, spins.clone());
            let value = |key: &str| {
                let line = written.lines().find_map(|l| l.strip_prefix(&format!("# {key}: "))).unwrap();
                line.parse::<f64>().unwrap()
            };
            let data = written.split_once("# Begin: Data Text\n").unwrap().1.split_once("# End").unwrap().0;
            let nodes: Vec<Vec<f64>> = data.lines().map(numbers).collect();
            let size = ["x", "y", "z"].map(|c| value(&format!("{c}nodes")) as usize);
            assert_eq!(nodes.len(), size.iter().product::<usize>(), "{text}");
            let mut there = 0;
            for (k, node) in nodes.iter().enumerate() {
                let cell = [k % size[0], k / size[0] % size[1], k / size[0] / size[1]];
                let at = [0, 1, 2].map(|c| {
                    let axis = ["x", "y", "z"][c];
                    let (base, step) = (value(&format!("{axis}base")), value(&format!("{axis}stepsize")));
                    assert!((1e9 * step - steps[c]).abs() < 1e-12, "{text}: {step}");
                    1e9 * (base + cell[c] as f64 * step)
                });
                let near = |i: &usize| vector::norm(vector::sub(lattice.position(*i), at)) < 1e-9;
                let site = (0..lattice.sites).find(near).filter(|i| !lattice.vacant[*i]);
                there += usize::from(site.is_some());
                assert_eq!(node[..], site.map_or([0.0; 3], |i| spins[i]), "{text}: node {k}");
            }
            assert_eq!(there, lattice.vacant.iter().filter(|vacant| !**vacant).count(), "{text}");
        }
    }

    #[test]
    fn other_lattices_are_irregular_meshes_of_their_positions() {
        for text in [
            r#"{"triangular": {"cells": [4, 3], "spacing": "0.3 nm", "vacant": [2]}}"#,
            r#"{"hcp": {"cells": [3, 2, 2], "spacing": "0.3 nm"}}"#,
        ] {
            let lattice = lattice(text);
            let spins = fan(lattice.sites);
            let written = text_of(&lattice, spins.clone());
            assert!(
                written.contains(&format!("# meshtype: irregular\n# pointcount: {}\n", lattice.sites)),
                "{written}"
            );
            let data = written.split_once("# Begin: Data Text\n").unwrap().1.split_once("# End").unwrap().0;
            for (i, row) in data.lines().map(numbers).enumerate() {
                let at = vector::scale(1e9, [row[0], row[1], row[2]]);
                assert!(vector::norm(vector::sub(at, lattice.position(i))) < 1e-12, "{text}");
                assert_eq!(row[3..], if lattice.vacant[i] { [0.0; 3] } else { spins[i] }, "{text}");
            }
        }
    }

    #[test]
    fn what_is_written_of_any_lattice_is_read_back_on_it_and_refused_on_another() {
        let others = r#"{"square": {"cells": [5, 4]}}"#;
        for text in [
            r#"{"square": {"cells": [4, 3], "shape": {"disc": {"radius": 1.3}}, "vacant": [1]}}"#,
            r#"{"grid": {"cells": [4, 1, 3], "cell": ["2 nm", "3 nm", "0.6 nm"]}}"#,
            r#"{"square": {"cells": [9, 1], "shape": {"not": {"box": {"from": [3], "to": [4]}}}}}"#,
            r#"{"honeycomb": {"cells": [4, 3], "vacant": [0, 9]}}"#,
            r#"{"fcc": {"cells": [2, 2, 2], "spacing": "0.4 nm"}}"#,
        ] {
            let lattice = lattice(text).with_vacancies_frozen(Direction::Y);
            let mut spins = fan(lattice.sites);
            (0..lattice.sites).filter(|i| lattice.vacant[*i]).for_each(|i| spins[i] = [0.0, 1.0, 0.0]);
            for (data, near) in [(OvfData::Text, 0.0), (OvfData::Binary8, 0.0), (OvfData::Binary4, 1e-7)] {
                let bytes = OvfMesh::of(&lattice)
                    .file(data, vec![("a".into(), spins.clone()), ("b".into(), fan(lattice.sites))]);
                let found = files::read("m.ovf", &bytes).unwrap();
                let read = found.placed(&found.images[0], &lattice).unwrap();
                let apart = read.iter().zip(&spins).map(|(a, b)| vector::norm(vector::sub(*a, *b))).fold(0.0, f64::max);
                assert!(apart <= near, "{text} {data:?}: {apart}");
                let said = found.placed(&found.images[0], &self::lattice(others)).unwrap_err().to_string();
                assert!(said.starts_with("has ") && said.contains("but the lattice has "), "{text}: {said}");
            }
        }
        // positions of other sites, or of the same in another order
        let [one, other] = [r#"{"honeycomb": {"cells": [4, 3]}}"#, r#"{"honeycomb": {"cells": [3, 4]}}"#].map(lattice);
        let bytes = OvfMesh::of(&one).file(OvfData::Binary4, vec![("a".into(), fan(one.sites))]);
        let found = files::read("m.ovf", &bytes).unwrap();
        assert!(found.placed(&found.images[0], &one).is_ok());
        let said = found.placed(&found.images[0], &other).unwrap_err().to_string();
        assert!(said.contains("its sites are others"), "{said}");
        // a file of a smaller shape has no spin for some sites
        let [disc, whole] = [r#", "shape": {"disc": {"radius": 1.3}}"#, ""]
            .map(|shape| lattice(&format!(r#"{{"square": {{"cells": [4, 3]{shape}}}}}"#)));
        let bytes = OvfMesh::of(&disc).file(OvfData::Text, vec![("a".into(), fan(disc.sites))]);
        let found = files::read("m.ovf", &bytes).unwrap();
        let said = found.placed(&found.images[0], &whole).unwrap_err().to_string();
        assert!(said.contains("has a zero vector at node 0, where the lattice has the spin of site 0"), "{said}");
    }
}
