//! The gradient of the energy, of walkers side by side.
//!
//! Where every term is of second order in the spins and joins no distant ones, ∂E/∂m = A m + b with the blocks of the Hessian, and the
//! walkers share each block as it is read. Other energies are asked walker by walker.

use super::{LANES, Lanes, Spin};
use crate::energy::Hamiltonian;
use crate::geometry::Vector;
use crate::geometry::matrix::transposed;
use multiversion::multiversion;

/// ∂E/∂m (meV) of walkers side by side.
#[derive(Clone, Debug)]
pub(super) enum Field<'a> {
    /// A m + b.
    Linear(Linear),
    /// Of any energy.
    Any(&'a Hamiltonian),
}

impl<'a> Field<'a> {
    pub fn new(h: &'a Hamiltonian) -> Field<'a> {
        let is_linear = h.terms().iter().all(|t| t.is_quadratic() && !t.is_whole());
        if is_linear { Field::Linear(Linear::new(h)) } else { Field::Any(h) }
    }

    /// Of all walkers.
    pub fn gradient(&self, m: &[Spin], gradient: &mut [Spin]) {
        match self {
            Field::Linear(linear) => multiply(linear, m, gradient),
            Field::Any(h) => {
                let mut own = vec![0.0; 3 * m.len()];
                for lane in 0..LANES {
                    h.energy_gradient(&of_lane(m, lane), &mut own);
                    to_lane(&own, lane, gradient);
                }
            }
        }
    }
}

/// Component-major numbers of one walker (3N).
pub(super) fn of_lane(spins: &[Spin], lane: usize) -> Vec<f64> {
    (0..3).flat_map(|c| spins.iter().map(move |s| s[c][lane])).collect()
}

/// Component-major numbers (3N) as those of one walker.
pub(super) fn to_lane(own: &[f64], lane: usize, spins: &mut [Spin]) {
    let n = spins.len();
    spins.iter_mut().enumerate().for_each(|(i, s)| (0..3).for_each(|c| s[c][lane] = own[c * n + i]));
}

/// A row of A, and of b.
#[derive(Clone, Debug)]
struct Row {
    own: [Vector; 3],
    /// Partners by s·1.
    plain: Vec<(usize, f64)>,
    /// Partners by a block.
    blocks: Vec<(usize, [Vector; 3])>,
    constant: Vector,
}

/// A and b.
#[derive(Clone, Debug)]
pub(super) struct Linear(Vec<Row>);

impl Linear {
    fn new(h: &Hamiltonian) -> Linear {
        let (blocks, n) = (h.constant_blocks(), h.sites());
        let mut constant = vec![0.0; 3 * n];
        h.energy_gradient(&vec![0.0; 3 * n], &mut constant);
        let row = |i: usize| {
            let constant = [0, 1, 2].map(|c| constant[c * n + i]);
            Row { own: blocks.at_site(i), plain: Vec::new(), blocks: Vec::new(), constant }
        };
        let mut rows: Vec<Row> = (0..n).map(row).collect();
        for bonds in &blocks.bond {
            for [i, j] in bonds.family.bonds() {
                match bonds.rest.get(i).filter(|rest| rest.iter().flatten().any(|x| *x != 0.0)) {
                    None => {
                        rows[i].plain.push((j, bonds.isotropic[i]));
                        rows[j].plain.push((i, bonds.isotropic[i]));
                    }
                    Some(rest) => {
                        let mut block = *rest;
                        (0..3).for_each(|c| block[c][c] += bonds.isotropic[i]);
                        rows[i].blocks.push((j, block));
                        rows[j].blocks.push((i, transposed(&block)));
                    }
                }
            }
        }
        rows.iter_mut().for_each(|row| row.plain.retain(|(_, s)| *s != 0.0));
        Linear(rows)
    }
}

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn multiply(linear: &Linear, m: &[Spin], gradient: &mut [Spin]) {
    for ((row, own), g) in linear.0.iter().zip(m).zip(gradient) {
        let mut sum: Spin = row.constant.map(|b| [b; LANES]);
        add_block(&row.own, own, &mut sum);
        for (j, s) in &row.plain {
            (0..3).for_each(|c| add(*s, &m[*j][c], &mut sum[c]));
        }
        for (j, block) in &row.blocks {
            add_block(block, &m[*j], &mut sum);
        }
        *g = sum;
    }
}

#[inline(always)]
fn add_block(block: &[Vector; 3], m: &Spin, sum: &mut Spin) {
    (0..3).for_each(|r| (0..3).for_each(|c| add(block[r][c], &m[c], &mut sum[r])));
}

#[inline(always)]
fn add(s: f64, m: &Lanes, sum: &mut Lanes) {
    (0..LANES).for_each(|l| sum[l] += s * m[l]);
}

/// The vector of walker l.
#[inline(always)]
pub(super) fn at(spin: &Spin, l: usize) -> Vector {
    [spin[0][l], spin[1][l], spin[2][l]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::load_text;
    use crate::spins::Spins;
    use std::path::Path;

    #[test]
    fn walkers_side_by_side_feel_what_each_of_them_feels() {
        let config = |more: &str| {
            format!(
                r#"{{"material": {{"name": "any", "moment": "1 mu_B", "energy": [{{"exchange": {{"J": ["1 meV", "-0.2 meV"]}}}},
                {{"dmi": {{"D": "0.4 meV", "kind": "interfacial"}}}}, {{"anisotropy": {{"K": "0.3 meV", "axis": [1, 2, 2], "sites": [3, 4]}}}}{more}]}},
                "energy": [{{"zeeman": {{"B": ["1 T", "0 T", "3 T"]}}}}], "lattice": {{"triangular": {{"cells": [4, 5], "periodic": [true, false]}}}},
                "initial": {{"random": {{"seed": 1}}}}, "final": {{"random": {{"seed": 2}}}}}}"#
            )
        };
        for (more, is_linear) in [("", true), (r#", {"cubic_anisotropy": {"K": "0.1 meV"}}"#, false)] {
            let config = load_text(Path::new("any.json"), config(more)).unwrap().problem().unwrap();
            let h = &config.hamiltonian;
            let field = Field::new(h);
            assert_eq!(matches!(field, Field::Linear(_)), is_linear);
            let mut m = vec![[[0.0; LANES]; 3]; h.sites()];
            let mut gradient = m.clone();
            let own = |lane: usize| Spins::random(h.sites(), lane as u64);
            (0..LANES).for_each(|lane| to_lane(own(lane).as_slice(), lane, &mut m));
            field.gradient(&m, &mut gradient);
            for lane in 0..LANES {
                let mut expected = vec![0.0; 3 * h.sites()];
                h.energy_gradient(own(lane).as_slice(), &mut expected);
                let found = of_lane(&gradient, lane);
                assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-13), "{lane} {more}");
            }
        }
    }
}
