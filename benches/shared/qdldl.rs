//! A sparse LDLᵀ that is not ours, a port of QDLDL (Stellato et al., Math. Program. Comput. 12, 637 (2020),
//! doi:10.1007/s12532-020-00179-2), to compare with.

/// Where L has entries.
pub struct Plan {
    n: usize,
    starts: Vec<usize>,
    rows: Vec<usize>,
    counts: Vec<usize>,
    tree: Vec<Option<usize>>,
    size: usize,
}

/// L, and the inverse of D.
pub struct Factors {
    n: usize,
    starts: Vec<usize>,
    rows: Vec<usize>,
    l: Vec<f64>,
    inverse: Vec<f64>,
    /// D.
    pub pivots: Vec<f64>,
    /// How many of them are negative.
    pub negatives: usize,
}

impl Plan {
    /// Of a symmetric matrix, its upper half by columns: where each column begins, and the rows of its entries.
    pub fn of(starts: Vec<usize>, rows: Vec<usize>) -> Plan {
        let n = starts.len() - 1;
        let (mut counts, mut tree) = (vec![0; n], vec![None; n]);
        let size = ldl::etree(n, &starts, &rows, &mut vec![0; 3 * n], &mut counts, &mut tree).unwrap();
        Plan { n, starts, rows, counts, tree, size }
    }

    /// Of these entries.
    pub fn factor(&self, entries: &[f64]) -> Factors {
        let n = self.n;
        let mut factors = Factors {
            n,
            starts: vec![0; n + 1],
            rows: vec![0; self.size],
            l: vec![0.0; self.size],
            inverse: vec![0.0; n],
            pivots: vec![0.0; n],
            negatives: 0,
        };
        let positive = ldl::factor(
            n,
            &self.starts,
            &self.rows,
            entries,
            &mut factors.starts,
            &mut factors.rows,
            &mut factors.l,
            &mut factors.pivots,
            &mut factors.inverse,
            &self.counts,
            &self.tree,
            &mut vec![ldl::Marker::Unused; n],
            &mut vec![0; 3 * n],
            &mut vec![0.0; n],
        );
        factors.negatives = n - positive.unwrap();
        factors
    }
}

impl Factors {
    /// Solves in place.
    pub fn solve(&self, x: &mut [f64]) {
        ldl::solve(self.n, &self.starts, &self.rows, &self.l, &self.inverse, x);
    }
}
