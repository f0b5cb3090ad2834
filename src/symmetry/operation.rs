//! One operation: spins moved to other sites and turned or reflected, all alike.

use super::frames::{SAME, are_alike};
use crate::field::{Components, ComponentsMut};
use crate::geometry::matrix::{UNIT, apart, determinant, opposite, product, times, transposed};
use crate::geometry::{Direction, Matrix, Vector, vector};
use crate::lattice::{Lattice, Motion};
use std::fmt;
use std::sync::Arc;

/// m ↦ m' with m'_i = R m_p(i), R orthogonal. What has no spin of its own to move, a vacant site or one that is frozen, stays as it is.
#[derive(Clone, Debug)]
pub struct Operation {
    /// p: from where each site takes its spin.
    pub motion: Motion,
    /// R: a rotation, or, with determinant −1, one together with m → −m.
    pub spin: Matrix,
    pub(super) lattice: Arc<Lattice>,
    pub(super) held: Arc<[bool]>,
}

impl Operation {
    /// Whether nothing is moved.
    pub fn is_identity(&self) -> bool {
        self.motion.is_none() && self.moves_sites_alone()
    }

    /// Whether another one does the same.
    pub fn is_same(&self, other: &Operation) -> bool {
        self.motion == other.motion && apart(&self.spin, &other.spin) < SAME
    }

    /// Whether every spin that moves is the same at another site.
    pub fn moves_sites_alone(&self) -> bool {
        apart(&self.spin, &UNIT) < SAME
    }

    /// Whether every spin is turned about this axis, or not at all.
    pub fn turns_about(&self, axis: Vector) -> bool {
        are_alike(&self.spin, &UNIT, &[axis])
    }

    /// p(i).
    #[inline]
    pub fn source(&self, i: usize) -> usize {
        // what leaves the lattice is no operation
        self.motion.of(&self.lattice, i).unwrap_or(i)
    }

    /// m'_i of component-major spins (3N numbers).
    #[inline]
    pub fn at(&self, m: Components, i: usize) -> Vector {
        if self.held[i] { m.get(i) } else { times(&self.spin, m.get(self.source(i))) }
    }

    /// m' of component-major spins (3N numbers).
    pub fn apply(&self, m: &[f64]) -> Vec<f64> {
        let (from, mut moved) = (Components::new(m), vec![0.0; m.len()]);
        let mut to = ComponentsMut::new(&mut moved);
        (0..from.sites()).for_each(|i| to.set(i, self.at(from, i)));
        moved
    }

    /// R v_p(i) of a component-major tangent field at m (3N numbers), which is tangent at m'. It vanishes where spins are held.
    pub fn apply_field(&self, v: &[f64]) -> Vec<f64> {
        let mut moved = self.apply(v);
        let mut to = ComponentsMut::new(&mut moved);
        (0..self.held.len()).filter(|i| self.held[*i]).for_each(|i| to.set(i, [0.0; 3]));
        moved
    }

    /// v of which a tangent field at m' is R v_p(i) (3N numbers): what [`apply_field`](Self::apply_field) makes, undone.
    pub fn undone_field(&self, moved: &[f64]) -> Vec<f64> {
        let (from, mut v) = (Components::new(moved), vec![0.0; moved.len()]);
        let (mut to, back) = (ComponentsMut::new(&mut v), transposed(&self.spin));
        (0..self.held.len()).filter(|i| !self.held[*i]).for_each(|i| to.set(self.source(i), times(&back, from.get(i))));
        v
    }

    /// What first `first` and then this one does.
    pub fn after(&self, first: &Operation) -> Operation {
        Operation {
            motion: first.motion.after(&self.motion, &self.lattice),
            spin: product(&self.spin, &first.spin),
            ..self.clone()
        }
    }
}

impl fmt::Display for Operation {
    /// "mirrored chain with m_x → −m_x", "shifted by 3 sites", "m turned by 90° about +z".
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match (self.motion.is_none(), self.moves_sites_alone()) {
            (true, true) => f.write_str("nothing moved"),
            (true, false) => f.write_str(&of_spins(&self.spin)),
            (false, true) => f.write_str(&of_sites(&self.motion, &self.lattice)),
            _ => write!(f, "{} with {}", of_sites(&self.motion, &self.lattice), of_spins(&self.spin)),
        }
    }
}

fn of_sites(motion: &Motion, lattice: &Lattice) -> String {
    // spins go the other way than the sites that they are taken from
    let turn = transposed(motion.turn());
    let turned = match (apart(&turn, &UNIT) < SAME, lattice.is_row()) {
        (true, _) => None,
        (_, true) => Some("mirrored chain".to_string()),
        _ => Some(format!("lattice {}", turned(&turn))),
    };
    let by = match (motion.shifts_by(), lattice.is_row()) {
        (Some([0, 0, 0]), _) | (None, false) => None,
        (Some(by), false) => Some(format!("shifted by {by:?} cells")),
        (_, true) => Some(motion.beside_mirror(lattice)).filter(|n| *n > 0).map(|n| match n {
            1 => "shifted by a site".into(),
            n => format!("shifted by {n} sites"),
        }),
    };
    turned.into_iter().chain(by).collect::<Vec<_>>().join(", ")
}

fn of_spins(r: &Matrix) -> String {
    let off = |i: usize| (0..3).any(|j| j != i && r[i][j].abs() > SAME);
    if !(0..3).any(off) {
        let flipped: String = "xyz".chars().zip(0..3).filter(|(_, i)| r[*i][*i] < 0.0).map(|(name, _)| name).collect();
        return format!("m_{flipped} → −m_{flipped}");
    }
    format!("m {}", turned(r))
}

fn turned(r: &Matrix) -> String {
    let proper = if determinant(r) > 0.0 { *r } else { opposite(r) };
    let (axis, degrees) = turn(&proper);
    match (determinant(r) > 0.0, degrees) {
        (true, _) => format!("turned by {degrees}° about {axis}"),
        (false, 180) => format!("mirrored along {axis}"),
        (false, 0) => "inverted".into(),
        _ => format!("turned by {degrees}° about {axis} and reversed"),
    }
}

/// Axis and angle (degrees, to the nearest) of a rotation that is not none.
fn turn(r: &Matrix) -> (Direction, i64) {
    let cosine = 0.5 * (r[0][0] + r[1][1] + r[2][2] - 1.0);
    let degrees = libm::round(libm::acos(cosine.clamp(-1.0, 1.0)).to_degrees()) as i64;
    let odd = [r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]];
    // of a half turn, R + 1 = 2 e eᵀ
    let columns = [0, 1, 2].map(|c| vector::add(r[c], UNIT[c]));
    let longest = columns.into_iter().max_by(|a, b| vector::norm(*a).total_cmp(&vector::norm(*b)));
    let axis = if vector::norm(odd) > SAME { odd } else { longest.unwrap_or(odd) };
    // either way for a half turn
    let back = degrees == 180 && axis.into_iter().find(|c| c.abs() > SAME).is_some_and(|c| c < 0.0);
    let axis = axis.map(|c| if c.abs() < SAME { 0.0 } else { c * if back { -1.0 } else { 1.0 } });
    (Direction::new(axis).unwrap_or(Direction::Z), degrees)
}
