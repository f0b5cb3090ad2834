//! States and first paths keep their contract: ends exact, unit vectors, the right number of images, neighbours together.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use spinneb::geometry::{Direction, Vector, angle, rotate, vector};
use spinneb::lattice::{Chain, Frozen, Lattice, Selection};
use spinneb::path::guess::{GuessContext, GuessSpec, NoiseSpec, add_noise, common_axis, component_sag, smooth};
use spinneb::path::{Path, distance};
use spinneb::registry::Entry;
use spinneb::spins::Spins;
use spinneb::state::{StateContext, StateSpec};
use spinneb::units::Angle;
use std::f64::consts::PI;

const EPS: f64 = f64::EPSILON;

fn try_state(text: &str, chain: &Lattice) -> Result<Spins, String> {
    let spec: StateSpec = serde_json::from_str(text).map_err(|e| e.to_string())?;
    spec.build(&StateContext::new(chain, 1.5)).map_err(|e| e.to_string())
}

/// In a chain with a region of the name that the example of regions has.
fn state(text: &str, sites: usize) -> Spins {
    let island = ("island".to_string(), Selection::List(vec![0]));
    let chain = Chain { regions: [island].into(), ..Chain::open(sites) };
    try_state(text, &chain.resolve().unwrap()).expect(text)
}

fn try_path(text: &str, a: &Spins, b: &Spins, images: usize, chain: &Lattice) -> Result<Path, String> {
    let spec: GuessSpec = serde_json::from_str(text).map_err(|e| e.to_string())?;
    let states = StateContext::new(chain, 1.5);
    let context = GuessContext { states, default_axis: Direction::X };
    spec.member().path(a, b, images, &context).map_err(|e| e.to_string())
}

fn path(text: &str, a: &Spins, b: &Spins, images: usize) -> Path {
    try_path(text, a, b, images, &Chain::open(a.sites()).resolve().unwrap()).expect(text)
}

fn z(sites: usize, sign: f64) -> Spins {
    Spins::from_vectors(&vec![[0.0, 0.0, sign]; sites]).unwrap()
}

fn random(sites: usize, seed: u64) -> Spins {
    state(&format!(r#"{{"random": {{"seed": {seed}}}}}"#), sites)
}

/// Every spin pushed by up to `size` in each component.
fn canted(spins: &Spins, size: f64, seed: u64) -> Spins {
    let mut r = ChaCha8Rng::seed_from_u64(seed);
    let push = |v: Vector, r: &mut ChaCha8Rng| v.map(|c| c + size * r.random_range(-1.0..1.0));
    Spins::from_vectors(&spins.vectors().into_iter().map(|v| push(v, &mut r)).collect::<Vec<_>>()).unwrap()
}

fn axes() -> Vec<Vector> {
    let cartesian = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut all: Vec<Vector> = cartesian.iter().flat_map(|v| [*v, v.map(|c| -c)]).collect();
    all.push([0.6, 0.0, 0.8]);
    all
}

fn check_contract(name: &str, p: &Path, a: &Spins, b: &Spins, images: usize) {
    assert_eq!((p.images(), p.sites()), (images, a.sites()), "{name}");
    assert_eq!(p.image(0), a.as_slice(), "{name}: the start moved");
    assert_eq!(p.image(images - 1), b.as_slice(), "{name}: the end moved");
    for k in 0..images {
        for (i, m) in p.spins(k).vectors().into_iter().enumerate() {
            assert!((vector::norm(m) - 1.0).abs() <= 4.0 * EPS, "{name}: image {k}, site {i}: {m:?}");
        }
    }
}

/// The largest angle between neighbours along the path beyond the sum of those at the ends; for antiferromagnets the angle to
/// the opposite of the neighbour.
fn tangle(p: &Path, staggered: bool) -> f64 {
    let apart = |k: usize, i: usize| {
        let s = p.spins(k);
        let next = if staggered { s.get(i + 1).map(|c| -c) } else { s.get(i + 1) };
        angle(s.get(i), next)
    };
    let last = p.images() - 1;
    let beyond = |i: usize| {
        let allowed = apart(0, i) + apart(last, i);
        (0..=last).map(|k| apart(k, i) - allowed).fold(f64::MIN, f64::max)
    };
    (0..p.sites() - 1).map(beyond).fold(f64::MIN, f64::max)
}

#[test]
fn every_entry_parses_into_the_member_of_its_name_and_summarises_itself_in_a_line() {
    for entry in StateSpec::ENTRIES {
        assert_eq!(serde_json::from_str::<StateSpec>(entry.example).expect(entry.example).name(), entry.name);
        assert!(!entry.summary.is_empty() && !entry.summary.contains('\n'));
    }
    for entry in GuessSpec::ENTRIES {
        assert_eq!(serde_json::from_str::<GuessSpec>(entry.example).expect(entry.example).name(), entry.name);
        assert!(!entry.summary.is_empty() && !entry.summary.contains('\n'));
    }
    let names = |entries: &[Entry]| entries.iter().map(|e| e.name).collect::<Vec<_>>().join(" ");
    assert_eq!(
        names(StateSpec::ENTRIES),
        "uniform domain_wall soliton skyrmion vortex spiral random vectors file regions"
    );
    assert_eq!(
        names(GuessSpec::ENTRIES),
        "geodesic sweep shrink drift translation droplet rotation nlerp waypoints file"
    );
}

/// The members whose examples need no file, nor two states that hold the same in two places; those of files are tested in `files.rs`, a
/// translation beside its code.
fn made_from_nothing(entries: &[Entry]) -> impl Iterator<Item = &Entry> {
    entries.iter().filter(|e| !["file", "translation"].contains(&e.name))
}

#[test]
fn every_state_is_made_of_unit_vectors_and_is_refused_an_unknown_key() {
    for entry in made_from_nothing(StateSpec::ENTRIES) {
        let sites = if entry.name == "vectors" { 3 } else { 12 };
        let spins = state(entry.example, sites);
        assert_eq!(spins.sites(), sites);
        for m in spins.vectors() {
            assert!((vector::norm(m) - 1.0).abs() <= 4.0 * EPS, "{}: {m:?}", entry.name);
        }
        // a key of `regions` is the name of a region
        if !["vectors", "regions"].contains(&entry.name) {
            let extra = entry.example.replacen("{\"", "{\"widht\": 1, \"", 2).replacen("{\"widht\": 1, ", "{", 1);
            let error = serde_json::from_str::<StateSpec>(&extra).expect_err(&extra).to_string();
            assert!(error.contains("unknown field `widht`"), "{extra}: {error}");
        }
    }
}

#[test]
fn every_guess_keeps_the_ends_the_count_and_the_unit_length() {
    let ends = [
        (z(12, 1.0), z(12, -1.0)),
        (random(12, 1), random(12, 2)),
        (random(12, 3), random(12, 3)),
        (canted(&z(12, 1.0), 1e-9, 1), canted(&z(12, -1.0), 1e-9, 2)),
        (state(r#"{"domain_wall": {"center": 2}}"#, 12), state(r#"{"domain_wall": {"center": 8}}"#, 12)),
        (random(1, 1), random(1, 2)),
    ];
    let more = [
        r#"{"sweep": {"from": "right"}}"#,
        r#"{"sweep": {"from": "center", "width": 1e-3}}"#,
        r#"{"sweep": {"from": "ends", "width": 1e9, "axis": [0, 0, -1]}}"#,
        r#"{"rotation": {}}"#,
        r#"{"geodesic": {}}"#,
        r#"{"waypoints": {"states": []}}"#,
    ];
    for text in made_from_nothing(GuessSpec::ENTRIES).map(|e| e.example).chain(more) {
        for (a, b) in &ends {
            // walls at sites that a chain of one site does not have
            if a.sites() == 1 && text.contains("domain_wall") {
                continue;
            }
            for images in [2, 3, 4, 9, 16] {
                let p = path(text, a, b, images);
                check_contract(text, &p, a, b, images);
                let noise = NoiseSpec { amplitude: Angle(0.1), seed: 1 };
                let noisy = add_noise(&p, &noise, &Chain::open(a.sites()).resolve().unwrap());
                check_contract("noise", &noisy, a, b, images);
                check_contract("smooth", &smooth(&noisy, 0.6), a, b, images);
            }
        }
    }
}

#[test]
fn the_geodesic_is_the_shortest_path_at_constant_speed() {
    let pairs =
        [(random(40, 1), random(40, 2)), (z(7, 1.0), z(7, -1.0)), (random(5, 3), canted(&random(5, 3), 0.1, 4))];
    for (a, b) in pairs {
        let largest = (0..a.sites()).map(|i| angle(a.get(i), b.get(i))).fold(0.0, f64::max);
        assert!(largest < 3.0 || largest == PI, "this pair is not a shortest path's: {largest}");
        let p = path(r#"{"geodesic": {"axis": [0, 1, 0]}}"#, &a, &b, 11);
        let straight = distance(a.as_slice(), b.as_slice());
        assert!((p.length() / straight - 1.0).abs() < 1e-13, "{} {straight}", p.length());
        for s in p.spacings() {
            assert!((10.0 * s / straight - 1.0).abs() < 1e-12, "{s} {straight}");
        }
        assert!(path(r#"{"sweep": {"from": "left"}}"#, &a, &b, 11).length() > straight * (1.0 - 1e-13));
    }
}

#[test]
fn opposite_spins_turn_right_handed_about_the_axis() {
    let p = path(r#"{"geodesic": {"axis": [1, 0, 0]}}"#, &z(3, 1.0), &z(3, -1.0), 3);
    assert_eq!(p.spins(1).vectors(), vec![[0.0, -1.0, 0.0]; 3]);
    let p = path(r#"{"geodesic": {"axis": [0, 1, 0]}}"#, &z(3, 1.0), &z(3, -1.0), 3);
    assert_eq!(p.spins(1).vectors(), vec![[1.0, 0.0, 0.0]; 3]);
    let p = path(r#"{"geodesic": {"axis": [0, -1, 0]}}"#, &z(3, 1.0), &z(3, -1.0), 3);
    assert_eq!(p.spins(1).vectors(), vec![[-1.0, 0.0, 0.0]; 3]);
    // along the axis: about the next one, x
    let p = path(r#"{"geodesic": {"axis": [0, 0, 1]}}"#, &z(3, 1.0), &z(3, -1.0), 3);
    assert_eq!(p.spins(1).vectors(), vec![[0.0, -1.0, 0.0]; 3]);
}

#[test]
fn neighbours_stay_together_between_all_opposite_states_about_every_axis_however_slightly_canted() {
    for direction in axes() {
        for axis in axes() {
            for staggered in [false, true] {
                for cant in [0.0, 1e-15, 1e-9, 1e-7, 1e-6, 1e-3, 0.03] {
                    let text = format!(r#"{{"uniform": {{"direction": {direction:?}, "staggered": {staggered}}}}}"#);
                    let a = state(&text, 9);
                    let b =
                        Spins::from_vectors(&a.vectors().iter().map(|v| v.map(|c| -c)).collect::<Vec<_>>()).unwrap();
                    let (a, b) = (canted(&a, cant, 1), canted(&b, cant, 2));
                    for guess in ["geodesic", "nlerp"] {
                        let p = path(&format!(r#"{{"{guess}": {{"axis": {axis:?}}}}}"#), &a, &b, 9);
                        let beyond = tangle(&p, staggered);
                        assert!(
                            beyond < 12.0 * cant + 1e-14,
                            "{guess} {direction:?} about {axis:?}, staggered {staggered}, canted {cant}: {beyond}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn an_antiferromagnet_stays_antiparallel_in_a_sweep_too_behind_and_before_the_wall() {
    let a = state(r#"{"uniform": {"direction": [0, 0, 1], "staggered": true}}"#, 40);
    let b = state(r#"{"uniform": {"direction": [0, 0, -1], "staggered": true}}"#, 40);
    let p = path(r#"{"sweep": {"from": "left", "width": 8}}"#, &a, &b, 15);
    let ferromagnet = path(r#"{"sweep": {"from": "left", "width": 8}}"#, &z(40, 1.0), &z(40, -1.0), 15);
    for k in 0..15 {
        for i in 0..40 {
            let m = p.spins(k).get(i);
            let unstaggered = if i % 2 == 1 { m.map(|c| -c) } else { m };
            assert!(angle(unstaggered, ferromagnet.spins(k).get(i)) < 1e-14, "image {k}, site {i}");
        }
    }
}

#[test]
fn spins_at_120_degrees_stay_so_in_a_wide_wall_in_which_all_turn_as_one() {
    let chirality = |period: f64| state(&format!(r#"{{"spiral": {{"axis": [0, 0, 1], "period": {period}}}}}"#), 60);
    let (a, b) = (chirality(3.0), chirality(-3.0));
    // of three neighbours: nothing where they are at 120°, three where they are parallel
    let sum = |spins: &Spins, i: usize| {
        let three = (i..i + 3).map(|i| spins.get(i)).fold([0.0; 3], vector::add);
        vector::norm(three)
    };
    let largest = |guess: &str| {
        let p = path(guess, &a, &b, 21);
        let each = (0..21).map(|k| p.spins(k)).map(|spins| (0..58).map(|i| sum(&spins, i)).fold(0.0, f64::max));
        each.fold(0.0, f64::max)
    };
    assert!(largest(r#"{"sweep": {"from": "left", "width": 30}}"#) > 0.9);
    assert!(largest(r#"{"sweep": {"from": "left", "width": 30, "rigid": true}}"#) < 0.25);
    let both = r#"{"sweep": {"from": "left", "rigid": true, "helicity": "90 deg"}}"#;
    let refused = try_path(both, &a, &b, 5, &Chain::open(60).resolve().unwrap()).unwrap_err();
    assert!(refused.contains("rigid"), "{refused}");
}

#[test]
fn the_common_axis_is_the_given_one_unless_an_opposite_spin_lies_along_it() {
    let (up, down) = (z(4, 1.0), z(4, -1.0));
    assert_eq!(common_axis(&up, &down, Direction::Y), Direction::Y);
    assert_eq!(common_axis(&up, &down, Direction::Z), Direction::X);
    assert_eq!(common_axis(&up, &down, Direction::Z.reversed()), Direction::X.reversed());
    assert_eq!(common_axis(&up, &up, Direction::Z), Direction::Z);
    // a spiral in the plane of x and y, reversed: only z is across all of its spins
    let a = state(r#"{"spiral": {"axis": [0, 0, 1], "period": 8}}"#, 16);
    let b = Spins::from_vectors(&a.vectors().iter().map(|v| v.map(|c| -c)).collect::<Vec<_>>()).unwrap();
    for axis in [Direction::X, Direction::Y, Direction::Z] {
        assert_eq!(common_axis(&a, &b, axis), Direction::Z);
        let p = path(&format!(r#"{{"geodesic": {{"axis": {:?}}}}}"#, axis.vector()), &a, &b, 9);
        assert!(tangle(&p, false) < 1e-13, "{axis:?}");
    }
}

#[test]
fn a_sweep_is_a_wall_that_travels() {
    let (a, b) = (z(60, 1.0), z(60, -1.0));
    let wall = |from: &str| path(&format!(r#"{{"sweep": {{"from": "{from}", "width": 6}}}}"#), &a, &b, 13);
    let left = wall("left");
    for k in 1..12 {
        let m = left.spins(k).vectors();
        assert!((1..60).all(|i| m[i][2] >= m[i - 1][2]), "image {k} is not monotone: {m:?}");
        let between = m.iter().filter(|m| m[2].abs() < 1.0 - 1e-12).count();
        assert!((1..=6).contains(&between), "image {k}: {between} sites in the wall");
        let before = left.spins(k - 1).vectors();
        assert!((0..60).all(|i| m[i][2] <= before[i][2] + EPS), "image {k}: a spin turned back");
    }
    let right = wall("right");
    for k in 0..13 {
        for i in 0..60 {
            assert!(angle(left.spins(k).get(i), right.spins(k).get(59 - i)) < 1e-13, "mirror, image {k}, site {i}");
        }
    }
    let (center, ends) = (wall("center").spins(6).vectors(), wall("ends").spins(6).vectors());
    assert!(center[29][2] < -0.99 && center[30][2] < -0.99 && center[0][2] > 0.99 && center[59][2] > 0.99);
    assert!(ends[29][2] > 0.99 && ends[30][2] > 0.99 && ends[0][2] < -0.99 && ends[59][2] < -0.99);
}

#[test]
fn the_images_of_a_sweep_are_equally_far_apart_and_turn_about_the_axis_alone() {
    for (sites, width, images) in
        [(1, 4.0, 9), (12, 3.0, 5), (200, 4.0, 15), (200, 40.0, 15), (300, 2.0, 7), (50, 500.0, 9)]
    {
        for from in ["left", "center"] {
            let text = format!(r#"{{"sweep": {{"from": "{from}", "width": {width}, "axis": [0, 1, 0]}}}}"#);
            let p = path(&text, &z(sites, 1.0), &z(sites, -1.0), images);
            let s = p.spacings();
            let (least, most) = s.iter().fold((f64::MAX, 0.0_f64), |(l, m), d| (l.min(*d), m.max(*d)));
            assert!(most / least < 1.05, "{text} {sites}: {s:?}");
            for k in 1..images - 1 {
                assert!(p.spins(k).vectors().iter().all(|m| m[1].abs() < 1e-15 && m[0] > -1e-15), "{text}: image {k}");
            }
        }
    }
}

#[test]
fn only_spins_that_move_make_the_way_of_a_swept_wall() {
    let a = state(r#"{"domain_wall": {"center": 19.5, "width": 0}}"#, 100);
    let b = state(r#"{"domain_wall": {"center": 39.5, "width": 0}}"#, 100);
    let p = path(r#"{"sweep": {"from": "left", "width": 4}}"#, &a, &b, 9);
    let middle = p.spins(4).vectors();
    assert!((0..20).all(|i| middle[i][2] == 1.0) && (40..100).all(|i| middle[i][2] == -1.0));
    assert!(middle[21][2] > 0.99 && middle[38][2] < -0.99, "the wall is not halfway: {middle:?}");
    // the center is that of the spins that move
    let p = path(r#"{"sweep": {"from": "center", "width": 4}}"#, &a, &b, 9);
    let middle = p.spins(4).vectors();
    assert!(
        middle[29][2] > 0.99 && middle[30][2] > 0.99 && middle[20][2] < -0.99 && middle[39][2] < -0.99,
        "{middle:?}"
    );
}

#[test]
fn the_rotation_of_a_wall_by_half_a_turn_is_exact_and_right_handed() {
    let a = state(r#"{"domain_wall": {"center": 9.5, "through": [1, 0, 0]}}"#, 20);
    let b = state(r#"{"domain_wall": {"center": 9.5, "through": [-1, 0, 0]}}"#, 20);
    for (axis, sign) in [("[0, 0, 1]", 1.0), ("[0, 0, -1]", -1.0)] {
        let p = path(&format!(r#"{{"rotation": {{"axis": {axis}}}}}"#), &a, &b, 9);
        for k in 0..9 {
            for i in 0..20 {
                let expected = rotate(a.get(i), Direction::Z, sign * PI * k as f64 / 8.0);
                assert!(angle(p.spins(k).get(i), expected) < 20.0 * EPS, "{axis}: image {k}, site {i}");
            }
        }
    }
    // without an axis it is found
    let p = path(r#"{"rotation": {}}"#, &a, &b, 9);
    for i in 0..20 {
        assert!((p.spins(4).get(i)[2] - a.get(i)[2]).abs() < 1e-14, "not about z");
    }
    assert!(tangle(&p, false) < 1e-13);
}

#[test]
fn the_best_rotation_is_found_whatever_its_axis_and_angle() {
    let a = random(15, 8);
    for axis in [[0.0, 0.0, 1.0], [1.0, -2.0, 0.3], [-1.0, 1.0, 1.0]] {
        let k = Direction::new(axis).unwrap();
        for phi in [0.0, 1e-7, 0.4, 2.0, PI - 1e-6, PI] {
            let turned: Vec<Vector> = a.vectors().into_iter().map(|v| rotate(v, k, phi)).collect();
            let p = path(r#"{"rotation": {}}"#, &a, &Spins::from_vectors(&turned).unwrap(), 5);
            // a half turn has no sense of its own
            let middle: Vec<f64> = [0.5, -0.5]
                .iter()
                .map(|s| (0..15).map(|i| angle(p.spins(2).get(i), rotate(a.get(i), k, s * phi))).fold(0.0, f64::max))
                .collect();
            let gap = if phi == PI { middle[0].min(middle[1]) } else { middle[0] };
            assert!(gap < 1e-8, "{axis:?} {phi}: {middle:?}");
        }
    }
}

#[test]
fn a_rotation_of_all_spins_from_up_to_down_is_the_coherent_one_and_leaves_no_rest() {
    for axis in ["", r#""axis": [0, 0, 1]"#, r#""axis": [1, 0, 0]"#] {
        let p = path(&format!(r#"{{"rotation": {{{axis}}}}}"#), &z(6, 1.0), &z(6, -1.0), 5);
        assert!((p.length() / (PI * 6f64.sqrt()) - 1.0).abs() < 1e-14, "{axis}: {}", p.length());
        assert!(angle(p.spins(2).get(0), [0.0, -1.0, 0.0]) < 1e-14, "{axis}: {:?}", p.spins(2).get(0));
    }
}

#[test]
fn what_a_rotation_leaves_over_is_closed_along_the_way() {
    let a = state(r#"{"domain_wall": {"center": 6, "through": [1, 0, 0]}}"#, 14);
    let b = canted(&state(r#"{"domain_wall": {"center": 7, "through": [0, 1, 0]}}"#, 14), 0.1, 3);
    let p = path(r#"{"rotation": {"axis": [0, 0, 1]}}"#, &a, &b, 17);
    check_contract("rotation", &p, &a, &b, 17);
    let largest = p.largest_rotation();
    assert!(largest < 1.5 * (PI / 2.0) / 16.0, "a jump of {largest}");
}

#[test]
fn nlerp_goes_through_the_points_of_the_normalised_chord() {
    let (a, b) = (random(30, 1), random(30, 2));
    let p = path(r#"{"nlerp": {}}"#, &a, &b, 9);
    for k in 0..9 {
        let t = k as f64 / 8.0;
        for i in 0..30 {
            let chord = vector::add(vector::scale(1.0 - t, a.get(i)), vector::scale(t, b.get(i)));
            assert!(angle(p.spins(k).get(i), chord) < 1e-12, "image {k}, site {i}");
        }
    }
    let sag = (0..30).map(|i| libm::cos(0.5 * angle(a.get(i), b.get(i)))).fold(1.0, f64::min);
    assert!((component_sag(&a, &b) - sag).abs() < 4.0 * EPS);
    assert_eq!(component_sag(&z(3, 1.0), &z(3, -1.0)), 0.0);
}

#[test]
fn a_path_by_waypoints_meets_them_and_is_equally_spaced() {
    let (a, b) = (state(r#"{"domain_wall": {"center": 2}}"#, 12), state(r#"{"domain_wall": {"center": 8}}"#, 12));
    let stop = r#"{"uniform": {"direction": [1, 0, 0]}}"#;
    // by way of one state, from a and back to a: the middle image is that state
    let p = path(&format!(r#"{{"waypoints": {{"states": [{stop}]}}}}"#), &a, &a, 9);
    assert!(distance(p.image(4), state(stop, 12).as_slice()) < 1e-13);
    let s = p.spacings();
    assert!(s.iter().all(|d| (d / s[0] - 1.0).abs() < 1e-12), "{s:?}");
    // without stops it is the geodesic
    let none = path(r#"{"waypoints": {"states": []}}"#, &a, &b, 9);
    assert_eq!(none, path(r#"{"geodesic": {}}"#, &a, &b, 9));
    let error = try_path(
        r#"{"waypoints": {"states": [{"vectors": [[0, 0, 1]]}]}}"#,
        &a,
        &b,
        5,
        &Chain::open(12).resolve().unwrap(),
    );
    assert!(error.clone().is_err_and(|e| e.starts_with("states[0].vectors: found 1 vector for 12 sites")), "{error:?}");
}

#[test]
fn frozen_spins_do_not_move_on_any_path() {
    let frozen = vec![
        Frozen { sites: Selection::List(vec![0]), direction: Some(Direction::X) },
        Frozen { sites: Selection::List(vec![11]), direction: None },
    ];
    let chain = Chain { frozen, ..Chain::open(12) }.resolve().unwrap();
    let a = try_state(r#"{"domain_wall": {"center": 4, "through": [1, 1, 0.2]}}"#, &chain).unwrap();
    assert_eq!(a.get(0), [1.0, 0.0, 0.0]);
    let mut end = random(12, 5).vectors();
    (end[0], end[11]) = (a.get(0), a.get(11));
    let flat: Vec<f64> = (0..3).flat_map(|c| end.iter().map(move |v| v[c]).collect::<Vec<_>>()).collect();
    let b = Spins::from_components(&flat).unwrap();
    assert_eq!((b.get(0), b.get(11)), (a.get(0), a.get(11)), "the test's own end");
    let more = [r#"{"rotation": {}}"#, r#"{"waypoints": {"states": [{"random": {"seed": 3}}]}}"#];
    for text in made_from_nothing(GuessSpec::ENTRIES).map(|e| e.example).chain(more) {
        let p = try_path(text, &a, &b, 9, &chain).expect(text);
        let noisy = add_noise(&p, &NoiseSpec { amplitude: Angle(0.3), seed: 2 }, &chain);
        for p in [&p, &noisy, &smooth(&noisy, 0.5)] {
            for k in 0..9 {
                assert_eq!((p.spins(k).get(0), p.spins(k).get(11)), (a.get(0), a.get(11)), "{text}: image {k}");
            }
        }
        assert!(p.image(4) != noisy.image(4));
    }
}

#[test]
fn noise_is_smooth_depends_on_its_seed_alone_and_scales_with_its_amplitude() {
    let p = path(r#"{"geodesic": {}}"#, &z(200, 1.0), &z(200, -1.0), 9);
    let noisy = |amplitude: f64, seed: u64| {
        add_noise(&p, &NoiseSpec { amplitude: Angle(amplitude), seed }, &Chain::open(200).resolve().unwrap())
    };
    assert_eq!(noisy(0.01, 7), noisy(0.01, 7));
    assert!(noisy(0.01, 7) != noisy(0.01, 8));
    assert_eq!(noisy(0.0, 7), p);
    let deviation = |q: &Path| distance(q.image(4), p.image(4));
    let ratio = deviation(&noisy(0.02, 7)) / deviation(&noisy(0.01, 7));
    assert!((ratio - 2.0).abs() < 1e-10, "{ratio}");
    let rms = deviation(&noisy(0.01, 7)) / 200f64.sqrt();
    assert!((0.003..0.06).contains(&rms), "{rms}");
    let m = noisy(0.1, 7).spins(4).vectors();
    assert!((1..200).all(|i| angle(m[i], m[i - 1]) < 0.1 * 5.0 * 4.0 * PI / 200.0), "neighbours jump");
}

#[test]
fn smoothing_takes_roughness_away_and_leaves_an_even_turn_as_it_is() {
    let p = path(r#"{"geodesic": {}}"#, &z(4, 1.0), &z(4, -1.0), 41);
    let even = smooth(&p, 0.3);
    let moved = (0..41).map(|k| distance(p.image(k), even.image(k))).fold(0.0, f64::max);
    assert!(moved < 1e-6, "{moved}");
    assert!(smooth(&p, 0.0) == p);
    let rough: Vec<Spins> =
        (0..41).map(|k| if k % 40 == 0 { p.spins(k) } else { canted(&p.spins(k), 0.02, k as u64) }).collect();
    let rough = Path::new(&rough);
    assert!(smooth(&rough, 0.5).length() < 0.97 * rough.length());
}

#[test]
fn a_wall_has_the_profile_of_a_wall_and_passes_where_it_should() {
    let m = state(r#"{"domain_wall": {"center": 10.25, "width": 2.5, "through": [0, 3, 0.1]}}"#, 24);
    for i in 0..24 {
        let x = (i as f64 - 10.25) / 2.5;
        let expected = [0.0, 1.0 / libm::cosh(x), -libm::tanh(x)];
        assert!(vector::norm(vector::sub(m.get(i), expected)) < 1e-15 * 4.0, "site {i}");
    }
    let abrupt = state(r#"{"domain_wall": {"center": 1.5, "width": 0}}"#, 4).vectors();
    assert_eq!(abrupt.iter().map(|m| m[2]).collect::<Vec<_>>(), [1.0, 1.0, -1.0, -1.0]);
    let on_site = state(r#"{"domain_wall": {"center": 1, "width": 0, "right": [0, 0, -1]}}"#, 3);
    assert_eq!(on_site.get(1), [1.0, 0.0, 0.0]);
    // the material's width serves where none is given
    let with_default = state(r#"{"domain_wall": {"center": 3}}"#, 8);
    assert_eq!(with_default, state(r#"{"domain_wall": {"center": 3, "width": 1.5}}"#, 8));
}

#[test]
fn a_wall_between_domains_that_are_not_opposite_takes_the_side_of_through() {
    let wall = |extra: &str| {
        let text = format!(r#"{{"domain_wall": {{"center": 5, "left": [0, 0, 1], "right": [1, 0, 0]{extra}}}}}"#);
        state(&text, 11).get(5)
    };
    let half = 0.5_f64.sqrt();
    assert!(angle(wall(""), [half, 0.0, half]) < 1e-15);
    assert!(angle(wall(r#", "through": [0, 0.4, 1]"#), [half, 0.0, half]) < 1e-15);
    assert!(angle(wall(r#", "through": [-1, 0, 0]"#), [-half, 0.0, -half]) < 1e-15);
    // canted domains: through counts, not the canting
    let canted =
        r#"{"domain_wall": {"center": 5, "left": [0.01, 0, 1], "right": [0.01, 0, -1], "through": [0, 1, 0]}}"#;
    assert!(angle(state(canted, 11).get(5), [0.0, 1.0, 0.0]) < 1e-15);
    // head to head without through: across the domains
    let head = state(r#"{"domain_wall": {"center": 5, "left": [1, 0, 0], "right": [-1, 0, 0]}}"#, 11);
    assert!(angle(head.get(5), [0.0, 1.0, 0.0]) < 1e-15);
}

#[test]
fn a_wall_or_spiral_that_cannot_be_is_refused_at_its_key() {
    let chain = Chain::open(8).resolve().unwrap();
    for (text, expected) in [
        (r#"{"domain_wall": {"center": 3, "width": -1}}"#, "width: "),
        (r#"{"domain_wall": {"center": 3, "through": [0, 0, -1]}}"#, "through: "),
        (
            r#"{"domain_wall": {"center": 3, "left": [0, 0, 1], "right": [0, 0, 1], "through": [0, 0, -1]}}"#,
            "right: the domains left and right of the wall point the same way",
        ),
        (r#"{"spiral": {"axis": [0, 0, 1], "period": 0}}"#, "period: "),
        (r#"{"vectors": [[0, 0, 1]]}"#, "found 1 vector for 8 sites"),
        (r#"{"vectors": [[0, 0, 0]]}"#, "[0.0, 0.0, 0.0] has no direction"),
        (
            r#"{"spiral": {"axis": [0, 0, 1], "period": 8, "phase": 1}}"#,
            "found the number 1, but an angle needs its unit",
        ),
    ] {
        let error = try_state(text, &chain).expect_err(text);
        assert!(error.starts_with(expected), "{text}: {error}");
    }
    for width in ["0", "-2"] {
        let text = format!(r#"{{"sweep": {{"from": "left", "width": {width}}}}}"#);
        let error = try_path(&text, &z(8, 1.0), &z(8, -1.0), 5, &chain).expect_err(&text);
        assert!(error.starts_with("width: "), "{error}");
    }
}

#[test]
fn a_spiral_turns_by_the_same_angle_from_site_to_site_about_its_axis() {
    let m = state(r#"{"spiral": {"axis": [0, 1, 0], "period": 12, "phase": "30 deg"}}"#, 25);
    for i in 0..25 {
        let expected = rotate([0.0, 0.0, 1.0], Direction::Y, 2.0 * PI * (i as f64 + 1.0) / 12.0);
        assert!(angle(m.get(i), expected) < 1e-14, "site {i}");
    }
    let about_z = state(r#"{"spiral": {"axis": [0, 0, 1], "period": -4}}"#, 3).vectors();
    assert!(angle(about_z[0], [1.0, 0.0, 0.0]) < 1e-15 && angle(about_z[1], [0.0, -1.0, 0.0]) < 1e-15);
}

#[test]
fn a_staggered_state_has_its_odd_sites_reversed_and_nothing_else() {
    for entry in made_from_nothing(StateSpec::ENTRIES) {
        let (plain, staggered) = match entry.name {
            "vectors" => {
                let list = "[[0, 0, 1], [1, 0, 1], [0, 0, -1]]";
                (
                    format!(r#"{{"vectors": {{"spins": {list}}}}}"#),
                    format!(r#"{{"vectors": {{"spins": {list}, "staggered": true}}}}"#),
                )
            }
            "regions" => (entry.example.to_string(), entry.example.replace("]}}", r#"], "staggered": true}}"#)),
            _ => (entry.example.to_string(), entry.example.replacen("}}", r#", "staggered": true}}"#, 1)),
        };
        let sites = if entry.name == "vectors" { 3 } else { 12 };
        let (plain, staggered) = (state(&plain, sites), state(&staggered, sites));
        for i in 0..sites {
            let sign = if i % 2 == 1 { -1.0 } else { 1.0 };
            assert_eq!(staggered.get(i), plain.get(i).map(|c| sign * c), "{}: site {i}", entry.name);
        }
    }
}

#[test]
fn random_states_are_spread_evenly_and_depend_on_their_seed_alone() {
    let m = random(20_000, 1).vectors();
    for c in 0..3 {
        let mean = m.iter().map(|v| v[c]).sum::<f64>() / m.len() as f64;
        let square = m.iter().map(|v| v[c] * v[c]).sum::<f64>() / m.len() as f64;
        // four standard deviations: √(1/3N) and √(4/45N)
        assert!(mean.abs() < 4.0 * (1.0 / 60_000.0_f64).sqrt(), "component {c}: {mean}");
        assert!((square - 1.0 / 3.0).abs() < 4.0 * (4.0 / 900_000.0_f64).sqrt(), "component {c}: {square}");
    }
    assert_eq!(random(50, 9), random(50, 9));
    assert_eq!(random(50, 9).vectors()[..20], random(20, 9).vectors()[..]);
    assert!(random(50, 9) != random(50, 10));
}

#[test]
fn a_path_does_not_depend_on_the_number_of_threads() {
    let (a, b) = (random(3000, 1), random(3000, 2));
    for text in [r#"{"sweep": {"from": "left"}}"#, r#"{"rotation": {}}"#, r#"{"geodesic": {}}"#] {
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| path(text, &a, &b, 9))
        };
        assert_eq!(on(1), on(3), "{text}");
    }
}
