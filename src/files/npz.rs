//! NumPy's archives: a zip file with an npy file for each array, stored or deflated.

use super::npy::{Array, Header, write_npy};
use super::{Collector, FileFormat};
use crate::error::{Error, Result};
use crate::words::quoted;
use std::io::{Cursor, Read, Write};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, System, ZipArchive, ZipWriter};

pub(super) const FORMAT: FileFormat = FileFormat {
    name: "npz",
    summary: "a NumPy archive: its array \"spins\" (or \"m\", or the only one), as in npy",
    extensions: &["npz"],
    recognises: |bytes| bytes.starts_with(b"PK\x03\x04"),
    read,
};

/// Names under which spins are looked for first.
const NAMES: &[&str] = &["spins", "m"];

/// Deflated data are at most this much smaller than what they stand for.
const TIGHTEST: u64 = 1040;

/// Arrays, each under its name, as the bytes of an npz file; the same arrays give the same bytes.
pub fn write_npz(arrays: &[(String, Array)]) -> Result<Vec<u8>> {
    let wrong = |e: &dyn std::fmt::Display| Error::Numerical(format!("the npz file cannot be made: {e}"));
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, array) in arrays {
        let bytes = write_npy(array);
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Stored)
            .system(System::Unix)
            .unix_permissions(0o644)
            .large_file(bytes.len() > u32::MAX as usize / 2);
        archive.start_file(format!("{name}.npy"), options).map_err(|e| wrong(&e))?;
        archive.write_all(&bytes).map_err(|e| wrong(&e))?;
    }
    archive.finish().map(Cursor::into_inner).map_err(|e| wrong(&e))
}

/// The arrays of one axis in an npz file, in its order: the columns of a table.
pub fn read_npz_columns(file: &str, bytes: &[u8]) -> Result<Vec<(String, Vec<f64>)>> {
    let about = Collector::new(file);
    let mut archive = opened(bytes, &about)?;
    let mut columns = Vec::new();
    for index in 0..archive.len() {
        let mut entry = archive.by_index(index).map_err(|e| about.wrong(format!("entry {index}: {e}")))?;
        let name = entry.name().map(|n| n.into_owned()).unwrap_or_default();
        let Some(name) = name.strip_suffix(".npy") else { continue };
        let array = format!("array {}: ", quoted(name));
        let header = Header::read(&mut entry, &about, &array)?;
        if !header.is_column() {
            continue;
        }
        let mut unpacked = Vec::new();
        let wanted = header.bytes().filter(|n| *n as u64 <= entry.size()).unwrap_or(0) as u64;
        let read = entry.by_ref().take(wanted + 1).read_to_end(&mut unpacked);
        read.map_err(|e| about.wrong(format!("{array}cannot be unpacked: {e}")))?;
        let numbers = header.column(&unpacked);
        columns.push((name.to_string(), numbers.ok_or_else(|| about.wrong(format!("{array}the file is damaged")))?));
    }
    Ok(columns)
}

fn opened<'a>(bytes: &'a [u8], images: &Collector) -> Result<Archive<'a>> {
    ZipArchive::new(Cursor::new(bytes))
        .map_err(|e| images.wrong(format!("the archive cannot be opened: {e}; is it cut short?")))
}

type Archive<'a> = ZipArchive<Cursor<&'a [u8]>>;

fn read(bytes: &[u8], images: &mut Collector) -> Result<()> {
    let mut archive = opened(bytes, images)?;
    let (index, name) = chosen(&mut archive, images)?;
    let array = format!("array {}: ", quoted(&name));
    let packed = |e: &dyn std::fmt::Display| images.wrong(format!("{array}cannot be unpacked: {e}"));
    let mut entry = archive.by_index(index).map_err(|e| packed(&e))?;
    let (declared, compressed) = (entry.size(), entry.compressed_size());
    let header = Header::read(&mut entry, images, &array)?;
    header.layout().map_err(|m| images.error(format!("{array}header"), m))?;
    let numbers = header.bytes().map(|n| n as u64).filter(|n| *n <= declared && declared / TIGHTEST <= compressed);
    let Some(numbers) = numbers else {
        let message = format!("its shape does not fit its {declared} bytes: the file is damaged");
        return Err(images.error(format!("{array}header"), message));
    };
    let mut unpacked = Vec::new();
    // one byte more than there may be, so that the end is reached and the checksum compared
    entry.by_ref().take(numbers + 1).read_to_end(&mut unpacked).map_err(|e| packed(&e))?;
    drop(entry);
    header.images(&unpacked, (declared - numbers) as usize, images, &array)
}

/// The array with the spins: by its name, or the only one that can be spins.
fn chosen(archive: &mut Archive, images: &Collector) -> Result<(usize, String)> {
    let mut names = Vec::new();
    for index in 0..archive.len() {
        let entry = archive.by_index_raw(index).map_err(|e| images.wrong(format!("entry {index}: {e}")))?;
        let name = entry.name().map(|n| n.into_owned()).unwrap_or_default();
        names.extend(name.strip_suffix(".npy").map(|n| (index, n.to_string())));
    }
    for wanted in NAMES {
        if let Some(found) = names.iter().find(|(_, name)| name == wanted) {
            return Ok(found.clone());
        }
    }
    let mut can_be = |index: usize| {
        let Ok(mut entry) = archive.by_index(index) else { return false };
        Header::read(&mut entry, images, "").is_ok_and(|h| h.layout().is_ok())
    };
    let listed: Vec<String> = names.iter().take(10).map(|(_, n)| quoted(n)).collect();
    names.retain(|(index, _)| can_be(*index));
    match &names[..] {
        [only] => Ok(only.clone()),
        _ => Err(images.wrong(format!(
            "the archive has the arrays {}: name the one of the spins (image, site, xyz) \"spins\"",
            if listed.is_empty() { "none".into() } else { listed.join(", ") }
        ))),
    }
}
