//! The spins of a path as files that other programs read: npz, OVF, csv, VTK.

use super::disk::File;
use super::ovf_mesh::OvfMesh;
use super::{Format, RunReport, csv};
use crate::error::{Error, Result};
use crate::files::{self, Array, OvfData, VtkPoints};
use crate::geometry::{Vector, vector};
use crate::lattice::Lattice;

/// `path.npz`: spins (image, site, xyz) and the columns of `path.csv`.
#[derive(Clone, Copy, Debug)]
pub struct PathNpz;

/// `path.ovf` and its like: a segment an image.
#[derive(Clone, Copy, Debug)]
pub struct PathOvf(pub OvfData);

/// `saddle.ovf` and its like: a segment a saddle, in path order.
#[derive(Clone, Copy, Debug)]
pub struct SaddleOvf(pub OvfData);

/// `minima.ovf`: a segment a minimum, in path order, the initial state first and the final one last.
#[derive(Clone, Copy, Debug)]
pub struct MinimaOvf;

/// `ovf/image_000.ovf` …: a file an image.
#[derive(Clone, Copy, Debug)]
pub struct OvfImages;

/// `spins.csv`: a row a site and image.
#[derive(Clone, Copy, Debug)]
pub struct SpinsCsv;

/// `path.pvd` with `vtk/image_000.vtp` … (or `.vtu`): for ParaView.
#[derive(Clone, Copy, Debug)]
pub struct Vtk;

impl Format for PathNpz {
    fn file_name(&self) -> String {
        "path.npz".into()
    }

    fn render(&self, run: &RunReport) -> Result<Vec<u8>> {
        let path = &run.outcome.path;
        let (images, sites) = (path.images(), path.sites());
        let numbers = (0..images).flat_map(|k| path.spins(k).vectors()).flatten().collect();
        let mut arrays = vec![("spins".into(), Array { shape: vec![images, sites, 3], numbers })];
        arrays.extend(places(run.lattice));
        for (name, column) in csv::path_columns(run) {
            if let Some(k) = column.iter().position(|x| !x.is_finite()) {
                let message = format!("path.npz: {name}, image {k}: {} is not a finite number", column[k]);
                return Err(Error::Numerical(message));
            }
            arrays.push((name, Array { shape: vec![column.len()], numbers: column }));
        }
        files::write_npz(&arrays)
    }
}

impl Format for PathOvf {
    fn file_name(&self) -> String {
        format!("path{}.ovf", suffix(self.0))
    }

    fn render(&self, run: &RunReport) -> Result<Vec<u8>> {
        let images = 0..run.outcome.path.images();
        Ok(ovf(self.0, run, images.map(|k| (image_description(run, k), run.outcome.path.spins(k).vectors())).collect()))
    }
}

impl Format for SaddleOvf {
    fn file_name(&self) -> String {
        format!("saddle{}.ovf", suffix(self.0))
    }

    fn applies(&self, run: &RunReport) -> bool {
        !run.outcome.saddles.is_empty()
    }

    fn render(&self, run: &RunReport) -> Result<Vec<u8>> {
        let count = run.outcome.saddles.len();
        let saddles = run.outcome.saddles.iter().enumerate().map(|(k, s)| {
            let (at, energy) = (s.reaction_coordinate_rad, s.above_initial_mev);
            let words = format!("saddle {k} of {count}, reaction coordinate {at:?} rad, {energy:?} meV above initial");
            (words, s.spins.vectors())
        });
        Ok(ovf(self.0, run, saddles.collect()))
    }
}

impl Format for MinimaOvf {
    fn file_name(&self) -> String {
        "minima.ovf".into()
    }

    fn render(&self, run: &RunReport) -> Result<Vec<u8>> {
        let (path, between) = (&run.outcome.path, &run.outcome.intermediate_minima);
        let count = between.len() + 2;
        let named = |k: usize, energy: f64| format!("minimum {k} of {count}, energy {energy:?} meV");
        let mut minima = vec![(named(0, run.outcome.initial.energy_mev), path.spins(0).vectors())];
        minima.extend(between.iter().enumerate().map(|(k, m)| (named(k + 1, m.state.energy_mev), m.spins.vectors())));
        let last = path.spins(path.images() - 1).vectors();
        minima.push((named(count - 1, run.outcome.final_state.energy_mev), last));
        Ok(ovf(OvfData::Binary8, run, minima))
    }
}

impl Format for OvfImages {
    fn file_name(&self) -> String {
        numbered("ovf", 0, "ovf")
    }

    fn folder(&self) -> Option<&'static str> {
        Some("ovf")
    }

    fn render(&self, run: &RunReport) -> Result<Vec<u8>> {
        Ok(single(run, 0))
    }

    fn companions(&self, run: &RunReport) -> Result<Vec<File>> {
        let images = 1..run.outcome.path.images();
        Ok(images.map(|k| File { name: numbered("ovf", k, "ovf"), bytes: single(run, k) }).collect())
    }
}

impl Format for SpinsCsv {
    fn file_name(&self) -> String {
        "spins.csv".into()
    }

    fn render(&self, run: &RunReport) -> Result<Vec<u8>> {
        let path = &run.outcome.path;
        let images: Vec<Vec<Vector>> = (0..path.images()).map(|k| path.spins(k).vectors()).collect();
        Ok(files::write_csv(images.iter().map(Vec::as_slice)))
    }
}

impl Format for Vtk {
    fn file_name(&self) -> String {
        "path.pvd".into()
    }

    fn folder(&self) -> Option<&'static str> {
        Some("vtk")
    }

    fn render(&self, run: &RunReport) -> Result<Vec<u8>> {
        let outcome = run.outcome;
        let ending = vtk_points(run.lattice).ending();
        let at = |k: usize| outcome.images.reaction_coordinate_rad.get(k).copied().unwrap_or(0.0);
        let files = (0..outcome.path.images()).map(|k| (at(k), numbered("vtk", k, ending)));
        Ok(files::write_pvd(&files.collect::<Vec<_>>()))
    }

    fn companions(&self, run: &RunReport) -> Result<Vec<File>> {
        let path = &run.outcome.path;
        let points = vtk_points(run.lattice);
        let image = |k: usize| points.file(&without_idle(run.lattice, path.spins(k).vectors()));
        Ok((0..path.images()).map(|k| File { name: numbered("vtk", k, points.ending()), bytes: image(k) }).collect())
    }
}

fn suffix(data: OvfData) -> &'static str {
    match data {
        OvfData::Text => "_text",
        OvfData::Binary4 => "_binary4",
        OvfData::Binary8 => "",
    }
}

fn numbered(folder: &str, k: usize, ending: &str) -> String {
    format!("{folder}/image_{k:03}.{ending}")
}

fn ovf(data: OvfData, run: &RunReport, images: Vec<(String, Vec<Vector>)>) -> Vec<u8> {
    OvfMesh::of(run.lattice).file(data, images)
}

/// One image as a file of its own: text, which every reader of OVF reads, with all digits.
fn single(run: &RunReport, k: usize) -> Vec<u8> {
    ovf(OvfData::Text, run, vec![(image_description(run, k), run.outcome.path.spins(k).vectors())])
}

fn image_description(run: &RunReport, k: usize) -> String {
    let table = &run.outcome.images;
    let count = run.outcome.path.images();
    match (table.reaction_coordinate_rad.get(k), table.energy_mev.get(k)) {
        (Some(s), Some(e)) => format!("image {k} of {count}, reaction coordinate {s:?} rad, energy {e:?} meV"),
        _ => format!("image {k} of {count}"),
    }
}

/// Where the sites of a film or crystal are, as an array (site, xyz) whose name has the unit: nm, or lattice constants.
pub(super) fn places(lattice: &Lattice) -> Option<(String, Array)> {
    let name = if lattice.spacing_nm.is_some() { "positions_nm" } else { "positions_a" };
    let numbers = || (0..lattice.sites).flat_map(|i| lattice.position(i)).collect();
    (!lattice.is_row()).then(|| (name.into(), Array { shape: vec![lattice.sites, 3], numbers: numbers() }))
}

/// The sites as points: a row joined by a line, a film by the triangles between neighbours, a crystal of one atom a cell by hexahedra.
/// No triangle and no hexahedron leads over a periodic border, from one side of the picture to the other.
pub(super) fn vtk_points(lattice: &Lattice) -> VtkPoints {
    let n = lattice.sites;
    let triangles = lattice.triangles();
    let mut drawn = if triangles.layers == 1 { triangles.corners } else { Vec::new() };
    let periods = lattice.periods();
    let is_near = |i: usize, j: usize| {
        let way = vector::sub(lattice.place(j), lattice.place(i));
        vector::norm(vector::sub(periods.shortest(way), way)) < 0.5
    };
    drawn.retain(|&[a, b, c]| is_near(a, b) && is_near(b, c) && is_near(c, a));
    VtkPoints {
        positions: (0..n).map(|i| lattice.position(i)).collect(),
        unit: lattice.unit(),
        line: if lattice.is_row() && n > 1 { (0..n).chain(lattice.is_ring().then_some(0)).collect() } else { vec![] },
        triangles: drawn,
        hexahedra: lattice.hexahedra(),
    }
}

/// The spins, of films and crystals with a zero vector at every vacant site.
pub(super) fn without_idle(lattice: &Lattice, mut spins: Vec<Vector>) -> Vec<Vector> {
    let idle = |i: &usize| lattice.vacant[*i] && !lattice.is_row();
    (0..lattice.sites).filter(idle).for_each(|i| spins[i] = [0.0; 3]);
    spins
}

#[cfg(test)]
mod tests {
    use super::vtk_points;
    use crate::lattice::LatticeSpec;

    #[test]
    fn no_triangle_of_a_picture_leads_over_a_periodic_border() {
        let triangles = |periodic: bool| {
            let spec = serde_json::json!({"triangular": {"cells": [7, 6], "periodic": periodic}});
            let lattice = serde_json::from_value::<LatticeSpec>(spec).unwrap().resolve().unwrap();
            (lattice.triangles().corners.len(), vtk_points(&lattice).triangles)
        };
        let ((around, drawn), (open, all)) = (triangles(true), triangles(false));
        assert_eq!((around, open), (2 * 7 * 6, 2 * 6 * 5));
        assert_eq!((drawn.len(), all.len()), (open, open));
    }
}
