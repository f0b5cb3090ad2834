//! Runs that are stopped and go on: wherever that happens, the end is the same to the last bit.

use crate::common::Build;
use rand::{RngExt, SeedableRng};
use spinneb::drive::{HistoryRow, Images, Observer, Outcome, Partial, Problem, Silent, run};
use spinneb::error::Error;
use spinneb::geometry::Direction;
use spinneb::optimise::OptimiserSpec;
use spinneb::path::Path;
use spinneb::path::guess::GuessSpec;
use spinneb::record::Keep;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

/// What outlives a run.
#[derive(Clone, Debug, Default)]
struct Stored {
    finished: Vec<Vec<u8>>,
    underway: Option<(usize, Vec<u8>)>,
}

/// A record in memory, which stops the run at its `left`-th chance.
struct Memory {
    stored: Arc<Mutex<Stored>>,
    left: usize,
    switch: Arc<AtomicBool>,
    chances: Arc<Mutex<usize>>,
}

impl Keep for Memory {
    fn finished(&mut self, k: usize) -> Option<Vec<u8>> {
        self.stored.lock().unwrap().finished.get(k).cloned()
    }

    fn underway(&mut self, k: usize) -> Option<Vec<u8>> {
        self.stored.lock().unwrap().underway.clone().filter(|(place, _)| *place == k).map(|(_, state)| state)
    }

    fn add(&mut self, k: usize, record: Vec<u8>) {
        let mut stored = self.stored.lock().unwrap();
        stored.finished.truncate(k);
        stored.finished.push(record);
    }

    fn is_due(&mut self) -> bool {
        *self.chances.lock().unwrap() += 1;
        self.left = self.left.saturating_sub(1);
        if self.left == 0 {
            self.switch.store(true, Ordering::Relaxed);
        }
        false
    }

    fn save(&mut self, k: usize, underway: Option<Vec<u8>>) {
        self.stored.lock().unwrap().underway = underway.map(|state| (k, state));
    }
}

/// What one sitting came to.
struct Sitting {
    outcome: Option<Outcome>,
    partial: Option<Partial>,
    taken: usize,
    chances: usize,
}

/// Keeps the last band it is shown.
struct Watcher(Option<Partial>);

impl Observer for Watcher {
    fn iteration(&mut self, _: &HistoryRow) {}

    fn relaxed(&mut self, path: &Path, history: &[HistoryRow]) {
        self.0 = Some(Partial { path: path.clone(), history: history.to_vec() });
    }
}

/// Runs until the end, or until chance `until`.
fn sit(make: &dyn Fn() -> Problem, stored: &Arc<Mutex<Stored>>, until: usize) -> Sitting {
    let mut problem = make();
    let (switch, chances) = (Arc::new(AtomicBool::new(false)), Arc::new(Mutex::new(0)));
    problem.control.obey(Arc::clone(&switch));
    let keep = Memory { stored: Arc::clone(stored), left: until, switch, chances: Arc::clone(&chances) };
    problem.control.record(Box::new(keep));
    let mut watcher = Watcher(None);
    let outcome = match run(&problem, &mut watcher) {
        Ok(outcome) => Some(outcome),
        Err(Error::Stopped) => None,
        Err(other) => panic!("{other}"),
    };
    let chances = *chances.lock().unwrap();
    Sitting { outcome, partial: watcher.0, taken: problem.control.recorder().taken(), chances }
}

/// Every number of an outcome, to the bit, but for the time it took.
fn told(mut outcome: Outcome) -> String {
    outcome.work.seconds = 0.0;
    outcome.work.threads = 0;
    format!("{outcome:?}")
}

/// Stops a run at `stops` places spread over it, goes on each time, and at all of them one after the other.
fn survives(what: &str, make: &dyn Fn() -> Problem, stops: usize) {
    let whole = told(run(&make(), &mut Silent).unwrap());
    let all = sit(make, &Arc::default(), usize::MAX);
    assert_eq!(told(all.outcome.unwrap()), whole, "{what}: recorded");
    let chances = all.chances;
    assert!(chances > stops, "{what}: only {chances} places to stop at");
    for stop in 0..stops {
        let stored = Arc::default();
        let at = 1 + stop * (chances - 1) / stops;
        let first = sit(make, &stored, at);
        assert!(first.outcome.is_none(), "{what}: not stopped at {at} of {chances}");
        let second = sit(make, &stored, usize::MAX);
        assert_eq!(told(second.outcome.unwrap()), whole, "{what}: stopped at {at} of {chances}");
        assert!(second.chances <= chances - at + 1, "{what}: {at} of {chances} done, then {}", second.chances);
    }
    let stored = Arc::default();
    let mut sittings = 0;
    let step = chances.div_ceil(stops);
    let end = loop {
        let some = sit(make, &stored, step);
        sittings += 1;
        if let Some(outcome) = some.outcome {
            assert!(some.taken > 0);
            break outcome;
        }
        assert!(sittings <= 2 * stops, "{what}: no progress in {sittings} sittings");
    };
    assert!(sittings > 1);
    assert_eq!(told(end), whole, "{what}: in {sittings} sittings");
}

fn guess(json: &str) -> Option<GuessSpec> {
    Some(serde_json::from_str(json).unwrap())
}

#[test]
fn a_default_run_goes_on_from_anywhere() {
    survives("reversal", &|| Build::open(20).easy(0.2).reversal(), 12);
}

#[test]
fn a_row_of_minima_goes_on_from_anywhere() {
    survives("K = J", &|| Build::open(8).easy(1.0).reversal(), 16);
}

#[test]
fn rings_and_hard_axes_go_on_from_anywhere() {
    survives("ring", &|| Build::ring(16).easy(0.3).field([0.0, 0.0, -0.1]).reversal(), 10);
    survives("hard axis", &|| Build::open(16).easy(0.1).hard(0.3).reversal(), 10);
}

#[test]
fn every_optimiser_goes_on_from_anywhere() {
    for optimiser in [r#"{"preconditioned": {}}"#, r#"{"velocity_projection": {}}"#, r#"{"lbfgs": {"memory": 3}}"#] {
        let make = || {
            let mut problem = Build::open(10).easy(0.3).hard(0.2).reversal();
            problem.guess = guess(r#"{"sweep": {"from": "left"}}"#);
            problem.images = Images::Count(9);
            problem.neb.optimiser = serde_json::from_str::<OptimiserSpec>(optimiser).unwrap();
            problem.neb.max_evaluations = 300;
            problem
        };
        survives(optimiser, &make, 8);
    }
}

#[test]
fn a_climbing_band_between_ends_as_given_goes_on_from_anywhere() {
    let make = || {
        let build = Build::open(30).easy(0.1).defect(10, -0.05).defect(20, -0.05);
        let [a, b] = [10.0, 20.0].map(|site| build.wall(site, 5f64.sqrt(), Direction::X));
        let mut problem = build.problem(a, b);
        problem.relax_ends = false;
        problem.refine = false;
        problem.guess = guess(r#"{"geodesic": {}}"#);
        problem
    };
    survives("ends as given", &make, 8);
}

#[test]
fn a_stopped_run_says_so_and_shows_its_band() {
    let make = || Build::open(20).easy(0.2).reversal();
    let stored: Arc<Mutex<Stored>> = Arc::default();
    let stopped = sit(&make, &stored, 9);
    assert!(stopped.outcome.is_none());
    let partial = stopped.partial.expect("a band was being relaxed");
    assert_eq!(partial.path.sites(), 20);
    let shown = spinneb::drive::partial(&make(), &partial, "stopped");
    assert!(!shown.converged && !shown.certified && shown.barrier.is_none());
    assert_eq!((shown.stop_reason.as_str(), shown.images.energy_mev.len()), ("stopped", shown.path.images()));
}

#[test]
fn a_library_user_can_stop_a_run_without_any_record() {
    let problem = Build::open(20).easy(0.2).reversal();
    problem.control.switch().store(true, Ordering::Relaxed);
    assert!(matches!(run(&problem, &mut Silent), Err(Error::Stopped)));
    let problem = Build::open(20_000).easy(0.2).reversal();
    let switch = Arc::clone(problem.control.switch());
    let stopped = std::thread::scope(|scope| {
        let run = scope.spawn(|| run(&problem, &mut Silent));
        std::thread::sleep(std::time::Duration::from_millis(20));
        switch.store(true, Ordering::Relaxed);
        run.join().unwrap()
    });
    assert!(matches!(stopped, Err(Error::Stopped)));
}

#[test]
fn a_record_of_another_problem_or_a_damaged_one_changes_nothing() {
    let make = || Build::open(14).easy(0.2).reversal();
    let whole = told(run(&make(), &mut Silent).unwrap());
    let stored: Arc<Mutex<Stored>> = Arc::default();
    sit(&|| Build::open(14).easy(0.25).reversal(), &stored, 15);
    let foreign = sit(&make, &stored, usize::MAX);
    assert_eq!(told(foreign.outcome.unwrap()), whole);
    assert_eq!(foreign.taken, 0);

    let good: Arc<Mutex<Stored>> = Arc::default();
    sit(&make, &good, 15);
    let records = good.lock().unwrap().clone();
    assert!(records.finished.len() > 4);
    for k in 0..records.finished.len() {
        let mut bad = records.clone();
        let half = bad.finished[k].len() / 2;
        bad.finished[k].truncate(half);
        let run = sit(&make, &Arc::new(Mutex::new(bad)), usize::MAX);
        assert_eq!(told(run.outcome.unwrap()), whole, "record {k} cut short");
        assert_eq!(run.taken, k);
    }
}

/// Goes on from a record until the end or an error, or for two seconds: whether it panicked.
fn panics(make: &dyn Fn() -> Problem, stored: Stored) -> bool {
    let mut problem = make();
    let switch = Arc::new(AtomicBool::new(false));
    problem.control.obey(Arc::clone(&switch));
    let stored = Arc::new(Mutex::new(stored));
    let keep = Memory { stored, left: usize::MAX, switch: Arc::clone(&switch), chances: Arc::default() };
    problem.control.record(Box::new(keep));
    let (done, over) = std::sync::mpsc::channel::<()>();
    std::thread::scope(|scope| {
        scope.spawn(move || {
            let _ = over.recv_timeout(std::time::Duration::from_secs(2));
            switch.store(true, Ordering::Relaxed);
        });
        let work = || run(&problem, &mut Silent).is_ok();
        let ended = std::panic::catch_unwind(std::panic::AssertUnwindSafe(work));
        drop(done);
        ended.is_err()
    })
}

#[test]
fn whatever_a_record_says_no_run_panics() {
    let row = || Build::open(6).easy(1.0).reversal();
    let slow = || {
        let mut problem = Build::open(6).easy(0.3).hard(0.2).reversal();
        problem.guess = guess(r#"{"sweep": {"from": "left"}}"#);
        problem.images = Images::Count(7);
        problem.neb.optimiser = serde_json::from_str::<OptimiserSpec>(r#"{"lbfgs": {"memory": 3}}"#).unwrap();
        problem.neb.max_evaluations = 300;
        problem
    };
    let nasty = [f64::NAN, f64::INFINITY, -1e300, 1e-300, 0.0, -1.0, 1.5, 1e160].map(f64::to_bits);
    let nasty = nasty.into_iter().chain([1, 2, 3, 1 << 20, 1 << 40, u64::MAX, u64::MAX >> 1]);
    let nasty: Vec<u64> = nasty.collect();
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(11);
    let mut changed = 0;
    for (what, make) in [("row", &row as &dyn Fn() -> Problem), ("slow", &slow)] {
        let chances = sit(make, &Arc::default(), usize::MAX).chances;
        for part in 1..=4 {
            let stored: Arc<Mutex<Stored>> = Arc::default();
            sit(make, &stored, (part * chances / 4).max(2) - 1);
            let good = stored.lock().unwrap().clone();
            for _ in 0..100 {
                let mut bad = good.clone();
                let count = bad.finished.len() + usize::from(bad.underway.is_some());
                if count == 0 {
                    break;
                }
                let k = random.random_range(0..count);
                let last = bad.finished.len();
                let record = if k < last { &mut bad.finished[k] } else { &mut bad.underway.as_mut().unwrap().1 };
                // the first bytes are the fingerprint of the input: another one is no answer at all; the counts are at the
                // beginning and the end, between them rows of numbers behind their lengths
                let at = match random.random_range(0..3) {
                    0 => 5 + random.random_range(0..16),
                    1 => record.len().saturating_sub(30) + random.random_range(0..22),
                    _ => random.random_range(5..record.len().max(6)),
                };
                let at = at.min(record.len().saturating_sub(8));
                let value = nasty[random.random_range(0..nasty.len())];
                let length = [1, 8][random.random_range(0..2)];
                record[at..at + length].copy_from_slice(&value.to_le_bytes()[..length]);
                assert!(!panics(make, bad), "{what}: {value:#x} at {at} of record {k}");
                changed += 1;
            }
        }
    }
    assert!(changed >= 400, "{changed}");
}
