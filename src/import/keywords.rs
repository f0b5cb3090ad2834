//! Keywords of an input file, and what becomes of those that are not read: by their words some set an energy, which are refused, and
//! the others are told of, so that no format needs a list of all that its code can do.

use super::text::{Line, Text};
use crate::error::Result;
use crate::words::quoted;
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::path::Path;

/// By which words a format's keywords set an energy. `demag*` is any word that begins so; a whole keyword may stand for a word.
pub struct Energies {
    /// Words of keywords that set one.
    pub set: &'static [&'static str],
    /// Words of keywords that do not for all that.
    pub none: &'static [&'static str],
    /// Whole keywords that are read, or that the code too passes over for what else is in the file.
    pub read: &'static [&'static str],
}

/// A keyword that was not read.
pub struct Unread<'a> {
    /// With its part, where it has one.
    pub name: String,
    /// What stands behind it.
    pub value: String,
    /// Where it is.
    pub line: Line<'a>,
}

/// Values that switch off.
const OFF: &[&str] = &["n", "no", "f", "false", ".false.", "off", "none"];

impl Unread<'_> {
    fn sets(&self, energies: &Energies) -> bool {
        let is = |word: &str, part: &str| part.strip_suffix('*').map_or(word == part, |start| word.starts_with(start));
        let has = |parts: &[&str]| {
            parts.iter().any(|part| *part == self.name || self.name.split([':', '-', '_']).any(|word| is(word, part)))
        };
        has(energies.set) && !has(energies.none) && !energies.read.contains(&self.name.as_str()) && !self.is_off()
    }

    /// Zero, or a word for it; for scales and densities 1 is what 0 is for the others.
    fn is_off(&self) -> bool {
        let nothing = if ["scale", "density"].iter().any(|word| self.name.contains(word)) { 1.0 } else { 0.0 };
        let value = self.value.to_ascii_lowercase();
        let mut words = value.split(|c: char| c.is_whitespace() || "[](),\"'".contains(c)).filter(|w| !w.is_empty());
        let number = |word: &str| word.replace('d', "e").parse::<f64>().ok();
        let Some(first) = words.next() else { return false };
        // words behind the numbers are comments
        let rest = || words.map_while(number).all(|x| x == nothing);
        OFF.contains(&first) || (number(first) == Some(nothing) && rest())
    }
}

/// Refuses what sets an energy.
pub fn refuse(unread: &[Unread], energies: &Energies) -> Result<()> {
    let Some(Unread { name, value, line }) = unread.iter().find(|keyword| keyword.sets(energies)) else {
        return Ok(());
    };
    let dipoles = name.split([':', '-', '_']).any(|word| word.starts_with("dip") || word == "ddi");
    let what =
        if dipoles { "dipoles are not imported (a config has them along chains)" } else { "this is not imported" };
    let found = if value.is_empty() { String::new() } else { format!("found {}: ", quoted(value)) };
    let way_out = "take the line out to import the rest, and mind that the energy is another one then";
    Err(line.error(0, name, format!("{found}{what}: {way_out}")))
}

/// Tells of keywords that were not read in a line, of each once.
pub fn not_read(text: &Text, unread: &[Unread]) -> Option<String> {
    let mut names: BTreeSet<&str> = BTreeSet::new();
    let first = unread.iter().filter(|keyword| names.insert(&keyword.name));
    let list: Vec<String> = first.map(|keyword| format!("{} (line {})", keyword.name, keyword.line.number)).collect();
    let file = Path::new(&text.file).file_name().unwrap_or_default().to_string_lossy();
    (!list.is_empty()).then(|| format!("not read in {file}: {}", list.join(", ")))
}

/// An input file of lines that begin with a keyword; it remembers which ones were asked for.
pub struct Keywords<'a> {
    /// The file.
    pub text: &'a Text,
    /// Its lines.
    pub lines: Vec<Line<'a>>,
    /// Of lines with the same keyword the last one counts, or the first.
    last: bool,
    asked: RefCell<BTreeSet<String>>,
}

impl<'a> Keywords<'a> {
    /// With no keyword read.
    pub fn new(text: &'a Text, lines: Vec<Line<'a>>, last: bool) -> Keywords<'a> {
        Keywords { text, lines, last, asked: RefCell::default() }
    }

    /// Where among the lines a keyword is.
    pub fn find(&self, keyword: &str) -> Option<usize> {
        self.asked.borrow_mut().insert(keyword.to_ascii_lowercase());
        let is = |line: &Line| line.first().eq_ignore_ascii_case(keyword);
        if self.last { self.lines.iter().rposition(is) } else { self.lines.iter().position(is) }
    }

    /// The line of a keyword.
    pub fn line(&self, keyword: &str) -> Option<&Line<'a>> {
        self.find(keyword).map(|k| &self.lines[k])
    }

    /// The line of a keyword that has to be there.
    pub fn needed(&self, keyword: &str) -> Result<&Line<'a>> {
        self.line(keyword).ok_or_else(|| self.text.ends(format!("there is no \"{keyword}\" in it")))
    }

    /// The keywords that nobody has asked for. Numbers and the names of columns, which are letters, are no keywords.
    pub fn unread(&self) -> Vec<Unread<'a>> {
        let asked = self.asked.borrow();
        let keyword = |line: &Line<'a>| Unread {
            name: line.first().to_ascii_lowercase(),
            value: line.words().skip(1).collect::<Vec<_>>().join(" "),
            line: line.clone(),
        };
        let is = |name: &str| name.len() > 1 && name.starts_with(|c: char| c.is_ascii_alphabetic());
        self.lines.iter().map(keyword).filter(|k| is(&k.name) && !asked.contains(&k.name)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ENERGIES: Energies = Energies {
        set: &["demag*", "anisotropy", "do_dip", "scale", "exchange"],
        none: &["print"],
        read: &["old_exchange"],
    };

    fn said(input: &str) -> std::result::Result<Option<String>, String> {
        let text = Text { file: "folder/a.dat".into(), text: format!("read 1\n{input}\n") };
        let keywords = Keywords::new(&text, text.lines(&['#'], &[]), true);
        assert!(keywords.line("READ").is_some());
        refuse(&keywords.unread(), &ENERGIES).map_err(|e| e.to_string())?;
        Ok(not_read(&text, &keywords.unread()))
    }

    #[test]
    fn what_sets_an_energy_by_its_words_is_refused_unless_it_is_off() {
        for on in ["demag_x Y", "demagfield 0 0 1", "surface-anisotropy 1e-3", "do_dip 2", "jij_scale 0.5", "exchange"]
        {
            let found = said(on).unwrap_err();
            let name = on.split(' ').next().unwrap();
            assert!(
                found.starts_with(&format!("folder/a.dat:2:1: {name}: ")) && found.contains("take the line out"),
                "{found}"
            );
        }
        for off in
            ["demag_x N", "demagfield [0,0.0d0,0] nothing 1", "exchange .FALSE.", "jij_scale 1.0", "anisotropy none"]
        {
            assert!(said(off).unwrap().is_some(), "{off}");
        }
        for other in ["do_dipole 1", "exchanges 1", "print_anisotropy 1", "old_exchange 1"] {
            let name = other.split(' ').next().unwrap();
            assert_eq!(said(other).unwrap(), Some(format!("not read in a.dat: {name} (line 2)")));
        }
    }

    #[test]
    fn keywords_that_are_not_read_are_told_once() {
        assert_eq!(said("# nothing\n0 0 1\n-1\ni Kx\nread 2").unwrap(), None);
        let found = said("Nstep 10\nTemp 3 # K\nnstep 20").unwrap();
        assert_eq!(found, Some("not read in a.dat: nstep (line 2), temp (line 3)".into()));
    }
}
