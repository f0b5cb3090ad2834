//! Files of spins: what other programs write and what they can read. One file a format; bytes in, bytes out.
//!
//! A reader is tolerant where writers differ and nothing can go wrong (case of keywords, white space, labels, byte order), and
//! strict where the spins would be other ones: lengths, counts, check values, numbers that are not finite, vectors of length zero.
//! It never allocates more than a small multiple of what the file holds, whatever the file says of itself.

mod collector;
mod csv;
pub mod disk;
mod npy;
mod npz;
mod numbers;
mod ovf;
mod placed;
mod stored;
mod vtk;

pub use collector::{Collector, Images};
pub use csv::write_csv;
pub use npy::{Array, write_npy};
pub use npz::{read_npz_columns, write_npz};
pub use ovf::{Mesh, OvfData, Segment, write_ovf};
pub use stored::{LARGEST_FILE, Stored, open, open_file};
pub use vtk::{VtkPoints, write_pvd};

use crate::error::Result;

/// A format that is read.
pub struct FileFormat {
    /// Its name.
    pub name: &'static str,
    /// What it is, in a line.
    pub summary: &'static str,
    /// Endings of its files' names.
    pub extensions: &'static [&'static str],
    /// Whether these are the first bytes of such a file.
    pub recognises: fn(&[u8]) -> bool,
    /// Hands all images of the file to the collector.
    pub read: fn(&[u8], &mut Collector) -> Result<()>,
}

/// All formats that are read; the last one takes whatever no other recognises.
pub const FORMATS: &[FileFormat] = &[ovf::FORMAT, npz::FORMAT, npy::FORMAT, csv::FORMAT];

/// The images in a file's bytes; `file` is the name that messages begin with. The first bytes tell the format, or else the
/// ending of the name.
pub fn read(file: &str, bytes: &[u8]) -> Result<Images> {
    let ending = file.rsplit_once('.').map_or(String::new(), |(_, e)| e.to_ascii_lowercase());
    let by_content = FORMATS.iter().find(|f| (f.recognises)(bytes));
    let by_name = || FORMATS.iter().find(|f| f.extensions.contains(&ending.as_str()));
    let format = by_content.or_else(by_name).unwrap_or(&csv::FORMAT);
    let mut images = Collector::new(file);
    (format.read)(bytes, &mut images)?;
    images.finish()
}
