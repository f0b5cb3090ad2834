//! A round front that closes on a point: what differs between the two states shrinks to nothing there, or grows from there.
//!
//! The point is the hollow between the sites that is nearest to the middle of the difference: a skyrmion goes out where no spin has to
//! be its last. The state in which neighbours differ more is the one that shrinks.

use super::clock::Ways;
use super::difference::{Difference, is_rougher};
use super::front::{Front, Turning};
use super::{FirstGuess, GuessContext};
use crate::error::Result;
use crate::geometry::Direction;
use crate::lattice::Lattice;
use crate::path::Path;
use crate::registry::Described;
use crate::spins::Spins;
use crate::units::{Angle, Extent, Place};
use schemars::JsonSchema;
use serde::Deserialize;

/// `{"shrink": {}}`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Shrink {
    /// Where it closes; at the hollow nearest to the middle of what differs if absent.
    #[serde(default)]
    pub center: Option<Place>,
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

impl Described for Shrink {
    const NAME: &'static str = "shrink";
    const SUMMARY: &'static str = "a round front closes on a point: a skyrmion shrinks to nothing";
    const EXAMPLE: &'static str = r#"{"shrink": {"center": [5.5, 0]}}"#;
}

impl FirstGuess for Shrink {
    fn path(&self, a: &Spins, b: &Spins, images: usize, context: &GuessContext) -> Result<Path> {
        let lattice = context.states.lattice;
        let turning = Turning { axis: self.axis, helicity: self.helicity, rigid: self.rigid };
        let ways = Ways::between(a, b);
        self.front(&ways, &Difference::between(a, b, lattice), lattice)?
            .path(self.width, turning, &ways, images, context)
    }
}

impl Shrink {
    /// Its front, where two states differ as told.
    pub(super) fn front<'l>(&self, ways: &Ways, difference: &Difference, lattice: &'l Lattice) -> Result<Front<'l>> {
        let center = match &self.center {
            Some(place) => lattice.point(place).map_err(|e| e.within("center"))?,
            None => difference.hollow(difference.middle, lattice),
        };
        let inwards = !is_rougher(ways.b, ways.a, lattice);
        Ok(Front::round(difference.from(center, lattice), inwards, lattice.sites))
    }
}
