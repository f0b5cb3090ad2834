//! The Euclidean Hessian of a short-ranged chain as 3 × 3 blocks: one a site, one a bond of each shell.

use crate::geometry::Vector;

/// A 3 × 3 matrix, row by row.
pub type Block = [Vector; 3];

/// Blocks of ∂²E/∂m∂m (meV).
#[derive(Clone, Debug)]
pub struct Blocks {
    /// Diagonal blocks, symmetric.
    pub site: Vec<Block>,
    /// `bond[n − 1][i]` couples site i (rows) to site i + n (columns); its transpose is understood.
    pub bond: Vec<Vec<Block>>,
}

impl Blocks {
    /// Zero blocks for shells 1 … `reach`; every shell has one (possibly unused) bond a site.
    pub fn zeros(sites: usize, reach: usize) -> Blocks {
        Blocks { site: vec![[[0.0; 3]; 3]; sites], bond: vec![vec![[[0.0; 3]; 3]; sites]; reach] }
    }

    /// Adds s·1 to a site's block.
    pub fn add_isotropic(&mut self, site: usize, s: f64) {
        for c in 0..3 {
            self.site[site][c][c] += s;
        }
    }

    /// Adds s·e eᵀ to a site's block.
    pub fn add_axial(&mut self, site: usize, s: f64, e: Vector) {
        for r in 0..3 {
            for c in 0..3 {
                self.site[site][r][c] += s * e[r] * e[c];
            }
        }
    }
}

/// A v.
#[inline]
pub fn multiply(a: &Block, v: Vector) -> Vector {
    [0, 1, 2].map(|r| a[r][0] * v[0] + a[r][1] * v[1] + a[r][2] * v[2])
}

/// The matrix [d]× with vᵀ M w = d·(v × w).
#[inline]
pub fn cross_block(d: Vector) -> Block {
    [[0.0, d[2], -d[1]], [-d[2], 0.0, d[0]], [d[1], -d[0], 0.0]]
}
