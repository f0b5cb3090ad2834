//! Seeded mutations of configs and of files of spins, and what must hold whatever comes of them.

use super::reader::{self, Vectors};
use super::writer;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::Value;
use spinneb::config::load_text;
use spinneb::files::{Array, Mesh, OvfData, Segment, read, write_csv, write_npy, write_npz, write_ovf};
use spinneb::geometry::Vector;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

/// Chains longer than this are read but not built: what memory they may take is checked before, and is legitimate.
const LONGEST_CHAIN: usize = 2000;

/// Words and numbers that have meant trouble somewhere.
const WORDS: &[&str] = &[
    "0",
    "-1",
    "1",
    "3",
    "1e18",
    "1000000000000000000",
    "18446744073709551615",
    "18446744073709551616",
    "1e308",
    "1e-308",
    "1e999",
    "-0.0",
    "0.1",
    "nan",
    "inf",
    "null",
    "true",
    "[]",
    "{}",
    "[[]]",
    "\"\"",
    "\"1e400 meV\"",
    "\"1 meV\"",
    "\"-1 T\"",
    "\u{feff}",
    "\r\n",
    "\n",
    "\0",
    "#",
    "##",
    ":",
    ",",
    ";",
    " ",
    "\t",
    "# End: Header\n",
    "# Begin: Segment\n",
    "(3, 3)",
    "(0, 3)",
    "'<f8'",
    "'|O'",
    "True",
    "image,site,m_x,m_y,m_z\n",
    "{\"file\": {\"path\": \"m.ovf\"}}",
    "µ",
    "\u{10ffff}",
];

/// What is mutated: texts of configs and of materials, and files with their names.
pub struct Corpus {
    configs: Vec<Vec<u8>>,
    /// Those that are right as they are.
    trees: Vec<Value>,
    /// Every value that stands anywhere in the trees.
    values: Vec<Value>,
    files: Vec<(&'static str, Vec<u8>)>,
    config: PathBuf,
}

/// Which inputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Configs,
    Files,
}

impl Corpus {
    /// The shipped and the bad configs, files of every format, and in `folder` what configs name.
    pub fn new(folder: &Path) -> Corpus {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let files = files();
        for (name, bytes) in &files {
            fs::write(folder.join(name), bytes).expect("a folder to write in");
        }
        fs::create_dir(folder.join("materials")).expect("a folder to write in");
        fs::copy(root.join("configs/materials/toy.json"), folder.join("materials/toy.json")).expect("the material");
        let mut paths: Vec<PathBuf> = ["configs", "tests/configs/bad"]
            .iter()
            .flat_map(|f| fs::read_dir(root.join(f)).expect("configs").map(|e| e.expect("an entry").path()))
            .filter(|p| p.extension().is_some_and(|e| e == "json"))
            .collect();
        // those in tests/configs/bad are wrong in one thing each: values to graft from
        paths.sort_by_key(|p| (p.ancestors().any(|f| f.ends_with("bad")), p.clone()));
        let good = paths.iter().filter(|p| !p.ancestors().any(|f| f.ends_with("bad"))).count();
        let mut configs: Vec<Vec<u8>> = paths.iter().map(|p| fs::read(p).expect("a config")).collect();
        configs.insert(good, WITH_FILES.as_bytes().to_vec());
        let mut trees: Vec<Value> = configs.iter().filter_map(|c| serde_json::from_slice(c).ok()).collect();
        let mut values: Vec<Value> = WORDS.iter().filter_map(|w| serde_json::from_str(w).ok()).collect();
        trees.iter().for_each(|tree| collect(tree, &mut values));
        trees.truncate(good + 1);
        Corpus { configs, trees, values, files, config: folder.join("fuzz.json") }
    }

    /// Case `number` of a seed: whether it was read and not refused, or what went wrong.
    pub fn run(&self, kind: Kind, seed: u64, number: u64) -> Result<bool, String> {
        let mut r = ChaCha8Rng::seed_from_u64(seed);
        r.set_stream(2 * number + u64::from(kind == Kind::Files));
        let outcome = match kind {
            Kind::Configs => {
                let text = match r.random() {
                    true => mutated(&self.configs, &mut r),
                    false => self.grafted(&mut r).to_string().into_bytes(),
                };
                catch_unwind(AssertUnwindSafe(|| self.config(text)))
            }
            Kind::Files => {
                let (name, bytes, truth) = self.file(&mut r);
                let shown = || {
                    String::from_utf8_lossy(&bytes).chars().take(2000).flat_map(char::escape_debug).collect::<String>()
                };
                let outcome = catch_unwind(AssertUnwindSafe(|| compared(name, &bytes, truth)));
                outcome.map(|done| done.map_err(|what| format!("{what}; {name} is {}", shown())))
            }
        };
        match outcome {
            Ok(done) => done,
            Err(panic) => Err(panic
                .downcast_ref::<String>()
                .map(String::as_str)
                .or(panic.downcast_ref::<&str>().copied())
                .unwrap_or("a panic")
                .to_string()),
        }
    }

    /// A file as some program writes it, with what stands in it, or a mutated one.
    fn file(&self, r: &mut ChaCha8Rng) -> (&'static str, Vec<u8>, Option<Vectors>) {
        match r.random_range(0..4) {
            0 => {
                let (name, bytes, vectors) = writer::file(r);
                (name, bytes, Some(vectors))
            }
            1 => {
                let (name, bytes, _) = writer::file(r);
                (name, mutated(&[bytes], r), None)
            }
            _ => {
                let name = self.files[r.random_range(0..self.files.len())].0;
                let corpus: Vec<&[u8]> = self.files.iter().map(|(_, bytes)| &bytes[..]).collect();
                (name, mutated(&corpus, r), None)
            }
        }
    }

    /// A config in which one to three values gave way to others, came or went.
    fn grafted(&self, r: &mut ChaCha8Rng) -> Value {
        let mut tree = self.trees[r.random_range(0..self.trees.len())].clone();
        for _ in 0..r.random_range(1..=3) {
            let mut node = &mut tree;
            // down to some value, not too often the whole
            loop {
                let stop = r.random_range(0..4) == 0;
                let count = match &*node {
                    Value::Object(members) => members.len(),
                    Value::Array(values) => values.len(),
                    _ => 0,
                };
                if count == 0 || stop {
                    break;
                }
                let k = r.random_range(0..count);
                node = match node {
                    Value::Object(members) => members.values_mut().nth(k).expect("a member"),
                    Value::Array(values) => &mut values[k],
                    _ => break,
                };
            }
            let other = self.values[r.random_range(0..self.values.len())].clone();
            match node {
                Value::Array(values) if r.random() => values.push(other),
                Value::Array(values) if r.random() => drop(values.pop()),
                Value::Object(members) if r.random() => {
                    let from = self.trees[r.random_range(0..self.trees.len())].as_object();
                    members.extend(from.into_iter().flatten().take(8).map(|(k, v)| (k.clone(), v.clone())).last());
                }
                Value::Number(n) if r.random() => {
                    let x = n.as_f64().unwrap_or(1.0) * [0.0, 0.5, -1.0, 2.0, 1e3, 1e9, 1e300][r.random_range(0..7)];
                    *node = if x.abs() < 1e15 && x.fract() == 0.0 { Value::from(x as i64) } else { Value::from(x) };
                }
                _ => *node = other,
            }
        }
        tree
    }

    fn config(&self, text: Vec<u8>) -> Result<bool, String> {
        let file = self.config.display().to_string();
        let folder = self.config.parent().map(|p| p.display().to_string()).unwrap_or_default();
        let named = |e: spinneb::error::Error| {
            let said = e.to_string();
            // without a place there is no help
            if said.contains(&folder) || said.starts_with("library material ") {
                Ok(false)
            } else {
                Err(format!("no file in {said:?}"))
            }
        };
        let text = match spinneb::config::text::decode(&file, text) {
            Ok(text) => text,
            Err(e) => return named(e),
        };
        match load_text(&self.config, text) {
            Err(e) => named(e),
            Ok(loaded) if loaded.lattice.sites > LONGEST_CHAIN => Ok(false),
            Ok(loaded) => loaded.problem().map_or_else(named, |_| Ok(true)),
        }
    }
}

/// Reads a file with the program's reader and with another one: the same directions, those that are known to stand in it, or none.
fn compared(name: &str, bytes: &[u8], truth: Option<Vectors>) -> Result<bool, String> {
    let other = reader::read(name, bytes);
    let found = match read(name, bytes) {
        Err(e) if !e.to_string().starts_with(name) => return Err(format!("no file in {e}")),
        Err(e) => Err(e.to_string()),
        Ok(found) => Ok(found.images),
    };
    match (found, other, truth) {
        (_, other, Some(truth)) if other.as_ref() != Some(&truth) => {
            Err("the other reader does not read what was written".into())
        }
        (Ok(images), Some(other), _) => same(&images, &other).map(|()| true),
        (Err(_), None, _) => Ok(false),
        // an archive may be damaged where the spins are not: their check value is compared by both
        (found, _, _) if bytes.starts_with(b"PK") => Ok(found.is_ok()),
        (Ok(_), None, _) => Err("a file that the other reader refuses is read".into()),
        (Err(e), Some(_), _) => Err(format!("a file that the other reader reads is refused: {e}")),
    }
}

/// Unit vectors along the others.
fn same(images: &[Vec<Vector>], other: &Vectors) -> Result<(), String> {
    let lengths = |n: usize, m: usize| if n == m { Ok(()) } else { Err(format!("{n} instead of {m}")) };
    lengths(images.len(), other.len()).map_err(|e| format!("{e} images"))?;
    for (k, (image, other)) in images.iter().zip(other).enumerate() {
        lengths(image.len(), other.len()).map_err(|e| format!("image {k}: {e} sites"))?;
        for (i, (m, v)) in image.iter().zip(other).enumerate() {
            let largest = v.iter().fold(0.0, |l: f64, x| l.max(x.abs()));
            if largest == 0.0 && *m == [0.0; 3] {
                continue;
            }
            let v = v.map(|x| x / largest);
            let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
            let agree = |c: usize| (m[c] - v[c] / length).abs() <= 4e-15;
            if !(0..3).all(agree) {
                return Err(format!("image {k}, site {i}: {m:?} instead of {v:?}"));
            }
        }
    }
    Ok(())
}

/// A value and all values in it.
fn collect(value: &Value, found: &mut Vec<Value>) {
    found.push(value.clone());
    match value {
        Value::Object(members) => members.values().for_each(|v| collect(v, found)),
        Value::Array(values) => values.iter().for_each(|v| collect(v, found)),
        _ => {}
    }
}

const WITH_FILES: &str = r#"{
  "material": "materials/toy.json",
  "lattice": {"chain": {"sites": 5, "frozen": [{"sites": [0]}]}},
  "initial": {"file": {"path": "text.ovf", "segment": 0}},
  "final": {"file": {"path": "spins.npz", "segment": -1, "staggered": true}},
  "path": {"images": 5, "guess": {"waypoints": {"states": [{"file": {"path": "binary8.ovf", "segment": 1}}]}}},
  "output": {"formats": ["csv", "npz", "ovf", "vtk"], "plots": []}
}"#;

/// A file of every format and representation.
fn files() -> Vec<(&'static str, Vec<u8>)> {
    let images: Vec<Vec<Vector>> = (0..3)
        .map(|k| (0..5).map(|i| if (i + k) % 2 == 0 { [0.0, 0.6, 0.8] } else { [0.28, 0.0, -0.96] }).collect())
        .collect();
    let segments: Vec<Segment> = images.iter().map(|spins| Segment { description: "fuzz", spins }).collect();
    let mesh = Mesh::Cells { base: [5e-10; 3], step: [1e-9; 3], nodes: [5, 1, 1], unit: "m" };
    let ovf = |data| write_ovf(data, &mesh, &segments);
    let array = Array { shape: vec![3, 5, 3], numbers: images.iter().flatten().flatten().copied().collect() };
    let arrays = [
        ("spins".to_string(), array.clone()),
        ("energy_meV".to_string(), Array { shape: vec![1], numbers: vec![0.5] }),
    ];
    let packed = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/compressed.npz");
    vec![
        ("text.ovf", ovf(OvfData::Text)),
        ("binary4.ovf", ovf(OvfData::Binary4)),
        ("binary8.ovf", ovf(OvfData::Binary8)),
        ("spins.csv", write_csv(images.iter().map(Vec::as_slice))),
        ("plain.csv", b"0 0 1\n0 1 0\n0.6 0.8 0\n".to_vec()),
        ("spins.npy", write_npy(&array)),
        ("spins.npz", write_npz(&arrays).expect("an archive")),
        ("packed.npz", fs::read(packed).expect("an archive")),
    ]
}

/// One of the corpus with one to six things changed.
fn mutated<B: AsRef<[u8]>>(corpus: &[B], r: &mut ChaCha8Rng) -> Vec<u8> {
    let mut bytes = corpus[r.random_range(0..corpus.len())].as_ref().to_vec();
    for _ in 0..r.random_range(1..=6) {
        let length = bytes.len();
        let at = r.random_range(0..=length);
        let end = (at + r.random_range(0..=24)).min(length);
        match r.random_range(0..9) {
            0 if at < length => bytes[at] ^= 1 << r.random_range(0..8),
            1 if at < length => bytes[at] = r.random(),
            2 => drop(bytes.drain(at..end)),
            3 => bytes.truncate(at),
            4 => {
                let copy = bytes[at..end].to_vec();
                let to = r.random_range(0..=length);
                bytes.splice(to..to, copy);
            }
            5 => {
                let other = corpus[r.random_range(0..corpus.len())].as_ref();
                let from = r.random_range(0..=other.len());
                let to = (from + r.random_range(0..=200)).min(other.len());
                bytes.splice(at..end, other[from..to].iter().copied());
            }
            6 => {
                let word = WORDS[r.random_range(0..WORDS.len())];
                bytes.splice(at..at, word.bytes());
            }
            _ => {
                // a whole word gives way to another
                let within = |b: &u8| b.is_ascii_alphanumeric() || matches!(b, b'.' | b'-' | b'"' | b'_');
                let start = bytes[..at].iter().rposition(|b| !within(b)).map_or(0, |k| k + 1);
                let stop = bytes[at..].iter().position(|b| !within(b)).map_or(length, |k| at + k);
                let word = WORDS[r.random_range(0..WORDS.len())];
                bytes.splice(start..stop, word.bytes());
            }
        }
    }
    bytes
}
