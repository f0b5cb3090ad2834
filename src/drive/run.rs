//! What a run has while it goes on, and how much work it may do.

use super::ends::{judge_end, kept, torque_mev};
use super::explore::turning_axis;
use super::first_path::FirstPath;
use super::relaxation::{Goal, Relaxation, Tools, needs_laplacian};
use super::{Observer, Problem, Scales};
use crate::band::{Band, Laplacian, Sweep};
use crate::energy::{Evaluator, recorded};
use crate::error::Result;
use crate::geometry::Direction;
use crate::landscape::{Landscape, Minimum};
use crate::path::guess::GuessContext;
use crate::record::Count;
use crate::spins::Spins;
use crate::stationary::{RELAXED, Relaxed, both_by_factors, relax_end};
use std::sync::Arc;
use std::time::Instant;

/// Fewest images of an automatic path in the end.
pub const FEWEST_IMAGES: usize = 17;
/// A path is not followed further if its top is higher than that of the best one times this.
pub(super) const WORTH: f64 = 1.2;

pub(super) struct Run<'a, 'o> {
    pub(super) problem: &'a Problem,
    pub(super) observer: &'o mut dyn Observer,
    pub(super) started: Instant,
    /// What was evaluated before it.
    pub(super) before: Count,
    pub(super) ends: [Relaxed; 2],
    pub(super) tools: Tools<'a>,
    pub(super) axis: Direction,
    pub(super) warnings: Vec<String>,
    /// All that was found.
    pub(super) land: Landscape<'a>,
    /// The two ends in it.
    pub(super) minima: [usize; 2],
    /// Most evaluations of single states, where a path is proven and others are followed beside it.
    pub(super) most_evaluations: usize,
}

impl<'a, 'o> Run<'a, 'o> {
    pub(super) fn prepare(problem: &'a Problem, observer: &'o mut dyn Observer) -> Result<Run<'a, 'o>> {
        let started = Instant::now();
        let h = problem.evaluator();
        let before = h.evaluated();
        observer.stage("relaxing the ends");
        let mut warnings = Vec::new();
        let given = [&problem.initial, &problem.final_state];
        let ends = if problem.relax_ends {
            recorded(h, "ends", &given.map(|spins| spins.as_slice()), || relaxed_ends(h, given))?
        } else {
            given.map(|spins| kept(spins, torque_mev(h, spins), None))
        };
        if problem.relax_ends {
            warnings.extend(ends.iter().zip(["initial", "final"]).flat_map(|(end, which)| judge_end(h, end, which)));
        } else {
            warnings.push(
                "the ends were not relaxed (relax_ends is false): they need not be minima, and a certificate speaks of the saddle alone"
                    .into(),
            );
        }
        let (a, b) = (ends[0].spins.as_slice(), ends[1].spins.as_slice());
        let scales = recorded(h, "scales", &[a, b], || Ok(Scales::of_ends(h, &ends)))?;
        let axes = h.symmetry_axes_at(a);
        let laplacian =
            needs_laplacian(&problem.neb.optimiser).then(|| Arc::new(Laplacian::new(&h, scales.stiffness_mev)));
        let stand_in = if laplacian.is_none() { Sweep::stand_in(&h, [a, b], scales.stiffness_mev) } else { None };
        let mut land = Landscape::new(h, a);
        let examined = Minimum::of_both(h, &ends);
        problem.control.check()?;
        let minima = examined.each_ref().map(|minimum| land.add_minimum(minimum));
        let mut run = Run {
            problem,
            observer,
            started,
            before,
            ends,
            tools: Tools { settings: &problem.neb, scales, axes, laplacian, stand_in },
            axis: Direction::X,
            warnings,
            land,
            minima,
            most_evaluations: usize::MAX,
        };
        run.axis = turning_axis(problem, &run.ends[0].spins, &run.ends[1].spins, &run.context());
        Ok(run)
    }

    pub(super) fn context(&self) -> GuessContext<'a> {
        GuessContext { states: self.problem.states(&self.tools.scales), default_axis: self.axis }
    }

    pub(super) fn relax(&mut self, c: &mut FirstPath<'a>, goal: Goal, limit: usize) -> Result<()> {
        let left = self.left(&c.band) / c.band.images();
        let limit = limit.min(self.problem.neb.max_evaluations).min(c.band.evaluations() + left);
        let mut relaxation = Relaxation {
            tools: &self.tools,
            climb: self.problem.neb.climb && !self.problem.refine,
            history: std::mem::take(&mut c.history),
            observer: &mut *self.observer,
        };
        let stop = relaxation.run(&mut c.band, goal, limit);
        c.history = relaxation.history;
        self.observer.relaxed(c.band.path(), &c.history);
        c.stop = stop?;
        Ok(())
    }

    /// How many evaluations of single states a band may take with all that is done for it, all that were made before counted.
    pub(super) fn allowed(&self, band: &Band) -> usize {
        let own = self.problem.neb.max_evaluations.saturating_mul(band.images());
        self.before.evaluations.saturating_add(own).min(self.most_evaluations)
    }

    /// What it has evaluated so far.
    pub(super) fn evaluated(&self) -> Count {
        self.problem.evaluator().evaluated().since(self.before)
    }

    /// How many are left of them.
    pub(super) fn left(&self, band: &Band) -> usize {
        self.allowed(band).saturating_sub(self.problem.evaluator().evaluated().evaluations)
    }

    /// Whether none are.
    pub(super) fn is_spent(&self, band: &Band) -> bool {
        self.left(band) == 0
    }
}

/// The minima that two states relax to.
fn relaxed_ends(h: Evaluator, given: [&Spins; 2]) -> Result<[Relaxed; 2]> {
    let relax = |spins: &Spins| relax_end(h, spins, RELAXED * h.stiffness_mev());
    let (a, b) = both_by_factors(&h, || relax(given[0]), || relax(given[1]));
    Ok([a?, b?])
}
