//! VTK's XML files for ParaView and its like: a `.vtp` of points with vectors and cells for each image, and a `.pvd` that lists them.
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
}

impl VtkPoints {
    /// An image: the points with a unit vector on each.
    pub fn file(&self, spins: &[Vector]) -> Vec<u8> {
        let VtkPoints { positions, unit, line, triangles } = self;
        let (n, lines, polys) = (positions.len(), usize::from(!line.is_empty()), triangles.len());
        let mut text = String::from("<?xml version=\"1.0\"?>\n");
        let mut put = |line: &str| {
            text.push_str(line);
            text.push('\n');
        };
        put("<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">");
        put(&format!("<!-- positions in {unit} -->"));
        put("<PolyData>");
        put(&format!(
            "<Piece NumberOfPoints=\"{n}\" NumberOfVerts=\"{n}\" NumberOfLines=\"{lines}\" NumberOfStrips=\"0\" NumberOfPolys=\"{polys}\">"
        ));
        put("<PointData Vectors=\"m\">");
        put(&vectors("m", spins));
        put("</PointData>");
        put("<Points>");
        put(&vectors("positions", positions));
        put("</Points>");
        let cells: [(&str, Vec<usize>, Vec<usize>); 3] = [
            ("Verts", (0..n).collect(), (1..n + 1).collect()),
            ("Lines", line.clone(), (0..lines).map(|_| line.len()).collect()),
            ("Polys", triangles.iter().flatten().copied().collect(), (1..polys + 1).map(|k| 3 * k).collect()),
        ];
        for (name, corners, ends) in cells.iter().filter(|(name, corners, _)| *name != "Polys" || !corners.is_empty()) {
            put(&format!("<{name}>"));
            put(&indices("connectivity", corners.iter().copied()));
            put(&indices("offsets", ends.iter().copied()));
            put(&format!("</{name}>"));
        }
        put("</Piece>\n</PolyData>\n</VTKFile>");
        text.into_bytes()
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

fn indices(name: &str, indices: impl Iterator<Item = usize>) -> String {
    let mut text = format!("<DataArray type=\"Int64\" Name=\"{name}\" format=\"ascii\">\n");
    for i in indices {
        let _ = write!(text, "{i} ");
    }
    text.push('\n');
    text + "</DataArray>"
}
