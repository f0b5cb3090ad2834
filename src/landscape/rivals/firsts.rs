//! From the tops of all first paths that are natural between the two states of a route, as they are made: of those that were relaxed for a
//! while and given up, and of those that went elsewhere as they relaxed. In a row bands of them are followed already, and walls are among
//! the ways of the nearest minima.

use super::{Cut, Rival};
use crate::path::Path;
use crate::path::guess::natural;
use rand_chacha::ChaCha8Rng;
use std::collections::VecDeque;

/// Images of a path: more than a little on the way is to be seen.
const IMAGES: usize = 25;

/// The starts that wait.
#[derive(Debug, Default)]
pub struct Firsts {
    /// None until they are asked for.
    next: Option<VecDeque<Vec<f64>>>,
}

impl Rival for Firsts {
    fn start(&mut self, cut: &Cut, _: &mut ChaCha8Rng) -> Option<Vec<f64>> {
        let next = self.next.get_or_insert_with(|| tops(cut).unwrap_or_default());
        next.pop_front()
    }
}

fn tops(cut: &Cut) -> Option<VecDeque<Vec<f64>>> {
    let h = cut.land.evaluator();
    if h.lattice().is_row() {
        return None;
    }
    let [a, b] = cut.ends?.map(|k| &cut.land.minima()[k].spins);
    let guesses = natural(h.hamiltonian(), a, b, &cut.context).into_iter();
    let paths = guesses.filter_map(|(guess, _)| guess.member().path(a, b, IMAGES, &cut.context).ok());
    Some(paths.flat_map(|path| tops_of(&path, |m| h.difference_mev(m, a.as_slice()))).collect())
}

/// The images between the ends that are higher than both beside them.
fn tops_of(path: &Path, height_mev: impl Fn(&[f64]) -> f64) -> Vec<Vec<f64>> {
    let heights: Vec<f64> = (0..path.images()).map(|k| height_mev(path.image(k))).collect();
    let tops = (1..path.images() - 1).filter(|k| heights[*k] > heights[k - 1] && heights[*k] >= heights[k + 1]);
    tops.map(|k| path.image(k).to_vec()).collect()
}
