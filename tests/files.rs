//! Files of spins: read back as written, refused where they are damaged, understood as other programs write them.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use spinneb::files::{self, Array, Images, Mesh, OvfData, Segment, read, write_csv, write_npy, write_npz, write_ovf};
use spinneb::geometry::{Direction, Vector, vector};
use spinneb::lattice::{Chain, MAX_SITES};
use spinneb::path::Path;
use spinneb::path::guess::{FirstGuess, GuessContext, PathFile};
use spinneb::spins::Spins;
use spinneb::state::{StateBuilder, StateContext, StateSpec};
use std::fmt::Write;
use std::fs;

/// Unit vectors in all directions, image after image.
fn images(count: usize, sites: usize, seed: u64) -> Vec<Vec<Vector>> {
    let mut r = ChaCha8Rng::seed_from_u64(seed);
    let mut one = || vector::unit([0; 3].map(|_| r.random_range(-1.0..1.0))).unwrap();
    (0..count).map(|_| (0..sites).map(|_| one()).collect()).collect()
}

fn ovf(data: OvfData, images: &[Vec<Vector>]) -> Vec<u8> {
    let segments: Vec<Segment> = images.iter().map(|spins| Segment { description: "m: test", spins }).collect();
    let nodes = [images[0].len(), 1, 1];
    let mesh = Mesh::Cells { base: [1.25e-10, 0.0, 0.0], step: [2.5e-10, 1e-9, 1e-9], nodes, unit: "m" };
    write_ovf(data, &mesh, &segments)
}

fn array(images: &[Vec<Vector>]) -> Array {
    Array {
        shape: vec![images.len(), images[0].len(), 3],
        numbers: images.iter().flatten().flatten().copied().collect(),
    }
}

fn npz(images: &[Vec<Vector>]) -> Vec<u8> {
    let energies = Array { shape: vec![2], numbers: vec![1.0, 2.0] };
    write_npz(&[("spins".into(), array(images)), ("energy_meV".into(), energies)]).unwrap()
}

/// Every format that is both written and read: name of a file, its bytes, whether it keeps double precision.
fn written(images: &[Vec<Vector>]) -> Vec<(&'static str, Vec<u8>, bool)> {
    vec![
        ("text.ovf", ovf(OvfData::Text, images), true),
        ("binary8.ovf", ovf(OvfData::Binary8, images), true),
        ("binary4.ovf", ovf(OvfData::Binary4, images), false),
        ("spins.npz", npz(images), true),
        ("spins.npy", write_npy(&array(images)), true),
        ("spins.csv", write_csv(images.iter().map(Vec::as_slice)), true),
    ]
}

fn refused(file: &str, bytes: &[u8]) -> String {
    match read(file, bytes) {
        Err(e) => e.to_string(),
        Ok(found) => panic!("{file}: {} images were read", found.images.len()),
    }
}

#[test]
fn what_is_written_is_read_back_exactly_or_to_the_precision_of_the_format() {
    for (count, sites) in [(1, 1), (1, 50), (20, 7), (3, 1000)] {
        let given = images(count, sites, 1);
        for (file, bytes, exact) in written(&given) {
            let Images { images: found, warnings, .. } = read(file, &bytes).unwrap();
            assert_eq!((found.len(), found[0].len(), warnings.len()), (count, sites, 0), "{file}");
            if exact {
                assert_eq!(found, given, "{file}");
            }
            for (a, b) in found.iter().flatten().zip(given.iter().flatten()) {
                assert!(vector::norm(vector::sub(*a, *b)) <= f64::from(f32::EPSILON), "{file}: {a:?}, {b:?}");
            }
        }
    }
}

#[test]
fn reading_what_was_read_changes_nothing() {
    let long: Vec<Vector> = images(1, 200, 3).remove(0).iter().map(|v| vector::scale(1.7, *v)).collect();
    let once = read("m.npy", &write_npy(&array(&[long]))).unwrap().images;
    let twice = read("m.npy", &write_npy(&array(&once))).unwrap().images;
    assert_eq!(once, twice);
}

#[test]
fn a_file_cut_short_anywhere_is_refused_with_its_name_and_a_reason() {
    let given = images(3, 40, 2);
    let mut r = ChaCha8Rng::seed_from_u64(4);
    for (file, bytes, _) in written(&given) {
        // what a text ends with may be missing: its last line feed, unless a number stands before it
        let needed = if file.ends_with("ovf") { bytes.trim_ascii_end().len() } else { bytes.len() };
        let header = bytes.windows(8).position(|w| w == b"# End: H").unwrap_or(200) + 40;
        let ends = (0..header.min(needed)).chain(needed.saturating_sub(300)..needed);
        let random: Vec<usize> = (0..100).map(|_| r.random_range(header..needed)).collect();
        for cut in ends.chain(random) {
            let said = refused(file, &bytes[..cut]);
            assert!(said.starts_with(&format!("{file}: ")) && said.len() > file.len() + 12, "{cut}: {said}");
        }
    }
}

#[test]
fn errors_name_the_place() {
    let given = images(3, 5, 5);
    let text = String::from_utf8(ovf(OvfData::Text, &given)).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let node = lines.iter().position(|l| *l == "# Begin: Data Text").unwrap() + 2;
    let with = |line: usize, new: &str| {
        let mut lines = lines.clone();
        lines[line] = new;
        refused("m.ovf", (lines.join("\n") + "\n").as_bytes())
    };
    let line = node + 1;
    assert_eq!(
        with(node, "0 0 nan"),
        format!("m.ovf: line {line}: segment 0, node 1: the z component is NaN, which is no direction")
    );
    assert!(with(node, "0 0 0").contains(&format!("line {line}: segment 0, node 1: the vector is zero")));
    assert!(with(node, "0 0 x").contains(&format!("line {line}: segment 0: found \"x\", expected a number")));
    assert!(with(node, "0 0").contains("found 14 numbers, but 5 nodes have 3 each"));
    assert!(with(1, "# Segment count: 4").contains("after 3 of its 4 segments"));
    assert!(with(0, "# OOMMF: rectangular mesh v1.0").contains("OVF 1.0"));

    let mut bytes = ovf(OvfData::Binary8, &given);
    let data = bytes.windows(8).position(|w| w == b"Binary 8").unwrap() + 9;
    bytes[data + 3] ^= 1;
    assert!(refused("m.ovf", &bytes).contains(&format!("byte {data}: segment 0: the check value is ")));
    bytes[data + 3] ^= 1;
    bytes[data + 8 + 24 + 7] = 0x7f;
    bytes[data + 8 + 24 + 6] = 0xf0;
    bytes[data + 8 + 24..data + 8 + 24 + 6].fill(0);
    let said = refused("m.ovf", &bytes);
    assert_eq!(
        said,
        format!("m.ovf: byte {}: segment 0, node 1: the x component is inf, which is no direction", data + 32)
    );

    let mut npz = npz(&given);
    let at = npz.len() / 3;
    npz[at] ^= 1;
    assert!(refused("m.npz", &npz).contains("hecksum"), "{}", refused("m.npz", &npz));
    assert!(refused("m.csv", b"m_x,m_y,m_z\n0,0,1\n0,1\n").contains("line 3: found 2 columns, expected 3"));
    assert!(refused("m.csv", b"0,0,1\n0,0,0.9").contains("line 2: the last line has no end"));
    assert!(refused("m.csv", b"a,b\n1,2\n").contains("line 1: found the columns \"a\", \"b\""));
    let out_of_order = b"image,site,mx,my,mz\n0,0,0,0,1\n0,2,0,0,1\n";
    assert!(refused("m.csv", out_of_order).contains("line 3: found site 2, expected 1"));
    assert!(refused("m.csv", b"image,mx,my,mz\n0,0,0,1\n2,0,0,1\n").contains("line 3: image 2 follows image 0"));
    assert!(refused("m.csv", b"image,mx,my,mz\n0,0,0,1\n1,0,0,1\n1,0,0,1\n").contains("image 1 has 2 sites"));
    assert!(refused("m.bin", &[0, 1, 2, 3]).contains("neither a text nor"));
    assert!(refused("m.npy", &write_npy(&Array { shape: vec![3, 4], numbers: vec![0.5; 12] })).contains("transposed"));
}

#[test]
fn absurd_sizes_are_refused_before_anything_is_allocated() {
    let header = |x: &str, y: &str| {
        format!(
            "# OOMMF OVF 2.0\n# Segment count: 1\n# Begin: Segment\n# Begin: Header\n# meshtype: rectangular\n# xnodes: {x}\n\
             # ynodes: {y}\n# znodes: 1\n# valuedim: 3\n# End: Header\n# Begin: Data Binary 8\n"
        )
    };
    for (x, y) in
        [("1000000000000000000", "1"), ("99999999999999999999999", "1"), ("100000001", "1"), ("10000", "100000")]
    {
        assert!(refused("m.ovf", header(x, y).as_bytes()).contains("m.ovf: line "), "{x}");
    }
    assert!(refused("m.ovf", header("100000000", "1").as_bytes()).contains("2400000008 bytes"));
    let npy = |shape: &str| {
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}}}\n");
        bytes.extend_from_slice(&(header.len() as u16).to_le_bytes());
        bytes.extend_from_slice(header.as_bytes());
        bytes
    };
    for shape in ["(1000000000000000000, 3)", "(99999999999999999999999, 3)", "(1000000000, 1000000000, 3)", "(0, 3)"] {
        assert!(refused("m.npy", &npy(shape)).contains("m.npy: "), "{shape}");
    }
    let images = format!("(18446744073709551615, {MAX_SITES}, 3)");
    assert!(refused("m.npy", &npy(&images)).contains("more than there can be"));
    // of the length of "False,"
    let garbled = String::from_utf8_lossy(&npy("(2, 3)")[10..]).replace("False,", "Trues ").into_bytes();
    let garbled = [&npy("(2, 3)")[..10], &garbled].concat();
    assert!(refused("m.npy", &garbled).contains("fortran_order is True or False"));
}

#[test]
fn other_dialects_of_ovf_are_understood() {
    let given = images(2, 3, 6);
    let rows = |image: &[Vector]| {
        image.iter().fold(String::new(), |mut text, [x, y, z]| {
            writeln!(text, "  {x:?}\t{y:?}   {z:?} ").unwrap();
            text
        })
    };
    // OOMMF and Spirit: comments, padded counts, other cases of keys, descriptions of several lines, no labels or units
    let loose = format!(
        "#   oommf   OVF 2.0\r\n#\n## a comment\n# segment COUNT: 000002\n#\n#Begin: segment\n#BEGIN:HEADER\n\
         # Title: spins\n# Desc: first line: with a colon\n#   a second line\n# MeshType:  Rectangular ## comment\n\
         # XNODES:3\n#YNodes : 1\n# znodes: 1\n# valueDim: 3\n# End: header\n# begin: data TEXT\n{}# End: Data Text\n\
         # End: Segment\n\n# Begin: Segment\n# Begin: Header\n# meshtype: irregular\n# pointcount: 3\n# End: Header\n\
         # Begin: Data CSV\n{}# End: Data CSV\n# End: Segment",
        rows(&given[0]),
        rows(&given[1]).replace('\t', ", ")
    );
    assert_eq!(read("m.ovf", loose.as_bytes()).unwrap().images, given);

    // positions before the vectors on an irregular mesh, as the format has it
    let placed: String =
        given[0].iter().enumerate().map(|(i, [x, y, z])| format!("{i} 0 0 {x:?} {y:?} {z:?}\n")).collect();
    let irregular = format!(
        "# OOMMF OVF 2.0\n# Segment count: 1\n# Begin: Segment\n# Begin: Header\n# meshtype: irregular\n# pointcount: 3\n\
         # valuedim: 3\n# End: Header\n# Begin: Data Text\n{placed}# End: Data Text\n# End: Segment\n"
    );
    assert_eq!(read("m.ovf", irregular.as_bytes()).unwrap().images, given[..1]);

    // mumax: binary 4 without a line feed behind the data; and numbers of the other byte order
    let mut binary =
        b"# OOMMF OVF 2.0\n# Segment count: 1\n# Begin: Segment\n# Begin: Header\n# meshtype: rectangular\n\
        # xnodes: 1\n# ynodes: 3\n# znodes: 1\n# valuedim: 3\n# End: Header\n# Begin: Data Binary 4\n"
            .to_vec();
    binary.extend_from_slice(&1234567.0f32.to_be_bytes());
    binary.extend(given[0].iter().flatten().flat_map(|x| (*x as f32).to_be_bytes()));
    binary.extend_from_slice(b"# End: Data Binary 4\n# End: Segment\n");
    let found = read("m.omf", &binary).unwrap().images.remove(0);
    for (a, b) in found.iter().zip(&given[0]) {
        assert!(vector::norm(vector::sub(*a, *b)) <= f64::from(f32::EPSILON));
    }
}

#[test]
fn tables_and_arrays_of_other_programs_are_understood() {
    let single: [Vec<Vector>; 1] = [vec![[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]];
    for text in [
        "0 0 1\n1 0 0\n",
        "# mx my mz\n0.0e+00 0.0e+00 1.0e+00\n1.0D+00 0 0\n",
        "\u{feff}Mx;My;Mz\r\n0;0;1\r\n1;0;0\r\n",
        "i,x_nm,y_nm,m_z,m_y,m_x\n1,0,0,1,0,0\n2,0,0,0,0,1\n",
        "\"m_x\"\t\"m_y\"\t\"m_z\"\n0\t0\t1\n\n1\t0\t0\n",
    ] {
        assert_eq!(read("m.csv", text.as_bytes()).unwrap().images, single, "{text:?}");
    }
    let npy = |descr: &str, fortran: &str, shape: &str, data: &[u8]| {
        let header = format!("{{\"shape\": {shape}, \"fortran_order\": {fortran}, \"descr\": \"{descr}\"}}\n");
        let mut bytes = b"\x93NUMPY\x02\x00".to_vec();
        bytes.extend_from_slice(&(header.len() as u32).to_le_bytes());
        bytes.extend_from_slice(header.as_bytes());
        bytes.extend_from_slice(data);
        read("m.npy", &bytes).unwrap().images
    };
    assert_eq!(npy("|i1", "False", "(2, 3)", &[0, 0, 1, 1, 0, 0]), single);
    assert_eq!(npy("|i1", "True", "(2L, 3L)", &[0, 1, 0, 0, 1, 0]), single);
    assert_eq!(npy(">i2", "False", "(1, 2, 1, 1, 3)", &[0, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0]), single);
    // a mesh of 2 × 1 × 2 nodes: x first where sites are counted, last among NumPy's nodes
    let corners = [[1, 0, 0], [0, 0, 1], [0, 1, 0], [0, 0, 0]];
    let (rows, columns): (Vec<u8>, Vec<u8>) =
        (corners.concat(), (0..12).map(|e| corners[2 * (e % 2) + e / 2 % 2][e / 4]).collect());
    for (fortran, bytes) in [("False", rows), ("True", columns)] {
        let [image] = &npy("|i1", fortran, "(2, 1, 2, 3)", &bytes)[..] else { panic!("one image") };
        assert_eq!(image[..], [0, 2, 1, 3].map(|k| corners[k].map(f64::from)), "{fortran}");
    }
    let deflated =
        fs::read(std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/compressed.npz")).unwrap();
    assert_eq!(read("compressed.npz", &deflated).unwrap().images, [&single[..], &single[..]].concat());
}

#[test]
fn vectors_of_other_length_are_normalised_and_the_worst_is_named() {
    let read = |text: &str| read("m.csv", text.as_bytes()).unwrap();
    let found = read("0 0 1\n0 2 0\n0.5 0 0\n0 0 1.001\n");
    assert_eq!(found.images[0], [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
    let [warning] = &found.warnings[..] else { panic!("{:?}", found.warnings) };
    assert!(warning.contains("3 of 4 vectors") && warning.contains("the worst is 2 long, line 2"), "{warning}");
    let magnetisation = read("0 0 8e5\n0 8e5 0\n").warnings;
    assert_eq!(magnetisation, ["m.csv: all vectors are 800000 long instead of 1: only their directions are used"]);
    assert_eq!(read("0 0 1.000001\n").warnings, Vec::<String>::new());
    let tiny = read("0 0 1e-300\n0 -1e300 0\n");
    assert_eq!(tiny.images[0], [[0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]);
}

#[test]
fn an_image_is_chosen_by_its_number_from_either_end() {
    let folder = tempfile::tempdir().unwrap();
    let given = images(4, 6, 7);
    fs::write(folder.path().join("m.ovf"), ovf(OvfData::Text, &given)).unwrap();
    let state = |json: &str| {
        let mut spec: StateSpec = serde_json::from_str(json).unwrap();
        let StateSpec::File(file) = &mut spec else { panic!("{json}") };
        let chain = Chain::open(6).resolve().unwrap();
        file.load(folder.path(), Some(&chain))?;
        file.vectors(&StateContext::new(&chain, 1.0))
    };
    assert_eq!(state(r#"{"file": {"path": "m.ovf", "segment": 2}}"#).unwrap(), given[2]);
    assert_eq!(state(r#"{"file": {"path": "m.ovf", "segment": -1}}"#).unwrap(), given[3]);
    let said = |json: &str| state(json).unwrap_err().to_string();
    assert!(said(r#"{"file": {"path": "m.ovf"}}"#).contains("holds 4 images: say which one with \"segment\", 0 to 3"));
    assert!(said(r#"{"file": {"path": "m.ovf", "segment": 4}}"#).contains("found 4, but"));
    assert!(said(r#"{"file": {"path": "m.ovf", "segment": -9223372036854775808}}"#).contains("holds images 0 to 3"));
    assert!(said(r#"{"file": {"path": "n.ovf"}}"#).contains("there is no file"));
    assert!(said(r#"{"file": {"path": "m.ovf", "segment": 0, "sha256": "00"}}"#).contains("not the one"));
}

#[test]
fn a_path_from_a_file_is_taken_as_it_is_or_spaced_evenly_along_it() {
    let given = images(5, 6, 8);
    let bytes = npz(&given);
    let stored = files::Stored { file: "p.npz".into(), content: read("p.npz", &bytes).unwrap() };
    let guess = PathFile { path: "p.npz".into(), sha256: None, stored: Some(stored.into()) };
    let ends = [0, 4].map(|k| Spins::from_vectors(&given[k]).unwrap());
    let chain = Chain::open(6).resolve().unwrap();
    let states = StateContext::new(&chain, 1.0);
    let context = GuessContext { states, default_axis: Direction::X };
    let path = |images| guess.path(&ends[0], &ends[1], images, &context).unwrap();
    let all: Vec<Spins> = given.iter().map(|image| Spins::from_vectors(image).unwrap()).collect();
    assert_eq!(path(5), Path::new(&all));
    let fine = path(401);
    assert_eq!((fine.spins(0), fine.spins(400)), (ends[0].clone(), ends[1].clone()));
    for image in &all {
        let nearest = (0..401).map(|k| spinneb::path::distance(fine.image(k), image.as_slice())).fold(9.0, f64::min);
        assert!(nearest < 0.6 * fine.length() / 400.0, "{nearest}");
    }
    let chain = Chain::open(7).resolve().unwrap();
    let (other, states) = (Spins::uniform(7, Direction::Z), StateContext::new(&chain, 1.0));
    let said = guess.path(&other, &other, 5, &GuessContext { states, ..context }).unwrap_err().to_string();
    assert!(said.contains("p.npz has 6 spins, but the chain has 7 sites"), "{said}");
}
