//! What a Hamiltonian is made of: whether a term fits a lattice, the blocks of all terms, and how stiff they are.

use super::{Blocks, EnergyTerm};
use crate::error::Error;
use crate::field::Components;
use crate::geometry::Direction;
use crate::lattice::{BondFamily, Hop, Lattice};
use crate::linalg::slab;
use crate::spins::Spins;

/// What of a term does not fit a lattice, in words.
pub(super) fn fit(lattice: &Lattice, term: &dyn EnergyTerm) -> std::result::Result<(), String> {
    let sites = lattice.sites;
    if let Some(found) = term.sites().filter(|n| *n != sites) {
        return Err(format!("a term of {found} sites on a lattice of {sites}"));
    }
    if !term.fits(sites) {
        return Err(format!("its arrays are of different lengths: each has an entry for each of the {sites} sites"));
    }
    match term.families().into_iter().find(|family| !family.is_of(lattice)) {
        None => Ok(()),
        Some(family) => {
            let Hop { atoms: [from, to], shift } = family.hop;
            let bonds = format!("bonds from atom {from} to atom {to}, {shift:?} cells on");
            Err(format!(
                "a term of another lattice, which has other {bonds}: make it for the lattice of the Hamiltonian"
            ))
        }
    }
}

/// The blocks of the quadratic terms, for the bonds of all terms; in a row for all shells up to the furthest.
pub(super) fn constant_blocks(lattice: &Lattice, terms: &[Box<dyn EnergyTerm>]) -> Blocks {
    let families = match lattice.is_row() {
        true => {
            let reach = terms.iter().map(|t| t.reach()).max().unwrap_or(0);
            lattice.families(reach.min(lattice.sites - 1))
        }
        false => distinct(terms.iter().flat_map(|t| t.families())),
    };
    let mut blocks = Blocks::zeros(lattice.sites, families);
    for t in terms.iter().filter(|t| t.is_quadratic()) {
        t.add_blocks(Components::new(&vec![0.0; 3 * lattice.sites]), &mut blocks);
    }
    blocks
}

/// Each family once.
fn distinct<'a>(families: impl Iterator<Item = &'a BondFamily>) -> Vec<BondFamily> {
    let mut known: Vec<BondFamily> = Vec::new();
    for family in families {
        if !known.iter().any(|other| other.hop == family.hop) {
            known.push(family.clone());
        }
    }
    known
}

/// Two terms that count the same forces.
pub(super) fn twice(first: &str, second: &str) -> Error {
    let what = if first == second {
        format!("\"{first}\" is there twice")
    } else {
        format!("there are both \"{first}\" and \"{second}\"")
    };
    Error::invalid(
        "energy",
        format!("{what}, of the material or here: keep one, or the moments act on each other twice"),
    )
}

/// The largest stiffness or torque that a site can feel (meV), roughly, of terms with these constant blocks and this gradient.
pub(super) fn stiffness_mev(blocks: &Blocks, is_quadratic: bool, gradient: impl Fn(&[f64], &mut [f64])) -> f64 {
    let diagonal = |b: super::blocks::Block| b[0][0].abs() + b[1][1].abs() + b[2][2].abs();
    let of_blocks = blocks.sites().map(diagonal).fold(1e-280, f64::max);
    let sites = blocks.sites().count();
    // a cubic anisotropy has no torque and no gradient along its axes, and some between them
    let between = (!is_quadratic).then(|| Direction::new([1.0, 2.0, 3.0])).and_then(Result::ok);
    let axes = [Direction::X, Direction::Y, Direction::Z].into_iter().chain(between);
    let largest = axes.map(|axis| {
        let mut g = vec![0.0; 3 * sites];
        gradient(Spins::uniform(sites, axis).as_slice(), &mut g);
        slab::max_abs(&g)
    });
    largest.fold(of_blocks, f64::max)
}
