//! From a term as written in a config to a term with numbers a site: units, cell sizes and selections.

use super::{
    AnisotropySpec, CubicAnisotropySpec, DemagSpec, DipolarSpec, DmiSpec, EnergyTerm, ExchangeSpec, ZeemanSpec,
};
use crate::error::{Error, Result};
use crate::lattice::{Chain, OwnMoment, Selection};
use crate::profile::Profile;
use crate::registry::family;
use crate::units::{BondEnergy, ExchangeStiffness, Magnetisation, Moment, SiteEnergy, SurfaceEnergy};

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
///
/// A cell i of a continuum has the volume V_i = a S_i, with the spacing a and its own cross-section S_i. A bond between cells of
/// unequal cross-sections has their harmonic mean, 2 S_i S_j/(S_i + S_j): between the two centres the flux A S dm/dx of the
/// exchange is continuous, so half a spacing of each are springs in series. (S. V. Patankar, Numerical Heat Transfer and Fluid
/// Flow, 1980, §4.2-3, for fluxes in general.) D S, weighted with the angles that these springs turn by, has the same mean.
#[derive(Clone, Debug)]
pub struct Medium<'a> {
    /// The chain.
    pub chain: &'a Chain,
    /// Moment of a site, where the material has one.
    pub moment: Option<Profile<Moment>>,
    /// Saturation magnetisation, where the material has one.
    pub saturation: Option<Profile<Magnetisation>>,
    /// The part of the chain that terms act on, where it is not the whole.
    pub part: Option<Part>,
}

/// A part of a chain that has a material of its own. A site is in just one part; a bond between two of them is a bond of both, each of
/// which gives it a share.
#[derive(Clone, Debug)]
pub struct Part {
    /// Whether each site is in it.
    pub inside: Vec<bool>,
    /// By shell and bond, which share of its own value the part gives; all of it where there is no number.
    pub shares: Vec<Vec<f64>>,
}

impl Part {
    fn share(&self, shell: usize, bond: usize) -> f64 {
        self.shares.get(shell - 1).and_then(|shares| shares.get(bond)).copied().unwrap_or(1.0)
    }
}

impl<'a> Medium<'a> {
    /// All of a chain.
    pub fn new(
        chain: &'a Chain,
        moment: Option<Profile<Moment>>,
        saturation: Option<Profile<Magnetisation>>,
    ) -> Medium<'a> {
        Medium { chain, moment, saturation, part: None }
    }

    /// Moment of every site (μ_B): the material's, as given or Ms × cell volume, or the site's own.
    pub fn moments_mub(&self) -> Result<Vec<f64>> {
        let n = self.chain.sites;
        let mut own = vec![None; n];
        for (k, m) in self.chain.moments.iter().enumerate() {
            let sites = m.sites.indices(n, "site").map_err(|e| e.within("sites"))?;
            let values = match m.own().map_err(|e| e.within(&format!("lattice.chain.moments[{k}]")))? {
                OwnMoment::Moment(p) => p.values(sites.len(), "site", |m, _| Ok(m.0)).map_err(|e| e.within("moment")),
                OwnMoment::Ms(p) => {
                    p.values(sites.len(), "site", |ms, i| self.cell_moment(ms, sites[i])).map_err(|e| e.within("Ms"))
                }
            };
            for (i, value) in sites.iter().zip(values?) {
                own[*i] = Some(value);
            }
        }
        if own.iter().all(|m| m.is_some()) {
            return Ok(own.into_iter().flatten().collect());
        }
        let common = match (&self.moment, &self.saturation) {
            (Some(m), _) => m.values(n, "site", |m, _| Ok(m.0)),
            (None, Some(ms)) => ms.values(n, "site", |ms, i| self.cell_moment(ms, i)),
            (None, None) => Err(Error::invalid(
                "",
                "a field acts on moments: give the material a \"moment\" (\"2 mu_B\") or \"Ms\" (\"800 kA/m\")",
            )),
        }?;
        Ok(own.into_iter().zip(common).map(|(own, common)| own.unwrap_or(common)).collect())
    }

    pub(crate) fn cell_moment(&self, ms: Magnetisation, i: usize) -> Result<f64> {
        Ok(ms.in_volume(self.volume_nm3(i)?).0)
    }

    /// Energy of site i (meV).
    pub fn site_energy_mev(&self, k: SiteEnergy, i: usize) -> Result<f64> {
        match k {
            SiteEnergy::PerSite(e) => Ok(e.0),
            SiteEnergy::PerVolume(density) => Ok(density.in_volume(self.volume_nm3(i)?).0),
        }
    }

    /// Energy of bond i (meV).
    pub fn bond_energy_mev(&self, d: BondEnergy, i: usize) -> Result<f64> {
        match d {
            BondEnergy::PerBond(e) => Ok(e.0),
            BondEnergy::PerArea(d) => Ok(d.over_area(self.bond_section_nm2(i)?).0),
        }
    }

    /// Exchange energy of bond i (meV) of one an area.
    pub fn bond_from_area_mev(&self, j: SurfaceEnergy, i: usize) -> Result<f64> {
        Ok(j.over_area(self.bond_section_nm2(i)?).0)
    }

    /// Exchange energy of bond i (meV) of a stiffness.
    pub fn bond_from_stiffness_mev(&self, a: ExchangeStiffness, i: usize) -> Result<f64> {
        Ok(2.0 * a.over_length(self.bond_section_nm2(i)? / self.spacing_nm()?).0)
    }

    /// [`moments_mub`](Self::moments_mub), 0 where a site is vacant.
    pub fn acting_moments_mub(&self) -> Result<Vec<f64>> {
        let (mut moments, vacant) = (self.moments_mub()?, self.chain.is_vacant()?);
        moments.iter_mut().zip(vacant).filter(|(_, vacant)| *vacant).for_each(|(moment, _)| *moment = 0.0);
        Ok(moments)
    }

    /// The values of a profile on the chosen sites, made numbers by `convert`, which is told the index; 0 on all others and where a site is vacant.
    pub fn on_sites<T: Copy>(
        &self,
        profile: &Profile<T>,
        selection: Option<&Selection>,
        key: &str,
        convert: impl Fn(T, usize) -> Result<f64>,
    ) -> Result<Vec<f64>> {
        let chosen = self.chosen(selection)?;
        let values =
            profile.values(chosen.len(), "site", |value, k| convert(value, chosen[k])).map_err(|e| e.within(key))?;
        let vacant = self.chain.is_vacant()?;
        let mut list = vec![0.0; self.chain.sites];
        for (i, value) in chosen.into_iter().zip(values).filter(|(i, _)| !vacant[*i]) {
            list[i] = value;
        }
        Ok(list)
    }

    /// The values of a profile on the chosen bonds of a shell, made numbers by `convert`, which is told the index; 0 on all others and where a site of
    /// the bond is vacant. `key` is the profile's place.
    pub fn on_bonds<T: Copy>(
        &self,
        profile: &Profile<T>,
        shell: usize,
        selection: Option<&Selection>,
        key: &str,
        convert: impl Fn(T, usize) -> Result<f64>,
    ) -> Result<Vec<f64>> {
        let chosen = self.bonds(shell, selection, key)?;
        let values =
            profile.values(chosen.len(), "bond", |value, k| convert(value, chosen[k])).map_err(|e| e.within(key))?;
        let (vacant, sites) = (self.chain.is_vacant()?, self.chain.sites);
        let mut list = vec![0.0; sites];
        for (i, value) in chosen.into_iter().zip(values).filter(|(i, _)| !vacant[*i] && !vacant[(i + shell) % sites]) {
            list[i] = value * self.part.as_ref().map_or(1.0, |part| part.share(shell, i));
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
        let count = self.chain.sites;
        let mut sites = match selection {
            None => (0..count).collect(),
            Some(Selection::Region(name)) => {
                let region = self.chain.region(name).map_err(|e| e.within("sites"))?;
                region.indices(count, "site")?
            }
            Some(s) => s.indices(count, "site").map_err(|e| e.within("sites"))?,
        };
        if let Some(part) = &self.part {
            sites.retain(|i| part.inside[*i]);
        }
        Ok(sites)
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
        let mut bonds = match selection {
            None => (0..count).collect(),
            Some(s) => s.indices(count, "bond").map_err(|e| e.within("bonds"))?,
        };
        if let Some(part) = &self.part {
            bonds.retain(|i| part.inside[*i] || part.inside[(i + shell) % n]);
        }
        Ok(bonds)
    }

    /// Width and thickness of every cell.
    pub(super) fn sections_nm(&self) -> Result<Vec<[f64; 2]>> {
        let missing =
            || Error::invalid("", "a continuum quantity needs the lattice's \"cross_section\" ([\"20 nm\", \"5 nm\"])");
        (0..self.chain.sites).map(|i| self.chain.section_nm(i).ok_or_else(missing)).collect()
    }

    /// Distance between neighbours.
    pub(super) fn spacing_nm(&self) -> Result<f64> {
        let missing = || Error::invalid("", "a continuum quantity needs the lattice's \"spacing\" (\"2 nm\")");
        self.chain.spacing.map(|a| a.0).ok_or_else(missing)
    }

    fn section_nm2(&self, i: usize) -> Result<f64> {
        let missing =
            || Error::invalid("", "a continuum quantity needs the lattice's \"cross_section\" ([\"20 nm\", \"5 nm\"])");
        let [width, thickness] = self.chain.section_nm(i).ok_or_else(missing)?;
        Ok(width * thickness)
    }

    /// Cross-section between the centres of sites i and i + 1.
    fn bond_section_nm2(&self, i: usize) -> Result<f64> {
        let (s, t) = (self.section_nm2(i)?, self.section_nm2((i + 1) % self.chain.sites)?);
        Ok(if s == t { s } else { 2.0 * s * t / (s + t) })
    }

    fn volume_nm3(&self, i: usize) -> Result<f64> {
        Ok(self.section_nm2(i)? * self.spacing_nm()?)
    }
}
