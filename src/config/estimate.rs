//! What a run will take, before it runs.
//!
//! ```text
//! gradients = (1 + d)(15 images + 220 + 60 saddles) + 600        time = gradients × 2.5 (one gradient with its factorised Hessian) + figures
//! ```
//! A band converges in about 15 gradients of each image, whatever its length (8 to 26 in the shipped configs), and finding the seat of
//! a saddle, its proof and the descents to its two minima take about 280, of one beside another 60. An automatic path is refined once. One saddle is taken for
//! granted, but a chain's wall narrower than `PINNED` sites rests on every site that it passes: there are as many saddles, and four images
//! to each. The search for lower passes takes some
//! 600, and as much as the path for each of the d domains that its ends consist of, through which it may lead; 0 for both where there
//! is none. The gradient is measured; eigenvalues and proofs are in the factor 2.5, and figures take what the constants say on a usual
//! machine. Where factors are very dear few are made, and a gradient goes with solutions by iteration. With these the shipped configs
//! take what is said within a factor of 3 (`cargo bench --bench estimate`); paths through many minima, and ends that are far from their
//! minima, take longer.

use super::{Loaded, expected_images};
use crate::drive::{Images, Problem, Scales, third_states};
use crate::hessian::{TangentBasis, assemble_into};
use crate::landscape::Effort;
use crate::linalg::Matrix;
use crate::path::guess::moving_sites;
use crate::stationary::is_very_dear;
use std::time::Instant;

/// Gradients of each image until the band has converged.
const A_IMAGE: usize = 14;
/// Gradients for a saddle, and for one beside another: images by symmetry and short stretches cost little.
const A_SADDLE: usize = 270;
const ANOTHER: usize = 60;
/// Gradients for the search below a path: some 24 to 40 climbs.
const A_SEARCH: usize = 600;
/// A wall of less than this many sites has a saddle between any two sites: its energy varies as exp(−π²δ) from one to the next.
const PINNED: f64 = 2.0;
/// Images to each of them.
const IMAGES_A_SADDLE: usize = 4;
/// What a gradient of a run takes beside itself, as a factor.
const PROOFS: f64 = 2.5;
/// Where factors are very dear, so many are made, each by all threads, and a gradient takes the time of so many solutions by them.
const FACTORS: f64 = 16.0;
const SOLUTIONS: f64 = 16.0;
/// Gradients with Hessians, in whose time an image moves where nothing is factorised.
const ITERATIONS: f64 = 10.0;
/// Figures as pixels and as vectors, and what each image adds to either (s).
const PIXELS_S: f64 = 0.2;
const VECTORS_S: f64 = 0.03;
const AN_IMAGE_S: f64 = 5e-4;
/// A gradient is measured for so long (s), and at most so often.
const MEASURED_S: f64 = 0.05;
const MOST: usize = 20;

/// What a run will take, roughly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Images of the path in the end.
    pub images: usize,
    /// Saddles on the way.
    pub saddles: usize,
    /// Gradients of one image, everything counted.
    pub evaluations: usize,
}

impl Estimate {
    /// Of a problem.
    pub fn of(problem: &Problem, scales: &Scales) -> Estimate {
        let start = expected_images(problem, scales);
        let moving = moving_sites(&problem.initial, &problem.final_state, problem.hamiltonian.lattice());
        let rests = problem.hamiltonian.lattice().is_row() && scales.wall_width_sites < PINNED;
        let saddles = if rests { moving.max(1) } else { 1 };
        let images = match problem.images {
            Images::Count(n) => n,
            Images::Auto => (2 * start - 1).max(IMAGES_A_SADDLE * saddles),
        };
        let saddles = saddles.min(images / 2).max(1);
        let path = A_IMAGE * images + A_SADDLE + ANOTHER * (saddles - 1);
        let evaluations = match problem.search {
            Effort::None => path,
            _ => {
                path * (1 + third_states(&problem.hamiltonian, [&problem.initial, &problem.final_state]).len())
                    + A_SEARCH
            }
        };
        Estimate { images, saddles, evaluations }
    }

    /// Time of one processor (s); the threads share all of it but the figures.
    pub fn processor_seconds(&self, loaded: &Loaded, problem: &Problem, scales: &Scales) -> f64 {
        let plots = &loaded.config.output.plots;
        let images = AN_IMAGE_S * self.images as f64;
        let figures = |name: &str, own: f64| if plots.iter().any(|plot| plot == name) { own + images } else { 0.0 };
        let drawn = figures("png", PIXELS_S) + figures("svg", VECTORS_S);
        let (h, gradient) = (&problem.hamiltonian, gradient_seconds(problem, scales));
        let evaluations = self.evaluations as f64;
        drawn
            + if h.forgoes_factors() {
                gradient * ITERATIONS * evaluations
            } else if is_very_dear(h) {
                let factors = FACTORS * rayon::current_num_threads() as f64;
                gradient * (factors + SOLUTIONS * evaluations / h.solutions_a_factor())
            } else {
                gradient * PROOFS * evaluations
            }
    }
}

/// Time of a gradient with its factorised Hessian (s): the shortest of several, since other programs only make it longer.
fn gradient_seconds(problem: &Problem, scales: &Scales) -> f64 {
    let (h, m) = (&problem.hamiltonian, problem.initial.as_slice());
    let mut g = vec![0.0; m.len()];
    let basis = TangentBasis::at(m);
    let mut matrix = Matrix::default();
    let (begin, mut shortest) = (Instant::now(), f64::INFINITY);
    for _ in 0..MOST {
        let start = Instant::now();
        let _ = h.energy_gradient(m, &mut g);
        assemble_into(h, m, &g, &basis, scales.stiffness_mev, &mut matrix);
        if !h.forgoes_factors() {
            matrix = std::mem::take(&mut matrix).factor().into_memory();
        }
        shortest = shortest.min(start.elapsed().as_secs_f64());
        if begin.elapsed().as_secs_f64() > MEASURED_S {
            break;
        }
    }
    shortest
}
