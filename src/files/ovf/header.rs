//! A segment's header: what counts of it is how many spins there are, and in which box.

use super::lines::{Lines, squeezed};
use crate::error::Result;
use crate::files::Collector;
use crate::lattice::MAX_SITES;
use crate::words::quoted;

/// What a header says of the data.
pub(super) struct Header {
    /// Nodes in the segment.
    pub(super) nodes: usize,
    /// Nodes along x, y and z, where that is more than a row.
    pub(super) mesh: Option<[usize; 3]>,
    /// Every vector has its position before it, in files that keep to the letter of the format.
    pub(super) irregular: bool,
}

/// The keys that count, as they are found.
#[derive(Default)]
struct Found {
    nodes: [Option<usize>; 3],
    points: Option<usize>,
    dimension: Option<usize>,
    irregular: Option<bool>,
}

impl Header {
    /// Reads on to the end of the header. Keys that do not matter here may be anything; those that do may appear once only.
    pub(super) fn read(lines: &mut Lines, images: &Collector, segment: usize) -> Result<Header> {
        let mut found = Found::default();
        while let Some(line) = lines.next() {
            if line.is_blank() {
                continue;
            }
            let wrong = |message: String| images.error(line.place(), format!("segment {segment}: {message}"));
            let shown = || quoted(line.text.trim());
            let Some((key, value)) = line.entry() else {
                // descriptions run over several lines now and then
                if line.text.trim_start().starts_with('#') {
                    continue;
                }
                return Err(wrong(format!("found {}, but lines of a header begin with \"#\"", shown())));
            };
            match key.as_str() {
                "end" if squeezed(&value) == "header" => {
                    return Header::of(&found).map_err(wrong);
                }
                "begin" | "end" => return Err(wrong(format!("found {} before \"# End: Header\"", shown()))),
                _ => found.take(&key, &value).map_err(wrong)?,
            }
        }
        Err(images.error(lines.place(), format!("segment {segment}: the file ends within the header: it is cut short")))
    }

    fn of(found: &Found) -> std::result::Result<Header, String> {
        if let Some(n) = found.dimension.filter(|n| *n != 3) {
            return Err(format!("valuedim is {n}, but a spin has 3 components"));
        }
        let irregular = found.irregular.unwrap_or(false);
        let (nodes, mesh) = match (found.nodes, found.points) {
            ([Some(x), Some(y), Some(z)], _) if !irregular => {
                let mesh = Some([x, y, z]).filter(|mesh| mesh.iter().filter(|n| **n > 1).count() > 1);
                (x.checked_mul(y).and_then(|area| area.checked_mul(z)).unwrap_or(usize::MAX), mesh)
            }
            (_, Some(points)) => (points, None),
            _ if irregular => return Err("the header has no pointcount".into()),
            (nodes, None) => {
                let axis = nodes.iter().position(Option::is_none).unwrap_or(0);
                return Err(format!("the header has no {}nodes", ["x", "y", "z"][axis]));
            }
        };
        match nodes > MAX_SITES {
            true => Err(format!("{nodes} nodes, but a lattice has at most {MAX_SITES} sites")),
            false => Ok(Header { nodes, mesh, irregular }),
        }
    }
}

impl Found {
    fn take(&mut self, key: &str, value: &str) -> std::result::Result<(), String> {
        let slot = match key {
            "xnodes" => &mut self.nodes[0],
            "ynodes" => &mut self.nodes[1],
            "znodes" => &mut self.nodes[2],
            "pointcount" => &mut self.points,
            "valuedim" => &mut self.dimension,
            "meshtype" => {
                let kind = squeezed(value);
                let irregular = kind == "irregular";
                if !irregular && kind != "rectangular" {
                    return Err(format!("meshtype is rectangular or irregular, found {}", quoted(value)));
                }
                return once(&mut self.irregular, irregular, key);
            }
            _ => return Ok(()),
        };
        match value.parse::<usize>() {
            Ok(n @ 1..) => once(slot, n, key),
            _ => Err(format!("{key} is a whole number from 1, found {}", quoted(value))),
        }
    }
}

fn once<T: PartialEq>(slot: &mut Option<T>, value: T, key: &str) -> std::result::Result<(), String> {
    match slot.replace(value) {
        Some(before) if Some(&before) != slot.as_ref() => Err(format!("{key} appears twice, with different values")),
        _ => Ok(()),
    }
}
