//! States that slide: soft translations over a lattice, a soft turn of all spins, and the volume of the places that they reach.
//!
//! ```text
//! v_a           what a shift or a turn along way a does to the spins;  Z: an orthonormal basis of all v_a
//! w             the valleys along Z: of all moves by 1 along Z_k and by 0 along the others that of least energy, orthonormal
//! K = (wᵀH⁻¹w)⁻¹,  ℓ_a = wᵀv_a,   U_a = ℓ_aᵀKℓ_a/2π²
//! E(x) = Σ_a E_a(x_a)                            x_a in shifts and turns that keep the energy; see `pinning`
//! ∫ e^(−E/k_BT) dV = V · Π_a ∫₀¹ e^(−E_a/k_BT) dx  1 where it slides freely, √(k_BT/πU) where it is held
//! V = P √det G,   G_ab = ℓ_a · ℓ_b               P places, as many as free shifts and turns make of the state
//! ```
//! The Hessian's determinant is that on the space normal to w. Where the state is held, the product of both is the determinant of all
//! of the Hessian, however little of a translation its soft modes are; where it slides freely, w are these modes.
//!
//! Where the ℓ_a are not orthogonal, all U_a are scaled so that the integral is the harmonic one where the state is held (a factor of
//! ¾ on a triangular lattice); where not all ways are soft, there is one U for each soft valley, along the way that it moves the state
//! farthest. v_a of a shift is one of two: the derivative, ∂m/∂x_a (to sixth order in the distance of two sites), which rates are made
//! of; and the finite hop, Log_m(T_a m), the geodesic to the state in the next place, which cuts the corner. On a fine lattice they are
//! the same. Volumes of skyrmions by a hop: P. F. Bessarab et al., Sci. Rep. 8, 3433 (2018), doi:10.1038/s41598-018-21623-3; the
//! integral over a cosine, which K. S. Pitzer and W. D. Gwinn, J. Chem. Phys. 10, 428 (1942), doi:10.1063/1.1723744, have for the
//! hindered rotation of a molecule.
//!
//! A turn is one of all free spins about an axis that a term singles out, by 2π/n where n such turns keep the energy: v = 2π/n axis × m.
//! Of several axes the softest is taken, and none where the energy has an axis of its own, about which turns are zero modes. A circle
//! about the axis so small that the state comes back to where it was is no valley, nor one across which k_BT moves it as far as to its
//! centre.
//!
//! A valley is integrated so from the k_BT on at which the harmonic integral over one place fails (see `pinning`). The top between two places
//! is the energy half-way to the next, at rest normal to the valley. The hop to the next place must go on from the hop from the one
//! before: a state as narrow as a spin or two jumps, and each of its places is a state. Nor does a state slide along a way that is mostly
//! its descent or a zero mode. Which shifts and turns are free: those that keep each minimum beside the saddle that does not itself slide, a turn
//! to less than k_BT; the others lead to a saddle between other minima. A saddle slides along shifts that keep one minimum, past places of the
//! other, where that is held, and these share what its valley holds. All this is decided at each temperature by itself.

mod pinning;
mod valleys;
mod ways;

use super::validity::LARGE;
use super::{UnknownModes, Unstable, ZeroKind, ZeroModes};
use crate::energy::{Evaluator, Hamiltonian};
use crate::linalg::{eigen_symmetric, orthonormal, remove, slab};
use crate::stationary::State;
use crate::symmetry::Group;
use crate::units::K_B;
pub use pinning::Pinning;
use std::collections::BTreeMap;
use std::rc::Rc;
pub use valleys::LEAST;
use valleys::{Held, Valley};
use ways::Way;
pub use ways::{Generator, Turn};

/// Fewer sites along a direction leave nothing room to slide.
const FEWEST: usize = 7;
/// A state that nothing but the edges of its lattice holds may be moved by k_BT over this part of it.
const ROOM: f64 = 0.25;
/// A move of which less than this part is its own is none beside the others.
const OWN: f64 = 1e-3;

/// All ways in which a stationary state may slide, whatever the temperature.
pub struct Slide<'a> {
    h: Evaluator<'a>,
    held: Held<'a>,
    ways: Vec<Way>,
    /// Where k_BT moves it over a lattice that does not repeat: above which one (meV), and by how many cells there.
    wanders: Option<[f64; 2]>,
    /// The valleys along those ways that were asked for.
    known: BTreeMap<Vec<usize>, Rc<Along>>,
}

/// The valleys along some ways.
struct Along {
    valleys: Vec<Valley>,
    /// Of each way the part along the valleys.
    derivatives: Vec<Vec<f64>>,
    /// Of each way.
    by_way: Vec<Pinning>,
    /// Of each valley, the spins turning by as much as along the longest way.
    by_valley: Vec<Pinning>,
}

/// How a stationary state slides at a temperature.
#[derive(Clone, Debug, PartialEq)]
pub struct Sliding {
    /// Orthonormal directions of its valleys, tangent coordinates (2N).
    pub modes: Vec<Vec<f64>>,
    /// Of each mode the curvature of the energy (meV).
    curvatures_mev: Vec<f64>,
    /// What the volume is made of.
    soft: Vec<Soft>,
    /// Whether it is held along others.
    in_part: bool,
    /// Volume from a place to the next, of shifts and of all: by the derivative and by the hop.
    volumes: [[f64; 2]; 2],
}

/// A way, or, where not all valleys along the ways are soft, a valley with the way that moves the state farthest along it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Soft {
    generator: Generator,
    pinning: Pinning,
    /// By the derivative and by the hop (rad).
    lengths: [f64; 2],
}

impl<'a> Slide<'a> {
    /// Of a state with its descending mode. No more is sought than matters where k_BT is below `most_mev`.
    pub fn of(
        h: Evaluator<'a>,
        state: &'a State,
        unstable: Option<&Unstable>,
        group: &Group,
        most_mev: f64,
    ) -> Slide<'a> {
        let held = Held::new(state, unstable, h.stiffness_mev() / 3.0);
        let roomy = (0..3).filter(|d| h.lattice().grid.size[*d] >= FEWEST);
        let (along, across): (Vec<usize>, Vec<usize>) = roomy.partition(|d| ways::shift_along(group, *d).is_some());
        // an open row ends by what its walls rest at
        let across = across.into_iter().filter(|d| !h.lattice().is_row() || h.lattice().grid.periodic[*d]);
        let beside: Vec<Vec<f64>> = along.iter().filter_map(|d| moved_along(&h, &held, *d)).collect();
        let wanders = across.filter_map(|d| wanders(&h, &held, d, &beside)).min_by(|a, b| a[0].total_cmp(&b[0]));
        let ways = ways::all(h, &held, group, &along, most_mev);
        Slide { h, held, ways, wanders, known: BTreeMap::new() }
    }

    /// Along what it moves at a k_BT (meV) that nobody knows how far it goes.
    pub fn unknown(&self, thermal_mev: f64) -> Option<UnknownModes> {
        let [from, cells] = self.wanders.filter(|[from, _]| thermal_mev > *from)?;
        Some(UnknownModes::Wanders { cells, kelvin: from / K_B })
    }

    /// At a k_BT (meV), along the ways that are free.
    pub fn at(&mut self, thermal_mev: f64, free: &dyn Fn(&Generator) -> bool) -> Sliding {
        let mut own: Vec<Vec<f64>> = Vec::new();
        let mut chosen = Vec::new();
        for (k, way) in self.ways.iter().enumerate() {
            if way.is_open(thermal_mev) && free(&way.generator) {
                let mut rest = way.derivative.clone();
                remove(&mut rest, &own);
                if slab::norm(&rest) >= OWN * slab::norm(&way.derivative) {
                    own.push(valleys::unit(&rest));
                    chosen.push(k);
                }
            }
        }
        self.soft(&chosen, own, thermal_mev)
    }

    /// Along chosen ways, which span `space`, all valleys or those that are soft.
    fn soft(&mut self, chosen: &[usize], space: Vec<Vec<f64>>, thermal_mev: f64) -> Sliding {
        let (ways, held) = (&self.ways, &self.held);
        let made = || Rc::new(Along::new(held, chosen.iter().map(|k| &ways[*k]), &space));
        let along = self.known.entry(chosen.to_vec()).or_insert_with(made).clone();
        let loose = |pinning: &Pinning| pinning.loosens_mev() < thermal_mev;
        let ways: Vec<&Way> = chosen.iter().map(|k| &self.ways[*k]).collect();
        if !along.valleys.is_empty() && along.by_way.iter().all(loose) {
            return Sliding::along_ways(&along, &ways);
        }
        let soft: Vec<usize> = (0..along.valleys.len()).filter(|k| loose(&along.by_valley[*k])).collect();
        Sliding::along_valleys(&along, &soft, &ways)
    }

    /// Every k_BT (meV) that was met at which something changes.
    pub fn levels_mev(&self) -> Vec<f64> {
        let closes = self.ways.iter().map(|way| way.closes_mev).filter(|mev| mev.is_finite());
        let own = self.ways.iter().map(Way::opens_mev).chain(closes).chain(self.wanders.map(|[from, _]| from));
        let all = |along: &Rc<Along>| along.by_way.iter().map(Pinning::loosens_mev).reduce(f64::max);
        let each = self.known.values().flat_map(|along| along.by_valley.iter().map(Pinning::loosens_mev));
        own.chain(self.known.values().filter_map(all)).chain(each).collect()
    }

    /// Every height (meV) that was met of a top between two places.
    pub fn tops_mev(&self) -> impl Iterator<Item = f64> {
        self.known.values().flat_map(|along| along.by_way.iter().chain(&along.by_valley)).map(|pinning| pinning.top_mev)
    }

    /// The turn along which it may slide.
    pub fn turn(&self) -> Option<Turn> {
        self.ways.iter().find_map(|way| turn_of(&way.generator))
    }

    /// How much higher (meV) the state is half-way to where a turn takes it, all spins alike.
    pub fn turned_mev(&self, turn: &Turn) -> f64 {
        let m = &self.held.state.m;
        self.h.difference_mev(&turn.half(&self.h, m.clone()), m)
    }
}

impl Along {
    fn new<'w>(held: &Held, ways: impl Iterator<Item = &'w Way>, space: &[Vec<f64>]) -> Along {
        let (mut derivatives, tops): (Vec<Vec<f64>>, Vec<f64>) =
            ways.map(|way| (way.derivative.clone(), way.pinning.top_mev)).unzip();
        let valleys = held.valleys(space);
        let span: Vec<Vec<f64>> = valleys.iter().map(|w| w.along.clone()).collect();
        for v in &mut derivatives {
            let mut beside = v.clone();
            remove(&mut beside, &span);
            slab::add_scaled(v, -1.0, &beside);
        }
        let by_way = pinning_by_way(&derivatives, &valleys, &tops);
        let farthest = derivatives.iter().map(|v| slab::norm(v)).fold(0.0, f64::max);
        let top_mev = tops.iter().copied().fold(0.0, f64::max);
        let by_valley = valleys.iter().map(|w| Pinning::new(w.stiffness_mev, farthest, top_mev)).collect();
        Along { valleys, derivatives, by_way, by_valley }
    }
}

impl Sliding {
    /// Along all of some ways.
    fn along_ways(along: &Along, ways: &[&Way]) -> Sliding {
        let soft = |(k, way): (usize, &&Way)| {
            let lengths = [slab::norm(&along.derivatives[k]), slab::norm(&way.hop)];
            Soft { generator: way.generator, pinning: along.by_way[k], lengths }
        };
        let hops: Vec<Vec<f64>> = ways.iter().map(|way| way.hop.clone()).collect();
        let both = |kept: &dyn Fn(&Generator) -> bool| {
            [&along.derivatives, &hops]
                .map(|moves| volume(moves.iter().zip(ways).filter(|(_, way)| kept(&way.generator)).map(|(v, _)| v)))
        };
        Sliding {
            modes: along.valleys.iter().map(|w| w.along.clone()).collect(),
            curvatures_mev: along.valleys.iter().map(|w| w.curvature_mev).collect(),
            soft: ways.iter().enumerate().map(soft).collect(),
            in_part: false,
            volumes: [both(&is_shift), both(&|_| true)],
        }
    }

    /// Along some of the valleys.
    fn along_valleys(along: &Along, soft: &[usize], ways: &[&Way]) -> Sliding {
        let made = |k: &usize| {
            let valley = &along.valleys[*k];
            let moves = |v: &[f64]| slab::dot(v, &valley.along).abs();
            let by: Vec<f64> = along.derivatives.iter().map(|v| moves(v)).collect();
            let longest = (0..by.len()).fold(0, |l, a| if by[a] > by[l] { a } else { l });
            Soft {
                generator: ways[longest].generator,
                pinning: Pinning::new(valley.stiffness_mev, by[longest], ways[longest].pinning.top_mev),
                lengths: [by[longest], ways.iter().map(|way| moves(&way.hop)).fold(0.0, f64::max)],
            }
        };
        let made: Vec<Soft> = soft.iter().map(made).collect();
        let both = |kept: &dyn Fn(&Generator) -> bool| {
            [0, 1].map(|by| made.iter().filter(|s| kept(&s.generator)).map(|s| s.lengths[by]).product())
        };
        Sliding {
            modes: soft.iter().map(|k| along.valleys[*k].along.clone()).collect(),
            curvatures_mev: soft.iter().map(|k| along.valleys[*k].curvature_mev).collect(),
            volumes: [both(&is_shift), both(&|_| true)],
            in_part: !made.is_empty() && made.len() < along.valleys.len(),
            soft: made,
        }
    }

    /// Whether it slides over the lattice.
    pub fn shifts(&self) -> bool {
        self.soft.iter().any(|s| is_shift(&s.generator))
    }

    /// The highest top (meV) between two places of the lattice along which it slides.
    pub fn top_mev(&self) -> f64 {
        let tops = self.soft.iter().filter(|s| is_shift(&s.generator)).map(|s| s.pinning.top_mev);
        tops.fold(0.0, f64::max)
    }

    /// The fields (3N) at a state along which alone it slides; none where it does along all that move it.
    pub fn lines(&self, state: &State) -> Vec<Vec<f64>> {
        self.modes.iter().filter(|_| self.in_part).map(|mode| state.field(mode)).collect()
    }

    /// The turn along which it slides.
    pub fn turn(&self) -> Option<Turn> {
        self.soft.iter().find_map(|s| turn_of(&s.generator))
    }

    /// How many of its valleys are flat to rounding.
    pub fn flat(&self, floor_mev: f64) -> usize {
        self.curvatures_mev.iter().filter(|c| c.abs() <= floor_mev).count()
    }

    /// What a place costs along each way, or valley.
    pub fn pinning(&self) -> impl Iterator<Item = Pinning> {
        self.soft.iter().map(|s| s.pinning)
    }

    /// What is said of it, of each kind apart; it has so many places that free shifts make.
    pub fn said(&self, places: usize) -> Vec<ZeroModes> {
        let [shifts, all] = self.volumes;
        let turns = [0, 1].map(|by| all[by] / shifts[by]);
        let fold = self.turn().map_or(1, |turn| turn.fold);
        let of = |kind: ZeroKind, volumes: [f64; 2], places: usize| {
            let own = |s: &&Soft| is_shift(&s.generator) == (kind == ZeroKind::Translation);
            let pinning: Vec<Pinning> = self.soft.iter().filter(own).map(|s| s.pinning).collect();
            let [volume, hop_volume] = volumes.map(|v| places as f64 * v);
            ZeroModes {
                kind,
                count: pinning.len(),
                volume,
                hop_volume: (kind == ZeroKind::Translation).then_some(hop_volume),
                pinning,
            }
        };
        let both = [of(ZeroKind::Rotation, turns, fold), of(ZeroKind::Translation, shifts, places)];
        both.into_iter().filter(|zeros| zeros.count > 0).collect()
    }
}

fn is_shift(generator: &Generator) -> bool {
    matches!(generator, Generator::Shift(_))
}

fn turn_of(generator: &Generator) -> Option<Turn> {
    match generator {
        Generator::Turn(turn) => Some(*turn),
        Generator::Shift(_) => None,
    }
}

/// √det of the products of moves.
fn volume<'m>(moves: impl Iterator<Item = &'m Vec<f64>>) -> f64 {
    let moves: Vec<&Vec<f64>> = moves.collect();
    if moves.is_empty() {
        return 1.0;
    }
    let gram: Vec<f64> = moves.iter().flat_map(|a| moves.iter().map(|b| slab::dot(a, b))).collect();
    let (values, _) = eigen_symmetric(&gram, moves.len());
    values.iter().map(|l| l.max(0.0).sqrt()).product()
}

/// What a shift along a direction of the lattice does to the spins, tangent coordinates.
fn moved_along(h: &Hamiltonian, held: &Held, direction: usize) -> Option<Vec<f64>> {
    held.tangent(&ways::derivative(h.lattice(), &held.state.m, direction))
}

/// Above which k_BT (meV) the state slides far along a direction that no shift of the energy goes along, and by how many cells there:
/// what holds it is no row of places, and may be anything. A valley in which no spin fluctuates much is a well, however little of a
/// translation it is. `beside`: what shifts do that the energy has. Along these the state may slide so freely that rounding would make the
/// softest move of them.
fn wanders(h: &Hamiltonian, held: &Held, direction: usize, beside: &[Vec<f64>]) -> Option<[f64; 2]> {
    let v = moved_along(h, held, direction)?;
    let cells = ROOM * h.lattice().grid.size[direction] as f64;
    let from = |valley: &Valley| {
        let by = slab::dot(&v, &valley.along);
        // what is mostly something else may be soft: it moves the state nowhere
        let is_translation = by * by > 0.5 * slab::dot(&v, &v);
        let spin = valley.along.chunks_exact(2).map(|s| s[0] * s[0] + s[1] * s[1]).fold(0.0, f64::max);
        let far = (cells * by * cells * by).max(LARGE / spin);
        is_translation.then_some([valley.stiffness_mev * far, (far / (by * by)).sqrt()])
    };
    let all = std::iter::once(&v).chain(beside).cloned();
    let valleys = held.valleys(&orthonormal(all.collect(), LEAST));
    valleys.iter().filter_map(from).min_by(|a, b| a[0].total_cmp(&b[0]))
}

/// U_a and A_a where all ways are soft.
fn pinning_by_way(ways: &[Vec<f64>], valleys: &[Valley], tops_mev: &[f64]) -> Vec<Pinning> {
    let part = |a: &Vec<f64>, b: &Vec<f64>| -> f64 {
        valleys.iter().map(|w| w.stiffness_mev * slab::dot(a, &w.along) * slab::dot(b, &w.along)).sum()
    };
    let curvature: Vec<f64> = ways.iter().flat_map(|a| ways.iter().map(move |b| part(a, b))).collect();
    let own: Vec<f64> = (0..ways.len()).map(|k| curvature[k * ways.len() + k]).collect();
    let all: f64 = eigen_symmetric(&curvature, ways.len()).0.iter().product();
    let share = all.max(0.0) / own.iter().product::<f64>().max(f64::MIN_POSITIVE);
    let scale = libm::pow(share, 1.0 / ways.len().max(1) as f64);
    own.into_iter().zip(tops_mev).map(|(e, top_mev)| Pinning::new(scale * e, 1.0, scale * top_mev)).collect()
}

#[cfg(test)]
mod tests {
    use super::super::unstable_mode;
    use super::*;
    use crate::config::load_text;
    use crate::spins::Spins;
    use crate::stationary::{FEW, Limits, STEP, STEPS, climb};

    /// Cells of a strip that repeats along its length.
    const CELLS: [usize; 2] = [10, 40];

    /// A wall that two columns without anisotropy hold, with two lines half the strip apart about a place along it, between which it turns
    /// the other way.
    fn wall(place: f64) -> Spins {
        let spin = |i: usize| {
            let (x, y) = ((i % CELLS[0]) as f64, (i / CELLS[0]) as f64);
            let apart = (y - place).rem_euclid(CELLS[1] as f64);
            let depth = (apart.min(CELLS[1] as f64 - apart) - 0.25 * CELLS[1] as f64) / 4.0;
            let (up, across) = (libm::tanh((4.5 - x) / 2.0), 1.0 / libm::cosh((4.5 - x) / 2.0));
            [across / libm::cosh(depth), across * libm::tanh(depth), up]
        };
        Spins::from_vectors(&(0..CELLS[0] * CELLS[1]).map(spin).collect::<Vec<_>>()).unwrap()
    }

    #[test]
    fn what_slides_freely_along_a_strip_wanders_across_it_from_the_same_temperature_on_at_all_places() {
        let config = r#"{"material": {"name": "strip", "moment": "2 mu_B", "energy": [{"exchange": {"J": ["5 meV"]}},
                {"anisotropy": {"K": "0.6 meV", "axis": [0, 0, 1]}}, {"anisotropy": {"K": "-0.15 meV", "axis": [1, 0, 0]}},
                {"anisotropy": {"K": "-0.6 meV", "axis": [0, 0, 1], "sites": {"box": {"from": [3.9, -1], "to": [5.1, 41]}}}}]},
            "lattice": {"square": {"cells": [10, 40], "periodic": [false, true]}},
            "initial": {"uniform": {"direction": [0, 0, 1]}}, "final": {"uniform": {"direction": [0, 0, -1]}}}"#;
        let problem = load_text("strip.json".as_ref(), config.into()).unwrap().problem().unwrap();
        let h = Evaluator::from(&problem.hamiltonian);
        let wanders = |place: f64| {
            let start = wall(place);
            let group = Group::of(&h, start.as_slice(), &[]);
            let limits = Limits {
                steps: STEPS,
                without_mode: FEW,
                radius: STEP,
                ceiling_mev: f64::INFINITY,
                known: &|_, _| false,
            };
            let saddle = climb(h, start.as_slice(), &limits).saddle.unwrap();
            let unstable = unstable_mode(&saddle.state, &saddle.mode, &saddle.state.zeros);
            Slide::of(h, &saddle.state, unstable.as_ref(), &group, 20.0)
                .wanders
                .expect("nothing but its columns holds it")[0]
        };
        let own = wanders(10.0);
        for place in [10.31, 17.77] {
            let other = wanders(place);
            assert!((other / own - 1.0).abs() < 1e-3, "{place}: {other} {own}");
        }
    }
}
