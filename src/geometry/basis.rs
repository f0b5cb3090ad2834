//! An orthonormal basis of the plane tangent to the sphere at m.
//!
//! ```text
//! σ = sign m_z,  α = −1/(σ + m_z),  β = m_x m_y α
//! u = (1 + σ m_x² α, σ β, −σ m_x),    v = (β, σ + m_y² α, −m_y),    u×v = m
//! ```
//!
//! T. Duff et al., "Building an orthonormal basis, revisited", J. Comput. Graph. Tech. 6(1), 1 (2017),
//! <https://jcgt.org/published/0006/01/01/>. No branch and no division by a small number; the basis jumps on the
//! equator m_z = 0 (some jump there must be), with the sign of zero deciding.

use super::vector::Vector;

/// Two unit vectors normal to the unit vector m and to each other, right-handed: u×v = m.
///
/// ```
/// use spinneb::geometry::tangent_basis;
/// assert_eq!(tangent_basis([0.0, 0.0, 1.0]), ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]));
/// ```
#[inline]
pub fn tangent_basis(m: Vector) -> (Vector, Vector) {
    let [x, y, z] = m;
    let sign = 1.0_f64.copysign(z);
    let alpha = -1.0 / (sign + z);
    let beta = x * y * alpha;
    ([1.0 + sign * x * x * alpha, sign * beta, -sign * x], [beta, sign + y * y * alpha, -y])
}

#[cfg(test)]
mod tests {
    use super::super::test_vectors::pairs;
    use super::super::vector::{cross, dot, norm, sub};
    use super::*;

    #[test]
    fn the_basis_is_orthonormal_and_right_handed_everywhere() {
        for (_, m) in pairs() {
            let (u, v) = tangent_basis(m);
            for wrong in [norm(u) - 1.0, norm(v) - 1.0, dot(u, v), dot(u, m), dot(v, m), norm(sub(cross(u, v), m))] {
                assert!(wrong.abs() <= 4.0 * f64::EPSILON, "{m:?}: {wrong}");
            }
        }
    }

    #[test]
    fn on_the_equator_the_sign_of_zero_decides() {
        assert_eq!(tangent_basis([1.0, 0.0, 0.0]), ([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]));
        assert_eq!(tangent_basis([1.0, 0.0, -0.0]), ([0.0, 0.0, 1.0], [0.0, -1.0, 0.0]));
    }
}
