//! What is wrong with a point's config is said where the sweep's file has the key or the value that is to blame.

use super::super::json::{Holds, Node, Step, at, steps, tree};
use super::super::text::nearest;
use super::Sweep;
use crate::error::Error;
use crate::words::quoted;

/// The error of a `--set` at the place that stands for it here.
pub(super) fn carried(error: Error, here: impl Fn(String) -> Error) -> Error {
    match error {
        Error::Invalid { message, .. } => here(message),
        other => other,
    }
}

impl Sweep {
    /// An error at a swept key.
    pub(super) fn wrong_key(&self, k: usize, message: String) -> Error {
        self.place(k, None, message)
    }

    /// An error at a swept key, or at one of its values.
    fn place(&self, k: usize, value: Option<usize>, message: String) -> Error {
        let key = &self.keys[k];
        let mut place = vec![Step::Key(self.list.into()), Step::Key(key.key.clone())];
        let start = |root: &Node, place: &[Step]| root.descend(place).0.start;
        let Ok(root) = tree(&self.file, &self.text) else { return Error::invalid(&key.key, message) };
        match value {
            Some(value) => {
                if !key.range {
                    place.push(Step::Index(value));
                }
                at(&self.file, &self.text, start(&root, &place), &place, message)
            }
            None => {
                let (list, _) = root.descend(&place[..1]);
                let own = list.child(&place[1]).map_or(list.start, |(_, at)| at);
                at(&self.file, &self.text, own, &place, message)
            }
        }
    }

    /// An error of a point's config where the sweep's file has what is to blame for it; otherwise as it is, with the point.
    pub(super) fn blame(&self, point: usize, error: Error) -> Error {
        let own = self.config.display().to_string();
        match error {
            Error::Config { file, place, message, .. } if file == own => match self.blamed(&place) {
                Some(k) => self.blame_key(point, k, &place, message),
                None => self.blame_point(point, &file, &place, &message),
            },
            Error::Several(errors) => Error::several(errors.into_iter().map(|e| self.blame(point, e)).collect()),
            other => other,
        }
    }

    /// The swept key that has set what stands at this place of the config.
    fn blamed(&self, place: &str) -> Option<usize> {
        let at = steps(place).filter(|at| !at.is_empty())?;
        let starts = |own: &[Step]| at.starts_with(own) || own.starts_with(&at);
        let mut candidates: Vec<usize> = (0..self.keys.len()).filter(|k| starts(&self.keys[*k].steps)).collect();
        candidates.sort_by_key(|k| !at.starts_with(&self.keys[*k].steps));
        match candidates[..] {
            [one] => Some(one),
            [first, ..] if at.starts_with(&self.keys[first].steps) => Some(first),
            _ => None,
        }
    }

    fn blame_key(&self, point: usize, k: usize, place: &str, message: String) -> Error {
        let key = &self.keys[k];
        let config = self.config.display();
        if let Some(hint) = self.missing(k) {
            return self.wrong_key(k, format!("{hint}; with it, {config}: {place}: {message}"));
        }
        let index = self.points[point][k];
        let value = if key.range { format!("with {}, ", key.values[index]) } else { String::new() };
        self.place(k, Some(index), format!("{value}{config}: {place}: {message}"))
    }

    /// What the config has instead of a key that it has not.
    fn missing(&self, k: usize) -> Option<String> {
        let config = self.config.display().to_string();
        let root = tree(&config, &self.base).ok()?;
        let steps = &self.keys[k].steps;
        let (node, depth) = root.descend(steps);
        let Some(Step::Key(wanted)) = steps.get(depth) else { return None };
        let Holds::Members(members) = &node.holds else { return None };
        let near = nearest(wanted, members.iter().map(|m| m.key.as_str()));
        let hint = near.map(|near| format!(": did you mean {}?", quoted(near))).unwrap_or_default();
        Some(format!("{config} has no {} there{hint}", quoted(wanted)))
    }

    /// An error that is of no key alone.
    fn blame_point(&self, point: usize, file: &str, place: &str, message: &str) -> Error {
        let values: Vec<String> =
            self.keys.iter().zip(self.values(point)).map(|(key, value)| format!("{} = {value}", key.key)).collect();
        let list = [Step::Key(self.list.into())];
        let start = tree(&self.file, &self.text).map_or(0, |root| root.descend(&list).0.start);
        let message = format!("point {point} ({}): {file}: {place}: {message}", values.join(", "));
        at(&self.file, &self.text, start, &list, message)
    }
}
