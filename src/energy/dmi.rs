//! Dzyaloshinskii–Moriya interaction.
//!
//! ```text
//! E = + Σ D d̂·(m_i × m_j)                   every bond i–j once, r̂ from i to j
//! ∂E/∂m_i = D (m_j × d̂),   ∂E/∂m_j = D (d̂ × m_i)
//! interfacial: d̂ = n × r̂          bulk: d̂ = r̂          d2d: d̂ = r̂ mirrored along n × x̂, in the plane across n
//! ```
//! With D > 0 the lower turning sense is that in which m_i × m_j points against d̂. (A. N. Bogdanov, D. A. Yablonskii, Sov. Phys.
//! JETP 68, 101 (1989), for the kinds that crystal classes allow; A. Fert, P. M. Levy, Phys. Rev. Lett. 44, 1538 (1980),
//! doi:10.1103/PhysRevLett.44.1538, for interfaces.) Turned round, a bond of a kind has the opposite d̂, and the same energy; for
//! one of a given direction it matters which way bonds lead: up, see [`Lattice::shells`], in a chain ahead.

use super::EnergyTerm;
use super::blocks::{Blocks, cross_block};
use super::by_shell::ByShell;
use super::choice::{Choice, Valued};
use super::couplings::Couplings;
use super::spec::{FamilyBond, Medium, TermBuilder};
use crate::error::{Error, Result};
use crate::field::{Components, ComponentsMut};
use crate::geometry::{Direction, Vector, vector};
use crate::lattice::{BondFamily, Lattice, Selection, at};
use crate::profile::Profile;
use crate::registry::Described;
use crate::units::BondEnergy;
use multiversion::multiversion;
use schemars::JsonSchema;
use serde::Deserialize;
use std::ops::Range;

/// `{"D": "2 meV", "direction": [0, 1, 0]}` or `{"D": ["2 meV", "0.3 meV"], "kind": "interfacial"}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct DmiSpec {
    /// Energy per bond, or per area between cells; a list is by shell of neighbours, and in a chain without a `kind` by bond.
    pub D: ByShell<BondEnergy>,
    /// d̂, the same for all bonds.
    #[serde(default)]
    pub direction: Option<Direction>,
    /// How d̂ follows from the direction of a bond.
    #[serde(default)]
    pub kind: Option<DmiKind>,
    /// The normal n of an interface; ẑ if not given.
    #[serde(default)]
    pub normal: Option<Direction>,
    /// Only bonds with both ends among these sites; all if absent.
    #[serde(default)]
    pub sites: Option<Selection>,
    /// Only bonds from the first of these to the second, with shells of their own.
    #[serde(default)]
    pub between: Option<[Selection; 2]>,
    /// Only these bonds of a chain; all if absent.
    #[serde(default)]
    pub bonds: Option<Selection>,
}

/// How d̂ follows from r̂, the direction from the first to the second end of a bond.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DmiKind {
    /// d̂ = n × r̂, not normalised: of an interface with the normal n (C_nv). Walls and skyrmions are of Néel's kind.
    Interfacial,
    /// d̂ = r̂: of a crystal without mirrors (T, O). Walls and skyrmions are of Bloch's kind.
    Bulk,
    /// d̂ = r̂ mirrored in the plane of n and x̂, without its part along n (D_2d, S₄): antiskyrmions.
    D2d,
}

impl DmiKind {
    /// d̂ of a bond along r̂.
    fn direction(self, r: Vector, n: Vector) -> Vector {
        match self {
            DmiKind::Interfacial => vector::cross(n, r),
            DmiKind::Bulk => r,
            DmiKind::D2d => {
                let across = vector::unit_or(vector::cross(n, [1.0, 0.0, 0.0]), [0.0, 1.0, 0.0]);
                let flat = vector::normal_part(r, n);
                vector::sub(flat, vector::scale(2.0 * vector::dot(flat, across), across))
            }
        }
    }
}

impl Described for DmiSpec {
    const NAME: &'static str = "dmi";
    const SUMMARY: &'static str =
        "Dzyaloshinskii–Moriya interaction +D d·(m_i × m_j): interfacial, bulk, d2d or of one direction";
    const EXAMPLE: &'static str = r#"{"dmi": {"D": "2 meV", "direction": [0, 1, 0]}}"#;
}

impl DmiSpec {
    /// d̂ of the bonds of a family.
    fn direction(&self, along: Vector) -> Result<Vector> {
        let n = self.normal.unwrap_or(Direction::Z).vector();
        match (self.kind, self.direction, self.normal) {
            (Some(DmiKind::Bulk) | None, _, Some(_)) => Err(Error::invalid(
                "normal",
                "a normal is that of an interface: give it with \"kind\": \"interfacial\"",
            )),
            (Some(kind), None, _) => Ok(kind.direction(vector::unit_or(along, [0.0; 3]), n)),
            (None, Some(direction), _) => Ok(direction.vector()),
            (Some(_), Some(_), _) => {
                Err(Error::invalid("direction", "\"kind\" and \"direction\" are two ways to say the same: keep one"))
            }
            (None, None, _) => {
                let message =
                    "a DMI needs a \"kind\" (\"interfacial\", \"bulk\", \"d2d\") or a \"direction\" ([0, 1, 0])";
                Err(Error::invalid("", message))
            }
        }
    }

    /// D family by family.
    fn couplings(&self, medium: &Medium) -> Result<Vec<Couplings>> {
        let choice = Choice { sites: self.sites.as_ref(), between: self.between.as_ref(), bonds: self.bonds.as_ref() };
        let mev = |d: BondEnergy, bond: FamilyBond| {
            let turned = bond.reversed && self.direction.is_some();
            Ok(medium.bond_energy_mev(d, bond)? * if turned { -1.0 } else { 1.0 })
        };
        let by_bond = medium.lattice.is_row() && self.kind.is_none();
        let families = |d: &Profile<BondEnergy>, shell: usize, key: &str| match d.written().first() {
            Some(BondEnergy::PerArea(_)) if shell == 1 => medium.faces(key),
            _ => medium.shell(shell, key, &choice),
        };
        if let Some(list) = self.D.by_bond().filter(|_| by_bond) {
            return medium.on_bonds(&list, families(&list, 1, "D")?, &choice, "D", mev);
        }
        let shells = self
            .D
            .shells("D")?
            .into_iter()
            .map(|(shell, key, profile)| Ok(Valued { profile, families: families(profile, shell, &key)?, key }));
        medium.on_shells(shells.collect::<Result<_>>()?, &choice, mev)
    }
}

impl TermBuilder for DmiSpec {
    fn build(&self, medium: &Medium) -> Result<Box<dyn EnergyTerm>> {
        let families = self.couplings(medium)?;
        let directions = families.iter().map(|c| self.direction(c.family.along)).collect::<Result<_>>()?;
        Ok(Box::new(Dmi { directions, families }))
    }
}

/// Bond energies D (meV).
#[derive(Clone, Debug)]
pub struct Dmi {
    /// d̂ of each family.
    pub directions: Vec<Vector>,
    /// D of each family of bonds.
    pub families: Vec<Couplings>,
}

impl Dmi {
    /// The same D (meV) on all bonds of nearest neighbours, along one direction.
    pub fn uniform(lattice: &Lattice, d: f64, direction: Direction) -> Dmi {
        let families = Couplings::uniform(lattice, 1, d);
        Dmi { directions: vec![direction.vector(); families.len()], families }
    }

    fn parts(&self) -> impl Iterator<Item = (Vector, &Couplings)> {
        self.directions.iter().copied().zip(&self.families)
    }
}

/// A run of sites, from the first on, whose partners ahead and behind are runs of as many.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn add_run(
    (d, [ex, ey, ez]): (&[f64], Vector),
    [first, ahead, behind]: [usize; 3],
    m: Components,
    gx: &mut [f64],
    gy: &mut [f64],
    gz: &mut [f64],
    density: &mut [f64],
) {
    // all of one length to the compiler too, or it keeps the last of each run for a slower loop
    let n = gx.len();
    let [here, next, previous] = [first, ahead, behind].map(|k| m.range(k..k + n));
    let (dp, dm) = (&d[first..][..n], &d[behind..][..n]);
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

/// A run of sites with partners on one side only, ahead (`side` 1) or behind (−1); the energy is there if the bonds are of these
/// sites.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn add_side(
    (d, [ex, ey, ez], side): (&[f64], Vector, f64),
    [first, other]: [usize; 2],
    m: Components,
    gx: &mut [f64],
    gy: &mut [f64],
    gz: &mut [f64],
    density: Option<&mut [f64]>,
) {
    let n = gx.len();
    let [here, there] = [first, other].map(|k| m.range(k..k + n));
    let (d, gy, gz) = (&d[..n], &mut gy[..n], &mut gz[..n]);
    for i in 0..n {
        let (wx, wy, wz) = (d[i] * there.x[i], d[i] * there.y[i], d[i] * there.z[i]);
        gx[i] += side * (wy * ez - wz * ey);
        gy[i] += side * (wz * ex - wx * ez);
        gz[i] += side * (wx * ey - wy * ex);
    }
    let Some(density) = density else { return };
    let density = &mut density[..n];
    for i in 0..n {
        let x = here.y[i] * there.z[i] - here.z[i] * there.y[i];
        let y = here.z[i] * there.x[i] - here.x[i] * there.z[i];
        let z = here.x[i] * there.y[i] - here.y[i] * there.x[i];
        density[i] += d[i] * (ex * x + ey * y + ez * z);
    }
}

impl EnergyTerm for Dmi {
    fn name(&self) -> &'static str {
        DmiSpec::NAME
    }

    fn sites(&self) -> Option<usize> {
        Couplings::sites(&self.families)
    }

    fn fits(&self, sites: usize) -> bool {
        self.directions.len() == self.families.len() && Couplings::fit(&self.families, sites)
    }

    fn reference_mev(&self) -> f64 {
        0.0
    }

    fn add_gradient(&self, m: Components, g: ComponentsMut, density: &mut [f64], range: Range<usize>) {
        let first = range.start;
        for (e, Couplings { family, mev: d }) in self.parts() {
            for segment in family.segments(range.clone()) {
                let (start, run) = (segment.sites.start, segment.sites.start - first..segment.sites.end - first);
                let [x, y, z] = [&mut *g.x, &mut *g.y, &mut *g.z].map(|c| &mut c[run.clone()]);
                let (density, partner) = (&mut density[run], |offset| at(start, offset));
                match (segment.next.map(partner), segment.previous.map(partner)) {
                    (Some(next), Some(previous)) => add_run((d, e), [start, next, previous], m, x, y, z, density),
                    (Some(next), None) => {
                        add_side((&d[start..], e, 1.0), [start, next], m, x, y, z, Some(density));
                    }
                    (None, Some(previous)) => {
                        add_side((&d[previous..], e, -1.0), [start, previous], m, x, y, z, None);
                    }
                    (None, None) => {}
                }
            }
        }
    }

    fn add_hessian_product(&self, _: Components, v: Components, out: ComponentsMut) {
        super::add_linear(self, v, out);
    }

    fn add_blocks(&self, _: Components, blocks: &mut Blocks) {
        for (e, couplings) in self.parts() {
            let Some(bonds) = blocks.of(&couplings.family) else { continue };
            couplings.bonds().for_each(|([i, _], d)| bonds.add(i, cross_block(vector::scale(d, e))));
        }
    }

    fn families(&self) -> Vec<&BondFamily> {
        self.families.iter().map(|c| &c.family).collect()
    }

    fn is_quadratic(&self) -> bool {
        true
    }

    fn axes(&self) -> Vec<Vector> {
        self.directions.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::density_of;
    use crate::lattice::Chain;

    #[test]
    fn a_right_handed_quarter_turn_about_d_costs_plus_d() {
        let m = [1.0, 0.0, 0.0, 1.0, 0.0, 0.0];
        let term = Dmi::uniform(&Chain::open(2).resolve().unwrap(), 2.0, Direction::Z);
        assert_eq!(density_of(&term, &m), [2.0, 0.0]);
    }
}
