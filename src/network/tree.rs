//! The disconnectivity tree: at which energies minima come apart.
//!
//! At an energy, minima that passes below it join are one branch. With falling energy branches part at saddles, until each is a
//! minimum alone. O. M. Becker, M. Karplus, J. Chem. Phys. 106, 1495 (1997), doi:10.1063/1.473299.

use super::Parts;

/// A branch of the tree.
#[derive(Clone, Debug, PartialEq)]
pub struct Branch {
    /// Where it ends below: the energy of its minimum, or of the saddle at which it parts into others.
    pub energy: f64,
    /// The minimum that it is, if it is one alone.
    pub minimum: Option<usize>,
    /// The branches into which it parts, the one with the lowest minimum first.
    pub parts: Vec<Branch>,
    /// Its lowest minimum.
    pub lowest: f64,
}

impl Branch {
    fn leaf(minimum: usize, energy: f64) -> Branch {
        Branch { energy, minimum: Some(minimum), parts: Vec::new(), lowest: energy }
    }

    fn joined(energy: f64, mut parts: Vec<Branch>) -> Branch {
        parts.sort_by(|p, q| p.lowest.total_cmp(&q.lowest));
        let lowest = parts.first().map_or(energy, |part| part.lowest);
        Branch { energy, minimum: None, parts, lowest }
    }

    /// How many minima it has.
    pub fn minima(&self) -> usize {
        if self.minimum.is_some() { 1 } else { self.parts.iter().map(Branch::minima).sum() }
    }
}

/// Minima and the energies at which they come together; several branches where no pass joins them.
#[derive(Clone, Debug, PartialEq)]
pub struct Tree {
    /// One for each part of the landscape that no pass joins with another.
    pub branches: Vec<Branch>,
}

impl Tree {
    /// Of minima with these energies and passes (two minima and an energy), in any one unit. Passes that differ by no more than
    /// `alike` are at one energy.
    pub fn of(minima: &[f64], passes: &[([usize; 2], f64)], alike: f64) -> Tree {
        let mut ascending: Vec<&([usize; 2], f64)> = passes.iter().collect();
        ascending.sort_by(|p, q| p.1.total_cmp(&q.1));
        let mut together = Parts::of(minima.len());
        let mut branches: Vec<Option<Branch>> =
            minima.iter().enumerate().map(|(k, e)| Some(Branch::leaf(k, *e))).collect();
        for &&([a, b], energy) in &ascending {
            let [a, b] = [a, b].map(|k| together.root(k));
            if a == b {
                continue;
            }
            let parts = [branches[a].take(), branches[b].take()].into_iter().flatten();
            // what came together at this very energy parts there into all of them
            let level = |branch: Branch| match branch.minimum.is_none() && energy - branch.energy <= alike {
                true => branch.parts,
                false => vec![branch],
            };
            let joined = Branch::joined(energy, parts.flat_map(level).collect());
            together.join(a, b);
            branches[a.min(b)] = Some(joined);
        }
        let mut branches: Vec<Branch> = branches.into_iter().flatten().collect();
        branches.sort_by(|p, q| p.lowest.total_cmp(&q.lowest));
        Tree { branches }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn minima_come_together_at_the_lowest_pass_between_them() {
        let minima = [0.0, 1.0, 0.5, 3.0];
        // 0–1 at 4 and at 2, 1–2 at 5; 3 by itself
        let tree = Tree::of(&minima, &[([0, 1], 4.0), ([1, 0], 2.0), ([1, 2], 5.0), ([1, 1], 1.5)], 1e-9);
        assert_eq!(tree.branches.len(), 2);
        let [whole, alone] = &tree.branches[..] else { panic!("{tree:?}") };
        assert_eq!((whole.energy, whole.minima(), alone.minimum), (5.0, 3, Some(3)));
        assert_eq!(whole.parts.iter().map(|p| p.energy).collect::<Vec<_>>(), [2.0, 0.5]);
        assert_eq!(whole.parts[0].parts.iter().map(|p| p.minimum).collect::<Vec<_>>(), [Some(0), Some(1)]);
    }

    #[test]
    fn passes_of_one_energy_part_into_all_their_minima_at_once() {
        let tree = Tree::of(&[0.0; 4], &[([0, 1], 1.0), ([1, 2], 1.0 + 1e-12), ([2, 3], 1.0 - 1e-12)], 1e-9);
        assert_eq!((tree.branches.len(), tree.branches[0].parts.len()), (1, 4));
    }
}
