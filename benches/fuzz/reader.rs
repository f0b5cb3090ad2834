//! A second reader of files of spins, written from the formats' documents and the book alone, to compare the program's with.
//!
//! It knows nothing of places or messages: a file has these vectors, or none.

use super::arrays::{Numbers, array, members};

/// Vectors as they stand in the file, one a site, image after image.
pub type Vectors = Vec<Vec<[f64; 3]>>;

/// The vectors of a file, if it is one.
pub fn read(name: &str, bytes: &[u8]) -> Option<Vectors> {
    let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending);
    // an OVF file knows by itself where a zero vector may stand
    let by_ovf = is_ovf(bytes) || (ending == "ovf" && !is_packed(bytes));
    let images = if by_ovf {
        ovf(bytes)
    } else if bytes.starts_with(b"PK\x03\x04") || (ending == "npz" && !is_packed(bytes)) {
        npz(bytes)
    } else if is_packed(bytes) || ending == "npy" {
        images(array(bytes)?)
    } else {
        csv(bytes)
    }?;
    let same = images.iter().all(|i| !i.is_empty() && i.len() == images[0].len());
    let sound = |v: &[f64; 3]| v.iter().all(|x| x.is_finite()) && (by_ovf || !is_zero(v));
    (same && !images.is_empty() && images.iter().flatten().all(sound)).then_some(images)
}

fn is_zero(v: &[f64; 3]) -> bool {
    v.iter().all(|x| *x == 0.0)
}

fn is_packed(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(b"\x93NUMPY")
}

fn is_ovf(bytes: &[u8]) -> bool {
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(64)]).to_lowercase();
    let text = text.trim_start_matches('\u{feff}').trim_start();
    text.starts_with('#') && text.trim_start_matches(['#', ' ', '\t']).starts_with("oommf")
}

/// Spins are called so, or m, or they are the only array that can be spins.
fn npz(bytes: &[u8]) -> Option<Vectors> {
    let members = members(bytes)?;
    let named = |wanted: &str| members.iter().find(|(name, _)| name == wanted);
    if let Some((_, content)) = named("spins.npy").or(named("m.npy")) {
        return images(array(content)?);
    }
    let mut found = members.iter().filter(|(name, _)| name.ends_with(".npy")).filter_map(|(_, c)| images(array(c)?));
    found.next().filter(|_| found.next().is_none())
}

/// (site, 3), (image, site, 3), and meshes (x, y, z, 3) of one row, with images or without.
fn images(array: Numbers) -> Option<Vectors> {
    let (&components, axes) = array.shape.split_last()?;
    let (count, mesh) = match axes.len() {
        1 | 3 => (1, axes),
        2 | 4 => (axes[0], &axes[1..]),
        _ => return None,
    };
    let row = mesh.iter().filter(|n| **n != 1).count() <= 1;
    (components == 3 && row && !array.values.is_empty()).then_some(())?;
    let vectors: Vec<[f64; 3]> = array.values.chunks(3).map(|v| [v[0], v[1], v[2]]).collect();
    Some(vectors.chunks(vectors.len() / count).map(<[_]>::to_vec).collect())
}

/// A number as programs print it, Fortran's among them.
fn number(word: &str) -> Option<f64> {
    let plain: Option<f64> = word.parse().ok();
    plain.or_else(|| {
        let digits = word.starts_with(|c: char| !c.is_ascii_alphabetic());
        word.replace(['D', 'd'], "e").parse().ok().filter(|_| digits)
    })
}

/// The words of a line: between commas, else semicolons, else white space, without quotation marks.
fn words(line: &str) -> Vec<&str> {
    let split: Vec<&str> = match [',', ';'].into_iter().find(|c| line.contains(*c)) {
        Some(mark) => line.split(mark).collect(),
        None => line.split_whitespace().collect(),
    };
    split.into_iter().map(|w| w.trim_matches(['"', '\'', ' ', '\t'])).collect()
}

/// Which column is x, y, z, image and site.
#[derive(Clone, Copy)]
struct Columns {
    count: usize,
    xyz: [usize; 3],
    image: Option<usize>,
    site: Option<usize>,
}

fn columns(names: &[&str]) -> Option<Columns> {
    let plain: Vec<String> =
        names.iter().map(|n| n.to_lowercase().chars().filter(|c| c.is_ascii_alphanumeric()).collect()).collect();
    let place = |name: &str| plain.iter().position(|n| n == name);
    let first = |names: &[&str]| names.iter().find_map(|n| place(n));
    let xyz = ["m", "s", "spin", ""].iter().find_map(|start| {
        let of = |c: &str| place(&format!("{start}{c}"));
        Some([of("x")?, of("y")?, of("z")?])
    })?;
    let image = first(&["image", "segment", "frame"]);
    Some(Columns { count: names.len(), xyz, image, site: first(&["site", "index", "atom", "node", "i"]) })
}

/// `# images: 3, sites: 5`.
fn promise(comment: &str) -> Option<(usize, usize)> {
    let words = words(comment.trim());
    let of = |word: &str, key: &str| word.strip_prefix(key)?.trim_start().strip_prefix(':')?.trim().parse().ok();
    (words.len() == 2).then(|| Some((of(words[0], "images")?, of(words[1], "sites")?)))?
}

fn csv(bytes: &[u8]) -> Option<Vectors> {
    (!bytes.contains(&0)).then_some(())?;
    let text = String::from_utf8_lossy(bytes);
    let text = text.trim_start_matches('\u{feff}');
    // no row may be cut short: each has an end, comments and blank lines aside
    let rows: Vec<&str> = text.split_inclusive('\n').collect();
    let whole = |row: &&str| row.ends_with('\n') || row.trim().is_empty() || row.trim().starts_with('#');
    rows.iter().all(whole).then_some(())?;
    let (mut named, mut promised, mut begun) = (None, None, false);
    // image, site, vector
    let mut found: Vec<(Option<usize>, Option<usize>, [f64; 3])> = Vec::new();
    for row in rows.iter().map(|row| row.trim()).filter(|row| !row.is_empty()) {
        if let Some(comment) = row.strip_prefix('#') {
            if !begun {
                match promise(comment) {
                    Some(p) => promised = Some(p),
                    None => named = named.or_else(|| columns(&words(comment.trim()))),
                }
            }
            continue;
        }
        let words = words(row);
        if !begun && words.iter().all(|w| number(w).is_none()) {
            named = Some(columns(&words)?);
            begun = true;
            continue;
        }
        begun = true;
        let without = Columns { count: 3, xyz: [0, 1, 2], image: None, site: None };
        let c = *named.get_or_insert(without);
        (words.len() == c.count).then_some(())?;
        let index = |k: Option<usize>| k.map_or(Some(None), |k| words[k].parse().ok().map(Some));
        let [x, y, z] = c.xyz.map(|k| number(words[k]));
        found.push((index(c.image)?, index(c.site)?, [x?, y?, z?]));
    }
    in_images(&found, promised)
}

/// Rows are in order: images count up by one, sites from 0 or 1.
fn in_images(rows: &[(Option<usize>, Option<usize>, [f64; 3])], promised: Option<(usize, usize)>) -> Option<Vectors> {
    let first = rows.first()?.1;
    (first.is_none_or(|i| i <= 1)).then_some(())?;
    let mut images: Vectors = Vec::new();
    for (k, (image, site, vector)) in rows.iter().enumerate() {
        let before = k.checked_sub(1).map(|b| rows[b].0);
        let begins = match (image, before) {
            (_, None) => true,
            (Some(_), Some(before)) => *image != before,
            (None, _) => site.is_some() && *site == first,
        };
        if begins {
            let next = before.flatten().and_then(|b| b.checked_add(1));
            (before.is_none() || image.is_none() || *image == next).then_some(())?;
            images.push(Vec::new());
        }
        let here = images.last_mut()?;
        let wanted = first.map(|f| f + here.len());
        (site.is_none() || *site == wanted).then_some(())?;
        here.push(*vector);
    }
    let kept = |(count, sites): (usize, usize)| images.len() == count && images.iter().all(|i| i.len() == sites);
    promised.is_none_or(kept).then_some(images)
}

/// The bytes of a file, line by line.
struct Cursor<'a> {
    rest: &'a [u8],
}

impl<'a> Cursor<'a> {
    /// The next line, and whether it has an end.
    fn line(&mut self) -> Option<(String, bool)> {
        (!self.rest.is_empty()).then_some(())?;
        let end = self.rest.iter().position(|b| *b == b'\n');
        let line = String::from_utf8_lossy(&self.rest[..end.unwrap_or(self.rest.len())]).into_owned();
        self.rest = &self.rest[end.map_or(self.rest.len(), |e| e + 1)..];
        Some((line, end.is_some()))
    }
}

fn small(text: &str) -> String {
    text.to_lowercase().split_whitespace().collect()
}

/// The key and the value of `# key: value ## comment`.
fn entry(line: &str) -> Option<(String, String)> {
    let (key, value) = line.trim().strip_prefix('#')?.split("##").next()?.split_once(':')?;
    Some((small(key), value.trim().to_string()))
}

/// White space and comments.
fn blank(line: &str) -> bool {
    let line = line.trim();
    line.starts_with("##") || line.trim_start_matches('#').trim().is_empty()
}

fn ovf(bytes: &[u8]) -> Option<Vectors> {
    let mut at = Cursor { rest: bytes };
    let title = small(at.line()?.0.trim_start_matches('\u{feff}').trim_start().trim_start_matches('#'));
    (title.replace(':', "") == "oommfovf2.0").then_some(())?;
    let (mut images, mut promised, mut first) = (Vec::new(), None, None);
    while let Some((line, _)) = at.line() {
        match entry(&line) {
            Some((key, value)) if key == "segmentcount" => promised = Some(value.parse::<usize>().ok()?),
            Some((key, value)) if key == "begin" && small(&value) == "segment" => {
                let (vectors, mesh) = segment(&mut at)?;
                (*first.get_or_insert(mesh) == mesh).then_some(())?;
                images.push(vectors);
            }
            Some((key, _)) if key == "begin" || key == "end" => return None,
            Some(_) => {}
            None => (blank(&line) || line.trim_start().starts_with('#')).then_some(())?,
        }
    }
    let some = images.iter().flatten().any(|v| !is_zero(v));
    (some && promised.is_none_or(|p| p == images.len())).then_some(images)
}

/// Nodes along x, y and z, where that is more than a row.
type Box3 = Option<[usize; 3]>;

/// One segment, and its mesh. A node of a mesh, and one with a position, may have no spin: its vector is zero.
fn segment(at: &mut Cursor) -> Option<(Vec<[f64; 3]>, Box3)> {
    let mut nodes: Option<(usize, bool, Box3)> = None;
    let mut found = None;
    while let Some((line, ended)) = at.line() {
        if blank(&line) {
            continue;
        }
        let (key, value) = entry(&line)?;
        match (key.as_str(), small(&value).as_str(), nodes) {
            ("begin", "header", None) => nodes = Some(header(at)?),
            ("begin", kind, Some((n, irregular, mesh))) if kind.starts_with("data") && found.is_none() => {
                ended.then_some(())?;
                let widths: &[usize] = if irregular { &[6, 3] } else { &[3] };
                let (vectors, width) = match kind {
                    "datatext" | "datacsv" => text(at, n, widths)?,
                    "databinary4" => binary(at, n, widths, 4)?,
                    "databinary8" => binary(at, n, widths, 8)?,
                    _ => return None,
                };
                (mesh.is_some() || width == 6 || !vectors.iter().any(is_zero)).then_some(())?;
                found = Some((vectors, mesh));
            }
            ("end", "segment", _) => return found,
            ("begin" | "end", ..) => return None,
            _ => {}
        }
    }
    None
}

/// How many nodes, whether each has its position before it, and the mesh.
fn header(at: &mut Cursor) -> Option<(usize, bool, Box3)> {
    let mut keys: std::collections::BTreeMap<String, String> = Default::default();
    loop {
        let line = at.line()?.0;
        if blank(&line) {
            continue;
        }
        let Some((key, value)) = entry(&line) else {
            line.trim_start().starts_with('#').then_some(())?;
            continue;
        };
        match key.as_str() {
            "end" if small(&value) == "header" => break,
            "begin" | "end" => return None,
            "xnodes" | "ynodes" | "znodes" | "pointcount" | "valuedim" => {
                let n = value.parse::<usize>().ok().filter(|n| *n > 0)?.to_string();
                (keys.get(&key).is_none_or(|before| *before == n)).then(|| keys.insert(key, n))?;
            }
            "meshtype" => {
                let kind = small(&value);
                ["rectangular", "irregular"].contains(&kind.as_str()).then_some(())?;
                (keys.get(&key).is_none_or(|before| *before == kind)).then(|| keys.insert(key, kind))?;
            }
            _ => {}
        }
    }
    let whole = |key: &str| keys.get(key).and_then(|n| n.parse::<usize>().ok());
    whole("valuedim").is_none_or(|n| n == 3).then_some(())?;
    let irregular = keys.get("meshtype").is_some_and(|kind| kind == "irregular");
    let mesh = ["xnodes", "ynodes", "znodes"].map(whole);
    let (nodes, mesh) = match mesh {
        [Some(x), Some(y), Some(z)] if !irregular => {
            let rows = [x, y, z].iter().filter(|n| **n > 1).count();
            (x.checked_mul(y)?.checked_mul(z)?, (rows > 1).then_some([x, y, z]))
        }
        _ => (whole("pointcount")?, None),
    };
    (nodes <= 100_000_000).then_some((nodes, irregular, mesh))
}

fn is_end_of_data(line: &str) -> bool {
    entry(line).is_some_and(|(key, value)| key == "end" && small(&value).starts_with("data"))
}

fn text(at: &mut Cursor, nodes: usize, widths: &[usize]) -> Option<(Vec<[f64; 3]>, usize)> {
    let mut numbers = Vec::new();
    loop {
        let line = at.line()?.0;
        if line.trim_start().starts_with('#') {
            if is_end_of_data(&line) {
                break;
            }
            blank(&line).then_some(())?;
            continue;
        }
        for word in line.split(|c: char| c == ',' || c.is_whitespace()).filter(|w| !w.is_empty()) {
            numbers.push(number(word)?);
        }
    }
    let width = widths.iter().find(|w| nodes * **w == numbers.len())?;
    Some((last_three(&numbers, *width), *width))
}

fn last_three(numbers: &[f64], width: usize) -> Vec<[f64; 3]> {
    numbers.chunks(width).map(|n| [n[width - 3], n[width - 2], n[width - 1]]).collect()
}

fn binary(at: &mut Cursor, nodes: usize, widths: &[usize], size: usize) -> Option<(Vec<[f64; 3]>, usize)> {
    let decoded = |bytes: &[u8], swap: bool| {
        let mut bytes = bytes.to_vec();
        if swap {
            bytes.reverse();
        }
        match size {
            4 => f64::from(f32::from_le_bytes(bytes.try_into().expect("4 bytes"))),
            _ => f64::from_le_bytes(bytes.try_into().expect("8 bytes")),
        }
    };
    let check = if size == 4 { 1234567.0 } else { 123456789012345.0 };
    for width in widths {
        let length = (nodes * width + 1) * size;
        let Some(rest) = at.rest.get(length..) else { continue };
        let mut behind = Cursor { rest };
        let line = loop {
            match behind.line() {
                Some((line, _)) if blank(&line) => {}
                line => break line,
            }
        };
        if !line.is_some_and(|(line, _)| is_end_of_data(&line)) {
            continue;
        }
        let data = &at.rest[..length];
        let swap = [false, true].into_iter().find(|swap| decoded(&data[..size], *swap) == check)?;
        let numbers: Vec<f64> = data[size..].chunks(size).map(|bytes| decoded(bytes, swap)).collect();
        at.rest = behind.rest;
        return Some((last_three(&numbers, *width), *width));
    }
    None
}
