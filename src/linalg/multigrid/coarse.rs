//! Which unknowns stay on the next level, and how the others follow from them.

use super::{Eliminated, FEW, Rows, Runs, Wide};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// An entry couples strongly that is at least this part of the largest of its row.
const STRONG: f64 = 0.25;
/// Fewer unknowns are not gained by a level that leaves more than this part of them.
const GAIN: f64 = 0.9;

/// How the unknowns of every level follow from those of the next, for all matrices that differ in their diagonals alone.
#[derive(Debug)]
pub struct Coarsening {
    /// Where those of the first level that follow hang on the others alone.
    pub(super) eliminated: Option<Eliminated>,
    pub(super) steps: Vec<Step>,
    /// What the unit matrix of the first level is on the last.
    pub(super) square: Rows,
}

impl Coarsening {
    /// Of a symmetric positive semidefinite matrix, every row with an entry of its own.
    pub fn of(matrix: &Rows) -> Coarsening {
        let unit = Rows::new(matrix.order(), (0..matrix.order()).map(|i| vec![(i, 1.0)]));
        let eliminated = Parted::of(matrix).and_then(|parted| Eliminated::of(matrix, parted));
        let mut here = match &eliminated {
            Some(first) => [matrix, &unit].map(|m| first.parted.on_the_next(m)),
            None => [matrix.clone(), unit],
        };
        let mut steps = Vec::new();
        while let Some(parted) = Parted::of(&here[0]) {
            let [matrix, square] = &here;
            let step = Step::of(matrix, square, parted);
            here = here.each_ref().map(|m| step.parted.on_the_next(m));
            steps.push(step);
        }
        let [_, square] = here;
        Coarsening { eliminated, steps, square }
    }
}

/// The unknowns of a level: those that stay on the next, and those that follow from these.
#[derive(Debug)]
pub(super) struct Parted {
    pub stay: Vec<u32>,
    /// Those first that follow from as many that lie alike: so the rows of a matrix between the two make long runs.
    pub follow: Vec<u32>,
    /// P.
    pub p: Rows,
    /// Pᵀ.
    back: Rows,
}

impl Parted {
    /// Where a level is gained.
    fn of(matrix: &Rows) -> Option<Parted> {
        if matrix.order() <= FEW {
            return None;
        }
        let (p, kinds) = interpolation(matrix);
        let gains = p.columns() > 0 && (p.columns() as f64) < GAIN * matrix.order() as f64;
        gains.then(|| {
            let those = |stay: bool| -> Vec<u32> {
                (0..kinds.len()).filter(|i| (kinds[*i] == Kind::Stays) == stay).map(|i| i as u32).collect()
            };
            let lie = |i: &u32| {
                let columns: Vec<usize> = p.row(*i as usize).map(|(j, _)| j).collect();
                columns.iter().map(|j| j - columns[0]).collect::<Vec<_>>()
            };
            let [stay, mut follow] = [true, false].map(those);
            follow.sort_by_cached_key(lie);
            Parted { stay, follow, back: p.transposed(), p }
        })
    }

    /// Pᵀ A P.
    pub fn on_the_next(&self, matrix: &Rows) -> Rows {
        self.back.product(matrix).product(&self.p)
    }
}

/// From one level to the next.
#[derive(Debug)]
pub(super) struct Step {
    pub parted: Parted,
    /// The rows of P of those that follow, and their transposes.
    w: Runs,
    back_w: Runs,
    /// The matrix, and what the unit matrix of the first level is here.
    matrix: Runs,
    pub square: Runs,
}

impl Step {
    fn of(matrix: &Rows, square: &Rows, parted: Parted) -> Step {
        let next: Vec<u32> = (0..parted.stay.len() as u32).collect();
        let runs = Runs::of(matrix);
        Step {
            w: Runs::of(&block(&parted.p, &parted.follow, &next)),
            back_w: Runs::of(&block(&parted.back, &next, &parted.follow)),
            square: runs.with(square),
            matrix: runs,
            parted,
        }
    }

    /// A matrix of this level.
    pub fn runs(&self, matrix: &Rows) -> Runs {
        self.matrix.with(matrix)
    }

    /// out ← Pᵀ v; `room` is for those that follow.
    pub fn down(&self, v: &[Wide], room: &mut [Wide], out: &mut [Wide]) {
        gather(&self.parted.stay, v, out);
        gather(&self.parted.follow, v, room);
        self.back_w.add(1.0, room, out);
    }

    /// out ← out + P v; `room` is for those that follow.
    pub fn up(&self, v: &[Wide], room: &mut [Wide], out: &mut [Wide]) {
        room.fill([0.0; 4]);
        self.w.add(1.0, v, room);
        for (those, v) in [(&self.parted.stay, v), (&self.parted.follow, room)] {
            those.iter().zip(v).for_each(|(i, v)| (0..4).for_each(|c| out[*i as usize][c] += v[c]));
        }
    }
}

/// The entries of a matrix in these rows and columns, by places among them.
pub(super) fn block(matrix: &Rows, rows: &[u32], columns: &[u32]) -> Rows {
    let mut place = vec![None; matrix.columns()];
    columns.iter().enumerate().for_each(|(p, j)| place[*j as usize] = Some(p));
    Rows::filled(rows.len(), columns.len(), |p, row| {
        row.extend(matrix.row(rows[p] as usize).filter_map(|(j, a)| Some((place[j]?, a))));
    })
}

/// out ← those of v.
fn gather(those: &[u32], v: &[Wide], out: &mut [Wide]) {
    out.iter_mut().zip(those).for_each(|(out, i)| *out = v[*i as usize]);
}

/// What an unknown is to the next level.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Open,
    Stays,
    Follows,
}

/// P: one row an unknown, one column each that stays.
///
/// ```text
/// stays     P_ii = 1
/// follows   P_ij = −α A_ij / A_ii,   α = Σ_k A_ik / Σ_j A_ij over entries of the sign of A_ij, all of them and those that stay and
///                                    couple strongly; where none of a sign does, entries of this sign count for A_ii
/// ```
fn interpolation(matrix: &Rows) -> (Rows, Vec<Kind>) {
    let strong = strong(matrix);
    let kinds = split(&strong);
    let mut number = vec![0; kinds.len()];
    let mut columns = 0;
    for (number, _) in number.iter_mut().zip(&kinds).filter(|(_, kind)| **kind == Kind::Stays) {
        *number = columns;
        columns += 1;
    }
    let p = Rows::filled(kinds.len(), columns, |i, row| match kinds[i] {
        Kind::Stays => row.push((number[i], 1.0)),
        _ => {
            let stays = |j: usize| kinds[j] == Kind::Stays && strong.row(i).any(|(k, _)| k == j);
            follow(matrix, i, stays, row);
            row.iter_mut().for_each(|(j, _)| *j = number[*j]);
        }
    });
    (p, kinds)
}

/// The strong entries.
fn strong(matrix: &Rows) -> Rows {
    Rows::filled(matrix.order(), matrix.order(), |i, row| {
        let others = || matrix.row(i).filter(move |(j, _)| *j != i);
        let largest = others().fold(0.0f64, |most, (_, a)| most.max(a.abs()));
        row.extend(others().filter(|(_, a)| *a != 0.0 && a.abs() >= STRONG * largest));
    })
}

/// Unknown by unknown, the one first that most of the others hang on: it stays, those follow.
fn split(strong: &Rows) -> Vec<Kind> {
    let on = strong.transposed();
    let mut kinds = vec![Kind::Open; strong.order()];
    let mut wanted: Vec<usize> = (0..kinds.len()).map(|i| on.row(i).count()).collect();
    let mut queue: BinaryHeap<(usize, Reverse<usize>)> = wanted.iter().copied().zip((0..).map(Reverse)).collect();
    while let Some((want, Reverse(i))) = queue.pop() {
        if kinds[i] != Kind::Open || want != wanted[i] {
            continue;
        }
        // nothing hangs on it and it hangs on nothing: neighbours tell it all there is
        kinds[i] = if want == 0 && strong.row(i).next().is_none() { Kind::Follows } else { Kind::Stays };
        for (j, _) in on.row(i) {
            if kinds[j] != Kind::Open {
                continue;
            }
            kinds[j] = Kind::Follows;
            for (k, _) in strong.row(j).filter(|(k, _)| kinds[*k] == Kind::Open) {
                wanted[k] += 1;
                queue.push((wanted[k], Reverse(k)));
            }
        }
    }
    kinds
}

/// Writes the weights of the unknowns from which this one follows.
fn follow(matrix: &Rows, i: usize, stays: impl Fn(usize) -> bool, from: &mut Vec<(usize, f64)>) {
    let (mut all, mut those, mut own) = ([0.0; 2], [0.0; 2], 0.0);
    let sign = |a: f64| usize::from(a > 0.0);
    for (j, a) in matrix.row(i) {
        if j == i {
            own = a;
            continue;
        }
        all[sign(a)] += a;
        if stays(j) {
            those[sign(a)] += a;
            from.push((j, a));
        }
    }
    for s in [0, 1] {
        own += if those[s] == 0.0 { all[s] } else { 0.0 };
    }
    let own = own.max(1e-3 * matrix.diagonal(i));
    from.iter_mut().for_each(|(_, a)| *a = -*a * all[sign(*a)] / (those[sign(*a)] * own));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_second_unknown_of_a_row_stays_and_a_constant_goes_down_and_up() {
        for sign in [-1.0, 1.0] {
            let row = |i: usize| {
                let next = [i.wrapping_sub(1), i + 1].into_iter().filter(|j| *j < 9).map(|j| (j, sign));
                let next: Vec<_> = next.collect();
                let own = next.len() as f64;
                next.into_iter().chain([(i, own)]).collect()
            };
            let (p, _) = interpolation(&Rows::new(9, (0..9).map(row)));
            assert!((4..=5).contains(&p.columns()));
            // from a constant, or one that changes sign from site to site
            let kept: Vec<usize> = (0..9).filter(|i| p.row(*i).eq([(p.row(*i).next().unwrap().0, 1.0)])).collect();
            let value = |i: usize| if i.is_multiple_of(2) { 1.0 } else { -sign };
            let mut coarse = vec![0.0; p.columns()];
            for i in kept.iter().filter(|i| p.row(**i).count() == 1) {
                coarse[p.row(*i).next().unwrap().0] = value(*i);
            }
            for i in 0..9 {
                let here: f64 = p.row(i).map(|(j, w)| w * coarse[j]).sum();
                assert!((here - value(i)).abs() < 1e-14, "{sign} {i}: {here}");
            }
        }
    }
}
