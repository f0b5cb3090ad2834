//! Answers calls from a record, and records them.

use super::{Fingerprint, Keep, Share};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::ops::Add;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Records the calls of a run in a [`Keep`], or does not.
#[derive(Default)]
pub struct Recorder(Option<Mutex<Record>>);

struct Record {
    keep: Box<dyn Keep>,
    /// What tells the problem from another.
    problem: u32,
    done: usize,
    taken: usize,
    /// A call is at work: those within it are part of it.
    busy: bool,
}

impl std::fmt::Debug for Recorder {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.debug_struct("Recorder").field("on", &self.0.is_some()).field("taken", &self.taken()).finish()
    }
}

impl Recorder {
    /// Records in `keep`, and answers from what that has.
    pub fn new(keep: Box<dyn Keep>) -> Recorder {
        Recorder(Some(Mutex::new(Record { keep, problem: 0, done: 0, taken: 0, busy: false })))
    }

    fn record(&self) -> Option<MutexGuard<'_, Record>> {
        self.0.as_ref().map(|record| record.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Starts with a problem: only what was recorded of the same one is an answer.
    pub fn begin(&self, problem: impl FnOnce() -> Fingerprint) {
        if let Some(mut record) = self.record() {
            (record.problem, record.done, record.taken) = (problem().value(), 0, 0);
        }
    }

    /// How many calls were answered from the record.
    pub fn taken(&self) -> usize {
        self.record().map_or(0, |record| record.taken)
    }

    /// Saves all that is recorded, whether it is time to or not.
    pub fn save(&self) {
        self.save_with(|| None);
    }

    /// Saves all that is recorded, and where the call in progress stands.
    pub(crate) fn save_with(&self, state: impl FnOnce() -> Option<Vec<u8>>) {
        if let Some(mut record) = self.record() {
            let k = record.done;
            record.keep.save(k, state());
        }
    }

    /// The same, if it is time to.
    pub(crate) fn save_if_due(&self, state: impl FnOnce() -> Vec<u8>) {
        if let Some(mut record) = self.record()
            && record.keep.is_due()
        {
            let k = record.done;
            record.keep.save(k, Some(state()));
        }
    }

    /// Begins the next call, and what identifies it by its input; nothing where nothing is recorded or it is part of another.
    pub(crate) fn begin_call(&self, input: impl FnOnce(Fingerprint) -> Fingerprint) -> Option<Ticket> {
        let mut record = self.record()?;
        if std::mem::replace(&mut record.busy, true) {
            return None;
        }
        Some(Ticket(input(Fingerprint::default().whole(record.problem as usize)).value()))
    }

    /// The call that was begun is over.
    pub(crate) fn end_call(&self) {
        if let Some(mut record) = self.record() {
            record.busy = false;
        }
    }

    /// The result of the next call and its evaluations, if it is recorded and `check` takes it.
    pub(crate) fn answer<T: DeserializeOwned>(
        &self,
        ticket: Ticket,
        check: impl FnOnce(T) -> Option<T>,
    ) -> Option<(T, Count)> {
        let mut record = self.record()?;
        let k = record.done;
        let found = ticket.opened(&record.keep.finished(k)?, check)?;
        record.done += 1;
        record.taken += 1;
        Some(found)
    }

    /// Where the next call stood and its evaluations until then, if it was saved on the way and `check` takes it.
    pub(crate) fn underway<T: DeserializeOwned>(
        &self,
        ticket: Ticket,
        check: impl FnOnce(T) -> Option<T>,
    ) -> Option<(T, Count)> {
        let mut record = self.record()?;
        let k = record.done;
        ticket.opened(&record.keep.underway(k)?, check)
    }

    /// Records the result of a call.
    pub(crate) fn add(&self, sealed: Vec<u8>) {
        if let Some(mut record) = self.record() {
            let k = record.done;
            record.keep.add(k, sealed);
            record.done += 1;
            if record.keep.is_due() {
                record.keep.save(k + 1, None);
            }
        }
    }

    /// What is asked of how processes share the next call; nothing where they do not.
    pub(crate) fn shared<T>(&self, ask: impl FnOnce(&mut dyn Share, usize) -> T) -> Option<T> {
        let mut record = self.record()?;
        let k = record.done;
        record.keep.share().map(|share| ask(share, k))
    }

    /// All parts of the next call are there.
    pub(crate) fn end_parts(&self) {
        if let Some(mut record) = self.record() {
            record.done += 1;
        }
    }
}

/// What was evaluated of single states.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Count {
    /// Gradients.
    pub evaluations: usize,
    /// Hessians.
    pub hessians: usize,
}

impl Count {
    /// What came after `before`.
    pub fn since(self, before: Count) -> Count {
        Count { evaluations: self.evaluations - before.evaluations, hessians: self.hessians - before.hessians }
    }

    /// What of an allowance is left after it.
    pub fn left_of(self, allowed: Count) -> Count {
        Count {
            evaluations: allowed.evaluations.saturating_sub(self.evaluations),
            hessians: allowed.hessians.saturating_sub(self.hessians),
        }
    }

    /// Which part of an allowance it is, of that of which it is the larger one; all of one of nothing.
    pub fn part_of(self, allowed: Count) -> f64 {
        if allowed.evaluations.min(allowed.hessians) == 0 {
            return 1.0;
        }
        let part = |own: usize, of: usize| own as f64 / of as f64;
        part(self.evaluations, allowed.evaluations).max(part(self.hessians, allowed.hessians))
    }
}

impl Add for Count {
    type Output = Count;

    fn add(self, other: Count) -> Count {
        Count { evaluations: self.evaluations + other.evaluations, hessians: self.hessians + other.hessians }
    }
}

/// What identifies a call: its input.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ticket(u32);

impl Ticket {
    /// A record: the fingerprint of the input, the evaluations of the call so far, and its result or where it stands. What
    /// cannot be written is no record of anything.
    pub(crate) fn sealed(self, count: Count, content: &impl Serialize) -> Vec<u8> {
        let whole = (self.0, count, content);
        // of bands these are many: no memory is had twice
        let size = postcard::serialize_with_flavor(&whole, postcard::ser_flavors::Size::default()).unwrap_or_default();
        postcard::to_extend(&whole, Vec::with_capacity(size)).unwrap_or_default()
    }

    /// What a record holds, with its evaluations; nothing if it is of another input, or not understood to its last byte.
    pub(crate) fn opened<T: DeserializeOwned>(
        self,
        record: &[u8],
        check: impl FnOnce(T) -> Option<T>,
    ) -> Option<(T, Count)> {
        // the input first: where it is another, what follows need not be understood
        let (print, _) = postcard::take_from_bytes::<u32>(record).ok()?;
        if print != self.0 {
            return None;
        }
        let ((_, count, content), rest) = postcard::take_from_bytes::<(u32, Count, T)>(record).ok()?;
        (rest.is_empty() && count.evaluations.max(count.hessians) <= MOST).then_some(())?;
        Some((check(content)?, count))
    }
}

/// Most of anything that is counted: sums of such counts do not overflow.
pub(crate) const MOST: usize = (u32::MAX >> 1) as usize;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_written_is_read_to_the_bit_and_never_less_or_more_than_that() {
        let rows = vec![vec![0.1, -0.0, f64::MIN_POSITIVE], Vec::new(), vec![f64::INFINITY, f64::NAN]];
        let bytes = Ticket(7).sealed(Count { evaluations: 3, hessians: 2 }, &(true, 1.0 / 3.0, &rows));
        type Content = (bool, f64, Vec<Vec<f64>>);
        let read = |bytes: &[u8]| Ticket(7).opened::<Content>(bytes, Some);
        let ((yes, x, again), count) = read(&bytes).unwrap();
        assert_eq!((count.evaluations, count.hessians, yes, x.to_bits()), (3, 2, true, (1.0f64 / 3.0).to_bits()));
        let bits = |rows: &[Vec<f64>]| rows.iter().flatten().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!((again.len(), bits(&again)), (3, bits(&rows)));
        for cut in 0..bytes.len() {
            assert!(read(&bytes[..cut]).is_none(), "{cut} bytes are too few");
        }
        assert!(read(&[&bytes[..], &[0]].concat()).is_none());
        assert!(Ticket(8).opened::<Content>(&bytes, Some).is_none());
        // a length of 2⁶³ numbers asks for no memory
        let mut endless = bytes[..12].to_vec();
        endless.extend([0xff; 9]);
        endless.push(1);
        assert!(read(&endless).is_none());
    }
}
