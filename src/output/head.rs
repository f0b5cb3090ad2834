//! What the summary of a result of any version says.

use serde::{Deserialize, Serialize};

/// Which result it is, and what it is worth: what a summary of any version says.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Head {
    /// The version that wrote it.
    pub version: String,
    /// The hash of its config.
    pub config_sha256: String,
    /// The band met its tolerance.
    pub converged: bool,
    /// Ends and saddles are proven.
    pub certified: bool,
}

impl Head {
    /// Converged and certified.
    pub fn is_proven(&self) -> bool {
        self.converged && self.certified
    }
}
