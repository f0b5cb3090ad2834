//! `summary.json`: the result in numbers and words, as it is written and as it is read back.
//!
//! Energies in meV; the barrier also in J (1 meV = 1.602176634e-22 J) and in K (E/k_B), CODATA 2022.
//! A number that is not finite is an error where it would be written, with its place: JSON has no word for it. What an earlier
//! version did not write is nothing where it is read.

use super::columns::WAY_OUT;
use super::disk::MARK;
use super::head::Head;
use super::number::Number;
use super::rates_summary::{self, RateEntry, TransitionEntry};
use super::read::{shown, text};
use super::{Certainty, Format, RunReport};
use crate::drive::{
    Barrier, Certificate, EndPoint, IntermediateMinimum, Outcome, RejectedPath, SaddlePoint, SearchReport, StopCode,
    Work,
};
use crate::error::{Error, Result};
use crate::hessian::Bound;
use crate::landscape::Effort;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// J in a meV: e/1000, e in C.
pub(super) const J_PER_MEV: f64 = 1.602176634e-22;
/// Boltzmann's constant in meV/K.
pub(super) const K_B_MEV: f64 = 8.617333262e-2;

/// `summary.json`.
#[derive(Clone, Copy, Debug)]
pub struct SummaryJson;

impl Format for SummaryJson {
    fn file_name(&self) -> String {
        MARK.into()
    }

    fn render(&self, run: &RunReport) -> Result<Vec<u8>> {
        let mut bytes = Vec::new();
        let mut json = serde_json::Serializer::pretty(&mut bytes);
        let mut track = serde_path_to_error::Track::new();
        Summary::of(run)
            .serialize(serde_path_to_error::Serializer::new(&mut json, &mut track))
            .map_err(|e| Error::Numerical(format!("{MARK}: {}: {e}", track.path())))?;
        bytes.push(b'\n');
        Ok(bytes)
    }
}

/// What the result of another command than `run` says that it is.
#[derive(Deserialize)]
struct Kind {
    kind: String,
}

/// What `summary.json` holds.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(expecting = "the summary of a result")]
#[allow(non_snake_case)]
pub struct Summary {
    /// Name of the run.
    pub name: String,
    /// Which result it is.
    #[serde(flatten)]
    pub head: Head,
    /// By what the negative directions of what is certified were told: "counted" or "bounded".
    #[serde(default)]
    pub certificate: Option<Told>,
    /// The bound, where they were bounded.
    #[serde(skip_serializing_if = "Option::is_none")]
    certificate_bound: Option<CertificateBound>,
    /// Why the run stopped, from a closed list; nothing of version 0.1.0.
    pub stop_code: Option<StopCode>,
    /// Why the run stopped, in words.
    pub stop_reason: String,
    /// What the user should know.
    pub warnings: Vec<String>,
    /// The barrier, where there is one.
    pub barrier_meV: Option<BothWays>,
    barrier_J: Option<BothWays>,
    barrier_K: Option<BothWays>,
    #[serde(skip_serializing_if = "Option::is_none")]
    barrier_uncertainty_meV: Option<Number>,
    /// The highest climb from any minimum on the way to a later saddle.
    pub highest_climb_meV: Option<BothWays>,
    pub(super) saddles: Vec<Saddle>,
    pub(super) initial: End,
    pub(super) r#final: End,
    pub(super) intermediate_minima: Vec<Minimum>,
    /// What the search for lower passes came to; nothing of version 0.1.0.
    pub(super) search: Option<Search>,
    pub(super) rejected_paths: Vec<Rejected>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) rates: Option<Vec<RateEntry>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) transition_rates: Option<Vec<TransitionEntry>>,
    pub(super) path: Band,
    pub(super) work: Work,
}

/// An energy from the initial state and from the final one.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct BothWays {
    forward: Number,
    backward: Number,
}

impl BothWays {
    fn of(barrier: Barrier, per_mev: fn(f64) -> f64) -> BothWays {
        let [forward, backward] = [barrier.forward_mev, barrier.backward_mev].map(|mev| Number(per_mev(mev)));
        BothWays { forward, backward }
    }
}

/// Of energies in meV.
impl From<BothWays> for Barrier {
    fn from(b: BothWays) -> Barrier {
        Barrier { forward_mev: b.forward.0, backward_mev: b.backward.0 }
    }
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[allow(non_snake_case)]
pub(super) struct Saddle {
    pub energy_meV: Number,
    pub energy_above_initial_meV: Number,
    pub reaction_coordinate_rad: Number,
    pub image: usize,
    pub max_torque_meV: Option<Number>,
    pub negative_modes: Option<usize>,
    pub zero_modes: Option<usize>,
    pub lowest_eigenvalues_meV: Vec<Number>,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[allow(non_snake_case)]
pub(super) struct Search {
    pub effort: Effort,
    pub searches: usize,
    pub quiet: usize,
    pub minima: usize,
    pub saddles: usize,
    pub lowered_by_meV: Number,
    pub spent: bool,
    /// Nothing of earlier results.
    #[serde(default)]
    pub lowest_exit_meV: Exits,
    /// The lowest temperature of the rates; nothing where there are none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lowest_exit_from_K: Option<Number>,
}

/// Above the initial state and above the final one.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub(super) struct Exits {
    pub initial: Option<Number>,
    pub r#final: Option<Number>,
}

fn search(found: &SearchReport) -> Search {
    let SearchReport {
        effort,
        searches,
        quiet,
        minima,
        saddles,
        lowered_by_mev,
        spent,
        lowest_exits_mev,
        exits_from_k,
    } = *found;
    let [initial, r#final] = lowest_exits_mev.map(|mev| mev.map(Number));
    Search {
        effort,
        searches,
        quiet,
        minima,
        saddles,
        lowered_by_meV: Number(lowered_by_mev),
        spent,
        lowest_exit_meV: Exits { initial, r#final },
        lowest_exit_from_K: exits_from_k.map(Number),
    }
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[allow(non_snake_case)]
pub(super) struct State {
    pub energy_meV: Number,
    pub max_torque_meV: Number,
    pub negative_modes: Option<usize>,
    pub zero_modes: Option<usize>,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct End {
    #[serde(flatten)]
    pub state: State,
    pub moved_rad: Option<Number>,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct Minimum {
    pub image: usize,
    pub reaction_coordinate_rad: Number,
    #[serde(flatten)]
    pub state: State,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[allow(non_snake_case)]
pub(super) struct Rejected {
    pub guess: String,
    pub barrier_meV: Option<Number>,
    pub negative_modes: Option<usize>,
    pub reason: String,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[allow(non_snake_case)]
pub(super) struct Band {
    pub images: usize,
    pub length_rad: Number,
    pub max_perpendicular_torque_meV: Number,
    pub largest_predicted_rotation_rad: Number,
}

/// By what negative directions are told.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Told {
    /// By the inertia of factors.
    Counted,
    /// By Lanczos.
    Bounded,
}

/// No direction is more negative than this part of its stiffness between spins, but for the negative ones that were found.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct CertificateBound {
    part_of_stiffness: Number,
    lanczos_steps: usize,
    probability_of_error: Number,
}

impl From<Bound> for CertificateBound {
    fn from(Bound { part, steps, probability }: Bound) -> CertificateBound {
        let [part_of_stiffness, probability_of_error] = [part, probability].map(Number);
        CertificateBound { part_of_stiffness, lanczos_steps: steps, probability_of_error }
    }
}

impl Summary {
    fn of(run: &RunReport) -> Summary {
        let outcome = run.outcome;
        let barrier = |per_mev: fn(f64) -> f64| outcome.barrier.map(|b| BothWays::of(b, per_mev));
        let unknown_mev = outcome.barrier.and_then(|_| Certainty::of(outcome).unknown_mev);
        Summary {
            name: run.name.into(),
            head: Head {
                version: run.version.into(),
                config_sha256: run.config_sha256.into(),
                converged: outcome.converged,
                certified: outcome.certified,
            },
            certificate: outcome.certificate.map(|by| match by {
                Certificate::Counted => Told::Counted,
                Certificate::Bounded(_) => Told::Bounded,
            }),
            certificate_bound: outcome.certificate.and_then(Certificate::bound).map(CertificateBound::from),
            stop_code: Some(outcome.stop_code),
            stop_reason: outcome.stop_reason.clone(),
            warnings: outcome.warnings.clone(),
            barrier_meV: barrier(|mev| mev),
            barrier_J: barrier(|mev| mev * J_PER_MEV),
            barrier_K: barrier(|mev| mev / K_B_MEV),
            barrier_uncertainty_meV: unknown_mev.map(Number),
            highest_climb_meV: outcome.highest_climb.map(|climb| BothWays::of(climb, |mev| mev)),
            saddles: outcome.saddles.iter().map(saddle).collect(),
            initial: end(&outcome.initial),
            r#final: end(&outcome.final_state),
            intermediate_minima: outcome.intermediate_minima.iter().map(minimum).collect(),
            search: Some(search(&outcome.search)),
            rejected_paths: outcome.rejected_paths.iter().map(rejected).collect(),
            rates: outcome.rates.as_ref().map(rates_summary::saddles),
            transition_rates: outcome.rates.as_ref().map(rates_summary::transitions),
            path: band(outcome),
            work: outcome.work,
        }
    }

    /// That of the result in a folder.
    pub fn read(dir: &Path) -> Result<Summary> {
        let wrong = |words: String| Error::invalid(shown(dir, MARK), format!("{words}: {WAY_OUT}"));
        let text = text(dir, MARK)?.ok_or_else(|| wrong("is not there".into()))?;
        serde_json::from_str(&text).map_err(|e| match serde_json::from_str(&text) {
            Ok(Kind { kind }) => {
                let words = format!(
                    "this is the result of a {kind}, not of a path between two states; its figures are drawn as it is written, and \
                     `spinneb {kind}` with --force draws them anew"
                );
                Error::invalid(shown(dir, MARK), words)
            }
            Err(_) => wrong(format!("is damaged: {e}")),
        })
    }

    /// By what negative directions were told, with the bound.
    pub(super) fn told(&self) -> Option<Certificate> {
        let bound = |b: &CertificateBound| Bound {
            part: b.part_of_stiffness.0,
            steps: b.lanczos_steps,
            probability: b.probability_of_error.0,
        };
        let by = self.certificate_bound.as_ref().map_or(Certificate::Counted, |b| Certificate::Bounded(bound(b)));
        self.head.certified.then_some(by)
    }

    /// Whether the search for lower passes ended because it had done as much work as it may.
    pub fn search_is_spent(&self) -> bool {
        self.search.as_ref().is_some_and(|search| search.spent)
    }

    /// How certain its barrier is; results of earlier versions do not say how much of it is unknown.
    pub fn certainty(&self) -> Certainty {
        let unknown_mev = self.barrier_uncertainty_meV.map_or(0.0, |mev| mev.0);
        let moved = [&self.initial, &self.r#final].map(|end| end.moved_rad.map(|angle| angle.0));
        Certainty::new((!self.head.certified).then_some(unknown_mev), moved)
    }
}

fn saddle(s: &SaddlePoint) -> Saddle {
    Saddle {
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

fn state(e: &EndPoint) -> State {
    State {
        energy_meV: Number(e.energy_mev),
        max_torque_meV: Number(e.max_torque_mev),
        negative_modes: e.negative_modes,
        zero_modes: e.zero_modes,
    }
}

fn end(e: &EndPoint) -> End {
    End { state: state(e), moved_rad: e.moved_rad.map(Number) }
}

fn minimum(m: &IntermediateMinimum) -> Minimum {
    let reaction_coordinate_rad = Number(m.reaction_coordinate_rad);
    Minimum { image: m.image, reaction_coordinate_rad, state: state(&m.state) }
}

fn rejected(r: &RejectedPath) -> Rejected {
    Rejected {
        guess: r.guess.clone(),
        barrier_meV: r.barrier_mev.map(Number),
        negative_modes: r.negative_modes,
        reason: r.reason.clone(),
    }
}

fn band(outcome: &Outcome) -> Band {
    Band {
        images: outcome.path.images(),
        length_rad: Number(outcome.images.reaction_coordinate_rad.last().copied().unwrap_or(0.0)),
        max_perpendicular_torque_meV: Number(outcome.max_perpendicular_torque_mev),
        largest_predicted_rotation_rad: Number(outcome.largest_predicted_rotation_rad),
    }
}
