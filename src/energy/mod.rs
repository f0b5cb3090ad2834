//! What a configuration costs: energy terms, their gradients and Hessians, and the sum of them.
//!
//! ```text
//! E = − Σ J_ij m_i·m_j + Σ D d̂·(m_i × m_j) − Σ K (m_i·e)² − Σ K₂ (m_i·e)⁴ + Σ K_c (α₁²α₂² + …) − Σ μ_i m_i·B
//!   + Σ m_iᵀ T_ij m_j − Σ B_ij (m_i·m_j)² − Σ K_ijkl (m_i·m_j)(m_k·m_l)
//! ```
//! Every bond is counted once; energies are in meV, moments in μ_B, fields in T. One file a term; to add one, write
//! its file, name it here (`mod` and `pub use`) and in the `family!` of [`TermSpec`] (`spec.rs`).

mod anisotropy;
mod biquadratic;
mod blocks;
mod by_shell;
mod choice;
mod construction;
mod coupling;
mod couplings;
mod cubic_anisotropy;
mod custom;
mod demag;
mod dipolar;
mod dmi;
mod evaluator;
mod exchange;
mod exchange_matrix;
mod four_spin;
mod hamiltonian;
pub mod magnetostatics;
mod on_site;
mod pairs;
mod pairs_table;
mod recorded;
mod rounding;
mod shared;
mod spec;
mod symmetry;
#[cfg(test)]
pub mod test_terms;
mod zeeman;

pub use anisotropy::{Anisotropy, AnisotropySpec};
pub use biquadratic::{Biquadratic, BiquadraticSpec};
pub use blocks::{Block, Blocks, Bonds, multiply};
pub use by_shell::ByShell;
pub use choice::Choice;
pub use coupling::{AllPairs, Coupling};
pub use couplings::Couplings;
pub use cubic_anisotropy::{CubicAnisotropy, CubicAnisotropySpec};
pub use custom::{Custom, CustomEnergy, Reach, check_term};
pub use demag::DemagSpec;
pub use dipolar::DipolarSpec;
pub use dmi::{Dmi, DmiKind, DmiSpec};
pub use evaluator::Evaluator;
pub use exchange::{Exchange, ExchangeSpec};
pub use four_spin::{FourSpin, FourSpinSpec, QuadSpec};
pub use hamiltonian::{Hamiltonian, LONG};
pub use magnetostatics::Magnetostatics;
pub use on_site::{SiteAnisotropy, site_anisotropies};
pub use pairs::{Convention, Counting, DmiForm, EnergyForm, PairSpec, Pairs, PairsSpec};
pub use recorded::{Stored, recorded};
pub use shared::recorded_each;
pub use spec::{FamilyBond, Medium, Part, TermBuilder, TermSpec};
pub use symmetry::symmetry_axes;
pub use zeeman::{Zeeman, ZeemanSpec};

use crate::field::{Components, ComponentsMut, TILE};
use crate::geometry::Vector;
use crate::lattice::BondFamily;
use std::fmt::Debug;
use std::ops::Range;

/// Each site's share of a term's energy above its reference (meV), at the configuration `m` (3N components).
pub fn density_of(term: &dyn EnergyTerm, m: &[f64]) -> Vec<f64> {
    let mut density = vec![0.0; m.len() / 3];
    add_density(term, m, &mut density);
    density
}

/// Adds [`density_of`] a term.
fn add_density(term: &dyn EnergyTerm, m: &[f64], density: &mut [f64]) {
    let mut gradient = vec![0.0; m.len()];
    term.add_gradient(Components::new(m), ComponentsMut::new(&mut gradient), density, 0..m.len() / 3);
}

/// Adds A v of a term whose gradient is A m to `out`, tile by tile.
fn add_linear(term: &dyn EnergyTerm, v: Components, mut out: ComponentsMut) {
    let mut density = [0.0; TILE];
    for first in (0..v.sites()).step_by(TILE) {
        let range = first..v.sites().min(first + TILE);
        let density = &mut density[..range.len()];
        term.add_gradient(v, out.reborrow().into_range(range.clone()), density, range);
    }
}

/// One contribution to the energy of N classical unit spins.
///
/// A term counts its energy from a reference state of its own: E = [`reference_mev`](Self::reference_mev) + Σ density.
/// Densities are written as squares of deviations (½J|m_i − m_j|² for −J m_i·m_j), so that small energies of many spins are
/// not differences of large ones.
///
/// ```
/// use spinneb::energy::{EnergyTerm, Exchange, density_of};
/// use spinneb::{geometry::Direction, lattice::Chain, spins::Spins};
///
/// let chain = Chain::open(50).resolve()?;
/// let exchange = Exchange::uniform(&chain, &[10.0]); // meV
/// let up = Spins::uniform(50, Direction::Z);
/// let energy_mev = exchange.reference_mev() + density_of(&exchange, up.as_slice()).iter().sum::<f64>();
/// assert_eq!(energy_mev, -490.0); // 49 bonds
/// # Ok::<(), spinneb::error::Error>(())
/// ```
/// A term of a program's own need not write blocks: see [`CustomEnergy`].
pub trait EnergyTerm: Debug + Send + Sync {
    /// The name it has in configs and results.
    fn name(&self) -> &str;

    /// Of how many sites it is; nothing where it fits any lattice.
    fn sites(&self) -> Option<usize>;

    /// Whether all that it has of sites and bonds fits a lattice of so many sites: an entry for each of them in every array.
    fn fits(&self, sites: usize) -> bool {
        self.sites().is_none_or(|own| own == sites)
    }

    /// Energy of the reference state (meV), a constant.
    fn reference_mev(&self) -> f64;

    /// Adds ∂E/∂m (meV) on the sites of `range` to `g`, as if the components were free, and each site's share of the energy
    /// above the reference (meV) to `density`; a bond's energy belongs to the site that its family counts it at. Both cover just `range`.
    fn add_gradient(&self, m: Components, g: ComponentsMut, density: &mut [f64], range: Range<usize>);

    /// Adds (∂²E/∂m∂m) v (meV) to `out`.
    fn add_hessian_product(&self, m: Components, v: Components, out: ComponentsMut);

    /// Adds the 3 × 3 blocks of ∂²E/∂m∂m (meV).
    fn add_blocks(&self, m: Components, blocks: &mut Blocks);

    /// The bonds that have blocks; none of a term of single sites.
    fn families(&self) -> Vec<&BondFamily> {
        Vec::new()
    }

    /// In a row, how many sites away the furthest partner with a block is.
    fn reach(&self) -> usize {
        self.families().into_iter().map(|family| family.hop.shift[0].unsigned_abs()).max().unwrap_or(0)
    }

    /// Whether ∂²E/∂m∂m does not depend on m: its blocks are then asked for once.
    fn is_quadratic(&self) -> bool;

    /// Axes that the term itself singles out: the candidates for an axis of symmetry that are tried first.
    fn axes(&self) -> Vec<Vector>;

    /// Whether its gradient is asked for once a configuration, for all sites together.
    fn is_whole(&self) -> bool {
        self.coupling().pairs().is_some()
    }

    /// What its Hessian is uncertain by (meV), rounding apart.
    fn hessian_error_mev(&self) -> f64 {
        0.0
    }

    /// Which sites it couples. Where it joins all pairs, its
    /// [`reach`](Self::reach) is that of the blocks it adds, which are not all.
    fn coupling(&self) -> Coupling<'_> {
        Coupling::Local
    }
}
