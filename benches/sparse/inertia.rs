//! How many eigenvalues of random Hessians lie below random shifts, by three programs.

use super::others;
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use spinneb::config::load_text;
use spinneb::hessian::{TangentBasis, assemble};
use spinneb::linalg::{Graph, Matrix, SparseLdl, SparseMatrix, Symbolic};
use spinneb::spins::Spins;
use std::path::Path;
use std::sync::Arc;

const LATTICES: [(&str, usize); 8] = [
    ("square", 2),
    ("triangular", 2),
    ("honeycomb", 2),
    ("kagome", 2),
    ("cubic", 3),
    ("bcc", 3),
    ("fcc", 3),
    ("hcp", 3),
];

/// Ends with a message at the first that differs.
pub fn compare(count: u64) {
    let mut negative = 0;
    for seed in 0..count {
        let r = &mut ChaCha8Rng::seed_from_u64(seed);
        let matrix = hessian(r);
        let found = SparseLdl::of(matrix.clone()).negatives();
        let b = vec![1.0; matrix.order()];
        let [faer, qdldl] = [others::faer(&matrix, &b), others::qdldl(&matrix, &b)].map(|taken| taken.negatives);
        assert!(found == faer && found == qdldl, "{seed}: {found}, faer {faer}, QDLDL {qdldl}");
        negative += usize::from(found > 0);
    }
    println!("{count} random shifted Hessians, {negative} of them indefinite: the three count the same");
}

/// Of random spins on a random lattice with exchange, Dzyaloshinskii–Moriya interaction and an easy axis, less a random shift.
fn hessian(r: &mut impl Rng) -> SparseMatrix {
    let (kind, directions) = LATTICES[r.random_range(0..LATTICES.len())];
    let cells: Vec<usize> =
        (0..directions).map(|_| r.random_range(if directions == 2 { 3..10 } else { 3..5 })).collect();
    let [j, d, k]: [f64; 3] = [(-1.0, 1.0), (-0.5, 0.5), (-0.3, 0.3)].map(|(a, b)| r.random_range(a..b));
    let periodic = r.random_bool(0.5);
    let text = format!(
        r#"{{"material": {{"name": "random", "moment": "1 mu_B", "energy": [{{"exchange": {{"J": ["{j} meV"]}}}},
            {{"dmi": {{"D": "{d} meV", "kind": "bulk"}}}}, {{"anisotropy": {{"K": "{k} meV", "axis": [0, 0, 1]}}}}]}},
            "lattice": {{"{kind}": {{"cells": {cells:?}, "periodic": {periodic}}}}},
            "initial": {{"uniform": {{"direction": [0, 0, 1]}}}}, "final": {{"uniform": {{"direction": [0, 0, -1]}}}}}}"#
    );
    let problem = load_text(Path::new("random.json"), text).and_then(|loaded| loaded.problem()).expect("a problem");
    let h = &problem.hamiltonian;
    let vectors: Vec<[f64; 3]> = (0..h.sites()).map(|_| [0; 3].map(|_| r.random_range(-1.0..1.0))).collect();
    let spins = Spins::from_vectors(&vectors).expect("spins");
    let m = spins.as_slice();
    let mut g = vec![0.0; m.len()];
    h.energy_gradient(m, &mut g);
    let shift = r.random_range(-2.0..2.0);
    blocks(&assemble(h, m, &g, &TangentBasis::at(m)), (0..h.sites()).map(|i| h.lattice().place(i)).collect(), shift)
}

/// The same matrix less a shift, of blocks of sites.
fn blocks(matrix: &Matrix, positions: Vec<[f64; 3]>, shift: f64) -> SparseMatrix {
    let sites = positions.len();
    let block = |i: usize, j: usize| [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(u, v)| (2 * j + u, 2 * i + v));
    let coupled = |i: usize, j: usize| block(i, j).into_iter().any(|(p, q)| matrix.get(p, q) != 0.0);
    let bonds: Vec<(usize, usize)> =
        (0..sites).flat_map(|i| (i + 1..sites).map(move |j| (i, j))).filter(|(i, j)| coupled(*i, *j)).collect();
    let mut found = SparseMatrix::zeros(Arc::new(Symbolic::of(Graph::new(sites, bonds.iter().copied()), &positions)));
    for (i, j) in bonds.into_iter().chain((0..sites).map(|i| (i, i))) {
        for (p, q) in block(i, j).into_iter().filter(|(p, q)| p >= q) {
            found.add(p, q, matrix.get(p, q));
        }
    }
    found.shift(-shift);
    found
}
