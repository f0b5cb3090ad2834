//! Turns of spins that tensors tell, in whatever frame spins are written.
//!
//! ```text
//! A_ij = J_ij − ⅓ tr J_ij                      what a bond has beside isotropic exchange, and A_ii a site
//! T_i = Σ_j w_j (A_ij + A_ijᵀ + A_ij A_ijᵀ/a)  over the bonds of a site, each with a weight of its own, a the largest |A_ij|
//! R J_p(i)p(j) Rᵀ = J_ij  ⇒  R T' Rᵀ = T_i     T' the same sum over the bonds that a motion takes these from
//! R = Σ_k ± e_k e'_kᵀ                           e, e' the eigenvectors of T_i and of T', by their eigenvalues
//! ```
//! Where no two eigenvalues are alike these eight are all there are: operations that permute bonds as they turn spins, such as the
//! threefold axis of a honeycomb whose bonds couple one component each, are found without the axes of anything being known.

use crate::energy::Hamiltonian;
use crate::geometry::matrix::{product, transposed};
use crate::geometry::{Matrix, vector};
use crate::linalg::eigen_symmetric;

/// Eigenvalues are different that are further apart than this part of the whole spread: eigenvectors are as exact as that.
const APART: f64 = 1e-3;
/// What is less than this part of the stiffness is rounding.
const NONE: f64 = 1e-9;
/// At most so many sites are looked at.
const SITES: usize = 64;

/// The bonds of one site that tell all three axes.
pub struct Tensors {
    site: usize,
    /// Partners, itself the first, and A.
    bonds: Vec<(usize, Matrix)>,
    /// a.
    largest: f64,
    values: [f64; 3],
    vectors: Matrix,
}

impl Tensors {
    /// Of the site, of some all over the lattice, whose eigenvalues are furthest apart. Spins that are held have no say.
    pub fn of(h: &Hamiltonian, held: &[bool]) -> Option<Tensors> {
        let free: Vec<usize> = (0..held.len()).filter(|i| !held[*i]).collect();
        let some = free.iter().step_by(free.len().div_ceil(SITES).max(1));
        let all = some.filter_map(|i| Tensors::at(h, *i, held));
        all.reduce(|best, next| if next.gap() > best.gap() * (1.0 + APART) { next } else { best })
    }

    fn at(h: &Hamiltonian, site: usize, held: &[bool]) -> Option<Tensors> {
        let bonds = bonds(h, site, held);
        let size = |a: &Matrix| a.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
        let largest = bonds.iter().map(|(_, a)| size(a)).fold(0.0, f64::max);
        if largest <= NONE * h.stiffness_mev() {
            return None;
        }
        let (values, vectors) = axes(bonds.iter().map(|(_, a)| a), largest);
        let found = Tensors { site, bonds, largest, values, vectors };
        (found.gap() > APART * (values[2] - values[0])).then_some(found)
    }

    fn gap(&self) -> f64 {
        (self.values[1] - self.values[0]).min(self.values[2] - self.values[1])
    }

    /// The matrices R that an operation can have which takes the spin of site i from `source(i)`.
    pub fn turns(&self, h: &Hamiltonian, held: &[bool], source: impl Fn(usize) -> Option<usize>) -> Vec<Matrix> {
        let Some(site) = source(self.site) else { return Vec::new() };
        let others = bonds(h, site, held);
        let image = |(j, _): &(usize, Matrix)| {
            let from = source(*j)?;
            others.iter().find(|(k, _)| *k == from).map(|(_, a)| a)
        };
        let Some(images) = self.bonds.iter().map(image).collect::<Option<Vec<&Matrix>>>() else { return Vec::new() };
        let (values, vectors) = axes(images.into_iter(), self.largest);
        if (0..3).any(|k| (values[k] - self.values[k]).abs() > 0.1 * self.gap()) {
            return Vec::new();
        }
        let signs = (0..8u32).map(|k| [0, 1, 2].map(|c| if k >> c & 1 == 1 { -1.0 } else { 1.0 }));
        let from = |signs: [f64; 3]| [0, 1, 2].map(|k| vector::scale(signs[k], vectors[k]));
        signs.map(|signs| product(&transposed(&self.vectors), &from(signs))).collect()
    }
}

/// The partners of a site, itself the first, with A.
fn bonds(h: &Hamiltonian, site: usize, held: &[bool]) -> Vec<(usize, Matrix)> {
    let blocks = h.constant_blocks();
    let mut found = vec![(site, blocks.at_site(site))];
    let mut add = |j: usize, block: Matrix| match found.iter_mut().find(|(k, _)| *k == j) {
        Some((_, sum)) => (0..3).for_each(|r| sum[r] = vector::add(sum[r], block[r])),
        None => found.push((j, block)),
    };
    for bonds in blocks.bond.iter().filter(|bonds| !bonds.rest.is_empty()) {
        if let Some(j) = bonds.family.next(site).filter(|j| !held[*j]) {
            add(j, bonds.rest[site]);
        }
        if let Some(j) = bonds.family.previous(site).filter(|j| !held[*j]) {
            add(j, transposed(&bonds.rest[j]));
        }
    }
    for (_, a) in &mut found {
        let mean = (a[0][0] + a[1][1] + a[2][2]) / 3.0;
        (0..3).for_each(|c| a[c][c] -= mean);
    }
    found
}

/// Eigenvalues, ascending, and eigenvectors of T.
fn axes<'a>(bonds: impl Iterator<Item = &'a Matrix>, largest: f64) -> ([f64; 3], Matrix) {
    let mut t = [[0.0; 3]; 3];
    for (k, a) in bonds.enumerate() {
        // the golden section: no two alike, and none near a sum of others
        let weight = 1.0 + (0.618_033_988_75 * k as f64).fract();
        let (back, square) = (transposed(a), product(a, &transposed(a)));
        for (r, row) in t.iter_mut().enumerate() {
            (0..3).for_each(|c| row[c] += weight * (a[r][c] + back[r][c] + square[r][c] / largest));
        }
    }
    let (values, vectors) = eigen_symmetric(&t.concat(), 3);
    ([0, 1, 2].map(|k| values[k]), [0, 1, 2].map(|k| [vectors[k][0], vectors[k][1], vectors[k][2]]))
}
