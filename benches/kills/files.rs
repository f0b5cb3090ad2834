//! What a folder of results holds.

use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// All files in a directory, with what may differ taken out of `summary.json`.
pub fn files(directory: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![String::new()];
    while let Some(folder) = folders.pop() {
        let Ok(entries) = fs::read_dir(directory.join(&folder)) else { continue };
        for entry in entries {
            let entry = entry.unwrap();
            let name = format!("{folder}{}", entry.file_name().to_str().unwrap());
            if entry.path().is_dir() {
                folders.push(format!("{name}/"));
                continue;
            }
            let mut bytes = fs::read(entry.path()).unwrap();
            if name == "summary.json" {
                let mut summary: Value = serde_json::from_slice(&bytes).expect("a whole summary");
                for key in ["seconds", "threads"] {
                    summary["work"][key].take();
                }
                bytes = serde_json::to_vec(&summary).unwrap();
            }
            found.insert(name, bytes);
        }
    }
    found
}
