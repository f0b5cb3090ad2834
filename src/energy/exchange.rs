//! Heisenberg exchange with any number of neighbour shells.
//!
//! ```text
//! E = − Σ_n Σ_i J_n m_i·m_{i+n}          every bond once; J > 0 ferromagnetic, J < 0 antiferromagnetic
//!   = − Σ |J| + Σ ½|J| |m_i − sgn(J) m_{i+n}|²
//! ∂E/∂m_i = |J| (m_i − sgn(J) m_j)       (a multiple of m_i apart, which spheres do not feel)
//! ```
//! From a continuum stiffness: J = 2 A S/a, with the cross-section S of the bond (see [`Medium`]) and the spacing a. From an energy
//! an area, as interlayer exchange and RKKY are measured: J = J_area S.

use super::EnergyTerm;
use super::blocks::Blocks;
use super::spec::{Medium, TermBuilder};
use crate::error::{Error, Result};
use crate::field::{Components, ComponentsMut};
use crate::geometry::{Vector, vector};
use crate::lattice::{Chain, Selection};
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
    /// Only these bonds (of every shell given); all if absent.
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
    /// Energies (meV) by shell and bond.
    pub fn shells(&self, medium: &Medium) -> Result<Vec<Vec<f64>>> {
        let bonds = self.bonds.as_ref();
        Ok(match (&self.J, &self.A, &self.J_area) {
            (Some(j), None, None) if !j.is_empty() => {
                let shell = |(k, j): (usize, &Profile<Energy>)| {
                    medium.on_bonds(j, k + 1, bonds, &format!("J[{k}]"), |e, _| Ok(e.0))
                };
                j.iter().enumerate().map(shell).collect::<Result<_>>()?
            }
            (Some(_), None, None) => {
                return Err(Error::invalid("J", "the list is empty: give one energy a neighbour shell, [\"10 meV\"]"));
            }
            (None, Some(a), None) => {
                vec![medium.on_bonds(a, 1, bonds, "A", |a, i| medium.bond_from_stiffness_mev(a, i))?]
            }
            (None, None, Some(j)) => {
                vec![medium.on_bonds(j, 1, bonds, "J_area", |j, i| medium.bond_from_area_mev(j, i))?]
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
        Ok(Box::new(Exchange { shells: self.shells(medium)? }))
    }
}

/// Exchange energies: `shells[n − 1][i]` (meV) joins sites i and i + n, 0 where there is no bond.
#[derive(Clone, Debug)]
pub struct Exchange {
    /// One list a shell, one entry a site.
    pub shells: Vec<Vec<f64>>,
}

/// One component's share of one shell, on the run of sites from `lo` on whose partners i ± n need no wrapping.
#[multiversion(targets("x86_64+avx2"))]
fn add_run(n: usize, lo: usize, j: &[f64], x: &[f64], g: &mut [f64], density: &mut [f64]) {
    let hi = lo + g.len();
    let (here, next, previous) = (&x[lo..hi], &x[lo + n..hi + n], &x[lo - n..hi - n]);
    let (jp, jm, density) = (&j[lo..hi], &j[lo - n..hi - n], &mut density[..g.len()]);
    for k in 0..g.len() {
        let up = here[k] - 1f64.copysign(jp[k]) * next[k];
        let down = here[k] - 1f64.copysign(jm[k]) * previous[k];
        density[k] += 0.5 * jp[k].abs() * up * up;
        g[k] += jp[k].abs() * up + jm[k].abs() * down;
    }
}

impl Exchange {
    /// The same energies on all bonds: `j[n − 1]` (meV) for shell n.
    pub fn uniform(chain: &Chain, j: &[f64]) -> Exchange {
        let shell =
            |(k, j): (usize, &f64)| (0..chain.sites).map(|i| if i < chain.bonds(k + 1) { *j } else { 0.0 }).collect();
        Exchange { shells: j.iter().enumerate().map(shell).collect() }
    }

    /// m_i − sgn(J) m_j.
    fn deviation(m: &Components, j: f64, a: usize, b: usize) -> Vector {
        let s = 1f64.copysign(j);
        vector::sub(m.get(a), vector::scale(s, m.get(b)))
    }

    /// Gradient and energy of one site near an end, where partners wrap or are missing.
    fn edge(j: &[f64], n: usize, m: &Components, i: usize) -> (Vector, f64) {
        let sites = j.len();
        let (next, previous) = ((i + n) % sites, (i + sites - n % sites) % sites);
        let (mut g, mut e) = ([0.0; 3], 0.0);
        if j[i] != 0.0 {
            let d = Exchange::deviation(m, j[i], i, next);
            e = 0.5 * j[i].abs() * vector::dot(d, d);
            g = vector::scale(j[i].abs(), d);
        }
        if j[previous] != 0.0 {
            let d = Exchange::deviation(m, j[previous], i, previous);
            g = vector::add(g, vector::scale(j[previous].abs(), d));
        }
        (g, e)
    }
}

impl EnergyTerm for Exchange {
    fn name(&self) -> &'static str {
        ExchangeSpec::NAME
    }

    fn reference_mev(&self) -> f64 {
        -self.shells.iter().flatten().map(|j| j.abs()).sum::<f64>()
    }

    fn add_gradient(&self, m: Components, mut g: ComponentsMut, density: &mut [f64], range: Range<usize>) {
        let (first, last) = (range.start, range.end);
        for (k, j) in self.shells.iter().enumerate() {
            let (n, sites) = (k + 1, j.len());
            let lo = first.max(n).min(last);
            let hi = last.min(sites.saturating_sub(n)).max(lo);
            for i in (first..lo).chain(hi..last) {
                let (v, e) = Exchange::edge(j, n, &m, i);
                g.add(i - first, v);
                density[i - first] += e;
            }
            let run = lo - first..hi - first;
            if !run.is_empty() {
                add_run(n, lo, j, m.x, &mut g.x[run.clone()], &mut density[run.clone()]);
                add_run(n, lo, j, m.y, &mut g.y[run.clone()], &mut density[run.clone()]);
                add_run(n, lo, j, m.z, &mut g.z[run.clone()], &mut density[run]);
            }
        }
    }

    fn add_hessian_product(&self, _: Components, v: Components, mut out: ComponentsMut) {
        for (k, j) in self.shells.iter().enumerate() {
            let (n, sites) = (k + 1, j.len());
            for i in 0..sites {
                if j[i] != 0.0 {
                    let next = (i + n) % sites;
                    let d = vector::scale(j[i].abs(), Exchange::deviation(&v, j[i], i, next));
                    out.add(i, d);
                    out.add(next, vector::scale(-1f64.copysign(j[i]), d));
                }
            }
        }
    }

    fn add_blocks(&self, _: Components, blocks: &mut Blocks) {
        for (k, j) in self.shells.iter().enumerate() {
            let (n, sites) = (k + 1, j.len());
            for i in 0..sites {
                if j[i] != 0.0 {
                    blocks.add_isotropic(i, j[i].abs());
                    blocks.add_isotropic((i + n) % sites, j[i].abs());
                    blocks.bond[k].isotropic[i] -= j[i];
                }
            }
        }
    }

    fn reach(&self) -> usize {
        self.shells.len()
    }

    fn axes(&self) -> Vec<Vector> {
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::density_of;

    #[test]
    fn two_spins_at_right_angles_cost_the_bond_energy_and_an_antiferromagnet_prefers_opposite_ones() {
        let m = [1.0, 0.0, 0.0, 1.0, 0.0, 0.0];
        let term = Exchange { shells: vec![vec![3.0, 0.0]] };
        assert_eq!((term.reference_mev(), density_of(&term, &m)), (-3.0, vec![3.0, 0.0]));
        let opposite = [0.0, 0.0, 0.0, 0.0, 1.0, -1.0];
        assert_eq!(density_of(&Exchange { shells: vec![vec![-3.0, 0.0]] }, &opposite), [0.0; 2]);
    }

    #[test]
    fn an_exchange_an_area_is_taken_times_the_section_of_its_bond() {
        let read = |text: &str| serde_json::from_str::<ExchangeSpec>(text).unwrap();
        let chain: Chain = serde_json::from_str(
            r#"{"sites": 3, "spacing": "1 nm", "cross_section": [["10 nm", "10 nm", "30 nm"], "4 nm"]}"#,
        )
        .unwrap();
        let medium = Medium::new(&chain, None, None);
        let coupling = |bond: usize| {
            let spec = read(&format!(r#"{{"J_area": "-5 mJ/m^2", "bonds": [{bond}]}}"#));
            -spec.build(&medium).unwrap().reference_mev()
        };
        // 5 mJ/m² is 31.2075… meV/nm²; unequal sections have their harmonic mean, 60 nm²
        let density = 5.0 / 0.1602176634;
        assert!((coupling(0) - 40.0 * density).abs() < 1e-9, "{}", coupling(0));
        assert!((coupling(1) - 60.0 * density).abs() < 1e-9, "{}", coupling(1));
        let bare = Chain { cross_section: None, ..chain.clone() };
        let medium = Medium::new(&bare, None, None);
        let said = read(r#"{"J_area": "5 mJ/m^2"}"#).build(&medium).unwrap_err().to_string();
        assert!(said.starts_with("J_area") && said.contains("cross_section"), "{said}");
    }
}
