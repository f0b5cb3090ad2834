//! Products with the Hessian of a custom term, and its blocks.

use super::super::blocks::{Block, Blocks};
use super::Custom;
use super::colours::colours;
use crate::field::{Components, ComponentsMut, project_row};
use crate::geometry::matrix::transposed;
use crate::geometry::{Vector, vector};
use crate::lattice::BondFamily;
use crate::linalg::slab;

/// Step of the differences (rad): rounding, ε/h, and what they leave out, h⁶/140 of a seventh derivative, are both below 1e-13.
const STEP: f64 = 1.0 / 512.0;
/// Weights of the differences over 1, 2 and 3 steps each way, in 60ths of a step.
const WEIGHTS: [f64; 3] = [45.0, -9.0, 1.0];
/// Error of the differences, in parts of what they are made from.
const UNCERTAIN: f64 = 1e-12;

/// Which sites act on each, and classes of sites that are asked at once.
#[derive(Debug)]
pub(super) struct Neighbours {
    /// Of every site, ascending.
    of: Vec<Vec<usize>>,
    classes: Vec<Vec<usize>>,
}

impl Neighbours {
    /// Each site is alone.
    pub(super) fn none(sites: usize) -> Neighbours {
        Neighbours::new(sites, &[])
    }

    pub(super) fn new(sites: usize, families: &[BondFamily]) -> Neighbours {
        let mut of: Vec<Vec<usize>> = vec![Vec::new(); sites];
        for [i, j] in families.iter().flat_map(BondFamily::bonds) {
            of[i].push(j);
            of[j].push(i);
        }
        for near in &mut of {
            near.sort_unstable();
            near.dedup();
        }
        Neighbours { classes: colours(&of), of }
    }

    /// In how many classes the sites are.
    pub(super) fn classes(&self) -> usize {
        self.classes.len()
    }
}

impl Custom {
    /// (∂²E/∂m∂m) v (meV) for a tangent field, up to parts along the spins.
    pub(super) fn product(&self, m: &[f64], v: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; m.len()];
        if self.energy.hessian_product(Components::new(m), Components::new(v), ComponentsMut::new(&mut out)) {
            return out;
        }
        if self.quadratic {
            let opposite: Vec<f64> = v.iter().map(|x| -x).collect();
            slab::add_scaled(&mut out, 0.5, &self.gradient(v));
            slab::add_scaled(&mut out, -0.5, &self.gradient(&opposite));
            return out;
        }
        let field = Components::new(v);
        let largest = (0..self.sites).map(|i| vector::norm(field.get(i))).fold(0.0, f64::max);
        if largest == 0.0 {
            return out;
        }
        for (k, weight) in WEIGHTS.iter().enumerate() {
            let by = (k + 1) as f64 * STEP / largest;
            let weight = weight * largest / (60.0 * STEP);
            slab::add_scaled(&mut out, weight, &self.gradient(&turned(m, v, by)));
            slab::add_scaled(&mut out, -weight, &self.gradient(&turned(m, v, -by)));
        }
        out
    }

    /// Adds the blocks at m: the products with tangent vectors of each class of sites, or with unit vectors where the Hessian is
    /// the same everywhere.
    pub(super) fn add_curvature(&self, m: &[f64], blocks: &mut Blocks) {
        let n = self.sites;
        let basis: Vec<Vec<Vector>> = match self.quadratic {
            true => vec![vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]; n],
            false => (0..n).map(|i| across(Components::new(m).get(i)).to_vec()).collect(),
        };
        let near = &self.neighbours.of;
        let mut own: Vec<Block> = vec![[[0.0; 3]; 3]; n];
        let mut others: Vec<Vec<Block>> = near.iter().map(|near| vec![[[0.0; 3]; 3]; near.len()]).collect();
        for class in &self.neighbours.classes {
            for k in 0..basis[0].len() {
                let mut v = vec![0.0; 3 * n];
                class.iter().for_each(|i| ComponentsMut::new(&mut v).set(*i, basis[*i][k]));
                let mut column = self.product(m, &v);
                if !self.quadratic {
                    project_row(Components::new(m), ComponentsMut::new(&mut column));
                }
                let column = Components::new(&column);
                for &i in class {
                    add_outer(&mut own[i], column.get(i), basis[i][k]);
                    for (block, j) in others[i].iter_mut().zip(&near[i]) {
                        add_outer(block, column.get(*j), basis[i][k]);
                    }
                }
            }
        }
        for i in 0..n {
            blocks.add_site(i, mean(&own[i], &transposed(&own[i])));
            for (block, &j) in others[i].iter().zip(&near[i]).filter(|(_, j)| **j > i) {
                let Ok(back) = near[j].binary_search(&i) else { continue };
                // rows of i, columns of j
                blocks.add_bond([i, j], mean(&others[j][back], &transposed(block)));
            }
        }
    }

    /// What the Hessian is uncertain by (meV).
    pub(super) fn difference_error_mev(&self) -> f64 {
        let m = crate::spins::Spins::random(self.sites, 1);
        let mut blocks = Blocks::zeros(self.sites, self.families.clone());
        self.add_curvature(m.as_slice(), &mut blocks);
        let size = |b: &Block| b.iter().map(|row| vector::norm(*row)).fold(0.0, f64::max);
        let mut rows: Vec<f64> = blocks.sites().map(|b| size(&b)).collect();
        for bonds in &blocks.bond {
            for [i, j] in bonds.family.bonds() {
                let block = bonds.rest.get(i).map_or(0.0, size);
                rows[i] += block;
                rows[j] += block;
            }
        }
        UNCERTAIN * (rows.into_iter().fold(0.0, f64::max) + slab::max_abs(&self.gradient(m.as_slice())))
    }
}

/// All spins turned along their great circles.
pub(super) fn turned(m: &[f64], v: &[f64], by: f64) -> Vec<f64> {
    let (mut out, m, v) = (vec![0.0; m.len()], Components::new(m), Components::new(v));
    for i in 0..m.sites() {
        let (along, length) = (v.get(i), vector::norm(v.get(i)));
        let (sin, cos) = libm::sincos(by * length);
        let part = if length > 0.0 { sin / length } else { 0.0 };
        let spin = vector::add(vector::scale(cos, m.get(i)), vector::scale(part, along));
        ComponentsMut::new(&mut out).set(i, spin);
    }
    out
}

/// Two unit vectors normal to a spin and to each other.
fn across(m: Vector) -> [Vector; 2] {
    let small = if m[0].abs() < 0.6 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let e = vector::unit_or(vector::cross(m, small), small);
    [e, vector::cross(m, e)]
}

fn add_outer(block: &mut Block, rows: Vector, columns: Vector) {
    for r in 0..3 {
        block[r] = vector::add(block[r], vector::scale(rows[r], columns));
    }
}

fn mean(a: &Block, b: &Block) -> Block {
    [0, 1, 2].map(|r| vector::scale(0.5, vector::add(a[r], b[r])))
}

/// The matrix of these blocks times a field.
pub(super) fn times_blocks(blocks: &Blocks, v: Components) -> Vec<f64> {
    let n = v.sites();
    let mut out = vec![0.0; 3 * n];
    let mut sum = ComponentsMut::new(&mut out);
    (0..n).for_each(|i| sum.add(i, super::super::multiply(&blocks.at_site(i), v.get(i))));
    for bonds in &blocks.bond {
        for [i, j] in bonds.family.bonds() {
            let isotropic =
                [[bonds.isotropic[i], 0.0, 0.0], [0.0, bonds.isotropic[i], 0.0], [0.0, 0.0, bonds.isotropic[i]]];
            let rest = bonds.rest.get(i).copied().unwrap_or([[0.0; 3]; 3]);
            let block = [0, 1, 2].map(|r| vector::add(isotropic[r], rest[r]));
            sum.add(i, super::super::multiply(&block, v.get(j)));
            sum.add(j, super::super::multiply(&transposed(&block), v.get(i)));
        }
    }
    out
}
