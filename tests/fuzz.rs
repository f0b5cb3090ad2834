//! Some thousand mutated configs and files; `cargo bench --bench fuzz -- 10000000` runs millions.

#[path = "../benches/fuzz/cases.rs"]
mod cases;

use cases::{Corpus, Kind};
use std::time::Instant;

#[test]
fn mutated_configs_and_files_are_read_or_refused_in_words_without_a_panic() {
    let folder = tempfile::tempdir().unwrap();
    let corpus = Corpus::new(folder.path());
    for kind in [Kind::Configs, Kind::Files] {
        let mut read = 0;
        for number in 0..20_000 {
            let started = Instant::now();
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
