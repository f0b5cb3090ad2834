//! From a config file to everything that it says, ready to be built.

use super::inputs::Inputs;
use super::library;
use super::material::{DEFAULT, MaterialChoice};
use super::parts::PartMaterial;
use super::pictures::with_images;
use super::source::{Source, bytes, known_file};
use super::text::{Text, apply_set, decode, nearest};
use super::{Config, Name, memory};
use crate::energy::CustomEnergy;
use crate::error::{Error, Result, both};
use crate::lattice::Lattice;
use crate::words::quoted;
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A config with everything it names.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The config file, with `--set` carried out.
    pub text: Text,
    /// What it says.
    pub config: Config,
    /// Name of the run.
    pub name: String,
    /// Its material, or one for each region, that of all other sites first.
    pub parts: Vec<PartMaterial>,
    /// Where the spins are.
    pub lattice: Lattice,
    /// The config as run: with `--set` carried out, the material and the name written out, keys in order. It runs by itself.
    pub as_run: String,
    /// SHA-256 of [`as_run`](Self::as_run) in hexadecimal.
    pub sha256: String,
    /// The files of spins that it names, as they are kept with the result.
    pub inputs: Vec<crate::files::disk::File>,
    /// What the user should know of these files.
    pub warnings: Vec<String>,
    /// The terms of the program that its `custom_terms` name.
    pub custom: Vec<Arc<dyn CustomEnergy>>,
    /// The config's file as the system knows it; nothing if it came from standard input.
    pub source: Option<PathBuf>,
    /// All files that it was made from, as the system knows them.
    pub made_from: Vec<PathBuf>,
}

/// Reads a config, changed by `sets` (`KEY.PATH=JSON`), and the material it names. The path `-` stands for standard input; a
/// config from there names files from the working directory on.
pub fn load(path: &Path, sets: &[String]) -> Result<Loaded> {
    Source::file(path)?.set(sets)?.load()
}

/// Reads a config whose states alone are wanted; whether it has a `final` one, which it need not.
pub fn load_states(path: &Path, sets: &[String]) -> Result<(Loaded, bool)> {
    Source::file(path)?.set(sets)?.load_states()
}

/// Reads a config whose ends are but states to start from, and need not be there.
pub fn load_landscape(path: &Path, sets: &[String]) -> Result<Loaded> {
    Source::file(path)?.set(sets)?.load_landscape()
}

/// A config's text as if it were read from `path`, and what it names.
pub fn load_text(path: &Path, text: String) -> Result<Loaded> {
    Source::text(path, text).load()
}

impl Source {
    /// The config, with all that it names.
    pub fn load(self) -> Result<Loaded> {
        load_from(&self.path, self.text, self.known)
    }

    /// The same of a config whose states alone are wanted; whether it has a `final` one, which it need not.
    pub fn load_states(self) -> Result<(Loaded, bool)> {
        let (source, [given]) = self.with_states(["final"])?;
        Ok((source.load()?, given))
    }

    /// The same of a config whose ends are but states to start from, and need not be there.
    pub fn load_landscape(self) -> Result<Loaded> {
        self.with_states(["initial", "final"])?.0.load()
    }

    /// Whether only `spinneb landscape` takes it: it asks for one, and has not two ends.
    pub fn is_of_a_landscape_alone(&self) -> Result<bool> {
        let value: Value = self.text.parse()?;
        let has = |key: &str| value.get(key).is_some();
        Ok(has("landscape") && !(has("initial") && has("final")))
    }

    /// With some state where it lacks one of these; whether it has each.
    fn with_states<const N: usize>(mut self, states: [&str; N]) -> Result<(Source, [bool; N])> {
        let value: Value = self.text.parse()?;
        let given = states.map(|key| !value.is_object() || value.get(key).is_some());
        for (key, _) in states.iter().zip(given).filter(|(_, given)| !given) {
            // it stands at the end and moves nothing else
            let any = format!(r#"{key}={{"uniform": {{"direction": [0, 0, 1]}}}}"#);
            self.text.text = apply_set(&self.text.file, &self.text.text, &[any])?;
        }
        Ok((self, given))
    }
}

fn load_from(path: &Path, text: Text, source: Option<PathBuf>) -> Result<Loaded> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let (text, images) = with_images(text, folder)?;
    let mut config: Config = text.parse().map_err(|e| not_a(&text, "config", e))?;
    let name = name(path, &config).map_err(|e| text.locate(e));
    let parts = materials(path, &config, &text);
    let lattice = lattice(&config).map_err(|e| text.locate(e));
    let inputs = Inputs::read(&mut config, folder, lattice.as_ref().ok()).map_err(|e| text.locate(e));
    let ((name, mut parts), mut inputs) = both(both(name, parts), inputs)?;
    for part in &mut parts {
        let pointer = format!("/{}/energy", part.key.replace('.', "/"));
        let read = inputs.pairs(&mut part.material.energy, &pointer, folder);
        read.map_err(|e| part.locate(&text, e))?;
    }
    let lattice = lattice?;
    let as_run = as_run(&text, &parts, &name, &inputs)?;
    let sha256 = Sha256::digest(as_run.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect();
    let own = parts
        .iter()
        .filter_map(|part| part.text.as_ref())
        .map(|text| Path::new(&text.file))
        .chain(inputs.read.iter().chain(&images).map(PathBuf::as_path));
    let made_from = source.iter().cloned().chain(own.filter_map(known_file)).collect();
    let Inputs { files: inputs, warnings, .. } = inputs;
    let custom = Vec::new();
    Ok(Loaded { text, config, name, parts, lattice, as_run, sha256, inputs, warnings, custom, source, made_from })
}

/// The error, unless the text is another kind of file than the wanted one: then what that is and what takes it.
pub(super) fn not_a(text: &Text, wanted: &str, error: Error) -> Error {
    let Ok(Value::Object(keys)) = text.parse::<Value>() else { return error };
    let has = |key: &str| keys.contains_key(key);
    let (kind, way_out) = if has("config_sha256") && has("version") {
        ("a result's summary", "the config that made it is config.json beside it")
    } else if has("config") && (has("grid") || has("zip")) {
        ("a sweep", "`spinneb sweep` runs it")
    } else if has("lattice") && has("material") && !has("grid") && !has("zip") {
        ("a config", "`spinneb run` runs it, and a sweep names it as its \"config\"")
    } else if has("energy") && (has("moment") || has("Ms")) && !has("lattice") {
        ("a material", "a config names it as its \"material\"")
    } else {
        return error;
    };
    let message = format!("this is {kind}, not a {wanted}: {way_out}");
    if kind == format!("a {wanted}") { error } else { text.locate(Error::invalid("", message)) }
}

/// The lattice of a config, if memory can hold what is on it.
fn lattice(config: &Config) -> Result<Lattice> {
    let sites = config.lattice.sites().map_err(|e| e.within("lattice"))?;
    memory::affordable(memory::hamiltonian_bytes(sites, 1, 1), sites, &config.lattice.extent(), None)?;
    config.lattice.resolve().map_err(|e| e.within("lattice"))
}

/// The materials of a config, that of sites in no region first.
fn materials(path: &Path, config: &Config, text: &Text) -> Result<Vec<PartMaterial>> {
    let MaterialChoice::Regions(regions) = &config.material else {
        return Ok(vec![material(path, &config.material, None, "material".into(), text)?]);
    };
    let (default, others): (Vec<_>, Vec<_>) = regions.iter().partition(|(name, _)| *name == DEFAULT);
    let one = |(name, choice): (&String, &MaterialChoice)| {
        let region = Some(name.clone()).filter(|name| name != DEFAULT);
        material(path, choice, region, format!("material.{name}"), text)
    };
    let (mut all, mut wrong) = (Vec::new(), Vec::new());
    default.into_iter().chain(others).map(one).for_each(|part| match part {
        Ok(part) => all.push(part),
        Err(e) => wrong.push(e),
    });
    if wrong.is_empty() { Ok(all) } else { Err(Error::several(wrong)) }
}

/// A material, with its own text where it has one.
fn material(
    path: &Path,
    choice: &MaterialChoice,
    region: Option<String>,
    key: String,
    text: &Text,
) -> Result<PartMaterial> {
    let (material, own) = match choice {
        MaterialChoice::Inline(material) => ((**material).clone(), None),
        MaterialChoice::Named(named) => {
            let from = material_file(path, named).map_err(|e| text.locate(e.within(&key)))?;
            (from.parse().map_err(|e| not_a(&from, "material", e))?, Some(from))
        }
        MaterialChoice::Regions(_) => {
            return Err(text.locate(Error::invalid(key, "a region has no regions of its own")));
        }
    };
    let part = PartMaterial { region, material, text: own, key };
    part.material.validate().map_err(|e| part.locate(text, e))?;
    Ok(part)
}

/// The name given, or the file's without its ending.
fn name(path: &Path, config: &Config) -> Result<String> {
    if let Some(name) = &config.name {
        return Ok(name.to_string());
    }
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    Name::new(&stem).map(|name| name.to_string()).map_err(|e| {
        let near = Name::near(&stem);
        let message = format!(
            "the file's name cannot name the run, which needs one of its own, such as \"name\": \"{near}\": {e}"
        );
        Error::invalid("", message)
    })
}

/// The text of a material: of its file, looked for beside the config, or of the library.
fn material_file(config: &Path, named: &str) -> Result<Text> {
    let path = config.parent().unwrap_or(Path::new("")).join(named);
    let file = path.display().to_string();
    if !path.is_file() {
        if let Some(found) = library::find(named)? {
            return Ok(Text::new(library::file_name(found.key), found.text.into()));
        }
        if !path.exists() && !named.contains(['.', '/', '\\']) {
            return Err(Error::invalid("", unknown(named)?));
        }
    }
    match bytes(&path) {
        Ok(bytes) => decode(&file, bytes).map(|text| Text::new(file, text)),
        Err(e) => {
            let (what, said) = (quoted(named), &e);
            let message = match e.kind() {
                io::ErrorKind::NotFound => format!(
                    "no material {what}: there is no file {file}{}, and no library material of this name",
                    neighbours(&path)
                ),
                _ => format!("the material's file {file} cannot be read: {said}"),
            };
            Err(Error::invalid("", message))
        }
    }
}

/// What to say of a name that is neither a file nor in the library.
fn unknown(named: &str) -> Result<String> {
    let way_out = match library::near(named)? {
        Some(key) => format!("did you mean {}?", quoted(key)),
        None => "`spinneb list materials` names them".into(),
    };
    Ok(format!(
        "no library material {}: {way_out} (a material of your own is a file, \"materials/mine.json\")",
        quoted(named)
    ))
}

/// What the folder of a missing file holds instead.
fn neighbours(path: &Path) -> String {
    let folder = match path.parent() {
        Some(parent) if parent.as_os_str().is_empty() => PathBuf::from("."),
        Some(parent) => parent.into(),
        None => return String::new(),
    };
    let Ok(entries) = folder.read_dir() else { return format!(" (and no folder {})", folder.display()) };
    let mut names: Vec<String> = entries.flatten().map(|e| e.file_name().to_string_lossy().into_owned()).collect();
    names.retain(|name| name.ends_with(".json"));
    names.sort();
    let wanted = path.file_name().unwrap_or_default().to_string_lossy();
    match nearest(&wanted, names.iter().map(String::as_str)) {
        Some(near) => format!(" (did you mean {}?)", quoted(near)),
        None => String::new(),
    }
}

/// The config as run, in one form: keys in order, two spaces deep, the material written out.
fn as_run(text: &Text, parts: &[PartMaterial], name: &str, inputs: &Inputs) -> Result<String> {
    let mut value: Value = text.parse()?;
    for part in parts {
        let Some(own) = &part.text else { continue };
        let mut material: Value = own.parse()?;
        if let Some(keys) = material.as_object_mut() {
            keys.remove("$schema");
        }
        if let Some(place) = value.pointer_mut(&format!("/{}", part.key.replace('.', "/"))) {
            *place = material;
        }
    }
    if let Some(config) = value.as_object_mut() {
        config.insert("name".into(), name.into());
        config.remove("$schema");
    }
    inputs.rename(&mut value);
    let pretty = serde_json::to_string_pretty(&value).map_err(|e| Error::Numerical(e.to_string()))?;
    Ok(pretty + "\n")
}

#[cfg(test)]
mod tests;
