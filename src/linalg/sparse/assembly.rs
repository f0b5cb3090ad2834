//! What a front begins with: entries of the matrix, and what the fronts below it have left.

use super::symbolic::{Front, Target};
use crate::linalg::panels::{self, SITES, WIDTH};
use multiversion::multiversion;

/// Numbers of the two rows of a site in a panel.
const PAIR: usize = 2 * WIDTH;

/// Puts the entries of the matrix into the columns of a front, which are zero, and 1 on the diagonal of columns of no site.
pub(super) fn add_entries(front: &Front, targets: &[Target], blocks: &[[f64; 4]], l: &mut [f64]) {
    for target in targets {
        let [a, b, c, d] = blocks[target.block as usize];
        let (b, c) = if target.mirrored { (c, b) } else { (b, c) };
        let to = &mut l[target.at..target.at + WIDTH + 2];
        (to[0], to[1], to[WIDTH], to[WIDTH + 1]) = (a, b, c, d);
    }
    if front.own.len() % SITES == 1 {
        let last = panels::first(front.rows(), front.panels - 1);
        for k in 2..WIDTH {
            l[last + WIDTH * k + k] = 1.0;
        }
    }
}

/// Adds what a front has left to the columns of the one above it and to what that will leave; `slots` tell where its sites stand
/// there.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
pub(super) fn add_left(left: &[f64], slots: &[u32], front: &Front, l: &mut [f64], rest: &mut [f64]) {
    let (rows, others, own) = (front.rows(), front.other_rows(), SITES * front.panels);
    let mut left = left;
    for (q, columns) in slots.chunks(SITES).enumerate() {
        let slots = &slots[SITES * q..];
        let source;
        (source, left) = left.split_at(PAIR * slots.len());
        let together = columns.len() == SITES && columns[0] % 2 == 0 && columns[1] == columns[0] + 1;
        for (k, slot) in columns.iter().enumerate() {
            let slot = *slot as usize;
            let panel = slot / SITES;
            let (target, top) = match panel.checked_sub(front.panels) {
                None => (&mut l[panels::first(rows, panel)..], SITES * panel),
                Some(panel) => (&mut rest[panels::first(others, panel)..], own + SITES * panel),
            };
            if together {
                for (from, slot) in source.chunks_exact(PAIR).zip(slots) {
                    let to = &mut target[PAIR * (*slot as usize - top)..][..PAIR];
                    for e in 0..PAIR {
                        to[e] += from[e];
                    }
                }
                break;
            }
            for (from, row) in source.chunks_exact(PAIR).zip(slots).skip(k) {
                let to = &mut target[PAIR * (*row as usize - top) + 2 * (slot % SITES)..][..WIDTH + 2];
                let from = &from[2 * k..][..WIDTH + 2];
                for e in [0, 1, WIDTH, WIDTH + 1] {
                    to[e] += from[e];
                }
            }
        }
    }
}
