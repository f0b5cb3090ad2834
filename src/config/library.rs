//! The materials that come with the program, each a file of `configs/materials/` compiled into it.
//!
//! Names are compared without case, spaces, hyphens and underscores: `"Nd2Fe14B"`, `"nd2fe14b"` and `"NdFeB"` are one.

use super::Material;
use super::text::{nearest, parse};
use crate::error::Result;

/// The key of every material, which is the name of its file, and the file.
const FILES: &[(&str, &str)] = &[
    ("cobalt", include_str!("../../configs/materials/cobalt.json")),
    ("cobalt_atoms", include_str!("../../configs/materials/cobalt_atoms.json")),
    ("cobalt_chain", include_str!("../../configs/materials/cobalt_chain.json")),
    ("cobalt_platinum", include_str!("../../configs/materials/cobalt_platinum.json")),
    ("cofeb", include_str!("../../configs/materials/cofeb.json")),
    ("fege", include_str!("../../configs/materials/fege.json")),
    ("fept", include_str!("../../configs/materials/fept.json")),
    ("fidimag_chain", include_str!("../../configs/materials/fidimag_chain.json")),
    ("galfenol", include_str!("../../configs/materials/galfenol.json")),
    ("iron", include_str!("../../configs/materials/iron.json")),
    ("iron_cobalt", include_str!("../../configs/materials/iron_cobalt.json")),
    ("nd2fe14b", include_str!("../../configs/materials/nd2fe14b.json")),
    ("nickel", include_str!("../../configs/materials/nickel.json")),
    ("nickel_atoms", include_str!("../../configs/materials/nickel_atoms.json")),
    ("pd_fe_ir111", include_str!("../../configs/materials/pd_fe_ir111.json")),
    ("permalloy", include_str!("../../configs/materials/permalloy.json")),
    ("terfenol_d", include_str!("../../configs/materials/terfenol_d.json")),
    ("yig", include_str!("../../configs/materials/yig.json")),
];

/// A material of the library.
#[derive(Clone, Debug)]
pub struct LibraryMaterial {
    /// What a config names it by.
    pub key: &'static str,
    /// Its file.
    pub text: &'static str,
    /// What the file says.
    pub material: Material,
}

/// All of them, by name.
pub fn library() -> Result<Vec<LibraryMaterial>> {
    let read = |(key, text): &(&'static str, &'static str)| {
        Ok(LibraryMaterial { key, text, material: parse(&file_name(key), text)? })
    };
    FILES.iter().map(read).collect()
}

/// The material with this name, key or other name.
pub fn find(name: &str) -> Result<Option<LibraryMaterial>> {
    let wanted = plain(name);
    let has_it = |m: &LibraryMaterial| {
        let names = [m.key, m.material.name.as_str()].into_iter().chain(m.material.also.iter().map(String::as_str));
        names.into_iter().any(|n| plain(n) == wanted)
    };
    Ok(library()?.into_iter().find(has_it))
}

/// The key nearest to a misspelt name.
pub fn near(name: &str) -> Result<Option<&'static str>> {
    let all = library()?;
    let names = all.iter().flat_map(|m| {
        std::iter::once(m.key).chain(m.material.also.iter().map(String::as_str)).map(move |name| (name, m.key))
    });
    let names: Vec<(&str, &'static str)> = names.collect();
    let found = nearest(name, names.iter().map(|(name, _)| *name));
    Ok(found.and_then(|found| names.iter().find(|(name, _)| *name == found).map(|(_, key)| *key)))
}

/// What messages call the file of a material.
pub fn file_name(key: &str) -> String {
    format!("library material {key}")
}

fn plain(name: &str) -> String {
    name.chars().filter(|c| !matches!(c, ' ' | '_' | '-')).flat_map(char::to_lowercase).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_file_of_the_folder_but_the_toy_is_in_the_library() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/configs/materials");
        let mut files: BTreeSet<String> = std::fs::read_dir(folder)
            .unwrap()
            .map(|e| e.unwrap().file_name().into_string().unwrap().trim_end_matches(".json").to_string())
            .collect();
        assert!(files.remove("toy"));
        assert_eq!(files, FILES.iter().map(|(key, _)| key.to_string()).collect());
        assert!(files.len() >= 15);
    }

    #[test]
    fn every_quantity_has_a_source_and_a_status_and_nothing_else_has() {
        for m in library().unwrap() {
            m.material.validate().unwrap();
            let file: serde_json::Value = serde_json::from_str(m.text).unwrap();
            let mut given = BTreeSet::new();
            for key in ["Ms", "moment"] {
                if file.get(key).is_some() {
                    given.insert(key.to_string());
                }
            }
            for term in file["energy"].as_array().unwrap() {
                let (_, fields) = term.as_object().unwrap().iter().next().unwrap();
                let known = ["A", "J", "K", "K2", "D"];
                given.extend(fields.as_object().unwrap().keys().filter(|k| known.contains(&k.as_str())).cloned());
            }
            assert_eq!(given, m.material.references.keys().cloned().collect(), "{}", m.key);
            for (quantity, reference) in &m.material.references {
                assert!(reference.source.len() > 10, "{} {quantity}", m.key);
                let status = &reference.status;
                assert!(
                    status.starts_with("read") || status.starts_with("quoted in "),
                    "{} {quantity}: {status}",
                    m.key
                );
            }
        }
    }

    #[test]
    fn names_are_found_as_people_say_them_and_no_two_materials_share_one() {
        for (name, key) in [
            ("permalloy", "permalloy"),
            ("Py", "permalloy"),
            ("NdFeB", "nd2fe14b"),
            ("Co/Pt", "cobalt_platinum"),
            ("Iron-Cobalt", "iron_cobalt"),
            ("YIG", "yig"),
        ] {
            assert_eq!(find(name).unwrap().map(|m| m.key), Some(key), "{name}");
        }
        assert!(find("unobtainium").unwrap().is_none());
        assert_eq!(near("permaloy").unwrap(), Some("permalloy"));
        assert_eq!(near("unobtainium").unwrap(), None);
        let mut seen = BTreeSet::new();
        for m in library().unwrap() {
            let names: BTreeSet<String> = [m.key, &m.material.name]
                .into_iter()
                .chain(m.material.also.iter().map(String::as_str))
                .map(plain)
                .collect();
            assert!(names.into_iter().all(|name| seen.insert(name)), "{}", m.key);
        }
    }
}
