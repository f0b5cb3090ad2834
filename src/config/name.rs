//! Names of runs, which are also names of folders.

use crate::error::{Error, Result};
use crate::words::quoted;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer};
use std::borrow::Cow;
use std::fmt;

/// Longest name, so that every file system takes it.
const LONGEST: usize = 200;

/// A name of letters, digits, dots, underscores and hyphens.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Name(String);

impl Name {
    /// The name, if it can be one.
    pub fn new(name: &str) -> Result<Name> {
        let allowed = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '_' | '-');
        let wrong = match name {
            "" => "is empty",
            "." | ".." => "stands for a folder",
            _ if name.len() > LONGEST => "is too long",
            _ if !name.chars().all(allowed) => "has other characters",
            _ => return Ok(Name(name.into())),
        };
        let rule = format!("a name is 1 to {LONGEST} of the characters A-Z a-z 0-9 . _ -");
        Err(Error::invalid("", format!("{} {wrong}: {rule}", quoted(name))))
    }

    /// As text.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl JsonSchema for Name {
    fn schema_name() -> Cow<'static, str> {
        "Name".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({"type": "string", "pattern": "^[A-Za-z0-9._-]+$", "maxLength": LONGEST})
    }
}

impl<'de> Deserialize<'de> for Name {
    fn deserialize<D: Deserializer<'de>>(d: D) -> std::result::Result<Self, D::Error> {
        Name::new(&String::deserialize(d)?).map_err(serde::de::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_can_be_a_folder_and_nothing_but_a_folder() {
        for good in ["wall", "a", "v1.2_x-3", "...", "-"] {
            assert_eq!(Name::new(good).unwrap().as_str(), good);
        }
        for bad in ["", ".", "..", "a/b", "a b", "a\\b", "ä", &"x".repeat(201)] {
            assert!(Name::new(bad).is_err(), "{bad}");
        }
    }
}
