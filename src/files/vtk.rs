//! VTK's XML files for ParaView and its like: points with vectors and cells for each image, a `.vtp`, or a `.vtu` where some of the cells
//! are solid, and a `.pvd` that lists them.
//!
//! Text, so that any XML reader can look into them, with all digits. File formats: VTK User's Guide, <https://docs.vtk.org>.

use crate::geometry::Vector;
use std::fmt::Write;

/// Where the spins of all images are, and what joins them.
#[derive(Clone, Debug, PartialEq)]
pub struct VtkPoints {
    /// One position a site, each a vertex.
    pub positions: Vec<Vector>,
    /// Their unit.
    pub unit: &'static str,
    /// Sites joined by a line, in its order; none if empty.
    pub line: Vec<usize>,
    /// Triangles of sites.
    pub triangles: Vec<[usize; 3]>,
    /// Hexahedra of sites, in the order of VTK; with them there is no line and no triangle.
    pub hexahedra: Vec<[usize; 8]>,
}

/// The numbers of VTK for a vertex and a hexahedron.
const VERTEX: usize = 1;
const HEXAHEDRON: usize = 12;

impl VtkPoints {
    /// How the name of a file ends.
    pub fn ending(&self) -> &'static str {
        if self.hexahedra.is_empty() { "vtp" } else { "vtu" }
    }

    /// An image: the points with a unit vector on each.
    pub fn file(&self, spins: &[Vector]) -> Vec<u8> {
        let (kind, counts, cells) = if self.hexahedra.is_empty() { self.surface() } else { self.solid() };
        let lines = [
            "<?xml version=\"1.0\"?>".into(),
            format!("<VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">"),
            format!("<!-- positions in {} -->", self.unit),
            format!("<{kind}>"),
            format!("<Piece NumberOfPoints=\"{}\" {counts}>", self.positions.len()),
            "<PointData Vectors=\"m\">".into(),
            vectors("m", spins),
            "</PointData>\n<Points>".into(),
            vectors("positions", &self.positions),
            "</Points>".into(),
            cells,
            format!("</Piece>\n</{kind}>\n</VTKFile>\n"),
        ];
        lines.join("\n").into_bytes()
    }

    /// Vertices, the line and triangles.
    fn surface(&self) -> (&'static str, String, String) {
        let VtkPoints { positions, line, triangles, .. } = self;
        let (n, lines, polys) = (positions.len(), usize::from(!line.is_empty()), triangles.len());
        let counts =
            format!("NumberOfVerts=\"{n}\" NumberOfLines=\"{lines}\" NumberOfStrips=\"0\" NumberOfPolys=\"{polys}\"");
        let mut groups = vec![
            cells("Verts", 0..n, 1..n + 1, None),
            cells("Lines", line.iter().copied(), (0..lines).map(|_| line.len()), None),
        ];
        if polys > 0 {
            let (corners, ends) = (triangles.iter().flatten().copied(), (1..polys + 1).map(|k| 3 * k));
            groups.push(cells("Polys", corners, ends, None));
        }
        ("PolyData", counts, groups.join("\n"))
    }

    /// Vertices and hexahedra.
    fn solid(&self) -> (&'static str, String, String) {
        let (n, solids) = (self.positions.len(), self.hexahedra.len());
        let corners = (0..n).chain(self.hexahedra.iter().flatten().copied());
        let ends = (1..n + 1).chain((1..solids + 1).map(|k| n + 8 * k));
        let types = [vec![VERTEX; n], vec![HEXAHEDRON; solids]].concat();
        let counts = format!("NumberOfCells=\"{}\"", n + solids);
        ("UnstructuredGrid", counts, cells("Cells", corners, ends, Some(types)))
    }
}

/// The list of a series: files with the value, usually a time, at which each stands.
pub fn write_pvd(files: &[(f64, String)]) -> Vec<u8> {
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n",
    );
    for (at, file) in files {
        // a String takes whatever is written to it
        let _ = writeln!(text, "<DataSet timestep=\"{at:?}\" group=\"\" part=\"0\" file=\"{file}\"/>");
    }
    text.push_str("</Collection>\n</VTKFile>\n");
    text.into_bytes()
}

fn vectors(name: &str, vectors: &[Vector]) -> String {
    let mut text = format!("<DataArray type=\"Float64\" Name=\"{name}\" NumberOfComponents=\"3\" format=\"ascii\">\n");
    for [x, y, z] in vectors {
        let _ = writeln!(text, "{x:?} {y:?} {z:?}");
    }
    text + "</DataArray>"
}

/// Cells by their corners one after the other and where those of each end; with the types of unstructured ones.
fn cells(
    name: &str,
    corners: impl Iterator<Item = usize>,
    ends: impl Iterator<Item = usize>,
    types: Option<Vec<usize>>,
) -> String {
    let types = types.map(|types| indices("types", "UInt8", types.into_iter()));
    let arrays = [indices("connectivity", "Int64", corners), indices("offsets", "Int64", ends)];
    let arrays = arrays.into_iter().chain(types).collect::<Vec<_>>().join("\n");
    format!("<{name}>\n{arrays}\n</{name}>")
}

fn indices(name: &str, kind: &str, indices: impl Iterator<Item = usize>) -> String {
    let mut text = format!("<DataArray type=\"{kind}\" Name=\"{name}\" format=\"ascii\">\n");
    for i in indices {
        let _ = write!(text, "{i} ");
    }
    text.push('\n');
    text + "</DataArray>"
}
