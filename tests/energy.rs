//! Every registered energy term keeps its contract: energy, gradient and Hessian are derivatives of one another.

#[path = "../benches/shared/qdldl.rs"]
mod qdldl;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use spinneb::energy::{EnergyTerm, Hamiltonian, Medium, TermSpec};
use spinneb::field::{Components, ComponentsMut, project};
use spinneb::geometry::{Direction, exp, rotate, tangent_basis, vector};
use spinneb::hessian::{TangentBasis, assemble};
use spinneb::lattice::{Chain, Frozen, Lattice, LatticeSpec, Selection};
use spinneb::linalg::Matrix;
use spinneb::spins::Spins;
use spinneb::units::{Length, Moment};

fn chain(sites: usize, periodic: bool) -> Chain {
    let cross_section = Some([Length(2.0), Length(3.0)].map(Into::into));
    Chain { periodic, spacing: Some(Length(1.5)), cross_section, ..Chain::open(sites) }
}

fn build(text: &str, chain: &Lattice) -> Box<dyn EnergyTerm> {
    let spec: TermSpec = serde_json::from_str(text).expect(text);
    spec.member().build(&Medium::new(chain, Some(Moment(2.0).into()), None)).expect(text)
}

fn random_spins(sites: usize, seed: u64) -> Vec<f64> {
    let mut r = ChaCha8Rng::seed_from_u64(seed);
    let vectors: Vec<_> = (0..sites).map(|_| [0; 3].map(|_| r.random_range(-1.0..1.0))).collect();
    Spins::from_vectors(&vectors).unwrap().as_slice().to_vec()
}

fn random_tangent(m: &[f64], seed: u64) -> Vec<f64> {
    let mut r = ChaCha8Rng::seed_from_u64(seed);
    let mut v: Vec<f64> = m.iter().map(|_| r.random_range(-1.0..1.0)).collect();
    project(m, &mut v);
    v
}

/// m turned along the tangent field v by the exponential map.
fn moved(m: &[f64], v: &[f64], t: f64) -> Vec<f64> {
    let mut out = vec![0.0; m.len()];
    let (mc, vc) = (Components::new(m), Components::new(v));
    for i in 0..mc.sites() {
        ComponentsMut::new(&mut out).set(i, exp(mc.get(i), vector::scale(t, vc.get(i))));
    }
    out
}

fn gradient_and_product(h: &Hamiltonian, m: &[f64], v: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let (mut gradient, mut product) = (vec![0.0; m.len()], vec![0.0; m.len()]);
    h.energy_gradient(m, &mut gradient);
    h.hessian_product(m, &gradient, v, &mut product);
    (gradient, product)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Every example of the registry, and variants that the examples do not show.
fn fragments() -> Vec<String> {
    let more = [
        r#"{"exchange": {"J": ["-4 meV", "1 meV", "-0.3 meV"]}}"#,
        r#"{"exchange": {"A": "13 pJ/m", "bonds": [1, 3]}}"#,
        r#"{"anisotropy": {"K": "-20 kJ/m^3", "axis": [1, 2, -1], "sites": {"from": 1, "to": 3}}}"#,
        r#"{"anisotropy": {"K": "0 meV", "axis": [0, 1, 1], "K2": "-0.4 meV"}}"#,
        r#"{"cubic_anisotropy": {"K": "-0.3 meV", "sites": [0, 2]}}"#,
        r#"{"dmi": {"D": "1.2 mJ/m^2", "direction": [0.3, -1, 0.2], "bonds": [0, 2]}}"#,
        r#"{"zeeman": {"B": ["10 mT", "1 kOe", "-0.2 T"], "sites": [0, 4]}}"#,
    ];
    TermSpec::ENTRIES.iter().map(|e| e.example.to_string()).chain(more.map(String::from)).collect()
}

#[test]
fn every_entry_parses_into_the_member_of_its_name() {
    for entry in TermSpec::ENTRIES {
        let spec: TermSpec = serde_json::from_str(entry.example).expect(entry.example);
        assert_eq!(spec.name(), entry.name);
        assert_eq!(build(entry.example, &chain(8, false).resolve().unwrap()).name(), entry.name);
    }
}

#[test]
fn the_gradient_is_the_slope_of_the_energy_and_the_hessian_the_slope_of_the_gradient() {
    for text in fragments() {
        for (sites, periodic) in [(1, false), (2, false), (8, false), (9, true)] {
            let longer_than_the_chain = text.contains("exchange") && text.contains(", \"");
            let needs_more = ["bonds", "sites", "quads"].iter().any(|key| text.contains(key));
            if sites < 8 && (needs_more || longer_than_the_chain) {
                continue;
            }
            let chain = chain(sites, periodic).resolve().unwrap();
            let h = Hamiltonian::new(&chain, vec![build(&text, &chain)]).unwrap();
            let m = random_spins(sites, 3);
            let v = random_tangent(&m, 4);
            let w = random_tangent(&m, 5);
            let mut g = vec![0.0; 3 * sites];
            let above = h.energy_gradient(&m, &mut g);
            let total = h.energy_mev(&m);
            let scale = h.stiffness_mev().max(g.iter().fold(0.0, |s, x| x.abs().max(s))) + 1e-12;
            assert!(
                (h.reference_mev() + above - total).abs() < 1e-14 * scale * sites as f64,
                "{text}: kernels and densities differ"
            );

            let t = 1e-4;
            let energy = |s: f64| h.energy_mev(&moved(&m, &v, s));
            let slope = (8.0 * (energy(t) - energy(-t)) - (energy(2.0 * t) - energy(-2.0 * t))) / (12.0 * t);
            assert!(
                (slope - dot(&g, &v)).abs() < 1e-9 * scale,
                "{text} on {sites}: slope {slope}, gradient {}",
                dot(&g, &v)
            );

            let mut hv = vec![0.0; 3 * sites];
            let mut hw = vec![0.0; 3 * sites];
            h.hessian_product(&m, &g, &v, &mut hv);
            h.hessian_product(&m, &g, &w, &mut hw);
            assert!((dot(&hv, &w) - dot(&hw, &v)).abs() < 1e-12 * scale, "{text}: the Hessian is not symmetric");
            let t = 1e-3;
            let energy = |s: f64| h.energy_mev(&moved(&m, &v, s));
            let second = (-energy(2.0 * t) - energy(-2.0 * t) + 16.0 * (energy(t) + energy(-t)) - 30.0 * energy(0.0))
                / (12.0 * t * t);
            assert!(
                (second - dot(&hv, &v)).abs() < 1e-6 * scale,
                "{text}: curvature {second}, Hessian {}",
                dot(&hv, &v)
            );
        }
    }
}

#[test]
fn the_banded_hessian_in_tangent_coordinates_is_the_hessian_product() {
    for text in fragments() {
        for (sites, periodic) in [(8, false), (9, true)] {
            let mut chain = chain(sites, periodic);
            chain.frozen = vec![Frozen { sites: Selection::List(vec![3]), direction: Some(Direction::Z) }];
            let chain = chain.resolve().unwrap();
            let h = Hamiltonian::new(&chain, vec![build(&text, &chain)]).unwrap();
            let m = random_spins(sites, 6);
            let mut v = random_tangent(&m, 7);
            h.hold_frozen(&mut v);
            let (g, expected) = gradient_and_product(&h, &m, &v);
            let basis = TangentBasis::at(&m);
            let matrix = assemble(&h, &m, &g, &basis);
            let mut y = vec![0.0; 2 * sites];
            matrix.multiply(&basis.coordinates(&v), &mut y);
            let mut found = vec![0.0; 3 * sites];
            basis.field(&y, &mut found);
            for (a, b) in found.iter().zip(&expected) {
                assert!((a - b).abs() < 1e-13 * h.stiffness_mev().max(1.0), "{text}: {a} {b}");
            }
        }
    }
}

#[test]
fn a_long_chain_in_tiles_has_the_gradient_of_its_sites_one_by_one() {
    let sites = 1500;
    let chain = chain(sites, true).resolve().unwrap();
    // one of the two long-ranged terms at a time
    let terms = || fragments().iter().filter(|f| !f.contains("dipolar")).map(|f| build(f, &chain)).collect::<Vec<_>>();
    let h = Hamiltonian::new(&chain, terms()).unwrap();
    let m = random_spins(sites, 8);
    let mut g = vec![0.0; 3 * sites];
    let above = h.energy_gradient(&m, &mut g);
    let mut direct = vec![0.0; 3 * sites];
    let mut energy = 0.0;
    for i in 0..sites {
        for t in h.terms() {
            let mut one = [0.0; 3];
            let mut density = [0.0];
            t.add_gradient(Components::new(&m), ComponentsMut::new(&mut one), &mut density, i..i + 1);
            energy += density[0];
            ComponentsMut::new(&mut direct).add(i, one);
        }
    }
    assert!((above - energy).abs() < 1e-11 * energy.abs());
    for (a, b) in g.iter().zip(&direct) {
        assert!((a - b).abs() < 1e-12 * h.stiffness_mev());
    }
}

/// Terms on lattices of several atoms a cell.
fn of_lattices() -> Vec<(&'static str, &'static str)> {
    let kagome = r#"{"kagome": {"cells": [5, 4], "periodic": [true, false], "shape": {"disc": {"radius": 2.4}}}}"#;
    let bcc = r#"{"bcc": {"cells": [3, 3, 2], "periodic": [true, true, false], "vacant": [3]}}"#;
    let short = r#"{"square": {"cells": [2, 5], "periodic": true}}"#;
    vec![
        (kagome, r#"{"exchange": {"J": ["3 meV", "-1 meV"]}}"#),
        (short, r#"{"exchange": {"J": ["3 meV"]}}"#),
        (short, r#"{"dmi": {"D": "2 meV", "kind": "bulk"}}"#),
        (kagome, r#"{"dmi": {"D": ["3 meV", "1 meV"], "kind": "interfacial"}}"#),
        (bcc, r#"{"dmi": {"D": "3 meV", "kind": "bulk"}}"#),
        (kagome, r#"{"biquadratic": {"B": ["1 meV", "-0.4 meV"]}}"#),
        (bcc, r#"{"biquadratic": {"B": "-1 meV"}}"#),
        (short, r#"{"biquadratic": {"B": "1 meV"}}"#),
        (
            bcc,
            r#"{"pairs": {"convention": {"counting": "both directions", "energy": "-J/2", "dmi": "-D"}, "bonds": [
                {"from": 0, "to": 1, "J": "4 meV", "D": ["1 meV", "0.5 meV", "0 meV"]},
                {"from": 1, "to": 0, "J": "4 meV", "D": ["-1 meV", "-0.5 meV", "0 meV"]},
                {"from": 1, "to": 1, "cell": [1, -1, 0], "tensor": [["1 meV", "2 meV", "0 meV"], ["0 meV", "3 meV", "1 meV"], ["1 meV", "0 meV", "0 meV"]]},
                {"from": 1, "to": 1, "cell": [-1, 1, 0], "tensor": [["1 meV", "0 meV", "1 meV"], ["2 meV", "3 meV", "0 meV"], ["0 meV", "1 meV", "0 meV"]]}]}}"#,
        ),
        (
            kagome,
            r#"{"four_spin": {"quads": [
                {"K": "1 meV", "atoms": [0, 1, 2, 1], "cells": [[0, 0, 0], [0, 0, 0], [0, 0, 0], [-1, 0, 0]]},
                {"K": "-0.7 meV", "atoms": [0, 0, 0, 0], "cells": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], "ring": true}]}}"#,
        ),
        (
            short,
            r#"{"four_spin": {"quads": [{"K": "1 meV", "cells": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], "ring": true}]}}"#,
        ),
    ]
}

#[test]
fn terms_on_any_lattice_have_the_derivatives_of_their_energy_and_the_blocks_of_their_hessian() {
    for (lattice, text) in of_lattices() {
        let lattice = serde_json::from_str::<LatticeSpec>(lattice).unwrap().resolve().unwrap();
        let n = lattice.sites;
        let h = Hamiltonian::new(&lattice, vec![build(text, &lattice)]).unwrap();
        let m = random_spins(n, 3);
        let (v, w) = (random_tangent(&m, 4), random_tangent(&m, 5));
        let mut g = vec![0.0; 3 * n];
        let above = h.energy_gradient(&m, &mut g);
        let scale = h.stiffness_mev().max(g.iter().fold(0.0, |s, x| x.abs().max(s)));
        assert!((h.reference_mev() + above - h.energy_mev(&m)).abs() < 1e-14 * scale * n as f64, "{text}");
        let energy = |s: f64| h.energy_mev(&moved(&m, &v, s));
        let t = 1e-4;
        let slope = (8.0 * (energy(t) - energy(-t)) - (energy(2.0 * t) - energy(-2.0 * t))) / (12.0 * t);
        assert!((slope - dot(&g, &v)).abs() < 1e-8 * scale, "{text}: {slope} {}", dot(&g, &v));
        let (mut hv, mut hw) = (vec![0.0; 3 * n], vec![0.0; 3 * n]);
        h.hessian_product(&m, &g, &v, &mut hv);
        h.hessian_product(&m, &g, &w, &mut hw);
        assert!((dot(&hv, &w) - dot(&hw, &v)).abs() < 1e-12 * scale, "{text}: the Hessian is not symmetric");
        let t = 1e-3;
        let outer = energy(2.0 * t) + energy(-2.0 * t);
        let second = (16.0 * (energy(t) + energy(-t)) - outer - 30.0 * energy(0.0)) / (12.0 * t * t);
        assert!((second - dot(&hv, &v)).abs() < 1e-5 * scale, "{text}: {second} {}", dot(&hv, &v));
        let basis = TangentBasis::at(&m);
        let mut y = vec![0.0; 2 * n];
        assemble(&h, &m, &g, &basis).multiply(&basis.coordinates(&v), &mut y);
        let mut found = vec![0.0; 3 * n];
        basis.field(&y, &mut found);
        let apart = found.iter().zip(&hv).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-13 * scale.max(1.0), "{text}: {apart}");
    }
}

#[test]
fn conventions_of_pairs_and_shells_state_the_same_energy() {
    let lattice = serde_json::from_str::<LatticeSpec>(r#"{"square": {"cells": [5, 4], "periodic": true}}"#);
    let lattice = lattice.unwrap().resolve().unwrap();
    let m = random_spins(20, 11);
    let energy = |text: &str| Hamiltonian::new(&lattice, vec![build(text, &lattice)]).unwrap().energy_mev(&m);
    let by_shell = energy(r#"{"exchange": {"J": ["6 meV"]}}"#) + energy(r#"{"dmi": {"D": "2 meV", "kind": "bulk"}}"#);
    let pair = |cell: &str, j: f64, d: [f64; 2]| {
        format!(
            r#"{{"from": 0, "to": 0, "cell": {cell}, "J": "{j} meV", "D": ["{} meV", "{} meV", "0 meV"]}}"#,
            d[0], d[1]
        )
    };
    let there = |j: f64, d: f64| format!("{}, {}", pair("[1, 0, 0]", j, [d, 0.0]), pair("[0, 1, 0]", j, [0.0, d]));
    let back = |j: f64, d: f64| format!("{}, {}", pair("[-1, 0, 0]", j, [-d, 0.0]), pair("[0, -1, 0]", j, [0.0, -d]));
    for (counting, form, dmi, bonds) in [
        ("once", "-J", "+D", there(6.0, 2.0)),
        ("once", "-J", "+D", back(6.0, 2.0)),
        ("once", "+2J", "-2D", there(-3.0, -1.0)),
        ("both directions", "-J", "+D", format!("{}, {}", there(3.0, 1.0), back(3.0, 1.0))),
        ("both directions", "-J/2", "-D/2", format!("{}, {}", there(6.0, -2.0), back(6.0, -2.0))),
    ] {
        let text = format!(
            r#"{{"pairs": {{"bonds": [{bonds}], "convention": {{"counting": "{counting}", "energy": "{form}", "dmi": "{dmi}"}}}}}}"#
        );
        let found = energy(&text);
        assert!((found - by_shell).abs() < 1e-12 * by_shell.abs(), "{text}: {found} {by_shell}");
    }
}

#[test]
fn the_d2d_kind_is_the_interfacial_one_with_spins_turned_over_the_diagonal() {
    let lattice = serde_json::from_str::<LatticeSpec>(r#"{"square": {"cells": [5, 6], "periodic": true}}"#);
    let lattice = lattice.unwrap().resolve().unwrap();
    let m = random_spins(30, 12);
    // (x, y, z) ↦ (y, x, −z)
    let [x, y, z] = [&m[..30], &m[30..60], &m[60..]];
    let turned: Vec<f64> = y.iter().chain(x).copied().chain(z.iter().map(|z| -z)).collect();
    let energy = |kind: &str, m: &[f64]| {
        let text = format!(r#"{{"dmi": {{"D": "2 meV", "kind": "{kind}"}}}}"#);
        Hamiltonian::new(&lattice, vec![build(&text, &lattice)]).unwrap().energy_mev(m)
    };
    let (interfacial, d2d) = (energy("interfacial", &m), energy("d2d", &turned));
    assert!((interfacial - d2d).abs() < 1e-12 && interfacial.abs() > 1.0, "{interfacial} {d2d}");
}

/// How much a turn of all spins about an axis changes the energy of a state (meV).
fn change_by_a_turn(h: &Hamiltonian, m: &[f64], axis: [f64; 3]) -> f64 {
    let direction = Direction::new(axis).unwrap();
    let turned: Vec<_> = (0..h.sites()).map(|i| rotate(Components::new(m).get(i), direction, 0.7)).collect();
    h.difference_mev(Spins::from_vectors(&turned).unwrap().as_slice(), m)
}

#[test]
fn an_axis_of_symmetry_leaves_the_energy_as_it_is_and_another_does_not() {
    for text in fragments() {
        let chain = chain(9, true).resolve().unwrap();
        let term = build(&text, &chain);
        let named = term.axes();
        let h = Hamiltonian::new(&chain, vec![term]).unwrap();
        let m = random_spins(9, 9);
        let found = h.symmetry_axes();
        for axis in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.6, 0.0, 0.8]].into_iter().chain(named) {
            let is_axis = found.len() == 3 || found.iter().any(|a| vector::norm(vector::cross(*a, axis)) < 1e-12);
            let change = change_by_a_turn(&h, &m, axis);
            let rounding = 1e-12 * h.stiffness_mev().max(1.0);
            assert_eq!(change.abs() < rounding, is_axis, "{text} about {axis:?}: {change}");
        }
    }
}

#[test]
fn axes_of_symmetry_are_those_of_the_sum_of_all_terms() {
    let axes = |terms: &[&str], sites: usize| {
        let chain = chain(sites, false).resolve().unwrap();
        let terms = terms.iter().map(|text| build(text, &chain)).collect();
        Hamiltonian::new(&chain, terms).unwrap().symmetry_axes().to_vec()
    };
    let exchange = r#"{"exchange": {"J": ["10 meV"]}}"#;
    let oblique = r#"{"anisotropy": {"K": "1 meV", "axis": [1, 2, 2]}}"#;
    assert_eq!(axes(&[exchange], 7).len(), 3);
    let third = [1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0];
    let [found] = axes(&[exchange, oblique], 7)[..] else { panic!("one axis") };
    assert!(vector::norm(vector::cross(found, third)) < 1e-15);
    // three hard axes of one strength, at right angles, are no anisotropy at all; two of them are an easy axis, which none names
    let hard = |axis: &str| format!(r#"{{"anisotropy": {{"K": "-1 meV", "axis": {axis}}}}}"#);
    let [a, b, c] = [hard("[1, 2, 2]"), hard("[2, 1, -2]"), hard("[2, -2, 1]")];
    assert_eq!(axes(&[exchange, &a, &b, &c], 7).len(), 3);
    let [found] = axes(&[exchange, &a, &b], 7)[..] else { panic!("one axis") };
    assert!(vector::norm(vector::cross(found, [2.0 / 3.0, -2.0 / 3.0, 1.0 / 3.0])) < 1e-12);
    assert!(axes(&[exchange, &a, r#"{"anisotropy": {"K": "1 meV", "axis": [0, 0, 1]}}"#], 7).is_empty());
    // an anisotropy of a billionth of the exchange is one
    let weak = r#"{"anisotropy": {"K": "1e-8 meV", "axis": [0, 0, 1]}}"#;
    assert_eq!(axes(&[exchange, weak], 2000), [[0.0, 0.0, 1.0]]);
    assert!(axes(&[exchange, weak, r#"{"anisotropy": {"K": "2e-8 meV", "axis": [0, 1, 0]}}"#], 2000).is_empty());
}

#[test]
fn tangent_bases_are_the_columns_of_coordinates() {
    let m = random_spins(5, 10);
    let basis = TangentBasis::at(&m);
    let v = random_tangent(&m, 11);
    let t = basis.coordinates(&v);
    for i in 0..5 {
        let (e, f) = tangent_basis(Components::new(&m).get(i));
        assert_eq!(
            [t[2 * i], t[2 * i + 1]],
            [vector::dot(e, Components::new(&v).get(i)), vector::dot(f, Components::new(&v).get(i))]
        );
    }
    let mut back = vec![0.0; 15];
    basis.field(&t, &mut back);
    for (a, b) in back.iter().zip(&v) {
        assert!((a - b).abs() < 1e-15);
    }
}

#[test]
fn the_hessian_of_a_long_ranged_chain_is_its_product_dense_or_as_exponentials() {
    for text in [r#"{"dipolar": {}}"#, r#"{"demag": {}}"#] {
        for (sites, periodic) in [(40, false), (41, true), (129, false), (400, false)] {
            let mut chain = chain(sites, periodic);
            chain.direction = Some(Direction::new([1.0, -0.4, 0.2]).unwrap());
            chain.frozen = vec![Frozen { sites: Selection::List(vec![3, 17]), direction: Some(Direction::Z) }];
            let chain = chain.resolve().unwrap();
            let terms = [r#"{"exchange": {"J": ["0.1 meV", "-0.02 meV"]}}"#, text].map(|t| build(t, &chain));
            let h = Hamiltonian::new(&chain, terms.into()).unwrap();
            let m = random_spins(sites, 12);
            let mut v = random_tangent(&m, 13);
            h.hold_frozen(&mut v);
            let (g, expected) = gradient_and_product(&h, &m, &v);
            let basis = TangentBasis::at(&m);
            let mut found = vec![0.0; 3 * sites];
            let mut y = vec![0.0; 2 * sites];
            let matrix = assemble(&h, &m, &g, &basis);
            matrix.multiply(&basis.coordinates(&v), &mut y);
            basis.field(&y, &mut found);
            let norm = matrix.norm1();
            for (a, b) in found.iter().zip(&expected) {
                assert!((a - b).abs() < 2e-14 * norm, "{text} on {sites}: {a} {b}");
            }
            let (right, factors) = (y.clone(), matrix.clone().factor());
            factors.solve(&mut y, 1);
            let mut back = vec![0.0; 2 * sites];
            matrix.multiply(&y, &mut back);
            for (a, b) in back.iter().zip(&right) {
                assert!((a - b).abs() < 1e-8 * norm, "{text} on {sites}: {a} {b}");
            }
        }
    }
}

/// A⁻¹b, the number of negative pivots and ln|det A| by a sparse LDLᵀ that is not ours.
fn by_qdldl(matrix: &Matrix, b: &[f64]) -> (Vec<f64>, usize, f64) {
    let n = b.len();
    let (mut starts, mut rows, mut entries) = (vec![0usize], Vec::new(), Vec::new());
    for j in 0..n {
        for i in (0..=j).filter(|&i| i == j || matrix.get(j, i) != 0.0) {
            rows.push(i);
            entries.push(matrix.get(j, i));
        }
        starts.push(rows.len());
    }
    let factors = qdldl::Plan::of(starts, rows).factor(&entries);
    let mut x = b.to_vec();
    factors.solve(&mut x);
    (x, factors.negatives, factors.pivots.iter().map(|d: &f64| d.abs().ln()).sum())
}

#[test]
fn factors_of_hessians_agree_with_those_of_an_independent_sparse_solver() {
    let shells = [r#"["10 meV"]"#, r#"["10 meV", "-3 meV"]"#, r#"["10 meV", "-3 meV", "1 meV"]"#];
    let mut signs = std::collections::BTreeSet::new();
    for (round, (j, periodic)) in shells.iter().flat_map(|j| [(j, false), (j, true)]).enumerate() {
        for sites in [9, 50, 301] {
            let chain = chain(sites, periodic).resolve().unwrap();
            let exchange = format!(r#"{{"exchange": {{"J": {j}}}}}"#);
            let anisotropy = r#"{"anisotropy": {"K": "0.5 meV", "axis": [0.2, 0.1, 1]}}"#;
            let terms = [exchange.as_str(), anisotropy].map(|t| build(t, &chain));
            let h = Hamiltonian::new(&chain, terms.into()).unwrap();
            let m = random_spins(sites, round as u64);
            let (g, b) = gradient_and_product(&h, &m, &random_tangent(&m, 40));
            let basis = TangentBasis::at(&m);
            for shift in [0.0, 3.0, 30.0] {
                let mut matrix = assemble(&h, &m, &g, &basis);
                matrix.shift(shift);
                let b = basis.coordinates(&b);
                let (expected, negatives, log) = by_qdldl(&matrix, &b);
                let factors = matrix.clone().factor();
                let mut x = b.clone();
                factors.solve(&mut x, 1);
                let size = expected.iter().fold(0.0f64, |s, x| s.max(x.abs()));
                for (p, q) in x.iter().zip(&expected) {
                    assert!((p - q).abs() < 1e-9 * size, "{j} {sites} {shift}: {p} {q}");
                }
                assert_eq!(factors.negatives(), negatives, "{j} {sites} {shift}");
                assert!((factors.log_abs_determinant() - log).abs() < 1e-10 * log.abs(), "{j} {sites} {shift}");
                signs.insert(negatives.min(1));
            }
        }
    }
    assert_eq!(signs.len(), 2, "definite and indefinite ones");
}

#[test]
fn terms_as_a_config_names_them_have_the_signs_of_their_definitions() {
    let chain = chain(2, false).resolve().unwrap();
    let energy = |text: &str, a: [f64; 3], b: [f64; 3]| {
        let h = Hamiltonian::new(&chain, vec![build(text, &chain)]).unwrap();
        h.energy_mev(Spins::from_vectors(&[a, b]).unwrap().as_slice())
    };
    let (x, y, z) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    // μ·B of 2 μ_B in 1 T
    let moment = 2.0 * 5.7883817982e-2;
    for (text, a, b, expected) in [
        (r#"{"exchange": {"J": ["3 meV"]}}"#, x, x, -3.0),
        (r#"{"exchange": {"J": ["3 meV"]}}"#, x, y, 0.0),
        (r#"{"anisotropy": {"K": "0.5 meV", "axis": [1, 0, 0]}}"#, x, y, -0.5),
        (r#"{"anisotropy": {"K": "0 meV", "K2": "0.25 meV", "axis": [0, 0, 1]}}"#, z, z, -0.5),
        (r#"{"cubic_anisotropy": {"K": "3 meV"}}"#, [3f64.sqrt().recip(); 3], z, 1.0),
        (r#"{"dmi": {"D": "0.3 meV", "direction": [0, 0, 1]}}"#, x, y, 0.3),
        (r#"{"dmi": {"D": "0.3 meV", "direction": [0, 0, 1]}}"#, y, x, -0.3),
        (r#"{"zeeman": {"B": ["1 T", "0 T", "0 T"]}}"#, x, y, -moment),
        (r#"{"zeeman": {"B": ["0 T", "-1 T", "0 T"]}}"#, x, y, moment),
    ] {
        let found = energy(text, a, b);
        assert!((found - expected).abs() < 1e-9, "{text}: {found}, not {expected}");
    }
}
