//! Dzyaloshinskii–Moriya interaction of nearest neighbours.
//!
//! ```text
//! E = + Σ_i D d̂·(m_i × m_{i+1})               every bond once
//! ∂E/∂m_i = D (m_{i+1} × d̂),   ∂E/∂m_{i+1} = D (d̂ × m_i)
//! ```
//! With D > 0 the lower turning sense is that in which m_i × m_{i+1} points against d̂.

use super::EnergyTerm;
use super::blocks::{Blocks, cross_block};
use super::spec::{Medium, TermBuilder};
use crate::error::Result;
use crate::field::{Components, ComponentsMut};
use crate::geometry::{Direction, Vector, vector};
use crate::lattice::{Chain, Selection};
use crate::registry::Described;
use crate::units::BondEnergy;
use serde::Deserialize;
use std::ops::Range;

/// `{"D": "2 meV", "direction": [0, 1, 0]}`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct DmiSpec {
    /// Energy per bond, or per area of the cross-section.
    pub D: BondEnergy,
    /// d̂.
    pub direction: Direction,
    /// Only these bonds; all if absent.
    #[serde(default)]
    pub bonds: Option<Selection>,
}

impl Described for DmiSpec {
    const NAME: &'static str = "dmi";
    const SUMMARY: &'static str = "Dzyaloshinskii–Moriya interaction +D d·(m_i × m_j) of neighbours";
    const EXAMPLE: &'static str = r#"{"dmi": {"D": "2 meV", "direction": [0, 1, 0]}}"#;
}

impl TermBuilder for DmiSpec {
    fn build(&self, medium: &Medium) -> Result<Box<dyn EnergyTerm>> {
        let d = medium.bond_energy_mev(self.D).map_err(|e| e.within("D"))?;
        let mut term = Dmi { direction: self.direction.vector(), d: vec![0.0; medium.chain.sites] };
        for i in medium.bonds(1, self.bonds.as_ref(), "D")? {
            term.d[i] = d;
        }
        Ok(Box::new(term))
    }
}

/// Bond energies D (meV) along one direction; `d[i]` joins sites i and i + 1, 0 where there is no bond.
#[derive(Clone, Debug)]
pub struct Dmi {
    /// Unit vector d̂.
    pub direction: Vector,
    /// D of each bond.
    pub d: Vec<f64>,
}

impl Dmi {
    /// The same D (meV) on all bonds.
    pub fn uniform(chain: &Chain, d: f64, direction: Direction) -> Dmi {
        let d = (0..chain.sites).map(|i| if i < chain.bonds(1) { d } else { 0.0 }).collect();
        Dmi { direction: direction.vector(), d }
    }

    /// Σ over the two bonds of a site: D_i (m_{i+1} × d̂) − D_{i−1} (m_{i−1} × d̂).
    #[inline(always)]
    fn slope(&self, dp: f64, dm: f64, p: Vector, q: Vector) -> Vector {
        let w = [dp * p[0] - dm * q[0], dp * p[1] - dm * q[1], dp * p[2] - dm * q[2]];
        vector::cross(w, self.direction)
    }
}

impl EnergyTerm for Dmi {
    fn name(&self) -> &'static str {
        DmiSpec::NAME
    }

    fn reference_mev(&self) -> f64 {
        0.0
    }

    fn add_density(&self, m: Components, density: &mut [f64]) {
        let n = m.sites();
        for i in 0..n {
            if self.d[i] != 0.0 {
                let turn = vector::cross(m.get(i), m.get((i + 1) % n));
                density[i] += self.d[i] * vector::dot(self.direction, turn);
            }
        }
    }

    fn add_gradient(&self, m: Components, mut g: ComponentsMut, range: Range<usize>) -> f64 {
        let n = m.sites();
        let first = range.start;
        let mut energy = 0.0;
        let mut at = |i: usize, previous: usize, next: usize, g: &mut ComponentsMut| {
            let p = m.get(next);
            g.add(i - first, self.slope(self.d[i], self.d[previous], p, m.get(previous)));
            if self.d[i] != 0.0 {
                energy += self.d[i] * vector::dot(self.direction, vector::cross(m.get(i), p));
            }
        };
        for i in range {
            let previous = if i == 0 { n - 1 } else { i - 1 };
            let next = if i + 1 == n { 0 } else { i + 1 };
            at(i, previous, next, &mut g);
        }
        energy
    }

    fn add_hessian_product(&self, _: Components, v: Components, mut out: ComponentsMut) {
        let n = v.sites();
        for i in 0..n {
            let (previous, next) = ((i + n - 1) % n, (i + 1) % n);
            out.add(i, self.slope(self.d[i], self.d[previous], v.get(next), v.get(previous)));
        }
    }

    fn add_blocks(&self, _: Components, blocks: &mut Blocks) {
        for (i, &d) in self.d.iter().enumerate() {
            if d != 0.0 {
                let b = cross_block(vector::scale(d, self.direction));
                for r in 0..3 {
                    blocks.bond[0][i][r] = vector::add(blocks.bond[0][i][r], b[r]);
                }
            }
        }
    }

    fn reach(&self) -> usize {
        1
    }

    fn invariant_about(&self, axis: Vector) -> bool {
        self.d.iter().all(|d| *d == 0.0) || vector::norm(vector::cross(axis, self.direction)) < 1e-14
    }

    fn axes(&self) -> Vec<Vector> {
        vec![self.direction]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_right_handed_quarter_turn_about_d_costs_plus_d() {
        let m = [1.0, 0.0, 0.0, 1.0, 0.0, 0.0];
        let term = Dmi { direction: [0.0, 0.0, 1.0], d: vec![2.0, 0.0] };
        let mut density = [0.0; 2];
        term.add_density(Components::new(&m), &mut density);
        assert_eq!(density, [2.0, 0.0]);
    }
}
