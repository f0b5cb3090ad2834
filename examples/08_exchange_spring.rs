//! What a soft end is worth: a grain of hard magnet that is written at a lower field and is as stable as before.
//!
//! L1₀ FePt of the library (Ms, A, K), cells of 0.25 nm, without magnetostatics, as in the theories compared with. The figure of
//! merit is that of Victora and Shen,
//!
//! ```text
//! ξ = 2 E_b/(μ B_s)          E_b: barrier without a field;  μ: moment of the grain;  B_s: field along the axis that reverses it
//! ```
//! Published: 1 for a grain that turns as a whole (Stoner–Wohlfarth), 2 for the best composite of two coupled spins, at most 4 for
//! any profile, which K growing as the square of the depth comes very close to (Domain wall switching: optimizing the energy
//! landscape, arXiv:0704.0913; the figures are those of its abstract). And a wall passes from a soft half (K = 0) into a hard one
//! at a quarter of the field of the hard one's anisotropy, B_s = ¼ · 2K/Ms, if both are thick (H. Kronmüller, D. Goll, Physica B
//! 319, 122 (2002), doi:10.1016/S0921-4526(02)01113-4, with equal A and Ms). B_s is found by raising the field in small steps and
//! relaxing the grain in each; every E_b is certified.
//!
//! ```text
//! cargo run --release --example 08_exchange_spring
//! ```
//! writes a table and a figure to `results/gallery/08_exchange_spring/`.

use anyhow::{Context, Result, ensure};
use rayon::prelude::*;
use spinneb::config::library;
use spinneb::drive::{Problem, Silent, run};
use spinneb::energy::{Anisotropy, EnergyTerm, Exchange, Hamiltonian, Zeeman};
use spinneb::geometry::Direction;
use spinneb::lattice::Chain;
use spinneb::output::canvas::{BLACK, BLUE, LinePlot, Marker, Series, VERMILLION};
use spinneb::spins::Spins;
use spinneb::stationary::relax_to_minimum;
use spinneb::units::{Energy, EnergyDensity, ExchangeStiffness, MU_B_MEV_PER_T, Magnetisation};
use std::fmt::Write;

const CELL_NM: f64 = 0.25;
/// Length of the side of a grain (nm); neither ξ nor fields depend on it.
const SIDE_NM: f64 = 4.0;
const LENGTHS_NM: [f64; 9] = [2.0, 3.0, 5.0, 8.0, 12.0, 18.0, 27.0, 40.0, 60.0];
const FOLDER: &str = "results/gallery/08_exchange_spring";

/// A grain as a chain of cells.
#[derive(Clone, Debug)]
struct Grain {
    /// Exchange of all bonds (meV).
    exchange_mev: f64,
    /// Anisotropy of every cell (meV).
    anisotropy_mev: Vec<f64>,
    /// Moment of every cell (meV/T).
    moment_mev_per_t: Vec<f64>,
}

/// What a grain does.
#[derive(Clone, Copy, Debug)]
struct Found {
    barrier_mev: f64,
    switching_t: f64,
    merit: f64,
}

impl Grain {
    /// Of the library's FePt, with the anisotropy at the relative depth t times `profile(t)`.
    fn of_fept(length_nm: f64, profile: impl Fn(f64) -> f64) -> Result<Grain> {
        let (ms, a, k) = fept()?;
        let sites = (length_nm / CELL_NM).round() as usize;
        let section = SIDE_NM * SIDE_NM;
        let volume = section * CELL_NM;
        let depth = |i: usize| (i as f64 + 0.5) / sites as f64;
        Ok(Grain {
            exchange_mev: 2.0 * a.over_length(section / CELL_NM).0,
            anisotropy_mev: (0..sites).map(|i| k.in_volume(volume).0 * profile(depth(i))).collect(),
            moment_mev_per_t: vec![ms.in_volume(volume).0 * MU_B_MEV_PER_T; sites],
        })
    }

    fn in_field(&self, b_t: f64) -> Result<Hamiltonian> {
        let chain = Chain::open(self.anisotropy_mev.len()).resolve()?;
        let exchange = Exchange::uniform(&chain, &[self.exchange_mev]);
        let easy = Anisotropy { axis: [0.0, 0.0, 1.0], k: self.anisotropy_mev.clone(), k2: Vec::new() };
        let b = self.moment_mev_per_t.iter().map(|m| b_t * m).collect();
        let field = Zeeman { direction: [0.0, 0.0, -1.0], b };
        let terms: Vec<Box<dyn EnergyTerm>> = vec![Box::new(exchange), Box::new(easy), Box::new(field)];
        Ok(Hamiltonian::new(&chain, terms)?)
    }

    /// The certified barrier without a field (meV).
    fn barrier_mev(&self) -> Result<f64> {
        let sites = self.anisotropy_mev.len();
        let [up, down] = [Direction::Z, Direction::Z.reversed()].map(|d| Spins::uniform(sites, d));
        let outcome = run(&Problem::new(self.in_field(0.0)?, up, down), &mut Silent)?;
        ensure!(outcome.certified, "{sites} cells: {:?}", outcome.warnings);
        Ok(outcome.barrier.context("a barrier")?.forward_mev)
    }

    /// The field (T) in which the grain, magnetised up, runs down to the other side: raised in steps of 1/2000 of the largest
    /// anisotropy field, the last step then halved ten times.
    fn switching_t(&self) -> Result<f64> {
        let fields = self.anisotropy_mev.iter().zip(&self.moment_mev_per_t).map(|(k, m)| 2.0 * k / m);
        let mut step = fields.fold(0.0, f64::max) / 2000.0;
        let mut state = Spins::uniform(self.anisotropy_mev.len(), Direction::Z);
        let (mut b, mut halved) = (0.0, 0);
        while halved < 10 {
            let h = self.in_field(b + step)?;
            let relaxed = relax_to_minimum((&h).into(), &state, 1e-10 * h.stiffness_mev())?;
            // where a mode is just going soft, the last digits of the torque are not to be had
            let torque = relaxed.max_torque_mev / h.stiffness_mev();
            ensure!(torque < 1e-7, "a torque of {torque:e} of the stiffness is left at {} T", b + step);
            let hard_end = relaxed.spins.get(self.anisotropy_mev.len() - 1)[2];
            if hard_end < 0.0 {
                (step, halved) = (0.5 * step, halved + 1);
            } else {
                (b, state) = (b + step, relaxed.spins);
            }
        }
        Ok(b + step)
    }

    fn measured(&self) -> Result<Found> {
        let (barrier_mev, switching_t) = (self.barrier_mev()?, self.switching_t()?);
        let moment: f64 = self.moment_mev_per_t.iter().sum();
        Ok(Found { barrier_mev, switching_t, merit: 2.0 * barrier_mev / (moment * switching_t) })
    }
}

/// Ms, A and K of the library's FePt.
fn fept() -> Result<(Magnetisation, ExchangeStiffness, EnergyDensity)> {
    let material = library::find("FePt")?.context("FePt is in the library")?.material;
    let file: serde_json::Value = serde_json::from_str(library::find("FePt")?.context("FePt")?.text)?;
    let text = |place: &str| file.pointer(place).and_then(|v| v.as_str()).context("a quantity");
    ensure!(material.energy.len() == 2, "FePt has an exchange and an anisotropy");
    Ok((text("/Ms")?.parse()?, text("/energy/0/exchange/A")?.parse()?, text("/energy/1/anisotropy/K")?.parse()?))
}

/// A hard spin and a soft one: the best figure of merit over their exchange (in units of K) and the soft one's share of moment.
fn best_pair() -> Result<(f64, f64, Found)> {
    let k = Energy(100.0).0;
    let mut choices = Vec::new();
    for soft in [0.1, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.98, 0.99, 0.995] {
        choices.extend((1..=36).map(|j| (0.05 * j as f64, soft)));
    }
    let measured = |&(j, soft): &(f64, f64)| -> Result<(f64, f64, Found)> {
        let pair = Grain {
            exchange_mev: j * k,
            anisotropy_mev: vec![0.0, k],
            moment_mev_per_t: vec![10.0 * soft, 10.0 * (1.0 - soft)],
        };
        Ok((j, soft, pair.measured()?))
    };
    let all = choices.par_iter().map(measured).collect::<Result<Vec<_>>>()?;
    all.into_iter().max_by(|a, b| a.2.merit.total_cmp(&b.2.merit)).context("a pair")
}

fn main() -> Result<()> {
    let rows = LENGTHS_NM
        .into_par_iter()
        .map(|l| {
            let half = Grain::of_fept(l, |t| if t < 0.5 { 0.0 } else { 1.0 })?.measured()?;
            let square = Grain::of_fept(l, |t| t * t)?.measured()?;
            Ok((l, half, square))
        })
        .collect::<Result<Vec<(f64, Found, Found)>>>()?;
    let whole = Grain::of_fept(CELL_NM, |_| 1.0)?.measured()?;
    let (j, soft, pair) = best_pair()?;
    let (ms, _, k) = fept()?;
    let anisotropy_t = 2.0 * k.0 / ms.0;
    let thick = rows.last().context("a row")?;
    let mut text = String::from("grain,length_nm,barrier_meV,switching_field_T,figure_of_merit\n");
    let mut line = |name: &str, l: f64, f: &Found| {
        let _ = writeln!(text, "{name},{l},{:.6},{:.6},{:.6}", f.barrier_mev, f.switching_t, f.merit);
    };
    line("one cell", CELL_NM, &whole);
    rows.iter().for_each(|(l, half, _)| line("soft and hard half", *l, half));
    rows.iter().for_each(|(l, _, square)| line("K as depth squared", *l, square));
    let said = format!(
        "figure of merit: one cell {:.6} (published 1); two spins at best {:.4} (published 2; J = {j:.2} K, {soft} of the moment \
         soft); K as depth squared {:.4} at {} nm (published: close to the limit 4)\nsoft and hard half of {} nm: switched at {:.4} \
         of the hard half's anisotropy field (published: 1/4)\n",
        whole.merit,
        pair.merit,
        thick.2.merit,
        thick.0,
        thick.0,
        thick.1.switching_t / anisotropy_t
    );
    print!("{said}");
    std::fs::create_dir_all(FOLDER)?;
    std::fs::write(format!("{FOLDER}/grains.csv"), text)?;
    std::fs::write(format!("{FOLDER}/compared.txt"), said)?;
    let canvas = figure(&rows).draw()?;
    std::fs::write(format!("{FOLDER}/figure_of_merit.svg"), canvas.svg()?)?;
    std::fs::write(format!("{FOLDER}/figure_of_merit.png"), canvas.png()?)?;
    Ok(())
}

fn figure(rows: &[(f64, Found, Found)]) -> LinePlot {
    let ends = [0.0, 65.0];
    let level = |y: f64| Series::line(ends.map(|x| (x, y)).to_vec()).colour(BLACK).width(0.6).dash(3.0, 2.0);
    let curve = |f: fn(&(f64, Found, Found)) -> f64| rows.iter().map(|r| (r.0, f(r))).collect::<Vec<_>>();
    LinePlot::new("Length (nm)", "Figure of merit 2E_{b}/μB_{s}")
        .x_range(ends[0], ends[1])
        .y_range(0.0, 5.6)
        .with(level(1.0))
        .with(level(2.0))
        .with(level(4.0).label("published: 1, 2 and 4"))
        .with(Series::line(curve(|r| r.2.merit)).colour(BLUE).marker(Marker::Disc).label("K as depth squared"))
        .with(Series::line(curve(|r| r.1.merit)).colour(VERMILLION).marker(Marker::Square).label("soft and hard half"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_figures_of_merit_and_the_field_of_a_step_are_found() {
        let whole = Grain::of_fept(CELL_NM, |_| 1.0).unwrap().measured().unwrap();
        assert!((whole.merit - 1.0).abs() < 1e-5, "{whole:?}");
        let (ms, _, k) = fept().unwrap();
        let step = Grain::of_fept(30.0, |t| if t < 0.5 { 0.0 } else { 1.0 }).unwrap().measured().unwrap();
        assert!((step.switching_t * ms.0 / (2.0 * k.0) - 0.25).abs() < 1e-3, "{step:?}");
        let square = Grain::of_fept(27.0, |t| t * t).unwrap().measured().unwrap();
        assert!(3.4 < square.merit && square.merit < 4.0, "{square:?}");
    }
}
