//! Biquadratic exchange.
//!
//! ```text
//! E = − Σ_n Σ B_n (m_i·m_j)²              every bond i–j of shell n once; B > 0: neighbours along one line, B < 0: at right angles
//! 1 − (m_i·m_j)² = |m_i × m_j|²
//! ∂E/∂m_i = − 2 B c m_j,  ∂²E/∂m_i∂m_i = − 2 B m_j m_jᵀ,  ∂²E/∂m_i∂m_j = − 2 B (c 1 + m_j m_iᵀ)          c = m_i·m_j
//! ```

use super::EnergyTerm;
use super::blocks::Blocks;
use super::by_shell::ByShell;
use super::choice::{Choice, Valued};
use super::couplings::Couplings;
use super::spec::{Medium, TermBuilder};
use crate::error::Result;
use crate::field::{Components, ComponentsMut};
use crate::geometry::{Vector, vector};
use crate::lattice::{BondFamily, Lattice, Selection, at};
use crate::registry::Described;
use crate::units::Energy;
use schemars::JsonSchema;
use serde::Deserialize;
use std::ops::Range;

/// `{"B": ["0.3 meV"]}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct BiquadraticSpec {
    /// Energy per bond of the nearest neighbours, or a list by shell.
    pub B: ByShell<Energy>,
    /// Only bonds with both ends among these sites; all if absent.
    #[serde(default)]
    pub sites: Option<Selection>,
    /// Only bonds from the first of these to the second, with shells of their own.
    #[serde(default)]
    pub between: Option<[Selection; 2]>,
}

impl Described for BiquadraticSpec {
    const NAME: &'static str = "biquadratic";
    const SUMMARY: &'static str = "biquadratic exchange −B (m_i·m_j)² of any neighbour shells";
    const EXAMPLE: &'static str = r#"{"biquadratic": {"B": ["0.3 meV"]}}"#;
}

impl TermBuilder for BiquadraticSpec {
    fn build(&self, medium: &Medium) -> Result<Box<dyn EnergyTerm>> {
        let choice = Choice { sites: self.sites.as_ref(), between: self.between.as_ref(), bonds: None };
        let shells =
            self.B.shells("B")?.into_iter().map(|(shell, key, profile)| {
                Ok(Valued { profile, families: medium.shell(shell, &key, &choice)?, key })
            });
        let shells = shells.collect::<Result<_>>()?;
        let families = medium.on_shells(shells, &choice, |e: Energy, _| Ok(e.0))?;
        Ok(Box::new(Biquadratic { families }))
    }
}

/// Biquadratic energies.
#[derive(Clone, Debug)]
pub struct Biquadratic {
    /// Those of each family of bonds.
    pub families: Vec<Couplings>,
}

impl Biquadratic {
    /// The same energies on all bonds: `b[n − 1]` (meV) for shell n.
    pub fn uniform(lattice: &Lattice, b: &[f64]) -> Biquadratic {
        let families = b.iter().enumerate().flat_map(|(k, b)| Couplings::uniform(lattice, k + 1, *b));
        Biquadratic { families: families.collect() }
    }

    fn bonds(&self) -> impl Iterator<Item = ([usize; 2], f64)> + '_ {
        self.families.iter().flat_map(Couplings::bonds)
    }
}

/// ∂E/∂m of a site with a partner.
fn pull(b: f64, own: Vector, partner: Vector) -> Vector {
    vector::scale(-2.0 * b * vector::dot(own, partner), partner)
}

/// The energy of a bond above its reference.
fn above(b: f64, p: Vector, q: Vector) -> f64 {
    let (cross, c) = (vector::cross(p, q), vector::dot(p, q));
    b.abs() * if b > 0.0 { vector::dot(cross, cross) } else { c * c }
}

impl EnergyTerm for Biquadratic {
    fn name(&self) -> &'static str {
        BiquadraticSpec::NAME
    }

    fn sites(&self) -> Option<usize> {
        Couplings::sites(&self.families)
    }

    fn fits(&self, sites: usize) -> bool {
        Couplings::fit(&self.families, sites)
    }

    fn reference_mev(&self) -> f64 {
        self.bonds().map(|(_, b)| -b.max(0.0)).sum()
    }

    fn add_gradient(&self, m: Components, mut g: ComponentsMut, density: &mut [f64], range: Range<usize>) {
        let first = range.start;
        for Couplings { family, mev: b } in &self.families {
            for segment in family.segments(range.clone()) {
                for i in segment.sites.clone() {
                    let own = m.get(i);
                    if let Some(next) = segment.next.map(|n| m.get(at(i, n))) {
                        g.add(i - first, pull(b[i], own, next));
                        density[i - first] += above(b[i], own, next);
                    }
                    if let Some(k) = segment.previous.map(|n| at(i, n)) {
                        g.add(i - first, pull(b[k], own, m.get(k)));
                    }
                }
            }
        }
    }

    fn add_hessian_product(&self, m: Components, v: Components, mut out: ComponentsMut) {
        for ([i, j], b) in self.bonds() {
            let (p, q, u, w) = (m.get(i), m.get(j), v.get(i), v.get(j));
            let turned = vector::dot(u, q) + vector::dot(p, w);
            let c = vector::dot(p, q);
            for (to, other, moved) in [(i, q, w), (j, p, u)] {
                out.add(
                    to,
                    vector::scale(-2.0 * b, vector::add(vector::scale(turned, other), vector::scale(c, moved))),
                );
            }
        }
    }

    fn add_blocks(&self, m: Components, blocks: &mut Blocks) {
        for couplings in &self.families {
            for ([i, j], b) in couplings.bonds() {
                blocks.add_axial(i, -2.0 * b, m.get(j));
                blocks.add_axial(j, -2.0 * b, m.get(i));
            }
            let Some(bonds) = blocks.of(&couplings.family) else { continue };
            for ([i, j], b) in couplings.bonds() {
                let (p, q) = (m.get(i), m.get(j));
                bonds.isotropic[i] -= 2.0 * b * vector::dot(p, q);
                bonds.add(i, q.map(|q| vector::scale(-2.0 * b * q, p)));
            }
        }
    }

    fn families(&self) -> Vec<&BondFamily> {
        self.families.iter().map(|c| &c.family).collect()
    }

    fn is_quadratic(&self) -> bool {
        self.bonds().next().is_none()
    }

    fn axes(&self) -> Vec<Vector> {
        Vec::new()
    }
}
