//! The energy term that dipoles and cells share.

use super::{Convolution, Exponentials, Kernel, Pairs, Section, Shape};
use crate::energy::blocks::{Block, Blocks};
use crate::energy::{AllPairs, Coupling, EnergyTerm};
use crate::field::{Components, ComponentsMut};
use crate::geometry::{Direction, Vector, vector};
use crate::units::{E_CHARGE, MU_0, MU_B_MEV_PER_T};
use std::ops::Range;

/// Open chains of at most this many sites have a dense Hessian; longer ones a sum of exponentials. Rings are dense, and so are
/// cells tens of times wider than their spacing. Of more sites the images of a band are found without factors.
pub const DENSE: usize = 128;
/// Accuracy of the exponentials, of Σ|K|: below the rounding error of a Hessian.
const PRECISE: f64 = 4.0 * f64::EPSILON;

/// μ₀μ_B² (meV nm³).
pub const MU_0_MU_B_SQUARED: f64 = MU_0 * MU_B_MEV_PER_T * (1e-3 * MU_B_MEV_PER_T * E_CHARGE) * 1e27;

/// Moments in a row, each acting on all the others.
#[derive(Debug)]
pub struct Magnetostatics {
    name: &'static str,
    /// The chain's own axes: along, width, thickness.
    frame: [Vector; 3],
    /// Moment of every site (μ_B).
    moments: Vec<f64>,
    /// In meV/μ_B².
    interaction: Interaction,
    /// x̂·h_i(x̂)/2 of the chain magnetised along itself (meV).
    reference: Vec<f64>,
}

/// What two sites do to each other, the moments apart.
#[derive(Debug)]
enum Interaction {
    /// It depends on their distance alone.
    Distance(Box<ByDistance>),
    /// Each pair has its own.
    Pairs(Pairs),
}

/// A kernel, made ready for sums and for Hessians.
#[derive(Debug)]
struct ByDistance {
    kernel: Kernel,
    convolution: Convolution,
    tail: Option<Exponentials>,
}

/// What the sites are, and how they stand.
#[derive(Clone, Debug)]
pub struct Row {
    /// Dipoles, or cells.
    pub shape: Shape,
    /// Volume of a cell, or the cube of the spacing of dipoles (nm³).
    pub volume_nm3: f64,
    /// A ring: the row repeats itself.
    pub periodic: bool,
    /// Where the row points.
    pub direction: Direction,
}

impl Magnetostatics {
    /// Of sites with these moments (μ_B).
    pub fn new(name: &'static str, row: &Row, moments: Vec<f64>) -> Magnetostatics {
        let sites = moments.len();
        let mut kernel = Kernel::new(row.shape, sites, row.periodic);
        let tail = if !row.periodic && sites > DENSE { tail(&kernel) } else { None };
        let strength = MU_0_MU_B_SQUARED / row.volume_nm3;
        kernel.table.iter_mut().flatten().for_each(|k| *k *= strength);
        let scaled = |mut e: Exponentials| {
            e.weights.iter_mut().flatten().for_each(|w| *w *= strength);
            e.error *= strength;
            e
        };
        let convolution = Convolution::new(&kernel);
        let tail = tail.map(scaled);
        Magnetostatics::coupled(
            name,
            row.direction,
            moments,
            Interaction::Distance(Box::new(ByDistance { kernel, convolution, tail })),
        )
    }

    /// Of cells with these moments (μ_B) and unequal sections (in units of the spacing).
    pub fn unequal(
        name: &'static str,
        spacing_nm: f64,
        sections: &[Section],
        periodic: bool,
        direction: Direction,
        moments: Vec<f64>,
    ) -> Magnetostatics {
        let mut pairs = Pairs::new(sections, periodic);
        pairs.scale(MU_0_MU_B_SQUARED / (spacing_nm * spacing_nm * spacing_nm));
        Magnetostatics::coupled(name, direction, moments, Interaction::Pairs(pairs))
    }

    fn coupled(
        name: &'static str,
        direction: Direction,
        moments: Vec<f64>,
        interaction: Interaction,
    ) -> Magnetostatics {
        let sites = moments.len();
        let mut term =
            Magnetostatics { name, frame: frame(direction), reference: vec![0.0; sites], moments, interaction };
        let [x, y, z] = term.frame[0].map(|v| vec![v; sites]);
        let along = Components { x: &x, y: &y, z: &z };
        let field = term.field(along, 0..sites);
        term.reference =
            (0..sites).map(|i| 0.5 * vector::dot(term.frame[0], [0, 1, 2].map(|c: usize| field[c][i]))).collect();
        term
    }

    /// y_i ← Σ_j of component c, all sites.
    fn apply(&self, c: usize, x: &[f64], y: &mut [f64]) {
        match &self.interaction {
            Interaction::Distance(by) => by.convolution.apply(c, x, y),
            Interaction::Pairs(pairs) => pairs.apply(c, x, y),
        }
    }

    /// Σ_c d_c f_c f_cᵀ with the chain's axes f.
    fn in_space(&self, diagonal: [f64; 3]) -> Block {
        let entry = |r: usize, s: usize| (0..3).map(|c| diagonal[c] * self.frame[c][r] * self.frame[c][s]).sum();
        [0, 1, 2].map(|r| [0, 1, 2].map(|s| entry(r, s)))
    }

    /// h_i (meV) on the sites of `range`, x of all, y of all, z of all.
    fn field(&self, m: Components, range: Range<usize>) -> [Vec<f64>; 3] {
        let sites = self.moments.len();
        let mut field = [(); 3].map(|()| vec![0.0; range.len()]);
        let mut weighted = vec![0.0; sites];
        let mut own = vec![0.0; range.len()];
        for (c, axis) in self.frame.iter().enumerate() {
            for i in 0..sites {
                weighted[i] = self.moments[i] * (axis[0] * m.x[i] + axis[1] * m.y[i] + axis[2] * m.z[i]);
            }
            if range.len() == sites {
                self.apply(c, &weighted, &mut own);
            } else {
                for (own, i) in own.iter_mut().zip(range.clone()) {
                    *own = (0..sites).map(|j| self.pair(i, j)[c] * weighted[j]).sum();
                }
            }
            for (k, i) in range.clone().enumerate() {
                let h = self.moments[i] * own[k];
                for (field, a) in field.iter_mut().zip(axis) {
                    field[k] += h * a;
                }
            }
        }
        field
    }
}

/// The sum of exponentials; nothing where cells are so wide beside their spacing that none is precise.
fn tail(kernel: &Kernel) -> Option<Exponentials> {
    let sum = |c: usize| kernel.table[c].iter().map(|k| k.abs()).sum::<f64>();
    let scale = sum(0).max(sum(1)).max(sum(2));
    let tail = Exponentials::new(kernel, PRECISE);
    (tail.error <= 4.0 * PRECISE * scale).then_some(tail)
}

/// The axes of a chain that points along `direction`: x, y and z turned by the smallest rotation that takes x there.
fn frame(direction: Direction) -> [Vector; 3] {
    let d = direction.vector();
    let (x, y) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    if d[0] <= -1.0 + 1e-12 {
        return frame_beside(d, [0.0, -1.0, 0.0]);
    }
    // parallel transport of y along the arc from x to d
    let carried = |v: Vector| vector::sub(v, vector::scale(vector::dot(d, v) / (1.0 + d[0]), vector::add(x, d)));
    frame_beside(d, carried(y))
}

/// Right-handed axes with the first along d and the second as near to y as can be.
fn frame_beside(d: Vector, y: Vector) -> [Vector; 3] {
    let across = vector::sub(y, vector::scale(vector::dot(d, y), d));
    let y = vector::unit_or(across, y);
    [d, y, vector::cross(d, y)]
}

impl AllPairs for Magnetostatics {
    fn frame(&self) -> &[Vector; 3] {
        &self.frame
    }

    fn moments(&self) -> &[f64] {
        &self.moments
    }

    fn pair(&self, i: usize, j: usize) -> [f64; 3] {
        match &self.interaction {
            Interaction::Distance(by) => [0, 1, 2].map(|c: usize| by.kernel.table[c][i.abs_diff(j)]),
            Interaction::Pairs(pairs) => pairs.at(i, j),
        }
    }

    fn sums_of_others(&self) -> Vec<Block> {
        let sums = [0, 1, 2].map(|c: usize| {
            let mut sum = vec![0.0; self.moments.len()];
            self.apply(c, &self.moments, &mut sum);
            sum
        });
        let others = |i: usize| {
            let own = self.pair(i, i);
            [0, 1, 2].map(|c: usize| self.moments[i] * (sums[c][i] - own[c] * self.moments[i]))
        };
        (0..self.moments.len()).map(|i| self.in_space(others(i))).collect()
    }
}

impl EnergyTerm for Magnetostatics {
    fn name(&self) -> &'static str {
        self.name
    }

    fn sites(&self) -> Option<usize> {
        Some(self.moments.len())
    }

    fn reference_mev(&self) -> f64 {
        self.reference.iter().sum()
    }

    fn add_gradient(&self, m: Components, mut g: ComponentsMut, density: &mut [f64], range: Range<usize>) {
        let [x, y, z] = self.field(m, range.clone());
        for (k, i) in range.enumerate() {
            let h = [x[k], y[k], z[k]];
            density[k] += 0.5 * vector::dot(m.get(i), h) - self.reference[i];
            g.add(k, h);
        }
    }

    fn add_hessian_product(&self, _: Components, v: Components, mut out: ComponentsMut) {
        let [x, y, z] = self.field(v, 0..self.moments.len());
        for i in 0..self.moments.len() {
            out.add(i, [x[i], y[i], z[i]]);
        }
    }

    fn add_blocks(&self, _: Components, blocks: &mut Blocks) {
        let sites = self.moments.len();
        let block = |i: usize, j: usize| {
            let strength = self.moments[i] * self.moments[j];
            self.in_space(self.pair(i, j).map(|k| strength * k))
        };
        for i in 0..sites {
            blocks.add_site(i, block(i, i));
        }
        for n in 1..=self.reach() {
            for i in 0..sites - n {
                blocks.bond[n - 1].add(i, block(i, i + n));
            }
        }
    }

    fn reach(&self) -> usize {
        self.coupling().tail().map_or(0, |e| e.shells)
    }

    fn is_quadratic(&self) -> bool {
        true
    }

    fn axes(&self) -> Vec<Vector> {
        self.frame.to_vec()
    }

    fn coupling(&self) -> Coupling<'_> {
        match &self.interaction {
            Interaction::Distance(by) => Coupling::Translational(self, by.tail.as_ref()),
            Interaction::Pairs(_) => Coupling::Dense(self),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axes_of_a_chain_are_orthonormal_wherever_it_points() {
        for d in [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0], [-0.9, 0.3, 0.1]] {
            let f = frame(Direction::new(d).unwrap());
            for i in 0..3 {
                for j in 0..3 {
                    let expected = if i == j { 1.0 } else { 0.0 };
                    assert!((vector::dot(f[i], f[j]) - expected).abs() < 1e-15, "{f:?}");
                }
            }
        }
    }
}
