//! Hamiltonians of tests, from the words of a config.

use super::{Hamiltonian, Medium, TermSpec};
use crate::lattice::{Lattice, LatticeSpec};

/// A lattice, as a config names it.
pub fn lattice(spec: &str) -> Lattice {
    serde_json::from_str::<LatticeSpec>(spec).unwrap().resolve().unwrap()
}

/// Terms on it, as a config names them.
pub fn hamiltonian(lattice: &Lattice, terms: &[&str]) -> Hamiltonian {
    let medium = Medium::new(lattice, None, None);
    let term = |text: &&str| serde_json::from_str::<TermSpec>(text).unwrap().member().build(&medium).unwrap();
    Hamiltonian::new(lattice, terms.iter().map(term).collect()).unwrap()
}
