//! The first paths that are natural between two states of a lattice that is no chain.
//!
//! | the states differ | paths |
//! |---|---|
//! | in a spot or a tube | geodesic; shrinking about the nearest hollow; drifting over each edge, and onto the nearest holes |
//! | in two spots, each in one of them | also the one moved to the other |
//! | in a band across the lattice | geodesic; a front from either side of it |
//! | everywhere | geodesic; a front from every edge (face); a droplet from every corner; where directions are periodic a front along each, and where all are a droplet from the middle |
//!
//! The droplet is of the state of lower energy, whichever end that is: from one end to the other or back, the paths are the same.
//!
//! Opposite spins turn in the sense whose image halfway has the least energy, of ±x, ±y, ±z, the axes that terms of the energy single
//! out, and fronts also outwards, inwards and both ways round of their way; and in the opposite sense too where that has another
//! energy. Of paths whose energies are the same all along, images of each other by a symmetry, the first stays.

use super::difference::Difference;
use super::drift::{exits, nearest_holes};
use super::front::{Front, Turning};
use super::joining::{joining_axes, own_axis};
use super::outline::Outline;
use super::translation::moved;
use super::{
    Drift, Droplet, Edge, FirstGuess, Geodesic, GuessContext, GuessSpec, Inside, NoiseSpec, Rotation, Shrink, Sweep,
    Translation, Ways,
};
use crate::energy::Hamiltonian;
use crate::geometry::matrix::UNIT;
use crate::geometry::{Direction, Vector, vector};
use crate::lattice::Lattice;
use crate::path::Path;
use crate::spins::Spins;
use crate::units::Angle;
use std::f64::consts::{FRAC_PI_2, PI};

/// Noise that frees a front from accidental symmetries (rad).
const NOISE: f64 = 2e-3;
/// Energies that differ by less than this part of the largest stiffness are equal to rounding.
const ROUNDING: f64 = 1e-9;
/// Those of two senses, or of two paths, differ by more than this part.
const DIFFERENT: f64 = 1e-6;
/// Images on which two paths are compared.
const COMPARED: usize = 9;

/// How opposite spins turn.
#[derive(Clone, Copy)]
enum Sense {
    About(Direction),
    AtHelicity(f64),
    /// With all others.
    Rigidly(Direction),
}

impl Sense {
    fn axis(self) -> Option<Direction> {
        if let Sense::About(axis) | Sense::Rigidly(axis) = self { Some(axis) } else { None }
    }

    fn helicity(self) -> Option<Angle> {
        if let Sense::AtHelicity(angle) = self { Some(Angle(angle)) } else { None }
    }

    fn is_rigid(self) -> bool {
        matches!(self, Sense::Rigidly(_))
    }

    fn reversed(self) -> Sense {
        match self {
            Sense::About(axis) => Sense::About(axis.reversed()),
            Sense::Rigidly(axis) => Sense::Rigidly(axis.reversed()),
            Sense::AtHelicity(angle) => Sense::AtHelicity(if angle > 0.0 { angle - PI } else { angle + PI }),
        }
    }
}

/// A way that a change may take through the lattice, but for the sense of opposite spins.
#[derive(Clone)]
enum Route {
    Geodesic,
    Front(Direction),
    Droplet(Option<Vector>, Inside),
    Shrink,
    Drift(Direction),
    Onto(Vector),
    Translation,
}

impl Route {
    fn guess(&self, sense: Sense, lattice: &Lattice) -> GuessSpec {
        let (axis, helicity, rigid) = (sense.axis(), sense.helicity(), sense.is_rigid());
        match self {
            Route::Geodesic => GuessSpec::Geodesic(Geodesic { axis }),
            Route::Front(side) => GuessSpec::Sweep(Sweep { axis, helicity, rigid, ..Edge::From(*side).into() }),
            Route::Droplet(at, of) => {
                let center = at.map(|at| lattice.place_of(at));
                GuessSpec::Droplet(Droplet { center, of: *of, axis, helicity, rigid, ..Droplet::default() })
            }
            Route::Shrink => GuessSpec::Shrink(Shrink { axis, helicity, rigid, ..Shrink::default() }),
            Route::Translation => GuessSpec::Translation(Translation {}),
            Route::Drift(direction) => GuessSpec::Drift(Drift { direction: Some(*direction), onto: None }),
            Route::Onto(hole) => GuessSpec::Drift(Drift { direction: None, onto: Some(lattice.place_of(*hole)) }),
        }
    }

    /// The senses that may differ.
    fn senses(&self, axes: &Axes) -> Vec<Sense> {
        let about = axes.about.iter().copied().map(Sense::About);
        let around = [0.0, PI, FRAC_PI_2, -FRAC_PI_2].map(Sense::AtHelicity);
        let none = || vec![Sense::About(Direction::X)];
        match self {
            Route::Drift(_) | Route::Onto(_) | Route::Translation => none(),
            Route::Geodesic if axes.about.is_empty() => none(),
            Route::Geodesic => about.collect(),
            _ if axes.about.is_empty() => none(),
            _ => about.chain(around).collect(),
        }
    }
}

/// The axes that senses may be about.
struct Axes {
    /// Of opposite spins; none where there are no such spins.
    about: Vec<Direction>,
    /// Of all spins as one.
    rigidly: Vec<Direction>,
    /// The highest energy as they turn so all at once (meV).
    at_once_mev: f64,
}

impl Axes {
    fn between(a: &Spins, b: &Spins, h: &Hamiltonian, choice: bool, context: &GuessContext) -> Axes {
        let oblique = |v: &Vector| v.iter().all(|c| c.abs() < 1.0);
        let own = own_axis(a, b).map(Direction::vector);
        let further = h.own_axes().into_iter().chain(own).filter(oblique);
        let axes = UNIT.into_iter().chain(further).flat_map(|v| [v, v.map(|c| -c)]);
        let about = if choice { axes.filter_map(|v| Direction::new(v).ok()).collect() } else { Vec::new() };
        let rigidly = joining_axes(h, a, b);
        let turn = |axis: &Direction| Rotation { axis: Some(*axis) }.path(a, b, COMPARED, context).ok();
        let tops = rigidly.iter().filter_map(turn).map(|path| highest(&profile(h, &path)));
        let at_once_mev = tops.fold(f64::INFINITY, f64::min);
        Axes { about, rigidly, at_once_mev }
    }
}

/// The natural first paths from a to b, each with the noise that it starts with: the geodesic, then the others by their highest
/// energies as they are made.
pub fn natural(h: &Hamiltonian, a: &Spins, b: &Spins, context: &GuessContext) -> Vec<(GuessSpec, Option<NoiseSpec>)> {
    let lattice = h.lattice();
    let (ways, difference) = (Ways::between(a, b), Difference::between(a, b, lattice));
    let choice = ways.have_a_choice();
    let axes = Axes::between(a, b, h, choice, context);
    let mut found: Vec<(GuessSpec, Vec<f64>)> = Vec::new();
    for route in routes(a, b, h, &difference) {
        let front = front(&route.guess(Sense::AtHelicity(0.0), lattice), &ways, &difference, lattice);
        let path = |sense: Sense, images: usize| match (&route, &front) {
            (Route::Geodesic, _) => Ok(Geodesic { axis: sense.axis() }.along(&ways, images, context)),
            (_, None) => route.guess(sense, lattice).member().path(a, b, images, context),
            (_, Some(front)) => {
                let turning = Turning { axis: sense.axis(), helicity: sense.helicity(), rigid: sense.is_rigid() };
                front.path(None, turning, &ways, images, context)
            }
        };
        let halfway = |sense: Sense| path(sense, 3).map_or(f64::INFINITY, |path| h.energy_mev(path.image(1)));
        let best = |senses: Vec<Sense>| best_senses(senses, h.stiffness_mev(), halfway);
        let rigid =
            if front.is_some() { axes.rigidly.iter().copied().map(Sense::Rigidly).collect() } else { Vec::new() };
        for sense in best(route.senses(&axes)).into_iter().chain(best(rigid)) {
            let guess = route.guess(sense, lattice);
            let Ok(energies) = path(sense, COMPARED).map(|path| profile(h, &path)) else { continue };
            // where a wall costs more than all spins at once, there is no place for one
            if sense.is_rigid() && highest(&energies) > axes.at_once_mev {
                continue;
            }
            let alike = |other: &(GuessSpec, Vec<f64>)| same(&energies, &other.1, h.stiffness_mev());
            if !found.iter().any(alike) {
                found.push((guess, energies));
            }
        }
    }
    let is_geodesic = |guess: &GuessSpec| matches!(guess, GuessSpec::Geodesic(_));
    found.sort_by(|p, q| is_geodesic(&q.0).cmp(&is_geodesic(&p.0)).then(highest(&p.1).total_cmp(&highest(&q.1))));
    let noise = NoiseSpec { amplitude: Angle(NOISE), seed: 5 };
    let coherent = |guess: &GuessSpec| is_geodesic(guess) && choice && !difference.is_spot();
    found.into_iter().map(|(guess, _)| (guess.clone(), (!coherent(&guess)).then_some(noise))).collect()
}

/// The front of a guess that has one: it is the same for all senses.
fn front<'l>(guess: &GuessSpec, ways: &Ways, difference: &Difference, lattice: &'l Lattice) -> Option<Front<'l>> {
    match guess {
        GuessSpec::Sweep(sweep) => sweep.front(ways, lattice).ok(),
        GuessSpec::Shrink(shrink) => shrink.front(ways, difference, lattice).ok(),
        GuessSpec::Droplet(droplet) => droplet.front(difference, lattice).ok(),
        _ => None,
    }
}

/// The ways that fit how two states differ.
fn routes(a: &Spins, b: &Spins, h: &Hamiltonian, difference: &Difference) -> Vec<Route> {
    let lattice = h.lattice();
    let direction = |v: &Vector| Direction::new(*v).ok();
    let mut routes = vec![Route::Geodesic];
    routes.extend(moved(a, b, lattice).map(|_| Route::Translation));
    if difference.is_spot() {
        routes.push(Route::Shrink);
        routes.extend(exits(a, b, lattice).iter().filter_map(direction).map(Route::Drift));
        routes.extend(nearest_holes(difference, lattice).into_iter().map(Route::Onto));
        return routes;
    }
    if let [across] = difference.across[..] {
        routes.extend([vector::scale(-1.0, across), across].iter().filter_map(direction).map(Route::Front));
        return routes;
    }
    let (outline, cells) = (Outline::of(lattice), lattice.cell_vectors());
    let climbs = h.difference_mev(b.as_slice(), a.as_slice()) > DIFFERENT * h.stiffness_mev();
    let droplet = |at: Option<Vector>| Route::Droplet(at, if climbs { Inside::Initial } else { Inside::Final });
    routes.extend(outline.edges.iter().filter_map(direction).map(Route::Front));
    routes.extend(outline.corners.iter().map(|i| droplet(Some(lattice.place(*i)))));
    let periodic = (0..3).filter(|d| lattice.grid.periodic[*d] && lattice.grid.size[*d] > 1);
    routes.extend(periodic.filter_map(|d| direction(&vector::scale(-1.0, cells[d]))).map(Route::Front));
    if outline.edges.is_empty() {
        routes.push(droplet(None));
    }
    routes
}

/// The sense of least energy (meV), the first of equal ones, and the opposite one if that differs.
fn best_senses(senses: Vec<Sense>, stiffness: f64, energy: impl Fn(Sense) -> f64) -> Vec<Sense> {
    let mut best: Option<(Sense, f64)> = None;
    for sense in senses {
        let here = energy(sense);
        if best.is_none_or(|(_, least)| here < least - ROUNDING * stiffness) {
            best = Some((sense, here));
        }
    }
    let Some((sense, least)) = best else { return Vec::new() };
    let differs = (energy(sense.reversed()) - least).abs() > DIFFERENT * stiffness;
    if differs { vec![sense, sense.reversed()] } else { vec![sense] }
}

/// The energies of the images between the ends (meV).
fn profile(h: &Hamiltonian, path: &Path) -> Vec<f64> {
    (1..path.images() - 1).map(|k| h.energy_mev(path.image(k))).collect()
}

fn highest(energies: &[f64]) -> f64 {
    energies.iter().copied().fold(f64::MIN, f64::max)
}

fn same(p: &[f64], q: &[f64], stiffness: f64) -> bool {
    p.iter().zip(q).all(|(p, q)| (p - q).abs() <= DIFFERENT * stiffness)
}
