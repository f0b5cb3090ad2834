//! What a run is given.

use super::{Scales, memory};
use crate::control::Control;
use crate::energy::{Evaluator, Hamiltonian};
use crate::error::{Error, Result};
use crate::landscape::Effort;
use crate::optimise::{Implicit, OptimiserSpec};
use crate::path::guess::{GuessSpec, NoiseSpec};
use crate::rates::RateSettings;
use crate::record::Fingerprint;
use crate::spins::Spins;
use crate::state::{Senses, StateContext};
use crate::words::{counted, number};

/// Two states of a lattice, and how to look for the path between them.
///
/// ```
/// use spinneb::drive::{Problem, Silent, run};
/// use spinneb::energy::{Anisotropy, Exchange, Hamiltonian};
/// use spinneb::{geometry::Direction, lattice::Chain, spins::Spins};
///
/// let chain = Chain::open(9).resolve()?;
/// let exchange = Exchange::uniform(&chain, &[10.0]); // meV
/// let easy_axis = Anisotropy::uniform(9, 0.5, Direction::Z); // meV
/// let hamiltonian = Hamiltonian::new(&chain, vec![Box::new(exchange), Box::new(easy_axis)])?;
/// let [up, down] = [Direction::Z, Direction::Z.reversed()].map(|d| Spins::uniform(9, d));
/// let mut problem = Problem::new(hamiltonian, up, down);
/// problem.neb.tolerance = 1e-8; // rad
/// # assert!(run(&problem, &mut Silent)?.certified);
/// # Ok::<(), spinneb::error::Error>(())
/// ```
#[derive(Debug)]
pub struct Problem {
    /// The energy of the spins, and where they are.
    pub hamiltonian: Hamiltonian,
    /// What counts and stops its evaluations.
    pub control: Control,
    /// Where the path starts.
    pub initial: Spins,
    /// Where it ends.
    pub final_state: Spins,
    /// The senses that states on the way take where they have a choice; the cheapest where there are none.
    pub senses: Senses,
    /// Relax both ends to minima first.
    pub relax_ends: bool,
    /// How many images.
    pub images: Images,
    /// The first path; all natural ones are tried if absent.
    pub guess: Option<GuessSpec>,
    /// Noise on an explicit guess.
    pub noise: Option<NoiseSpec>,
    /// Smoothing of an explicit guess, 0 to 1.
    pub smooth: Option<f64>,
    /// Refine the saddles to machine precision.
    pub refine: bool,
    /// Prove what kind of saddle each is, and where the descents from it lead.
    pub certify: bool,
    /// How long passes below the best of the first paths are looked for.
    pub search: Effort,
    /// How the band is relaxed.
    pub neb: NebSettings,
    /// Rates over the saddles; none if absent.
    pub rates: Option<RateSettings>,
    /// What the user should know before it is run: the last warnings of its outcome.
    pub warnings: Vec<String>,
    /// Wall time that it took to make (s), counted with that of its run.
    pub made_in_s: f64,
}

impl Problem {
    /// With everything but the physics at its default.
    pub fn new(hamiltonian: Hamiltonian, initial: Spins, final_state: Spins) -> Problem {
        let neb = NebSettings::default();
        Problem {
            hamiltonian,
            control: Control::default(),
            initial,
            final_state,
            senses: Senses::default(),
            relax_ends: true,
            images: Images::Auto,
            guess: None,
            noise: None,
            smooth: None,
            refine: true,
            certify: true,
            search: Effort::default(),
            neb,
            rates: None,
            warnings: Vec::new(),
            made_in_s: 0.0,
        }
    }
}

impl Problem {
    /// The energy, as counted and stopped.
    pub fn evaluator(&self) -> Evaluator<'_> {
        Evaluator::new(&self.hamiltonian, &self.control)
    }

    /// What states on the way need to know.
    pub fn states(&self, scales: &Scales) -> StateContext<'_> {
        StateContext { taken: Some(&self.senses), ..scales.states(&self.hamiltonian) }
    }

    /// An error where an end, the number of images, a setting or what is asked of rates is none that a run can have.
    pub(super) fn check(&self) -> Result<()> {
        let sites = self.hamiltonian.sites();
        of_so_many_sites(sites, "initial", &self.initial)?;
        of_so_many_sites(sites, "final_state", &self.final_state)?;
        if let Images::Count(n) = self.images {
            let bytes = memory::images_bytes(n, sites);
            let whose = memory::exceeded(bytes);
            if n < Images::LEAST || whose.is_some() {
                let more =
                    whose.map(|whose| format!(" (these need about {}, more than {whose})", memory::shown(bytes)));
                let message = format!(
                    "found {n}, but a path has 3 images or more, both ends counted, that memory holds{}",
                    more.unwrap_or_default()
                );
                return Err(Error::invalid("images", message));
            }
        }
        self.neb.check().map_err(|e| e.within("neb"))?;
        if let Some(smooth) = self.smooth {
            checked_smoothing(smooth).map_err(|message| Error::invalid("smooth", message))?;
        }
        if let Some(noise) = self.noise.filter(|noise| !noise.amplitude.0.is_finite()) {
            let message = format!("found {}, but an amplitude is a finite angle", number(noise.amplitude.0));
            return Err(Error::invalid("noise.amplitude", message));
        }
        check_rates(self.rates.as_ref(), sites)
    }

    /// What tells it from other problems: its energies, states and settings.
    pub(super) fn fingerprint(&self) -> Fingerprint {
        let h = &self.hamiltonian;
        let mut print = Fingerprint::default().real(h.reference_mev()).real(h.stiffness_mev());
        // between uniform ends there may be terms of which neither end has anything
        for spins in [&self.initial, &self.final_state, &Spins::random(h.sites(), 0)] {
            let mut gradient = vec![0.0; 3 * h.sites()];
            let energy = h.energy_gradient(spins.as_slice(), &mut gradient);
            print = print.real(energy).row(&gradient).row(spins.as_slice());
        }
        let Problem { relax_ends, images, guess, noise, smooth, refine, certify, search, neb, .. } = self;
        print.text(&format!(
            "{relax_ends} {images:?} {guess:?} {noise:?} {smooth:?} {refine} {certify} {search:?} {neb:?}"
        ))
    }

    /// Whether the maxima are followed to their saddles.
    pub fn seeks_saddles(&self) -> bool {
        self.refine || self.neb.climb
    }
}

/// An error where there are no rates of such settings for so many sites.
pub(super) fn check_rates(rates: Option<&RateSettings>, sites: usize) -> Result<()> {
    let Some(rates) = rates else { return Ok(()) };
    rates.check(sites).map_err(|e| e.within("rates"))?;
    match rates.theories.is_empty() {
        true => Err(Error::invalid("rates.theories", "found none: name a theory, or leave the rates out")),
        false => Ok(()),
    }
}

/// The strength of a smoothing, if it can be one.
pub fn checked_smoothing(x: f64) -> std::result::Result<f64, String> {
    match (0.0..=1.0).contains(&x) {
        true => Ok(x),
        false => Err(format!("found {}, but smoothing goes from 0 (none) to 1", number(x))),
    }
}

/// The tolerance of a band (rad), if it can be one.
pub fn checked_tolerance(x: f64) -> std::result::Result<f64, String> {
    match x.is_finite() && x > 0.0 {
        true => Ok(x),
        false => Err(format!("found {}, but a tolerance (rad) is greater than 0, such as 1e-6", number(x))),
    }
}

/// The most evaluations of a band, if there can be so many.
pub fn checked_evaluations(n: usize) -> std::result::Result<usize, String> {
    match n {
        0 => Err("found 0, but at least 1 evaluation is needed".into()),
        n => Ok(n),
    }
}

/// An error where a state is of another lattice.
pub(super) fn of_so_many_sites(sites: usize, place: &str, spins: &Spins) -> Result<()> {
    match spins.sites() {
        n if n == sites => Ok(()),
        n => {
            let [found, sites] = [counted(n, "spin", "spins"), counted(sites, "site", "sites")];
            Err(Error::invalid(place, format!("found {found}, but the lattice has {sites}")))
        }
    }
}

/// Number of images of a path, both ends counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Images {
    /// As many as the path needs: neighbours at most 1 rad a spin apart.
    Auto,
    /// Just so many.
    Count(usize),
}

impl Images {
    /// Fewest images of a path: its two ends, and one between.
    pub const LEAST: usize = 3;

    /// The number, if one was asked for.
    pub fn asked_for(self) -> Option<usize> {
        match self {
            Images::Auto => None,
            Images::Count(n) => Some(n),
        }
    }
}

/// How a band is relaxed.
#[derive(Clone, Debug, PartialEq)]
pub struct NebSettings {
    /// Let the maxima climb to their saddles and stand in the path as images.
    pub climb: bool,
    /// Largest predicted remaining rotation of any spin (rad).
    pub tolerance: f64,
    /// Most evaluations of the whole band.
    pub max_evaluations: usize,
    /// The method.
    pub optimiser: OptimiserSpec,
}

impl NebSettings {
    /// An error where no band can be relaxed so.
    fn check(&self) -> Result<()> {
        checked_tolerance(self.tolerance).map_err(|message| Error::invalid("tolerance", message))?;
        checked_evaluations(self.max_evaluations).map_err(|message| Error::invalid("max_evaluations", message))?;
        Ok(())
    }
}

impl Default for NebSettings {
    fn default() -> Self {
        NebSettings {
            climb: true,
            tolerance: 1e-6,
            max_evaluations: 20_000,
            optimiser: OptimiserSpec::Implicit(Implicit {}),
        }
    }
}
