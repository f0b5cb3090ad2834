//! Everything that was found, as one graph, and what is asked of it.
//!
//! Nodes are minima, each state one of its own: up and down are two. Edges are passes: certified saddles with the minima that their
//! two descents reach. The images of both under the symmetry of lattice and energy are nodes and edges too, without a search; so one
//! saddle may have several edges. A pass with the same minimum on both sides is an edge that no route takes. Where a survey would have
//! too many images, a node stands for all places to which translations shift it.

use super::pairs::Pairs;
use super::places::Places;
use super::slid::is_slid;
use super::{Minimum, Pass, Saddle, Seen, is_same_state, turned, turns};
use crate::energy::Evaluator;
use crate::path::{Path, is_within, largest_angle};
use crate::sphere::SAME;
use crate::spins::Spins;
use crate::stationary::{ALIKE, LAST_DIGITS, LOWER, STEP};
use crate::symmetry::{Group, Operation};

/// Images by symmetry of every minimum and pass, at most, and of how many spins; and minima, from which on no more images are added:
/// so many in a search for a route, and so many in a survey.
pub(super) const IMAGES: usize = 64;
const IMAGE_SPINS: usize = 2_000_000;
const MINIMA: usize = 2000;
const SURVEYED: usize = 10_000;

/// A pass, or an image of one.
#[derive(Clone, Debug)]
pub struct Edge {
    /// The minima that it joins.
    pub ends: [usize; 2],
    /// Energy of its saddle above the landscape's reference (meV).
    pub height_mev: f64,
    /// Which pass.
    pub pass: usize,
    /// Which image of it; the pass itself if absent.
    pub by: Option<usize>,
    /// The saddle's spins (3N).
    pub saddle: Vec<f64>,
    /// Another edge has this saddle too: a symmetry leaves it as it is, but not the minima that its descents came to, each over a
    /// state that is left in any of several directions alike.
    pub is_twin: bool,
}

/// Minima and passes.
///
/// A survey fills one; what it found is told in [`Survey`](crate::drive::survey::Survey):
///
/// ```
/// use spinneb::config::load_text;
/// use spinneb::drive::{Silent, survey::survey};
///
/// let config = r#"{
///     "material": {"name": "two spins", "energy": [{"exchange": {"J": ["1 meV"]}}, {"anisotropy": {"K": "2 meV", "axis": [0, 0, 1]}}]},
///     "lattice": {"chain": {"sites": 2}},
///     "initial": {"uniform": {"direction": [0, 0, 1]}},
///     "final": {"uniform": {"direction": [0, 0, -1]}},
///     "landscape": {"effort": "quick"}
/// }"#;
/// let found = survey(&load_text("two.json".as_ref(), config.into())?.survey()?, &mut Silent)?;
/// assert_eq!(found.minima.len(), 4); // up and down, each by itself
/// # Ok::<(), spinneb::error::Error>(())
/// ```
#[derive(Debug)]
pub struct Landscape<'a> {
    h: Evaluator<'a>,
    /// Energies are counted from that of this state (3N).
    reference: Vec<f64>,
    reference_mev: f64,
    /// None until they are wanted.
    operations: Option<Vec<Operation>>,
    /// All operations, where those are but the first of them.
    group: Option<Group>,
    most_minima: usize,
    places: Places,
    minima: Vec<Minimum>,
    heights_mev: Vec<f64>,
    /// The minimum that stands for each: itself, or another one along a flat valley.
    stands_for: Vec<usize>,
    /// Ways along flat valleys, each from minimum to minimum.
    valleys: Vec<Path>,
    /// The minimum that each is an image of by symmetry.
    orbits: Vec<usize>,
    pub(super) pairs: Pairs,
    passes: Vec<Pass>,
    edges: Vec<Edge>,
}

impl<'a> Landscape<'a> {
    /// Of an energy, so far with nothing in it; energies are counted from that of the state `reference`.
    pub fn new(h: Evaluator<'a>, reference: &[f64]) -> Landscape<'a> {
        Landscape {
            h,
            reference: reference.to_vec(),
            reference_mev: h.hamiltonian().energy_mev(reference) - h.reference_mev(),
            operations: None,
            group: None,
            most_minima: MINIMA,
            places: Places::default(),
            minima: Vec::new(),
            heights_mev: Vec::new(),
            stands_for: Vec::new(),
            valleys: Vec::new(),
            orbits: Vec::new(),
            pairs: Pairs::default(),
            passes: Vec::new(),
            edges: Vec::new(),
        }
    }

    /// Finds the symmetries of the energy. From now on, and for all that is in it already, images are put in too.
    pub fn unfold(&mut self) {
        if self.operations.is_none() {
            let group = Group::of(&self.h, &self.reference, &[]);
            self.unfold_by(group.operations().take(IMAGES.min(self.most_images())).collect());
            self.group = (group.order() > 1 + self.operations_known().len()).then_some(group);
        }
    }

    /// The same by all operations of a group if these are no more than so many, else but for translations.
    pub fn unfold_all(&mut self, group: &Group, most: usize) {
        let most_images = self.most_images();
        let until = match group.order() > most.min(most_images) {
            true => group.until_translations(),
            false => group.orders(),
        };
        self.places = Places::of(group, &until);
        self.most_minima = SURVEYED;
        self.unfold_by(group.classes_within(&until).skip(1).take(most_images).collect());
    }

    fn most_images(&self) -> usize {
        IMAGE_SPINS / self.h.sites()
    }

    fn unfold_by(&mut self, operations: Vec<Operation>) {
        self.operations = Some(operations);
        for k in 0..self.minima.len() {
            self.unfold_minimum(k);
        }
        for k in 0..self.passes.len() {
            self.unfold_pass(k);
        }
    }

    /// Translations of which no state of its own is made.
    pub fn places(&self) -> &Places {
        &self.places
    }

    /// The energy.
    pub fn evaluator(&self) -> Evaluator<'a> {
        self.h
    }

    /// All minima, images counted.
    pub fn minima(&self) -> &[Minimum] {
        &self.minima
    }

    /// Energies of the minima above the reference (meV).
    pub fn heights_mev(&self) -> &[f64] {
        &self.heights_mev
    }

    /// Energy of the lowest minimum above the reference (meV); ∞ where there is none.
    pub fn lowest_mev(&self) -> f64 {
        self.heights_mev.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// All passes, each once.
    pub fn passes(&self) -> &[Pass] {
        &self.passes
    }

    /// All passes and their images.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// Energy of a state above the reference (meV).
    pub fn height_mev(&self, m: &[f64]) -> f64 {
        self.h.difference_mev(m, &self.reference)
    }

    /// Energy of the state from which energies are counted, above the Hamiltonian's own reference (meV).
    pub fn reference_mev(&self) -> f64 {
        self.reference_mev
    }

    /// Whether a state of this height is so near to a known saddle that a climb from it would end there.
    pub fn is_beside_a_saddle(&self, m: &[f64], height_mev: f64) -> bool {
        let near = LAST_DIGITS * LAST_DIGITS * self.h.stiffness_mev() * self.h.sites() as f64;
        let beside = |e: &Edge| (e.height_mev - height_mev).abs() < near && is_within(&e.saddle, m, LAST_DIGITS);
        self.edges.iter().any(beside)
    }

    /// Whether this state of rest of this height is a known saddle.
    pub fn has_saddle(&self, m: &[f64], height_mev: f64) -> bool {
        self.edges_over(m, height_mev).next().is_some()
    }

    /// The state from which energies are counted (3N).
    pub fn reference(&self) -> &[f64] {
        &self.reference
    }

    /// By how much a pass must be lower than one of this height to count as lower (meV).
    pub fn tolerance_mev(&self, height_mev: f64) -> f64 {
        (ALIKE * self.h.stiffness_mev()).max(LOWER * height_mev.abs())
    }

    /// The minimum that this one is, which is put in with its images if it is new.
    pub fn add_minimum(&mut self, minimum: &Minimum) -> usize {
        let known = self.minima.len();
        let place = self.place(minimum, None);
        if self.minima.len() > known {
            self.unfold_minimum(place);
        }
        place
    }

    fn unfold_minimum(&mut self, k: usize) {
        for by in 0..self.images_to_come() {
            self.place(&self.minima[k].image(&self.operations_known()[by]), Some(k));
        }
    }

    /// The node of a minimum, a new one if there is none yet; `of`: the one that it is an image of.
    fn place(&mut self, minimum: &Minimum, of: Option<usize>) -> usize {
        if let Some(known) = self.known(minimum) {
            return self.stands_for[known];
        }
        self.minima.push(minimum.clone());
        self.heights_mev.push(self.height_mev(minimum.spins.as_slice()));
        let new = self.minima.len() - 1;
        self.stands_for.push(new);
        self.orbits.push(of.map_or(new, |k| self.orbits[k]));
        new
    }

    /// Which of the minima one is.
    fn known(&self, minimum: &Minimum) -> Option<usize> {
        let height = self.height_mev(minimum.spins.as_slice());
        let near = ALIKE * self.h.stiffness_mev();
        let alike = |k: &usize| {
            (self.heights_mev[*k] - height).abs() < near
                && self.is_one(self.minima[*k].spins.as_slice(), minimum.spins.as_slice())
        };
        (0..self.minima.len()).find(alike)
    }

    /// Whether two states are the same, or two places of one.
    fn is_one(&self, a: &[f64], b: &[f64]) -> bool {
        is_same_state(self.h, a, b) || self.places.join(self.h, a, b)
    }

    /// Lets two minima be one, and their images by symmetry: they are joined by this flat valley.
    pub fn merge(&mut self, pair: [usize; 2], valley: Path) {
        self.valleys.push(valley);
        self.join(pair);
        for by in 0..self.images_to_come() {
            let operation = &self.operations_known()[by];
            if let [Some(a), Some(b)] = pair.map(|k| self.known(&self.minima[k].image(operation))) {
                self.join([a, b]);
            }
        }
    }

    /// Lets the same minimum stand for both.
    fn join(&mut self, pair: [usize; 2]) {
        let [a, b] = pair.map(|k| self.stands_for[k]);
        let ([a, b], all) = ([a.min(b), a.max(b)], &mut self.stands_for);
        all.iter_mut().filter(|k| **k == b).for_each(|k| *k = a);
        for end in self.edges.iter_mut().flat_map(|edge| &mut edge.ends) {
            *end = all[*end];
        }
    }

    /// The flat valleys that lead on from a state: those that were found and their images, turned about the symmetry axes.
    pub(super) fn valleys_from<'l>(&'l self, from: &'l Spins) -> impl Iterator<Item = Path> + 'l {
        let images = || std::iter::once(None).chain(self.operations_known().iter().map(Some));
        let all = self.valleys.iter().flat_map(move |valley| images().map(move |by| (valley, by)));
        let ways = all.flat_map(|(valley, by)| [(valley, by, false), (valley, by, true)]);
        let here = Seen::of(self.h, from.as_slice());
        ways.filter_map(move |(valley, by, back)| {
            let last = valley.images() - 1;
            if !here.may_be(by, valley.image(if back { last } else { 0 })) {
                return None;
            }
            let image = |k: usize| {
                let m = valley.image(if back { last - k } else { k });
                Spins::from_unit_components(&by.map_or_else(|| m.to_vec(), |by| by.apply(m)))
            };
            let turns = turns(self.h, &image(0), from);
            let fits = largest_angle(turned(&image(0), &turns).as_slice(), from.as_slice()) < SAME;
            let rest = (1..=last).map(|k| turned(&image(k), &turns));
            fits.then(|| Path::new(&std::iter::once(from.clone()).chain(rest).collect::<Vec<_>>()))
        })
    }

    /// The minimum that one is an image of by symmetry: itself if it was there first.
    pub fn orbit(&self, k: usize) -> usize {
        self.orbits[k]
    }

    /// How many minima there are of which no symmetry makes another one.
    pub fn kinds(&self) -> usize {
        (0..self.minima.len()).filter(|k| self.orbits[*k] == *k).count()
    }

    /// How many passes below a height there are (meV above the reference), images not counted.
    pub fn passes_below(&self, height_mev: f64) -> usize {
        self.edges.iter().filter(|e| e.by.is_none() && e.height_mev < height_mev).count()
    }

    /// The minimum that stands for one of the minima.
    pub fn standing_for(&self, k: usize) -> usize {
        self.stands_for[k]
    }

    /// Puts a certified pass in, with its minima and all its images; false if its saddle is known, or a place of one that is.
    pub fn add(&mut self, pass: Pass) -> bool {
        if self.knows(&pass.saddle) || self.is_place(&pass) {
            return false;
        }
        let ends = [&pass.before, &pass.after].map(|minimum| self.add_minimum(minimum));
        let height_mev = self.height_mev(pass.saddle.spins());
        let number = self.passes.len();
        self.edges.push(Edge {
            ends,
            height_mev,
            pass: number,
            by: None,
            saddle: pass.saddle.spins().to_vec(),
            is_twin: false,
        });
        self.passes.push(pass);
        self.unfold_pass(number);
        true
    }

    fn unfold_pass(&mut self, number: usize) {
        for by in 0..self.images_to_come() {
            let (pass, operation) = (&self.passes[number], &self.operations_known()[by]);
            let saddle = operation.apply(pass.saddle.spins());
            let height_mev = self.height_mev(pass.saddle.spins());
            let known: Vec<[usize; 2]> = self.edges_over(&saddle, height_mev).map(|e| e.ends).collect();
            let images = [&pass.before, &pass.after].map(|minimum| minimum.image(operation));
            let of = self.edges.iter().find(|e| e.pass == number && e.by.is_none()).map(|e| e.ends);
            let ends = [0, 1].map(|k| self.place(&images[k], of.map(|of| of[k])));
            if !known.iter().any(|[a, b]| ends == [*a, *b] || ends == [*b, *a]) {
                let is_twin = !known.is_empty();
                self.edges.push(Edge { ends, height_mev, pass: number, by: Some(by), saddle, is_twin });
            }
        }
    }

    /// Of the next minimum or pass.
    fn images_to_come(&self) -> usize {
        if self.minima.len() < self.most_minima { self.operations_known().len() } else { 0 }
    }

    pub(super) fn operations_known(&self) -> &[Operation] {
        self.operations.as_deref().unwrap_or_default()
    }

    /// Whether a saddle is as high as this.
    pub fn has_height(&self, height_mev: f64) -> bool {
        self.edges_at(height_mev).next().is_some()
    }

    /// Whether a saddle is known.
    pub fn knows(&self, saddle: &Saddle) -> bool {
        self.edges_over(saddle.spins(), self.height_mev(saddle.spins())).next().is_some()
    }

    /// The pass over a saddle, where that is an image by symmetry of a known one, but none of those that were put in.
    pub(super) fn image_over(&self, saddle: &Saddle) -> Option<Pass> {
        let group = self.group.as_ref()?;
        let (m, height_mev) = (saddle.spins(), self.height_mev(saddle.spins()));
        let alike = self.edges_at(height_mev).filter(|e| e.by.is_none());
        let seen = Seen::of(self.h, m);
        alike.map(|e| &self.passes[e.pass]).find_map(|pass| {
            let by = group.operations().find(|by| seen.is_made(by, pass.saddle.spins()))?;
            Some(pass.image(self.h, &by))
        })
    }

    /// Whether a pass leads over another place of a known saddle that slides along a flat valley, between the same minima.
    fn is_place(&self, pass: &Pass) -> bool {
        let ends = [&pass.before, &pass.after].map(|minimum| self.known(minimum).map(|k| self.stands_for[k]));
        let [Some(a), Some(b)] = ends else { return false };
        let (m, height_mev) = (pass.saddle.spins(), self.height_mev(pass.saddle.spins()));
        let alike = |e: &&Edge| e.ends == [a, b] || e.ends == [b, a];
        let mut places =
            self.edges_at(height_mev).filter(alike).flat_map(|e| self.places.beside(self.h, &e.saddle, m, STEP));
        places.any(|place| is_slid(self.h, &place, m))
    }

    /// The edges over a saddle.
    fn edges_over(&self, m: &[f64], height_mev: f64) -> impl Iterator<Item = &Edge> {
        self.edges_at(height_mev).filter(move |e| self.is_one(&e.saddle, m))
    }

    /// The edges whose saddles are as high as this.
    fn edges_at(&self, height_mev: f64) -> impl Iterator<Item = &Edge> {
        let near = ALIKE * self.h.stiffness_mev();
        self.edges.iter().filter(move |e| (e.height_mev - height_mev).abs() < near)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::{Anisotropy, EnergyTerm, Exchange, Hamiltonian};
    use crate::geometry::Direction;
    use crate::landscape::Sides;
    use crate::lattice::Chain;
    use crate::stationary::Limits;

    /// One spin with an easy axis z and a hard axis x: minima ±z, saddles ±y.
    fn spin() -> Hamiltonian {
        let lattice = Chain::open(1).resolve().unwrap();
        let terms: Vec<Box<dyn EnergyTerm>> = vec![
            Box::new(Anisotropy::uniform(1, 1.0, Direction::Z)),
            Box::new(Anisotropy::uniform(1, -0.5, Direction::X)),
        ];
        Hamiltonian::new(&lattice, terms).unwrap()
    }

    fn state(v: [f64; 3]) -> Spins {
        Spins::from_vectors(&[v]).unwrap()
    }

    /// The number of the minimum with this spin.
    fn find(land: &Landscape, v: [f64; 3]) -> usize {
        land.known(&Minimum::examine(land.evaluator(), &state(v))).unwrap()
    }

    const SIDES: Sides = Sides { c: 1.0, level_mev: 0.0, beside: &[], most: usize::MAX };

    fn climbed(h: Evaluator, start: &Spins) -> Saddle {
        let limits =
            Limits { steps: 40, without_mode: 8, radius: 0.5, ceiling_mev: f64::INFINITY, known: &|_, _| false };
        Saddle::climbed(h, start.as_slice(), &limits).unwrap()
    }

    fn pass(h: &Hamiltonian) -> Pass {
        Pass::of(h.into(), climbed(h.into(), &state([0.1, 0.9, 0.2])), SIDES).unwrap()
    }

    #[test]
    fn a_pass_brings_its_images_by_symmetry_and_joins_minima_without_another_search() {
        let h = spin();
        let up = Spins::from_vectors(&[[0.0, 0.0, 1.0]]).unwrap();
        for (unfolded, saddles) in [(false, 1), (true, 2)] {
            let mut land = Landscape::new((&h).into(), up.as_slice());
            if unfolded {
                land.unfold();
            }
            let a = land.add_minimum(&Minimum::examine((&h).into(), &up));
            assert!(land.add(pass(&h)) && !land.add(pass(&h)));
            assert_eq!((land.minima().len(), land.edges().len()), (2, saddles));
            let route = land.route(a, 1 - a).unwrap();
            assert!((route.top_mev - 1.0).abs() < 1e-12 && route.steps.len() == 1, "{route:?}");
            let passes = land.passes_of(&route);
            assert!(passes[0].before.is_identical((&h).into(), &land.minima()[a]));
            assert_eq!(land.parts_below(0.9), [0, 1]);
            assert_eq!(land.parts_below(1.1), [0, 0]);
            let back = land.route(1 - a, a).unwrap();
            assert_eq!(back.steps[0].1, !route.steps[0].1);
        }
    }

    #[test]
    fn a_saddle_that_a_symmetry_leaves_as_it_is_joins_the_images_of_its_minima() {
        let h = spin();
        let mut land = Landscape::new((&h).into(), state([0.0, 0.0, 1.0]).as_slice());
        land.unfold();
        // as if the descent to +z had been left aside: mirrors of x and z leave the saddles on ±y where they are, but not this
        let mut pass = pass(&h);
        let down = usize::from(pass.after.spins.as_slice()[2] < 0.0);
        let end = if down == 1 { &mut pass.before } else { &mut pass.after };
        *end = Minimum::examine((&h).into(), &state([0.3, 0.0, 0.9]));
        assert!(land.add(pass));
        assert_eq!((land.edges().len(), land.edges().iter().filter(|e| e.is_twin).count()), (8, 6));
        let route = land.route(find(&land, [-0.3, 0.0, 0.9]), find(&land, [0.0, 0.0, -1.0])).unwrap();
        let passes = land.passes_of(&route);
        assert!(passes.len() == 1 && passes[0].before.spins.as_slice()[0] < -0.2);
    }

    #[test]
    fn a_saddle_of_which_no_image_was_put_in_has_the_pass_that_symmetry_makes_of_a_known_one() {
        let (sites, lattice) = (40, Chain::ring(40).resolve().unwrap());
        let terms: Vec<Box<dyn EnergyTerm>> = vec![
            Box::new(Exchange::uniform(&lattice, &[0.02])),
            Box::new(Anisotropy::uniform(sites, 1.0, Direction::Z)),
            Box::new(Anisotropy::uniform(sites, -0.5, Direction::X)),
        ];
        let h = Hamiltonian::new(&lattice, terms).unwrap();
        let h = Evaluator::from(&h);
        // one spin that turns over beside others that do not
        let over = |site: usize| {
            let spins: Vec<_> = (0..sites).map(|i| if i == site { [0.1, 0.9, 0.2] } else { [0.0, 0.0, 1.0] }).collect();
            climbed(h, &Spins::from_vectors(&spins).unwrap())
        };
        let mut land = Landscape::new(h, Spins::uniform(sites, Direction::Z).as_slice());
        land.unfold();
        assert!(land.add(Pass::of(h, over(0), SIDES).unwrap()));
        let far = over(20);
        assert!(land.edges().len() < 80 && !land.knows(&far));
        let image = land.image_over(&far).expect("a shift makes it");
        let exact = Pass::of(h, far, SIDES).unwrap();
        assert!(is_same_state(h, image.saddle.spins(), exact.saddle.spins()) && image.doubt(h).is_none());
        let ends =
            |pass: &Pass| [pass.before.spins.as_slice()[2 * sites + 20], pass.after.spins.as_slice()[2 * sites + 20]];
        let [[a, b], [c, d]] = [ends(&image), ends(&exact)];
        assert!(a * b < -0.9 && ((a - c).abs().max((b - d).abs()) < 1e-9 || (a - d).abs().max((b - c).abs()) < 1e-9));
        assert!(land.add(image) && land.knows(&exact.saddle));
    }

    #[test]
    fn a_flat_valley_joins_the_images_of_its_minima_too() {
        let h = spin();
        let mut land = Landscape::new((&h).into(), state([0.0, 0.0, 1.0]).as_slice());
        land.unfold();
        let a = land.add_minimum(&Minimum::examine((&h).into(), &state([0.3, 0.0, 0.9])));
        assert_eq!(land.minima().len(), 4);
        let b = find(&land, [-0.3, 0.0, 0.9]);
        let [c, d] = [[0.3, 0.0, -0.9], [-0.3, 0.0, -0.9]].map(|v| find(&land, v));
        land.merge([a, b], Path::new(&[[0.3, 0.0, 0.9], [0.0, 0.1, 0.9], [-0.3, 0.0, 0.9]].map(state)));
        let standing = [a, b, c, d].map(|k| land.standing_for(k));
        assert!(standing[0] == standing[1] && standing[2] == standing[3] && standing[0] != standing[2]);
        let valleys: Vec<Path> = land.valleys_from(&state([-0.3, 0.0, -0.9])).collect();
        assert!(!valleys.is_empty());
        for valley in valleys {
            let [middle, last] = [1, 2].map(|k| valley.image(k).to_vec());
            assert!(middle[2] < -0.9 && middle[1].abs() > 0.05 && last[0] > 0.2, "{middle:?}");
        }
    }

    #[test]
    fn a_route_is_over_the_lowest_highest_pass_and_then_over_the_fewest() {
        let h = spin();
        let up = Spins::from_vectors(&[[0.0, 0.0, 1.0]]).unwrap();
        let mut land = Landscape::new((&h).into(), up.as_slice());
        let minimum = Minimum::examine((&h).into(), &up);
        land.minima = vec![minimum; 5];
        (land.stands_for, land.orbits) = ((0..5).collect(), (0..5).collect());
        let edge = |a: usize, b: usize, height_mev: f64| Edge {
            ends: [a, b],
            height_mev,
            pass: 0,
            by: None,
            saddle: Vec::new(),
            is_twin: false,
        };
        land.edges = vec![
            edge(0, 4, 5.0),
            edge(0, 1, 2.0),
            edge(2, 1, 3.0),
            edge(2, 4, 1.0),
            edge(1, 1, 0.5),
            edge(1, 3, 1.0),
            edge(3, 2, 1.5),
        ];
        let route = land.route(0, 4).unwrap();
        assert_eq!((route.top_mev, &route.steps[..]), (2.0, &[(1, false), (5, false), (6, false), (3, false)][..]));
        land.edges[6].height_mev = 3.5;
        let route = land.route(0, 4).unwrap();
        assert_eq!((route.top_mev, &route.steps[..]), (3.0, &[(1, false), (2, true), (3, false)][..]));
        land.edges.truncate(2);
        assert_eq!(land.route(0, 3), None);
    }
}
