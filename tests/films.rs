//! First paths on films and crystals: ends kept, images near each other, frozen spins at rest, fronts where they should be, and the
//! natural paths of a problem.

use spinneb::energy::{Anisotropy, Dmi, EnergyTerm, Exchange, Hamiltonian, Zeeman};
use spinneb::geometry::{Direction, angle, vector};
use spinneb::lattice::{Atom, FrozenSites, Grid, Lattice};
use spinneb::path::Path;
use spinneb::path::guess::{GuessContext, GuessSpec, NoiseSpec, add_noise, natural};
use spinneb::spins::Spins;
use spinneb::state::{StateContext, StateSpec};
use spinneb::units::Angle;

/// A box of cells with steps of length 1, the second one at so many degrees to the first, with so many atoms along the diagonal.
fn lattice(size: [usize; 3], periodic: bool, degrees: f64, atoms: usize) -> Lattice {
    let grid = Grid { size, periodic: [periodic, periodic, false] };
    let (sin, cos) = degrees.to_radians().sin_cos();
    let second = Direction::new([if degrees == 90.0 { 0.0 } else { cos }, sin, 0.0]).unwrap();
    let steps = [(1.0, Direction::X), (1.0, second), (1.0, Direction::Z)];
    let at = |k: usize| [k as f64 / 3.0, k as f64 / 3.0, 0.0];
    Lattice::of_atoms("crystal", grid, steps, (0..atoms).map(|k| Atom { at: at(k), species: 0 }).collect())
}

/// A square film, a rhombus, honeycombs and a box.
fn all(periodic: bool) -> Vec<Lattice> {
    vec![
        lattice([14, 12, 1], periodic, 90.0, 1),
        lattice([12, 13, 1], periodic, 60.0, 1),
        lattice([8, 9, 1], periodic, 60.0, 2),
        lattice([8, 7, 6], periodic, 90.0, 1),
    ]
}

fn state(text: &str, lattice: &Lattice) -> Spins {
    let spec: StateSpec = serde_json::from_str(text).expect(text);
    spec.build(&StateContext::new(lattice, 1.5)).expect(text)
}

fn try_path(text: &str, a: &Spins, b: &Spins, images: usize, lattice: &Lattice) -> Result<Path, String> {
    let spec: GuessSpec = serde_json::from_str(text).map_err(|e| e.to_string())?;
    let context = GuessContext { states: StateContext::new(lattice, 1.0), default_axis: Direction::X };
    spec.member().path(a, b, images, &context).map_err(|e| e.to_string())
}

fn path(text: &str, a: &Spins, b: &Spins, images: usize, lattice: &Lattice) -> Path {
    try_path(text, a, b, images, lattice).expect(text)
}

fn up_and_down(sites: usize) -> [Spins; 2] {
    [Direction::Z, Direction::Z.reversed()].map(|d| Spins::uniform(sites, d))
}

const SKYRMION: &str = r#"{"skyrmion": {"radius": 2.6, "width": 0.9, "helicity": "30 deg"}}"#;

fn check(text: &str, p: &Path, [a, b]: [&Spins; 2], lattice: &Lattice) {
    let last = p.images() - 1;
    assert_eq!((p.image(0), p.image(last)), (a.as_slice(), b.as_slice()), "{text}");
    let spacings = p.spacings();
    let mean = p.length() / last as f64;
    assert!(spacings.iter().all(|s| *s < 2.0 * mean), "{text}: {spacings:?}");
    for k in 0..=last {
        let m = p.spins(k);
        assert!(m.vectors().iter().all(|v| (vector::norm(*v) - 1.0).abs() < 1e-14), "{text}");
        for frozen in &lattice.frozen {
            frozen.sites.iter().for_each(|i| assert_eq!(m.get(*i), a.get(*i), "{text}: image {k}, frozen site {i}"));
        }
    }
}

#[test]
fn every_guess_keeps_ends_and_frozen_spins_and_its_images_are_near_each_other_on_every_lattice() {
    let fronts = [
        r#"{"sweep": {"from": "left"}}"#,
        r#"{"sweep": {"from": [0, 1, 0], "helicity": "20 deg"}}"#,
        r#"{"sweep": {"from": [1, 1, 0.5], "width": 3, "axis": [0, 1, 0]}}"#,
        r#"{"sweep": {"from": "center", "helicity": "90 deg"}}"#,
        r#"{"droplet": {"center": [0, 0]}}"#,
        r#"{"droplet": {"radius": 2}}"#,
        r#"{"shrink": {"helicity": "0 deg"}}"#,
        r#"{"geodesic": {}}"#,
    ];
    let of_edges = [r#"{"sweep": {"from": "edges"}}"#, r#"{"sweep": {"from": "corners", "helicity": "0 deg"}}"#];
    let drifts =
        [r#"{"drift": {}}"#, r#"{"drift": {"direction": [0, -1, 0]}}"#, r#"{"drift": {"direction": [1, 1, 0]}}"#];
    for periodic in [false, true] {
        for mut lattice in all(periodic) {
            lattice.frozen = vec![FrozenSites { sites: vec![3, 17], direction: Some(Direction::Z) }];
            let spot = state(SKYRMION, &lattice);
            let [up, mut down] = up_and_down(lattice.sites);
            let mut vectors = down.vectors();
            [3, 17].into_iter().for_each(|i| vectors[i] = [0.0, 0.0, 1.0]);
            down = Spins::from_vectors(&vectors).unwrap();
            let edges: &[&str] = if periodic && lattice.grid.size[2] == 1 { &[] } else { &of_edges };
            for text in fronts.iter().chain(edges) {
                for (a, b) in [(&up, &down), (&down, &up), (&spot, &up), (&up, &spot)] {
                    check(text, &path(text, a, b, 15, &lattice), [a, b], &lattice);
                }
            }
            for text in drifts.iter().filter(|_| !periodic) {
                for (a, b) in [(&spot, &up), (&up, &spot)] {
                    check(text, &path(text, a, b, 25, &lattice), [a, b], &lattice);
                }
            }
        }
    }
}

#[test]
fn a_straight_front_leaves_the_final_state_behind_it_and_is_level_across_its_way() {
    for lattice in all(false) {
        let [up, down] = up_and_down(lattice.sites);
        for side in [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.3, -0.9, 0.0]] {
            let n = Direction::new(side).unwrap().vector();
            let text = format!(r#"{{"sweep": {{"from": {side:?}, "width": 3}}}}"#);
            let middle = path(&text, &up, &down, 9, &lattice).spins(4);
            let mut sites: Vec<usize> = (0..lattice.sites).collect();
            let x = |i: usize| vector::dot(lattice.place(i), n);
            sites.sort_by(|i, j| x(*i).total_cmp(&x(*j)));
            for pair in sites.windows(2) {
                let [near, far] = [middle.get(pair[1])[2], middle.get(pair[0])[2]];
                assert!(near <= far + 1e-9, "{text}: {near} {far}");
                assert!(x(pair[1]) - x(pair[0]) > 1e-9 || (near - far).abs() < 1e-7, "{text}");
            }
            assert!(middle.get(sites[0])[2] > 0.99 && middle.get(sites[lattice.sites - 1])[2] < -0.99);
        }
    }
}

#[test]
fn round_fronts_are_round_and_a_skyrmion_shrinks_about_a_hollow_beside_its_middle() {
    for degrees in [90.0, 60.0] {
        let film = lattice([15, 15, 1], true, degrees, 1);
        let hollow = if degrees == 90.0 { 0.5f64.sqrt() } else { 1.0 / 3f64.sqrt() };
        let center = film.place(7 + 15 * 7);
        let text =
            format!(r#"{{"skyrmion": {{"center": {:?}, "radius": 3, "width": 0.8, "helicity": "0 deg"}}}}"#, center);
        let (spot, up) = (state(&text, &film), Spins::uniform(film.sites, Direction::Z));
        let p = path(r#"{"shrink": {}}"#, &spot, &up, 21, &film);
        // the spins that are the last to turn stand around a hollow
        let gone = |k: usize, i: usize| {
            let (from, now) = (spot.get(i), p.spins(k).get(i));
            angle(from, now) / angle(from, up.get(i))
        };
        let near: Vec<usize> = (0..film.sites).filter(|i| spot.get(*i)[2] < 0.0).collect();
        let behind = |k: usize| {
            let least = near.iter().map(|i| gone(k, *i)).fold(1.0, f64::min);
            near.iter().copied().filter(|i| gone(k, *i) < least + 1e-9).collect::<Vec<_>>()
        };
        let last = behind(19);
        assert_eq!(last.len(), if degrees == 90.0 { 4 } else { 3 }, "{last:?}");
        let sum = last.iter().fold([0.0; 3], |sum, i| vector::add(sum, film.place(*i)));
        let middle = vector::sub(vector::scale(1.0 / last.len() as f64, sum), center);
        assert!((vector::norm(middle) - hollow).abs() < 1e-6, "{degrees}: {last:?} {middle:?}");
        // a spot that grows is one that shrinks, the other way round
        let back = path(r#"{"shrink": {}}"#, &up, &spot, 21, &film);
        let z = |p: &Path, k: usize, i: usize| p.spins(k).get(i)[2];
        let apart = |k: usize| (0..film.sites).map(|i| (z(&p, k, i) - z(&back, 20 - k, i)).abs()).fold(0.0, f64::max);
        assert!((0..21).all(|k| apart(k) < 0.5), "{:?}", (0..21).map(apart).collect::<Vec<_>>());
    }
    let film = lattice([15, 15, 1], false, 90.0, 1);
    let [up, down] = up_and_down(film.sites);
    for (text, center) in [
        (r#"{"droplet": {"center": [0, 14], "width": 3}}"#, [0.0, 14.0]),
        (r#"{"sweep": {"from": "center", "width": 3}}"#, [6.5, 6.5]),
    ] {
        let m = path(text, &up, &down, 9, &film).spins(3);
        let r = |i: usize| ((i % 15) as f64 - center[0]).hypot((i / 15) as f64 - center[1]);
        for (i, j) in (0..film.sites).flat_map(|i| (0..i).map(move |j| (i, j))) {
            assert!(r(i) < r(j) + 1e-9 || m.get(i)[2] >= m.get(j)[2] - 1e-9, "{text}: {i} {j}");
        }
    }
    let corners = path(r#"{"sweep": {"from": "corners", "width": 3}}"#, &up, &down, 9, &film).spins(4);
    [0, 14, 210, 224].into_iter().for_each(|i| assert!(corners.get(i)[2] < -0.9));
    let edges = path(r#"{"sweep": {"from": "edges", "width": 3}}"#, &up, &down, 9, &film).spins(4);
    [0, 7, 105, 217].into_iter().for_each(|i| assert!(edges.get(i)[2] < -0.9 && edges.get(112)[2] > 0.9));
}

#[test]
fn the_spins_of_a_front_pass_at_its_helicity_to_its_way() {
    let film = lattice([15, 15, 1], false, 90.0, 1);
    let [up, down] = up_and_down(film.sites);
    for (helicity, [c, s]) in
        [(0.0, [1.0, 0.0]), (90.0, [0.0, 1.0]), (180.0, [-1.0, 0.0]), (-45.0, [0.5f64.sqrt(), -0.5f64.sqrt()])]
    {
        for (from, way) in [("\"left\"", [1.0, 0.0]), ("[0, 1, 0]", [0.0, -1.0]), ("[-1, -1, 0]", [0.5f64.sqrt(); 2])] {
            let text = format!(r#"{{"sweep": {{"from": {from}, "width": 4, "helicity": "{helicity} deg"}}}}"#);
            let m = path(&text, &up, &down, 9, &film).spins(4);
            let turning = m.vectors().into_iter().filter(|m| m[2].abs() < 0.9);
            let through = [c * way[0] - s * way[1], s * way[0] + c * way[1], 0.0];
            for v in turning {
                assert!(angle([v[0], v[1], 0.0], through) < 1e-9, "{text}: {v:?} {through:?}");
            }
        }
    }
    // around a corner they turn with it
    let m = path(r#"{"droplet": {"center": [0, 0], "width": 5, "helicity": "0 deg"}}"#, &up, &down, 9, &film).spins(3);
    for i in (1..film.sites).filter(|i| m.get(*i)[2].abs() < 0.9) {
        let [x, y, _] = m.get(i);
        assert!(angle([x, y, 0.0], film.place(i)) < 1e-9, "site {i}");
    }
}

#[test]
fn a_skyrmion_drifts_off_as_it_is_and_leaves_the_film_as_the_final_state_has_it() {
    for film in [lattice([20, 16, 1], false, 90.0, 1), lattice([12, 14, 1], false, 60.0, 2)] {
        let (spot, up) = (state(SKYRMION, &film), Spins::uniform(film.sites, Direction::Z));
        let text = r#"{"drift": {"direction": [1, 0, 0]}}"#;
        let p = path(text, &spot, &up, 31, &film);
        let down = |k: usize| p.spins(k).vectors().iter().map(|m| 1.0 - m[2]).sum::<f64>();
        // whole until it meets the edge, then less and less
        assert!((1..6).all(|k| (down(k) / down(0) - 1.0).abs() < 0.15), "{:?}", (0..31).map(down).collect::<Vec<_>>());
        assert!((20..30).all(|k| down(k + 1) <= down(k) + 1e-9));
        let middle = |k: usize| {
            let m = p.spins(k);
            let weights = || (0..film.sites).map(|i| (i, 1.0 - m.get(i)[2]));
            weights().map(|(i, w)| w * film.place(i)[0]).sum::<f64>() / weights().map(|(_, w)| w).sum::<f64>()
        };
        assert!((1..20).all(|k| middle(k) > middle(k - 1)), "{:?}", (0..20).map(middle).collect::<Vec<_>>());
    }
    // after whole cells it is the same to rounding: what is between sites is between their spins
    let film = lattice([30, 16, 1], false, 90.0, 1);
    let said = try_path(
        r#"{"drift": {"direction": [0, 1, 0]}}"#,
        &Spins::uniform(480, Direction::Z),
        &Spins::uniform(480, Direction::X),
        9,
        &lattice([30, 16, 1], true, 90.0, 1),
    );
    assert!(said.unwrap_err().starts_with("direction: the lattice is periodic that way"));
    let said = try_path(
        r#"{"sweep": {"from": "edges"}}"#,
        &Spins::uniform(480, Direction::Z),
        &Spins::uniform(480, Direction::X),
        9,
        &lattice([30, 16, 1], true, 90.0, 1),
    );
    assert!(said.unwrap_err().starts_with("from: all directions of the lattice are periodic"));
    let both = try_path(
        r#"{"sweep": {"from": "left", "axis": [1, 0, 0], "helicity": "0 deg"}}"#,
        &Spins::uniform(480, Direction::Z),
        &Spins::uniform(480, Direction::X),
        9,
        &film,
    );
    assert!(both.unwrap_err().starts_with("helicity: opposite spins turn about an \"axis\" or at a \"helicity\""));
}

#[test]
fn noise_is_smooth_over_the_lattice_and_differs_along_every_direction() {
    let film = lattice([14, 12, 1], false, 90.0, 1);
    let [up, _] = up_and_down(film.sites);
    let still = Path::new(&[up.clone(), up.clone(), up.clone()]);
    let m = add_noise(&still, &NoiseSpec { amplitude: Angle(0.1), seed: 3 }, &film).spins(1);
    let apart = |i: usize, j: usize| angle(m.get(i), m.get(j));
    assert!((0..13).all(|x| apart(x, x + 1) < 0.3) && (0..11).all(|y| apart(14 * y, 14 * (y + 1)) < 0.3));
    assert!(apart(0, 13) > 1e-3 && apart(0, 14 * 11) > 1e-3);
}

fn energy(lattice: &Lattice, d: f64, k: impl Fn(usize) -> f64, b: f64) -> Hamiltonian {
    let mut dmi = Dmi::uniform(lattice, d, Direction::X);
    for (direction, couplings) in dmi.directions.iter_mut().zip(&dmi.families) {
        *direction = vector::cross([0.0, 0.0, 1.0], vector::unit(couplings.family.along).unwrap());
    }
    let n = lattice.sites;
    let mut easy = Anisotropy::uniform(n, 0.0, Direction::Z);
    (0..n).for_each(|i| easy.k[i] = k(i));
    let terms: Vec<Box<dyn EnergyTerm>> = vec![
        Box::new(Exchange::uniform(lattice, &[1.0])),
        Box::new(dmi),
        Box::new(easy),
        Box::new(Zeeman::uniform(n, [0.0, 0.0, b])),
    ];
    Hamiltonian::new(lattice, terms).unwrap()
}

/// The names of the natural paths, with the directions of those that have one.
fn names(h: &Hamiltonian, a: &Spins, b: &Spins) -> Vec<String> {
    let context = GuessContext { states: StateContext::new(h.lattice(), 1.5), default_axis: Direction::X };
    let guesses = natural(h, a, b, &context);
    for (guess, noise) in &guesses {
        let mut p = guess.member().path(a, b, 15, &context).unwrap();
        if let Some(noise) = noise {
            p = add_noise(&p, noise, h.lattice());
        }
        check(guess.name(), &p, [a, b], h.lattice());
    }
    assert_eq!(guesses, natural(h, a, b, &context), "not the same again");
    guesses.iter().map(|(guess, _)| guess.name().to_string()).collect()
}

#[test]
fn the_natural_paths_of_a_reversal_are_geodesic_edges_and_corners_each_once_by_symmetry() {
    let count = |film: &Lattice, h: &Hamiltonian| {
        let [up, down] = up_and_down(film.sites);
        let names = names(h, &up, &down);
        let of = |name: &str| names.iter().filter(|n| *n == name).count();
        [of("geodesic"), of("sweep"), of("droplet"), names.len()]
    };
    let square = lattice([12, 12, 1], false, 90.0, 1);
    assert_eq!(count(&square, &energy(&square, 0.0, |_| 0.1, 0.0)), [1, 1, 1, 3]);
    let oblong = lattice([14, 10, 1], false, 90.0, 1);
    assert_eq!(count(&oblong, &energy(&oblong, 0.0, |_| 0.1, 0.0)), [1, 2, 1, 4]);
    // acute and obtuse corners
    let rhombus = lattice([12, 12, 1], false, 60.0, 1);
    assert_eq!(count(&rhombus, &energy(&rhombus, 0.0, |_| 0.1, 0.0)), [1, 1, 2, 4]);
    // both senses where an interaction tells them apart
    assert_eq!(count(&square, &energy(&square, 0.2, |_| 0.1, 0.0)), [1, 2, 2, 5]);
    // nothing is like anything else
    let grains = |i: usize| 0.1 + 0.02 * f64::sin(1.7 * i as f64);
    assert_eq!(count(&square, &energy(&square, 0.0, grains, 0.0)), [1, 4, 4, 9]);
    let cube = lattice([6, 6, 6], false, 90.0, 1);
    assert_eq!(count(&cube, &energy(&cube, 0.0, |_| 0.2, 0.0)), [1, 1, 1, 3]);
    let periodic = lattice([12, 12, 1], true, 90.0, 1);
    assert_eq!(count(&periodic, &energy(&periodic, 0.0, |_| 0.1, 0.0)), [1, 1, 1, 3]);
}

#[test]
fn the_natural_paths_of_a_spot_shrink_it_and_let_it_drift_over_open_edges_and_a_band_has_two_sides() {
    let film = lattice([20, 16, 1], false, 90.0, 1);
    let h = energy(&film, 0.6, |_| 0.1, 0.2);
    let context = StateContext { hamiltonian: Some(&h), ..StateContext::new(&film, 1.5) };
    let spec: StateSpec = serde_json::from_str(r#"{"skyrmion": {"radius": 3}}"#).unwrap();
    let (spot, up) = (spec.build(&context).unwrap(), Spins::uniform(film.sites, Direction::Z));
    for (a, b) in [(&spot, &up), (&up, &spot)] {
        let found = names(&h, a, b);
        let of = |name: &str| found.iter().filter(|n| *n == name).count();
        assert_eq!((found[0].as_str(), of("drift")), ("geodesic", 2), "{found:?}");
        assert!(of("shrink") >= 1 && of("sweep") + of("droplet") == 0, "{found:?}");
    }
    let torus = lattice([20, 16, 1], true, 90.0, 1);
    let h = energy(&torus, 0.6, |_| 0.1, 0.2);
    let found = names(&h, &spot, &up);
    assert!(found.iter().all(|name| name == "geodesic" || name == "shrink"), "{found:?}");
    let two: Vec<Spins> = [4.0, 14.0]
        .map(|x| {
            let spec: StateSpec =
                serde_json::from_str(&format!(r#"{{"skyrmion": {{"radius": 2, "center": [{x}, 8]}}}}"#)).unwrap();
            spec.build(&context).unwrap()
        })
        .into();
    let found = names(&energy(&film, 0.6, |_| 0.1, 0.2), &two[0], &two[1]);
    assert_eq!(found.iter().filter(|name| *name == "translation").count(), 1, "{found:?}");
    let wall = |center: f64| state(&format!(r#"{{"domain_wall": {{"center": {center}, "width": 1}}}}"#), &film);
    let weak = |i: usize| if [5, 13].contains(&(i % 20)) { 0.05 } else { 0.1 };
    let found = names(&energy(&film, 0.0, weak, 0.0), &wall(5.0), &wall(13.0));
    assert!(found[0] == "geodesic" && found.iter().all(|name| name == "geodesic" || name == "sweep"), "{found:?}");
    assert!(found.iter().filter(|name| *name == "sweep").count() >= 2, "{found:?}");
}

/// The energies along the natural paths, of the exchanged ones from their last image on.
fn profiles(h: &Hamiltonian, a: &Spins, b: &Spins, exchanged: bool) -> Vec<Vec<f64>> {
    let context = GuessContext { states: StateContext::new(h.lattice(), 1.5), default_axis: Direction::X };
    let [a, b] = if exchanged { [b, a] } else { [a, b] };
    let energies = |(guess, _): (GuessSpec, Option<NoiseSpec>)| -> Vec<f64> {
        let p = guess.member().path(a, b, 15, &context).unwrap();
        let image = |k: usize| h.energy_mev(p.image(if exchanged { 14 - k } else { k }));
        (0..15).map(image).collect()
    };
    natural(h, a, b, &context).into_iter().map(energies).collect()
}

#[test]
fn the_natural_paths_from_one_end_to_the_other_are_those_back() {
    let film = lattice([9, 7, 1], false, 90.0, 1);
    let [up, down] = up_and_down(film.sites);
    let grains = |i: usize| 0.3 + 0.06 * f64::sin(1.7 * i as f64);
    for (field, d) in [(0.05, 0.0), (-0.05, 0.0), (0.05, 0.15), (-0.05, 0.15)] {
        let h = energy(&film, d, grains, field);
        let [there, back] = [false, true].map(|exchanged| profiles(&h, &up, &down, exchanged));
        assert_eq!(there.len(), back.len(), "{field} {d}");
        // images are equally far apart to a thousandth
        let alike = |x: &[f64], y: &[f64]| x.iter().zip(y).all(|(x, y)| (x - y).abs() < 0.1);
        for (ours, others) in [(&there, &back), (&back, &there)] {
            assert!(ours.iter().all(|x| others.iter().any(|y| alike(x, y))), "{field} {d}: {ours:?} {others:?}");
        }
    }
}

#[test]
fn a_droplet_of_the_initial_state_ends_where_one_of_the_final_state_begins() {
    let film = lattice([12, 10, 1], false, 90.0, 1);
    let [up, down] = up_and_down(film.sites);
    let made = |of: &str, x: f64, a: &Spins, b: &Spins| {
        let guess = format!(r#"{{"droplet": {{"center": [2, 3], "radius": 1, "of": "{of}", "axis": [{x}, 0, 0]}}}}"#);
        path(&guess, a, b, 11, &film)
    };
    let (shrinks, grows) = (made("initial", 1.0, &up, &down), made("final", -1.0, &down, &up));
    for k in 0..11 {
        let mut pairs = shrinks.image(k).iter().zip(grows.image(10 - k));
        assert!(pairs.all(|(x, y)| (x - y).abs() < 0.02), "image {k}");
    }
    let apart = |p: &Path, image: usize| (0..120).filter(|i| p.spins(image).get(*i)[2] > 0.0).count();
    assert!((1..60).contains(&apart(&shrinks, 8)) && apart(&made("final", 1.0, &up, &down), 2) > 60);
}
