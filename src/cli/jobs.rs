//! Processes, several at a time: each takes the next point when it is free.

use std::io;
use std::process::Output;
use std::sync::mpsc;
use std::sync::{
    Mutex,
    atomic::{AtomicBool, Ordering},
};
use std::thread;

/// How the process of a point ended.
pub enum Ended {
    /// By itself, with a code and what it said on stderr.
    Exited(u8, String),
    /// By a signal.
    Killed(i32),
    /// It never began.
    NotStarted(io::Error),
}

impl Ended {
    fn of(done: io::Result<Output>) -> Ended {
        match done {
            Err(e) => Ended::NotStarted(e),
            Ok(output) => match output.status.code() {
                Some(code) => {
                    let said = String::from_utf8_lossy(&output.stderr).into_owned();
                    Ended::Exited(u8::try_from(code).unwrap_or(1), said)
                }
                None => Ended::Killed(signal(&output)),
            },
        }
    }

    /// What went wrong, in words, and the exit code for it; nothing where a result was written.
    pub fn failure(&self) -> Option<(String, u8)> {
        match self {
            Ended::Exited(0 | super::UNFINISHED, _) => None,
            Ended::Exited(code, said) => {
                let lines: Vec<&str> = said.lines().filter(|line| !line.trim().is_empty()).collect();
                let chosen = lines.iter().find(|line| line.starts_with("error: ")).or(lines.last());
                let words = chosen.map_or("it said nothing", |line| line.strip_prefix("error: ").unwrap_or(line));
                Some((format!("{words} (exit code {code})"), *code))
            }
            Ended::Killed(9) => Some(("it was killed (signal 9): did its memory run out?".into(), 1)),
            Ended::Killed(signal) => Some((format!("it was ended by signal {signal}"), 1)),
            Ended::NotStarted(e) => Some((format!("it could not be started: {e}"), 1)),
        }
    }

    /// The exit code of somebody who wants everything to stop.
    fn interruption(&self) -> Option<u8> {
        match self {
            Ended::Exited(code @ (130 | 143), _) => Some(*code),
            Ended::Killed(signal @ (2 | 15)) => Some(128 + *signal as u8),
            _ => None,
        }
    }
}

#[cfg(unix)]
fn signal(output: &Output) -> i32 {
    std::os::unix::process::ExitStatusExt::signal(&output.status).unwrap_or(0)
}

#[cfg(not(unix))]
fn signal(_: &Output) -> i32 {
    0
}

/// Runs all points, so many at a time, and tells of each as it ends. The exit code if they were interrupted; no further one is
/// begun then.
pub fn run_all(
    points: &[usize],
    jobs: usize,
    start: impl Fn(usize) -> io::Result<Output> + Sync,
    mut ended: impl FnMut(usize, &Ended),
) -> Option<u8> {
    let next = Mutex::new(points.iter());
    let stop = AtomicBool::new(false);
    let mut interrupted = None;
    thread::scope(|scope| {
        let (sender, receiver) = mpsc::channel();
        for _ in 0..jobs.min(points.len()) {
            let sender = sender.clone();
            scope.spawn(|| {
                let sender = sender;
                let free = || next.lock().ok()?.next().copied().filter(|_| !stop.load(Ordering::Relaxed));
                while let Some(point) = free() {
                    // nobody listens only when everything is over
                    let _ = sender.send((point, Ended::of(start(point))));
                }
            });
        }
        drop(sender);
        for (point, how) in receiver {
            ended(point, &how);
            if let Some(code) = how.interruption() {
                stop.store(true, Ordering::Relaxed);
                interrupted = Some(code);
            }
        }
    });
    interrupted
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::process::Command;

    fn program(script: &str) -> io::Result<Output> {
        Command::new("sh").args(["-c", script]).output()
    }

    #[test]
    #[cfg(unix)]
    fn every_point_runs_once_and_a_failure_is_told_in_the_words_of_the_program() {
        let scripts = ["exit 0", "echo warned >&2; echo error: no field >&2; exit 2", "kill -9 $$", "exit 3", "exit 1"];
        let mut told: Vec<(usize, Option<(String, u8)>)> = Vec::new();
        let stopped = run_all(&[0, 1, 2, 3, 4], 2, |k| program(scripts[k]), |k, how| told.push((k, how.failure())));
        assert_eq!(stopped, None);
        told.sort();
        let words = |k: usize| told[k].1.as_ref().map(|(words, code)| (words.as_str(), *code));
        assert_eq!(told.iter().map(|t| t.0).collect::<Vec<_>>(), [0, 1, 2, 3, 4]);
        assert_eq!((words(0), words(3)), (None, None));
        assert_eq!(words(1), Some(("no field (exit code 2)", 2)));
        assert_eq!(words(2), Some(("it was killed (signal 9): did its memory run out?", 1)));
        assert_eq!(words(4), Some(("it said nothing (exit code 1)", 1)));
    }

    #[test]
    #[cfg(unix)]
    fn an_interruption_stops_what_has_not_begun() {
        for (script, code) in [("exit 130", 130), ("kill -15 $$", 143)] {
            let mut begun = 0;
            let points: Vec<usize> = (0..50).collect();
            assert_eq!(run_all(&points, 1, |_| program(script), |_, _| begun += 1), Some(code));
            assert!(begun < 50, "{begun}");
        }
    }

    #[test]
    fn what_cannot_be_started_is_told() {
        let mut said = Vec::new();
        let start = |_| Err(io::Error::from(io::ErrorKind::NotFound));
        run_all(&[7], 3, start, |k, how| said.push((k, how.failure().map(|f| f.1))));
        assert_eq!(said, [(7, Some(1))]);
    }
}
