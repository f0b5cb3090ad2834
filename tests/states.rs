//! States on films and crystals: closed forms, symmetry, and what is refused.

use spinneb::energy::{Anisotropy, Dmi, EnergyTerm, Exchange, Hamiltonian, Zeeman};
use spinneb::field::Components;
use spinneb::geometry::{Direction, Quaternion, Vector, angle, vector};
use spinneb::lattice::{Grid, Lattice, LatticeSpec};
use spinneb::spins::Spins;
use spinneb::state::{StateContext, StateSpec};
use std::f64::consts::{FRAC_PI_2, PI};

/// A box of cells with steps of length 1, the second one at so many degrees to the first.
fn lattice(size: [usize; 3], periodic: bool, degrees: f64) -> Lattice {
    let grid = Grid { size, periodic: [periodic, periodic, false] };
    let (sin, cos) = degrees.to_radians().sin_cos();
    let second = Direction::new([if degrees == 90.0 { 0.0 } else { cos }, sin, 0.0]).unwrap();
    Lattice::bare(grid, [(1.0, Direction::X), (1.0, second), (1.0, Direction::Z)])
}

fn square(n: usize) -> Lattice {
    lattice([n, n, 1], false, 90.0)
}

fn try_state(text: &str, lattice: &Lattice, h: Option<&Hamiltonian>) -> Result<Spins, String> {
    let spec: StateSpec = serde_json::from_str(text).map_err(|e| e.to_string())?;
    let context = StateContext { hamiltonian: h, ..StateContext::new(lattice, 2.0) };
    spec.build(&context).map_err(|e| e.to_string())
}

fn state(text: &str, lattice: &Lattice) -> Spins {
    try_state(text, lattice, None).expect(text)
}

/// Topological charge by solid angles of triangles: B. Berg, M. Lüscher, Nucl. Phys. B 190, 412 (1981),
/// doi:10.1016/0550-3213(81)90568-X.
fn charge(m: &Spins, lattice: &Lattice) -> f64 {
    let solid = |[i, j, k]: [usize; 3]| {
        let [a, b, c] = [m.get(i), m.get(j), m.get(k)];
        let below = 1.0 + vector::dot(a, b) + vector::dot(b, c) + vector::dot(c, a);
        2.0 * f64::atan2(vector::dot(a, vector::cross(b, c)), below)
    };
    let triangles = (0..lattice.sites).filter_map(|i| {
        let at = |x, y| lattice.shifted(i, [x, y, 0]);
        Some((at(1, 0)?, at(1, 1)?, at(0, 1)?))
            .map(|(right, across, up)| solid([i, right, across]) + solid([i, across, up]))
    });
    triangles.sum::<f64>() / (4.0 * PI)
}

/// J = 1 meV, an interfacial Dzyaloshinskii–Moriya interaction D (ẑ × r̂)·(m_i × m_j) or one along the bonds, K and B along z.
fn chiral(lattice: &Lattice, d: f64, along_bonds: bool, k: f64, b: f64) -> Hamiltonian {
    let mut dmi = Dmi::uniform(lattice, d, Direction::X);
    for (direction, couplings) in dmi.directions.iter_mut().zip(&dmi.families) {
        let along = vector::unit(couplings.family.along).unwrap();
        *direction = if along_bonds { along } else { vector::cross([0.0, 0.0, 1.0], along) };
    }
    let n = lattice.sites;
    let easy = Anisotropy::uniform(n, k, Direction::Z);
    let terms: Vec<Box<dyn EnergyTerm>> = vec![
        Box::new(Exchange::uniform(lattice, &[1.0])),
        Box::new(dmi),
        Box::new(easy),
        Box::new(Zeeman::uniform(n, [0.0, 0.0, b])),
    ];
    Hamiltonian::new(lattice, terms).unwrap()
}

#[test]
fn a_skyrmion_has_the_charge_of_its_vorticity_and_core_on_any_film() {
    for degrees in [90.0, 60.0] {
        for periodic in [false, true] {
            let film = lattice([24, 24, 1], periodic, degrees);
            for (core, sign) in [(-1.0, -1.0), (1.0, 1.0)] {
                for vorticity in [-2, -1, 1, 2] {
                    for helicity in ["\"0 deg\"", "\"90 deg\"", "\"auto\"", "\"-130 deg\""] {
                        let text = format!(
                            r#"{{"skyrmion": {{"radius": 4.5, "width": 1.2, "core": [0, 0, {core}], "vorticity": {vorticity}, "helicity": {helicity}}}}}"#
                        );
                        let found = charge(&state(&text, &film), &film);
                        let expected = sign * f64::from(vorticity);
                        // the tail is cut off at the border of an open film
                        assert!((found - expected).abs() < 2e-2, "{text} at {degrees} degrees: {found}");
                    }
                }
            }
        }
    }
    // tilted with its core
    let film = square(24);
    let tilted = state(r#"{"skyrmion": {"radius": 4.5, "width": 1.2, "core": [0.3, 0.4, -0.6]}}"#, &film);
    assert!((charge(&tilted, &film) + 1.0).abs() < 2e-2);
}

#[test]
fn the_charge_on_any_lattice_is_that_of_the_texture_and_a_turn_of_all_spins_leaves_it() {
    for lattice in [
        r#"{"square": {"cells": [26, 24]}}"#,
        r#"{"triangular": {"cells": [26, 26], "periodic": true}}"#,
        r#"{"honeycomb": {"cells": [20, 20]}}"#,
        r#"{"kagome": {"cells": [16, 16], "periodic": true}}"#,
        r#"{"triangular": {"cells": [40, 40], "shape": {"disc": {"radius": 14}}}}"#,
        r#"{"cubic": {"cells": [22, 22, 3]}}"#,
        r#"{"fcc": {"cells": [16, 16, 2], "periodic": [true, true, false]}}"#,
        r#"{"hcp": {"cells": [22, 22, 2], "periodic": [true, true, false]}}"#,
    ] {
        let film = serde_json::from_str::<LatticeSpec>(lattice).unwrap().resolve().unwrap();
        let triangles = film.triangles();
        let charge =
            |vectors: &[Vector]| triangles.charge(Components::new(Spins::from_vectors(vectors).unwrap().as_slice()));
        assert_eq!(charge(&vec![[0.6, 0.0, -0.8]; film.sites]), 0.0);
        for (core, vorticity) in [(-1.0, 1), (-1.0, -1), (1.0, 1), (-1.0, 2)] {
            let text = format!(
                r#"{{"skyrmion": {{"radius": 4, "width": 1, "core": [0, 0, {core}], "vorticity": {vorticity}, "helicity": "40 deg"}}}}"#
            );
            let m = state(&text, &film).vectors();
            let found = charge(&m);
            assert!((found - core * f64::from(vorticity)).abs() < 1e-2, "{text} on {lattice}: {found}");
            let turn = Quaternion::from_axis_angle(Direction::new([1.0, 2.0, -0.5]).unwrap(), 1.3);
            let turned: Vec<Vector> = m.iter().map(|m| turn.rotate(*m)).collect();
            let reversed: Vec<Vector> = m.iter().map(|m| vector::scale(-1.0, *m)).collect();
            assert!((charge(&turned) - found).abs() < 1e-12, "{text} on {lattice}");
            assert!((charge(&reversed) + found).abs() < 1e-12, "{text} on {lattice}");
        }
    }
    // by the sum over squares of one diagonal
    let film = square(24);
    let m = state(SMALL, &film);
    assert!((film.triangles().charge(Components::new(m.as_slice())) - charge(&m, &film)).abs() < 1e-12);
}

const SMALL: &str = r#"{"skyrmion": {"radius": 2.1, "width": 0.8, "helicity": "0 deg"}}"#;

#[test]
fn a_skyrmion_has_its_radius_its_core_and_its_helicity_and_is_a_tube_in_three_dimensions() {
    let film = lattice([21, 21, 3], false, 90.0);
    for (helicity, [x, y]) in [("0 deg", [1.0, 0.0]), ("90 deg", [0.0, 1.0]), ("180 deg", [-1.0, 0.0])] {
        let text =
            format!(r#"{{"skyrmion": {{"center": [10, 10], "radius": 5, "width": 2, "helicity": "{helicity}"}}}}"#);
        let m = state(&text, &film);
        for z in 0..3 {
            let at = |x: usize, y: usize| m.get(x + 21 * (y + 21 * z));
            assert!(angle(at(10, 10), [0.0, 0.0, -1.0]) < 1e-12 && angle(at(0, 0), [0.0, 0.0, 1.0]) < 0.1);
            // to the right of the core, above it, and to its left
            assert!(angle(at(15, 10), [x, y, 0.0]) < 1e-12, "{helicity}: {:?}", at(15, 10));
            assert!(angle(at(10, 15), [-y, x, 0.0]) < 1e-12 && angle(at(5, 10), [-x, -y, 0.0]) < 1e-12);
            // sinh(3/2)/sinh(5/2) = tan(θ/2)
            let theta = 2.0 * (1.5f64.sinh() / 2.5f64.sinh()).atan();
            assert!((angle(at(13, 10), [0.0, 0.0, -1.0]) - theta).abs() < 1e-12);
        }
    }
    // over a periodic border it is whole
    let ring = lattice([20, 20, 1], true, 60.0);
    let [middle, corner] = ["[14.5, 8.66]", "[0, 0]"].map(|center| {
        state(
            &format!(r#"{{"skyrmion": {{"center": {center}, "radius": 4, "width": 1, "helicity": "0 deg"}}}}"#),
            &ring,
        )
    });
    let sum = |m: &Spins| m.vectors().iter().map(|m| m[2]).sum::<f64>();
    assert!((sum(&middle) - sum(&corner)).abs() < 0.3, "{} {}", sum(&middle), sum(&corner));
    assert!((charge(&corner, &ring) + 1.0).abs() < 1e-3);
}

#[test]
fn the_automatic_helicity_is_the_cheapest_and_the_automatic_size_that_of_the_relaxed_skyrmion() {
    let film = lattice([24, 24, 1], true, 90.0);
    for (d, along_bonds, expected) in
        [(0.6, false, [1.0, 0.0]), (-0.6, false, [-1.0, 0.0]), (0.6, true, [0.0, -1.0]), (-0.6, true, [0.0, 1.0])]
    {
        let h = chiral(&film, d, along_bonds, 0.1, 0.2);
        let text = |size: &str| format!(r#"{{"skyrmion": {{"center": [12, 12]{size}}}}}"#);
        let given = try_state(&text(r#", "radius": 3"#), &film, Some(&h)).unwrap();
        let of_own = try_state(&text(""), &film, Some(&h)).unwrap();
        for m in [&given, &of_own] {
            let right = m.get(12 + 3 + 24 * 12);
            let [x, y] = expected;
            assert!(right[0] * x + right[1] * y > 0.5, "{d} {along_bonds}: {right:?}");
        }
        // no other size of the same shape has less energy
        let e = h.energy_mev(of_own.as_slice());
        assert!(e <= h.energy_mev(given.as_slice()), "{e}");
        let crossing = (0..12).map(|k| of_own.get(12 + k + 24 * 12)[2]).position(|z| z > 0.0).unwrap();
        assert!((2..6).contains(&crossing), "{crossing}");
    }
    // without an interaction that holds it none has a size of its own
    let plain = chiral(&film, 0.0, false, 0.1, 0.0);
    let said = try_state(r#"{"skyrmion": {}}"#, &film, Some(&plain)).unwrap_err();
    assert!(said.starts_with("radius: no size of this skyrmion is stable here"), "{said}");
}

#[test]
fn a_wall_stands_where_and_as_wide_as_it_is_given_across_any_normal_of_any_lattice() {
    for (size, degrees) in [([20, 16, 1], 90.0), ([20, 16, 1], 60.0), ([9, 8, 7], 90.0)] {
        let crystal = lattice(size, false, degrees);
        for normal in [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [1.0, 1.0, 0.0], [0.3, 0.7, 0.0]] {
            let n = Direction::new(normal).unwrap().vector();
            let center = vector::dot(crystal.middle(), n);
            let text = format!(
                r#"{{"domain_wall": {{"center": {center}, "width": 1.7, "normal": {normal:?}, "through": [0, 1, 0]}}}}"#
            );
            let m = state(&text, &crystal);
            for i in 0..crystal.sites {
                let x = (vector::dot(crystal.place(i), n) - center) / 1.7;
                let expected = [0.0, 1.0 / x.cosh(), -x.tanh()];
                assert!(angle(m.get(i), expected) < 1e-12, "{text}: site {i}");
            }
        }
    }
    let said = try_state(r#"{"domain_wall": {"center": 40, "normal": [0, 1, 0]}}"#, &square(12), None).unwrap_err();
    assert!(
        said.contains("wholly outside the lattice, which reaches from 0.0000 to 11.0000 along the normal"),
        "{said}"
    );
}

#[test]
fn a_wall_takes_the_cheapest_sense_whichever_way_it_faces() {
    let film = square(16);
    for normal in [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]] {
        let n = Direction::new(normal).unwrap().vector();
        let center = vector::dot(film.middle(), n);
        let text = format!(r#"{{"domain_wall": {{"center": {center}, "width": 2, "normal": {normal:?}}}}}"#);
        for (along_bonds, d) in [(false, 0.3), (false, -0.3), (true, 0.3), (true, -0.3)] {
            let h = chiral(&film, d, along_bonds, 0.1, 0.0);
            let m = try_state(&text, &film, Some(&h)).unwrap();
            let middle = (0..film.sites).min_by(|i, j| m.get(*i)[2].abs().total_cmp(&m.get(*j)[2].abs())).unwrap();
            // left is +z: a Néel wall against the normal for D > 0, a Bloch wall across it
            let bloch = [-n[1], n[0], 0.0];
            let expected = if along_bonds { vector::scale(d.signum(), bloch) } else { vector::scale(-d.signum(), n) };
            let [x, y, _] = m.get(middle);
            assert!(angle([x, y, 0.0], expected) < 1e-9, "{text} {along_bonds} {d}: {:?} {expected:?}", m.get(middle));
        }
    }
}

#[test]
fn a_vortex_winds_once_around_and_leaves_the_plane_in_its_core_alone() {
    for degrees in [90.0, 60.0] {
        let film = lattice([16, 16, 1], false, degrees);
        for vorticity in [1, -1] {
            for helicity in ["auto", "-90 deg", "0 deg"] {
                let text =
                    format!(r#"{{"vortex": {{"radius": 3, "vorticity": {vorticity}, "helicity": "{helicity}"}}}}"#);
                let m = state(&text, &film);
                // around the border of the film
                let last = 15;
                let around = (0..last)
                    .chain((0..last).map(|k| last + 16 * k))
                    .chain((0..last).map(|k| 16 * last + last - k))
                    .chain((0..last).map(|k| 16 * (last - k)));
                let angles: Vec<f64> = around.map(|i| m.get(i)).map(|m| f64::atan2(m[1], m[0])).collect();
                let turn = |k: usize| {
                    let by = angles[(k + 1) % angles.len()] - angles[k];
                    by - 2.0 * PI * (by / (2.0 * PI)).round()
                };
                let winding = (0..angles.len()).map(turn).sum::<f64>() / (2.0 * PI);
                assert!((winding - f64::from(vorticity)).abs() < 1e-9, "{text}: {winding}");
                for i in 0..film.sites {
                    let r = vector::norm(vector::sub(film.place(i), film.middle()));
                    let theta = if r < 3.0 { 2.0 * (r / 3.0).atan() } else { FRAC_PI_2 };
                    assert!((m.get(i)[2] - theta.cos()).abs() < 1e-12, "{text}: site {i}");
                }
            }
        }
    }
    // "auto" without an energy turns anticlockwise
    let m = state(r#"{"vortex": {"center": [8, 8], "radius": 1}}"#, &square(17));
    assert!(angle(m.get(12 + 17 * 8), [0.0, 1.0, 0.0]) < 1e-12);
    // the polarity times half the vorticity is the charge
    let half = charge(&m, &square(17));
    assert!((half - 0.5).abs() < 0.02, "{half}");
}

#[test]
fn a_quarter_turn_of_the_lattice_turns_every_state_with_it() {
    let film = square(15);
    let turned = |v: Vector| [-v[1], v[0], v[2]];
    // site (x, y) goes to (14 − y, x)
    let image = |i: usize| (14 - i / 15) + 15 * (i % 15);
    for (text, rotated) in [
        (
            r#"{"skyrmion": {"center": [6, 5], "radius": 3, "width": 1, "helicity": "20 deg"}}"#,
            r#"{"skyrmion": {"center": [9, 6], "radius": 3, "width": 1, "helicity": "20 deg"}}"#,
        ),
        (
            r#"{"skyrmion": {"center": [6, 5], "radius": 3, "width": 1, "helicity": "20 deg", "vorticity": -1}}"#,
            r#"{"skyrmion": {"center": [9, 6], "radius": 3, "width": 1, "helicity": "200 deg", "vorticity": -1}}"#,
        ),
        (r#"{"vortex": {"center": [6, 5], "radius": 2}}"#, r#"{"vortex": {"center": [9, 6], "radius": 2}}"#),
        (
            r#"{"domain_wall": {"center": 5, "width": 2, "through": [1, 0, 0]}}"#,
            r#"{"domain_wall": {"center": 5, "width": 2, "normal": [0, 1, 0], "through": [0, 1, 0]}}"#,
        ),
        (
            r#"{"soliton": {"center": 5, "width": 2, "through": [1, 0, 0]}}"#,
            r#"{"soliton": {"center": 5, "width": 2, "normal": [0, 1, 0], "through": [0, 1, 0]}}"#,
        ),
        (
            r#"{"spiral": {"axis": [0, 0, 1], "period": 7, "along": [1, 0, 0]}}"#,
            r#"{"spiral": {"axis": [0, 0, 1], "period": 7, "along": [0, 1, 0], "phase": "90 deg"}}"#,
        ),
    ] {
        let (a, b) = (state(text, &film), state(rotated, &film));
        for i in 0..film.sites {
            assert!(angle(b.get(image(i)), turned(a.get(i))) < 1e-12, "{text}: site {i}");
        }
    }
}

#[test]
fn regions_have_states_of_their_own_and_every_site_one() {
    let mut film = square(10);
    film.regions.insert("left".into(), (0..100).filter(|i| i % 10 < 3).collect());
    film.regions.insert("top".into(), (80..100).collect());
    let m = state(
        r#"{"regions": {"default": {"uniform": {"direction": [0, 0, 1]}}, "left": {"uniform": {"direction": [1, 0, 0], "staggered": true}}}}"#,
        &film,
    );
    assert_eq!(
        (m.get(3), m.get(2), m.get(11), m.get(1)),
        ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0])
    );
    let said = |text: &str| try_state(text, &film, None).unwrap_err();
    let up = r#"{"uniform": {"direction": [0, 0, 1]}}"#;
    assert!(said(&format!(r#"{{"regions": {{"left": {up}}}}}"#)).contains("add \"default\""));
    assert!(said(&format!(r#"{{"regions": {{"default": {up}, "lef": {up}}}}}"#)).starts_with("lef: no region \"lef\""));
    let both = said(&format!(r#"{{"regions": {{"default": {up}, "left": {up}, "top": {up}}}}}"#));
    assert!(both.starts_with("top: site 80 is in the region \"top\" and in another one here"), "{both}");
    let inner = said(&format!(r#"{{"regions": {{"default": {up}, "left": {{"domain_wall": {{"center": 90}}}}}}}}"#));
    assert!(inner.starts_with("left.domain_wall.center: found 90"), "{inner}");
}

#[test]
fn states_that_leave_no_trace_are_refused() {
    let film = square(12);
    for text in [
        r#"{"skyrmion": {"center": [40, 5], "radius": 3, "width": 1}}"#,
        r#"{"skyrmion": {"center": [5.5, 5.5], "radius": 0.2, "width": 0}}"#,
        r#"{"vortex": {"center": [5, -20], "radius": 3}}"#,
        r#"{"soliton": {"center": -30, "width": 2}}"#,
    ] {
        let said = try_state(text, &film, None).unwrap_err();
        assert!(said.starts_with("center: ") && said.contains("wholly outside"), "{text}: {said}");
    }
    for (text, words) in [
        (r#"{"skyrmion": {"radius": -3}}"#, "radius: found -3, but a radius is greater than 0"),
        (
            r#"{"skyrmion": {"radius": 9, "width": 1}}"#,
            "radius: a skyrmion of 9.0 spacings is larger than the lattice, whose furthest site is 7.8",
        ),
        (r#"{"skyrmion": {"radius": "3 nm"}}"#, "radius: a length with a unit needs the lattice's \"spacing\""),
        (r#"{"skyrmion": {"radius": 3, "width": -1}}"#, "width: found -1"),
        (r#"{"skyrmion": {"radius": 3, "vorticity": 0}}"#, "vorticity: found 0"),
        (r#"{"skyrmion": {"center": [1, "2 nm"], "radius": 3}}"#, "center[1]: a length with a unit needs"),
        (r#"{"skyrmion": {"center": [1], "radius": 3}}"#, "found 1 coordinates"),
        (r#"{"skyrmion": {"radius": 3, "helicity": 90}}"#, "unit"),
        (r#"{"skyrmion": {"radius": 3, "heliciti": "90 deg"}}"#, "unknown field `heliciti`"),
        (r#"{"vortex": {"radius": -1}}"#, "radius"),
    ] {
        let said = try_state(text, &film, None).unwrap_err();
        assert!(said.contains(words), "{text}: {said}");
    }
}
