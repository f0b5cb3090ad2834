//! Numbers of a document.

use serde::{Deserialize, Serialize, Serializer, ser::Error as _};

/// A number that JSON can hold.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct Number(pub f64);

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        if self.0.is_finite() {
            serializer.serialize_f64(self.0)
        } else {
            Err(S::Error::custom(format!("{} is not a finite number", self.0)))
        }
    }
}
