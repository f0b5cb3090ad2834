//! Numbers as a reader wants to see them: a true minus sign, sensible digits.

/// `v` with so many decimals and U+2212 for minus; no minus before zero.
pub fn decimal(v: f64, decimals: usize) -> String {
    let text = format!("{v:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.bytes().any(|b| (b'1'..=b'9').contains(&b)) => format!("−{digits}"),
        Some(digits) => digits.into(),
        None => text,
    }
}

/// `v` to `digits` significant digits, as a decimal or m×10ⁿ.
pub fn significant(v: f64, digits: usize) -> String {
    if v == 0.0 || !v.is_finite() {
        return decimal(v, 0);
    }
    let scientific = format!("{v:.*e}", digits.saturating_sub(1));
    let exponent: i32 = scientific.split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0);
    if (-3..6).contains(&exponent) {
        return decimal(v, (digits as i32 - 1 - exponent).max(0) as usize);
    }
    format!(
        "{}×{}",
        decimal(v / libm::pow(10.0, f64::from(exponent)), digits.saturating_sub(1)),
        power_of_ten(exponent)
    )
}

/// 10ⁿ.
pub fn power_of_ten(n: i32) -> String {
    let raised = n.to_string().chars().map(superscript).collect::<String>();
    format!("10{raised}")
}

fn superscript(c: char) -> char {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    c.to_digit(10).map_or('⁻', |d| DIGITS[d as usize])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn significant_digits_are_kept() {
        assert_eq!(significant(6.29761, 4), "6.298");
        assert_eq!(significant(-0.170008526, 4), "−0.1700");
        assert_eq!(significant(9.99996, 4), "10.00");
        assert_eq!(significant(1.234e-9, 3), "1.23×10⁻⁹");
        assert_eq!(significant(0.0, 4), "0");
        assert_eq!(decimal(-0.001, 1), "0.0");
    }
}
