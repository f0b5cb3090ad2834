//! Moments in a field.
//!
//! ```text
//! E = − Σ_i μ_i m_i·B  =  − Σ μ|B| + Σ ½ μ|B| |m_i − B̂|²
//! ```

use super::EnergyTerm;
use super::blocks::Blocks;
use super::spec::{Medium, TermBuilder};
use crate::error::Result;
use crate::field::{Components, ComponentsMut};
use crate::geometry::{Vector, vector};
use crate::lattice::Selection;
use crate::registry::Described;
use crate::units::{FluxDensity, MU_B_MEV_PER_T};
use multiversion::multiversion;
use schemars::JsonSchema;
use serde::Deserialize;
use std::ops::Range;

/// `{"B": ["0 T", "0 T", "-0.1 T"]}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct ZeemanSpec {
    /// The field's components.
    #[schemars(extend("components" = ["x", "y", "z"]))]
    pub B: [FluxDensity; 3],
    /// Only these sites; all if absent.
    #[serde(default)]
    pub sites: Option<Selection>,
}

impl Described for ZeemanSpec {
    const NAME: &'static str = "zeeman";
    const SUMMARY: &'static str = "energy −μ m·B of the moments in a field";
    const EXAMPLE: &'static str = r#"{"zeeman": {"B": ["0 T", "0 T", "-50 mT"]}}"#;
}

impl TermBuilder for ZeemanSpec {
    fn build(&self, medium: &Medium) -> Result<Box<dyn EnergyTerm>> {
        let field = self.B.map(|b| b.0);
        let strength = vector::norm(field);
        let direction = vector::unit(field).unwrap_or([0.0, 0.0, 1.0]);
        let moments = medium.moments_mub()?;
        let mut term = Zeeman { direction, b: vec![0.0; medium.lattice.sites] };
        for i in medium.sites(self.sites.as_ref())? {
            term.b[i] = moments[i] * MU_B_MEV_PER_T * strength;
        }
        Ok(Box::new(term))
    }
}

/// Field energies μ|B| a site (meV) along one direction.
#[derive(Clone, Debug)]
pub struct Zeeman {
    /// Unit vector B̂.
    pub direction: Vector,
    /// μ|B| of each site, not negative.
    pub b: Vec<f64>,
}

impl Zeeman {
    /// The same field energy μB (meV, a vector) on all sites.
    pub fn uniform(sites: usize, b: Vector) -> Zeeman {
        let strength = vector::norm(b);
        Zeeman { direction: vector::unit(b).unwrap_or([0.0, 0.0, 1.0]), b: vec![strength; sites] }
    }
}

/// One component's share: −b m·e = −b + ½ b |m − e|².
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn add_component(b: &[f64], e: f64, x: &[f64], g: &mut [f64], density: &mut [f64]) {
    let n = b.len();
    let (x, g, density) = (&x[..n], &mut g[..n], &mut density[..n]);
    for i in 0..n {
        let d = x[i] - e;
        density[i] += 0.5 * b[i] * d * d;
        g[i] -= b[i] * e;
    }
}

impl EnergyTerm for Zeeman {
    fn name(&self) -> &'static str {
        ZeemanSpec::NAME
    }

    fn sites(&self) -> Option<usize> {
        Some(self.b.len())
    }

    fn reference_mev(&self) -> f64 {
        -self.b.iter().sum::<f64>()
    }

    fn add_gradient(&self, m: Components, g: ComponentsMut, density: &mut [f64], range: Range<usize>) {
        let (b, m, e) = (&self.b[range.clone()], m.range(range), self.direction);
        add_component(b, e[0], m.x, g.x, density);
        add_component(b, e[1], m.y, g.y, density);
        add_component(b, e[2], m.z, g.z, density);
    }

    fn add_hessian_product(&self, _: Components, _: Components, _: ComponentsMut) {}

    fn add_blocks(&self, _: Components, _: &mut Blocks) {}

    fn is_quadratic(&self) -> bool {
        true
    }

    fn axes(&self) -> Vec<Vector> {
        vec![self.direction]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::density_of;
    use crate::lattice::{Chain, SiteMoment};
    use crate::units::Moment;

    #[test]
    fn a_site_with_a_moment_of_its_own_feels_its_own_energy() {
        let mut chain = Chain::open(3);
        chain.moments =
            vec![SiteMoment { sites: Selection::List(vec![1]), moment: Some(Moment(4.0).into()), Ms: None }];
        let lattice = chain.resolve().unwrap();
        let medium = Medium::new(&lattice, Some(Moment(2.0).into()), None);
        assert_eq!(medium.moments_mub().unwrap(), [2.0, 4.0, 2.0]);
        let spec: ZeemanSpec = serde_json::from_str(r#"{"B": ["0 T", "0 T", "1 T"]}"#).unwrap();
        let term = spec.build(&medium).unwrap();
        assert!((term.reference_mev() + 8.0 * MU_B_MEV_PER_T).abs() < 1e-15);
    }

    #[test]
    fn a_moment_along_the_field_is_the_reference_and_against_it_costs_twice_mu_b() {
        let term = Zeeman { direction: [0.0, 0.0, 1.0], b: vec![3.0, 3.0] };
        let density = density_of(&term, &[0.0, 0.0, 0.0, 0.0, 1.0, -1.0]);
        assert_eq!((term.reference_mev(), density), (-6.0, vec![0.0, 6.0]));
    }
}
