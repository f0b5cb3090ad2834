//! The group of an energy: what is found, that it is a group, and that nothing else is in it.

use spinneb::energy::{Hamiltonian, Medium, TermSpec};
use spinneb::geometry::Direction;
use spinneb::landscape::Minimum;
use spinneb::lattice::{Chain, LatticeSpec};
use spinneb::spins::Spins;
use spinneb::stationary::relax_to_minimum;
use spinneb::symmetry::{Group, Operation};
use spinneb::units::Moment;

/// The energy of a chain, as configs write both; vacant sites have idle spins along z.
fn energy(chain: &str, terms: &str) -> Hamiltonian {
    let chain: Chain = serde_json::from_str(chain).unwrap();
    let lattice = chain.resolve().unwrap();
    let specs: Vec<TermSpec> = serde_json::from_str(terms).unwrap();
    let medium = Medium::new(&lattice, Some(Moment(2.0).into()), None);
    let terms = specs.iter().map(|s| s.member().build(&medium).unwrap()).collect();
    Hamiltonian::new(&lattice.clone().with_vacancies_frozen(Direction::Z), terms).unwrap()
}

/// The energy of any lattice.
fn on(lattice: &str, terms: &str) -> Hamiltonian {
    let lattice = serde_json::from_str::<LatticeSpec>(lattice).unwrap().resolve().unwrap();
    let specs: Vec<TermSpec> = serde_json::from_str(terms).unwrap();
    let medium = Medium::new(&lattice, Some(Moment(2.0).into()), None);
    let terms = specs.iter().map(|s| s.member().build(&medium).unwrap()).collect();
    Hamiltonian::new(&lattice.clone().with_vacancies_frozen(Direction::Z), terms).unwrap()
}

fn up(h: &Hamiltonian) -> Spins {
    Spins::uniform(h.sites(), Direction::Z)
}

/// Its group, after a look at every operation and at the products of any two: they leave the energies of other states as they are.
fn group(h: &Hamiltonian) -> Group {
    let group = Group::of(h, up(h).as_slice(), &[]);
    let list: Vec<Operation> = group.operations().collect();
    assert_eq!(list.len() + 1, group.order());
    let mut m = Spins::random(h.sites(), 99).as_slice().to_vec();
    for i in (0..h.sites()).filter(|i| h.is_frozen(*i)) {
        (0..3).for_each(|c| m[c * h.sites() + i] = f64::from(u8::from(c == 2)));
    }
    let same = |o: &Operation| {
        let off = h.difference_mev(&o.apply(&m), &m).abs();
        assert!(off < 1e-11 * h.stiffness_mev() * h.sites() as f64, "{o}: {off}");
    };
    for (k, a) in list.iter().enumerate().take(40) {
        assert!(!a.is_identity());
        same(a);
        list[..k].iter().for_each(|b| same(&a.after(b)));
    }
    group
}

fn names(h: &Hamiltonian) -> Vec<String> {
    group(h).operations().map(|o| o.to_string()).collect()
}

const EASY: &str = r#"{"exchange": {"J": ["1 meV"]}}, {"anisotropy": {"K": "0.2 meV", "axis": [0, 0, 1]}}"#;

fn with(more: &str) -> String {
    format!("[{EASY}{}{more}]", if more.is_empty() { "" } else { ", " })
}

#[test]
fn an_easy_axis_has_mirrors_of_spins_and_of_the_chain() {
    let h = energy(r#"{"sites": 6}"#, &with(""));
    let spins = ["m_x → −m_x", "m_z → −m_z", "m_xz → −m_xz"];
    let mirrored = spins.map(|s| format!("mirrored chain with {s}"));
    let all: Vec<String> =
        spins.iter().map(|s| s.to_string()).chain(["mirrored chain".into()]).chain(mirrored).collect();
    assert_eq!(names(&h), all);
    assert_eq!(group(&h).axes(), [[0.0, 0.0, 1.0]]);
}

#[test]
fn a_field_leaves_the_operations_that_keep_it() {
    let along = energy(r#"{"sites": 6}"#, &with(r#"{"zeeman": {"B": ["0 T", "0 T", "1 T"]}}"#));
    assert_eq!(names(&along), ["m_x → −m_x", "mirrored chain", "mirrored chain with m_x → −m_x"]);
    let across = energy(r#"{"sites": 1}"#, &with(r#"{"zeeman": {"B": ["1 T", "0 T", "0 T"]}}"#));
    assert_eq!(names(&across), ["m_y → −m_y", "m_z → −m_z", "m_yz → −m_yz"]);
    let tilted = energy(r#"{"sites": 1}"#, &with(r#"{"zeeman": {"B": ["1 T", "1 T", "1 T"]}}"#));
    assert_eq!(names(&tilted), ["m mirrored along [0.707, -0.707, 0.000]"]);
}

#[test]
fn a_bond_with_a_handedness_is_mirrored_with_its_spins_turned() {
    let h = energy(r#"{"sites": 5}"#, &with(r#"{"dmi": {"D": "0.1 meV", "direction": [0, 1, 0]}}"#));
    // y is D's: m_y ↦ −m_y turns no neighbours' sense of turning, m ↦ −m neither; a mirrored chain needs a turn about x or z
    let all = [
        "m_y → −m_y",
        "m_xz → −m_xz",
        "m_xyz → −m_xyz",
        "mirrored chain with m_x → −m_x",
        "mirrored chain with m_xy → −m_xy",
        "mirrored chain with m_z → −m_z",
        "mirrored chain with m_yz → −m_yz",
    ];
    let mut found = names(&h);
    found.sort();
    let mut expected = all.map(String::from);
    expected.sort();
    assert_eq!(found, expected);
}

#[test]
fn a_ring_has_shifts_and_one_defect_leaves_its_own_mirror() {
    for sites in [3, 7, 200] {
        let ring = format!(r#"{{"sites": {sites}, "periodic": true}}"#);
        let h = energy(&ring, &with(""));
        assert_eq!(group(&h).order(), 4 * sites * 2);
        let defect = r#"{"anisotropy": {"K": "0.1 meV", "axis": [0, 0, 1], "sites": [1]}}"#;
        let found = names(&energy(&ring, &with(defect)));
        assert_eq!(found.len(), 7);
        let two = r#"{"anisotropy": {"K": "0.1 meV", "axis": [0, 0, 1], "sites": [0, 1]}}"#;
        assert_eq!(group(&energy(&ring, &with(two))).order(), 8);
    }
    let every_third = r#"{"anisotropy": {"K": "0.1 meV", "axis": [0, 0, 1], "sites": [0, 3, 6, 9]}}"#;
    let h = energy(r#"{"sites": 12, "periodic": true}"#, &with(every_third));
    let g = group(&h);
    assert_eq!((g.order(), g.shifts()[0].order), (4 * 4 * 2, 4));
    assert_eq!(g.shifts()[0].operation.to_string(), "shifted by 3 sites");
}

#[test]
fn neighbours_whose_axes_are_crossed_go_over_into_each_other_by_a_shift_and_a_turn() {
    let crossed = r#"[{"exchange": {"J": ["1 meV"]}},
        {"anisotropy": {"K": "0.2 meV", "axis": [1, 0, 0], "sites": [0, 2, 4, 6]}},
        {"anisotropy": {"K": "0.2 meV", "axis": [0, 0, 1], "sites": [1, 3, 5, 7]}}]"#;
    let g = group(&energy(r#"{"sites": 8, "periodic": true}"#, crossed));
    assert_eq!(g.shifts()[0].order, 8);
    assert_eq!(g.shifts()[0].operation.to_string(), "shifted by a site with m mirrored along [0.707, 0.000, -0.707]");
    assert_eq!(g.order(), 8 * 8 * 2);
}

#[test]
fn an_antiferromagnet_is_mirrored_and_reversed() {
    let terms = r#"[{"exchange": {"J": ["-1 meV"]}}, {"anisotropy": {"K": "0.2 meV", "axis": [0, 0, 1]}}]"#;
    for sites in [4_usize, 5] {
        let h = energy(&format!(r#"{{"sites": {sites}}}"#), terms);
        let g = group(&h);
        let neel: Vec<_> = (0..sites).map(|i| [0.0, 0.0, if i.is_multiple_of(2) { 1.0 } else { -1.0 }]).collect();
        let neel = Spins::from_vectors(&neel).unwrap();
        let kept = g.classes().iter().filter(|o| o.apply(neel.as_slice()) == neel.as_slice());
        assert_eq!((g.order(), kept.count()), (8, 4));
    }
}

#[test]
fn frozen_spins_stay_what_they_are() {
    let up = |list: &str| format!(r#"{{"sites": 5, "frozen": [{{"sites": {list}, "direction": [0, 0, 1]}}]}}"#);
    assert_eq!(names(&energy(&up("[0]"), &with(""))), ["m_x → −m_x"]);
    assert_eq!(names(&energy(&up("[0, 4]"), &with(""))).len(), 3);
    let vacant = r#"{"sites": 5, "vacant": [1, 3]}"#;
    let h = energy(vacant, &with(""));
    assert_eq!(group(&h).order(), 8);
    for o in group(&h).operations() {
        let m = Spins::random(5, 3);
        let moved = o.apply(m.as_slice());
        assert!([1, 3, 6, 8, 11, 13].iter().all(|c| moved[*c] == m.as_slice()[*c]));
        assert!([0, 5, 10].map(|c| o.apply_field(m.as_slice())[c + 1]).iter().all(|v| *v == 0.0));
    }
}

#[test]
fn a_cubic_site_has_forty_eight_operations_however_its_axes_lie() {
    for axes in ["[[1, 0, 0], [0, 1, 0]]", "[[1, 1, 0], [-1, 1, 0]]", "[[1, 2, 2], [2, 1, -2]]"] {
        let cubic = format!(r#"{{"cubic_anisotropy": {{"K": "0.2 meV", "axes": {axes}}}}}"#);
        let h = energy(r#"{"sites": 3}"#, &format!(r#"[{{"exchange": {{"J": ["1 meV"]}}}}, {cubic}]"#));
        assert_eq!(group(&h).order(), 96, "{axes}");
    }
}

#[test]
fn exchange_alone_can_be_reversed_and_what_is_uneven_has_nothing() {
    let h = energy(r#"{"sites": 4}"#, r#"[{"exchange": {"J": ["1 meV"]}}]"#);
    assert_eq!(names(&h), ["m_xyz → −m_xyz", "mirrored chain", "mirrored chain with m_xyz → −m_xyz"]);
    let uneven = r#"[{"exchange": {"J": [["1 meV", "-2 meV", "0.7 meV"]]}},
        {"anisotropy": {"K": "0.3 meV", "axis": [1, 2, 3]}}, {"anisotropy": {"K": "0.2 meV", "axis": [3, -1, 1]}},
        {"zeeman": {"B": ["1 T", "-0.5 T", "2 T"]}}]"#;
    assert_eq!(group(&energy(r#"{"sites": 4}"#, uneven)).order(), 1);
}

#[test]
fn dipoles_know_the_direction_of_their_chain() {
    let terms = with(r#"{"dipolar": {}}"#);
    for (ring, places) in [(false, 2), (true, 12)] {
        let chain = format!(r#"{{"sites": 6, "spacing": "0.3 nm", "periodic": {ring}}}"#);
        assert_eq!(group(&energy(&chain, &terms)).order(), 8 * places);
    }
}

#[test]
fn images_of_a_minimum_are_minima_of_the_same_energy() {
    let terms = with(
        r#"{"anisotropy": {"K": "-0.3 meV", "axis": [1, 2, 0]}}, {"dmi": {"D": "0.4 meV", "direction": [0, 0, 1]}},
        {"dipolar": {}}"#,
    );
    let h = energy(r#"{"sites": 9, "spacing": "0.3 nm", "direction": [1, 2, 0], "periodic": true}"#, &terms);
    let group = group(&h);
    assert!(group.order() >= 72, "{}", group.order());
    let relaxed = relax_to_minimum((&h).into(), &Spins::random(9, 5), 1e-12).unwrap().spins;
    let minimum = Minimum::examine((&h).into(), &relaxed);
    assert!(minimum.is_proven());
    for operation in group.operations() {
        let spins = Spins::from_components(&operation.apply(relaxed.as_slice())).unwrap();
        let image = Minimum::examine((&h).into(), &spins);
        assert!(image.is_proven() && (image.energy_mev - minimum.energy_mev).abs() < 1e-12, "{operation}");
        // a tangent field is taken to one, and the force with the state
        let v: Vec<f64> = (0..27).map(|k| libm::sin(k as f64)).collect();
        let (mut moved, mut tangent) = (operation.apply_field(&v), v);
        spinneb::field::project(relaxed.as_slice(), &mut tangent);
        spinneb::field::project(spins.as_slice(), &mut moved);
        let off = operation.apply_field(&tangent).iter().zip(&moved).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-14, "{operation}: {off}");
        assert!(group.takes(&operation, relaxed.as_slice(), spins.as_slice(), 1e-9));
    }
}

#[test]
fn a_ring_of_unlike_sites_costs_no_more_than_an_even_one() {
    // axes of random strength, no two sites alike; half and half, every site like one other
    let sites = 2000;
    let random = |seed: u64| Spins::random(sites, seed).vectors();
    let list = |v: Vec<String>| format!("[{}]", v.join(", "));
    let strengths = list(random(5).iter().map(|v| format!("\"{} meV\"", 1.0 + 0.3 * v[2])).collect());
    let half = list((0..sites).map(|i| format!("\"{} meV\"", if i < sites / 2 { 0.2 } else { 0.1 })).collect());
    let ring = format!(r#"{{"sites": {sites}, "periodic": true}}"#);
    for (k, order) in [(&strengths, 4), (&half, 8)] {
        let terms =
            format!(r#"[{{"exchange": {{"J": ["1 meV"]}}}}, {{"anisotropy": {{"K": {k}, "axis": [0, 0, 1]}}}}]"#);
        assert_eq!(group(&energy(&ring, &terms)).order(), order);
    }
}

#[test]
fn films_and_crystals_have_the_groups_of_their_lattices_and_interactions() {
    let field = r#"{"zeeman": {"B": ["0 T", "0 T", "1 T"]}}"#;
    let interface = r#"{"dmi": {"D": "0.4 meV", "kind": "interfacial"}}"#;
    let bulk = r#"{"dmi": {"D": "0.4 meV", "kind": "bulk"}}"#;
    let d2d = r#"{"dmi": {"D": "0.4 meV", "kind": "d2d"}}"#;
    let both = |a: &str, b: &str| format!("{a}, {b}");
    for (lattice, more, order) in [
        // rotations about z counted as one: four classes of spins alone, and the motions of the square
        (r#"{"square": {"cells": [4, 4]}}"#, String::new(), 4 * 8),
        (r#"{"square": {"cells": [4, 4]}}"#, interface.into(), 2 * 8),
        (r#"{"square": {"cells": [4, 4]}}"#, both(interface, field), 8),
        (r#"{"square": {"cells": [4, 4]}}"#, both(bulk, field), 8),
        (r#"{"square": {"cells": [4, 4]}}"#, both(d2d, field), 8),
        (r#"{"square": {"cells": [5, 4], "periodic": true}}"#, both(interface, field), 4 * 20),
        (r#"{"square": {"cells": [9, 9], "shape": {"disc": {"radius": 4}}}}"#, both(interface, field), 8),
        (r#"{"square": {"cells": [4, 4], "vacant": [5]}}"#, both(interface, field), 2),
        (r#"{"triangular": {"cells": [4, 4]}}"#, both(interface, field), 4),
        (r#"{"triangular": {"cells": [6, 6], "periodic": true}}"#, both(interface, field), 12 * 36),
        (r#"{"honeycomb": {"cells": [3, 3], "periodic": true}}"#, both(interface, field), 12 * 9),
        (r#"{"kagome": {"cells": [3, 3], "periodic": true}}"#, both(interface, field), 12 * 9),
        (r#"{"cubic": {"cells": [3, 3, 2], "periodic": [true, true, false]}}"#, both(bulk, field), 8 * 9),
        // the corner of an open box of cubes keeps three axes alike, and its middle is a centre of inversion
        (r#"{"bcc": {"cells": [3, 3, 3]}}"#, String::new(), 4 * 12),
        (r#"{"hcp": {"cells": [3, 3, 2], "periodic": true}}"#, String::new(), 4 * 24 * 18),
    ] {
        let h = on(lattice, &with(&more));
        assert_eq!(group(&h).order(), order, "{lattice} {more}");
    }
}

#[test]
fn operations_of_a_film_say_how_they_turn_it() {
    let h = on(
        r#"{"square": {"cells": [3, 3]}}"#,
        &with(r#"{"dmi": {"D": "0.4 meV", "kind": "interfacial"}}, {"zeeman": {"B": ["0 T", "0 T", "1 T"]}}"#),
    );
    let said = names(&h);
    assert!(said.contains(&"lattice mirrored along +x with m_x → −m_x".to_string()), "{said:?}");
    assert!(
        said.iter().any(|s| s.starts_with("lattice turned by 90° about") && s.contains("with m turned by 90° about")),
        "{said:?}"
    );
}

#[test]
fn a_cluster_of_one_cell_has_the_group_of_the_same_sites_as_a_lattice() {
    let terms = with(r#"{"anisotropy": {"K": "-0.1 meV", "axis": [1, 1, 0]}}"#);
    let part = |k: usize| (k as f64 + 0.5) / 5.0;
    let atoms: Vec<String> = (0..25).map(|i| format!(r#"{{"at": [{}, {}, 0.5]}}"#, part(i % 5), part(i / 5))).collect();
    let vectors = r#""vectors": [[5, 0, 0], [0, 5, 0], [0, 0, 1]]"#;
    let cluster = format!(r#"{{"crystal": {{{vectors}, "basis": [{}], "cells": [1, 1, 1]}}}}"#, atoms.join(", "));
    let square = on(r#"{"square": {"cells": [5, 5]}}"#, &terms);
    assert_eq!(names(&on(&cluster, &terms)), names(&square));
    assert_eq!(group(&square).order(), 64);
}

/// A honeycomb whose bonds couple m·x, m·y and m·z of a frame of spins, by the direction of the bond, and a little what is across.
fn kitaev(frame: [[f64; 3]; 3]) -> Hamiltonian {
    let entry = |k: usize, r: usize, c: usize| {
        let [own, one, other] = [k, (k + 1) % 3, (k + 2) % 3].map(|k| frame[k]);
        own[r] * own[c] + 0.3 * (one[r] * other[c] + other[r] * one[c])
    };
    let bond = |(k, cell): (usize, [isize; 3])| {
        let row = |r: usize| [0, 1, 2].map(|c| format!("{} meV", entry(k, r, c)));
        let tensor = [0, 1, 2].map(row);
        format!(r#"{{"from": 0, "to": 1, "cell": {cell:?}, "J": "2 meV", "tensor": {tensor:?}}}"#)
    };
    let bonds = [[0, 0, 0], [-1, 0, 0], [0, -1, 0]].into_iter().enumerate().map(bond);
    let pairs = format!(r#"[{{"pairs": {{"bonds": [{}]}}}}]"#, bonds.collect::<Vec<_>>().join(", "));
    on(r#"{"honeycomb": {"cells": [3, 3], "periodic": true}}"#, &pairs)
}

#[test]
fn exchange_matrices_have_their_operations_in_any_frame_of_spins() {
    let unit = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let [a, b] = [0.7_f64, 0.4].map(|angle| (angle.cos(), angle.sin()));
    let turned = [[a.0, a.1 * b.0, a.1 * b.1], [-a.1, a.0 * b.0, a.0 * b.1], [0.0, -b.1, b.0]];
    let order = group(&kitaev(unit)).order();
    assert_eq!((order, group(&kitaev(turned)).order()), (216, 216));
}
