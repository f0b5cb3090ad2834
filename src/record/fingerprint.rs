//! What tells the inputs of computations apart.

use crc32fast::Hasher;

/// What tells the input of one computation from that of another.
#[derive(Debug, Default)]
pub struct Fingerprint(Hasher);

impl Fingerprint {
    /// And a whole number.
    pub fn whole(mut self, n: usize) -> Self {
        self.0.update(&(n as u64).to_le_bytes());
        self
    }

    /// And a number, to the bit.
    pub fn real(self, x: f64) -> Self {
        self.row(&[x])
    }

    /// And words.
    pub fn text(mut self, text: &str) -> Self {
        self.0.update(text.as_bytes());
        self
    }

    /// And a row of numbers, to the bit.
    pub fn row(mut self, row: &[f64]) -> Self {
        let mut bytes = [0; 4096];
        for some in row.chunks(bytes.len() / 8) {
            for (b, x) in bytes.chunks_exact_mut(8).zip(some) {
                b.copy_from_slice(&x.to_le_bytes());
            }
            self.0.update(&bytes[..8 * some.len()]);
        }
        self
    }

    /// The check value of all of them.
    pub fn value(self) -> u32 {
        self.0.finalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_bit_is_another_input() {
        let print = |x: f64| Fingerprint::default().whole(1).row(&[0.5, x]).value();
        assert_eq!(print(0.1), print(0.1));
        assert_ne!(print(0.1), print(f64::from_bits(0.1f64.to_bits() + 1)));
        assert_ne!(print(0.0), print(-0.0));
    }
}
