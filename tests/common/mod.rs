//! Chains in the reference's units: J = 1 meV, spins of the reference's energy.
#![allow(dead_code)]

pub mod shipped;

use spinneb::drive::{Outcome, Problem, Silent, run};
use spinneb::energy::{Anisotropy, Dmi, EnergyTerm, Exchange, Hamiltonian, Zeeman};
use spinneb::geometry::Direction;
use spinneb::lattice::{Chain, Frozen, Lattice, Selection};
use spinneb::spins::Spins;
use spinneb::state::{DomainWall, StateContext, StateSpec};

/// A chain with J = 1 meV bonds and what else is put on it.
pub struct Build {
    pub lattice: Lattice,
    pub terms: Vec<Box<dyn EnergyTerm>>,
}

impl Build {
    pub fn open(sites: usize) -> Build {
        Build::on(Chain::open(sites))
    }

    pub fn ring(sites: usize) -> Build {
        Build::on(Chain::ring(sites))
    }

    pub fn on(chain: Chain) -> Build {
        let lattice = chain.resolve().expect("a valid chain");
        let exchange: Box<dyn EnergyTerm> = Box::new(Exchange::uniform(&lattice, &[1.0]));
        Build { terms: vec![exchange], lattice }
    }

    /// `sites` free sites between a frozen +z on the left (site 0) and a frozen −z on the right.
    pub fn between_walls(sites: usize) -> Build {
        let frozen = |site, direction| Frozen { sites: Selection::List(vec![site]), direction: Some(direction) };
        let frozen = vec![frozen(0, Direction::Z), frozen(sites + 1, Direction::Z.reversed())];
        Build::on(Chain { frozen, ..Chain::open(sites + 2) })
    }

    pub fn with(mut self, term: impl EnergyTerm + 'static) -> Build {
        self.terms.push(Box::new(term));
        self
    }

    pub fn easy(self, k: f64) -> Build {
        let n = self.lattice.sites;
        self.with(Anisotropy::uniform(n, k, Direction::Z))
    }

    pub fn hard(self, k: f64) -> Build {
        let n = self.lattice.sites;
        self.with(Anisotropy::uniform(n, -k, Direction::X))
    }

    pub fn field(self, b: [f64; 3]) -> Build {
        let n = self.lattice.sites;
        self.with(Zeeman::uniform(n, b))
    }

    pub fn dmi(self, d: f64, direction: Direction) -> Build {
        let term = Dmi::uniform(&self.lattice, d, direction);
        self.with(term)
    }

    /// Adds K on one site.
    pub fn defect(self, site: usize, k: f64) -> Build {
        let mut term = Anisotropy::uniform(self.lattice.sites, 0.0, Direction::Z);
        term.k[site] = k;
        self.with(term)
    }

    pub fn problem(self, initial: Spins, final_state: Spins) -> Problem {
        let h = Hamiltonian::new(&self.lattice, self.terms).expect("a valid chain");
        Problem::new(h, initial, final_state)
    }

    /// All up to all down.
    pub fn reversal(self) -> Problem {
        let n = self.lattice.sites;
        self.problem(Spins::uniform(n, Direction::Z), Spins::uniform(n, Direction::Z.reversed()))
    }

    /// A wall from +z (left) to −z, moved; through x or another direction.
    pub fn wall(&self, center: f64, width: f64, through: Direction) -> Spins {
        let wall = DomainWall {
            center: center.into(),
            width: Some(width.into()),
            normal: None,
            left: None,
            right: None,
            through: Some(through),
            staggered: false,
        };
        let context = StateContext::new(&self.lattice, width);
        StateSpec::DomainWall(wall).build(&context).expect("a wall")
    }
}

pub fn solve(problem: &Problem) -> Outcome {
    run(problem, &mut Silent).expect("a run")
}

pub fn forward(outcome: &Outcome) -> f64 {
    outcome.barrier.expect("a barrier").forward_mev
}

/// The reference file.
pub fn cases() -> serde_json::Value {
    serde_json::from_str(include_str!("../reference/cases.json")).expect("the reference file")
}

pub fn number(v: &serde_json::Value, key: &str) -> f64 {
    v[key].as_f64().unwrap_or_else(|| panic!("no number {key} in {v}"))
}
