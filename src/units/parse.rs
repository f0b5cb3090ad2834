//! From `"13 pJ/m"` to a number.
//!
//! A unit is a product of symbols with integer powers: `J/m^2`, `J/m²`, `A m^2`, `A·m²`, `J m^-3`. Its size is kept as
//! (power of ten) × (powers of the constants in it), so that converting to a unit with the same constants is exact, and
//! the power of ten goes into the decimal number before that is rounded once to double precision.

use crate::error::{Error, Result};
use crate::words::{nearest, quoted};
use std::f64::consts::PI;

/// Powers of J, m, A, K, s and rad.
pub(super) type Dimension = [i32; 6];

const ENERGY_J: Dimension = [1, 0, 0, 0, 0, 0];
const MOMENT_A_M2: Dimension = [0, 2, 1, 0, 0, 0];
const FLUX_T: Dimension = [1, -2, -1, 0, 0, 0];
const STIFFNESS_J_M: Dimension = [1, -1, 0, 0, 0, 0];
const SURFACE_J_M2: Dimension = [1, -2, 0, 0, 0, 0];
const DENSITY_J_M3: Dimension = [1, -3, 0, 0, 0, 0];
const FIELD_A_M: Dimension = [0, -1, 1, 0, 0, 0];
const LENGTH_M: Dimension = [0, 1, 0, 0, 0, 0];
const CURRENT_A: Dimension = [0, 0, 1, 0, 0, 0];
const TEMPERATURE_K: Dimension = [0, 0, 0, 1, 0, 0];
const TIME_S: Dimension = [0, 0, 0, 0, 1, 0];
const ANGLE_RAD: Dimension = [0, 0, 0, 0, 0, 1];

/// What a unit of each dimension measures.
const MEASURES: &[(Dimension, &str)] = &[
    (ENERGY_J, "an energy"),
    (MOMENT_A_M2, "a magnetic moment"),
    (FLUX_T, "a magnetic field"),
    (STIFFNESS_J_M, "an exchange stiffness"),
    (SURFACE_J_M2, "an energy per area"),
    (DENSITY_J_M3, "an energy per volume"),
    (FIELD_A_M, "a magnetisation (or a field H)"),
    (LENGTH_M, "a length"),
    ([0, 2, 0, 0, 0, 0], "an area"),
    ([0, 3, 0, 0, 0, 0], "a volume"),
    (CURRENT_A, "an electric current"),
    (TEMPERATURE_K, "a temperature"),
    (TIME_S, "a time"),
    (ANGLE_RAD, "an angle"),
];

/// The digits of the constants in units: e, Ry/eV, μ_B in eV/T, π, 180, μ₀; the last one only marks that emu is in it.
const CONSTANTS: [f64; 7] = [1.602176634, 13.605693122990, 5.7883817982, PI, 180.0, 1.25663706127, 1.0];
const MU_0: usize = 5;
const EMU: usize = 6;

/// A unit: 10^ten · Π constants^power in SI.
#[derive(Clone, Copy, Debug)]
pub(super) struct Unit {
    pub(super) dimension: Dimension,
    constants: [i32; 7],
    ten: i32,
}

const fn unit(dimension: Dimension, constants: [i32; 7], ten: i32) -> Unit {
    Unit { dimension, constants, ten }
}

const PLAIN: [i32; 7] = [0; 7];

/// A unit's symbol, its other spellings, and the prefixes it takes.
pub(super) struct Symbol {
    pub(super) names: &'static [&'static str],
    pub(super) prefixes: &'static str,
    pub(super) unit: Unit,
}

const fn symbol(names: &'static [&'static str], prefixes: &'static str, unit: Unit) -> Symbol {
    Symbol { names, prefixes, unit }
}

/// Prefixes from the likeliest to the least: the order in which a misspelt one is guessed.
const ALL: &str = "mkunpfMGTaz";
/// Those of energies of atoms: an M would be a slip for m.
const OF_ATOMS: &str = "mkunpfaz";

pub(super) const SYMBOLS: &[Symbol] = &[
    symbol(&["eV"], OF_ATOMS, unit(ENERGY_J, [1, 0, 0, 0, 0, 0, 0], -19)),
    symbol(&["J"], ALL, unit(ENERGY_J, PLAIN, 0)),
    symbol(&["Ry"], OF_ATOMS, unit(ENERGY_J, [1, 1, 0, 0, 0, 0, 0], -19)),
    symbol(&["erg"], ALL, unit(ENERGY_J, PLAIN, -7)),
    symbol(&["mu_B", "muB", "u_B", "uB"], "mkun", unit(MOMENT_A_M2, [1, 0, 1, 0, 0, 0, 0], -24)),
    symbol(&["emu"], ALL, unit(MOMENT_A_M2, [0, 0, 0, 0, 0, 0, 1], -3)),
    symbol(&["T"], ALL, unit(FLUX_T, PLAIN, 0)),
    // In vacuum B = H in Gaussian units, so 1 Oe stands for 1 G, exactly.
    symbol(&["Oe"], ALL, unit(FLUX_T, PLAIN, -4)),
    symbol(&["G"], ALL, unit(FLUX_T, PLAIN, -4)),
    symbol(&["A"], ALL, unit(CURRENT_A, PLAIN, 0)),
    symbol(&["m"], "ncumpfk", unit(LENGTH_M, PLAIN, 0)),
    symbol(&["angstrom", "Angstrom", "Å"], "", unit(LENGTH_M, PLAIN, -10)),
    symbol(&["cc"], "", unit([0, 3, 0, 0, 0, 0], PLAIN, -6)),
    symbol(&["K"], "mkun", unit(TEMPERATURE_K, PLAIN, 0)),
    symbol(&["s"], "mpnufa", unit(TIME_S, PLAIN, 0)),
    symbol(&["deg", "°"], "mu", unit(ANGLE_RAD, [0, 0, 0, 1, -1, 0, 0], 0)),
    symbol(&["rad"], "mun", unit(ANGLE_RAD, PLAIN, 0)),
];

/// Names people write out, with the symbol to use.
const WORDS: &[(&str, &str)] = &[
    ("joule", "J"),
    ("rydberg", "Ry"),
    ("electronvolt", "eV"),
    ("tesla", "T"),
    ("gauss", "G"),
    ("gs", "G"),
    ("oersted", "Oe"),
    ("meter", "m"),
    ("metre", "m"),
    ("ang", "angstrom"),
    ("kelvin", "K"),
    ("sec", "s"),
    ("second", "s"),
    ("degree", "deg"),
    ("degrees", "deg"),
    ("radian", "rad"),
    ("radians", "rad"),
    ("micron", "um"),
];

/// Things that are counted; an energy "per bond" is an energy.
const COUNTED: &[&str] = &["atom", "atoms", "site", "bond", "link", "spin", "cell", "pair", "f.u."];

/// Numbers below this are of no use in the units that this field takes.
const TINY: f64 = 1e-6;

/// One kind of quantity: the unit it is written in and, for each dimension it may have, the unit it is converted to.
#[derive(Debug)]
pub(super) struct Kind {
    pub(super) unit: &'static str,
    /// What a number that is tiny in that unit is likely to be in.
    si: &'static str,
    targets: &'static [Unit],
}

/// What a place in a config wants: one kind, or the first that fits of several.
#[derive(Debug)]
pub(super) struct Wanted {
    pub(super) name: &'static str,
    pub(super) units: &'static str,
    pub(super) example: &'static str,
    pub(super) kinds: &'static [Kind],
}

const MEV: Kind = Kind { unit: "meV", si: "J", targets: &[unit(ENERGY_J, [1, 0, 0, 0, 0, 0, 0], -22)] };
const J_M2: Kind = Kind { unit: "J/m^2", si: "J/m^2", targets: &[unit(SURFACE_J_M2, PLAIN, 0)] };
const J_M3: Kind = Kind { unit: "J/m^3", si: "J/m^3", targets: &[unit(DENSITY_J_M3, PLAIN, 0)] };

pub(super) static ENERGY: Wanted =
    Wanted { name: "an energy", units: "J, eV, Ry or erg, with SI prefixes", example: "10 meV", kinds: &[MEV] };
pub(super) static MOMENT: Wanted = Wanted {
    name: "a magnetic moment",
    units: "mu_B or A m^2, with SI prefixes",
    example: "2 mu_B",
    kinds: &[Kind { unit: "mu_B", si: "A m^2", targets: &[unit(MOMENT_A_M2, [1, 0, 1, 0, 0, 0, 0], -24)] }],
};
pub(super) static FLUX_DENSITY: Wanted = Wanted {
    name: "a magnetic field",
    units: "T, Oe, G or A/m, with SI prefixes",
    example: "50 mT",
    kinds: &[Kind {
        unit: "T",
        si: "T",
        targets: &[unit(FLUX_T, PLAIN, 0), unit(FIELD_A_M, [0, 0, 0, 0, 0, -1, 0], 6)],
    }],
};
pub(super) static EXCHANGE_STIFFNESS: Wanted = Wanted {
    name: "an exchange stiffness",
    units: "J/m or erg/cm, with SI prefixes",
    example: "13 pJ/m",
    kinds: &[Kind { unit: "J/m", si: "J/m", targets: &[unit(STIFFNESS_J_M, PLAIN, 0)] }],
};
pub(super) static SURFACE_ENERGY: Wanted = Wanted {
    name: "an energy per area",
    units: "J/m^2 or erg/cm^2, with SI prefixes",
    example: "3 mJ/m^2",
    kinds: &[J_M2],
};
pub(super) static ENERGY_DENSITY: Wanted = Wanted {
    name: "an energy per volume",
    units: "J/m^3 or erg/cm^3, with SI prefixes",
    example: "500 kJ/m^3",
    kinds: &[J_M3],
};
pub(super) static MAGNETISATION: Wanted = Wanted {
    name: "a magnetisation",
    units: "A/m or emu/cm^3, with SI prefixes",
    example: "800 kA/m",
    kinds: &[Kind { unit: "A/m", si: "A/m", targets: &[unit(FIELD_A_M, PLAIN, 0)] }],
};
pub(super) static LENGTH: Wanted = Wanted {
    name: "a length",
    units: "m with SI prefixes, or angstrom",
    example: "0.25 nm",
    kinds: &[Kind { unit: "nm", si: "m", targets: &[unit(LENGTH_M, PLAIN, -9)] }],
};
pub(super) static TEMPERATURE: Wanted = Wanted {
    name: "a temperature",
    units: "K, with SI prefixes",
    example: "300 K",
    kinds: &[Kind { unit: "K", si: "K", targets: &[unit(TEMPERATURE_K, PLAIN, 0)] }],
};
pub(super) static TIME: Wanted = Wanted {
    name: "a time",
    units: "s, with SI prefixes",
    example: "1 ps",
    kinds: &[Kind { unit: "ps", si: "s", targets: &[unit(TIME_S, PLAIN, -12)] }],
};
pub(super) static ANGLE: Wanted = Wanted {
    name: "an angle",
    units: "deg or rad, with SI prefixes",
    example: "2 deg",
    kinds: &[
        // proposed too, and converted to the other
        Kind { unit: "deg", si: "deg", targets: &[] },
        Kind { unit: "rad", si: "rad", targets: &[unit(ANGLE_RAD, PLAIN, 0)] },
    ],
};
pub(super) static SITE_ENERGY: Wanted = Wanted {
    name: "an energy per site or per volume",
    units: "J, eV, Ry or erg for a site, J/m^3 or erg/cm^3 for a volume, with SI prefixes",
    example: "0.5 meV",
    kinds: &[MEV, J_M3],
};
pub(super) static BOND_ENERGY: Wanted = Wanted {
    name: "an energy per bond or per area",
    units: "J, eV, Ry or erg for a bond, J/m^2 or erg/cm^2 for an area, with SI prefixes",
    example: "0.5 meV",
    kinds: &[MEV, J_M2],
};

/// All of them.
pub(super) static WANTED: [&Wanted; 13] = [
    &ENERGY,
    &MOMENT,
    &FLUX_DENSITY,
    &EXCHANGE_STIFFNESS,
    &SURFACE_ENERGY,
    &ENERGY_DENSITY,
    &MAGNETISATION,
    &LENGTH,
    &TEMPERATURE,
    &TIME,
    &ANGLE,
    &SITE_ENERGY,
    &BOND_ENERGY,
];

/// A quantity of whatever kind.
static ANY: Wanted = Wanted {
    name: "a quantity",
    units: "units of energy, moment, field, stiffness, magnetisation, length, temperature, time or angle, with SI prefixes",
    example: "0.5 meV",
    kinds: &[],
};

/// The number of a quantity of any kind and its unit as written.
pub(super) fn any(text: &str) -> Result<(f64, &str)> {
    let wrong = |message| Error::invalid("", message);
    let (number, unit) = split_any(text).map_err(wrong)?;
    Ok((number.convert(&unit, &unit, text).map_err(wrong)?, number.unit.trim_end()))
}

/// The number of a quantity in the unit that another one is written in.
pub(super) fn any_as(text: &str, other: &str) -> Result<f64> {
    let wrong = |message| Error::invalid("", message);
    let (number, unit) = split_any(text).map_err(wrong)?;
    let (_, target) = split_any(other).map_err(wrong)?;
    if unit.dimension != target.dimension {
        let [is, wanted] = [&unit, &target].map(measure);
        return Err(wrong(format!("{} is {is}, but {} is {wanted}", quoted(text), quoted(other))));
    }
    number.convert(&unit, &target, text).map_err(wrong)
}

fn split_any(text: &str) -> std::result::Result<(Number<'_>, Unit), String> {
    let number = Number::split(text, &ANY)?;
    if number.unit.is_empty() {
        return Err(format!("{} has no unit", quoted(text)));
    }
    let unit = ANY.unit(number.unit, text)?;
    Ok((number, unit))
}

/// What a unit measures, in words.
fn measure(unit: &Unit) -> &'static str {
    let measure = MEASURES.iter().find(|(dimension, _)| *dimension == unit.dimension);
    measure.map_or("of a kind that is not used here", |(_, name)| name)
}

impl Wanted {
    /// The value in the unit of the kind that fits, and which kind that is.
    pub(super) fn parse(&self, text: &str) -> Result<(f64, usize)> {
        self.try_parse(text).map_err(|message| Error::invalid("", message))
    }

    /// The dimensions that fit, and whether each is that of a field H, which has no unit with emu.
    pub(super) fn targets(&self) -> Vec<(Dimension, bool)> {
        let targets = self.kinds.iter().flat_map(|kind| kind.targets);
        targets.map(|target| (target.dimension, target.constants[MU_0] != 0)).collect()
    }

    /// A message about a number without a unit: how it could be written with one.
    pub(super) fn bare(&self, found: &str, digits: &str) -> String {
        let is_tiny = digits.parse().is_ok_and(|number: f64| number != 0.0 && number.abs() < TINY);
        let unit = |kind: &Kind| if is_tiny { kind.si } else { kind.unit };
        let ways: Vec<String> = self.kinds.iter().map(|kind| format!("\"{digits} {}\"", unit(kind))).collect();
        format!("{found}: write {} ({})", ways.join(" or "), self.units)
    }

    fn try_parse(&self, text: &str) -> std::result::Result<(f64, usize), String> {
        let number = Number::split(text, self)?;
        if number.unit.is_empty() {
            let digits = text.trim();
            return Err(self.bare(&format!("{} has no unit, but {} needs one", quoted(text), self.name), digits));
        }
        let unit = self.unit(number.unit, text)?;
        let fits = |target: &Unit| {
            // emu is a unit of the moment: emu/cm^3 never means a field H.
            target.dimension == unit.dimension && (target.constants[MU_0] == 0 || unit.constants[EMU] == 0)
        };
        for (i, kind) in self.kinds.iter().enumerate() {
            if let Some(target) = kind.targets.iter().find(|target| fits(target)) {
                return Ok((number.convert(&unit, target, text)?, i));
            }
        }
        Err(self.wrong_dimension(&number, &unit, text))
    }

    fn wrong_dimension(&self, number: &Number, unit: &Unit, text: &str) -> String {
        let mut message =
            format!("{} is {}, but {} is wanted here: {}", quoted(text), measure(unit), self.name, self.units);
        if unit.dimension == CURRENT_A && std::ptr::eq(self, &LENGTH) {
            message.push_str(" (A is the ampere)");
        }
        if unit.dimension == FLUX_T && std::ptr::eq(self, &MAGNETISATION) {
            let per_mu_0 = Unit { ten: -6, constants: [0, 0, 0, 0, 0, 1, 0], ..*unit };
            if let Ok(value) = number.convert(unit, &per_mu_0, text) {
                message.push_str(&format!("; if it is μ₀M, write \"{value:.6e} A/m\""));
            }
        }
        message
    }

    /// The product of symbols that `unit` is.
    fn unit(&self, unit: &str, text: &str) -> std::result::Result<Unit, String> {
        let trouble =
            |what: String| format!("{what} in {}: {} is wanted here: {}", quoted(text), self.name, self.units);
        let mut total = Unit { dimension: [0; 6], constants: PLAIN, ten: 0 };
        let mut rest = unit;
        let mut divide = false;
        for factor in 0.. {
            if factor == 8 {
                return Err(trouble("too long a unit".into()));
            }
            let end = rest.find(|c: char| !(c.is_alphabetic() || c == '_' || c == '°')).unwrap_or(rest.len());
            let (name, tail) = rest.split_at(end);
            if name.is_empty() {
                let found = rest.chars().next().map_or("the end".to_string(), |c| quoted(&c.to_string()));
                return Err(trouble(format!("found {found} where a unit should be")));
            }
            let Some(known) = find(name) else { return Err(self.unknown(name, divide, text)) };
            let Some((power, tail)) = power(tail) else {
                return Err(trouble(format!("the power of {name} is not a whole number from -9 to 9")));
            };
            let power = if divide { -power } else { power };
            for (sum, x) in total.dimension.iter_mut().zip(known.dimension) {
                *sum += power * x;
            }
            for (sum, x) in total.constants.iter_mut().zip(known.constants) {
                *sum += power * x;
            }
            total.ten += power * known.ten;
            let multiplied = |c: char| c.is_whitespace() || matches!(c, '·' | '⋅' | '*');
            rest = tail.trim_start_matches(multiplied);
            divide = rest.starts_with('/');
            if divide {
                rest = rest[1..].trim_start();
            } else if rest.is_empty() {
                break;
            }
        }
        Ok(total)
    }

    fn unknown(&self, name: &str, divided: bool, text: &str) -> String {
        if divided && COUNTED.contains(&name) {
            return format!("leave out \"/{name}\" in {}: what is counted has no unit", quoted(text));
        }
        let start = match is_huge(name) {
            true => {
                let [name, text] = [name, text].map(quoted);
                format!("{name} in {text} is refused, since so large a unit is all but surely a slip")
            }
            false => format!("unknown unit {} in {}", quoted(name), quoted(text)),
        };
        match self.guess(name) {
            Some(guess) => format!("{start}: did you mean \"{guess}\"? ({})", self.units),
            None => format!("{start}: {} is wanted here: {}", self.name, self.units),
        }
    }

    /// The unit that was probably meant: the same letters in another case, a word for it, or the nearest that fits.
    fn guess(&self, name: &str) -> Option<String> {
        let name = ascii(name);
        let inside = |symbol: &&Symbol| self.kinds.iter().any(|kind| kind.unit.contains(symbol.names[0]));
        let listed = |symbol: &&Symbol| self.units.split([' ', ',', '/', '^']).any(|word| word == symbol.names[0]);
        let spellings = |symbol: &Symbol| -> Vec<String> {
            let prefixed = symbol.prefixes.chars().map(|prefix| format!("{prefix}{}", symbol.names[0]));
            std::iter::once(symbol.names[0].to_string()).chain(prefixed).collect()
        };
        let mut fitting: Vec<String> = SYMBOLS.iter().filter(inside).flat_map(spellings).collect();
        fitting.extend(SYMBOLS.iter().filter(listed).flat_map(spellings));
        let others = SYMBOLS.iter().flat_map(spellings);
        if let Some(same) = fitting.iter().cloned().chain(others).find(|other| other.eq_ignore_ascii_case(&name)) {
            return Some(same);
        }
        if let Some((_, symbol)) = WORDS.iter().find(|(word, _)| word.eq_ignore_ascii_case(&name)) {
            return Some(symbol.to_string());
        }
        // One letter of two is too much to guess.
        let long = name.chars().count() > 2;
        long.then(|| nearest(&name, fitting.iter().map(String::as_str)).map(str::to_string)).flatten()
    }
}

/// The symbol with every way to write µ as `u` and Å as one letter.
fn ascii(name: &str) -> String {
    name.chars()
        .map(|c| match c {
            'µ' | 'μ' => 'u',
            '\u{212B}' => 'Å',
            c => c,
        })
        .collect()
}

/// Whether it is a unit with a prefix by which it is too large for all that is asked for: M, where m is meant.
fn is_huge(name: &str) -> bool {
    let name = ascii(name);
    let symbol = name.strip_prefix(['M', 'G', 'T']);
    let is_word = WORDS.iter().any(|(word, _)| word.eq_ignore_ascii_case(&name));
    symbol.is_some_and(|rest| !is_word && SYMBOLS.iter().any(|s| !s.prefixes.is_empty() && s.names.contains(&rest)))
}

fn find(name: &str) -> Option<Unit> {
    let name = ascii(name);
    if let Some(symbol) = SYMBOLS.iter().find(|symbol| symbol.names.contains(&name.as_str())) {
        return Some(symbol.unit);
    }
    let prefix = name.chars().next()?;
    let rest = &name[prefix.len_utf8()..];
    let ten = match prefix {
        'z' => -21,
        'a' => -18,
        'f' => -15,
        'p' => -12,
        'n' => -9,
        'u' => -6,
        'm' => -3,
        'c' => -2,
        'k' => 3,
        'M' => 6,
        'G' => 9,
        'T' => 12,
        _ => return None,
    };
    let symbol = SYMBOLS.iter().find(|s| s.names.contains(&rest) && s.prefixes.contains(prefix))?;
    Some(Unit { ten: symbol.unit.ten + ten, ..symbol.unit })
}

/// The power at the start of `text` (`^2`, `²`, `2`, `^-3`, `⁻³`; 1 where there is none) and what follows it.
fn power(text: &str) -> Option<(i32, &str)> {
    let raised = |c: char| "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|r| r == c).map(|d| d as i32);
    let plain = |c: char| c.to_digit(10).map(|d| d as i32);
    let after_caret = text.strip_prefix('^');
    let rest = after_caret.unwrap_or(text);
    let minus = rest.chars().next().filter(|c| matches!(c, '-' | '⁻'));
    let rest = minus.map_or(rest, |c| &rest[c.len_utf8()..]);
    let Some(digit) = rest.chars().next().filter(|c| plain(*c).or(raised(*c)).is_some()) else {
        return if after_caret.is_none() && minus.is_none() { Some((1, text)) } else { None };
    };
    let rest = &rest[digit.len_utf8()..];
    if rest.starts_with(|c: char| plain(c).or(raised(c)).is_some() || c == '.') {
        return None;
    }
    let power = plain(digit).or(raised(digit))?;
    Some((if minus.is_some() { -power } else { power }, rest))
}

/// A decimal number (sign, digits, power of ten) and the unit after it.
struct Number<'a> {
    digits: String,
    ten: i64,
    unit: &'a str,
}

impl<'a> Number<'a> {
    fn split(text: &'a str, wanted: &Wanted) -> std::result::Result<Number<'a>, String> {
        let mut rest = text.trim();
        let mut digits = String::new();
        if let Some(sign) = rest.chars().next().filter(|c| matches!(c, '+' | '-' | '−')) {
            rest = &rest[sign.len_utf8()..];
            if sign != '+' {
                digits.push('-');
            }
        }
        let end = rest.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(rest.len());
        let (mantissa, tail) = rest.split_at(end);
        if !mantissa.contains(|c: char| c.is_ascii_digit()) {
            let word = rest.split_whitespace().next().unwrap_or("").to_ascii_lowercase();
            return Err(if matches!(word.as_str(), "nan" | "inf" | "infinity" | "∞") {
                format!(
                    "{} is not a finite number: {} is wanted, such as \"{}\"",
                    quoted(text),
                    wanted.name,
                    wanted.example
                )
            } else {
                format!(
                    "{} does not begin with a number: {} is wanted, such as \"{}\"",
                    quoted(text),
                    wanted.name,
                    wanted.example
                )
            });
        }
        if mantissa.matches('.').count() > 1 {
            return Err(format!("the number in {} has two decimal points", quoted(text)));
        }
        digits.push_str(mantissa);
        let (ten, tail) = exponent(tail);
        let unit = tail.trim_start();
        let grouped =
            tail.starts_with([',', '_', '\'', '’']) || unit.starts_with(|c: char| c.is_ascii_digit() || c == '.');
        if grouped {
            return Err(format!(
                "the number in {} is not readable: write it with a decimal point and without grouping digits, such as \"{}\"",
                quoted(text),
                wanted.example
            ));
        }
        Ok(Number { digits, ten, unit })
    }

    /// The number in another unit of the same dimension.
    fn convert(&self, from: &Unit, to: &Unit, text: &str) -> std::result::Result<f64, String> {
        let ten = self.ten + i64::from(from.ten - to.ten);
        let decimal: f64 = format!("{}e{ten}", self.digits).parse().unwrap_or(f64::NAN);
        let (mut above, mut below) = (1.0, 1.0);
        for (i, constant) in CONSTANTS.iter().enumerate() {
            let power = from.constants[i] - to.constants[i];
            *(if power < 0 { &mut below } else { &mut above }) *= constant.powi(power.abs());
        }
        let value = decimal * above / below;
        let zero = !self.digits.contains(|c: char| ('1'..='9').contains(&c));
        if !value.is_finite() {
            Err(format!("{} is too large for a double-precision number", quoted(text)))
        } else if !zero && !value.is_normal() {
            Err(format!("{} is too small for a double-precision number: write 0 if that is meant", quoted(text)))
        } else {
            Ok(value)
        }
    }
}

/// The power of ten at the start of `text` (`e-3`; 0 where there is none, as in `eV`) and what follows it.
fn exponent(text: &str) -> (i64, &str) {
    let Some(rest) = text.strip_prefix(['e', 'E']) else { return (0, text) };
    let (negative, rest) = match rest.chars().next() {
        Some('-') => (true, &rest[1..]),
        Some('−') => (true, &rest['−'.len_utf8()..]),
        Some('+') => (false, &rest[1..]),
        _ => (false, rest),
    };
    let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
    if end == 0 {
        return (0, text);
    }
    // Anything beyond a million is as infinite as a million.
    let size = rest[..end].parse::<i64>().unwrap_or(i64::MAX).min(1_000_000);
    (if negative { -size } else { size }, &rest[end..])
}
