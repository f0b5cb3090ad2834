//! All that a type refuses in a document, not only the first.
//!
//! A type stops at the first value that it cannot use. That one is then mended in a copy, and the copy is read again: a misspelt key
//! gets the name that it is nearest to, one that means nothing is taken out, a missing key is put in, and a wrong value gives way to
//! one that fits. Values that fit are looked for among those of [`examples`], first under the same key; the one found serves the
//! message too. A mended place is right, so nothing is refused because of what was refused before.

use super::json::Step;
use super::strict::Strict;
use crate::energy::TermSpec;
use crate::optimise::OptimiserSpec;
use crate::path::guess::GuessSpec;
use crate::registry::Entry;
use crate::state::StateSpec;
use crate::units;
use crate::words::nearest;
use serde::de::DeserializeOwned;
use serde_json::Value;
use serde_path_to_error::Segment;
use std::sync::OnceLock;

/// So many are told.
const MOST: usize = 50;
/// Bytes of copies that are read again at most: long lists of spins are not read hundreds of times.
const WORK: usize = 1 << 26;

/// Every key of a config that is in no registry's example, with a value that fits.
const KEYS: &str = r#"{
  "material": "permalloy",
  "also": ["Py"], "source": "doi:10.1103/PhysRevB.50.16501", "status": "read", "references": {"A": {"source": "doi:10.1103/PhysRevB.50.16501", "status": "read"}},
  "moment": "2 mu_B", "Ms": "800 kA/m",
  "lattice": {"chain": {"sites": 50}},
  "spacing": "0.25 nm", "periodic": true, "cross_section": ["20 nm", "5 nm"], "width": "12 nm", "thickness": "2 nm", "direction": [0, 0, 1],
  "sections": [{"sites": [3, 4], "width": "12 nm"}], "frozen": [{"sites": [0]}], "moments": [{"sites": [7], "moment": "3 mu_B"}], "vacant": [7], "regions": {"top": {"from": 3, "to": 9}},
  "from": 3, "to": 9, "step": 2,
  "energy": [{"exchange": {"J": ["10 meV"]}}],
  "initial": {"uniform": {"direction": [0, 0, 1]}}, "final": {"uniform": {"direction": [0, 0, -1]}},
  "path": {"images": 20}, "noise": {"amplitude": "2 deg", "seed": 1}, "smooth": 0.3,
  "neb": {"max_evaluations": 20000}, "climb": true, "tolerance": 1e-6, "optimiser": {"implicit": {}},
  "search": {"effort": "normal"},
  "saddle": {"refine": true, "certify": true},
  "rates": {"temperatures": ["4 K", "300 K"]}, "damping": 0.1, "g_factor": 2.0, "theory": ["htst"],
  "output": {"formats": ["csv", "npz"]}, "plots": ["svg", "png"], "style": "paper", "width_mm": 85,
  "config": "wall.json", "set": {"path.images": 21}, "grid": {"lattice.chain.sites": [20, 40]}, "zip": {"lattice.chain.sites": [20, 40]}
}"#;

/// What a type refuses.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Refusal {
    /// Where, in the document as it is.
    pub(super) steps: Vec<Step>,
    /// In the words of serde or of the type.
    pub(super) said: String,
    /// A value that would do there: in place of what is refused, or of the missing key.
    pub(super) example: Option<Value>,
}

impl Refusal {
    /// It is a key that is refused, and not its value.
    pub(super) fn of_key(&self) -> bool {
        let unknown = unknown(&self.said, "field").or_else(|| unknown(&self.said, "variant"));
        unknown.is_some_and(|(found, _)| self.steps.last() == Some(&Step::Key(found.into())))
    }
}

/// The value of a document, or all that its type refuses in it.
pub(super) fn read<T: DeserializeOwned>(value: &Value, bytes: usize) -> Result<T, Vec<Refusal>> {
    match try_read(value) {
        Ok(value) => Ok(value),
        Err(first) => {
            let left = WORK / bytes.max(1);
            let mut copy = Copy { value: value.clone(), renamed: Vec::new(), left };
            Err(copy.refusals::<T>(first))
        }
    }
}

/// A document that is being mended.
struct Copy {
    value: Value,
    /// Keys that got another name: where they are now, and how they were called.
    renamed: Vec<(Vec<Step>, String)>,
    /// How often it may be read again.
    left: usize,
}

/// What was refused, here.
#[derive(Clone)]
struct Said {
    steps: Vec<Step>,
    said: String,
}

impl Copy {
    fn refusals<T: DeserializeOwned>(&mut self, first: Said) -> Vec<Refusal> {
        let mut found = Vec::new();
        let mut next = Some(first);
        while let Some(Said { steps, said }) = next {
            let place = self.original(&steps);
            // what is wrong with a key's value is not known before the key is
            let told = self.renamed.iter().any(|(own, _)| *own == steps);
            let mended = self.mend::<T>(&steps, &said);
            let example = mended.as_ref().and_then(|m| m.example.clone());
            if !told {
                found.push(Refusal { steps: place, said, example });
            }
            next = match mended {
                Some(mended) if found.len() < MOST => mended.next,
                _ => None,
            };
        }
        found
    }

    /// A place as the document as it is has it.
    fn original(&self, steps: &[Step]) -> Vec<Step> {
        let step = |k: usize| {
            let renamed = self.renamed.iter().find(|(own, _)| own[..] == steps[..=k]);
            renamed.map_or(steps[k].clone(), |(_, key)| Step::Key(key.clone()))
        };
        (0..steps.len()).map(step).collect()
    }

    /// Makes right what was refused; nothing if that cannot be done.
    fn mend<T: DeserializeOwned>(&mut self, steps: &[Step], said: &str) -> Option<Mended> {
        let Some((last, parent)) = steps.split_last() else {
            return missing(said).and_then(|key| self.put_in::<T>(steps, key)).or_else(|| self.replace::<T>(steps));
        };
        if let Some(key) = missing(said) {
            return self.put_in::<T>(steps, key).or_else(|| self.replace::<T>(steps));
        }
        let field = unknown(said, "field");
        if let (Some((found, known)), Step::Key(key)) = (field.clone().or_else(|| unknown(said, "variant")), last)
            && found == key
            && let Some(Value::Object(members)) = at(&mut self.value, parent)
        {
            let near = nearest(found, known.iter().copied()).filter(|near| !members.contains_key(*near));
            if let Some(value) = members.remove(found) {
                let Some(near) = near else {
                    if field.is_some() {
                        return self.accepted::<T>(steps, None);
                    }
                    members.insert(found.into(), value);
                    return self.replace::<T>(parent);
                };
                members.insert(near.into(), value);
                let place = [parent, &[Step::Key(near.into())]].concat();
                self.renamed.push((place, found.into()));
                return Some(Mended { example: None, next: try_read::<T>(&self.value).err() });
            }
        }
        self.replace::<T>(steps)
    }

    /// Puts a missing key into an object.
    fn put_in<T: DeserializeOwned>(&mut self, object: &[Step], key: &str) -> Option<Mended> {
        let place = [object, &[Step::Key(key.into())]].concat();
        self.try_examples::<T>(&place)
    }

    /// Puts a value that fits in place of one that does not, or of what it is in.
    fn replace<T: DeserializeOwned>(&mut self, steps: &[Step]) -> Option<Mended> {
        for depth in (0..=steps.len()).rev() {
            if let Some(mut mended) = self.try_examples::<T>(&steps[..depth]) {
                mended.example = mended.example.filter(|_| depth == steps.len());
                return Some(mended);
            }
        }
        None
    }

    fn try_examples<T: DeserializeOwned>(&mut self, place: &[Step]) -> Option<Mended> {
        let name = key_of(place);
        let same = examples().iter().filter(|(key, _)| *key == name);
        let others = examples().iter().filter(|(key, _)| *key != name);
        let before = at(&mut self.value, place).map(|v| v.clone());
        for (_, example) in same.chain(others) {
            put(&mut self.value, place, example.clone())?;
            if let Some(mended) = self.accepted::<T>(place, Some(example)) {
                return Some(mended);
            }
            if self.left == 0 {
                break;
            }
        }
        match before {
            Some(before) => put(&mut self.value, place, before),
            None => take_out(&mut self.value, place),
        };
        None
    }

    /// Reads the copy again: what is refused next, if that has nothing to do with the mended place.
    fn accepted<T: DeserializeOwned>(&mut self, place: &[Step], example: Option<&Value>) -> Option<Mended> {
        self.left = self.left.checked_sub(1)?;
        let next = try_read::<T>(&self.value).err();
        let apart = next.as_ref().is_none_or(|Said { steps, said }| {
            let another_key = missing(said).is_some() || unknown(said, "field").is_some();
            !steps.starts_with(place) && (another_key || !place.starts_with(steps))
        });
        apart.then(|| Mended { example: example.cloned(), next })
    }
}

/// What is refused after a mend, and the value that was put in.
struct Mended {
    example: Option<Value>,
    next: Option<Said>,
}

fn try_read<T: DeserializeOwned>(value: &Value) -> Result<T, Said> {
    serde_path_to_error::deserialize(Strict(value)).map_err(|e| {
        let said = e.inner().to_string();
        let mut steps: Vec<Step> = e.path().iter().filter_map(step).collect();
        let (deepest, depth) = descend(value, &steps);
        // A kind given as a string is a step for serde, but not for the reader.
        if depth + 1 == steps.len() && !deepest.is_object() && !deepest.is_array() {
            steps.pop();
        }
        // What is unknown is the key, so that is where to look, and not at its value.
        if let Some((found, _)) = unknown(&said, "field").or_else(|| unknown(&said, "variant")) {
            let key = Step::Key(found.into());
            if deepest.get(found).is_some() && steps.last() != Some(&key) {
                steps.push(key);
            }
        }
        Said { steps, said }
    })
}

fn step(segment: &Segment) -> Option<Step> {
    match segment {
        Segment::Seq { index } => Some(Step::Index(*index)),
        Segment::Map { key } | Segment::Enum { variant: key } => Some(Step::Key(key.clone())),
        Segment::Unknown => None,
    }
}

/// The unknown word and the known ones of "unknown field `x`, expected one of `a`, `b`".
pub(super) fn unknown<'a>(said: &'a str, what: &str) -> Option<(&'a str, Vec<&'a str>)> {
    let rest = said.strip_prefix(&format!("unknown {what} `"))?;
    let (found, known) = rest.rsplit_once("`, expected ").or_else(|| rest.rsplit_once("`, there are no "))?;
    Some((found, known.split('`').skip(1).step_by(2).collect()))
}

/// The key of "missing field `x`".
pub(super) fn missing(said: &str) -> Option<&str> {
    said.strip_prefix("missing field `")?.strip_suffix('`')
}

fn descend<'a>(value: &'a Value, steps: &[Step]) -> (&'a Value, usize) {
    let mut deepest = value;
    for (depth, step) in steps.iter().enumerate() {
        let child = match step {
            Step::Key(key) => deepest.get(key),
            Step::Index(i) => deepest.get(i),
        };
        match child {
            Some(child) => deepest = child,
            None => return (deepest, depth),
        }
    }
    (deepest, steps.len())
}

fn at<'a>(value: &'a mut Value, steps: &[Step]) -> Option<&'a mut Value> {
    steps.iter().try_fold(value, |value, step| match step {
        Step::Key(key) => value.get_mut(key),
        Step::Index(i) => value.get_mut(i),
    })
}

fn put(value: &mut Value, place: &[Step], new: Value) -> Option<()> {
    match place.split_last() {
        Some((Step::Key(key), parent)) => {
            at(value, parent)?.as_object_mut()?.insert(key.clone(), new);
        }
        _ => *at(value, place)? = new,
    }
    Some(())
}

fn take_out(value: &mut Value, place: &[Step]) -> Option<()> {
    let (Step::Key(key), parent) = place.split_last()? else { return None };
    at(value, parent)?.as_object_mut()?.remove(key);
    Some(())
}

/// The key that a place is under; `[]` behind it for an element of its array.
fn key_of(place: &[Step]) -> String {
    let key = place.iter().rev().find_map(|step| match step {
        Step::Key(key) => Some(key.as_str()),
        Step::Index(_) => None,
    });
    let elements = place.iter().rev().take_while(|step| matches!(step, Step::Index(_))).count();
    key.unwrap_or_default().to_string() + &"[]".repeat(elements)
}

/// Values that a config may have, each with the key that it is under: all that stands in the registries' examples, in [`KEYS`] and
/// as examples of units. Plain ones come first.
fn examples() -> &'static [(String, Value)] {
    static EXAMPLES: OnceLock<Vec<(String, Value)>> = OnceLock::new();
    EXAMPLES.get_or_init(|| {
        let families: [&[Entry]; 4] =
            [TermSpec::ENTRIES, StateSpec::ENTRIES, GuessSpec::ENTRIES, OptimiserSpec::ENTRIES];
        let texts = families.into_iter().flatten().map(|entry| entry.example);
        let mut all = Vec::new();
        for text in [KEYS].into_iter().chain(texts) {
            if let Ok(value) = serde_json::from_str::<Value>(text) {
                collect("", &value, &mut all);
            }
        }
        for example in units::examples() {
            all.push((String::new(), example.into()));
            all.push((String::new(), vec![example].into()));
            all.push((String::new(), vec![example; 3].into()));
        }
        all.sort_by_cached_key(|(_, value)| (value.is_null(), value.to_string().len()));
        all.dedup();
        all
    })
}

fn collect(key: &str, value: &Value, all: &mut Vec<(String, Value)>) {
    all.push((key.into(), value.clone()));
    match value {
        Value::Object(members) => members.iter().for_each(|(key, value)| collect(key, value, all)),
        Value::Array(values) => values.iter().for_each(|value| collect(&format!("{key}[]"), value, all)),
        _ => {}
    }
}

/// A value on one line.
pub(super) fn inline(value: &Value) -> String {
    match value {
        Value::Array(values) => format!("[{}]", values.iter().map(inline).collect::<Vec<_>>().join(", ")),
        Value::Object(members) => {
            let member = |(key, value): (&String, &Value)| format!("{}: {}", Value::from(key.as_str()), inline(value));
            format!("{{{}}}", members.iter().map(member).collect::<Vec<_>>().join(", "))
        }
        single => single.to_string(),
    }
}

#[cfg(test)]
mod tests;
