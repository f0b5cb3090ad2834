//! Lattices beyond the chain: sites and bonds that are known by counting, and reference energies.

use spinneb::config::load_text;
use spinneb::lattice::{Lattice, LatticeSpec};
use std::path::Path;

fn lattice(text: &str) -> Lattice {
    serde_json::from_str::<LatticeSpec>(text).unwrap().resolve().unwrap()
}

/// Bonds of a shell.
fn bonds(lattice: &Lattice, shell: usize) -> usize {
    lattice.bonds(shell).len()
}

#[test]
fn shells_of_periodic_lattices_have_the_neighbours_of_the_crystal() {
    // neighbours of a site in each shell, and twice the squared distance of the first shells in units of a²
    for (text, neighbours, squares) in [
        (r#"{"square": {"cells": [9, 9], "periodic": true}}"#, vec![4, 4, 4, 8, 4], vec![2.0, 4.0, 8.0]),
        (r#"{"triangular": {"cells": [11, 11], "periodic": true}}"#, vec![6, 6, 6, 12, 6], vec![2.0, 6.0, 8.0]),
        (r#"{"honeycomb": {"cells": [7, 7], "periodic": true}}"#, vec![3, 6, 3, 6, 6], vec![2.0 / 3.0, 2.0]),
        (r#"{"kagome": {"cells": [7, 7], "periodic": true}}"#, vec![4, 4, 6], vec![0.5, 1.5, 2.0]),
        (r#"{"cubic": {"cells": [7, 7, 7], "periodic": true}}"#, vec![6, 12, 8, 6, 24], vec![2.0, 4.0, 6.0]),
        (r#"{"bcc": {"cells": [7, 7, 7], "periodic": true}}"#, vec![8, 6, 12, 24, 8], vec![1.5, 2.0, 4.0]),
        (r#"{"fcc": {"cells": [5, 5, 5], "periodic": true}}"#, vec![12, 6, 24, 12], vec![1.0, 2.0, 3.0]),
        (r#"{"hcp": {"cells": [7, 7, 5], "periodic": true}}"#, vec![12, 6, 2, 18, 12], vec![2.0, 4.0]),
    ] {
        let lattice = lattice(text);
        for (k, n) in neighbours.into_iter().enumerate() {
            assert_eq!(bonds(&lattice, k + 1), n * lattice.sites / 2, "{text}: shell {}", k + 1);
        }
        for (k, twice) in squares.into_iter().enumerate() {
            for family in lattice.shell(k + 1) {
                let square: f64 = family.along.iter().map(|c| c * c).sum();
                assert!((2.0 * square - twice).abs() < 1e-12, "{text}: shell {}: {square}", k + 1);
            }
        }
    }
}

#[test]
fn open_kagome_and_hcp_lattices_have_bonds_in_closed_form() {
    for (n, m) in [(2, 2), (3, 5), (6, 4)] {
        let kagome = lattice(&format!(r#"{{"kagome": {{"cells": [{n}, {m}]}}}}"#));
        // three in each upward triangle, and three in each downward one whose corners are in three cells
        let up = 3 * n * m;
        let down = (n - 1) * m + n * (m - 1) + (n - 1) * (m - 1);
        assert_eq!((kagome.sites, bonds(&kagome, 1)), (3 * n * m, up + down));
        for l in [2, 5] {
            let hcp = lattice(&format!(r#"{{"hcp": {{"cells": [{n}, {m}, {l}]}}}}"#));
            // in each of 2 l layers those of a triangular lattice; each site has three in the next layer but for the edges
            let layer = (n - 1) * m + n * (m - 1) + (n - 1) * (m - 1);
            let between = n * m + (n - 1) * m + n * (m - 1);
            assert_eq!(bonds(&hcp, 1), 2 * l * layer + (2 * l - 1) * between, "{n} {m} {l}");
        }
    }
}

#[test]
fn species_have_shells_of_their_own_with_each_other() {
    let text = r#"{"crystal": {"vectors": [[1, 0, 0], [0, 1, 0], [0, 0, 1.1]], "cells": [4, 4, 4], "periodic": true,
        "basis": [{"at": [0, 0, 0], "species": "Fe", "moment": "3 mu_B"}, {"at": [0.5, 0.5, 0.5], "species": "Pt"},
                  {"at": [0.5, 0.5, 0], "species": "Fe"}]}}"#;
    let lattice = lattice(text);
    assert_eq!((lattice.sites, &lattice.species[..]), (192, &["Fe".to_string(), "Pt".to_string()][..]));
    assert_eq!((lattice.moments_mub[0], lattice.moments_mub[64]), (Some(3.0), None));
    let lengths = |shell: usize| {
        let mut all: Vec<(usize, usize, i64)> = lattice
            .shell(shell)
            .iter()
            .map(|f| {
                let [a, b] = f.hop.atoms.map(|atom| lattice.atoms[atom].species);
                (a.min(b), a.max(b), (1e6 * f.along.iter().map(|c| c * c).sum::<f64>()).round() as i64)
            })
            .collect();
        all.sort_unstable();
        all.dedup();
        all
    };
    // Fe–Fe at ½, Fe–Pt at ¼ 1.1², Pt–Pt at 1; then at 1, ½ + ¼ 1.1², 1.1²
    assert_eq!(lengths(1), [(0, 0, 500_000), (0, 1, 302_500), (1, 1, 1_000_000)]);
    assert_eq!(lengths(2), [(0, 0, 1_000_000), (0, 1, 802_500), (1, 1, 1_210_000)]);
}

#[test]
fn across_a_short_periodic_border_both_images_count_and_no_site_is_its_own_neighbour() {
    let pairs = lattice(r#"{"square": {"cells": [2, 3], "periodic": true}}"#);
    assert_eq!(bonds(&pairs, 1), 12);
    for text in
        [r#"{"square": {"cells": [5, 1], "periodic": true}}"#, r#"{"cubic": {"cells": [2, 2, 1], "periodic": true}}"#]
    {
        let said = lattice(text).admits(1).unwrap_err().to_string();
        assert!(said.contains("images of themselves"), "{said}");
    }
    let said = lattice(r#"{"square": {"cells": [2, 2]}}"#).admits(3).unwrap_err().to_string();
    assert!(said.contains("further than the lattice"), "{said}");
}

fn of(reference: &str) -> serde_json::Value {
    let text = std::fs::read_to_string(Path::new("tests/reference").join(reference)).unwrap();
    serde_json::from_str(&text).unwrap()
}

#[test]
fn reference_lattices_have_the_sites_bonds_and_uniform_energies_of_the_reference() {
    let mut compared = 0;
    for case in of("lattices.json")["cases"].as_array().unwrap() {
        let name = case["name"].as_str().unwrap();
        let mut config = case["config"].clone();
        if !config["final"].as_object().unwrap().contains_key("uniform") {
            continue;
        }
        config["initial"] = serde_json::json!({"uniform": {"direction": [1, 0, 0]}});
        let Ok(loaded) = load_text(Path::new(&format!("{name}.json")), config.to_string()) else {
            continue;
        };
        let states = loaded.states(true).unwrap();
        let h = &states.hamiltonian;
        if let (Some(sites), Some(count)) = (case["sites"].as_u64(), case["bonds"].as_u64()) {
            let exchange: usize = h.constant_blocks().bond.iter().map(|b| b.family.bonds().count()).sum();
            assert_eq!((h.sites() as u64, exchange as u64), (sites, count), "{name}");
        }
        let Some(expected) = case["energy_meV"]["final"].as_f64() else { continue };
        // the reference relaxes its ends: with a DMI the uniform state of an open film is none
        if name == "square24_dmi" {
            continue;
        }
        let energy = h.energy_mev(states.final_state.unwrap().as_slice());
        assert!((energy - expected).abs() < 1e-9 * expected.abs(), "{name}: {energy} {expected}");
        compared += 1;
    }
    assert!(compared >= 13, "{compared}");
}
