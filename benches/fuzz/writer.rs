//! Files of spins as other programs write them, in every way that the formats leave open, with the numbers that stand in them.

use super::reader::Vectors;
use flate2::{Compression, Crc, write::DeflateEncoder};
use rand::{RngExt, seq::IndexedRandom};
use rand_chacha::ChaCha8Rng;
use std::io::Write;

/// How numbers are stored in bytes.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Float(usize),
    Integer(usize),
}

/// A file: its name, its bytes, and the vectors that stand in it.
pub fn file(r: &mut ChaCha8Rng) -> (&'static str, Vec<u8>, Vectors) {
    let (images, sites) = (r.random_range(1..4), r.random_range(1..6));
    let format = r.random_range(0..6);
    let kind = match (format, r.random_range(0..6)) {
        (0 | 1, 0) => Kind::Integer([1, 2, 4, 8][r.random_range(0..4)]),
        (3, _) | (0 | 1, 1 | 2) => Kind::Float(4),
        _ => Kind::Float(8),
    };
    let vectors: Vectors = (0..images).map(|_| (0..sites).map(|_| vector(kind, r)).collect()).collect();
    let (name, bytes) = match format {
        0 => ("spins.npy", npy(&vectors, kind, r)),
        1 => ("spins.npz", npz(&vectors, kind, r)),
        2 => ("spins.csv", csv(&vectors, r)),
        _ => ("spins.ovf", ovf(&vectors, ["", "Binary 4", "Binary 8", "Text"][format - 2], r)),
    };
    (name, bytes, vectors)
}

/// Of about unit length, or any, never zero.
fn vector(kind: Kind, r: &mut ChaCha8Rng) -> [f64; 3] {
    let size = if r.random() { 1.0 } else { 10f64.powf(r.random_range(-3.0..3.0)) };
    let v = [0; 3].map(|_| match kind {
        Kind::Integer(_) => f64::from(r.random_range(-128..128)),
        Kind::Float(4) => f64::from((size * r.random_range(-1.0..1.0)) as f32),
        Kind::Float(_) => size * r.random_range(-1.0..1.0),
    });
    if v == [0.0; 3] { [0.0, 0.0, 1.0] } else { v }
}

fn stored(x: f64, kind: Kind, big: bool) -> Vec<u8> {
    let mut bytes = match kind {
        Kind::Float(4) => (x as f32).to_le_bytes().to_vec(),
        Kind::Float(_) => x.to_le_bytes().to_vec(),
        Kind::Integer(size) => (x as i64).to_le_bytes()[..size].to_vec(),
    };
    if big {
        bytes.reverse();
    }
    bytes
}

fn npy(vectors: &Vectors, kind: Kind, r: &mut ChaCha8Rng) -> Vec<u8> {
    let (images, sites) = (vectors.len(), vectors[0].len());
    let (big, fortran) = (r.random::<bool>(), r.random::<bool>());
    let mut shape = vec![sites, 3];
    if r.random_range(0..4) == 0 {
        shape.splice(0..1, *[[sites, 1, 1], [1, sites, 1], [1, 1, sites]].choose(r).expect("one"));
    }
    if images > 1 || r.random() {
        shape.insert(0, images);
    }
    let mut order: Vec<[usize; 3]> = Vec::new();
    for k in 0..images {
        order.extend((0..sites).flat_map(|i| [0, 1, 2].map(|c| [k, i, c])));
    }
    if fortran {
        order.sort_by_key(|[k, i, c]| (*c, *i, *k));
    }
    let letter = match kind {
        Kind::Float(size) => format!("f{size}"),
        Kind::Integer(size) => format!("i{size}"),
    };
    let lengths: Vec<String> = shape.iter().map(usize::to_string).collect();
    let mut header = format!(
        "{{'descr': '{}{letter}', 'fortran_order': {}, 'shape': ({}), }}",
        if big { '>' } else { '<' },
        if fortran { "True" } else { "False" },
        lengths.join(", ")
    );
    header.push_str(&" ".repeat(r.random_range(0..64)));
    header.push('\n');
    let version = r.random_range(1..4u8);
    let mut bytes = b"\x93NUMPY".to_vec();
    bytes.extend([version, 0]);
    match version {
        1 => bytes.extend((header.len() as u16).to_le_bytes()),
        _ => bytes.extend((header.len() as u32).to_le_bytes()),
    }
    bytes.extend(header.bytes());
    bytes.extend(order.iter().flat_map(|[k, i, c]| stored(vectors[*k][*i][*c], kind, big)));
    bytes
}

fn npz(vectors: &Vectors, kind: Kind, r: &mut ChaCha8Rng) -> Vec<u8> {
    let name = *["spins.npy", "m.npy", "other.npy"].choose(r).expect("one");
    let column = npy_column(r.random_range(1..9));
    let mut members = vec![(name, npy(vectors, kind, r))];
    if r.random() {
        members.insert(r.random_range(0..2), ("energy.npy", column));
    }
    let (mut bytes, mut directory) = (Vec::new(), Vec::new());
    for (name, content) in &members {
        let deflated = r.random::<bool>();
        let packed = if deflated {
            let mut encoder = DeflateEncoder::new(Vec::new(), Compression::default());
            encoder.write_all(content).expect("memory");
            encoder.finish().expect("memory")
        } else {
            content.clone()
        };
        let mut check = Crc::new();
        check.update(content);
        let mut common = Vec::new();
        for n in [20u16, 0, if deflated { 8 } else { 0 }, 0, 33] {
            common.extend(n.to_le_bytes());
        }
        for n in [check.sum(), packed.len() as u32, content.len() as u32] {
            common.extend(n.to_le_bytes());
        }
        common.extend((name.len() as u16).to_le_bytes());
        common.extend([0, 0]);
        let start = bytes.len() as u32;
        bytes.extend(b"PK\x03\x04");
        bytes.extend(&common);
        bytes.extend(name.bytes());
        bytes.extend(&packed);
        directory.extend(b"PK\x01\x02\x14\x00");
        directory.extend(&common);
        directory.extend([0; 10]);
        directory.extend(start.to_le_bytes());
        directory.extend(name.bytes());
    }
    let start = bytes.len() as u32;
    bytes.extend(&directory);
    bytes.extend(b"PK\x05\x06\0\0\0\0");
    bytes.extend([members.len() as u16; 2].iter().flat_map(|n| n.to_le_bytes()));
    bytes.extend((directory.len() as u32).to_le_bytes());
    bytes.extend(start.to_le_bytes());
    bytes.extend([0, 0]);
    bytes
}

/// Numbers that are no spins.
fn npy_column(length: usize) -> Vec<u8> {
    let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({length},), }}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.bytes());
    bytes.extend((0..length).flat_map(|k| (k as f64).to_le_bytes()));
    bytes
}

/// A number with all its digits, in one of the ways of writing it.
fn shown(x: f64, r: &mut ChaCha8Rng) -> String {
    match r.random_range(0..4) {
        0 => format!("{x:e}"),
        1 => format!("{x:?}"),
        2 => format!("{x:e}").replace('e', "D"),
        _ => format!("{x}"),
    }
}

fn csv(vectors: &Vectors, r: &mut ChaCha8Rng) -> Vec<u8> {
    let (mark, end) = (*[",", ";", " ", "\t", ", "].choose(r).expect("one"), *["\n", "\r\n"].choose(r).expect("one"));
    let many = vectors.len() > 1;
    let plain = !many && r.random();
    let xyz = *[["m_x", "m_y", "m_z"], ["Mx", "My", "Mz"], ["x", "y", "z"], ["spin_x", "spin_y", "spin_z"]]
        .choose(r)
        .expect("one");
    // columns in any order, and some that mean nothing
    let mut columns: Vec<&str> = xyz.to_vec();
    if !plain {
        columns.extend(["site"].iter().filter(|_| many || r.random()));
        columns.extend(["image"].iter().filter(|_| many || r.random()));
        columns.extend(["energy"].iter().filter(|_| r.random()));
        let turn = r.random_range(0..columns.len());
        columns.rotate_left(turn);
    }
    let first = r.random_range(0..2);
    let mut text = String::new();
    if r.random_range(0..4) == 0 {
        text.push('\u{feff}');
    }
    if r.random_range(0..3) == 0 {
        text.push_str(&format!("# images: {}, sites: {}{end}", vectors.len(), vectors[0].len()));
    }
    if !plain {
        text.push_str(["", "# "][r.random_range(0..2)]);
        text.push_str(&columns.join(mark));
        text.push_str(end);
    }
    for (k, image) in vectors.iter().enumerate() {
        for (i, v) in image.iter().enumerate() {
            let cells: Vec<String> = columns
                .iter()
                .map(|name| match *name {
                    "site" => (first + i).to_string(),
                    "image" => k.to_string(),
                    "energy" => "0.5".into(),
                    name => shown(v[xyz.iter().position(|c| *c == name).expect("a column")], r),
                })
                .collect();
            text.push_str(&cells.join(mark));
            text.push_str(end);
        }
        if r.random_range(0..4) == 0 {
            text.push_str(["# a comment", "", "  "][r.random_range(0..3)]);
            text.push_str(end);
        }
    }
    text.into_bytes()
}

fn ovf(vectors: &Vectors, data: &str, r: &mut ChaCha8Rng) -> Vec<u8> {
    let mut out = Vec::new();
    let style = r.random_range(0..3);
    let end = *["\n", "\r\n"].choose(r).expect("one");
    let line = |out: &mut Vec<u8>, key: &str, value: &str| {
        let text = match style {
            0 => format!("# {key}: {value}"),
            1 => format!("#{}:{value}", key.to_uppercase()),
            _ => format!("#  {} :  {value}  ## said so", key.to_lowercase()),
        };
        out.extend(text.bytes().chain(end.bytes()));
    };
    out.extend(format!("# OOMMF OVF 2.0{end}").bytes());
    if r.random() {
        line(&mut out, "Segment count", &vectors.len().to_string());
    }
    let (irregular, positions, big) = (r.random_range(0..4) == 0, r.random::<bool>(), r.random::<bool>());
    let (along, many) = (r.random_range(0..3), r.random::<bool>());
    for image in vectors {
        for (key, value) in [("Begin", "Segment"), ("Begin", "Header"), ("Title", "m"), ("valuedim", "3")] {
            line(&mut out, key, value);
        }
        let rows = if many && image.len().is_multiple_of(2) { 2 } else { 1 };
        let [n, rows] = [image.len() / if irregular { 1 } else { rows }, rows].map(|n| n.to_string());
        if irregular {
            line(&mut out, "meshtype", "irregular");
            line(&mut out, "pointcount", &n);
        } else {
            line(&mut out, "meshtype", "rectangular");
            for (c, key) in ["xnodes", "ynodes", "znodes"].into_iter().enumerate() {
                line(
                    &mut out,
                    key,
                    if c == along {
                        &n
                    } else if c == (along + 1) % 3 {
                        &rows
                    } else {
                        "1"
                    },
                );
            }
        }
        line(&mut out, "End", "Header");
        line(&mut out, "Begin", &format!("Data {data}"));
        let rows = image.iter().enumerate().map(|(i, v)| {
            let place = [i as f64, 0.0, 0.0];
            if irregular && positions { [&place[..], v].concat() } else { v.to_vec() }
        });
        match data {
            "Text" => {
                for row in rows {
                    let words: Vec<String> = row.iter().map(|x| shown(*x, r)).collect();
                    out.extend(words.join(" ").bytes().chain(end.bytes()));
                }
            }
            _ => {
                let (kind, check) = match data {
                    "Binary 4" => (Kind::Float(4), 1234567.0),
                    _ => (Kind::Float(8), 123456789012345.0),
                };
                out.extend(stored(check, kind, big));
                rows.for_each(|row| row.iter().for_each(|x| out.extend(stored(*x, kind, big))));
                out.extend(end.bytes());
            }
        }
        line(&mut out, "End", &format!("Data {data}"));
        line(&mut out, "End", "Segment");
    }
    out
}
