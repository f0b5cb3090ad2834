//! TB2J: `exchange.out`.
//!
//! ```text
//! E = − Σ_i K_i (S_i·e)² − Σ_{i≠j} [J_ij S_i·S_j + S_i J^ani_ij S_j + D_ij·(S_i × S_j)]          each pair twice, unit vectors, meV
//! ```
//! Only the atoms that exchange are taken. The numbers are rounded in the file, J and D to 10⁻⁴ meV and J^ani to 10⁻³ meV.
//!
//! Sources: <https://tb2j.readthedocs.io/en/latest/src/convention.html> and `output.html` beside it; the writer,
//! `TB2J/io_exchange/io_txt.py` of <https://github.com/mailhexu/TB2J>; He et al., <https://doi.org/10.1016/j.cpc.2021.107938>.

use super::atoms::coordinates;
use super::bonds::{Listed, matrix, merge};
use super::text::{Line, Text};
use super::told::{Told, in_words};
use super::{Anisotropy, Atom, Format, Model, found, only};
use crate::energy::{Convention, Counting, DmiForm, EnergyForm};
use crate::error::{Error, Result};
use crate::geometry::matrix::Matrix;
use crate::geometry::{Direction, Vector, matrix::determinant, vector};
use crate::lattice::Hop;
use std::path::PathBuf;

pub const FORMAT: Format = Format { name: "tb2j", summary: "exchange.out, or its folder (TB2J_results)", read };

/// What rounding leaves open between the two directions of a pair (meV).
const ROUNDING: f64 = 4e-3;

fn read(paths: &[PathBuf], told: Told) -> Result<Model> {
    let path = found(only(paths, "exchange.out, or the folder with it")?, &["exchange.out"]);
    let text = Text::read(&path)?;
    if text.text.trim_start().starts_with('<') {
        return Err(text.error(1, "this is an XML file: give exchange.out, which TB2J writes beside it"));
    }
    let own = Convention { counting: Counting::BothDirections, energy: EnergyForm::Minus, dmi: DmiForm::Minus };
    told.no_cubic()?;
    let convention = told.over(own);
    let file = Sections { text: &text, lines: text.lines(&[], &['(', ')', '[', ']', ',']) };
    let (vectors, mut atoms) = (file.vectors()?, file.atoms()?);
    if determinant(&vectors).abs() < 1e-12 {
        return Err(text.error(file.section("Cell", None)?.0, "the vectors of the cell lie in a plane"));
    }
    for atom in &mut atoms {
        atom.at = coordinates(&vectors, atom.at);
    }
    file.anisotropies(&mut atoms)?;
    let listed = file.exchange(&atoms, convention)?;
    let used: Vec<usize> = (0..atoms.len()).filter(|k| listed.iter().any(|pair| pair.hop.atoms.contains(k))).collect();
    let place = |atom: usize| used.iter().position(|k| *k == atom).unwrap_or(0);
    let listed: Vec<Listed> = listed
        .into_iter()
        .map(|pair| Listed { hop: Hop { atoms: pair.hop.atoms.map(place), ..pair.hop }, ..pair })
        .collect();
    let bonds = merge(&text, &listed, convention.counting, ROUNDING)?;
    let [formula, factors] = in_words(convention, true);
    let model = Model {
        code: "TB2J",
        files: vec![text.file.clone()],
        vectors,
        spacing_nm: None,
        atoms: used.iter().map(|k| atoms[*k].clone()).collect(),
        bonds,
        field_t: [0.0; 3],
        cells: None,
        periodic: None,
        convention: vec![formula, format!("{factors}, J^ani as J; meV; unit vectors; K (S·e)² is written with K")],
        notes: Vec::new(),
    };
    model.scaled_to_first(1.0).checked(&path)
}

struct Sections<'a> {
    text: &'a Text,
    lines: Vec<Line<'a>>,
}

impl<'a> Sections<'a> {
    /// The number of the line and the lines behind it that begins with a word (and a second one).
    fn section(&self, word: &str, second: Option<&str>) -> Result<(usize, &[Line<'a>])> {
        let is =
            |line: &Line| line.first().trim_end_matches(':') == word && second.is_none_or(|s| line.get(1) == Some(s));
        let missing = || self.text.ends(format!("there is no section \"{word}:\" in it, as in exchange.out of TB2J"));
        let at = self.lines.iter().position(is).ok_or_else(missing)?;
        Ok((self.lines[at].number, &self.lines[at + 1..]))
    }

    fn vectors(&self) -> Result<Matrix> {
        let (_, lines) = self.section("Cell", None)?;
        let row = |k: usize| lines.get(k).ok_or_else(|| self.text.ends("a cell has three vectors"))?.vector(0, "Cell");
        Ok([row(0)?, row(1)?, row(2)?])
    }

    /// Names, Cartesian places (Å), charges, moments along z or x, y and z (μ_B).
    fn atoms(&self) -> Result<Vec<Atom>> {
        let (_, lines) = self.section("Atoms", None)?;
        let mut atoms: Vec<Atom> = Vec::new();
        // a note and the names of the columns come first
        let rows = lines.iter().skip_while(|line| matches!(line.first(), "Note:" | "Atom_number" | "Atom"));
        for line in rows.take_while(|line| line.first() != "Total" && !is_rule(line)) {
            let at = line.vector(1, "place")?;
            let moment_mub = match line.count() {
                6 => line.number(5, "moment")?.abs(),
                _ => vector::norm(line.vector(5, "moment")?),
            };
            if atoms.iter().any(|atom| atom.species == line.first()) {
                return Err(line.error(0, "atom", "an atom of this name is there already"));
            }
            atoms.push(Atom { at, species: line.first().into(), moment_mub, anisotropies: Vec::new() });
        }
        match atoms.is_empty() {
            true => Err(self.text.ends("there is no atom in it")),
            false => Ok(atoms),
        }
    }

    /// K and its axis, where they are given so; the tensors of newer files do not say with which sign they count.
    fn anisotropies(&self, atoms: &mut [Atom]) -> Result<()> {
        let heading = |line: &&Line| line.first() == "Single" && line.get(1) == Some("Ion");
        let Some(head) = self.lines.iter().find(heading) else { return Ok(()) };
        let behind = self.lines.iter().skip_while(|line| line.number <= head.number);
        if !head.words().any(|word| word.starts_with("meV")) {
            let message = "tensors of single ions are not imported, for their sign is not documented: take the section out, and write \
                           an \"anisotropy\" into the config";
            return Err(head.error(0, "Single Ion Anisotropy", message));
        }
        let rows = behind.skip_while(|line| matches!(line.first(), "k1" | "Atom" | "Atom_number"));
        for line in rows.take_while(|line| !is_rule(line)) {
            let Some(atom) = atoms.iter_mut().find(|atom| atom.species == line.first()) else { break };
            let k = line.number(1, "k1")?;
            if k == 0.0 {
                continue;
            }
            let axis = Direction::new(line.vector(2, "k1dir")?).map_err(|e| line.error(2, "k1dir", e.to_string()))?;
            atom.anisotropies.push(Anisotropy::Uniaxial { k, axis });
        }
        Ok(())
    }

    fn exchange(&self, atoms: &[Atom], convention: Convention) -> Result<Vec<Listed>> {
        let (_, lines) = self.section("Exchange", None)?;
        let named = |line: &Line, k: usize| {
            let name = line.word(k, "atom")?;
            let found = atoms.iter().position(|atom| atom.species == name);
            found.ok_or_else(|| line.error(k, "atom", format!("found {name:?}, which is none of the atoms")))
        };
        let mut listed = Vec::new();
        let mut blocks = lines.split(is_rule);
        // the names of the columns
        blocks.next();
        for block in blocks.filter(|block| !block.is_empty()) {
            let head = &block[0];
            let hop = Hop { atoms: [named(head, 0)?, named(head, 1)?], shift: head.shift(2, "R")? };
            let j = head.number(5, "J_iso")?;
            let (d, rest) = (dmi(block)?, anisotropic(self.text, block)?);
            listed.push(Listed { hop, matrix: matrix(convention, j, d, Some(&rest)), line: head.number });
        }
        match listed.is_empty() {
            true => Err(self.text.ends("there is no pair in it")),
            false => Ok(listed),
        }
    }
}

/// A line of dashes or equality signs.
fn is_rule(line: &Line) -> bool {
    line.count() == 1 && line.first().len() > 8 && line.first().chars().all(|c| c == '-' || c == '=')
}

/// Where in a line, words without brackets, a name stands; `Testing!` may come before it.
fn named(line: &Line, name: &str) -> Option<usize> {
    line.words().take(2).position(|word| word.trim_end_matches(':') == name)
}

fn dmi(block: &[Line]) -> Result<Vector> {
    let found = block.iter().find_map(|line| Some((line, named(line, "DMI")?)));
    found.map_or(Ok([0.0; 3]), |(line, k)| line.vector(k + 1, "DMI"))
}

/// J^ani: three rows behind its name.
fn anisotropic(text: &Text, block: &[Line]) -> Result<Matrix> {
    let Some(at) = block.iter().position(|line| named(line, "J_ani").is_some()) else { return Ok([[0.0; 3]; 3]) };
    let row = |k: usize| {
        let missing =
            || -> Error { text.error(block[at].number, "three rows of three numbers are to follow this line") };
        block.get(at + k).ok_or_else(missing)?.vector(0, "J_ani")
    };
    Ok([row(1)?, row(2)?, row(3)?])
}
