//! NumPy's arrays: a header that is a Python dictionary, then the numbers.
//!
//! Spins are of shape (site, 3) or (image, site, 3), or those of a mesh, (x, y, z, 3) or (image, x, y, z, 3), as micromagnetic codes
//! have them; a mesh of one row is a chain along any axis.
//! Format: NEP 1, <https://numpy.org/neps/nep-0001-npy-format.html>.

use super::numbers::Stored;
use super::{Collector, FileFormat};
use crate::error::Result;
use crate::lattice::MAX_SITES;
use crate::words::quoted;
use std::io::Read;

pub(super) const FORMAT: FileFormat = FileFormat {
    name: "npy",
    summary: "a NumPy array (site, xyz), (image, site, xyz), or of a mesh (x, y, z, xyz); single or double precision or integers",
    extensions: &["npy"],
    recognises: |bytes| bytes.starts_with(MAGIC),
    read: |bytes, images| {
        let mut rest = bytes;
        let header = Header::read(&mut rest, images, "")?;
        header.images(rest, bytes.len() - rest.len(), images, "")
    },
};

const MAGIC: &[u8] = b"\x93NUMPY";

/// Longest header that is read (bytes); NumPy's own are some hundred.
const LONGEST: usize = 1 << 16;

/// Where the numbers begin is a multiple of this.
const ALIGNMENT: usize = 64;

/// An array to write: the last index runs fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct Array {
    /// Lengths of its axes.
    pub shape: Vec<usize>,
    /// As many numbers as the product of them.
    pub numbers: Vec<f64>,
}

/// An array as the bytes of an npy file, double precision.
pub fn write_npy(array: &Array) -> Vec<u8> {
    let lengths: Vec<String> = array.shape.iter().map(|n| format!("{n},")).collect();
    let shape = lengths.join(" ");
    // a comma after the last length is there for tuples of one only
    let shape = if array.shape.len() == 1 { shape } else { shape.trim_end_matches(',').to_string() };
    let mut header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({shape}), }}");
    let start = MAGIC.len() + 4;
    while !(start + header.len() + 1).is_multiple_of(ALIGNMENT) {
        header.push(' ');
    }
    header.push('\n');
    let mut bytes = Vec::with_capacity(start + header.len() + 8 * array.numbers.len());
    bytes.extend_from_slice(MAGIC);
    bytes.extend_from_slice(&[1, 0]);
    bytes.extend_from_slice(&(header.len() as u16).to_le_bytes());
    bytes.extend_from_slice(header.as_bytes());
    array.numbers.iter().for_each(|x| bytes.extend_from_slice(&x.to_le_bytes()));
    bytes
}

/// What an array's header says.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Header {
    kind: Stored,
    big_endian: bool,
    fortran: bool,
    shape: Vec<usize>,
}

impl Header {
    /// Reads the header and leaves `from` at the numbers; `array` names the array in messages (empty: the whole file).
    pub(super) fn read(from: &mut impl Read, images: &Collector, array: &str) -> Result<Header> {
        let place = format!("{array}header");
        let mut take = |n: usize| -> Result<Vec<u8>> {
            let mut bytes = Vec::new();
            let read = from.take(n as u64).read_to_end(&mut bytes);
            read.map_err(|e| images.error(&place, format!("cannot be read: {e}")))?;
            match bytes.len() == n {
                true => Ok(bytes),
                false => Err(images.error(&place, "the file ends within it: it is cut short")),
            }
        };
        let start = take(8)?;
        if !start.starts_with(MAGIC) {
            return Err(images.error(&place, "this is no NumPy array: it does not begin with \\x93NUMPY"));
        }
        let length = match start[6] {
            1 => take(2)?.iter().rev().fold(0, |n, b| 256 * n + *b as usize),
            2 | 3 => take(4)?.iter().rev().fold(0, |n, b| 256 * n + *b as usize),
            n => return Err(images.error(&place, format!("version {n} of the npy format is not known, but 1 to 3"))),
        };
        if length > LONGEST {
            return Err(images.error(&place, format!("{length} bytes long: the file is damaged")));
        }
        let text = String::from_utf8_lossy(&take(length)?).into_owned();
        Header::parse(&text).map_err(|message| images.error(&place, message))
    }

    fn parse(text: &str) -> std::result::Result<Header, String> {
        let missing = |key: &str| format!("no {key} in {}", quoted(text.trim()));
        let descr = value(text, "descr").ok_or_else(|| missing("descr"))?;
        let quote = descr.chars().next().filter(|c| matches!(c, '\'' | '"'));
        let Some(descr) = quote.and_then(|q| descr[1..].split(q).next()) else {
            return Err("the array has fields of several kinds, not numbers of one".into());
        };
        let (order, kind) = descr.split_at(descr.chars().next().map_or(0, char::len_utf8));
        let kind = match kind {
            "f8" => Stored::F8,
            "f4" => Stored::F4,
            "i1" => Stored::I1,
            "i2" => Stored::I2,
            "i4" => Stored::I4,
            "i8" => Stored::I8,
            _ => {
                let found = quoted(descr);
                return Err(format!("the numbers are of kind {found}: save float64 (\"<f8\"), float32 or integers"));
            }
        };
        let big_endian = match order {
            "<" | "|" | "=" => false,
            ">" => true,
            _ => return Err(format!("the byte order of {} is not known", quoted(descr))),
        };
        let fortran = value(text, "fortran_order").ok_or_else(|| missing("fortran_order"))?;
        let fortran = match fortran.split([',', '}']).next().unwrap_or_default().trim() {
            "True" => true,
            "False" => false,
            v => return Err(format!("fortran_order is True or False, found {}", quoted(v))),
        };
        let tuple = value(text, "shape").and_then(|v| v.strip_prefix('(')?.split_once(')'));
        let lengths = tuple.ok_or_else(|| missing("shape"))?.0;
        let words = lengths.split(',').map(|w| w.trim().trim_end_matches('L')).filter(|w| !w.is_empty());
        let shape: Option<Vec<usize>> = words.map(|w| w.parse().ok()).collect();
        let shape = shape.ok_or_else(|| format!("the shape ({}) is none", quoted(lengths)))?;
        Ok(Header { kind, big_endian, fortran, shape })
    }

    /// Bytes of all numbers; an error where no file can have as many.
    pub(super) fn bytes(&self) -> Option<usize> {
        self.shape.iter().try_fold(self.kind.size(), |n, length| n.checked_mul(*length))
    }

    /// Whether the array has one axis.
    pub(super) fn is_column(&self) -> bool {
        self.shape.len() == 1
    }

    /// The numbers of an array of one axis; nothing where there are more or fewer than it says.
    pub(super) fn column(&self, numbers: &[u8]) -> Option<Vec<f64>> {
        let whole = self.bytes() == Some(numbers.len());
        let value = |bytes: &[u8]| self.kind.value(bytes, self.big_endian);
        whole.then(|| numbers.chunks_exact(self.kind.size()).map(value).collect())
    }

    /// Images and the nodes of a mesh along x, y and z, if spins can have this shape.
    pub(super) fn layout(&self) -> std::result::Result<(usize, [usize; 3]), String> {
        let shown = self.shape.iter().map(usize::to_string).collect::<Vec<_>>().join(", ");
        let wanted = "spins are of shape (site, 3), (image, site, 3) or, on a mesh, (x, y, z, 3)";
        let (images, mesh) = match self.shape[..] {
            [sites, 3] => (1, [sites, 1, 1]),
            [images, sites, 3] => (images, [sites, 1, 1]),
            [x, y, z, 3] => (1, [x, y, z]),
            [images, x, y, z, 3] => (images, [x, y, z]),
            [3, _] => return Err(format!("the shape is ({shown}), but {wanted}: save the transposed array")),
            _ => return Err(format!("the shape is ({shown}), but {wanted}")),
        };
        if images == 0 || mesh.contains(&0) {
            return Err(format!("the shape is ({shown}): there are no spins in it"));
        }
        let nodes = mesh.iter().try_fold(1, |n: usize, length| n.checked_mul(*length));
        match nodes.is_none_or(|n| n > MAX_SITES) {
            true => Err(format!("the shape is ({shown}), but there are at most {MAX_SITES} sites")),
            false => Ok((images, mesh)),
        }
    }

    /// Hands on the images of the array's numbers, which begin at byte `start`.
    pub(super) fn images(&self, numbers: &[u8], start: usize, out: &mut Collector, array: &str) -> Result<()> {
        let (images, [x, y, z]) = self.layout().map_err(|m| out.error(format!("{array}header"), m))?;
        // a row is a chain, whose sites are all there
        let mesh = Some([x, y, z]).filter(|mesh| mesh.iter().filter(|n| **n > 1).count() > 1);
        let (needed, found) = (self.bytes(), numbers.len());
        if needed != Some(found) {
            let needed = needed.map_or("more than there can be".into(), |n| n.to_string());
            let what = format!("the numbers take {needed} bytes, found {found}: the file is cut short or damaged");
            return Err(out.error(format!("{array}byte {start}"), what));
        }
        let size = self.kind.size();
        let number = |at: usize| self.kind.value(&numbers[at * size..(at + 1) * size], self.big_endian);
        for k in 0..images {
            out.begin_on(x * y * z, mesh, mesh.is_some())?;
            // sites are counted along x first
            for (p, q, r) in (0..z).flat_map(|r| (0..y).flat_map(move |q| (0..x).map(move |p| (p, q, r)))) {
                let v = [0, 1, 2].map(|c| match self.fortran {
                    false => number(c + 3 * (r + z * (q + y * (p + x * k)))),
                    true => number(k + images * (p + x * (q + y * (r + z * c)))),
                });
                out.push(v, || format!("{array}image {k}, site {}", p + x * (q + y * r)))?;
            }
        }
        Ok(())
    }
}

/// What follows a key of a Python dictionary.
fn value<'a>(dictionary: &'a str, key: &str) -> Option<&'a str> {
    let after = |quote: char| dictionary.split_once(&format!("{quote}{key}{quote}")).map(|(_, rest)| rest);
    after('\'').or_else(|| after('"'))?.trim_start().strip_prefix(':').map(str::trim_start)
}
