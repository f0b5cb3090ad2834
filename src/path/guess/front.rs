//! Fronts that pass over a lattice: each spin's way, delayed by the place of its site.
//!
//! ```text
//! u_i(T) = clip((T − x_i)/w, 0, 1)      x_i: where the site is along the way of the front, w the front's width, 0 ≤ T ≤ max x + w
//! ```
//! at times T of equal distances √Σ(θ_i Δu_i)². Only sites that move by more than 0.3 rad count for the x_i.
//!
//! Opposite spins turn about one axis, or about one at an angle to the front: by way of the direction that stands at the helicity to
//! the way of the front, as the spins of a skyrmion do.

use super::GuessContext;
use super::clock::{About, Ways, clocked, fraction};
use super::rotation::rotation_between;
use crate::error::{Error, Result};
use crate::geometry::{Direction, Vector, vector};
use crate::lattice::Lattice;
use crate::linalg::slab;
use crate::path::Path;
use crate::threads::{READ, apiece};
use crate::units::{Angle, Extent};
use multiversion::multiversion;
use rayon::prelude::*;

/// Spins that move by less (rad) do not make a front.
pub(super) const MOVES: f64 = 0.3;

/// Distances between images that agree to this fraction are equal.
const EVEN: f64 = 0.01;

/// Rounds of making them equal, at the most.
const ROUNDS: usize = 20;

/// Sites in one pass.
const ROW: usize = 256;

/// About what opposite spins turn as a front passes: an axis, or one at an angle to the front's way; the axis of the context if
/// neither is given. Or all spins turn as one about the axis (that of the best rotation if none is given), as in a [`Rotation`].
///
/// [`Rotation`]: super::Rotation
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Turning {
    pub(super) axis: Option<Direction>,
    pub(super) helicity: Option<Angle>,
    pub(super) rigid: bool,
}

/// Which halves of a row a front passes over, each from where to where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Fold {
    /// Both at once, from the middle.
    Outwards,
    /// Both at once, from the ends.
    Inwards,
}

/// A front.
pub(super) struct Front<'a> {
    /// Where each site is along its way, in spacings from anywhere.
    pub(super) places: Vec<f64>,
    /// Whether it passes over the two halves of these places at once.
    pub(super) fold: Option<Fold>,
    /// Which way it goes at a site.
    pub(super) way: Box<dyn Fn(usize) -> Vector + Sync + 'a>,
}

impl<'a> Front<'a> {
    /// A straight one that comes from a side.
    pub(super) fn straight(side: Direction, lattice: &Lattice) -> Front<'a> {
        let way = side.reversed();
        Front::new(lattice.coordinates(Some(way)), move |_| way.vector())
    }

    /// A round one, outwards or inwards, where `from` is the way from its middle to each site.
    pub(super) fn round(from: impl Fn(usize) -> Vector + Sync + 'a, inwards: bool, sites: usize) -> Front<'a> {
        let sign = if inwards { -1.0 } else { 1.0 };
        let places = (0..sites).map(|i| sign * vector::norm(from(i))).collect();
        // in its middle it goes where most of the lattice is
        let most = (0..sites).map(&from).fold([0.0; 3], vector::add);
        let within = vector::norm(most) < 1e-6 * sites as f64;
        let middle = if within { [1.0, 0.0, 0.0] } else { vector::unit_or(most, most) };
        Front::new(places, move |i| {
            let way = from(i);
            vector::scale(sign, if vector::norm(way) < 1e-9 { middle } else { vector::unit_or(way, way) })
        })
    }

    /// Over places, one way at each site.
    pub(super) fn new(places: Vec<f64>, way: impl Fn(usize) -> Vector + Sync + 'a) -> Front<'a> {
        Front { places, fold: None, way: Box::new(way) }
    }

    /// The path on which it passes, as wide as that, or four times as wide as a wall.
    pub(super) fn path(
        &self,
        width: Option<Extent>,
        turning: Turning,
        ways: &Ways,
        images: usize,
        context: &GuessContext,
    ) -> Result<Path> {
        if turning.axis.is_some() && turning.helicity.is_some() {
            let message =
                "opposite spins turn about an \"axis\" or at a \"helicity\" to the front: give one of the two";
            return Err(Error::invalid("helicity", message));
        }
        if turning.rigid && turning.helicity.is_some() {
            let message = "all spins turn as one (\"rigid\"), or opposite ones at a \"helicity\" to the front: give one of the two";
            return Err(Error::invalid("rigid", message));
        }
        let width = width.map(|width| context.states.lattice.spacings(width).map_err(|e| e.within("width")));
        let about = turning.about(ways, context, &*self.way);
        let lengths = about.lengths();
        let (mut entries, extent) = entered(self.places.clone(), &lengths);
        let half = extent / 2.0;
        match self.fold {
            Some(Fold::Outwards) => entries.iter_mut().for_each(|x| *x = (*x - half).abs()),
            Some(Fold::Inwards) => entries.iter_mut().for_each(|x| *x = half - (*x - half).abs()),
            None => {}
        }
        let usual = (4.0 * context.states.wall_width_sites).clamp(2.0, extent.max(2.0));
        let width = width.transpose()?.unwrap_or(usual);
        if width <= 0.0 {
            let message = format!("found {width}, but a wall's width is a number of sites greater than 0");
            return Err(Error::invalid("width", message));
        }
        let times = even_times(&entries, &lengths, width, images);
        Ok(clocked(ways, &about, images, |k, i| reached(times[k], entries[i], width)))
    }
}

/// Places from half a spacing before the first site that moves on, those beyond with the last, and how far it is to half a spacing
/// behind the last.
fn entered(mut places: Vec<f64>, lengths: &[f64]) -> (Vec<f64>, f64) {
    let wider = |[a, b]: [f64; 2], x: &f64| [a.min(*x), b.max(*x)];
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    let moving = places.iter().zip(lengths).filter(|(_, l)| **l > MOVES).map(|(x, _)| x);
    let [first, last] = match moving.fold(none, wider) {
        found if found == none => places.iter().fold(none, wider),
        found => found,
    };
    let extent = last - first + 1.0;
    places.iter_mut().for_each(|x| *x = (*x - first + 0.5).clamp(0.5, extent - 0.5));
    (places, extent)
}

impl Turning {
    /// The ways of all spins as a front passes that goes `way` at each site.
    fn about<'w>(self, ways: &'w Ways, context: &GuessContext, way: &dyn Fn(usize) -> Vector) -> About<'w> {
        if self.rigid {
            let (axis, angle) = rotation_between(ways.a, ways.b, self.axis, context);
            return ways.turned(axis, angle, &context.states.lattice.is_frozen());
        }
        let Some(Angle(helicity)) = self.helicity.filter(|_| ways.have_a_choice()) else {
            return ways.about(self.axis.unwrap_or(context.default_axis));
        };
        let (sin, cos) = libm::sincos(helicity);
        ways.about_each(|i, up| {
            let across = |v: Vector| vector::normal_part(v, up);
            let candidates = [way(i), [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(across);
            let ahead = candidates.into_iter().find(|v| vector::norm(*v) > 0.1).unwrap_or(candidates[0]);
            let ahead = vector::unit_or(ahead, ahead);
            let through = vector::add(vector::scale(cos, ahead), vector::scale(sin, vector::cross(up, ahead)));
            Direction::new(vector::cross(up, through)).unwrap_or(context.default_axis)
        })
    }
}

/// The fraction of its way a spin has gone at time T.
#[inline(always)]
fn reached(time: f64, entry: f64, width: f64) -> f64 {
    ((time - entry) / width).clamp(0.0, 1.0)
}

/// How far each spin goes between two times (rad), squared.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
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
