//! Plain vectors of three components.

/// A vector in three dimensions, (x, y, z).
pub type Vector = [f64; 3];

/// a + b.
#[inline]
pub fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// a − b.
#[inline]
pub fn sub(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// s a.
#[inline]
pub fn scale(s: f64, a: Vector) -> Vector {
    [s * a[0], s * a[1], s * a[2]]
}

/// a · b.
#[inline]
pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// a × b.
#[inline]
pub fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// |a|.
#[inline]
pub fn norm(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// The part of a normal to the unit vector n: (I − nnᵀ) a.
#[inline]
pub fn normal_part(a: Vector, n: Vector) -> Vector {
    sub(a, scale(dot(a, n), n))
}

/// a/|a|, or `None` for a vector of zero or non-finite length. Safe for the smallest and largest numbers.
#[inline]
pub fn unit(a: Vector) -> Option<Vector> {
    let largest = a[0].abs().max(a[1].abs()).max(a[2].abs());
    if !(largest > 0.0 && a[0].is_finite() && a[1].is_finite() && a[2].is_finite()) {
        return None;
    }
    let a = [a[0] / largest, a[1] / largest, a[2] / largest];
    let length = norm(a);
    Some([a[0] / length, a[1] / length, a[2] / length])
}

/// a/|a|, or `otherwise` where |a| is not a positive finite number. For vectors of ordinary length: |a|² must not underflow.
#[inline]
pub fn unit_or(a: Vector, otherwise: Vector) -> Vector {
    let length = norm(a);
    if length > 0.0 && length.is_finite() { [a[0] / length, a[1] / length, a[2] / length] } else { otherwise }
}

/// a, near enough in length to `model`, given exactly that length (to rounding).
#[inline]
pub fn with_length_of(a: Vector, model: Vector) -> Vector {
    let (wanted, found) = (dot(model, model), dot(a, a));
    if found > 0.0 && wanted.is_finite() { scale((wanted / found).sqrt(), a) } else { a }
}

/// (1−t) a + t b: not a unit vector. It is here to compare with; a spin must not be moved this way.
///
/// ```
/// use spinneb::geometry::lerp;
/// assert_eq!(lerp([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], 0.5), [0.5, 0.5, 0.0]); // of length 0.71
/// ```
#[inline]
pub fn lerp(a: Vector, b: Vector, t: f64) -> Vector {
    add(scale(1.0 - t, a), scale(t, b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_vector_is_made_of_the_smallest_and_the_largest_numbers() {
        for size in [5e-324, 1e-310, 1e-160, 1.0, 1e160, f64::MAX] {
            let u = unit([size, -size, 0.0]).unwrap();
            assert!((norm(u) - 1.0).abs() <= f64::EPSILON, "{size}: {u:?}");
            assert_eq!(u[0], -u[1]);
        }
    }

    #[test]
    fn what_has_no_direction_gives_none() {
        for v in [[0.0; 3], [f64::NAN, 1.0, 0.0], [1.0, 0.0, f64::NAN], [f64::INFINITY, 0.0, 0.0]] {
            assert_eq!(unit(v), None, "{v:?}");
            assert_eq!(unit_or(v, [0.0, 0.0, 1.0]), [0.0, 0.0, 1.0], "{v:?}");
        }
    }

    #[test]
    fn the_cross_product_is_right_handed() {
        assert_eq!(cross([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]), [0.0, 0.0, 1.0]);
    }
}
