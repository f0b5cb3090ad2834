//! The cross-section of a cell.

/// Width and thickness of a cell, in units of the spacing.
pub type Section = [f64; 2];
