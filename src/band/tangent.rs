//! The improved tangent: towards the neighbour of higher energy, both mixed at an extremum.
//!
//! ```text
//! τ⁺ = m_{k+1} − m_k,  τ⁻ = m_k − m_{k−1}
//! E_{k+1} > E_k > E_{k−1}:  τ = τ⁺        E_{k+1} < E_k < E_{k−1}:  τ = τ⁻
//! at an extremum: τ = τ⁺ w⁺ + τ⁻ w⁻, the larger energy step weighing towards the higher neighbour
//! then τ ← P τ/|P τ|
//! ```
//! Henkelman, Jónsson, J. Chem. Phys. 113, 9978 (2000), doi:10.1063/1.1323224, eqs. 8–11.

/// Weights of τ⁺ and τ⁻ at an image of energy `e` between `before` and `after`.
fn raw_weights(before: f64, e: f64, after: f64) -> (f64, f64) {
    if after > e && e > before {
        return (1.0, 0.0);
    }
    if after < e && e < before {
        return (0.0, 1.0);
    }
    let (up, down) = ((after - e).abs(), (before - e).abs());
    let (large, small) = (up.max(down), up.min(down));
    if large == 0.0 {
        (1.0, 1.0)
    } else if after > before {
        (large, small)
    } else {
        (small, large)
    }
}

/// Weights of τ⁺ and τ⁻ at image k, the larger one 1.
pub fn weights(energy: &[f64], k: usize) -> (f64, f64) {
    let (plus, minus) = raw_weights(energy[k - 1], energy[k], energy[k + 1]);
    let scale = plus.max(minus);
    (plus / scale, minus / scale)
}

/// The uphill neighbour of each image on a monotone slope, none at extrema and ends.
pub fn uphill_neighbours(energy: &[f64]) -> Vec<Option<usize>> {
    let last = energy.len() - 1;
    let one = |k: usize| match raw_weights(energy[k - 1], energy[k], energy[k + 1]) {
        (1.0, 0.0) => Some(k + 1),
        (0.0, 1.0) => Some(k - 1),
        _ => None,
    };
    (0..=last).map(|k| if k == 0 || k == last { None } else { one(k) }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn on_a_slope_the_tangent_looks_uphill_and_at_an_extremum_both_ways_count() {
        assert_eq!(raw_weights(0.0, 1.0, 3.0), (1.0, 0.0));
        assert_eq!(raw_weights(3.0, 1.0, 0.0), (0.0, 1.0));
        assert_eq!(raw_weights(0.0, 2.0, 1.0), (2.0, 1.0));
        assert_eq!(raw_weights(1.0, 2.0, 0.0), (1.0, 2.0));
        assert_eq!(raw_weights(1.0, 1.0, 1.0), (1.0, 1.0));
        assert_eq!(uphill_neighbours(&[0.0, 1.0, 3.0, 2.0, 0.0]), [None, Some(2), None, Some(2), None]);
    }
}
