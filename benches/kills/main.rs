//! Kills runs at random moments and lets them go on: `cargo bench --bench kills -- 1000` (a seed may follow the number).

mod campaign;

use campaign::Campaign;
use std::path::Path;
use std::time::Instant;

fn main() {
    let numbers: Vec<u64> = std::env::args().skip(1).filter_map(|word| word.parse().ok()).collect();
    let count = numbers.first().map_or(1000, |n| *n as usize);
    let seed = numbers.get(1).copied().unwrap_or(1);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let started = Instant::now();
    let mut campaign = Campaign::new(Path::new(env!("CARGO_BIN_EXE_spinneb")), folder.path(), seed);
    let tally = campaign.kill(count);
    println!("seed {seed}, {:.0} s: {tally:#?}", started.elapsed().as_secs_f64());
    assert!(tally.went_on > tally.with_checkpoint / 2, "resumes begin anew");
}
