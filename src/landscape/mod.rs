//! Minima, the passes between them, and the ways over these.

mod doubt;
mod minimum;
mod pass;
mod peaks;
mod saddle;
mod stored;
mod turns;

pub use doubt::{Doubt, PathEnd};
pub use minimum::Minimum;
pub use pass::Pass;
pub use peaks::{Peak, direction, highest, peaks};
pub use saddle::{Saddle, same};
pub use stored::{are_counts, are_finite, fit};
pub use turns::{turned, turns};
