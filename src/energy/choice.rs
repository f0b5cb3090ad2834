//! Which bonds a term is for.

use super::couplings::Couplings;
use super::spec::{FamilyBond, Medium};
use crate::error::{Error, Result};
use crate::lattice::{BondFamily, Selection};
use crate::profile::Profile;

/// As written in a config; all bonds if nothing is said.
#[derive(Clone, Copy, Debug, Default)]
pub struct Choice<'a> {
    /// Bonds with both ends among these.
    pub sites: Option<&'a Selection>,
    /// Bonds with one end among the first and the other among the second.
    pub between: Option<&'a [Selection; 2]>,
    /// Bonds of a chain by their numbers.
    pub bonds: Option<&'a Selection>,
}

/// A bond that is chosen: number of its family, its sites, and whether it leads from the second of two selections to the first.
#[derive(Clone, Copy, Debug)]
pub struct Chosen {
    pub family: usize,
    pub sites: [usize; 2],
    pub reversed: bool,
}

/// A profile, its place, and the bonds that it is for.
pub struct Valued<'a, T> {
    pub profile: &'a Profile<T>,
    pub key: String,
    pub families: Vec<BondFamily>,
}

impl Choice<'_> {
    /// That no bond is chosen.
    fn refusal(&self) -> Error {
        match self.between {
            Some(_) => Error::invalid("between", "no bond leads from the first to the second of these"),
            None => Error::invalid("sites", "no bond has both its ends among these sites"),
        }
    }
}

impl Medium<'_> {
    /// The bonds of a shell, between two selections one of their own; `key` is the place of what acts on them.
    pub fn shell(&self, shell: usize, key: &str, choice: &Choice) -> Result<Vec<BondFamily>> {
        let Some(between) = choice.between else {
            self.lattice.admits(shell).map_err(|e| e.within(key))?;
            return Ok(self.lattice.shell(shell));
        };
        let [a, b] = self.ends(between)?;
        self.lattice.shell_between(shell, [&a, &b]).map_err(|e| e.within(key))
    }

    /// The bonds of cells that share a face.
    pub fn faces(&self, key: &str) -> Result<Vec<BondFamily>> {
        self.lattice.faces().map_err(|e| e.within(key))
    }

    /// The chosen bonds of some families, family after family.
    fn choose(&self, families: &[BondFamily], choice: &Choice) -> Result<Vec<Chosen>> {
        let of = |(family, bonds): (usize, &BondFamily)| -> Vec<Chosen> {
            bonds.bonds().map(|sites| Chosen { family, sites, reversed: false }).collect()
        };
        let mut chosen: Vec<Chosen> = families.iter().enumerate().flat_map(of).collect();
        if let Some(selection) = choice.bonds {
            chosen = self.numbered(selection, &chosen).map_err(|e| e.within("bonds"))?;
        }
        if let Some(selection) = choice.sites {
            let inside = self.among(selection).map_err(|e| e.within("sites"))?;
            chosen.retain(|bond| bond.sites.iter().all(|i| inside[*i]));
        }
        if let Some(between) = choice.between {
            let [a, b] = self.ends(between)?;
            chosen.iter_mut().for_each(|bond| {
                let [i, j] = bond.sites;
                bond.reversed = !(a[i] && b[j]) && b[i] && a[j];
            });
            chosen.retain(|bond| bond.reversed || (a[bond.sites[0]] && b[bond.sites[1]]));
        }
        Ok(chosen)
    }

    /// Values of several shells; one at least has a bond that is chosen, if any choice is made.
    pub fn on_shells<T: Copy>(
        &self,
        shells: Vec<Valued<T>>,
        choice: &Choice,
        convert: impl Fn(T, FamilyBond) -> Result<f64>,
    ) -> Result<Vec<Couplings>> {
        let chosen = shells.iter().map(|shell| self.choose(&shell.families, choice)).collect::<Result<Vec<_>>>()?;
        if chosen.iter().all(Vec::is_empty) && (choice.sites.is_some() || choice.between.is_some()) {
            return Err(choice.refusal());
        }
        let values = shells.into_iter().zip(chosen).map(|(shell, chosen)| self.on_chosen(shell, chosen, &convert));
        Ok(values.collect::<Result<Vec<_>>>()?.concat())
    }

    /// The values of a profile on the chosen bonds of some families, made numbers by `convert`, which is told the bond; 0 on all
    /// others and where a site of the bond is vacant. `key` is the profile's place.
    pub fn on_bonds<T: Copy>(
        &self,
        profile: &Profile<T>,
        families: Vec<BondFamily>,
        choice: &Choice,
        key: &str,
        convert: impl Fn(T, FamilyBond) -> Result<f64>,
    ) -> Result<Vec<Couplings>> {
        self.on_shells(vec![Valued { profile, key: key.into(), families }], choice, convert)
    }

    fn on_chosen<T: Copy>(
        &self,
        Valued { profile, key, families }: Valued<T>,
        mut chosen: Vec<Chosen>,
        convert: &impl Fn(T, FamilyBond) -> Result<f64>,
    ) -> Result<Vec<Couplings>> {
        if let Some(part) = &self.part {
            chosen.retain(|bond| bond.sites.iter().any(|i| part.inside[*i]));
        }
        let value = |value, k: usize| {
            let Chosen { family, sites, reversed } = chosen[k];
            convert(value, FamilyBond { family: &families[family], sites, reversed })
        };
        let firsts: Vec<usize> = chosen.iter().map(|bond| bond.sites[0]).collect();
        let values = profile.values(self.lattice.places_of(&firsts), "bond", value).map_err(|e| e.within(&key))?;
        let mut couplings = Couplings::none(families, self.lattice.sites);
        for (Chosen { family, sites: [i, j], .. }, value) in chosen.into_iter().zip(values) {
            if !self.lattice.vacant[i] && !self.lattice.vacant[j] {
                let share = self.part.as_ref().map_or(1.0, |part| part.share(couplings[family].family.hop, [i, j]));
                couplings[family].mev[i] = value * share;
            }
        }
        Ok(couplings)
    }

    fn ends(&self, between: &[Selection; 2]) -> Result<[Vec<bool>; 2]> {
        let end = |k: usize| self.among(&between[k]).map_err(|e| e.within(&format!("between[{k}]")));
        Ok([end(0)?, end(1)?])
    }

    /// Whether each site is in a selection.
    fn among(&self, selection: &Selection) -> Result<Vec<bool>> {
        let mut inside = vec![false; self.lattice.sites];
        selection.sites(self.lattice)?.into_iter().for_each(|i| inside[i] = true);
        Ok(inside)
    }

    fn numbered(&self, selection: &Selection, bonds: &[Chosen]) -> Result<Vec<Chosen>> {
        if !self.lattice.is_row() {
            let message = "bonds are chosen by number in a chain only: choose \"sites\", with both ends among them";
            return Err(Error::invalid("", message));
        }
        Ok(selection.indices(bonds.len(), "bond")?.into_iter().map(|k| bonds[k]).collect())
    }
}
