//! Spirit: a `.cfg` file, and the files of pairs and anisotropies that it names.
//!
//! ```text
//! H = − Σ_<ij> J n_i·n_j − Σ_<ij> D·(n_i × n_j) − Σ K (n·e)² − Σ K₄/2 Σ_c n_c⁴ − Σ μ n·B          each pair once, unit vectors, meV
//! ```
//! −K₄/2 Σ n_c⁴ is K₄ (α₁²α₂² + α₂²α₃² + α₃²α₁²), but for a constant. Neighbours in shells are those at the same distances, of all
//! atoms of the cell, over directions with more than one cell; their D is D r̂ (chirality 1), D r̂ × ẑ (2), or the opposite (−1, −2). A
//! pair that is listed twice, in either direction, adds up.
//!
//! Sources: <https://spirit-docs.readthedocs.io>, `core/docs/Input.md`, and the readers and energies of
//! <https://github.com/spirit-code/spirit> (`Configparser.cpp`, `Dataparser.cpp`, `Neighbours.cpp`, `Hamiltonian_Heisenberg.cpp`);
//! Müller et al., <https://doi.org/10.1103/PhysRevB.99.224414>.

use super::atoms::place;
use super::bonds::{Bond, Listed, added, matrix, merge};
use super::keywords::{Energies, Keywords, not_read, refuse};
use super::text::{Line, Text};
use super::told::{Told, in_words};
use super::{Anisotropy, Atom, Format, Model, beside, only};
use crate::energy::{Convention, Counting, DmiForm, EnergyForm};
use crate::error::Result;
use crate::geometry::matrix::{Matrix, UNIT};
use crate::geometry::{Direction, Vector, vector};
use crate::lattice::{Hop, Shift};
use std::path::{Path, PathBuf};

pub const FORMAT: Format = Format {
    name: "spirit",
    summary: "an input file (.cfg), with the files of pairs and anisotropies that it names",
    read,
};

/// Distances this close (Å) are of one shell; Spirit's own.
const SHELL: f64 = 1e-3;
/// Shells that are looked for; the work grows with their cube.
const MAX_SHELLS: usize = 24;
/// Words of what sets an energy.
const ENERGIES: Energies = Energies {
    set: &[
        "anisotropy",
        "field",
        "exchange",
        "dmi",
        "pairs",
        "quadruplet*",
        "ddi",
        "gaussian*",
        "atom_types",
        "defects",
        "pinned",
        "pinning",
    ],
    // how dipoles are summed, which ddi_method switches on
    none: &["images", "radius", "padding"],
    read: &[
        "external_field_magnitude",
        "external_field_normal",
        "n_anisotropy",
        "anisotropy_file",
        "anisotropy_from_file",
        "anisotropy_magnitude",
        "anisotropy_normal",
        "cubic_anisotropy_magnitude",
        "n_shells_exchange",
        "n_shells_dmi",
        PAIRS_COUNT,
        PAIRS_FILES[0],
        PAIRS_FILES[1],
    ],
};

/// The Hamiltonian of shells of neighbours, which is meant where none is named.
const SHELLS: &str = "heisenberg_neighbours";
/// Where the pairs of the other one are.
const PAIRS_FILES: [&str; 2] = ["interaction_pairs_file", "pairs_from_file"];
const PAIRS_COUNT: &str = "n_interaction_pairs";
const NO_MOMENT: &str = "there is no mu_s: moments are 1 μ_B, as in Spirit then";

struct Input<'a> {
    path: &'a Path,
    keys: Keywords<'a>,
}

fn read(paths: &[PathBuf], told: Told) -> Result<Model> {
    told.no_cubic()?;
    let path = only(paths, "the input file, input.cfg")?;
    let text = Text::read(path)?;
    let input = Input { path, keys: Keywords::new(&text, text.lines(&['#'], &['|']), false) };
    refuse(&input.keys.unread(), &ENERGIES)?;
    let own = Convention { counting: Counting::Once, energy: EnergyForm::Minus, dmi: DmiForm::Minus };
    let convention = told.over(own);
    let (vectors, scale) = (input.vectors()?, input.single("lattice_constant", 1.0)?);
    if scale <= 0.0 {
        let line = input.keys.needed("lattice_constant")?;
        return Err(line.error(1, "lattice_constant", format!("found {scale}, but a length is positive")));
    }
    let mut atoms = input.atoms()?;
    let cells = match input.keys.line("n_basis_cells") {
        Some(line) => line.cells(1, "n_basis_cells")?,
        None => [100, 100, 1],
    };
    let mut files = vec![text.file.clone()];
    files.extend(input.anisotropies(&mut atoms)?);
    let lattice = Shells { vectors, atoms: &atoms, cells, scale };
    let (bonds, pairs) = match input.word("hamiltonian", SHELLS)? {
        SHELLS => (input.shells(&lattice, convention)?, None),
        "heisenberg_pairs" => input.pairs(atoms.len(), convention)?,
        other => {
            let message = format!("found \"{other}\", but heisenberg_neighbours and heisenberg_pairs are imported");
            return Err(input.keys.needed("hamiltonian")?.error(1, "hamiltonian", message));
        }
    };
    files.extend(pairs);
    let [formula, factors] = in_words(convention, true);
    let mut model = Model {
        code: "Spirit",
        files,
        vectors,
        spacing_nm: input.keys.line("lattice_constant").map(|_| 0.1 * scale),
        atoms,
        bonds,
        field_t: input.field()?,
        cells: Some(cells),
        periodic: Some(input.boundaries()?),
        convention: vec![formula, format!("{factors}; meV; unit vectors; K (n·e)² is written with K")],
        notes: input.notes()?,
    };
    model.notes.extend(not_read(&text, &input.keys.unread()));
    let of_vectors = model.spacing_nm.is_none() && input.keys.line("bravais_lattice").is_none();
    let model = if of_vectors { model.scaled_to_first(1.0) } else { model };
    model.checked(path)
}

impl<'a> Input<'a> {
    /// What a user of the file may not expect.
    fn notes(&self) -> Result<Vec<String>> {
        let kind = self.word("hamiltonian", SHELLS)?;
        let pairs = [PAIRS_COUNT, PAIRS_FILES[0], PAIRS_FILES[1]];
        let unread: &[&str] = if kind == SHELLS { &pairs } else { &["n_shells_exchange", "n_shells_dmi"] };
        let unread = unread.iter().filter(|keyword| self.keys.line(keyword).is_some());
        let words = |keyword: &&str| {
            format!(
                "{keyword} is not read, as in Spirit: \"hamiltonian\" is {kind}, {}",
                match self.keys.line("hamiltonian") {
                    Some(_) => "as the file says",
                    None => "which it is where the file does not say",
                }
            )
        };
        let no_moment = self.keys.line("mu_s").is_none().then(|| NO_MOMENT.to_string());
        Ok(no_moment.into_iter().chain(unread.map(words)).collect())
    }

    /// A line after that of a keyword.
    fn after(&self, keyword: &str, k: usize) -> Result<&Line<'a>> {
        let at = self.keys.find(keyword).unwrap_or(0) + k;
        self.keys.lines.get(at).ok_or_else(|| self.keys.text.ends(format!("{k} lines are needed behind \"{keyword}\"")))
    }

    fn word(&self, keyword: &str, otherwise: &'a str) -> Result<&'a str> {
        self.keys.line(keyword).map_or(Ok(otherwise), |line| line.word(1, keyword))
    }

    fn single(&self, keyword: &str, otherwise: f64) -> Result<f64> {
        self.keys.line(keyword).map_or(Ok(otherwise), |line| line.number(1, keyword))
    }

    fn direction(&self, keyword: &str) -> Result<Vector> {
        let Some(line) = self.keys.line(keyword) else { return Ok([0.0, 0.0, 1.0]) };
        let v = line.vector(1, keyword)?;
        vector::unit(v).ok_or_else(|| line.error(1, keyword, "found no direction: all components are 0"))
    }

    fn vectors(&self) -> Result<Matrix> {
        let rows = |keyword| Ok([1, 2, 3].map(|k| self.after(keyword, k).and_then(|line| line.vector(0, keyword))));
        let whole = |[a, b, c]: [Result<Vector>; 3]| Ok([a?, b?, c?]);
        let Some(line) = self.keys.line("bravais_lattice") else {
            return match (self.keys.line("bravais_vectors"), self.keys.line("bravais_matrix")) {
                (Some(_), _) => rows("bravais_vectors").and_then(whole),
                (_, Some(_)) => Ok(crate::geometry::matrix::transposed(&rows("bravais_matrix").and_then(whole)?)),
                _ => Ok(UNIT),
            };
        };
        let (h, s) = (0.5, 0.5 * 3f64.sqrt());
        let name = line.word(1, "bravais_lattice")?;
        match name.to_ascii_lowercase().as_str() {
            "sc" => Ok(UNIT),
            "fcc" => Ok([[h, 0.0, h], [h, h, 0.0], [0.0, h, h]]),
            "bcc" => Ok([[h, h, -h], [-h, h, -h], [h, -h, -h]]),
            "hex2d" | "hex2d60" => Ok([[s, -h, 0.0], [s, h, 0.0], [0.0, 0.0, 1.0]]),
            "hex2d120" => Ok([[h, -s, 0.0], [h, s, 0.0], [0.0, 0.0, 1.0]]),
            _ => {
                let message = format!("found {name:?}, expected sc, fcc, bcc, hex2d, hex2d60 or hex2d120");
                Err(line.error(1, "bravais_lattice", message))
            }
        }
    }

    fn atoms(&self) -> Result<Vec<Atom>> {
        if let Some(line) = self.keys.line("basis_file") {
            return Err(line.error(0, "basis_file", "put the \"basis\" into the input file itself"));
        }
        let count = match self.keys.line("basis") {
            None => 1,
            Some(_) => {
                let line = self.after("basis", 1)?;
                let most = self.keys.lines.len();
                line.index(0, "basis", 1, most)? + 1
            }
        };
        let places = (0..count).map(|k| match self.keys.line("basis") {
            None => Ok([0.0; 3]),
            Some(_) => self.after("basis", 2 + k)?.vector(0, "basis"),
        });
        let moments = self.keys.line("mu_s");
        let atom = |(k, at): (usize, Result<Vector>)| {
            let Some(moments) = moments else {
                return Ok(Atom { at: at?, species: format!("atom_{k}"), moment_mub: 1.0, anisotropies: Vec::new() });
            };
            // where one is given it is for all, as in Spirit
            let word = if moments.count() == 2 { 1 } else { k + 1 };
            let moment_mub = moments.number(word, "mu_s")?;
            if moment_mub < 0.0 {
                return Err(moments.error(
                    word,
                    "mu_s",
                    format!("found {moment_mub}, but a moment has a size and a direction"),
                ));
            }
            Ok(Atom { at: at?, species: format!("atom_{k}"), moment_mub, anisotropies: Vec::new() })
        };
        places.enumerate().map(atom).collect()
    }

    fn boundaries(&self) -> Result<[bool; 3]> {
        let flags =
            self.keys.line("boundary_conditions").map_or(Ok([0; 3]), |line| line.shift(1, "boundary_conditions"))?;
        Ok(flags.map(|flag| flag != 0))
    }

    fn field(&self) -> Result<Vector> {
        let (b, along) = (self.single("external_field_magnitude", 0.0)?, self.direction("external_field_normal"));
        Ok(if b == 0.0 { [0.0; 3] } else { vector::scale(b, along?) })
    }

    /// A table: what the keyword's line says how long it is, or a file of its own; and that file's name.
    fn table(&self, count: &str, names: &[&str]) -> Result<Option<Table>> {
        if let Some(at) = self.keys.find(count) {
            let rows = self.keys.lines[at].index(1, count, 0, self.keys.lines.len() + 1)?;
            let text = self.keys.text.clone();
            let head = self.after(count, 1)?;
            // a column may be called as a keyword is: Jij
            self.keys.find(head.first());
            return Ok(Some(Table { first: head.number, rows: Some(rows), text, file: None }));
        }
        let Some(line) = names.iter().find_map(|name| self.keys.line(name)) else { return Ok(None) };
        let (keyword, named) = (line.first(), line.word(1, names[0])?);
        // Spirit looks for it from where it was started, which is often the folder above
        let above = self.path.parent().and_then(Path::parent).unwrap_or(Path::new(""));
        let places = [beside(self.path, named), above.join(named)];
        let file = places.iter().find(|file| file.is_file()).unwrap_or(&places[0]);
        let text = Text::read(file).map_err(|e| line.error(1, keyword, format!("the file cannot be read: {e}")))?;
        let lines = text.lines(&['#'], &['|']);
        let (first, rows) = match lines.iter().position(|line| line.first().eq_ignore_ascii_case(count)) {
            Some(at) => {
                let head = lines.get(at + 1).ok_or_else(|| text.ends("the names of the columns are missing"))?;
                (head.number, Some(lines[at].index(1, count, 0, lines.len() + 1)?))
            }
            None => (lines.first().map_or(1, |line| line.number), None),
        };
        Ok(Some(Table { first, rows, file: Some(text.file.clone()), text }))
    }

    fn anisotropies(&self, atoms: &mut [Atom]) -> Result<Option<String>> {
        let Some(table) = self.table("n_anisotropy", &["anisotropy_file", "anisotropy_from_file"])? else {
            let (k, k4) = (self.single("anisotropy_magnitude", 0.0)?, self.single("cubic_anisotropy_magnitude", 0.0)?);
            let axis = Direction::new(self.direction("anisotropy_normal")?)?;
            for atom in atoms {
                add_anisotropy(atom, k, axis, k4);
            }
            return Ok(None);
        };
        table.each(&["i", "k", "kx", "ky", "kz", "k4"], |row| {
            let site = row.line.index(row.column("i")?, "i", 0, atoms.len())?;
            let own = row.vector(["kx", "ky", "kz"])?.unwrap_or([0.0; 3]);
            let k = row.number("k")?.unwrap_or(vector::norm(own));
            let axis = vector::unit(own).unwrap_or([0.0, 0.0, 1.0]);
            add_anisotropy(&mut atoms[site], k, Direction::new(axis)?, row.number("k4")?.unwrap_or(0.0));
            Ok(())
        })?;
        Ok(table.file)
    }

    fn pairs(&self, atoms: usize, convention: Convention) -> Result<(Vec<Bond>, Option<String>)> {
        let missing =
            || self.keys.text.ends("there is no \"n_interaction_pairs\" and no \"interaction_pairs_file\" in it");
        let table = self.table(PAIRS_COUNT, &PAIRS_FILES)?.ok_or_else(missing)?;
        let mut listed = Vec::new();
        let columns = ["i", "j", "da", "db", "dc", "jij", "dij", "dijx", "dijy", "dijz"];
        table.each(&columns, |row| {
            let atom = |name| row.line.index(row.column(name)?, name, 0, atoms);
            let step = |name| row.line.whole(row.column(name)?, name);
            let hop = Hop { atoms: [atom("i")?, atom("j")?], shift: [step("da")?, step("db")?, step("dc")?] };
            let own = row.vector(["dijx", "dijy", "dijz"])?.unwrap_or([0.0; 3]);
            let d = match row.number("dij")? {
                Some(size) => vector::scale(size, vector::unit(own).unwrap_or([0.0; 3])),
                None => own,
            };
            let j = row.number("jij")?.unwrap_or(0.0);
            listed.push(Listed { hop, matrix: matrix(convention, j, d, None), line: row.line.number });
            Ok(())
        })?;
        Ok((merge(&table.text, &listed, convention.counting, 0.0)?, table.file))
    }

    /// J and D of shells.
    fn shells(&self, lattice: &Shells, convention: Convention) -> Result<Vec<Bond>> {
        let mut bonds = Vec::new();
        for (count, values, dmi) in [("n_shells_exchange", "jij", false), ("n_shells_dmi", "dij", true)] {
            let Some(line) = self.keys.line(count) else { continue };
            let shells = line.index(1, count, 0, MAX_SHELLS + 1)?;
            if shells == 0 {
                continue;
            }
            let list = self.keys.needed(values)?;
            let chirality = self.keys.line("dm_chirality").map_or(Ok(1), |line| line.whole(1, "dm_chirality"))?;
            if dmi && !matches!(chirality, -2 | -1 | 1 | 2) {
                let message = format!("found {chirality}, expected 1 or -1 (Bloch), 2 or -2 (Néel)");
                return Err(self.keys.needed("dm_chirality")?.error(1, "dm_chirality", message));
            }
            for (shell, hop, r) in lattice.neighbours(shells) {
                let value = list.number(1 + shell, values)?;
                let (j, d) = match dmi {
                    false => (value, [0.0; 3]),
                    true => (0.0, vector::scale(value, normal(r, chirality))),
                };
                bonds.push(Bond { hop, matrix: matrix(convention, j, d, None) });
            }
        }
        Ok(added(bonds))
    }
}

fn add_anisotropy(atom: &mut Atom, k: f64, axis: Direction, k4: f64) {
    if k != 0.0 {
        atom.anisotropies.push(Anisotropy::Uniaxial { k, axis });
    }
    if k4 != 0.0 {
        atom.anisotropies.push(Anisotropy::Cubic { k: k4 });
    }
}

/// d̂ of a pair.
fn normal(r: Vector, chirality: isize) -> Vector {
    let along = vector::unit(r).unwrap_or([0.0; 3]);
    let own = if chirality.abs() == 1 { along } else { vector::cross(along, [0.0, 0.0, 1.0]) };
    vector::scale(chirality.signum() as f64, own)
}

/// Where the atoms stand, for neighbours by distance.
struct Shells<'a> {
    vectors: Matrix,
    atoms: &'a [Atom],
    cells: [usize; 3],
    /// Length of 1 (Å).
    scale: f64,
}

impl Shells<'_> {
    /// Shell, hop and vector of each pair, each once.
    fn neighbours(&self, shells: usize) -> Vec<(usize, Hop, Vector)> {
        let reach = self.cells.map(|n| (n - 1).min(shells + 2) as isize);
        let range = |d: usize| -reach[d]..=reach[d];
        let shifts: Vec<Shift> =
            range(0).flat_map(|a| range(1).flat_map(move |b| range(2).map(move |c| [a, b, c]))).collect();
        let mut all = Vec::new();
        for from in 0..self.atoms.len() {
            for to in from..self.atoms.len() {
                // of an atom and its images the half that leads up
                let up = |shift: &&Shift| from < to || **shift > [0; 3];
                for shift in shifts.iter().filter(up) {
                    let between = [0, 1, 2].map(|d| self.atoms[to].at[d] - self.atoms[from].at[d] + shift[d] as f64);
                    let r = place(&self.vectors, between);
                    all.push((self.scale * vector::norm(r), Hop { atoms: [from, to], shift: *shift }, r));
                }
            }
        }
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut radii: Vec<f64> = Vec::new();
        let mut found = Vec::new();
        for (distance, hop, r) in all {
            if radii.last().is_none_or(|last| distance - last > SHELL) {
                radii.push(distance);
            }
            if radii.len() > shells {
                break;
            }
            found.push((radii.len() - 1, hop, r));
        }
        found
    }
}

/// A table with the names of its columns in its first line.
struct Table {
    text: Text,
    /// Line of the names.
    first: usize,
    /// How many rows follow; all there are if nothing is said.
    rows: Option<usize>,
    /// Where it is a file of its own.
    file: Option<String>,
}

struct Row<'r, 'a> {
    names: &'r [String],
    line: &'r Line<'a>,
}

impl Table {
    fn each(&self, known: &[&str], mut row: impl FnMut(Row) -> Result<()>) -> Result<()> {
        let lines = self.text.lines(&['#'], &['|']);
        let mut lines = lines.iter().skip_while(|line| line.number < self.first);
        let head = lines.next().ok_or_else(|| self.text.ends("the names of the columns are missing"))?;
        let names: Vec<String> = head.words().map(str::to_ascii_lowercase).collect();
        for (k, name) in names.iter().enumerate() {
            if ["dija", "dijb", "dijc", "ka", "kb", "kc"].contains(&name.as_str()) {
                let message = "components along the cell's vectors are not imported, for Spirit's documentation and its reader differ: \
                               give those along x, y and z";
                return Err(head.error(k, name, message));
            }
            if !known.contains(&name.as_str()) {
                return Err(head.error(k, name, format!("no column is called this: there are {}", known.join(", "))));
            }
        }
        for k in 0..self.rows.unwrap_or(usize::MAX) {
            match lines.next() {
                Some(line) => row(Row { names: &names, line })?,
                None if self.rows.is_none() => break,
                None => {
                    return Err(self
                        .text
                        .ends(format!("found {k} rows of the {} that are announced", self.rows.unwrap_or(0))));
                }
            }
        }
        Ok(())
    }
}

impl Row<'_, '_> {
    fn column(&self, name: &str) -> Result<usize> {
        let missing = || self.line.error(0, name, "the table has no such column");
        self.names.iter().position(|own| own == name).ok_or_else(missing)
    }

    fn number(&self, name: &str) -> Result<Option<f64>> {
        self.names.iter().position(|own| own == name).map(|k| self.line.number(k, name)).transpose()
    }

    fn vector(&self, names: [&str; 3]) -> Result<Option<Vector>> {
        let [x, y, z] = [self.number(names[0])?, self.number(names[1])?, self.number(names[2])?];
        Ok(match (x, y, z) {
            (Some(x), Some(y), Some(z)) => Some([x, y, z]),
            _ => None,
        })
    }
}
