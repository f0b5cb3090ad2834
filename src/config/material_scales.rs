//! What follows from a material's numbers alone, for lists.
//!
//! ```text
//! l_ex = √(2A/μ₀Ms²)      δ = √(A/|K|), or √(J/2K) sites      σ = 4√(AK), or 2√(2JK) a chain       (K uniaxial in σ)
//! ```
//! 2K is the curvature at the minimum: of a cubic K < 0, whose diagonals are easy, K is ⅔ of it here.

use super::Material;
use crate::energy::{AnisotropySpec, TermSpec};
use crate::profile::Profile;
use crate::units::{Energy, MU_0, SiteEnergy};

/// Lengths and energies of a material; nothing where its numbers do not say.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MaterialScales {
    /// Exchange length of a continuum (nm).
    pub exchange_length_nm: Option<f64>,
    /// Wall width δ of a continuum (nm).
    pub wall_width_nm: Option<f64>,
    /// Wall width δ of a chain of atoms, in sites.
    pub wall_width_sites: Option<f64>,
    /// Energy of a wall of a continuum (mJ/m²).
    pub wall_energy_mj_per_m2: Option<f64>,
    /// Energy of a wall of a chain of atoms (meV).
    pub wall_energy_mev: Option<f64>,
}

impl MaterialScales {
    /// Of a material that is the same everywhere.
    pub fn of(material: &Material) -> MaterialScales {
        let mut scales = MaterialScales::default();
        let (uniaxial, cubic) = (uniaxial(material), cubic(material));
        if let Some(a) = stiffness(material) {
            let density = |k: SiteEnergy| match k {
                SiteEnergy::PerVolume(k) => Some(k.0),
                SiteEnergy::PerSite(_) => None,
            };
            if let Some(Profile::Same(ms)) = &material.Ms {
                scales.exchange_length_nm = positive(1e9 * (2.0 * a / MU_0).sqrt() / ms.0);
            }
            let of_cubic = |k: f64| if k < 0.0 { 2.0 / 3.0 * k } else { k };
            let k = uniaxial.and_then(density).or(cubic.and_then(density).map(of_cubic));
            scales.wall_width_nm = k.and_then(|k| positive(1e9 * (a / k.abs()).sqrt()));
            scales.wall_energy_mj_per_m2 = uniaxial.and_then(density).and_then(|k| positive(4e3 * (a * k).sqrt()));
        } else if let (Some(Energy(j)), Some(SiteEnergy::PerSite(Energy(k)))) = (bond(material), uniaxial) {
            scales.wall_width_sites = positive((j.abs() / (2.0 * k)).sqrt());
            scales.wall_energy_mev = positive(2.0 * (2.0 * j.abs() * k).sqrt());
        }
        scales
    }
}

fn positive(x: f64) -> Option<f64> {
    (x > 0.0 && x.is_finite()).then_some(x)
}

fn same<T: Copy>(profile: &Profile<T>) -> Option<T> {
    match profile {
        Profile::Same(value) => Some(*value),
        _ => None,
    }
}

fn stiffness(material: &Material) -> Option<f64> {
    material.energy.iter().find_map(|term| match term {
        TermSpec::Exchange(spec) => spec.A.as_ref().and_then(same).map(|a| a.0),
        _ => None,
    })
}

fn bond(material: &Material) -> Option<Energy> {
    material.energy.iter().find_map(|term| match term {
        TermSpec::Exchange(spec) => spec.J.as_ref().and_then(|j| j.first()).and_then(same),
        _ => None,
    })
}

fn uniaxial(material: &Material) -> Option<SiteEnergy> {
    material.energy.iter().find_map(|term| match term {
        TermSpec::Anisotropy(AnisotropySpec { K, .. }) => same(K),
        _ => None,
    })
}

fn cubic(material: &Material) -> Option<SiteEnergy> {
    material.energy.iter().find_map(|term| match term {
        TermSpec::CubicAnisotropy(spec) => same(&spec.K),
        _ => None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::library::find;

    #[test]
    fn scales_follow_from_the_numbers() {
        let of = |name: &str| MaterialScales::of(&find(name).unwrap().unwrap().material);
        let close = |x: Option<f64>, y: f64| assert!((x.unwrap() / y - 1.0).abs() < 2e-3, "{x:?} {y}");
        // √(2 × 13e-12/(4π × 1e-7 × 6.4e11)), and no wall without an anisotropy
        close(of("permalloy").exchange_length_nm, 5.686);
        assert_eq!(of("permalloy").wall_width_nm, None);
        close(of("cobalt").wall_width_nm, 7.596);
        close(of("cobalt").wall_energy_mj_per_m2, 15.8);
        close(of("cobalt chain").wall_width_sites, 1.3693);
        close(of("cobalt chain").wall_energy_mev, 10.954);
        assert!(of("nickel").wall_width_nm.is_some() && of("nickel").wall_energy_mj_per_m2.is_none());
    }
}
