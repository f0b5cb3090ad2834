//! From lists of pairs, as codes write them, to bonds that are counted once.
//!
//! ```text
//! E = Σ_bonds m_iᵀ M m_j          both directions listed:  M = M_ij + M_jiᵀ,  and M_ij = M_jiᵀ is checked
//! ```

use super::text::Text;
use crate::energy::{Convention, Counting};
use crate::error::{Error, Result};
use crate::geometry::matrix::{Matrix, apart, transposed};
use crate::geometry::{Vector, vector};
use crate::lattice::Hop;
use std::collections::BTreeMap;

/// A pair as a file lists it.
#[derive(Clone, Debug)]
pub struct Listed {
    /// From which atom to which, how many cells on.
    pub hop: Hop,
    /// M of the listed term m_iᵀ M m_j (meV), sign and factor of the convention in it.
    pub matrix: Matrix,
    /// Where it stands.
    pub line: usize,
}

/// A bond, counted once.
#[derive(Clone, Debug, PartialEq)]
pub struct Bond {
    /// From which atom to which, how many cells on.
    pub hop: Hop,
    /// M of E = m_iᵀ M m_j (meV).
    pub matrix: Matrix,
}

/// How far two directions of a pair may be apart: this part of the larger, and so much (meV) beside, by which numbers are rounded.
const ASYMMETRY: f64 = 1e-4;

/// M of J, D and a symmetric rest in a convention; all in meV.
pub fn matrix(c: Convention, j: f64, d: Vector, rest: Option<&Matrix>) -> Matrix {
    let (f, [x, y, z]) = (c.energy.factor(), vector::scale(c.dmi.factor(), d));
    let turn = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]];
    [0, 1, 2].map(|r| {
        [0, 1, 2].map(|k| {
            let own = if r == k { j } else { 0.0 } + rest.map_or(0.0, |t| t[r][k]);
            f * own + turn[r][k]
        })
    })
}

impl Bond {
    /// J of −J m_i·m_j (meV).
    pub fn j(&self) -> f64 {
        let m = &self.matrix;
        -(m[0][0] + m[1][1] + m[2][2]) / 3.0
    }

    /// D of +D·(m_i × m_j) (meV).
    pub fn d(&self) -> Vector {
        let half = |r: usize, c: usize| 0.5 * (self.matrix[r][c] - self.matrix[c][r]);
        [half(1, 2), half(2, 0), half(0, 1)]
    }

    /// The symmetric rest T of −m_iᵀ T m_j (meV), without trace; nothing where it is none but for rounding.
    pub fn rest(&self) -> Option<Matrix> {
        let (m, j) = (&self.matrix, self.j());
        let rest = [0, 1, 2].map(|r| [0, 1, 2].map(|c| -0.5 * (m[r][c] + m[c][r]) - if r == c { j } else { 0.0 }));
        let [rest_size, size] = [&rest, m].map(largest);
        (rest_size > 1e-12 * size).then_some(rest)
    }
}

fn largest(m: &Matrix) -> f64 {
    m.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()))
}

/// The bonds of a list. Where pairs are counted once, two listings of one pair add up; `rounding` (meV) is what the file's digits
/// leave open.
pub fn merge(text: &Text, listed: &[Listed], counting: Counting, rounding: f64) -> Result<Vec<Bond>> {
    let mut at: BTreeMap<Hop, &Listed> = BTreeMap::new();
    let mut bonds = Vec::new();
    for pair in listed {
        let hop = pair.hop;
        if hop == hop.back() {
            return Err(text.error(pair.line, "this pair joins an atom to itself"));
        }
        if counting == Counting::Once {
            bonds.push(Bond { hop, matrix: pair.matrix });
        } else if let Some(first) = at.insert(hop, pair) {
            let message = format!("{} is listed a second time, after line {}", shown(hop), first.line);
            return Err(text.error(pair.line, message));
        }
    }
    for pair in listed.iter().filter(|_| counting == Counting::BothDirections) {
        let Some(partner) = at.get(&pair.hop.back()) else { return Err(alone(text, pair)) };
        let other = transposed(&partner.matrix);
        if apart(&pair.matrix, &other) > rounding + ASYMMETRY * largest(&pair.matrix).max(largest(&other)) {
            return Err(unequal(text, pair, partner));
        }
        if pair.line <= partner.line && (pair.line < partner.line || pair.hop < partner.hop) {
            bonds.push(Bond { hop: pair.hop, matrix: sum(&pair.matrix, &other) });
        }
    }
    Ok(added(bonds))
}

fn alone(text: &Text, pair: &Listed) -> Error {
    let message = format!(
        "{} is not listed the other way ({}), but the convention counts both directions: list both, or give --convention once \
         if each pair is listed and counted once",
        shown(pair.hop),
        shown(pair.hop.back())
    );
    text.error(pair.line, message)
}

fn unequal(text: &Text, pair: &Listed, partner: &Listed) -> Error {
    let message = format!(
        "{} and its other direction in line {} do not agree: J_ij = J_jiᵀ is needed (J the same, D opposite), found {:?} and {:?} meV",
        shown(pair.hop),
        partner.line,
        pair.matrix,
        partner.matrix
    );
    text.error(pair.line, message)
}

/// "the pair from atom 1 to atom 2 in the cell (0, 1, 0)", atoms counted from 1.
fn shown(hop: Hop) -> String {
    let ([i, j], [a, b, c]) = (hop.atoms, hop.shift);
    format!("the pair from atom {} of the cell to atom {} of the cell ({a}, {b}, {c}) on", i + 1, j + 1)
}

fn sum(a: &Matrix, b: &Matrix) -> Matrix {
    [0, 1, 2].map(|r| vector::add(a[r], b[r]))
}

/// The bonds with those of one pair added up, in the order of the first, without those that are nothing.
pub fn added(bonds: Vec<Bond>) -> Vec<Bond> {
    let mut at: BTreeMap<Hop, usize> = BTreeMap::new();
    let mut all: Vec<Bond> = Vec::new();
    for Bond { hop, matrix } in bonds {
        let back = hop.back();
        if let Some(&k) = at.get(&hop) {
            all[k].matrix = sum(&all[k].matrix, &matrix);
        } else if let Some(&k) = at.get(&back) {
            all[k].matrix = sum(&all[k].matrix, &transposed(&matrix));
        } else {
            at.insert(hop, all.len());
            all.push(Bond { hop, matrix });
        }
    }
    all.retain(|bond| largest(&bond.matrix) > 0.0);
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parts_of_a_matrix_are_those_that_made_it() {
        let rest = [[1.0, 0.5, 0.0], [0.5, -2.0, 0.0], [0.0, 0.0, 1.0]];
        let bond =
            Bond { hop: Hop::ahead(1), matrix: matrix(Convention::default(), 3.0, [0.1, -0.2, 0.3], Some(&rest)) };
        assert!((bond.j() - 3.0).abs() < 1e-15 && apart(&bond.rest().unwrap(), &rest) < 1e-15);
        assert!(vector::norm(vector::sub(bond.d(), [0.1, -0.2, 0.3])) < 1e-15);
    }
}
