//! Minima, the passes between them, and the routes over these: everything that is found is kept in one graph.
//!
//! ```text
//! Landscape: minima (nodes), passes and their images by symmetry (edges)
//! route(a, b)  the way from a to b whose highest saddle is lowest; T is its height
//! search       while there is news:  a rival names a start;  climb to a saddle below T;  descents to its two minima;  add
//! ```
//! A search is over after so many climbs in a row without news: a lower T, or a saddle of an energy that none had before. What it
//! found is certified as every pass is; that no lower route exists it does not prove.
//!
//! # Words
//! *minimum*: a stationary state without a descending mode, each state one of its own; two are the same if rotations about the symmetry
//! axes make them so, or if both are flat and of one energy. *Peak*: a maximum of a band, where a saddle is looked for. *Saddle*: the
//! stationary state that is reached from there, of index one if it is to count. *Descent*: the way down from a saddle on one side.
//! *Pass*: a saddle with the minima that its two descents reach. *Route*: passes that lead from one minimum to another. *Rival*: a rule
//! that names states from which a climb may lead to a pass below T. *Climb*: the search for a saddle of index one from any state.
//! *Quiet*: searches since the last news. *Image*: what an operation of the energy's symmetry group makes of a minimum or a pass.

mod doubt;
mod graph;
mod minimum;
mod pass;
mod peaks;
mod rivals;
mod saddle;
mod search;
mod stored;
mod turns;

pub use doubt::{Doubt, PathEnd};
pub use graph::{Edge, Landscape, Route};
pub use minimum::{Minimum, is_same_state};
pub use pass::Pass;
pub use peaks::{Peak, direction, highest, peaks};
pub use saddle::{Saddle, same};
pub use search::{Effort, Searched, Settings, search};
pub use stored::{are_counts, are_finite, fit};
pub use turns::{turned, turns};
