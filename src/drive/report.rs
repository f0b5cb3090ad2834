//! From a finished run to its outcome.

use super::judge::{Judgement, Seen};
use super::network::NetworkTimes;
use super::outcome::*;
use super::path_warnings::{OfPath, search_cut_short};
use super::points::{end_of, highest_climb, image_state, minima_between, places_of, saddles, tell_eigenvalues};
use super::rate_warnings;
use super::rates::{self, Known};
use super::run::Run;
use super::settled::{Proof, Settled};
use super::tables::{image_table, profile, profile_terms};
use super::{Partial, Problem, Verdict};
use crate::band::Band;
use crate::landscape::{Effort, Minimum, Pass};
use crate::path::Path;
use crate::rates::{RateSettings, Rates, Symmetry};

/// What its rates are made of, beside its saddles.
#[derive(Default)]
pub struct Rated<'a> {
    /// The symmetry of the energy and the moments, where there are saddles.
    pub symmetry: Option<&'a Symmetry>,
    /// The times over all passes that are known, where they were looked for.
    pub network: Option<NetworkTimes>,
}

impl Run<'_, '_> {
    fn work(&self, iterations: usize) -> Work {
        Work {
            iterations,
            force_evaluations: self.evaluated().evaluations,
            seconds: self.problem.made_in_s + self.started.elapsed().as_secs_f64(),
            threads: rayon::current_num_threads(),
        }
    }

    /// The two ends as they are reported.
    fn end_points(&self, ends: &[Minimum; 2]) -> [EndPoint; 2] {
        let moved = |k: usize| self.problem.relax_ends.then_some(self.ends[k].largest_rotation_rad);
        [0, 1].map(|k| EndPoint { moved_rad: moved(k), ..end_of(&ends[k]) })
    }

    /// What is to be said, with this of the path.
    fn told(&self, of_path: impl IntoIterator<Item = String>) -> Vec<String> {
        self.warnings.iter().cloned().chain(of_path).chain(self.problem.warnings.iter().cloned()).collect()
    }
}

impl Rated<'_> {
    /// Over the saddles of a path, with the times of its network.
    fn rates(&self, known: &Known, settings: &RateSettings) -> Rates {
        let mut rates = rates::of_path(known, settings);
        if let Some(network) = &self.network {
            network.put_into(&mut rates);
        }
        rates
    }
}

/// The outcome of a path.
pub fn outcome(
    run: &Run,
    settled: Settled,
    search: SearchReport,
    rejected_paths: Vec<RejectedPath>,
    rated: Rated,
) -> Outcome {
    let h = run.problem.evaluator();
    let Settled { first: c, found, proof: Proof { ends, links, doubts } } = settled;
    let band = &c.band;
    let initial = band.path().image(0);
    let above_final = h.difference_mev(band.path().image(band.images() - 1), initial);
    let places = places_of(band.path(), &links);
    let mut saddles = saddles(run.problem, band, &found, &links, &places);
    let seen = Seen { problem: run.problem, saddles: &saddles, above_final, ends: &ends };
    let Judgement { verdict, barrier, doubts } = seen.judge(&c, doubts);
    let intermediate_minima = minima_between(run.problem, band, &links, &places);
    // nothing is crossed in a flat valley
    let (saddles, crossed) = match verdict {
        Verdict::FlatValley { .. } | Verdict::BelowRounding { .. } => (Vec::new(), &[][..]),
        _ => {
            tell_eigenvalues(h, &mut saddles, &links);
            (saddles, &links[..])
        }
    };
    let rates = run.problem.rates.as_ref().map(|settings| {
        let no_barrier = barrier.is_none().then_some(&verdict);
        let symmetry = rated.symmetry.filter(|_| !crossed.is_empty());
        let known = Known { h, links: crossed, saddles: &saddles, above_final, doubts: &doubts, no_barrier, symmetry };
        rated.rates(&known, settings)
    });
    let highest_climb =
        barrier.map(|b| highest_climb(b, &saddles, &intermediate_minima, [h.energy_mev(initial), above_final]));
    let of_path = OfPath { band, asked_for: run.problem.images.asked_for(), ends: &ends, links: &links };
    let of_rates = rates.iter().flat_map(|rates| rate_warnings::warnings(rates, &search, barrier, highest_climb));
    let of_network = rates.iter().zip(&rated.network).flat_map(|(rates, network)| network.warnings(rates));
    let of_path = of_path.warnings(&saddles, &doubts, &verdict).into_iter().chain(search_cut_short(&search));
    let warnings = run.told(of_path.chain(of_rates).chain(of_network));
    let (certified, iterations) = (doubts.is_empty() && barrier.is_some(), band.evaluations());
    Outcome {
        certified,
        certificate: certified.then(|| certificate(crossed, &ends)),
        warnings,
        barrier,
        highest_climb,
        saddles,
        intermediate_minima,
        rates,
        search,
        rejected_paths,
        ..of_band(c.band, c.history, &verdict, run.end_points(&ends), run.work(iterations))
    }
}

/// Of the saddles that are crossed, the minima beside them, and the ends.
fn certificate(crossed: &[Pass], ends: &[Minimum; 2]) -> Certificate {
    let beside = crossed.iter().flat_map(|link| [&link.before, &link.after]).chain(ends);
    let spectra = crossed.iter().map(|link| &link.spectrum).chain(beside.map(|minimum| &minimum.spectrum));
    Certificate::of(spectra)
}

/// Both ends relaxed to one minimum: a result without a path.
pub fn same_minimum(run: &Run) -> Outcome {
    let h = run.problem.evaluator();
    let path = Path::new(&[run.ends[0].spins.clone(), run.ends[1].spins.clone()]);
    let ends = Minimum::of_both(h, &run.ends);
    let images = image_table(h, &Band::new(h, path.clone()));
    Outcome {
        warnings: run.told(["there is no path between a minimum and itself".into()]),
        ..bare(path, images, &Verdict::SameMinimum, run.end_points(&ends), run.work(0))
    }
}

/// What is known of a run that was stopped: the band as it stood, without a barrier. `why` says that it is not the end.
pub fn partial(problem: &Problem, partial: &Partial, why: &str) -> Outcome {
    let mut band = Band::new(problem.evaluator(), partial.path.clone());
    band.evaluate();
    let ends = [0, band.images() - 1].map(|k| image_state(&band, k));
    let work = Work { iterations: partial.history.len(), threads: rayon::current_num_threads(), ..Work::default() };
    of_band(band, partial.history.clone(), &Verdict::Interrupted(why.into()), ends, work)
}

/// What a run came to whose band was evaluated, with nothing else said of its path.
fn of_band(band: Band, history: Vec<HistoryRow>, verdict: &Verdict, ends: [EndPoint; 2], work: Work) -> Outcome {
    let images = image_table(band.evaluator(), &band);
    Outcome {
        profile: profile(&band),
        profile_terms_mev: profile_terms(&band.profile(), &images),
        max_perpendicular_torque_mev: band.max_perpendicular_mev(),
        largest_predicted_rotation_rad: history.last().map_or(0.0, |r| r.largest_predicted_rotation_rad),
        history,
        ..bare(band.into_path(), images, verdict, ends, work)
    }
}

/// The same of a path that is not relaxed.
fn bare(path: Path, images: ImageTable, verdict: &Verdict, ends: [EndPoint; 2], work: Work) -> Outcome {
    let [initial, final_state] = ends;
    Outcome {
        converged: verdict.is_converged(),
        certified: false,
        certificate: None,
        stop_code: verdict.code(),
        stop_reason: verdict.to_string(),
        warnings: Vec::new(),
        barrier: None,
        highest_climb: None,
        saddles: Vec::new(),
        initial,
        final_state,
        intermediate_minima: Vec::new(),
        rates: None,
        search: SearchReport { effort: Effort::None, ..SearchReport::default() },
        rejected_paths: Vec::new(),
        path,
        images,
        profile: Vec::new(),
        profile_terms_mev: Vec::new(),
        history: Vec::new(),
        work,
        max_perpendicular_torque_mev: 0.0,
        largest_predicted_rotation_rad: 0.0,
    }
}
