//! The JSON Schema of a config, from the types that read it: editors complete and check configs with it.
//!
//! Draft 7, which Visual Studio Code and most others know. What a schema cannot say, such as how many sites there are, is in descriptions.

use super::Config;
use super::refusals::inline;
use schemars::generate::SchemaSettings;
use schemars::{Schema, json_schema};
use serde_json::Value;

/// The name that configs give their schema.
pub const SCHEMA_FILE: &str = "spinneb.schema.json";

/// The schema as text.
pub fn schema() -> String {
    format!("{:#}\n", value())
}

fn value() -> Value {
    let mut schema = SchemaSettings::draft07().into_generator().into_root_schema_for::<Config>();
    schema.insert("title".into(), "a config of spinneb".into());
    schema.to_value()
}

/// A key of a part of a config, in words.
#[derive(Clone, Debug, PartialEq)]
pub struct Key {
    /// Its name.
    pub name: String,
    /// It may not be left out.
    pub required: bool,
    /// What it takes if left out, where that is a value.
    pub default: Option<String>,
    /// What it says.
    pub meaning: String,
    /// What is written.
    pub value: String,
}

/// The keys of a member of a family of the schema (`TermSpec`, `exchange`); required ones first.
pub fn keys(family: &str, member: &str) -> Vec<Key> {
    let schema = value();
    let choices = schema["definitions"][family]["oneOf"].as_array().into_iter().flatten();
    let Some(own) = choices.map(|choice| &choice["properties"][member]).find(|own| own.is_object()) else {
        return Vec::new();
    };
    let own = resolved(&schema, own);
    let required = |name: &str| own["required"].as_array().is_some_and(|r| r.iter().any(|key| key == name));
    let properties = own["properties"].as_object().into_iter().flatten();
    let key = |(name, property): (&String, &Value)| Key {
        name: name.clone(),
        required: required(name),
        default: property.get("default").filter(|d| !d.is_null()).map(inline),
        meaning: property["description"].as_str().unwrap_or_default().into(),
        value: written(&schema, property),
    };
    let mut keys: Vec<Key> = properties.map(key).collect();
    keys.sort_by_key(|key| !key.required);
    keys
}

/// What a `$ref` stands for.
fn resolved<'a>(schema: &'a Value, part: &'a Value) -> &'a Value {
    let pointer = part["$ref"].as_str().and_then(|r| r.strip_prefix('#'));
    pointer.and_then(|pointer| schema.pointer(pointer)).unwrap_or(part)
}

/// What is written for a value, in words.
fn written(schema: &Value, part: &Value) -> String {
    let referred = resolved(schema, part);
    let own = |part: &Value| part["description"].as_str().map(String::from);
    if !std::ptr::eq(referred, part) {
        let inner = referred["anyOf"][0].get("$ref").map(|_| written(schema, &referred["anyOf"][0]));
        let told = own(referred);
        return match (told, inner) {
            (Some(told), Some(inner)) => format!("{told}; each {inner}"),
            (Some(told), None) if referred["oneOf"][0].get("const").is_none() => told,
            _ => written(schema, referred),
        };
    }
    let choices = |list: &str| part[list].as_array().cloned().unwrap_or_default();
    if let Some(constant) = part.get("const") {
        return inline(constant);
    }
    if let Some(one) = choices("allOf").first() {
        return written(schema, one);
    }
    let forms: Vec<String> = choices("anyOf")
        .iter()
        .chain(&choices("oneOf"))
        .filter(|form| form["type"] != "null")
        .map(|form| written(schema, form))
        .collect();
    if !forms.is_empty() {
        return forms.join(" or ");
    }
    let kinds = part["type"].as_array().cloned().unwrap_or_else(|| vec![part["type"].clone()]);
    let many = || match (part["minItems"].as_u64(), part.get("items")) {
        (Some(n), Some(items)) => format!("[{n} values, each {}]", written(schema, items)),
        (None, Some(items)) => format!("[a list, each {}]", written(schema, items)),
        _ => "a list".into(),
    };
    match kinds.iter().filter_map(Value::as_str).find(|kind| *kind != "null") {
        Some("number") => "a number".into(),
        Some("integer") => "a whole number".into(),
        Some("boolean") => "true or false".into(),
        Some("string") => "a text".into(),
        Some("array") => many(),
        _ => own(part).unwrap_or_else(|| "an object".into()),
    }
}

/// A list of some of these names, each once.
pub(super) fn names_schema(names: impl Iterator<Item = &'static str>) -> Schema {
    json_schema!({"type": "array", "items": {"enum": names.collect::<Vec<_>>()}, "uniqueItems": true})
}
