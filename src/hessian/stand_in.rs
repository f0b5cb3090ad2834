//! What stands in for the Hessians of many configurations: the stiffness between its spins, inverted roughly.
//!
//! ```text
//! M_ij = −J_ij,   M_ii = the stiffness of spin i on its own, ½ Tr P_i (A_ii − m_i·g_i) P_i, where that is largest;
//!                              at least |Σ_j J_ij|, that of a spin among equals
//! ```
//! One unknown a site, the same matrix for each Cartesian component: where spins turn little from site to site that is what the
//! Hessian does, but for couplings that tell directions apart. At a uniform end with one easy axis M is the Hessian. Shifts s
//! of the images are met to a factor √2: c + s is rounded to c 2^k. (Preconditioning by the exchange operator: Packwood et al.,
//! J. Chem. Phys. 144, 164109 (2016), doi:10.1063/1.4947024.)

use crate::energy::Hamiltonian;
use crate::field::Components;
use crate::geometry::vector;
use crate::linalg::{Multigrid, multigrid};
use std::sync::OnceLock;

/// Most k.
const LEVELS: usize = 48;

/// M + s for all s that are wanted.
#[derive(Debug)]
pub struct StandIn {
    /// M.
    matrix: Multigrid,
    /// The stiffness scale (meV).
    pub c: f64,
    levels: Vec<OnceLock<Multigrid>>,
}

impl StandIn {
    /// For configurations between these, given with their gradients, of an energy with the stiffness scale c (meV).
    pub fn between(h: &Hamiltonian, ends: &[(&[f64], &[f64])], c: f64) -> StandIn {
        let mut stiffness = vec![0.0f64; h.sites()];
        for (m, g) in ends {
            stiffness.iter_mut().zip(on_their_own(h, m, g)).for_each(|(most, own)| *most = most.max(own));
        }
        let among_equals = &h.exchange_matrix().among_equals;
        stiffness.iter_mut().zip(among_equals).for_each(|(own, among)| *own = own.max(*among));
        StandIn::of(h, stiffness, c)
    }

    /// For configurations like the one m with gradient g, whose spins are held by c (meV) at least beside their neighbours.
    pub fn about(h: &Hamiltonian, m: &[f64], g: &[f64], c: f64) -> StandIn {
        let mut stiffness = on_their_own(h, m, g);
        let among_equals = &h.exchange_matrix().among_equals;
        stiffness.iter_mut().zip(among_equals).for_each(|(own, among)| *own = own.max(among + c));
        StandIn::of(h, stiffness, c)
    }

    /// With the stiffness of each spin on its own.
    pub(super) fn of(h: &Hamiltonian, mut own: Vec<f64>, c: f64) -> StandIn {
        let frozen = (0..h.sites()).filter(|i| h.is_frozen(*i));
        frozen.for_each(|i| own[i] = h.stiffness_mev());
        let exchange = h.exchange_matrix();
        let matrix = Multigrid::of(exchange.rows.with_diagonal(&own), exchange.coarsening.clone());
        StandIn { matrix, c, levels: (0..LEVELS).map(|_| OnceLock::new()).collect() }
    }

    /// (M + s)⁻¹ v, nearly, of a field of 3N numbers; `room` is memory.
    pub fn solve(&self, s: f64, v: &[f64], out: &mut [f64], room: &mut multigrid::Room) {
        let level = self.level(s);
        let shifted = || self.shifted(level);
        let here = if level == 0 { &self.matrix } else { self.levels[level].get_or_init(shifted) };
        here.solve(v, out, room);
    }

    /// k.
    fn level(&self, s: f64) -> usize {
        libm::round(libm::log2(1.0 + s.max(0.0) / self.c)).min((LEVELS - 1) as f64) as usize
    }

    /// M + c (2ᵏ − 1).
    fn shifted(&self, level: usize) -> Multigrid {
        self.matrix.shifted(self.c * (libm::exp2(level as f64) - 1.0))
    }
}

/// ½ Tr P (A − m·g) P of every spin.
pub(super) fn on_their_own(h: &Hamiltonian, m: &[f64], g: &[f64]) -> Vec<f64> {
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
    use crate::energy::test_terms::{hamiltonian, lattice};
    use crate::geometry::Direction;
    use crate::linalg::slab;
    use crate::spins::Spins;

    #[test]
    fn at_a_uniform_end_with_an_easy_axis_it_is_the_hessian_and_nearly_inverted() {
        let spec = r#"{"square": {"cells": [40, 36], "periodic": [true, false]}}"#;
        let lattice = lattice(spec);
        let terms =
            [r#"{"exchange": {"J": ["1 meV", "-0.2 meV"]}}"#, r#"{"anisotropy": {"K": "0.1 meV", "axis": [0, 0, 1]}}"#];
        let h = hamiltonian(&lattice, &terms);
        let ends = [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]].map(|v| Spins::uniform(h.sites(), Direction::new(v).unwrap()));
        let gradient = |m: &Spins| {
            let mut g = vec![0.0; 3 * h.sites()];
            h.energy_gradient(m.as_slice(), &mut g);
            g
        };
        let g = ends.each_ref().map(gradient);
        let stand_in = StandIn::between(&h, &[(ends[0].as_slice(), &g[0]), (ends[1].as_slice(), &g[1])], 0.2);
        let mut v = Spins::random(h.sites(), 3).as_slice().to_vec();
        v[2 * h.sites()..].fill(0.0);
        // 0.6 is 0.2 (2² − 1), 0.7 is none of these
        for (s, exact, most) in [(0.0, true, 0.3), (0.6, true, 0.2), (0.7, false, 0.3)] {
            let shifted = stand_in.shifted(stand_in.level(s));
            let matrix = shifted.matrix();
            let product = |x: &[f64], k: usize| -> f64 {
                let (i, field) = (k % h.sites(), k / h.sites() * h.sites());
                matrix.row(i).map(|(j, a)| a * x[field + j]).sum()
            };
            let off = |x: &[f64], wanted: &dyn Fn(usize) -> f64| {
                let mut image = vec![0.0; x.len()];
                h.hessian_product(ends[0].as_slice(), &g[0], x, &mut image);
                slab::add_scaled(&mut image, s, x);
                let difference: Vec<f64> = image.iter().enumerate().map(|(k, a)| a - wanted(k)).collect();
                slab::norm(&difference) / slab::norm(&v)
            };
            let error = off(&v, &|k| product(&v, k));
            assert!(if exact { error < 1e-12 } else { (1e-3..0.5).contains(&error) }, "{s}: {error:e}");
            let mut x = vec![0.0; v.len()];
            stand_in.solve(s, &v, &mut x, &mut multigrid::Room::default());
            let error = off(&x, &|k| v[k]);
            assert!((1e-3..most).contains(&error), "{s}: {error:e}");
        }
    }
}
