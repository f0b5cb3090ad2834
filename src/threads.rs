//! How much work is worth waking another thread for: some 30 µs of it.

/// Numbers of vector fields that are passed once.
pub const READ: usize = 3 * 8192;
/// Numbers of vector fields that are made from angles, or in several passes.
pub const MADE: usize = 3 * 2048;

/// Runs two computations on fields of `numbers` numbers, side by side where that is worth it.
pub fn both<A: Send, B: Send>(numbers: usize, a: impl FnOnce() -> A + Send, b: impl FnOnce() -> B + Send) -> (A, B) {
    if numbers < MADE { (a(), b()) } else { rayon::join(a, b) }
}

/// So many fields of `numbers` numbers make a piece of work of at least `worth` numbers.
pub fn apiece(numbers: usize, worth: usize) -> usize {
    worth.div_ceil(numbers.max(1))
}
