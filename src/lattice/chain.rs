//! A chain: a row of equally spaced sites, open or closed to a ring.

use super::selection::Selection;
use super::sites::{Frozen, SiteMoment, SiteSection};
use super::{FrozenSites, Grid, Lattice};
use crate::error::{Error, Result};
use crate::geometry::Direction;
use crate::profile::Profile;
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
        let (sites, grid) = (self.checked_sites()?, Grid::row(self.sites, self.periodic));
        if let Some(a) = self.spacing {
            positive(a.0, "spacing")?;
        }
        let length = self.spacing.map_or(1.0, |a| a.0);
        let steps = [self.direction.unwrap_or(Direction::X), Direction::Y, Direction::Z].map(|along| (length, along));
        let mut lattice = Lattice { spacing_nm: self.spacing.map(|a| a.0), ..Lattice::bare(grid, steps) };
        for (name, chosen) in &self.regions {
            let place = format!("regions.{name}");
            if name == "default" {
                return Err(Error::invalid(place, "\"default\" is what is in no region: give this one another name"));
            }
            let chosen = chosen.indices(sites, "site").map_err(|e| e.within(&place))?;
            lattice.regions.insert(name.clone(), chosen);
        }
        lattice.sections_nm = self.sections_nm(&lattice)?;
        if let Some(list) = &self.vacant {
            let vacant = lattice.chosen(list).map_err(|e| e.within("vacant"))?;
            vacant.into_iter().for_each(|i| lattice.vacant[i] = true);
        }
        if lattice.vacant.iter().all(|v| *v) {
            return Err(Error::invalid("vacant", "all sites are vacant: no spin is left"));
        }
        lattice.frozen = self.frozen_sites(&lattice)?;
        lattice.moments_mub = self.moments_mub(&lattice)?;
        Ok(lattice)
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

    /// Spins that never move, none of them twice and none where there is no spin.
    fn frozen_sites(&self, lattice: &Lattice) -> Result<Vec<FrozenSites>> {
        let one = |(k, f): (usize, &Frozen)| {
            let within = |e: Error| e.within(&format!("frozen[{k}].sites"));
            let sites = lattice.chosen(&f.sites).map_err(within)?;
            match sites.iter().find(|i| lattice.vacant[**i]) {
                None => Ok(FrozenSites { sites, direction: f.direction }),
                Some(i) => Err(within(Error::invalid("", format!("site {i} is vacant: there is no spin to freeze")))),
            }
        };
        let frozen: Vec<FrozenSites> = self.frozen.iter().enumerate().map(one).collect::<Result<_>>()?;
        let mut taken = Taken::new("frozen", "is frozen", self.sites);
        frozen.iter().enumerate().try_for_each(|(k, f)| taken.take(k, &f.sites))?;
        Ok(frozen)
    }

    /// Moments of the sites that have one of their own (μ_B).
    fn moments_mub(&self, lattice: &Lattice) -> Result<Vec<Option<f64>>> {
        let mut moments = lattice.moments_mub.clone();
        let mut taken = Taken::new("moments", "has a moment of its own", self.sites);
        for (k, m) in self.moments.iter().enumerate() {
            let within = |e: Error| e.within(&format!("moments[{k}]"));
            let chosen = lattice.chosen(&m.sites).map_err(|e| within(e.within("sites")))?;
            taken.take(k, &chosen)?;
            let (key, values) = match (&m.moment, &m.Ms) {
                (Some(p), None) => ("moment", p.values(chosen.len(), "site", |m, _| Ok(m.0))),
                (None, Some(p)) => {
                    let moment = |k: usize| lattice.volume_nm3(chosen[k]);
                    ("Ms", p.values(chosen.len(), "site", |ms, k| Ok(ms.in_volume(moment(k)?).0)))
                }
                _ => {
                    let message = "a moment of its own is a \"moment\" or an \"Ms\": give one of the two";
                    return Err(within(Error::invalid("", message)));
                }
            };
            for (i, moment) in chosen.into_iter().zip(values.map_err(|e| within(e.within(key)))?) {
                if moment < 0.0 {
                    let message =
                        "found a negative value: a spin is the direction of its moment, so this is not negative";
                    return Err(within(Error::invalid(key, message)));
                }
                moments[i] = Some(moment);
            }
        }
        Ok(moments)
    }
}

impl Lattice {
    fn chosen(&self, selection: &Selection) -> Result<Vec<usize>> {
        selection.sites(self.sites, &self.regions)
    }
}

/// Which entry of a list each site is of: no site is of two.
struct Taken {
    list: &'static str,
    what: &'static str,
    by: Vec<Option<usize>>,
}

impl Taken {
    fn new(list: &'static str, what: &'static str, sites: usize) -> Taken {
        Taken { list, what, by: vec![None; sites] }
    }

    fn take(&mut self, k: usize, sites: &[usize]) -> Result<()> {
        let Taken { list, what, by } = self;
        match sites.iter().find_map(|i| by[*i].replace(k).map(|first| (i, first))) {
            None => Ok(()),
            Some((i, first)) => {
                Err(Error::invalid(format!("{list}[{k}]"), format!("site {i} {what} already, in {list}[{first}]")))
            }
        }
    }
}

/// One length (nm) for each of `count` sites, all greater than 0.
fn lengths(edge: &Profile<Length>, count: usize) -> Result<Vec<f64>> {
    let values = edge.values(count, "site", |length, _| positive(length.0, "").map(|()| length.0))?;
    values.iter().try_for_each(|nm| positive(*nm, ""))?;
    Ok(values)
}

fn positive(nm: f64, place: &str) -> Result<()> {
    match nm > 0.0 {
        true => Ok(()),
        false => Err(Error::invalid(place, format!("found {nm} nm, but a length is greater than 0"))),
    }
}
