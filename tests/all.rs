//! The tests of the library and of the program: one binary, so that the library is linked once and all cores are used to the end.
//! `cargo test --test all rates::` runs those of one file.

// the campaigns of benches/ are programs of their own, each with all its files
#![allow(clippy::duplicate_mod)]

mod common;
mod pages;

mod any_lattice;
mod book;
mod climb;
mod configs;
mod conventions;
mod counts;
mod custom_terms;
mod descents;
mod dynamics;
mod energy;
mod equivalent_films;
mod file_configs;
mod files;
mod film_barriers;
mod films;
mod fuzz;
mod gallery;
mod geometry;
mod guesses;
mod import;
mod interrupted;
mod kills;
mod kin;
mod landscape_command;
mod landscape_shares;
mod lattices;
mod library;
mod longrange;
mod lowest;
mod media;
mod modules;
mod network;
mod other_saddles;
mod output;
mod parts;
mod physics;
mod plot_command;
mod rate_command;
mod rates;
mod readme;
mod reference;
mod relax;
mod result_folder;
mod resume;
mod run;
mod sliding_saddles;
mod soft_rotations;
mod start;
mod states;
mod structure;
mod sweep;
mod symmetry;
mod turning_minima;
mod without_factors;

#[test]
fn every_file_of_tests_is_among_them() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests");
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let missing: Vec<String> = files
        .filter(|file| file.extension().is_some_and(|e| e == "rs"))
        .map(|file| file.file_stem().unwrap().to_string_lossy().into_owned())
        .filter(|name| name != "all" && !include_str!("all.rs").contains(&format!("\nmod {name};\n")))
        .collect();
    assert!(missing.is_empty(), "tests/all.rs does not name {missing:?}");
}
