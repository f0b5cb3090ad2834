//! LDLᵀ of lattices of nearest neighbours: time, memory and arithmetic by number of sites.
//!
//! `cargo bench --bench sparse`. Squares and cubes, open and periodic, of rotated 2 × 2 bonds. With `--features faer` beside faer and a
//! port of QDLDL; with the word `inertia` after `--` the three count the negative eigenvalues of 1000 random shifted Hessians.

#[cfg(feature = "faer")]
mod inertia;
#[cfg(feature = "faer")]
mod others;
#[cfg(feature = "faer")]
#[path = "../shared/qdldl.rs"]
mod qdldl;

use cpu_time::ThreadTime;
use spinneb::linalg::{Graph, SparseLdl, SparseMatrix, Symbolic};
use std::sync::Arc;

fn main() {
    #[cfg(feature = "faer")]
    if std::env::args().any(|word| word == "inertia") {
        return inertia::compare(1000);
    }
    println!(
        "{:>12} {:>8} {:>9} {:>10} {:>10} {:>10} {:>9} {:>9} {:>9} {:>9}",
        "lattice", "sites", "periodic", "plan (s)", "first (s)", "again (s)", "solve (s)", "MiB", "Gflop", "Gflop/s"
    );
    for (length, dimensions) in [(100, 2), (317, 2), (22, 3), (32, 3)] {
        for periodic in [false, true] {
            measure(length, dimensions, periodic);
        }
    }
}

fn measure(length: usize, dimensions: u32, periodic: bool) {
    let height = if dimensions == 3 { length } else { 1 };
    let sites = length * length * height;
    let at = |i: usize| [i % length, i / length % length, i / (length * length)];
    let number = |[x, y, z]: [usize; 3]| x + length * (y + length * z);
    let positions: Vec<[f64; 3]> = (0..sites).map(|i| at(i).map(|x| x as f64)).collect();
    let mut bonds = Vec::new();
    for i in 0..sites {
        for (axis, extent) in [length, length, height].into_iter().enumerate() {
            let mut next = at(i);
            next[axis] += 1;
            if next[axis] < extent || periodic && extent > 2 {
                next[axis] %= extent;
                bonds.push((i, number(next)));
            }
        }
    }
    let start = ThreadTime::now();
    let plan = Arc::new(Symbolic::of(Graph::new(sites, bonds.iter().copied()), &positions));
    let planned = start.elapsed().as_secs_f64();
    let matrix = laplacian(plan.clone(), &bonds);
    let start = ThreadTime::now();
    let factors = SparseLdl::of(matrix.clone());
    let first = start.elapsed().as_secs_f64();
    let memory = factors.into_memory();
    let start = ThreadTime::now();
    let factors = SparseLdl::of(memory);
    let again = start.elapsed().as_secs_f64();
    let b: Vec<f64> = (0..2 * sites).map(|i| libm::sin(0.37 * i as f64)).collect();
    let mut x = b.clone();
    let start = ThreadTime::now();
    factors.solve(&mut x, 1);
    let solved = start.elapsed().as_secs_f64();
    let mut product = vec![0.0; 2 * sites];
    matrix.multiply(&x, &mut product);
    let residual = product.iter().zip(&b).fold(0.0f64, |m, (p, b)| m.max((p - b).abs()));
    assert!(residual < 1e-8, "residual {residual:e}");
    let (mib, gflop) = (plan.bytes(1) as f64 / f64::from(1 << 20), plan.flops() / 1e9);
    println!(
        "{:>12} {sites:>8} {periodic:>9} {planned:>10.3} {first:>10.3} {again:>10.3} {solved:>9.4} {mib:>9.1} {gflop:>9.2} {:>9.1}",
        format!("{length}^{dimensions}"),
        gflop / again
    );
    #[cfg(feature = "faer")]
    beside(&matrix, &b, &x, [planned, again, solved], factors.negatives());
}

/// What others take for the same, and how many times ours that is.
#[cfg(feature = "faer")]
fn beside(matrix: &SparseMatrix, b: &[f64], x: &[f64], ours: [f64; 3], negatives: usize) {
    for (name, by) in [("faer", others::faer as fn(&SparseMatrix, &[f64]) -> others::Taken), ("QDLDL", others::qdldl)] {
        // minutes beyond
        if name == "QDLDL" && matrix.plan().flops() > 5e10 {
            continue;
        }
        let taken = by(matrix, b);
        let off = taken.x.iter().zip(x).fold(0.0f64, |m, (p, q)| m.max((p - q).abs()));
        assert!(off < 1e-6 && taken.negatives == negatives, "{name}: {off:e}, {} {negatives}", taken.negatives);
        let [plan, factor, solve] = [taken.plan_s / ours[0], taken.factor_s / ours[1], taken.solve_s / ours[2]];
        println!(
            "{name:>12} {:>8} {:>9} {:>10.3} {:>10} {:>10.3} {:>9.4}   {plan:.2}, {factor:.2} and {solve:.2} times ours",
            "", "", taken.plan_s, "", taken.factor_s, taken.solve_s
        );
    }
}

/// Indefinite: some of its eigenvalues are negative.
fn laplacian(plan: Arc<Symbolic>, bonds: &[(usize, usize)]) -> SparseMatrix {
    let mut matrix = SparseMatrix::zeros(plan);
    matrix.shift(-0.013);
    for (k, (i, j)) in bonds.iter().enumerate() {
        let (s, c) = libm::sincos(0.3 * libm::sin(k as f64));
        for u in 0..2 {
            matrix.add(2 * i + u, 2 * i + u, 1.0);
            matrix.add(2 * j + u, 2 * j + u, 1.0);
            matrix.add(2 * i + u, 2 * j + u, -c);
        }
        matrix.add(2 * i, 2 * j + 1, s);
        matrix.add(2 * i + 1, 2 * j, -s);
    }
    matrix
}
