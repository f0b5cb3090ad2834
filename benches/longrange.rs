//! What magnetostatics cost: the gradient beside that of short-ranged terms, a factorised Hessian and a product with it.
//!
//! `cargo bench --bench longrange`. One thread, CPU time, the best of several repetitions.

use cpu_time::ProcessTime;
use spinneb::energy::magnetostatics::{Convolution, Kernel, Shape};
use spinneb::energy::{EnergyTerm, Hamiltonian, Medium, TermSpec};
use spinneb::geometry::Direction;
use spinneb::hessian::{TangentBasis, assemble};
use spinneb::lattice::Chain;
use spinneb::spins::Spins;
use spinneb::units::{Length, Magnetisation};
use std::time::{Duration, Instant};

fn main() {
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread to measure with");
    one.install(|| {
        convolutions();
        gradients();
    });
}

/// Where transforms become quicker than direct sums.
fn convolutions() {
    println!("one component of a convolution, µs:");
    println!("{:>8} {:>10} {:>12}", "sites", "direct", "transforms");
    for sites in [16, 32, 48, 64, 96, 128, 256, 300, 512, 1024] {
        let convolution = Convolution::new(&Kernel::new(Shape::Dipoles, sites, false));
        let (x, mut y) = (vec![1.0; sites], vec![0.0; sites]);
        let direct = seconds(|| convolution.direct(0, &x, &mut y));
        let fast = seconds(|| convolution.transformed(0, &x, &mut y));
        println!("{sites:>8} {:>10.2} {:>12.2}", 1e6 * direct, 1e6 * fast);
    }
}

fn gradients() {
    println!("energy and gradient of one image, one factorised Hessian, and one product with it:");
    println!(
        "{:>8} {:>14} {:>14} {:>8} {:>16} {:>14}",
        "sites", "short (µs)", "with demag", "ratio", "Hessian (ms)", "product (µs)"
    );
    for sites in [100, 1000, 4096, 16_384, 100_000] {
        let short = hamiltonian(sites, &[EXCHANGE, ANISOTROPY]);
        let all = hamiltonian(sites, &[EXCHANGE, ANISOTROPY, r#"{"demag": {}}"#]);
        let m = Spins::uniform(sites, Direction::new([0.6, 0.48, 0.64]).expect("a direction"));
        let mut g = vec![0.0; 3 * sites];
        let a = seconds(|| assert!(short.energy_gradient(m.as_slice(), &mut g).is_finite()));
        let b = seconds(|| assert!(all.energy_gradient(m.as_slice(), &mut g).is_finite()));
        let basis = TangentBasis::at(m.as_slice());
        let factorised = seconds(|| {
            let _ = std::hint::black_box(assemble(&all, m.as_slice(), &g, &basis).factor());
        });
        let (v, mut image) = (m.as_slice().to_vec(), vec![0.0; 3 * sites]);
        let product = seconds(|| all.hessian_product(m.as_slice(), &g, &v, &mut image));
        println!(
            "{sites:>8} {:>14.2} {:>14.2} {:>8.1} {:>16.2} {:>14.2}",
            1e6 * a,
            1e6 * b,
            b / a,
            1e3 * factorised,
            1e6 * product
        );
    }
}

const EXCHANGE: &str = r#"{"exchange": {"A": "13 pJ/m"}}"#;
const ANISOTROPY: &str = r#"{"anisotropy": {"K": "10 kJ/m^3", "axis": [1, 0, 0]}}"#;

fn hamiltonian(sites: usize, terms: &[&str]) -> Hamiltonian {
    let edges = Some([Length(20.0), Length(5.0)].map(Into::into));
    let chain = Chain { spacing: Some(Length(5.0)), cross_section: edges, ..Chain::open(sites) };
    let chain = chain.resolve().expect("a chain");
    let medium = Medium::new(&chain, None, Some(Magnetisation(8e5).into()));
    let build = |text: &&str| -> Box<dyn EnergyTerm> {
        let spec: TermSpec = serde_json::from_str(text).expect("a term");
        spec.member().build(&medium).expect("a term")
    };
    Hamiltonian::new(&chain, terms.iter().map(build).collect()).expect("a chain")
}

/// CPU seconds of one call, the best of five repetitions of at least 0.05 s.
fn seconds(mut work: impl FnMut()) -> f64 {
    work();
    let run = |work: &mut dyn FnMut()| {
        let (cpu, wall) = (ProcessTime::now(), Instant::now());
        let mut times = 0;
        while wall.elapsed() < Duration::from_millis(50) {
            work();
            times += 1;
        }
        cpu.elapsed().as_secs_f64() / f64::from(times)
    };
    (0..5).map(|_| run(&mut work)).fold(f64::INFINITY, f64::min)
}
