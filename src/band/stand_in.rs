//! What stands in for the Hessians of all images of a band: the stiffness between its spins, factorised once.
//!
//! ```text
//! M_ij = −J_ij,   M_ii = the stiffness of spin i on its own, ½ Tr P_i (A_ii − m_i·g_i) P_i, at the end where that is larger
//! ```
//! One unknown a site, the same matrix for each Cartesian component: where spins turn little from site to site that is what the
//! Hessian does, but for couplings that tell directions apart. At a uniform end with one easy axis it is the Hessian. Shifts s
//! of the images are met to a factor √2: c + s is rounded to c 2^k. (Preconditioning by the exchange operator: Packwood et al.,
//! J. Chem. Phys. 144, 164109 (2016), doi:10.1063/1.4947024.)

use super::Band;
use crate::energy::Hamiltonian;
use crate::field::Components;
use crate::geometry::vector;
use crate::linalg::{Singles, SparseLdl, SparseMatrix};
use std::sync::{Arc, OnceLock};

/// Most k.
const LEVELS: usize = 48;
/// Most times that the matrix is made stiffer until it is positive definite.
const TRIES: usize = 40;

/// M + s for all s that are wanted.
#[derive(Debug)]
pub struct StandIn {
    plan: Arc<Singles>,
    matrix: SparseMatrix,
    /// The stiffness scale (meV).
    pub c: f64,
    levels: Vec<OnceLock<SparseLdl>>,
}

impl StandIn {
    /// Of a band with the stiffness scale c (meV), where factors of Hessians take long.
    pub fn of(band: &Band, c: f64) -> Option<StandIn> {
        let h = band.hamiltonian();
        let plan = h.singles()?;
        let stiffness = [0, band.images() - 1].map(|end| on_their_own(h, band.path().image(end), band.gradient(end)));
        let mut matrix = plan.matrix();
        for i in 0..h.sites() {
            let stiff = if h.is_frozen(i) { h.stiffness_mev() } else { stiffness[0][i].max(stiffness[1][i]) };
            plan.add(&mut matrix, i, i, stiff);
        }
        for bonds in &h.constant_blocks().bond {
            for [i, next] in bonds.family.bonds().filter(|bond| !bond.iter().any(|i| h.is_frozen(*i))) {
                plan.add(&mut matrix, i, next, bonds.mean(i));
            }
        }
        let levels = (0..LEVELS).map(|_| OnceLock::new()).collect();
        let mut stand_in = StandIn { plan: plan.clone(), matrix, c, levels };
        let mut more = c;
        for _ in 0..TRIES {
            if stand_in.factors(0).negatives() == 0 {
                break;
            }
            stand_in.matrix.shift(more);
            stand_in.levels[0] = OnceLock::new();
            more *= 2.0;
        }
        Some(stand_in)
    }

    /// (M + s)⁻¹ v, nearly, of a field of 3N numbers; `room` is memory.
    pub fn solve(&self, s: f64, v: &[f64], out: &mut [f64], room: &mut Vec<f64>) {
        let level = libm::round(libm::log2(1.0 + s.max(0.0) / self.c)).min((LEVELS - 1) as f64);
        self.plan.solve(self.factors(level as usize), v, out, room);
    }

    fn factors(&self, level: usize) -> &SparseLdl {
        self.levels[level].get_or_init(|| {
            let mut matrix = self.matrix.clone();
            matrix.shift(self.c * (libm::exp2(level as f64) - 1.0));
            SparseLdl::of(matrix)
        })
    }
}

/// ½ Tr P (A − m·g) P of every spin.
fn on_their_own(h: &Hamiltonian, m: &[f64], g: &[f64]) -> Vec<f64> {
    let (m, g) = (Components::new(m), Components::new(g));
    let own = h.varying_blocks(m);
    let stiffness = |(i, block): (usize, [[f64; 3]; 3])| {
        let m = m.get(i);
        let radial = vector::dot(m, block.map(|row| vector::dot(row, m)));
        0.5 * (block[0][0] + block[1][1] + block[2][2] - radial) - vector::dot(m, g.get(i))
    };
    own.as_ref().unwrap_or(h.constant_blocks()).sites().enumerate().map(stiffness).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::{Medium, TermSpec};
    use crate::geometry::Direction;
    use crate::lattice::LatticeSpec;
    use crate::linalg::slab;
    use crate::path::Path;
    use crate::spins::Spins;

    #[test]
    fn at_a_uniform_end_with_an_easy_axis_it_is_the_hessian() {
        let spec = r#"{"square": {"cells": [40, 36], "periodic": [true, false]}}"#;
        let lattice = serde_json::from_str::<LatticeSpec>(spec).unwrap().resolve().unwrap();
        let medium = Medium::new(&lattice, None, None);
        let terms =
            [r#"{"exchange": {"J": ["1 meV", "-0.2 meV"]}}"#, r#"{"anisotropy": {"K": "0.1 meV", "axis": [0, 0, 1]}}"#];
        let term = |text: &&str| serde_json::from_str::<TermSpec>(text).unwrap().member().build(&medium).unwrap();
        let h = Hamiltonian::new(&lattice, terms.iter().map(term).collect()).unwrap();
        let ends = [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]].map(|v| Spins::uniform(h.sites(), Direction::new(v).unwrap()));
        let band = Band::new(&h, Path::new(&[ends[0].clone(), ends[0].clone(), ends[1].clone()]));
        let stand_in = StandIn::of(&band, 0.2).expect("factors are dear");
        let mut v = Spins::random(h.sites(), 3).as_slice().to_vec();
        v[2 * h.sites()..].fill(0.0);
        for (s, exact) in [(0.0, true), (0.6, true), (0.7, false)] {
            let (mut x, mut back) = (vec![0.0; v.len()], vec![0.0; v.len()]);
            stand_in.solve(s, &v, &mut x, &mut Vec::new());
            h.hessian_product(band.path().image(0), band.gradient(0), &x, &mut back);
            slab::add_scaled(&mut back, s, &x);
            slab::add_scaled(&mut back, -1.0, &v);
            let error = slab::norm(&back) / slab::norm(&v);
            assert!(if exact { error < 1e-12 } else { (1e-3..0.5).contains(&error) }, "{s}: {error:e}");
        }
    }
}
