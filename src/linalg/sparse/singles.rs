//! Sparse symmetric matrices with one unknown a site: two sites of a bond stand for a site with two unknowns.

use super::{Graph, SparseLdl, SparseMatrix, Symbolic};
use std::sync::Arc;

/// No site.
const NONE: u32 = u32::MAX;
/// Numbers of a field on a site.
const COLUMNS: usize = 3;

/// Where the unknown of every site of a graph stands, and the plan of the factorisation.
#[derive(Clone, Debug)]
pub struct Singles {
    /// By site.
    unknown: Vec<u32>,
    /// Unknowns of no site, the second ones of sites that found no partner.
    idle: Vec<u32>,
    plan: Arc<Symbolic>,
}

impl Singles {
    /// For sites at these positions.
    pub fn of(graph: &Graph, positions: &[[f64; 3]]) -> Singles {
        let sites = graph.sites();
        let (mut unknown, mut idle, mut places) = (vec![NONE; sites], Vec::new(), Vec::new());
        for i in 0..sites {
            if unknown[i] != NONE {
                continue;
            }
            let first = 2 * places.len() as u32;
            unknown[i] = first;
            // the first partner that is free: the next one of its row, where there is one
            match graph.partners(i).iter().find(|j| unknown[**j as usize] == NONE) {
                Some(j) => unknown[*j as usize] = first + 1,
                None => idle.push(first + 1),
            }
            places.push(positions[i]);
        }
        let pairs = |i: usize| graph.partners(i).iter().map(move |j| (i, *j as usize));
        let bonds = (0..sites).flat_map(pairs).map(|(i, j)| (unknown[i] as usize / 2, unknown[j] as usize / 2));
        let plan = Symbolic::of(Graph::new(places.len(), bonds), &places);
        Singles { unknown, idle, plan: Arc::new(plan) }
    }

    /// A matrix that is zero but for 1 on the diagonal of unknowns of no site.
    pub fn matrix(&self) -> SparseMatrix {
        let mut matrix = SparseMatrix::zeros(self.plan.clone());
        self.idle.iter().for_each(|k| matrix.add(*k as usize, *k as usize, 1.0));
        matrix
    }

    /// Adds `v` to the entry of sites i and j and, off the diagonal, to its mirror image. The sites must be the same or coupled.
    pub fn add(&self, matrix: &mut SparseMatrix, i: usize, j: usize, v: f64) {
        matrix.add(self.unknown[i] as usize, self.unknown[j] as usize, v);
    }

    /// Solves A X = V for a field of three numbers a site, component-major; `room` is memory.
    pub fn solve(&self, factors: &SparseLdl, v: &[f64], out: &mut [f64], room: &mut Vec<f64>) {
        let n = self.unknown.len();
        room.clear();
        room.resize(COLUMNS * self.plan.order(), 0.0);
        for (i, k) in self.unknown.iter().enumerate() {
            let to = &mut room[COLUMNS * *k as usize..][..COLUMNS];
            (to[0], to[1], to[2]) = (v[i], v[n + i], v[2 * n + i]);
        }
        factors.solve(room, COLUMNS);
        for (i, k) in self.unknown.iter().enumerate() {
            let from = &room[COLUMNS * *k as usize..][..COLUMNS];
            (out[i], out[n + i], out[2 * n + i]) = (from[0], from[1], from[2]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::solve_dense;
    use crate::linalg::sparse::samples;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn a_field_is_solved_for_component_by_component_on_all_kinds_of_graphs() {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(61);
        for lattice in samples::all(&mut r) {
            let n = lattice.positions.len();
            let graph = Graph::new(n, lattice.bonds.iter().copied());
            let singles = Singles::of(&graph, &lattice.positions);
            let (mut sparse, mut full) = (singles.matrix(), vec![0.0; n * n]);
            for i in 0..n {
                for j in graph.partners(i).iter().map(|j| *j as usize).filter(|j| *j <= i).chain([i]) {
                    let v = r.random_range(-1.0..1.0) + if i == j { 3.0 } else { 0.0 };
                    singles.add(&mut sparse, i, j, v);
                    (full[i * n + j], full[j * n + i]) = (v, v);
                }
            }
            let v: Vec<f64> = (0..3 * n).map(|_| r.random_range(-1.0..1.0)).collect();
            let mut x = vec![9.0; 3 * n];
            singles.solve(&SparseLdl::of(sparse), &v, &mut x, &mut Vec::new());
            for (v, x) in v.chunks(n).zip(x.chunks(n)) {
                let exact = solve_dense(&full, v, n).expect("regular");
                let size = exact.iter().fold(1.0f64, |m, x| m.max(x.abs()));
                assert!(x.iter().zip(&exact).all(|(x, e)| (x - e).abs() < 1e-9 * size), "{}", lattice.name);
            }
        }
    }
}
