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

use super::TangentBasis;
use crate::energy::Hamiltonian;
use crate::field::Components;
use crate::geometry::vector;
use crate::linalg::{Inverse, Multigrid, Rows, multigrid, slab};
use std::sync::OnceLock;

/// Most k.
const LEVELS: usize = 48;
/// The least of what spins feel beside their neighbours, in parts of the largest stiffness.
const LEAST: f64 = 1e-9;

/// M + s for all s that are wanted.
#[derive(Debug)]
pub struct StandIn {
    matrix: Rows,
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
        let mut rows: Vec<Vec<(usize, f64)>> = vec![Vec::new(); h.sites()];
        for bonds in &h.constant_blocks().bond {
            for [i, next] in bonds.family.bonds().filter(|bond| !bond.iter().any(|i| h.is_frozen(*i))) {
                rows[i].push((next, bonds.mean(i)));
                rows[next].push((i, bonds.mean(i)));
            }
        }
        for (i, row) in rows.iter_mut().enumerate() {
            let among_equals = row.iter().map(|(_, a)| a).sum::<f64>().abs();
            row.push((i, if h.is_frozen(i) { h.stiffness_mev() } else { stiffness[i].max(among_equals) }));
        }
        let levels = (0..LEVELS).map(|_| OnceLock::new()).collect();
        StandIn { matrix: Rows::new(h.sites(), rows), c, levels }
    }

    /// For the configuration m with gradient g alone, and with it in c what its spins feel beside their neighbours, on the average.
    pub fn about(h: &Hamiltonian, m: &[f64], g: &[f64]) -> StandIn {
        let mut stand_in = StandIn::between(h, &[(m, g)], 0.0);
        let alone = |(i, own): (usize, f64)| {
            let others: f64 = stand_in.matrix.row(i).filter(|(j, _)| *j != i).map(|(_, a)| a).sum();
            (own - others.abs()).abs()
        };
        let sum: f64 = on_their_own(h, m, g).into_iter().enumerate().map(alone).sum();
        stand_in.c = (sum / h.sites() as f64).max(LEAST * h.stiffness_mev());
        stand_in
    }

    /// (M + s)⁻¹ v, nearly, of a field of 3N numbers; `room` is memory.
    pub fn solve(&self, s: f64, v: &[f64], out: &mut [f64], room: &mut multigrid::Room) {
        let level = self.level(s);
        self.levels[level].get_or_init(|| Multigrid::of(self.shifted(level))).solve(v, out, room);
    }

    /// (M + c)⁻¹ in the tangent space of a basis.
    pub fn at<'a>(&'a self, basis: &'a TangentBasis) -> StandInAt<'a> {
        StandInAt { stand_in: self, basis }
    }

    /// k.
    fn level(&self, s: f64) -> usize {
        libm::round(libm::log2(1.0 + s.max(0.0) / self.c)).min((LEVELS - 1) as f64) as usize
    }

    /// M + c (2ᵏ − 1).
    fn shifted(&self, level: usize) -> Rows {
        self.matrix.shifted(self.c * (libm::exp2(level as f64) - 1.0))
    }
}

/// (M + c)⁻¹ in the tangent coordinates of one configuration.
pub struct StandInAt<'a> {
    stand_in: &'a StandIn,
    basis: &'a TangentBasis,
}

impl Inverse for StandInAt<'_> {
    fn order(&self) -> usize {
        2 * self.stand_in.matrix.order()
    }

    fn solve(&self, x: &mut [f64], columns: usize) {
        slab::one_by_one(x, columns, |x| {
            let mut field = vec![0.0; x.len() / 2 * 3];
            let mut out = field.clone();
            self.basis.field(x, &mut field);
            self.stand_in.solve(self.stand_in.c, &field, &mut out, &mut multigrid::Room::default());
            x.copy_from_slice(&self.basis.coordinates(&out));
        });
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
    use crate::energy::test_terms::{hamiltonian, lattice};
    use crate::geometry::Direction;
    use crate::hessian::assemble;
    use crate::linalg::{orthonormal, softest};
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
            let matrix = stand_in.shifted(stand_in.level(s));
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

    #[test]
    fn where_all_spins_point_along_a_hard_axis_it_still_leads_to_the_lowest_mode() {
        // M alone is the Laplacian there, which has no inverse; the lowest mode turns all spins to the easy axis: −2K
        let lattice = lattice(r#"{"square": {"cells": [14, 12]}}"#);
        let easy = r#"{"anisotropy": {"K": "0.1 meV", "axis": [0, 0, 1]}}"#;
        let h = hamiltonian(&lattice, &[r#"{"exchange": {"J": ["1 meV"]}}"#, easy]);
        let m = Spins::uniform(h.sites(), Direction::X);
        let mut g = vec![0.0; 3 * h.sites()];
        h.energy_gradient(m.as_slice(), &mut g);
        let (basis, mut turn) = (TangentBasis::at(m.as_slice()), Vec::new());
        basis.write_rotation([0.0, 0.0, 1.0], &mut turn);
        let (hessian, turns) = (assemble(&h, m.as_slice(), &g, &basis), orthonormal(vec![turn], 0.5));
        let stand_in = StandIn::about(&h, m.as_slice(), &g);
        assert!((stand_in.c - 0.1).abs() < 1e-12, "{}", stand_in.c);
        let modes = softest(&hessian, 2, &turns, &stand_in.at(&basis), &|| false).expect("they are found");
        let told = modes.iter().map(|mode| mode.value);
        // the next is the longest wave along the longer side
        let wave = -0.2 + 2.0 * (1.0 - libm::cos(std::f64::consts::PI / 14.0));
        assert!(told.zip([-0.2, wave]).all(|(value, exact)| (value - exact).abs() < 1e-11), "{modes:?}");
    }
}
