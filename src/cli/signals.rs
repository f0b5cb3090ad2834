//! Ctrl-C, the request to terminate and a terminal that is gone: the first ends the run in good order, a second one at once.

use anyhow::{Context, Result};
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Duration;

/// The number of "hung up"; not every system has it.
const SIGHUP: i32 = 1;
/// The signals that are waited for, with their exit codes and names.
const KNOWN: [(i32, u8, &str); 3] =
    [(SIGINT, 130, "interrupted"), (SIGTERM, 143, "terminated"), (SIGHUP, 129, "hung up")];
/// How long a signal may go unnoticed by a thread that waits for one.
const NOTICED_AFTER: Duration = Duration::from_millis(20);
/// Signals that come so soon after the first are that one: programs such as `timeout` send it to a process and once more to its group.
const ONE_SIGNAL: Duration = Duration::from_millis(300);
/// Which signals a process ignores, on systems that tell.
const STATUS: &str = "/proc/self/status";

/// Watches for signals from when it is made.
pub struct Signals {
    stop: Arc<AtomicBool>,
    caught: Arc<AtomicUsize>,
}

impl Signals {
    /// From now on a signal is noticed; one that comes later than with it ends the program at once, with the same code.
    pub fn watch() -> Result<Signals> {
        let (stop, caught) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicUsize::new(0)));
        let armed = Arc::new(AtomicBool::new(false));
        let register = |(signal, code, _): (i32, u8, &str)| -> std::io::Result<()> {
            flag::register_conditional_shutdown(signal, i32::from(code), Arc::clone(&armed))?;
            flag::register_usize(signal, Arc::clone(&caught), usize::from(code))?;
            flag::register(signal, Arc::clone(&stop)).map(|_| ())
        };
        // nohup lets a run go on when its terminal is gone
        let mut watched = KNOWN.into_iter().filter(|(signal, ..)| *signal != SIGHUP || !is_ignored(SIGHUP));
        let registered = watched.try_for_each(register).and_then(|()| fail_where_files_grow_too_large());
        registered.context("signals cannot be watched for")?;
        let signals = Signals { stop, caught };
        signals.once_there(move |_| {
            std::thread::sleep(ONE_SIGNAL);
            armed.store(true, Ordering::SeqCst);
        });
        Ok(signals)
    }

    /// From now on the end of standard input is a request to terminate: whoever held its other end is gone.
    pub fn end_with_stdin(&self) {
        let (stop, caught) = (Arc::clone(&self.stop), Arc::clone(&self.caught));
        std::thread::spawn(move || {
            let _ = io::copy(&mut io::stdin(), &mut io::sink());
            caught.store(usize::from(KNOWN[1].1), Ordering::SeqCst);
            stop.store(true, Ordering::SeqCst);
        });
    }

    /// From now on the first signal ends the program, once something was said of what it did, in a word.
    pub fn end_saying(self, say: impl Fn(&str) + Send + 'static) {
        self.once_there(move |signals| {
            if let Some((code, word)) = signals.caught() {
                say(word);
                std::process::exit(i32::from(code));
            }
        });
    }

    /// Acts once a signal has come, in a thread that waits for one.
    fn once_there(&self, act: impl FnOnce(&Signals) + Send + 'static) {
        let signals = Signals { stop: Arc::clone(&self.stop), caught: Arc::clone(&self.caught) };
        std::thread::spawn(move || {
            while !signals.stop.load(Ordering::SeqCst) {
                std::thread::sleep(NOTICED_AFTER);
            }
            act(&signals);
        });
    }

    /// True once a signal has come.
    pub fn switch(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.stop)
    }

    /// The exit code that the signal asks for, and what it did, in a word; nothing as long as there was none.
    pub fn caught(&self) -> Option<(u8, &'static str)> {
        let code = self.caught.load(Ordering::SeqCst);
        KNOWN.into_iter().find(|known| usize::from(known.1) == code).map(|(_, code, word)| (code, word))
    }
}

/// A file that a limit (`ulimit -f`) does not let grow is an error of its writing; the signal that comes with it would end the program without a
/// word.
#[cfg(unix)]
fn fail_where_files_grow_too_large() -> io::Result<()> {
    flag::register(signal_hook::consts::SIGXFSZ, Arc::default()).map(|_| ())
}

#[cfg(not(unix))]
fn fail_where_files_grow_too_large() -> io::Result<()> {
    Ok(())
}

/// Whether whoever started the process had it ignore a signal; where the system does not tell, it is left as it is, as if it were.
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string(STATUS).unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(u64::MAX);
    mask >> (signal - 1) & 1 == 1
}
