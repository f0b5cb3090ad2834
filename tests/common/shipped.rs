//! The shipped configs as the program runs them: once each, whatever number of tests looks at what came out.

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, OnceLock};

/// What a run of a shipped config left.
pub struct Run {
    /// Its line of JSON.
    pub line: Value,
    /// Its files by their names.
    pub files: BTreeMap<String, Vec<u8>>,
}

impl Run {
    pub fn summary(&self) -> Value {
        serde_json::from_slice(&self.files["summary.json"]).unwrap()
    }

    /// Barriers forward and backward (meV).
    pub fn barriers(&self) -> (f64, f64) {
        let number = |way: &str| self.line["barrier_meV"][way].as_f64().unwrap();
        (number("forward"), number("backward"))
    }
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Names of the shipped configs.
pub fn names() -> BTreeSet<String> {
    let files = fs::read_dir(root().join("configs")).unwrap().map(|e| e.unwrap().path());
    let configs = files.filter(|path| path.extension().is_some_and(|e| e == "json"));
    configs.map(|path| path.file_stem().unwrap().to_str().unwrap().to_string()).collect()
}

/// The run of a config with all of its figures: by the first test that asks for it, the others wait for that one.
pub fn shipped(name: &str) -> &'static Run {
    static RUNS: Mutex<BTreeMap<String, &'static OnceLock<Run>>> = Mutex::new(BTreeMap::new());
    let run = *RUNS.lock().unwrap().entry(name.to_string()).or_insert_with(|| Box::leak(Box::default()));
    run.get_or_init(|| program(name))
}

fn program(name: &str) -> Run {
    let temporary = tempfile::tempdir().unwrap();
    let config = format!("configs/{name}.json");
    let done = Command::new(env!("CARGO_BIN_EXE_spinneb"))
        .current_dir(root())
        .args(["run", &config, "--json", "--quiet", "--out"])
        .arg(temporary.path().join(name))
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&done.stderr);
    assert_eq!((done.status.code(), &*said), (Some(0), ""), "{name}");
    let line = serde_json::from_slice(&done.stdout).unwrap();
    Run { line, files: files(&temporary.path().join(name)) }
}

fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|e| e.unwrap()).filter(|e| e.file_type().unwrap().is_file());
    entries.map(|e| (e.file_name().into_string().unwrap(), fs::read(e.path()).unwrap())).collect()
}
