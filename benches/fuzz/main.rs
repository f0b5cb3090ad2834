//! Mutated configs and files of spins by the million: `cargo bench --bench fuzz -- 10000000 [SEED]` (as many of each kind).
//!
//! No panic, no second of work for a case, no gigabyte of memory; the first case that breaks this is printed with its number, and
//! the exit code is 1. The same seed gives the same cases. A small number runs in `tests/fuzz.rs`.

mod arrays;
mod cases;
mod check;
mod physical;
mod reader;
mod runs;
mod writer;

use cases::{Corpus, Kind};
use cpu_time::ThreadTime;
use runs::{Runs, Tally};
use std::process::exit;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// A case may take this long (s of its thread).
const LONGEST_S: f64 = 1.0;
/// After this long (s of the clock) a case hangs.
const HANGS_S: u64 = 20;

/// So many configs at a time, most of them in one process.
const BATCH: u64 = 40;

fn main() {
    if let Some(at) = std::env::args().position(|a| a == "run") {
        let numbers: Vec<u64> = std::env::args().skip(at + 1).filter_map(|a| a.parse().ok()).collect();
        return campaign(numbers.first().copied().unwrap_or(1000), numbers.get(1).copied().unwrap_or(1));
    }
    let numbers: Vec<u64> = std::env::args().filter_map(|a| a.parse().ok()).collect();
    let (count, seed) = (numbers.first().copied().unwrap_or(20_000), numbers.get(1).copied().unwrap_or(1));
    let folder = tempfile::tempdir().expect("a folder to write in");
    let corpus = Corpus::new(folder.path());
    std::panic::set_hook(Box::new(|panic| eprintln!("{panic}")));
    for kind in [Kind::Configs, Kind::Files] {
        let started = Instant::now();
        let (slowest, read) = all(&corpus, kind, seed, count);
        let seconds = started.elapsed().as_secs_f64();
        println!(
            "{kind:?}: {count} cases of seed {seed}, {read} of them read and the others refused, in {seconds:.0} s; the slowest \
             took {:.1} ms; {}",
            1e3 * slowest,
            memory()
        );
    }
}

/// Mutated configs as a user runs them, until so many have run; faults are told as they are found, and their configs are kept.
fn campaign(count: u64, seed: u64) {
    let started = Instant::now();
    let program = std::env::var_os("SPINNEB").map_or(env!("CARGO_BIN_EXE_spinneb").into(), std::path::PathBuf::from);
    let folder = tempfile::tempdir().expect("a folder to write in").keep();
    println!("in {}", folder.display());
    let runs = Runs::new(&program, &folder, seed);
    let (next, total) = (AtomicU64::new(0), Mutex::new(Tally::default()));
    std::panic::set_hook(Box::new(|panic| eprintln!("{panic}")));
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, |n| n.get()) {
            scope.spawn(|| {
                while total.lock().expect("no panic").runs < count as usize {
                    let first = next.fetch_add(BATCH, Ordering::Relaxed);
                    let tally = runs.batch(first..first + BATCH);
                    tally.faults.iter().for_each(|(number, what)| println!("config {number}: {what}"));
                    let mut total = total.lock().expect("no panic");
                    *total = std::mem::take(&mut *total).and(tally);
                }
            });
        }
    });
    let total = total.into_inner().expect("no panic");
    println!("seed {seed}, {:.0} s: {total}", started.elapsed().as_secs_f64());
    if !total.faults.is_empty() {
        exit(1);
    }
}

/// Runs all cases; the longest time that one took (s), and how many were read.
fn all(corpus: &Corpus, kind: Kind, seed: u64, count: u64) -> (f64, u64) {
    let threads = thread::available_parallelism().map_or(1, |n| n.get()) as u64;
    let (now, done) = ((0..threads).map(|_| AtomicU64::new(0)).collect::<Vec<_>>(), AtomicBool::new(false));
    thread::scope(|scope| {
        let workers: Vec<_> = (0..threads)
            .map(|t| {
                let now = &now[t as usize];
                scope.spawn(move || {
                    let (mut slowest, mut read) = (0.0f64, 0);
                    for number in (t..count).step_by(threads as usize) {
                        now.store(number, Ordering::Relaxed);
                        let started = ThreadTime::now();
                        let outcome = corpus.run(kind, seed, number);
                        let seconds = started.elapsed().as_secs_f64();
                        slowest = slowest.max(seconds);
                        match outcome {
                            Ok(was_read) => read += u64::from(was_read),
                            Err(what) => broken(kind, number, &what),
                        }
                        if seconds > LONGEST_S {
                            broken(kind, number, &format!("{seconds:.1} s of work"));
                        }
                    }
                    now.store(u64::MAX, Ordering::Relaxed);
                    (slowest, read)
                })
            })
            .collect();
        scope.spawn(|| watch(kind, &now, &done));
        let results: Vec<(f64, u64)> = workers.into_iter().map(|w| w.join().expect("panics are caught")).collect();
        done.store(true, Ordering::Relaxed);
        results.into_iter().fold((0.0f64, 0), |(slowest, read), (s, r)| (slowest.max(s), read + r))
    })
}

/// Ends the program where a case does not end.
fn watch(kind: Kind, now: &[AtomicU64], done: &AtomicBool) {
    let mut seen: Vec<(u64, Instant)> = now.iter().map(|_| (u64::MAX, Instant::now())).collect();
    while !done.load(Ordering::Relaxed) {
        thread::sleep(Duration::from_millis(100));
        for (case, seen) in now.iter().zip(&mut seen) {
            let number = case.load(Ordering::Relaxed);
            if seen.0 != number {
                *seen = (number, Instant::now());
            } else if number != u64::MAX && seen.1.elapsed().as_secs() >= HANGS_S {
                broken(kind, number, "does not end");
            }
        }
    }
}

fn broken(kind: Kind, number: u64, what: &str) -> ! {
    println!("{kind:?}, case {number}: {what}");
    exit(1);
}

/// The most memory the program has had, where the system says it; more than a gigabyte ends it.
fn memory() -> String {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find_map(|l| l.strip_prefix("VmHWM:")?.strip_suffix("kB")?.trim().parse::<f64>().ok());
    match peak {
        Some(kib) if kib > 1e6 => {
            println!("{:.1} GB of memory", kib / 1e6);
            exit(1)
        }
        Some(kib) => format!("at most {:.0} MB of memory", kib / 1024.0),
        None => "memory not known on this system".into(),
    }
}
