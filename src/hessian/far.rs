//! The Hessian's couplings of distant sites: all pairs of a short chain or a ring, exponentials along a long open chain.
//!
//! ```text
//! H_ij = Σ_c r_ic K_c(|i − j|) r_jcᵀ,   r_ic = μ_i (e_i·f_c, e'_i·f_c)       e, e': tangent basis;  f: the chain's axes
//! ```
//! In a long open chain K is a sum of exponentials beyond the nearest shells, whose blocks are in the band already; so the
//! band takes back what the sum gives there.

use super::TangentBasis;
use crate::energy::{AllPairs, Hamiltonian};
use crate::geometry::{Vector, vector};
use crate::linalg::{Decays, Matrix, Tail};
use std::sync::Arc;

/// r of every site: two rows of three; zero where a site is frozen.
type Rows = Vec<[Vector; 2]>;

/// Adds what reaches further than the blocks.
pub(super) fn add(h: &Hamiltonian, basis: &TangentBasis, matrix: &mut Matrix) {
    let Some(pairs) = h.coupling().pairs() else { return };
    let rows = rows(h, pairs, basis);
    let Some(sum) = h.coupling().tail() else {
        return add_pairs(pairs, &rows, matrix);
    };
    for n in 1..=sum.shells {
        let back = sum.at(n).map(|k| -k);
        for i in 0..rows.len() - n {
            matrix.add_block(i + n, i, block(&rows[i], &rows[i + n], back));
        }
    }
    let decays = Arc::new(Decays { q: sum.decays.clone(), weights: sum.weights.clone() });
    matrix.set_tail(Tail { decays, norm: h.coupling().far_norm_mev(sum.shells), rows });
}

/// All pairs but those of neighbours that have a block.
fn add_pairs(pairs: &dyn AllPairs, rows: &Rows, matrix: &mut Matrix) {
    for (j, row) in rows.iter().enumerate() {
        matrix.add_blocks_before(j, |i| block(&rows[i], row, pairs.pair(i, j)));
    }
}

/// The couplings of a site to a later one: the later one's rows, the earlier one's columns.
#[inline]
fn block([e, f]: &[Vector; 2], [p, q]: &[Vector; 2], k: [f64; 3]) -> [[f64; 2]; 2] {
    let entry = |p: &Vector, q: &Vector| p[0] * k[0] * q[0] + p[1] * k[1] * q[1] + p[2] * k[2] * q[2];
    [[entry(e, p), entry(f, p)], [entry(e, q), entry(f, q)]]
}

fn rows(h: &Hamiltonian, pairs: &dyn AllPairs, basis: &TangentBasis) -> Rows {
    let row = |i: usize| {
        let moment = if h.is_frozen(i) { 0.0 } else { pairs.moments()[i] };
        basis.pair(i).map(|e| pairs.frame().map(|f| moment * vector::dot(e, f)))
    };
    (0..h.sites()).map(row).collect()
}
