//! `summary.json`: the result in numbers and words.
//!
//! Energies in meV; the barrier also in J (1 meV = 1.602176634e-22 J) and in K (E/k_B), CODATA 2022.
//! A number that is not finite is an error here, with its place: JSON has no word for it.

use super::rates_summary::{self, RateEntry, TransitionEntry};
use super::{Certainty, Format, RunReport};
use crate::drive::{Barrier, EndPoint, IntermediateMinimum, Outcome, RejectedPath, SaddlePoint, StopCode, Work};
use crate::error::{Error, Result};
use serde::{Serialize, Serializer, ser::Error as _};

/// J in a meV: e/1000, e in C.
pub(super) const J_PER_MEV: f64 = 1.602176634e-22;
/// Boltzmann's constant in meV/K.
pub(super) const K_B_MEV: f64 = 8.617333262e-2;

/// `summary.json`.
#[derive(Clone, Copy, Debug)]
pub struct Summary;

impl Format for Summary {
    fn file_name(&self) -> String {
        super::disk::MARK.into()
    }

    fn render(&self, run: &RunReport) -> Result<Vec<u8>> {
        let mut bytes = Vec::new();
        let mut json = serde_json::Serializer::pretty(&mut bytes);
        let mut track = serde_path_to_error::Track::new();
        document(run)
            .serialize(serde_path_to_error::Serializer::new(&mut json, &mut track))
            .map_err(|e| Error::Numerical(format!("summary.json: {}: {e}", track.path())))?;
        bytes.push(b'\n');
        Ok(bytes)
    }
}

/// A number that JSON can hold.
#[derive(Clone, Copy)]
pub(super) struct Number(pub(super) f64);

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        if self.0.is_finite() {
            serializer.serialize_f64(self.0)
        } else {
            Err(S::Error::custom(format!("{} is not a finite number", self.0)))
        }
    }
}

#[derive(Serialize)]
#[allow(non_snake_case)]
struct Document<'a> {
    name: &'a str,
    version: &'a str,
    config_sha256: &'a str,
    converged: bool,
    certified: bool,
    stop_code: StopCode,
    stop_reason: &'a str,
    warnings: &'a [String],
    barrier_meV: Option<BothWays>,
    barrier_J: Option<BothWays>,
    barrier_K: Option<BothWays>,
    #[serde(skip_serializing_if = "Option::is_none")]
    barrier_uncertainty_meV: Option<Number>,
    highest_climb_meV: Option<BothWays>,
    saddles: Vec<SaddleEntry>,
    initial: EndEntry,
    r#final: EndEntry,
    intermediate_minima: Vec<MinimumEntry>,
    rejected_paths: Vec<RejectedEntry<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rates: Option<Vec<RateEntry<'a>>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    transition_rates: Option<Vec<TransitionEntry<'a>>>,
    path: PathEntry,
    work: WorkEntry,
}

#[derive(Serialize)]
struct BothWays {
    forward: Number,
    backward: Number,
}

#[derive(Serialize)]
#[allow(non_snake_case)]
struct SaddleEntry {
    energy_meV: Number,
    energy_above_initial_meV: Number,
    reaction_coordinate_rad: Number,
    image: usize,
    max_torque_meV: Option<Number>,
    negative_modes: Option<usize>,
    zero_modes: Option<usize>,
    lowest_eigenvalues_meV: Vec<Number>,
}

#[derive(Serialize)]
#[allow(non_snake_case)]
struct EndEntry {
    energy_meV: Number,
    max_torque_meV: Number,
    negative_modes: Option<usize>,
    zero_modes: Option<usize>,
    moved_rad: Option<Number>,
}

#[derive(Serialize)]
#[allow(non_snake_case)]
struct MinimumEntry {
    image: usize,
    reaction_coordinate_rad: Number,
    energy_meV: Number,
    max_torque_meV: Number,
    negative_modes: Option<usize>,
    zero_modes: Option<usize>,
}

#[derive(Serialize)]
#[allow(non_snake_case)]
struct RejectedEntry<'a> {
    guess: &'a str,
    barrier_meV: Option<Number>,
    negative_modes: Option<usize>,
    reason: &'a str,
}

#[derive(Serialize)]
#[allow(non_snake_case)]
struct PathEntry {
    images: usize,
    length_rad: Number,
    max_perpendicular_torque_meV: Number,
    largest_predicted_rotation_rad: Number,
}

#[derive(Serialize)]
struct WorkEntry {
    iterations: usize,
    force_evaluations: usize,
    seconds: Number,
    threads: usize,
}

fn document<'a>(run: &RunReport<'a>) -> Document<'a> {
    let outcome = run.outcome;
    let barrier = |convert: fn(f64) -> f64| outcome.barrier.map(|b| both_ways(b, convert));
    let unknown_mev = outcome.barrier.and_then(|_| Certainty::of(outcome).unknown_mev);
    Document {
        name: run.name,
        version: run.version,
        config_sha256: run.config_sha256,
        converged: outcome.converged,
        certified: outcome.certified,
        stop_code: outcome.stop_code,
        stop_reason: &outcome.stop_reason,
        warnings: &outcome.warnings,
        barrier_meV: barrier(|mev| mev),
        barrier_J: barrier(|mev| mev * J_PER_MEV),
        barrier_K: barrier(|mev| mev / K_B_MEV),
        barrier_uncertainty_meV: unknown_mev.map(Number),
        highest_climb_meV: outcome.highest_climb.map(|climb| both_ways(climb, |mev| mev)),
        saddles: outcome.saddles.iter().map(saddle).collect(),
        initial: end(&outcome.initial),
        r#final: end(&outcome.final_state),
        intermediate_minima: outcome.intermediate_minima.iter().map(minimum).collect(),
        rejected_paths: outcome.rejected_paths.iter().map(rejected).collect(),
        rates: outcome.rates.as_ref().map(rates_summary::saddles),
        transition_rates: outcome.rates.as_ref().map(rates_summary::transitions),
        path: path(outcome),
        work: work(&outcome.work),
    }
}

fn both_ways(barrier: Barrier, convert: fn(f64) -> f64) -> BothWays {
    BothWays { forward: Number(convert(barrier.forward_mev)), backward: Number(convert(barrier.backward_mev)) }
}

fn saddle(s: &SaddlePoint) -> SaddleEntry {
    SaddleEntry {
        energy_meV: Number(s.energy_mev),
        energy_above_initial_meV: Number(s.above_initial_mev),
        reaction_coordinate_rad: Number(s.reaction_coordinate_rad),
        image: s.image,
        max_torque_meV: s.max_torque_mev.map(Number),
        negative_modes: s.negative_modes,
        zero_modes: s.zero_modes,
        lowest_eigenvalues_meV: s.lowest_eigenvalues_mev.iter().copied().map(Number).collect(),
    }
}

fn end(e: &EndPoint) -> EndEntry {
    EndEntry {
        energy_meV: Number(e.energy_mev),
        max_torque_meV: Number(e.max_torque_mev),
        negative_modes: e.negative_modes,
        zero_modes: e.zero_modes,
        moved_rad: e.moved_rad.map(Number),
    }
}

fn minimum(m: &IntermediateMinimum) -> MinimumEntry {
    let EndEntry { energy_meV, max_torque_meV, negative_modes, zero_modes, .. } = end(&m.state);
    let reaction_coordinate_rad = Number(m.reaction_coordinate_rad);
    MinimumEntry { image: m.image, reaction_coordinate_rad, energy_meV, max_torque_meV, negative_modes, zero_modes }
}

fn rejected(r: &RejectedPath) -> RejectedEntry<'_> {
    RejectedEntry {
        guess: &r.guess,
        barrier_meV: r.barrier_mev.map(Number),
        negative_modes: r.negative_modes,
        reason: &r.reason,
    }
}

fn path(outcome: &Outcome) -> PathEntry {
    PathEntry {
        images: outcome.path.images(),
        length_rad: Number(outcome.images.reaction_coordinate_rad.last().copied().unwrap_or(0.0)),
        max_perpendicular_torque_meV: Number(outcome.max_perpendicular_torque_mev),
        largest_predicted_rotation_rad: Number(outcome.largest_predicted_rotation_rad),
    }
}

fn work(w: &Work) -> WorkEntry {
    WorkEntry {
        iterations: w.iterations,
        force_evaluations: w.force_evaluations,
        seconds: Number(w.seconds),
        threads: w.threads,
    }
}
