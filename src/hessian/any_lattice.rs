//! What is written for any lattice, on one that is no chain: a ladder, open and closed, against sums over all pairs of sites.

use super::{Free, TangentBasis, assemble};
use crate::energy::{Anisotropy, EnergyTerm, Hamiltonian, Medium, TermSpec};
use crate::geometry::{Direction, Vector, vector};
use crate::lattice::{FrozenSites, Lattice};
use crate::linalg::{Matrix, eigenvalues_symmetric, slab};
use crate::spins::Spins;

/// Exchange of nearest neighbours, diagonals and next nearest neighbours along a leg (meV), by their distances.
const J: [(f64, f64); 3] = [(1.0, 1.0), (std::f64::consts::SQRT_2, -0.3), (2.0, 0.2)];
const D: f64 = 0.4;
const K: f64 = 0.15;

/// From site i to site j, the short way round.
fn between(ladder: &Lattice, i: usize, j: usize) -> Vector {
    let mut d = vector::sub(ladder.position(j), ladder.position(i));
    let rungs = ladder.grid.size[0] as f64;
    if ladder.grid.periodic[0] {
        d[0] -= rungs * (d[0] / rungs).round();
    }
    d
}

/// E = ½ mᵀ A m, row by row, of exchange, a DMI about the y axis and an easy axis along z; vacant sites have nothing.
fn dense(ladder: &Lattice) -> Vec<f64> {
    let n = ladder.sites;
    let mut a = vec![0.0; 9 * n * n];
    let there = |i: &usize| !ladder.vacant[*i];
    for i in (0..n).filter(there) {
        a[(2 * n + i) * 3 * n + 2 * n + i] = -2.0 * K;
        for j in (0..n).filter(there).filter(|j| *j != i) {
            let d = between(ladder, i, j);
            if let Some((_, exchange)) = J.iter().find(|(length, _)| (vector::norm(d) - length).abs() < 1e-9) {
                (0..3).for_each(|c| a[(c * n + i) * 3 * n + c * n + j] = -exchange);
            }
            if (vector::norm(d) - 1.0).abs() < 1e-9 {
                // D ŷ·(m_i × m_j) = D (z_i x_j − x_i z_j), with i first where j is ahead
                let ahead = d[0] + d[1];
                a[(2 * n + i) * 3 * n + j] += ahead * D;
                a[i * 3 * n + 2 * n + j] -= ahead * D;
            }
        }
    }
    a
}

fn product(a: &[f64], v: &[f64]) -> Vec<f64> {
    a.chunks_exact(v.len()).map(|row| slab::dot(row, v)).collect()
}

fn hamiltonian(ladder: &Lattice) -> Hamiltonian {
    let medium = Medium::new(ladder, None, None);
    let term = |text: &str| serde_json::from_str::<TermSpec>(text).unwrap().member().build(&medium).unwrap();
    let exchange = term(r#"{"exchange": {"J": ["1 meV", "-0.3 meV", "0.2 meV"]}}"#);
    let dmi = term(r#"{"dmi": {"D": "0.4 meV", "direction": [0, 1, 0]}}"#);
    let mut easy = Anisotropy::uniform(ladder.sites, K, Direction::Z);
    easy.k.iter_mut().zip(&ladder.vacant).filter(|(_, vacant)| **vacant).for_each(|(k, _)| *k = 0.0);
    let terms: Vec<Box<dyn EnergyTerm>> = vec![exchange, dmi, Box::new(easy)];
    Hamiltonian::new(ladder, terms).unwrap()
}

/// Whole ladders, and ones with sites that are vacant or frozen; one is longer than the tiles that gradients are computed in.
fn ladders() -> impl Iterator<Item = Lattice> {
    let sizes = [(3, false), (5, false), (5, true), (6, true), (150, false), (150, true)];
    sizes.into_iter().flat_map(|(rungs, closed)| {
        let whole = Lattice::ladder(rungs, closed);
        let mut holed = whole.clone();
        holed.vacant[1] = true;
        holed.frozen = vec![FrozenSites { sites: vec![rungs], direction: None }];
        [whole, holed.with_vacancies_frozen(Direction::Z)]
    })
}

#[test]
fn energies_forces_and_hessian_products_of_a_ladder_are_sums_over_all_pairs() {
    for ladder in ladders() {
        let (h, a, n) = (hamiltonian(&ladder), dense(&ladder), ladder.sites);
        let state = Spins::random(n, 7);
        let (m, mut v) = (state.as_slice(), Spins::random(n, 8).as_slice().to_vec());
        crate::field::project(m, &mut v);
        h.hold_frozen(&mut v);
        let (pull, push) = (product(&a, m), product(&a, &v));
        let (mut g, mut out) = (vec![0.0; 3 * n], vec![0.0; 3 * n]);
        let above = h.energy_gradient(m, &mut g);
        let energy = 0.5 * slab::dot(m, &pull);
        assert!((h.reference_mev() + above - energy).abs() < 1e-11 * n as f64, "{n}: {above} {energy}");
        assert!((h.energy_mev(m) - energy).abs() < 1e-11 * n as f64);
        let (mut force, mut expected) = (vec![0.0; 3 * n], vec![0.0; 3 * n]);
        h.force(m, &g, &mut force);
        h.force(m, &pull, &mut expected);
        slab::add_scaled(&mut force, -1.0, &expected);
        assert!(slab::max_abs(&force) < 1e-13, "{n}: {}", slab::max_abs(&force));
        h.hessian_product(m, &g, &v, &mut out);
        let mut curved: Vec<f64> = push;
        for i in 0..n {
            let radial: f64 = (0..3).map(|c| m[c * n + i] * pull[c * n + i]).sum();
            (0..3).for_each(|c| curved[c * n + i] -= radial * v[c * n + i]);
        }
        crate::field::project(m, &mut curved);
        h.hold_frozen(&mut curved);
        slab::add_scaled(&mut out, -1.0, &curved);
        assert!(slab::max_abs(&out) < 1e-12, "{n}: {}", slab::max_abs(&out));
    }
}

#[test]
fn the_hessian_of_a_ladder_its_index_determinant_and_solutions_are_those_of_its_products() {
    for ladder in ladders().filter(|ladder| ladder.sites < 20) {
        let (h, n) = (hamiltonian(&ladder), ladder.sites);
        let state = Spins::random(n, 9);
        let m = state.as_slice();
        let mut g = vec![0.0; 3 * n];
        h.energy_gradient(m, &mut g);
        let basis = TangentBasis::at(m);
        let matrix = assemble(&h, m, &g, &basis);
        assert!(matches!(matrix, Matrix::Sparse(_)));
        let free = Free { h: &h, m, g: &g, basis: &basis };
        let (mut whole, mut column) = (vec![0.0; 4 * n * n], Vec::new());
        for k in 0..2 * n {
            let mut unit = vec![0.0; 2 * n];
            unit[k] = 1.0;
            free.multiply(&unit, &mut column);
            whole[k * 2 * n..(k + 1) * 2 * n].copy_from_slice(&column);
            for (i, here) in column.iter().enumerate() {
                assert!((matrix.get(i, k) - here).abs() < 1e-12, "{n} sites: {i} {k}: {} {here}", matrix.get(i, k));
            }
        }
        let values = eigenvalues_symmetric(&whole, 2 * n);
        let below = values.iter().filter(|e| **e < 0.0).count();
        let factors = matrix.factor();
        assert!(below > 0 && factors.negatives() == below, "{n} sites");
        let log: f64 = values.iter().map(|e| libm::log(e.abs())).sum();
        assert!((factors.log_abs_determinant() - log).abs() < 1e-10, "{n} sites");
        let smallest = values.iter().fold(f64::INFINITY, |least, e| least.min(e.abs()));
        let x = basis.coordinates(Spins::random(n, 10).as_slice());
        let mut y = Vec::new();
        free.multiply(&x, &mut y);
        factors.solve(&mut y, 1);
        slab::add_scaled(&mut y, -1.0, &x);
        assert!(slab::max_abs(&y) < 1e-12 / smallest, "{n} sites: {:e}", slab::max_abs(&y));
    }
}

#[test]
fn moments_that_act_on_each_other_are_refused_where_they_stand_in_no_chain() {
    for (name, closed) in [("dipolar", false), ("demag", true)] {
        let mut ladder = Lattice::ladder(5, closed);
        (ladder.spacing_nm, ladder.sections_nm) = (Some(1.0), Some(vec![[1.0; 2]; 10]));
        ladder.moments_mub = vec![Some(2.0); 10];
        let term: TermSpec = serde_json::from_str(&format!("{{\"{name}\": {{}}}}")).unwrap();
        let said = term.member().build(&Medium::new(&ladder, None, None)).unwrap_err().to_string();
        assert!(said.contains("along a chain only"), "{said}");
    }
}
