//! Connecting two minima by a band's saddles: the graph names the next pair, a way between the two is relaxed a little, and its
//! peaks are refined to saddles, whose passes go into the graph; until a route leads from end to end.

use super::flat::flat_way;
use super::nearing::Nearing;
use super::pass::{Pass, Sides};
use super::search::QUIET;
use super::ways::{WAYS, way};
use super::zoom::zoomed;
use super::{Doubt, Landscape, Peak, Saddle, highest, peaks, turned, turns};
use crate::band::Band;
use crate::error::Result;
use crate::path::guess::GuessContext;
use crate::path::{COARSE, Path, distance};
use crate::spins::Spins;
use crate::stationary::FEW;

/// What relaxes bands.
pub trait Bands: Sync {
    /// Loosely.
    fn loosely(&self, band: &mut Band) -> Result<()>;

    /// As far as the run's tolerance.
    fn tightly(&self, band: &mut Band) -> Result<()>;
}

/// What is needed to connect two minima.
pub struct Connector<'c> {
    /// Relaxes ways.
    pub bands: &'c dyn Bands,
    /// A relaxed path between the two.
    pub path: &'c Path,
    /// A route is to stay below this height (meV above the landscape's reference).
    pub below_mev: f64,
    /// Most evaluations of single states, all that were made before counted.
    pub evaluations: usize,
    /// What the descents from its saddles need to know.
    pub sides: Sides<'c>,
    /// What first paths need to know.
    pub context: GuessContext<'c>,
}

impl Connector<'_> {
    /// Puts passes into a landscape until a route leads from one minimum to another; what stands against it if none does.
    pub fn connect(&self, land: &mut Landscape, ends: [usize; 2]) -> Result<Option<Doubt>> {
        let is_done = |land: &Landscape| {
            let [a, b] = ends.map(|k| land.standing_for(k));
            a == b || land.top_mev(a, b).is_some_and(|top| top < self.below_mev)
        };
        if is_done(land) {
            return Ok(None);
        }
        land.unfold();
        let known = land.pairs.nearing.filter(|nearing| nearing.is_of(ends, self.below_mev));
        let mut nearing = known.unwrap_or_else(|| Nearing::of(ends, self.below_mev));
        while !is_done(land) {
            let left = self.evaluations.saturating_sub(land.evaluator().evaluated().evaluations);
            let next = if left > 0 { land.next_pair(ends, self.below_mev, WAYS / 2) } else { None };
            let next = next.filter(|(_, far)| nearing.goes_on(*far, QUIET));
            land.pairs.nearing = Some(nearing);
            let Some((pair, _)) = next else { return Ok(Some(Doubt::NoRoute(nearing.tried))) };
            let k = land.try_once_more(pair);
            let along = self.part_between(land, pair);
            let way = match (along, k) {
                (Some(part), 0) => Some(part),
                (along, k) => way(land, pair, (k - usize::from(along.is_some())) % WAYS, COARSE, &self.context),
            };
            if let Some(way) = way {
                self.follow(land, pair, way)?;
            }
        }
        Ok(None)
    }

    /// The part of the path between two states on it, turned about the symmetry axes to be near it, if it has images enough there.
    fn part_between(&self, land: &Landscape, pair: [usize; 2]) -> Option<Path> {
        let (h, path) = (land.evaluator(), self.path);
        let near = |spins: &Spins, k: usize| turned(spins, &turns(h, spins, &path.spins(k)));
        let nearest = |spins: &Spins| {
            let far = |k: usize| distance(near(spins, k).as_slice(), path.image(k));
            let far: Vec<f64> = (0..path.images()).map(far).collect();
            (0..far.len()).min_by(|i, j| far[*i].total_cmp(&far[*j])).unwrap_or(0)
        };
        let ends = pair.map(|k| &land.minima()[k].spins);
        let places = ends.map(nearest);
        let [i, j] = places;
        if i.abs_diff(j) < FEW {
            return None;
        }
        let mut row: Vec<Spins> = (i.min(j) + 1..i.max(j)).map(|k| path.spins(k)).collect();
        if i > j {
            row.reverse();
        }
        row.insert(0, near(ends[0], i));
        row.push(near(ends[1], j));
        Some(Path::new(&row).resampled((i.abs_diff(j) + 1).max(COARSE)))
    }

    /// Relaxes a way a little and puts the pass of its highest new saddle in.
    fn follow(&self, land: &mut Landscape, pair: [usize; 2], way: Path) -> Result<()> {
        let h = land.evaluator();
        let mut band = Band::new(h, way);
        self.bands.loosely(&mut band)?;
        if let Some(flat) = flat_way(self.bands, &band, self.sides.c, self.sides.level_mev)? {
            land.merge(pair, flat);
            return Ok(());
        }
        for _ in 0..FEW {
            let Some(path) = zoomed(&band, highest(&band, self.sides.c).as_ref(), band.images() + 4) else { break };
            band = Band::new(h, path);
            self.bands.loosely(&mut band)?;
        }
        let tops = peaks(&band, self.sides.c);
        if tops.first().is_some_and(|top| top.floor_mev - land.reference_mev() > self.below_mev) {
            return Ok(());
        }
        // a saddle on the way lies above the lower of the two, and may lie far below a peak that it is not near
        let ends_mev = band.energies_mev()[0].min(band.energies_mev()[band.images() - 1]);
        for top in tops {
            let found = Saddle::recorded(h, Peak { floor_mev: top.floor_mev.min(ends_mev), ..top }, true)?;
            if found.is_saddle(self.sides.c) && !land.knows(&found) {
                return self.add(land, found);
            }
        }
        Ok(())
    }

    /// Puts the pass of a saddle in if it is proven.
    fn add(&self, land: &mut Landscape, saddle: Saddle) -> Result<()> {
        let pass = Pass::recorded(land.evaluator(), saddle, self.sides)?;
        if pass.doubt(land.evaluator()).is_none() {
            land.add(pass);
        }
        Ok(())
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::energy::{Anisotropy, EnergyTerm, Exchange, Hamiltonian};
    use crate::geometry::Direction;
    use crate::landscape::Minimum;
    use crate::lattice::Chain;
    use crate::state::StateContext;

    /// Leaves bands as they are.
    pub struct AsTheyAre;

    impl Bands for AsTheyAre {
        fn loosely(&self, _: &mut Band) -> Result<()> {
            Ok(())
        }

        fn tightly(&self, _: &mut Band) -> Result<()> {
            Ok(())
        }
    }

    /// An open chain that holds a narrow wall at any of its sites.
    pub fn firm_chain(sites: usize) -> Hamiltonian {
        let lattice = Chain::open(sites).resolve().unwrap();
        let easy = Anisotropy::uniform(sites, 2.5, Direction::Z);
        let terms: Vec<Box<dyn EnergyTerm>> = vec![Box::new(Exchange::uniform(&lattice, &[10.0])), Box::new(easy)];
        Hamiltonian::new(&lattice, terms).unwrap()
    }

    /// A wall in it, nearly relaxed.
    pub fn wall(sites: usize, center: f64) -> Spins {
        let angle = |i: usize| 2.0 * ((i as f64 - center) / 1.4).exp().atan();
        let spins: Vec<_> = (0..sites).map(|i| [angle(i).sin(), 0.0, angle(i).cos()]).collect();
        Spins::from_vectors(&spins).unwrap()
    }

    #[test]
    fn joins_that_bring_two_minima_no_nearer_end() {
        let h = firm_chain(80);
        let path = Path::new(&[20.5, 60.5].map(|center| wall(80, center)));
        let mut land = Landscape::new((&h).into(), path.image(0));
        let minima = (0..=40).map(|k| Minimum::examine((&h).into(), &wall(80, 20.5 + f64::from(k))));
        let walls: Vec<usize> = minima.map(|minimum| land.add_minimum(&minimum)).collect();
        let connector = Connector {
            bands: &AsTheyAre,
            path: &path,
            // nothing leads on so low
            below_mev: 1e-6,
            evaluations: usize::MAX,
            sides: Sides { c: 10.0, level_mev: 0.0, beside: &[], most: usize::MAX },
            context: GuessContext { states: StateContext::new(h.lattice(), 1.4), default_axis: Direction::Y },
        };
        let doubt = connector.connect(&mut land, [walls[0], walls[40]]).unwrap();
        // forty pairs, each of which may be tried three times
        assert!(matches!(doubt, Some(Doubt::NoRoute(tried)) if (QUIET..40).contains(&tried)), "{doubt:?}");
    }
}
