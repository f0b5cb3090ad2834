//! Dzyaloshinskii–Moriya interaction of nearest neighbours.
//!
//! ```text
//! E = + Σ_i D d̂·(m_i × m_{i+1})               every bond once
//! ∂E/∂m_i = D (m_{i+1} × d̂),   ∂E/∂m_{i+1} = D (d̂ × m_i)
//! ```
//! With D > 0 the lower turning sense is that in which m_i × m_{i+1} points against d̂.

use super::EnergyTerm;
use super::blocks::{Blocks, cross_block};
use super::spec::{Medium, TermBuilder};
use crate::error::Result;
use crate::field::{Components, ComponentsMut};
use crate::geometry::{Direction, Vector, vector};
use crate::lattice::{Chain, Selection};
use crate::profile::Profile;
use crate::registry::Described;
use crate::units::BondEnergy;
use multiversion::multiversion;
use schemars::JsonSchema;
use serde::Deserialize;
use std::ops::Range;

/// `{"D": "2 meV", "direction": [0, 1, 0]}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct DmiSpec {
    /// Energy per bond, or per area of the cross-section.
    pub D: Profile<BondEnergy>,
    /// d̂.
    pub direction: Direction,
    /// Only these bonds; all if absent.
    #[serde(default)]
    pub bonds: Option<Selection>,
}

impl Described for DmiSpec {
    const NAME: &'static str = "dmi";
    const SUMMARY: &'static str = "Dzyaloshinskii–Moriya interaction +D d·(m_i × m_j) of neighbours";
    const EXAMPLE: &'static str = r#"{"dmi": {"D": "2 meV", "direction": [0, 1, 0]}}"#;
}

impl TermBuilder for DmiSpec {
    fn build(&self, medium: &Medium) -> Result<Box<dyn EnergyTerm>> {
        let d = medium.on_bonds(&self.D, 1, self.bonds.as_ref(), "D", |d, i| medium.bond_energy_mev(d, i))?;
        Ok(Box::new(Dmi { direction: self.direction.vector(), d }))
    }
}

/// Bond energies D (meV) along one direction; `d[i]` joins sites i and i + 1, 0 where there is no bond.
#[derive(Clone, Debug)]
pub struct Dmi {
    /// Unit vector d̂.
    pub direction: Vector,
    /// D of each bond.
    pub d: Vec<f64>,
}

impl Dmi {
    /// The same D (meV) on all bonds.
    pub fn uniform(chain: &Chain, d: f64, direction: Direction) -> Dmi {
        let d = (0..chain.sites).map(|i| if i < chain.bonds(1) { d } else { 0.0 }).collect();
        Dmi { direction: direction.vector(), d }
    }

    /// Σ over the two bonds of a site: D_i (m_{i+1} × d̂) − D_{i−1} (m_{i−1} × d̂).
    #[inline(always)]
    fn slope(&self, dp: f64, dm: f64, p: Vector, q: Vector) -> Vector {
        let w = [dp * p[0] - dm * q[0], dp * p[1] - dm * q[1], dp * p[2] - dm * q[2]];
        vector::cross(w, self.direction)
    }
}

/// The run of sites from `lo` on whose two neighbours need no wrapping.
#[multiversion(targets("x86_64+avx2"))]
fn add_run(term: &Dmi, lo: usize, m: Components, gx: &mut [f64], gy: &mut [f64], gz: &mut [f64], density: &mut [f64]) {
    let n = gx.len();
    let (here, next, previous) = (m.range(lo..lo + n), m.range(lo + 1..lo + 1 + n), m.range(lo - 1..lo - 1 + n));
    let (dp, dm, [ex, ey, ez]) = (&term.d[lo..lo + n], &term.d[lo - 1..lo - 1 + n], term.direction);
    let (gy, gz, density) = (&mut gy[..n], &mut gz[..n], &mut density[..n]);
    for i in 0..n {
        let (px, py, pz) = (dp[i] * next.x[i], dp[i] * next.y[i], dp[i] * next.z[i]);
        let (wx, wy, wz) = (px - dm[i] * previous.x[i], py - dm[i] * previous.y[i], pz - dm[i] * previous.z[i]);
        gx[i] += wy * ez - wz * ey;
        gy[i] += wz * ex - wx * ez;
        gz[i] += wx * ey - wy * ex;
        let turn = (here.y[i] * pz - here.z[i] * py, here.z[i] * px - here.x[i] * pz, here.x[i] * py - here.y[i] * px);
        density[i] += ex * turn.0 + ey * turn.1 + ez * turn.2;
    }
}

impl EnergyTerm for Dmi {
    fn name(&self) -> &'static str {
        DmiSpec::NAME
    }

    fn reference_mev(&self) -> f64 {
        0.0
    }

    fn add_gradient(&self, m: Components, mut g: ComponentsMut, density: &mut [f64], range: Range<usize>) {
        let (first, last, n) = (range.start, range.end, m.sites());
        let lo = first.max(1).min(last);
        let hi = last.min(n - 1).max(lo);
        for i in (first..lo).chain(hi..last) {
            let (previous, next) = ((i + n - 1) % n, (i + 1) % n);
            g.add(i - first, self.slope(self.d[i], self.d[previous], m.get(next), m.get(previous)));
            density[i - first] += self.d[i] * vector::dot(self.direction, vector::cross(m.get(i), m.get(next)));
        }
        let run = lo - first..hi - first;
        if !run.is_empty() {
            let (gx, gy, gz) = (&mut g.x[run.clone()], &mut g.y[run.clone()], &mut g.z[run.clone()]);
            add_run(self, lo, m, gx, gy, gz, &mut density[run]);
        }
    }

    fn add_hessian_product(&self, _: Components, v: Components, mut out: ComponentsMut) {
        let n = v.sites();
        for i in 0..n {
            let (previous, next) = ((i + n - 1) % n, (i + 1) % n);
            out.add(i, self.slope(self.d[i], self.d[previous], v.get(next), v.get(previous)));
        }
    }

    fn add_blocks(&self, _: Components, blocks: &mut Blocks) {
        for (i, &d) in self.d.iter().enumerate() {
            if d != 0.0 {
                blocks.bond[0].add(i, cross_block(vector::scale(d, self.direction)));
            }
        }
    }

    fn reach(&self) -> usize {
        1
    }

    fn axes(&self) -> Vec<Vector> {
        vec![self.direction]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::density_of;

    #[test]
    fn a_right_handed_quarter_turn_about_d_costs_plus_d() {
        let m = [1.0, 0.0, 0.0, 1.0, 0.0, 0.0];
        let term = Dmi { direction: [0.0, 0.0, 1.0], d: vec![2.0, 0.0] };
        assert_eq!(density_of(&term, &m), [2.0, 0.0]);
    }
}
