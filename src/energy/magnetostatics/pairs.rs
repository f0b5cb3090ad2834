//! Cells of unequal cross-sections in a row: a tensor for each pair of sites, since the distance alone no longer says it.
//!
//! ```text
//! G(i, j) = −(4πV_iV_j)⁻¹ Δ²_x Δ²_y Δ²_z f       E = ½ μ₀ Σ_ij μ_i μ_j m_i·G(i, j) m_j
//! Δ²_y F = 2F((w_i + w_j)/2) − 2F((w_i − w_j)/2)      all cells share one axis and one length along it
//! ```
//! f is Newell's (see [`super::newell`]); for equal cells G = N/V. Distant pairs have the multipole series of both sections.
//! The sums are direct, O(N²), and the Hessian is dense.

use super::Section;
use super::kernel::with_images;
use super::newell::pair_tensor;
use super::series::{Multipoles, Series};
use crate::linalg::slab;
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

/// The diagonal tensors of all pairs of sites, in the row's own axes.
#[derive(Clone, Debug)]
pub struct Pairs {
    sites: usize,
    /// `table[c][i N + j]`: xx, yy, zz of sites i and j.
    table: [Vec<f64>; 3],
}

/// Two kinds of cells, the lower number first, and how far apart they are.
type Key = (usize, usize, usize);

impl Pairs {
    /// Of a row of cells with these sections; a ring's images are included.
    pub fn new(sections: &[Section], periodic: bool) -> Pairs {
        let sites = sections.len();
        let (kinds, kind) = kinds(sections);
        let apart = |i: usize, j: usize| if periodic { (j - i).min(sites - (j - i)) } else { j - i };
        let key = |i: usize, j: usize| (kind[i].min(kind[j]), kind[i].max(kind[j]), apart(i, j));
        let all = (0..sites).flat_map(|i| (i..sites).map(move |j| (i, j)));
        let keys: Vec<Key> = all.map(|(i, j)| key(i, j)).collect::<BTreeSet<Key>>().into_iter().collect();
        let multipoles = Multipoles::new();
        // keys of the same two kinds follow one another: they share a series
        let groups: Vec<&[Key]> = keys.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).collect();
        let ring = periodic.then_some(sites);
        let tensors: Vec<[f64; 3]> = groups
            .into_par_iter()
            .flat_map_iter(|group| of_kinds(group, kinds[group[0].0], kinds[group[0].1], ring, &multipoles))
            .collect();
        let mut table = [(); 3].map(|()| vec![0.0; sites * sites]);
        for i in 0..sites {
            for j in i..sites {
                let Ok(k) = keys.binary_search(&key(i, j)) else { continue };
                for c in 0..3 {
                    table[c][i * sites + j] = tensors[k][c];
                    table[c][j * sites + i] = tensors[k][c];
                }
            }
        }
        let mut pairs = Pairs { sites, table };
        if sections.iter().all(|[w, t]| (w - t).abs() <= 1e-14 * w) {
            pairs.make_axial();
        }
        pairs
    }

    /// Number of sites.
    pub fn sites(&self) -> usize {
        self.sites
    }

    /// G of sites i and j.
    pub fn at(&self, i: usize, j: usize) -> [f64; 3] {
        [0, 1, 2].map(|c: usize| self.table[c][i * self.sites + j])
    }

    /// Row i of component c.
    pub fn row(&self, c: usize, i: usize) -> &[f64] {
        &self.table[c][i * self.sites..(i + 1) * self.sites]
    }

    /// Every entry times `factor`.
    pub fn scale(&mut self, factor: f64) {
        self.table.iter_mut().flatten().for_each(|g| *g *= factor);
    }

    /// Whether the two transverse directions are alike.
    pub fn is_axial(&self) -> bool {
        self.table[1] == self.table[2]
    }

    /// y_i ← Σ_j G_c(i, j) x_j.
    pub fn apply(&self, c: usize, x: &[f64], y: &mut [f64]) {
        for (i, y) in y.iter_mut().enumerate() {
            *y = slab::dot(self.row(c, i), x);
        }
    }

    /// Makes alike what differs by rounding only.
    fn make_axial(&mut self) {
        let [_, y, z] = &mut self.table;
        for (y, z) in y.iter_mut().zip(z) {
            (*y, *z) = (0.5 * (*y + *z), 0.5 * (*y + *z));
        }
    }
}

/// The different sections, and which of them each site has.
fn kinds(sections: &[Section]) -> (Vec<Section>, Vec<usize>) {
    let bits = |s: &Section| s.map(f64::to_bits);
    let mut number: BTreeMap<[u64; 2], usize> = BTreeMap::new();
    let mut kinds = Vec::new();
    let mut kind = Vec::with_capacity(sections.len());
    for section in sections {
        let k = *number.entry(bits(section)).or_insert_with(|| {
            kinds.push(*section);
            kinds.len() - 1
        });
        kind.push(k);
    }
    (kinds, kind)
}

/// G of two kinds of cells at all distances of the keys; `ring` is the number of sites of a ring.
fn of_kinds(keys: &[Key], a: Section, b: Section, ring: Option<usize>, multipoles: &Multipoles) -> Vec<[f64; 3]> {
    let series = Series::of_unequal_cells(a, b, multipoles);
    let near = |n: usize| pair_tensor(n, a, b);
    let one = |&(_, _, n): &Key| match ring {
        Some(sites) => with_images(n, sites, series.first(), near, &series),
        None if n < series.first() => near(n),
        None => series.at(n as f64),
    };
    keys.iter().map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::magnetostatics::{Kernel, Shape};

    #[test]
    fn equal_cells_have_the_tensors_of_their_distance() {
        for periodic in [false, true] {
            let (width, thickness, sites) = (4.0, 1.0, 60);
            let pairs = Pairs::new(&vec![[width, thickness]; sites], periodic);
            let kernel = Kernel::new(Shape::Cells { width, thickness }, sites, periodic);
            for (i, j) in [(0, 0), (0, 1), (3, 20), (50, 8), (0, 59)] {
                for c in 0..3 {
                    let (g, n) = (width * thickness * pairs.at(i, j)[c], kernel.table[c][i.abs_diff(j)]);
                    assert!((g - n).abs() <= 1e-14 * n.abs(), "{periodic} {i} {j} {c}: {g} {n}");
                }
            }
        }
    }

    #[test]
    fn a_wide_cell_is_two_narrow_ones_side_by_side_and_their_sum_with_a_third_on_the_axis_is_exact() {
        // the wide cell 2w × t beside a small one s × t on the axis: split along its length instead, so all stay on the axis.
        // N cells of one length a are also 2N cells of length a/2: the energy of a uniform pair is the sum of four
        let (a, b) = ([4.0, 1.5], [2.5, 0.5]);
        let half = |s: Section| [2.0 * s[0], 2.0 * s[1]];
        for n in [1, 2, 5, 17, 40] {
            let whole = pair_tensor(n, a, b);
            let parts = [2 * n - 1, 2 * n, 2 * n, 2 * n + 1].map(|m| pair_tensor(m, half(a), half(b)));
            for c in 0..3 {
                // G is per volume squared in units of the spacing cubed: half the spacing, so 1/8, and a quarter of each pair
                let sum: f64 = parts.iter().map(|p| 8.0 * 0.25 * p[c]).sum();
                assert!((whole[c] - sum).abs() < 1e-13 * whole[0].abs(), "{n} {c}: {} {sum}", whole[c]);
            }
        }
    }

    #[test]
    fn the_closed_form_and_the_series_of_unequal_cells_agree_where_one_takes_over() {
        let multipoles = Multipoles::new();
        for (a, b) in [([4.0, 1.0], [3.0, 1.0]), ([0.2, 0.3], [0.7, 0.1]), ([0.5, 8.0], [2.0, 2.0])] {
            let series = Series::of_unequal_cells(a, b, &multipoles);
            for n in series.first()..series.first() + 3 {
                let (near, far) = (pair_tensor(n, a, b), series.at(n as f64));
                for c in 0..3 {
                    assert!((near[c] / far[c] - 1.0).abs() < 1e-13, "{a:?} {b:?} {n}: {near:?} {far:?}");
                }
            }
        }
    }

    #[test]
    fn pairs_do_not_magnetise_each_other_on_the_whole() {
        // outside of itself a cell's field has no sources: trace 0; inside, 1/V
        let (a, b) = ([4.0, 1.5], [2.5, 0.5]);
        for n in [1, 3, 30] {
            let g = pair_tensor(n, a, b);
            assert!(g.iter().sum::<f64>().abs() < 1e-14 * g[0].abs(), "{g:?}");
        }
        assert!((pair_tensor(0, a, a).iter().sum::<f64>() * 6.0 - 1.0).abs() < 1e-14);
    }
}
