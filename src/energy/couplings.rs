//! Strengths of the bonds of one family.

use crate::lattice::{BondFamily, Lattice};

/// What joins each site to its partner a shift on (meV), site by site; 0 where there is no bond.
#[derive(Clone, Debug)]
pub struct Couplings {
    /// The bonds.
    pub family: BondFamily,
    /// One strength a site.
    pub mev: Vec<f64>,
}

impl Couplings {
    /// Of how many sites these are, if of any.
    pub fn sites(all: &[Couplings]) -> Option<usize> {
        all.first().map(|couplings| couplings.mev.len())
    }

    /// Whether each of these has a strength for each of so many sites.
    pub fn fit(all: &[Couplings], sites: usize) -> bool {
        all.iter().all(|couplings| couplings.mev.len() == sites)
    }

    /// None yet, on these families of a lattice of so many sites.
    pub fn none(families: Vec<BondFamily>, sites: usize) -> Vec<Couplings> {
        families.into_iter().map(|family| Couplings { family, mev: vec![0.0; sites] }).collect()
    }

    /// The same strength (meV) on all bonds of a shell.
    pub fn uniform(lattice: &Lattice, shell: usize, mev: f64) -> Vec<Couplings> {
        let mut all = Couplings::none(lattice.shell(shell), lattice.sites);
        for Couplings { family, mev: strengths } in &mut all {
            family.bonds().for_each(|[i, _]| strengths[i] = mev);
        }
        all
    }

    /// Every bond that is not zero: both sites, and its strength (meV).
    pub fn bonds(&self) -> impl Iterator<Item = ([usize; 2], f64)> + '_ {
        self.family.bonds().map(|sites| (sites, self.mev[sites[0]])).filter(|(_, mev)| *mev != 0.0)
    }
}
