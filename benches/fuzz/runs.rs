//! Mutated configs as a user runs them: in processes with limits of time and memory, and what came of them checked.

#[path = "../kills/files.rs"]
mod files;

use super::check::{faults, unproven};
use super::physical::Physical;
use files::files;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};
use spinneb::config::load_text;
use std::collections::BTreeMap;
use std::fmt;
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::ops::Range;
use std::panic::catch_unwind;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

/// A run takes longer than this only if something is wrong (s).
const LONGEST: Duration = Duration::from_secs(120);
/// Address space of a process (KiB).
const MEMORY_KIB: u64 = 8 << 20;

/// What was done, and what was found.
#[derive(Debug, Default)]
pub struct Tally {
    /// Configs that were made, and of these the ones that were refused as they were read.
    pub made: usize,
    pub refused: usize,
    /// Results that were checked, and of these the ones with a certificate and with rates.
    pub runs: usize,
    pub certified: usize,
    pub with_rates: usize,
    /// Results without a certificate whose saddles do not tell the barrier, or are out of order.
    pub doubtful: usize,
    /// Certified results with a dip of the path between its saddles that nobody looked at.
    pub unproven: usize,
    /// Runs again: on two threads, from their own config.json, after a kill (and of these from a checkpoint), by a sweep.
    pub on_two_threads: usize,
    pub from_their_own_config: usize,
    pub after_a_kill: usize,
    pub from_a_checkpoint: usize,
    pub in_sweeps: usize,
    /// Results drawn anew, and ends relaxed by themselves.
    pub drawn_anew: usize,
    pub relaxed: usize,
    /// Configs whose runs were ended because they took too long.
    pub endless: Vec<u64>,
    /// The number of a config and what was wrong.
    pub faults: Vec<(u64, String)>,
}

impl Tally {
    /// Both together.
    pub fn and(mut self, other: Tally) -> Tally {
        for (a, b) in self.counts().into_iter().zip(other.copied()) {
            *a += b;
        }
        self.endless.extend(other.endless);
        self.faults.extend(other.faults);
        self
    }

    fn counts(&mut self) -> [&mut usize; 14] {
        [
            &mut self.made,
            &mut self.refused,
            &mut self.runs,
            &mut self.certified,
            &mut self.with_rates,
            &mut self.doubtful,
            &mut self.unproven,
            &mut self.on_two_threads,
            &mut self.from_their_own_config,
            &mut self.after_a_kill,
            &mut self.from_a_checkpoint,
            &mut self.in_sweeps,
            &mut self.drawn_anew,
            &mut self.relaxed,
        ]
    }

    fn copied(&self) -> [usize; 14] {
        let mut copy = Tally { faults: Vec::new(), endless: Vec::new(), ..*self };
        copy.counts().map(|n| *n)
    }

    /// How many configs have faults of each kind, and one of them.
    fn kinds(&self) -> BTreeMap<String, (usize, u64)> {
        let mut kinds: BTreeMap<String, (usize, u64)> = BTreeMap::new();
        let mut seen = None;
        for (number, what) in &self.faults {
            let kind = kind(what);
            if seen.replace((*number, kind.clone())) != Some((*number, kind.clone())) {
                let entry = kinds.entry(kind).or_insert((0, *number));
                *entry = (entry.0 + 1, entry.1.min(*number));
            }
        }
        kinds
    }
}

/// A fault without its numbers.
fn kind(what: &str) -> String {
    let words = what.split_whitespace().filter(|w| !w.contains(|c: char| c.is_ascii_digit() || c == '/'));
    words.take(12).collect::<Vec<_>>().join(" ")
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let t = self;
        writeln!(f, "{} configs made, {} of them refused", t.made, t.refused)?;
        writeln!(
            f,
            "{} runs checked, {} of them certified ({} with a dip that nobody looked at), {} with rates, {} without a certificate \
             and with saddles that contradict the barrier or their order",
            t.runs, t.certified, t.unproven, t.with_rates, t.doubtful
        )?;
        writeln!(
            f,
            "run again: {} on two threads, {} from their own config.json, {} after a kill ({} of them from a checkpoint), {} \
             in sweeps",
            t.on_two_threads, t.from_their_own_config, t.after_a_kill, t.from_a_checkpoint, t.in_sweeps
        )?;
        writeln!(f, "{} drawn anew, {} relaxed by themselves", t.drawn_anew, t.relaxed)?;
        writeln!(f, "{} took longer than {LONGEST:?} and were ended: {:?}", t.endless.len(), t.endless)?;
        write!(f, "{} faults", t.faults.len())?;
        self.kinds().iter().try_for_each(|(kind, (n, first))| write!(f, "\n{n:6} configs, such as {first}: {kind}"))
    }
}

/// Where configs are made and run.
pub struct Runs<'a> {
    program: &'a Path,
    folder: &'a Path,
    physical: Physical,
    seed: u64,
}

/// A config that was read.
struct Case {
    number: u64,
    name: String,
    config: Value,
    /// What the energies of an image are made of (meV).
    scale: f64,
    file: PathBuf,
    random: ChaCha8Rng,
}

impl<'a> Runs<'a> {
    /// With a program, in a folder.
    pub fn new(program: &'a Path, folder: &'a Path, seed: u64) -> Runs<'a> {
        let configs = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs");
        Runs { program, folder, physical: Physical::new(&configs), seed }
    }

    /// Makes, runs and checks these configs.
    pub fn batch(&self, numbers: Range<u64>) -> Tally {
        let mut tally = Tally::default();
        let folder = self.folder.join(format!("{}", numbers.start));
        fs::create_dir_all(&folder).expect("a folder to write in");
        let cases: Vec<Case> = numbers.filter_map(|number| self.case(number, &folder, &mut tally)).collect();
        let mut pending: &[Case] = &cases;
        let out = folder.join("results");
        while !pending.is_empty() {
            let (lines, broken) = self.run(pending, &out);
            let mut last = 0;
            for (k, case) in pending.iter().enumerate() {
                if let Some(line) = lines.get(&case.name) {
                    last = k + 1;
                    self.look_at(case, &out.join(&case.name), line, &mut tally);
                } else if broken.as_ref().is_some_and(|b| !b.ended) && k == last {
                    // the process ended in this one; those behind it have not begun
                } else if broken.as_ref().is_none_or(|b| b.ended) {
                    let said = broken.as_ref().map_or("", |b| b.said.as_str());
                    tally.faults.push((case.number, format!("no result: {said}")));
                }
            }
            match broken.filter(|b| !b.ended) {
                None => break,
                Some(b) => {
                    match pending.get(last) {
                        Some(case) if b.late => tally.endless.push(case.number),
                        Some(case) => tally.faults.push((case.number, b.said)),
                        None => {}
                    }
                    pending = pending.get(last + 1..).unwrap_or_default();
                }
            }
        }
        if tally.faults.is_empty() {
            fs::remove_dir_all(&folder).expect("a folder of our own");
        }
        tally
    }

    /// A config that is read without complaint.
    fn case(&self, number: u64, folder: &Path, tally: &mut Tally) -> Option<Case> {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        random.set_stream(number);
        let name = format!("case_{number}");
        let config = self.physical.config(&name, &mut random);
        let file = folder.join(format!("{name}.json"));
        let text = serde_json::to_string_pretty(&config).expect("JSON");
        fs::write(&file, &text).expect("a folder to write in");
        tally.made += 1;
        let read = catch_unwind(|| load_text(&file, text).and_then(|loaded| loaded.problem().map(|p| p.hamiltonian)));
        match read {
            Ok(Ok(h)) => {
                let scale = h.sites() as f64 * h.stiffness_mev();
                return Some(Case { number, name, config, scale, file, random });
            }
            Ok(Err(_)) => tally.refused += 1,
            Err(_) => tally.faults.push((number, "a panic as it was read".into())),
        }
        None
    }

    /// The program within its limits.
    fn start(&self, arguments: &[&str]) -> Child {
        let mut command = Command::new("sh");
        command.args(["-c", &format!("ulimit -v {MEMORY_KIB}; exec \"$0\" \"$@\"")]).arg(self.program).args(arguments);
        command.current_dir(self.folder).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command.spawn().expect("the program starts")
    }

    /// Runs configs in one process: the lines of JSON by name, and how it ended if that was not as usual.
    fn run(&self, cases: &[Case], out: &Path) -> (BTreeMap<String, Value>, Option<Broken>) {
        let files: Vec<&str> = cases.iter().map(|c| c.file.to_str().expect("a name")).collect();
        // with one config the folder is the result's own
        let own = match cases {
            [one] => out.join(&one.name),
            _ => out.to_path_buf(),
        };
        let options = ["--out", own.to_str().expect("a name"), "--json", "--quiet", "--threads", "1"];
        let mut lines = BTreeMap::new();
        let broken = self.watched(&[&["run"], &files[..], &options[..]].concat(), |line| {
            if let Ok(value) = serde_json::from_str::<Value>(line) {
                lines.insert(value["name"].as_str().unwrap_or_default().to_string(), value);
            }
        });
        let complete = lines.len() == cases.len();
        (lines, Some(broken).filter(|b| !complete || !b.ended))
    }

    /// Runs to the end, or until it says nothing for too long.
    fn watched(&self, arguments: &[&str], mut line: impl FnMut(&str)) -> Broken {
        let mut child = self.start(arguments);
        let (stdout, mut stderr) = (child.stdout.take().expect("a pipe"), child.stderr.take().expect("a pipe"));
        let (sender, receiver) = channel();
        let reader = thread::spawn(move || {
            BufReader::new(stdout).lines().map_while(Result::ok).for_each(|line| drop(sender.send(line)));
        });
        let errors = thread::spawn(move || {
            let mut said = String::new();
            let _ = stderr.read_to_string(&mut said);
            said
        });
        let mut late = false;
        loop {
            match receiver.recv_timeout(LONGEST) {
                Ok(text) => line(&text),
                Err(RecvTimeoutError::Disconnected) => break,
                Err(RecvTimeoutError::Timeout) => {
                    child.kill().expect("it is ours");
                    late = true;
                    break;
                }
            }
        }
        let status = child.wait().expect("it is ours");
        let said = errors.join().expect("no panic");
        reader.join().expect("no panic");
        let code = status.code();
        let ended = !late && code.is_some_and(|c| c < 100);
        let how = if late { format!("no end within {LONGEST:?}") } else { format!("{status}") };
        Broken { ended, late, code, said: format!("{how}: {}", said.trim()) }
    }

    /// The exit code, and what was said.
    fn done(&self, arguments: &[&str]) -> (Option<i32>, Vec<String>, String) {
        let mut lines = Vec::new();
        let ended = self.watched(arguments, |line| lines.push(line.to_string()));
        (ended.code, lines, ended.said)
    }

    /// Checks a result, and does something more with it.
    fn look_at(&self, case: &Case, result: &Path, line: &Value, tally: &mut Tally) {
        let faults = faults(result, line, case.scale);
        tally.doubtful += usize::from(!faults.doubtful.is_empty());
        let mut found = faults.found;
        let summary = fs::read(result.join("summary.json")).unwrap_or_default();
        let summary: Value = serde_json::from_slice(&summary).unwrap_or_default();
        tally.runs += 1;
        tally.certified += usize::from(summary["certified"] == true);
        tally.with_rates += usize::from(summary["rates"].is_array());
        tally.unproven += usize::from(unproven(&summary));
        // what takes long is not done again and again
        let quick = summary["work"]["seconds"].as_f64().is_some_and(|s| s < 2.0);
        match case.number % 50 {
            _ if !quick => {}
            0 | 1 => found.extend(self.on_two_threads(case, result, tally)),
            2 | 3 => found.extend(self.its_own_config(result, tally)),
            4..7 => found.extend(self.after_a_kill(case, result, tally)),
            7 => found.extend(self.in_a_sweep(case, tally)),
            8 | 9 => found.extend(self.relaxed(case, &summary, tally)),
            _ if case.config["output"]["plots"] != json!([]) => found.extend(self.drawn_anew(result, tally)),
            _ => {}
        }
        tally.faults.extend(found.into_iter().map(|what| (case.number, what)));
    }

    fn on_two_threads(&self, case: &Case, result: &Path, tally: &mut Tally) -> Vec<String> {
        tally.on_two_threads += 1;
        let again = result.with_extension("two");
        let (file, out) = (text(&case.file), text(&again));
        let (_, _, said) = self.done(&["run", file, "--out", out, "--quiet", "--threads", "2"]);
        differences("on two threads", result, &again, &said)
    }

    fn its_own_config(&self, result: &Path, tally: &mut Tally) -> Vec<String> {
        tally.from_their_own_config += 1;
        let again = result.with_extension("again");
        let own = result.join("config.json");
        let (_, _, said) = self.done(&["run", text(&own), "--out", text(&again), "--quiet", "--threads", "1"]);
        let [one, other] = [result, &again].map(|folder| without_source(files(folder)));
        same("from its own config", &one, &other, &said)
    }

    fn after_a_kill(&self, case: &Case, result: &Path, tally: &mut Tally) -> Vec<String> {
        tally.after_a_kill += 1;
        let again = result.with_extension("killed");
        let run = ["run", text(&case.file), "--out", text(&again), "--threads", "1", "--checkpoint-every", "0 s"];
        let mut child = self.start(&run);
        let seconds = fs::read(result.join("summary.json")).ok().and_then(|s| serde_json::from_slice::<Value>(&s).ok());
        let seconds = seconds.and_then(|s| s["work"]["seconds"].as_f64()).unwrap_or(0.0);
        // what is said is more than a pipe may hold: nobody reads it
        thread::sleep(Duration::from_secs_f64(0.01 + case.random.clone().random_range(0.0..1.5) * seconds));
        child.kill().expect("it is ours");
        let _ = child.wait();
        tally.from_a_checkpoint += usize::from(again.join("checkpoint/journal").is_file());
        // to record every step once more takes long
        let rest = [&run[..6], &["--checkpoint-every", "60 s", "--resume", "--quiet"]].concat();
        let (_, _, said) = self.done(&rest);
        differences("after a kill", result, &again, &said)
    }

    fn drawn_anew(&self, result: &Path, tally: &mut Tally) -> Vec<String> {
        tally.drawn_anew += 1;
        let before = files(result);
        let (code, _, said) = self.done(&["plot", text(result), "--format", "svg", "--quiet"]);
        let mut found = same("drawn anew", &before, &files(result), &said);
        if code != Some(0) {
            found.push(format!("plot: {said}"));
        }
        found
    }

    /// A sweep over one number of the config, from half of it to all of it.
    fn in_a_sweep(&self, case: &Case, tally: &mut Tally) -> Vec<String> {
        let sweep = case.file.with_extension("sweep.json");
        let out = case.file.with_extension("sweep");
        let name = case.file.file_name().and_then(|n| n.to_str()).expect("a name");
        let text_of =
            json!({"name": "sweep", "config": name, "grid": {"path.images": [5, 8], "neb.tolerance": [1e-4, 1e-6]}});
        fs::write(&sweep, text_of.to_string()).expect("a folder to write in");
        let arguments = ["sweep", text(&sweep), "--out", text(&out), "--json", "--quiet", "--jobs", "1"];
        let (_, lines, said) = self.done(&arguments);
        let mut found = Vec::new();
        let lines: Vec<Value> = lines.iter().filter_map(|l| serde_json::from_str(l).ok()).collect();
        if lines.len() != 4 {
            return vec![format!("a sweep of 4 points says {} lines: {said}", lines.len())];
        }
        for line in &lines {
            let folder = Path::new(line["directory"].as_str().unwrap_or_default());
            let folder = self.folder.join(folder);
            tally.in_sweeps += 1;
            found.extend(
                faults(&folder, line, case.scale).found.into_iter().map(|what| format!("{}: {what}", folder.display())),
            );
        }
        found
    }

    /// The ends by themselves are those of the run.
    fn relaxed(&self, case: &Case, summary: &Value, tally: &mut Tally) -> Vec<String> {
        if case.config["relax_ends"] == false {
            return Vec::new();
        }
        tally.relaxed += 1;
        let (_, lines, said) = self.done(&["relax", text(&case.file), "--json", "--quiet", "--threads", "1"]);
        let lines: Vec<Value> = lines.iter().filter_map(|l| serde_json::from_str(l).ok()).collect();
        let mut found = Vec::new();
        for (line, end) in lines.iter().zip(["initial", "final"]) {
            for key in ["energy_meV", "negative_modes"] {
                if line[key] != summary[end][key] {
                    found.push(format!("relax: {end}.{key} is {}, of the run {}", line[key], summary[end][key]));
                }
            }
        }
        if lines.len() != 2 {
            found.push(format!("relax says {} lines: {said}", lines.len()));
        }
        found
    }
}

/// How a process ended.
struct Broken {
    /// By itself.
    ended: bool,
    /// Because it took too long.
    late: bool,
    code: Option<i32>,
    said: String,
}

fn text(path: &Path) -> &str {
    path.to_str().expect("a name")
}

/// Where the config was is told, and differs.
fn without_source(mut files: BTreeMap<String, Vec<u8>>) -> BTreeMap<String, Vec<u8>> {
    if let Some(bytes) = files.get_mut("summary.json") {
        let mut summary: Value = serde_json::from_slice(bytes).unwrap_or_default();
        summary["manifest"]["source"].take();
        *bytes = summary.to_string().into_bytes();
    }
    files
}

fn differences(what: &str, a: &Path, b: &Path, said: &str) -> Vec<String> {
    same(what, &files(a), &files(b), said)
}

fn same(what: &str, a: &BTreeMap<String, Vec<u8>>, b: &BTreeMap<String, Vec<u8>>, said: &str) -> Vec<String> {
    let names = |f: &BTreeMap<String, Vec<u8>>| f.keys().cloned().collect::<Vec<_>>();
    if names(a) != names(b) {
        return vec![format!("{what}: files {:?} instead of {:?}: {said}", names(b), names(a))];
    }
    a.iter()
        .filter(|(name, bytes)| b[*name] != **bytes)
        .map(|(name, _)| format!("{what}: {name} is another one: {said}"))
        .collect()
}
