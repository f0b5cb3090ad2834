//! A wall between two domains.
//!
//! ```text
//! φ_i = Φ (2/π) atan exp((i − center)/δ)      from the left direction (φ = 0) to the right one (φ = Φ)
//! ```
//! the profile of a wall in a uniaxial chain, δ = √(J/2K) sites (L. Landau, E. Lifshitz, Phys. Z. Sowjetunion 8, 153 (1935)).
//! The spins turn on the great circle of the two directions, the way on which `through` lies (the shorter one if absent).
//! Opposite directions, 3 rad apart or more, have no great circle of their own: there the spins turn by way of the part of
//! `through` normal to them.

use super::{StateBuilder, StateContext};
use crate::error::{Error, Result};
use crate::geometry::{Arc, Direction, Vector, vector};
use crate::registry::Described;
use schemars::JsonSchema;
use serde::Deserialize;
use std::f64::consts::FRAC_PI_2;

/// Domains farther apart than this (rad) are opposite.
const OPPOSITE: f64 = 3.0;

/// The least sine between the domains' line and a direction across it.
const ACROSS: f64 = 1e-6;

/// `{"domain_wall": {"center": 39.5}}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DomainWall {
    /// In sites; 39.5 lies between sites 39 and 40.
    pub center: f64,
    /// δ in sites; that of the material if absent. 0 is an abrupt wall.
    #[serde(default)]
    pub width: Option<f64>,
    /// Left of the wall; +z if absent.
    #[serde(default)]
    pub left: Option<Direction>,
    /// Right of the wall; −z if absent.
    #[serde(default)]
    pub right: Option<Direction>,
    /// Where the wall passes; between opposite domains +x if absent, or +y where they lie along x.
    #[serde(default)]
    pub through: Option<Direction>,
    /// Reverse odd sites.
    #[serde(default)]
    pub staggered: bool,
}

impl Described for DomainWall {
    const NAME: &'static str = "domain_wall";
    const SUMMARY: &'static str = "a wall at `center` (in sites) between two domains";
    const EXAMPLE: &'static str = r#"{"domain_wall": {"center": 5.5, "width": 2, "through": [0, 1, 0]}}"#;
}

impl StateBuilder for DomainWall {
    fn vectors(&self, context: &StateContext) -> Result<Vec<Vector>> {
        if !self.center.is_finite() {
            return Err(Error::invalid("center", "a wall's center is a finite number of sites"));
        }
        let width = self.width.unwrap_or(context.wall_width_sites);
        if !(width.is_finite() && width >= 0.0) {
            return Err(Error::invalid("width", format!("found {width}, but a width is a number of sites, 0 or more")));
        }
        let left = self.left.unwrap_or(Direction::Z).vector();
        let right = self.right.unwrap_or(Direction::Z.reversed()).vector();
        let ways = turn(left, right, self.through.map(Direction::vector))?;
        let fraction = |i: usize| {
            let x = i as f64 - self.center;
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
        Ok((0..context.chain.sites).map(|i| at(&ways, fraction(i))).collect())
    }

    fn staggered(&self) -> bool {
        self.staggered
    }
}

/// The two halves of the turn from left to right.
fn turn(left: Vector, right: Vector, through: Option<Vector>) -> Result<[Arc; 2]> {
    let short = Arc::new(left, right, Direction::X);
    let middle = if short.angle() < OPPOSITE {
        let behind = through.is_some_and(|t| vector::dot(t, short.middle()) < 0.0);
        vector::scale(if behind { -1.0 } else { 1.0 }, short.middle())
    } else {
        let line = vector::unit_or(vector::sub(left, right), left);
        let across = |v: Vector| vector::normal_part(v, line);
        let default = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(across);
        let default = if vector::norm(default[0]) > 0.1 { default[0] } else { default[1] };
        let middle = through.map_or(default, across);
        if vector::norm(middle) < ACROSS {
            return Err(along_a_domain());
        }
        vector::unit_or(middle, line)
    };
    let halves = [Arc::new(left, middle, Direction::X), Arc::new(middle, right, Direction::X)];
    // a wall all the way round, between equal domains, has no plane
    if halves[0].angle() >= OPPOSITE { Err(along_a_domain()) } else { Ok(halves) }
}

/// The spin at a fraction of the turn.
fn at(halves: &[Arc; 2], fraction: f64) -> Vector {
    if fraction <= 0.5 { halves[0].at(2.0 * fraction) } else { halves[1].at(2.0 * fraction - 1.0) }
}

fn along_a_domain() -> Error {
    let message = "the wall is to pass through a domain's own direction: give a direction across it";
    Error::invalid("through", message)
}
