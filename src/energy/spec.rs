//! From a term as written in a config to a term with numbers a site: units, cell sizes and selections.

use super::{
    AnisotropySpec, CubicAnisotropySpec, DemagSpec, DipolarSpec, DmiSpec, EnergyTerm, ExchangeSpec, Profile, ZeemanSpec,
};
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
        Dipolar(DipolarSpec),
        Demag(DemagSpec),
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

    /// [`moments_mub`](Self::moments_mub), 0 where a site is vacant.
    pub fn acting_moments_mub(&self) -> Result<Vec<f64>> {
        let (mut moments, vacant) = (self.moments_mub()?, self.chain.is_vacant()?);
        moments.iter_mut().zip(vacant).filter(|(_, vacant)| *vacant).for_each(|(moment, _)| *moment = 0.0);
        Ok(moments)
    }

    /// The values of a profile on the chosen sites, made numbers by `convert`; 0 on all others and where a site is vacant.
    pub fn on_sites<T: Copy>(
        &self,
        profile: &Profile<T>,
        selection: Option<&Selection>,
        key: &str,
        convert: impl Fn(T) -> Result<f64>,
    ) -> Result<Vec<f64>> {
        let chosen = self.chosen(selection)?;
        let values = profile.values(chosen.len(), "site", convert).map_err(|e| e.within(key))?;
        let vacant = self.chain.is_vacant()?;
        let mut list = vec![0.0; self.chain.sites];
        for (i, value) in chosen.into_iter().zip(values).filter(|(i, _)| !vacant[*i]) {
            list[i] = value;
        }
        Ok(list)
    }

    /// The values of a profile on the chosen bonds of a shell, made numbers by `convert`; 0 on all others and where a site of
    /// the bond is vacant. `key` is the profile's place.
    pub fn on_bonds<T: Copy>(
        &self,
        profile: &Profile<T>,
        shell: usize,
        selection: Option<&Selection>,
        key: &str,
        convert: impl Fn(T) -> Result<f64>,
    ) -> Result<Vec<f64>> {
        let chosen = self.bonds(shell, selection, key)?;
        let values = profile.values(chosen.len(), "bond", convert).map_err(|e| e.within(key))?;
        let (vacant, sites) = (self.chain.is_vacant()?, self.chain.sites);
        let mut list = vec![0.0; sites];
        for (i, value) in chosen.into_iter().zip(values).filter(|(i, _)| !vacant[*i] && !vacant[(i + shell) % sites]) {
            list[i] = value;
        }
        Ok(list)
    }

    /// The chosen sites that are not vacant; all of these if there is no choice.
    pub fn sites(&self, selection: Option<&Selection>) -> Result<Vec<usize>> {
        let (mut sites, vacant) = (self.chosen(selection)?, self.chain.is_vacant()?);
        sites.retain(|i| !vacant[*i]);
        Ok(sites)
    }

    fn chosen(&self, selection: Option<&Selection>) -> Result<Vec<usize>> {
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

    /// Width and thickness of a cell.
    pub(super) fn edges_nm(&self) -> Result<[f64; 2]> {
        self.section_nm2()?;
        Ok(self.chain.cross_section.map_or([0.0; 2], |edges| edges.map(|e| e.0)))
    }

    /// Distance between neighbours.
    pub(super) fn spacing_nm(&self) -> Result<f64> {
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
