//! Graphs and matrices for tests.

use super::{Graph, SparseMatrix, Symbolic};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use std::sync::Arc;

/// Sites with bonds.
#[derive(Clone)]
pub struct Lattice {
    pub name: String,
    pub positions: Vec<[f64; 3]>,
    pub bonds: Vec<(usize, usize)>,
}

/// Graphs of many kinds.
pub fn all(r: &mut ChaCha8Rng) -> Vec<Lattice> {
    let mut all = vec![
        Lattice::chain(1, 1, false),
        Lattice::chain(2, 1, false),
        Lattice::chain(3, 1, true),
        Lattice::chain(41, 1, false),
        Lattice::chain(40, 2, true),
        Lattice::nowhere("apart", 9, vec![]),
        Lattice::nowhere("star", 30, (1..30).map(|i| (0, i)).collect()),
        Lattice::nowhere("complete", 23, (0..23).flat_map(|i| (0..i).map(move |j| (i, j))).collect()),
        Lattice::nowhere("rings apart", 36, (0..36).map(|i| (i, i / 12 * 12 + (i + 1) % 12)).collect()),
        Lattice::grid([8, 7, 1], [false, false, false], 1.0, r),
        Lattice::grid([8, 7, 1], [true, true, false], 1.0, r),
        Lattice::grid([4, 4, 4], [false, false, false], 1.0, r),
        Lattice::grid([4, 3, 4], [true, true, true], 1.0, r),
        Lattice::grid([10, 9, 1], [false, true, false], 0.6, r),
        Lattice::grid([2, 30, 1], [false, true, false], 1.0, r),
    ];
    for (sites, bonds) in [(20, 15), (45, 60), (50, 120), (30, 200)] {
        let ends = (0..bonds).map(|_| (r.random_range(0..sites), r.random_range(0..sites))).collect();
        let mut lattice = Lattice::nowhere("random", sites, ends);
        all.push(lattice.clone());
        lattice.name += " in space";
        lattice.positions.iter_mut().flatten().for_each(|x| *x = r.random_range(-1.0..1.0));
        all.push(lattice);
    }
    all
}

impl Lattice {
    /// All sites at one point.
    fn nowhere(name: &str, sites: usize, bonds: Vec<(usize, usize)>) -> Lattice {
        Lattice { name: format!("{name} {sites}"), positions: vec![[1.5; 3]; sites], bonds }
    }

    /// A chain or ring with bonds of all lengths up to `reach`.
    pub fn chain(sites: usize, reach: usize, ring: bool) -> Lattice {
        let bonds = (0..sites).flat_map(|i| (1..=reach).map(move |n| (i, i + n)));
        let bonds = bonds.filter(|(_, j)| ring || *j < sites).map(|(i, j)| (i, j % sites)).collect();
        let positions = (0..sites).map(|i| [0.3 * i as f64, 0.0, 0.0]).collect();
        Lattice { name: format!("chain {sites} {reach} {ring}"), positions, bonds }
    }

    /// Nearest neighbours in a box, some of the sites left out.
    pub fn grid(extents: [usize; 3], periodic: [bool; 3], filling: f64, r: &mut ChaCha8Rng) -> Lattice {
        let [nx, ny, nz] = extents;
        let mut numbers = vec![None; nx * ny * nz];
        let mut positions = Vec::new();
        let at = |i: usize| [i % nx, i / nx % ny, i / (nx * ny)];
        for (i, number) in numbers.iter_mut().enumerate() {
            if r.random_range(0.0..1.0) < filling {
                *number = Some(positions.len());
                positions.push(at(i).map(|x| 0.1 * x as f64));
            }
        }
        let mut bonds = Vec::new();
        for i in 0..numbers.len() {
            for axis in 0..3 {
                let mut next = at(i);
                next[axis] += 1;
                if next[axis] == extents[axis] {
                    next[axis] = if periodic[axis] { 0 } else { continue };
                }
                let partner = numbers[next[0] + nx * (next[1] + ny * next[2])];
                bonds.extend(numbers[i].zip(partner));
            }
        }
        Lattice { name: format!("grid {extents:?} {periodic:?} {filling}"), positions, bonds }
    }

    pub fn graph(&self) -> Graph {
        Graph::new(self.positions.len(), self.bonds.iter().copied())
    }

    pub fn zeros(&self) -> SparseMatrix {
        SparseMatrix::zeros(Arc::new(Symbolic::of(self.graph(), &self.positions)))
    }

    /// Entries between −1 and 1.
    pub fn random(&self, r: &mut ChaCha8Rng) -> SparseMatrix {
        let mut a = self.zeros();
        for j in 0..self.positions.len() {
            let plan = a.plan().clone();
            for i in [j].into_iter().chain(plan.graph().later(j).iter().map(|i| *i as usize)) {
                for (u, v) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
                    if i != j || u >= v {
                        a.add(2 * i + u, 2 * j + v, r.random_range(-1.0..1.0));
                    }
                }
            }
        }
        a
    }
}

/// Row by row.
pub fn dense(a: &SparseMatrix) -> Vec<f64> {
    let n = a.order();
    (0..n * n).map(|k| a.get(k / n, k % n)).collect()
}
