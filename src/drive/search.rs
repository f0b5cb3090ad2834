//! The search below the top of the best of the first paths: what they met, third states, and climbs.

use super::Silent;
use super::ends::kept;
use super::explore::turning_axis;
use super::first_paths::BRIEF_TRIAL;
use super::heights::height;
use super::outcome::{RejectedPath, SearchReport};
use super::run::Run;
use super::settled::{Proof, Settled};
use crate::band::Band;
use crate::energy::Hamiltonian;
use crate::error::Result;
use crate::geometry::Vector;
use crate::hessian::factorisation_flops;
use crate::landscape::{Aim, Doubt, Effort, KINDS, Landscape, Minimum, Searched, Settings, search};
use crate::record::Count;
use crate::spins::Spins;
use crate::stationary::{RELAXED, STRIDE, relax_to_minimum};

/// Single states are evaluated until so many spins were, or as often as for the first paths; and their Hessians until so many
/// operations were spent on factorising them, or as often. At `thorough` several times as much of all.
const SPINS: f64 = 1e7;
const FLOPS: f64 = 1e9;
/// And so many times as much while searches bring news.
pub(super) const WITH_NEWS: usize = 8;
/// Climbs are made side by side as long as they take no more than so many times that, a second or so.
const TOGETHER: f64 = 10.0;

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
        let [most, most_with_news] = [1, WITH_NEWS].map(|times| self.allowance(&best.first.band, times));
        let ends = self.minima;
        if ends[0] == ends[1] {
            return Ok(report);
        }
        let first_mev = best.seen_mev();
        let unproven = !best.proof.doubts.is_empty();
        // images may miss a saddle by as much as the path is high
        let top_mev = if unproven { first_mev + height(&best.first.band) } else { first_mev };
        self.land.unfold();
        // as much goes there at most as into the search
        self.most_evaluations = h.evaluated().evaluations.saturating_add(most.evaluations);
        self.through_third_states(top_mev)?;
        self.most_evaluations = usize::MAX;
        let settings = Settings {
            effort,
            shares: 1,
            most,
            most_with_news,
            together: self.worth(TOGETHER),
            most_kinds: KINDS,
            c: self.tools.scales.stiffness_mev,
            context: self.context(),
        };
        let searched = search(&mut self.land, Aim::Route(ends, top_mev), &settings, &mut |standing| {
            self.observer.searching(standing)
        })?;
        let Searched { searches, quiet, spent } = searched;
        let saddles = self.land.edges().iter().filter(|edge| !edge.is_twin).count();
        report = SearchReport { searches, quiet, spent, minima: self.land.minima().len(), saddles, ..report };
        let least = self.land.tolerance_mev(first_mev);
        let lower = |top_mev: f64| first_mev - top_mev > least;
        let route = self.land.route(ends[0], ends[1]).filter(|route| lower(route.top_mev) || unproven);
        let Some(route) = route else { return Ok(report) };
        let proof = Proof { ends: best.proof.ends.clone(), links: self.land.passes_of(&route), doubts: Vec::new() };
        let name = best.first.name.clone();
        if self.lead_over(&mut best.first, &proof)? {
            report.lowered_by_mev = if lower(route.top_mev) { first_mev - route.top_mev } else { 0.0 };
            let reason = match unproven {
                true => "it could not be proven; a search found passes that could".to_string(),
                false => format!("a search found passes that are {:.1e} meV lower", report.lowered_by_mev),
            };
            rejected
                .insert(0, RejectedPath { guess: name, barrier_mev: Some(first_mev), negative_modes: None, reason });
            best.proof = proof;
        } else if lower(route.top_mev) {
            best.proof.doubts.push(Doubt::Unassembled { top_mev: route.top_mev, path_mev: first_mev });
        }
        Ok(report)
    }

    /// What the search may evaluate after all that was evaluated for a band, so many times as much as is usual.
    fn allowance(&self, band: &Band, times: usize) -> Count {
        let times = times * self.problem.search.works();
        let Count { evaluations, hessians } = self.worth(1.0);
        let evaluations = evaluations.saturating_mul(times).min(self.left(band));
        Count { evaluations, hessians: hessians.saturating_mul(times) }
    }

    /// So many times the work that is little, or as much as there was.
    pub(super) fn worth(&self, times: f64) -> Count {
        let h = self.problem.evaluator();
        let own = self.evaluated();
        let little = |of: f64, one: f64| (times * of / one) as usize;
        Count {
            evaluations: little(SPINS, h.sites() as f64).max(own.evaluations),
            hessians: little(FLOPS, factorisation_flops(&h)).max(own.hessians),
        }
    }

    /// Ways through the domains that the ends consist of: out of the lattice and in again.
    fn through_third_states(&mut self, top_mev: f64) -> Result<()> {
        let h = self.problem.evaluator();
        let [a, b] = self.minima;
        for domain in third_states(&h, self.ends.each_ref().map(|end| &end.spins)) {
            if h.evaluated().evaluations >= self.most_evaluations {
                break;
            }
            let top = self.land.top_mev(a, b).map_or(top_mev, |lowest| lowest.min(top_mev));
            if self.land.height_mev(domain.as_slice()) >= top {
                continue;
            }
            let relaxed = relax_to_minimum(h, &domain, RELAXED * h.stiffness_mev())?;
            let third = Minimum::of(h, &relaxed);
            if !third.is_proven() || self.land.height_mev(third.spins.as_slice()) >= top {
                continue;
            }
            let third = self.land.add_minimum(&third);
            let below = top - self.land.tolerance_mev(top);
            for pair in [[a, third], [third, b]] {
                if !self.is_joined(pair, below) {
                    self.connect_by_first_path(pair, below)?;
                    if !self.is_joined(pair, below) {
                        break;
                    }
                }
            }
        }
        Ok(())
    }

    fn is_joined(&self, [a, b]: [usize; 2], below_mev: f64) -> bool {
        let parts = self.land.parts_below(below_mev);
        parts[a] == parts[b]
    }

    /// A run of its own between two minima, over the best of their natural first paths; what it finds stays in the landscape.
    pub(super) fn connect_by_first_path(&mut self, minima: [usize; 2], below_mev: f64) -> Result<()> {
        let h = self.problem.evaluator();
        let land = std::mem::replace(&mut self.land, Landscape::new(h, self.ends[0].spins.as_slice()));
        let ends = minima.map(|k| {
            let Minimum { spins, max_torque_mev, spectrum, .. } = &land.minima()[k];
            kept(spins, *max_torque_mev, Some(spectrum.clone()))
        });
        let mut run = Run {
            problem: self.problem,
            observer: &mut Silent,
            started: self.started,
            ends,
            tools: self.tools.clone(),
            axis: self.axis,
            warnings: Vec::new(),
            land,
            minima,
            before: self.before,
            most_evaluations: self.most_evaluations,
        };
        run.axis = turning_axis(run.problem, &run.ends[0].spins, &run.ends[1].spins, &run.context());
        if let Some(best) = run.natural(BRIEF_TRIAL)?.into_iter().next() {
            run.put_in(best, below_mev)?;
        }
        self.land = run.land;
        Ok(())
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
            let new = |other: &Spins| crate::path::largest_angle(other.as_slice(), state.as_slice()) > STRIDE;
            if ends.iter().all(|end| new(end)) && found.iter().all(new) {
                found.push(state);
            }
        }
    }
    found
}
