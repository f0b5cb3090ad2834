//! UppASD: `inpsd.dat` and the files that it names.
//!
//! ```text
//! H = − Σ_{i≠j} J_ij e_i·e_j ∓ Σ_{i≠j} D_ij·(e_i × e_j) + Σ K₁ (e·n)² − Σ μ e·B          each pair twice, unit vectors, mRy
//! ```
//! The manual has −D, and so has the program since May 2023 (commit 49158ad); up to version 6.0.2 its field was that of +D. A file of D
//! does not say for which it was made, so the sign is asked for. Couplings belong to types of atoms and vectors: a line is for all
//! atoms of the first one's type, `sym` turns J (not D) by the operations of a group. Of the anisotropies the manual and the program
//! agree on the uniaxial K₁ alone: K₂ is refused, and the sign of the cubic one asked for.
//!
//! Sources: the manual, <https://uppasd.github.io/UppASD-manual/input/>; the readers and fields in the program,
//! <https://github.com/UppASD/UppASD> (`inputhandler_ext.f90`, `neighbourmap.f90`, `hamiltonianactions.f90`).

use super::atoms::{atom_at, coordinates, place};
use super::bonds::{Listed, added, matrix, merge};
use super::keywords::{Energies, Keywords, not_read, refuse};
use super::text::{Line, Text};
use super::told::{Told, in_words};
use super::{Anisotropy, Atom, Format, Model, beside, found, only};
use crate::energy::{Convention, Counting, DmiForm, EnergyForm};
use crate::error::{Error, Result};
use crate::geometry::matrix::{Matrix, UNIT, times};
use crate::geometry::{Direction, Vector};
use crate::lattice::Hop;
use crate::units::RYDBERG;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

pub const FORMAT: Format = Format {
    name: "uppasd",
    summary: "inpsd.dat, or its folder, with the posfile, momfile, exchange, dm and anisotropy files that it names",
    read,
};

/// 1 mRy (meV).
const MRY: f64 = 1e-3 * RYDBERG;
/// How far from where a coupling leads an atom may stand, in the unit of the cell; the program has the same.
const NEAR: f64 = 0.1;
/// Words of what sets an energy; its short ones and its switches are whole keywords.
const ENERGIES: Energies = Energies {
    set: &[
        "demag*",
        "anisotropy",
        "exchange*",
        "dip*",
        "qdip",
        "do_ewald",
        "scale",
        "scalefac",
        "model",
        "pd",
        "bq*",
        "biq*",
        "chir",
        "fourx",
        "ring",
        "sa",
        "ml",
        "mml",
        "mmll",
        "locfield",
        "siteatomfield",
        "do_bpulse",
        "do_ralloy",
        "do_cluster",
        "do_lsf",
        "ind_mom_flag",
        "multiscale",
        "positions",
        "moments",
        "mult_axis",
        "exc_inter",
        "map_multiple",
        "aunits",
    ],
    // what is printed, and what belongs to do_cluster
    none: &["prn", "print", "clus"],
    read: &["exchange", "anisotropy", "do_anisotropy"],
};

/// `inpsd.dat`.
struct Input<'a> {
    path: &'a Path,
    keys: Keywords<'a>,
}

/// What stands where.
struct Cell {
    vectors: Matrix,
    at: Vec<Vector>,
    types: Vec<isize>,
}

/// How vectors of couplings are written.
#[derive(Clone, Copy, PartialEq)]
enum Vectors {
    Cartesian,
    Direct,
    /// Cells from atom to atom.
    Cells,
}

fn read(paths: &[PathBuf], told: Told) -> Result<Model> {
    let path = found(only(paths, "inpsd.dat, or the folder with it")?, &["inpsd.dat"]);
    let text = Text::read(&path)?;
    let lines = text.lines(&['#', '!', '%'], &[':', ',']);
    let input = Input { path: &path, keys: Keywords::new(&text, lines, true) };
    refuse(&input.keys.unread(), &ENERGIES)?;
    let (cell, positions) = input.cell()?;
    let jfile = input.file("exchange")?;
    let dmfile = input.optional("dm")?;
    let own = Convention { counting: Counting::BothDirections, energy: EnergyForm::Minus, dmi: DmiForm::Minus };
    if dmfile.is_some() && told.dmi.is_none() {
        return Err(input.keys.needed("dm")?.error(0, "dm", SIGN_OF_D));
    }
    let convention = told.over(own);
    let style = input.style()?;
    let tensors = input.tensors(told)?;
    let exchange = Couplings { cell: &cell, style, group: input.group()?, tensors, convention };
    let mut bonds = merge(&jfile, &exchange.exchange(&jfile)?, convention.counting, 0.0)?;
    if let Some(dmfile) = &dmfile {
        let plain = Couplings { group: vec![UNIT], ..exchange };
        bonds.extend(merge(dmfile, &plain.dmi(dmfile)?, convention.counting, 0.0)?);
    }
    let (momfile, kfile) = (input.file("momfile")?, input.anisotropy_file()?);
    let mut atoms = moments(&cell, &momfile)?;
    if let Some(kfile) = &kfile {
        anisotropies(kfile, &mut atoms, told)?;
    }
    let [formula, factors] = in_words(convention, dmfile.is_some());
    let files = [Some(&text), Some(&positions), Some(&momfile), Some(&jfile), dmfile.as_ref(), kfile.as_ref()];
    let mut model = Model {
        code: "UppASD",
        files: files.into_iter().flatten().map(|text| text.file.clone()).collect(),
        vectors: cell.vectors,
        spacing_nm: input.spacing_nm()?,
        atoms,
        bonds: added(bonds),
        field_t: input.keys.line("hfield").map_or(Ok([0.0; 3]), |line| line.vector(1, "hfield"))?,
        cells: Some(input.keys.needed("ncell")?.cells(1, "ncell")?),
        periodic: Some(input.boundaries()?),
        convention: vec![
            formula,
            format!("{factors}; mRy = {MRY:.6} meV; unit vectors; K₁ (e·n)² is written with −K₁"),
        ],
        notes: Vec::new(),
    };
    model.notes.extend(not_read(&text, &input.keys.unread()));
    model.checked(&path)
}

const SIGN_OF_D: &str = "the sign of D is open: the manual has −D·(e_i × e_j), and so has the program since May 2023; up to version \
                         6.0.2 it computed with +D. Give --convention -D or --convention +D, by what the file was made for";

const SIGN_OF_CUBIC: &str = "the sign of the cubic anisotropy is open: the manual has +K₁ (α₁²α₂² + α₂²α₃² + α₃²α₁²), the program \
                             computes with −K₁. Give --convention +K or --convention -K, by what the file was made for";
const NO_CUBIC_K2: &str =
    "the term of sixth order is not imported: make K2 0, and mind that the energy is another one then";
const NO_K2: &str = "K2 is not imported, for it is K₂ (e·n)⁴ in the manual and −K₂ [1 − (e·n)²]² in the program: make it 0, and write \
                     \"K2\" into the config";
const SIGN_OF_TENSORS: &str = "what tensors mean is open: the manual has +e·𝒥·e in Ry, the program computes −e·T·e in mRy. Give \
                               --convention -J if the file's diagonal is the J of ferromagnets, --convention +J if it is −J; its \
                               numbers are taken as mRy";

impl<'a> Input<'a> {
    /// The file that a keyword names, if it is there.
    fn optional(&self, keyword: &str) -> Result<Option<Text>> {
        self.keys.find(keyword).map(|_| self.file(keyword)).transpose()
    }

    /// The word behind a keyword, in lower case.
    fn value(&self, keyword: &str) -> Option<String> {
        Some(self.keys.line(keyword)?.get(1)?.to_ascii_lowercase())
    }

    /// The file that a keyword names, beside this one.
    fn file(&self, keyword: &str) -> Result<Text> {
        let line = self.keys.needed(keyword)?;
        let named = line.word(1, keyword)?;
        let file = beside(self.path, named);
        Text::read(&file).map_err(|e| line.error(1, keyword, format!("the file cannot be read: {e}")))
    }

    /// The file of anisotropies, unless it is named and not to be read.
    fn anisotropy_file(&self) -> Result<Option<Text>> {
        let file = self.optional("anisotropy")?;
        match self.keys.line("do_anisotropy").filter(|line| line.get(1) == Some("0")) {
            Some(line) if file.is_some() => {
                let message = "found 0, but a file of anisotropies is named: take the line out that is not meant";
                Err(line.error(1, "do_anisotropy", message))
            }
            _ => Ok(file),
        }
    }

    /// Whether the file of exchange has tensors, whose sign and unit are those of the program.
    fn tensors(&self, told: Told) -> Result<bool> {
        let Some(line) = self.keys.line("do_jtensor").filter(|line| line.get(1) != Some("0")) else { return Ok(false) };
        if told.energy.is_none() {
            return Err(line.error(0, "do_jtensor", SIGN_OF_TENSORS));
        }
        match self.value("sym").as_deref() {
            None | Some("0") => Ok(true),
            _ => Err(line.error(
                0,
                "do_jtensor",
                "tensors are not turned with their vectors: list all of them, with sym 0",
            )),
        }
    }

    /// The cell's vectors: nine numbers, on one line or several.
    fn vectors(&self) -> Result<Matrix> {
        let first = self.keys.find("cell").ok_or_else(|| self.keys.text.ends("there is no \"cell\" in it"))?;
        let mut all: Vec<f64> = Vec::new();
        for (k, line) in self.keys.lines[first..].iter().enumerate() {
            // words behind the numbers are comments
            let skip = usize::from(k == 0);
            for word in skip..line.count() {
                match line.number(word, "cell") {
                    Ok(x) if all.len() < 9 => all.push(x),
                    Err(e) if word == skip && all.len() < 9 && (k > 0 || line.count() > 1) => return Err(e),
                    _ => break,
                }
            }
            if all.len() == 9 {
                return Ok([0, 3, 6].map(|row| [all[row], all[row + 1], all[row + 2]]));
            }
        }
        Err(self.keys.text.ends(format!("a \"cell\" has 9 numbers, found {}", all.len())))
    }

    fn style(&self) -> Result<Vectors> {
        match (self.value("maptype").as_deref(), self.posfiletype()?) {
            (Some("2"), _) => Ok(Vectors::Cells),
            (None | Some("1"), style) => Ok(style),
            (Some(other), _) => {
                let message = format!("found \"{other}\", but vectors of maptype 1 and 2 are imported");
                Err(self.keys.needed("maptype")?.error(1, "maptype", message))
            }
        }
    }

    fn posfiletype(&self) -> Result<Vectors> {
        match self.value("posfiletype").as_deref() {
            None | Some("c") => Ok(Vectors::Cartesian),
            Some("d") => Ok(Vectors::Direct),
            Some(other) => {
                let message = format!("found \"{other}\", expected C (Cartesian) or D (direct)");
                Err(self.keys.needed("posfiletype")?.error(1, "posfiletype", message))
            }
        }
    }

    fn cell(&self) -> Result<(Cell, Text)> {
        let (vectors, posfile) = (self.vectors()?, self.file("posfile")?);
        if crate::geometry::matrix::determinant(&vectors).abs() < 1e-12 {
            return Err(self.keys.needed("cell")?.error(
                0,
                "cell",
                "the three vectors lie in a plane: they span no cell",
            ));
        }
        let style = self.posfiletype()?;
        let lines = posfile.lines(&['#', '!'], &[',']);
        let mut cell = Cell { vectors, at: vec![[0.0; 3]; lines.len()], types: vec![0; lines.len()] };
        let mut seen = vec![false; lines.len()];
        for line in &lines {
            let site = line.index(0, "site", 1, lines.len())?;
            if std::mem::replace(&mut seen[site], true) {
                return Err(line.error(0, "site", "this site is there a second time"));
            }
            let r = line.vector(2, "position")?;
            cell.types[site] = line.whole(1, "type")?;
            cell.at[site] = if style == Vectors::Direct { r } else { coordinates(&vectors, r) };
        }
        match lines.is_empty() {
            true => Err(posfile.ends("there is no atom in it")),
            false => Ok((cell, posfile)),
        }
    }

    fn boundaries(&self) -> Result<[bool; 3]> {
        let Some(line) = self.keys.line("bc") else { return Ok([false; 3]) };
        let flag = |k: usize| match line.word(k, "BC")? {
            "P" | "p" => Ok(true),
            "0" => Ok(false),
            other => Err(line.error(k, "BC", format!("found {other:?}, expected P (periodic) or 0 (open)"))),
        };
        Ok([flag(1)?, flag(2)?, flag(3)?])
    }

    /// `alat`, in m; 1 is what it is if nobody gave it.
    fn spacing_nm(&self) -> Result<Option<f64>> {
        let Some(line) = self.keys.line("alat") else { return Ok(None) };
        let metres = line.number(1, "alat")?;
        Ok(Some(1e9 * metres).filter(|nm| *nm > 0.0 && metres != 1.0))
    }

    /// The operations by which vectors of exchange are repeated.
    fn group(&self) -> Result<Vec<Matrix>> {
        match self.value("sym").as_deref() {
            None | Some("0") => Ok(vec![UNIT]),
            Some("1") => Ok(cubic(true)),
            Some("2") => Ok(cubic(false)),
            Some("3") => Ok(hexagonal()),
            Some(other) => {
                let message = format!("found {other:?}, but 0 to 3 are imported: list all couplings, and give 0");
                Err(self.keys.needed("sym")?.error(1, "sym", message))
            }
        }
    }
}

/// The 48 operations of a cube, or the 8 of a square about z.
fn cubic(whole: bool) -> Vec<Matrix> {
    let orders: &[[usize; 3]] = if whole {
        &[[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]]
    } else {
        &[[0, 1, 2], [1, 0, 2]]
    };
    let signs = |k: usize| [0, 1, 2].map(|d| if k >> d & 1 == 1 { -1.0 } else { 1.0 });
    let count = if whole { 8 } else { 4 };
    let one = |order: &[usize; 3], k: usize| {
        [0, 1, 2].map(|r| [0, 1, 2].map(|c| if c == order[r] { signs(k)[r] } else { 0.0 }))
    };
    orders.iter().flat_map(|order| (0..count).map(move |k| one(order, k))).collect()
}

/// The 24 operations of a hexagon about z: turns by 60°, mirrored or not, up or down.
fn hexagonal() -> Vec<Matrix> {
    let one = |k: usize| {
        let (sin, cos) = (std::f64::consts::FRAC_PI_3 * (k % 6) as f64).sin_cos();
        let (mirror, up) = (if k / 6 % 2 == 1 { -1.0 } else { 1.0 }, if k / 12 == 1 { -1.0 } else { 1.0 });
        [[cos, -sin * mirror, 0.0], [sin, cos * mirror, 0.0], [0.0, 0.0, up]]
    };
    (0..24).map(one).collect()
}

/// How the lines of a file of couplings become pairs.
struct Couplings<'a> {
    cell: &'a Cell,
    style: Vectors,
    group: Vec<Matrix>,
    tensors: bool,
    convention: Convention,
}

impl Couplings<'_> {
    fn exchange(&self, text: &Text) -> Result<Vec<Listed>> {
        self.each(text, |line| match self.tensors {
            false => Ok(matrix(self.convention, MRY * line.number(5, "J")?, [0.0; 3], None)),
            true => {
                let row = |k: usize| Ok::<_, Error>(line.vector(k, "J tensor")?.map(|x| MRY * x));
                Ok(matrix(self.convention, 0.0, [0.0; 3], Some(&[row(5)?, row(8)?, row(11)?])))
            }
        })
    }

    fn dmi(&self, text: &Text) -> Result<Vec<Listed>> {
        self.each(text, |line| Ok(matrix(self.convention, 0.0, line.vector(5, "D")?.map(|x| MRY * x), None)))
    }

    /// The pairs of all lines: for all atoms of the first one's type, along the vector as the group turns it.
    fn each(&self, text: &Text, strength: impl Fn(&Line) -> Result<Matrix>) -> Result<Vec<Listed>> {
        let count = self.cell.at.len();
        let mut at: BTreeMap<Hop, Listed> = BTreeMap::new();
        let mut order = Vec::new();
        for line in &text.lines(&['#', '!'], &[',']) {
            // a line of TB2J's writer: the number of couplings
            if line.count() == 2 && order.is_empty() {
                continue;
            }
            let (i, j) = (line.index(0, "site i", 1, count)?, line.index(1, "site j", 1, count)?);
            let (r, matrix) = (self.vector(line, i, j)?, strength(line)?);
            let hops = self.hops(i, j, r);
            if !hops.iter().any(|hop| hop.atoms[0] == i) {
                let message =
                    format!("no atom of the type of site {} stands where this vector leads from site {}", j + 1, i + 1);
                return Err(line.error(2, "vector", message));
            }
            for hop in hops {
                let listed = Listed { hop, matrix, line: line.number };
                match at.get(&hop) {
                    None => {
                        order.push(hop);
                        at.insert(hop, listed);
                    }
                    Some(first) if crate::geometry::matrix::apart(&first.matrix, &matrix) <= 1e-9 * MRY => {}
                    Some(first) => {
                        let message = format!(
                            "this coupling has another value in line {}, for atoms of the same types along an equivalent vector",
                            first.line
                        );
                        return Err(line.error(0, "coupling", message));
                    }
                }
            }
        }
        match order.is_empty() {
            true => Err(text.ends("there is no coupling in it")),
            false => Ok(order.iter().filter_map(|hop| at.get(hop).cloned()).collect()),
        }
    }

    /// The vector of a line, Cartesian.
    fn vector(&self, line: &Line, i: usize, j: usize) -> Result<Vector> {
        let r = line.vector(2, "vector")?;
        let Cell { vectors, at, .. } = self.cell;
        Ok(match self.style {
            Vectors::Cartesian => r,
            Vectors::Direct => place(vectors, r),
            Vectors::Cells => place(vectors, [0, 1, 2].map(|d| r[d] + at[j][d] - at[i][d])),
        })
    }

    /// Where the vector leads, as the group turns it, from each atom of the type of i to one of the type of j.
    fn hops(&self, i: usize, j: usize, r: Vector) -> Vec<Hop> {
        let Cell { vectors, at, types } = self.cell;
        let mut hops: Vec<Hop> = Vec::new();
        for from in (0..at.len()).filter(|from| types[*from] == types[i]) {
            let start = place(vectors, at[from]);
            for operation in &self.group {
                let end = crate::geometry::vector::add(start, times(operation, r));
                let Some((to, shift)) = atom_at(vectors, at, end, NEAR) else { continue };
                let hop = Hop { atoms: [from, to], shift };
                if types[to] == types[j] && !hops.contains(&hop) {
                    hops.push(hop);
                }
            }
        }
        hops
    }
}

/// Site, chemical type, moment in μ_B, direction.
fn moments(cell: &Cell, text: &Text) -> Result<Vec<Atom>> {
    let count = cell.at.len();
    let mut all: Vec<Option<f64>> = vec![None; count];
    for line in &text.lines(&['#', '!'], &[',']) {
        let site = line.index(0, "site", 1, count)?;
        let moment = line.number(2, "moment")?;
        if moment < 0.0 {
            return Err(line.error(2, "moment", format!("found {moment}, but a moment has a size and a direction")));
        }
        all[site] = Some(moment);
    }
    let atom = |k: usize| {
        let missing = || text.ends(format!("there is no moment of site {} in it", k + 1));
        let moment_mub = all[k].ok_or_else(missing)?;
        Ok(Atom { at: cell.at[k], species: format!("type_{}", cell.types[k]), moment_mub, anisotropies: Vec::new() })
    };
    (0..count).map(atom).collect()
}

/// Site, kind (1 uniaxial, 2 cubic), K₁, K₂, axis; mRy.
fn anisotropies(text: &Text, atoms: &mut [Atom], told: Told) -> Result<()> {
    for line in &text.lines(&['#', '!'], &[',']) {
        let site = line.index(0, "site", 1, atoms.len())?;
        let (kind, k1, k2) = (line.whole(1, "kind")?, line.number(2, "K1")?, line.number(3, "K2")?);
        if kind == 0 || (k1 == 0.0 && k2 == 0.0) {
            continue;
        }
        let cubic = match kind {
            1 => false,
            2 => true,
            _ => {
                let message = format!("found {kind}, but uniaxial (1) and cubic (2) anisotropy are imported");
                return Err(line.error(1, "kind", message));
            }
        };
        if k2 != 0.0 {
            let message = if cubic { NO_CUBIC_K2 } else { NO_K2 };
            return Err(line.error(3, "K2", message));
        }
        if cubic {
            let sign = told.cubic.ok_or_else(|| line.error(1, "kind", SIGN_OF_CUBIC))?;
            atoms[site].anisotropies.push(Anisotropy::Cubic { k: sign * MRY * k1 });
            continue;
        }
        let axis = Direction::new(line.vector(4, "axis")?).map_err(|e| line.error(4, "axis", e.to_string()))?;
        atoms[site].anisotropies.push(Anisotropy::Uniaxial { k: -MRY * k1, axis });
    }
    Ok(())
}
