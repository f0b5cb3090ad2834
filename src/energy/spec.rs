//! From a term as written in a config to a term with numbers a site: units, cell sizes and selections.

use super::{AnisotropySpec, CubicAnisotropySpec, DmiSpec, EnergyTerm, ExchangeSpec, ZeemanSpec};
use crate::error::{Error, Result};
use crate::lattice::{Chain, Selection};
use crate::registry::family;
use crate::units::{BondEnergy, ExchangeStiffness, Magnetisation, Moment, SiteEnergy};

family! {
    /// An energy term as written in a config: `{"exchange": {…}}`.
    TermSpec as TermBuilder {
        Exchange(ExchangeSpec),
        Anisotropy(AnisotropySpec),
        CubicAnisotropy(CubicAnisotropySpec),
        Dmi(DmiSpec),
        Zeeman(ZeemanSpec),
    }
}

/// A term's config that becomes a term.
pub trait TermBuilder {
    /// The term's numbers for this medium.
    fn build(&self, medium: &Medium) -> Result<Box<dyn EnergyTerm>>;
}

/// What a term needs to know to turn its quantities into meV a site or bond.
#[derive(Clone, Copy, Debug)]
pub struct Medium<'a> {
    /// The chain.
    pub chain: &'a Chain,
    /// Moment of a site, where the material has one.
    pub moment: Option<Moment>,
    /// Saturation magnetisation, where the material has one.
    pub saturation: Option<Magnetisation>,
}

impl Medium<'_> {
    /// Moment of a site (μ_B): as given, or Ms × cell volume.
    pub fn moment_mu_b(&self) -> Result<f64> {
        match (self.moment, self.saturation) {
            (Some(m), _) => Ok(m.0),
            (None, Some(ms)) => Ok(ms.in_volume(self.volume_nm3()?).0),
            (None, None) => Err(Error::invalid(
                "",
                "a field acts on moments: give the material a \"moment\" (\"2 mu_B\") or \"Ms\" (\"800 kA/m\")",
            )),
        }
    }

    /// Moment of every site (μ_B): the material's, or the site's own.
    pub fn moments_mub(&self) -> Result<Vec<f64>> {
        let n = self.chain.sites;
        let mut own = vec![None; n];
        for m in &self.chain.moments {
            for i in m.sites.indices(n, "site").map_err(|e| e.within("sites"))? {
                own[i] = Some(m.moment.0);
            }
        }
        let common = if own.iter().all(|m| m.is_some()) { 0.0 } else { self.moment_mu_b()? };
        Ok(own.into_iter().map(|m| m.unwrap_or(common)).collect())
    }

    /// Energy a site (meV).
    pub fn site_energy_mev(&self, k: SiteEnergy) -> Result<f64> {
        match k {
            SiteEnergy::PerSite(e) => Ok(e.0),
            SiteEnergy::PerVolume(density) => Ok(density.in_volume(self.volume_nm3()?).0),
        }
    }

    /// Energy a bond (meV).
    pub fn bond_energy_mev(&self, d: BondEnergy) -> Result<f64> {
        match d {
            BondEnergy::PerBond(e) => Ok(e.0),
            BondEnergy::PerArea(d) => Ok(d.over_area(self.section_nm2()?).0),
        }
    }

    /// Exchange energy a bond (meV) of a stiffness.
    pub fn bond_from_stiffness_mev(&self, a: ExchangeStiffness) -> Result<f64> {
        Ok(2.0 * a.over_length(self.section_nm2()? / self.spacing_nm()?).0)
    }

    /// The chosen sites; all if there is no choice.
    pub fn sites(&self, selection: Option<&Selection>) -> Result<Vec<usize>> {
        match selection {
            None => Ok((0..self.chain.sites).collect()),
            Some(s) => s.indices(self.chain.sites, "site").map_err(|e| e.within("sites")),
        }
    }

    /// The chosen bonds of shell `shell`; all if there is no choice. `place` names the shell's value in errors.
    pub fn bonds(&self, shell: usize, selection: Option<&Selection>, place: &str) -> Result<Vec<usize>> {
        let (n, count) = (self.chain.sites, self.chain.bonds(shell));
        if self.chain.periodic && 2 * shell >= n {
            let most = (n - 1) / 2;
            return Err(Error::invalid(
                place,
                format!("shell {shell} wraps onto itself in a ring of {n} sites: at most {most} shells fit"),
            ));
        }
        match selection {
            None => Ok((0..count).collect()),
            Some(s) => s.indices(count, "bond").map_err(|e| e.within("bonds")),
        }
    }

    fn spacing_nm(&self) -> Result<f64> {
        let missing = || Error::invalid("", "a continuum quantity needs the lattice's \"spacing\" (\"2 nm\")");
        self.chain.spacing.map(|a| a.0).ok_or_else(missing)
    }

    fn section_nm2(&self) -> Result<f64> {
        let missing =
            || Error::invalid("", "a continuum quantity needs the lattice's \"cross_section\" ([\"20 nm\", \"5 nm\"])");
        self.chain.section_nm2().ok_or_else(missing)
    }

    fn volume_nm3(&self) -> Result<f64> {
        Ok(self.section_nm2()? * self.spacing_nm()?)
    }
}
