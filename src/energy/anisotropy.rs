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
use crate::linalg::slab::accumulate;
use crate::registry::Described;
use crate::units::SiteEnergy;
use serde::Deserialize;
use std::ops::Range;

/// `{"K": "0.5 meV", "axis": [0, 0, 1]}`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct AnisotropySpec {
    /// Energy per site or per volume; positive: easy axis.
    pub K: SiteEnergy,
    /// The axis.
    pub axis: Direction,
    /// Fourth-order constant.
    #[serde(default)]
    pub K2: Option<SiteEnergy>,
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
        let k = medium.site_energy_mev(self.K).map_err(|e| e.within("K"))?;
        let k2 = self.K2.map_or(Ok(0.0), |k2| medium.site_energy_mev(k2)).map_err(|e| e.within("K2"))?;
        let mut term = Anisotropy {
            axis: self.axis.vector(),
            k: vec![0.0; medium.chain.sites],
            k2: vec![0.0; medium.chain.sites],
        };
        for i in medium.sites(self.sites.as_ref())? {
            (term.k[i], term.k2[i]) = (k, k2);
        }
        Ok(Box::new(term))
    }
}

/// Constants a site (meV) about one axis.
#[derive(Clone, Debug)]
pub struct Anisotropy {
    /// Unit vector.
    pub axis: Vector,
    /// K of each site.
    pub k: Vec<f64>,
    /// K₂ of each site.
    pub k2: Vec<f64>,
}

impl Anisotropy {
    /// The same K (meV) on all sites.
    pub fn uniform(sites: usize, k: f64, axis: Direction) -> Anisotropy {
        Anisotropy { axis: axis.vector(), k: vec![k; sites], k2: vec![0.0; sites] }
    }

    /// Energy of one spin above its reference, as squares of what is small: 1 − c² = |m − c e|².
    #[inline]
    fn site(k: f64, k2: f64, c: f64, rest2: f64) -> f64 {
        let quadratic = if k > 0.0 { k * rest2 } else { -k * c * c };
        let quartic = if k2 > 0.0 { k2 * rest2 * (1.0 + c * c) } else { -k2 * c * c * c * c };
        quadratic + quartic
    }
}

impl EnergyTerm for Anisotropy {
    fn name(&self) -> &'static str {
        AnisotropySpec::NAME
    }

    fn reference_mev(&self) -> f64 {
        -self.k.iter().chain(&self.k2).map(|k| k.max(0.0)).sum::<f64>()
    }

    fn add_density(&self, m: Components, density: &mut [f64]) {
        for i in 0..m.sites() {
            let c = vector::dot(m.get(i), self.axis);
            let rest = vector::sub(m.get(i), vector::scale(c, self.axis));
            density[i] += Anisotropy::site(self.k[i], self.k2[i], c, vector::dot(rest, rest));
        }
    }

    fn add_gradient(&self, m: Components, g: ComponentsMut, range: Range<usize>) -> f64 {
        let (lo, hi, len) = (range.start, range.end, range.len());
        let [ex, ey, ez] = self.axis;
        let (x, y, z) = (&m.x[lo..hi], &m.y[lo..hi], &m.z[lo..hi]);
        let (k1, k2) = (&self.k[lo..hi], &self.k2[lo..hi]);
        let (gx, gy, gz) = (&mut g.x[..len], &mut g.y[..len], &mut g.z[..len]);
        let at = |i: usize, lane: &mut f64| {
            let c = x[i] * ex + y[i] * ey + z[i] * ez;
            let (rx, ry, rz) = (x[i] - c * ex, y[i] - c * ey, z[i] - c * ez);
            *lane += Anisotropy::site(k1[i], k2[i], c, rx * rx + ry * ry + rz * rz);
            let slope = -(2.0 * k1[i] * c + 4.0 * k2[i] * c * c * c);
            gx[i] += slope * ex;
            gy[i] += slope * ey;
            gz[i] += slope * ez;
        };
        accumulate(len, at)
    }

    fn add_hessian_product(&self, m: Components, v: Components, mut out: ComponentsMut) {
        for i in 0..m.sites() {
            let c = vector::dot(m.get(i), self.axis);
            let curvature = -(2.0 * self.k[i] + 12.0 * self.k2[i] * c * c);
            out.add(i, vector::scale(curvature * vector::dot(v.get(i), self.axis), self.axis));
        }
    }

    fn add_blocks(&self, m: Components, blocks: &mut Blocks) {
        for i in 0..m.sites() {
            let c = vector::dot(m.get(i), self.axis);
            blocks.add_axial(i, -(2.0 * self.k[i] + 12.0 * self.k2[i] * c * c), self.axis);
        }
    }

    fn reach(&self) -> usize {
        0
    }

    fn is_quadratic(&self) -> bool {
        self.k2.iter().all(|k| *k == 0.0)
    }

    fn invariant_about(&self, axis: Vector) -> bool {
        let nothing = self.k.iter().chain(&self.k2).all(|k| *k == 0.0);
        nothing || vector::norm(vector::cross(axis, self.axis)) < 1e-14
    }

    fn axes(&self) -> Vec<Vector> {
        vec![self.axis]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
            let mut density = [0.0];
            term.add_density(Components::new(&m), &mut density);
            assert!((density[0] - expected).abs() < 1e-15);
            let total = -k * c * c - k2 * c.powi(4);
            assert!((term.reference_mev() + density[0] - total).abs() < 1e-15);
        }
    }
}
