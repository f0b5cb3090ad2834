//! The README tells the truth: its commands, its config and its numbers are those of the program.

use crate::pages::{Page, root, text};
use serde_json::Value;
use std::fs;

fn readme() -> Page {
    Page::read("README.md")
}

#[test]
fn the_two_commands_are_those_of_the_gate() {
    let blocks = readme().blocks_of("sh");
    let commands: Vec<&str> = blocks[0].lines().collect();
    assert_eq!(commands, ["cargo run --release -- run configs/wall_nucleation.json", "cargo test --release"]);
    let gate = text(".ci/run");
    for command in commands {
        let is_it = |line: &str| line.strip_prefix("stage ").is_some_and(|l| l.trim_end_matches(" --force") == command);
        assert!(gate.lines().any(is_it), "{command} is no stage of .ci/run");
    }
}

#[test]
fn it_is_short_and_its_config_too() {
    let readme = readme();
    assert!(readme.text.lines().count() <= 200);
    let [config] = &readme.blocks_of("json")[..] else { panic!("one config") };
    assert!(config.lines().count() <= 12);
    let notebook = readme.blocks_of("python").into_iter().next().unwrap();
    assert!(notebook.lines().count() <= 12);
    assert_eq!(readme.follow(), 2);
}

#[test]
fn the_barrier_is_that_of_the_gallery_which_another_test_compares_with_a_run() {
    let stored: Value =
        serde_json::from_slice(&fs::read(root().join("results/gallery/wall_nucleation/summary.json")).unwrap())
            .unwrap();
    assert_eq!(stored["certified"], true);
    let forward = stored["barrier_meV"]["forward"].as_f64().unwrap();
    for digits in [6, 9] {
        let number = format!("{forward:.digits$} meV");
        assert!(readme().text.contains(&number), "the README does not say {number}");
    }
}

#[test]
fn what_is_linked_exists_and_the_rust_version_is_that_of_the_package() {
    readme().check_links();
    let version = env!("CARGO_PKG_RUST_VERSION");
    for (page, times) in [("README.md", 2), ("docs/src/citing.md", 1)] {
        let page = text(page);
        assert_eq!(page.matches(&format!("{version} or later")).count(), times, "{version}");
        assert_eq!(page.matches(" or later").count(), times);
    }
}

#[test]
fn what_it_leads_to_is_in_the_crate_but_for_the_python_package() {
    let listing = std::process::Command::new(env!("CARGO"))
        .args(["package", "--list", "--allow-dirty", "--offline", "--manifest-path"])
        .arg(root().join("Cargo.toml"))
        .output()
        .unwrap();
    assert!(listing.status.success(), "{}", String::from_utf8_lossy(&listing.stderr));
    let listing = String::from_utf8(listing.stdout).unwrap();
    let packed: std::collections::BTreeSet<&str> = listing.lines().collect();
    let readme = readme();
    for link in readme.links().into_iter().filter(|link| !link.starts_with("https://") && !link.starts_with("python/"))
    {
        assert!(packed.contains(link), "{link}: add it to `include` in Cargo.toml");
    }
    for folder in ["tests/", "benches/", "results/", "python/", "tools/"] {
        let odd: Vec<_> =
            packed.iter().filter(|file| file.starts_with(folder) && !readme.links().contains(file)).collect();
        assert!(odd.is_empty(), "{odd:?}");
    }
}
