//! How far a term reaches, and what joins all pairs of sites where it does.
//!
//! ```text
//! E = ½ Σ_ij Σ_c μ_i (m_i·f_c) K_c(i, j) μ_j (m_j·f_c)          f_c: three axes, the same for all pairs; i = j included
//! ```

use super::blocks::Block;
use super::magnetostatics::Exponentials;
use crate::geometry::Vector;
use std::fmt::Debug;

/// A term that joins all pairs of sites.
pub trait AllPairs: Debug + Sync {
    /// f: orthonormal.
    fn frame(&self) -> &[Vector; 3];

    /// μ of every site (μ_B).
    fn moments(&self) -> &[f64];

    /// K_c(i, j) (meV/μ_B²).
    fn pair(&self, i: usize, j: usize) -> [f64; 3];

    /// What all other sites do to each site where all spins are alike (meV): site blocks, in the coordinates of space.
    fn sums_of_others(&self) -> Vec<Block>;
}

/// Which sites a term couples.
#[derive(Clone, Copy, Debug)]
pub enum Coupling<'a> {
    /// Those within its reach.
    Local,
    /// All pairs, by their distance alone; in a row also as a sum of exponentials, from the shells on that have blocks, where there is one.
    Translational(&'a dyn AllPairs, Option<&'a Exponentials>),
    /// All pairs, each in its own way.
    Dense(&'a dyn AllPairs),
}

impl<'a> Coupling<'a> {
    /// What joins all pairs, if anything does.
    pub fn pairs(self) -> Option<&'a dyn AllPairs> {
        match self {
            Coupling::Local => None,
            Coupling::Translational(pairs, _) | Coupling::Dense(pairs) => Some(pairs),
        }
    }

    /// The sum of exponentials, if there is one.
    pub fn tail(self) -> Option<&'a Exponentials> {
        if let Coupling::Translational(_, tail) = self { tail } else { None }
    }

    /// A bound of the Hessian's error (meV, any norm) for what the exponentials leave out.
    pub fn error_mev(self) -> f64 {
        self.tail().map_or(0.0, |tail| 2.0 * tail.error * self.largest_moment() * self.largest_moment())
    }

    /// About the norm of what acts beyond the nearest `shells` of a row (meV); 0 where the Hessian is dense.
    pub fn far_norm_mev(self, shells: usize) -> f64 {
        let Coupling::Translational(pairs, _) = self else { return 0.0 };
        let beyond = |c: usize| (shells + 1..pairs.moments().len()).map(|n| pairs.pair(0, n)[c].abs()).sum::<f64>();
        let largest = self.largest_moment();
        2.0 * largest * largest * [0, 1, 2].map(beyond).into_iter().fold(0.0, f64::max)
    }

    /// (μ_B).
    fn largest_moment(self) -> f64 {
        self.pairs().map_or(0.0, |pairs| pairs.moments().iter().fold(0.0, |m: f64, x| m.max(x.abs())))
    }
}
