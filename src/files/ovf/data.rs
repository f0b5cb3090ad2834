//! A segment's data: text or binary, as long as the header says and no longer.

use super::header::Header;
use super::lines::{Line, Lines, squeezed};
use crate::error::Result;
use crate::files::Collector;
use crate::files::numbers::{Stored, parse, vector};
use crate::words::quoted;

/// The first number of binary data, in single and in double precision.
pub(super) const CHECK_4: f32 = 1234567.0;
/// See [`CHECK_4`].
pub(super) const CHECK_8: f64 = 123456789012345.0;

/// Reads the data behind their "Begin: Data …" line; `kind` is what that line names, in lower case without white space.
pub(super) fn read(
    kind: &str,
    header: &Header,
    lines: &mut Lines,
    images: &mut Collector,
    segment: usize,
    begin: &Line,
) -> Result<()> {
    if !begin.ended {
        let message = format!("segment {segment}: the file ends where the data should begin: it is cut short");
        return Err(images.error(begin.place(), message));
    }
    match kind {
        // libovf's csv is text with commas
        "datatext" | "datacsv" => text(header, lines, images, segment)?,
        "databinary4" => binary(Stored::F4, header, lines, images, segment)?,
        "databinary8" => binary(Stored::F8, header, lines, images, segment)?,
        _ => {
            let found = quoted(begin.text.trim());
            let message =
                format!("segment {segment}: found {found}, expected Data Text, Data Binary 4 or Data Binary 8");
            return Err(images.error(begin.place(), message));
        }
    }
    Ok(())
}

/// Whether this is the line that ends data.
fn ends_data(line: &Line) -> bool {
    line.entry().is_some_and(|(key, value)| key == "end" && squeezed(&value).starts_with("data"))
}

/// Numbers of each node: three, or six where their positions are there.
fn columns(header: &Header, numbers: usize) -> Option<usize> {
    let usual: &[usize] = if header.irregular { &[6, 3] } else { &[3] };
    usual.iter().copied().find(|c| header.nodes.checked_mul(*c) == Some(numbers))
}

impl Header {
    /// Begins an image whose data have so many numbers a node. Where nodes have places, some may have no spin.
    fn begin(&self, columns: usize, images: &mut Collector) -> Result<()> {
        images.begin_on(self.nodes, self.mesh, self.mesh.is_some() || columns > 3)
    }
}

fn text(header: &Header, lines: &mut Lines, images: &mut Collector, segment: usize) -> Result<()> {
    // the numbers, and for each line with numbers its own number and how many come before it
    let (mut numbers, mut starts): (Vec<f64>, Vec<(usize, usize)>) = (Vec::new(), Vec::new());
    loop {
        let Some(line) = lines.next() else {
            let message = format!("segment {segment}: the file ends within the data: it is cut short");
            return Err(images.error(lines.place(), message));
        };
        if line.text.trim_start().starts_with('#') {
            if ends_data(&line) {
                break;
            }
            if line.is_blank() {
                continue;
            }
            let found = quoted(line.text.trim());
            let message = format!("segment {segment}: found {found} among the data, expected \"# End: Data Text\"");
            return Err(images.error(line.place(), message));
        }
        starts.push((numbers.len(), line.number));
        let words = line.text.split(|c: char| c.is_whitespace() || c == ',').filter(|w| !w.is_empty());
        for word in words {
            let number = parse(word).ok_or_else(|| {
                images.error(line.place(), format!("segment {segment}: found {}, expected a number", quoted(word)))
            })?;
            numbers.push(number);
        }
    }
    let Some(columns) = columns(header, numbers.len()) else {
        let (found, wanted) = (numbers.len(), header.nodes);
        let message = format!("segment {segment}: found {found} numbers, but {wanted} nodes have 3 each");
        return Err(images.error(lines.place(), message));
    };
    header.begin(columns, images)?;
    for (i, node) in numbers.chunks_exact(columns).enumerate() {
        let v = &node[columns - 3..];
        if columns > 3 {
            images.stand([node[0], node[1], node[2]]);
        }
        images.push([v[0], v[1], v[2]], || {
            let line = starts.partition_point(|(first, _)| *first <= i * columns);
            format!("line {}: segment {segment}, node {i}", line.checked_sub(1).map_or(0, |k| starts[k].1))
        })?;
    }
    Ok(())
}

fn binary(kind: Stored, header: &Header, lines: &mut Lines, images: &mut Collector, segment: usize) -> Result<()> {
    let (size, data, start) = (kind.size(), lines.rest(), lines.byte());
    let wrong = |images: &Collector, at: usize, m: String| {
        Err(images.error(format!("byte {at}"), format!("segment {segment}: {m}")))
    };
    let columns = if header.irregular { &[6, 3][..] } else { &[3] };
    let mut lengths = columns.iter().map(|c| (*c, (header.nodes * c + 1) * size));
    let end = |length: usize| {
        let mut after = Lines::new(data.get(length..)?);
        while after.peek()?.is_blank() {
            after.next();
        }
        after.peek().filter(ends_data).map(|_| after.byte())
    };
    let found = lengths.clone().find_map(|(c, length)| Some((c, length, end(length)?)));
    let Some((columns, length, blank)) = found else {
        let needed = lengths.next_back().map_or(0, |(_, length)| length);
        if data.len() < needed {
            let (nodes, there) = (header.nodes, data.len());
            let m =
                format!("{nodes} nodes take {needed} bytes with the check value, {there} are left: it is cut short");
            return wrong(images, start, m);
        }
        let m = "expected \"# End: Data\" behind the data of all nodes: the file is damaged or cut short";
        return wrong(images, start + needed, m.into());
    };
    let big_endian = match checked(kind, &data[..size]) {
        Ok(big_endian) => big_endian,
        Err(m) => return wrong(images, start, m),
    };
    header.begin(columns, images)?;
    for i in 0..header.nodes {
        let at = size * (1 + columns * i + columns - 3);
        let v = vector(kind, &data[at..], big_endian);
        if columns > 3 {
            images.stand(vector(kind, &data[at - 3 * size..], big_endian));
        }
        images.push(v, || format!("byte {}: segment {segment}, node {i}", start + at))?;
    }
    lines.skip(length + blank);
    lines.next();
    Ok(())
}

/// Whether the check value is big-endian, as in files of OVF 1.0 and of some writers since.
fn checked(kind: Stored, bytes: &[u8]) -> std::result::Result<bool, String> {
    let wanted = if kind == Stored::F4 { f64::from(CHECK_4) } else { CHECK_8 };
    let found = [false, true].map(|big_endian| kind.value(bytes, big_endian));
    match found.iter().position(|x| *x == wanted) {
        Some(k) => Ok(k == 1),
        None => Err(format!(
            "the check value is {:e}, not {wanted}: the file is damaged, or its numbers are others",
            found[0]
        )),
    }
}
