//! A lower pass beside the highest saddle of a proven path: the same walls with other azimuths.
//!
//! Where rotations about an axis cost nothing, two walls between domains along that axis feel each other's azimuth only through
//! the tails that overlap in the domains, about as cos Δφ. So two saddles may join the same two minima, both of index one, that
//! differ by half a turn of one wall about the axis: in one the walls' distance is what falls, in the other their azimuth. No soft
//! mode leads from one to the other, so the half turn is tried, wall by wall.

use crate::energy::Evaluator;
use crate::energy::recorded;
use crate::error::Result;
use crate::field::Components;
use crate::geometry::{Direction, Vector, vector};
use crate::landscape::Pass;
use crate::landscape::Peak;
use crate::landscape::Saddle;
use crate::sphere::rotate_sites;
use crate::stationary::{Point, follow_modes};
use std::f64::consts::PI;
use std::ops::Range;

/// How often a saddle is exchanged for a lower one.
const ROUNDS: usize = 4;
/// A saddle is lower if it is so by more than this part of c.
const LOWER: f64 = 1e-6;
/// Walls whose half turn costs less than this part of c, tails cut, are far enough apart to be turned.
const APART: f64 = 0.1;
/// A spin with this part of it along the axis is in a domain, with less it is in a wall.
const DOMAIN: f64 = 0.7;
/// More walls than these are not turned one by one.
const MOST_WALLS: usize = 8;

/// The links with their highest saddle exchanged for a lower one between the same two minima; none if there is none in sight.
/// c is the stiffness scale (meV).
pub fn lowered(h: Evaluator, links: &[Pass], c: f64) -> Result<Option<Vec<Pass>>> {
    let mut better: Option<Vec<Pass>> = None;
    for _ in 0..ROUNDS {
        let now = better.as_deref().unwrap_or(links);
        let height = |k: &usize| now[*k].saddle.refined.state.energy_mev;
        let Some(k) = (0..now.len()).max_by(|i, j| height(i).total_cmp(&height(j))) else { break };
        let Some(lower) = beside(h, &now[k], c)? else { break };
        better.get_or_insert_with(|| links.to_vec())[k] = lower;
    }
    Ok(better)
}

/// A lower saddle between the minima of a link, with one of its walls turned.
fn beside(h: Evaluator, link: &Pass, c: f64) -> Result<Option<Pass>> {
    let saddle = &link.saddle.refined.state;
    for start in turned_walls(h, &saddle.m, APART * c) {
        let found = recorded(h, "saddle beside", &[&start], || Ok(saddle_at(h, &start)))?;
        let below = |f: &Saddle| saddle.above_mev(&f.refined.state) > LOWER * c;
        let Some(found) = found.into_iter().next().filter(|f| f.is_saddle(c) && below(f)) else { continue };
        let mut lower = Pass::recorded(h, found, c)?;
        if lower.before.is_same(h, &link.after) && lower.after.is_same(h, &link.before) {
            lower.reverse();
        }
        let joins = lower.before.is_same(h, &link.before) && lower.after.is_same(h, &link.after);
        if joins && lower.doubt(h).is_none() {
            return Ok(Some(lower));
        }
    }
    Ok(None)
}

/// The saddle near a state, if there is one.
fn saddle_at(h: Evaluator, m: &[f64]) -> Vec<Saddle> {
    let found = follow_modes(h, m).map(|refined| Saddle {
        top: Peak {
            m: m.to_vec(),
            tau: refined.valley.clone(),
            energy_mev: Point::at(h, m.to_vec()).energy_mev,
            s: 0.0,
            image: 0,
        },
        refined,
    });
    found.into_iter().collect()
}

/// The state with one wall turned by half a turn, for every wall for which that costs less than `most` (meV).
fn turned_walls(h: Evaluator, m: &[f64], most: f64) -> Vec<Vec<f64>> {
    let mut all = Vec::new();
    for axis in h.symmetry_axes_at(m) {
        let Ok(direction) = Direction::new(axis) else { continue };
        let walls = walls(m, axis, h.lattice().is_ring());
        if walls.len() < 2 || walls.len() > MOST_WALLS {
            continue;
        }
        // to turn all of them costs nothing, so the first may stay
        let states = walls[1..].iter().map(|wall| turned(m, wall.clone(), direction, PI));
        all.extend(states.filter(|state| h.difference_mev(state, m) < most));
    }
    all
}

/// A state with the spins of a row of sites turned about an axis; the row may go on at the start of a ring.
fn turned(m: &[f64], row: Range<usize>, axis: Direction, angle: f64) -> Vec<f64> {
    let sites = m.len() / 3;
    let mut out = m.to_vec();
    rotate_sites(&mut out, row.map(|i| i % sites), axis, angle);
    out
}

/// The rows of sites from the middle of one domain to that of the next of the other sign, each with a wall inside. On a ring the
/// last row goes on at the start.
fn walls(m: &[f64], axis: Vector, periodic: bool) -> Vec<Range<usize>> {
    let m = Components::new(m);
    let sites = m.sites();
    let along: Vec<f64> = (0..sites).map(|i| vector::dot(m.get(i), axis)).collect();
    // of each domain its site that is most along the axis
    let mut middles: Vec<usize> = Vec::new();
    for (i, x) in along.iter().enumerate().filter(|(_, x)| x.abs() > DOMAIN) {
        match middles.last_mut() {
            Some(last) if along[*last] * x > 0.0 => {
                if x.abs() > along[*last].abs() {
                    *last = i;
                }
            }
            _ => middles.push(i),
        }
    }
    let mut rows: Vec<Range<usize>> = middles.windows(2).map(|pair| pair[0]..pair[1]).collect();
    if periodic && let (Some(first), Some(last)) = (middles.first(), middles.last()) {
        if along[*first] * along[*last] < 0.0 {
            rows.push(*last..first + sites);
        } else if rows.len() > 1 {
            // one domain at both ends of the row of sites
            let second = rows.remove(0).end;
            let before = rows.pop().map_or(second, |row| row.start);
            let middle = if along[*last].abs() > along[*first].abs() { *last } else { first + sites };
            rows.extend([before..middle, middle..second + sites]);
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Spins with the given components along z, the rest along x.
    fn state(z: &[f64]) -> Vec<f64> {
        let x = z.iter().map(|z| (1.0 - z * z).sqrt());
        x.chain(z.iter().map(|_| 0.0)).chain(z.iter().copied()).collect()
    }

    #[test]
    fn walls_lie_between_the_middles_of_domains() {
        let z = [0.9, 1.0, 0.8, 0.0, -0.9, -1.0, -0.8, 0.1, 0.8, 0.95];
        let rows = |z: &[f64], periodic| walls(&state(z), [0.0, 0.0, 1.0], periodic);
        assert_eq!(rows(&z, false), [1..5, 5..9]);
        assert_eq!(rows(&z, true), [5..11, 11..15]);
        assert_eq!(rows(&z[..7], true), [1..5, 5..8]);
        assert_eq!(rows(&z[..7], false).first(), Some(&(1..5)));
        assert!(rows(&[1.0; 5], true).is_empty());
        let last = [0.8, -0.9, 0.1, -1.0, 0.9];
        assert_eq!(rows(&last, true), [3..4, 4..8]);
    }

    #[test]
    fn a_turn_about_z_on_a_row_over_the_end_of_a_ring_leaves_the_rest() {
        let m = state(&[0.0; 5]);
        let half = turned(&m, 3..6, Direction::Z, PI);
        let x = &half[..5];
        assert!(x.iter().zip([-1.0, 1.0, 1.0, -1.0, -1.0]).all(|(a, b)| (a - b).abs() < 1e-15), "{x:?}");
    }
}
