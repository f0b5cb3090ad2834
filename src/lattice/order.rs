//! In which order sites are eliminated: partners near each other, so that a matrix keeps a narrow band.

use super::{BondFamily, Lattice};
use crate::linalg::{Graph, Layout, Places, Symbolic};

impl Lattice {
    /// Where every site stands in the order of elimination: as they are counted; of a ring folded, 0, N − 1, 1, N − 2, …, so that
    /// all partners within r sites of each other stand within 2r.
    pub fn places(&self) -> Vec<usize> {
        let n = self.sites;
        let folded = |i: usize| if i < n.div_ceil(2) { 2 * i } else { 2 * (n - 1 - i) + 1 };
        (0..n).map(|i| if self.is_ring() { folded(i) } else { i }).collect()
    }

    /// How a matrix of the bonds of these families is kept: as a band where the lattice is a row, as blocks of coupled sites in any
    /// other. Of a row they are those of all shells up to the furthest.
    pub fn layout(&self, families: &[&BondFamily]) -> Layout {
        if self.is_row() {
            let span = if self.is_ring() { 2 * families.len() } else { families.len() };
            return Layout::Band { span, places: Places::new(self.places()) };
        }
        let bonds = families.iter().flat_map(|family| family.bonds()).map(|[i, j]| (i, j));
        let positions: Vec<_> = (0..self.sites).map(|i| self.position(i)).collect();
        Layout::Sparse(Symbolic::of(Graph::new(self.sites, bonds), &positions).into())
    }
}

#[cfg(test)]
mod tests {
    use crate::lattice::Chain;

    #[test]
    fn a_folded_ring_keeps_partners_together_and_every_place_has_one_site() {
        for n in [3, 4, 9, 10] {
            let ring = Chain::ring(n).resolve().unwrap();
            let places = ring.places();
            assert_eq!((places[0], places[n - 1], places[1]), (0, 1, 2));
            let mut all = places.clone();
            all.sort_unstable();
            assert!(all.iter().enumerate().all(|(k, place)| k == *place));
            assert!(ring.bonds(1).iter().all(|b| places[b.sites[0]].abs_diff(places[b.sites[1]]) <= 2));
            assert!(Chain::open(n).resolve().unwrap().places().is_sorted());
        }
    }
}
