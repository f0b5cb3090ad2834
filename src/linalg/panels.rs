//! Lower halves of dense symmetric matrices in panels of four columns, each row by row from its first row on the diagonal:
//!
//! ```text
//!   0 ▓▓▓▓                     entry (i, j) of `rows` rows: first(rows, j / 4) + 4 (i − 4 ⌊j/4⌋) + j mod 4
//!   4 ▓▓▓▓▓▓▓▓
//!   8 ▓▓▓▓▓▓▓▓▓▓▓▓             half the memory of the square, and the four numbers of a row in one register
//! ```
//! What stands above the diagonal within a panel has no meaning.

/// Columns of a panel.
pub(super) const WIDTH: usize = 4;
/// Sites of a panel.
pub(super) const SITES: usize = WIDTH / 2;

/// Where a panel begins.
#[inline(always)]
pub(super) fn first(rows: usize, panel: usize) -> usize {
    WIDTH * (panel * rows) - WIDTH * WIDTH * (panel * panel.saturating_sub(1) / 2)
}

/// Length of so many panels.
pub(super) fn length(rows: usize, panels: usize) -> usize {
    first(rows, panels)
}
