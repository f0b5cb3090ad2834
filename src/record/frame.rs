//! Pieces of a file that show whether they are whole: length, check value, content.
//!
//! ```text
//! file  = "spinneb checkpoint 1\n", frame, frame, …
//! frame = length of the content (8 bytes), CRC-32 of length and content (4 bytes), content        numbers little-endian
//! ```

use crc32fast::Hasher;
use std::fs::File;
use std::io::{self, ErrorKind, Read, Write};
use std::path::Path;

/// How every file begins; the number is that of the format.
const MAGIC: &[u8] = b"spinneb checkpoint 1\n";
/// Bytes of a frame before its content.
pub const HEAD: u64 = 12;

/// Begins a file.
pub fn begin(out: &mut impl Write) -> io::Result<()> {
    out.write_all(MAGIC)
}

/// Whether a file begins as such a file does, or is empty.
pub fn is_begun(path: &Path) -> io::Result<bool> {
    let mut start = Vec::new();
    File::open(path)?.take(MAGIC.len() as u64).read_to_end(&mut start)?;
    Ok(start.is_empty() || start == MAGIC)
}

/// Writes one frame.
pub fn write(out: &mut impl Write, content: &[u8]) -> io::Result<()> {
    let length = (content.len() as u64).to_le_bytes();
    out.write_all(&length)?;
    out.write_all(&check(&length, content))?;
    out.write_all(content)
}

fn check(length: &[u8; 8], content: &[u8]) -> [u8; 4] {
    let mut hasher = Hasher::new();
    hasher.update(length);
    hasher.update(content);
    hasher.finalize().to_le_bytes()
}

/// The frames of a file, one after the other.
#[derive(Debug)]
pub struct Frames<R> {
    file: R,
    /// Where the last whole frame ends (bytes from the start).
    pub end: u64,
    size: u64,
}

impl<R: Read> Frames<R> {
    /// Of a file of `size` bytes, from its start; nothing if that is not the start of such a file.
    pub fn of(mut file: R, size: u64) -> io::Result<Option<Frames<R>>> {
        let mut start = [0; MAGIC.len()];
        match file.read_exact(&mut start) {
            Ok(()) if start == MAGIC => Ok(Some(Frames { file, end: MAGIC.len() as u64, size })),
            Ok(()) => Ok(None),
            Err(e) if e.kind() == ErrorKind::UnexpectedEof => Ok(None),
            Err(e) => Err(e),
        }
    }

    /// The content of the next frame; nothing at the end of the file, or where the frame is not whole.
    pub fn next_frame(&mut self) -> io::Result<Option<Vec<u8>>> {
        let mut head = [0; HEAD as usize];
        let left = self.size.saturating_sub(self.end);
        if left < HEAD {
            return Ok(None);
        }
        self.file.read_exact(&mut head)?;
        let Some((length, rest)) = head.split_first_chunk::<8>() else { return Ok(None) };
        let bytes = u64::from_le_bytes(*length);
        if bytes > left - HEAD {
            return Ok(None);
        }
        let mut content = vec![0; usize::try_from(bytes).map_err(io::Error::other)?];
        self.file.read_exact(&mut content)?;
        if check(length, &content) != *rest {
            return Ok(None);
        }
        self.end += HEAD + bytes;
        Ok(Some(content))
    }

    /// Whether the file goes on behind the last whole frame.
    pub fn has_rest(&self) -> bool {
        self.end < self.size
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contents(bytes: &[u8]) -> Option<(Vec<Vec<u8>>, bool)> {
        let mut frames = Frames::of(bytes, bytes.len() as u64).unwrap()?;
        let found = std::iter::from_fn(|| frames.next_frame().unwrap()).collect();
        Some((found, frames.has_rest()))
    }

    #[test]
    fn a_frame_is_read_whole_or_not_at_all() {
        let mut file = Vec::new();
        begin(&mut file).unwrap();
        let first = file.len();
        write(&mut file, b"one").unwrap();
        let second = file.len();
        write(&mut file, b"").unwrap();
        assert_eq!(contents(&file).unwrap(), (vec![b"one".to_vec(), Vec::new()], false));
        for cut in 0..file.len() {
            let whole = usize::from(cut >= second);
            match contents(&file[..cut]) {
                None => assert!(cut < first),
                Some((found, rest)) => {
                    assert_eq!((found.len(), rest), (whole, cut != first && cut != second), "{cut} bytes")
                }
            }
        }
        for k in first..second {
            let mut bad = file.clone();
            bad[k] ^= 4;
            assert_eq!(contents(&bad).unwrap(), (Vec::new(), true), "byte {k}");
        }
    }
}
