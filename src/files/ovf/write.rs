//! Spins as OVF 2.0.

use super::data::{CHECK_4, CHECK_8};
use crate::geometry::Vector;
use std::io::Write;

/// How the data of a file are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OvfData {
    /// Numbers in the shortest form that reads back to the same value.
    Text,
    /// Single precision.
    Binary4,
    /// Double precision.
    Binary8,
}

impl OvfData {
    fn name(self) -> &'static str {
        match self {
            OvfData::Text => "Data Text",
            OvfData::Binary4 => "Data Binary 4",
            OvfData::Binary8 => "Data Binary 8",
        }
    }
}

/// A chain as a mesh of N × 1 × 1 cells; x counts along the chain, whichever way it points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mesh {
    /// Center of the first cell.
    pub base: [f64; 3],
    /// Size of a cell.
    pub step: [f64; 3],
    /// Unit of that size.
    pub unit: &'static str,
}

/// A segment of a file.
#[derive(Clone, Copy, Debug)]
pub struct Segment<'a> {
    /// What it is, in a line.
    pub description: &'a str,
    /// One vector a site.
    pub spins: &'a [Vector],
}

/// An OVF 2.0 file of these segments.
pub fn write_ovf(data: OvfData, mesh: &Mesh, segments: &[Segment]) -> Vec<u8> {
    let size: usize = segments.iter().map(|s| 1024 + 24 * s.spins.len()).sum();
    let mut out = Vec::with_capacity(size);
    let mut line = |text: &str| line(&mut out, text);
    line("OOMMF OVF 2.0");
    line(&format!("Segment count: {}", segments.len()));
    for segment in segments {
        write_segment(&mut out, data, mesh, segment);
    }
    out
}

fn line(out: &mut Vec<u8>, text: &str) {
    out.extend_from_slice(b"# ");
    out.extend_from_slice(text.as_bytes());
    out.push(b'\n');
}

fn write_segment(out: &mut Vec<u8>, data: OvfData, mesh: &Mesh, segment: &Segment) {
    let ([x, y, z], n) = (mesh.step, segment.spins.len());
    let low = [0, 1, 2].map(|c| mesh.base[c] - 0.5 * mesh.step[c]);
    let header = [
        ("Begin", "Segment".into()),
        ("Begin", "Header".into()),
        ("Title", "m".into()),
        ("Desc", segment.description.into()),
        ("meshunit", mesh.unit.into()),
        ("meshtype", "rectangular".into()),
        ("xbase", format!("{:e}", mesh.base[0])),
        ("ybase", format!("{:e}", mesh.base[1])),
        ("zbase", format!("{:e}", mesh.base[2])),
        ("xstepsize", format!("{x:e}")),
        ("ystepsize", format!("{y:e}")),
        ("zstepsize", format!("{z:e}")),
        ("xnodes", n.to_string()),
        ("ynodes", "1".into()),
        ("znodes", "1".into()),
        ("xmin", format!("{:e}", low[0])),
        ("ymin", format!("{:e}", low[1])),
        ("zmin", format!("{:e}", low[2])),
        ("xmax", format!("{:e}", low[0] + n as f64 * x)),
        ("ymax", format!("{:e}", low[1] + y)),
        ("zmax", format!("{:e}", low[2] + z)),
        ("valuedim", "3".into()),
        ("valuelabels", "m_x m_y m_z".into()),
        ("valueunits", "1 1 1".into()),
        ("End", "Header".into()),
        ("Begin", data.name().to_string()),
    ];
    for (key, value) in &header {
        line(out, &format!("{key}: {value}"));
    }
    write_data(out, data, segment.spins);
    line(out, &format!("End: {}", data.name()));
    line(out, "End: Segment");
}

fn write_data(out: &mut Vec<u8>, data: OvfData, spins: &[Vector]) {
    let numbers = spins.iter().flatten();
    match data {
        OvfData::Text => {
            for [x, y, z] in spins {
                // a Vec takes whatever is written to it
                let _ = writeln!(out, "{x:?} {y:?} {z:?}");
            }
        }
        OvfData::Binary4 => {
            out.extend_from_slice(&CHECK_4.to_le_bytes());
            out.extend(numbers.flat_map(|x| (*x as f32).to_le_bytes()));
            out.push(b'\n');
        }
        OvfData::Binary8 => {
            out.extend_from_slice(&CHECK_8.to_le_bytes());
            out.extend(numbers.flat_map(|x| x.to_le_bytes()));
            out.push(b'\n');
        }
    }
}
