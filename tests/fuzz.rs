//! Some thousand mutated configs and files, and some dozen configs run; `cargo bench --bench fuzz` runs as many as one likes.

#[path = "../benches/fuzz/arrays.rs"]
mod arrays;
#[path = "../benches/fuzz/cases.rs"]
mod cases;
#[path = "../benches/fuzz/check.rs"]
mod check;
#[path = "../benches/fuzz/physical.rs"]
mod physical;
#[path = "../benches/fuzz/reader.rs"]
mod reader;
#[path = "../benches/fuzz/runs.rs"]
mod runs;
#[path = "../benches/fuzz/writer.rs"]
mod writer;

use cases::{Corpus, Kind};
use cpu_time::ThreadTime;
use std::path::Path;

#[test]
fn mutated_configs_and_files_are_read_or_refused_in_words_without_a_panic() {
    let folder = tempfile::tempdir().unwrap();
    let corpus = Corpus::new(folder.path());
    for kind in [Kind::Configs, Kind::Files] {
        let mut read = 0;
        for number in 0..20_000 {
            let started = ThreadTime::now();
            match corpus.run(kind, 7, number) {
                Ok(was_read) => read += u64::from(was_read),
                Err(what) => panic!("{kind:?}, case {number}: {what}"),
            }
            assert!(started.elapsed().as_secs() < 5, "{kind:?}, case {number} takes long");
        }
        // mutations that all are refused at the first byte would show nothing
        assert!(read > 500, "{kind:?}: {read} were read");
    }
}

#[test]
#[cfg(unix)]
fn mutated_configs_run_to_results_that_agree_with_themselves() {
    let folder = tempfile::tempdir().unwrap();
    let runs = runs::Runs::new(Path::new(env!("CARGO_BIN_EXE_spinneb")), folder.path(), 7);
    let tally = runs.batch(0..50).and(runs.batch(50..100));
    println!("{tally}");
    assert!(tally.faults.is_empty(), "{tally}\n{:#?}", tally.faults);
    // configs that all are refused would show nothing
    assert!(tally.runs > 50 && tally.certified > 20 && tally.in_sweeps > 0 && tally.drawn_anew > 0, "{tally}");
}
