//! Signals, locks, checkpoints that are damaged or another's, disks that are full: what a user meets, and that nothing is lost.
#![cfg(unix)]

use serde_json::Value;
use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A slow method on a chain, with some hundred iterations.
const CONFIG: &str = r#"{
  "material": {"name": "toy", "moment": "2 mu_B", "energy": [
    {"exchange": {"J": ["10 meV"]}},
    {"anisotropy": {"K": "0.5 meV", "axis": [0, 0, 1]}}
  ]},
  "lattice": {"chain": {"sites": 60}},
  "initial": {"uniform": {"direction": [0, 0, 1]}},
  "final": {"uniform": {"direction": [0, 0, -1]}},
  "path": {"images": 15, "guess": {"sweep": {"from": "left"}}},
  "neb": {"optimiser": {"velocity_projection": {}}, "max_evaluations": 1500},
  "output": {"formats": ["csv", "npz"], "plots": []}
}"#;

/// What makes it take long enough for any signal.
const ENDLESS: [&str; 4] = ["--set", "neb.max_evaluations=2000000", "--set", "neb.tolerance=1e-300"];

/// A folder with the config as slow.json.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("slow.json"), CONFIG).unwrap();
    folder
}

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_spinneb"));
    let out: &[&str] = if arguments.contains(&"--out") { &[] } else { &["--out", "out"] };
    command.current_dir(folder).args(["run", "slow.json"]).args(out).args(arguments);
    command
}

/// Exit code, stdout, stderr of a run to its end.
fn run(folder: &Path, arguments: &[&str]) -> (Option<i32>, String, String) {
    let done = command(folder, arguments).output().unwrap();
    (done.status.code(), String::from_utf8(done.stdout).unwrap(), String::from_utf8(done.stderr).unwrap())
}

/// A run at work, with a checkpoint after every iteration and some of them done.
fn at_work(folder: &Path, arguments: &[&str]) -> Child {
    let mut command = command(folder, &["--checkpoint-every", "0 s", "--json"]);
    let mut child = command.args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    // one that is there already is replaced by the first of this run
    let started = Instant::now();
    while !folder.join("out/checkpoint/snapshot.previous").is_file() {
        assert!(started.elapsed() < Duration::from_secs(60), "no checkpoint appears");
        if child.try_wait().unwrap().is_some() {
            panic!("not at work: {:?}", ended(child));
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    child
}

/// A run that has said its first word, and watches for signals.
fn speaking(mut command: Command) -> Child {
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    // one byte at a time, so that the rest is there for others
    let mut byte = [0];
    while child.stderr.as_mut().unwrap().read(&mut byte).unwrap() == 1 && byte != *b"\n" {}
    child
}

fn signal(child: &Child, name: &str) {
    let line = format!("kill -{name} {}", child.id());
    assert!(Command::new("sh").args(["-c", &line]).status().unwrap().success());
}

/// Exit code, stdout, stderr.
fn ended(mut child: Child) -> (Option<i32>, String, String) {
    let (mut out, mut said) = (String::new(), String::new());
    child.stdout.take().unwrap().read_to_string(&mut out).unwrap();
    child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
    (child.wait().unwrap().code(), out, said)
}

/// The names in the folder of the result, and all that must not differ in them.
fn result(folder: &Path, out: &str) -> Vec<(String, Vec<u8>)> {
    let mut files: Vec<(String, Vec<u8>)> = fs::read_dir(folder.join(out))
        .unwrap()
        .map(|entry| entry.unwrap())
        .map(|entry| (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap_or_default()))
        .collect();
    for (_, bytes) in files.iter_mut().filter(|(name, _)| name == "summary.json") {
        let mut summary: Value = serde_json::from_slice(bytes).unwrap();
        summary["work"]["seconds"].take();
        summary["work"]["threads"].take();
        *bytes = serde_json::to_vec(&summary).unwrap();
    }
    files.sort();
    files
}

/// Exit code and result of the run that nobody disturbed.
fn undisturbed(folder: &Path) -> (Option<i32>, Vec<(String, Vec<u8>)>) {
    let (code, _, said) = run(folder, &["--out", "whole", "--quiet"]);
    assert!(matches!(code, Some(0 | 3)), "{said}");
    (code, result(folder, "whole"))
}

/// Goes on in `out` to the end, which must be the undisturbed one; what was said.
fn goes_on(folder: &Path, arguments: &[&str]) -> String {
    let (code, _, said) = run(folder, &[&["--resume"], arguments].concat());
    assert!((code, result(folder, "out")) == undisturbed(folder), "the end is another one: {said}");
    said
}

/// A folder with a checkpoint of a run that was killed.
fn killed() -> tempfile::TempDir {
    let folder = folder();
    let mut child = at_work(folder.path(), &[]);
    child.kill().unwrap();
    child.wait().unwrap();
    folder
}

#[test]
fn an_interrupted_run_leaves_a_checkpoint_and_partial_results_and_goes_on() {
    // tests that are to outlive their terminal have it ignored, and so have their children
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| u64::from_str_radix(line.strip_prefix("SigIgn:")?.trim(), 16).ok());
    let hangs_up = ignored.filter(|mask| mask & 1 == 0).map(|_| ("HUP", 129, "hung up"));
    for (name, expected, word) in [("INT", 130, "interrupted"), ("TERM", 143, "terminated")].into_iter().chain(hangs_up)
    {
        let folder = folder();
        let child = at_work(folder.path(), &[]);
        signal(&child, name);
        let (code, out, said) = ended(child);
        assert_eq!((code, out.as_str()), (Some(expected), ""), "{said}");
        assert!(said.contains(&format!("slow: {word} while ")), "{said}");
        assert!(said.contains("--resume goes on from there; partial results in out"), "{said}");
        let left = folder.path().join("out");
        assert!(!left.join("summary.json").exists());
        let partial: Value = serde_json::from_slice(&fs::read(left.join("partial.json")).unwrap()).unwrap();
        assert_eq!((&partial["partial"], &partial["certified"]), (&true.into(), &false.into()));
        assert!(partial["stop_reason"].as_str().unwrap().contains("this is no result"), "{partial}");
        let images = partial["images"].as_u64().unwrap() as usize;
        assert!(partial["iteration"].as_u64().unwrap() > 0);
        let table = fs::read_to_string(left.join("partial_path.csv")).unwrap();
        assert_eq!(table.lines().count(), images + 1);
        assert!(left.join("partial_path.npz").is_file() && left.join("partial_history.csv").is_file());
        let said = goes_on(folder.path(), &[]);
        assert!(said.contains("slow: going on from the checkpoint, with "), "{said}");
        let (code, _, said) = run(folder.path(), &["--resume"]);
        assert_eq!(code, undisturbed(folder.path()).0);
        assert!(said.contains("holds the finished result of this config already"), "{said}");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn a_run_that_is_to_outlive_its_terminal_does() {
    let folder = folder();
    let run = command(folder.path(), &ENDLESS);
    let mut nohup = Command::new("sh");
    nohup.args(["-c", "trap '' HUP; exec \"$0\" \"$@\""]).arg(run.get_program()).args(run.get_args());
    nohup.current_dir(run.get_current_dir().unwrap_or(folder.path()));
    let child = speaking(nohup);
    signal(&child, "HUP");
    std::thread::sleep(Duration::from_millis(100));
    signal(&child, "INT");
    let (code, _, said) = ended(child);
    assert_eq!(code, Some(130), "{said}");
}

#[test]
fn a_short_interrupted_run_writes_its_first_checkpoint_then() {
    let folder = folder();
    let child = speaking(command(folder.path(), &ENDLESS));
    std::thread::sleep(Duration::from_millis(100));
    assert!(!folder.path().join("out/checkpoint").exists());
    signal(&child, "INT");
    let (code, _, said) = ended(child);
    assert_eq!(code, Some(130), "{said}");
    assert!(folder.path().join("out/checkpoint/journal").is_file(), "{said}");
}

/// How a run ends after commands of the shell, in which $0 is its number.
fn ended_by(child: Child, commands: &str) -> (Option<i32>, String, String) {
    let mut shell = Command::new("sh");
    shell.args(["-c", commands, &child.id().to_string()]).stderr(Stdio::null());
    assert!(shell.status().unwrap().success());
    ended(child)
}

#[test]
fn a_second_signal_ends_the_program_at_once() {
    let folder = folder();
    let child = at_work(folder.path(), &[]);
    let (code, _, said) = ended_by(child, "kill -INT $0; sleep 0.4; kill -INT $0 || true");
    assert_eq!(code, Some(130), "{said}");
    goes_on(folder.path(), &[]);
}

#[test]
fn signals_that_come_together_are_one() {
    let folder = folder();
    let child = at_work(folder.path(), &[]);
    let (_, _, said) = ended_by(child, "kill -INT $0; kill -INT $0; kill -TERM $0 || true");
    assert!(folder.path().join("out/partial.json").is_file(), "{said}");
    goes_on(folder.path(), &[]);
}

#[test]
fn an_interrupted_run_of_several_leaves_the_others_undone() {
    let folder = folder();
    fs::copy(folder.path().join("slow.json"), folder.path().join("second.json")).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_spinneb"));
    command.current_dir(folder.path()).args(["run", "slow.json", "second.json", "--json"]);
    command.args(ENDLESS);
    let child = speaking(command);
    signal(&child, "TERM");
    let (code, out, said) = ended(child);
    assert_eq!((code, out.as_str()), (Some(143), ""), "{said}");
    assert!(!folder.path().join("results/second").exists());
}

#[test]
fn two_runs_into_one_directory_exclude_each_other() {
    let folder = folder();
    let mut first = at_work(folder.path(), &[]);
    signal(&first, "STOP");
    let refused = || {
        let (code, _, said) = run(folder.path(), &["--resume"]);
        assert_eq!(code, Some(1), "{said}");
        let holder = format!("error: out: another run (process {}", first.id());
        assert!(said.starts_with(&holder) && said.contains("is at work in this directory"), "{said}");
    };
    refused();
    // whatever the holder has half written
    let [journal, aside] = ["out/checkpoint/journal", "aside"].map(|name| folder.path().join(name));
    fs::rename(&journal, &aside).unwrap();
    fs::create_dir(&journal).unwrap();
    fs::write(folder.path().join("out/summary.json"), "{").unwrap();
    refused();
    fs::remove_file(folder.path().join("out/summary.json")).unwrap();
    fs::remove_dir(&journal).unwrap();
    fs::rename(&aside, &journal).unwrap();
    first.kill().unwrap();
    first.wait().unwrap();
    goes_on(folder.path(), &[]);
}

#[test]
fn without_a_checkpoint_resume_starts_anew_and_says_so() {
    let folder = folder();
    let said = goes_on(folder.path(), &[]);
    assert!(said.starts_with("slow: no checkpoint to go on from: starting anew"), "{said}");
}

#[test]
fn a_run_without_resume_says_that_there_is_a_checkpoint_and_starts_anew() {
    let folder = killed();
    let (code, _, said) = run(folder.path(), &[]);
    assert!(said.contains("slow: starting anew; --resume would have gone on from the checkpoint"), "{said}");
    assert!((code, result(folder.path(), "out")) == undisturbed(folder.path()));
}

#[test]
fn a_checkpoint_of_another_config_is_refused_and_left_as_it_is() {
    let folder = killed();
    let journal = folder.path().join("out/checkpoint/journal");
    let before = fs::read(&journal).unwrap();
    let other = ["--resume", "--set", "path.images=13"];
    let (code, _, said) = run(folder.path(), &other);
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("error: out/checkpoint: is the checkpoint of another config"), "{said}");
    assert_eq!(fs::read(&journal).unwrap(), before);
    // nor does a run that asks for nothing of it take it away, or one that records nothing
    for unrecorded in [&[][..], &["--checkpoint-every", "off"]] {
        let (code, _, said) = run(folder.path(), &[&other[1..], unrecorded].concat());
        assert!(code == Some(2) && said.contains("is the checkpoint of another config"), "{said}");
        assert_eq!(fs::read(&journal).unwrap(), before);
    }
    let (code, _, said) = run(folder.path(), &[&other[..], &["--force"]].concat());
    assert!(matches!(code, Some(0 | 3)), "{said}");
    assert!(said.contains("starting anew: out/checkpoint: is the checkpoint of another config"), "{said}");
}

#[test]
fn a_checkpoint_of_another_version_or_build_is_refused() {
    let folder = killed();
    let journal = folder.path().join("out/checkpoint/journal");
    let old = fs::read(&journal).unwrap();
    for (key, value, words) in [
        ("version", Value::from("9.1.0"), "version 9.1.0 (this is"),
        ("program_crc32", 1.into(), "another build of version"),
    ] {
        fs::write(&journal, with_another_head(&old, key, value)).unwrap();
        let (code, _, said) = run(folder.path(), &["--resume"]);
        assert_eq!(code, Some(2), "{said}");
        assert!(said.contains("out/checkpoint: is the checkpoint of ") && said.contains(words), "{said}");
    }
}

/// A journal whose first frame says something else, and is whole.
fn with_another_head(journal: &[u8], key: &str, value: Value) -> Vec<u8> {
    let magic = journal.iter().position(|b| *b == b'\n').unwrap() + 1;
    let content = magic + 12;
    let rest = content + u64::from_le_bytes(journal[magic..magic + 8].try_into().unwrap()) as usize;
    let mut head: Value = serde_json::from_slice(&journal[content..rest]).unwrap();
    head[key] = value;
    let head = serde_json::to_vec(&head).unwrap();
    let length = (head.len() as u64).to_le_bytes();
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(&length);
    hasher.update(&head);
    [&journal[..magic], &length, &hasher.finalize().to_le_bytes(), &head, &journal[rest..]].concat()
}

#[test]
fn a_damaged_checkpoint_is_said_and_used_as_far_as_it_is_whole() {
    let folder = killed();
    let checkpoint = folder.path().join("out/checkpoint");
    let names = ["journal", "snapshot", "snapshot.previous"];
    // killed between taking away the old snapshot and the new one, it has but the one before
    let read = |name: &&str| fs::read(checkpoint.join(name)).or_else(|_| fs::read(checkpoint.join(names[2]))).unwrap();
    let good: Vec<Vec<u8>> = names.iter().map(read).collect();
    let restore = || {
        fs::remove_dir_all(folder.path().join("out")).unwrap();
        fs::create_dir_all(&checkpoint).unwrap();
        names.iter().zip(&good).for_each(|(name, bytes)| fs::write(checkpoint.join(name), bytes).unwrap());
    };
    let spoiled = |bytes: &[u8], at: usize| {
        let mut bytes = bytes.to_vec();
        bytes[at] ^= 1;
        bytes
    };
    // a bit of the journal's last record, then its tail cut off, then its beginning
    let last = good[0].len() - 20;
    for (bytes, words) in [
        (spoiled(&good[0], last), "the end of out/checkpoint/journal is damaged and left out"),
        (good[0][..good[0].len() - 3].to_vec(), "the end of out/checkpoint/journal is damaged and left out"),
        (spoiled(&good[0], 3), "out/checkpoint/journal is damaged and cannot be used: starting anew"),
        (Vec::new(), "out/checkpoint/journal is damaged and cannot be used: starting anew"),
    ] {
        restore();
        fs::write(checkpoint.join("journal"), bytes).unwrap();
        let said = goes_on(folder.path(), &[]);
        assert!(said.contains(words), "{words}: {said}");
    }
    restore();
    fs::write(checkpoint.join("snapshot"), spoiled(&good[1], good[1].len() / 2)).unwrap();
    let said = goes_on(folder.path(), &[]);
    assert!(said.contains("out/checkpoint/snapshot is damaged and not used"), "{said}");
    assert!(said.contains("going on from the one before it, out/checkpoint/snapshot.previous"), "{said}");
    restore();
    names[1..].iter().for_each(|name| fs::write(checkpoint.join(name), "x").unwrap());
    let said = goes_on(folder.path(), &[]);
    assert!(said.contains("out/checkpoint/snapshot.previous is damaged and not used"), "{said}");
}

/// A run that may write no file larger than so many blocks of 512 bytes, and is told so by an error as on a full disk.
fn with_little_room(folder: &Path, blocks: usize, arguments: &str) -> (Option<i32>, String) {
    let program = env!("CARGO_BIN_EXE_spinneb");
    let line = format!("ulimit -f {blocks}; exec {program} run slow.json --out out {arguments}");
    let done = Command::new("sh").current_dir(folder).args(["-c", &line]).output().unwrap();
    (done.status.code(), String::from_utf8(done.stderr).unwrap())
}

#[test]
fn a_directory_without_room_is_found_before_the_work() {
    let folder = folder();
    let (code, said) = with_little_room(folder.path(), 8, "");
    assert_eq!(code, Some(1), "{said}");
    assert!(said.starts_with("error: out: cannot write here: File too large (os error "), "{said}");
    assert_eq!(said.lines().count(), 1, "{said}");
    let (code, _, said) = run(folder.path(), &["--out", "/proc/no_such/place"]);
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("the directory cannot be made"), "{said}");
}

#[test]
fn more_files_than_may_be_open_are_written() {
    let folder = folder();
    let program = env!("CARGO_BIN_EXE_spinneb");
    let more = "--set 'output.formats=[\"vtk\"]' --set path.images=151 --set neb.max_evaluations=1 --threads 1";
    let line = format!("ulimit -n 40; exec {program} run slow.json --out out {more}");
    let done = Command::new("sh").current_dir(folder.path()).args(["-c", &line]).output().unwrap();
    assert_eq!(done.status.code(), Some(3), "{}", String::from_utf8_lossy(&done.stderr));
    assert!(fs::read_dir(folder.path().join("out/vtk")).unwrap().count() > 100);
    // what the system says where a file cannot be made
    #[cfg(target_os = "linux")]
    {
        let (_, _, said) = run(folder.path(), &["--out", "/proc"]);
        assert!(said.starts_with("error: /proc: cannot write here: ") && said.contains("(os error "), "{said}");
    }
}

#[test]
fn a_result_that_does_not_fit_is_an_error_and_leaves_no_file_of_it() {
    let folder = folder();
    let more = "--set 'output.formats=[\"ovf_text\"]' --set path.images=41";
    let (code, said) = with_little_room(folder.path(), 200, more);
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("error: out/path_text.ovf: "), "{said}");
    let left: Vec<String> = result(folder.path(), "out").into_iter().map(|(name, _)| name).collect();
    assert!(left.iter().all(|name| name == "checkpoint"), "{left:?}");
    goes_on_or_anew(folder.path());
}

/// What is left in `out` is no obstacle to the run of the config as it is.
fn goes_on_or_anew(folder: &Path) {
    let (code, _, said) = run(folder, &["--resume", "--force"]);
    assert!((code, result(folder, "out")) == undisturbed(folder), "{said}");
}

#[test]
fn when_files_cannot_be_written_the_computation_is_kept() {
    let folder = folder();
    let child = at_work(folder.path(), &[]);
    fs::create_dir_all(folder.path().join("out/path.csv/in_the_way")).unwrap();
    let (code, _, said) = ended(child);
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("error: out/path.csv: is a folder"), "{said}");
    assert!(
        said.contains("slow: the checkpoint is kept: once files can be written, --resume makes the result"),
        "{said}"
    );
    assert!(!folder.path().join("out/summary.json").exists());
    fs::remove_dir_all(folder.path().join("out/path.csv")).unwrap();
    let said = goes_on(folder.path(), &[]);
    assert!(said.contains("slow: going on from the checkpoint, with "), "{said}");
}

#[test]
fn a_checkpoint_that_does_not_fit_is_said_and_does_not_end_the_run() {
    let folder = folder();
    let (code, said) = with_little_room(folder.path(), 140, "--checkpoint-every '0 s' --set 'output.formats=[]'");
    assert!(said.contains("slow: out/checkpoint: the checkpoint cannot be written: "), "{said}");
    assert!(matches!(code, Some(0 | 3)), "{said}");
    assert!(folder.path().join("out/summary.json").is_file());
    assert!(!folder.path().join("out/checkpoint").exists());
}
