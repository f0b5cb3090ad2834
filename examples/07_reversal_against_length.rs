//! A small elongated particle reverses as a whole, a longer one by a wall: where does one become the other?
//!
//! A Permalloy bar, 20 nm × 5 nm across, 30 nm … 160 nm long, in cells of 2.5 nm. Its only anisotropy is that of its shape: all
//! spins of a prism that turn together cost
//!
//! ```text
//! E = K(L) V,   K(L) = ½ μ₀ Ms² (N_yy − N_xx)          N: demagnetising factors of the prism (Newell's tensors, summed)
//! ```
//! If that anisotropy were local, the saddle would be no longer uniform from L = π √(A/K) on (the mode cos πx/L goes soft), and
//! beyond be part of a periodic wall, cos φ = k sn(x/δ), with the length and the barrier
//!
//! ```text
//! L = 2δ K(k),   E = S √(AK) [4 E(k) − 2(1 − k²) K(k)]          complete elliptic integrals;  E → 4 S √(AK)
//! ```
//! (H.-B. Braun, Phys. Rev. Lett. 71, 3557 (1993), doi:10.1103/PhysRevLett.71.3557, for the infinite wire; free ends here.) Both
//! are run: with the demagnetising field, and with a local easy axis of the same strength, K(L) of each length. Every barrier is
//! certified.
//!
//! The demagnetising field is not local: the ends, where the saddle begins to differ, carry the charges. Its own prediction is the
//! length at which the uniform state across the bar, all spins along y, becomes softer than that towards a turn that is odd in x:
//! the lowest odd eigenvalue of the Hessian there changes sign. Every length is first predicted, then run.
//!
//! ```text
//! cargo run --release --example 07_reversal_against_length
//! ```
//! writes a table and a figure to `results/gallery/07_reversal_against_length/`.

use anyhow::{Context, Result, ensure};
use rayon::prelude::*;
use spinneb::drive::{Problem, Silent, run};
use spinneb::energy::{EnergyTerm, Hamiltonian, Medium, TermSpec};
use spinneb::geometry::Direction;
use spinneb::lattice::Chain;
use spinneb::linalg::eigenvalues_symmetric;
use spinneb::output::canvas::{BLACK, BLUE, LinePlot, Marker, Series, VERMILLION};
use spinneb::spins::Spins;
use spinneb::units::{Energy, ExchangeStiffness, Length, Magnetisation};
use std::f64::consts::PI;
use std::fmt::Write;

const CELL_NM: f64 = 2.5;
const SECTION_NM: [f64; 2] = [20.0, 5.0];
const SITES: std::ops::RangeInclusive<usize> = 12..=64;
const FOLDER: &str = "results/gallery/07_reversal_against_length";

/// One length.
struct Row {
    length_nm: f64,
    /// All spins together (meV).
    coherent_mev: f64,
    /// The local theory (meV).
    theory_mev: f64,
    /// π √(A/K) of this length (nm).
    critical_nm: f64,
    /// Lowest odd eigenvalue of the demagnetising field's Hessian with all spins across the bar (meV).
    odd_mev: f64,
    demag: Found,
    local: Found,
}

/// A certified barrier, and how much the two ends of its saddle differ in m_x: 0 as long as the bar turns as a whole.
struct Found {
    barrier_mev: f64,
    asymmetry: f64,
}

fn main() -> Result<()> {
    let rows = SITES.into_par_iter().map(row).collect::<Result<Vec<Row>>>()?;
    let predicted_local = crossing(&rows, |r| r.length_nm - r.critical_nm).context("no length is critical")?;
    let predicted_demag = crossing(&rows, |r| -r.odd_mev).context("no odd mode is soft")?;
    let onset = |of: fn(&Row) -> &Found| crossing(&rows, move |r| of(r).asymmetry - 0.1).context("no wall");
    let (demag, local) = (onset(|r| &r.demag)?, onset(|r| &r.local)?);
    let said = format!(
        "the saddle stops being uniform with a local easy axis at {local:.1} nm (predicted: {predicted_local:.1} nm, π√(A/K) of \
         its own length), with the demagnetising field at {demag:.1} nm (predicted: {predicted_demag:.1} nm, where the first odd \
         mode goes soft); lengths differ by cells of {CELL_NM} nm"
    );
    println!("{said}");
    std::fs::create_dir_all(FOLDER)?;
    std::fs::write(format!("{FOLDER}/barriers.csv"), table(&rows))?;
    std::fs::write(format!("{FOLDER}/crossover.txt"), said + "\n")?;
    let canvas = figure(&rows, predicted_local, predicted_demag).draw()?;
    std::fs::write(format!("{FOLDER}/barrier_against_length.svg"), canvas.svg()?)?;
    std::fs::write(format!("{FOLDER}/barrier_against_length.png"), canvas.png()?)?;
    Ok(())
}

/// Permalloy's A.
fn stiffness() -> ExchangeStiffness {
    ExchangeStiffness(13e-12)
}

/// Both barriers of one length, and what is expected.
fn row(sites: usize) -> Result<Row> {
    let length_nm = sites as f64 * CELL_NM;
    let section = SECTION_NM[0] * SECTION_NM[1];
    let far = bar(sites, r#"{"demag": {}}"#)?;
    let [x, y] = [Direction::X, Direction::Y].map(|d| Spins::uniform(sites, d));
    let coherent_mev = far.difference_mev(y.as_slice(), x.as_slice());
    let k_mev_per_nm3 = coherent_mev / (section * length_nm);
    // A in meV/nm: an energy of 1 nm of a wire of 1 nm²
    let a_mev_per_nm = stiffness().over_length(1.0).0;
    let delta_nm = (a_mev_per_nm / k_mev_per_nm3).sqrt();
    let scale = section * (a_mev_per_nm * k_mev_per_nm3).sqrt();
    let theory_mev = scale * local_barrier(length_nm / delta_nm);
    let odd_mev = lowest_odd_mode(&far, y.as_slice());
    // the easy axis, and an equal hard one across the film, where the bar is stiffer still
    let k = Energy(k_mev_per_nm3 * section * CELL_NM);
    let axis = format!(r#"{{"anisotropy": {{"K": "{} meV", "axis": [1, 0, 0]}}}}"#, k.0);
    let hard = format!(r#"{{"anisotropy": {{"K": "{} meV", "axis": [0, 0, 1]}}}}"#, -3.0 * k.0);
    let near = bar_of(sites, &[EXCHANGE, &axis, &hard])?;
    let (demag, local) = (found(sites, far)?, found(sites, near)?);
    Ok(Row { length_nm, coherent_mev, theory_mev, critical_nm: PI * delta_nm, odd_mev, demag, local })
}

const EXCHANGE: &str = r#"{"exchange": {"A": "13 pJ/m"}}"#;

fn bar(sites: usize, term: &str) -> Result<Hamiltonian> {
    bar_of(sites, &[EXCHANGE, term])
}

fn chain(sites: usize) -> Chain {
    let section = SECTION_NM.map(|edge| Length(edge).into());
    Chain { spacing: Some(Length(CELL_NM)), cross_section: Some(section), ..Chain::open(sites) }
}

fn bar_of(sites: usize, terms: &[&str]) -> Result<Hamiltonian> {
    let chain = chain(sites).resolve()?;
    let medium = Medium::new(&chain, None, Some(Magnetisation(8e5).into()));
    let build = |text: &&str| -> Result<Box<dyn EnergyTerm>> {
        let spec: TermSpec = serde_json::from_str(text)?;
        Ok(spec.member().build(&medium)?)
    };
    let terms = terms.iter().map(build).collect::<Result<Vec<_>>>()?;
    Ok(Hamiltonian::new(&chain, terms)?)
}

/// Lowest eigenvalue (meV) of the Hessian for turns towards x that change sign in the middle of the bar.
fn lowest_odd_mode(h: &Hamiltonian, m: &[f64]) -> f64 {
    let sites = h.sites();
    let mut g = vec![0.0; 3 * sites];
    h.energy_gradient(m, &mut g);
    let half = sites / 2;
    let (mut v, mut out) = (vec![0.0; 3 * sites], vec![0.0; 3 * sites]);
    let mut odd = vec![0.0; half * half];
    for j in 0..half {
        v.fill(0.0);
        (v[j], v[sites - 1 - j]) = (0.5f64.sqrt(), -(0.5f64.sqrt()));
        h.hessian_product(m, &g, &v, &mut out);
        for i in 0..half {
            odd[i * half + j] = 0.5f64.sqrt() * (out[i] - out[sites - 1 - i]);
        }
    }
    eigenvalues_symmetric(&odd, half).into_iter().fold(f64::INFINITY, f64::min)
}

/// The certified barrier of the reversal from +x to −x.
fn found(sites: usize, h: Hamiltonian) -> Result<Found> {
    let [a, b] = [Direction::X, Direction::X.reversed()].map(|d| Spins::uniform(sites, d));
    let outcome = run(&Problem::new(h, a, b), &mut Silent)?;
    ensure!(outcome.certified, "{sites} cells: {:?}", outcome.warnings);
    let barrier_mev = outcome.barrier.context("a barrier")?.forward_mev;
    let top = outcome.saddles.iter().max_by(|a, b| a.energy_mev.total_cmp(&b.energy_mev)).context("a saddle")?;
    let asymmetry = (top.spins.get(0)[0] - top.spins.get(sites - 1)[0]).abs();
    Ok(Found { barrier_mev, asymmetry })
}

/// The barrier of a local easy axis over S√(AK), for L/δ: uniform up to π, then elliptic.
fn local_barrier(length: f64) -> f64 {
    if length <= PI {
        return length;
    }
    // the complementary parameter 1 − k² falls as L grows: bisection of L = 2 K(k)
    let (mut low, mut high) = (1e-300f64, 1.0);
    for _ in 0..200 {
        let middle = if low < 1e-3 * high { (low * high).sqrt() } else { 0.5 * (low + high) };
        if 2.0 * elliptic(middle).0 > length { low = middle } else { high = middle }
    }
    let (k, e) = elliptic(low);
    4.0 * e - 2.0 * low * k
}

/// Complete elliptic integrals K and E for the complementary parameter m' = 1 − k², by the arithmetic-geometric mean.
fn elliptic(complement: f64) -> (f64, f64) {
    let (mut a, mut b, mut sum, mut power) = (1.0, complement.sqrt(), 0.5 * (1.0 - complement), 1.0);
    for _ in 0..60 {
        let c = 0.5 * (a - b);
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
        sum += power * c * c;
        power *= 2.0;
    }
    let k = PI / (2.0 * a);
    (k, k * (1.0 - sum))
}

/// Where a function of the rows changes sign, by linear interpolation of the length.
fn crossing(rows: &[Row], f: impl Fn(&Row) -> f64) -> Option<f64> {
    let pair = rows.windows(2).find(|w| f(&w[0]) <= 0.0 && f(&w[1]) > 0.0)?;
    let (a, b) = (f(&pair[0]), f(&pair[1]));
    Some(pair[0].length_nm + (pair[1].length_nm - pair[0].length_nm) * a / (a - b))
}

fn table(rows: &[Row]) -> String {
    let mut text = String::from(
        "length_nm,barrier_demag_meV,barrier_local_meV,coherent_meV,local_theory_meV,critical_length_nm,odd_mode_meV,asymmetry_demag,asymmetry_local\n",
    );
    for r in rows {
        let _ = writeln!(
            text,
            "{},{:.6},{:.6},{:.6},{:.6},{:.4},{:.6},{:.6},{:.6}",
            r.length_nm,
            r.demag.barrier_mev,
            r.local.barrier_mev,
            r.coherent_mev,
            r.theory_mev,
            r.critical_nm,
            r.odd_mev,
            r.demag.asymmetry,
            r.local.asymmetry
        );
    }
    text
}

fn figure(rows: &[Row], predicted_local_nm: f64, predicted_demag_nm: f64) -> LinePlot {
    let curve = |f: fn(&Row) -> f64| rows.iter().map(|r| (r.length_nm, 1e-3 * f(r))).collect::<Vec<_>>();
    let highest = rows.iter().map(|r| 1e-3 * r.theory_mev.max(r.demag.barrier_mev)).fold(0.0, f64::max);
    let top = 1.12 * highest;
    let coherent = curve(|r| r.coherent_mev).into_iter().filter(|p| p.1 < top).collect();
    let predicted = |x: f64, colour| Series::line(vec![(x, 0.0), (x, top)]).colour(colour).width(0.6).dash(1.5, 1.5);
    let thinned = |points: Vec<(f64, f64)>| points.into_iter().step_by(2).collect::<Vec<_>>();
    LinePlot::new("Length (nm)", "Barrier (eV)")
        .x_range(25.0, 165.0)
        .y_range(0.0, top)
        .with(predicted(predicted_local_nm, VERMILLION))
        .with(predicted(predicted_demag_nm, BLUE))
        .with(Series::line(coherent).colour(BLACK).width(0.7).dash(4.0, 2.0).label("all spins together, K(L) V"))
        .with(Series::line(curve(|r| r.theory_mev)).colour(VERMILLION).width(0.8).label("local theory"))
        .with(
            Series::markers(thinned(curve(|r| r.local.barrier_mev)), Marker::Square)
                .colour(VERMILLION)
                .label("local easy axis"),
        )
        .with(
            Series::markers(thinned(curve(|r| r.demag.barrier_mev)), Marker::Disc)
                .colour(BLUE)
                .label("demagnetising field"),
        )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_local_easy_axis_has_the_barrier_of_its_theory_below_and_above_the_critical_length() {
        assert!((local_barrier(PI) - PI).abs() < 1e-12 && (local_barrier(40.0) - 4.0).abs() < 1e-12);
        for (sites, together) in [(14, true), (40, false)] {
            let row = row(sites).unwrap();
            assert!((row.local.barrier_mev / row.theory_mev - 1.0).abs() < 3e-3, "{sites}");
            assert_eq!(row.local.asymmetry < 1e-6, together);
            assert_eq!(row.demag.asymmetry < 1e-6, row.odd_mev > 0.0);
        }
    }
}
