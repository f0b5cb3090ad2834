//! Sites that are not as the others, as written in a config, and what they make of a lattice.

use super::selection::Selection;
use super::{FrozenSites, Lattice};
use crate::error::{Error, Result};
use crate::geometry::Direction;
use crate::profile::Profile;
use crate::units::{Length, Magnetisation, Moment};
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;

/// Along which directions the last cell is followed by the first.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "true, false, or a list with one of them a direction")]
pub enum Periodic {
    /// All or none.
    All(bool),
    /// One a direction.
    Each(Vec<bool>),
}

impl Default for Periodic {
    fn default() -> Periodic {
        Periodic::All(false)
    }
}

/// Sites with a moment of their own.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct SiteMoment {
    /// Which ones.
    pub sites: Selection,
    /// The moment of each.
    #[serde(default)]
    pub moment: Option<Profile<Moment>>,
    /// The saturation magnetisation of each, in place of the moment.
    #[serde(default)]
    pub Ms: Option<Profile<Magnetisation>>,
}

/// Sites with a cross-section of their own.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SiteSection {
    /// Which ones.
    pub sites: Selection,
    /// Width of each; that of the chain if not given.
    #[serde(default)]
    pub width: Option<Profile<Length>>,
    /// Thickness of each; that of the chain if not given.
    #[serde(default)]
    pub thickness: Option<Profile<Length>>,
}

/// Spins that never move.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Frozen {
    /// Which ones.
    pub sites: Selection,
    /// Where they point; as in the initial state if not given.
    #[serde(default)]
    pub direction: Option<Direction>,
}

/// What all kinds of lattices say.
pub struct Common<'a> {
    pub frozen: &'a [Frozen],
    pub vacant: Option<&'a Selection>,
    pub moments: &'a [SiteMoment],
    pub regions: &'a BTreeMap<String, Selection>,
}

impl Common<'_> {
    /// The lattice constant (nm), where it is given.
    pub fn spacing_nm(&self, spacing: Option<Length>) -> Result<Option<f64>> {
        spacing.map(|a| positive(a.0, "spacing").map(|()| a.0)).transpose()
    }

    /// The lattice with all that is said of its sites, whose regions are known.
    pub fn complete(&self, mut lattice: Lattice) -> Result<Lattice> {
        if let Some(list) = self.vacant {
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

    /// The regions with their sites.
    pub fn name_regions(&self, lattice: &mut Lattice) -> Result<()> {
        for (name, chosen) in self.regions {
            let place = format!("regions.{name}");
            if name == "default" {
                return Err(Error::invalid(place, "\"default\" is what is in no region: give this one another name"));
            }
            if lattice.species.contains(name) {
                return Err(Error::invalid(place, "a species has this name: give the region another one"));
            }
            // a region is no part of another one
            let known = std::mem::take(&mut lattice.regions);
            let chosen = lattice.chosen(chosen).map_err(|e| e.within(&place))?;
            lattice.regions = known;
            lattice.regions.insert(name.clone(), chosen);
        }
        Ok(())
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
        let mut taken = Taken::new("frozen", "is frozen", lattice.sites);
        frozen.iter().enumerate().try_for_each(|(k, f)| taken.take(k, &f.sites))?;
        Ok(frozen)
    }

    /// Moments of the sites that have one of their own (μ_B).
    fn moments_mub(&self, lattice: &Lattice) -> Result<Vec<Option<f64>>> {
        let mut moments = lattice.moments_mub.clone();
        let mut taken = Taken::new("moments", "has a moment of its own", lattice.sites);
        for (k, m) in self.moments.iter().enumerate() {
            let within = |e: Error| e.within(&format!("moments[{k}]"));
            let chosen = lattice.chosen(&m.sites).map_err(|e| within(e.within("sites")))?;
            taken.take(k, &chosen)?;
            let (key, values) = match (&m.moment, &m.Ms) {
                (Some(p), None) => ("moment", p.values(lattice.places_of(&chosen), "site", |m, _| Ok(m.0))),
                (None, Some(p)) => {
                    let moment = |k: usize| lattice.volume_nm3(chosen[k]);
                    ("Ms", p.values(lattice.places_of(&chosen), "site", |ms, k| Ok(ms.in_volume(moment(k)?).0)))
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
    /// The sites of a selection.
    pub fn chosen(&self, selection: &Selection) -> Result<Vec<usize>> {
        selection.sites(self)
    }
}

/// Which entry of a list each site is of: no site is of two.
pub struct Taken {
    list: &'static str,
    what: &'static str,
    by: Vec<Option<usize>>,
}

impl Taken {
    pub fn new(list: &'static str, what: &'static str, sites: usize) -> Taken {
        Taken { list, what, by: vec![None; sites] }
    }

    pub fn take(&mut self, k: usize, sites: &[usize]) -> Result<()> {
        let Taken { list, what, by } = self;
        match sites.iter().find_map(|i| by[*i].replace(k).map(|first| (i, first))) {
            None => Ok(()),
            Some((i, first)) => {
                Err(Error::invalid(format!("{list}[{k}]"), format!("site {i} {what} already, in {list}[{first}]")))
            }
        }
    }
}

/// Refuses a length (nm) that is none.
pub fn positive(nm: f64, place: &str) -> Result<()> {
    match nm > 0.0 {
        true => Ok(()),
        false => Err(Error::invalid(place, format!("found {nm} nm, but a length is greater than 0"))),
    }
}
