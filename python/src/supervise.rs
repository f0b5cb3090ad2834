//! Work on threads of its own, while the thread that asked for it listens to the user.

use crate::errors::raised;
use crate::term::Trouble;
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use spinneb::cli::check_threads;
use spinneb::config::Say;
use spinneb::drive::{HistoryRow, Observer};
use spinneb::error::{Error, Result};
use std::ffi::CString;
use std::num::NonZeroUsize;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

/// Between looks for a signal.
const LOOK: Duration = Duration::from_millis(20);
/// Between two iterations that are told of.
const TELL: Duration = Duration::from_millis(50);

/// What is told of a run on its way.
enum News {
    Stage(String),
    Iteration(HistoryRow),
    /// What the user should know whether or not the progress is told.
    Note(String),
}

/// What the work is given: the switch that stops it, and who hears of its progress.
pub struct Ways {
    pub switch: Arc<AtomicBool>,
    pub teller: Teller,
}

/// Tells the waiting thread.
pub struct Teller {
    to: Sender<News>,
    wanted: bool,
    last: Option<Instant>,
}

impl Teller {
    /// What warns the user.
    pub fn speaker(&self) -> Say {
        let to = self.to.clone();
        Box::new(move |words| {
            let _ = to.send(News::Note(words.into()));
        })
    }

    fn tell(&self, news: News) {
        if self.wanted {
            // nobody listens any more to a run that is to stop
            let _ = self.to.send(news);
        }
    }
}

impl Observer for Teller {
    fn iteration(&mut self, row: &HistoryRow) {
        if self.last.is_none_or(|last| last.elapsed() >= TELL) {
            self.last = Some(Instant::now());
            self.tell(News::Iteration(*row));
        }
    }

    fn stage(&mut self, what: &str) {
        self.tell(News::Stage(what.into()));
    }
}

/// A single thread.
pub const ONE: Option<NonZeroUsize> = Some(NonZeroUsize::MIN);

/// Does the work with so many threads, one for each core if nothing is said. Ctrl-C stops it, and so does what `progress` raises.
pub fn supervised<T: Send + 'static>(
    py: Python,
    threads: Option<NonZeroUsize>,
    progress: Option<&Bound<PyAny>>,
    trouble: &Trouble,
    work: impl FnOnce(&mut Ways) -> Result<T> + Send + 'static,
) -> PyResult<T> {
    let of_threads = |message: String| raised(py, Error::invalid("threads", message));
    let count = threads.map_or(0, NonZeroUsize::get);
    check_threads(1, count).map_err(|e| match e {
        Error::Invalid { message, .. } => of_threads(message),
        other => raised(py, other),
    })?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build();
    let pool = pool.map_err(|e| raised(py, Error::Numerical(format!("the threads cannot be started: {e}"))))?;
    let (to, from) = channel();
    let switch = Arc::new(AtomicBool::new(false));
    let teller = Teller { to, wanted: progress.is_some(), last: None };
    let mut ways = Ways { switch: switch.clone(), teller };
    let worker = thread::spawn(move || pool.install(|| work(&mut ways)));
    let heard = listen(py, from, progress);
    if heard.is_err() {
        switch.store(true, Ordering::SeqCst);
    }
    let done = py.detach(|| worker.join());
    heard?;
    trouble.raise()?;
    let done =
        done.map_err(|_| raised(py, Error::Numerical("the computation broke off: this is a fault of spinneb".into())))?;
    done.map_err(|e| raised(py, e))
}

/// Passes news on until there can be no more.
fn listen(py: Python, mut from: Receiver<News>, progress: Option<&Bound<PyAny>>) -> PyResult<()> {
    let mut stage = String::new();
    loop {
        let (back, news) = py.detach(move || {
            let news = from.recv_timeout(LOOK);
            (from, news)
        });
        from = back;
        py.check_signals()?;
        let row = match news {
            Ok(News::Stage(words)) => {
                stage = words;
                None
            }
            Ok(News::Iteration(row)) => Some(row),
            Ok(News::Note(words)) => {
                let words = CString::new(words).unwrap_or_default();
                PyErr::warn(py, &py.get_type::<PyUserWarning>(), &words, 2)?;
                continue;
            }
            Err(RecvTimeoutError::Timeout) => continue,
            Err(RecvTimeoutError::Disconnected) => return Ok(()),
        };
        if let Some(progress) = progress {
            progress.call1((told(py, &stage, row)?,))?;
        }
    }
}

/// What a progress function is called with.
fn told<'py>(py: Python<'py>, stage: &str, row: Option<HistoryRow>) -> PyResult<Bound<'py, PyDict>> {
    let news = PyDict::new(py);
    news.set_item("stage", stage)?;
    if let Some(row) = row {
        news.set_item("iteration", row.iteration)?;
        news.set_item("images", row.images)?;
        news.set_item("highest_image_meV", row.highest_image_mev)?;
        news.set_item("largest_predicted_rotation_rad", row.largest_predicted_rotation_rad)?;
        news.set_item("length_rad", row.length_rad)?;
    }
    Ok(news)
}
