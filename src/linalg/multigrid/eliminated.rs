//! The unknowns that hang on those alone that stay, as every second one does where nearest neighbours couple on a square, cubic,
//! body-centred or honeycomb lattice: they are eliminated, exactly, before anything is smoothed.
//!
//! ```text
//! x_C ← B (b_C − A_CF A_FF⁻¹ b_F)      C: those that stay, F: those that follow
//! x_F ← A_FF⁻¹ (b_F − A_FC x_C)        A_FF diagonal
//! ```
//! B is that of Pᵀ A P, which is A_CC − A_CF A_FF⁻¹ A_FC where the unknowns of F follow with just these weights.

use super::coarse::{Parted, block};
use super::{Rows, Runs, Wide, interleave, scaled, spread};

/// How they hang on the others: the same for all matrices that differ in their diagonals alone.
#[derive(Debug)]
pub(super) struct Eliminated {
    pub parted: Parted,
    /// A_FC.
    following: Runs,
    /// A_CF.
    staying: Runs,
}

impl Eliminated {
    /// If none of those that follow hangs on another one of them.
    pub fn of(matrix: &Rows, parted: Parted) -> Option<Eliminated> {
        let Parted { stay, follow, .. } = &parted;
        let among = block(matrix, follow, follow);
        let is_alone = |i: usize| among.row(i).all(|(j, a)| j == i || a == 0.0);
        if !(0..among.order()).all(is_alone) {
            return None;
        }
        let following = Runs::of(&block(matrix, follow, stay));
        let staying = Runs::of(&block(matrix, stay, follow));
        Some(Eliminated { parted, following, staying })
    }

    /// A_FF⁻¹ of a matrix.
    pub fn inverse(&self, matrix: &Rows) -> Vec<f64> {
        let follow = self.parted.follow.iter();
        follow.map(|i| 1.0 / matrix.diagonal(*i as usize).max(f64::MIN_POSITIVE)).collect()
    }

    /// `b` ← b_F, and `rest` ← b_C − A_CF A_FF⁻¹ b_F; `x` is for those that follow.
    pub fn leave(&self, inverse: &[f64], v: &[f64], [b, x]: [&mut [Wide]; 2], rest: &mut [Wide]) {
        interleave(sites(&self.parted.follow), v, b);
        interleave(sites(&self.parted.stay), v, rest);
        scaled(inverse, b, x);
        self.staying.add(-1.0, x, rest);
    }

    /// out ← x_C and A_FF⁻¹ (b_F − A_FC x_C).
    pub fn follow(&self, inverse: &[f64], found: &[Wide], [b, x]: [&mut [Wide]; 2], out: &mut [f64]) {
        self.following.add(-1.0, found, b);
        scaled(inverse, b, x);
        spread(sites(&self.parted.stay), found, out);
        spread(sites(&self.parted.follow), x, out);
    }
}

fn sites(those: &[u32]) -> impl Iterator<Item = usize> {
    those.iter().map(|i| *i as usize)
}
