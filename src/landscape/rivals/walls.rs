//! The highest saddle of the route with one of its walls turned by half a turn.
//!
//! Where rotations about an axis cost nothing, two walls between domains along that axis feel each other's azimuth only through
//! the tails that overlap in the domains, about as cos Δφ. So two saddles may join the same two minima, both of index one, that
//! differ by half a turn of one wall about the axis: in one the walls' distance is what falls, in the other their azimuth. No soft
//! mode leads from one to the other.

use super::{Cut, Rival};
use crate::field::Components;
use crate::geometry::{Direction, Vector, vector};
use crate::sphere::rotate_sites;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::PI;
use std::ops::Range;

/// A spin with this part of it along the axis is in a domain, with less it is in a wall.
const DOMAIN: f64 = 0.7;
/// More walls than these are not turned one by one.
const MOST_WALLS: usize = 8;

/// What is left to be tried of the saddle that was the highest last.
#[derive(Debug, Default)]
pub struct Walls {
    saddle: Vec<f64>,
    left: Vec<Vec<f64>>,
}

impl Rival for Walls {
    fn start(&mut self, cut: &Cut, _: &mut ChaCha8Rng) -> Option<Vec<f64>> {
        let h = cut.land.evaluator();
        if !h.lattice().grid.is_row() || h.symmetry_axes().is_empty() {
            return None;
        }
        let highest = cut.highest_saddle()?;
        if self.saddle != highest {
            self.saddle = highest.to_vec();
            self.left = turned_walls(highest, &h.symmetry_axes_at(highest), h.lattice().is_ring());
        }
        self.left.pop()
    }
}

/// The state with one wall turned by half a turn, for every wall.
fn turned_walls(m: &[f64], axes: &[Vector], periodic: bool) -> Vec<Vec<f64>> {
    let mut all = Vec::new();
    for axis in axes {
        let Ok(direction) = Direction::new(*axis) else { continue };
        let walls = walls(m, *axis, periodic);
        if walls.len() < 2 || walls.len() > MOST_WALLS {
            continue;
        }
        // to turn all of them costs nothing, so the first may stay
        all.extend(walls[1..].iter().map(|wall| turned(m, wall.clone(), direction, PI)));
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
