//! What watches over a computation beside its physics: how often gradients were computed, and whether it is to stop.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Counts the gradients of a run and can stop it, from any thread.
#[derive(Debug, Default)]
pub struct Control {
    evaluations: AtomicUsize,
    stop: Arc<AtomicBool>,
}

impl Control {
    /// Stops when this switch is set to true: a run then finishes its iteration and ends with
    /// [`Error::Stopped`](crate::Error::Stopped); the switch is never set back.
    pub fn obey(&mut self, switch: Arc<AtomicBool>) {
        self.stop = switch;
    }

    /// The switch that stops what it watches over.
    pub fn switch(&self) -> &Arc<AtomicBool> {
        &self.stop
    }

    /// Whether what it watches over is to stop.
    pub fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Gradients of one image computed so far.
    pub fn evaluations(&self) -> usize {
        self.evaluations.load(Ordering::Relaxed)
    }

    /// One more gradient.
    pub(crate) fn count(&self) {
        self.evaluations.fetch_add(1, Ordering::Relaxed);
    }

    /// Counts on from `count`: what a resumed run takes over is counted as in the run that computed it.
    pub(crate) fn set_evaluations(&self, count: usize) {
        self.evaluations.store(count, Ordering::Relaxed);
    }
}
