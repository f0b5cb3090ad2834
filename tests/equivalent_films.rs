//! Equivalent forms of one problem on a film have one barrier: turned and mirrored lattices, turned and mirrored spins, time reversal,
//! exchanged ends, sites numbered in another order.

use serde_json::{Value, json};
use spinneb::config::load_text;
use spinneb::drive::{Silent, run};
use spinneb::geometry::{Direction, Vector, rotate, vector};

/// μ_B (meV/T).
const MU_B: f64 = 5.7883817982e-2;

/// A problem of a film of moments of 1 μ_B, energies in meV.
#[derive(Clone)]
struct Film {
    cells: [usize; 2],
    periodic: bool,
    /// Which cell a bond leads to, and its D; J is 1.
    bonds: Vec<([i64; 2], Vector)>,
    /// Easy axis: K of each site.
    easy: (Vec<f64>, Vector),
    /// Hard axis.
    hard: (f64, Vector),
    field: Vector,
    ends: [Vec<Vector>; 2],
}

impl Film {
    fn new(cells: [usize; 2], k: f64) -> Film {
        let (n, up) = (cells[0] * cells[1], [0.0, 0.0, 1.0]);
        Film {
            cells,
            periodic: false,
            bonds: vec![([1, 0], [0.0; 3]), ([0, 1], [0.0; 3])],
            easy: (vec![k; n], up),
            hard: (0.0, [1.0, 0.0, 0.0]),
            field: [0.0; 3],
            ends: [vec![up; n], vec![[0.0, 0.0, -1.0]; n]],
        }
    }

    /// Interfacial: D (ẑ × r̂).
    fn with_dmi(mut self, d: f64) -> Film {
        self.bonds = vec![([1, 0], [0.0, d, 0.0]), ([0, 1], [-d, 0.0, 0.0])];
        self
    }

    /// A wall across x from one column to another, K weak in both.
    fn pinned() -> Film {
        let mut film = Film::new([10, 2], 0.4);
        film.hard.0 = 0.15;
        let columns = [2usize, 7];
        for site in 0..20 {
            let column = site % 10;
            film.easy.0[site] *= if columns.contains(&column) { 0.4 } else { 1.0 };
            for (end, center) in film.ends.iter_mut().zip(columns) {
                let theta = 2.0 * libm::atan(libm::exp((column as f64 - center as f64) / 1.1));
                end[site] = [0.0, libm::sin(theta), libm::cos(theta)];
            }
        }
        film
    }

    /// A skyrmion in a periodic film.
    fn collapse() -> Film {
        let mut film = Film::new([7, 7], 0.08).with_dmi(1.0);
        (film.periodic, film.field) = (true, [0.0, 0.0, 0.42]);
        for site in 0..49 {
            let (x, y) = ((site % 7) as f64 - 3.0, (site / 7) as f64 - 3.0);
            let (r, phi) = (x.hypot(y), libm::atan2(y, x) + std::f64::consts::PI);
            let theta = std::f64::consts::PI * (1.0 - r / 3.6).max(0.0);
            let sin = libm::sin(theta);
            film.ends[0][site] = [sin * libm::cos(phi), sin * libm::sin(phi), libm::cos(theta)];
        }
        film.ends[1] = vec![[0.0, 0.0, 1.0]; 49];
        film
    }

    /// Every spin m becomes s(m); `sign` is −1 where s is improper: a vector product then keeps another sign.
    fn spins(&self, s: impl Fn(Vector) -> Vector, sign: f64) -> Film {
        let mut film = self.clone();
        film.bonds.iter_mut().for_each(|(_, d)| *d = vector::scale(sign, s(*d)));
        (film.easy.1, film.hard.1, film.field) = (s(self.easy.1), s(self.hard.1), s(self.field));
        film.ends.iter_mut().flatten().for_each(|m| *m = s(*m));
        film
    }

    /// x and y exchanged, sites and bonds alike; the spins stay.
    fn transposed(&self) -> Film {
        let [nx, ny] = self.cells;
        let moved = |i: usize| i % ny * nx + i / ny;
        let mut film = Film { cells: [ny, nx], ..self.clone() };
        film.bonds.iter_mut().for_each(|(to, _)| to.reverse());
        film.easy.0 = (0..nx * ny).map(|i| self.easy.0[moved(i)]).collect();
        film.ends = self.ends.each_ref().map(|end| (0..nx * ny).map(|i| end[moved(i)]).collect());
        film
    }

    fn exchanged(&self) -> Film {
        let [a, b] = self.ends.clone();
        Film { ends: [b, a], ..self.clone() }
    }

    /// As a config; `doubled`: of cells twice as long along x, with two atoms, those of odd columns last.
    fn config(&self, doubled: bool) -> Value {
        let mev = |x: f64| format!("{x:?} meV");
        let [nx, ny] = self.cells;
        let bond = |from: i64, to: [i64; 2], d: &Vector| {
            let atoms = if doubled { 2 } else { 1 };
            let (to, cell) = ((from + to[0]).rem_euclid(atoms), [(from + to[0]).div_euclid(atoms), to[1], 0]);
            json!({"from": from, "to": to, "cell": cell, "J": "1 meV", "D": d.map(mev)})
        };
        let firsts = if doubled { 0..2 } else { 0..1 };
        let bonds: Vec<Value> =
            firsts.flat_map(|from| self.bonds.iter().map(move |(to, d)| bond(from, *to, d))).collect();
        let lattice = if doubled {
            json!({"crystal": {"vectors": [[2, 0, 0], [0, 1, 0], [0, 0, 1]], "basis": [{"at": [0, 0, 0]}, {"at": [0.5, 0, 0]}],
                   "cells": [nx / 2, ny, 1], "periodic": [self.periodic, self.periodic, false]}})
        } else {
            json!({"square": {"cells": self.cells, "periodic": self.periodic}})
        };
        let order: Vec<usize> = match doubled {
            true => (0..2).flat_map(|odd| (0..nx * ny).filter(move |i| i % nx % 2 == odd)).collect(),
            false => (0..nx * ny).collect(),
        };
        let state = |m: &[Vector]| json!({"vectors": order.iter().map(|i| m[*i]).collect::<Vec<_>>()});
        let k: Vec<String> = order.iter().map(|i| mev(self.easy.0[*i])).collect();
        json!({
            "material": {"name": "test", "moment": "1 mu_B", "energy": [
                {"pairs": {"bonds": bonds}},
                {"anisotropy": {"K": k, "axis": self.easy.1}},
                {"anisotropy": {"K": mev(-self.hard.0), "axis": self.hard.1}},
                {"zeeman": {"B": self.field.map(|b| format!("{:?} T", b / MU_B))}}
            ]},
            "lattice": lattice, "initial": state(&self.ends[0]), "final": state(&self.ends[1])
        })
    }
}

/// Forward and backward barrier (meV).
fn barriers(config: &Value) -> [f64; 2] {
    let problem = load_text(std::path::Path::new("film.json"), config.to_string()).unwrap().problem().unwrap();
    let found = run(&problem, &mut Silent).unwrap();
    assert!(found.certified, "{:?}", found.warnings);
    let barrier = found.barrier.unwrap();
    [barrier.forward_mev, barrier.backward_mev]
}

#[test]
fn equivalent_forms_of_a_film_have_one_barrier() {
    let axis = Direction::new([0.3, -0.5, 0.8]).unwrap();
    let mut tilted = Film::new([4, 3], 0.5);
    (tilted.hard.0, tilted.field) = (0.1, [0.15, -0.1, 0.2]);
    let mut nucleus = Film::new([6, 4], 0.3);
    nucleus.field = [0.0, 0.0, -0.25];
    let films = [
        ("reversal", Film::new([6, 3], 0.3)),
        ("field", nucleus),
        ("dmi", Film::new([6, 4], 0.3).with_dmi(0.2)),
        ("tilted", tilted),
        ("pinned", Film::pinned()),
        ("collapse", Film::collapse()),
    ];
    for (name, film) in films {
        let [forward, backward] = barriers(&film.config(false));
        let turned = |m: Vector| rotate(m, axis, 1.1);
        let mut forms = vec![
            ("turned lattice", film.transposed().config(false)),
            ("turned spins", film.spins(turned, 1.0).config(false)),
            ("mirrored spins", film.spins(|[x, y, z]| turned([x, -y, z]), -1.0).config(false)),
            ("time reversal", film.spins(|m| vector::scale(-1.0, m), -1.0).config(false)),
        ];
        if film.cells[0].is_multiple_of(2) {
            forms.push(("renumbered", film.config(true)));
        }
        let exchanged = barriers(&film.exchanged().config(false));
        for (form, found) in forms
            .into_iter()
            .map(|(form, config)| (form, barriers(&config)))
            .chain([("exchanged ends", [exchanged[1], exchanged[0]])])
        {
            let same = |a: f64, b: f64| (a - b).abs() < 1e-8 * b.abs();
            assert!(
                same(found[0], forward) && same(found[1], backward),
                "{name}, {form}: {found:?} {forward} {backward}"
            );
        }
    }
}

#[test]
fn a_layer_that_is_its_own_neighbour_across_is_no_stiffer_and_no_softer_for_it() {
    let width = |periodic: Value| {
        let config = json!({
            "material": {"name": "film", "Ms": "580 kA/m", "energy": [
                {"exchange": {"A": "15 pJ/m"}}, {"anisotropy": {"K": "0.589 MJ/m^3", "axis": [0, 0, 1]}}
            ]},
            "lattice": {"grid": {"cells": [12, 9, 1], "cell": ["1 nm", "1 nm", "0.4 nm"], "periodic": periodic}},
            "initial": {"uniform": {"direction": [0, 0, 1]}}, "final": {"uniform": {"direction": [0, 0, -1]}}
        });
        let problem = load_text(std::path::Path::new("film.json"), config.to_string()).unwrap().problem().unwrap();
        spinneb::drive::Scales::of_terms(&problem.hamiltonian).wall_width_sites
    };
    // √(A/K) in cells of 1 nm
    let expected = (15.0f64 / 0.589).sqrt();
    for periodic in [json!([true, true, false]), json!(true), json!(false), json!([false, true, true])] {
        let found = width(periodic.clone());
        assert!((found / expected - 1.0).abs() < 1e-9, "{periodic}: {found} {expected}");
    }
}
