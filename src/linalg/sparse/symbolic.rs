//! What of a factorisation follows from the pattern alone: the fronts, where everything stands in them, memory and arithmetic.

use super::memory::Spare;
use super::supernodes::{self, Group, NONE};
use super::{Graph, nested_dissection};
use crate::linalg::panels::{self, SITES, WIDTH};
use std::ops::Range;

/// Factors of less arithmetic than this are computed by one thread: some 10 ms.
const WORTH: f64 = 1e8;
/// A branch is no more than one of so many parts of the work.
const PIECES: f64 = 16.0;

/// The plan of the LDLᵀ of all matrices of a graph; computed once a lattice.
#[derive(Clone, Debug, Default)]
pub struct Symbolic {
    pub(super) graph: Graph,
    /// When every site is eliminated.
    pub(super) place: Vec<u32>,
    pub(super) fronts: Vec<Front>,
    /// The places of the other sites of the fronts, ascending in each.
    pub(super) others: Vec<u32>,
    /// Where those stand in the front above, in sites.
    pub(super) slots: Vec<u32>,
    pub(super) children: Vec<u32>,
    /// Where the blocks of the matrix stand in the fronts.
    pub(super) targets: Vec<Target>,
    /// Entries of L.
    pub(super) entries: usize,
    /// Pivots, with those that fill the last panel of a front.
    pub(super) pivots: usize,
    /// Rows of the largest front.
    pub(super) most_rows: usize,
    /// Whole branches of the tree that can be eliminated side by side, ascending; the other fronts are the trunk. None where that
    /// would gain nothing.
    pub(super) branches: Vec<Branch>,
    /// Most entries of the trunk that wait in either stack.
    pub(super) waiting: [usize; 2],
    flops: f64,
    /// For the next factors.
    pub(super) spare: Spare,
}

/// A front and all that are below it.
#[derive(Clone, Debug, Default)]
pub(super) struct Branch {
    pub fronts: Range<usize>,
    /// Most entries that wait in either stack.
    pub waiting: [usize; 2],
}

/// Sites that are eliminated together, and those they are coupled to then.
#[derive(Clone, Debug, Default)]
pub(super) struct Front {
    /// Places of its own sites.
    pub own: Range<usize>,
    /// Its other sites in `others`.
    pub others: Range<usize>,
    /// Panels of own columns.
    pub panels: usize,
    /// Its columns of L.
    pub entries: Range<usize>,
    /// Its first pivot.
    pub pivot: usize,
    pub children: Range<usize>,
    pub targets: Range<usize>,
    /// The stack that takes what is left: not that of its children.
    pub stack: usize,
}

impl Front {
    /// Rows of the own sites, whole panels.
    pub fn own_rows(&self) -> usize {
        WIDTH * self.panels
    }

    /// Rows of the other sites.
    pub fn other_rows(&self) -> usize {
        2 * self.others.len()
    }

    pub fn rows(&self) -> usize {
        self.own_rows() + self.other_rows()
    }

    /// Entries of what is left for the front above.
    pub fn left(&self) -> usize {
        panels::length(self.other_rows(), self.others.len().div_ceil(SITES))
    }
}

/// A block of the matrix in the columns of a front: where its first entry stands, and whether the site of its column is
/// eliminated last, so that it stands there mirrored.
#[derive(Clone, Copy, Debug)]
pub(super) struct Target {
    pub block: u32,
    pub mirrored: bool,
    /// From the first entry of the front.
    pub at: usize,
}

impl Symbolic {
    /// The plan for sites at these positions: nested dissection.
    pub fn of(graph: Graph, positions: &[[f64; 3]]) -> Symbolic {
        let order = nested_dissection(&graph, positions);
        Symbolic::in_order(graph, &order)
    }

    /// The plan that eliminates in a given order, but for changes that save time and add nothing to the factors.
    pub fn in_order(graph: Graph, order: &[u32]) -> Symbolic {
        let groups = supernodes::groups(&graph, order);
        let mut place = vec![0; order.len()];
        let sites = groups.iter().flat_map(|g| &g.own);
        sites.enumerate().for_each(|(k, i)| place[*i as usize] = k as u32);
        let mut plan = Symbolic { graph, place, ..Symbolic::default() };
        plan.set_fronts(&groups);
        plan.set_slots(&groups);
        plan.set_sizes();
        plan
    }

    /// Number of unknowns.
    pub fn order(&self) -> usize {
        2 * self.graph.sites()
    }

    /// The graph of the matrices.
    pub fn graph(&self) -> &Graph {
        &self.graph
    }

    /// Memory of a matrix, its factors and their computation by so many threads, in bytes.
    pub fn bytes(&self, threads: usize) -> usize {
        let mut stacks: Vec<usize> = self.branches.iter().map(|branch| branch.waiting.iter().sum()).collect();
        stacks.sort_unstable_by(|a, b| b.cmp(a));
        let of_branches = stacks.iter().take(threads).sum::<usize>()
            + self.branches.iter().map(|branch| self.fronts[branch.fronts.end - 1].left()).sum::<usize>();
        let numbers = 4 * self.graph.block_count() + self.entries + self.pivots + self.waiting.iter().sum::<usize>();
        (numbers + of_branches) * size_of::<f64>()
    }

    /// Memory of a matrix that is not factorised, in bytes.
    pub fn matrix_bytes(&self) -> usize {
        4 * self.graph.block_count() * size_of::<f64>()
    }

    /// The arithmetic of a factorisation, in those of a solution by it. (A film of 40² sites: 20.)
    pub fn solutions(&self) -> f64 {
        self.flops / (4.0 * self.entries.max(1) as f64)
    }

    /// Additions and multiplications of a factorisation.
    pub fn flops(&self) -> f64 {
        self.flops
    }

    /// The sites of every front: own ones, and what those and the fronts below reach.
    fn set_fronts(&mut self, groups: &[Group]) {
        let mut seen = vec![NONE; self.place.len()];
        for (k, group) in groups.iter().enumerate() {
            let first = self.fronts.last().map_or(0, |f: &Front| f.own.end);
            let own = first..first + group.own.len();
            let start = self.others.len();
            let mut found = |place: u32, others: &mut Vec<u32>| {
                if place as usize >= own.end && seen[place as usize] != k as u32 {
                    seen[place as usize] = k as u32;
                    others.push(place);
                }
            };
            for i in &group.own {
                let partners = self.graph.partners(*i as usize).iter();
                partners.for_each(|j| found(self.place[*j as usize], &mut self.others));
            }
            for c in &group.children {
                let below = self.fronts[*c].others.clone();
                below.for_each(|e| found(self.others[e], &mut self.others));
            }
            self.others[start..].sort_unstable();
            let children = self.children.len()..self.children.len() + group.children.len();
            self.children.extend(group.children.iter().map(|c| *c as u32));
            let panels = own.len().div_ceil(SITES);
            self.fronts.push(Front { own, others: start..self.others.len(), panels, children, ..Front::default() });
        }
    }

    /// Where in the fronts the sites stand: the other sites of those below, and the blocks of the matrix.
    fn set_slots(&mut self, groups: &[Group]) {
        self.slots = vec![0; self.others.len()];
        let mut slot = vec![0; self.place.len()];
        for (k, group) in groups.iter().enumerate() {
            let front = self.fronts[k].clone();
            front.own.clone().enumerate().for_each(|(k, place)| slot[place] = k as u32);
            let first = SITES * front.panels;
            let others = &self.others[front.others.clone()];
            others.iter().enumerate().for_each(|(k, place)| slot[*place as usize] = (first + k) as u32);
            for c in &self.children[front.children.clone()] {
                for e in self.fronts[*c as usize].others.clone() {
                    self.slots[e] = slot[self.others[e] as usize];
                }
            }
            let start = self.targets.len();
            for (column, i) in group.own.iter().enumerate() {
                self.add_targets(*i as usize, column, front.rows(), &slot);
            }
            self.fronts[k].targets = start..self.targets.len();
        }
    }

    /// The blocks of site i, a column of a front of so many rows, with itself and with those that are eliminated later.
    fn add_targets(&mut self, i: usize, column: usize, rows: usize, slot: &[u32]) {
        let (graph, place) = (&self.graph, &self.place);
        let partners = graph.partners(i).iter().map(|j| *j as usize);
        for j in partners.filter(|j| place[*j] > place[i]).chain([i]) {
            let Some(block) = graph.block(i.max(j), i.min(j)) else { continue };
            let (panel, row) = (column / SITES, 2 * slot[place[j] as usize] as usize);
            let at = panels::first(rows, panel) + WIDTH * (row - WIDTH * panel) + 2 * (column % SITES);
            self.targets.push(Target { block: block as u32, mirrored: i > j, at });
        }
    }

    /// Where the fronts stand in the memory of the factors, and which stack takes what they leave.
    fn set_sizes(&mut self) {
        for k in (0..self.fronts.len()).rev() {
            let stack = self.fronts[k].stack;
            for c in &self.children[self.fronts[k].children.clone()] {
                self.fronts[*c as usize].stack = 1 - stack;
            }
        }
        for front in &mut self.fronts {
            let length = panels::length(front.rows(), front.panels);
            (front.entries, front.pivot) = (self.entries..self.entries + length, self.pivots);
            self.entries += length;
            self.pivots += front.own_rows();
            self.most_rows = self.most_rows.max(front.rows());
        }
        self.set_branches();
        for k in 0..self.branches.len() {
            self.branches[k].waiting = self.most_waiting(self.branches[k].fronts.clone());
        }
        self.waiting = self.most_waiting(0..self.fronts.len());
    }

    /// The plan that eliminates front after front.
    #[cfg(test)]
    pub(super) fn without_branches(&self) -> Symbolic {
        let mut plan = Symbolic { branches: Vec::new(), ..self.clone() };
        plan.waiting = plan.most_waiting(0..plan.fronts.len());
        plan
    }

    /// Which branches are eliminated side by side: the largest that are no more than a part of the work each.
    fn set_branches(&mut self) {
        // the arithmetic of the branch that ends with a front, and the first of its fronts
        let mut branches: Vec<(f64, usize)> = Vec::with_capacity(self.fronts.len());
        for (k, front) in self.fronts.iter().enumerate() {
            let own = supernodes::flops(front.own.len(), front.others.len());
            let children = self.children[front.children.clone()].iter().map(|c| branches[*c as usize]);
            branches.push(children.fold((own, k), |(flops, first), (f, c)| (flops + f, first.min(c))));
            self.flops += own;
        }
        if self.flops < WORTH {
            return;
        }
        let mut end = self.fronts.len();
        while end > 0 {
            let (flops, first) = branches[end - 1];
            if flops > self.flops / PIECES {
                end -= 1;
            } else {
                self.branches.push(Branch { fronts: first..end, waiting: [0; 2] });
                end = first;
            }
        }
        self.branches.reverse();
    }

    /// Most entries that wait in either stack while these fronts are eliminated, branches within them apart.
    fn most_waiting(&self, fronts: Range<usize>) -> [usize; 2] {
        let (mut waiting, mut most) = ([0; 2], [0; 2]);
        let inner: Vec<&Range<usize>> =
            self.branches.iter().map(|branch| &branch.fronts).filter(|f| **f != fronts).collect();
        let is_inside = |k: usize| inner.get(inner.partition_point(|f| f.end <= k)).is_some_and(|f| f.contains(&k));
        for k in fronts.filter(|k| !is_inside(*k)) {
            let front = &self.fronts[k];
            waiting[front.stack] += front.left();
            most[front.stack] = most[front.stack].max(waiting[front.stack]);
            let children = self.children[front.children.clone()].iter().filter(|c| !is_inside(**c as usize));
            waiting[1 - front.stack] -= children.map(|c| self.fronts[*c as usize].left()).sum::<usize>();
        }
        most
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples;
    use rand::SeedableRng;

    #[test]
    fn fronts_hold_what_elimination_fills_and_no_other_site() {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(51);
        for lattice in samples::all(&mut r) {
            let n = lattice.positions.len();
            let plan = lattice.zeros().plan().clone();
            let mut filled = vec![false; n * n];
            for (i, j) in &lattice.bonds {
                let (i, j) = (plan.place[*i] as usize, plan.place[*j] as usize);
                (filled[i * n + j], filled[j * n + i]) = (true, true);
            }
            for k in 0..n {
                let later: Vec<usize> = (k + 1..n).filter(|i| filled[i * n + k]).collect();
                later.iter().for_each(|i| later.iter().for_each(|j| filled[i * n + j] = true));
            }
            let mut next = 0;
            for front in &plan.fronts {
                assert_eq!(front.own.start, next);
                next = front.own.end;
                let reached = (next..n).filter(|i| front.own.clone().any(|k| filled[i * n + k]));
                let others = plan.others[front.others.clone()].iter().map(|i| *i as usize);
                assert!(reached.eq(others), "{}", lattice.name);
            }
            assert_eq!(next, n);
        }
    }
}
