//! Which bonds an energy has, shell by shell.

use crate::energy::{Block, Bonds, Hamiltonian};
use crate::geometry::{Vector, vector};

/// Lengths of bonds differ by more than this part.
const SAME: f64 = 1e-9;

/// The bonds of one length between sites of two species.
#[derive(Clone, Debug, PartialEq)]
pub struct Shell {
    /// Its number, as the term that has it first counts; by distance where a term does not count shells.
    pub number: usize,
    /// Distance, in the unit of positions.
    pub distance: f64,
    /// The two species, where there are any.
    pub species: Option<[String; 2]>,
    /// Bonds that are not zero.
    pub bonds: usize,
    /// Smallest and largest exchange J (meV).
    pub exchange_mev: [f64; 2],
    /// Smallest and largest |D| of Dzyaloshinskii and Moriya (meV).
    pub dmi_mev: [f64; 2],
}

/// All of them, the nearest first.
pub fn shells(h: &Hamiltonian) -> Vec<Shell> {
    let lattice = h.lattice();
    let mut found: Vec<Shell> = Vec::new();
    for bonds in &h.constant_blocks().bond {
        let family = &bonds.family;
        let mut names = family.hop.atoms.map(|a| lattice.species.get(lattice.atoms[a].species).cloned());
        names.sort();
        let species = match names {
            [Some(a), Some(b)] => Some([a, b]),
            _ => None,
        };
        let distance = vector::norm(family.along);
        let same = |s: &Shell| (s.distance - distance).abs() < SAME * distance && s.species == species;
        let k = found.iter().position(same).unwrap_or_else(|| {
            let none = [f64::INFINITY, f64::NEG_INFINITY];
            let number = family.shell;
            found.push(Shell {
                number,
                distance,
                species: species.clone(),
                bonds: 0,
                exchange_mev: none,
                dmi_mev: none,
            });
            found.len() - 1
        });
        for (j, d) in strengths(bonds).filter(|(j, d)| *j != 0.0 || *d != 0.0) {
            let shell = &mut found[k];
            shell.bonds += 1;
            shell.exchange_mev = within(shell.exchange_mev, j);
            shell.dmi_mev = within(shell.dmi_mev, d);
        }
    }
    found.retain(|shell| shell.bonds > 0);
    found.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    let counted = found.iter().all(|shell| shell.number > 0);
    for k in (0..found.len()).filter(|_| !counted) {
        let same = |shell: &&Shell| shell.species == found[k].species;
        found[k].number = 1 + found[..k].iter().filter(same).count();
    }
    found
}

fn within([low, high]: [f64; 2], x: f64) -> [f64; 2] {
    [low.min(x), high.max(x)]
}

/// J and |D| of every bond of a family (meV).
fn strengths(bonds: &Bonds) -> impl Iterator<Item = (f64, f64)> + '_ {
    bonds.family.bonds().map(|[i, _]| (-bonds.mean(i), bonds.rest.get(i).map_or(0.0, |b| vector::norm(turn(b)))))
}

/// D of the antisymmetric part of a block.
fn turn(b: &Block) -> Vector {
    [0.5 * (b[1][2] - b[2][1]), 0.5 * (b[2][0] - b[0][2]), 0.5 * (b[0][1] - b[1][0])]
}
