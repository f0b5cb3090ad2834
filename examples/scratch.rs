use rand::{RngExt, SeedableRng};
use spinneb::{
    drive::*, energy::*, geometry::Direction, lattice::Chain, optimise::*, path::guess::*, spins::Spins, units::Angle,
};
pub struct Case {
    pub chain: Chain,
    pub terms: Vec<Box<dyn EnergyTerm>>,
    pub afm: bool,
    pub k: f64,
}
fn case(name: &str, n: usize) -> Case {
    let k = 0.05 * (50.0 / n as f64).powi(2);
    let ring = name.starts_with("ring");
    let chain = if ring { Chain::ring(n) } else { Chain::open(n) };
    let mut t: Vec<Box<dyn EnergyTerm>> = vec![];
    let afm = name.starts_with("afm");
    let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(7);
    let z = Direction::Z;
    let mut j = Exchange::uniform(
        &chain,
        &if afm {
            vec![-1.0]
        } else if name == "j1j2" {
            vec![1.0, -0.2]
        } else {
            vec![1.0]
        },
    );
    let mut a = Anisotropy::uniform(n, k, z);
    if name == "randJK" {
        for i in 0..n {
            if j.shells[0][i] != 0.0 {
                j.shells[0][i] = r.random_range(0.3..1.7);
            }
            a.k[i] = k * r.random_range(-0.2..2.2);
        }
    }
    t.push(Box::new(j));
    t.push(Box::new(a));
    if name == "kp4" {
        t.push(Box::new(Anisotropy::uniform(n, -4.0 * k, Direction::X)));
    }
    if name == "b0.5" {
        t.push(Box::new(Zeeman::uniform(n, [0., 0., -0.5 * 2.0 * k])));
    }
    if name == "b0.9" {
        t.push(Box::new(Zeeman::uniform(n, [0., 0., -0.9 * 2.0 * k])));
    }
    if name == "afmb" {
        t.push(Box::new(Zeeman::uniform(n, [0., 0., 0.3 * (8.0 * k).sqrt()])));
    }
    if name == "ringb" {
        t.push(Box::new(Zeeman::uniform(n, [0., 0., -0.3 * 2.0 * k])));
    }
    if name == "dmi.9" {
        t.push(Box::new(Dmi::uniform(&chain, 0.9 * 4.0 / std::f64::consts::PI * (2.0 * k).sqrt() / 2.0, Direction::Y)));
    }
    Case { chain, terms: t, afm, k }
}
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let names: Vec<&str> = if args.len() > 1 && args[1] != "all" {
        args[1].split(',').collect()
    } else {
        vec!["plain", "kp4", "b0.5", "b0.9", "j1j2", "afmb", "dmi.9", "randJK", "ringb"]
    };
    let images: usize = args.get(2).map_or(17, |s| s.parse().unwrap());
    let opt = args.get(3).map_or("{\"implicit\":{}}".to_string(), |s| s.clone());
    let ns: Vec<usize> = args.get(4).map_or(vec![50, 200, 800], |s| s.split(',').map(|x| x.parse().unwrap()).collect());
    for name in names {
        for &n in &ns {
            let c = case(name, n);
            let up = |s: f64| {
                Spins::from_vectors(
                    &(0..n).map(|i| [0., 0., if c.afm && i % 2 == 1 { -s } else { s }]).collect::<Vec<_>>(),
                )
                .unwrap()
            };
            let h = Hamiltonian::new(&c.chain, c.terms).unwrap();
            let mut p = Problem::new(c.chain.clone(), h, up(1.), up(-1.));
            if images > 0 {
                p.images = Images::Count(images);
                p.guess = Some(GuessSpec::Sweep(Sweep {
                    from: if name.starts_with("ring") { Edge::Center } else { Edge::Left },
                    width: None,
                    axis: None,
                }));
                p.noise = Some(NoiseSpec { amplitude: Angle(2f64.to_radians()), seed: 1 });
            }
            p.neb.tolerance = args.get(5).map_or(1e-5, |s| s.parse().unwrap());
            p.neb.climb = args.get(6).map_or(true, |s| s == "climb");
            p.neb.optimiser = serde_json::from_str(&opt).unwrap();
            p.neb.max_evaluations = args.get(7).map_or(2000, |s| s.parse().unwrap());
            let t = std::time::Instant::now();
            let o = run(&p, &mut Silent).unwrap();
            println!(
                "{name} N={n} conv={} ev={} imgev={} barrier={:.12} E/√(JK)={:.8} levels={:?} t={:.3} {}",
                o.converged,
                o.work.iterations,
                o.work.force_evaluations,
                o.barrier.unwrap().forward_mev,
                o.barrier.unwrap().forward_mev / c.k.sqrt(),
                {
                    let mut v: Vec<(usize, usize)> = vec![];
                    for r in &o.history {
                        if v.last().is_some_and(|l| l.0 == r.images) {
                            v.last_mut().unwrap().1 += 1;
                        } else {
                            v.push((r.images, 1));
                        }
                    }
                    v
                },
                t.elapsed().as_secs_f64(),
                if o.converged { String::new() } else { o.stop_reason.clone() }
            );
            if std::env::var("V").is_ok() {
                for r in &o.history {
                    println!(
                        "   {} n={} F={:.2e} rot={:.2e} E={:.10} L={:.3}",
                        r.iteration,
                        r.images,
                        r.max_perpendicular_torque_mev / (2.0 * c.k),
                        r.largest_predicted_rotation_rad,
                        r.highest_image_mev,
                        r.length_rad
                    );
                }
                println!("{:?} {:?}", o.warnings, o.rejected_paths);
            }
        }
    }
}
