//! The scales of a problem: how stiff its softest mode is, how wide its walls are.

use crate::energy::{Evaluator, Hamiltonian, site_anisotropies};
use crate::lattice::{BondFamily, Lattice};
use crate::linalg::orthonormal;
use crate::state::StateContext;
use crate::stationary::{ALIKE, INDEPENDENT, Relaxed, State};
use crate::threads::both;
use serde::{Deserialize, Serialize};

/// Images between the ends of a path on which nothing narrow moves.
pub(super) const LEAST_IMAGES: usize = 15;

/// Scales from which tolerances, shifts and image counts follow.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scales {
    /// Stiffness c (meV): the softest mode of a stable end, 2K for an easy axis.
    pub stiffness_mev: f64,
    /// Exchange stiffness, in a chain Σ_n n² J_n (meV), without sign: that of a bond where only neighbours in rows are joined.
    pub exchange_mev: f64,
    /// Domain-wall width δ = √(J/c) in sites.
    pub wall_width_sites: f64,
}

impl Scales {
    /// From the on-site terms alone, before any state is known.
    pub fn of_terms(h: &Hamiltonian) -> Scales {
        Scales::new(h, on_site_gap(h))
    }

    /// From two relaxed ends.
    pub fn of_ends(h: Evaluator, [a, b]: &[Relaxed; 2]) -> Scales {
        let softest = |end: &Relaxed| end.stiffness_mev.unwrap_or_else(|| softest_mode(h, end.spins.as_slice()));
        let (of_a, of_b) = both(3 * h.sites(), || softest(a), || softest(b));
        let softest = of_a.max(of_b);
        Scales::new(&h, if softest > ALIKE * h.stiffness_mev() { softest } else { on_site_gap(&h) })
    }

    fn new(h: &Hamiltonian, c: f64) -> Scales {
        let exchange = exchange_stiffness(h);
        let floor = ALIKE * h.stiffness_mev();
        let c = c.max(floor);
        let width = (exchange / c).sqrt().clamp(0.25, h.sites().max(1) as f64);
        Scales { stiffness_mev: c, exchange_mev: exchange, wall_width_sites: width }
    }

    /// What states need to know.
    pub fn states<'a>(&self, h: &'a Hamiltonian) -> StateContext<'a> {
        let context = StateContext::new(h.lattice(), self.wall_width_sites);
        StateContext { exchange_mev: self.exchange_mev, hamiltonian: Some(h), ..context }
    }

    /// Images between the ends that resolve a wall sweeping through `moving` of the sites along a lattice: 2 rad a spin between
    /// neighbours, and at least 15, or 7 where a wall in the middle of a chain only moves by a few times its width.
    pub fn images_between(&self, lattice: &Lattice, moving: usize) -> usize {
        let sites = lattice.sites_along();
        let (n, w) = (moving as f64, self.sweep_width(sites));
        let least = if lattice.is_row() && 2 * moving < sites && n < 3.0 * w { 7 } else { LEAST_IMAGES };
        ((std::f64::consts::PI * (n + w) / (2.0 * w)).ceil() as usize).max(least)
    }

    /// Width of a wall that enters: 4δ, at least two sites, at most the chain.
    pub fn sweep_width(&self, sites: usize) -> f64 {
        (4.0 * self.wall_width_sites).clamp(2.0, (sites as f64).max(2.0))
    }
}

/// Lowest eigenvalue of the Riemannian Hessian (meV), rotations about symmetry axes apart.
fn softest_mode(h: Evaluator, m: &[f64]) -> f64 {
    State::at(h, m.to_vec()).stiffness_mev(h).unwrap_or(0.0)
}

/// Median over sites of the least curvature that a site has of itself at its lowest minimum: 2K of an easy axis. Magnetostatics count as
/// between spins that are all alike: the anisotropy of the chain's shape.
fn on_site_gap(h: &Hamiltonian) -> f64 {
    let mut gaps: Vec<f64> = site_anisotropies(h, true).iter().map(|site| site.gap_mev).collect();
    gaps.sort_by(f64::total_cmp);
    gaps[gaps.len() / 2]
}

/// ⟨½ Σ_j s J_ij |r_ij|²⟩/(d a²) of all sites, without sign: the exchange stiffness in units of the lattice constant a, the mean of
/// the d directions that bonds span; in a row Σ_n n² J_n sⁿ. Of each family the median of its bonds; s is −1 where the order of
/// nearest neighbours is staggered and the bond joins the two sublattices.
fn exchange_stiffness(h: &Hamiltonian) -> f64 {
    let lattice = h.lattice();
    let medians: Vec<(&BondFamily, f64)> = h
        .constant_blocks()
        .bond
        .iter()
        .map(|bonds| {
            let mut j: Vec<f64> = (0..h.sites()).map(|i| -bonds.mean(i)).filter(|j| *j != 0.0).collect();
            j.sort_by(f64::total_cmp);
            (&bonds.family, j.get(j.len() / 2).copied().unwrap_or(0.0))
        })
        .collect();
    let nearest = medians
        .iter()
        .filter(|(_, j)| *j != 0.0)
        .min_by(|(p, _), (q, _)| lattice.squared_length(p.hop).total_cmp(&lattice.squared_length(q.hop)));
    let sign = nearest.map_or(1.0, |(_, j)| 1f64.copysign(*j));
    let part = |(family, j): &(&BondFamily, f64)| {
        let squared = lattice.squared_length(family.hop);
        squared * j * if lattice.joins_sublattices(family.hop) { sign } else { 1.0 }
    };
    let hops = medians.iter().filter(|(_, j)| *j != 0.0).map(|(family, _)| lattice.along(family.hop).to_vec());
    let directions = orthonormal(hops.collect(), INDEPENDENT).len().max(1) * lattice.atoms.len();
    (medians.iter().map(part).sum::<f64>() / directions as f64).abs()
}
