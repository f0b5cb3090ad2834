//! OVF 2.0, the vector field format of OOMMF: segments, each with a header of `# key: value` lines and text or binary data.
//!
//! Format: M. J. Donahue, D. G. Porter, OOMMF User's Guide 2.0, Vector Field File Format (OVF),
//! <https://math.nist.gov/oommf/doc/userguide20a3/userguide/Vector_Field_File_Format_OV.html>. Binary data are little-endian behind
//! a check value, 1234567.0 or 123456789012345.0. mumax, OOMMF, ubermag (discretisedfield) and Spirit (libovf) write and read it.

mod data;
mod header;
mod lines;
mod write;

pub use write::{Mesh, OvfData, Segment, write_ovf};

use super::{Collector, FileFormat};
use crate::error::Result;
use crate::words::quoted;
use header::Header;
use lines::{Lines, squeezed};

pub(super) const FORMAT: FileFormat = FileFormat {
    name: "ovf",
    summary: "OVF 2.0 of any number of segments, text, binary 4 or binary 8",
    extensions: &["ovf", "omf", "ohf", "obf", "oef"],
    recognises: |bytes| {
        let head = String::from_utf8_lossy(&bytes[..bytes.len().min(64)]).to_lowercase();
        let head = head.trim_start_matches('\u{feff}').trim_start();
        head.strip_prefix('#').is_some_and(|rest| rest.trim_start_matches([' ', '\t', '#']).starts_with("oommf"))
    },
    read,
};

fn read(bytes: &[u8], images: &mut Collector) -> Result<()> {
    let mut lines = Lines::new(bytes);
    first_line(&mut lines, images)?;
    let mut promised: Option<usize> = None;
    while let Some(line) = lines.next() {
        let Some((key, value)) = line.entry() else {
            if line.text.trim_start().starts_with('#') || line.is_blank() {
                continue;
            }
            let message = format!("found {}, expected \"# Begin: Segment\"", quoted(line.text.trim()));
            return Err(images.error(line.place(), message));
        };
        match key.as_str() {
            "segmentcount" => {
                let count = value.parse().map_err(|_| {
                    images.error(line.place(), format!("the segment count is {}, no whole number", quoted(&value)))
                })?;
                promised = Some(count);
            }
            "begin" if squeezed(&value) == "segment" => segment(&mut lines, images)?,
            "begin" | "end" => {
                let message = format!("found {}, expected \"# Begin: Segment\"", quoted(line.text.trim()));
                return Err(images.error(line.place(), message));
            }
            _ => {}
        }
    }
    match promised {
        Some(count) if count != images.count() => {
            let found = images.count();
            Err(images
                .error(lines.place(), format!("the file ends after {found} of its {count} segments: it is cut short")))
        }
        _ => Ok(()),
    }
}

fn first_line(lines: &mut Lines, images: &Collector) -> Result<()> {
    let Some(line) = lines.next() else { return Err(images.wrong("the file is empty")) };
    let found = squeezed(line.text.trim_start_matches('\u{feff}').trim_start().trim_start_matches('#'));
    match found.replace(':', "").as_str() {
        "oommfovf2.0" => Ok(()),
        old if old.ends_with("v1.0") || old.ends_with("v0.0a0") || old.starts_with("oommfovf1") => Err(images.error(
            line.place(),
            "this is OVF 1.0, which is not read: write OVF 2.0 (mumax: OutputFormat = OVF2_BINARY; OOMMF: avf2ovf)",
        )),
        _ => {
            let found = quoted(line.text.trim());
            Err(images.error(line.place(), format!("found {found}, but an OVF file begins with \"# OOMMF OVF 2.0\"")))
        }
    }
}

/// One segment behind its "Begin: Segment".
fn segment(lines: &mut Lines, images: &mut Collector) -> Result<()> {
    let number = images.count();
    let mut header: Option<Header> = None;
    let mut with_data = false;
    while let Some(line) = lines.next() {
        if line.is_blank() {
            continue;
        }
        let wrong = |wanted: &str| {
            let found = quoted(line.text.trim());
            Err(images.error(line.place(), format!("segment {number}: found {found}, expected \"{wanted}\"")))
        };
        let wanted = match (&header, with_data) {
            (None, _) => "# Begin: Header",
            (Some(_), false) => "# Begin: Data Text\" or \"# Begin: Data Binary 8",
            (Some(_), true) => "# End: Segment",
        };
        let Some((key, value)) = line.entry() else { return wrong(wanted) };
        match (key.as_str(), squeezed(&value).as_str(), &header) {
            ("begin", "header", None) => header = Some(Header::read(lines, images, number)?),
            ("begin", kind, Some(h)) if kind.starts_with("data") && !with_data => {
                data::read(kind, h, lines, images, number, &line)?;
                with_data = true;
            }
            ("end", "segment", Some(_)) if with_data => return Ok(()),
            ("begin" | "end", ..) => return wrong(wanted),
            _ => {}
        }
    }
    Err(images.error(lines.place(), format!("segment {number}: the file ends within it: it is cut short")))
}
