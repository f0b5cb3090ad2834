//! Where the spins are: an open or periodic chain, and its selections of sites and bonds.

use crate::error::{Error, Result};
use crate::geometry::Direction;
use crate::profile::Profile;
use crate::units::{Length, Magnetisation, Moment};
use crate::words::{nearest, quoted};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::json;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// The most sites a chain may have; a longer one is refused before anything is allocated.
pub const MAX_SITES: usize = 100_000_000;

/// `{"chain": {…}}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Lattice {
    /// A row of equally spaced sites.
    Chain(Chain),
}

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

/// How sites have moments of their own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OwnMoment<'a> {
    /// As moments.
    Moment(&'a Profile<Moment>),
    /// As magnetisations, to be taken times the volumes of the cells.
    Ms(&'a Profile<Magnetisation>),
}

impl SiteMoment {
    /// Whichever is given.
    pub fn own(&self) -> Result<OwnMoment<'_>> {
        match (&self.moment, &self.Ms) {
            (Some(moment), None) => Ok(OwnMoment::Moment(moment)),
            (None, Some(ms)) => Ok(OwnMoment::Ms(ms)),
            _ => Err(Error::invalid("", "a moment of its own is a \"moment\" or an \"Ms\": give one of the two")),
        }
    }

    /// Sites that are there, and one value for each that is not negative.
    fn validate(&self, sites: usize) -> Result<()> {
        let count = self.sites.indices(sites, "site").map_err(|e| e.within("sites"))?.len();
        let (key, values) = match self.own()? {
            OwnMoment::Moment(p) => ("moment", p.values(count, "site", |m, _| Ok(m.0))),
            OwnMoment::Ms(p) => ("Ms", p.values(count, "site", |m, _| Ok(m.0))),
        };
        if values.map_err(|e| e.within(key))?.iter().any(|m| *m < 0.0) {
            let message = "found a negative value: a spin is the direction of its moment, so this is not negative";
            return Err(Error::invalid(key, message));
        }
        Ok(())
    }
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

impl SiteSection {
    /// Sites that are there, and one edge for each that is greater than 0.
    fn validate(&self, sites: usize) -> Result<()> {
        let count = self.sites.indices(sites, "site").map_err(|e| e.within("sites"))?.len();
        for (key, edge) in [("width", &self.width), ("thickness", &self.thickness)] {
            if let Some(edge) = edge {
                lengths(edge, count).map_err(|e| e.within(key))?;
            }
        }
        match (&self.width, &self.thickness) {
            (None, None) => Err(Error::invalid("", "a section of its own needs a \"width\", a \"thickness\" or both")),
            _ => Ok(()),
        }
    }
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

    /// Number of bonds of shell `shell` (1: nearest neighbours).
    pub fn bonds(&self, shell: usize) -> usize {
        if self.periodic { self.sites } else { self.sites.saturating_sub(shell) }
    }

    /// Width and thickness of the cell of site i (nm), where the lattice has cells.
    pub fn section_nm(&self, i: usize) -> Option<[f64; 2]> {
        let edges = self.cross_section.as_ref()?;
        let mut section = [edges[0].at(i, self.sites)?.0, edges[1].at(i, self.sites)?.0];
        for own in &self.sections {
            let Some((k, count)) = own.sites.position(i) else { continue };
            for (edge, profile) in section.iter_mut().zip([&own.width, &own.thickness]) {
                if let Some(profile) = profile {
                    *edge = profile.at(k, count)?.0;
                }
            }
        }
        Some(section)
    }

    /// Volume of a cell, nm³, where the lattice has cells: the middle one of all by size.
    pub fn cell_volume_nm3(&self) -> Option<f64> {
        Some(self.spacing?.0 * self.section_nm2()?)
    }

    /// Area of the cross-section, nm², where given: the middle one of all by size.
    pub fn section_nm2(&self) -> Option<f64> {
        let areas: Option<Vec<f64>> = (0..self.sites).map(|i| self.section_nm(i).map(|[w, t]| w * t)).collect();
        let mut areas = areas?;
        areas.sort_by(f64::total_cmp);
        areas.get(areas.len() / 2).copied()
    }

    /// Which sites are vacant.
    pub fn is_vacant(&self) -> Result<Vec<bool>> {
        let mut vacant = vec![false; self.sites];
        if let Some(list) = &self.vacant {
            list.indices(self.sites, "site")
                .map_err(|e| e.within("vacant"))?
                .into_iter()
                .for_each(|i| vacant[i] = true);
        }
        Ok(vacant)
    }

    /// The sites of a region.
    pub fn region(&self, name: &str) -> Result<&Selection> {
        self.regions.get(name).ok_or_else(|| {
            let known = self.regions.keys().map(String::as_str);
            let way_out = match nearest(name, known) {
                Some(near) => format!("did you mean {}?", quoted(near)),
                None if self.regions.is_empty() => {
                    format!("give the chain \"regions\": {{{}: {{\"from\": 3, \"to\": 9}}}}", quoted(name))
                }
                None => {
                    let names: Vec<String> = self.regions.keys().map(|name| quoted(name)).collect();
                    format!("there are {}", names.join(", "))
                }
            };
            Error::invalid("", format!("no region {} in the lattice: {way_out}", quoted(name)))
        })
    }

    /// Puts the sites of regions in place of their names, wherever the chain names one.
    pub fn resolve_regions(&mut self) -> Result<()> {
        let mut resolved = self.clone();
        let put = |selection: &mut Selection, place: String| match selection {
            Selection::Region(name) => {
                *selection = self.region(name).map_err(|e| e.within(&place))?.clone();
                Ok(())
            }
            _ => Ok(()),
        };
        for (k, section) in resolved.sections.iter_mut().enumerate() {
            put(&mut section.sites, format!("sections[{k}].sites"))?;
        }
        for (k, frozen) in resolved.frozen.iter_mut().enumerate() {
            put(&mut frozen.sites, format!("frozen[{k}].sites"))?;
        }
        for (k, moment) in resolved.moments.iter_mut().enumerate() {
            put(&mut moment.sites, format!("moments[{k}].sites"))?;
        }
        if let Some(vacant) = &mut resolved.vacant {
            put(vacant, "vacant".into())?;
        }
        *self = resolved;
        Ok(())
    }

    /// The same chain with its vacant sites frozen, their idle spins along `direction`.
    pub fn with_vacancies_frozen(mut self, direction: Direction) -> Chain {
        if let Some(sites) = self.vacant.clone() {
            self.frozen.push(Frozen { sites, direction: Some(direction) });
        }
        self
    }

    /// Sites, spacing, frozen and vacant sites that make sense.
    pub fn validate(&self) -> Result<()> {
        if self.sites == 0 || self.sites > MAX_SITES {
            return Err(Error::invalid(
                "sites",
                format!("found {}, but a chain has 1 to {MAX_SITES} sites", self.sites),
            ));
        }
        if self.periodic && self.sites < 3 {
            return Err(Error::invalid("periodic", format!("a ring needs at least 3 sites, found {}", self.sites)));
        }
        if let Some(a) = self.spacing {
            positive(a, "spacing")?;
        }
        for (name, sites) in &self.regions {
            let place = format!("regions.{name}");
            if name == "default" {
                return Err(Error::invalid(place, "\"default\" is what is in no region: give this one another name"));
            }
            sites.indices(self.sites, "site").map_err(|e| e.within(&place))?;
        }
        for (k, edge) in self.cross_section.iter().flatten().enumerate() {
            lengths(edge, self.sites).map_err(|e| e.within(&format!("cross_section[{k}]")))?;
        }
        if self.cross_section.is_none() && !self.sections.is_empty() {
            let message = "sections of single sites need the \"cross_section\" of all others ([\"20 nm\", \"5 nm\"])";
            return Err(Error::invalid("sections", message));
        }
        let mut entry: Vec<Option<usize>> = vec![None; if self.sections.is_empty() { 0 } else { self.sites }];
        for (k, section) in self.sections.iter().enumerate() {
            section.validate(self.sites).map_err(|e| e.within(&format!("sections[{k}]")))?;
            for i in section.sites.indices(self.sites, "site")? {
                if let Some(first) = entry[i].replace(k) {
                    let message = format!("site {i} has a section of its own already, in sections[{first}]");
                    return Err(Error::invalid(format!("sections[{k}]"), message));
                }
            }
        }
        for (k, f) in self.frozen.iter().enumerate() {
            f.sites.indices(self.sites, "site").map_err(|e| e.within(&format!("frozen[{k}].sites")))?;
        }
        if self.is_vacant()?.iter().all(|v| *v) {
            return Err(Error::invalid("vacant", "all sites are vacant: no spin is left"));
        }
        let mut entry: Vec<Option<usize>> = vec![None; if self.moments.is_empty() { 0 } else { self.sites }];
        for (k, m) in self.moments.iter().enumerate() {
            for i in m.sites.indices(self.sites, "site").map_err(|e| e.within(&format!("moments[{k}].sites")))? {
                if let Some(first) = entry[i].replace(k) {
                    let message = format!("site {i} has a moment of its own already, in moments[{first}]");
                    return Err(Error::invalid(format!("moments[{k}]"), message));
                }
            }
            m.validate(self.sites).map_err(|e| e.within(&format!("moments[{k}]")))?;
        }
        Ok(())
    }
}

/// One length for each of `count` sites, all greater than 0.
fn lengths(edge: &Profile<Length>, count: usize) -> Result<()> {
    let values = edge.values(count, "site", |length, _| positive(length, "").map(|()| length.0))?;
    values.into_iter().try_for_each(|nm| positive(Length(nm), ""))
}

fn positive(length: Length, place: &str) -> Result<()> {
    if length.0 > 0.0 {
        Ok(())
    } else {
        Err(Error::invalid(place, format!("found {} nm, but a length is greater than 0", length.0)))
    }
}

/// Some sites or bonds: a list, or a range with both ends.
#[derive(Clone, Debug, PartialEq)]
pub enum Selection {
    /// `[3, 4, 9]`.
    List(Vec<usize>),
    /// `{"from": 3, "to": 9, "step": 2}`: every `step`th, both ends included where the steps meet them.
    Range {
        /// First.
        from: usize,
        /// Last.
        to: usize,
        /// From one to the next; 1 if not given.
        step: usize,
    },
    /// `"top"`: the sites of one of the lattice's regions.
    Region(String),
}

impl Selection {
    /// Which of the chosen an index is, and of how many; nothing if it is not chosen.
    pub fn position(&self, index: usize) -> Option<(usize, usize)> {
        match self {
            Selection::List(list) => list.iter().position(|i| *i == index).map(|k| (k, list.len())),
            Selection::Range { from, to, step } => {
                let step = (*step).max(1);
                let chosen = (*from..=*to).contains(&index) && (index - from).is_multiple_of(step);
                chosen.then(|| ((index - from) / step, (to - from) / step + 1))
            }
            Selection::Region(_) => None,
        }
    }

    /// The chosen indices, each below `count`; `what` names them in the error.
    pub fn indices(&self, count: usize, what: &str) -> Result<Vec<usize>> {
        match self {
            Selection::List(list) => {
                let mut seen = vec![false; count];
                for (k, &i) in list.iter().enumerate() {
                    if i >= count {
                        return Err(out_of_range(format!("[{k}]"), i, count, what));
                    }
                    if std::mem::replace(&mut seen[i], true) {
                        return Err(Error::invalid(format!("[{k}]"), format!("{what} {i} is listed twice")));
                    }
                }
                Ok(list.clone())
            }
            Selection::Range { from, to, step } => {
                if *step == 0 {
                    return Err(Error::invalid("step", "found 0, but a step leads from one to the next: 1 or more"));
                }
                if *to >= count {
                    return Err(out_of_range("to".into(), *to, count, what));
                }
                if from > to {
                    return Err(Error::invalid(
                        "from",
                        format!("the range from {from} to {to} is empty: exchange the two"),
                    ));
                }
                Ok((*from..=*to).step_by(*step).collect())
            }
            Selection::Region(name) => {
                let name = quoted(name);
                Err(Error::invalid(
                    "",
                    format!("found {name}, but {what}s are chosen here by number, [3, 4], not by a region"),
                ))
            }
        }
    }
}

fn one() -> usize {
    1
}

fn out_of_range(place: String, found: usize, count: usize, what: &str) -> Error {
    let message = match count {
        0 => format!("found {what} {found}, but there is no {what} here"),
        _ => format!("found {what} {found}, but {what}s are counted from 0 to {}", count - 1),
    };
    Error::invalid(place, message)
}

impl JsonSchema for Selection {
    fn schema_name() -> Cow<'static, str> {
        "Selection".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let index = json!({"type": "integer", "minimum": 0});
        json_schema!({
            "description": "indices like [3, 4] or a range like {\"from\": 3, \"to\": 9, \"step\": 2}, both ends included",
            "oneOf": [
                {"type": "array", "items": index, "uniqueItems": true},
                {
                    "type": "object",
                    "properties": {"from": index, "to": index, "step": {"type": "integer", "minimum": 1, "default": 1}},
                    "required": ["from", "to"],
                    "additionalProperties": false,
                },
                {"type": "string", "description": "the name of one of the lattice's regions"},
            ],
        })
    }
}

impl<'de> Deserialize<'de> for Selection {
    fn deserialize<D: Deserializer<'de>>(d: D) -> std::result::Result<Self, D::Error> {
        struct Seen;
        impl<'de> Visitor<'de> for Seen {
            type Value = Selection;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str(
                    "a list of indices like [3, 4], a range like {\"from\": 3, \"to\": 9} or the name of a region",
                )
            }
            fn visit_str<E: serde::de::Error>(self, name: &str) -> std::result::Result<Selection, E> {
                Ok(Selection::Region(name.into()))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut s: A) -> std::result::Result<Selection, A::Error> {
                let mut list = Vec::new();
                while let Some(i) = s.next_element()? {
                    list.push(i);
                }
                Ok(Selection::List(list))
            }
            fn visit_map<A: MapAccess<'de>>(self, m: A) -> std::result::Result<Selection, A::Error> {
                #[derive(Deserialize)]
                #[serde(deny_unknown_fields)]
                struct Ends {
                    from: usize,
                    to: usize,
                    #[serde(default = "one")]
                    step: usize,
                }
                let e = Ends::deserialize(serde::de::value::MapAccessDeserializer::new(m))?;
                Ok(Selection::Range { from: e.from, to: e.to, step: e.step })
            }
        }
        d.deserialize_any(Seen)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_open_chain_has_one_bond_less_than_sites_and_a_ring_as_many() {
        assert_eq!(Chain::open(5).bonds(1), 4);
        assert_eq!(Chain::open(5).bonds(2), 3);
        assert_eq!(Chain::open(1).bonds(1), 0);
        assert_eq!(Chain::ring(5).bonds(1), 5);
    }

    #[test]
    fn a_selection_is_a_list_or_a_range_with_both_ends() {
        let list: Selection = serde_json::from_str("[3, 1]").unwrap();
        assert_eq!(list.indices(4, "site").unwrap(), [3, 1]);
        let range: Selection = serde_json::from_str(r#"{"from": 1, "to": 3}"#).unwrap();
        assert_eq!(range.indices(4, "site").unwrap(), [1, 2, 3]);
        assert!(range.indices(3, "site").unwrap_err().to_string().contains("counted from 0 to 2"));
        assert!(serde_json::from_str::<Selection>(r#"{"from": 1}"#).is_err());
    }

    #[test]
    fn a_range_with_a_step_chooses_every_other_site_and_knows_which_of_them_each_is() {
        let range: Selection = serde_json::from_str(r#"{"from": 1, "to": 10, "step": 3}"#).unwrap();
        assert_eq!(range.indices(11, "site").unwrap(), [1, 4, 7, 10]);
        let positions: Vec<_> = (0..12).filter_map(|i| range.position(i)).collect();
        assert_eq!(positions, [(0, 4), (1, 4), (2, 4), (3, 4)]);
        let short: Selection = serde_json::from_str(r#"{"from": 1, "to": 9, "step": 3}"#).unwrap();
        assert_eq!(short.indices(10, "site").unwrap(), [1, 4, 7]);
        assert_eq!(short.position(7), Some((2, 3)));
        let none: Selection = serde_json::from_str(r#"{"from": 1, "to": 9, "step": 0}"#).unwrap();
        assert!(none.indices(10, "site").unwrap_err().to_string().starts_with("step: found 0"));
    }
}
