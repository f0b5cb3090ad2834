//! The regular expression of a quantity: a number, then a unit of the right dimension. Editors check configs with it.
//!
//! A unit of a dimension is a product of up to three kinds of units with powers that add up to it (J/m³, kA m⁻¹, emu/cm^3): all such
//! products are written out from the table of symbols. What no one writes, such as a product of four, the program reads and the
//! expression refuses.

use super::parse::{Dimension, SYMBOLS, Symbol, Wanted};

/// The number.
const NUMBER: &str = r"[+−-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+−-]?[0-9]+)?";
/// Between two units that are multiplied.
const TIMES: &str = r"(\s*[·⋅*]\s*|\s+)";
/// The sum of the powers of a product, signs set aside.
const LARGEST: i32 = 4;
/// The highest power of a unit.
const HIGHEST: i32 = 3;

/// The expression for what is wanted.
pub(super) fn of(wanted: &Wanted) -> String {
    let forms: Vec<String> = wanted.targets().iter().flat_map(|(d, field)| products(&kinds(*field), *d)).collect();
    format!(r"^\s*{NUMBER}\s*({})\s*$", forms.join("|"))
}

/// Units of one dimension.
struct Kind {
    dimension: Dimension,
    /// One of them, with its prefix.
    one: String,
}

/// All kinds of units; of a field H none has emu in it.
fn kinds(field: bool) -> Vec<Kind> {
    let mut kinds: Vec<Kind> = Vec::new();
    for symbol in SYMBOLS.iter().filter(|symbol| !(field && symbol.names.contains(&"emu"))) {
        let dimension = symbol.unit.dimension;
        let own = spellings(symbol);
        match kinds.iter_mut().find(|kind| kind.dimension == dimension) {
            Some(kind) => kind.one = format!("{}|{own}", kind.one),
            None => kinds.push(Kind { dimension, one: own }),
        }
    }
    kinds.iter_mut().for_each(|kind| kind.one = format!("({})", kind.one));
    kinds
}

fn spellings(symbol: &Symbol) -> String {
    // three signs for micro, and two for the ångström
    let prefixes = symbol.prefixes.replace('u', "uµμ");
    let names: Vec<String> =
        symbol.names.iter().map(|name| name.replace('Å', "[Å\u{212B}]").replace("u", "[uµμ]")).collect();
    let names = match &names[..] {
        [name] => name.clone(),
        names => format!("({})", names.join("|")),
    };
    if prefixes.is_empty() { names } else { format!("[{prefixes}]?{names}") }
}

/// All products of a dimension, factors above the line first.
fn products(kinds: &[Kind], wanted: Dimension) -> Vec<String> {
    let mut found = Vec::new();
    let mut open: Vec<Vec<(usize, i32)>> = vec![Vec::new()];
    while let Some(product) = open.pop() {
        let size: i32 = product.iter().map(|(_, power)| power.abs()).sum();
        let dimension = |k: usize| product.iter().map(|(kind, power)| power * kinds[*kind].dimension[k]).sum::<i32>();
        if !product.is_empty() && (0..wanted.len()).all(|k| dimension(k) == wanted[k]) {
            let mut factors = product.clone();
            factors.sort_by_key(|(_, power)| *power < 0);
            found.extend(written(kinds, &factors));
        }
        if product.len() < 3 {
            let first = product.last().map_or(0, |(kind, _)| kind + 1);
            for kind in first..kinds.len() {
                let powers = (-HIGHEST..=HIGHEST).filter(|power| *power != 0 && size + power.abs() <= LARGEST);
                open.extend(powers.map(|power| [&product[..], &[(kind, power)]].concat()));
            }
        }
    }
    found
}

/// A product as an expression; nothing if all of it is below the line.
fn written(kinds: &[Kind], factors: &[(usize, i32)]) -> Option<String> {
    let mut text = String::new();
    for (place, (kind, power)) in factors.iter().enumerate() {
        let one = &kinds[*kind].one;
        match (place, *power > 0) {
            (0, true) => text.push_str(&format!("{one}{}", raised(*power))),
            (0, false) => return None,
            (_, true) => text.push_str(&format!("{TIMES}{one}{}", raised(*power))),
            (_, false) => {
                let (below, above) = (raised(-power), raised(*power));
                text.push_str(&format!(r"(\s*/\s*{one}{below}|{TIMES}{one}{above})"));
            }
        }
    }
    Some(text)
}

fn raised(power: i32) -> String {
    let digit = |d: i32| "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().nth(d.unsigned_abs() as usize).unwrap_or('0');
    match power {
        1 => r"(\^?1|¹)?".into(),
        2.. => format!(r"(\^?{power}|{})", digit(power)),
        _ => format!(r"(\^?{power}|\^?⁻{})", digit(power)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::parse::WANTED;

    /// Whether an editor that knows the schema takes a text.
    fn taken(expression: &str) -> impl Fn(&str) -> bool + use<> {
        let validator =
            jsonschema::validator_for(&serde_json::json!({"type": "string", "pattern": expression})).unwrap();
        move |text: &str| validator.is_valid(&text.into())
    }

    #[test]
    fn the_expression_takes_what_the_program_reads_and_refuses_what_it_refuses() {
        let ones =
            ["eV", "meV", "J", "Ry", "erg", "mu_B", "μB", "emu", "T", "mT", "Oe", "G", "A", "kA", "m", "nm", "Å", "cm"];
        let others = ["cc", "K", "mK", "s", "ps", "deg", "°", "rad", "meter", "mev", "kg", "x"];
        let all: Vec<&str> = ones.into_iter().chain(others).collect();
        let mut units: Vec<String> = all.iter().map(|one| one.to_string()).collect();
        for (i, a) in all.iter().enumerate() {
            for b in all.iter().skip(i % 2).step_by(2) {
                for power in ["", "^2", "²", "3", "^3"] {
                    units.push(format!("{a}/{b}{power}"));
                }
                units.push(format!("{a} {b}^-3"));
                units.push(format!("{a}·{b}⁻¹"));
                units.push(format!("{a} {b}²"));
            }
        }
        for wanted in WANTED {
            let expression = of(wanted);
            assert!(expression.len() < 40_000, "{} {}", wanted.name, expression.len());
            let taken = taken(&expression);
            let mut fitting = 0;
            for unit in &units {
                let text = format!("-1.5e-3 {unit}");
                let read = wanted.parse(&text).is_ok();
                assert_eq!(taken(&text), read, "{text:?} as {}", wanted.name);
                fitting += usize::from(read);
            }
            assert!(fitting > 0, "{}", wanted.name);
            for good in [wanted.example, &format!("  {} ", wanted.example)] {
                assert!(taken(good), "{good}");
            }
            for bad in ["", "1", "meV", "1 2 meV", "0,5 meV", "1 meV/atom", "1 µµeV", "0.5 meters", "1 J/m^", "1 /m"]
            {
                assert!(!taken(bad), "{bad} as {}", wanted.name);
            }
        }
    }

    #[test]
    fn ways_to_write_a_unit_that_are_usual_are_taken() {
        let wanted = |name: &str| WANTED.into_iter().find(|wanted| wanted.name == name).unwrap();
        for (name, texts) in [
            ("an energy per volume", &["1 MJ/m^3", "1 MJ/m³", "1 kJ m^-3", "1e6erg/cc", "1 erg / cm^3", "1 J·m⁻³"][..]),
            ("a magnetic moment", &["2 mu_B", "2 μ_B", "2 muB", "1 emu", "1 J/T", "1 A m^2", "1 A·m²"]),
            ("a magnetic field", &["50 mT", "-1 kOe", "3 G", "40 kA/m", "40 kA m^-1", "1 J/A/m^2"]),
            ("a magnetisation", &["800 kA/m", "800 emu/cm^3", "800 emu/cc", "1 MA m⁻¹"]),
            ("an exchange stiffness", &["13 pJ/m", "1.3e-6 erg/cm", "13 pJ m^-1", "1 meV/nm", "1 meV/Å"]),
        ] {
            let taken = taken(&of(wanted(name)));
            for text in texts {
                assert!(taken(text) && wanted(name).parse(text).is_ok(), "{text} as {name}");
            }
        }
    }
}
