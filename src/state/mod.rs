//! Spin states as written in a config: `{"domain_wall": {"center": 39.5}}`.
//!
//! Every state may carry `"staggered": true`: site i is then multiplied by (−1)^i, for antiferromagnets. One file a state.

mod domain_wall;
mod file;
mod random;
mod spiral;
mod uniform;
mod vectors;

pub use domain_wall::DomainWall;
pub use file::File;
pub use random::Random;
pub use spiral::Spiral;
pub use uniform::Uniform;
pub use vectors::Vectors;

use crate::error::Result;
use crate::geometry::{Vector, vector};
use crate::lattice::Chain;
use crate::registry::family;
use crate::spins::Spins;

family! {
    /// A state as written in a config.
    StateSpec as StateBuilder {
        Uniform(Uniform),
        DomainWall(DomainWall),
        Spiral(Spiral),
        Random(Random),
        Vectors(Vectors),
        File(File),
    }
}

/// What a state needs to know to become spins.
#[derive(Clone, Copy, Debug)]
pub struct StateContext<'a> {
    /// The chain.
    pub chain: &'a Chain,
    /// Width δ of a domain wall in sites, for walls without a width of their own.
    pub wall_width_sites: f64,
}

/// A state's config that becomes spins.
pub trait StateBuilder {
    /// One vector a site (not yet staggered), of unit length to rounding.
    fn vectors(&self, context: &StateContext) -> Result<Vec<Vector>>;

    /// Whether odd sites are reversed.
    fn staggered(&self) -> bool;
}

impl StateSpec {
    /// The spins: staggered if wished, frozen spins with a direction put in that direction.
    pub fn build(&self, context: &StateContext) -> Result<Spins> {
        let member = self.member();
        let mut vectors = member.vectors(context)?;
        if member.staggered() {
            for v in vectors.iter_mut().skip(1).step_by(2) {
                *v = vector::scale(-1.0, *v);
            }
        }
        for f in &context.chain.frozen {
            if let Some(direction) = f.direction {
                for i in f.sites.indices(context.chain.sites, "site")? {
                    vectors[i] = direction.vector();
                }
            }
        }
        Spins::from_vectors(&vectors)
    }
}
