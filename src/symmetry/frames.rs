//! Which rotations and reflections of spins are worth trying: the 48 that take the axes of a frame to each other, in the frames
//! that an energy may be symmetric in.

use crate::energy::Hamiltonian;
use crate::geometry::matrix::{UNIT, apart, determinant, product, times, transposed};
use crate::geometry::{Matrix, Vector, vector};
use crate::linalg::eigen_symmetric;

/// Entries of two matrices that are the same differ by less.
pub(super) const SAME: f64 = 1e-9;

/// At most so many frames.
const MOST: usize = 8;

/// Three unit vectors at right angles, the rows of a matrix.
pub type Frame = Matrix;

/// The frames to try: x, y and z; the principal axes of Σ ∂²E/∂m_i∂m_i; those that two of the `axes` of the energy's parts span.
/// Where the energy has one axis
/// of symmetry, any operation takes it to ± itself, and a frame with that axis does.
pub fn frames(h: &Hamiltonian, symmetry: &[Vector], axes: &[Vector]) -> Vec<Frame> {
    let mut list = vec![UNIT];
    if let [axis] = symmetry {
        list.extend(beside(*axis));
    } else {
        list.push(principal(h));
        let pairs = axes.iter().enumerate().flat_map(|(k, a)| axes[k + 1..].iter().map(move |b| (a, b)));
        list.extend(pairs.filter_map(|(a, b)| spanned(*a, *b)));
        list.extend(axes.iter().filter_map(|a| beside(*a)));
    }
    let mut known: Vec<Frame> = Vec::new();
    for frame in list {
        let same = |other: &Frame| frame.iter().all(|a| other.iter().any(|b| along(*a, *b)));
        if known.len() < MOST && !known.iter().any(same) {
            known.push(frame);
        }
    }
    known
}

/// Whether two unit vectors lie along one line.
pub fn along(a: Vector, b: Vector) -> bool {
    vector::norm(vector::cross(a, b)) < SAME
}

/// a, the normal of the plane of a and b, and what is normal to both.
fn spanned(a: Vector, b: Vector) -> Option<Frame> {
    let normal = vector::unit(vector::cross(a, b)).filter(|_| !along(a, b))?;
    Some([a, normal, vector::cross(a, normal)])
}

/// A frame of which one axis is a.
fn beside(a: Vector) -> Option<Frame> {
    UNIT.iter().find_map(|e| spanned(a, *e))
}

fn principal(h: &Hamiltonian) -> Frame {
    let sum = h.constant_blocks().sites().fold([[0.0; 3]; 3], |sum, b| [0, 1, 2].map(|r| vector::add(sum[r], b[r])));
    let (_, vectors) = eigen_symmetric(&sum.concat(), 3);
    [0, 1, 2].map(|k| [vectors[k][0], vectors[k][1], vectors[k][2]])
}

/// An orthogonal matrix that takes each axis of a frame to ± one of them.
#[derive(Clone, Copy, Debug)]
pub struct Permutation {
    /// Axis k goes to ± axis `to[k]`.
    pub to: [usize; 3],
    /// Whether to the opposite one.
    pub reversed: [bool; 3],
}

impl Permutation {
    /// All 48, those first that leave the axes where they are but for signs.
    pub fn all() -> impl Iterator<Item = Permutation> {
        let orders = [[0, 1, 2], [1, 0, 2], [0, 2, 1], [2, 1, 0], [1, 2, 0], [2, 0, 1]];
        let signs = |k: u32| [0, 1, 2].map(|c| k >> c & 1 == 1);
        orders.into_iter().flat_map(move |to| (0..8).map(move |k| Permutation { to, reversed: signs(k) }))
    }

    /// Σ ± f_to(k) f_kᵀ.
    pub fn matrix(&self, frame: &Frame) -> Matrix {
        let sign = |k: usize| if self.reversed[k] { -1.0 } else { 1.0 };
        let mut rows = [[0.0; 3]; 3];
        (0..3).for_each(|k| rows[self.to[k]] = vector::scale(sign(k), frame[k]));
        product(&transposed(frame), &rows)
    }
}

/// Whether two orthogonal matrices differ by no more than a rotation about the axes of symmetry of an energy.
pub fn are_alike(a: &Matrix, b: &Matrix, symmetry: &[Vector]) -> bool {
    match symmetry {
        [] => apart(a, b) < SAME,
        [axis] => {
            let between = product(a, &transposed(b));
            determinant(&between) > 0.0 && vector::norm(vector::sub(times(&between, *axis), *axis)) < SAME
        }
        _ => determinant(a) * determinant(b) > 0.0,
    }
}
