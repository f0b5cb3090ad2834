//! What magnetic moments in a row do to each other, all pairs of them.
//!
//! ```text
//! E = ½ (μ₀/V) Σ_ij μ_i μ_j m_i·N(|i − j|) m_j          = E_ref + Σ_i ½ (m_i·h_i − x̂·h_i(x̂))
//! ∂E/∂m_i = h_i = (μ₀/V) μ_i Σ_j N(|i − j|) μ_j m_j
//! ```
//! N is the demagnetising tensor of uniformly magnetised cells of volume V, or that of point dipoles; it is diagonal in the
//! chain's own axes (along, width, thickness). Cells of unequal cross-sections have a tensor a pair instead, see [`Pairs`]. The reference is the chain magnetised along itself, x̂.

mod convolution;
mod exponentials;
mod kernel;
mod newell;
mod pairs;
mod section;
mod series;
mod term;

pub use convolution::Convolution;
pub use exponentials::Exponentials;
pub use kernel::{Kernel, Shape};
pub use newell::{cell_tensor, pair_tensor};
pub use pairs::Pairs;
pub use section::Section;
pub use series::{Multipoles, Series, hurwitz_zeta};
pub use term::{DENSE, MU_0_MU_B_SQUARED, Magnetostatics, Row};
