//! Numbers as files have them: text, and bytes of either order.

/// A number in a text: as Rust reads it, or with Fortran's exponent (`1.0D+00`).
pub(super) fn parse(word: &str) -> Option<f64> {
    let fortran = || word.replace(['d', 'D'], "e").parse().ok();
    word.parse().ok().or_else(|| if word.starts_with(|c: char| !c.is_ascii_alphabetic()) { fortran() } else { None })
}

/// How a number is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stored {
    F4,
    F8,
    I1,
    I2,
    I4,
    I8,
}

impl Stored {
    /// Bytes of a number.
    pub(super) fn size(self) -> usize {
        match self {
            Stored::I1 => 1,
            Stored::I2 => 2,
            Stored::F4 | Stored::I4 => 4,
            Stored::F8 | Stored::I8 => 8,
        }
    }

    /// The number in exactly as many bytes as it has.
    pub(super) fn value(self, bytes: &[u8], big_endian: bool) -> f64 {
        // As wide as the widest, least significant byte first.
        let mut wide = [0u8; 8];
        for (k, byte) in bytes.iter().take(8).enumerate() {
            wide[if big_endian { bytes.len() - 1 - k } else { k }] = *byte;
        }
        let bits = u64::from_le_bytes(wide);
        match self {
            Stored::F4 => f64::from(f32::from_bits(bits as u32)),
            Stored::F8 => f64::from_bits(bits),
            Stored::I1 => f64::from(bits as u8 as i8),
            Stored::I2 => f64::from(bits as u16 as i16),
            Stored::I4 => f64::from(bits as u32 as i32),
            Stored::I8 => bits as i64 as f64,
        }
    }
}

/// The three numbers at the beginning of the bytes.
pub(super) fn vector(kind: Stored, bytes: &[u8], big_endian: bool) -> [f64; 3] {
    let size = kind.size();
    [0, 1, 2].map(|c| kind.value(&bytes[c * size..(c + 1) * size], big_endian))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_from_bytes_of_both_orders() {
        let cases: [(Stored, &[u8], f64); 6] = [
            (Stored::F4, &1.5f32.to_le_bytes(), 1.5),
            (Stored::F8, &(-0.1f64).to_le_bytes(), -0.1),
            (Stored::I1, &(-3i8).to_le_bytes(), -3.0),
            (Stored::I2, &(-300i16).to_le_bytes(), -300.0),
            (Stored::I4, &70000i32.to_le_bytes(), 70000.0),
            (Stored::I8, &(-1i64).to_le_bytes(), -1.0),
        ];
        for (kind, bytes, expected) in cases {
            let reversed: Vec<u8> = bytes.iter().rev().copied().collect();
            assert_eq!(kind.value(bytes, false), expected);
            assert_eq!(kind.value(&reversed, true), expected);
        }
    }

    #[test]
    fn numbers_are_read_from_text_with_any_usual_exponent() {
        for (text, expected) in [("1.5", Some(1.5)), ("-1D-1", Some(-0.1)), ("+2.0d0", Some(2.0)), ("1e3", Some(1e3))] {
            assert_eq!(parse(text), expected, "{text}");
        }
        for text in ["", "x", "d", "1.2.3", "1,5", "deed"] {
            assert_eq!(parse(text), None, "{text}");
        }
        assert!(parse("nan").is_some_and(f64::is_nan));
    }
}
