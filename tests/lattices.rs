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

/// What is said of a config of this lattice and these terms, or its energy of all spins along z and its bonds.
fn energy_of(lattice: &str, terms: &str) -> Result<(f64, usize), String> {
    let text = format!(
        r#"{{"material": {{"name": "m", "source": "x", "moment": "1 mu_B", "energy": []}}, "lattice": {lattice}, "energy": {terms},
            "initial": {{"uniform": {{"direction": [0, 0, 1]}}}}, "final": {{"uniform": {{"direction": [0, 0, -1]}}}}}}"#
    );
    let states =
        load_text(Path::new("some.json"), text).and_then(|loaded| loaded.states(true)).map_err(|e| e.to_string())?;
    let bonds = states.hamiltonian.constant_blocks().bond.iter();
    let count = bonds.map(|b| b.family.bonds().filter(|[i, _]| b.isotropic[*i] != 0.0).count()).sum();
    Ok((states.hamiltonian.energy_mev(states.initial.as_slice()), count))
}

#[test]
fn a_bond_term_takes_the_bonds_within_a_selection_or_between_two() {
    let film = r#"{"square": {"cells": [6, 5], "regions": {"left": {"box": {"from": [0], "to": [2]}}}}}"#;
    let layers = r#"{"cubic": {"cells": [4, 3, 4]}}"#;
    let alloy = r#"{"crystal": {"vectors": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "cells": [3, 3, 3], "periodic": true,
        "basis": [{"at": [0, 0, 0], "species": "Fe"}, {"at": [0.5, 0.5, 0.5], "species": "Pt"}]}}"#;
    for (lattice, selection, bonds) in [
        (film, r#""sites": "left""#, 2 * 5 + 3 * 4),
        (film, r#""sites": {"not": {"box": {"from": [0], "to": [2]}}}"#, 2 * 5 + 3 * 4),
        (film, r#""between": ["left", {"box": {"from": [3], "to": [5]}}]"#, 5),
        (film, r#""sites": [0, 1, 6]"#, 2),
        // two layers apart the first shell between them is the second neighbour along z
        (
            layers,
            r#""between": [{"box": {"from": [0, 0, 0], "to": [9, 9, 0]}}, {"box": {"from": [0, 0, 2], "to": [9, 9, 2]}}]"#,
            12,
        ),
        (alloy, r#""between": ["Fe", "Pt"]"#, 27 * 8),
        (alloy, r#""between": ["Pt", "Pt"]"#, 27 * 3),
        (alloy, r#""sites": "Fe""#, 27 * 3),
    ] {
        let terms = format!(r#"[{{"exchange": {{"J": ["1 meV"], {selection}}}}}]"#);
        assert_eq!(energy_of(lattice, &terms).unwrap(), (-(bonds as f64), bonds), "{selection}");
    }
    // sites that are no nearest neighbours have bonds of the second shell alone
    for term in [
        r#"{"exchange": {"J": ["9 meV", "1 meV"], "sites": [0, 7, 14]}}"#,
        r#"{"biquadratic": {"B": ["9 meV", "1 meV"], "sites": [0, 7, 14]}}"#,
    ] {
        assert_eq!(energy_of(film, &format!("[{term}]")).unwrap().0, -2.0, "{term}");
    }
    for (lattice, term, said) in [
        (
            film,
            r#"{"exchange": {"J": ["1 meV"], "bonds": [3]}}"#,
            "energy[0].exchange.bonds: bonds are chosen by number",
        ),
        (film, r#"{"exchange": {"J": ["1 meV"], "sites": [0, 8]}}"#, "no bond has both its ends"),
        (film, r#"{"exchange": {"J": ["1 meV", "1 meV"], "sites": [0, 8]}}"#, "no bond has both its ends"),
        (film, r#"{"exchange": {"J": ["1 meV"], "between": ["left", "right"]}}"#, "between[1]: no region \"right\""),
        (alloy, r#"{"exchange": {"J": ["1 meV"], "sites": "Co"}}"#, "there are \"Fe\", \"Pt\""),
        (film, r#"{"exchange": {"A": "10 pJ/m"}}"#, "give the lattice as a \"grid\""),
        (film, r#"{"dmi": {"D": "1 meV"}}"#, "a DMI needs a \"kind\""),
        (film, r#"{"dipolar": {}}"#, "along a chain only"),
    ] {
        let found = energy_of(lattice, &format!("[{term}]")).unwrap_err();
        assert!(found.contains(said), "{term}: {found}");
    }
}

#[test]
fn a_grid_takes_its_numbers_from_densities_face_by_face() {
    let grid = r#"{"grid": {"cells": [4, 3, 2], "cell": ["2 nm", "3 nm", "0.5 nm"]}}"#;
    // 2 A S/a a face, in meV: 1 pJ/m is 1e-12/1.602176634e-22/1e9 meV/nm
    let a = 10.0 / 0.1602176634;
    let faces = 3.0 * 3.0 * 2.0 * (1.5 / 2.0) + 4.0 * 2.0 * 2.0 * (1.0 / 3.0) + 12.0 * (6.0 / 0.5);
    let (energy, bonds) = energy_of(grid, r#"[{"exchange": {"A": "10 pJ/m"}}]"#).unwrap();
    assert_eq!(bonds, 18 + 16 + 12);
    assert!((energy + 2.0 * a * faces).abs() < 1e-9 * energy.abs(), "{energy} {}", 2.0 * a * faces);
    let (energy, _) = energy_of(grid, r#"[{"anisotropy": {"K": "1 MJ/m^3", "axis": [0, 0, 1]}}]"#).unwrap();
    assert!((energy + 24.0 * 3.0 * 1e6 * 1e-27 / 1.602176634e-22).abs() < 1e-9 * energy.abs(), "{energy}");
    let layers =
        r#""between": [{"box": {"from": [0, 0, 0], "to": [4, 3, 1]}}, {"box": {"from": [0, 0, 1], "to": [4, 3, 2]}}]"#;
    let (energy, bonds) = energy_of(grid, &format!(r#"[{{"exchange": {{"J_area": "2 mJ/m^2", {layers}}}}}]"#)).unwrap();
    assert_eq!(bonds, 12);
    assert!((energy + 12.0 * 6.0 * 2e-3 * 1e-18 / 1.602176634e-22).abs() < 1e-9 * energy.abs(), "{energy}");
}

#[test]
fn selections_choose_spins_that_are_frozen_vacant_or_of_another_moment_in_any_lattice_and_in_chains() {
    let film = lattice(
        r#"{"honeycomb": {"cells": [4, 4], "vacant": {"disc": {"center": [0, 0], "radius": 0.1}}, "shape": {"box": {"from": [0, 0], "to": [3, 9]}},
            "frozen": [{"sites": {"box": {"from": [0, 2.5], "to": [9, 9]}}, "direction": [0, 0, 1]}],
            "moments": [{"sites": "edge", "moment": "3 mu_B"}], "regions": {"edge": {"box": {"from": [2.5], "to": [3]}}}}}"#,
    );
    for i in 0..film.sites {
        let [x, y, _] = film.position(i);
        assert!((-1e-9..=3.0 + 1e-9).contains(&x), "{x}");
        assert_eq!(film.vacant[i], x.abs() + y.abs() < 1e-9);
        assert_eq!(film.is_frozen()[i], y > 2.5);
        assert_eq!(film.moments_mub[i], (x > 2.5 - 1e-9).then_some(3.0));
    }
    let chain = lattice(r#"{"chain": {"sites": 20, "direction": [0, 1, 0], "vacant": {"disc": {"radius": 1}}}}"#);
    assert_eq!((0..20).filter(|i| chain.vacant[*i]).collect::<Vec<_>>(), [9, 10]);
}

#[test]
fn the_kinds_of_dmi_turn_spins_about_the_directions_of_their_symmetry() {
    // E of one bond along r̂, with m_i = a and m_j = b: D d̂·(a × b)
    let one = |sites: &str, kind: &str| {
        let text = format!(r#"[{{"dmi": {{"D": ["2 meV"], {kind}, "sites": {sites}}}}}]"#);
        let config = format!(
            r#"{{"material": {{"name": "m", "source": "x", "energy": []}}, "lattice": {{"square": {{"cells": [2, 2]}}}}, "energy": {text},
            "initial": {{"uniform": {{"direction": [0, 0, 1]}}}}, "final": {{"uniform": {{"direction": [0, 0, -1]}}}}}}"#
        );
        let states = load_text(Path::new("some.json"), config).unwrap().states(true).unwrap();
        let at = |first: [f64; 3], second: [f64; 3]| {
            let (i, j) = if sites == "[0, 1]" { (0, 1) } else { (0, 2) };
            let mut m = vec![0.0; 12];
            for c in 0..3 {
                (0..4).for_each(|k| m[4 * c + k] = first[c]);
                m[4 * c + i] = first[c];
                m[4 * c + j] = second[c];
            }
            states.hamiltonian.energy_mev(&m)
        };
        // (d̂_x, d̂_y, d̂_z)
        [at([0., 1., 0.], [0., 0., 1.]), at([0., 0., 1.], [1., 0., 0.]), at([1., 0., 0.], [0., 1., 0.])]
            .map(|e| e / 2.0)
    };
    for (kind, along_x, along_y) in [
        (r#""kind": "interfacial""#, [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]),
        (r#""kind": "interfacial", "normal": [0, 0, -1]"#, [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]),
        (r#""kind": "bulk""#, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
        (r#""kind": "d2d""#, [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]),
        (r#""direction": [0, 0, 1]"#, [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]),
    ] {
        assert_eq!([one("[0, 1]", kind), one("[0, 2]", kind)], [along_x, along_y], "{kind}");
    }
}

#[test]
fn a_table_of_pairs_is_the_list_of_its_bonds_and_the_config_as_run_has_them() {
    let temporary = tempfile::tempdir().unwrap();
    let folder = temporary.path();
    std::fs::write(folder.join("bonds.csv"), "from,to,cell_1,cell_2,J_mRy,D_z_meV\n0,0,1,0,1,0.5\n0,0,0,1,0.5,0\n")
        .unwrap();
    let config = |pairs: &str| {
        format!(
            r#"{{"material": {{"name": "m", "source": "x", "energy": [{{"pairs": {{{pairs}}}}}]}}, "lattice": {{"square": {{"cells": [4, 3]}}}},
            "initial": {{"random": {{"seed": 3}}}}, "final": {{"uniform": {{"direction": [0, 0, -1]}}}}}}"#
        )
    };
    let load = |pairs: &str| load_text(&folder.join("film.json"), config(pairs)).map_err(|e| e.to_string());
    let convention = r#""convention": {"counting": "once", "energy": "-2J"}"#;
    let loaded = load(&format!(r#""file": "bonds.csv", {convention}"#)).unwrap();
    let listed = load(&format!(
        r#""bonds": [{{"from": 0, "to": 0, "cell": [1, 0, 0], "J": "1 mRy", "D": ["0 meV", "0 meV", "0.5 meV"]}},
            {{"from": 0, "to": 0, "cell": [0, 1, 0], "J": "0.5 mRy"}}], {convention}"#
    ));
    let energy = |loaded: &spinneb::config::Loaded| {
        let states = loaded.states(false).unwrap();
        states.hamiltonian.energy_mev(states.initial.as_slice())
    };
    assert_eq!(energy(&loaded), energy(&listed.unwrap()));
    let again = load_text(Path::new("elsewhere.json"), loaded.as_run.clone()).unwrap();
    assert_eq!((energy(&again), again.sha256 == loaded.sha256), (energy(&loaded), true));
    assert!(load(r#""file": "bonds.csv""#).err().unwrap().contains("pairs.convention: a table needs the convention"));
    assert!(load(&format!(r#""file": "none.csv", {convention}"#)).err().unwrap().contains("none.csv"));
}

#[test]
fn materials_by_region_meet_in_the_harmonic_mean_on_any_lattice() {
    let text = r#"{"material": {
            "default": {"name": "a", "source": "x", "moment": "1 mu_B", "energy": [{"exchange": {"J": ["2 meV", "1 meV"]}}]},
            "right": {"name": "b", "source": "x", "moment": "3 mu_B", "energy": [{"exchange": {"J": ["6 meV"]}}, {"zeeman": {"B": ["0 T", "0 T", "1 T"]}}]}},
        "lattice": {"square": {"cells": [4, 3], "regions": {"right": {"box": {"from": [2], "to": [3]}}}}},
        "initial": {"uniform": {"direction": [0, 0, 1]}}, "final": {"uniform": {"direction": [0, 0, -1]}}}"#;
    let states = load_text(Path::new("two.json"), text.into()).unwrap().states(false).unwrap();
    // per half: 3 + 4 nearest and 4 second bonds; 3 nearest bonds of 2·2·6/8 = 3 between, whose second shell is that of one half alone
    let expected = -(7.0 * 2.0 + 4.0 * 1.0 + 7.0 * 6.0 + 3.0 * 3.0) - 6.0 * 3.0 * 5.7883817982e-2;
    let energy = states.hamiltonian.energy_mev(states.initial.as_slice());
    assert!((energy - expected).abs() < 1e-12, "{energy} {expected}");
}
