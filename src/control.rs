//! What watches over a computation beside its physics: how often gradients were computed, whether it is to stop, and what is
//! recorded of it.

use crate::error::{Error, Result};
use crate::record::{Count, Fingerprint, Keep, Recorder, Share, Ticket};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

/// Counts the gradients of a run, can stop it from any thread, and records what it computes.
#[derive(Debug, Default)]
pub struct Control {
    evaluations: AtomicUsize,
    hessians: AtomicUsize,
    stop: Arc<AtomicBool>,
    fault: OnceLock<String>,
    recorder: Recorder,
}

impl Control {
    /// Stops when this switch is set to true: a run then finishes its iteration and ends with
    /// [`Error::Stopped`]; the switch is never set back.
    pub fn obey(&mut self, switch: Arc<AtomicBool>) {
        self.stop = switch;
    }

    /// The switch that stops what it watches over.
    pub fn switch(&self) -> &Arc<AtomicBool> {
        &self.stop
    }

    /// Whether what it watches over is to stop.
    pub fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed) || self.fault.get().is_some()
    }

    /// Stops what it watches over, for it cannot go on; of several reasons the first is kept.
    pub fn give_up(&self, reason: impl FnOnce() -> String) {
        self.fault.get_or_init(reason);
    }

    /// An error where what it watches over is to stop: why it cannot go on, if it cannot.
    pub fn check(&self) -> Result<()> {
        match self.fault.get() {
            Some(reason) => Err(Error::Numerical(reason.clone())),
            None if self.is_stopped() => Err(Error::Stopped),
            None => Ok(()),
        }
    }

    /// What was found, unless it was to stop: what is stopped on its way may look like what there is none of.
    pub fn relied_on<T>(&self, found: Result<T>) -> Result<T> {
        self.check().and(found)
    }

    /// Records in `keep`, and takes what an interrupted run has recorded there: a run goes on to the outcome that that would
    /// have had.
    pub fn record(&mut self, keep: Box<dyn Keep>) {
        self.recorder = Recorder::new(keep);
    }

    /// What is recorded.
    pub fn recorder(&self) -> &Recorder {
        &self.recorder
    }

    /// Gradients of one image computed so far.
    pub fn evaluations(&self) -> usize {
        self.evaluations.load(Ordering::Relaxed)
    }

    /// Gradients and Hessians computed so far.
    pub fn evaluated(&self) -> Count {
        Count { evaluations: self.evaluations(), hessians: self.hessians.load(Ordering::Relaxed) }
    }

    /// One more Hessian.
    pub(crate) fn count_hessian(&self) {
        self.hessians.fetch_add(1, Ordering::Relaxed);
    }

    /// One more gradient.
    pub(crate) fn count(&self) {
        self.evaluations.fetch_add(1, Ordering::Relaxed);
    }
}

/// A computation that is recorded when it has finished, or answered from the record. One within another is part of that, and
/// without a [`Control`] nothing is recorded.
#[derive(Debug)]
pub struct Call<'a> {
    control: Option<&'a Control>,
    /// The record, where this call is recorded.
    record: Option<(&'a Recorder, Ticket)>,
    /// What was evaluated before it.
    before: Count,
}

impl<'a> Call<'a> {
    /// The next one, of a kind and with an input of its own.
    pub(crate) fn begin(
        control: Option<&'a Control>,
        kind: &str,
        input: impl FnOnce(Fingerprint) -> Fingerprint,
    ) -> Call<'a> {
        let record = control.and_then(|control| {
            let ticket = control.recorder.begin_call(|print| input(print.text(kind)))?;
            Some((&control.recorder, ticket))
        });
        Call { control, record, before: control.map(Control::evaluated).unwrap_or_default() }
    }

    /// Its result, if it is recorded and `check` takes it. What it evaluated counts as in the run that computed it.
    pub fn answer<T: DeserializeOwned>(&self, check: impl FnOnce(T) -> Option<T>) -> Option<T> {
        let (recorder, ticket) = self.record?;
        recorder.answer(ticket, check).map(|found| self.counted(found))
    }

    /// Where it stood, if it was saved on the way and `check` takes that.
    pub fn underway<T: DeserializeOwned>(&self, check: impl FnOnce(T) -> Option<T>) -> Option<T> {
        let (recorder, ticket) = self.record?;
        recorder.underway(ticket, check).map(|found| self.counted(found))
    }

    fn counted<T>(&self, (found, count): (T, Count)) -> T {
        if let Some(control) = self.control {
            let now = self.before + count;
            control.evaluations.store(now.evaluations, Ordering::Relaxed);
            control.hessians.store(now.hessians, Ordering::Relaxed);
        }
        found
    }

    /// An error if the run is to stop; all that is recorded is saved then, with where this call stands if it can go on from
    /// there.
    pub fn obey<T: Serialize>(&self, state: impl FnOnce() -> Option<T>) -> Result<()> {
        let stopped = self.control.map_or(Ok(()), Control::check);
        if let (Err(Error::Stopped), Some((recorder, ticket))) = (&stopped, self.record) {
            recorder.save_with(|| state().map(|state| ticket.sealed(self.count(), &state)));
        }
        stopped
    }

    /// Saves where it stands, if it is time to.
    pub fn save_if_due<T: Serialize>(&self, state: impl FnOnce() -> T) {
        if let Some((recorder, ticket)) = self.record {
            recorder.save_if_due(|| ticket.sealed(self.count(), &state()));
        }
    }

    /// Records its result.
    pub fn finish<T: Serialize>(&self, result: impl FnOnce() -> T) {
        if let Some((recorder, ticket)) = self.record {
            recorder.add(ticket.sealed(self.count(), &result()));
            self.heed();
        }
    }

    /// What is asked of how processes share it; nothing where it is one process's alone.
    pub(crate) fn shared<T>(&self, ask: impl FnOnce(&mut dyn Share, usize) -> T) -> Option<T> {
        self.record?.0.shared(ask)
    }

    /// A part of it, if some process has made it and `check` takes it, and what it evaluated.
    pub(crate) fn part<T: DeserializeOwned>(
        &self,
        part: usize,
        check: impl FnOnce(T) -> Option<T>,
    ) -> Option<(T, Count)> {
        let record = self.shared(|share, k| share.part(k, part))??;
        self.record?.1.opened(&record, check)
    }

    /// Records a part that was made here, and what it evaluated.
    pub(crate) fn add_part(&self, part: usize, count: Count, content: &impl Serialize) {
        if let Some((_, ticket)) = self.record {
            let sealed = ticket.sealed(count, content);
            self.shared(|share, k| share.add_part(k, part, sealed));
            self.heed();
        }
    }

    /// All parts are there; so much was evaluated for them, whoever did.
    pub(crate) fn end_parts(&self, count: Count) {
        self.counted(((), count));
        if let Some((recorder, _)) = self.record {
            recorder.end_parts();
        }
    }

    /// Stops where others have computed something else.
    fn heed(&self) {
        if let (Some(control), Some(Some(reason))) = (self.control, self.shared(|share, _| share.fault())) {
            control.give_up(|| reason);
        }
    }

    /// So far.
    fn count(&self) -> Count {
        self.control.map(Control::evaluated).unwrap_or_default().since(self.before)
    }
}

impl Drop for Call<'_> {
    fn drop(&mut self) {
        if let Some((recorder, _)) = self.record {
            recorder.end_call();
        }
    }
}
