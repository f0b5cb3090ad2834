//! Spin states as written in a config: `{"domain_wall": {"center": 39.5}}`.
//!
//! Every state may carry `"staggered": true`: every other site is then reversed, for antiferromagnets. One file a state.

mod domain_wall;
mod file;
mod parts;
mod random;
mod regions;
mod sense;
mod size;
mod skyrmion;
mod soliton;
mod spiral;
mod surroundings;
mod texture;
mod uniform;
mod vectors;
mod vortex;

pub use domain_wall::DomainWall;
pub use file::File;
pub use random::Random;
pub use regions::Regions;
pub use sense::{Sense, Senses};
pub use skyrmion::Skyrmion;
pub use soliton::Soliton;
pub use spiral::Spiral;
pub use surroundings::Surroundings;
pub use uniform::Uniform;
pub use vectors::Vectors;
pub use vortex::Vortex;

use crate::energy::Hamiltonian;
use crate::error::Result;
use crate::geometry::{Vector, vector};
use crate::lattice::Lattice;
use crate::linalg::slab;
use crate::registry::family;
use crate::spins::Spins;
use parts::Part;

family! {
    /// A state as written in a config.
    StateSpec as StateBuilder {
        Uniform(Uniform),
        DomainWall(DomainWall),
        Soliton(Soliton),
        Skyrmion(Skyrmion),
        Vortex(Vortex),
        Spiral(Spiral),
        Random(Random),
        Vectors(Vectors),
        File(File),
        Regions(Regions),
    }
}

/// What a state needs to know to become spins.
#[derive(Clone, Copy, Debug)]
pub struct StateContext<'a> {
    /// Where the spins are.
    pub lattice: &'a Lattice,
    /// Width δ of a domain wall in sites, for walls without a width of their own.
    pub wall_width_sites: f64,
    /// Exchange a bond (meV), without sign, for solitons without a width of their own; 0 where it is not known.
    pub exchange_mev: f64,
    /// The energy, for which a state that is free to turn this way or that takes the cheapest one. Without an energy it takes the
    /// first: a wall between opposite domains passes through +u, see [`Sense`].
    pub hamiltonian: Option<&'a Hamiltonian>,
    /// The sense to build a state in that has a choice.
    pub sense: Option<Sense>,
    /// The senses that another state has taken; parts of states that are there in them too take them.
    pub taken: Option<&'a Senses>,
    /// Where a part of a state stands; a state without parts has the whole lattice.
    pub around: Option<&'a Surroundings>,
}

impl<'a> StateContext<'a> {
    /// Of a lattice whose energy is not known.
    pub fn new(lattice: &'a Lattice, wall_width_sites: f64) -> StateContext<'a> {
        StateContext {
            lattice,
            wall_width_sites,
            exchange_mev: 0.0,
            hamiltonian: None,
            sense: None,
            taken: None,
            around: None,
        }
    }

    /// Of these senses the one to take.
    fn sense_among(&self, open: &[Sense]) -> Option<Sense> {
        self.sense.filter(|sense| open.contains(sense)).or(open.first().copied())
    }

    /// Whether a site is one of the state's own.
    fn is_own(&self, i: usize) -> bool {
        self.around.is_none_or(|around| around.is_own(i))
    }

    /// What a state's own sites are all of, in words.
    fn place(&self) -> &'static str {
        if self.around.is_some() { "its region" } else { "the lattice" }
    }

    /// The energy (meV) by which a state that stands here is judged, but for a constant.
    fn energy_mev(&self, h: &Hamiltonian, vectors: Vec<Vector>) -> f64 {
        match self.around {
            None => h.energy_mev(Spins::from_unit_vectors(&vectors).as_slice()),
            Some(around) => {
                let all = Spins::from_unit_vectors(&around.surrounded(vectors));
                slab::sum(&around.counted(h.density(all.as_slice())))
            }
        }
    }

    /// Spins, the frozen ones with a direction put in that direction.
    fn spins(&self, mut vectors: Vec<Vector>) -> Result<Spins> {
        for f in &self.lattice.frozen {
            if let Some(direction) = f.direction {
                f.sites.iter().for_each(|i| vectors[*i] = direction.vector());
            }
        }
        Spins::from_vectors(&vectors)
    }
}

/// A state's config that becomes spins.
pub trait StateBuilder {
    /// One vector a site (not yet staggered), of unit length to rounding.
    fn vectors(&self, context: &StateContext) -> Result<Vec<Vector>>;

    /// Whether odd sites are reversed.
    fn staggered(&self) -> bool;

    /// The senses that are open to it, the one to take without an energy first; none where it has no choice.
    fn senses(&self, _: &StateContext) -> Vec<Sense> {
        Vec::new()
    }

    /// Whether the energy chooses its size, so that this depends on what is around it.
    fn is_sized_by_energy(&self) -> bool {
        false
    }

    /// Whether there may be senses in which it does not exist, as a skyrmion of the wrong helicity, so that the others are left.
    fn may_miss_senses(&self) -> bool {
        false
    }
}

impl StateSpec {
    /// The spins: staggered if wished, frozen spins with a direction put in that direction.
    pub fn build(&self, context: &StateContext) -> Result<Spins> {
        Ok(self.build_with_senses(context)?.0)
    }

    /// The spins, and the senses that those parts have taken which had a choice.
    pub fn build_with_senses(&self, context: &StateContext) -> Result<(Spins, Senses)> {
        let (vectors, senses) = parts::settled(self.parts(context)?, context)?;
        Ok((context.spins(vectors)?, senses))
    }

    /// Its parts: states by region, or itself.
    fn parts(&self, context: &StateContext) -> Result<Vec<Part<'_>>> {
        match self {
            StateSpec::Regions(regions) => regions.parts(context),
            whole => Ok(vec![Part::whole(whole, context.lattice)]),
        }
    }

    /// One vector a site in the context's sense, staggered if wished, frozen or not.
    fn arranged(&self, context: &StateContext) -> Result<Vec<Vector>> {
        let member = self.member();
        let mut vectors = member.vectors(context)?;
        if member.staggered() {
            for (_, v) in vectors.iter_mut().enumerate().filter(|(i, _)| context.lattice.is_odd(*i)) {
                *v = vector::scale(-1.0, *v);
            }
        }
        Ok(vectors)
    }
}
