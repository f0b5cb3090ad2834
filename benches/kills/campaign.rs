//! Runs that are killed at random moments and go on: what a directory holds must be right at any time, and the end the same as
//! without a kill, to the last bit.

#[path = "files.rs"]
mod files;

use files::files;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Short runs that pass through everything that is recorded: a row of minima, a plain reversal, a slow method that does not
/// converge and writes folders of files, a ring, magnetostatics, a state from a file.
const CONFIGS: [(&str, &str); 6] = [
    (
        "row",
        r#"{"lattice": {"chain": {"sites": 14}}, "energy": [{"anisotropy": {"K": "9.5 meV", "axis": [0, 0, 1]}}],
            "rates": {"temperatures": ["300 K"]}}"#,
    ),
    ("reversal", r#"{"lattice": {"chain": {"sites": 100}}}"#),
    (
        "slow",
        r#"{"lattice": {"chain": {"sites": 30}}, "path": {"images": 11, "guess": {"sweep": {"from": "left"}}},
            "neb": {"optimiser": {"velocity_projection": {}}, "max_evaluations": 300},
            "output": {"formats": ["csv", "npz", "ovf_images", "vtk"], "plots": []}}"#,
    ),
    (
        "ring",
        r#"{"lattice": {"chain": {"sites": 60, "periodic": true}}, "energy": [{"zeeman": {"B": ["0 T", "0 T", "-1 T"]}}]}"#,
    ),
    (
        "demag",
        r#"{"lattice": {"chain": {"sites": 40, "spacing": "5 nm", "cross_section": ["20 nm", "5 nm"]}},
            "material": {"name": "soft", "Ms": "800 kA/m", "energy": [{"exchange": {"A": "13 pJ/m"}}, {"demag": {}}]},
            "initial": {"uniform": {"direction": [1, 0, 0]}}, "final": {"uniform": {"direction": [-1, 0, 0]}}}"#,
    ),
    (
        "from_file",
        r#"{"lattice": {"chain": {"sites": 24}}, "initial": {"file": {"path": "up.csv", "segment": 0}},
            "final": {"file": {"path": "up.csv", "segment": 1}}, "output": {"formats": ["csv", "ovf_images"], "plots": []}}"#,
    ),
];

/// What the configs have unless they say otherwise.
const USUAL: &str = r#"{
    "material": {"name": "toy", "moment": "2 mu_B",
        "energy": [{"exchange": {"J": ["10 meV"]}}, {"anisotropy": {"K": "0.5 meV", "axis": [0, 0, 1]}}]},
    "initial": {"uniform": {"direction": [0, 0, 1]}}, "final": {"uniform": {"direction": [0, 0, -1]}},
    "output": {"formats": ["csv", "npz", "ovf"], "plots": ["svg"]}}"#;

/// Every tenth kill is one of these signals instead, with its exit code.
const SIGNALS: [(&str, i32); 2] = [("INT", 130), ("TERM", 143)];

/// What was done.
#[derive(Debug, Default)]
pub struct Tally {
    /// Processes killed at work.
    pub kills: usize,
    /// Processes interrupted or terminated at work, which ended in good order.
    pub signals: usize,
    /// Processes that were killed after they had nothing left to do.
    pub too_late: usize,
    /// Kills after which there was a checkpoint to go on from.
    pub with_checkpoint: usize,
    /// Processes that found finished steps in a checkpoint and went on from there.
    pub went_on: usize,
    /// Kills between the first and the last file of a result.
    pub while_writing: usize,
    /// Runs that were brought to their end, each equal to the one that nobody disturbed.
    pub ends: usize,
}

impl Tally {
    /// A process goes on from at least the steps that one before it found, if it lives long enough to say anything.
    fn goes_on(&mut self, steps: &mut usize, said: &str, killed: bool) {
        let words = said.split_once("going on from the checkpoint, with ").and_then(|(_, rest)| rest.split(' ').next());
        match words.and_then(|n| n.parse().ok()) {
            Some(found) => {
                assert!(found >= *steps, "{found} steps are left of {steps}: {said}");
                *steps = found;
                self.went_on += usize::from(found > 0);
            }
            None => {
                // one that is killed between its words on a torn end of the journal and these has not begun anew
                let cut_short = killed && !said.contains("starting anew");
                let nothing_to_do = said.trim().is_empty() || said.contains("holds the finished result");
                assert!(*steps == 0 || cut_short || nothing_to_do, "{steps} finished steps are not used: {said}");
            }
        }
    }
}

/// A directory with the configs, and the ends of the runs that nobody disturbs.
pub struct Campaign<'a> {
    program: &'a Path,
    folder: &'a Path,
    random: ChaCha8Rng,
    cases: Vec<Case>,
}

struct Case {
    config: PathBuf,
    /// Its files, `summary.json` without what may differ.
    files: BTreeMap<String, Vec<u8>>,
    code: Option<i32>,
    /// How long it takes with a checkpoint after every iteration, as far as the machine's other work tells.
    takes: Duration,
}

impl<'a> Campaign<'a> {
    /// Kills the program's runs in `folder`, at the moments that a seed tells.
    pub fn new(program: &'a Path, folder: &'a Path, seed: u64) -> Campaign<'a> {
        let mut campaign = Campaign { program, folder, random: ChaCha8Rng::seed_from_u64(seed), cases: Vec::new() };
        let image = |k: usize, z: f64| (0..24).map(|i| format!("{k} {i} 0 0 {z}\n")).collect::<String>();
        let spins = format!("image site m_x m_y m_z\n{}{}", image(0, 1.0), image(1, -1.0));
        fs::write(folder.join("up.csv"), spins).unwrap();
        for (name, rest) in CONFIGS {
            let config = folder.join(format!("{name}.json"));
            let mut whole: Map<String, Value> = serde_json::from_str(USUAL).unwrap();
            whole.extend(serde_json::from_str::<Map<String, Value>>(rest).unwrap());
            fs::write(&config, Value::from(whole).to_string()).unwrap();
            let [plain, watched] = ["off", "0 s"].map(|every| {
                let out = folder.join(format!("{name} {every}"));
                let started = Instant::now();
                let code = campaign.start(&config, &out, every, &[]).wait().unwrap().code();
                (code, files(&out), started.elapsed())
            });
            assert!(matches!(plain.0, Some(0 | 3)), "{name}: exit code {:?}", plain.0);
            assert_eq!((plain.0, &plain.1), (watched.0, &watched.1), "{name}: checkpoints change the result");
            campaign.cases.push(Case { config, files: plain.1, code: plain.0, takes: watched.2 });
        }
        campaign
    }

    fn start(&self, config: &Path, out: &Path, every: &str, more: &[&str]) -> Child {
        let mut command = Command::new(self.program);
        command.arg("run").arg(config).arg("--out").arg(out).args(["--checkpoint-every", every]).args(more);
        command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
    }

    /// Until so many processes were killed at work.
    pub fn kill(&mut self, count: usize) -> Tally {
        let mut tally = Tally::default();
        while tally.kills + tally.signals < count {
            let case = tally.ends % self.cases.len();
            let out = self.folder.join(format!("run_{}", tally.ends));
            let mut steps = 0;
            for _ in 0..self.random.random_range(1..=5) {
                if tally.kills + tally.signals == count {
                    break;
                }
                let before = tally.too_late;
                self.kill_once(case, &out, &mut steps, &mut tally);
                let late = tally.too_late > before;
                let takes = &mut self.cases[case].takes;
                *takes = takes.mul_f64(if late { 0.85 } else { 1.04 });
                if late {
                    break;
                }
            }
            let (code, said) = ended(self.start(&self.cases[case].config, &out, "0 s", &["--resume"]));
            let case = &self.cases[case];
            tally.goes_on(&mut steps, &said, false);
            assert_eq!(code, case.code, "{}: {said}", out.display());
            let files = files(&out);
            let names = |files: &BTreeMap<String, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
            assert_eq!(names(&files), names(&case.files), "{}: {said}", out.display());
            for (name, bytes) in &files {
                assert!(*bytes == case.files[name], "{}: {name} is another one: {said}", out.display());
            }
            fs::remove_dir_all(&out).unwrap();
            tally.ends += 1;
        }
        tally
    }

    fn kill_once(&mut self, case: usize, out: &Path, steps: &mut usize, tally: &mut Tally) {
        let threads = ["--resume", "--threads", ["1", "2"][self.random.random_range(0..2)]];
        let signal = (self.random.random_range(0..10) == 0).then(|| SIGNALS[self.random.random_range(0..2)]);
        let takes = self.cases[case].takes;
        let moment = takes.mul_f64(self.random.random_range(0.0..1.1));
        let mut child = self.start(&self.cases[case].config, out, "0 s", &threads);
        std::thread::sleep(moment);
        if child.try_wait().unwrap().is_some() {
            tally.too_late += 1;
            return;
        }
        match signal {
            None => child.kill().unwrap(),
            Some((name, _)) => {
                let line = format!("kill -{name} {}", child.id());
                assert!(Command::new("sh").args(["-c", &line]).status().unwrap().success());
            }
        }
        let (code, said) = ended(child);
        tally.goes_on(steps, &said, code.is_none());
        let case = &self.cases[case];
        match (signal, code) {
            (None, None) => tally.kills += 1,
            // before it watches for signals, and after its last word, it is ended by the signal itself or ends as usual
            (Some((_, expected)), Some(code)) if code == expected => {
                tally.signals += 1;
                let partial: Value = serde_json::from_slice(&fs::read(out.join("partial.json")).unwrap()).unwrap();
                assert_eq!(partial["partial"], true, "{said}");
                assert!(out.join("checkpoint/journal").is_file(), "{said}");
            }
            (Some(_), None) => tally.kills += 1,
            (_, code) if code == case.code => tally.too_late += 1,
            (_, code) => panic!("{}: exit code {code:?}: {said}", out.display()),
        }
        self.is_right(case, out, tally);
    }

    /// Whatever has the name of a file of the result is that file, whole, and the mark is there only with all of them.
    fn is_right(&self, case: &Case, out: &Path, tally: &mut Tally) {
        tally.with_checkpoint += usize::from(out.join("checkpoint/journal").is_file());
        let files = files(out);
        let own: Vec<&String> = files.keys().filter(|name| case.files.contains_key(*name)).collect();
        for name in &own {
            assert!(files[*name] == case.files[*name], "{}: half a file {name}", out.display());
        }
        let finished = files.contains_key("summary.json");
        assert!(!finished || own.len() == case.files.len(), "{}: a mark without all files", out.display());
        tally.while_writing += usize::from(!finished && !own.is_empty());
        let others = files.keys().filter(|name| !case.files.contains_key(*name));
        for name in others {
            let known = ["checkpoint/", "partial"].iter().any(|start| name.starts_with(start))
                || name.rsplit('/').next().is_some_and(|last| last.starts_with(".spinneb"));
            assert!(known, "{}: an unknown file {name}", out.display());
        }
    }
}

/// The exit code, none if it was killed, and what was said.
fn ended(mut child: Child) -> (Option<i32>, String) {
    let mut said = String::new();
    child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
    (child.wait().unwrap().code(), said)
}
