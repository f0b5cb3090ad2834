//! Products and sums of many long vectors at once, tile by tile: each vector is read from memory once, and a few are in registers
//! together. The order of all sums is fixed, for any number of threads.

use multiversion::multiversion;
use rayon::prelude::*;

/// Numbers of a vector in a tile: tiles of a hundred vectors stay in the second cache.
const TILE: usize = 512;
/// Tiles of one thread's turn.
const TURN: usize = 8;
/// Vectors in registers together, and lanes of each.
const TOGETHER: usize = 4;
const LANES: usize = 4;

/// aᵢ · bⱼ, row by row.
pub fn products(a: &[Vec<f64>], b: &[Vec<f64>]) -> Vec<f64> {
    let length = a.first().map_or(0, Vec::len);
    let turns: Vec<Vec<f64>> = (0..length.div_ceil(TURN * TILE))
        .into_par_iter()
        .map(|turn| {
            let mut sums = vec![0.0; a.len() * b.len()];
            let end = length.min((turn + 1) * TURN * TILE);
            for start in (turn * TURN * TILE..end).step_by(TILE) {
                let tile = start..end.min(start + TILE);
                let (a, b) = (tiles(a, &tile), tiles(b, &tile));
                add_products(&a, &b, &mut sums);
            }
            sums
        })
        .collect();
    let mut sums = vec![0.0; a.len() * b.len()];
    turns.iter().for_each(|turn| sums.iter_mut().zip(turn).for_each(|(sum, part)| *sum += part));
    sums
}

/// x ← Σ w_k v_k, for each x and its weights.
pub fn combine(x: &mut [Vec<f64>], weights: &[Vec<f64>], vectors: &[Vec<f64>]) {
    each_turn(x, weights, vectors, false);
}

/// x ← x + Σ w_k v_k, for each x and its weights.
pub fn add(x: &mut [Vec<f64>], weights: &[Vec<f64>], vectors: &[Vec<f64>]) {
    each_turn(x, weights, vectors, true);
}

/// Each x minus its parts along orthonormal vectors, all taken at once.
pub fn without(x: &mut [Vec<f64>], space: &[Vec<f64>]) {
    if space.is_empty() || x.is_empty() {
        return;
    }
    let parts: Vec<Vec<f64>> = products(x, space).chunks(space.len()).map(|p| p.iter().map(|p| -p).collect()).collect();
    add(x, &parts, space);
}

fn tiles<'a>(vectors: &'a [Vec<f64>], tile: &std::ops::Range<usize>) -> Vec<&'a [f64]> {
    vectors.iter().map(|v| &v[tile.clone()]).collect()
}

fn each_turn(x: &mut [Vec<f64>], weights: &[Vec<f64>], vectors: &[Vec<f64>], keep: bool) {
    let length = x.first().map_or(0, Vec::len);
    let mut turns: Vec<Vec<&mut [f64]>> = Vec::new();
    turns.resize_with(length.div_ceil(TURN * TILE), Vec::new);
    for x in x {
        turns.iter_mut().zip(x.chunks_mut(TURN * TILE)).for_each(|(turn, part)| turn.push(part));
    }
    turns.into_par_iter().enumerate().for_each(|(turn, mut parts)| {
        let first = turn * TURN * TILE;
        let mut start = 0;
        while start < parts[0].len() {
            let end = parts[0].len().min(start + TILE);
            let sources = tiles(vectors, &(first + start..first + end));
            for (parts, weights) in parts.chunks_mut(TOGETHER).zip(weights.chunks(TOGETHER)) {
                let mut targets: Vec<&mut [f64]> = parts.iter_mut().map(|part| &mut part[start..end]).collect();
                let weights: Vec<[f64; TOGETHER]> =
                    (0..vectors.len()).map(|k| std::array::from_fn(|r| weights.get(r).map_or(0.0, |w| w[k]))).collect();
                add_sums(&mut targets, &weights, &sources, keep);
            }
            start = end;
        }
    });
}

/// Adds the products of tiles.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn add_products(a: &[&[f64]], b: &[&[f64]], sums: &mut [f64]) {
    let whole = a.first().map_or(0, |a| a.len() / LANES * LANES);
    for i in (0..a.len()).step_by(TOGETHER) {
        let rows: [&[f64]; TOGETHER] = std::array::from_fn(|r| a[(i + r).min(a.len() - 1)]);
        for (j, column) in b.iter().enumerate() {
            let mut lanes = [[0.0; LANES]; TOGETHER];
            for (k, y) in column.chunks_exact(LANES).enumerate() {
                for r in 0..TOGETHER {
                    let x = &rows[r][k * LANES..(k + 1) * LANES];
                    for l in 0..LANES {
                        lanes[r][l] += x[l] * y[l];
                    }
                }
            }
            for r in 0..TOGETHER.min(a.len() - i) {
                let rest: f64 = rows[r][whole..].iter().zip(&column[whole..]).map(|(x, y)| x * y).sum();
                let [p, q, s, t] = lanes[r];
                sums[(i + r) * b.len() + j] += (p + s) + (q + t) + rest;
            }
        }
    }
}

/// At most so many targets, to each the sum of all sources with its weights.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn add_sums(targets: &mut [&mut [f64]], weights: &[[f64; TOGETHER]], sources: &[&[f64]], keep: bool) {
    let whole = targets[0].len() / LANES * LANES;
    for first in (0..whole).step_by(LANES) {
        let mut sums = [[0.0; LANES]; TOGETHER];
        for r in 0..TOGETHER {
            if keep && r < targets.len() {
                sums[r].copy_from_slice(&targets[r][first..first + LANES]);
            }
        }
        for (w, source) in weights.iter().zip(sources) {
            let x = &source[first..first + LANES];
            for r in 0..TOGETHER {
                for l in 0..LANES {
                    sums[r][l] += w[r] * x[l];
                }
            }
        }
        for r in 0..TOGETHER {
            if r < targets.len() {
                targets[r][first..first + LANES].copy_from_slice(&sums[r]);
            }
        }
    }
    for (r, target) in targets.iter_mut().enumerate() {
        for (at, x) in target.iter_mut().enumerate().skip(whole) {
            let sum: f64 = weights.iter().zip(sources).map(|(w, source)| w[r] * source[at]).sum();
            *x = if keep { *x + sum } else { sum };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::slab;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn products_and_sums_are_those_of_vectors_one_by_one() {
        let mut r = ChaCha8Rng::seed_from_u64(5);
        for (length, a, b) in [(3, 1, 1), (8, 2, 5), (519, 4, 3), (4096, 5, 1), (9001, 7, 9)] {
            let mut many = |k: usize| -> Vec<Vec<f64>> {
                (0..k).map(|_| (0..length).map(|_| r.random_range(-1.0..1.0)).collect()).collect()
            };
            let (xs, vs, weights) = (many(a), many(b), many(a));
            let weights: Vec<Vec<f64>> = weights.iter().map(|w| w.iter().cycle().take(b).copied().collect()).collect();
            for (k, p) in products(&xs, &vs).into_iter().enumerate() {
                let (i, j) = (k / b, k % b);
                assert!((p - slab::dot(&xs[i], &vs[j])).abs() < 1e-12 * (length as f64).sqrt(), "{length}: {i} {j}");
            }
            for keep in [false, true] {
                let mut sums = xs.clone();
                if keep {
                    add(&mut sums, &weights, &vs)
                } else {
                    combine(&mut sums, &weights, &vs)
                };
                for i in 0..a {
                    let mut one = if keep { xs[i].clone() } else { vec![0.0; length] };
                    slab::add_all(&mut one, &weights[i], &vs);
                    assert!(one.iter().zip(&sums[i]).all(|(x, y)| (x - y).abs() < 1e-13), "{length} {keep}: {i}");
                }
            }
        }
    }
}
