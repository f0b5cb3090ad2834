//! The tables of other codes' conventions in the book: each one's own energy of random spins is that of a config with the factors
//! of the table.

use crate::pages::Page;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use spinneb::config::load_text;
use std::path::Path;

pub(crate) type V = [f64; 3];

const SITES: usize = 4;
/// What the other code calls J and K, its unit of energy apart, and its D from each site to the next.
const J: f64 = 3.0;
const K: f64 = 0.7;
const D: V = [0.4, -1.1, 0.3];
const AXIS: V = [0.6, 0.0, 0.8];

pub(crate) fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn random(sites: usize, seed: u64) -> Vec<V> {
    let mut r = ChaCha8Rng::seed_from_u64(seed);
    let spin = |r: &mut ChaCha8Rng| {
        let v: V = [0, 1, 2].map(|_| r.random_range(-1.0..1.0));
        v.map(|c| c / dot(v, v).sqrt())
    };
    (0..sites).map(|_| spin(&mut r)).collect()
}

/// The sum over ordered pairs of neighbours in an open row, i before j (`once`) or both ways, of J m_i·m_j and of D_ij·(m_i × m_j), where
/// D_ji = −D_ij; and that of K (m·e)².
fn sums(m: &[V], once: bool) -> [f64; 3] {
    let (mut j, mut d) = (0.0, 0.0);
    for a in 0..m.len() {
        for b in 0..m.len() {
            if a.abs_diff(b) == 1 && (!once || a < b) {
                let sign = if a < b { 1.0 } else { -1.0 };
                j += J * dot(m[a], m[b]);
                d += sign * dot(D, cross(m[a], m[b]));
            }
        }
    }
    [j, d, m.iter().map(|m| K * dot(*m, AXIS).powi(2)).sum()]
}

/// The energy of a code by its own formula; a unit of energy is 1 here.
fn theirs(code: &str, m: &[V]) -> [f64; 3] {
    let [once, both] = [true, false].map(|once| sums(m, once));
    match code {
        "Spirit" => [-once[0], -once[1], -once[2]],
        "UppASD" => [-both[0], -both[1], once[2]],
        "Vampire" => [-once[0], 0.0, -once[2]],
        "Fidimag, atomistic" => [-once[0], once[1], -once[2]],
        "Matjes" => [-both[0], 0.0, 0.0],
        _ => panic!("there is no formula of {code}"),
    }
}

/// The energy (meV) of a config with these terms.
fn ours(lattice: &str, material: &str, terms: &str, m: &[V]) -> f64 {
    let end = r#"{"uniform": {"direction": [0, 0, 1]}}"#;
    let config = format!(
        r#"{{"material": {{"name": "test", {material} "energy": [{terms}]}}, "lattice": {lattice},
            "initial": {{"vectors": {m:?}}}, "final": {end}}}"#
    );
    let problem = load_text(Path::new("test.json"), config).unwrap().problem().unwrap();
    problem.hamiltonian.energy_mev(problem.initial.as_slice())
}

/// The rows of the two tables, that of atoms and that of continua.
fn tables() -> [Vec<Vec<String>>; 2] {
    let rows = Page::read("docs/src/coming_from.md").rows();
    let of = |columns: usize| -> Vec<Vec<String>> {
        let is_row = |row: &&Vec<String>| row.len() == columns && row[0] != "code" && !row[0].starts_with('-');
        rows.iter().filter(is_row).cloned().collect()
    };
    [of(5), of(3)]
}

/// A factor as the table writes it; none where the code has no such term.
fn factor(cell: &str) -> Option<f64> {
    cell.replace('−', "-").parse().ok()
}

#[test]
fn atomistic_codes_have_the_energies_of_a_config_with_the_factors_of_the_table() {
    let [rows, _] = tables();
    assert_eq!(rows.len(), 5, "{rows:?}");
    let chain = format!(r#"{{"chain": {{"sites": {SITES}}}}}"#);
    let mut compared = 0;
    for row in rows {
        let terms = [
            factor(&row[2]).map(|f| format!(r#"{{"exchange": {{"J": ["{} meV"]}}}}"#, f * J)),
            factor(&row[3])
                .map(|f| format!(r#"{{"dmi": {{"D": "{} meV", "direction": {D:?}}}}}"#, f * dot(D, D).sqrt())),
            factor(&row[4]).map(|f| format!(r#"{{"anisotropy": {{"K": "{} meV", "axis": {AXIS:?}}}}}"#, f * K)),
        ];
        for (which, term) in terms.iter().enumerate().filter_map(|(which, term)| Some((which, term.as_ref()?))) {
            for seed in 0..5 {
                let found = ours(&chain, "", term, &random(SITES, seed));
                let expected = theirs(&row[0], &random(SITES, seed))[which];
                assert!((found - expected).abs() < 1e-9, "{}: {term}: {found} {expected}", row[0]);
                compared += 1;
            }
        }
    }
    assert_eq!(compared, 5 * (3 + 3 + 2 + 3 + 1));
}

/// Cells along x and y, of 1 nm, closed to a torus: there the sum over bonds is the integral by central differences.
const CELLS: [usize; 2] = [5, 4];

/// The energy of a code's density in a cell over D a², from the spin there and its central differences along x and y.
fn density(code: &str, m: V, [dx, dy]: [V; 2]) -> f64 {
    let interfacial = m[2] * (dx[0] + dy[1]) - (m[0] * dx[2] + m[1] * dy[2]);
    let curl = [dy[2], -dx[2], dx[1] - dy[0]];
    match code {
        "mumax3, Dind" => interfacial,
        "Ubermag, Cnv_z" => m[0] * dx[2] + m[1] * dy[2] - m[2] * (dx[0] + dy[1]),
        "mumax3, Dbulk" | "Ubermag, T or O" => dot(m, curl),
        "Ubermag, D2d_z" => {
            let [x, y] = [cross(dx, [1.0, 0.0, 0.0]), cross(dy, [0.0, 1.0, 0.0])];
            dot(m, [x[0] - y[0], x[1] - y[1], x[2] - y[2]])
        }
        _ => panic!("there is no formula of {code}"),
    }
}

#[test]
fn micromagnetic_codes_have_the_energies_of_a_config_with_the_signs_of_the_table() {
    let [_, rows] = tables();
    assert_eq!(rows.len(), 5, "{rows:?}");
    let [nx, ny] = CELLS;
    let grid = format!(
        r#"{{"grid": {{"cells": [{nx}, {ny}, 1], "cell": ["1 nm", "1 nm", "1 nm"], "periodic": [true, true, false]}}}}"#
    );
    for row in rows {
        let (sign, kind) = row[2].split_once(", ").unwrap();
        let term =
            format!(r#"{{"dmi": {{"D": "{} mJ/m^2", "kind": "{}"}}}}"#, factor(sign).unwrap(), kind.trim_matches('`'));
        for seed in 0..5 {
            let m = random(nx * ny, seed);
            let at = |x: usize, y: usize| m[x % nx + nx * (y % ny)];
            let half = |a: V, b: V| [0, 1, 2].map(|c| 0.5 * (a[c] - b[c]));
            let cells = (0..nx).flat_map(|x| (0..ny).map(move |y| (x, y)));
            let sum: f64 = cells
                .map(|(x, y)| {
                    let differences = [half(at(x + 1, y), at(x + nx - 1, y)), half(at(x, y + 1), at(x, y + ny - 1))];
                    density(&row[0], at(x, y), differences)
                })
                .sum();
            // 1 mJ/m² on 1 nm² in meV
            let expected = 1e-21 / 1.602176634e-22 * sum;
            let found = ours(&grid, r#""Ms": "800 kA/m","#, &term, &m);
            assert!((found - expected).abs() < 1e-9, "{}: {found} {expected}", row[0]);
        }
    }
}

#[test]
fn a_dmi_along_a_direction_between_two_kinds_of_sites_acts_from_the_first_kind_to_the_second() {
    let energy = |between: &str| {
        let config = format!(
            r#"{{"material": {{"name": "m", "moment": "1 mu_B", "energy": [{{"exchange": {{"J": ["1 meV"]}}}},
                {{"dmi": {{"D": "0.7 meV", "direction": [0, 0.6, 0.8], "between": {between}}}}}]}},
            "lattice": {{"chain": {{"sites": 6}}}}, "initial": {{"uniform": {{"direction": [0, 0, 1]}}}},
            "final": {{"uniform": {{"direction": [0, 0, -1]}}}}}}"#
        );
        let problem = load_text(Path::new("between.json"), config).expect("a config").problem().expect("a problem");
        let m = random(6, 3);
        let exchange: f64 = m.windows(2).map(|pair| -dot(pair[0], pair[1])).sum();
        let components: Vec<f64> = (0..3).flat_map(|c| m.iter().map(move |v| v[c])).collect();
        problem.hamiltonian.energy_mev(&components) - exchange
    };
    // from the odd sites to the even ones: each of these is left in both directions of the chain
    let m = random(6, 3);
    let expected: f64 = [1, 3, 5]
        .iter()
        .flat_map(|odd| [odd - 1, odd + 1].into_iter().filter(|even| *even < 6).map(move |even| (*odd, even)))
        .map(|(from, to)| 0.7 * dot([0.0, 0.6, 0.8], cross(m[from], m[to])))
        .sum();
    let [there, back] = ["[[1, 3, 5], [0, 2, 4]]", "[[0, 2, 4], [1, 3, 5]]"].map(energy);
    assert!((there - expected).abs() < 1e-12 && (back + expected).abs() < 1e-12, "{there} {back} {expected}");
}
