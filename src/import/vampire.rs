//! VAMPIRE: a unit cell file (`.ucf`), a material file (`.mat`), and the input file that names both.
//!
//! ```text
//! H = − Σ_{i<j} S_i·J_ij S_j − Σ k_u (S·e)² − Σ k_c/2 Σ_c S_c⁴ − Σ μ S·B          J a link, each link in both directions in the file
//! ```
//! The field on a spin is Σ_j J_ij S_j over the links listed from it, so that a link counts once though it is listed twice: each listing
//! is half of it. −k_c/2 Σ S_c⁴ is k_c (α₁²α₂² + α₂²α₃² + α₃²α₁²), but for a constant. Exchange in the file is in J (types `isotropic`,
//! `vectorial`, `tensorial`, or 0, 1, 2), or a multiple of the material file's `exchange-matrix` (`normalised-isotropic`).
//!
//! Sources: the manual, <https://github.com/richard-evans/vampire/tree/release/manual>; the program, `src/unitcell/read.cpp`,
//! `read_interactions.cpp`, `src/exchange/exchange_fields.cpp`, `src/anisotropy`, `src/create/create.cpp`; Evans et al.,
//! <https://doi.org/10.1088/0953-8984/26/10/103202>.

use super::bonds::{Bond, Listed, matrix, merge};
use super::keywords::{Energies, Unread, not_read, refuse};
use super::text::{Line, Text};
use super::told::{Told, in_words};
use super::{Anisotropy, Atom, Format, Model, beside, found};
use crate::energy::{Convention, Counting, DmiForm, EnergyForm};
use crate::error::{Error, Result};
use crate::geometry::matrix::Matrix;
use crate::geometry::{Direction, Vector, vector};
use crate::lattice::Hop;
use crate::units::{Energy, FluxDensity, Length, Moment};
use std::collections::BTreeMap;
use std::path::PathBuf;

pub const FORMAT: Format = Format {
    name: "vampire",
    summary: "the input file, or its folder, with the .ucf and .mat that it names; or a .ucf and a .mat",
    read,
};

/// Words of what sets an energy.
const ENERGIES: Energies = Energies {
    set: &[
        "anisotropy",
        "exchange",
        "dmi",
        "constant",
        "coupling",
        "triaxial",
        "field*",
        "demag*",
        "dipole",
        "fmr",
        "alloy",
        "magnetic",
        "material:density",
        "material:intermixing",
    ],
    // what is computed and printed, how far and how often; fields of a program are of its protocol
    none: &[
        "damping",
        "diffusion",
        "output",
        "screen",
        "config",
        "roughness",
        "cutoff",
        "update",
        "seed",
        "program",
        "minimum",
        "maximum",
        "equilibration",
        "increment",
        "phonon",
        "sink",
    ],
    read: &[],
};

/// A setting `part:key = value !unit`, or `material[1]:key[2] = value`.
struct Setting<'a> {
    line: Line<'a>,
    part: &'a str,
    index: Option<usize>,
    key: String,
    other: Option<usize>,
    value: Option<&'a str>,
    unit: Option<&'a str>,
}

/// A material; its number is its place.
#[derive(Clone, Default)]
struct Material {
    name: Option<String>,
    moment_mub: Option<f64>,
    k: f64,
    axis: Option<Direction>,
    cubic: f64,
    exchange: BTreeMap<usize, f64>,
}

fn read(paths: &[PathBuf], told: Told) -> Result<Model> {
    let mut files = Files::default();
    for path in paths {
        files.add(&found(path, &["input"]))?;
    }
    let missing =
        |what: &str| Error::invalid("PATH", format!("no {what} is named: give the input file, or a .ucf and a .mat"));
    let ucf = files.ucf.as_ref().ok_or_else(|| missing("unit cell file (.ucf)"))?;
    let mat = files.mat.as_ref().ok_or_else(|| missing("material file (.mat)"))?;
    let own = Convention { counting: Counting::BothDirections, energy: EnergyForm::MinusHalf, dmi: DmiForm::Plus };
    if told.dmi.is_some() {
        let message = "the files have no D of its own, but tensors: give what stands in front of J alone";
        return Err(Error::invalid("--convention", message));
    }
    told.no_cubic()?;
    let convention = told.over(own);
    let (materials, mut notes) = materials(mat)?;
    let cell = Cell::read(ucf, &materials, convention)?;
    let [formula, factors] = in_words(convention, false);
    let mut model = Model {
        code: "VAMPIRE",
        files: [files.input.as_ref(), Some(ucf), Some(mat)]
            .into_iter()
            .flatten()
            .map(|text| text.file.clone())
            .collect(),
        vectors: cell.vectors,
        spacing_nm: None,
        atoms: cell.atoms,
        bonds: cell.bonds,
        field_t: [0.0; 3],
        cells: None,
        periodic: None,
        convention: vec![
            formula,
            format!("{factors}; J (joules) a link; unit vectors; k_u (S·e)² is written with k_u"),
        ],
        notes: Vec::new(),
    };
    if let Some(input) = &files.input {
        notes.extend(surroundings(input, &mut model)?);
    }
    model.notes = notes;
    model.scaled_to_first(1.0).checked(ucf.file.as_ref())
}

/// The files, by what they are.
#[derive(Default)]
struct Files {
    input: Option<Text>,
    ucf: Option<Text>,
    mat: Option<Text>,
}

impl Files {
    fn add(&mut self, path: &std::path::Path) -> Result<()> {
        let ending = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
        match ending.as_str() {
            "ucf" => self.ucf = Some(Text::read(path)?),
            "mat" => self.mat = Some(Text::read(path)?),
            _ => {
                let text = Text::read(path)?;
                for setting in settings(&text)?.iter().filter(|s| s.part == "material" && s.index.is_none()) {
                    let slot = match setting.key.as_str() {
                        "file" => &mut self.mat,
                        "unit-cell-file" => &mut self.ucf,
                        _ => continue,
                    };
                    let named = setting.value()?;
                    let failed = |e: Error| setting.error(format!("the file cannot be read: {e}"));
                    *slot = Some(Text::read(&beside(path, named)).map_err(failed)?);
                }
                self.input = Some(text);
            }
        }
        Ok(())
    }
}

/// All settings of an input or material file.
fn settings(text: &Text) -> Result<Vec<Setting<'_>>> {
    let whole: Vec<&str> = text.text.lines().collect();
    text.lines(&['#'], &[]).into_iter().map(|line| Setting::read(whole[line.number - 1], line)).collect()
}

impl<'a> Setting<'a> {
    fn read(whole: &'a str, line: Line<'a>) -> Result<Setting<'a>> {
        let whole = whole.split('#').next().unwrap_or_default();
        let (name, rest) = whole.split_once('=').map_or((whole, None), |(name, rest)| (name, Some(rest)));
        let wrong = || {
            line.error(
                0,
                ".",
                format!("found {:?}, expected a setting such as create:full or material[1]:key=value", name.trim()),
            )
        };
        let (part, key) = name.split_once(':').ok_or_else(wrong)?;
        let (part, index) = indexed(part.trim()).ok_or_else(wrong)?;
        let (key, other) = indexed(key.trim()).ok_or_else(wrong)?;
        let (value, unit) = rest.map_or((None, None), |rest| match rest.split_once('!') {
            Some((value, unit)) => (Some(value.trim()), Some(unit.trim())),
            None => (Some(rest.trim()), None),
        });
        let key = key.to_ascii_lowercase();
        Ok(Setting { part, index, key, other, value, unit, line })
    }

    fn error(&self, message: impl Into<String>) -> Error {
        self.line.error(0, &self.key, message)
    }

    fn value(&self) -> Result<&'a str> {
        self.value.filter(|value| !value.is_empty()).ok_or_else(|| self.error("the value is missing: key = value"))
    }

    /// The value with its unit; `otherwise` where there is none.
    fn quantity<Q: std::str::FromStr<Err = Error>>(&self, otherwise: &str) -> Result<Q> {
        let unit = match self.unit.unwrap_or(otherwise) {
            "J/T" => "A m^2",
            // J/atom, J/link
            other => other.split('/').next().unwrap_or_default().trim(),
        };
        let unit = match unit {
            "muB" | "mu_B" => "mu_B",
            "A" | "Angstrom" | "Angstroms" => "angstrom",
            other => other,
        };
        format!("{} {unit}", self.value()?).parse().map_err(|e: Error| self.error(e.to_string()))
    }

    /// An angle in degrees, as sine and cosine.
    fn angle(&self) -> Result<(f64, f64)> {
        if let Some(unit) = self.unit {
            return Err(self.error(format!("found \"!{unit}\", but angles are in degrees, without a unit")));
        }
        let value = self.value()?;
        let degrees = value.parse().ok().filter(|x: &f64| x.is_finite());
        let (sin, cos) =
            degrees.ok_or_else(|| self.error(format!("found {value:?}, expected degrees")))?.to_radians().sin_cos();
        // of right angles rounding leaves something
        let clean = |x: f64| if x.abs() < 1e-15 { 0.0 } else { x };
        Ok((clean(sin), clean(cos)))
    }

    /// What is told of it, where it is not read.
    fn unread(self) -> Unread<'a> {
        let (name, value) = (format!("{}:{}", self.part, self.key), self.value.unwrap_or_default().into());
        Unread { name, value, line: self.line }
    }

    fn vector(&self) -> Result<Vector> {
        let value = self.value()?.trim_matches(['[', ']', '(', ')', '"']);
        let parts: Vec<Option<f64>> =
            value.split(',').map(|x| x.trim().parse().ok().filter(|x: &f64| x.is_finite())).collect();
        match parts[..] {
            [Some(x), Some(y), Some(z)] => Ok([x, y, z]),
            _ => Err(self.error(format!("found {value:?}, expected three numbers with commas between: 0,0,1"))),
        }
    }
}

/// "material[2]" → ("material", 1).
fn indexed(word: &str) -> Option<(&str, Option<usize>)> {
    let Some((name, rest)) = word.split_once('[') else { return Some((word, None)) };
    let number: usize = rest.split_once(']')?.0.trim().parse().ok()?;
    Some((name.trim(), Some(number.checked_sub(1)?)))
}

/// The materials of a file, and what is not read of it.
fn materials(text: &Text) -> Result<(Vec<Material>, Vec<String>)> {
    let (mut all, mut unread): (Vec<Material>, Vec<Unread>) = (Vec::new(), Vec::new());
    for setting in settings(text)? {
        let read = match (setting.part, setting.index) {
            ("material", Some(index)) if index >= 1000 => {
                return Err(setting.error(format!("found material {}, more than there can be", index + 1)));
            }
            ("material", Some(index)) => {
                all.resize(all.len().max(index + 1), Material::default());
                all[index].set(&setting)?
            }
            (part, _) => part == "material" && setting.key == "num-materials",
        };
        if !read {
            unread.push(setting.unread());
        }
    }
    refuse(&unread, &ENERGIES)?;
    Ok((all, not_read(text, &unread).into_iter().collect()))
}

impl Material {
    /// Takes a setting; false if it is none that is imported.
    fn set(&mut self, setting: &Setting) -> Result<bool> {
        match setting.key.as_str() {
            "material-name" => self.name = Some(setting.value()?.trim_matches('"').replace([' ', '\t'], "_")),
            "atomic-spin-moment" => {
                setting.unit.ok_or_else(|| setting.error("a moment needs its unit behind it: !muB"))?;
                self.moment_mub = Some(setting.quantity::<Moment>("")?.0);
            }
            "uniaxial-anisotropy-constant" | "second-order-uniaxial-anisotropy-constant" => {
                self.k = setting.quantity::<Energy>("J")?.0;
            }
            "uniaxial-anisotropy-direction" => {
                let axis = Direction::new(setting.vector()?).map_err(|e| setting.error(e.to_string()))?;
                self.axis = Some(axis);
            }
            "cubic-anisotropy-constant" | "fourth-order-cubic-anisotropy-constant" => {
                self.cubic = setting.quantity::<Energy>("J")?.0;
            }
            "exchange-matrix" | "exchange-matrix-1st-nn" | "exchange-matrix-1st-nearest-neighbours" => {
                let other =
                    setting.other.ok_or_else(|| setting.error("with which material? exchange-matrix[1] = …"))?;
                self.exchange.insert(other, setting.quantity::<Energy>("J")?.0);
            }
            _ => return Ok(false),
        }
        Ok(true)
    }
}

/// The unit cell.
struct Cell {
    vectors: Matrix,
    atoms: Vec<Atom>,
    bonds: Vec<Bond>,
}

impl Cell {
    fn read(text: &Text, materials: &[Material], convention: Convention) -> Result<Cell> {
        let lines = text.lines(&['#'], &[',']);
        let line = |k: usize, what: &str| lines.get(k).ok_or_else(|| text.ends(format!("the {what} is missing")));
        let size = line(0, "size of the unit cell")?.vector(0, "size")?;
        if size.iter().any(|x| *x <= 0.0) {
            return Err(lines[0].error(0, "size", "the size of the unit cell is positive, in Å"));
        }
        let rows = [0, 1, 2]
            .map(|k| line(1 + k, "shape of the unit cell")?.vector(0, "shape").map(|v| vector::scale(size[k], v)));
        let [a, b, c] = rows;
        let vectors = [a?, b?, c?];
        let count = line(4, "number of atoms")?.index(0, "number of atoms", 1, lines.len())? + 1;
        let (mut atoms, mut numbers) = (Vec::new(), Vec::new());
        for k in 0..count {
            let (atom, material) = atom(line(5 + k, "list of atoms")?, k, count, materials)?;
            atoms.push(atom);
            numbers.push(material);
        }
        let head = line(5 + count, "number of interactions")?;
        let links = head.index(0, "number of interactions", 0, lines.len() + 1)?;
        let columns = Columns::read(head)?;
        let mut listed = Vec::new();
        for k in 0..links {
            let line = line(6 + count + k, &format!("interaction {k} of {links}"))?;
            let hop = Hop {
                atoms: [line.index(1, "i", 0, count)?, line.index(2, "j", 0, count)?],
                shift: line.shift(3, "cell")?,
            };
            let tensor = columns.tensor(line, hop.atoms.map(|atom| numbers[atom]), materials)?;
            let matrix = matrix(convention, 0.0, [0.0; 3], Some(&tensor));
            listed.push(Listed { hop, matrix, line: line.number });
        }
        if let Some(rest) = lines.get(6 + count + links).filter(|line| line.first() != "0") {
            let message = "found more than the interactions announced; biquadratic ones are not imported";
            return Err(rest.error(0, "interactions", message));
        }
        Ok(Cell { vectors, atoms, bonds: merge(text, &listed, convention.counting, 0.0)? })
    }
}

/// Id, place, material.
fn atom(line: &Line, k: usize, count: usize, materials: &[Material]) -> Result<(Atom, usize)> {
    if line.index(0, "atom", 0, count)? != k {
        return Err(line.error(
            0,
            "atom",
            format!("found atom {}, expected {k}: atoms are numbered in order", line.first()),
        ));
    }
    let at = line.vector(1, "place")?;
    let number = if line.count() > 4 { line.index(4, "material", 0, materials.len().max(1))? } else { 0 };
    let material = materials.get(number).cloned().unwrap_or_default();
    let missing = || {
        line.error(4, "material", format!("material[{}] has no atomic-spin-moment in the material file", number + 1))
    };
    let moment_mub = material.moment_mub.ok_or_else(missing)?;
    let mut anisotropies = Vec::new();
    if material.k != 0.0 {
        anisotropies.push(Anisotropy::Uniaxial { k: material.k, axis: material.axis.unwrap_or(Direction::Z) });
    }
    if material.cubic != 0.0 {
        anisotropies.push(Anisotropy::Cubic { k: material.cubic });
    }
    let species = material.name.unwrap_or_else(|| format!("material_{}", number + 1));
    Ok((Atom { at, species, moment_mub, anisotropies }, number))
}

/// What stands behind the cell of an interaction.
enum Columns {
    One { normalised: bool },
    Three,
    Nine,
}

impl Columns {
    fn read(head: &Line) -> Result<Columns> {
        match head.word(1, "exchange type")? {
            "isotropic" | "0" => Ok(Columns::One { normalised: false }),
            "normalised-isotropic" | "normalized-isotropic" => Ok(Columns::One { normalised: true }),
            "vectorial" | "1" => Ok(Columns::Three),
            "tensorial" | "2" => Ok(Columns::Nine),
            other => {
                let message =
                    format!("found {other:?}, expected isotropic, vectorial, tensorial or normalised-isotropic");
                Err(head.error(1, "exchange type", message))
            }
        }
    }

    fn tensor(&self, line: &Line, numbers: [usize; 2], materials: &[Material]) -> Result<Matrix> {
        let joule = |k: usize, what: &str| {
            line.number(k, what)?;
            let word = line.word(k, what)?;
            // by way of the text: powers of ten are exact so
            let energy: Energy = format!("{word} J").parse().map_err(|e: Error| line.error(k, what, e.to_string()))?;
            Ok::<f64, Error>(energy.0)
        };
        let diagonal = |[x, y, z]: Vector| [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]];
        match self {
            Columns::One { normalised: false } => joule(6, "J").map(|j| diagonal([j; 3])),
            Columns::One { normalised: true } => {
                let of = materials.get(numbers[0]).and_then(|material| material.exchange.get(&numbers[1]));
                let missing = || {
                    let [a, b] = numbers.map(|n| n + 1);
                    line.error(
                        6,
                        "J",
                        format!("the material file has no material[{a}]:exchange-matrix[{b}] to multiply it with"),
                    )
                };
                Ok(diagonal([line.number(6, "J")? * of.ok_or_else(missing)?; 3]))
            }
            Columns::Three => Ok(diagonal([joule(6, "Jx")?, joule(7, "Jy")?, joule(8, "Jz")?])),
            Columns::Nine => {
                let row = |k: usize| Ok::<_, Error>([joule(k, "J")?, joule(k + 1, "J")?, joule(k + 2, "J")?]);
                Ok([row(6)?, row(9)?, row(12)?])
            }
        }
    }
}

/// The field of an input file. Its direction is what is said last, a vector or two angles: θ is the azimuth and φ the polar angle
/// in the program (`initialise_variables.cpp`), of which the manual says nothing.
struct Field {
    strength: f64,
    along: Vector,
    by_angles: bool,
    /// Sine and cosine.
    theta: (f64, f64),
    phi: (f64, f64),
}

impl Field {
    const NONE: Field =
        Field { strength: 0.0, along: [0.0, 0.0, 1.0], by_angles: false, theta: (0.0, 1.0), phi: (0.0, 1.0) };

    /// Takes a setting of the part `sim`; false if it is none of the field.
    fn set(&mut self, setting: &Setting) -> Result<bool> {
        match setting.key.as_str() {
            "applied-field-strength" => self.strength = setting.quantity::<FluxDensity>("T")?.0,
            "applied-field-unit-vector" => {
                let v = setting.vector()?;
                self.along =
                    vector::unit(v).ok_or_else(|| setting.error("found no direction: all components are 0"))?;
                self.by_angles = false;
            }
            "applied-field-angle-theta" => (self.theta, self.by_angles) = (setting.angle()?, true),
            "applied-field-angle-phi" => (self.phi, self.by_angles) = (setting.angle()?, true),
            _ => return Ok(false),
        }
        Ok(true)
    }

    fn vector(&self) -> Vector {
        let (theta, phi) = (self.theta, self.phi);
        let along = if self.by_angles { [phi.0 * theta.1, phi.0 * theta.0, phi.1] } else { self.along };
        if self.strength == 0.0 { [0.0; 3] } else { vector::scale(self.strength, along) }
    }
}

/// Takes size, boundaries and field of the input file; what is not read of it.
fn surroundings(text: &Text, model: &mut Model) -> Result<Option<String>> {
    let (mut size, mut periodic, mut field) = ([None; 3], [false; 3], Field::NONE);
    let mut unread = Vec::new();
    for setting in settings(text)? {
        let last = setting.key.rsplit('-').next().and_then(|d| ["x", "y", "z"].iter().position(|own| *own == d));
        match (setting.part, setting.key.as_str(), last) {
            ("dimensions", "system-size", _) => size = [Some(setting.quantity::<Length>("angstrom")?.0); 3],
            ("dimensions", "system-size-x" | "system-size-y" | "system-size-z", Some(d)) => {
                size[d] = Some(setting.quantity::<Length>("angstrom")?.0);
            }
            ("create", key, Some(d)) if key.starts_with("periodic-boundaries") => periodic[d] = true,
            ("create", "periodic-boundaries", _) => {
                let named = setting.value.filter(|value| !value.is_empty()).unwrap_or("xyz");
                ["x", "y", "z"].iter().zip(&mut periodic).for_each(|(d, flag)| *flag |= named.contains(d));
            }
            ("create", "full", _) | ("material", "file" | "unit-cell-file", _) => {}
            ("sim", _, _) if field.set(&setting)? => {}
            _ => unread.push(setting.unread()),
        }
    }
    model.cells = cells(size, &model.vectors)?.or(model.cells);
    (model.periodic, model.field_t) = (Some(periodic), field.vector());
    refuse(&unread, &ENERGIES)?;
    Ok(not_read(text, &unread))
}

/// As many cells as the size (nm) holds in whole or in part, as in the program.
fn cells(size: [Option<f64>; 3], vectors: &Matrix) -> Result<Option<[usize; 3]>> {
    let [Some(x), Some(y), Some(z)] = size else { return Ok(None) };
    let mut cells = [0; 3];
    for (d, nm) in [x, y, z].into_iter().enumerate() {
        let count = (10.0 * nm / vector::norm(vectors[d]) - 1e-9).ceil();
        if !(1.0..1e7).contains(&count) {
            return Err(Error::invalid("dimensions:system-size", format!("found {nm} nm, which is {count} cells")));
        }
        cells[d] = count as usize;
    }
    Ok(Some(cells))
}
