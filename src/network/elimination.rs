//! Mean first-passage times by taking states out one by one: the graph transformation.
//!
//! P_ij is the probability that the next state after i is j, τ_i the mean time until then. With x taken out,
//!
//! ```text
//! P_ij ← P_ij + P_ix P_xj/(1 − P_xx)      τ_i ← τ_i + P_ix τ_x/(1 − P_xx)      1 − P_xx = Σ_{j≠x} P_xj
//! ```
//! and every mean first-passage time between the states that remain is as it was. Nothing is subtracted, so it is as exact at
//! barriers of hundreds of k_BT as at low ones. S. A. Trygubenko, D. J. Wales, J. Chem. Phys. 124, 234110 (2006),
//! doi:10.1063/1.2198806; without subtraction: W. K. Grassmann, M. I. Taksar, D. P. Heyman, Oper. Res. 33, 1107 (1985),
//! doi:10.1287/opre.33.5.1107.

use crate::linalg::log_sum;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, BinaryHeap};

/// The states that are left.
struct States {
    /// ln P_ij.
    onward: Vec<BTreeMap<usize, f64>>,
    /// From which states one comes to each.
    before: Vec<BTreeSet<usize>>,
    /// ln τ_i (s).
    ln_time: Vec<f64>,
}

/// ln of the mean time (s) from a state to the first of some others, by ln of the rates (1/s); nothing where none may ever be reached.
pub(super) fn ln_first_passage_s(ln_rates: &[BTreeMap<usize, f64>], from: usize, to: &[usize]) -> Option<f64> {
    let target: BTreeSet<usize> = to.iter().copied().collect();
    if target.contains(&from) {
        return Some(f64::NEG_INFINITY);
    }
    let inner = on_the_way(ln_rates, from, &target)?;
    let mut states = States::of(ln_rates, &inner);
    let mut left: BTreeSet<usize> = inner.into_iter().filter(|k| *k != from).collect();
    // that with the fewest ways through it first; what changed since a state was put in is seen when its turn comes
    let mut turns: BinaryHeap<_> = left.iter().map(|k| Reverse((states.ways(*k), *k))).collect();
    while let Some(Reverse((ways, x))) = turns.pop() {
        if ways == states.ways(x) && left.remove(&x) {
            let touched = states.take_out(x);
            turns.extend(touched.into_iter().filter(|k| left.contains(k)).map(|k| Reverse((states.ways(k), k))));
        }
    }
    Some(states.ln_time[from] - states.ln_leaves(from))
}

/// The states that are reached from one without passing a target; nothing if there are some from which no target is.
fn on_the_way(ln_rates: &[BTreeMap<usize, f64>], from: usize, target: &BTreeSet<usize>) -> Option<BTreeSet<usize>> {
    let mut inner = BTreeSet::from([from]);
    let mut back: Vec<Vec<usize>> = vec![Vec::new(); ln_rates.len()];
    let mut front = vec![from];
    while let Some(i) = front.pop() {
        for &j in ln_rates[i].keys() {
            back[j].push(i);
            if !target.contains(&j) && inner.insert(j) {
                front.push(j);
            }
        }
    }
    let mut arrive: BTreeSet<usize> = BTreeSet::new();
    let mut front: Vec<usize> = target.iter().copied().collect();
    while let Some(j) = front.pop() {
        front.extend(back[j].iter().copied().filter(|i| arrive.insert(*i)));
    }
    inner.is_subset(&arrive).then_some(inner)
}

impl States {
    fn of(ln_rates: &[BTreeMap<usize, f64>], inner: &BTreeSet<usize>) -> States {
        let n = ln_rates.len();
        let mut states = States {
            onward: vec![BTreeMap::new(); n],
            before: vec![BTreeSet::new(); n],
            ln_time: vec![f64::NEG_INFINITY; n],
        };
        for &i in inner {
            let total = ln_rates[i].values().copied().fold(f64::NEG_INFINITY, log_sum);
            states.ln_time[i] = -total;
            states.onward[i] = ln_rates[i].iter().map(|(j, ln)| (*j, ln - total)).collect();
            ln_rates[i].keys().for_each(|j| {
                states.before[*j].insert(i);
            });
        }
        states
    }

    /// ln(1 − P_xx).
    fn ln_leaves(&self, x: usize) -> f64 {
        self.onward[x].iter().filter(|(j, _)| **j != x).fold(f64::NEG_INFINITY, |sum, (_, ln)| log_sum(sum, *ln))
    }

    /// How many ways lead through a state.
    fn ways(&self, x: usize) -> usize {
        self.before[x].len() * self.onward[x].len()
    }

    /// Takes a state out; those that lead to it, and those that it leads to.
    fn take_out(&mut self, x: usize) -> BTreeSet<usize> {
        let leaves = self.ln_leaves(x);
        let (through, own) = (std::mem::take(&mut self.onward[x]), std::mem::take(&mut self.before[x]));
        for (j, _) in through.iter().filter(|(j, _)| **j != x) {
            self.before[*j].remove(&x);
        }
        for &i in own.iter().filter(|i| **i != x) {
            let Some(to_x) = self.onward[i].remove(&x) else { continue };
            let part = to_x - leaves;
            self.ln_time[i] = log_sum(self.ln_time[i], part + self.ln_time[x]);
            for (&j, ln) in through.iter().filter(|(j, _)| **j != x) {
                let onward = self.onward[i].entry(j).or_insert(f64::NEG_INFINITY);
                *onward = log_sum(*onward, part + ln);
                self.before[j].insert(i);
            }
        }
        own.into_iter().chain(through.into_keys()).collect()
    }
}
