//! Bytes as text, base 64 (RFC 4648).

const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Padded, without line breaks.
pub(crate) fn base64(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let word = chunk.iter().enumerate().fold(0u32, |w, (k, &b)| w | u32::from(b) << (16 - 8 * k));
        for k in 0..4 {
            let letter = LETTERS[(word >> (18 - 6 * k)) as usize & 63] as char;
            text.push(if k <= chunk.len() { letter } else { '=' });
        }
    }
    text
}

/// The bytes; nothing where a letter is none of those.
pub(crate) fn bytes(base64: &str) -> Option<Vec<u8>> {
    let digit = |c: u8| LETTERS.iter().position(|letter| *letter == c).map(|k| k as u32);
    let digits: Vec<u32> = base64.trim_end_matches('=').bytes().map(digit).collect::<Option<_>>()?;
    let group = |g: &[u32]| {
        let word = g.iter().enumerate().fold(0, |w, (k, d)| w | d << (18 - 6 * k));
        word.to_be_bytes()[1..g.len()].to_vec()
    };
    Some(digits.chunks(4).flat_map(group).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_pads_as_rfc_4648_says_and_is_undone() {
        for (plain, coded) in [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")] {
            assert_eq!(base64(plain.as_bytes()), coded);
            assert_eq!(bytes(coded).as_deref(), Some(plain.as_bytes()));
        }
        assert_eq!(bytes("Zm9v!"), None);
    }
}
