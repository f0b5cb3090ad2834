//! The JSON Schema of a config, from the types that read it: editors complete and check configs with it.
//!
//! Draft 7, which Visual Studio Code and most others know. What a schema cannot say, such as which units fit, is in descriptions.

use super::Config;
use schemars::generate::SchemaSettings;
use schemars::{Schema, json_schema};

/// The name that configs give their schema.
pub const SCHEMA_FILE: &str = "spinneb.schema.json";

/// The schema as text.
pub fn schema() -> String {
    let mut schema = SchemaSettings::draft07().into_generator().into_root_schema_for::<Config>();
    schema.insert("title".into(), "a config of spinneb".into());
    format!("{:#}\n", schema.to_value())
}

/// A list of some of these names, each once.
pub(super) fn names_schema(names: impl Iterator<Item = &'static str>) -> Schema {
    json_schema!({"type": "array", "items": {"enum": names.collect::<Vec<_>>()}, "uniqueItems": true})
}
