//! Sums of numbers that only their logarithms can hold.

/// ln(e^a + e^b).
pub fn log_sum(a: f64, b: f64) -> f64 {
    let (large, small) = if a >= b { (a, b) } else { (b, a) };
    if small == f64::NEG_INFINITY { large } else { large + libm::log1p(libm::exp(small - large)) }
}

#[cfg(test)]
mod tests {
    use super::log_sum;

    #[test]
    fn sums_are_right_where_numbers_overflow_and_where_one_is_nothing() {
        assert!((log_sum(libm::log(2.0), libm::log(3.0)) - libm::log(5.0)).abs() < 1e-15);
        assert_eq!(log_sum(f64::NEG_INFINITY, 7.0), 7.0);
        assert_eq!(log_sum(f64::NEG_INFINITY, f64::NEG_INFINITY), f64::NEG_INFINITY);
        assert!((log_sum(5000.0, 5000.0) - 5000.0 - libm::log(2.0)).abs() < 1e-12);
    }
}
