//! From a term as written in a config to a term with numbers a site: units, cell sizes and selections.

use super::{
    AnisotropySpec, BiquadraticSpec, CubicAnisotropySpec, DemagSpec, DipolarSpec, DmiSpec, EnergyTerm, ExchangeSpec,
    FourSpinSpec, PairsSpec, ZeemanSpec,
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
        Pairs(PairsSpec),
        Biquadratic(BiquadraticSpec),
        FourSpin(FourSpinSpec),
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
    pub(super) fn share(&self, hop: Hop, [i, j]: [usize; 2]) -> f64 {
        match self.shares.iter().find(|(own, _)| *own == hop) {
            _ if self.inside[i] && self.inside[j] => 1.0,
            Some((_, shares)) => shares[i],
            None => 0.5,
        }
    }
}

/// A bond: its family, its two sites, and whether it leads from the second of two selections to the first.
#[derive(Clone, Copy, Debug)]
pub struct FamilyBond<'a> {
    /// Its family.
    pub family: &'a BondFamily,
    /// Its ends.
    pub sites: [usize; 2],
    /// Whether it was chosen as one that leads the other way.
    pub reversed: bool,
}

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
        let places = || self.lattice.places_of(&(0..n).collect::<Vec<_>>());
        let common = match (&self.moment, &self.saturation) {
            (Some(m), _) => m.values(places(), "site", |m, _| Ok(m.0)),
            (None, Some(ms)) => ms.values(places(), "site", |ms, i| self.cell_moment(ms, i)).map_err(|e| match e {
                // what asks for moments is not what is written in the wrong units
                Error::Invalid { place, message } => {
                    Error::invalid(place, format!("the moments are of the material's \"Ms\": {message}"))
                }
                other => other,
            }),
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
            BondEnergy::PerArea(d) => Ok(d.over_area(self.lattice.bond_section_nm2(bond.family, bond.sites)?).0),
        }
    }

    /// Exchange energy of a bond (meV) of one an area.
    pub fn bond_from_area_mev(&self, j: SurfaceEnergy, bond: FamilyBond) -> Result<f64> {
        Ok(j.over_area(self.lattice.bond_section_nm2(bond.family, bond.sites)?).0)
    }

    /// Exchange energy of a bond (meV) of a stiffness.
    pub fn bond_from_stiffness_mev(&self, a: ExchangeStiffness, bond: FamilyBond) -> Result<f64> {
        Ok(2.0
            * a.over_length(
                self.lattice.bond_section_nm2(bond.family, bond.sites)? / self.lattice.bond_length_nm(bond.family)?,
            )
            .0)
    }

    /// Refuses moments that act on each other and stand in no chain.
    pub fn in_a_chain(&self) -> Result<()> {
        match self.lattice.is_row() {
            true => Ok(()),
            false => {
                let message =
                    "moments act on each other along a chain only: give the lattice as one, or leave this term out";
                Err(Error::invalid("", message))
            }
        }
    }

    /// [`moments_mub`](Self::moments_mub), 0 where a site is vacant, for moments that act on each other.
    pub fn acting_moments_mub(&self) -> Result<Vec<f64>> {
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
        let places = self.lattice.places_of(&chosen);
        let values = profile.values(places, "site", |value, k| convert(value, chosen[k])).map_err(|e| e.within(key))?;
        let mut list = vec![0.0; self.lattice.sites];
        for (i, value) in chosen.into_iter().zip(values).filter(|(i, _)| !self.lattice.vacant[*i]) {
            list[i] = value;
        }
        Ok(list)
    }

    /// The share of a part in what joins so many sites: that of its sites among them.
    pub fn share<const N: usize>(&self, sites: [usize; N]) -> f64 {
        let Some(part) = &self.part else { return 1.0 };
        sites.iter().filter(|i| part.inside[**i]).count() as f64 / N as f64
    }

    /// The chosen sites that are not vacant; all of these if there is no choice.
    pub fn sites(&self, selection: Option<&Selection>) -> Result<Vec<usize>> {
        let mut sites = self.chosen(selection)?;
        sites.retain(|i| !self.lattice.vacant[*i]);
        Ok(sites)
    }

    fn chosen(&self, selection: Option<&Selection>) -> Result<Vec<usize>> {
        let mut sites = match selection {
            None => (0..self.lattice.sites).collect(),
            Some(s) => s.sites(self.lattice).map_err(|e| e.within("sites"))?,
        };
        if let Some(part) = &self.part {
            sites.retain(|i| part.inside[*i]);
        }
        Ok(sites)
    }
}
