//! A configuration with its Hessian.

use super::point::{Point, move_free};
use crate::energy::{Evaluator, Hamiltonian};
use crate::hessian::Resolvent;
use crate::linalg::{
    Asked, Factors, Matrix, Mode, Wanted, lowest_modes_beside, modes_by_factors, remove, slab, softest,
};
use crate::threads::both;
use serde::{Deserialize, Serialize};
use std::ops::Deref;

/// What is like a mode is changed by this part of it, so that it has something of every mode.
const STIRRED: f64 = 0.1;

/// Factors are very dear where they take the arithmetic of so many solutions by them: in films of some 170² sites and more, cubes of
/// 15³.
const DEAR: f64 = 60.0;

/// Something like a mode, with something of every mode.
pub(super) fn stirred(mut like: Vec<f64>) -> Vec<f64> {
    let size = slab::norm(&like);
    slab::stir(&mut like, STIRRED * size);
    like
}

/// Whether factors of a Hessian take so long that modes are found sooner without.
pub fn is_very_dear(h: &Hamiltonian) -> bool {
    h.solutions_a_factor() > DEAR || h.forgoes_factors()
}

/// Two computations with factors of `h`, side by side; one after the other where all threads share the work of one factor, whose memory
/// two would take twice.
pub fn both_by_factors<A: Send, B: Send>(
    h: &Hamiltonian,
    a: impl FnOnce() -> A + Send,
    b: impl FnOnce() -> B + Send,
) -> (A, B) {
    if is_very_dear(h) && !h.forgoes_factors() { (a(), b()) } else { both(3 * h.sites(), a, b) }
}

/// Everything a Newton step needs, at one configuration: all that a [`Point`] has, and the Hessian.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct State {
    /// Spins, energy and gradient.
    pub point: Point,
    /// Riemannian Hessian in tangent coordinates (meV).
    #[serde(skip)]
    pub hessian: Matrix,
}

impl Deref for State {
    type Target = Point;

    fn deref(&self) -> &Point {
        &self.point
    }
}

impl State {
    /// At the spins `m`.
    pub fn at(h: Evaluator, m: Vec<f64>) -> State {
        State::of(h, Point::at(h, m))
    }

    /// At a point.
    pub fn of(h: Evaluator, point: Point) -> State {
        let mut hessian = Matrix::default();
        point.write_hessian(h, 0.0, &mut hessian);
        State { point, hessian }
    }

    /// The lowest mode, zero modes apart; none where there is no other direction.
    pub fn lowest_mode(&self, h: Evaluator) -> Option<Mode> {
        self.lowest_modes_beside(h, 1, &[]).into_iter().next()
    }

    /// The lowest modes, so many if there are, zero modes apart, where the vectors of the lowest may be known roughly; where factors take
    /// long, without them if that can be had. None where there are no factors and they are not found.
    pub fn lowest_modes_beside(&self, h: Evaluator, count: usize, roughly: &[Vec<f64>]) -> Vec<Mode> {
        self.modes(h, count, Wanted::Vectors, roughly)
    }

    /// The vector of its negative mode by factors of the Hessian that are at hand, if it has one alone, or of its lowest if it has none;
    /// nothing where those do not tell it soon, or where new factors are as cheap as solutions. A field (3N) may be `like` it.
    pub fn mode_at_hand(&self, factors: &Factors, wanted: Wanted, like: Option<&Vec<f64>>) -> Option<Vec<f64>> {
        let Matrix::Sparse(_) = self.hessian else { return None };
        let starts = like.map(|field| stirred(self.basis.coordinates(field))).into_iter().collect();
        let mut v = modes_by_factors(factors, &self.zeros, starts, wanted.residual())?.pop()?;
        // one solution more: what is left of stiff modes would show in vᵀHv
        factors.solve(&mut v, 1);
        remove(&mut v, &self.zeros);
        slab::normalise(&mut v);
        Some(v)
    }

    /// Their eigenvalues (meV) alone; `known` are the vectors of the lowest, as far as these are known.
    pub fn lowest_eigenvalues_mev(&self, h: Evaluator, count: usize, known: &[Vec<f64>]) -> Vec<f64> {
        self.modes(h, count, Wanted::Values, known).into_iter().map(|mode| mode.value).collect()
    }

    /// The lowest eigenvalue (meV), to a thousandth where more takes long.
    pub fn stiffness_mev(&self, h: Evaluator) -> Option<f64> {
        self.modes(h, 1, Wanted::Size, &[]).first().map(|mode| mode.value)
    }

    /// vᵀHv/v² (meV) of a vector in tangent coordinates.
    pub fn curvature_mev(&self, v: &[f64]) -> f64 {
        let mut image = vec![0.0; v.len()];
        self.hessian.multiply(v, &mut image);
        slab::dot(v, &image) / slab::dot(v, v)
    }

    fn modes(&self, h: Evaluator, count: usize, wanted: Wanted, known: &[Vec<f64>]) -> Vec<Mode> {
        let asked = Asked { wanted, given: known, by_factors: !h.forgoes_factors() };
        let iterated = || {
            let nearly = Resolvent::at(&h, &self.m, &self.gradient, &self.basis);
            let apply = |x: &mut [f64], theta: f64| nearly.apply(x, theta);
            softest(&self.hessian, count, &self.zeros, asked, &apply, &|| h.is_stopped())
        };
        if h.forgoes_factors() {
            return iterated().unwrap_or_default();
        }
        let found = is_very_dear(&h).then(iterated).flatten();
        found.unwrap_or_else(|| lowest_modes_beside(&self.hessian, count, &self.zeros, (wanted, known)))
    }

    /// The spins after a move along a vector field.
    pub fn moved(&self, h: &Hamiltonian, v: &[f64]) -> Vec<f64> {
        let mut m = self.m.clone();
        move_free(h, &mut m, v);
        m
    }
}
