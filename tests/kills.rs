//! Fifty kills; `tests/kills/run.sh 1000` makes it a thousand.
#![cfg(unix)]

#[path = "../benches/kills/campaign.rs"]
mod campaign;

use campaign::Campaign;
use std::path::Path;

#[test]
fn killed_runs_leave_nothing_half_and_go_on_to_the_same_end() {
    let folder = tempfile::tempdir().unwrap();
    let mut campaign = Campaign::new(Path::new(env!("CARGO_BIN_EXE_spinneb")), folder.path(), 7);
    let tally = campaign.kill(50);
    println!("{tally:#?}");
    // kills that all come before the first checkpoint would show nothing
    assert!(tally.with_checkpoint > 20, "{tally:?}");
    // and so would runs that all begin anew; on a busy machine many are killed before they say that they go on
    assert!(tally.went_on > tally.with_checkpoint / 4, "{tally:?}");
}
