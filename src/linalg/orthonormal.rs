//! Gram–Schmidt.

use super::slab;

/// Gram–Schmidt; a vector of which less than `least` is left is left out.
pub fn orthonormal(vectors: Vec<Vec<f64>>, least: f64) -> Vec<Vec<f64>> {
    let mut done: Vec<Vec<f64>> = Vec::new();
    for mut v in vectors {
        remove(&mut v, &done);
        let size = slab::norm(&v);
        if size > least {
            slab::scale(&mut v, 1.0 / size);
            done.push(v);
        }
    }
    done
}

/// v minus its parts along orthonormal vectors.
pub fn remove(v: &mut [f64], directions: &[Vec<f64>]) {
    for d in directions {
        let overlap = slab::dot(d, v);
        slab::add_scaled(v, -overlap, d);
    }
}
