//! `spinneb import`: the Hamiltonians of other codes' files, against closed forms and sums over bonds written out here.

use crate::conventions::{V, cross, dot, random};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use spinneb::config::{Source, load_text};
use spinneb::drive::Problem;
use spinneb::import::{FORMATS, Model, Spiral, Told};
use spinneb::units::{MU_B_MEV_PER_T, RYDBERG};
use std::f64::consts::TAU;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// Names and texts.
type Files = Vec<(&'static str, String)>;

const MRY: f64 = 1e-3 * RYDBERG;
/// Of the ladder of two kinds of atoms, A at 0 and B at ½: from A to B, from B to the next A, from A to the next A (meV).
const J: [f64; 3] = [31.0, -7.5, 2.25];
const D: [V; 3] = [[0.5, -1.25, 0.75], [0.0, 2.0, -0.5], [0.0; 3]];
/// Easy axis of A and hard one of B (meV).
const K: [f64; 2] = [0.75, -0.5];
const AXIS: V = [0.6, 0.0, 0.8];
const MOMENTS: [f64; 2] = [2.5, 1.5];
const CELLS: usize = 6;

/// Files in a folder of their own.
fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    files.iter().for_each(|(name, text)| fs::write(folder.path().join(name), text).unwrap());
    folder
}

fn read(format: &str, paths: &[PathBuf], convention: &str) -> Result<Model, String> {
    let format = FORMATS.iter().find(|f| f.name == format).unwrap();
    let told = if convention.is_empty() { Ok(Told::default()) } else { Told::parse(convention) };
    let model = told.and_then(|told| (format.read)(paths, told));
    model.map_err(|e| e.to_string())
}

fn model(format: &str, files: &[(&str, &str)], convention: &str) -> Model {
    let folder = folder(files);
    let named = |name: &str| folder.path().join(name);
    let paths = if format == "vampire" { vec![named("input")] } else { vec![named(files[0].0)] };
    read(format, &paths, convention).unwrap().in_its_box().unwrap()
}

/// The config of a model, completed with two ends.
fn problem(model: &Model, initial: &[V]) -> Problem {
    let ends =
        [format!("initial={{\"vectors\": {initial:?}}}"), r#"final={"uniform": {"direction": [0, 0, 1]}}"#.into()];
    Source::text(Path::new("imported.json"), model.config()).set(&ends).unwrap().load().unwrap().problem().unwrap()
}

fn energy(model: &Model, m: &[V]) -> f64 {
    let problem = problem(model, m);
    problem.hamiltonian.energy_mev(problem.initial.as_slice())
}

fn close(a: f64, b: f64) {
    assert!((a - b).abs() < 1e-9 * (1.0 + a.abs().max(b.abs())), "{a} {b}");
}

/// The ladder's energy, by its definition; sites count with the cells fastest.
fn ladder_energy(m: &[V], field: f64) -> f64 {
    let (a, b) = (|n: usize| m[n % CELLS], |n: usize| m[CELLS + n % CELLS]);
    let bond = |k: usize, i: V, j: V| -J[k] * dot(i, j) + dot(D[k], cross(i, j));
    let own = |k: usize, m: V| -K[k] * dot(m, AXIS).powi(2) - MU_B_MEV_PER_T * MOMENTS[k] * field * m[2];
    let cell = |n: usize| {
        bond(0, a(n), b(n)) + bond(1, b(n), a(n + 1)) + bond(2, a(n), a(n + 1)) + own(0, a(n)) + own(1, b(n))
    };
    (0..CELLS).map(cell).sum()
}

/// From, to, cells on, of the ladder's bonds.
const BONDS: [(usize, usize, isize); 3] = [(0, 1, 0), (1, 0, 1), (0, 0, 1)];

/// All bonds in both directions: from, to, cells on, J, D.
fn both() -> Vec<(usize, usize, isize, f64, V)> {
    let one = |k: usize| {
        let (i, j, n) = BONDS[k];
        [(i, j, n, J[k], D[k]), (j, i, -n, J[k], D[k].map(|d| -d))]
    };
    (0..3).flat_map(one).collect()
}

fn uppasd(sign: f64) -> Files {
    let at = [0.0, 0.5];
    let row = |&(i, j, n, x, d): &(usize, usize, isize, f64, V), dmi: bool| {
        let along = n as f64 + at[j] - at[i];
        let d = d.map(|d| sign * d / (2.0 * MRY));
        let tail = if dmi { format!("{} {} {}", d[0], d[1], d[2]) } else { format!("{}", x / (2.0 * MRY)) };
        format!("{} {} {along} 0 0 {tail}\n", i + 1, j + 1)
    };
    let list = |dmi: bool| both().iter().map(|bond| row(bond, dmi)).collect::<String>();
    let input = format!(
        "simid ladder\n# nothing\nncell {CELLS} 1 1 size\nBC P 0 0 boundaries\ncell 1.0 0.0 0.0\n 0.0 1.5 0.0\n 0.0 0.0 2.0\n\
         posfile ./posfile\nmomfile ./momfile\nexchange ./jfile\ndm ./dmfile\nanisotropy ./kfile\nSym 0\nalat 3.0d-10\n\
         hfield 0.0 0.0 2.0\nmode M\n"
    );
    let k = |site: usize| format!("{} 1 {} 0.0 0.6 0.0 0.8 0.0\n", site + 1, -K[site] / MRY);
    vec![
        ("inpsd.dat", input),
        ("posfile", "1 1 0.0 0.0 0.0\n2 2 0.5 0.0 0.0\n".into()),
        ("momfile", "1 1 2.5 0 0 1\n2 1 1.5 0 0 1\n".into()),
        ("jfile", list(false)),
        ("dmfile", list(true)),
        ("kfile", k(0) + &k(1)),
    ]
}

fn spirit() -> Files {
    let row = |k: usize| {
        let ((i, j, n), d) = (BONDS[k], D[k].map(|d| -d));
        format!("{i} {j} {n} 0 0 {} {} {} {}\n", J[k], d[0], d[1], d[2])
    };
    let pairs: String = (0..3).map(row).collect();
    let input = format!(
        "### a ladder\nbravais_vectors\n3.0 0.0 0.0\n0.0 4.5 0.0\n0.0 0.0 6.0\nbasis\n2\n0 0 0\n0.5 0 0\nmu_s 2.5 1.5\n\
         n_basis_cells {CELLS} 1 1\nhamiltonian heisenberg_pairs\nboundary_conditions 1 0 0\nexternal_field_magnitude 2.0\n\
         external_field_normal 0 0 1\nn_anisotropy 2\ni K Kx Ky Kz\n0 {} 0.6 0 0.8\n1 {} 0.6 0 0.8\nddi_method none\n\
         n_interaction_pairs 3\ni j da db dc Jij Dijx Dijy Dijz\n{pairs}\nllg_dt 0.001\n",
        K[0], K[1]
    );
    vec![("ladder.cfg", input)]
}

fn vampire() -> Files {
    // −S_i T S_j with T = J − [D]×
    let joule = |x: f64| format!("{:e}", x * 1.602176634e-22);
    let row = |(id, &(i, j, n, x, [p, q, r])): (usize, &(usize, usize, isize, f64, V))| {
        let t = [x, -r, q, r, x, -p, -q, p, x].map(joule).join(" ");
        format!("{id} {i} {j} {n} 0 0 {t}\n")
    };
    let links: String = both().iter().enumerate().map(row).collect();
    let ucf = format!(
        "# Unit cell size\n3.0 4.5 6.0\n1 0 0\n0 1 0\n0 0 1\n# Atoms\n2 2\n0 0.0 0.0 0.0 0 0 0\n1 0.5 0.0 0.0 1 0 0\n\
         # Interactions\n6 tensorial\n{links}"
    );
    let material = |k: usize| {
        let n = k + 1;
        format!(
            "material[{n}]:material-name=kind{n}\nmaterial[{n}]:damping-constant=1.0\nmaterial[{n}]:atomic-spin-moment={} !muB\n\
             material[{n}]:uniaxial-anisotropy-constant={}\nmaterial[{n}]:uniaxial-anisotropy-direction=0.6,0,0.8\n",
            MOMENTS[k],
            joule(K[k])
        )
    };
    let input = "create:full\ncreate:periodic-boundaries-x\nmaterial:file=ladder.mat\nmaterial:unit-cell-file = \"ladder.ucf\"\n\
                 dimensions:system-size-x = 1.8 !nm\ndimensions:system-size-y = 4.5 !A\ndimensions:system-size-z = 0.5 !nm\n\
                 sim:applied-field-strength = 2.0 !T\nsim:applied-field-unit-vector = 0,0,1\nsim:temperature=0\n";
    let materials = format!("material:num-materials=2\n{}{}", material(0), material(1));
    vec![("input", input.into()), ("ladder.mat", materials), ("ladder.ucf", ucf)]
}

/// What `io_txt.py` and `io_exchange.py` of TB2J 0.9 write below "Information:".
const TB2J_INFORMATION: &str = "Executed:  \n/usr/bin/wann2J.py --posfile POSCAR --prefix_spinor Cell --elements Fe\n\
     Exchange parameters generated by TB2J 0.9.12.9\nGeneration time: 25/05/01 12:00:00\n Input from non-collinear Wannier90 data.\n\
     Tight binding data from ./.\nCell and Atoms from POSCAR.\nPrefix of wannier function files:Cell.\n\
     Warning: Please check if the noise level of Wannier function Hamiltonian to make sure it is much smaller than the exchange \
     values.\ne.g. if the spins are along z, the xz, yz, zz, zx, zy components and the z component of DMI.\n";

fn tb2j() -> Files {
    let (line, rule, names) = ("-".repeat(88), "=".repeat(90), ["Fe1", "Fe2"]);
    let row = |&(i, j, n, x, d): &(usize, usize, isize, f64, V)| {
        let d = d.map(|d| -0.5 * d);
        format!(
            "{line}\n   {} {} ({n:3},   0,   0) {}   ( 1.5,  0.0,  0.0)  1.5 \nJ_iso: {} \n[Testing!] DMI: ({} {} {})\n\
             [Testing!]J_ani:\n[[0. 0. 0.]\n [0. 0. 0.]\n [0. 0. 0.]]\n",
            names[i],
            names[j],
            0.5 * x,
            0.5 * x,
            d[0],
            d[1],
            d[2]
        )
    };
    let pairs: String = both().iter().map(row).collect();
    let text = format!(
        "{rule}\nInformation: \n{TB2J_INFORMATION}\n{rule}\nCell (Angstrom):\n3.0 0.0 0.0\n0.0 4.5 0.0\n0.0 0.0 6.0\n\n{rule}\n\
         Atoms:  \n(Note: charge and magmoms only count the wannier functions.)\nAtom_number x y z w_charge M(x) M(y) M(z)\n\
         O1  1.0 1.0 1.0  4.0  0.0 0.0 0.01\nFe1 0.0 0.0 0.0  6.0  0.0 1.5 2.0\nFe2 1.5 0.0 0.0  6.0  0.0 0.0 -1.5\n\
         Total  16.0 0.0 0.0 0.0\n\n{line}\nSingle Ion Anisotropy (meV): \n(k1 is the anisotropy constant, k1dir is the direction vector)\n\
         Atom number k1 k1dir\nFe1 {} (0.6, 0.0, 0.8)\nFe2 {} (0.6, 0.0, 0.8)\n\n{rule}\nExchange: \n    i     j  R  J_iso(meV)  vector  \
         distance(A) \n{pairs}",
        K[0], K[1]
    );
    vec![("exchange.out", text)]
}

fn borrowed<'a>(files: &'a [(&'static str, String)]) -> Vec<(&'static str, &'a str)> {
    files.iter().map(|(name, text)| (*name, text.as_str())).collect()
}

/// Each format's files of the ladder, with what has to be said of their convention and the field that is in them.
fn ladders() -> [(&'static str, Files, &'static str, f64); 4] {
    [
        ("uppasd", uppasd(-1.0), "-D", 2.0),
        ("spirit", spirit(), "", 2.0),
        ("vampire", vampire(), "", 2.0),
        ("tb2j", tb2j(), "", 0.0),
    ]
}

#[test]
fn one_ladder_in_the_files_of_four_codes_has_one_energy() {
    for (format, files, convention, field) in ladders() {
        let model = model(format, &borrowed(&files), convention).with_cells(Some([CELLS, 1, 1]));
        assert_eq!(model.bonds.len(), 3, "{format}");
        assert_eq!(model.atoms.len(), 2, "{format}");
        assert!((model.spacing_nm.unwrap() - 0.3).abs() < 1e-12, "{format}");
        assert_eq!(model.periodic, Some([true, false, false]), "{format}");
        for seed in 0..3 {
            let m = random(2 * CELLS, seed);
            let [found, expected] = [energy(&model, &m), ladder_energy(&m, field)];
            assert!((found - expected).abs() < 1e-8, "{format}: {found} {expected}");
        }
        // what is printed is what is there
        let up = vec![[0.0, 0.0, 1.0]; 2 * CELLS];
        close(model.ferromagnet_mev([0.0, 0.0, 1.0]).iter().sum(), ladder_energy(&up, field) / (2 * CELLS) as f64);
    }
}

#[test]
fn a_box_of_the_files_is_kept_and_one_is_made_where_there_is_none() {
    for (format, files, convention, _) in ladders() {
        let cells = model(format, &borrowed(&files), convention).cells;
        assert_eq!(cells, Some(if format == "tb2j" { [3, 1, 1] } else { [CELLS, 1, 1] }), "{format}");
    }
}

/// A chain along x with exchange to two neighbours and D along z, in UppASD's files; mRy.
fn chain(jfile: &str, dmfile: &str) -> Files {
    let dm = if dmfile.is_empty() { "" } else { "dm dmfile\n" };
    let input = format!(
        "ncell 12 1 1\nbc P 0 0\ncell 1 0 0 0 1 0 0 0 1\nposfile posfile\nmomfile momfile\nexchange jfile\n{dm}maptype 2\n"
    );
    vec![
        ("inpsd.dat", input),
        ("posfile", "1 1 0 0 0\n".into()),
        ("momfile", "1 1 2.0 0 0 1\n".into()),
        ("jfile", jfile.into()),
        ("dmfile", dmfile.into()),
    ]
}

const EXCHANGE: &str = "1 1 1 0 0 1.5\n1 1 -1 0 0 1.5\n1 1 2 0 0 -0.4\n1 1 -2 0 0 -0.4\n";
const DMI: &str = "1 1 1 0 0 0 0 0.3\n1 1 -1 0 0 0 0 -0.3\n";

/// A spiral of so many twelfths of a turn a site in the xy plane.
fn spiral(twelfths: f64) -> Vec<V> {
    (0..12).map(|n| (TAU * twelfths * f64::from(n) / 12.0).sin_cos()).map(|(sin, cos)| [cos, sin, 0.0]).collect()
}

#[test]
fn a_chain_has_the_energy_of_a_spiral_and_the_sign_of_d_that_is_asked_for() {
    for (convention, sign) in [("-D", -1.0), ("+D", 1.0)] {
        let model = model("uppasd", &borrowed(&chain(EXCHANGE, DMI)), convention);
        for twelfths in [0.0, 1.0, -1.0, 3.0, -5.0] {
            // − Σ_R J(R) cos q·R over both directions, and ± Σ_R D(R) sin q·R; m_n × m_n+1 = ẑ sin q
            let q = TAU * twelfths / 12.0;
            let expected = MRY * (-2.0 * 1.5 * q.cos() + 2.0 * 0.4 * (2.0 * q).cos() + sign * 2.0 * 0.3 * q.sin());
            close(energy(&model, &spiral(twelfths)) / 12.0, expected);
            let own = Spiral { q: [twelfths / 12.0, 0.0, 0.0], u: [1.0, 0.0, 0.0], v: [0.0, 1.0, 0.0] };
            close(model.spiral_mev(own).iter().sum(), expected);
        }
    }
}

#[test]
fn a_format_that_leaves_a_sign_open_asks_for_it() {
    let files = chain(EXCHANGE, DMI);
    let folder = folder(&borrowed(&files));
    let paths = [folder.path().join("inpsd.dat")];
    let said = read("uppasd", &paths, "").unwrap_err();
    assert!(said.contains("inpsd.dat:7:1: dm: the sign of D is open") && said.contains("--convention -D"), "{said}");
    assert!(read("uppasd", &paths, "-D").is_ok());
    let input = format!("{}anisotropy kfile\n", files[0].1);
    fs::write(folder.path().join("inpsd.dat"), input).unwrap();
    fs::write(folder.path().join("kfile"), "1 2 -0.02 0 0 0 1 0\n").unwrap();
    assert!(
        read("uppasd", &paths, "-D").unwrap_err().contains("kfile:1:3: kind: the sign of the cubic anisotropy is open")
    );
    let cubic = read("uppasd", &paths, "-D -K").unwrap().in_its_box().unwrap();
    let [axis, diagonal] = [[0.0, 0.0, 1.0], [0.5f64.sqrt(), 0.5f64.sqrt(), 0.0]].map(|m| cubic.ferromagnet_mev(m)[1]);
    close(diagonal - axis, 0.25 * 0.02 * MRY);
    assert!(read("spirit", &paths, "+K").unwrap_err().contains("--convention"));
}

#[test]
fn pairs_listed_once_and_in_both_directions_are_one_hamiltonian() {
    let [once, both] = [
        model("uppasd", &borrowed(&chain("1 1 1 0 0 3.0\n1 1 2 0 0 -0.8\n", "1 1 1 0 0 0 0 0.6\n")), "once, -D"),
        model("uppasd", &borrowed(&chain(EXCHANGE, DMI)), "-D"),
    ];
    for seed in 0..3 {
        close(energy(&once, &random(12, seed)), energy(&both, &random(12, seed)));
    }
    let doubled = model("uppasd", &borrowed(&chain(EXCHANGE, DMI)), "both directions, -2J, -2D");
    close(energy(&doubled, &random(12, 0)), 2.0 * energy(&both, &random(12, 0)));
}

#[test]
fn a_pair_without_its_other_direction_or_with_another_value_there_is_told() {
    for (jfile, dmfile, said) in [
        (
            "1 1 1 0 0 1.5\n",
            "",
            "jfile:1:1: .: the pair from atom 1 of the cell to atom 1 of the cell (1, 0, 0) on is not listed",
        ),
        ("1 1 1 0 0 1.5\n1 1 -1 0 0 1.4\n", "", "other direction in line 2 do not agree"),
        (EXCHANGE, "1 1 1 0 0 0 0 0.3\n1 1 -1 0 0 0 0 0.3\n", "dmfile:1:1"),
        ("1 1 1 0 0 1.5\n1 1 1 0 0 1.4\n", "", "jfile:2:1: coupling: this coupling has another value in line 1"),
        ("1 1 0.5 0 0 1.5\n", "", "jfile:1:5: vector: no atom"),
        ("1 2 1 0 0 1.5\n", "", "jfile:1:3: site j: found 2, but there are 1 to 1"),
        ("1 1 1 0 0\n", "", "jfile:1:10: J: the line ends here"),
    ] {
        let folder = folder(&borrowed(&chain(jfile, dmfile)));
        let found = read("uppasd", &[folder.path().into()], "-D").unwrap_err();
        assert!(found.contains(said), "{jfile:?}: {found}");
    }
}

#[test]
fn symmetry_lists_the_couplings_that_are_written_out() {
    let input = |sym: u8, cell: &str| {
        format!("ncell 4 4 4\nbc P P P\ncell {cell}\nposfile posfile\nmomfile momfile\nexchange jfile\nsym {sym}\n")
    };
    let (cubic, hexagonal) = ("1 0 0 0 1 0 0 0 1", "1 0 0 -0.5 0.8660254037844386 0 0 0 1.6");
    let count = |sym: u8, cell: &str, jfile: &str| {
        let input = input(sym, cell);
        let files =
            [("inpsd.dat", input.as_str()), ("posfile", "1 1 0 0 0\n"), ("momfile", "1 1 1 0 0 1\n"), ("jfile", jfile)];
        let model = model("uppasd", &files, "");
        (model.bonds.len(), model.ferromagnet_mev([0.0, 0.0, 1.0])[0])
    };
    for (sym, cell, jfile, neighbours) in [
        (1, cubic, "1 1 1 0 0 1\n", 6),
        (1, cubic, "1 1 1 1 0 1\n", 12),
        (1, cubic, "1 1 1 1 1 1\n", 8),
        (2, cubic, "1 1 1 0 0 1\n", 4),
        (3, hexagonal, "1 1 1 0 0 1\n", 6),
        (3, hexagonal, "1 1 1 0 1.6 1\n", 12),
    ] {
        let (bonds, energy) = count(sym, cell, jfile);
        assert_eq!(2 * bonds, neighbours, "{sym} {jfile}");
        close(energy, -MRY * neighbours as f64);
    }
    let listed = "1 1 1 0 0 1\n1 1 -1 0 0 1\n1 1 0 1 0 1\n1 1 0 -1 0 1\n1 1 0 0 1 1\n1 1 0 0 -1 1\n";
    assert_eq!(count(1, cubic, "1 1 1 0 0 1\n"), count(0, cubic, listed));
}

#[test]
fn shells_of_spirit_have_their_neighbours_and_the_chirality_that_they_ask_for() {
    let film = |more: &str| {
        format!(
            "bravais_lattice sc\nlattice_constant 2.7\nmu_s 2\nn_basis_cells 8 8 1\nboundary_conditions 1 1 0\n\
             n_shells_exchange 2\njij 10.0 -1.5\n{more}"
        )
    };
    let of = |more: &str| model("spirit", &[("film.cfg", &film(more))], "");
    let plain = of("anisotropy_magnitude 0.5\nanisotropy_normal 0 0 1\nexternal_field_magnitude 3\n");
    assert_eq!((plain.bonds.len(), plain.spacing_nm), (4, Some(0.27)));
    // two nearest and two next bonds an atom
    let [bonds, own, field] = plain.ferromagnet_mev([0.0, 0.0, 1.0]);
    close(bonds, -2.0 * 10.0 + 2.0 * 1.5);
    close(own, -0.5);
    close(field, -2.0 * 3.0 * MU_B_MEV_PER_T);
    // a cycloid m = (sin qx, 0, cos qx): m_i × m_j = ŷ sin q; Spirit's Néel D is D x̂ × ẑ = −D ŷ, with a minus in front
    let cycloid = |q: f64| Spiral { q: [q, 0.0, 0.0], u: [0.0, 0.0, 1.0], v: [1.0, 0.0, 0.0] };
    for (chirality, sign) in [(2, 1.0), (-2, -1.0), (1, 0.0)] {
        let model = of(&format!("n_shells_dmi 1\ndij 6.0\ndm_chirality {chirality}\n"));
        let q: f64 = 0.125;
        let expected = -10.0 * ((TAU * q).cos() + 1.0) + 3.0 * (TAU * q).cos() + sign * 6.0 * (TAU * q).sin();
        close(model.spiral_mev(cycloid(q)).iter().sum(), expected);
        let spins: Vec<V> = (0..64).map(|i| (TAU * q * (i % 8) as f64).sin_cos()).map(|(s, c)| [s, 0.0, c]).collect();
        close(energy(&model, &spins) / 64.0, expected);
    }
    // Bloch: D along the bond, a helix about it
    let model = of("n_shells_dmi 1\ndij 6.0\ndm_chirality 1\n");
    let helix = Spiral { q: [0.25, 0.0, 0.0], u: [0.0, 1.0, 0.0], v: [0.0, 0.0, 1.0] };
    close(model.spiral_mev(helix)[0], -10.0 - 6.0);
    assert_eq!(model.helix([0.25, 0.0, 0.0]).map(|own| model.spiral_mev(own)[0] < -15.9), Some(true));
}

#[test]
fn links_of_vampire_may_be_numbers_or_multiples_of_the_materials() {
    let ucf = |kind: &str, j: &str| {
        let link = |(k, r): (usize, &str)| format!("{k} 0 0 {r} {j}\n");
        let links: String = ["1 0 0", "-1 0 0", "0 1 0", "0 -1 0"].into_iter().enumerate().map(link).collect();
        format!("3 3 3\n1 0 0\n0 1 0\n0 0 1\n1 1\n0 0 0 0 0\n4 {kind}\n{links}")
    };
    let mat = "material:num-materials=1\nmaterial[1]:atomic-spin-moment = 2 !muB\nmaterial[1]:exchange-matrix[1]=1.602176634e-21\n\
               material[1]:cubic-anisotropy-constant=1.602176634e-22 !J/atom\n";
    for (kind, j) in [
        ("isotropic", "1.602176634e-21"),
        ("0", "1.602176634e-21"),
        ("vectorial", "1.602176634e-21 1.602176634e-21 1.602176634e-21"),
        ("normalised-isotropic", "1.0"),
    ] {
        let folder = folder(&[("a.ucf", &ucf(kind, j)), ("a.mat", mat)]);
        let paths = ["a.ucf", "a.mat"].map(|name| folder.path().join(name));
        let model = read("vampire", &paths, "").unwrap().in_its_box().unwrap();
        let [bonds, own, _] = model.ferromagnet_mev([1.0, 0.0, 0.0]);
        close(bonds, -2.0 * 10.0);
        // −k/2 Σ S⁴ between [100] and [111]: k (½ − 1/6), the energy of the cubic anisotropy with K = k
        let diagonal = model.ferromagnet_mev([1.0 / 3f64.sqrt(); 3])[1];
        close(diagonal - own, 0.5 - 0.5 / 3.0);
        assert_eq!((model.cells, model.periodic), (Some([3, 3, 1]), Some([true, true, false])));
    }
}

/// A film of each format that is imported whole, with room for one more line: its text, with the line in the file of this name.
fn with_line(format: &str, file: &str, line: &str) -> (TempDir, PathBuf) {
    let (mut files, first) = match format {
        "uppasd" => (chain(EXCHANGE, ""), "inpsd.dat"),
        "vampire" => (vampire(), "input"),
        "tb2j" => (tb2j(), "exchange.out"),
        _ => (vec![("a.cfg", "mu_s 1\nn_shells_exchange 1\njij 1\n".to_string())], "a.cfg"),
    };
    files.iter_mut().filter(|(name, _)| *name == file).for_each(|(_, text)| *text += &format!("{line}\n"));
    let folder = folder(&borrowed(&files));
    let path = folder.path().join(first);
    (folder, path)
}

const WITHOUT_ENERGY: &[(&str, &str, &str)] = &[
    ("vampire", "ladder.mat", "material[1]:density = 1.0"),
    ("vampire", "ladder.mat", "material[1]:second-order-triaxial-anisotropy-vector = 0,0,0"),
    ("vampire", "ladder.mat", "material[2]:applied-field-strength = 0.0 !T"),
    ("vampire", "input", "sim:demagnetisation-factor = 0,0,0"),
    ("vampire", "input", "sim:maximum-applied-field-strength = 2 !T"),
    ("vampire", "input", "output:exchange-energy"),
    ("vampire", "input", "create:sphere"),
    ("spirit", "a.cfg", "n_biaxial_anisotropy_terms 0"),
    ("spirit", "a.cfg", "ddi_n_periodic_images 4 4 4"),
    ("spirit", "a.cfg", "ddi_method none"),
    ("spirit", "a.cfg", "llg_dt 0.001"),
    ("uppasd", "inpsd.dat", "demag N"),
    ("uppasd", "inpsd.dat", "do_dip 0"),
    ("uppasd", "inpsd.dat", "jij_scale 1.0"),
    ("uppasd", "inpsd.dat", "do_prn_beff Y"),
    ("uppasd", "inpsd.dat", "locfiles ./x"),
];

#[test]
fn what_has_no_place_in_a_config_is_refused_and_not_left_out() {
    for (format, file, line) in [
        ("spirit", "a.cfg", "ddi_method fft"),
        ("spirit", "a.cfg", "n_interaction_quadruplets 1"),
        ("spirit", "a.cfg", "biaxial_anisotropy_axes_file axes.txt"),
        ("spirit", "a.cfg", "biaxial_anisotropy_terms_file terms.txt"),
        ("spirit", "a.cfg", "n_biaxial_anisotropy_axes 1\ni K1x K1y K1z\n0 0 0 1"),
        ("spirit", "a.cfg", "n_biaxial_anisotropy_terms 2\ni n1 n2 n3 k\n0 1 0 0 -0.5\n0 0 2 0 0.1"),
        ("uppasd", "inpsd.dat", "bq bqfile"),
        ("uppasd", "inpsd.dat", "do_ralloy 1"),
        ("uppasd", "inpsd.dat", "do_dip 2"),
        ("uppasd", "inpsd.dat", "dm_scale 2.0"),
        ("uppasd", "inpsd.dat", "demag Y"),
        ("uppasd", "inpsd.dat", "demag_z Y"),
        ("uppasd", "inpsd.dat", "demag1 Y"),
        ("uppasd", "inpsd.dat", "demagfield Y Y Y"),
        ("uppasd", "inpsd.dat", "locfield ./locfield"),
        ("vampire", "ladder.mat", "material[1]:second-order-triaxial-anisotropy-vector = 1e-23,0,2e-23"),
        ("vampire", "ladder.mat", "material[1]:fourth-order-triaxial-anisotropy-vector = 0,0,2e-23"),
        ("vampire", "ladder.mat", "material[2]:fourth-order-rotational-anisotropy-constant = 3e-24"),
        ("vampire", "ladder.mat", "material[1]:biquadratic-exchange-matrix[2] = 1e-22"),
        ("vampire", "ladder.mat", "material[1]:dmi-constant[2] = 1e-22"),
        ("vampire", "ladder.mat", "material[1]:kitaev-constant[2] = 1e-22"),
        ("vampire", "ladder.mat", "material[1]:applied-field-strength = 3.0 !T"),
        ("vampire", "ladder.mat", "material[1]:density = 0.5"),
        ("vampire", "input", "sim:demagnetisation-factor = 0,0,1"),
        ("vampire", "input", "anisotropy:enable-bulk-neel-anisotropy"),
        ("vampire", "input", "dipole:solver = tensor"),
    ] {
        let (_folder, path) = with_line(format, file, line);
        let found = read(format, &[path], "").unwrap_err();
        let keyword = line.split([' ', '\n']).next().unwrap();
        let named = if format == "vampire" { keyword.replace(['[', ']', '1', '2'], "") } else { keyword.into() };
        assert!(found.contains(&format!(": {named}: ")) && found.contains(file), "{line}: {found}");
        assert!(found.contains("imported") && found.contains("take the line out"), "{line}: {found}");
    }
    for (format, file, line, said) in [
        ("spirit", "a.cfg", "hamiltonian gaussian", "found \"gaussian\""),
        // what is refused is said before files are read for it
        (
            "uppasd",
            "inpsd.dat",
            "posfile none\ndo_ralloy 1",
            "inpsd.dat:9:1: do_ralloy: found \"1\": this is not imported",
        ),
        ("spirit", "a.cfg", "mu_s x\nddi_method fft", "ddi_method: found \"fft\": dipoles are not imported"),
        ("uppasd", "inpsd.dat", "do_jtensor 1", "what tensors mean is open"),
        ("uppasd", "inpsd.dat", "anisotropy jfile\ndo_anisotropy 0", "do_anisotropy: found 0, but a file"),
        ("vampire", "input", "sim:applied-field-angle-theta = 1.57 !rad", "angles are in degrees"),
    ] {
        let (_folder, path) = with_line(format, file, line);
        let found = read(format, &[path], "").unwrap_err();
        assert!(found.contains(said), "{format}: {found}");
    }
    let folder = folder(&[("exchange.xml", "<?xml version=\"1.0\"?>")]);
    assert!(read("tb2j", &[folder.path().join("exchange.xml")], "").unwrap_err().contains("give exchange.out"));
}

#[test]
fn every_keyword_that_is_not_read_is_told_with_its_line() {
    for (format, file, line) in WITHOUT_ENERGY {
        let (_folder, path) = with_line(format, file, line);
        let model = read(format, std::slice::from_ref(&path), "").unwrap();
        let text = fs::read_to_string(path.with_file_name(file)).unwrap();
        let keyword = line.split(' ').next().unwrap().replace(['[', ']', '1', '2'], "");
        let (start, told) = (format!("not read in {file}: "), format!("{keyword} (line {})", text.lines().count()));
        let notes: Vec<&String> = model.notes.iter().filter(|note| note.starts_with(&start)).collect();
        assert!(notes.len() == 1 && notes[0].contains(&told), "{line}: {:?}", model.notes);
        assert!(model.report().iter().any(|(_, value)| value == notes[0]), "{line}");
    }
    // of what was read nothing is told
    let (_folder, path) = with_line("uppasd", "", "");
    assert_eq!(read("uppasd", &[path], "").unwrap().notes, Vec::<String>::new());
    let (_folder, path) = with_line("vampire", "", "");
    let expected =
        ["not read in ladder.mat: material:damping-constant (line 3)", "not read in input: sim:temperature (line 10)"];
    assert_eq!(read("vampire", &[path], "").unwrap().notes, expected);
}

#[test]
fn the_field_of_vampire_points_where_the_last_of_its_directions_says() {
    let h = 0.5 * 3f64.sqrt();
    for (lines, expected) in [
        ("", [0.0, 0.0, 2.0]),
        // θ is the azimuth and φ the polar angle
        ("sim:applied-field-angle-theta = 90\nsim:applied-field-angle-phi = 90", [0.0, 2.0, 0.0]),
        ("sim:applied-field-angle-phi = 30", [1.0, 0.0, 2.0 * h]),
        ("sim:applied-field-angle-theta = 70", [0.0, 0.0, 2.0]),
        ("sim:applied-field-angle-phi = 90\nsim:applied-field-angle-theta = 60", [1.0, 2.0 * h, 0.0]),
        ("sim:applied-field-angle-phi = 90\nsim:applied-field-unit-vector = 0,0,-1", [0.0, 0.0, -2.0]),
        ("sim:applied-field-unit-vector = 0,1,0\nsim:applied-field-angle-theta = 0", [0.0, 0.0, 2.0]),
    ] {
        let (_folder, path) = with_line("vampire", "input", lines);
        let found = read("vampire", &[path], "").unwrap().field_t;
        (0..3).for_each(|d| close(found[d], expected[d]));
    }
}

#[test]
fn boundaries_of_vampire_may_be_named_together() {
    for (line, periodic) in [
        ("create:periodic-boundaries = z", [true, false, true]),
        ("create:periodic-boundaries = y,z", [true; 3]),
        ("create:periodic-boundaries", [true; 3]),
    ] {
        let (_folder, path) = with_line("vampire", "input", line);
        assert_eq!(read("vampire", &[path], "").unwrap().periodic, Some(periodic), "{line}");
    }
}

#[test]
fn of_a_keyword_that_is_there_twice_the_one_counts_that_the_code_takes() {
    let (_folder, path) = with_line("uppasd", "inpsd.dat", "ncell 7 1 1\nhfield 0 0 1\nhfield 0 0 3");
    let model = read("uppasd", &[path], "").unwrap();
    assert_eq!((model.cells, model.field_t), (Some([7, 1, 1]), [0.0, 0.0, 3.0]));
    let (_folder, path) = with_line("spirit", "a.cfg", "mu_s 5");
    assert_eq!(read("spirit", &[path], "").unwrap().atoms[0].moment_mub, 1.0);
}

#[test]
fn what_tb2j_writes_beside_its_hamiltonian_is_told() {
    let mut files = tb2j();
    files[0].1 = files[0].1.replacen("[Testing!] DMI", "[Testing!] Jprime: 1.000,  B: -0.100\n[Testing!] DMI", 1);
    let found = model("tb2j", &borrowed(&files), "");
    let line = files[0].1.lines().position(|line| line.contains("Jprime")).unwrap() + 1;
    let expected = format!("not read in exchange.out: Jprime (line {line}), B (line {line})");
    assert!(found.notes.contains(&expected), "{:?}", found.notes);
    assert!(!model("tb2j", &borrowed(&tb2j()), "").notes.iter().any(|note| note.contains("not read")));
}

#[test]
fn what_spirit_itself_does_not_read_is_noted() {
    let common = "bravais_lattice sc\nmu_s 1\nn_shells_exchange 1\njij 1\n";
    for (lines, said) in [
        ("interaction_pairs_file pairs.txt\n", Some("interaction_pairs_file is not read, as in Spirit")),
        (
            "hamiltonian heisenberg_pairs\nn_interaction_pairs 1\ni j da db dc Jij\n0 0 1 0 0 1\n",
            Some("n_shells_exchange is not read"),
        ),
        (
            "n_interaction_pairs 1\ni j da db dc Jij\n0 0 1 0 0 1\n",
            Some("n_interaction_pairs is not read, as in Spirit"),
        ),
        ("", None),
    ] {
        let folder = folder(&[("a.cfg", &format!("{common}{lines}"))]);
        let notes = read("spirit", &[folder.path().join("a.cfg")], "").unwrap().notes;
        let found: Vec<&String> = notes.iter().filter(|note| note.contains("is not read")).collect();
        assert_eq!(found.len(), usize::from(said.is_some()), "{notes:?}");
        assert!(said.is_none_or(|said| found[0].contains(said)), "{notes:?}");
    }
}

#[test]
fn what_a_table_of_spirit_takes_the_place_of_is_told() {
    let input = "mu_s 1\nn_shells_exchange 1\njij 1\nn_anisotropy 1\ni K Kx Ky Kz\n0 2 0 0 1\nanisotropy_magnitude 1\n\
                 anisotropy_normal 1 0 0\nanisotropy_file none.txt\nexternal_field_magnitude 0\nexternal_field_normal 0 0 1\n";
    let model = model("spirit", &[("a.cfg", input)], "");
    close(model.ferromagnet_mev([0.0, 0.0, 1.0])[1], -2.0);
    let told = "not read in a.cfg: anisotropy_magnitude (line 7), anisotropy_normal (line 8), anisotropy_file (line 9)";
    assert!(model.notes.iter().any(|note| note == told), "{:?}", model.notes);
}

#[test]
fn files_that_are_cut_or_garbled_are_errors_and_nothing_else() {
    let garbage = ["x", "-1", "nan", "1e999", "99999999999999999999", "0", "", "\u{fffd}", "[", "1e30", "-1e300"];
    let mut r = ChaCha8Rng::seed_from_u64(7);
    let (mut refused, mut tried) = (0, 0);
    for (format, files, convention, _) in ladders() {
        for which in 0..files.len() {
            for k in 0..60 {
                let mut files = files.clone();
                let text = &mut files[which].1;
                let at = r.random_range(0..text.len());
                match k % 3 {
                    0 => text.truncate(at),
                    1 => text.replace_range(at..=at, ["\n", "#", "(", "9", "-", "e"][r.random_range(0..6)]),
                    _ => {
                        let start = text[..at].rfind(char::is_whitespace).map_or(0, |s| s + 1);
                        let end = text[at..].find(char::is_whitespace).map_or(text.len(), |e| at + e);
                        text.replace_range(start.min(end)..end, garbage[r.random_range(0..garbage.len())]);
                    }
                }
                let folder = folder(&borrowed(&files));
                let named = |name: &str| folder.path().join(name);
                let paths = vec![named(if format == "vampire" { "input" } else { files[0].0 })];
                let found =
                    read(format, &paths, convention).map(|model| model.in_its_box().map(|model| model.config()));
                tried += 1;
                refused += usize::from(!matches!(found, Ok(Ok(_))));
            }
        }
    }
    assert!(4 * refused > tried, "{refused} of {tried}");
}

#[test]
fn the_command_writes_a_config_prints_the_convention_and_keeps_what_is_there() {
    let folder = folder(&borrowed(&uppasd(-1.0)));
    let run = |arguments: &[&str]| {
        let done = Command::new(env!("CARGO_BIN_EXE_spinneb"))
            .current_dir(&folder)
            .arg("import")
            .args(arguments)
            .output()
            .unwrap();
        (done.status.code(), String::from_utf8(done.stdout).unwrap(), String::from_utf8(done.stderr).unwrap())
    };
    let (code, _, said) = run(&["uppasd", "inpsd.dat"]);
    assert!(code == Some(2) && said.contains("the sign of D is open"), "{said}");
    let (code, printed, said) = run(&["uppasd", "inpsd.dat", "--convention", "-D"]);
    assert!(code == Some(0) && said.contains("inpsd.json is written"), "{said}");
    for words in
        ["J is multiplied by 2, D is multiplied by −2", "type_1–type_2", "ferromagnet along z", "cycloid along b1"]
    {
        assert!(printed.contains(words), "{words}: {printed}");
    }
    let written = fs::read_to_string(folder.path().join("inpsd.json")).unwrap();
    let lacking = load_text(Path::new("inpsd.json"), written.clone()).unwrap_err().to_string();
    assert!(lacking.contains("initial") && lacking.contains("final"), "{lacking}");
    let (code, _, said) = run(&["uppasd", "inpsd.dat", "--convention", "-D"]);
    assert!(code == Some(2) && said.contains("exists already"), "{said}");
    assert_eq!(run(&["uppasd", ".", "--convention", "-D", "--out", "inpsd.json", "--force"]).0, Some(0));
    // what is read is not replaced by what is made of it
    let input = fs::read(folder.path().join("inpsd.dat")).unwrap();
    let (code, _, said) = run(&["uppasd", ".", "--convention", "-D", "--out", "inpsd.dat", "--force"]);
    assert!(code == Some(2) && said.contains("is no config"), "{said}");
    assert_eq!(fs::read(folder.path().join("inpsd.dat")).unwrap(), input);
    let (code, _, said) = run(&["uppasd", ".", "--convention=-D", "--cells", "1,1,1", "--out", "small.json"]);
    assert!(code == Some(2) && said.contains("--cells 3,1,1") && !folder.path().join("small.json").exists(), "{said}");
    for wrong in [&["uppasd", "nothing"][..], &["uppasd", ".", "--convention", "twice"], &["vampire", "posfile"]] {
        let (code, printed, said) = run(wrong);
        assert!(code == Some(2) && printed.is_empty() && said.starts_with("error: "), "{wrong:?}: {said}");
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("elsewhere.json", folder.path().join("link.json")).unwrap();
        let (code, _, said) = run(&["uppasd", ".", "--convention=-D", "--out", "link.json", "--force"]);
        assert!(
            code == Some(2) && said.contains("symbolic link") && !folder.path().join("elsewhere.json").exists(),
            "{said}"
        );
    }
}
