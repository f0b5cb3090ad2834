//! Heisenberg exchange with any number of neighbour shells.
//!
//! ```text
//! E = − Σ_n Σ_i J_n m_i·m_j              every bond i–j of shell n once; J > 0 ferromagnetic, J < 0 antiferromagnetic
//!   = − Σ |J| + Σ ½|J| |m_i − sgn(J) m_j|²
//! ∂E/∂m_i = |J| (m_i − sgn(J) m_j)       (a multiple of m_i apart, which spheres do not feel)
//! ```
//! From a continuum stiffness: J = 2 A S/a, with the cross-section S of the bond (see [`Lattice::bond_section_nm2`]) and the spacing a. From an energy
//! an area, as interlayer exchange and RKKY are measured: J = J_area S.

use super::EnergyTerm;
use super::blocks::Blocks;
use super::choice::{Choice, Valued};
use super::couplings::Couplings;
use super::spec::{Medium, TermBuilder};
use crate::error::{Error, Result};
use crate::field::{Components, ComponentsMut};
use crate::geometry::Vector;
use crate::lattice::{BondFamily, Lattice, Selection, at};
use crate::profile::Profile;
use crate::registry::Described;
use crate::units::{Energy, ExchangeStiffness, SurfaceEnergy};
use multiversion::multiversion;
use schemars::JsonSchema;
use serde::Deserialize;
use std::ops::Range;

/// `{"J": ["10 meV", "-1 meV"]}`, `{"A": "13 pJ/m"}` or `{"J_area": "5 mJ/m^2", "bonds": [19]}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct ExchangeSpec {
    /// Bond energies of the nearest, next … neighbours.
    #[serde(default)]
    pub J: Option<Vec<Profile<Energy>>>,
    /// Exchange stiffness of a continuum.
    #[serde(default)]
    pub A: Option<Profile<ExchangeStiffness>>,
    /// Exchange an area of the cross-section, between layers.
    #[serde(default)]
    pub J_area: Option<Profile<SurfaceEnergy>>,
    /// Only bonds with both ends among these sites; all if absent.
    #[serde(default)]
    pub sites: Option<Selection>,
    /// Only bonds from the first of these to the second, with shells of their own.
    #[serde(default)]
    pub between: Option<[Selection; 2]>,
    /// Only these bonds of a chain (of every shell given); all if absent.
    #[serde(default)]
    pub bonds: Option<Selection>,
}

impl Described for ExchangeSpec {
    const NAME: &'static str = "exchange";
    const SUMMARY: &'static str =
        "Heisenberg exchange −J m_i·m_j of any neighbour shells, a stiffness A, or J_area an area between layers";
    const EXAMPLE: &'static str = r#"{"exchange": {"J": ["10 meV", "-1 meV"]}}"#;
}

impl ExchangeSpec {
    /// Energies family by family.
    pub fn couplings(&self, medium: &Medium) -> Result<Vec<Couplings>> {
        let choice = Choice { sites: self.sites.as_ref(), between: self.between.as_ref(), bonds: self.bonds.as_ref() };
        Ok(match (&self.J, &self.A, &self.J_area) {
            (Some(j), None, None) if !j.is_empty() => {
                let shells = j.iter().enumerate().map(|(k, profile)| {
                    let key = format!("J[{k}]");
                    Ok(Valued { profile, families: medium.shell(k + 1, &key, &choice)?, key })
                });
                medium.on_shells(shells.collect::<Result<_>>()?, &choice, |e, _| Ok(e.0))?
            }
            (Some(_), None, None) => {
                return Err(Error::invalid("J", "the list is empty: give one energy a neighbour shell, [\"10 meV\"]"));
            }
            (None, Some(a), None) => {
                let faces = medium.faces("A")?;
                medium.on_bonds(a, faces, &choice, "A", |a, bond| medium.bond_from_stiffness_mev(a, bond))?
            }
            (None, None, Some(j)) => {
                let faces = medium.faces("J_area")?;
                medium.on_bonds(j, faces, &choice, "J_area", |j, bond| medium.bond_from_area_mev(j, bond))?
            }
            (None, None, None) => {
                let message =
                    "an exchange needs \"J\" (bond energies), \"A\" (a stiffness) or \"J_area\" (between layers)";
                return Err(Error::invalid("", message));
            }
            (Some(_), Some(_), None) => {
                return Err(Error::invalid("A", "\"J\" and \"A\" are two ways to say the same: keep one"));
            }
            (_, _, Some(_)) => {
                let message = "\"J\", \"A\" and \"J_area\" are ways to say the same: keep one, and give other bonds a term of their own";
                return Err(Error::invalid("J_area", message));
            }
        })
    }
}

impl TermBuilder for ExchangeSpec {
    fn build(&self, medium: &Medium) -> Result<Box<dyn EnergyTerm>> {
        Ok(Box::new(Exchange { families: self.couplings(medium)? }))
    }
}

/// Exchange energies.
#[derive(Clone, Debug)]
pub struct Exchange {
    /// Those of each family of bonds.
    pub families: Vec<Couplings>,
}

/// One family's share on a run of sites, from the first on, whose partners ahead and behind are runs of as many.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn add_run(
    [first, ahead, behind]: [usize; 3],
    j: &[f64],
    m: Components,
    gx: &mut [f64],
    gy: &mut [f64],
    gz: &mut [f64],
    density: &mut [f64],
) {
    // all of one length to the compiler too, or it keeps the last of each run for a slower loop
    let n = gx.len();
    let [here, next, previous] = [first, ahead, behind].map(|k| m.range(k..k + n));
    let (jp, jm) = (&j[first..][..n], &j[behind..][..n]);
    let (gy, gz, density) = (&mut gy[..n], &mut gz[..n], &mut density[..n]);
    for i in 0..n {
        let (p, q, s, t) = (jp[i].abs(), jm[i].abs(), 1f64.copysign(jp[i]), 1f64.copysign(jm[i]));
        let (ux, uy, uz) = (here.x[i] - s * next.x[i], here.y[i] - s * next.y[i], here.z[i] - s * next.z[i]);
        gx[i] += p * ux + q * (here.x[i] - t * previous.x[i]);
        gy[i] += p * uy + q * (here.y[i] - t * previous.y[i]);
        gz[i] += p * uz + q * (here.z[i] - t * previous.z[i]);
        density[i] = density[i] + 0.5 * p * ux * ux + 0.5 * p * uy * uy + 0.5 * p * uz * uz;
    }
}

/// Its share on a run of sites with partners on one side only; the energy is there if the bonds are of these sites.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn add_side(
    [first, other]: [usize; 2],
    j: &[f64],
    m: Components,
    gx: &mut [f64],
    gy: &mut [f64],
    gz: &mut [f64],
    density: Option<&mut [f64]>,
) {
    let n = gx.len();
    let [here, there] = [first, other].map(|k| m.range(k..k + n));
    let (j, gy, gz) = (&j[..n], &mut gy[..n], &mut gz[..n]);
    for i in 0..n {
        let (p, s) = (j[i].abs(), 1f64.copysign(j[i]));
        gx[i] += p * (here.x[i] - s * there.x[i]);
        gy[i] += p * (here.y[i] - s * there.y[i]);
        gz[i] += p * (here.z[i] - s * there.z[i]);
    }
    let Some(density) = density else { return };
    let density = &mut density[..n];
    for i in 0..n {
        let (p, s) = (j[i].abs(), 1f64.copysign(j[i]));
        let (ux, uy, uz) = (here.x[i] - s * there.x[i], here.y[i] - s * there.y[i], here.z[i] - s * there.z[i]);
        density[i] += 0.5 * p * (ux * ux + uy * uy + uz * uz);
    }
}

impl Exchange {
    /// The same energies on all bonds: `j[n − 1]` (meV) for shell n.
    pub fn uniform(lattice: &Lattice, j: &[f64]) -> Exchange {
        let families = j.iter().enumerate().flat_map(|(k, j)| Couplings::uniform(lattice, k + 1, *j));
        Exchange { families: families.collect() }
    }
}

impl EnergyTerm for Exchange {
    fn name(&self) -> &'static str {
        ExchangeSpec::NAME
    }

    fn sites(&self) -> Option<usize> {
        Couplings::sites(&self.families)
    }

    fn fits(&self, sites: usize) -> bool {
        Couplings::fit(&self.families, sites)
    }

    fn reference_mev(&self) -> f64 {
        -self.families.iter().flat_map(|c| &c.mev).map(|j| j.abs()).sum::<f64>()
    }

    fn add_gradient(&self, m: Components, g: ComponentsMut, density: &mut [f64], range: Range<usize>) {
        let first = range.start;
        for Couplings { family, mev: j } in &self.families {
            for segment in family.segments(range.clone()) {
                let (start, run) = (segment.sites.start, segment.sites.start - first..segment.sites.end - first);
                let [x, y, z] = [&mut *g.x, &mut *g.y, &mut *g.z].map(|c| &mut c[run.clone()]);
                let (density, partner) = (&mut density[run], |offset| at(start, offset));
                match (segment.next.map(partner), segment.previous.map(partner)) {
                    (Some(next), Some(previous)) => add_run([start, next, previous], j, m, x, y, z, density),
                    (Some(next), None) => add_side([start, next], &j[start..], m, x, y, z, Some(density)),
                    (None, Some(previous)) => add_side([start, previous], &j[previous..], m, x, y, z, None),
                    (None, None) => {}
                }
            }
        }
    }

    fn add_hessian_product(&self, _: Components, v: Components, out: ComponentsMut) {
        super::add_linear(self, v, out);
    }

    fn add_blocks(&self, _: Components, blocks: &mut Blocks) {
        for couplings in &self.families {
            for ([i, next], j) in couplings.bonds() {
                blocks.add_isotropic(i, j.abs());
                blocks.add_isotropic(next, j.abs());
            }
            let Some(bonds) = blocks.of(&couplings.family) else { continue };
            couplings.bonds().for_each(|([i, _], j)| bonds.isotropic[i] -= j);
        }
    }

    fn families(&self) -> Vec<&BondFamily> {
        self.families.iter().map(|c| &c.family).collect()
    }

    fn is_quadratic(&self) -> bool {
        true
    }

    fn axes(&self) -> Vec<Vector> {
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::density_of;
    use crate::lattice::Chain;

    #[test]
    fn two_spins_at_right_angles_cost_the_bond_energy_and_an_antiferromagnet_prefers_opposite_ones() {
        let m = [1.0, 0.0, 0.0, 1.0, 0.0, 0.0];
        let pair = Chain::open(2).resolve().unwrap();
        let term = Exchange::uniform(&pair, &[3.0]);
        assert_eq!((term.reference_mev(), density_of(&term, &m)), (-3.0, vec![3.0, 0.0]));
        let opposite = [0.0, 0.0, 0.0, 0.0, 1.0, -1.0];
        assert_eq!(density_of(&Exchange::uniform(&pair, &[-3.0]), &opposite), [0.0; 2]);
    }

    #[test]
    fn an_exchange_an_area_is_taken_times_the_section_of_its_bond() {
        let read = |text: &str| serde_json::from_str::<ExchangeSpec>(text).unwrap();
        let chain: Chain = serde_json::from_str(
            r#"{"sites": 3, "spacing": "1 nm", "cross_section": [["10 nm", "10 nm", "30 nm"], "4 nm"]}"#,
        )
        .unwrap();
        let lattice = chain.resolve().unwrap();
        let medium = Medium::new(&lattice, None, None);
        let coupling = |bond: usize| {
            let spec = read(&format!(r#"{{"J_area": "-5 mJ/m^2", "bonds": [{bond}]}}"#));
            -spec.build(&medium).unwrap().reference_mev()
        };
        // 5 mJ/m² is 31.2075… meV/nm²; unequal sections have their harmonic mean, 60 nm²
        let density = 5.0 / 0.1602176634;
        assert!((coupling(0) - 40.0 * density).abs() < 1e-9, "{}", coupling(0));
        assert!((coupling(1) - 60.0 * density).abs() < 1e-9, "{}", coupling(1));
        let bare = Chain { cross_section: None, ..chain.clone() };
        let lattice = bare.resolve().unwrap();
        let medium = Medium::new(&lattice, None, None);
        let said = read(r#"{"J_area": "5 mJ/m^2"}"#).build(&medium).unwrap_err().to_string();
        assert!(said.starts_with("J_area") && said.contains("cross_section"), "{said}");
    }
}
