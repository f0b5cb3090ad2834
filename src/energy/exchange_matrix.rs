//! The couplings between spins as a matrix of one unknown a site, for what is to be inverted roughly.

use super::Blocks;
use crate::linalg::{Coarsening, Rows};
use std::sync::Arc;

/// What couples the spins that move, Cartesian components alike.
#[derive(Debug)]
pub struct ExchangeMatrix {
    /// −J_ij (meV): a third of the trace of the block of a bond; Σ_j |J_ij| on the diagonal.
    pub rows: Rows,
    /// How its unknowns follow from fewer.
    pub coarsening: Arc<Coarsening>,
    /// |Σ_j J_ij| of every site (meV): the stiffness of a spin among equals.
    pub among_equals: Vec<f64>,
}

impl ExchangeMatrix {
    /// Of the blocks of a Hamiltonian that do not depend on the spins.
    pub(super) fn of(blocks: &Blocks, frozen: &[bool]) -> ExchangeMatrix {
        let mut rows: Vec<Vec<(usize, f64)>> = vec![Vec::new(); frozen.len()];
        for bonds in &blocks.bond {
            for [i, next] in bonds.family.bonds().filter(|bond| !bond.iter().any(|i| frozen[*i])) {
                rows[i].push((next, bonds.mean(i)));
                rows[next].push((i, bonds.mean(i)));
            }
        }
        let among_equals = rows.iter().map(|row| row.iter().map(|(_, a)| a).sum::<f64>().abs()).collect();
        for (i, row) in rows.iter_mut().enumerate() {
            row.push((i, row.iter().map(|(_, a)| a.abs()).sum()));
        }
        let rows = Rows::new(frozen.len(), rows);
        ExchangeMatrix { coarsening: Arc::new(Coarsening::of(&rows)), rows, among_equals }
    }
}
