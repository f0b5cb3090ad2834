//! The search below the top of the best of the first paths: what they met, third states, and climbs.

use super::Silent;
use super::explore::turning_axis;
use super::outcome::{RejectedPath, SearchReport};
use super::relaxation::height;
use super::report::Proof;
use super::run::{Run, Settled};
use crate::energy::Hamiltonian;
use crate::error::Result;
use crate::geometry::Vector;
use crate::hessian::factorisation_flops;
use crate::landscape::{Effort, Landscape, Minimum, Pass, Settings, search};
use crate::record::Count;
use crate::spins::Spins;
use crate::stationary::{Relaxed, relax_to_minimum};
use crate::symmetry::Group;

/// Images by symmetry of every minimum and pass, at most, and of how many spins.
const IMAGES: usize = 64;
const IMAGE_SPINS: usize = 2_000_000;
/// Single states are evaluated until so many spins were, or so many times as often as for the first paths; and their Hessians until
/// so many operations were spent on factorising them, or as many times as often.
const SPINS: usize = 10_000_000;
const FLOPS: f64 = 5e8;
const PARTS: usize = 2;

/// Domains with a spin that is further apart are two (rad).
const DOMAIN: f64 = 0.5;

impl<'a> Run<'a, '_> {
    /// Looks for a route below the top of the best path, and leads the path over it.
    pub(super) fn search(&mut self, best: &mut Settled<'a>, rejected: &mut Vec<RejectedPath>) -> Result<SearchReport> {
        let effort = self.problem.search;
        let mut report = SearchReport { effort, ..SearchReport::default() };
        let asked = self.problem.certify && self.problem.seeks_saddles() && self.problem.relax_ends;
        if effort == Effort::None || !asked {
            return Ok(report);
        }
        self.observer.stage("looking for lower passes");
        let h = self.problem.evaluator();
        let most = self.allowance(best.candidate.band.images());
        let a = self.ends[0].spins.as_slice();
        let images = IMAGES.min(IMAGE_SPINS / h.sites());
        let mut land = Landscape::new(h, a, Group::of(&h, a, &[]).operations().take(images).collect());
        let ends = best.proof.ends.each_ref().map(|end| land.add_minimum(end));
        if ends[0] == ends[1] {
            return Ok(report);
        }
        let first_mev = best.seen_mev();
        let unproven = !best.proof.doubts.is_empty();
        // images may miss a saddle by as much as the path is high
        let top_mev = if unproven { first_mev + height(&best.candidate.band) } else { first_mev };
        for pass in std::mem::take(&mut self.met) {
            land.add(pass);
        }
        if most.evaluations > 0 {
            self.through_third_states(&mut land, ends, top_mev)?;
        }
        let settings = Settings { effort, most, top_mev, c: self.scales.stiffness_mev, context: self.context() };
        let searched = search(&mut land, ends, &settings)?;
        report.searches = searched.searches;
        report.quiet = searched.quiet;
        report.spent = searched.spent;
        report.minima = land.minima().len();
        report.saddles = land.edges().len();
        let lower = |top_mev: f64| first_mev - top_mev > land.tolerance_mev(first_mev);
        let Some(route) = land.route(ends[0], ends[1]).filter(|route| lower(route.top_mev) || unproven) else {
            return Ok(report);
        };
        let proof = Proof { ends: best.proof.ends.clone(), links: land.passes_of(&route), doubts: Vec::new() };
        let name = best.candidate.name.clone();
        if self.join(&mut best.candidate, &proof)? {
            report.lowered_by_mev = if lower(route.top_mev) { first_mev - route.top_mev } else { 0.0 };
            let reason = match unproven {
                true => "it could not be proven; a search found passes that could".to_string(),
                false => format!("a search found passes that are {:.1e} meV lower", report.lowered_by_mev),
            };
            rejected
                .insert(0, RejectedPath { guess: name, barrier_mev: Some(first_mev), negative_modes: None, reason });
            best.proof = proof;
        } else {
            let top = route.top_mev;
            self.warnings.push(format!(
                "passes are known that rise to {top:.6} meV alone, but a path over them could not be put together"
            ));
        }
        Ok(report)
    }

    /// What the search may evaluate after all that was evaluated for a path of so many images.
    fn allowance(&self, images: usize) -> Count {
        let h = self.problem.evaluator();
        let own = h.evaluated();
        let hessians = (FLOPS / factorisation_flops(&h)) as usize;
        // of the whole run: so many of the whole band
        let allowed = self.problem.neb.max_evaluations.saturating_mul(images);
        let left = allowed.saturating_sub(own.evaluations);
        Count {
            evaluations: (SPINS / h.sites()).max(PARTS * own.evaluations).min(left),
            hessians: hessians.max(PARTS * own.hessians),
        }
    }

    /// Ways through the domains that the ends consist of: out of the lattice and in again.
    fn through_third_states(&mut self, land: &mut Landscape<'a>, [a, b]: [usize; 2], top_mev: f64) -> Result<()> {
        let h = self.problem.evaluator();
        for domain in third_states(&h, self.ends.each_ref().map(|end| &end.spins)) {
            let top = land.top_mev(a, b).map_or(top_mev, |lowest| lowest.min(top_mev));
            if land.height_mev(domain.as_slice()) >= top {
                continue;
            }
            let relaxed = relax_to_minimum(h, &domain, super::run::END_TOLERANCE * h.stiffness_mev())?;
            let third = Minimum::examine(h, &relaxed.spins);
            if !third.is_proven() || land.height_mev(third.spins.as_slice()) >= top {
                continue;
            }
            let third = land.add_minimum(&third);
            for [from, to] in [[a, third], [third, b]] {
                let parts = land.parts_below(top - land.tolerance_mev(top));
                if parts[from] != parts[to] {
                    let passes = self.passes_between([from, to].map(|k| &land.minima()[k]))?;
                    for pass in passes {
                        land.add(pass);
                    }
                    let parts = land.parts_below(top - land.tolerance_mev(top));
                    if parts[from] != parts[to] {
                        break;
                    }
                }
            }
        }
        Ok(())
    }

    /// The certified passes that the best natural first path between two minima meets.
    fn passes_between(&self, minima: [&Minimum; 2]) -> Result<Vec<Pass>> {
        let at_rest = |m: &Minimum| Relaxed {
            spins: m.spins.clone(),
            max_torque_mev: m.max_torque_mev,
            steps: 0,
            largest_rotation_rad: 0.0,
            left: None,
            converged: true,
        };
        let mut run = Run {
            problem: self.problem,
            observer: &mut Silent,
            started: self.started,
            ends: minima.map(at_rest),
            scales: self.scales,
            axes: self.axes.clone(),
            laplacian: self.laplacian.clone(),
            axis: self.axis,
            warnings: Vec::new(),
            lowest_top: f64::INFINITY,
            met: Vec::new(),
            silent: Silent,
        };
        run.axis = turning_axis(run.problem, &run.ends[0].spins, &run.ends[1].spins, &run.context());
        let best = run.natural()?.remove(0);
        run.settle(best)?;
        Ok(run.met)
    }
}

/// What the first and the last spins of two states say all over the lattice, where that is another state: all as the one at the
/// end, or, where neighbours there are opposite, as the two. Frozen spins stay.
pub fn third_states(h: &Hamiltonian, ends: [&Spins; 2]) -> Vec<Spins> {
    let sites = ends[0].sites();
    let mut found: Vec<Spins> = Vec::new();
    if sites < 2 {
        return found;
    }
    for end in ends {
        for [first, second] in [[0, 1], [sites - 2, sites - 1]] {
            let pair = [end.get(first), end.get(second)];
            let spin = |i: usize| if h.is_frozen(i) { end.get(i) } else { pair[(i + first) % 2] };
            let vectors: Vec<Vector> = (0..sites).map(spin).collect();
            let Ok(state) = Spins::from_vectors(&vectors) else { continue };
            let new = |other: &Spins| crate::path::largest_angle(other.as_slice(), state.as_slice()) > DOMAIN;
            if ends.iter().all(|end| new(end)) && found.iter().all(new) {
                found.push(state);
            }
        }
    }
    found
}
