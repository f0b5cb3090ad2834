//! Computations on many things alike, side by side, and shared by processes that record together.

use super::Evaluator;
use super::recorded::{Stored, rows, through};
use crate::control::Call;
use crate::error::Result;
use crate::record::Count;
use rayon::prelude::*;
use std::ops::Add;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// A part that others are to make is waited for at least so long, and so many times as long as the own ones took; then it is made here.
const PATIENCE: Duration = Duration::from_secs(1);
const TIMES: u32 = 2;
/// How often is looked whether it is there.
const PAUSE: Duration = Duration::from_millis(20);

/// The result of `compute` for each input, which has its number, from whatever record or process there is.
pub fn recorded_each<T: Stored + Send>(
    h: Evaluator,
    kind: &str,
    input: &[&[f64]],
    compute: impl Fn(usize) -> Result<T> + Sync,
) -> Result<Vec<T>> {
    let call = h.call(kind, |print| rows(print, input));
    let all = |numbers: Vec<usize>| numbers.into_par_iter().map(&compute).collect::<Result<Vec<T>>>();
    match call.shared(|share, _| share.parts()) {
        None | Some(..2) => through(h, &call, || all((0..input.len()).collect())),
        Some(parts) => Parts { h, call, found: (0..parts).map(|_| None).collect(), inputs: input.len() }.all(all),
    }
}

/// The parts of a call: part p has the inputs p, p + n, p + 2n, …, where there are n parts.
struct Parts<'a, T> {
    h: Evaluator<'a>,
    call: Call<'a>,
    found: Vec<Option<(Vec<T>, Count)>>,
    inputs: usize,
}

impl<T: Stored + Send> Parts<'_, T> {
    fn all(mut self, compute: impl Fn(Vec<usize>) -> Result<Vec<T>>) -> Result<Vec<T>> {
        let began = Instant::now();
        let own: Vec<usize> = (0..self.found.len()).filter(|p| self.ask(|share| share.is_mine(*p))).collect();
        for part in &own {
            self.look();
            if self.found[*part].is_none() {
                self.make(*part, &compute)?;
            }
        }
        let took = began.elapsed();
        let patience = PATIENCE.max(TIMES * took);
        loop {
            self.call.obey(|| None::<Vec<T>>)?;
            self.look();
            let missing: Vec<usize> = (0..self.found.len()).filter(|p| self.found[*p].is_none()).collect();
            let Some(last) = missing.len().checked_sub(1) else { break };
            let late = missing.iter().all(|part| self.ask(|share| share.is_late(*part)));
            if !late && began.elapsed() < took + patience {
                sleep(PAUSE);
                continue;
            }
            // several that wait begin with different ones
            let next = missing[own.first().map_or(0, |first| first % (last + 1))];
            self.make(next, &compute)?;
        }
        Ok(self.end())
    }

    fn ask<A: Default>(&self, ask: impl FnOnce(&mut dyn crate::record::Share) -> A) -> A {
        self.call.shared(|share, _| ask(share)).unwrap_or_default()
    }

    /// Takes what others have made meanwhile.
    fn look(&mut self) {
        let parts = self.found.len();
        for part in (0..parts).filter(|p| self.found[*p].is_none()).collect::<Vec<_>>() {
            let h = self.h;
            let count = (part..self.inputs).step_by(parts).len();
            let sound = |(number, found): (usize, Vec<T>)| {
                let fits = number == part && found.len() == count;
                fits.then(|| found.restored(h)).flatten().map(|found| (number, found))
            };
            self.found[part] = self.call.part(part, sound).map(|((_, found), evaluated)| (found, evaluated));
        }
    }

    fn make(&mut self, part: usize, compute: &impl Fn(Vec<usize>) -> Result<Vec<T>>) -> Result<()> {
        let before = self.h.evaluated();
        let found = compute((part..self.inputs).step_by(self.found.len()).collect());
        // what a stopped computation returns is no result
        self.call.obey(|| None::<Vec<T>>)?;
        let (found, count) = (found?, self.h.evaluated().since(before));
        self.call.add_part(part, count, &(part, &found));
        self.found[part] = Some((found, count));
        Ok(())
    }

    /// In the order of the inputs.
    fn end(self) -> Vec<T> {
        let (mut parts, counts): (Vec<_>, Vec<Count>) =
            self.found.into_iter().flatten().map(|(found, count)| (found.into_iter(), count)).unzip();
        self.call.end_parts(counts.into_iter().fold(Count::default(), Add::add));
        let n = parts.len();
        (0..self.inputs).filter_map(|k| parts[k % n].next()).collect()
    }
}
