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

/// Where the nodes of a file are.
#[derive(Clone, Debug, PartialEq)]
pub enum Mesh {
    /// In the middle of the cells of a box, counted with x fastest.
    Cells {
        /// Center of the first cell.
        base: Vector,
        /// Size of a cell.
        step: Vector,
        /// Cells along x, y and z.
        nodes: [usize; 3],
        /// Unit of these lengths.
        unit: &'static str,
    },
    /// Anywhere: an irregular mesh, in whose data the position of each node stands before its vector.
    Points {
        /// One position a node.
        at: Vec<Vector>,
        /// Their unit.
        unit: &'static str,
    },
}

/// A segment of a file.
#[derive(Clone, Copy, Debug)]
pub struct Segment<'a> {
    /// What it is, in a line.
    pub description: &'a str,
    /// One vector a node; zero where there is no spin.
    pub spins: &'a [Vector],
}

/// An OVF 2.0 file of these segments.
pub fn write_ovf(data: OvfData, mesh: &Mesh, segments: &[Segment]) -> Vec<u8> {
    let size: usize = segments.iter().map(|s| 1024 + 48 * s.spins.len()).sum();
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
    let before = [
        ("Begin", "Segment".into()),
        ("Begin", "Header".into()),
        ("Title", "m".into()),
        ("Desc", segment.description.into()),
    ];
    let after = [
        ("valuedim", "3".into()),
        ("valuelabels", "m_x m_y m_z".into()),
        ("valueunits", "1 1 1".into()),
        ("End", "Header".into()),
        ("Begin", data.name().to_string()),
    ];
    for (key, value) in before.into_iter().chain(mesh.header()).chain(after) {
        line(out, &format!("{key}: {value}"));
    }
    match mesh {
        Mesh::Cells { .. } => write_data(out, data, segment.spins.iter().map(|m| &m[..])),
        Mesh::Points { at, .. } => {
            let rows: Vec<[f64; 6]> =
                at.iter().zip(segment.spins).map(|([x, y, z], m)| [*x, *y, *z, m[0], m[1], m[2]]).collect();
            write_data(out, data, rows.iter().map(|row| &row[..]));
        }
    }
    line(out, &format!("End: {}", data.name()));
    line(out, "End: Segment");
}

impl Mesh {
    /// What the header of a segment says of it.
    fn header(&self) -> Vec<(&'static str, String)> {
        let three = |keys: [&'static str; 3], v: Vector| keys.into_iter().zip(v).map(|(k, x)| (k, format!("{x:e}")));
        let (lowest, highest) = (["xmin", "ymin", "zmin"], ["xmax", "ymax", "zmax"]);
        let mut lines = Vec::new();
        match self {
            Mesh::Cells { base, step, nodes, unit } => {
                let low = [0, 1, 2].map(|c| base[c] - 0.5 * step[c]);
                lines.extend([("meshunit", unit.to_string()), ("meshtype", "rectangular".into())]);
                lines.extend(three(["xbase", "ybase", "zbase"], *base));
                lines.extend(three(["xstepsize", "ystepsize", "zstepsize"], *step));
                lines.extend(["xnodes", "ynodes", "znodes"].into_iter().zip(nodes.map(|n| n.to_string())));
                lines.extend(three(lowest, low));
                lines.extend(three(highest, [0, 1, 2].map(|c| low[c] + nodes[c] as f64 * step[c])));
            }
            Mesh::Points { at, unit } => {
                let extreme =
                    |start: f64, of: fn(f64, f64) -> f64| [0, 1, 2].map(|c| at.iter().map(|p| p[c]).fold(start, of));
                lines.extend([("meshunit", unit.to_string()), ("meshtype", "irregular".into())]);
                lines.push(("pointcount", at.len().to_string()));
                lines.extend(three(lowest, extreme(f64::INFINITY, f64::min)));
                lines.extend(three(highest, extreme(f64::NEG_INFINITY, f64::max)));
            }
        }
        lines
    }
}

/// The data, a row of numbers a node.
fn write_data<'a>(out: &mut Vec<u8>, data: OvfData, rows: impl Iterator<Item = &'a [f64]>) {
    match data {
        OvfData::Text => {
            for row in rows {
                for (k, x) in row.iter().enumerate() {
                    // a Vec takes whatever is written to it
                    let _ = write!(out, "{}{x:?}", if k > 0 { " " } else { "" });
                }
                out.push(b'\n');
            }
        }
        OvfData::Binary4 => {
            out.extend_from_slice(&CHECK_4.to_le_bytes());
            rows.flatten().for_each(|x| out.extend_from_slice(&(*x as f32).to_le_bytes()));
            out.push(b'\n');
        }
        OvfData::Binary8 => {
            out.extend_from_slice(&CHECK_8.to_le_bytes());
            rows.flatten().for_each(|x| out.extend_from_slice(&x.to_le_bytes()));
            out.push(b'\n');
        }
    }
}
