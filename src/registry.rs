//! Families of named things: energy terms, states, first guesses, optimisers.
//!
//! A member describes itself where it is defined; the config enum, the lists and the contract tests come from the
//! family's one list of members.

use schemars::{Schema, json_schema};
use serde_json::json;

/// What a member of a family says of itself.
pub trait Described {
    /// Its name in configs.
    const NAME: &'static str;
    /// One line.
    const SUMMARY: &'static str;
    /// A config fragment that parses.
    const EXAMPLE: &'static str;
}

/// A member's description, for lists.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// Its name in configs.
    pub name: &'static str,
    /// One line.
    pub summary: &'static str,
    /// A config fragment that parses.
    pub example: &'static str,
}

/// Defines the config enum of a family (`{"name": {…}}`) from its members, with their role and their descriptions.
macro_rules! family {
    ($(#[$meta:meta])* $family:ident as $role:path { $($variant:ident($spec:ty)),+ $(,)? }) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq, serde::Deserialize)]
        #[serde(rename_all = "snake_case")]
        pub enum $family {
            $(
                #[doc = concat!("See [`", stringify!($spec), "`].")]
                $variant($spec)
            ),+
        }

        impl $family {
            /// All members, in the order of the family's list.
            pub const ENTRIES: &'static [$crate::registry::Entry] = &[$($crate::registry::Entry {
                name: <$spec as $crate::registry::Described>::NAME,
                summary: <$spec as $crate::registry::Described>::SUMMARY,
                example: <$spec as $crate::registry::Described>::EXAMPLE,
            }),+];

            /// The member's name in configs.
            pub fn name(&self) -> &'static str {
                match self { $($family::$variant(_) => <$spec as $crate::registry::Described>::NAME),+ }
            }

            /// The member in its role.
            pub fn member(&self) -> &dyn $role {
                match self { $($family::$variant(m) => m),+ }
            }
        }

        impl schemars::JsonSchema for $family {
            fn schema_name() -> std::borrow::Cow<'static, str> {
                stringify!($family).into()
            }

            fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
                let members = [$(generator.subschema_for::<$spec>()),+];
                $crate::registry::one_of($family::ENTRIES, &members)
            }
        }
    };
}
pub(crate) use family;

/// The schema of a family: an object with one of the members' names and what that member is made of.
pub(crate) fn one_of(entries: &[Entry], members: &[Schema]) -> Schema {
    let choice = |(entry, member): (&Entry, &Schema)| {
        let example: Option<serde_json::Value> = serde_json::from_str(entry.example).ok();
        json!({
            "type": "object",
            "description": entry.summary,
            "properties": { entry.name: member },
            "required": [entry.name],
            "additionalProperties": false,
            "examples": example.into_iter().collect::<Vec<_>>(),
        })
    };
    json_schema!({ "oneOf": entries.iter().zip(members).map(choice).collect::<Vec<_>>() })
}
