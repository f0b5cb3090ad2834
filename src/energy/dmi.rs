//! Dzyaloshinskii–Moriya interaction of nearest neighbours.
//!
//! ```text
//! E = + Σ_i D d̂·(m_i × m_j)                   every bond i–j once
//! ∂E/∂m_i = D (m_j × d̂),   ∂E/∂m_j = D (d̂ × m_i)
//! ```
//! With D > 0 the lower turning sense is that in which m_i × m_j points against d̂.

use super::EnergyTerm;
use super::blocks::{Blocks, cross_block};
use super::couplings::Couplings;
use super::spec::{Medium, TermBuilder};
use crate::error::Result;
use crate::field::{Components, ComponentsMut};
use crate::geometry::{Direction, Vector, vector};
use crate::lattice::{Lattice, Segment, Selection, at};
use crate::profile::Profile;
use crate::registry::Described;
use crate::units::BondEnergy;
use multiversion::multiversion;
use schemars::JsonSchema;
use serde::Deserialize;
use std::ops::Range;

/// `{"D": "2 meV", "direction": [0, 1, 0]}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct DmiSpec {
    /// Energy per bond, or per area of the cross-section.
    pub D: Profile<BondEnergy>,
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
        let families =
            medium.on_bonds(&self.D, 1, self.bonds.as_ref(), "D", |d, sites| medium.bond_energy_mev(d, sites))?;
        Ok(Box::new(Dmi { direction: self.direction.vector(), families }))
    }
}

/// Bond energies D (meV) along one direction.
#[derive(Clone, Debug)]
pub struct Dmi {
    /// Unit vector d̂.
    pub direction: Vector,
    /// D of each family of bonds of nearest neighbours, in the order of [`Lattice::families`].
    pub families: Vec<Couplings>,
}

impl Dmi {
    /// The same D (meV) on all bonds.
    pub fn uniform(lattice: &Lattice, d: f64, direction: Direction) -> Dmi {
        Dmi { direction: direction.vector(), families: Couplings::uniform(lattice, 1, d) }
    }

    /// D_i (m_j × d̂) − D_k (m_k × d̂) of a site i near a border, with its partner j a shift on and k a shift back.
    fn edge(&self, d: &[f64], segment: &Segment, m: &Components, i: usize) -> Vector {
        let [next, previous] = [segment.next, segment.previous].map(|n| n.map(|n| at(i, n)));
        let p = next.map_or([0.0; 3], |j| vector::scale(d[i], m.get(j)));
        let q = previous.map_or([0.0; 3], |k| vector::scale(d[k], m.get(k)));
        vector::cross(vector::sub(p, q), self.direction)
    }
}

/// A run of sites whose partners are `step` sites ahead and as many behind.
#[multiversion(targets("x86_64+avx2"))]
fn add_run(
    (d, [ex, ey, ez]): (&[f64], Vector),
    (first, step): (usize, isize),
    m: Components,
    gx: &mut [f64],
    gy: &mut [f64],
    gz: &mut [f64],
    density: &mut [f64],
) {
    // all of one length to the compiler too, or it keeps the last of each run for a slower loop
    let n = gx.len();
    let (ahead, behind) = (at(first, step), at(first, -step));
    let [here, next, previous] = [first, ahead, behind].map(|k| m.range(k..k + n));
    let (dp, dm) = (&d[first..][..n], &d[behind..][..n]);
    let (gy, gz, density) = (&mut gy[..n], &mut gz[..n], &mut density[..n]);
    for i in 0..n {
        let (px, py, pz) = (dp[i] * next.x[i], dp[i] * next.y[i], dp[i] * next.z[i]);
        let (wx, wy, wz) = (px - dm[i] * previous.x[i], py - dm[i] * previous.y[i], pz - dm[i] * previous.z[i]);
        gx[i] += wy * ez - wz * ey;
        gy[i] += wz * ex - wx * ez;
        gz[i] += wx * ey - wy * ex;
        let turn = (here.y[i] * pz - here.z[i] * py, here.z[i] * px - here.x[i] * pz, here.x[i] * py - here.y[i] * px);
        density[i] += ex * turn.0 + ey * turn.1 + ez * turn.2;
    }
}

impl EnergyTerm for Dmi {
    fn name(&self) -> &'static str {
        DmiSpec::NAME
    }

    fn reference_mev(&self) -> f64 {
        0.0
    }

    fn add_gradient(&self, m: Components, mut g: ComponentsMut, density: &mut [f64], range: Range<usize>) {
        let first = range.start;
        for Couplings { family, mev: d } in &self.families {
            for segment in family.segments(range.clone()) {
                let (sites, run) = (segment.sites.clone(), segment.sites.start - first..segment.sites.end - first);
                if let Some(step) = segment.even() {
                    let (gx, gy, gz) = (&mut g.x[run.clone()], &mut g.y[run.clone()], &mut g.z[run.clone()]);
                    add_run((d, self.direction), (sites.start, step), m, gx, gy, gz, &mut density[run]);
                    continue;
                }
                for i in sites {
                    g.add(i - first, self.edge(d, &segment, &m, i));
                    if let Some(next) = segment.next {
                        let turn = vector::cross(m.get(i), m.get(at(i, next)));
                        density[i - first] += d[i] * vector::dot(self.direction, turn);
                    }
                }
            }
        }
    }

    fn add_hessian_product(&self, _: Components, v: Components, mut out: ComponentsMut) {
        for Couplings { family, mev: d } in &self.families {
            for segment in family.segments(0..v.sites()) {
                segment.sites.clone().for_each(|i| out.add(i, self.edge(d, &segment, &v, i)));
            }
        }
    }

    fn add_blocks(&self, _: Components, blocks: &mut Blocks) {
        for (k, couplings) in self.families.iter().enumerate() {
            for ([i, _], d) in couplings.bonds() {
                blocks.bond[k].add(i, cross_block(vector::scale(d, self.direction)));
            }
        }
    }

    fn reach(&self) -> usize {
        1
    }

    fn axes(&self) -> Vec<Vector> {
        vec![self.direction]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::density_of;
    use crate::lattice::Chain;

    #[test]
    fn a_right_handed_quarter_turn_about_d_costs_plus_d() {
        let m = [1.0, 0.0, 0.0, 1.0, 0.0, 0.0];
        let term = Dmi::uniform(&Chain::open(2).resolve().unwrap(), 2.0, Direction::Z);
        assert_eq!(density_of(&term, &m), [2.0, 0.0]);
    }
}
