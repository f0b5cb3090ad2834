//! Readers of NumPy's arrays and archives, written from the formats' documents and for the tests alone.
//!
//! NEP 1 (npy): magic, version, length, a Python dictionary, numbers. APPNOTE 6.3.10 (zip): the central directory says where what is.

use flate2::read::DeflateDecoder;
use std::io::Read;

/// Numbers with the lengths of their axes, the last one fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct Numbers {
    pub shape: Vec<usize>,
    pub values: Vec<f64>,
}

/// The members of an archive under their names, in order.
pub fn members(bytes: &[u8]) -> Option<Vec<(String, Vec<u8>)>> {
    let end = (0..=bytes.len().checked_sub(22)?).rev().find(|k| bytes[*k..].starts_with(b"PK\x05\x06"))?;
    let (count, mut at) = (number(bytes, end + 10, 2)?, number(bytes, end + 16, 4)?);
    let mut found = Vec::new();
    for _ in 0..count {
        (number(bytes, at, 4)? == 0x0201_4b50).then_some(())?;
        let field = |offset, size| number(bytes, at + offset, size);
        let (method, check, packed, size) = (field(10, 2)?, field(16, 4)?, field(20, 4)?, field(24, 4)?);
        let (name, extra, comment, local) = (field(28, 2)?, field(30, 2)?, field(32, 2)?, field(42, 4)?);
        let word = String::from_utf8(bytes.get(at + 46..at + 46 + name)?.to_vec()).ok()?;
        let start = local + 30 + number(bytes, local + 26, 2)? + number(bytes, local + 28, 2)?;
        (number(bytes, local, 4)? == 0x0403_4b50).then_some(())?;
        let stored = bytes.get(start..start.checked_add(packed)?)?;
        let content = match method {
            0 => stored.to_vec(),
            8 => {
                let mut content = Vec::new();
                DeflateDecoder::new(stored).take(size as u64 + 1).read_to_end(&mut content).ok()?;
                content
            }
            _ => return None,
        };
        (content.len() == size && crc32(&content) as usize == check).then_some(())?;
        found.push((word, content));
        at += 46 + name + extra + comment;
    }
    Some(found)
}

/// An array.
pub fn array(bytes: &[u8]) -> Option<Numbers> {
    bytes.starts_with(b"\x93NUMPY").then_some(())?;
    let (start, length): (usize, usize) = match bytes.get(6)? {
        1 => (10, number(bytes, 8, 2)?),
        2 | 3 => (12, number(bytes, 8, 4)?),
        _ => return None,
    };
    let header = String::from_utf8_lossy(bytes.get(start..start.checked_add(length)?)?).into_owned();
    let value = |key: &str| {
        let rest = header.split_once(&format!("'{key}'"))?.1.trim_start().strip_prefix(':')?.trim_start();
        let end = if rest.starts_with('(') { rest.find(')')? + 1 } else { rest.find([',', '}'])? };
        Some(rest[..end].trim())
    };
    let kind = value("descr")?.trim_matches('\'');
    let shape = value("shape")?.strip_prefix('(')?.strip_suffix(')')?.split(',').map(str::trim);
    let shape: Vec<usize> = shape.filter(|n| !n.is_empty()).map(|n| n.parse().ok()).collect::<Option<_>>()?;
    let data = &bytes[start + length..];
    let size: usize = kind.get(2..)?.parse().ok().filter(|n| [1, 2, 4, 8].contains(n))?;
    let count = shape.iter().try_fold(1usize, |product, n| product.checked_mul(*n))?;
    (data.len() == count.checked_mul(size)?).then_some(())?;
    let values: Vec<f64> = data.chunks(size).map(|bytes| decoded(kind, bytes)).collect::<Option<_>>()?;
    match value("fortran_order")? {
        "False" => Some(Numbers { shape, values }),
        "True" => Some(Numbers { values: last_fastest(&shape, &values), shape }),
        _ => None,
    }
}

/// From first index fastest to last index fastest.
fn last_fastest(shape: &[usize], values: &[f64]) -> Vec<f64> {
    let place = |mut k: usize| {
        let mut index = vec![0; shape.len()];
        for (i, n) in index.iter_mut().zip(shape).rev() {
            (*i, k) = (k % n, k / n);
        }
        index.iter().zip(shape).rev().fold(0, |place, (i, n)| place * n + i)
    };
    (0..values.len()).map(|k| values[place(k)]).collect()
}

fn decoded(kind: &str, bytes: &[u8]) -> Option<f64> {
    let mut bytes = bytes.to_vec();
    match kind.as_bytes().first()? {
        b'>' => bytes.reverse(),
        b'<' | b'|' | b'=' => {}
        _ => return None,
    }
    let wide = |fill: u8| {
        let mut wide = [fill; 8];
        wide[..bytes.len()].copy_from_slice(&bytes);
        wide
    };
    Some(match (kind.as_bytes()[1], bytes.len()) {
        (b'f', 8) => f64::from_le_bytes(wide(0)),
        (b'f', 4) => f64::from(f32::from_le_bytes(bytes.try_into().ok()?)),
        (b'u', _) => u64::from_le_bytes(wide(0)) as f64,
        (b'i', _) => i64::from_le_bytes(wide(if bytes.last()? >> 7 == 1 { 255 } else { 0 })) as f64,
        _ => return None,
    })
}

/// A little-endian whole number.
fn number(bytes: &[u8], at: usize, size: usize) -> Option<usize> {
    Some(bytes.get(at..at.checked_add(size)?)?.iter().rev().fold(0, |n, b| n << 8 | *b as usize))
}

fn crc32(bytes: &[u8]) -> u32 {
    let step = |c: u32, _| if c & 1 == 1 { 0xedb8_8320 ^ (c >> 1) } else { c >> 1 };
    !bytes.iter().fold(!0, |c, b| (0..8).fold(c ^ u32::from(*b), step))
}
