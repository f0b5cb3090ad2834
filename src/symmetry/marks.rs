//! Marks of sites, which any operation leaves as they are: it takes a site's spin only from a site of the same mark.

use crate::lattice::{Lattice, Motion};

/// One number a site, the same where sites may be alike.
#[derive(Debug)]
pub struct Marks(Vec<u64>);

impl Marks {
    /// No site is told from another.
    pub fn none(sites: usize) -> Marks {
        Marks(vec![0; sites])
    }

    /// Sites are told apart by a whole number.
    pub fn tell(&mut self, number: impl Fn(usize) -> u64) {
        self.0.iter_mut().enumerate().for_each(|(i, mark)| *mark = mix(*mark, number(i)));
    }

    /// Sites are told apart by real numbers: where the ordered numbers leave a gap of more than `noise`.
    pub fn tell_values(&mut self, values: &[f64], noise: f64) {
        let mut order: Vec<usize> = (0..values.len()).collect();
        order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
        let mut class = vec![0; values.len()];
        for pair in order.windows(2) {
            class[pair[1]] = class[pair[0]] + u64::from(values[pair[1]] - values[pair[0]] > noise);
        }
        self.tell(|i| class[i]);
    }

    /// Sites are told apart by the marks around them too, so many cells away on either side in each direction, twice as far each
    /// time: in the end by all that stands anywhere, but for mirror images.
    pub fn look_around(&mut self, lattice: &Lattice) {
        let mut far = 1isize;
        while far < lattice.grid.size.into_iter().max().unwrap_or(0) as isize {
            let known = self.0.clone();
            let at = |i: usize, d: usize, by: isize| {
                lattice.step_from(i, d, by).map_or(u64::MAX, |j| mix(known[j], d as u64))
            };
            let beside = |i: usize, d: usize| at(i, d, far).wrapping_add(at(i, d, -far));
            self.tell(|i| (0..3).map(|d| beside(i, d)).fold(0, u64::wrapping_add));
            far *= 2;
        }
    }

    /// Whether an operation may move spins so.
    pub fn allow(&self, motion: &Motion, lattice: &Lattice) -> bool {
        (0..self.0.len()).all(|i| motion.of(lattice, i).is_some_and(|to| self.0[to] == self.0[i]))
    }

    /// The sites of the mark that the fewest have, ascending.
    pub fn rarest(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.0.len()).collect();
        order.sort_by_key(|i| (self.0[*i], *i));
        let alike = order.chunk_by(|a, b| self.0[*a] == self.0[*b]);
        alike.min_by_key(|sites| (sites.len(), sites[0])).map(<[usize]>::to_vec).unwrap_or_default()
    }
}

/// A number that hangs on both.
fn mix(a: u64, b: u64) -> u64 {
    let mut z = a.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(b).wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
