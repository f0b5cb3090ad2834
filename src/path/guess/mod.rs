//! First paths between two states. One file a guess.
//!
//! Spins that point (nearly) opposite ways in the two states all turn about one axis: if each chose its own plane,
//! neighbours would come apart on the way and the exchange energy would explode.

mod carried;
mod clock;
mod difference;
mod drift;
mod droplet;
mod file;
mod front;
mod geodesic;
mod holes;
mod joining;
mod natural;
mod nlerp;
mod noise;
mod outline;
mod rotation;
mod shrink;
mod smooth;
mod sweep;
mod translation;
mod waypoints;

pub use clock::{NEARLY_OPPOSITE, Way, Ways, common_axis, ways};
pub use drift::Drift;
pub use droplet::{Droplet, Inside};
pub use file::PathFile;
pub use geodesic::Geodesic;
pub use joining::{joining_axes, own_axis};
pub use natural::natural;
pub use nlerp::{Nlerp, component_sag};
pub use noise::{NoiseSpec, add_noise};
pub use rotation::{Rotation, best_turn};
pub use shrink::Shrink;
pub use smooth::smooth;
pub use sweep::{Edge, Sweep, moving_sites};
pub use translation::Translation;
pub use waypoints::Waypoints;

use super::Path;
use crate::error::Result;
use crate::geometry::Direction;
use crate::registry::family;
use crate::spins::Spins;
use crate::state::StateContext;

family! {
    /// A first path as written in a config: `{"geodesic": {}}`.
    GuessSpec as FirstGuess {
        Geodesic(Geodesic),
        Sweep(Sweep),
        Shrink(Shrink),
        Drift(Drift),
        Translation(Translation),
        Droplet(Droplet),
        Rotation(Rotation),
        Nlerp(Nlerp),
        Waypoints(Waypoints),
        File(PathFile),
    }
}

/// What a first path may need to know.
#[derive(Clone, Copy, Debug)]
pub struct GuessContext<'a> {
    /// The lattice and the width of a wall there.
    pub states: StateContext<'a>,
    /// Axis about which opposite spins turn, where the guess names none.
    pub default_axis: Direction,
}

/// A first path.
pub trait FirstGuess {
    /// A path of `images` images (at least two) from a to b, states of the same lattice; both are kept exactly.
    fn path(&self, a: &Spins, b: &Spins, images: usize, context: &GuessContext) -> Result<Path>;
}
