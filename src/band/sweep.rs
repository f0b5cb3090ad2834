//! The implicit uphill sweep: nearly a Newton step for the whole band, without springs or step sizes.
//!
//! With upwind tangents a band is steepest descent integrated by implicit Euler, each image depending on its uphill neighbour
//! u alone; one pass from high to low energy solves the linearised band:
//!
//! ```text
//! for images a by descending energy:
//!   σ = |F·τ|/|m_u − m_a| (0 at extrema),   A = H + (σ + μ) 1,   C = [τ, zero modes]
//!   [A  C ] [x]   [F⊥ + σ P y_u − A x₀]
//!   [Cᵀ 0 ] [·] = [0                  ],    x₀ = d τ,    y_a = x₀ + x
//! ```
//! H is the banded Riemannian Hessian of the image. μ starts at a small part of the stiffness scale c and grows while A has a
//! negative direction in the complement of C; the count is exact (inertia of the bordered matrix).
//!
//! Images that wait for none go first, then those that wait for them, and so on: the images of one such level are solved
//! side by side, and only as many factorisations are kept as there are threads to make them.

use super::Band;
use super::linearised::{Linearised, Move, SHIFT_FLOOR};
use crate::geometry::Vector;
use rayon::prelude::*;

/// The sweep's memory between evaluations: the shifts μ, and room for the linear algebra.
#[derive(Debug)]
pub struct Sweep {
    stiffness: f64,
    shifts: Vec<f64>,
    room: Vec<Linearised>,
}

/// What one sweep amounts to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SweepStep {
    /// Largest rotation of any spin across the path (rad).
    pub rotation: f64,
    /// Banded factorisations used.
    pub factorisations: usize,
}

impl Sweep {
    /// With stiffness scale c (meV).
    pub fn new(stiffness: f64) -> Sweep {
        Sweep { stiffness, shifts: Vec::new(), room: Vec::new() }
    }

    /// The shift μ of every image (meV), all that one evaluation tells the next; empty before the first.
    pub fn shifts(&self) -> &[f64] {
        &self.shifts
    }

    /// Goes on with the shifts of another sweep.
    pub fn set_shifts(&mut self, shifts: Vec<f64>) {
        self.shifts = shifts;
    }

    /// Writes the tangent moves (rad) of the images between the ends, slab after slab, of an evaluated band.
    pub fn step(&mut self, band: &Band, axes: &[Vector], moves: &mut [f64]) -> SweepStep {
        let (images, c) = (band.images(), self.stiffness);
        self.shifts.resize(images, SHIFT_FLOOR * c);
        let order = by_level(band);
        let side_by_side = (2 * rayon::current_num_threads()).min(order.len());
        if self.room.len() < side_by_side {
            self.room.resize_with(side_by_side, Linearised::default);
        }
        let mut slabs: Vec<&mut [f64]> = moves.chunks_mut(3 * band.path().sites()).collect();
        slabs.iter_mut().enumerate().filter(|(k, _)| band.is_held(k + 1)).for_each(|(_, y)| y.fill(0.0));
        let mut step = SweepStep { rotation: 0.0, factorisations: 0 };
        for some in order.chunks(side_by_side.max(1)) {
            let room = &mut self.room[..some.len()];
            let shifts = &self.shifts;
            room.par_iter_mut().zip(some).for_each(|(r, &(_, k))| r.prepare(band, k, axes, c, shifts[k]));
            let mut first = 0;
            for level in some.chunk_by(|a, b| a.0 == b.0) {
                let room = &mut room[first..first + level.len()];
                first += level.len();
                for (&(_, k), done) in level.iter().zip(relax(band, room, level, &mut slabs)) {
                    self.shifts[k] = done.shift;
                    step.rotation = if done.rotation.is_nan() { f64::NAN } else { done.rotation.max(step.rotation) };
                    step.factorisations += done.factorisations;
                }
                if step.rotation.is_nan() {
                    return step;
                }
            }
        }
        step
    }
}

/// The moves of one level, side by side.
fn relax(band: &Band, room: &mut [Linearised], level: &[(usize, usize)], slabs: &mut [&mut [f64]]) -> Vec<Move> {
    let mut own: Vec<&mut [f64]> = level.iter().map(|&(_, k)| std::mem::take(&mut slabs[k - 1])).collect();
    let uphill = |k: usize| band.uphill(k).filter(|u| (1..band.images() - 1).contains(u)).map(|u| &*slabs[u - 1]);
    let work = room.par_iter_mut().zip(level).zip(&mut own);
    let moves = work.map(|((r, &(_, k)), y)| r.relax(band, k, uphill(k), y)).collect();
    for (&(_, k), y) in level.iter().zip(own) {
        slabs[k - 1] = y;
    }
    moves
}

/// (level, image) of the images that move: level 0 waits for no other, the others for one of the level before.
fn by_level(band: &Band) -> Vec<(usize, usize)> {
    let last = band.images() - 1;
    let level = |k: usize| {
        let (mut k, mut steps) = (k, 0);
        while let Some(u) = band.uphill(k).filter(|u| (1..last).contains(u)) {
            (k, steps) = (u, steps + 1);
        }
        steps
    };
    let mut order: Vec<(usize, usize)> = (1..last).filter(|&k| !band.is_held(k)).map(|k| (level(k), k)).collect();
    order.sort_unstable();
    order
}
