//! Minima, the passes between them, and the routes over these: everything that is found is kept in one graph.
//!
//! ```text
//! Landscape    minima (nodes), passes (edges), and their images by symmetry
//! route(a, b)  the way from a to b whose highest saddle is lowest; T is its height
//! connect      while no route, and joins bring the ends nearer:  the next pair, the nearest that leads on;  a band between the two,
//!              relaxed a little;  its peaks refined to saddles;  descents to their two minima;  add
//! search       while there is news:  a rival names a start;  climb to a saddle below T;  descents to its two minima;  add
//! assemble     the stretches from saddles down to minima along a route, each relaxed, put together to one path
//! ```
//! Every first path of a run feeds the same graph. A search is over after so many climbs in a row without news: a lower T, or a saddle
//! of an energy that none had before. What it found is certified as every pass is; that no lower route exists it does not prove.
//!
//! # Words
//! *minimum*: a stationary state without a descending mode, each state one of its own; two are the same if rotations about the symmetry
//! axes make them so, or if a valley that is flat to rounding joins them. *Peak*: a maximum of a band, where a saddle is looked for.
//! *Saddle*: the stationary state that is reached from there, of index one if it is to count; places of it along a valley that is flat to
//! rounding are one saddle where it parts the same minima. *Descent*: the way down from a saddle on
//! one side. *Pass*: a saddle with the minima that its two descents reach. *Route*: passes that lead from one minimum to another.
//! *Way*: a first path between two minima, not relaxed. *Rival*: a rule that names states from which a climb may lead to a pass below T.
//! *Climb*: the search for a saddle of index one from any state. *Quiet*: searches since the last news. *Image*: what an operation of
//! the energy's symmetry group makes of a minimum or a pass. *Orbit*: a minimum with its images.

mod assemble;
mod bound;
mod connect;
mod doubt;
mod exits;
mod flat;
mod graph;
mod minimum;
mod nearing;
mod pairs;
mod pass;
mod peaks;
mod places;
mod rivals;
mod route;
mod saddle;
mod search;
mod slid;
mod stored;
mod ways;
mod zoom;

pub use crate::path::{turned, turns};
pub use assemble::{Assembled, assemble};
pub use bound::highest_between;
pub use connect::{Bands, Connector};
pub use doubt::{Doubt, PathEnd};
pub use graph::{Edge, Landscape};
pub use minimum::{Minimum, is_same_state};
pub use pass::{Pass, Sides};
pub use peaks::{Peak, direction, highest, peaks, promising};
pub use places::{Places, Seen};
pub use route::Route;
pub use saddle::Saddle;
pub use search::{Aim, Effort, KINDS, Searched, Settings, Standing, brings_news, search};
pub use stored::{are_counts, are_finite, fit};
pub use zoom::zoomed;
