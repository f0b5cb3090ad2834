//! Spin states as written in a config: `{"domain_wall": {"center": 39.5}}`.
//!
//! Every state may carry `"staggered": true`: every other site is then reversed, for antiferromagnets. One file a state.

mod domain_wall;
mod file;
mod random;
mod regions;
mod sense;
mod size;
mod skyrmion;
mod soliton;
mod spiral;
mod texture;
mod uniform;
mod vectors;
mod vortex;

pub use domain_wall::DomainWall;
pub use file::File;
pub use random::Random;
pub use regions::Regions;
pub use sense::Sense;
pub use skyrmion::Skyrmion;
pub use soliton::Soliton;
pub use spiral::Spiral;
pub use uniform::Uniform;
pub use vectors::Vectors;
pub use vortex::Vortex;

use crate::energy::Hamiltonian;
use crate::error::Result;
use crate::geometry::{Vector, vector};
use crate::lattice::Lattice;
use crate::registry::family;
use crate::spins::Spins;

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
    /// The sense that another state has taken; states that could take it too do.
    pub sense: Option<Sense>,
}

impl<'a> StateContext<'a> {
    /// Of a lattice whose energy is not known.
    pub fn new(lattice: &'a Lattice, wall_width_sites: f64) -> StateContext<'a> {
        StateContext { lattice, wall_width_sites, exchange_mev: 0.0, hamiltonian: None, sense: None }
    }

    /// Of these senses the one to take.
    fn sense_among(&self, open: &[Sense]) -> Option<Sense> {
        self.sense.filter(|sense| open.contains(sense)).or(open.first().copied())
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

    /// Whether there may be senses in which it does not exist, as a skyrmion of the wrong helicity, so that the others are left.
    fn may_miss_senses(&self) -> bool {
        false
    }
}

impl StateSpec {
    /// The spins: staggered if wished, frozen spins with a direction put in that direction.
    pub fn build(&self, context: &StateContext) -> Result<Spins> {
        self.spins(&StateContext { sense: self.sense(context)?, ..*context })
    }

    /// The sense that it takes where it has a choice: that of the context, or the cheapest.
    pub fn sense(&self, context: &StateContext) -> Result<Option<Sense>> {
        let open = self.member().senses(context);
        match (context.hamiltonian, context.sense) {
            (_, Some(taken)) if open.contains(&taken) => Ok(Some(taken)),
            (Some(h), _) if !open.is_empty() => {
                let state = |k: usize| self.spins(&StateContext { sense: Some(open[k]), ..*context });
                Ok(Some(open[sense::cheapest(h, open.len(), self.member().may_miss_senses(), state)?]))
            }
            _ => Ok(open.first().copied()),
        }
    }

    /// The spins in the context's sense.
    fn spins(&self, context: &StateContext) -> Result<Spins> {
        let mut vectors = self.arranged(context)?;
        for f in &context.lattice.frozen {
            if let Some(direction) = f.direction {
                f.sites.iter().for_each(|i| vectors[*i] = direction.vector());
            }
        }
        Spins::from_vectors(&vectors)
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
