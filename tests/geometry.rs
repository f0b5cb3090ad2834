//! Laws of the geometry of one spin, over random and over adversarial pairs.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use spinneb::geometry::vector::{add, cross, dot, norm, scale, sub, unit, unit_or};
use spinneb::geometry::*;
use std::f64::consts::PI;

const EPS: f64 = f64::EPSILON;

/// Any direction: evenly distributed, or along an axis or a diagonal.
fn spin() -> impl Strategy<Value = Vector> {
    let random = (-1.0..1.0, 0.0..2.0 * PI).prop_map(|(z, phi): (f64, f64)| {
        let r = (1.0 - z * z).sqrt();
        unit_or([r * libm::cos(phi), r * libm::sin(phi), z], [0.0, 0.0, 1.0])
    });
    let lattice = (-1..=1, -1..=1, -1..=1)
        .prop_filter_map("zero", |(x, y, z): (i32, i32, i32)| unit([f64::from(x), f64::from(y), f64::from(z)]));
    prop_oneof![random, lattice]
}

/// Lengths of sideways steps: 0, denormal, and all magnitudes from 1e-17 to 1e-5.
fn step() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), Just(5e-324), Just(1e-310), (-17.0..-5.0).prop_map(libm::exp10)]
}

/// Two spins: independent, almost identical or almost opposite.
fn pair() -> impl Strategy<Value = (Vector, Vector)> {
    let near = (spin(), spin(), step(), prop_oneof![Just(1.0), Just(-1.0)]).prop_map(|(a, off, step, sign)| {
        let b = add(a, scale(step, cross(off, a)));
        (a, scale(sign, if step < 1e-17 { b } else { unit_or(b, a) }))
    });
    prop_oneof![(spin(), spin()), near]
}

fn axis() -> impl Strategy<Value = Direction> {
    spin().prop_filter_map("no direction", |v| Direction::new(v).ok())
}

fn off_unit(v: Vector) -> f64 {
    (norm(v) - 1.0).abs()
}

fn gap(a: Vector, b: Vector) -> f64 {
    norm(sub(a, b))
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 4000,
        max_global_rejects: 100_000,
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn every_point_of_slerp_and_nlerp_is_a_unit_vector((a, b) in pair(), k in axis(), t in 0.0..=1.0) {
        prop_assert!(off_unit(slerp(a, b, t, k)) <= 4.0 * EPS);
        prop_assert!(off_unit(nlerp(a, b, t, k)) <= 4.0 * EPS);
        prop_assert!(off_unit(midpoint(a, b, k)) <= 4.0 * EPS);
        prop_assert!(off_unit(rotation_axis(a, b, k)) <= 4.0 * EPS);
    }

    #[test]
    fn the_ends_are_exact((a, b) in pair(), k in axis(), n in 1_usize..40) {
        prop_assert_eq!((slerp(a, b, 0.0, k), slerp(a, b, 1.0, k)), (a, b));
        prop_assert_eq!((nlerp(a, b, 0.0, k), nlerp(a, b, 1.0, k)), (a, b));
        let path: Vec<Vector> = Arc::new(a, b, k).steps(n).collect();
        prop_assert_eq!((path.len(), path[0], path[n]), (n + 1, a, b));
    }

    #[test]
    fn exchanged_ends_give_the_same_points((a, b) in pair(), k in axis(), t in 0.0..=1.0) {
        prop_assert!(gap(slerp(a, b, t, k), slerp(b, a, 1.0 - t, k.reversed())) <= 5.0 * EPS);
    }

    #[test]
    fn slerp_turns_at_a_constant_rate((a, b) in pair(), k in axis(), n in 2_usize..50) {
        let arc = Arc::new(a, b, k);
        let path: Vec<Vector> = (0..=n).map(|j| arc.at(j as f64 / n as f64)).collect();
        let tolerance = if norm(add(a, b)) < 1e-6 { 1e-13 } else { 8.0 * EPS }; // a step across the blended middle cuts its corner
        for step in angular_velocity(&path, 1.0) {
            prop_assert!((step - arc.angle() / n as f64).abs() <= tolerance, "{step}");
        }
    }

    #[test]
    fn equal_steps_are_the_points_of_slerp((a, b) in pair(), k in axis(), n in 1_usize..200) {
        let arc = Arc::new(a, b, k);
        for (j, p) in arc.steps(n).enumerate() {
            prop_assert!(off_unit(p) <= 4.0 * EPS);
            prop_assert!(gap(p, arc.at(j as f64 / n as f64)) <= 256.0 * EPS);
        }
    }

    #[test]
    fn nlerp_is_fastest_in_the_middle_by_the_known_factor(a in spin(), b in spin(), k in axis()) {
        let theta = angle(a, b);
        prop_assume!((0.3..PI - 0.3).contains(&theta));
        let dt = 1e-5;
        let at = |t| nlerp(a, b, t, k);
        let ratio = angle(at(0.5 - dt / 2.0), at(0.5 + dt / 2.0)) / angle(at(0.0), at(dt));
        let c = libm::cos(0.5 * theta);
        prop_assert!((ratio * c * c - 1.0).abs() < 1e-3, "{ratio}");
        prop_assert!(ratio > 1.02);
    }

    #[test]
    fn the_arc_is_as_long_as_the_angle((a, b) in pair(), k in axis()) {
        let blended = norm(add(a, b)) < 1e-6;
        let tolerance = if blended { 2.1e-6 } else { 4.0 * EPS };
        prop_assert!((Arc::new(a, b, k).angle() - angle(a, b)).abs() <= tolerance);
    }

    #[test]
    fn opposite_spins_turn_right_handed_about_the_axis(a in spin(), k in axis(), t in 0.01..0.99) {
        let p = slerp(a, scale(-1.0, a), t, k);
        let sine = norm(cross(a, k.vector()));
        prop_assume!(sine >= 1e-6);
        let along = dot(cross(a, p), k.vector());
        prop_assert!((along - sine * libm::sin(PI * t)).abs() <= 6.0 * EPS, "{along} {sine}");
    }

    #[test]
    fn exp_undoes_log((a, b) in pair(), k in axis()) {
        let v = log_about(a, b, k);
        prop_assert!(gap(exp(a, v), b) <= 2e-15 + 3.0 * EPS);
        prop_assert!(dot(a, v).abs() <= 4.0 * EPS * norm(v));
        prop_assert!((norm(v) - angle(a, b)).abs() <= 2.0 * PI * EPS);
    }

    #[test]
    fn log_undoes_exp(a in spin(), phi in 0.0..2.0 * PI, length in 0.0..3.0) {
        let (u, w) = tangent_basis(a);
        let v = scale(length, add(scale(libm::cos(phi), u), scale(libm::sin(phi), w)));
        prop_assert!(gap(log(a, exp(a, v)), v) <= 6.0 * EPS * (length / libm::sin(length)).max(1.2));
    }

    #[test]
    fn exp_is_a_unit_vector_for_every_velocity(a in spin(), v in prop::array::uniform3(prop::num::f64::ANY)) {
        prop_assert!(off_unit(exp(a, v)) <= 4.0 * EPS);
    }

    #[test]
    fn transport_keeps_lengths_angles_and_tangency((a, b) in pair(), k in axis()) {
        let (u, w) = tangent_basis(a);
        let (p, q) = (transport_about(a, b, u, k), transport_about(a, b, w, k));
        for wrong in [norm(p) - 1.0, norm(q) - 1.0, dot(p, q), dot(p, b), dot(q, b)] {
            prop_assert!(wrong.abs() <= 8.0 * EPS, "{wrong}");
        }
    }

    #[test]
    fn transport_there_and_back_changes_nothing((a, b) in pair(), k in axis()) {
        let (u, _) = tangent_basis(a);
        let back = transport_about(b, a, transport_about(a, b, u, k), k.reversed());
        prop_assert!(gap(back, u) <= 8.0 * EPS);
    }

    #[test]
    fn transport_is_the_rotation_of_the_arc((a, b) in pair(), k in axis()) {
        let (u, _) = tangent_basis(a);
        let rotated = Quaternion::from_rotation(a, b, k).rotate(u);
        prop_assert!(gap(rotated, transport_about(a, b, u, k)) <= 12.0 * EPS);
    }

    #[test]
    fn a_quaternion_takes_one_spin_to_the_other((a, b) in pair(), k in axis()) {
        let q = Quaternion::from_rotation(a, b, k);
        prop_assert!(gap(q.rotate(a), b) <= 8.0 * EPS);
        prop_assert_eq!(q.rotate(a), q.negated().rotate(a));
    }

    #[test]
    fn rodrigues_is_the_quaternion(v in spin(), k in axis(), phi in -10.0..10.0) {
        let p = rotate(v, k, phi);
        prop_assert!(gap(p, Quaternion::from_axis_angle(k, phi).rotate(v)) <= 10.0 * EPS);
        prop_assert!(off_unit(p) <= 4.0 * EPS);
    }

    #[test]
    fn quaternion_slerp_is_even_and_short(k in axis(), l in axis(), phi in 0.0..6.2, chi in 0.0..6.2, t in 0.0..=1.0) {
        let (p, q) = (Quaternion::from_axis_angle(k, phi), Quaternion::from_axis_angle(l, chi));
        let whole = q.mul(p.conjugate()).angle();
        let part = p.slerp(q, t).mul(p.conjugate()).angle();
        prop_assert!((part - t * whole).abs() <= 10.0 * EPS, "{part} of {whole}");
        let same = p.slerp(q.negated(), t).dot(p.slerp(q, t)).abs();
        prop_assert!((same - 1.0).abs() <= 4.0 * EPS || (whole - PI).abs() < 1e-12);
    }

    #[test]
    fn through_the_blend_the_middle_moves_continuously(a in spin(), k in axis(), phi in -2.8..2.8) {
        let sine = norm(cross(a, k.vector()));
        prop_assume!(sine > 1e-3);
        let m = midpoint(a, scale(-1.0, a), k);
        let sideways = add(scale(libm::cos(phi), m), scale(libm::sin(phi), cross(a, m)));
        let mut before = m;
        for j in 0..=1200 {
            let b = add(scale(-1.0, a), scale(1e-9 * f64::from(j), sideways));
            let now = midpoint(a, unit_or(b, a), k);
            prop_assert!(angle(before, now) <= 0.02 * phi.abs() + 1e-9 / sine, "step {j}");
            before = now;
        }
        prop_assert!((angle(m, before) - phi.abs()).abs() < 2e-6 / sine);
    }

    #[test]
    fn the_filter_keeps_ends_and_unit_length(path in prop::collection::vec(spin(), 0..20), strength in 0.0..=1.0) {
        let smooth = low_pass(&path, strength);
        prop_assert_eq!((smooth.len(), smooth.first(), smooth.last()), (path.len(), path.first(), path.last()));
        for p in smooth {
            prop_assert!(off_unit(p) <= 4.0 * EPS);
        }
    }

    #[test]
    fn waypoints_are_met_and_the_path_is_continuous(path in prop::collection::vec(spin(), 2..8), k in axis()) {
        let way = Waypoints::new(&path, k).expect("two or more points");
        for (i, &p) in path.iter().enumerate() {
            prop_assert_eq!(way.at_leg(i as f64), p);
        }
        prop_assert_eq!((way.at(0.0), way.at(1.0)), (path[0], path[path.len() - 1]));
        for j in 0..200 {
            let (t, next) = (f64::from(j) / 200.0, f64::from(j + 1) / 200.0);
            prop_assert!(off_unit(way.at(t)) <= 4.0 * EPS);
            prop_assert!(angle(way.at(t), way.at(next)) <= way.length() / 200.0 + 40.0 * EPS);
        }
    }
}
