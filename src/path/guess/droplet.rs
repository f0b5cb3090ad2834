//! A round front from a point outwards: a droplet of the final state that grows; or to a point: one of the initial state that shrinks.
//!
//! Its spins within a radius turn together; from there on they turn as the front reaches them.

use super::clock::Ways;
use super::difference::Difference;
use super::front::{Front, Turning};
use super::{FirstGuess, GuessContext};
use crate::error::{Error, Result};
use crate::geometry::Direction;
use crate::lattice::Lattice;
use crate::path::Path;
use crate::registry::Described;
use crate::spins::Spins;
use crate::units::{Angle, Extent, Place};
use schemars::JsonSchema;
use serde::Deserialize;

/// `{"droplet": {"center": [0, 0]}}`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Droplet {
    /// Where it begins, or ends; at the hollow nearest to the middle of what differs if absent.
    #[serde(default)]
    pub center: Option<Place>,
    /// Which state it is of: the final one grows from the point, the initial one shrinks to it.
    #[serde(default)]
    pub of: Inside,
    /// What turns together, in spacings; 0 if absent.
    #[serde(default)]
    pub radius: Option<Extent>,
    /// Width of the front in sites; four times δ of the material if absent.
    #[serde(default)]
    pub width: Option<Extent>,
    /// Axis about which opposite spins turn.
    #[serde(default)]
    pub axis: Option<Direction>,
    /// In place of an axis: opposite spins turn by way of the direction at this angle to the way of the front.
    #[serde(default)]
    pub helicity: Option<Angle>,
    /// All spins turn as one about the axis (that of the best rotation if absent), not each along its own great circle.
    #[serde(default)]
    pub rigid: bool,
}

/// The state that a droplet is of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Inside {
    /// It shrinks.
    Initial,
    /// It grows.
    #[default]
    Final,
}

impl Described for Droplet {
    const NAME: &'static str = "droplet";
    const SUMMARY: &'static str =
        "a droplet of the final state grows from a point, such as a corner, or one of the initial state shrinks to it";
    const EXAMPLE: &'static str = r#"{"droplet": {"center": [0, 0], "radius": 1}}"#;
}

impl FirstGuess for Droplet {
    fn path(&self, a: &Spins, b: &Spins, images: usize, context: &GuessContext) -> Result<Path> {
        let lattice = context.states.lattice;
        let turning = Turning { axis: self.axis, helicity: self.helicity, rigid: self.rigid };
        let front = self.front(&Difference::between(a, b, lattice), lattice)?;
        front.path(self.width, turning, &Ways::between(a, b), images, context)
    }
}

impl Droplet {
    /// Its front, where two states differ as told.
    pub(super) fn front<'l>(&self, difference: &Difference, lattice: &'l Lattice) -> Result<Front<'l>> {
        let center = match &self.center {
            Some(place) => lattice.point(place).map_err(|e| e.within("center"))?,
            None => difference.hollow(difference.middle, lattice),
        };
        let radius = self.radius.map(|radius| lattice.spacings(radius).map_err(|e| e.within("radius")));
        let radius = radius.transpose()?.unwrap_or(0.0);
        if radius < 0.0 {
            return Err(Error::invalid("radius", format!("found {radius}, but a radius is 0 or more")));
        }
        let shrinks = self.of == Inside::Initial;
        let mut front = Front::round(difference.from(center, lattice), shrinks, lattice.sites);
        front.places.iter_mut().for_each(|r| *r = if shrinks { r.min(-radius) } else { r.max(radius) });
        Ok(front)
    }
}
