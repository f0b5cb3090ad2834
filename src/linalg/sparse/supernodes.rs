//! The sites that are eliminated together: which of them follow from an order of elimination, and in which tree.
//!
//! Site p is the parent of j if it is the first that the elimination of j couples to what comes later (Liu, SIAM J. Matrix
//! Anal. Appl. 11, 134 (1990), doi:10.1137/0611010). A group of sites joins that of its parent wherever the arithmetic on zeros
//! that it brings costs less time than it saves.

use super::Graph;

/// No parent.
pub(super) const NONE: u32 = u32::MAX;

/// Sites that are eliminated together, in order, and what they wait for.
pub(super) struct Group {
    /// Sites, first to last.
    pub own: Vec<u32>,
    /// The groups that come before it, as numbers in the same list.
    pub children: Vec<usize>,
}

/// The groups of an order of elimination, every one after its children and the groups below those.
pub(super) fn groups(graph: &Graph, order: &[u32]) -> Vec<Group> {
    let mut place = vec![0; order.len()];
    order.iter().enumerate().for_each(|(k, i)| place[*i as usize] = k as u32);
    let before = |i: usize| {
        let partners = graph.partners(order[i] as usize).iter();
        partners.map(|j| place[*j as usize]).filter(move |k| (*k as usize) < i)
    };
    let parents = elimination_tree(order.len(), before);
    let counts = column_counts(&parents, before);
    let (heads, children) = amalgamate(&parents, &counts);
    in_postorder(order, &heads, &children)
}

/// The parent of every column.
fn elimination_tree<I: Iterator<Item = u32>>(n: usize, before: impl Fn(usize) -> I) -> Vec<u32> {
    let (mut parents, mut ancestors) = (vec![NONE; n], vec![NONE; n]);
    for i in 0..n {
        for mut k in before(i) {
            while k != NONE && k as usize != i {
                let next = std::mem::replace(&mut ancestors[k as usize], i as u32);
                if next == NONE {
                    parents[k as usize] = i as u32;
                }
                k = next;
            }
        }
    }
    parents
}

/// Number of entries below the diagonal of every column of L.
fn column_counts<I: Iterator<Item = u32>>(parents: &[u32], before: impl Fn(usize) -> I) -> Vec<usize> {
    let (mut counts, mut seen) = (vec![0; parents.len()], vec![NONE; parents.len()]);
    for i in 0..parents.len() {
        seen[i] = i as u32;
        for mut k in before(i) {
            while seen[k as usize] != i as u32 {
                seen[k as usize] = i as u32;
                counts[k as usize] += 1;
                k = parents[k as usize];
            }
        }
    }
    counts
}

/// Estimated time of a front of so many own sites and others: its arithmetic, the addition of what it leaves to another front,
/// and what every front takes.
fn cost(own: usize, others: usize) -> f64 {
    let (s, b) = (2.0 * own as f64, 2.0 * others as f64);
    flops(own, others) + 6.0 * b * b + 4.0 * (s + b) * s + 3000.0
}

/// Additions and multiplications of a front of so many own sites and others.
pub(super) fn flops(own: usize, others: usize) -> f64 {
    let (s, b) = (2.0 * own as f64, 2.0 * others as f64);
    s * (s * s / 3.0 + s * b + b * b)
}

/// The last column of every column's group, and the groups that come before that of a last column.
fn amalgamate(parents: &[u32], counts: &[usize]) -> (Vec<u32>, Vec<Vec<u32>>) {
    let n = parents.len();
    let mut heads: Vec<u32> = (0..n as u32).collect();
    let mut own = vec![1; n];
    let mut children = vec![Vec::new(); n];
    for p in 0..n {
        let waiting: Vec<u32> = std::mem::take(&mut children[p]);
        for c in waiting {
            let child = c as usize;
            let apart = cost(own[child], counts[child]) + cost(own[p], counts[p]);
            if cost(own[child] + own[p], counts[p]) <= apart {
                own[p] += own[child];
                heads[child] = p as u32;
                let grandchildren = std::mem::take(&mut children[child]);
                children[p].extend(grandchildren);
            } else {
                children[p].push(c);
            }
        }
        if parents[p] != NONE {
            children[parents[p] as usize].push(p as u32);
        }
    }
    for c in (0..n).rev() {
        heads[c] = heads[heads[c] as usize];
    }
    (heads, children)
}

/// The groups, each right after the groups below it.
fn in_postorder(order: &[u32], heads: &[u32], children: &[Vec<u32>]) -> Vec<Group> {
    let n = order.len();
    let mut own = vec![Vec::new(); n];
    (0..n).for_each(|c| own[heads[c] as usize].push(order[c]));
    let mut is_root: Vec<bool> = (0..n).map(|c| heads[c] as usize == c).collect();
    children.iter().flatten().for_each(|c| is_root[*c as usize] = false);
    let mut groups = Vec::new();
    let mut numbers = vec![0; n];
    let mut path: Vec<(usize, usize)> = Vec::new();
    for root in (0..n).filter(|c| is_root[*c]) {
        path.push((root, 0));
        while let Some((group, next)) = path.pop() {
            match children[group].get(next) {
                Some(child) => path.extend([(group, next + 1), (*child as usize, 0)]),
                None => {
                    numbers[group] = groups.len();
                    let children = children[group].iter().map(|c| numbers[*c as usize]).collect();
                    groups.push(Group { own: std::mem::take(&mut own[group]), children });
                }
            }
        }
    }
    groups
}
