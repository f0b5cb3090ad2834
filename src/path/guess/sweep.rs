//! A wall that enters: each spin's geodesic, delayed along the chain.
//!
//! ```text
//! u_i(T) = clip((T − x_i)/w, 0, 1)      x_i: distance from where the wall enters, w the wall's width, 0 ≤ T ≤ max x + w
//! ```
//! at times T of equal distances √Σ(θ_i Δu_i)². Only sites that move by more than 0.3 rad count for the x_i.

use super::clock::{Ways, clocked, fraction};
use super::{FirstGuess, GuessContext};
use crate::error::{Error, Result};
use crate::geometry::{Direction, angle};
use crate::linalg::slab;
use crate::path::Path;
use crate::registry::Described;
use crate::spins::Spins;
use crate::threads::{READ, apiece};
use multiversion::multiversion;
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Deserialize;
use std::fmt;
use std::ops::Range;

/// Spins that move by less (rad) do not make a wall.
const MOVES: f64 = 0.3;

/// Distances between images that agree to this fraction are equal.
const EVEN: f64 = 0.01;

/// Rounds of making them equal, at the most.
const ROUNDS: usize = 20;

/// Sites in one pass.
const ROW: usize = 256;

/// Where a wall enters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
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
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
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
        self.along(&Ways::between(a, b), images, context)
    }
}

impl Sweep {
    /// The path along ways that are known.
    pub(crate) fn along(&self, ways: &Ways, images: usize, context: &GuessContext) -> Result<Path> {
        let sites = ways.a.sites();
        let about = ways.about(self.axis.unwrap_or(context.default_axis));
        let lengths = about.lengths();
        let moving = moving(sites, |i| lengths[i]);
        let (first, n) = (moving.start as f64, moving.len() as f64);
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
        let entries: Vec<f64> = (0..sites).map(entry).collect();
        let times = even_times(&entries, &lengths, width, images);
        Ok(clocked(ways, &about, images, |k, i| reached(times[k], entries[i], width)))
    }
}

/// Number of sites from the first to the last one that moves from a to b; all of them if none does.
pub fn moving_sites(a: &Spins, b: &Spins) -> usize {
    moving(a.sites(), |i| angle(a.get(i), b.get(i))).len()
}

/// From the first to the last site that moves, where `far` tells by how much (rad); all of them if none does.
fn moving(sites: usize, far: impl Fn(usize) -> f64) -> Range<usize> {
    let moves = |i: &usize| far(*i) > MOVES;
    let ends = (0..sites).find(moves).zip((0..sites).rfind(moves));
    ends.map_or(0..sites, |(first, last)| first..last + 1)
}

/// The fraction of its way a spin has gone at time T.
#[inline(always)]
fn reached(time: f64, entry: f64, width: f64) -> f64 {
    ((time - entry) / width).clamp(0.0, 1.0)
}

/// How far each spin goes between two times (rad), squared.
#[multiversion(targets("x86_64+avx2"))]
fn squared_steps(times: [f64; 2], entries: &[f64], lengths: &[f64], width: f64, squares: &mut [f64]) {
    for ((square, x), l) in squares.iter_mut().zip(entries).zip(lengths) {
        let step = l * (reached(times[1], *x, width) - reached(times[0], *x, width));
        *square = step * step;
    }
}

/// Times at which neighbouring images are equally far apart: equal steps, stretched and squeezed until the distances agree.
fn even_times(entries: &[f64], lengths: &[f64], width: f64, images: usize) -> Vec<f64> {
    let end = entries.iter().copied().fold(0.0, f64::max) + width;
    let mut times: Vec<f64> = (0..images).map(|k| end * fraction(k, images)).collect();
    for _ in 0..ROUNDS {
        let distance = |pair: &[f64]| {
            let mut squares = [0.0; ROW];
            let rows = entries.chunks(ROW).zip(lengths.chunks(ROW));
            let sums: Vec<f64> = rows
                .map(|(entries, lengths)| {
                    let squares = &mut squares[..entries.len()];
                    squared_steps([pair[0], pair[1]], entries, lengths, width, squares);
                    slab::sum(squares)
                })
                .collect();
            slab::sum(&sums).sqrt()
        };
        let pairs = times.par_windows(2).with_min_len(apiece(3 * entries.len(), READ));
        let distances: Vec<f64> = pairs.map(distance).collect();
        let mut s = vec![0.0];
        for d in &distances {
            s.push(s[s.len() - 1] + d);
        }
        let total = s[s.len() - 1];
        if total == 0.0 || distances.iter().all(|d| (d * distances.len() as f64 / total - 1.0).abs() < EVEN) {
            break;
        }
        let at = |place: f64| {
            let i = s.partition_point(|x| *x <= place).clamp(1, s.len() - 1) - 1;
            let step = s[i + 1] - s[i];
            let t = if step > 0.0 { (place - s[i]) / step } else { 0.0 };
            times[i] + t.clamp(0.0, 1.0) * (times[i + 1] - times[i])
        };
        times = (0..images).map(|k| at(total * fraction(k, images))).collect();
    }
    times
}
