//! Which sites of a lattice are coupled to which.

use std::ops::Range;

/// Sites and their partners, without direction; a site is not its own partner.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    /// Where the partners of every site begin, and where the last ones end.
    starts: Vec<usize>,
    /// Ascending for every site.
    partners: Vec<u32>,
    /// Where the blocks of every column of sites begin, and where the last ones end.
    blocks: Vec<usize>,
}

impl Graph {
    /// The graph of so many sites and these bonds, each of which may come more than once; a bond of a site to itself is none.
    pub fn new(sites: usize, bonds: impl IntoIterator<Item = (usize, usize)>) -> Graph {
        let bonds = bonds.into_iter().filter(|(i, j)| i != j);
        let mut pairs: Vec<(u32, u32)> =
            bonds.flat_map(|(i, j)| [(i as u32, j as u32), (j as u32, i as u32)]).collect();
        pairs.sort_unstable();
        pairs.dedup();
        let (mut starts, mut blocks) = (vec![0; sites + 1], vec![0; sites + 1]);
        for (i, j) in &pairs {
            starts[*i as usize + 1] += 1;
            blocks[*i as usize + 1] += usize::from(j > i);
        }
        for i in 0..sites {
            starts[i + 1] += starts[i];
            blocks[i + 1] += blocks[i] + 1;
        }
        Graph { starts, partners: pairs.into_iter().map(|(_, j)| j).collect(), blocks }
    }

    /// Number of sites.
    pub fn sites(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// The partners of a site, ascending.
    pub fn partners(&self, site: usize) -> &[u32] {
        &self.partners[self.starts[site]..self.starts[site + 1]]
    }

    /// Number of blocks of the lower half of a matrix: sites and bonds.
    pub(super) fn block_count(&self) -> usize {
        self.blocks.last().copied().unwrap_or(0)
    }

    /// The blocks of a column of sites: first the diagonal one, then those of the partners of higher number.
    pub(super) fn blocks_of(&self, site: usize) -> Range<usize> {
        self.blocks[site]..self.blocks[site + 1]
    }

    /// The partners of higher number.
    pub(super) fn later(&self, site: usize) -> &[u32] {
        let partners = self.partners(site);
        &partners[partners.len() + 1 - self.blocks_of(site).len()..]
    }

    /// The block of row i and column j ≤ i, where there is one.
    pub(super) fn block(&self, i: usize, j: usize) -> Option<usize> {
        let first = self.blocks[j];
        if i == j {
            return Some(first);
        }
        self.later(j).binary_search(&(i as u32)).ok().map(|k| first + 1 + k)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bond_counts_once_whatever_its_direction() {
        let g = Graph::new(4, [(0, 1), (1, 0), (2, 1), (2, 2), (1, 2)]);
        assert_eq!([0, 1, 2, 3].map(|i| g.partners(i).to_vec()), [vec![1], vec![0, 2], vec![1], vec![]]);
        assert_eq!([0, 1, 2, 3].map(|i| g.later(i).to_vec()), [vec![1], vec![2], vec![], vec![]]);
        assert_eq!(g.block_count(), 6);
        assert_eq!([g.block(0, 0), g.block(1, 0), g.block(2, 1), g.block(3, 3)], [Some(0), Some(1), Some(3), Some(5)]);
        assert_eq!([g.block(2, 0), g.block(3, 2)], [None, None]);
    }
}
