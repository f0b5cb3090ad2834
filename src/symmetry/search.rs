//! The search for a group: marks of sites and sums of gradients say what is worth trying, one random state decides.

use super::frames::{Frame, Permutation, SAME, along, are_alike, frames};
use super::marks::Marks;
use super::operation::Operation;
use super::shift::Shift;
use super::tensors::Tensors;
use crate::energy::Hamiltonian;
use crate::field::{Components, ComponentsMut};
use crate::geometry::matrix::{UNIT, apart, opposite, product, times, transposed};
use crate::geometry::{Matrix, Vector, vector};
use crate::lattice::{Lattice, Motion};
use crate::linalg::slab;
use crate::spins::Spins;
use std::sync::Arc;

/// What changes the force on a spin, or an energy a site, by less than this part of the stiffness is weak: a stray field, a little disorder.
pub const WEAK: f64 = 1e-2;

/// How much alike two things are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Alike {
    /// Forces agree that differ by less than this part of the stiffness, energies by so much a site.
    agree: f64,
    /// Squares of gradients differ by more than this part of the squared stiffness.
    noise: f64,
    /// Matrices are one that differ by less: tensors that agree but nearly turn a little otherwise than a frame does.
    turned: f64,
}

impl Alike {
    /// But for rounding.
    pub const EXACTLY: Alike = Alike { agree: 1e-12, noise: 1e-11, turned: 1e-6 };
    /// But for what is weak.
    pub const NEARLY: Alike = Alike { agree: WEAK, noise: 2.0 * WEAK, turned: 0.2 };
}

/// How many operations that move sites are tried at most.
const TRIALS: usize = 512;
/// How many axes are kept of those that the terms and the frozen spins single out.
const AXES: usize = 6;

/// What it takes to try an operation.
pub(super) struct Search<'a> {
    h: &'a Hamiltonian,
    state: &'a [f64],
    held: Arc<[bool]>,
    axes: Vec<Vector>,
    marks: Marks,
    /// The mirror image of a film along its normal.
    flat: Option<Matrix>,
    tensors: Option<Tensors>,
    /// Rotations and reflections of spins worth trying, 1 the first; once those that alone are operations are known, one of each
    /// class of those that differ by them.
    turns: Vec<Matrix>,
    /// A random state and its force.
    sample: [Vec<f64>; 2],
    /// Another one and its energy (meV).
    witness: (Vec<f64>, f64),
    trials: usize,
    within: Alike,
}

impl<'a> Search<'a> {
    pub fn new(h: &'a Hamiltonian, state: &'a [f64], alike: &[f64], within: Alike) -> Search<'a> {
        let vacant = &h.lattice().vacant;
        let held: Arc<[bool]> = (0..h.sites()).map(|i| h.is_frozen(i) || vacant[i]).collect();
        let mut search = Search {
            h,
            state,
            held,
            axes: h.symmetry_axes_at(state),
            marks: Marks::none(h.sites()),
            flat: h.lattice().flat_mirror(),
            tensors: None,
            turns: Vec::new(),
            sample: Default::default(),
            witness: Default::default(),
            trials: TRIALS,
            within,
        };
        search.marks.tell(|i| u64::from(h.is_frozen(i)) + 2 * u64::from(vacant[i]));
        if !alike.is_empty() {
            search.marks.tell(|i| alike[i].to_bits());
        }
        search.tensors = Tensors::of(h, &search.held);
        search.turns = search.candidates();
        let [m, other] = [1, 2].map(|seed| search.held_as_they_are(Spins::random(h.sites(), 0x5a3e + seed)));
        let force = search.force(&m);
        search.witness = (other.clone(), h.energy_mev(&other));
        search.sample = [m, force];
        search
    }

    pub fn into_axes(self) -> Vec<Vector> {
        self.axes
    }

    fn lattice(&self) -> &'a Arc<Lattice> {
        self.h.shared_lattice()
    }

    fn operation(&self, motion: &Motion, spin: Matrix) -> Operation {
        Operation { motion: motion.clone(), spin, lattice: self.lattice().clone(), held: self.held.clone() }
    }

    /// The operations that move no site, the identity the first.
    pub fn turns_of_spins(&mut self) -> Vec<Operation> {
        let none = Motion::none(self.lattice());
        let turns = [self.turns.as_slice(), &self.unlike(&self.told(&none), &self.turns)].concat();
        let all = turns.iter().map(|r| self.operation(&none, *r));
        let found: Vec<Operation> =
            all.enumerate().filter(|(k, o)| *k == 0 || self.is_symmetry(o)).map(|(_, o)| o).collect();
        let mut classes: Vec<Matrix> = Vec::new();
        for r in std::mem::take(&mut self.turns) {
            let reached = |q: &Matrix| found.iter().any(|o| are_alike(&product(q, &o.spin), &r, &self.axes));
            if !classes.iter().any(reached) {
                classes.push(r);
            }
        }
        self.turns = classes;
        found
    }

    /// The shortest shift along each periodic direction: of its subgroups of a cycle of n sites each has one that divides n.
    pub fn shifts(&mut self) -> Vec<Shift> {
        let lattice = self.lattice();
        let grid = lattice.grid;
        let along = |search: &mut Search, d: usize| {
            let n = grid.size[d];
            let mut parts = (1..n).filter(|k| n.is_multiple_of(*k));
            parts.find_map(|k| {
                let mut by = [0; 3];
                by[d] = k as isize;
                search.with_motion(&Motion::shift(lattice, by)).map(|operation| Shift { operation, order: n / k })
            })
        };
        (0..3).filter(|d| grid.periodic[*d]).filter_map(|d| along(self, d)).collect()
    }

    /// One operation of each class of those that move sites, of classes that differ by more than shifts and what moves none.
    pub fn motions(&mut self, shifts: &[Shift]) -> Vec<Operation> {
        let lattice = self.lattice();
        let grid = lattice.grid;
        let mut free = [0, 1, 2].map(|d| if grid.periodic[d] { grid.size[d] } else { 1 });
        for by in shifts.iter().filter_map(|shift| shift.operation.motion.shifts_by()) {
            (0..3).filter(|d| by[*d] > 0).for_each(|d| free[d] = by[d] as usize);
        }
        if free.iter().any(|n| *n > 1) {
            self.marks.look_around(lattice);
        }
        let none = Motion::none(lattice);
        let mut found = vec![self.operation(&none, UNIT)];
        // shifts along several directions at once; along one, all are known
        if free.iter().filter(|n| **n > 1).count() > 1 {
            let skew = self.placed(&none, free);
            found.extend(skew.iter().filter_map(|motion| self.with_motion(motion)));
        }
        let shifted = found.clone();
        for motion in lattice.motions() {
            let placed = self.placed(&motion, free);
            if let Some(one) = placed.iter().find_map(|motion| self.with_motion(motion)) {
                found.extend(shifted.iter().map(|s| s.after(&one)));
            }
        }
        found
    }

    /// The motions that do so and take a site of the rarest mark to one like it, but for shifts by `free`.
    fn placed(&self, motion: &Motion, free: [usize; 3]) -> Vec<Motion> {
        let (lattice, rarest) = (self.lattice(), self.marks.rarest());
        let grid = &lattice.grid;
        let (atom, from) = motion.place(lattice, rarest[0]);
        let mut list: Vec<Motion> = Vec::new();
        for (_, to) in rarest.iter().map(|i| lattice.cell(*i)).filter(|(own, _)| *own == atom) {
            let apart = [0, 1, 2].map(|d| (to[d] + grid.size[d] - from[d]) % grid.size[d]);
            if (0..3).any(|d| apart[d] > 0 && !grid.periodic[d]) {
                continue;
            }
            let by = [0, 1, 2].map(|d| (apart[d] % free[d]) as isize);
            let motion = Motion::shift(lattice, by).after(motion, lattice);
            if !motion.is_none() && !list.contains(&motion) {
                list.push(motion);
            }
        }
        list
    }

    /// The first operation that moves sites so.
    fn with_motion(&mut self, motion: &Motion) -> Option<Operation> {
        if !self.marks.allow(motion, self.lattice()) {
            return None;
        }
        let (first, others) = self.turns.split_at(self.turns.len().min(1));
        let mut turns: Vec<Matrix> = [first, &self.turned_alike(motion), others].concat();
        let told = self.told(motion);
        turns.extend(self.unlike(&told, &turns));
        // where tensors tell, others are operations by chance alone, and would use up the trials
        turns.sort_by_key(|r| !told.iter().any(|q| apart(q, r) < self.within.turned));
        let tried = self.trials.min(turns.len());
        let found = turns[..tried].iter().map(|r| self.operation(motion, *r)).position(|o| self.is_symmetry(&o));
        self.trials -= found.map_or(tried, |k| k + 1);
        found.map(|k| self.operation(motion, turns[k]))
    }

    /// The matrices that turn spins as the motion turns the lattice, or its film together with its normal, each with its
    /// opposite; none in a row, whose own are all among those of the frames.
    fn turned_alike(&self, motion: &Motion) -> Vec<Matrix> {
        // a site takes the spin from where the motion leads: the spins go the other way
        let turn = transposed(motion.turn());
        if self.lattice().is_row() || apart(&turn, &UNIT) < SAME {
            return Vec::new();
        }
        let other = self.flat.map(|mirror| product(&turn, &mirror));
        std::iter::once(turn).chain(other).flat_map(|r| [r, opposite(&r)]).collect()
    }

    /// The matrices that the tensors of bonds tell.
    fn told(&self, motion: &Motion) -> Vec<Matrix> {
        let turns = |tensors: &Tensors| tensors.turns(self.h, &self.held, |i| motion.of(self.lattice(), i));
        self.tensors.as_ref().map(turns).unwrap_or_default()
    }

    /// Those that are not known.
    fn unlike(&self, told: &[Matrix], known: &[Matrix]) -> Vec<Matrix> {
        let is_known = |r: &&Matrix| known.iter().any(|q| apart(q, r) < self.within.turned);
        told.iter().filter(|r| !is_known(r)).copied().collect()
    }

    /// f(m')_i = R f(m)_p(i) on a random state, E(m') = E(m) on another.
    fn is_symmetry(&self, o: &Operation) -> bool {
        let n = self.h.sites();
        let near = |a: Vector, b: Vector, most: f64| slab::max_abs(&vector::sub(a, b)) <= most;
        let state = Components::new(self.state);
        let frozen = |i: &usize| self.h.is_frozen(*i) && !self.h.lattice().vacant[*i];
        let image = |v: Components, i: usize| times(&o.spin, v.get(o.source(i)));
        if !(0..n).filter(frozen).all(|i| near(image(state, i), state.get(i), SAME)) {
            return false;
        }
        let [m, force] = &self.sample;
        let (moved, force) = (self.force(&o.apply(m)), Components::new(force));
        let (moved, most) = (Components::new(&moved), self.within.agree * self.h.stiffness_mev());
        let (other, energy_mev) = &self.witness;
        (0..n).all(|i| near(moved.get(i), image(force, i), most))
            && (self.h.energy_mev(&o.apply(other)) - energy_mev).abs() <= most * n as f64
    }

    /// The force on the spins that are not held (meV).
    fn force(&self, m: &[f64]) -> Vec<f64> {
        let (mut g, mut force) = (vec![0.0; m.len()], vec![0.0; m.len()]);
        self.h.energy_gradient(m, &mut g);
        self.h.force(m, &g, &mut force);
        self.without_held(force)
    }

    fn without_held(&self, mut v: Vec<f64>) -> Vec<f64> {
        let mut field = ComponentsMut::new(&mut v);
        (0..self.held.len()).filter(|i| self.held[*i]).for_each(|i| field.set(i, [0.0; 3]));
        v
    }

    /// A state with the held spins as they are.
    fn held_as_they_are(&self, spins: Spins) -> Vec<f64> {
        let (mut m, state) = (spins.as_slice().to_vec(), Components::new(self.state));
        let mut to = ComponentsMut::new(&mut m);
        (0..self.held.len()).filter(|i| self.held[*i]).for_each(|i| to.set(i, state.get(i)));
        m
    }

    /// ∂E/∂m of the state with all free spins along ± each axis of a frame.
    fn uniform_gradients(&self, frame: &Frame) -> impl Iterator<Item = Vec<f64>> {
        frame.iter().flat_map(|e| [*e, vector::scale(-1.0, *e)]).map(|along| {
            let components = along.iter().flat_map(|c| std::iter::repeat_n(*c, self.h.sites())).collect::<Vec<_>>();
            let mut g = vec![0.0; components.len()];
            self.h.energy_gradient(&self.held_as_they_are(Spins::from_unit_components(&components)), &mut g);
            self.without_held(g)
        })
    }

    /// Tells the sites by Σ |∂E/∂m_i|² over uniform states along ±x, ±y and ±z, and lists the matrices R worth trying: those that
    /// take Σ_i ∂E/∂m_i of the uniform states of a frame to each other, as any operation with R does, wherever it moves the sites.
    fn candidates(&mut self) -> Vec<Matrix> {
        let n = self.h.sites();
        let mut squares = vec![0.0; n];
        let mut list = Vec::new();
        for frame in frames(self.h, &self.axes, &self.known_axes()) {
            let mut sums = [[[0.0; 3]; 2]; 3];
            for (k, g) in self.uniform_gradients(&frame).enumerate() {
                sums[k / 2][k % 2] = [0, 1, 2].map(|c| slab::sum(&g[c * n..(c + 1) * n]));
                if frame == UNIT {
                    let g = Components::new(&g);
                    squares.iter_mut().enumerate().for_each(|(i, s)| *s += vector::dot(g.get(i), g.get(i)));
                }
            }
            list.extend(self.fitting(&frame, &sums));
        }
        let stiffness = self.h.stiffness_mev();
        self.marks.tell_values(&squares, self.within.noise * stiffness * stiffness);
        if self.axes.len() == 3 {
            list = vec![UNIT, opposite(&UNIT)];
        }
        // the identity is one whatever the energy says, also where that is none any more
        let mut distinct = vec![UNIT];
        for r in list {
            if !distinct.iter().any(|q| are_alike(&r, q, &self.axes)) {
                distinct.push(r);
            }
        }
        distinct
    }

    /// The matrices of a frame that take the sums of the states along each axis (forwards, backwards) to those of its image.
    fn fitting(&self, frame: &Frame, sums: &[[Vector; 2]; 3]) -> Vec<Matrix> {
        let most = self.within.agree * self.h.stiffness_mev() * self.h.sites() as f64;
        let fits = |p: &Permutation, r: &Matrix| {
            (0..6).all(|k| {
                let (axis, sense) = (k / 2, k % 2);
                let image = sums[p.to[axis]][sense ^ usize::from(p.reversed[axis])];
                slab::max_abs(&vector::sub(times(r, sums[axis][sense]), image)) <= most
            })
        };
        Permutation::all().map(|p| (p, p.matrix(frame))).filter(|(p, r)| fits(p, r)).map(|(_, r)| r).collect()
    }

    /// Axes that the terms and the frozen spins single out, the first few.
    fn known_axes(&self) -> Vec<Vector> {
        let state = Components::new(self.state);
        let vacant = &self.h.lattice().vacant;
        let frozen = (0..self.h.sites()).filter(|i| self.h.is_frozen(*i) && !vacant[*i]).map(|i| state.get(i));
        let mut known: Vec<Vector> = Vec::new();
        for axis in self.h.terms().iter().flat_map(|t| t.axes()).chain(frozen) {
            if known.len() < AXES && !known.iter().any(|k| along(*k, axis)) {
                known.push(axis);
            }
        }
        known
    }
}
