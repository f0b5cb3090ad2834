//! The JSON of a run: read strictly, with the file, line, column and path of what is wrong.
//!
//! [`load`] reads a config file and everything it names; [`Loaded::problem`] builds what the drive is given. Whatever can be
//! wrong in a config is found before anything large is allocated or computed.

mod built;
pub mod estimate;
mod inputs;
mod json;
mod keeping;
mod landscape;
pub mod library;
mod load;
mod material;
mod material_scales;
mod name;
mod neb;
pub mod neighbours;
mod output;
mod parts;
mod path;
pub mod physics;
mod pictures;
pub mod rates;
pub mod reference;
mod refusals;
mod results;
mod schema;
mod search;
mod set;
mod source;
mod strict;
pub mod sweep;
pub mod text;

pub use crate::drive::memory;
pub use built::{States, expected_images, needed_bytes};
pub use keeping::{Keeping, Say};
pub use landscape::{GroupConfig, LandscapeConfig};
pub use load::{Loaded, load, load_landscape, load_states, load_text};
pub use material::{Material, MaterialChoice, Reference};
pub use material_scales::MaterialScales;
pub use name::Name;
pub use neb::{NebConfig, SaddleConfig};
pub use output::OutputConfig;
pub use parts::PartMaterial;
pub use path::{ImageCount, PathConfig};
pub use rates::{RatesConfig, Temperatures};
pub use results::{VERSION, discard_leftovers};
pub use schema::{Key, SCHEMA_FILE, keys, landscape_schema, schema};
pub use search::SearchConfig;
pub use source::Source;
pub use sweep::sweep_schema;
pub use text::Text;

use crate::energy::TermSpec;
use crate::lattice::LatticeSpec;
use crate::state::StateSpec;
use schemars::JsonSchema;
use serde::Deserialize;

/// A config as written. Only `material`, `lattice`, `initial` and `final` are required.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Config {
    /// Where editors find the schema; not used here.
    #[serde(default, rename = "$schema")]
    pub schema: Option<String>,
    /// What you want to say about it: a text, or one of several lines.
    #[serde(default)]
    pub comment: Option<Comment>,
    /// Name of the run and of its folder; the file's name without its ending if absent.
    #[serde(default)]
    pub name: Option<Name>,
    /// What the sites are made of.
    pub material: MaterialChoice,
    /// Where the spins are.
    pub lattice: LatticeSpec,
    /// Terms added to the material's.
    #[serde(default)]
    pub energy: Vec<TermSpec>,
    /// Terms of the program that runs the config, by name; the command line has none.
    #[serde(default)]
    pub custom_terms: Vec<Name>,
    /// Where the path starts.
    pub initial: StateSpec,
    /// Where it ends.
    #[serde(rename = "final")]
    pub final_state: StateSpec,
    /// Relax both ends to minima first.
    #[serde(default = "yes")]
    pub relax_ends: bool,
    /// The first path.
    #[serde(default)]
    pub path: PathConfig,
    /// How long passes below the best of the first paths are looked for.
    #[serde(default)]
    pub search: Option<SearchConfig>,
    /// How the band is relaxed.
    #[serde(default)]
    pub neb: NebConfig,
    /// What is done with the saddles.
    #[serde(default)]
    pub saddle: SaddleConfig,
    /// Rates and lifetimes; none if absent.
    #[serde(default)]
    pub rates: Option<RatesConfig>,
    /// What `spinneb landscape` looks for; a run ignores it.
    #[serde(default)]
    pub landscape: Option<LandscapeConfig>,
    /// What is written.
    #[serde(default)]
    pub output: OutputConfig,
}

/// A text, or one of several lines. It is kept with the config and means nothing.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a text, or a list of its lines")]
pub enum Comment {
    /// A text.
    Text(String),
    /// Its lines.
    Lines(Vec<String>),
}

fn yes() -> bool {
    true
}
