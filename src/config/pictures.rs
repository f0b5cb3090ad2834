//! Images that shapes are made of: read once, and put into the config in place of their names, so that it runs by itself and its hash
//! is that of the pixels.

use super::json::{Holds, Node, Step, tree, written};
use super::text::Text;
use crate::base64::base64;
use crate::error::{Error, Result};
use crate::files::open_file;
use crate::lattice::DATA;
use std::io::Read;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Largest image (bytes).
const LARGEST: u64 = 16 << 20;

/// The text with the images that it names, looked for in `folder`, and their files.
pub(super) fn with_images(text: Text, folder: &Path) -> Result<(Text, Vec<PathBuf>)> {
    let (mut named, mut files, mut pieces) = (Vec::new(), Vec::new(), Vec::new());
    find(&tree(&text.file, &text.text)?, &mut Vec::new(), &mut named);
    for (range, place) in named {
        // what is no string is refused with all else
        let Ok(path) = serde_json::from_str::<String>(&text.text[range.clone()]) else { continue };
        if path.starts_with("data:") {
            continue;
        }
        let file = folder.join(&path);
        let bytes = read(&file).map_err(|message| text.locate(Error::invalid(written(&place), message)))?;
        pieces.push((range, format!("\"{DATA}{}\"", base64(&bytes))));
        files.push(file);
    }
    Ok((text.replaced(pieces), files))
}

fn read(file: &Path) -> std::result::Result<Vec<u8>, String> {
    let refused = |e: std::io::Error| format!("the image {} cannot be read: {e}", file.display());
    let mut bytes = Vec::new();
    open_file(file).and_then(|from| from.take(LARGEST + 1).read_to_end(&mut bytes)).map_err(refused)?;
    match bytes.starts_with(b"\x89PNG\r\n\x1a\n") {
        _ if bytes.len() as u64 > LARGEST => Err(format!("the image {} is larger than 16 MiB", file.display())),
        true => Ok(bytes),
        false => Err(format!("{} is no PNG image: save it as one", file.display())),
    }
}

/// Where the paths of images stand: `{"image": {"path": "mask.png"}}`, in order.
fn find(node: &Node, at: &mut Vec<Step>, named: &mut Vec<(Range<usize>, Vec<Step>)>) {
    let children: Vec<(Step, &Node)> = match &node.holds {
        Holds::Members(members) => members.iter().map(|m| (Step::Key(m.key.clone()), &m.value)).collect(),
        Holds::Values(values) => values.iter().enumerate().map(|(k, value)| (Step::Index(k), value)).collect(),
        Holds::Nothing => Vec::new(),
    };
    for (step, child) in children {
        let of_image = matches!(at.last(), Some(Step::Key(key)) if key == "image");
        let is_path = matches!(&step, Step::Key(key) if key == "path");
        at.push(step);
        match of_image && is_path {
            true => named.push((child.start..child.end, at.clone())),
            false => find(child, at, named),
        }
        at.pop();
    }
}
