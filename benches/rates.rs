//! Rates of long chains after the saddle is known: time by number of spins, which must grow no faster.
//!
//! `cargo bench --bench rates`. The chain of the shipped wall nucleation with a hard axis, refined to N sites; its saddle is the wall
//! at the centre, and the minima are the two uniform states.

use spinneb::energy::{Anisotropy, EnergyTerm, Exchange, Hamiltonian};
use spinneb::geometry::Direction;
use spinneb::landscape::Minimum;
use spinneb::lattice::Chain;
use spinneb::rates::{Crossing, RateSettings, Symmetry, Theory, saddle_rates};
use spinneb::spins::Spins;
use spinneb::stationary::{Spectrum, refine};
use spinneb::symmetry::Group;
use std::time::Instant;

fn main() {
    println!("{:>8} {:>12} {:>12} {:>16} {:>16}", "sites", "saddle (s)", "rates (s)", "HTST (Hz)", "Langer (Hz)");
    for sites in [1_000, 10_000, 100_000] {
        measure(sites);
    }
}

fn measure(sites: usize) {
    let chain = Chain::open(sites).resolve().expect("a chain");
    let (j, k) = (10.0, 0.5 * (50.0 / sites as f64).powi(2));
    let terms: Vec<Box<dyn EnergyTerm>> = vec![
        Box::new(Exchange::uniform(&chain, &[j])),
        Box::new(Anisotropy::uniform(sites, k, Direction::Z)),
        Box::new(Anisotropy::uniform(sites, -k, Direction::X)),
    ];
    let h = Hamiltonian::new(&chain, terms).expect("a chain");
    let width = (j / (2.0 * k)).sqrt();
    let u = |i: usize| (i as f64 - 0.5 * (sites as f64 - 1.0)) / width;
    let mut m = vec![0.0; 3 * sites];
    let mut along = vec![0.0; 3 * sites];
    for i in 0..sites {
        let (t, s) = (libm::tanh(u(i)), 1.0 / libm::cosh(u(i)));
        (m[sites + i], m[2 * sites + i]) = (s, -t);
        (along[sites + i], along[2 * sites + i]) = (s * t, s * s);
    }
    let start = Instant::now();
    let saddle = refine((&h).into(), &m, &along, f64::NEG_INFINITY);
    let spectrum = Spectrum::of((&h).into(), &saddle.state, 6);
    let minima = [Direction::Z, Direction::Z.reversed()].map(|d| Spins::uniform(sites, d));
    let spectra = [0, 1].map(|side| Minimum::examine((&h).into(), &minima[side]).spectrum);
    let before = start.elapsed().as_secs_f64();
    let settings = RateSettings {
        temperatures_k: (1..=100).map(|t| 3.0 * f64::from(t)).collect(),
        damping: 0.1,
        g_factor: 2.0,
        theories: Theory::ALL.to_vec(),
        moments_mub: vec![2.0; sites],
    };
    let start = Instant::now();
    let crossing = Crossing {
        saddle: &saddle.state,
        valley: &saddle.valley,
        spectrum: &spectrum,
        minima: [&minima[0], &minima[1]],
        minima_spectra: [&spectra[0], &spectra[1]],
        symmetry: &Symmetry::exactly(&Group::of(&h, minima[0].as_slice(), &settings.moments_mub)),
        doubt: None,
    };
    let [forward, _] = saddle_rates((&h).into(), 0, &crossing, &settings);
    let seconds = start.elapsed().as_secs_f64();
    let made = forward.at(3.0);
    let hz = |p: Option<spinneb::rates::Prefactor>| p.map_or(f64::NAN, |p| p.hz_at(3.0));
    println!("{sites:>8} {before:>12.3} {seconds:>12.3} {:>16.6e} {:>16.6e}", hz(made.htst), hz(made.langer));
    assert!(made.refused.is_empty(), "{:?}", made.refused);
    assert!(seconds < 2.0 || sites < 100_000, "rates of {sites} sites took {seconds:.2} s");
}
