//! The JSON Schema of a config, from the types that read it: editors complete and check configs with it.
//!
//! Draft 7, which Visual Studio Code and most others know. What a schema cannot say, such as how many sites there are, is in descriptions.

use super::Config;
use super::json::Step;
use super::refusals::inline;
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema, json_schema};
use serde_json::Value;

/// The name that configs give their schema.
pub const SCHEMA_FILE: &str = "spinneb.schema.json";
/// What a vector of space has beside what all schemas have: the letters of its components.
const COMPONENTS: &str = "components";

/// The schema of a config as text.
pub fn schema() -> String {
    format!("{:#}\n", value())
}

/// The schema of a config for `spinneb landscape` as text: its ends may be left out.
pub fn landscape_schema() -> String {
    let mut schema = of::<Config>("a config of a landscape of spinneb");
    if let Some(required) = schema["required"].as_array_mut() {
        required.retain(|key| key != "initial" && key != "final");
    }
    format!("{schema:#}\n")
}

pub(super) fn value() -> Value {
    of::<Config>("a config of spinneb")
}

/// Of any part, with this title.
pub(super) fn of<T: JsonSchema>(title: &str) -> Value {
    let mut schema = SchemaSettings::draft07().into_generator().into_root_schema_for::<T>();
    schema.insert("title".into(), title.into());
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
    let properties = own["properties"].as_object().into_iter().flatten();
    let mut keys: Vec<Key> = properties.map(|(name, property)| key(&schema, own, name, property)).collect();
    keys.sort_by_key(|key| !key.required);
    keys
}

/// A key of an object of the schema, in words.
pub(super) fn key(schema: &Value, owner: &Value, name: &str, property: &Value) -> Key {
    let mut form = property.clone();
    // what it means is no form of what is written
    form.as_object_mut().map(|form| form.remove("description"));
    Key {
        name: name.into(),
        required: owner["required"].as_array().is_some_and(|required| required.iter().any(|key| key == name)),
        default: property.get("default").filter(|d| !d.is_null()).map(inline),
        meaning: property["description"].as_str().unwrap_or_default().into(),
        value: written(schema, &form),
    }
}

/// The letter of a component where the path ends in a vector of space: `z` of `energy[0].zeeman.B[2]`.
pub(super) fn component(schema: &Value, path: &[Step]) -> Option<String> {
    let (Step::Index(i), owner) = path.split_last()? else { return None };
    let mut nodes = forms(schema, schema);
    for step in owner {
        nodes = nodes.into_iter().filter_map(|node| below(node, step)).flat_map(|node| forms(schema, node)).collect();
    }
    nodes.into_iter().find_map(|node| node[COMPONENTS].get(i)?.as_str().map(String::from))
}

/// What stands for a step down.
fn below<'a>(node: &'a Value, step: &Step) -> Option<&'a Value> {
    match step {
        Step::Key(key) => node["properties"].get(key).or(node.get("additionalProperties")),
        Step::Index(_) => node.get("items"),
    }
}

/// All that a part may be.
fn forms<'a>(schema: &'a Value, part: &'a Value) -> Vec<&'a Value> {
    let part = resolved(schema, part);
    let lists = ["allOf", "anyOf", "oneOf"].into_iter().filter_map(|list| part[list].as_array());
    [part].into_iter().chain(lists.flatten().flat_map(|form| forms(schema, form))).collect()
}

/// What a `$ref` stands for.
pub(super) fn resolved<'a>(schema: &'a Value, part: &'a Value) -> &'a Value {
    let pointer = part["$ref"].as_str().and_then(|r| r.strip_prefix('#'));
    pointer.and_then(|pointer| schema.pointer(pointer)).unwrap_or(part)
}

/// What is written for a value, in words.
fn written(schema: &Value, part: &Value) -> String {
    let referred = resolved(schema, part);
    if !std::ptr::eq(referred, part) {
        let inner = referred["anyOf"][0].get("$ref").map(|_| written(schema, &referred["anyOf"][0]));
        let plain = referred["oneOf"][0].get("const").is_none() && !referred["properties"].is_object();
        return match (own(referred), inner) {
            (Some(told), Some(inner)) => format!("{told}; each {inner}"),
            (Some(told), None) if plain => told,
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
    let mut forms = [choices("anyOf"), choices("oneOf")].concat();
    forms.retain(|form| form["type"] != "null");
    let names: Vec<&str> = forms.iter().filter_map(|form| Some(member(form)?.0.as_str())).collect();
    match names.len() {
        0 if forms.is_empty() => simple(schema, part),
        n if n > 1 && n == forms.len() => format!("{{NAME: …}} with one of the names {}", names.join(", ")),
        _ => forms.iter().map(|form| written(schema, form)).collect::<Vec<_>>().join(" or "),
    }
}

/// The same of what is no choice.
fn simple(schema: &Value, part: &Value) -> String {
    let kinds = part["type"].as_array().cloned().unwrap_or_else(|| vec![part["type"].clone()]);
    let many = || match (part["minItems"].as_u64(), part.get("items")) {
        (Some(n), Some(items)) => format!("[{n} values, each {}]", written(schema, items)),
        (None, Some(items)) => format!("[a list, each {}]", written(schema, items)),
        _ => "a list".into(),
    };
    let told = |kind: &str| own(part).unwrap_or_else(|| kind.into());
    if let Some(words) = part["enum"].as_array() {
        return words.iter().map(inline).collect::<Vec<_>>().join(" or ");
    }
    match kinds.iter().filter_map(Value::as_str).find(|kind| *kind != "null") {
        Some("number") => own(part).map_or("a number".into(), |told| format!("a number, {told}")),
        Some("integer") => "a whole number".into(),
        Some("boolean") => "true or false".into(),
        Some("string") => told("a text"),
        Some("array") => many(),
        _ if part["properties"].is_object() && part["additionalProperties"] == false => keys_of(part),
        _ if part["additionalProperties"].is_object() && own(part).is_none() => {
            format!("{{NAME: …}}, each {}", written(schema, &part["additionalProperties"]))
        }
        _ => told("an object"),
    }
}

/// The keys of an object; those that may be left out with a question mark.
fn keys_of(part: &Value) -> String {
    let required =
        |name: &str| part["required"].as_array().is_some_and(|required| required.iter().any(|key| key == name));
    let mut names: Vec<&String> = part["properties"].as_object().into_iter().flatten().map(|(name, _)| name).collect();
    names.sort_by_key(|name| !required(name));
    let shown = |name: &&String| if required(name) { name.to_string() } else { format!("{name}?") };
    format!("{{{}}}", names.iter().map(shown).collect::<Vec<_>>().join(", "))
}

/// What a part says of itself, where that is in words.
fn own(part: &Value) -> Option<String> {
    part["description"].as_str().filter(|told| !told.starts_with('`')).map(String::from)
}

/// The one key of a choice, `{"exchange": {…}}`, with what stands in it.
pub(super) fn member(part: &Value) -> Option<(&String, &Value)> {
    let properties = part["properties"].as_object()?;
    let required = part["required"].as_array().is_some_and(|required| required.len() == 1);
    let alone = properties.len() == 1 && required && !part["additionalProperties"].is_object();
    alone.then(|| properties.iter().next()).flatten()
}

/// A list of some of these names, each once.
pub(super) fn names_schema(names: impl Iterator<Item = &'static str>) -> Schema {
    json_schema!({"type": "array", "items": {"enum": names.collect::<Vec<_>>()}, "uniqueItems": true})
}
