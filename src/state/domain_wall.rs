//! A wall between two domains.
//!
//! ```text
//! φ_i = Φ (2/π) atan exp((r_i·n − center)/δ)      from the left direction (φ = 0) to the right one (φ = Φ)
//! ```
//! the profile of a wall in a uniaxial magnet, δ = √(J/2K) sites (L. Landau, E. Lifshitz, Phys. Z. Sowjetunion 8, 153 (1935)), across
//! the normal n; along a chain r_i·n is the number i of the site.
//! The spins turn on the great circle of the two directions, the way on which `through` lies (the shorter one if it is "auto").
//! Opposite directions, 3 rad apart or more, have no great circle of their own: there the spins turn by way of the part of
//! `through` normal to them, and "auto" is the cheapest of four ways, see [`Sense`].

use super::sense::{Sense, along_a_domain, auto_or_direction, auto_or_direction_schema};
use super::{StateBuilder, StateContext};
use crate::error::{Error, Result};
use crate::geometry::{Arc, Direction, Vector, vector};
use crate::lattice::Lattice;
use crate::registry::Described;
use crate::units::Extent;
use schemars::JsonSchema;
use serde::Deserialize;
use std::f64::consts::FRAC_PI_2;

/// Domains farther apart than this (rad) are opposite.
const OPPOSITE: f64 = 3.0;

/// Domains nearer to each other than this (rad) are one.
const ALIKE: f64 = 1e-6;

/// The least sine between the domains' line and a direction across it.
const ACROSS: f64 = 1e-6;

/// A wall leaves no trace where no spin has this share of the turn on one of its sides: 1.8° of half a turn, 4.2 δ from its center.
const NO_TRACE: f64 = 0.01;

/// `{"domain_wall": {"center": 39.5}}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DomainWall {
    /// In sites, 39.5 lies between sites 39 and 40: how far the wall is from the origin along its normal.
    pub center: Extent,
    /// Width δ of the wall in sites; that of the material if absent. 0 is an abrupt wall.
    #[serde(default)]
    pub width: Option<Extent>,
    /// From left to right, across the wall; +x if absent, in a chain along the chain.
    #[serde(default)]
    pub normal: Option<Direction>,
    /// Left of the wall; +z if absent.
    #[serde(default)]
    pub left: Option<Direction>,
    /// Right of the wall; −z if absent.
    #[serde(default)]
    pub right: Option<Direction>,
    /// Where the wall passes; "auto" (or absent): the shorter way, and between opposite domains the cheapest for the energy.
    #[serde(default, deserialize_with = "auto_or_direction")]
    #[schemars(schema_with = "auto_or_direction_schema")]
    pub through: Option<Direction>,
    /// Reverse odd sites, of a cell with several atoms every other one.
    #[serde(default)]
    pub staggered: bool,
}

impl Described for DomainWall {
    const NAME: &'static str = "domain_wall";
    const SUMMARY: &'static str = "a wall at `center` (in sites) between two domains";
    const EXAMPLE: &'static str = r#"{"domain_wall": {"center": 5.5, "width": 2, "through": [0, 1, 0]}}"#;
}

impl DomainWall {
    /// The directions left and right of the wall.
    fn domains(&self) -> [Vector; 2] {
        let [left, right] = [(self.left, Direction::Z), (self.right, Direction::Z.reversed())];
        [left, right].map(|(given, default)| given.unwrap_or(default).vector())
    }

    /// The error that both domains are one.
    fn no_wall(&self) -> Error {
        let key = if self.right.is_some() { "right" } else { "left" };
        let message = "the domains left and right of the wall point the same way, so that nothing turns between them: for a wall of \
                       360 degrees write {\"soliton\": {\"center\": …, \"domain\": […]}}, for one direction everywhere \
                       {\"uniform\": {\"direction\": […]}}";
        Error::invalid(key, message)
    }

    /// The two halves of the turn from left to right.
    fn turn(&self, context: &StateContext) -> Result<[Arc; 2]> {
        let [left, right] = self.domains();
        let short = Arc::new(left, right, Direction::X);
        if short.angle() < ALIKE {
            return Err(self.no_wall());
        }
        let through = self.through.map(Direction::vector);
        let middle = if short.angle() < OPPOSITE {
            let behind = through.is_some_and(|t| vector::dot(t, short.middle()) < 0.0);
            vector::scale(if behind { -1.0 } else { 1.0 }, short.middle())
        } else {
            let line = line(left, right);
            let through = through.or(context.sense_among(&self.senses(context)).map(|sense| sense.through));
            let across = through.map_or([0.0; 3], |t| vector::normal_part(t, line));
            if vector::norm(across) < ACROSS {
                return Err(along_a_domain("wall"));
            }
            vector::unit_or(across, line)
        };
        let halves = [Arc::new(left, middle, Direction::X), Arc::new(middle, right, Direction::X)];
        // a wall nearly all the way round has no plane
        if halves[0].angle() >= OPPOSITE { Err(along_a_domain("wall")) } else { Ok(halves) }
    }
}

impl StateBuilder for DomainWall {
    fn vectors(&self, context: &StateContext) -> Result<Vec<Vector>> {
        let width = width(self.width, context.lattice)?.unwrap_or(context.wall_width_sites);
        let fractions = fractions("wall", self.center, width, self.normal, context.lattice)?;
        let ways = self.turn(context)?;
        Ok(fractions.into_iter().map(|f| at(&ways, f)).collect())
    }

    fn staggered(&self) -> bool {
        self.staggered
    }

    fn senses(&self, _: &StateContext) -> Vec<Sense> {
        let [left, right] = self.domains();
        match self.through {
            None if Arc::new(left, right, Direction::X).angle() >= OPPOSITE => {
                Sense::across(left, line(left, right), self.normal.unwrap_or(Direction::X).vector()).into()
            }
            _ => Vec::new(),
        }
    }
}

/// The line of opposite domains.
fn line(left: Vector, right: Vector) -> Vector {
    vector::unit_or(vector::sub(left, right), left)
}

/// A width in spacings, where one is given.
pub(super) fn width(given: Option<Extent>, lattice: &Lattice) -> Result<Option<f64>> {
    let Some(given) = given else { return Ok(None) };
    match lattice.spacings(given).map_err(|e| e.within("width"))? {
        width if width >= 0.0 => Ok(Some(width)),
        _ => {
            let message = format!("found {given}, but a width is a number of sites, 0 or more");
            Err(Error::invalid("width", message))
        }
    }
}

/// How much of a turn across a normal each site has behind it, from 0 to 1: (2/π) atan exp((r_i·n − center)/width). An error where
/// the turn lies wholly outside; `what` names it.
pub(super) fn fractions(
    what: &str,
    center: Extent,
    width: f64,
    normal: Option<Direction>,
    lattice: &Lattice,
) -> Result<Vec<f64>> {
    let place = lattice.coordinate(center).map_err(|e| e.within("center"))?;
    let fraction = |x: f64| {
        let x = x - place;
        if width == 0.0 {
            return if x < 0.0 {
                0.0
            } else if x > 0.0 {
                1.0
            } else {
                0.5
            };
        }
        libm::atan(libm::exp((x / width).clamp(-700.0, 700.0))) / FRAC_PI_2
    };
    let coordinates = lattice.coordinates(normal);
    let first = coordinates.iter().copied().fold(f64::INFINITY, f64::min);
    let last = coordinates.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if fraction(first) > 1.0 - NO_TRACE || fraction(last) < NO_TRACE {
        let outside = match normal {
            None if lattice.counts_sites() => {
                format!("wholly outside the chain, whose sites are counted from 0 to {last},")
            }
            _ => format!("wholly outside the lattice, which reaches from {first:.4} to {last:.4} along the normal,"),
        };
        let message = format!(
            "found {center}, but a {what} there lies {outside} and leaves no trace in it: move it inside, or write \
             {{\"uniform\": {{\"direction\": […]}}}}"
        );
        return Err(Error::invalid("center", message));
    }
    Ok(coordinates.into_iter().map(fraction).collect())
}

/// The spin at a fraction of the turn.
fn at(halves: &[Arc; 2], fraction: f64) -> Vector {
    if fraction <= 0.5 { halves[0].at(2.0 * fraction) } else { halves[1].at(2.0 * fraction - 1.0) }
}
