//! The folder of a result: only what the program wrote is replaced or taken away, no link is followed, and a kill loses nothing.

use serde_json::json;
use spinneb::error::{Error, Result};
use spinneb::files::disk::{self, File};
use spinneb::output::file_names;
use spinneb::output::folder::{self, Destination, Intent, Kept, NewResult};
use std::fs;
use std::io::ErrorKind;
use std::path::Path;

fn file(name: &str, content: &str) -> File {
    File { name: name.into(), bytes: content.into() }
}

fn names(dir: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(dir).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn kind_of<T: std::fmt::Debug>(result: Result<T>) -> (ErrorKind, String) {
    match result {
        Err(e @ Error::Io { .. }) => {
            let words = e.to_string();
            let Error::Io { source, .. } = e else { unreachable!() };
            (source.kind(), words)
        }
        other => panic!("{other:?}"),
    }
}

/// A run of a config with this hash by this version, from a file or not.
fn intent<'a>(version: &'a str, config_sha256: &'a str, source: Option<&'a str>, names: &'a [String]) -> Intent<'a> {
    Intent { version, config_sha256, source, names, known: &[], made_from: &[], force: false }
}

fn forced(intent: Intent) -> Intent {
    Intent { force: true, ..intent }
}

/// A result of two files that says what it is of.
fn result(config_sha256: &str, table: &str) -> [File; 2] {
    let summary = format!(
        "{{\n  \"version\": \"0.2.0\",\n  \"config_sha256\": \"{config_sha256}\",\n  \"converged\": true,\n  \"certified\": false\n}}\n"
    );
    [file("path.csv", table), file("summary.json", &summary)]
}

fn new<'a>(files: &'a [File], source: Option<&'a str>) -> NewResult<'a> {
    NewResult { files, source, keep_earlier: true, force: false }
}

fn table(dir: &Path) -> String {
    fs::read_to_string(dir.join("path.csv")).unwrap()
}

#[test]
fn a_result_is_written_found_again_refused_and_replaced() {
    let top = tempfile::tempdir().unwrap();
    let dir = top.path().join("results/tiny");
    let names_of_all = file_names(|_| true);
    let of = |version, hash| intent(version, hash, None, &[]);
    assert_eq!(folder::prepare(&dir, &intent("0.2.0", "abc", None, &names_of_all)).unwrap(), Destination::Ready);
    assert_eq!(names(&dir), [""; 0]);

    let files = [&result("abc", "old")[..], &[file("config.json", "{}")]].concat();
    folder::write_result(&dir, &new(&files, None)).unwrap();
    fs::write(dir.join("notes.txt"), "mine").unwrap();
    assert_eq!(names(&dir), ["config.json", "notes.txt", "path.csv", "summary.json"]);

    match folder::prepare(&dir, &of("0.2.0", "abc")).unwrap() {
        Destination::Finished(stored) => assert_eq!(stored.exit_code(), 3),
        Destination::Ready => panic!("the result was not seen"),
    }
    let (kind, words) = kind_of(folder::prepare(&dir, &of("0.2.0", "other")));
    assert_eq!(kind, ErrorKind::AlreadyExists);
    assert!(words.contains("tiny: holds a result of another config; use --force"), "{words}");
    let (_, words) = kind_of(folder::prepare(&dir, &of("0.3.0", "abc")));
    assert!(words.contains("of this config by version 0.2.0 (this is 0.3.0)"), "{words}");

    assert_eq!(folder::prepare(&dir, &forced(of("0.2.0", "other"))).unwrap(), Destination::Ready);
    let files = result("other", "new");
    folder::write_result(&dir, &NewResult { keep_earlier: false, ..new(&files, None) }).unwrap();
    assert_eq!(names(&dir), ["notes.txt", "path.csv", "summary.json"]);
    assert_eq!(table(&dir), "new");
}

#[test]
fn what_no_manifest_names_or_was_changed_is_neither_replaced_nor_taken_away() {
    let top = tempfile::tempdir().unwrap();
    let dir = top.path();
    fs::create_dir(dir.join("inputs")).unwrap();
    fs::write(dir.join("inputs/start.csv"), "mine").unwrap();
    fs::write(dir.join("path.csv"), "mine").unwrap();
    let wanted = ["path.csv".to_string(), "summary.json".into()];
    let (kind, words) = kind_of(folder::prepare(dir, &intent("v", "c", None, &wanted)));
    assert_eq!(kind, ErrorKind::AlreadyExists);
    assert!(words.contains("path.csv: is there, was not written by an earlier run or was changed since"), "{words}");
    assert!(folder::write_result(dir, &new(&result("c", "1"), None)).is_err());
    assert_eq!(table(dir), "mine");
    // by force, the file of the very name alone
    assert_eq!(folder::prepare(dir, &forced(intent("v", "c", None, &wanted))).unwrap(), Destination::Ready);
    let files = [&result("c", "1")[..], &[file("inputs/initial.npy", "spins")]].concat();
    folder::write_result(dir, &NewResult { force: true, ..new(&files, None) }).unwrap();
    assert_eq!(names(&dir.join("inputs")), ["initial.npy", "start.csv"]);
    // a smaller result takes its own away, and nothing else
    let files = [result("d", "").into_iter().last().unwrap()];
    folder::write_result(dir, &NewResult { keep_earlier: false, ..new(&files, None) }).unwrap();
    assert_eq!(
        (names(dir), names(&dir.join("inputs"))),
        (vec!["inputs".into(), "summary.json".into()], vec!["start.csv".into()])
    );
}

#[test]
fn a_run_of_the_same_source_keeps_the_earlier_result_and_one_of_no_source_is_refused() {
    let top = tempfile::tempdir().unwrap();
    let (dir, earlier) = (top.path().join("wall"), top.path().join("wall.1"));
    let source = Some("/configs/wall.json");
    for k in 1..=4 {
        let (hash, content) = (k.to_string(), format!("table {k}"));
        assert_eq!(
            folder::prepare(&dir, &intent("0.2.0", &hash, source, &["path.csv".into()])).unwrap(),
            Destination::Ready
        );
        let files = result(&hash, &content);
        let kept = folder::write_result(&dir, &new(&files, source)).unwrap();
        assert_eq!(table(&dir), content);
        let expected = (k > 1).then(|| Kept { place: earlier.clone(), another_gave_way: k > 2 });
        assert_eq!(kept, expected);
        if k > 1 {
            assert_eq!(table(&earlier), format!("table {}", k - 1));
            assert_eq!(names(&earlier), ["path.csv", "summary.json"]);
        }
    }
    for other in [None, Some("/elsewhere/wall.json")] {
        let (_, words) = kind_of(folder::prepare(&dir, &intent("0.2.0", "5", other, &[])));
        assert!(words.contains("holds a result of another config"), "{words}");
    }
    // a folder of that name that is not the earlier result is never touched: a copy of a result, or one with changed files
    let again = intent("0.2.0", "5", source, &[]);
    fs::write(earlier.join("path.csv"), "changed").unwrap();
    let (kind, words) = kind_of(folder::prepare(&dir, &again));
    assert_eq!(kind, ErrorKind::AlreadyExists);
    assert!(words.contains("wall.1/path.csv: is there"), "{words}");
    fs::remove_dir_all(&earlier).unwrap();
    fs::create_dir(&earlier).unwrap();
    names(&dir).iter().for_each(|name| _ = fs::copy(dir.join(name), earlier.join(name)).unwrap());
    let (_, words) = kind_of(folder::prepare(&dir, &again));
    assert!(words.contains("wall.1: is not the earlier result of wall"), "{words}");
    assert!(folder::write_result(&dir, &new(&result("5", "5"), source)).is_err());
    assert_eq!((table(&dir), table(&earlier)), ("table 4".into(), "table 4".into()));
}

/// The files of a folder and of what is in it.
fn copied(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for name in names(from) {
        match from.join(&name).is_dir() {
            true => copied(&from.join(&name), &to.join(&name)),
            false => _ = fs::copy(from.join(&name), to.join(&name)).unwrap(),
        }
    }
}

#[test]
fn wherever_a_writer_was_killed_the_next_one_goes_on_and_the_earlier_result_is_whole() {
    let top = tempfile::tempdir().unwrap();
    let source = Some("/configs/wall.json");
    let wanted = ["path.csv", "old.csv", "summary.json"].map(String::from);
    let start = top.path().join("start");
    for k in [1, 2] {
        let files = [&result(&k.to_string(), &format!("table {k}"))[..], &[file("old.csv", "old")]].concat();
        folder::write_result(&start.join("wall"), &new(&files, source)).unwrap();
    }
    let third = result("3", "table 3");
    let ends = top.path().join("ends");
    copied(&start, &ends);
    folder::write_result(&ends.join("wall"), &new(&third, source)).unwrap();
    // every state between the beginning and the end, as a kill leaves it: the steps in their order
    let note = |tables: [&str; 2], of: Option<&str>| {
        let files = json!({"path.csv": tables.map(sha256), "old.csv": [sha256("old")]});
        json!({"earlier_of": of, "files": files}).to_string()
    };
    type Step<'a> = (&'a str, Box<dyn Fn(&Path) + 'a>);
    let remove =
        |name: &'static str| -> Box<dyn Fn(&Path)> { Box::new(move |at| fs::remove_file(at.join(name)).unwrap()) };
    let write = |name: &'static str, text: String| -> Box<dyn Fn(&Path)> {
        Box::new(move |at| fs::write(at.join(name), &text).unwrap())
    };
    let move_in = |name: &'static str| -> Box<dyn Fn(&Path)> {
        let from = ends.join(name);
        Box::new(move |at| _ = fs::copy(&from, at.join(name)).unwrap())
    };
    let steps: Vec<Step> = vec![
        ("nothing", Box::new(|_| ())),
        ("a staged file", write("wall/.spinneb-unfinished-aB3dE6", "half".into())),
        ("the lock of the earlier one", write("wall.1/.spinneb.lock", "process 1".into())),
        ("the earlier one's note", write("wall.1/.spinneb.writing", note(["table 1", "table 2"], Some("wall")))),
        ("the earlier one without its mark", remove("wall.1/summary.json")),
        ("a file of the earlier one", move_in("wall.1/path.csv")),
        ("the earlier one with its mark", move_in("wall.1/summary.json")),
        ("the earlier one as it is to be", remove("wall.1/.spinneb.writing")),
        ("the note", write("wall/.spinneb.writing", note(["table 2", "table 3"], None))),
        ("no mark", remove("wall/summary.json")),
        ("an old file less", remove("wall/old.csv")),
        ("a new file", move_in("wall/path.csv")),
    ];
    for (last, (what, _)) in steps.iter().enumerate() {
        let at = top.path().join(last.to_string());
        copied(&start, &at);
        steps[..=last].iter().for_each(|(_, step)| step(&at));
        let whole = |dir: &Path, text: &str| {
            let found = folder::stored_result(&at.join(dir), |_| true);
            found.is_ok_and(|found| found.is_some()) && table(&at.join(dir)) == text
        };
        let kept = whole(Path::new("wall"), "table 2") || whole(Path::new("wall.1"), "table 2");
        assert!(kept, "killed at: {what}");
        let dir = at.join("wall");
        let ready = folder::prepare(&dir, &intent("0.2.0", "3", source, &wanted));
        assert_eq!(ready.unwrap_or_else(|e| panic!("killed at: {what}: {e}")), Destination::Ready);
        disk::clean(&dir).unwrap();
        folder::write_result(&dir, &new(&third, source)).unwrap_or_else(|e| panic!("killed at: {what}: {e}"));
        assert_eq!((table(&dir), table(&at.join("wall.1"))), ("table 3".into(), "table 2".into()), "killed at: {what}");
        assert_eq!(names(&dir), ["path.csv", "summary.json"], "killed at: {what}");
    }
}

fn sha256(text: &str) -> String {
    use sha2::Digest;
    sha2::Sha256::digest(text).iter().map(|byte| format!("{byte:02x}")).collect()
}

#[test]
#[cfg(unix)]
fn no_link_is_followed_replaced_or_taken_away() {
    let top = tempfile::tempdir().unwrap();
    let home = top.path().join("home");
    fs::create_dir(&home).unwrap();
    let precious = ["path.csv", "summary.json", "initial.npy", "journal", "image_000.ovf"];
    precious.iter().for_each(|name| fs::write(home.join(name), "work of years").unwrap());
    let files = [&result("c", "1")[..], &[file("inputs/initial.npy", "spins"), file("ovf/image_000.ovf", "")]].concat();
    let wanted = ["path.csv", "summary.json", "inputs/initial.npy", "ovf/"].map(String::from);
    for (link, target) in [
        ("path.csv", "home/path.csv"),
        ("summary.json", "home/summary.json"),
        ("inputs", "home"),
        ("ovf", "home"),
        ("path.csv", "none"),
    ] {
        for force in [false, true] {
            let dir = top.path().join(format!("{}{force}", link.replace('/', "_")));
            fs::create_dir_all(&dir).unwrap();
            std::os::unix::fs::symlink(top.path().join(target), dir.join(link)).unwrap();
            let found = folder::prepare(&dir, &Intent { force, ..intent("v", "c", None, &wanted) });
            let (kind, words) = kind_of(found);
            assert_eq!(kind, ErrorKind::AlreadyExists);
            assert!(words.contains("symbolic link"), "{words}");
            assert!(folder::write_result(&dir, &NewResult { force, ..new(&files, None) }).is_err());
            assert!(fs::symlink_metadata(dir.join(link)).unwrap().is_symlink());
            fs::remove_dir_all(&dir).unwrap();
        }
    }
    for name in precious {
        assert_eq!(fs::read_to_string(home.join(name)).unwrap(), "work of years");
    }
    assert_eq!(names(&home).len(), precious.len());
}

#[test]
fn a_damaged_result_is_called_damaged() {
    let dir = tempfile::tempdir().unwrap();
    let (dir, source) = (dir.path(), Some("/configs/wall.json"));
    let again = |config| folder::prepare(dir, &intent("0.2.0", config, source, &[]));
    folder::write_result(dir, &new(&result("c", "1"), source)).unwrap();
    let summary = fs::read_to_string(dir.join("summary.json")).unwrap();
    let outside = summary.replace("\"path.csv\"", "\"../../path.csv\"");
    for (file, text, words) in [
        ("path.csv", "2", "path.csv is not as the run wrote it"),
        ("summary.json", &summary[..40], "summary.json is not a whole result"),
        (
            "summary.json",
            &*summary.replace("\"converged\": true", "\"converged\": false"),
            "summary.json is not as the run wrote it",
        ),
        ("summary.json", &*outside, "summary.json names files outside its folder"),
    ] {
        let whole = fs::read(dir.join(file)).unwrap();
        fs::write(dir.join(file), text).unwrap();
        for config in ["c", "other"] {
            let (kind, said) = kind_of(again(config));
            assert_eq!(kind, ErrorKind::AlreadyExists);
            assert!(said.contains(&format!("the result here is damaged: {words}")), "{said}");
        }
        assert!(kind_of(folder::stored_result(dir, |_| true)).1.contains("damaged"));
        assert_eq!(folder::prepare(dir, &forced(intent("0.2.0", "c", source, &[]))).unwrap(), Destination::Ready);
        fs::write(dir.join(file), whole).unwrap();
    }
    assert!(matches!(again("c").unwrap(), Destination::Finished(_)));
    // what is not there any more is no damage
    fs::remove_file(dir.join("path.csv")).unwrap();
    assert!(matches!(again("c").unwrap(), Destination::Finished(_)));
}

#[test]
fn what_a_run_is_made_from_is_not_replaced_even_by_force() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path().canonicalize().unwrap();
    let made_from = [dir.join("config.json"), dir.join("ovf/image_003.ovf")];
    fs::create_dir(dir.join("ovf")).unwrap();
    made_from.iter().for_each(|file| fs::write(file, "mine").unwrap());
    for (name, file) in [("config.json", &made_from[0]), ("ovf/", &made_from[1])] {
        let wanted = [name.to_string()];
        let (one, same) = ([file.clone()], [File { name: "config.json".into(), bytes: b"mine".to_vec() }]);
        let run = Intent { made_from: &one, ..forced(intent("v", "c", None, &wanted)) };
        let (kind, words) = kind_of(folder::prepare(&dir, &run));
        assert_eq!(kind, ErrorKind::AlreadyExists);
        assert!(words.contains("this run is made from this file"), "{words}");
        // the very same bytes are no other file
        assert_eq!(folder::prepare(&dir, &Intent { known: &same, ..run }).is_ok(), name == "config.json");
    }
}

#[test]
fn a_directory_that_is_a_file_is_refused_in_words() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("out");
    fs::write(&path, "").unwrap();
    let (kind, words) = kind_of(folder::prepare(&path, &intent("v", "c", None, &[])));
    assert_eq!(kind, ErrorKind::NotADirectory);
    assert!(words.contains("is a file, and results need a directory"), "{words}");
    // the part of the way that is the file is named
    let (kind, words) = kind_of(folder::prepare(&path.join("deeper").join("still"), &intent("v", "c", None, &[])));
    assert_eq!(kind, ErrorKind::NotADirectory);
    assert!(
        words.contains("out is a file, and results need a directory") || words.contains("out: is a file"),
        "{words}"
    );
    #[cfg(unix)]
    {
        let link = dir.path().join("link");
        std::os::unix::fs::symlink("nowhere", &link).unwrap();
        let (kind, words) = kind_of(folder::prepare(&link, &intent("v", "c", None, &[])));
        assert_eq!(kind, ErrorKind::NotADirectory);
        assert!(words.contains("is a link that leads nowhere"), "{words}");
    }
}

#[test]
fn a_summary_that_is_not_ours_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("summary.json"), "[1, 2]").unwrap();
    let (kind, words) = kind_of(folder::prepare(dir.path(), &intent("v", "c", None, &[])));
    assert_eq!(kind, ErrorKind::AlreadyExists);
    assert!(words.contains("the result here is damaged: summary.json is not a whole result"), "{words}");
}

#[test]
fn a_failed_write_leaves_the_old_result_as_it_was() {
    let dir = tempfile::tempdir().unwrap();
    folder::write_result(dir.path(), &new(&result("a", "old"), None)).unwrap();
    let bad = [&result("b", "new")[..], &[file("path.csv/x", "")]].concat();
    assert!(folder::write_result(dir.path(), &new(&bad, None)).is_err());
    assert_eq!((names(dir.path()), table(dir.path())), (vec!["path.csv".into(), "summary.json".into()], "old".into()));
}

#[test]
fn a_file_of_somebody_with_the_name_of_a_note_is_refused_and_stays_and_one_that_was_left_is_taken_away() {
    let top = tempfile::tempdir().unwrap();
    let note = top.path().join(".spinneb.writing");
    for mine in ["work of years", "{}", "[1, 2]"] {
        fs::write(&note, mine).unwrap();
        let (kind, words) = kind_of(folder::prepare(top.path(), &intent("0.2.0", "abc", None, &[])));
        assert!(kind == ErrorKind::AlreadyExists && words.contains("is none: take it away"), "{words}");
        kind_of(folder::write_result(top.path(), &new(&result("abc", "new"), None)));
        kind_of(folder::discard_note(top.path()));
        assert_eq!(fs::read_to_string(&note).unwrap(), mine);
    }
    for left in ["", r#"{"earlier_of": null, "files": {"path.csv": ["12"]}}"#] {
        fs::write(&note, left).unwrap();
        folder::write_result(top.path(), &NewResult { keep_earlier: false, ..new(&result("abc", "new"), None) })
            .unwrap();
        assert_eq!(names(top.path()), ["path.csv", "summary.json"]);
    }
}
