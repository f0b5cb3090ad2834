//! What a run found: everything that is written to disk is a function of an [`Outcome`].

use super::StopCode;
use crate::hessian::Bound;
use crate::landscape::Effort;
use crate::path::Path;
use crate::rates::Rates;
use crate::spins::Spins;
use crate::stationary::{FAR, Spectrum};
use serde::{Deserialize, Serialize};

/// A finished run.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The band met its tolerance.
    pub converged: bool,
    /// Saddles and ends were proven to be what they are said to be.
    pub certified: bool,
    /// By what the negative directions of ends and saddles are told; nothing of what is not certified.
    pub certificate: Option<Certificate>,
    /// Why the run stopped, from a closed list.
    pub stop_code: StopCode,
    /// Why the run stopped, in words.
    pub stop_reason: String,
    /// What the user should know.
    pub warnings: Vec<String>,
    /// The barrier, where there is one to report.
    pub barrier: Option<Barrier>,
    /// The highest climb from any minimum on the way, ends included, to a later saddle; at least the barrier, and nothing without
    /// one. At low temperature it is what the time to the other end goes with: d ln t/d(1/k_BT).
    pub highest_climb: Option<Barrier>,
    /// The saddles (energy maxima) along the path, in path order.
    pub saddles: Vec<SaddlePoint>,
    /// The initial state as relaxed.
    pub initial: EndPoint,
    /// The final state as relaxed.
    pub final_state: EndPoint,
    /// Minima between the ends.
    pub intermediate_minima: Vec<IntermediateMinimum>,
    /// Rates and lifetimes, where they were asked for.
    pub rates: Option<Rates>,
    /// What the search for lower passes came to.
    pub search: SearchReport,
    /// Other paths that were tried.
    pub rejected_paths: Vec<RejectedPath>,
    /// The spins.
    pub path: Path,
    /// One row an image.
    pub images: ImageTable,
    /// The interpolated energy path.
    pub profile: Vec<ProfilePoint>,
    /// Energy of each term above that of the initial image, at the points of `profile` (meV).
    pub profile_terms_mev: Vec<(String, Vec<f64>)>,
    /// One row a band iteration.
    pub history: Vec<HistoryRow>,
    /// Sum over saddles, ends, all: what it cost.
    pub work: Work,
    /// Largest |F⊥| component of any image (meV).
    pub max_perpendicular_torque_mev: f64,
    /// Largest rotation that the relaxation still predicted (rad).
    pub largest_predicted_rotation_rad: f64,
}

/// By what the negative directions of a state are told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Certificate {
    /// All of them, by the inertia of a factorised Hessian.
    Counted,
    /// Those that were found; that there is no other, by this bound, where memory would not hold the factors.
    Bounded(Bound),
}

impl Certificate {
    /// The bound, where they were not counted.
    pub fn bound(self) -> Option<Bound> {
        if let Certificate::Bounded(bound) = self { Some(bound) } else { None }
    }

    /// Of all these states.
    pub fn of<'a>(spectra: impl Iterator<Item = &'a Spectrum>) -> Certificate {
        let weakest = spectra.filter_map(|spectrum| spectrum.bound).max_by(|p, q| p.part.total_cmp(&q.part));
        weakest.map_or(Certificate::Counted, Certificate::Bounded)
    }
}

impl Outcome {
    /// The minima on the way with both ends, in path order.
    pub fn minima(&self) -> Vec<Spins> {
        let between = self.intermediate_minima.iter().map(|minimum| minimum.spins.clone());
        std::iter::once(self.path.spins(0)).chain(between).chain([self.path.spins(self.path.images() - 1)]).collect()
    }
}

/// Energy to climb from the initial state (forward) and from the final state (backward), meV.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Barrier {
    /// From the initial state.
    pub forward_mev: f64,
    /// From the final state.
    pub backward_mev: f64,
}

/// A saddle on the path.
#[derive(Clone, Debug)]
pub struct SaddlePoint {
    /// Total energy (meV).
    pub energy_mev: f64,
    /// Energy above the initial state, from differences of densities (meV).
    pub above_initial_mev: f64,
    /// Where on the path (rad).
    pub reaction_coordinate_rad: f64,
    /// Nearest image.
    pub image: usize,
    /// The spins, as far as they are known: refined, or those of the nearest image.
    pub spins: Spins,
    /// Largest component of the gradient on the spheres (meV); `None` if the saddle was only interpolated.
    pub max_torque_mev: Option<f64>,
    /// Negative eigenvalues, where counted.
    pub negative_modes: Option<usize>,
    /// Zero modes, where counted.
    pub zero_modes: Option<usize>,
    /// Lowest eigenvalues of the Riemannian Hessian (meV), where computed.
    pub lowest_eigenvalues_mev: Vec<f64>,
}

/// An end of which a spin turned by more than this while it relaxed may be another state than meant (rad): by a quarter turn, as from a
/// hard axis into the easy plane, but for rounding.
pub const MOVED_FAR_RAD: f64 = FAR - 1e-6;

/// An end of the path.
#[derive(Clone, Debug)]
pub struct EndPoint {
    /// Total energy (meV).
    pub energy_mev: f64,
    /// Largest component of the gradient on the spheres (meV).
    pub max_torque_mev: f64,
    /// Negative eigenvalues, where counted.
    pub negative_modes: Option<usize>,
    /// Zero modes, where counted.
    pub zero_modes: Option<usize>,
    /// Largest rotation of any spin from where the state was put (rad), where it was relaxed.
    pub moved_rad: Option<f64>,
}

/// A minimum between the ends.
#[derive(Clone, Debug)]
pub struct IntermediateMinimum {
    /// The image nearest to it.
    pub image: usize,
    /// Where on the path (rad).
    pub reaction_coordinate_rad: f64,
    /// Its spins, as far as they are known: relaxed, or those of the image.
    pub spins: Spins,
    /// Its state.
    pub state: EndPoint,
}

/// A path that was tried and not chosen.
#[derive(Clone, Debug)]
pub struct RejectedPath {
    /// The first guess it came from.
    pub guess: String,
    /// Its barrier as far as it was followed (meV).
    pub barrier_mev: Option<f64>,
    /// Negative modes at its top, where counted.
    pub negative_modes: Option<usize>,
    /// Why it was left.
    pub reason: String,
}

/// One row an image.
#[derive(Clone, Debug, Default)]
pub struct ImageTable {
    /// Geodesic length from the initial state (rad).
    pub reaction_coordinate_rad: Vec<f64>,
    /// Total energy (meV).
    pub energy_mev: Vec<f64>,
    /// Energy above the initial image, computed from differences of densities (meV).
    pub above_initial_mev: Vec<f64>,
    /// Energy by named term, in the order of the Hamiltonian (meV).
    pub terms_mev: Vec<(String, Vec<f64>)>,
    /// Largest component of the force perpendicular to the path (meV); zero at the ends.
    pub max_perpendicular_torque_mev: Vec<f64>,
}

/// A point of the interpolated energy path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProfilePoint {
    /// Geodesic length from the initial state (rad).
    pub reaction_coordinate_rad: f64,
    /// Energy above the initial image (meV).
    pub above_initial_mev: f64,
}

impl Outcome {
    /// Products with a Hessian an image that moves, in the band of the reported path.
    pub fn hessian_products_an_image(&self) -> f64 {
        self.history.iter().map(|row| row.hessian_products as f64 / (row.images - 2) as f64).sum()
    }
}

/// One row a band iteration.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HistoryRow {
    /// Counted from 1.
    pub iteration: usize,
    /// Images of the band at that time, both ends counted.
    pub images: usize,
    /// Largest |F⊥| component (meV).
    pub max_perpendicular_torque_mev: f64,
    /// Largest predicted rotation (rad).
    pub largest_predicted_rotation_rad: f64,
    /// Highest image above the initial state (meV).
    pub highest_image_mev: f64,
    /// Path length (rad).
    pub length_rad: f64,
    /// Products with the Hessians of all images, where nothing was factorised.
    pub hessian_products: usize,
}

/// What the search for lower passes came to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SearchReport {
    /// How long was looked.
    pub effort: Effort,
    /// Climbs.
    pub searches: usize,
    /// How many of them, the last ones, brought no news.
    pub quiet: usize,
    /// Minima known in the end, images by symmetry counted.
    pub minima: usize,
    /// Saddles known in the end, images by symmetry counted.
    pub saddles: usize,
    /// By how much the barrier is lower than that of the best of the first paths (meV).
    pub lowered_by_mev: f64,
    /// The search ended because it had done as much work as it may.
    pub spent: bool,
    /// How high above the initial state, and above the final one, the lowest way known leads that leaves the path before its highest
    /// saddle for a state that is not on it (meV).
    pub lowest_exits_mev: [Option<f64>; 2],
    /// What k_BT of this temperature (K) does not hold apart counts there as one state: the lowest that rates were asked for at; where
    /// none were, nothing does.
    pub exits_from_k: Option<f64>,
}

/// What a run cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Work {
    /// Band iterations of the reported path.
    pub iterations: usize,
    /// Gradients of one image, everything counted.
    pub force_evaluations: usize,
    /// Wall time (s).
    pub seconds: f64,
    /// Threads used.
    pub threads: usize,
}
