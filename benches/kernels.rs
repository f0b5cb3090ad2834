//! Throughput of the kernels on one thread, beside the memory bandwidth they run against, and the gain of two threads.
//!
//! `cargo bench --bench kernels`. A spin-image evaluation is the energy and the gradient of one spin in one image. Figures are
//! per CPU second (of all threads together), the best of several repetitions; the machine may be shared.

use cpu_time::ProcessTime;
use rayon::prelude::*;
use spinneb::band::{Band, Sweep};
use spinneb::config::load_text;
use spinneb::energy::{Anisotropy, Exchange, Hamiltonian};
use spinneb::geometry::Direction;
use spinneb::lattice::Chain;
use spinneb::optimise::{Implicit, Method};
use spinneb::path::Path;
use spinneb::spins::Spins;
use std::time::{Duration, Instant};

/// The program's own: where arrays lie decides a tenth of what passes.
#[cfg(feature = "mimalloc")]
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

const IMAGES: usize = 18;
const SIZES: [usize; 4] = [100, 1_000, 10_000, 100_000];

fn main() {
    let one = pool(1);
    let bandwidth = one.install(triad_gb_per_s);
    println!("memory bandwidth (triad, one thread): {bandwidth:.1} GB per CPU second");
    println!("million spin-image evaluations per CPU second, {} images between the ends:", IMAGES - 2);
    println!("{:>8} {:>10} {:>8} {:>10} {:>12} {:>8}", "sites", "gradient", "GB/s", "band", "iteration", "GB/s");
    for sites in SIZES {
        let (h, path) = problem(sites);
        let [g, b, i] = one.install(|| [gradient(&h, &path), band(&h, &path), iteration(&h, &path)]);
        println!(
            "{sites:>8} {:>10.1} {:>8.1} {:>10.1} {:>12.1} {:>8.1}",
            g.per_cpu(),
            g.per_cpu() * BYTES * 1e-3,
            b.per_cpu(),
            i.per_cpu(),
            i.per_cpu() * iteration_bytes() * 1e-3
        );
    }
    let two = pool(2);
    lattices(&one, &two);
    println!("wall time of one thread over that of two:");
    for sites in [1_000, 100_000] {
        let (h, path) = problem(sites);
        let [g1, i1] = one.install(|| [gradient(&h, &path), iteration(&h, &path)]);
        let [g2, i2] = two.install(|| [gradient(&h, &path), iteration(&h, &path)]);
        println!(
            "{sites:>8} gradient {:.2}  iteration {:.2}",
            g2.per_wall() / g1.per_wall(),
            i2.per_wall() / i1.per_wall()
        );
    }
}

/// Gradients on films and cubes with exchange, a Dzyaloshinskii–Moriya interaction and an easy axis.
fn lattices(one: &rayon::ThreadPool, two: &rayon::ThreadPool) {
    println!("lattices, and wall time of one thread over that of two:");
    for (kind, cells) in [
        ("square", &[100, 100][..]),
        ("square", &[316, 316]),
        ("triangular", &[100, 100]),
        ("triangular", &[316, 316]),
        ("cubic", &[22, 22, 22]),
        ("cubic", &[46, 46, 46]),
    ] {
        let h = on(kind, cells);
        let image = |k: usize| {
            let vector = |i: usize| {
                let [x, y, z] = h.lattice().place(i);
                let (s, c) = libm::sincos(0.05 * (x + 0.7 * y + 0.3 * z) + 0.1 * k as f64);
                [s, 0.1 * c, c]
            };
            Spins::from_vectors(&(0..h.sites()).map(vector).collect::<Vec<_>>()).expect("unit vectors")
        };
        let path = Path::new(&(0..IMAGES).map(image).collect::<Vec<_>>());
        let [g1, g2] = [one, two].map(|pool| pool.install(|| gradient(&h, &path)));
        println!(
            "{kind:>10} {:>8} gradient {:>7.1} {:>6.1} GB/s {:>6.2}",
            h.sites(),
            g1.per_cpu(),
            g1.per_cpu() * BYTES_OF_A_LATTICE * 1e-3,
            g2.per_wall() / g1.per_wall()
        );
    }
}

fn on(kind: &str, cells: &[usize]) -> Hamiltonian {
    let dmi = if cells.len() == 2 { "interfacial" } else { "bulk" };
    let text = format!(
        r#"{{"material": {{"name": "lattice", "moment": "1 mu_B", "energy": [{{"exchange": {{"J": ["1 meV"]}}}},
            {{"dmi": {{"D": "0.2 meV", "kind": "{dmi}"}}}}, {{"anisotropy": {{"K": "0.1 meV", "axis": [0, 0, 1]}}}}]}},
            "lattice": {{"{kind}": {{"cells": {cells:?}}}}},
            "initial": {{"uniform": {{"direction": [0, 0, 1]}}}}, "final": {{"uniform": {{"direction": [0, 0, -1]}}}}}}"#
    );
    let problem = load_text("lattice.json".as_ref(), text).and_then(|loaded| loaded.problem());
    problem.expect("a problem").hamiltonian
}

/// Numbers that must pass for one spin of a lattice: m read, g written, K read.
const BYTES_OF_A_LATTICE: f64 = 8.0 * (3.0 + 3.0 + 1.0);

/// Numbers that must pass for one spin of one image: m read, g written, the coefficients read (J, K, K₂), 8 bytes each.
const BYTES: f64 = 8.0 * (3.0 + 3.0 + 3.0);

/// Numbers that pass for one spin of one image in a whole iteration, read and written, one symmetry axis: every pass over an
/// array counts once, what stays in the first two caches between two passes over a row does not.
const ITERATION: [(&str, f64); 11] = [
    ("energy and gradient", 9.0),
    ("tangent, force across, spacing: two passes", 30.0),
    ("tangent bases, tangent and rotation in them, Hessian", 34.0),
    ("the two made orthonormal, and copied", 12.0),
    ("elimination with the forward substitution of the two", 24.0),
    ("their backward substitution", 16.0),
    ("their products", 8.0),
    ("right-hand side and its products with the two", 18.0),
    ("its two substitutions", 24.0),
    ("without the part along the border, as a field", 17.0),
    ("the move", 12.0),
];

fn iteration_bytes() -> f64 {
    8.0 * ITERATION.iter().map(|(_, numbers)| numbers).sum::<f64>()
}

fn pool(threads: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads to measure with")
}

/// The chain of the shipped wall nucleation, refined to `sites`, with a wall on its way through.
fn problem(sites: usize) -> (Hamiltonian, Path) {
    let chain = Chain::open(sites).resolve().expect("a chain");
    let ratio = 50.0 / sites as f64;
    let exchange = Exchange::uniform(&chain, &[10.0]);
    let easy_axis = Anisotropy::uniform(sites, 0.5 * ratio * ratio, Direction::Z);
    let h = Hamiltonian::new(&chain, vec![Box::new(exchange), Box::new(easy_axis)]).expect("a chain");
    let width = 4.0 * sites as f64 / 50.0 * 3.2;
    let image = |k: usize| {
        let front = -width + (sites as f64 + 2.0 * width) * k as f64 / (IMAGES - 1) as f64;
        let angle = |i: usize| std::f64::consts::PI * ((front - i as f64) / width + 0.5).clamp(0.0, 1.0);
        let mut m = vec![0.0; 3 * sites];
        for i in 0..sites {
            let (s, c) = libm::sincos(angle(i));
            let (sp, cp) = libm::sincos(0.05 * libm::sin(3.0 * i as f64 / width));
            (m[i], m[sites + i], m[2 * sites + i]) = (s * cp, s * sp, c);
        }
        Spins::from_components(&m).expect("unit vectors")
    };
    (h, Path::new(&(0..IMAGES).map(image).collect::<Vec<_>>()))
}

/// Work done in a time.
struct Figure {
    spins: f64,
    cpu: Duration,
    wall: Duration,
}

impl Figure {
    fn per_cpu(&self) -> f64 {
        self.spins / self.cpu.as_secs_f64() * 1e-6
    }

    fn per_wall(&self) -> f64 {
        self.spins / self.wall.as_secs_f64() * 1e-6
    }
}

/// The best of seven repetitions of at least 0.1 s.
fn measure(spins: usize, mut work: impl FnMut()) -> Figure {
    work();
    let run = |work: &mut dyn FnMut()| {
        let (cpu, wall) = (ProcessTime::now(), Instant::now());
        let mut times = 0;
        while wall.elapsed() < Duration::from_millis(100) {
            work();
            times += 1;
        }
        Figure { spins: (times * spins) as f64, cpu: cpu.elapsed(), wall: wall.elapsed() }
    };
    let figures: Vec<Figure> = (0..7).map(|_| run(&mut work)).collect();
    figures.into_iter().max_by(|a, b| a.per_wall().total_cmp(&b.per_wall())).expect("seven of them")
}

/// Energy and gradient of all images between the ends.
fn gradient(h: &Hamiltonian, path: &Path) -> Figure {
    let slab = 3 * path.sites();
    let mut g = vec![0.0; (IMAGES - 2) * slab];
    measure((IMAGES - 2) * path.sites(), || {
        let energy: Vec<f64> =
            g.par_chunks_mut(slab).enumerate().map(|(k, g)| h.energy_gradient(path.image(k + 1), g)).collect();
        assert!(energy.iter().all(|e| e.is_finite()));
    })
}

/// The evaluation of a band: energies, gradients, tangents, forces across the path, distances.
fn band(h: &Hamiltonian, path: &Path) -> Figure {
    let mut band = Band::new(h, path.clone());
    measure((IMAGES - 2) * path.sites(), || band.evaluate())
}

/// A whole implicit iteration: evaluation, Hessians, factorisations, the sweep and the move.
fn iteration(h: &Hamiltonian, path: &Path) -> Figure {
    let (sites, c) = (path.sites(), 2.0 * 0.5 * (50.0 / path.sites() as f64).powi(2));
    let mut band = Band::new(h, path.clone());
    let mut sweep = Sweep::new(c);
    let mut optimiser = Implicit {}.start(h.stiffness_mev());
    let mut moves = vec![0.0; (IMAGES - 2) * 3 * sites];
    measure((IMAGES - 2) * sites, || {
        band.evaluate();
        let step = sweep.step(&band, &[[0.0, 0.0, 1.0]], &mut moves);
        assert!(step.rotation.is_finite());
        optimiser.advance(band.inner_mut(), 3 * sites, &moves);
    })
}

/// a ← b + s c over 3 × 64 MiB: bytes read and written per CPU second.
fn triad_gb_per_s() -> f64 {
    const LENGTH: usize = 8 << 20;
    let (mut a, b, c) = (vec![0.0; LENGTH], vec![1.0; LENGTH], vec![2.0; LENGTH]);
    let figure = measure(LENGTH, || {
        for ((a, b), c) in a.iter_mut().zip(&b).zip(&c) {
            *a = b + 3.0 * c;
        }
        assert!(std::hint::black_box(&a)[LENGTH / 2] == 7.0);
    });
    figure.per_cpu() * 24e-3
}
