//! Numbers as bytes and back, bit for bit: how a run remembers what it computed.
//!
//! Everything is little-endian; a row of numbers and a text stand behind their length. Reading gives nothing where the bytes
//! end too early or say what cannot be: whatever the bytes are, the computation goes on with numbers that it can bear.

use crc32fast::Hasher;

/// Most of anything that is counted.
const MOST: usize = (u32::MAX >> 1) as usize;
/// Largest size of a number that is computed with.
const LARGEST: f64 = 1e100;

/// Bytes to be written.
#[derive(Debug, Default)]
pub struct Writer(Vec<u8>);

impl Writer {
    /// All that was written.
    pub fn into_bytes(self) -> Vec<u8> {
        self.0
    }

    pub fn whole(&mut self, n: usize) {
        self.0.extend_from_slice(&(n as u64).to_le_bytes());
    }

    pub fn flag(&mut self, yes: bool) {
        self.0.push(u8::from(yes));
    }

    pub fn real(&mut self, x: f64) {
        self.0.extend_from_slice(&x.to_le_bytes());
    }

    pub fn row(&mut self, row: &[f64]) {
        self.whole(row.len());
        self.0.reserve(8 * row.len());
        for x in row {
            self.0.extend_from_slice(&x.to_le_bytes());
        }
    }

    pub fn rows(&mut self, rows: &[Vec<f64>]) {
        self.whole(rows.len());
        rows.iter().for_each(|row| self.row(row));
    }
}

/// Bytes to be read, from the first on.
#[derive(Debug)]
pub struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    /// Of these bytes.
    pub fn new(bytes: &'a [u8]) -> Reader<'a> {
        Reader(bytes)
    }

    /// Whether all has been read.
    pub fn is_done(&self) -> bool {
        self.0.is_empty()
    }

    fn word(&mut self) -> Option<[u8; 8]> {
        let (word, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*word)
    }

    pub fn whole(&mut self) -> Option<usize> {
        usize::try_from(u64::from_le_bytes(self.word()?)).ok()
    }

    pub fn flag(&mut self) -> Option<bool> {
        let (first, rest) = self.0.split_first()?;
        self.0 = rest;
        [false, true].get(usize::from(*first)).copied()
    }

    pub fn real(&mut self) -> Option<f64> {
        self.word().map(f64::from_le_bytes)
    }

    pub fn row(&mut self) -> Option<Vec<f64>> {
        let (row, rest) = self.whole()?.checked_mul(8).and_then(|bytes| self.0.split_at_checked(bytes))?;
        self.0 = rest;
        Some(row.chunks_exact(8).map(|x| f64::from_le_bytes(x.try_into().unwrap_or_default())).collect())
    }

    /// How often something was done: sums of such counts do not overflow.
    pub fn count(&mut self) -> Option<usize> {
        self.whole().filter(|n| *n <= MOST)
    }

    /// A number that is one, and whose square is.
    pub fn finite(&mut self) -> Option<f64> {
        self.real().filter(|x| x.abs() <= LARGEST)
    }

    /// A row of such numbers.
    pub fn finite_row(&mut self) -> Option<Vec<f64>> {
        self.row().filter(|row| row.iter().all(|x| x.abs() <= LARGEST))
    }

    /// A list behind its length, by what reads one of it.
    pub fn list<T>(&mut self, mut one: impl FnMut(&mut Self) -> Option<T>) -> Option<Vec<T>> {
        let count = self.whole()?;
        // each takes a byte at least, so a wrong length cannot ask for more memory than there are bytes
        (count <= self.0.len()).then_some(())?;
        (0..count).map(|_| one(self)).collect()
    }
}

/// What tells the input of one computation from that of another.
#[derive(Debug, Default)]
pub struct Fingerprint(Hasher);

impl Fingerprint {
    pub fn whole(mut self, n: usize) -> Self {
        self.0.update(&(n as u64).to_le_bytes());
        self
    }

    pub fn real(self, x: f64) -> Self {
        self.row(&[x])
    }

    pub fn text(mut self, text: &str) -> Self {
        self.0.update(text.as_bytes());
        self
    }

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

    pub fn value(self) -> usize {
        self.0.finalize() as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_written_is_read_to_the_bit_and_never_more_than_that() {
        let rows = vec![vec![0.1, -0.0, f64::MIN_POSITIVE], Vec::new(), vec![f64::INFINITY]];
        let mut w = Writer::default();
        w.whole(7);
        w.flag(true);
        w.real(1.0 / 3.0);
        w.rows(&rows);
        let bytes = w.into_bytes();
        let read = |bytes: &[u8]| {
            let mut r = Reader::new(bytes);
            let all = (r.whole()?, r.flag()?, r.real()?, r.list(Reader::row)?);
            r.is_done().then_some(all)
        };
        let (n, yes, x, again) = read(&bytes).unwrap();
        assert_eq!((n, yes, x.to_bits()), (7, true, (1.0f64 / 3.0).to_bits()));
        let bits = |rows: &[Vec<f64>]| rows.iter().flatten().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!((again.len(), bits(&again)), (3, bits(&rows)));
        for cut in 0..bytes.len() {
            assert!(read(&bytes[..cut]).is_none(), "{cut} bytes are too few");
        }
        let mut endless = bytes.clone();
        endless[17..25].fill(0xff);
        assert!(read(&endless).is_none());
    }

    #[test]
    fn another_bit_is_another_input() {
        let print = |x: f64| Fingerprint::default().whole(1).row(&[0.5, x]).value();
        assert_eq!(print(0.1), print(0.1));
        assert_ne!(print(0.1), print(f64::from_bits(0.1f64.to_bits() + 1)));
        assert_ne!(print(0.0), print(-0.0));
    }
}
