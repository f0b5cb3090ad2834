//! The Euclidean Hessian of short-ranged terms as 3 × 3 blocks: one a site, one a bond of each family.

use crate::geometry::matrix::transposed;
use crate::geometry::{Vector, vector};
use crate::lattice::BondFamily;

/// A 3 × 3 matrix, row by row.
pub type Block = [Vector; 3];

/// Blocks of ∂²E/∂m∂m (meV).
#[derive(Clone, Debug)]
pub struct Blocks {
    /// Diagonal blocks, symmetric: xx, yy, zz, yz, zx and xy of all sites.
    pub site: [Vec<f64>; 6],
    /// By family, in a row in the order of its shells: each couples every site (rows) to its partner a hop on (columns); the
    /// transposes are understood.
    pub bond: Vec<Bonds>,
}

/// The couplings of one family, a multiple of the unit matrix and the rest of each.
#[derive(Clone, Debug)]
pub struct Bonds {
    /// The bonds.
    pub family: BondFamily,
    /// s of s·1, for the bond of every site.
    pub isotropic: Vec<f64>,
    /// What is not isotropic, for the bond of every site; empty where no term has any.
    pub rest: Vec<Block>,
}

impl Bonds {
    /// Adds a block to the bond of site i.
    pub fn add(&mut self, i: usize, block: Block) {
        if self.rest.is_empty() {
            self.rest = vec![[[0.0; 3]; 3]; self.isotropic.len()];
        }
        for r in 0..3 {
            self.rest[i][r] = vector::add(self.rest[i][r], block[r]);
        }
    }

    /// The block of the bond of site i times v.
    #[inline(always)]
    pub fn multiply(&self, i: usize, v: Vector) -> Vector {
        let isotropic = vector::scale(self.isotropic[i], v);
        if self.rest.is_empty() { isotropic } else { vector::add(isotropic, multiply(&self.rest[i], v)) }
    }

    /// A third of the block's trace.
    pub fn mean(&self, i: usize) -> f64 {
        let trace = |b: &Block| (b[0][0] + b[1][1] + b[2][2]) / 3.0;
        self.isotropic[i] + self.rest.get(i).map_or(0.0, trace)
    }
}

impl Blocks {
    /// Zero blocks for the bonds of these families.
    pub fn zeros(sites: usize, families: Vec<BondFamily>) -> Blocks {
        let bonds = |family| Bonds { family, isotropic: vec![0.0; sites], rest: Vec::new() };
        Blocks { site: [(); 6].map(|()| vec![0.0; sites]), bond: families.into_iter().map(bonds).collect() }
    }

    /// The blocks of a family's bonds; nothing where it has none in the lattice.
    pub fn of(&mut self, family: &BondFamily) -> Option<&mut Bonds> {
        self.bond.iter_mut().find(|bonds| bonds.family.hop == family.hop)
    }

    /// Adds a block to the bond of two sites (rows, columns), which are those of one of the families, either way.
    pub fn add_bond(&mut self, [i, j]: [usize; 2], block: Block) {
        for bonds in &mut self.bond {
            if bonds.family.next(i) == Some(j) {
                return bonds.add(i, block);
            }
            if bonds.family.next(j) == Some(i) {
                return bonds.add(j, transposed(&block));
            }
        }
    }

    /// Adds s·1 to a site's block.
    pub fn add_isotropic(&mut self, site: usize, s: f64) {
        for c in 0..3 {
            self.site[c][site] += s;
        }
    }

    /// Adds s·e eᵀ to a site's block.
    pub fn add_axial(&mut self, site: usize, s: f64, e: Vector) {
        let [x, y, z] = e;
        for (c, product) in [x * x, y * y, z * z, y * z, z * x, x * y].into_iter().enumerate() {
            self.site[c][site] += s * product;
        }
    }

    /// Adds a symmetric block to a site's.
    pub fn add_site(&mut self, site: usize, b: Block) {
        for (c, value) in [b[0][0], b[1][1], b[2][2], b[1][2], b[2][0], b[0][1]].into_iter().enumerate() {
            self.site[c][site] += value;
        }
    }

    /// A site's block.
    #[inline(always)]
    pub fn at_site(&self, i: usize) -> Block {
        let [xx, yy, zz, yz, zx, xy] = [0, 1, 2, 3, 4, 5].map(|c: usize| self.site[c][i]);
        [[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]]
    }

    /// The blocks of all sites.
    pub fn sites(&self) -> impl Iterator<Item = Block> + '_ {
        (0..self.site[0].len()).map(|i| self.at_site(i))
    }
}

/// A v.
#[inline(always)]
pub fn multiply(a: &Block, v: Vector) -> Vector {
    [vector::dot(a[0], v), vector::dot(a[1], v), vector::dot(a[2], v)]
}

/// The matrix [d]× with vᵀ M w = d·(v × w).
#[inline]
pub fn cross_block(d: Vector) -> Block {
    [[0.0, d[2], -d[1]], [-d[2], 0.0, d[0]], [d[1], -d[0], 0.0]]
}
