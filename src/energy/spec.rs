//! From a term as written in a config to a term with numbers a site: units, cell sizes and selections.

use super::{
    AnisotropySpec, Couplings, CubicAnisotropySpec, DemagSpec, DipolarSpec, DmiSpec, EnergyTerm, ExchangeSpec,
    ZeemanSpec,
};
use crate::error::{Error, Result};
use crate::lattice::{BondFamily, Hop, Lattice, Selection};
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
#[derive(Clone, Debug)]
pub struct Medium<'a> {
    /// Where the spins are.
    pub lattice: &'a Lattice,
    /// Moment of a site, where the material has one.
    pub moment: Option<Profile<Moment>>,
    /// Saturation magnetisation, where the material has one.
    pub saturation: Option<Profile<Magnetisation>>,
    /// The part of the lattice that terms act on, where it is not the whole.
    pub part: Option<Part>,
}

/// A part of a lattice that has a material of its own. A site is in just one part; a bond between two of them is a bond of both, each
/// of which gives it a share.
#[derive(Clone, Debug)]
pub struct Part {
    /// Whether each site is in it.
    pub inside: Vec<bool>,
    /// By hop and by site, which share of its own value the part gives to the site's bond; half of it where there is no number and
    /// the bond leads out of the part.
    pub shares: Vec<(Hop, Vec<f64>)>,
}

impl Part {
    /// Of a bond, the share of its own value that the part gives.
    fn share(&self, hop: Hop, [i, j]: [usize; 2]) -> f64 {
        match self.shares.iter().find(|(own, _)| *own == hop) {
            _ if self.inside[i] && self.inside[j] => 1.0,
            Some((_, shares)) => shares[i],
            None => 0.5,
        }
    }
}

/// A bond: its family and its two sites.
pub type FamilyBond<'a> = (&'a BondFamily, [usize; 2]);

impl<'a> Medium<'a> {
    /// All of a lattice.
    pub fn new(
        lattice: &'a Lattice,
        moment: Option<Profile<Moment>>,
        saturation: Option<Profile<Magnetisation>>,
    ) -> Medium<'a> {
        Medium { lattice, moment, saturation, part: None }
    }

    /// Moment of every site (μ_B): the site's own, or the material's, as given or Ms × cell volume.
    pub fn moments_mub(&self) -> Result<Vec<f64>> {
        let (n, own) = (self.lattice.sites, &self.lattice.moments_mub);
        if own.iter().all(|m| m.is_some()) {
            return Ok(own.iter().copied().flatten().collect());
        }
        let common = match (&self.moment, &self.saturation) {
            (Some(m), _) => m.values(n, "site", |m, _| Ok(m.0)),
            (None, Some(ms)) => ms.values(n, "site", |ms, i| self.cell_moment(ms, i)),
            (None, None) => Err(Error::invalid(
                "",
                "a field acts on moments: give the material a \"moment\" (\"2 mu_B\") or \"Ms\" (\"800 kA/m\")",
            )),
        }?;
        Ok(own.iter().zip(common).map(|(own, common)| own.unwrap_or(common)).collect())
    }

    pub(crate) fn cell_moment(&self, ms: Magnetisation, i: usize) -> Result<f64> {
        Ok(ms.in_volume(self.lattice.volume_nm3(i)?).0)
    }

    /// Energy of site i (meV).
    pub fn site_energy_mev(&self, k: SiteEnergy, i: usize) -> Result<f64> {
        match k {
            SiteEnergy::PerSite(e) => Ok(e.0),
            SiteEnergy::PerVolume(density) => Ok(density.in_volume(self.lattice.volume_nm3(i)?).0),
        }
    }

    /// Energy of a bond (meV).
    pub fn bond_energy_mev(&self, d: BondEnergy, bond: FamilyBond) -> Result<f64> {
        match d {
            BondEnergy::PerBond(e) => Ok(e.0),
            BondEnergy::PerArea(d) => Ok(d.over_area(self.lattice.bond_section_nm2(bond)?).0),
        }
    }

    /// Exchange energy of a bond (meV) of one an area.
    pub fn bond_from_area_mev(&self, j: SurfaceEnergy, bond: FamilyBond) -> Result<f64> {
        Ok(j.over_area(self.lattice.bond_section_nm2(bond)?).0)
    }

    /// Exchange energy of a bond (meV) of a stiffness.
    pub fn bond_from_stiffness_mev(&self, a: ExchangeStiffness, bond: FamilyBond) -> Result<f64> {
        Ok(2.0 * a.over_length(self.lattice.bond_section_nm2(bond)? / self.lattice.bond_length_nm(bond.0)?).0)
    }

    /// [`moments_mub`](Self::moments_mub), 0 where a site is vacant, for moments that act on each other; an error where they stand
    /// in no chain.
    pub fn acting_moments_mub(&self) -> Result<Vec<f64>> {
        if !self.lattice.is_row() {
            let message =
                "moments act on each other along a chain only: give the lattice as one, or leave this term out";
            return Err(Error::invalid("", message));
        }
        let (mut moments, vacant) = (self.moments_mub()?, &self.lattice.vacant);
        moments.iter_mut().zip(vacant).filter(|(_, vacant)| **vacant).for_each(|(moment, _)| *moment = 0.0);
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
        let mut list = vec![0.0; self.lattice.sites];
        for (i, value) in chosen.into_iter().zip(values).filter(|(i, _)| !self.lattice.vacant[*i]) {
            list[i] = value;
        }
        Ok(list)
    }

    /// The bonds of a shell; `key` is the place of what acts on them.
    pub fn shell(&self, shell: usize, key: &str) -> Result<Vec<BondFamily>> {
        self.lattice.admits(shell).map_err(|e| e.within(key))?;
        Ok(self.lattice.shell(shell))
    }

    /// The bonds of cells that share a face.
    pub fn faces(&self, key: &str) -> Result<Vec<BondFamily>> {
        self.lattice.faces().map_err(|e| e.within(key))
    }

    /// The values of a profile on the chosen bonds of some families, made numbers by `convert`, which is told the bond; 0 on all
    /// others and where a site of the bond is vacant. `key` is the profile's place.
    pub fn on_bonds<T: Copy>(
        &self,
        profile: &Profile<T>,
        families: Vec<BondFamily>,
        selection: Option<&Selection>,
        key: &str,
        convert: impl Fn(T, FamilyBond) -> Result<f64>,
    ) -> Result<Vec<Couplings>> {
        let mut couplings = Couplings::none(families, self.lattice.sites);
        let numbered = |(k, c): (usize, &Couplings)| c.family.bonds().map(|sites| (k, sites)).collect::<Vec<_>>();
        let mut chosen: Vec<(usize, [usize; 2])> = couplings.iter().enumerate().flat_map(numbered).collect();
        if let Some(selection) = selection {
            chosen = self.numbered(selection, &chosen).map_err(|e| e.within("bonds"))?;
        }
        if let Some(part) = &self.part {
            chosen.retain(|(_, sites)| sites.iter().any(|i| part.inside[*i]));
        }
        let value = |value, k: usize| convert(value, (&couplings[chosen[k].0].family, chosen[k].1));
        let values = profile.values(chosen.len(), "bond", value).map_err(|e| e.within(key))?;
        for ((k, [i, j]), value) in chosen.into_iter().zip(values) {
            if !self.lattice.vacant[i] && !self.lattice.vacant[j] {
                let share = self.part.as_ref().map_or(1.0, |part| part.share(couplings[k].family.hop, [i, j]));
                couplings[k].mev[i] = value * share;
            }
        }
        Ok(couplings)
    }

    /// Bonds of a chain by their numbers.
    fn numbered(&self, selection: &Selection, bonds: &[(usize, [usize; 2])]) -> Result<Vec<(usize, [usize; 2])>> {
        if !self.lattice.is_row() {
            let message = "bonds are chosen by number in a chain only: choose \"sites\", with both ends among them";
            return Err(Error::invalid("", message));
        }
        Ok(selection.indices(bonds.len(), "bond")?.into_iter().map(|k| bonds[k]).collect())
    }

    /// The chosen sites that are not vacant; all of these if there is no choice.
    pub fn sites(&self, selection: Option<&Selection>) -> Result<Vec<usize>> {
        let mut sites = self.chosen(selection)?;
        sites.retain(|i| !self.lattice.vacant[*i]);
        Ok(sites)
    }

    fn chosen(&self, selection: Option<&Selection>) -> Result<Vec<usize>> {
        let Lattice { sites: count, regions, .. } = self.lattice;
        let mut sites = match selection {
            None => (0..*count).collect(),
            Some(s) => s.sites(*count, regions).map_err(|e| e.within("sites"))?,
        };
        if let Some(part) = &self.part {
            sites.retain(|i| part.inside[*i]);
        }
        Ok(sites)
    }
}
