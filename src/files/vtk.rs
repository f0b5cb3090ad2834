//! VTK's XML files for ParaView and its like: a `.vtp` of points with vectors for each image, and a `.pvd` that lists them.
//!
//! Text, so that any XML reader can look into them, with all digits. File formats: VTK User's Guide, <https://docs.vtk.org>.

use crate::geometry::Vector;
use std::fmt::Write;

/// Points with a unit vector on each, and lines that join them: an image of a chain. Positions are in units of `unit`.
pub fn write_vtp(positions: &[Vector], closed: bool, spins: &[Vector], unit: &str) -> Vec<u8> {
    let n = positions.len();
    let mut text = String::from("<?xml version=\"1.0\"?>\n");
    let mut put = |line: &str| {
        text.push_str(line);
        text.push('\n');
    };
    put("<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">");
    put(&format!("<!-- positions in {unit} -->"));
    put("<PolyData>");
    let lines = usize::from(n > 1);
    put(&format!(
        "<Piece NumberOfPoints=\"{n}\" NumberOfVerts=\"{n}\" NumberOfLines=\"{lines}\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">"
    ));
    put("<PointData Vectors=\"m\">");
    put(&vectors("m", spins));
    put("</PointData>");
    put("<Points>");
    put(&vectors("positions", positions));
    put("</Points>");
    put("<Verts>");
    put(&indices("connectivity", 0..n));
    put(&indices("offsets", 1..n + 1));
    put("</Verts>");
    put("<Lines>");
    let ends = if closed && n > 1 { 1 } else { 0 };
    let along = || (0..n).chain(std::iter::repeat_n(0, ends));
    put(&indices("connectivity", along().filter(|_| n > 1)));
    put(&indices("offsets", (0..lines).map(|_| n + ends)));
    put("</Lines>");
    put("</Piece>\n</PolyData>\n</VTKFile>");
    text.into_bytes()
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
