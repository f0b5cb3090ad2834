//! The implicit uphill sweep: nearly a Newton step for the whole band, without springs or step sizes.
//!
//! With upwind tangents a band is steepest descent integrated by implicit Euler, each image depending on its uphill neighbour
//! u alone; one pass from high to low energy solves the linearised band:
//!
//! ```text
//! for images a by descending energy:
//!   σ = |F·τ|/|m_u − m_a| (0 at extrema),   A = H + σ + μ,   C = [τ, zero modes]
//!   [A  C ] [x]   [F⊥ + σ P y_u − A x₀]
//!   [Cᵀ 0 ] [·] = [0                  ],    x₀ = d τ,    y_a = x₀ + x
//! ```
//! H is the Riemannian Hessian of the image. μ starts at a small part of the stiffness scale c and grows while A has a negative
//! direction in the complement of C. In chains and small lattices of short reach, where factors are cheap, the count of those is exact
//! (inertia of the bordered matrix, see `linearised`). In others x is found by iteration, with those that it meets (see `iterated`), and
//! A is the derivative of F⊥ (see `upwind`), so that the last sweeps are Newton's.
//!
//! Images that wait for none go first, side by side; the slopes that hang on them after that, each from its top down.

use super::Band;
use super::iterated::{Iterated, ROUGH, TOLERANCE};
use super::linearised::{Linearised, Move, SHIFT_FLOOR};
use crate::energy::Hamiltonian;
use crate::geometry::Vector;
use crate::hessian::StandIn;
use crate::threads::MADE;
use rayon::prelude::*;
use std::collections::VecDeque;
use std::mem::take;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// The sweep's memory between evaluations: the shifts μ, and room for the linear algebra.
#[derive(Debug)]
pub struct Sweep {
    stiffness: f64,
    tolerance: f64,
    shifts: Vec<f64>,
    rooms: Rooms,
    /// For images that are found by iteration, if they are.
    stand_in: OnceLock<Option<Arc<StandIn>>>,
}

/// Room for the linear algebra of an image, with factors or without.
#[derive(Debug)]
enum Room {
    Factors(Box<Linearised>),
    Products(Box<Iterated>),
}

/// Room for the linear algebra of as many images as are worked on at a time.
#[derive(Debug, Default)]
struct Rooms(Mutex<Vec<Room>>);

impl Rooms {
    fn take(&self) -> Option<Room> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).pop()
    }

    fn give_back(&self, room: Room) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(room);
    }
}

/// Images one below the other, each waiting for the one before it.
struct Slope<'m> {
    images: Vec<usize>,
    moves: Vec<&'m mut [f64]>,
    /// The move that the first one waits for.
    above: Option<&'m [f64]>,
    /// The first one, if it is prepared already.
    ahead: Option<Room>,
}

/// What all images of a sweep need.
#[derive(Clone, Copy)]
struct Task<'a> {
    band: &'a Band<'a>,
    axes: &'a [Vector],
    stiffness: f64,
    shifts: &'a [f64],
    rooms: &'a Rooms,
    /// Where images are found by iteration.
    stand_in: Option<&'a Arc<StandIn>>,
    /// What they leave of their residuals.
    tolerance: f64,
    /// How many threads are worth waking.
    threads: usize,
}

impl Task<'_> {
    fn prepared(&self, k: usize) -> Room {
        let new = || match self.stand_in {
            Some(stand_in) => Room::Products(Box::new(Iterated::by(stand_in.clone(), self.tolerance))),
            None => Room::Factors(Box::default()),
        };
        let mut room = self.rooms.take().unwrap_or_else(new);
        let (c, old) = (self.stiffness, self.shifts[k]);
        match &mut room {
            Room::Factors(room) => room.prepare(self.band, k, self.axes, c, old),
            Room::Products(room) => room.prepare(self.band, k, self.axes, old),
        }
        room
    }

    fn relax(&self, mut room: Room, k: usize, above: Option<&[f64]>, y: &mut [f64]) -> (usize, Move) {
        let done = match &mut room {
            Room::Factors(room) => room.relax(self.band, k, above, y),
            Room::Products(room) => room.relax(self.band, k, above, y),
        };
        self.rooms.give_back(room);
        (k, done)
    }

    /// Relaxes the tops; threads without a top prepare the first images of the slopes, longest slopes first.
    fn relax_tops(
        &self,
        tops: &[usize],
        moves: &mut [&mut [f64]],
        slopes: &[Vec<usize>],
    ) -> (Vec<(usize, Move)>, Vec<Room>) {
        let idle = if tops.is_empty() { 0 } else { self.threads.saturating_sub(tops.len()) };
        let firsts: Vec<usize> = slopes.iter().map(|slope| slope[0]).take(idle).collect();
        let images = tops.par_iter().zip(moves).with_min_len(self.apiece()).with_max_len(self.apiece());
        let relax = || images.map(|(&k, y)| self.relax(self.prepared(k), k, None, y)).collect();
        if firsts.is_empty() {
            return (relax(), Vec::new());
        }
        rayon::join(relax, || firsts.par_iter().with_max_len(1).map(|&k| self.prepared(k)).collect())
    }

    fn relax_slopes(&self, slopes: Vec<Slope>) -> Vec<(usize, Move)> {
        let side_by_side = self.threads.div_ceil(slopes.len().max(1));
        let slopes = slopes.into_par_iter().with_min_len(self.apiece()).with_max_len(self.apiece());
        slopes.flat_map_iter(|slope| self.descend(slope, side_by_side)).collect()
    }

    /// How many tops or slopes make a piece of work.
    fn apiece(&self) -> usize {
        if self.threads == 1 { usize::MAX } else { 1 }
    }

    /// Relaxes the images of a slope, `side_by_side` of them prepared at a time.
    fn descend(&self, slope: Slope, side_by_side: usize) -> Vec<(usize, Move)> {
        let mut above = slope.above;
        let mut ready: VecDeque<Room> = slope.ahead.into_iter().collect();
        let mut done = Vec::with_capacity(slope.images.len());
        for (i, y) in slope.moves.into_iter().enumerate() {
            if ready.is_empty() {
                let next = &slope.images[i..slope.images.len().min(i + side_by_side)];
                ready = match next {
                    [k] => [self.prepared(*k)].into(),
                    _ => next.par_iter().map(|k| self.prepared(*k)).collect::<Vec<_>>().into(),
                };
            }
            let room = ready.pop_front().unwrap_or_else(|| self.prepared(slope.images[i]));
            done.push(self.relax(room, slope.images[i], above, y));
            above = Some(y);
        }
        done
    }
}

/// What one sweep amounts to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SweepStep {
    /// Largest rotation of any spin across the path (rad).
    pub rotation: f64,
    /// Factorisations used.
    pub factorisations: usize,
    /// Products with a Hessian in their place.
    pub products: usize,
}

impl Sweep {
    /// With stiffness scale c (meV).
    pub fn new(stiffness: f64) -> Sweep {
        let (shifts, rooms, stand_in) = (Vec::new(), Rooms::default(), OnceLock::new());
        Sweep { stiffness, tolerance: TOLERANCE, shifts, rooms, stand_in }
    }

    /// Of a band that is only to be looked at.
    pub fn roughly(self) -> Sweep {
        Sweep { tolerance: ROUGH, ..self }
    }

    /// With what stands in for the Hessians of all bands of a run, instead of one made for the first band; None where there are factors.
    pub fn sharing(self, stand_in: Option<Arc<StandIn>>) -> Sweep {
        Sweep { stand_in: OnceLock::from(stand_in), ..self }
    }

    /// What stands in for the Hessians of bands between two states, where factors take long; c is the stiffness scale (meV).
    pub fn stand_in(h: &Hamiltonian, ends: [&[f64]; 2], c: f64) -> Option<Arc<StandIn>> {
        Iterated::stand_in(h, ends, c).map(Arc::new)
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
        self.shifts.resize(band.images(), SHIFT_FLOOR * self.stiffness);
        let small = moves.len() < MADE;
        let mut slabs: Vec<&mut [f64]> = moves.chunks_mut(3 * band.path().sites()).collect();
        slabs.iter_mut().enumerate().filter(|(k, _)| band.is_held(k + 1)).for_each(|(_, y)| y.fill(0.0));
        let threads = if small { 1 } else { rayon::current_num_threads() };
        let (shifts, rooms) = (&self.shifts[..], &self.rooms);
        let make = || Sweep::stand_in(band.hamiltonian(), band.ends(), self.stiffness);
        let stand_in = self.stand_in.get_or_init(make).as_ref();
        let (stiffness, tolerance) = (self.stiffness, self.tolerance);
        let task = Task { band, axes, stiffness, shifts, rooms, stand_in, tolerance, threads };
        let (tops, slopes) = tops_and_slopes(band);
        let mut at_top: Vec<&mut [f64]> = tops.iter().map(|k| take(&mut slabs[k - 1])).collect();
        let (mut done, ahead) = task.relax_tops(&tops, &mut at_top, &slopes);
        let mut above: Vec<Option<&[f64]>> = vec![None; band.images()];
        for (k, y) in tops.into_iter().zip(at_top) {
            above[k] = Some(y);
        }
        let mut ahead = ahead.into_iter();
        let slopes = slopes.into_iter().map(|images| Slope {
            above: waits_for(band, images[0]).and_then(|k| above[k]),
            moves: images.iter().map(|k| take(&mut slabs[k - 1])).collect(),
            ahead: ahead.next(),
            images,
        });
        done.extend(task.relax_slopes(slopes.collect()));
        self.settle(&done)
    }

    fn settle(&mut self, done: &[(usize, Move)]) -> SweepStep {
        let mut step = SweepStep { rotation: 0.0, factorisations: 0, products: 0 };
        for (k, image) in done {
            self.shifts[*k] = image.shift;
            step.rotation =
                if (step.rotation + image.rotation).is_nan() { f64::NAN } else { image.rotation.max(step.rotation) };
            step.factorisations += image.factorisations;
            step.products += image.products;
        }
        step
    }
}

/// The image that moves and that image k waits for.
fn waits_for(band: &Band, k: usize) -> Option<usize> {
    band.uphill(k).filter(|&u| (1..band.images() - 1).contains(&u) && !band.is_held(u))
}

/// The images that two others wait for, and the slopes: images that wait for one of those or for none, with those that wait for
/// them, one after the other. Longest slopes first.
fn tops_and_slopes(band: &Band) -> (Vec<usize>, Vec<Vec<usize>>) {
    let last = band.images() - 1;
    let moves = |k: &usize| !band.is_held(*k);
    let (mut tops, mut slopes) = (Vec::new(), Vec::new());
    for k in (1..last).filter(moves).filter(|&k| waits_for(band, k).is_none()) {
        let on: Vec<usize> = (k + 1..last).filter(moves).take_while(|&j| waits_for(band, j) == Some(j - 1)).collect();
        let back: Vec<usize> = (1..k).rev().filter(moves).take_while(|&j| waits_for(band, j) == Some(j + 1)).collect();
        if on.is_empty() || back.is_empty() {
            slopes.push([vec![k], on, back].concat());
        } else {
            tops.push(k);
            slopes.extend([on, back]);
        }
    }
    slopes.sort_by_key(|slope| std::cmp::Reverse(slope.len()));
    (tops, slopes)
}
