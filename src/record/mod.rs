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
//! A [`Checkpoint`] keeps a record on the disk, a [`Lock`] keeps a second run out of a folder. [`Shares`] keep one that several
//! processes fill together.

mod checkpoint;
mod fingerprint;
mod frame;
mod lock;
mod recorder;
mod shares;

pub use checkpoint::{Checkpoint, FOLDER, Identity};
pub use fingerprint::Fingerprint;
pub use lock::Lock;
pub use recorder::Count;
pub use recorder::Recorder;
pub(crate) use recorder::{MOST, Ticket};
pub use shares::{ShareHead, Shares};

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

    /// Where processes share their calls, how they do.
    fn share(&mut self) -> Option<&mut dyn Share> {
        None
    }
}

/// Calls of many things alike in parts, each recorded by itself by one of several processes that all make the same calls.
pub trait Share {
    /// How many parts.
    fn parts(&self) -> usize;

    /// Whether it is for this process to make a part.
    fn is_mine(&self, part: usize) -> bool;

    /// Whether whoever is to make a part did not in time before.
    fn is_late(&self, part: usize) -> bool;

    /// The record of a part of call `k`, if some process has made it.
    fn part(&mut self, k: usize, part: usize) -> Option<Vec<u8>>;

    /// A part of call `k` has been made here.
    fn add_part(&mut self, k: usize, part: usize, record: Vec<u8>);

    /// Why this process cannot go on together with the others, if it cannot.
    fn fault(&self) -> Option<String>;
}
