//! A wall that enters: each spin's geodesic, delayed along the chain.
//!
//! ```text
//! u_i(t) = clip((t (L + w) − x_i)/w, 0, 1)      x_i: distance from where the wall enters, L the largest, w its width
//! ```
//! then resampled to equal distances. Only sites that move by more than 0.3 rad count for x and L.

use super::clock::clocked;
use super::{FirstGuess, GuessContext};
use crate::error::{Error, Result};
use crate::geometry::{Direction, angle};
use crate::path::Path;
use crate::registry::Described;
use crate::spins::Spins;
use serde::Deserialize;
use std::fmt;

/// Spins that move by less (rad) do not make a wall.
const MOVES: f64 = 0.3;

/// Where a wall enters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Edge {
    /// At site 0.
    Left,
    /// At the last site.
    Right,
    /// In the middle, outwards both ways.
    Center,
    /// At both ends, inwards.
    Ends,
}

impl fmt::Display for Edge {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Edge::Left => "left",
            Edge::Right => "right",
            Edge::Center => "center",
            Edge::Ends => "ends",
        })
    }
}

/// `{"sweep": {"from": "left"}}`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sweep {
    /// Where the wall enters.
    pub from: Edge,
    /// Its width in sites; four times δ of the material if absent.
    #[serde(default)]
    pub width: Option<f64>,
    /// Axis about which opposite spins turn.
    #[serde(default)]
    pub axis: Option<Direction>,
}

impl Described for Sweep {
    const NAME: &'static str = "sweep";
    const SUMMARY: &'static str = "a wall enters from the left, the right, the center or both ends";
    const EXAMPLE: &'static str = r#"{"sweep": {"from": "left", "width": 4}}"#;
}

impl FirstGuess for Sweep {
    fn path(&self, a: &Spins, b: &Spins, images: usize, context: &GuessContext) -> Result<Path> {
        let sites = a.sites();
        let moving: Vec<usize> = (0..sites).filter(|&i| angle(a.get(i), b.get(i)) > MOVES).collect();
        let (first, last) =
            (moving.first().copied().unwrap_or(0) as f64, moving.last().copied().unwrap_or(sites - 1) as f64);
        let n = last - first + 1.0;
        let width = self.width.unwrap_or((4.0 * context.states.wall_width_sites).clamp(2.0, n.max(2.0)));
        if !(width.is_finite() && width > 0.0) {
            return Err(Error::invalid(
                "width",
                format!("found {width}, but a wall's width is a number of sites greater than 0"),
            ));
        }
        let entry = |i: usize| {
            let x = (i as f64 - first + 0.5).clamp(0.5, n - 0.5);
            match self.from {
                Edge::Left => x,
                Edge::Right => n - x,
                Edge::Center => (x - n / 2.0).abs(),
                Edge::Ends => n / 2.0 - (x - n / 2.0).abs(),
            }
        };
        let farthest = (0..sites).map(entry).fold(0.0, f64::max) + 0.5;
        let axis = self.axis.unwrap_or(context.default_axis);
        let clock = |t: f64, i: usize| ((t * (farthest + width) - entry(i)) / width).clamp(0.0, 1.0);
        Ok(clocked(a, b, images.max(3), axis, clock).resampled(images))
    }
}
