//! Cubic anisotropy.
//!
//! ```text
//! E = Σ_i K (α₁²α₂² + α₂²α₃² + α₃²α₁²)        α_k = m·e_k;  K > 0: the cube edges are easy,  K < 0: its diagonals
//! ```

use super::EnergyTerm;
use super::blocks::{Block, Blocks, multiply};
use super::spec::{Medium, TermBuilder};
use crate::error::{Error, Result};
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

/// `{"K": "48 kJ/m^3", "axes": [[1, 0, 0], [0, 1, 0]]}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct CubicAnisotropySpec {
    /// Energy per site or per volume.
    pub K: Profile<SiteEnergy>,
    /// Two cube axes at right angles, the third follows; x and y if absent.
    #[serde(default)]
    pub axes: Option<[Direction; 2]>,
    /// Only these sites; all if absent.
    #[serde(default)]
    pub sites: Option<Selection>,
}

impl Described for CubicAnisotropySpec {
    const NAME: &'static str = "cubic_anisotropy";
    const SUMMARY: &'static str = "cubic anisotropy K (α₁²α₂² + α₂²α₃² + α₃²α₁²)";
    const EXAMPLE: &'static str = r#"{"cubic_anisotropy": {"K": "0.2 meV", "axes": [[1, 1, 0], [-1, 1, 0]]}}"#;
}

impl TermBuilder for CubicAnisotropySpec {
    fn build(&self, medium: &Medium) -> Result<Box<dyn EnergyTerm>> {
        let k = medium.on_sites(&self.K, self.sites.as_ref(), "K", |k, i| medium.site_energy_mev(k, i))?;
        let [a, b] = self.axes.unwrap_or([Direction::X, Direction::Y]).map(|d| d.vector());
        if vector::dot(a, b).abs() > 1e-6 {
            return Err(Error::invalid("axes[1]", "the two cube axes must be at right angles"));
        }
        let third = vector::cross(a, b);
        Ok(Box::new(CubicAnisotropy { axes: [a, vector::cross(third, a), third], k }))
    }
}

/// Constants a site (meV) about three axes at right angles.
#[derive(Clone, Debug)]
pub struct CubicAnisotropy {
    /// Unit vectors e₁, e₂, e₃.
    pub axes: [Vector; 3],
    /// K of each site.
    pub k: Vec<f64>,
}

impl CubicAnisotropy {
    fn cosines(&self, m: Vector) -> Vector {
        self.axes.map(|e| vector::dot(m, e))
    }

    fn curvature(&self, i: usize, m: Vector) -> Block {
        let a = self.cosines(m);
        let mut block = [[0.0; 3]; 3];
        for e in 0..3 {
            for f in 0..3 {
                let others: f64 = (0..3).filter(|&o| o != e).map(|o| a[o] * a[o]).sum();
                let h = if e == f { 2.0 * others } else { 4.0 * a[e] * a[f] };
                for r in 0..3 {
                    for c in 0..3 {
                        block[r][c] += self.k[i] * h * self.axes[e][r] * self.axes[f][c];
                    }
                }
            }
        }
        block
    }
}

/// A row of sites. For K < 0 the energy is counted from the diagonal's ⅓: ⅓ − Σ α_i²α_j² = ⅙ Σ (α_i² − α_j²)².
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn add_row(
    k: &[f64],
    axes: [Vector; 3],
    m: Components,
    gx: &mut [f64],
    gy: &mut [f64],
    gz: &mut [f64],
    density: &mut [f64],
) {
    let n = k.len();
    let (x, y, z) = (&m.x[..n], &m.y[..n], &m.z[..n]);
    let (gx, gy, gz, density) = (&mut gx[..n], &mut gy[..n], &mut gz[..n], &mut density[..n]);
    let [e, f, h] = axes;
    for i in 0..n {
        let a = x[i] * e[0] + y[i] * e[1] + z[i] * e[2];
        let b = x[i] * f[0] + y[i] * f[1] + z[i] * f[2];
        let c = x[i] * h[0] + y[i] * h[1] + z[i] * h[2];
        let (p, q, r) = (a * a, b * b, c * c);
        let uneven = (p - q) * (p - q) + (q - r) * (q - r) + (r - p) * (r - p);
        density[i] += k[i].abs() * if k[i] > 0.0 { p * q + q * r + r * p } else { uneven / 6.0 };
        let (s, t, u) = (2.0 * k[i] * a * (q + r), 2.0 * k[i] * b * (r + p), 2.0 * k[i] * c * (p + q));
        gx[i] += s * e[0] + t * f[0] + u * h[0];
        gy[i] += s * e[1] + t * f[1] + u * h[1];
        gz[i] += s * e[2] + t * f[2] + u * h[2];
    }
}

impl EnergyTerm for CubicAnisotropy {
    fn name(&self) -> &'static str {
        CubicAnisotropySpec::NAME
    }

    fn sites(&self) -> Option<usize> {
        Some(self.k.len())
    }

    fn reference_mev(&self) -> f64 {
        self.k.iter().map(|k| k.min(0.0) / 3.0).sum()
    }

    fn add_gradient(&self, m: Components, g: ComponentsMut, density: &mut [f64], range: Range<usize>) {
        add_row(&self.k[range.clone()], self.axes, m.range(range), g.x, g.y, g.z, density);
    }

    fn add_hessian_product(&self, m: Components, v: Components, mut out: ComponentsMut) {
        for i in 0..m.sites() {
            out.add(i, multiply(&self.curvature(i, m.get(i)), v.get(i)));
        }
    }

    fn add_blocks(&self, m: Components, blocks: &mut Blocks) {
        for i in 0..m.sites() {
            blocks.add_site(i, self.curvature(i, m.get(i)));
        }
    }

    fn is_quadratic(&self) -> bool {
        self.k.iter().all(|k| *k == 0.0)
    }

    fn axes(&self) -> Vec<Vector> {
        self.axes.to_vec()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::density_of;

    #[test]
    fn an_edge_costs_nothing_a_face_diagonal_a_quarter_and_a_body_diagonal_a_third() {
        let term = |k| CubicAnisotropy { axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], k: vec![k] };
        let (f, b) = (0.5f64.sqrt(), (1.0f64 / 3.0).sqrt());
        for k in [2.0, -2.0] {
            for (m, share) in [([0.0, 1.0, 0.0], 0.0), ([f, f, 0.0], 0.25), ([b, -b, b], 1.0 / 3.0)] {
                let density = density_of(&term(k), &m);
                assert!((term(k).reference_mev() + density[0] - k * share).abs() < 1e-15);
            }
        }
    }
}
