//! Uniaxial anisotropy, easy axis or hard axis, with its fourth-order part.
//!
//! ```text
//! E = − Σ_i [ K (m_i·e)² + K₂ (m_i·e)⁴ ]       K > 0: e is an easy axis;  K < 0: a hard axis
//! ```
//! For the form K₁ sin²θ + K₂' sin⁴θ use K = K₁ + 2 K₂', K₂ = − K₂'.

use super::EnergyTerm;
use super::blocks::Blocks;
use super::spec::{Medium, TermBuilder};
use crate::error::Result;
use crate::field::{Components, ComponentsMut};
use crate::geometry::{Direction, Vector, vector};
use crate::lattice::Selection;
use crate::profile::Profile;
use crate::registry::Described;
use crate::units::SiteEnergy;
use multiversion::multiversion;
use schemars::JsonSchema;
use serde::Deserialize;
use std::ops::Range;

/// `{"K": "0.5 meV", "axis": [0, 0, 1]}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct AnisotropySpec {
    /// Energy per site or per volume; positive: easy axis.
    pub K: Profile<SiteEnergy>,
    /// The axis.
    pub axis: Direction,
    /// Fourth-order constant.
    #[serde(default)]
    pub K2: Option<Profile<SiteEnergy>>,
    /// Only these sites; all if absent.
    #[serde(default)]
    pub sites: Option<Selection>,
}

impl Described for AnisotropySpec {
    const NAME: &'static str = "anisotropy";
    const SUMMARY: &'static str = "uniaxial anisotropy −K (m·e)² − K2 (m·e)⁴, K > 0 an easy axis, K < 0 a hard one";
    const EXAMPLE: &'static str = r#"{"anisotropy": {"K": "0.5 meV", "axis": [0, 0, 1], "K2": "0.1 meV"}}"#;
}

impl TermBuilder for AnisotropySpec {
    fn build(&self, medium: &Medium) -> Result<Box<dyn EnergyTerm>> {
        let on_sites = |profile: &Profile<SiteEnergy>, key: &str| {
            medium.on_sites(profile, self.sites.as_ref(), key, |k, i| medium.site_energy_mev(k, i))
        };
        let k = on_sites(&self.K, "K")?;
        let k2 = self.K2.as_ref().map_or(Ok(Vec::new()), |k2| on_sites(k2, "K2"))?;
        let k2 = if k2.iter().all(|k| *k == 0.0) { Vec::new() } else { k2 };
        Ok(Box::new(Anisotropy { axis: self.axis.vector(), k, k2 }))
    }
}

/// Constants a site (meV) about one axis.
#[derive(Clone, Debug)]
pub struct Anisotropy {
    /// Unit vector.
    pub axis: Vector,
    /// K of each site.
    pub k: Vec<f64>,
    /// K₂ of each site; empty where there is none.
    pub k2: Vec<f64>,
}

impl Anisotropy {
    /// The same K (meV) on all sites.
    pub fn uniform(sites: usize, k: f64, axis: Direction) -> Anisotropy {
        Anisotropy { axis: axis.vector(), k: vec![k; sites], k2: Vec::new() }
    }

    /// ∂²E/∂c² of site i, c = m·e.
    fn curvature(&self, i: usize, c: f64) -> f64 {
        -(2.0 * self.k[i] + 12.0 * self.k2.get(i).unwrap_or(&0.0) * c * c)
    }
}

/// The second-order part of a row of sites. Counted as squares of what is small: 1 − c² = |m − c e|².
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn add_quadratic(
    k: &[f64],
    e: Vector,
    m: Components,
    gx: &mut [f64],
    gy: &mut [f64],
    gz: &mut [f64],
    density: &mut [f64],
) {
    let n = k.len();
    let (x, y, z) = (&m.x[..n], &m.y[..n], &m.z[..n]);
    let (gx, gy, gz, density) = (&mut gx[..n], &mut gy[..n], &mut gz[..n], &mut density[..n]);
    for i in 0..n {
        let c = x[i] * e[0] + y[i] * e[1] + z[i] * e[2];
        let (rx, ry, rz) = (x[i] - c * e[0], y[i] - c * e[1], z[i] - c * e[2]);
        let across = rx * rx + ry * ry + rz * rz;
        density[i] += k[i].abs() * if k[i] > 0.0 { across } else { c * c };
        let slope = 2.0 * k[i] * c;
        gx[i] -= slope * e[0];
        gy[i] -= slope * e[1];
        gz[i] -= slope * e[2];
    }
}

/// The fourth-order part of one spin: energy above its reference, and slope along e. 1 − c⁴ = |m − c e|² (1 + c²).
fn quartic(k2: f64, m: Vector, e: Vector) -> (f64, f64) {
    let c = vector::dot(m, e);
    let rest = vector::sub(m, vector::scale(c, e));
    let energy = if k2 > 0.0 { k2 * vector::dot(rest, rest) * (1.0 + c * c) } else { -k2 * c * c * c * c };
    (energy, -4.0 * k2 * c * c * c)
}

impl EnergyTerm for Anisotropy {
    fn name(&self) -> &'static str {
        AnisotropySpec::NAME
    }

    fn sites(&self) -> Option<usize> {
        Some(self.k.len())
    }

    fn fits(&self, sites: usize) -> bool {
        self.k.len() == sites && (self.k2.is_empty() || self.k2.len() == sites)
    }

    fn reference_mev(&self) -> f64 {
        -self.k.iter().chain(&self.k2).map(|k| k.max(0.0)).sum::<f64>()
    }

    fn add_gradient(&self, m: Components, mut g: ComponentsMut, density: &mut [f64], range: Range<usize>) {
        let here = m.range(range.clone());
        add_quadratic(&self.k[range.clone()], self.axis, here, g.x, g.y, g.z, density);
        for (i, k2) in self.k2.get(range).unwrap_or_default().iter().enumerate() {
            let (energy, slope) = quartic(*k2, here.get(i), self.axis);
            density[i] += energy;
            g.add(i, vector::scale(slope, self.axis));
        }
    }

    fn add_hessian_product(&self, m: Components, v: Components, mut out: ComponentsMut) {
        for i in 0..m.sites() {
            let c = vector::dot(m.get(i), self.axis);
            let curvature = self.curvature(i, c);
            out.add(i, vector::scale(curvature * vector::dot(v.get(i), self.axis), self.axis));
        }
    }

    fn add_blocks(&self, m: Components, blocks: &mut Blocks) {
        for i in 0..m.sites() {
            let c = vector::dot(m.get(i), self.axis);
            blocks.add_axial(i, self.curvature(i, c), self.axis);
        }
    }

    fn is_quadratic(&self) -> bool {
        self.k2.iter().all(|k| *k == 0.0)
    }

    fn axes(&self) -> Vec<Vector> {
        vec![self.axis]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::{Hamiltonian, density_of};
    use crate::lattice::Chain;

    #[test]
    fn constants_of_too_few_or_too_many_sites_are_refused() {
        let chain = Chain::open(6).resolve().unwrap();
        for (sites, fits) in [(0, true), (6, true), (3, false), (9, false)] {
            let term = Anisotropy { axis: [0.0, 0.0, 1.0], k: vec![0.5; 6], k2: vec![0.1; sites] };
            assert_eq!(Hamiltonian::new(&chain, vec![Box::new(term)]).is_ok(), fits, "{sites}");
        }
    }

    #[test]
    fn an_easy_axis_costs_k_sine_squared_and_a_hard_axis_k_cosine_squared() {
        let (s, c) = libm::sincos(0.3);
        let m = [s, 0.0, c];
        for (k, k2, expected) in [
            (2.0, 0.0, 2.0 * s * s),
            (-2.0, 0.0, 2.0 * c * c),
            (0.0, 3.0, 3.0 * (1.0 - c.powi(4))),
            (0.0, -3.0, 3.0 * c.powi(4)),
        ] {
            let term = Anisotropy { axis: [0.0, 0.0, 1.0], k: vec![k], k2: vec![k2] };
            let density = density_of(&term, &m);
            assert!((density[0] - expected).abs() < 1e-15);
            let total = -k * c * c - k2 * c.powi(4);
            assert!((term.reference_mev() + density[0] - total).abs() < 1e-15);
        }
    }
}
