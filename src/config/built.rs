//! From a config to the problem that the drive is given, with every check on the way.

use super::{Loaded, Name, RatesConfig, Text, memory, physics};
use crate::drive::{FEWEST_IMAGES, Images, Problem, Scales};
use crate::energy::{Custom, CustomEnergy, EnergyTerm, Hamiltonian, Medium, Part, TermSpec, symmetry_axes};
use crate::error::{Error, Result, both};
use crate::field::{Components, ComponentsMut};
use crate::geometry::{Direction, angle};
use crate::lattice::Lattice;
use crate::linalg::slab;
use crate::path::guess::{GuessContext, moving_sites};
use crate::path::largest_angle;
use crate::rates::RateSettings;
use crate::sphere::{IDENTICAL, SAME};
use crate::spins::Spins;
use crate::state::{Senses, StateContext, StateSpec};
use crate::stationary::is_very_dear;
use crate::words::quoted;
use std::sync::Arc;
use std::time::Instant;

/// Largest torque on a site (meV) that is taken for meant: 1e20 meV is 16 mJ.
const LARGEST_MEV: f64 = 1e20;

/// The energy of a lattice's spins and two states of these, as a config has them.
#[derive(Debug)]
pub struct States {
    /// The energy.
    pub hamiltonian: Hamiltonian,
    /// Its scales, before any state is relaxed.
    pub scales: Scales,
    /// The initial state.
    pub initial: Spins,
    /// The final state, where it was wanted.
    pub final_state: Option<Spins>,
    /// The senses that the parts of the initial state have taken, where they had a choice.
    pub senses: Senses,
}

impl Loaded {
    /// With terms of the program's own beside those of the config, whose `custom_terms` are to name them.
    pub fn with_terms(self, custom: Vec<Arc<dyn CustomEnergy>>) -> Loaded {
        Loaded { custom, ..self }
    }

    /// The problem that the config states; an error, with its place, where something cannot be.
    pub fn problem(&self) -> Result<Problem> {
        let config = &self.config;
        let here = |e: Error| self.text.locate(e);
        let started = Instant::now();
        // before the plan of factors is made, which takes long where these are refused
        let least = config.path.images.0.asked_for().unwrap_or(FEWEST_IMAGES);
        self.affordable(memory::images_bytes(least, self.lattice.sites), Some(least))?;
        let States { hamiltonian, scales, initial, final_state, senses } = self.states(true)?;
        let final_state = final_state.unwrap_or_else(|| initial.clone());
        if largest_angle(initial.as_slice(), final_state.as_slice()) < IDENTICAL {
            let message = "the initial and the final state are identical: there is no path between them";
            return Err(here(Error::invalid("final", message)));
        }
        let mut problem = Problem::new(hamiltonian, initial, final_state);
        problem.senses = senses;
        problem.relax_ends = config.relax_ends;
        problem.images = config.path.images.0;
        problem.guess = config.path.guess.clone();
        problem.noise = config.path.noise;
        problem.smooth = config.path.smooth;
        problem.refine = config.saddle.refine;
        problem.certify = config.saddle.certify;
        problem.search = config.effort().map_err(here)?;
        problem.neb = config.neb.settings();
        problem.rates = self.rates(problem.hamiltonian.lattice(), config.rates.as_ref())?;
        forgo_factors(&mut problem, &scales);
        self.affordable(needed_bytes(&problem, &scales), Some(expected_images(&problem, &scales)))?;
        guess(&problem, &scales).map_err(here)?;
        let of_physics = physics::warnings(self, &problem.hamiltonian, &scales);
        let of_memory = std::mem::take(&mut problem.warnings);
        problem.warnings = self.warnings.iter().cloned().chain(of_physics).chain(of_memory).collect();
        problem.made_in_s = started.elapsed().as_secs_f64();
        Ok(problem)
    }

    /// The energy and the states, the final one if it is wanted, with the same checks.
    pub fn states(&self, with_final: bool) -> Result<States> {
        let config = &self.config;
        let here = |e: Error| self.text.locate(e);
        self.look()?;
        let specs = self.specs();
        self.affordable(memory::hamiltonian_bytes(self.lattice.sites, 1, specs.len()), None)?;
        let part = self.part_of_sites()?;
        let lattice = self.with_moments(&part)?;
        let terms = self.terms(&lattice, self.divided(&lattice, &part)?, specs)?;
        let idle = idle_direction(&terms, lattice.sites);
        let hamiltonian = Hamiltonian::new(&lattice.with_vacancies_frozen(idle), terms).map_err(here)?;
        let scales = Scales::of_terms(&hamiltonian);
        let free = scales.states(&hamiltonian);
        let within = |spec: &StateSpec, key: &str, e: Error| here(e.within(&format!("{key}.{}", spec.name())));
        let initial = config.initial.build_with_senses(&free).map_err(|e| within(&config.initial, "initial", e));
        let taken = initial.as_ref().ok().map(|(_, senses)| senses);
        let final_state = with_final.then(|| {
            let context = StateContext { taken, ..free };
            config.final_state.build(&context).map_err(|e| within(&config.final_state, "final", e))
        });
        let final_state = final_state.transpose();
        let ((initial, senses), final_state) = both(initial, final_state)?;
        let final_state =
            final_state.map(|state| frozen(hamiltonian.lattice(), &initial, state).map_err(here)).transpose()?;
        Ok(States { hamiltonian, scales, initial, final_state, senses })
    }

    /// The problem whose ends are both the initial state, with further states beside it (the final one among them) and the rates that
    /// are asked for.
    pub(super) fn seeded_problem(
        &self,
        others: &[StateSpec],
        rates: Option<&RatesConfig>,
    ) -> Result<(Problem, Vec<Spins>, Option<RateSettings>)> {
        let States { hamiltonian, scales, initial, final_state, senses } = self.states(true)?;
        let context = StateContext { taken: Some(&senses), ..scales.states(&hamiltonian) };
        let mut seeds: Vec<Spins> = final_state.into_iter().collect();
        for (k, spec) in others.iter().enumerate() {
            let here = |e: Error| self.text.locate(e.within(&format!("landscape.states[{k}].{}", spec.name())));
            let state = spec.build(&context).map_err(here)?;
            seeds.push(frozen(hamiltonian.lattice(), &initial, state).map_err(|e| self.text.locate(e))?);
        }
        let rates = self.rates(hamiltonian.lattice(), rates)?;
        let mut problem = Problem::new(hamiltonian, initial.clone(), initial);
        problem.senses = senses;
        problem.neb = self.config.neb.settings();
        problem.warnings = self.warnings.clone();
        forgo_factors(&mut problem, &scales);
        self.affordable(needed_bytes(&problem, &scales), None)?;
        Ok((problem, seeds, rates))
    }

    /// What rates are asked for, with the moments of the sites.
    fn rates(&self, lattice: &Lattice, config: Option<&RatesConfig>) -> Result<Option<RateSettings>> {
        let Some(config) = config else { return Ok(None) };
        let none = |e: Error| match e {
            Error::Invalid { .. } => Error::invalid(
                "rates",
                "a rate needs the moments of the sites, which say how fast they precess: give the material a \"moment\" \
                 (\"2 mu_B\") or \"Ms\" (\"800 kA/m\", with the lattice's \"spacing\" and \"cross_section\")",
            ),
            other => other,
        };
        let moments = self.medium(lattice).moments_mub().map_err(|e| self.text.locate(none(e)))?;
        if let Some(i) = moments.iter().position(|n| *n <= 0.0) {
            let message = format!("the moment of site {i} is 0, so it has no precession: a rate needs moments above 0");
            return Err(self.text.locate(Error::invalid("rates", message)));
        }
        Ok(Some(config.settings(moments)))
    }

    /// Moments of all sites (μ_B), where the material has any.
    pub(super) fn moments_mub(&self) -> Option<Vec<f64>> {
        let lattice = self.with_moments(&self.part_of_sites().ok()?).ok()?;
        self.medium(&lattice).moments_mub().ok()
    }

    /// What a lattice is made of; where there are several materials, the lattice itself has their moments.
    fn medium<'a>(&self, lattice: &'a Lattice) -> Medium<'a> {
        match &self.parts[..] {
            [one] => Medium::new(lattice, one.material.moment.clone(), one.material.Ms.clone()),
            _ => Medium::new(lattice, None, None),
        }
    }

    /// All term specs: those of the materials, then the config's. The field of the moments is that of all, so it is taken once.
    fn specs(&self) -> Vec<Written<'_>> {
        let mut all: Vec<Written> = Vec::new();
        for (part, own) in self.parts.iter().enumerate() {
            let list = if own.text.is_some() { "energy".into() } else { format!("{}.energy", own.key) };
            for (k, spec) in own.material.energy.iter().enumerate() {
                let of_all = matches!(spec, TermSpec::Demag(_) | TermSpec::Dipolar(_));
                if part > 0 && of_all && all.iter().any(|w| w.spec == spec && w.part != Some(part)) {
                    continue;
                }
                let (text, part) = (own.text.as_ref().unwrap_or(&self.text), Some(part));
                all.push(Written { spec, part, text, place: format!("{list}[{k}].{}", spec.name()) });
            }
        }
        for (k, spec) in self.config.energy.iter().enumerate() {
            all.push(Written { spec, part: None, text: &self.text, place: format!("energy[{k}].{}", spec.name()) });
        }
        all
    }

    /// The materials' terms and the config's, with numbers a site.
    fn terms(&self, lattice: &Lattice, parts: Vec<Part>, specs: Vec<Written>) -> Result<Vec<Box<dyn EnergyTerm>>> {
        let whole = self.medium(lattice);
        let media: Vec<Medium> = parts.into_iter().map(|part| Medium { part: Some(part), ..whole.clone() }).collect();
        let (mut terms, mut wrong) = (Vec::new(), Vec::new());
        let mut largest = 0.0f64;
        for Written { spec, part, text, place } in specs {
            let medium = part.and_then(|k| media.get(k)).unwrap_or(&whole);
            let built = spec.member().build(medium).and_then(|term| {
                largest = largest.max(torque(term.as_ref(), lattice.sites)?);
                Ok(term)
            });
            match built {
                Ok(term) => terms.push(term),
                Err(e) => wrong.push(text.locate(e.within(&place))),
            }
        }
        for (k, name) in self.config.custom_terms.iter().enumerate() {
            let built = self.custom_term(lattice, name).and_then(|term| {
                largest = largest.max(torque(&term, lattice.sites)?);
                Ok(term)
            });
            match built {
                Ok(term) => terms.push(Box::new(term) as Box<dyn EnergyTerm>),
                Err(e) => wrong.push(self.text.locate(e.within(&format!("custom_terms[{k}]")))),
            }
        }
        let named =
            |term: &Arc<dyn CustomEnergy>| self.config.custom_terms.iter().any(|name| name.as_str() == term.name());
        if let Some(unnamed) = self.custom.iter().find(|term| !named(term)) {
            let message = format!("it does not name {}, which the program gives", quoted(unnamed.name()));
            wrong.push(self.text.locate(Error::invalid("custom_terms", message)));
        }
        if !wrong.is_empty() {
            return Err(Error::several(wrong));
        }
        let nothing = match terms.is_empty() {
            true => {
                "there is no energy term, neither of the material nor here: without energy there is no path to find"
            }
            false if largest == 0.0 => "all energies are zero: without energy there is no path to find",
            false => return Ok(terms),
        };
        Err(self
            .text
            .locate(Error::invalid(if self.config.energy.is_empty() { "material" } else { "energy" }, nothing)))
    }

    fn custom_term(&self, lattice: &Lattice, name: &Name) -> Result<Custom> {
        let taken = TermSpec::ENTRIES.iter().any(|entry| entry.name == name.as_str()) || name.as_str() == "energy";
        let own = self.custom.iter().find(|term| term.name() == name.as_str());
        match own {
            _ if taken => {
                let message =
                    format!("{} is the name of something else in tables: give it another", quoted(name.as_str()));
                Err(Error::invalid("", message))
            }
            Some(own) => Custom::new(lattice, own.clone()),
            None => {
                let message = format!(
                    "{} is a term of the program that wrote this config, which alone can run it (in Python, a `Term` of the system)",
                    quoted(name.as_str())
                );
                Err(Error::invalid("", message))
            }
        }
    }

    /// Refuses what no memory can hold; `images` are the path's, where it has come to them.
    fn affordable(&self, bytes: f64, images: Option<usize>) -> Result<()> {
        let whose = images.map(|n| (n, self.config.path.images.0 == Images::Auto));
        memory::affordable(bytes, self.lattice.sites, &self.config.lattice.extent(), whose)
            .map_err(|e| self.text.locate(e))
    }
}

/// A term's spec, with the material that it is of and the place where it stands.
struct Written<'a> {
    spec: &'a TermSpec,
    part: Option<usize>,
    text: &'a Text,
    place: String,
}

/// Images that the path of a problem will have, or start with where their number is found on the way.
pub fn expected_images(problem: &Problem, scales: &Scales) -> usize {
    match problem.images {
        Images::Count(n) => n,
        Images::Auto => {
            let lattice = problem.hamiltonian.lattice();
            let moving = moving_sites(&problem.initial, &problem.final_state, lattice);
            FEWEST_IMAGES.max(scales.images_between(lattice, moving) + 2)
        }
    }
}

/// Memory that a run needs (bytes), roughly.
pub fn needed_bytes(problem: &Problem, scales: &Scales) -> f64 {
    let h = &problem.hamiltonian;
    let far = h.coupling().pairs().map_or(0.0, |_| {
        let state = h.coupling().tail().map(|e| e.cost());
        memory::far_bytes(h.sites(), state, rayon::current_num_threads())
    });
    let bonds = h.constant_blocks().bond.len();
    let images = expected_images(problem, scales);
    far + memory::hamiltonian_bytes(h.sites(), bonds, h.terms().len())
        + memory::band_bytes(images, h.sites(), h.layout(), factors_at_a_time(h), rayon::current_num_threads())
}

/// Factors of blocks whose memory is held at a time: where they are very dear one is made after the other, in the memory of one that was
/// made before, beside that of a search.
fn factors_at_a_time(h: &Hamiltonian) -> usize {
    match (h.forgoes_factors(), is_very_dear(h)) {
        (true, _) => 0,
        (false, true) => 3,
        (false, false) => 2 * rayon::current_num_threads(),
    }
}

/// Where no memory would hold factors they are done without; what is to be said of it.
fn forgo_factors(problem: &mut Problem, scales: &Scales) {
    let Some(whose) = memory::exceeded(needed_bytes(problem, scales)) else { return };
    problem.hamiltonian.forgo_factors();
    if problem.hamiltonian.forgoes_factors() {
        problem.warnings.push(format!(
            "factors of its Hessians need more memory than {whose}: equations are solved by iteration, negative directions are bounded, not \
             counted, and there are no prefactors"
        ));
    }
}

/// Largest derivative of a term by a component (meV) in a state of no order; an error where it is absurd.
fn torque(term: &dyn EnergyTerm, sites: usize) -> Result<f64> {
    let state = Spins::random(sites, 1);
    let m = state.as_slice();
    let mut g = vec![0.0; 3 * sites];
    let mut density = vec![0.0; sites];
    term.add_gradient(Components::new(m), ComponentsMut::new(&mut g), &mut density, 0..sites);
    let largest = slab::max_abs(&g);
    let finite = term.reference_mev().is_finite() && density.iter().chain(&g).all(|x| x.is_finite());
    match finite && largest <= LARGEST_MEV {
        true => Ok(largest),
        false => {
            let size =
                if finite { format!("about {largest:.0e} meV") } else { "more than can be computed with".into() };
            let message =
                format!("the energy of a site is {size}: is a quantity, or the lattice's cell, absurdly large?");
            Err(Error::invalid("", message))
        }
    }
}

/// Where the idle spins of vacant sites point: along the axis of symmetry, if there is one, which they must not break.
fn idle_direction(terms: &[Box<dyn EnergyTerm>], sites: usize) -> Direction {
    let axis = symmetry_axes(terms, sites).into_iter().last();
    axis.and_then(|axis| Direction::new(axis).ok()).unwrap_or(Direction::Z)
}

/// The final state with frozen spins just where the initial state has them; an error where it has them elsewhere.
fn frozen(lattice: &Lattice, initial: &Spins, final_state: Spins) -> Result<Spins> {
    if lattice.frozen.is_empty() {
        return Ok(final_state);
    }
    let (n, from) = (lattice.sites, initial.as_slice());
    let mut m = final_state.as_slice().to_vec();
    for (k, i) in lattice.frozen.iter().enumerate().flat_map(|(k, f)| f.sites.iter().map(move |i| (k, *i))) {
        let apart = angle(initial.get(i), final_state.get(i));
        if apart > SAME {
            let message = format!(
                "site {i} is frozen, but the final state has it {:.3} degrees away from where the initial state has it: give \
                 it a \"direction\" or make the two states agree there",
                apart.to_degrees()
            );
            return Err(Error::invalid(format!("lattice.{}.frozen[{k}]", lattice.kind), message));
        }
        for c in 0..3 {
            m[c * n + i] = from[c * n + i];
        }
    }
    Ok(Spins::from_unit_components(&m))
}

/// Whether the first path can be made; noise and smoothing need one that is named.
fn guess(problem: &Problem, scales: &Scales) -> Result<()> {
    let Some(guess) = &problem.guess else {
        let act_on = |key: &str| {
            let message = "acts on a guess that is named: add a \"guess\", such as {\"geodesic\": {}}";
            Err(Error::invalid(format!("path.{key}"), message))
        };
        return match (&problem.noise, problem.smooth) {
            (Some(_), _) => act_on("noise"),
            (_, Some(_)) => act_on("smooth"),
            _ => Ok(()),
        };
    };
    let context = GuessContext { states: problem.states(scales), default_axis: Direction::X };
    let images = match problem.images {
        Images::Count(n) => n.min(5),
        Images::Auto => 5,
    };
    let made = guess.member().path(&problem.initial, &problem.final_state, images, &context);
    made.map(|_| ()).map_err(|e| e.within(&format!("path.guess.{}", guess.name())))
}

#[cfg(test)]
mod tests;
