//! A chain: a row of equally spaced sites, open or closed to a ring.

use super::kind::common;
use super::selection::Selection;
use super::sites::{Frozen, SiteMoment, SiteSection, Taken, positive};
use super::{Atom, Grid, Lattice, LatticeKind};
use crate::error::{Error, Result};
use crate::geometry::Direction;
use crate::profile::Profile;
use crate::registry::Described;
use crate::units::Length;
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;

/// The most sites a chain may have; a longer one is refused before anything is allocated.
pub const MAX_SITES: usize = 100_000_000;

/// A row of equally spaced sites, counted from 0. Bond i joins sites i and i + 1; a ring's last bond joins N − 1 and 0.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Chain {
    /// Number of sites.
    #[schemars(range(min = 1, max = MAX_SITES))]
    pub sites: usize,
    /// Distance between neighbours.
    #[serde(default)]
    pub spacing: Option<Length>,
    /// A ring: the last site is joined to the first.
    #[serde(default)]
    pub periodic: bool,
    /// Width and thickness of a cell; with the spacing they give its volume. Either may be a list over sites or a ramp.
    #[serde(default)]
    pub cross_section: Option<[Profile<Length>; 2]>,
    /// Sites whose cells are narrower or wider than that: notches, tapers, constrictions.
    #[serde(default)]
    pub sections: Vec<SiteSection>,
    /// Where the chain points; +x if not given.
    #[serde(default)]
    pub direction: Option<Direction>,
    /// Spins that never move.
    #[serde(default)]
    pub frozen: Vec<Frozen>,
    /// Sites without a spin: nothing acts on them, and they on nothing.
    #[serde(default)]
    pub vacant: Option<Selection>,
    /// Sites whose moment is not the material's.
    #[serde(default)]
    pub moments: Vec<SiteMoment>,
    /// Sites with a name, to be chosen by it, and to be made of another material.
    #[serde(default)]
    pub regions: BTreeMap<String, Selection>,
}

impl Chain {
    /// A chain of `sites` sites, open, without a length scale.
    pub fn open(sites: usize) -> Chain {
        Chain {
            sites,
            spacing: None,
            periodic: false,
            cross_section: None,
            sections: Vec::new(),
            direction: None,
            frozen: Vec::new(),
            vacant: None,
            moments: Vec::new(),
            regions: BTreeMap::new(),
        }
    }

    /// A ring of `sites` sites, without a length scale.
    pub fn ring(sites: usize) -> Chain {
        Chain { periodic: true, ..Chain::open(sites) }
    }

    /// Number of sites, if that can be.
    pub(super) fn checked_sites(&self) -> Result<usize> {
        let sites = self.sites;
        if sites == 0 || sites > MAX_SITES {
            return Err(Error::invalid("sites", format!("found {sites}, but a chain has 1 to {MAX_SITES} sites")));
        }
        if self.periodic && sites < 3 {
            return Err(Error::invalid("periodic", format!("a ring needs at least 3 sites, found {sites}")));
        }
        Ok(sites)
    }

    /// The lattice; an error, with its place, where something cannot be.
    pub fn resolve(&self) -> Result<Lattice> {
        let grid = Grid::row(self.checked_sites()?, self.periodic);
        let common = common!(self);
        let spacing_nm = common.spacing_nm(self.spacing)?;
        let length = spacing_nm.unwrap_or(1.0);
        let steps = [self.direction.unwrap_or(Direction::X), Direction::Y, Direction::Z].map(|along| (length, along));
        // cells of a continuum begin at the origin, atoms stand there
        let first = if self.cross_section.is_some() { 0.5 } else { 0.0 };
        let atoms = vec![Atom { at: [first, 0.0, 0.0], species: 0 }];
        let mut lattice = Lattice { spacing_nm, ..Lattice::of_atoms(Chain::NAME, grid, steps, atoms) };
        common.name_regions(&mut lattice)?;
        lattice.sections_nm = self.sections_nm(&lattice)?;
        common.complete(lattice)
    }

    /// Width and thickness of every cell (nm).
    fn sections_nm(&self, lattice: &Lattice) -> Result<Option<Vec<[f64; 2]>>> {
        let Some([width, thickness]) = &self.cross_section else {
            let message = "sections of single sites need the \"cross_section\" of all others ([\"20 nm\", \"5 nm\"])";
            return if self.sections.is_empty() { Ok(None) } else { Err(Error::invalid("sections", message)) };
        };
        let edges = |edge, k: usize| lengths(edge, self.sites).map_err(|e| e.within(&format!("cross_section[{k}]")));
        let common = edges(width, 0)?.into_iter().zip(edges(thickness, 1)?);
        let mut sections: Vec<[f64; 2]> = common.map(|(width, thickness)| [width, thickness]).collect();
        let mut taken = Taken::new("sections", "has a section of its own", self.sites);
        for (k, section) in self.sections.iter().enumerate() {
            let within = |e: Error| e.within(&format!("sections[{k}]"));
            let chosen = lattice.chosen(&section.sites).map_err(|e| within(e.within("sites")))?;
            if section.width.is_none() && section.thickness.is_none() {
                let message = "a section of its own needs a \"width\", a \"thickness\" or both";
                return Err(within(Error::invalid("", message)));
            }
            for (edge, (key, profile)) in
                [("width", &section.width), ("thickness", &section.thickness)].iter().enumerate()
            {
                let Some(profile) = profile else { continue };
                let values = lengths(profile, chosen.len()).map_err(|e| within(e.within(key)))?;
                chosen.iter().zip(values).for_each(|(i, nm)| sections[*i][edge] = nm);
            }
            taken.take(k, &chosen)?;
        }
        Ok(Some(sections))
    }
}

impl Described for Chain {
    const NAME: &'static str = "chain";
    const SUMMARY: &'static str = "a row of equally spaced sites, open or closed to a ring";
    const EXAMPLE: &'static str = r#"{"chain": {"sites": 100, "spacing": "0.25 nm"}}"#;
}

impl LatticeKind for Chain {
    fn checked_sites(&self) -> Result<usize> {
        Chain::checked_sites(self)
    }

    fn resolve(&self) -> Result<Lattice> {
        Chain::resolve(self)
    }

    fn extent(&self) -> &'static str {
        "sites"
    }
}

/// One length (nm) for each of `count` sites, all greater than 0.
fn lengths(edge: &Profile<Length>, count: usize) -> Result<Vec<f64>> {
    let values = edge.values(count, "site", |length, _| positive(length.0, "").map(|()| length.0))?;
    values.iter().try_for_each(|nm| positive(*nm, ""))?;
    Ok(values)
}
