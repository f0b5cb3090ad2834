//! Runs that can be interrupted: the results of finished computations are recorded, and a run that is started again takes them
//! from the record.
//!
//! A run is a deterministic program whose costly parts are few kinds of calls: the relaxation of a band, the refinement of a
//! saddle, the descents from it. Each finished call is a record, in the order in which the calls are made, with a fingerprint of
//! its input; the relaxation in progress saves its whole state now and then. The program starts from the beginning again,
//! finished calls are answered from the record, and the one in progress goes on from where it was saved. So the end is the same
//! to the bit, wherever the run was interrupted and however often.
//!
//! Records are what `serde` derives, as [`postcard`] writes it: every number to the bit. Whoever takes one over says what it is to
//! be like, so that the computation goes on with numbers that it can bear, whatever the bytes are.
//!
//! A [`Checkpoint`] keeps a record on the disk, a [`Lock`] keeps a second run out of a folder.

mod checkpoint;
mod fingerprint;
mod frame;
mod lock;
mod recorder;

pub use checkpoint::{Checkpoint, FOLDER, Identity};
pub use fingerprint::Fingerprint;
pub use lock::Lock;
pub use recorder::Count;
pub use recorder::Recorder;
pub(crate) use recorder::{MOST, Ticket};

/// Where the record of a run is kept. Calls are counted from 0.
pub trait Keep: Send {
    /// The record of call `k` of the interrupted run, if it finished.
    fn finished(&mut self, k: usize) -> Option<Vec<u8>>;

    /// Where the relaxation stood that was call `k` of the interrupted run, if it was saved on the way.
    fn underway(&mut self, k: usize) -> Option<Vec<u8>>;

    /// Call `k` has finished now. What the interrupted run had from there on is of no use any more.
    fn add(&mut self, k: usize, record: Vec<u8>);

    /// Whether it is time to save.
    fn is_due(&mut self) -> bool;

    /// Saves all that was added and, if call `k` is a relaxation in progress, where that stands.
    fn save(&mut self, k: usize, underway: Option<Vec<u8>>);
}
