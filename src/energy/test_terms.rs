//! Hamiltonians of tests, from the words of a config.

use super::{Hamiltonian, Medium, TermSpec};
use crate::lattice::{Lattice, LatticeSpec};
use crate::spins::Spins;

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

/// Spins along what `spin` says of each site's position, vectors of any length, and the gradient there.
pub fn posed(h: &Hamiltonian, spin: impl Fn([f64; 3]) -> [f64; 3]) -> (Spins, Vec<f64>) {
    let vectors: Vec<[f64; 3]> = (0..h.sites()).map(|i| spin(h.lattice().position(i))).collect();
    let flat: Vec<f64> = (0..3).flat_map(|c| vectors.iter().map(move |v| v[c])).collect();
    let m = Spins::from_components(&flat).expect("vectors that are not zero");
    let mut g = vec![0.0; 3 * h.sites()];
    h.energy_gradient(m.as_slice(), &mut g);
    (m, g)
}
