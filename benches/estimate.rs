//! What `check` says of the time of each shipped config against the time that its run takes of the processor, and of its gradients:
//! `cargo bench --bench estimate`. All are to be within a factor of 3.

use cpu_time::ProcessTime;
use spinneb::config::estimate::Estimate;
use spinneb::config::load;
use spinneb::drive::{self, Scales, Silent};
use spinneb::output::{Group, render_files};
use std::path::Path;

/// Largest factor between what is said and what is taken.
const FACTOR: f64 = 3.0;

fn main() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs");
    let entries = folder.read_dir().expect("the shipped configs").flatten().map(|entry| entry.path());
    let mut configs: Vec<_> = entries.filter(|path| path.extension().is_some_and(|e| e == "json")).collect();
    configs.sort();
    println!(
        "{:22}{:>10}{:>10}{:>8}{:>12}{:>12}{:>8}",
        "config", "s said", "s taken", "factor", "gradients", "taken", "factor"
    );
    let mut wrong = 0;
    for path in configs {
        let loaded = load(&path, &[]).expect("a shipped config");
        let problem = loaded.problem().expect("a shipped config");
        let scales = Scales::of_terms(&problem.hamiltonian);
        let estimate = Estimate::of(&problem, &scales);
        let said = estimate.processor_seconds(&loaded, &problem, &scales);
        let start = ProcessTime::now();
        let outcome = drive::run(&problem, &mut Silent).expect("a result");
        let output = &loaded.config.output;
        let report = loaded.report(&outcome).expect("a report");
        let files = render_files(&report, |kind| match kind.group {
            Group::Always => true,
            Group::Formats | Group::OnRequest => output.formats.iter().any(|name| name == kind.name),
            Group::Plots => output.plots.iter().any(|name| name == kind.name),
        });
        assert!(!files.expect("files").is_empty());
        let taken = start.elapsed().as_secs_f64();
        let gradients = outcome.work.force_evaluations;
        let (time, work) = (said / taken, estimate.evaluations as f64 / gradients as f64);
        let inside = [time, work].iter().all(|x| (1.0 / FACTOR..=FACTOR).contains(x));
        wrong += usize::from(!inside);
        println!(
            "{:22}{said:>10.2}{taken:>10.2}{time:>8.2}{:>12}{gradients:>12}{work:>8.2}{}",
            loaded.name,
            estimate.evaluations,
            if inside { "" } else { "  !" }
        );
    }
    assert!(wrong == 0, "{wrong} configs take more or less than {FACTOR} times what is said");
}
