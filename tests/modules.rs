//! The front page of the library's documentation names every module, and they import each other as it says.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// The modules of the table, by row.
fn rows(front: &str) -> Vec<Vec<&str>> {
    let cells = front.lines().filter_map(|line| line.strip_prefix("//! | ")?.split(" | ").next());
    cells.map(|cell| cell.split('`').skip(1).step_by(2).collect()).filter(|row: &Vec<&str>| !row.is_empty()).collect()
}

fn sources(place: &Path, found: &mut Vec<PathBuf>) {
    if place.is_dir() {
        fs::read_dir(place).unwrap().for_each(|entry| sources(&entry.unwrap().path(), found));
    } else if place.extension().is_some_and(|e| e == "rs") && place.file_stem().is_some_and(|name| name != "tests") {
        found.push(place.into());
    }
}

/// What a file names in its code behind a word, its tests and comments left out.
fn names<'a>(text: &'a str, behind: &str) -> Vec<&'a str> {
    let code = text.split("#[cfg(test)]").next().unwrap_or_default();
    let lines = code.lines().filter(|line| !line.trim_start().starts_with("//"));
    let names = lines.flat_map(|line| line.split(behind).skip(1));
    names.map(|rest| rest.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or_default()).collect()
}

#[test]
fn the_front_page_names_every_module_and_none_imports_one_above_it() {
    let front = fs::read_to_string(format!("{ROOT}/src/lib.rs")).unwrap();
    let rows = rows(&front);
    let last = rows.len() - 1;
    let row_of: BTreeMap<&str, usize> =
        rows.iter().enumerate().flat_map(|(k, row)| row.iter().map(move |name| (*name, k))).collect();
    for module in front.lines().filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';')) {
        assert!(row_of.contains_key(module), "{module} is not on the front page");
    }
    for (module, row) in &row_of {
        let mut files = Vec::new();
        let place = PathBuf::from(format!("{ROOT}/src/{module}"));
        sources(&if place.is_dir() { place } else { place.with_extension("rs") }, &mut files);
        assert!(!files.is_empty(), "{module} is not there");
        for file in files {
            for other in names(&fs::read_to_string(&file).unwrap(), "crate::") {
                let Some(below) = row_of.get(other) else { continue };
                let lower = below > row || (below == row && *row == last);
                assert!(other == *module || lower, "{}: {module} imports {other}", file.display());
            }
        }
    }
}

/// Files that import each other in a circle, if any do: what is left once those that import none of the others are taken away.
fn circle(mut all: BTreeMap<String, String>) -> Vec<String> {
    loop {
        let is_end = |name: &str, text: &str| {
            names(text, "super::").into_iter().all(|other| other == name || !all.contains_key(other))
        };
        let ends = all.iter().find(|(name, text)| is_end(name, text));
        let Some(end) = ends.map(|(name, _)| name.clone()) else { return all.into_keys().collect() };
        all.remove(&end);
    }
}

#[test]
fn no_files_of_a_folder_import_each_other_in_a_circle() {
    let mut files = Vec::new();
    sources(Path::new(&format!("{ROOT}/src")), &mut files);
    let mut folders: BTreeMap<PathBuf, BTreeMap<String, String>> = BTreeMap::new();
    for file in files {
        let (folder, name) = (file.parent().unwrap().to_path_buf(), file.file_stem().unwrap().to_string_lossy());
        folders.entry(folder).or_default().insert(name.into_owned(), fs::read_to_string(&file).unwrap());
    }
    assert!(folders.len() > 20);
    for (folder, files) in folders {
        let all = circle(files);
        assert!(all.is_empty(), "{}: {all:?}", folder.display());
    }
    let two = [("a", "use super::b::B;"), ("b", "use super::a::A;"), ("c", "use super::a::A;")];
    let two = two.map(|(name, text)| (name.to_string(), text.to_string()));
    assert_eq!(circle(two.into()), ["a", "b", "c"]);
}
