//! Pivots of an elimination without pivoting.

/// A pivot, or what stands for it if it is smaller than the floor.
#[inline(always)]
pub(super) fn guarded(d: f64, floor: f64) -> f64 {
    if d.abs() < floor { if d < 0.0 { -floor } else { floor } } else { d }
}
