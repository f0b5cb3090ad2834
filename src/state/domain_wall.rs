//! A wall between two domains.
//!
//! ```text
//! φ_i = Φ (2/π) atan exp((i − center)/δ)      from the left direction (φ = 0) to the right one (φ = Φ)
//! ```
//! the profile of a wall in a uniaxial chain, δ = √(J/2K) sites (Landau, Lifshitz 1935). The spins turn in the plane of
//! `left` and `through`; the right direction lies in that plane or is reached on its own great circle.

use super::{StateBuilder, StateContext};
use crate::error::{Error, Result};
use crate::geometry::{Arc, Direction, Vector, vector};
use crate::registry::Described;
use serde::Deserialize;
use std::f64::consts::FRAC_PI_2;

/// `{"domain_wall": {"center": 39.5}}`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
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
    /// Where the wall passes between opposite domains; +x if absent.
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
        let through = self.through.unwrap_or(Direction::X).vector();
        let arc = Arc::new(left, right, turning_axis(left, right, through)?);
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
        Ok((0..context.chain.sites).map(|i| arc.at(fraction(i))).collect())
    }

    fn staggered(&self) -> bool {
        self.staggered
    }
}

/// The axis left × through about which a spin turns from left through `through` towards right.
fn turning_axis(left: Vector, right: Vector, through: Vector) -> Result<Direction> {
    let axis = vector::cross(left, through);
    if vector::norm(axis) > 1e-9 {
        return Direction::new(axis);
    }
    if vector::norm(vector::add(left, right)) > 1e-6 {
        return Ok(Direction::X);
    }
    Err(Error::invalid("through", "the wall is to pass through a domain's own direction: give a direction across it"))
}
