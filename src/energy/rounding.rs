//! What the energy of a configuration is uncertain by, and what that may hide.

use super::Hamiltonian;
use super::construction::{constant_blocks, stiffness_mev};
use crate::field::{Components, ComponentsMut};

/// A sum of the energies of sites is uncertain by this part of them: some ulp.
const ROUNDED: f64 = 8.0 * f64::EPSILON;

impl Hamiltonian {
    /// What the energy of a configuration is uncertain by (meV): a site's share of it by some ulp of the largest stiffness.
    pub fn rounding_mev(&self) -> f64 {
        ROUNDED * self.stiffness_mev() * self.sites() as f64
    }

    /// The largest stiffness or torque that a site can feel (meV) of the term of this number alone.
    fn term_stiffness_mev(&self, k: usize) -> f64 {
        let (term, alone) = (&self.terms()[k], &self.terms()[k..=k]);
        let blocks = constant_blocks(self.lattice(), alone);
        stiffness_mev(&blocks, term.is_quadratic(), |m, g| {
            let mut density = vec![0.0; self.sites()];
            term.add_gradient(Components::new(m), ComponentsMut::new(g), &mut density, 0..self.sites());
        })
    }

    /// The rounding error (meV) of the energies of these configurations, where it may hide a barrier between them: a term that differs
    /// among them, by more than its own rounding, is not stiffer for a spin than that error. Nothing where no such term is there.
    pub fn hiding_rounding_mev<'a>(&self, configurations: impl Iterator<Item = &'a [f64]> + Clone) -> Option<f64> {
        let largest = |sizes: &mut dyn Iterator<Item = f64>| sizes.fold(0.0, f64::max);
        let rounding = |stiffness: f64, size: f64| ROUNDED * (stiffness * self.sites() as f64).max(size);
        let all = largest(&mut configurations.clone().map(|m| size(&self.density(m))));
        let error = rounding(self.stiffness_mev(), all);
        let may_be_hidden = |k: usize| {
            let stiffness = self.term_stiffness_mev(k);
            let densities: Vec<Vec<f64>> =
                configurations.clone().map(|m| super::density_of(self.terms()[k].as_ref(), m)).collect();
            let own = rounding(stiffness, largest(&mut densities.iter().map(|density| size(density))));
            let rises = |density: &Vec<f64>| {
                let rise: f64 = density.iter().zip(&densities[0]).map(|(here, first)| here - first).sum();
                rise.abs() > own
            };
            stiffness <= error && densities.iter().any(rises)
        };
        (0..self.terms().len()).any(may_be_hidden).then_some(error)
    }
}

/// The sum of the sizes of densities.
fn size(density: &[f64]) -> f64 {
    density.iter().map(|e| e.abs()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::test_terms::{hamiltonian, lattice};
    use crate::geometry::Direction;
    use crate::spins::Spins;

    #[test]
    fn rounding_hides_what_a_term_no_stiffer_than_that_would_make() {
        let lattice = lattice(r#"{"chain": {"sites": 12}}"#);
        let turn = |h: &Hamiltonian, axes: [Direction; 2]| {
            let states = axes.map(|axis| Spins::uniform(h.sites(), axis));
            h.hiding_rounding_mev(states.iter().map(Spins::as_slice))
        };
        let of = |j: &str| {
            let exchange = format!(r#"{{"exchange": {{"J": ["{j}"]}}}}"#);
            hamiltonian(&lattice, &[&exchange, r#"{"anisotropy": {"K": "0.5 meV", "axis": [0, 0, 1]}}"#])
        };
        let [weak, strong] = ["10 meV", "1e14 meV"].map(of);
        let out_of_the_axis = [Direction::Z, Direction::X];
        assert_eq!(turn(&weak, out_of_the_axis), None);
        assert!(turn(&strong, out_of_the_axis).is_some_and(|mev| mev > 1.0));
        // about the axis no term changes, so none is hidden
        assert_eq!(turn(&strong, [Direction::X, Direction::Y]), None);
    }
}
