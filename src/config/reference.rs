//! The reference of all keys of a config, from its schema: a page of the book, and what `spinneb docs` prints.
//!
//! A part of a config that stands in many places, such as a shape, is told of once.

use super::refusals::inline;
use super::schema::{Key, key, member, resolved, value};
use crate::words::nearest;
use serde_json::{Value, json};
use std::collections::{BTreeSet, VecDeque};
use std::fmt::Write;

/// The keys of the config itself in the order of a reader's questions.
const ORDER: [&str; 17] = [
    "name",
    "material",
    "lattice",
    "energy",
    "initial",
    "final",
    "relax_ends",
    "path",
    "search",
    "neb",
    "saddle",
    "rates",
    "landscape",
    "output",
    "custom_terms",
    "comment",
    "$schema",
];

/// Where values are told of that differ from site to site, and what each of them is.
const VALUES: &str = "value";
const OF_ITS_KEY: &str = "a number with a unit of the key that it is written for; here of `material.Ms`";

/// Parts that stand in many places: what is written before their keys in the place of one of these.
const SHARED: [(&str, &str); 5] = [
    ("Profile", VALUES),
    ("Selection", "sites"),
    ("Shape", "shape"),
    ("Extent", "length"),
    ("Temperatures", "temperatures"),
];

/// Titles of the parts that are a choice, by where they stand.
const TITLES: [(&str, &str); 7] = [
    ("lattice", "Lattices"),
    ("energy", "Energy terms"),
    ("initial", "States"),
    ("path.guess", "First paths"),
    ("neb.optimiser", "Optimisers"),
    ("shape", "Shapes"),
    ("value", "Values that differ from site to site"),
];

/// A part of a config: an object with keys.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    /// Where it stands, without indices: `energy.exchange`; empty for the config itself.
    pub path: String,
    /// What it is.
    pub summary: String,
    /// A value of it that may be written, as JSON.
    pub example: String,
    /// Its keys, each with a value that may be written, as JSON; required ones first.
    pub keys: Vec<(Key, String)>,
    /// Its schema, which may refer to the definitions of the whole.
    pub schema: Value,
}

/// All parts of a config.
pub fn sections() -> Vec<Section> {
    let schema = value();
    let mut walk = Walk { schema: &schema, seen: BTreeSet::new(), queue: VecDeque::new(), found: Vec::new() };
    let summary = "A config is one object with these keys.";
    walk.queue.push_back(Part { path: String::new(), node: &schema, summary: summary.into(), example: None });
    while let Some(part) = walk.queue.pop_front() {
        walk.tell(part);
    }
    walk.found
}

/// A part that is to be told of.
struct Part<'s> {
    path: String,
    node: &'s Value,
    summary: String,
    example: Option<Value>,
}

struct Walk<'s> {
    schema: &'s Value,
    seen: BTreeSet<String>,
    queue: VecDeque<Part<'s>>,
    found: Vec<Section>,
}

impl<'s> Walk<'s> {
    fn tell(&mut self, part: Part<'s>) {
        let mut keys: Vec<(Key, String)> = Vec::new();
        for (name, property) in part.node["properties"].as_object().into_iter().flatten() {
            let shown = part.example.as_ref().and_then(|example| example.get(name)).cloned();
            let example = shown.unwrap_or_else(|| example(self.schema, property, name));
            keys.push((key(self.schema, part.node, name, property), inline(&example)));
        }
        if part.path.split('.').next() == Some(VALUES) {
            // the schema has them for each kind of quantity, and the first is told of
            let own = keys.iter_mut().filter(|(key, _)| key.value.contains("with its unit"));
            own.for_each(|(key, _)| key.value = OF_ITS_KEY.into());
        }
        let place = |key: &Key| ORDER.iter().position(|name| part.path.is_empty() && *name == key.name);
        keys.sort_by_key(|(key, _)| (place(key), !key.required));
        for (key, _) in &keys {
            self.below(&joined(&part.path, &key.name), &key.meaning, &part.node["properties"][&key.name]);
        }
        let Part { path, summary, node, example: told } = part;
        let example = told.unwrap_or_else(|| example(self.schema, node, ""));
        self.found.push(Section { path, summary, example: inline(&example), keys, schema: node.clone() });
    }

    /// Puts the parts that a value may consist of into the queue.
    fn below(&mut self, path: &str, meaning: &str, node: &'s Value) {
        let mut path = path.to_string();
        if let Some(name) = node["$ref"].as_str().and_then(|r| r.rsplit('/').next()) {
            let name = name.split("_of_").next().unwrap_or(name);
            if !self.seen.insert(name.into()) {
                return;
            }
            if let Some((_, own)) = SHARED.iter().find(|(shared, _)| *shared == name) {
                path = own.to_string();
            }
        }
        let node = resolved(self.schema, node);
        if let Some((name, member)) = member(node) {
            let (path, example) = (joined(&path, name), node["examples"].get(0).and_then(|e| e.get(name)));
            let inner = resolved(self.schema, member);
            if inner["properties"].is_object() || example.is_some() {
                self.queue.push_back(Part {
                    path,
                    node: inner,
                    summary: words(node).into(),
                    example: example.cloned(),
                });
            } else {
                self.below(&path, words(node), member);
            }
            return;
        }
        if node["properties"].is_object() {
            let summary = Some(words(node)).filter(|words| !words.is_empty()).unwrap_or(meaning).to_string();
            let example = told_example(node, path.rsplit('.').next().unwrap_or_default());
            self.queue.push_back(Part { path, node, summary, example });
            return;
        }
        for list in ["allOf", "anyOf", "oneOf"] {
            node[list].as_array().into_iter().flatten().for_each(|form| self.below(&path, meaning, form));
        }
        for inner in ["items", "additionalProperties"] {
            if node[inner].is_object() {
                self.below(&path, meaning, &node[inner]);
            }
        }
    }
}

/// What a part says of itself, without the example that it may begin with.
fn words(node: &Value) -> &str {
    let told = node["description"].as_str().unwrap_or_default();
    let rest = told.strip_prefix('`').and_then(|told| told.split_once('`')).map_or(told, |(_, rest)| rest);
    rest.trim_start_matches(['.', ':', ';', ',', ' ', '\n'])
}

/// The example in JSON that a part's words may begin with: `{"axis": …}`, or a key of this name with its value.
fn told_example(node: &Value, name: &str) -> Option<Value> {
    let told = node["description"].as_str()?.strip_prefix('`')?.split('`').next()?;
    let own: Option<Value> = serde_json::from_str(told).ok();
    own.or_else(|| serde_json::from_str::<Value>(&format!("{{{told}}}")).ok()?.get_mut(name).map(Value::take))
}

fn joined(path: &str, name: &str) -> String {
    if path.is_empty() { name.into() } else { format!("{path}.{name}") }
}

/// A value that a key of this name may have.
fn example(schema: &Value, node: &Value, name: &str) -> Value {
    let given = [&node["examples"][0], &node["const"], &node["enum"][0], &node["default"]];
    if let Some(value) = given.into_iter().find(|value| !value.is_null()) {
        return value.clone();
    }
    let referred = resolved(schema, node);
    if !std::ptr::eq(referred, node) {
        return example(schema, referred, name);
    }
    if let Some(told) = told_example(node, name) {
        return told;
    }
    let mut forms = ["allOf", "anyOf", "oneOf"].iter().filter_map(|list| node[list].as_array()).flatten();
    if let Some(form) = forms.find(|form| form["type"] != "null") {
        return example(schema, form, name);
    }
    let kind = node["type"].as_array().map_or(&node["type"], |kinds| &kinds[0]);
    match kind.as_str() {
        Some("number") => json!(node["minimum"].as_f64().map_or(0.5, |least| least.max(0.5))),
        Some("integer") => json!(node["minimum"].as_u64().map_or(1, |least| least.max(1))),
        Some("boolean") => json!(true),
        Some("array") => {
            let one = example(schema, &node["items"], name);
            json!(vec![one; node["minItems"].as_u64().unwrap_or(1) as usize])
        }
        Some("object") => {
            let required = node["required"].as_array().into_iter().flatten().filter_map(Value::as_str);
            let inner = |key: &str| (key.to_string(), example(schema, &node["properties"][key], key));
            let mut object: serde_json::Map<String, Value> = required.map(inner).collect();
            if object.is_empty() && node["additionalProperties"].is_object() {
                object.insert("name".into(), example(schema, &node["additionalProperties"], name));
            }
            Value::Object(object)
        }
        _ => json!(TEXTS.iter().find(|(key, _)| *key == name).map_or("any text", |(_, text)| text)),
    }
}

/// Texts that keys may have.
const TEXTS: [(&str, &str); 14] = [
    ("$schema", "spinneb.schema.json"),
    ("also", "Py"),
    ("custom_terms", "pinning"),
    ("default", "permalloy"),
    ("file", "bonds.csv"),
    ("key", "doi:10.1000/1"),
    ("material", "permalloy"),
    ("name", "wall"),
    ("path", "spins.ovf"),
    ("sites", "pin"),
    ("source", "doi:10.1000/1"),
    ("species", "Fe"),
    ("status", "read"),
    ("theory", "langer"),
];

/// The page of the book.
pub fn page() -> String {
    let mut page = String::from(HEAD);
    let (sections, mut title) = (sections(), "");
    for (k, section) in sections.iter().enumerate() {
        let family = family(&section.path);
        let own =
            TITLES.iter().find(|(path, _)| *path == family || *path == section.path).map_or("", |(_, title)| title);
        if own != title && !own.is_empty() {
            let _ = writeln!(page, "\n## {own}");
        }
        title = own;
        let heading = match section.path.as_str() {
            "" => "\n## The config\n".into(),
            // another form of what the section before it tells of
            path if k > 0 && sections[k - 1].path == path => String::new(),
            path => format!("\n{} `{path}`\n", if own.is_empty() { "##" } else { "###" }),
        };
        let _ = writeln!(page, "{heading}\n{}", ended(&section.summary));
        if !section.path.is_empty() {
            let _ = writeln!(page, "\n```text\n{}\n```", section.example);
        }
        listed(&mut page, section, &sections[..k]);
    }
    page
}

/// What a part is one of, by the path before its name.
fn family(path: &str) -> &str {
    path.rsplit_once('.').map_or(path, |(family, _)| family)
}

const HEAD: &str = "\
# Reference of all keys

Every key of a config: what it says, what is written, what holds if it is left out, and a value that may be written. The page is made
from the schema, as `spinneb docs KEY` is, which prints an entry (`spinneb docs anisotropy.K`); `spinneb schema` prints the schema
itself, `spinneb schema sweep` and `spinneb schema landscape` those of sweeps and landscapes. Indices are left out of the names: `energy.anisotropy.K` is
`energy[0].anisotropy.K` for `--set` and in sweeps. Energy terms stand in `energy` and in a material's `energy`, states in `initial`, `final`,
waypoints and `landscape.states`.
";

/// The keys of a section, but for those that it has in common with another lattice: of these, the names.
fn listed(page: &mut String, section: &Section, earlier: &[Section]) {
    let common =
        |other: &&Section| section.keys.iter().filter(|(key, _)| other.keys.iter().any(|(own, _)| own == key)).count();
    let lattice = |path: &str| family(path) == "lattice";
    let others = earlier.iter().filter(|other| lattice(&other.path) && lattice(&section.path)).rev();
    let model = others.max_by_key(common).filter(|model| common(model) > 0);
    let (told, own): (Vec<_>, Vec<_>) = section
        .keys
        .iter()
        .partition(|(key, _)| model.is_some_and(|model| model.keys.iter().any(|(other, _)| other == key)));
    if !own.is_empty() {
        page.push('\n');
    }
    for (key, example) in own {
        let (meaning, left_out, value) = (ended(&key.meaning), left_out(key), key.value.replace('\n', " "));
        let line = format!("- **`{}`** ({left_out}): {meaning}<br>*takes* {value}<br>*such as* ", key.name);
        let _ = writeln!(page, "{}`{example}`", line.replace('<', "&lt;").replace("&lt;br>", "<br>"));
    }
    if let Some(model) = model {
        let names: Vec<String> = told.iter().map(|(key, _)| format!("`{}`", key.name)).collect();
        let _ = writeln!(page, "\nAs in `{}`: {}.", model.path, names.join(", "));
    }
}

/// Whether a key may be left out, and what holds then.
pub fn left_out(key: &Key) -> String {
    match (key.required, &key.default) {
        (true, _) => "required".into(),
        (false, Some(default)) => format!("{default} if left out"),
        (false, None) => "may be left out".into(),
    }
}

/// A sentence of one line, with its end.
fn ended(words: &str) -> String {
    let line = words.split_whitespace().collect::<Vec<_>>().join(" ");
    let mut letters = line.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    let end = if line.ends_with(['.', ':', '`']) || line.is_empty() { "" } else { "." };
    if line.starts_with(char::is_alphabetic) {
        format!("{first}{}{end}", letters.as_str())
    } else {
        format!("{line}{end}")
    }
}

/// What a name stands for: a part of a config, and keys with the path of the part that they are in.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Found {
    /// Parts of this name.
    pub parts: Vec<Section>,
    /// Keys of this name.
    pub keys: Vec<(String, Key, String)>,
}

/// The parts and keys that a name means: a key, the end of its path, or all of it, with indices or without. Where there is none: the
/// name that comes nearest.
pub fn find(name: &str) -> Result<Found, Option<String>> {
    let sections = sections();
    let steps = steps(name);
    for skipped in 0..steps.len() {
        let wanted = &steps[skipped..];
        if skipped > 0 && !leads_somewhere(&steps) {
            break;
        }
        let mut found = named(&sections, wanted);
        // keys of one name may be of any part, but a part is told of once for all places where it stands
        if skipped > 0 && wanted.len() == 1 {
            found.keys.clear();
        }
        if found != Found::default() {
            return Ok(found);
        }
    }
    let mut known: BTreeSet<String> = BTreeSet::new();
    for section in &sections {
        let last = |n: usize, path: &str| {
            path.rsplit('.').take(n).collect::<Vec<_>>().into_iter().rev().collect::<Vec<_>>().join(".")
        };
        let paths = section.keys.iter().map(|(key, _)| joined(&section.path, &key.name)).chain([section.path.clone()]);
        paths.for_each(|path| known.extend([1, 2, 9].map(|n| last(n, &path))));
    }
    Err(nearest(&steps.join("."), known.iter().map(String::as_str)).map(String::from))
}

fn named(sections: &[Section], wanted: &[String]) -> Found {
    let ends = |path: &str| self::steps(path).ends_with(wanted);
    let parts = sections.iter().filter(|section| ends(&section.path)).cloned().collect();
    let keys = sections.iter().flat_map(|section| {
        let of = |(key, example): &(Key, String)| (section.path.clone(), key.clone(), example.clone());
        section.keys.iter().filter(|(key, _)| ends(&joined(&section.path, &key.name))).map(of)
    });
    Found { parts, keys: keys.collect() }
}

/// The names in a path: `energy[0].anisotropy.K` has energy, anisotropy and K.
fn steps(path: &str) -> Vec<String> {
    let names = path.split(['.', '[', ']']).filter(|step| !step.is_empty() && step.parse::<usize>().is_err());
    names.map(String::from).collect()
}

/// Whether a path from the config's own keys can be followed in the schema.
fn leads_somewhere(steps: &[String]) -> bool {
    let schema = value();
    let mut nodes = vec![&schema];
    for step in steps {
        nodes = nodes.into_iter().flat_map(|node| entered(&schema, node, step)).collect();
    }
    !nodes.is_empty()
}

/// What stands for a key in any form of a value.
fn entered<'s>(schema: &'s Value, node: &'s Value, key: &str) -> Vec<&'s Value> {
    let node = resolved(schema, node);
    let mut found: Vec<&Value> = node["properties"].get(key).into_iter().collect();
    for list in ["allOf", "anyOf", "oneOf"] {
        node[list].as_array().into_iter().flatten().for_each(|form| found.extend(entered(schema, form, key)));
    }
    if node["items"].is_object() {
        found.extend(entered(schema, &node["items"], key));
    }
    if found.is_empty() && node["additionalProperties"].is_object() {
        found.push(&node["additionalProperties"]);
    }
    found
}
