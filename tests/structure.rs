//! Paths with several saddles, long paths, and other chains that ask much of the driver.

mod common;

use common::{Build, forward, solve};
use spinneb::drive::Outcome;
use spinneb::energy::Exchange;
use spinneb::geometry::Direction;
use spinneb::lattice::Chain;
use spinneb::spins::Spins;

fn told(what: &str, o: &Outcome) {
    println!(
        "{what}: {:?} certified {} {} saddles {} images {} evals {:.2} s largest {:.2} {:?}",
        o.barrier.map(|b| b.forward_mev),
        o.certified,
        o.saddles.len(),
        o.path.images(),
        o.work.force_evaluations,
        o.work.seconds,
        o.path.largest_rotation(),
        o.warnings.iter().take(4).collect::<Vec<_>>()
    );
    println!(
        "    heights {:?}",
        o.saddles.iter().map(|s| (s.above_initial_mev * 1e6).round() / 1e6).collect::<Vec<_>>()
    );
    for r in &o.rejected_paths {
        println!("    rejected {r:?}");
    }
}

#[test]
fn a500() {
    let o = solve(&Build::open(500).easy(0.05).reversal());
    told("N=500 K=0.05", &o);
}

#[test]
fn b_defects() {
    let (k, w) = (0.05, 10f64.sqrt());
    let chain = Build::between_walls(120).easy(k).defect(40, -0.02).defect(60, 0.03).defect(80, -0.015);
    let (a, b) = (chain.wall(40.0, w, Direction::X), chain.wall(80.0, w, Direction::X));
    told("defects", &solve(&chain.problem(a, b)));
    let chain = Build::open(150).easy(k).defect(30, -0.02).defect(75, 0.04).defect(100, -0.03);
    told("defects reversal", &solve(&chain.reversal()));
}

#[test]
fn c_j2() {
    for n in [50, 100, 200] {
        let chain = Chain::open(n);
        let mut build = Build::on(chain);
        build.terms[0] = Box::new(Exchange::uniform(&build.chain, &[1.0, -0.2]));
        told(&format!("J2 {n}"), &solve(&build.easy(0.05).reversal()));
    }
}

#[test]
fn d_rings() {
    for d in [0.1, -0.1, 0.3, -0.3] {
        for axis in [Direction::Y, Direction::Z] {
            told(&format!("ring D {d} {axis:?}"), &solve(&Build::ring(30).easy(0.2).dmi(d, axis).reversal()));
        }
    }
}

#[test]
fn e_peierls() {
    for k in [0.5, 0.8, 1.0, 1.5] {
        let build = Build::open(60).easy(k);
        let w = (0.5 / k).sqrt();
        let (a, b) = (build.wall(20.5, w, Direction::X), build.wall(32.5, w, Direction::X));
        told(&format!("peierls {k}"), &solve(&build.problem(a, b)));
    }
}

#[test]
fn f_peierls_reversal() {
    for k in [1.0] {
        told(&format!("reversal {k}"), &solve(&Build::open(60).easy(k).reversal()));
        told(&format!("ring {k}"), &solve(&Build::ring(40).easy(k).reversal()));
    }
}

#[test]
fn g_edge() {
    for n in [2usize, 3, 4] {
        let f = [0.0, 0.02, -0.03];
        told(&format!("tiny {n}"), &solve(&Build::open(n).easy(0.5).field(f).reversal()));
    }
    let _ = (Spins::uniform(1, Direction::Z), forward);
}
