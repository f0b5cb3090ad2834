//! A first path in full: as many images as it needs, its saddles, their passes, and a route over them.

use super::Images;
use super::first_path::FirstPath;
use super::heights::{height, prominent_maxima, slack};
use super::relaxation::{Goal, LOOSELY, TIGHTLY, image_levels, refined};
use super::run::{FEWEST_IMAGES, Run};
use super::search::WITH_NEWS;
use super::settled::{Proof, Settled};
use crate::band::Band;
use crate::error::Result;
use crate::landscape::{
    Assembled, Connector, Doubt, Minimum, Pass, PathEnd, Peak, Saddle, Sides, assemble, highest_between, peaks,
};
use crate::path::{RESOLVED, distance, is_within};
use crate::sphere::SAME;
use crate::stationary::{ALIKE, FLAT};

/// How far apart (rad, any spin) the images of a path are that is put together, and where a band of these does not take the place.
const APART: [f64; 2] = [0.9 * RESOLVED, 0.45 * RESOLVED];
/// Most images of an automatic path.
const MOST_IMAGES: usize = 2001;
/// More images are of use where they bring neighbours nearer, to this part of how far they were.
const FINER: f64 = 0.8;
/// Maxima within this part of the path's height of the highest are refined.
const WINDOW: f64 = 0.1;

/// What no image of a path over these saddles exceeds (meV above the first image): the highest of them or an end, and rounding.
fn over(c: &FirstPath, links: &[Pass]) -> f64 {
    let e = c.band.energies_mev();
    let saddles = links.iter().map(|l| l.saddle.refined.state.energy_mev - e[0]);
    saddles.fold((e[e.len() - 1] - e[0]).max(0.0), f64::max) + slack(&c.band)
}

/// What rises by less along a band is level (meV): rounding, and what changes no digit of its barrier that is told.
fn level_mev(band: &Band) -> f64 {
    (FLAT * band.hamiltonian().stiffness_mev()).max(ALIKE * height(band))
}

impl<'a> Run<'a, '_> {
    /// A path in full, led over a route below a height (meV above the initial state) if there is one.
    pub(super) fn settle(&mut self, mut c: FirstPath<'a>, below_mev: f64) -> Result<Settled<'a>> {
        c.band.wake();
        self.land.begin_joins();
        let proves = self.problem.certify && self.problem.seeks_saddles();
        if proves && !self.problem.hamiltonian.lattice().is_row() {
            // away from its tops a band of a film relaxes slowly, and the descents from its saddles are the path
            let (mut found, mut proof) = self.examined(&c, below_mev)?;
            // each round of it is news
            let (now, own) = (self.problem.evaluator().evaluated(), self.evaluated());
            let most = self.most_evaluations;
            self.most_evaluations = most.min(now.evaluations.saturating_add(own.evaluations.saturating_mul(WITH_NEWS)));
            while let Some(lower) = self.examined_below(&mut c, &found, &proof)? {
                (found, proof) = lower;
            }
            self.most_evaluations = most;
            if self.lead_over(&mut c, &proof)? {
                return Ok(Settled { first: c, found, proof });
            }
        }
        if proves {
            self.relax_resolved(&mut c, TIGHTLY)?;
            let (found, proof) = self.examined(&c, below_mev)?;
            if self.needs_leading(&c, &found, &proof) && self.lead_over(&mut c, &proof)? {
                return Ok(Settled { first: c, found, proof });
            }
            if c.stop.is_converged() && !self.is_coarse(&c) {
                self.seat_saddles(&mut c, &found)?;
                return Ok(Settled { first: c, found, proof });
            }
        }
        self.relax_resolved(&mut c, usize::MAX)?;
        let found = self.all_saddles(&c)?;
        self.seat_saddles(&mut c, &found)?;
        let proof = self.prove(&c, &found, below_mev)?;
        if self.needs_leading(&c, &found, &proof) {
            self.lead_over(&mut c, &proof)?;
        }
        Ok(Settled { first: c, found, proof })
    }

    /// Puts the passes of a path into the landscape, until they join its ends below a height (meV above the initial state): what a path
    /// is worth that is not told itself.
    pub(super) fn put_in(&mut self, mut c: FirstPath<'a>, below_mev: f64) -> Result<()> {
        c.band.wake();
        self.land.begin_joins();
        let (_, proof) = self.examined(&c, below_mev)?;
        if !proof.doubts.is_empty() {
            self.relax_resolved(&mut c, TIGHTLY)?;
            self.examined(&c, below_mev)?;
        }
        Ok(())
    }

    /// The saddles of a path, and what they prove below a height (meV above the initial state).
    fn examined(&mut self, c: &FirstPath<'a>, below_mev: f64) -> Result<(Vec<Saddle>, Proof)> {
        let found = self.all_saddles(c)?;
        let proof = self.prove(c, &found, below_mev)?;
        Ok((found, proof))
    }

    /// A band whose images lie below the route that it led to, over saddles that are not its own, is relaxed and examined again: what
    /// connects minima one by one goes its own ways. What is lower, if anything is.
    fn examined_below(
        &mut self,
        c: &mut FirstPath<'a>,
        found: &[Saddle],
        proof: &Proof,
    ) -> Result<Option<(Vec<Saddle>, Proof)>> {
        let (route_mev, slack) = (self.route_mev(), slack(&c.band));
        let energy_mev = |pass: &&Pass| pass.saddle.refined.state.energy_mev;
        let highest = proof.links.iter().max_by(|p, q| energy_mev(p).total_cmp(&energy_mev(q)));
        let is_own = highest.is_none_or(|pass| is_among(found, pass));
        if is_own || c.peak_mev() > route_mev - slack || self.is_spent(&c.band) {
            return Ok(None);
        }
        self.relax_resolved(c, TIGHTLY)?;
        let lower = self.examined(c, route_mev - slack)?;
        Ok((self.route_mev() < route_mev - slack).then_some(lower))
    }

    /// Relaxes tightly with as many images as it takes, each time with at most `more` evaluations.
    fn relax_resolved(&mut self, c: &mut FirstPath<'a>, more: usize) -> Result<()> {
        loop {
            let before = c.band.images();
            self.resolve(c)?;
            let images = c.band.images();
            self.seat_top(c);
            self.relax(c, Goal::Tight, c.band.evaluations().saturating_add(more))?;
            let finer = self.is_coarse(c) && images > before && images < MOST_IMAGES;
            if !finer || !c.stop.is_converged() || more < usize::MAX {
                return Ok(());
            }
        }
    }

    /// Puts the refined top in the place of its image: then the rest of the path need not be relaxed around it once more.
    fn seat_top(&self, c: &mut FirstPath<'a>) {
        let scale = self.tools.scales.stiffness_mev;
        if self.problem.neb.climb
            && let Some(top) = c.found.as_ref().filter(|f| f.is_saddle(scale))
        {
            seat(&mut c.band, std::slice::from_ref(top));
        }
    }

    /// With its saddles as images.
    fn seat_saddles(&mut self, c: &mut FirstPath<'a>, found: &[Saddle]) -> Result<()> {
        if self.problem.neb.climb && seat(&mut c.band, found) {
            self.relax(c, Goal::Tight, usize::MAX)?;
        }
        Ok(())
    }

    /// Whether an automatic path needs more images.
    fn is_coarse(&self, c: &FirstPath<'a>) -> bool {
        self.problem.images == Images::Auto && !c.band.path().is_resolved()
    }

    /// Whether a path is better put together from the stretches of its route: it has minima between its ends, the band is not where
    /// the saddles are or has further maxima, or the route leads elsewhere.
    fn needs_leading(&self, c: &FirstPath<'a>, found: &[Saddle], proof: &Proof) -> bool {
        self.is_coarse(c)
            || !c.stop.is_converged()
            || proof.links.len() > 1
            || c.top_mev() > over(c, &proof.links)
            || prominent_maxima(c.band.energies_mev(), slack(&c.band)).len() > proof.links.len()
            || !proof.links.iter().all(|pass| is_among(found, pass))
    }

    /// Puts the path together from stretch to stretch of its route, in the place of the band; says whether it took the place.
    pub(super) fn lead_over(&mut self, c: &mut FirstPath<'a>, proof: &Proof) -> Result<bool> {
        if !proof.doubts.is_empty() || !self.problem.relax_ends {
            return Ok(false);
        }
        self.observer.stage("putting the path together");
        // where those asked for are too few, as many as it takes
        let asked = self.problem.images.asked_for();
        let tries = asked.map(|images| (Some(images), APART[0])).into_iter().chain(APART.map(|apart| (None, apart)));
        c.band.rest();
        let mut led = false;
        for (images, apart) in tries {
            let ends = [&self.ends[0].spins, &self.ends[1].spins];
            let assembled = assemble(&self.land, &proof.links, ends, images, apart, &self.tools)?;
            led = match assembled {
                Some(way) => self.follow_finer(c, way, &proof.links)?,
                None => false,
            };
            if led || self.is_spent(&c.band) {
                break;
            }
        }
        c.band.wake();
        Ok(led)
    }

    /// Follows a path that was put together, with more images where it is not resolved when relaxed; says whether it took the place.
    fn follow_finer(&mut self, c: &mut FirstPath<'a>, mut way: Assembled, links: &[Pass]) -> Result<bool> {
        let good = self.follow(c, &way, links)?;
        while good && self.is_coarse(c) && c.band.images() < MOST_IMAGES {
            let before = c.band.path().longest_step(RESOLVED);
            let Some(finer) = way.finer(c.band.path(), RESOLVED) else { break };
            way = finer;
            if !self.follow(c, &way, links)? || c.band.path().longest_step(RESOLVED) > FINER * before {
                break;
            }
        }
        Ok(good)
    }

    /// Takes a path that was put together in the place of the band, relaxed, unless a band that was converged would be lost or it rises
    /// over its saddles; says whether it took the place.
    fn follow(&mut self, c: &mut FirstPath<'a>, way: &Assembled, links: &[Pass]) -> Result<bool> {
        let mut band = Band::continued(self.problem.evaluator(), way.path.clone(), c.band.evaluations());
        for &k in &way.stops {
            band.fix(k, way.path.image(k));
        }
        let before = std::mem::replace(&mut c.band, band);
        let stop = c.stop;
        self.relax(c, Goal::Tight, c.band.evaluations() + TIGHTLY)?;
        let fits = c.top_mev() <= over(c, links);
        if fits && !c.stop.is_converged() {
            self.relax(c, Goal::Tight, usize::MAX)?;
        }
        let good = fits && (c.stop.is_converged() || !stop.is_converged());
        if !good {
            (c.band, c.stop) = (before, stop);
        }
        Ok(good)
    }

    /// Puts the passes of a path's saddles into the landscape, the highest first, and connects its ends from there; the lowest route
    /// that there is then, if it stays below a height (meV above the initial state), and what stands against it.
    fn prove(&mut self, c: &FirstPath<'a>, found: &[Saddle], below_mev: f64) -> Result<Proof> {
        let h = self.problem.evaluator();
        let ends = self.minima.map(|k| self.land.minima()[k].clone());
        let highest = found.iter().max_by(|p, q| p.refined.state.energy_mev.total_cmp(&q.refined.state.energy_mev));
        if let Some(doubt) = self.foregone(c, highest) {
            return Ok(Proof { ends, links: Vec::new(), doubts: vec![doubt] });
        }
        self.observer.stage("proving the saddles");
        let scale = self.tools.scales.stiffness_mev;
        if let Some(alone) = highest.filter(|_| !self.problem.relax_ends) {
            return self.prove_alone(alone, ends);
        }
        if highest.is_some_and(|highest| self.land.height_mev(highest.spins()) >= below_mev) {
            return Ok(Proof { ends, links: Vec::new(), doubts: vec![Doubt::NoRoute(0)] });
        }
        let sides = Sides { c: scale, level_mev: level_mev(&c.band), beside: &ends.each_ref(), most: usize::MAX };
        let (mut own, mut doubts): (Vec<Pass>, Vec<Doubt>) = (Vec::new(), Vec::new());
        let others = found.iter().filter(|f| highest.is_some_and(|highest| !std::ptr::eq(*f, highest)));
        for saddle in highest.into_iter().chain(others) {
            if self.is_spent(&c.band) {
                doubts.push(Doubt::Spent);
                break;
            }
            let pass = Pass::recorded(h, saddle.clone(), sides)?;
            match pass.doubt(h) {
                None => {
                    self.land.add(pass.clone());
                }
                Some(doubt) => doubts.push(doubt),
            }
            own.push(pass);
            if self.land.top_mev(self.minima[0], self.minima[1]).is_some_and(|top| top < below_mev) {
                break;
            }
        }
        let gap = self.connect(c, below_mev)?;
        let route = self.land.route(self.minima[0], self.minima[1]).filter(|route| route.top_mev < below_mev);
        let links = match route {
            Some(route) => {
                doubts.clear();
                self.land.passes_of(&route)
            }
            None => own,
        };
        if highest.is_none() && gap.is_some() {
            doubts.push(Doubt::NoSaddle);
        }
        doubts.extend(gap);
        let unproven = ends.iter().zip(PathEnd::BOTH).filter(|(end, _)| !end.is_proven());
        doubts.extend(unproven.map(|(_, which)| Doubt::NoMinimum(which)));
        doubts.dedup_by_key(|doubt| doubt.to_string());
        Ok(Proof { ends, links, doubts })
    }

    /// What stands against a proof before it is tried.
    fn foregone(&self, c: &FirstPath<'a>, highest: Option<&Saddle>) -> Option<Doubt> {
        match (self.problem.certify, self.problem.seeks_saddles()) {
            (false, _) => Some(Doubt::NotAskedFor),
            (_, false) => Some(Doubt::NotRefined),
            _ if highest.is_some() => None,
            _ if self.is_spent(&c.band) => Some(Doubt::Spent),
            // images may lie in minima, and what is between these is found by connecting them
            _ if self.problem.relax_ends => None,
            _ => Some(Doubt::NoSaddle),
        }
    }

    /// Connects the ends below a height (meV above the initial state), and not higher than the path itself rises; what stands against
    /// that.
    fn connect(&mut self, c: &FirstPath<'a>, below_mev: f64) -> Result<Option<Doubt>> {
        let connector = Connector {
            bands: &self.tools,
            path: c.band.path(),
            below_mev,
            evaluations: self.allowed(&c.band),
            sides: Sides {
                c: self.tools.scales.stiffness_mev,
                level_mev: level_mev(&c.band),
                beside: &[],
                most: usize::MAX,
            },
            context: self.context(),
        };
        let gap = connector.connect(&mut self.land, self.minima)?;
        let (slack, route_mev) = (slack(&c.band), self.route_mev());
        if gap.is_some() || route_mev <= c.top_mev() + slack {
            return Ok(gap);
        }
        // few images may lead around saddles that a finer look finds
        let path_mev = highest_between(&c.band, route_mev - slack) + slack;
        if route_mev > path_mev {
            Connector { below_mev: path_mev, ..connector }.connect(&mut self.land, self.minima)?;
        }
        let route_mev = self.route_mev();
        Ok((route_mev > path_mev).then_some(Doubt::HigherRoute { route_mev, path_mev }))
    }

    /// The highest saddle between the ends as far as is known (meV above the initial state).
    fn route_mev(&self) -> f64 {
        self.land.top_mev(self.minima[0], self.minima[1]).unwrap_or(f64::NEG_INFINITY)
    }

    /// What a saddle between ends that are kept as they are is by itself.
    fn prove_alone(&self, saddle: &Saddle, ends: [Minimum; 2]) -> Result<Proof> {
        let h = self.problem.evaluator();
        // a descending direction may be too flat for that
        let is_plain = self.problem.rates.is_none() && saddle.refined.index() > 0;
        let alone = is_plain.then(|| Pass::between(h, saddle.clone(), ends.clone()));
        let sides =
            Sides { c: self.tools.scales.stiffness_mev, level_mev: 0.0, beside: &ends.each_ref(), most: usize::MAX };
        let descended = || Pass::recorded(h, saddle.clone(), sides);
        let pass = alone.map_or_else(descended, Ok)?;
        let doubts = pass.doubt(h).into_iter().collect();
        Ok(Proof { ends, links: vec![pass], doubts })
    }

    /// Every maximum within a tenth of the highest, refined, one of a plateau; saddles found twice count once.
    fn all_saddles(&mut self, c: &FirstPath<'a>) -> Result<Vec<Saddle>> {
        let scale = self.tools.scales.stiffness_mev;
        if !self.problem.seeks_saddles() {
            return Ok(Vec::new());
        }
        let h = self.problem.evaluator();
        let mut found: Vec<Saddle> = Vec::new();
        let tops = peaks(&c.band, scale);
        let least = tops.first().map_or(0.0, |top| top.energy_mev) - WINDOW * height(&c.band);
        for top in tops.into_iter().filter(|top| top.energy_mev >= least) {
            if self.is_spent(&c.band) {
                break;
            }
            if found.iter().any(|f| is_level(&c.band, [&f.top, &top])) {
                continue;
            }
            let from_there = |f: &&Saddle| f.top.m == top.m && f.top.tau == top.tau;
            let f = match c.found.as_ref().filter(|f| is_seated(&c.band, top.image, f) || from_there(f)) {
                Some(f) => Saddle { top: top.into(), refined: f.refined.clone() },
                None => Saddle::recorded(h, top, true)?,
            };
            if f.is_saddle(scale) && !found.iter().any(|g| is_within(g.spins(), f.spins(), SAME)) {
                found.push(f);
            }
        }
        Ok(found)
    }

    /// More images, each time relaxed loosely: to the number asked for, or until neighbours are within 1 rad a spin.
    fn resolve(&mut self, c: &mut FirstPath<'a>) -> Result<()> {
        if !c.stop.is_converged() {
            self.relax(c, Goal::Loose, c.band.evaluations() + LOOSELY)?;
        }
        let mut apart = f64::INFINITY;
        loop {
            let now = c.band.images();
            let before = std::mem::replace(&mut apart, c.band.path().largest_rotation());
            // a step over a minimum stays as long as it is, however many images there are
            if apart > FINER * before && self.problem.images == Images::Auto && now >= FEWEST_IMAGES {
                return Ok(());
            }
            let next = match self.problem.images {
                Images::Count(n) if now < n => image_levels(n, |_| true).into_iter().find(|l| *l > now).unwrap_or(n),
                Images::Auto if now < FEWEST_IMAGES || self.is_coarse(c) && now < MOST_IMAGES => 2 * now - 1,
                _ => return Ok(()),
            };
            self.observer.stage(&format!("{next} images"));
            let evaluations = c.band.evaluations();
            c.band = Band::continued(self.problem.evaluator(), refined(c.band.path(), next), evaluations);
            self.relax(c, Goal::Loose, evaluations + 40)?;
        }
    }
}

/// Whether a pass is that of one of some saddles.
fn is_among(found: &[Saddle], pass: &Pass) -> bool {
    found.iter().any(|f| is_within(f.spins(), pass.saddle.spins(), SAME))
}

/// Whether two maxima of a band are of one plateau.
fn is_level(band: &Band, tops: [&Peak; 2]) -> bool {
    let [i, j] = tops.map(|top| top.image);
    let heights = tops.map(|top| top.energy_mev);
    let all = heights.iter().chain(&band.energies_mev()[i.min(j)..=i.max(j)]);
    all.into_iter().all(|e| (e - heights[0]).abs() < level_mev(band))
}

/// Whether a saddle is image k of a band, and higher than its neighbours.
fn is_seated(band: &Band, k: usize, saddle: &Saddle) -> bool {
    let e = band.energies_mev();
    let between_ends = k > 0 && k + 1 < e.len();
    between_ends
        && e[k] >= e[k - 1]
        && e[k] >= e[k + 1]
        && band.is_held(k)
        && band.path().image(k) == saddle.refined.state.m
}

/// Puts refined saddles in the place of the images nearest to them, where they fit between the neighbours; says whether any did.
fn seat(band: &mut Band, found: &[Saddle]) -> bool {
    let last = band.images() - 1;
    let mut seated = false;
    for f in found {
        let saddle = &f.refined.state.m;
        let far = band.path().distances_from(saddle);
        let k = (1..last).min_by(|&i, &j| far[i].total_cmp(&far[j])).unwrap_or(1);
        let gap = distance(band.path().image(k - 1), band.path().image(k + 1));
        let fits = far[k - 1] < gap && far[k + 1] < gap;
        if fits && !band.is_held(k) {
            band.hold(k, saddle);
            seated = true;
        }
    }
    seated
}
