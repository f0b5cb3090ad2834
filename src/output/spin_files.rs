//! The spins of a path as files that other programs read: npz, OVF, csv, VTK.

use super::disk::File;
use super::{Format, RunReport, csv};
use crate::error::{Error, Result};
use crate::files::{self, Array, Mesh, OvfData, Segment};
use crate::geometry::Vector;
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

/// `path.pvd` with `vtk/image_000.vtp` …: for ParaView.
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
        for (name, column) in csv::path_columns(run.outcome) {
            if let Some(k) = column.iter().position(|x| !x.is_finite()) {
                let message = format!("path.npz: {name}, image {k}: {} is not a finite number", column[k]);
                return Err(Error::Numerical(message));
            }
            arrays.push((name, Array { shape: vec![column.len()], numbers: column.to_vec() }));
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
        let at = |k: usize| outcome.images.reaction_coordinate_rad.get(k).copied().unwrap_or(0.0);
        let files = (0..outcome.path.images()).map(|k| (at(k), numbered("vtk", k, "vtp")));
        Ok(files::write_pvd(&files.collect::<Vec<_>>()))
    }

    fn companions(&self, run: &RunReport) -> Result<Vec<File>> {
        let path = &run.outcome.path;
        let (positions, unit) = positions(run.lattice);
        let closed = run.lattice.is_ring();
        let image = |k: usize| files::write_vtp(&positions, closed, &path.spins(k).vectors(), unit);
        Ok((0..path.images()).map(|k| File { name: numbered("vtk", k, "vtp"), bytes: image(k) }).collect())
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
    let segments: Vec<Segment> =
        images.iter().map(|(description, spins)| Segment { description, spins: spins.as_slice() }).collect();
    files::write_ovf(data, &mesh(run.lattice), &segments)
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

/// Cells in m, or in sites where the lattice has no length; their centers are where [`positions`] has the sites.
pub(super) fn mesh(lattice: &Lattice) -> Mesh {
    let (step, unit) = match lattice.spacing_nm {
        Some(a) => {
            // OVF knows one size of cells: the largest, where they differ
            let larger = |p: [f64; 2], q: [f64; 2]| [p[0].max(q[0]), p[1].max(q[1])];
            let sections = lattice.sections_nm.iter().flatten().copied();
            let [width, thickness] = sections.reduce(larger).unwrap_or([a; 2]);
            ([a, width, thickness].map(|nm| nm * 1e-9), "m")
        }
        None => ([1.0; 3], "site"),
    };
    Mesh { base: [lattice.first() * step[0], 0.0, 0.0], step, unit }
}

/// Where the sites are, and the unit of that.
pub(super) fn positions(lattice: &Lattice) -> (Vec<Vector>, &'static str) {
    ((0..lattice.sites).map(|i| lattice.position(i)).collect(), lattice.unit())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::Chain;

    fn numbers(text: &str) -> Vec<f64> {
        text.split_whitespace().map(|word| word.parse().unwrap()).collect()
    }

    /// The centers that an OVF file gives its cells, in nm where it is in m, and where each cell begins and ends.
    fn ovf_cells(lattice: &Lattice) -> Vec<[f64; 3]> {
        let spins = vec![[0.0, 0.0, 1.0]; lattice.sites];
        let bytes = files::write_ovf(OvfData::Text, &mesh(lattice), &[Segment { description: "cells", spins: &spins }]);
        let text = String::from_utf8(bytes).unwrap();
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
        let (positions, unit) = positions(lattice);
        let spins = vec![[0.0, 0.0, 1.0]; lattice.sites];
        let text = String::from_utf8(files::write_vtp(&positions, lattice.is_ring(), &spins, unit)).unwrap();
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
}
