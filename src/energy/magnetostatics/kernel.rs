//! The interaction of the sites of a chain as a function of their distance.
//!
//! A ring is the infinite straight row of its periodic images: K(n) = Σ_p N(|n + pL|) over all integers p, with the site's own
//! images in K(0). Near images are added one by one, the others by the Hurwitz zeta functions of [`super::series`].

use super::newell::cell_tensor;
use super::series::Series;

/// What stands on the sites.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// Point dipoles; lengths are in units of the spacing, so the volume of a cell is 1.
    Dipoles,
    /// Uniformly magnetised cells.
    Cells {
        /// Width over spacing.
        width: f64,
        /// Thickness over spacing.
        thickness: f64,
    },
}

/// The diagonal tensors of a chain, in its own axes (along, width, thickness), per volume of a cell.
#[derive(Clone, Debug)]
pub struct Kernel {
    /// What stands on the sites.
    pub shape: Shape,
    /// `table[c][n]`: xx, yy, zz of two sites n apart, n = 0 … N − 1; images included in a ring.
    pub table: [Vec<f64>; 3],
}

impl Kernel {
    /// Of a chain of `sites` sites.
    pub fn new(shape: Shape, sites: usize, periodic: bool) -> Kernel {
        let series = match shape {
            Shape::Dipoles => Series::of_dipoles(),
            Shape::Cells { width, thickness } => Series::of_cells(width, thickness),
        };
        let near = near_tensors(shape, if periodic { series.first() } else { series.first().min(sites) });
        let single = |n: usize| near.get(n).copied().unwrap_or_else(|| series.at(n as f64));
        let tensor =
            |n: usize| if periodic { with_images(n, sites, near.len(), |m| near[m], &series) } else { single(n) };
        let mut table = [(); 3].map(|()| vec![0.0; sites]);
        for n in 0..sites {
            let value =
                if periodic && 2 * n > sites { [0, 1, 2].map(|c: usize| table[c][sites - n]) } else { tensor(n) };
            for c in 0..3 {
                table[c][n] = value[c];
            }
        }
        let mut kernel = Kernel { shape, table };
        kernel.symmetrise();
        kernel
    }

    /// Whether the two transverse directions are alike, so that the chain is one of rotation about its axis.
    pub fn is_axial(&self) -> bool {
        self.table[1] == self.table[2]
    }

    /// Makes alike what differs by rounding only.
    fn symmetrise(&mut self) {
        let alike = match self.shape {
            Shape::Dipoles => true,
            Shape::Cells { width, thickness } => (width - thickness).abs() <= 1e-14 * width,
        };
        if alike {
            let [_, y, z] = &mut self.table;
            for (y, z) in y.iter_mut().zip(z) {
                (*y, *z) = (0.5 * (*y + *z), 0.5 * (*y + *z));
            }
        }
    }
}

/// N(n) for n below `count`, from closed forms.
fn near_tensors(shape: Shape, count: usize) -> Vec<[f64; 3]> {
    match shape {
        Shape::Dipoles => vec![[0.0; 3]; count.min(1)],
        Shape::Cells { width, thickness } => (0..count).map(|n| cell_tensor(n, width, thickness)).collect(),
    }
}

/// Σ_p N(|n + pL|) in a ring of L sites, 2n ≤ L; images less than `close` sites away have the tensor `near`, others the series'.
pub(super) fn with_images(
    n: usize,
    ring: usize,
    close: usize,
    near: impl Fn(usize) -> [f64; 3],
    series: &Series,
) -> [f64; 3] {
    let mut sums = [0.0; 3];
    let mut add = |value: [f64; 3]| {
        for c in 0..3 {
            sums[c] += value[c];
        }
    };
    // the images on either side: n, n + L, … and L − n, 2L − n, …
    for first in [n, ring - n] {
        let by_hand = close.saturating_sub(first).div_ceil(ring);
        add(series.images((first + by_hand * ring) as f64, ring as f64));
        (0..by_hand).rev().for_each(|p| add(near(first + p * ring)));
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    const CELLS: Shape = Shape::Cells { width: 2.0, thickness: 0.5 };

    #[test]
    fn the_images_of_a_ring_are_all_counted() {
        for shape in [Shape::Dipoles, CELLS] {
            for ring in [3, 7, 40] {
                let (closed, row) = (Kernel::new(shape, ring, true), Kernel::new(shape, 40_001, false));
                for n in 0..ring {
                    for c in 0..3 {
                        let own = if n == 0 { row.table[c][0] } else { 0.0 };
                        let first = if n == 0 { ring } else { n };
                        let one_side = |first: usize| -> f64 {
                            // the tail beyond the row, by the midpoint of 1/r³ integrated
                            let all: Vec<usize> = (first..40_000).step_by(ring).collect();
                            let last = all[all.len() - 1];
                            let end = last as f64 + 0.5 * ring as f64;
                            let strength = row.table[c][last] * (last as f64).powi(3);
                            let sum: f64 = all.iter().rev().map(|&r| row.table[c][r]).sum();
                            sum + strength / (2.0 * end * end * ring as f64)
                        };
                        let expected = own + one_side(first) + one_side(ring - n);
                        let found = closed.table[c][n];
                        let scale = closed.table[c][1].abs();
                        assert!(
                            (found - expected).abs() < 2e-14 * scale,
                            "{shape:?} {ring} {n} {c}: {found} {expected}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn a_square_cross_section_is_axial_and_another_is_not() {
        for (width, thickness, axial) in [(0.3, 0.3, true), (0.3, 0.4, false)] {
            assert_eq!(Kernel::new(Shape::Cells { width, thickness }, 50, false).is_axial(), axial);
        }
        assert!(Kernel::new(Shape::Dipoles, 50, true).is_axial());
    }
}
