//! Names of runs, which are also names of folders.

use crate::error::{Error, Result};
use crate::words::quoted;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer};
use std::borrow::Cow;
use std::fmt;

/// Longest name, so that every file system takes it.
const LONGEST: usize = 200;

/// What Windows takes for a device, whatever ending follows.
const DEVICES: [&str; 4] = ["con", "prn", "aux", "nul"];
/// The same of numbered ones: COM1, LPT9.
const PORTS: [&str; 2] = ["com", "lpt"];

/// A name of letters, digits, dots, underscores and hyphens that no system takes for anything but a folder's.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Name(String);

impl Name {
    /// The name, if it can be one.
    pub fn new(name: &str) -> Result<Name> {
        let wrong = match name {
            "" => "is empty",
            "." | ".." => "stands for a folder",
            _ if name.len() > LONGEST => "is too long",
            _ if !name.chars().all(is_allowed) => "has other characters",
            _ if name.starts_with('-') => "begins with a hyphen, as an option of a command does",
            _ if name.starts_with('.') => "begins with a dot, as a hidden folder does",
            _ if name.ends_with('.') => "ends in a dot, which Windows drops",
            _ if is_device(name) => "is a device on Windows",
            _ => return Ok(Name(name.into())),
        };
        let rule = format!(
            "a name is 1 to {LONGEST} of the characters A-Z a-z 0-9 . _ -, begins with none of . - and does not end in ."
        );
        Err(Error::invalid("", format!("{} {wrong}: {rule}", quoted(name))))
    }

    /// One to propose in place of a text that is none: an underscore stands for what a name does not hold.
    pub fn near(text: &str) -> Name {
        let kept: Vec<&str> = text.split(|c| !is_allowed(c)).filter(|part| !part.is_empty()).collect();
        let kept = kept.join("_");
        let kept = kept.trim_start_matches(['.', '-']).trim_end_matches('.');
        let prefixed = format!("run_{kept}");
        let fit = [kept, &prefixed].into_iter().filter(|_| !kept.is_empty()).find_map(|name| Name::new(name).ok());
        fit.unwrap_or(Name("run".into()))
    }

    /// As text.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

fn is_allowed(c: char) -> bool {
    c.is_ascii_alphanumeric() || matches!(c, '.' | '_' | '-')
}

fn is_device(name: &str) -> bool {
    let stem = name.split('.').next().unwrap_or_default().to_ascii_lowercase();
    let is_port =
        |port: &&str| stem.strip_prefix(*port).is_some_and(|n| n.len() == 1 && n.as_bytes()[0].is_ascii_digit());
    DEVICES.contains(&stem.as_str()) || PORTS.iter().any(is_port)
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
        json_schema!({
            "type": "string",
            "pattern": "^[A-Za-z0-9_]([A-Za-z0-9._-]*[A-Za-z0-9_-])?$",
            "not": {"pattern": "^([Cc][Oo][Nn]|[Pp][Rr][Nn]|[Aa][Uu][Xx]|[Nn][Uu][Ll]|([Cc][Oo][Mm]|[Ll][Pp][Tt])[0-9])([.]|$)"},
            "maxLength": LONGEST
        })
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
        for good in ["wall", "a", "v1.2_x-3", "_", "a-", "console", "com", "com10", "nul_1", "lptx"] {
            assert_eq!(Name::new(good).unwrap().as_str(), good);
        }
        let windows = ["CON", "nul", "aux.txt", "Com1", "LPT9.json", "prn", "com0.a.b"];
        let shells = ["", ".", "..", "...", "-", "-rf", ".hidden", "wall.", "a/b", "a b", "a ", "a\\b", "ä", "a\n"];
        for bad in windows.into_iter().chain(shells).chain([&*"x".repeat(201)]) {
            assert!(Name::new(bad).is_err(), "{bad}");
            assert!(Name::new(Name::near(bad).as_str()).is_ok(), "{bad}");
        }
    }

    #[test]
    fn a_name_is_proposed_for_any_file() {
        let near = ["my config (2)", "Fe₃Sn", "λ", "nul", "-rf", "wall."].map(|text| Name::near(text).to_string());
        assert_eq!(near, ["my_config_2", "Fe_Sn", "run", "run_nul", "rf", "wall"]);
    }
}
