//! What a barrier costs on ever finer lattices: K = 0.05 (50/N)² J, the same wall on N spins, nucleated at an end of the chain.
//!
//! `cargo bench --bench refinement` runs N = 50 … 102,400; `cargo bench --bench refinement -- 1000000` the sizes that are
//! given. Everything is a default but the guess (a wall enters from the left; where one is named, no lower pass is looked for) and
//! the number of images (17). Band evaluations count all levels; solves are the factorisations of the saddle's refinement; the error is against a Newton's
//! method of this file, in one angle a spin, that shares nothing with the library.
//! Times are those of the quickest of up to 99 runs, on one thread and on all cores, taken in three rounds over all sizes, so that
//! a busy spell of the machine does not meet one size alone.

use spinneb::band::Band;
use spinneb::control::Control;
use spinneb::drive::{Images, Outcome, Problem, Silent, run};
use spinneb::energy::{Anisotropy, Evaluator, Exchange, Hamiltonian};
use spinneb::geometry::Direction;
use spinneb::landscape::{Effort, peaks};
use spinneb::lattice::Chain;
use spinneb::path::guess::{Edge, GuessSpec, Sweep};
use spinneb::spins::Spins;
use spinneb::stationary::refine;

#[path = "shared/memory.rs"]
mod memory;
use memory::peak_gb;

/// The allocator of the binary.
#[cfg(feature = "mimalloc")]
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// Exchange (meV).
const J: f64 = 10.0;
const IMAGES: usize = 17;
const ROUNDS: usize = 3;

fn main() {
    let given: Vec<usize> = std::env::args().filter_map(|a| a.parse().ok()).collect();
    let sizes = if given.is_empty() { (0..12).map(|k| 50 << k).collect() } else { given };
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread to measure with");
    println!(
        "{:>8} {:>5} {:>7} {:>20} {:>9} {:>9} {:>10}",
        "sites", "evals", "solves", "barrier_meV", "error", "certified", "lowest/c"
    );
    let mut series: Vec<Size> = sizes.into_iter().map(Size::new).collect();
    series.iter_mut().for_each(|size| size.seconds[1] = size.first_run());
    for round in 0..ROUNDS {
        for size in &mut series {
            for _ in 0..size.repetitions(round) {
                size.seconds[0] = size.seconds[0].min(one.install(|| size.run().work.seconds));
                size.seconds[1] = size.seconds[1].min(size.run().work.seconds);
            }
        }
    }
    println!("{:>8} {:>14} {:>13}", "sites", "µs/spin: one", "all threads");
    for size in &series {
        let [one, all] = size.microseconds_per_spin();
        println!("{:>8} {one:>14.2} {all:>13.2}", size.sites);
    }
    let extremes = |k: usize| {
        let all = series.iter().map(|size| size.microseconds_per_spin()[k]);
        all.fold((f64::INFINITY, 0.0f64), |(least, most), t| (least.min(t), most.max(t)))
    };
    let [one, all] = [0, 1].map(extremes).map(|(least, most)| most / least);
    println!("slowest over quickest: one thread {one:.2}, all threads {all:.2}");
    println!("most memory held: {}", peak_gb().map_or("unknown".into(), |gb| format!("{gb:.2} GB")));
}

/// One member of the series.
struct Size {
    sites: usize,
    problem: Problem,
    /// The quickest run so far, on one thread and on all.
    seconds: [f64; 2],
}

impl Size {
    fn new(sites: usize) -> Size {
        Size { sites, problem: problem(sites), seconds: [f64::INFINITY; 2] }
    }

    fn run(&self) -> Outcome {
        run(&self.problem, &mut Silent).expect("a valid problem")
    }

    /// Runs it and tells what came out; the run's time (s).
    fn first_run(&self) -> f64 {
        let (sites, outcome) = (self.sites, self.run());
        let barrier = outcome.barrier.map_or(f64::NAN, |b| b.forward_mev);
        let soft = outcome.saddles.first().and_then(|s| s.lowest_eigenvalues_mev.first()).map_or(f64::NAN, |l| *l);
        println!(
            "{sites:>8} {:>5} {:>7} {barrier:>20.15} {:>9.1e} {:>9} {:>10.1e}",
            outcome.history.len(),
            saddle_solves(&self.problem, &outcome),
            (barrier / wall_energy(sites) - 1.0).abs(),
            outcome.certified,
            soft / (2.0 * anisotropy(sites)),
        );
        for warning in &outcome.warnings {
            println!("{:>8} {warning}", "");
        }
        outcome.work.seconds
    }

    /// How often it is run in a round: up to 33 times if it is short, in one round only if it is long.
    fn repetitions(&self, round: usize) -> usize {
        match 1_000_000 / ROUNDS / self.sites {
            0 => usize::from(round == 0),
            n => n.min(33),
        }
    }

    fn microseconds_per_spin(&self) -> [f64; 2] {
        self.seconds.map(|s| 1e6 * s / self.sites as f64)
    }
}

/// K (meV): walls are √10 sites wide on 50 sites, and as wide in comparison on any other number.
fn anisotropy(sites: usize) -> f64 {
    0.05 * J * (50.0 / sites as f64).powi(2)
}

fn problem(sites: usize) -> Problem {
    let chain = Chain::open(sites).resolve().expect("a chain");
    let terms: Vec<Box<dyn spinneb::energy::EnergyTerm>> = vec![
        Box::new(Exchange::uniform(&chain, &[J])),
        Box::new(Anisotropy::uniform(sites, anisotropy(sites), Direction::Z)),
    ];
    let h = Hamiltonian::new(&chain, terms).expect("a valid chain");
    let [up, down] = [Direction::Z, Direction::Z.reversed()].map(|d| Spins::uniform(sites, d));
    let mut problem = Problem::new(h, up, down);
    problem.guess = Some(GuessSpec::Sweep(Sweep::from(Edge::Left)));
    problem.images = Images::Count(IMAGES);
    // as the program does where a guess is named
    problem.search = Effort::None;
    problem
}

/// Factorisations that the refinement takes from the relaxed band's top.
fn saddle_solves(problem: &Problem, outcome: &Outcome) -> usize {
    let mut band = Band::new(&problem.hamiltonian, outcome.path.clone());
    band.evaluate();
    let c = 2.0 * anisotropy(outcome.path.sites());
    let top = peaks(&band, c).into_iter().next();
    let control = Control::default();
    let h = Evaluator::new(&problem.hamiltonian, &control);
    top.map(|top| refine(h, &top.m, &top.tau, top.floor_mev));
    control.evaluated().hessians
}

/// Energy (meV) of the wall in the middle of the chain above the uniform state, by Newton's method on its angles:
/// E = Σ 2J sin² ½(θ_{i+1} − θ_i) + Σ K sin² θ_i, tridiagonal, started from the continuum's wall.
fn wall_energy(sites: usize) -> f64 {
    let k = anisotropy(sites);
    let width = (J / (2.0 * k)).sqrt();
    let middle = 0.5 * (sites as f64 - 1.0);
    let mut theta: Vec<f64> = (0..sites).map(|i| 2.0 * ((i as f64 - middle) / width).exp().atan()).collect();
    for _ in 0..12 {
        let (mut slope, mut diagonal, mut beside) = (vec![0.0; sites], vec![0.0; sites], vec![0.0; sites]);
        for i in 0..sites {
            slope[i] += k * (2.0 * theta[i]).sin();
            diagonal[i] += 2.0 * k * (2.0 * theta[i]).cos();
            if i + 1 < sites {
                let step = theta[i + 1] - theta[i];
                slope[i] -= J * step.sin();
                slope[i + 1] += J * step.sin();
                diagonal[i] += J * step.cos();
                diagonal[i + 1] += J * step.cos();
                beside[i] = -J * step.cos();
            }
        }
        // the step keeps the wall antisymmetric about the middle, so that it stays on the saddle
        let mut step = tridiagonal(&diagonal, &beside, &slope);
        for i in 0..sites / 2 {
            let even = 0.5 * (step[i] + step[sites - 1 - i]);
            step[i] -= even;
            step[sites - 1 - i] -= even;
        }
        theta.iter_mut().zip(&step).for_each(|(t, s)| *t -= s);
    }
    let site = |i: usize| {
        let bond = if i + 1 < sites { 2.0 * J * (0.5 * (theta[i + 1] - theta[i])).sin().powi(2) } else { 0.0 };
        bond + k * theta[i].sin().powi(2)
    };
    compensated((0..sites).map(site))
}

fn tridiagonal(diagonal: &[f64], beside: &[f64], rhs: &[f64]) -> Vec<f64> {
    let n = diagonal.len();
    let (mut d, mut x) = (diagonal.to_vec(), rhs.to_vec());
    for i in 1..n {
        let l = beside[i - 1] / d[i - 1];
        d[i] -= l * beside[i - 1];
        x[i] -= l * x[i - 1];
    }
    for i in (0..n).rev() {
        let next = if i + 1 < n { beside[i] * x[i + 1] } else { 0.0 };
        x[i] = (x[i] - next) / d[i];
    }
    x
}

/// Kahan's sum.
fn compensated(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut lost) = (0.0, 0.0);
    for v in values {
        let y = v - lost;
        let next = sum + y;
        lost = (next - sum) - y;
        sum = next;
    }
    sum
}
