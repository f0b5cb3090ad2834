//! Runs that can be interrupted: the results of finished computations are recorded, and a run that is started again takes them
//! from the record.
//!
//! A run is a deterministic program whose costly parts are few kinds of calls: the relaxation of a band, the refinement of a
//! saddle, the descents from it. Each finished call is a record, in the order in which the calls are made, with a fingerprint of
//! its input; the relaxation in progress saves its whole state now and then. The program starts from the beginning again,
//! finished calls are answered from the record, and the one in progress goes on from where it was saved. So the end is the same
//! to the bit, wherever the run was interrupted and however often.

use super::Problem;
use super::bytes::{Fingerprint, Reader, Writer};
use super::outcome::HistoryRow;
use super::stored::Stored;
use crate::band::Band;
use crate::energy::Evaluator;
use crate::error::{Error, Result};
use crate::path::Path;

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

/// The band as it stood when a run was stopped.
#[derive(Clone, Debug)]
pub struct Partial {
    /// Its images.
    pub path: Path,
    /// Its iterations.
    pub history: Vec<HistoryRow>,
}

/// Records a run, or does not.
#[derive(Default)]
pub struct Recorder {
    keep: Option<Box<dyn Keep>>,
    /// What tells the problem from another.
    problem: usize,
    done: usize,
    taken: usize,
    partial: Option<Partial>,
}

impl std::fmt::Debug for Recorder {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.debug_struct("Recorder").field("on", &self.keep.is_some()).field("done", &self.done).finish()
    }
}

impl Recorder {
    /// Records nothing.
    pub fn off() -> Recorder {
        Recorder::default()
    }

    /// Records in `keep`, and answers from what that has.
    pub fn new(keep: Box<dyn Keep>) -> Recorder {
        Recorder { keep: Some(keep), ..Recorder::default() }
    }

    /// Starts with a problem: only what was recorded of the same energies, states and settings is an answer.
    pub(super) fn begin(&mut self, problem: &Problem) {
        (self.done, self.taken, self.partial) = (0, 0, None);
        if self.keep.is_none() {
            return;
        }
        let h = &problem.hamiltonian;
        let mut print = Fingerprint::default().real(h.reference_mev()).real(h.stiffness_mev());
        for spins in [&problem.initial, &problem.final_state] {
            let mut gradient = vec![0.0; 3 * h.sites()];
            let energy = h.energy_gradient(spins.as_slice(), &mut gradient);
            print = print.real(energy).row(&gradient).row(spins.as_slice());
        }
        let Problem { relax_ends, images, guess, noise, smooth, refine, certify, neb, .. } = problem;
        let settings = format!("{relax_ends} {images:?} {guess:?} {noise:?} {smooth:?} {refine} {certify} {neb:?}");
        self.problem = print.text(&settings).value();
    }

    /// How many calls were answered from the record.
    pub fn taken(&self) -> usize {
        self.taken
    }

    /// The band of the stopped run, as far as one was relaxed.
    pub fn partial(&self) -> Option<&Partial> {
        self.partial.as_ref()
    }

    /// Saves all that is recorded, whether it is time to or not.
    pub fn save(&mut self) {
        if let Some(keep) = &mut self.keep {
            keep.save(self.done, None);
        }
    }

    /// Keeps a band, to be shown if the run is stopped.
    pub(super) fn show(&mut self, band: &Band, history: &[HistoryRow]) {
        if self.keep.is_some() {
            self.partial = Some(Partial { path: band.path().clone(), history: history.to_vec() });
        }
    }

    /// The result of `compute`, or what the interrupted run had as its result for this input.
    pub(super) fn call<T: Stored>(
        &mut self,
        h: Evaluator,
        input: &[&[f64]],
        compute: impl FnOnce() -> Result<T>,
    ) -> Result<T> {
        self.obey(h, || None)?;
        let ticket = self.ticket(h, |print| input.iter().fold(print.whole(T::KIND), |p, row| p.row(row)));
        if let Some(found) = self.answer(h, &ticket, |r| T::read(r, h)) {
            return Ok(found);
        }
        let found = compute();
        // what a stopped computation returns is no result
        self.obey(h, || None)?;
        let found = found?;
        self.finish(h, &ticket, |w| found.write(w));
        Ok(found)
    }

    /// What identifies the next call, by its input.
    pub(super) fn ticket(&self, h: Evaluator, input: impl FnOnce(Fingerprint) -> Fingerprint) -> Ticket {
        let print = match self.keep {
            Some(_) => input(Fingerprint::default().whole(self.problem)).value(),
            None => 0,
        };
        Ticket { print, before: h.evaluations() }
    }

    /// The result of the next call, if it is recorded.
    pub(super) fn answer<T>(
        &mut self,
        h: Evaluator,
        ticket: &Ticket,
        read: impl FnOnce(&mut Reader) -> Option<T>,
    ) -> Option<T> {
        let record = self.keep.as_mut()?.finished(self.done)?;
        let (found, evaluations) = opened(&record, ticket, read)?;
        h.set_evaluations(ticket.before + evaluations);
        self.done += 1;
        self.taken += 1;
        Some(found)
    }

    /// Where the next call stood, if it was saved on the way; counts its evaluations so far.
    pub(super) fn resume<T>(
        &mut self,
        h: Evaluator,
        ticket: &Ticket,
        read: impl FnOnce(&mut Reader) -> Option<T>,
    ) -> Option<T> {
        let record = self.keep.as_mut()?.underway(self.done)?;
        let (found, evaluations) = opened(&record, ticket, read)?;
        h.set_evaluations(ticket.before + evaluations);
        Some(found)
    }

    /// Saves where the call in progress stands, if it is time to.
    pub(super) fn save_if_due(&mut self, state: impl FnOnce() -> Vec<u8>) {
        if let Some(keep) = &mut self.keep
            && keep.is_due()
        {
            keep.save(self.done, Some(state()));
        }
    }

    /// Ends the run if it is to stop, with everything saved; `state` is where the call in progress stands.
    pub(super) fn obey(&mut self, h: Evaluator, state: impl FnOnce() -> Option<Vec<u8>>) -> Result<()> {
        if !h.is_stopped() {
            return Ok(());
        }
        if let Some(keep) = &mut self.keep {
            keep.save(self.done, state());
        }
        Err(Error::Stopped)
    }

    /// Records the result of a call.
    pub(super) fn finish(&mut self, h: Evaluator, ticket: &Ticket, write: impl FnOnce(&mut Writer)) {
        if let Some(keep) = &mut self.keep {
            keep.add(self.done, ticket.sealed(h, write));
            self.done += 1;
            if keep.is_due() {
                keep.save(self.done, None);
            }
        }
    }
}

/// What identifies a call: its input; with the count of evaluations before it.
#[derive(Debug)]
pub struct Ticket {
    print: usize,
    before: usize,
}

impl Ticket {
    /// A record: the fingerprint of the input, the evaluations of the call so far, and what is written.
    pub fn sealed(&self, h: Evaluator, write: impl FnOnce(&mut Writer)) -> Vec<u8> {
        let mut w = Writer::default();
        w.whole(self.print);
        w.whole(h.evaluations() - self.before);
        write(&mut w);
        w.into_bytes()
    }
}

/// What a record holds, with its evaluations; nothing if it is of another input, or not understood to its last byte.
fn opened<T>(record: &[u8], ticket: &Ticket, read: impl FnOnce(&mut Reader) -> Option<T>) -> Option<(T, usize)> {
    let mut r = Reader::new(record);
    if r.whole()? != ticket.print {
        return None;
    }
    let evaluations = r.count()?;
    let found = read(&mut r)?;
    r.is_done().then_some((found, evaluations))
}
