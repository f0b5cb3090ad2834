//! What a run writes.

use super::schema::names_schema;
use crate::output::canvas::{Look, Style};
use crate::output::{Group, KINDS, Kind};
use crate::units::Length;
use crate::words::{nearest, quoted};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::Error;
use serde::{Deserialize, Deserializer};

/// `"output": {"formats": ["csv"], "plots": ["svg", "png"], "style": "dark", "width": "85 mm"}`; the usual kinds if absent.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct OutputConfig {
    /// Kinds of data files.
    #[serde(deserialize_with = "formats")]
    #[schemars(schema_with = "format_names")]
    pub formats: Vec<String>,
    /// Kinds of figures.
    #[serde(deserialize_with = "plots")]
    #[schemars(schema_with = "plot_names")]
    pub plots: Vec<String>,
    /// How figures look.
    pub style: Style,
    /// How wide figures are; what suits the style if absent: 85 mm, or 144.5 mm for slides.
    pub width: Option<Length>,
}

impl OutputConfig {
    /// Style and width of figures; an error where they do not fit each other.
    pub fn look(&self) -> crate::error::Result<Look> {
        Look::new(self.style, self.width.map(|w| w.0 / NM_PER_MM))
    }
}

impl OutputConfig {
    /// Whether files of a kind are to be written.
    pub fn wants(&self, kind: &Kind) -> bool {
        let named = |list: &[String]| list.iter().any(|name| name == kind.name);
        match kind.group {
            Group::Always => true,
            Group::Formats | Group::OnRequest => named(&self.formats),
            Group::Plots => named(&self.plots),
        }
    }
}

/// Lengths inside are in nm.
const NM_PER_MM: f64 = 1e6;

impl Default for OutputConfig {
    fn default() -> Self {
        let all = |group| names(group).map(String::from).collect();
        OutputConfig { formats: all(Group::Formats), plots: all(Group::Plots), style: Style::default(), width: None }
    }
}

fn format_names(_: &mut SchemaGenerator) -> Schema {
    names_schema(names(Group::Formats).chain(names(Group::OnRequest)))
}

fn plot_names(_: &mut SchemaGenerator) -> Schema {
    names_schema(names(Group::Plots))
}

fn names(group: Group) -> impl Iterator<Item = &'static str> {
    KINDS.iter().filter(move |kind| kind.group == group).map(|kind| kind.name)
}

fn formats<'de, D: Deserializer<'de>>(d: D) -> Result<Vec<String>, D::Error> {
    checked(d, &names(Group::Formats).chain(names(Group::OnRequest)).collect::<Vec<_>>())
}

fn plots<'de, D: Deserializer<'de>>(d: D) -> Result<Vec<String>, D::Error> {
    checked(d, &names(Group::Plots).collect::<Vec<_>>())
}

/// A list of known names, each once.
fn checked<'de, D: Deserializer<'de>>(d: D, known: &[&str]) -> Result<Vec<String>, D::Error> {
    let list = Vec::<String>::deserialize(d)?;
    for (k, name) in list.iter().enumerate() {
        if !known.contains(&name.as_str()) {
            let hint = nearest(name, known.iter().copied()).map(|n| format!(": did you mean \"{n}\"?"));
            let (shown, hint) = (quoted(name), hint.unwrap_or_default());
            return Err(D::Error::custom(format!("unknown name {shown}{hint} (known names: {})", known.join(", "))));
        }
        if list[..k].contains(name) {
            return Err(D::Error::custom(format!("{} is listed twice", quoted(name))));
        }
    }
    Ok(list)
}
