//! A quantity of whatever kind, in the unit it is written in: for ranges and tables of values whose place in a config decides
//! what they mean.

use super::{
    Angle, Energy, EnergyDensity, ExchangeStiffness, FluxDensity, Length, Magnetisation, Moment, SurfaceEnergy,
    Temperature, Time, parse,
};
use crate::error::Result;
use crate::words::number;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use std::borrow::Cow;

/// A number with its unit as written.
#[derive(Clone, Debug, PartialEq)]
pub struct AnyQuantity {
    text: String,
    /// The number.
    pub value: f64,
    /// Its unit, as written: `"kA/m"`.
    pub unit: String,
}

impl JsonSchema for AnyQuantity {
    fn schema_name() -> Cow<'static, str> {
        "AnyQuantity".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let kinds = [
            generator.subschema_for::<Energy>(),
            generator.subschema_for::<Moment>(),
            generator.subschema_for::<FluxDensity>(),
            generator.subschema_for::<ExchangeStiffness>(),
            generator.subschema_for::<SurfaceEnergy>(),
            generator.subschema_for::<EnergyDensity>(),
            generator.subschema_for::<Magnetisation>(),
            generator.subschema_for::<Length>(),
            generator.subschema_for::<Temperature>(),
            generator.subschema_for::<Time>(),
            generator.subschema_for::<Angle>(),
        ];
        json_schema!({"description": "a number with its unit, of whatever kind the key wants", "anyOf": kinds})
    }
}

impl AnyQuantity {
    /// Of a text such as `"800 kA/m"`.
    pub fn new(text: &str) -> Result<AnyQuantity> {
        let (value, unit) = parse::any(text)?;
        Ok(AnyQuantity { text: text.into(), value, unit: unit.into() })
    }

    /// The number in the unit of another quantity, which must be of the same kind.
    pub fn value_as(&self, other: &AnyQuantity) -> Result<f64> {
        parse::any_as(&self.text, &other.text)
    }

    /// Another number in the same unit, as a config has it: `"0.25 meV"`.
    pub fn with_value(&self, value: f64) -> String {
        format!("{} {}", number(value), self.unit)
    }

    /// The unit as a part of a name: `J_per_m3`, `mu_B`, `A_m2`.
    pub fn unit_name(&self) -> String {
        let mut name = String::new();
        let mut gap = false;
        for c in self.unit.chars() {
            match c {
                '/' => {
                    name.push_str("_per_");
                    gap = false;
                }
                '^' => {}
                '²' => name.push('2'),
                '³' => name.push('3'),
                'µ' | 'μ' => name.push('u'),
                'Å' | '\u{212B}' => name.push_str("angstrom"),
                '°' => name.push_str("deg"),
                c if c.is_ascii_alphanumeric() || c == '_' || c == '-' => {
                    if gap && !name.is_empty() && !name.ends_with('_') {
                        name.push('_');
                    }
                    gap = false;
                    name.push(c);
                }
                // a product
                _ => gap = true,
            }
        }
        name
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quantity_keeps_its_unit_and_is_told_in_that_of_another() {
        let [k, e] = ["0.1 meV", "2 eV"].map(|t| AnyQuantity::new(t).unwrap());
        assert_eq!((k.value, k.unit.as_str(), e.value_as(&k).unwrap()), (0.1, "meV", 2000.0));
        assert_eq!(k.with_value(0.25), "0.25 meV");
        let h = AnyQuantity::new("800kA/m ").unwrap();
        assert_eq!((h.value, h.unit.as_str()), (800.0, "kA/m"));
        assert_eq!(AnyQuantity::new("1 emu/cm^3").unwrap().value_as(&h).unwrap(), 1.0);
    }

    #[test]
    fn units_become_names() {
        for (text, name) in [
            ("1 meV", "meV"),
            ("1 J/m^3", "J_per_m3"),
            ("1 J/m³", "J_per_m3"),
            ("1 A m^2", "A_m2"),
            ("1 J m^-3", "J_m-3"),
            ("1 mu_B", "mu_B"),
            ("1 µm", "um"),
            ("1 A·m²", "A_m2"),
        ] {
            assert_eq!(AnyQuantity::new(text).unwrap().unit_name(), name, "{text}");
        }
    }

    #[test]
    fn what_is_no_quantity_or_of_another_kind_is_refused_in_words() {
        for (text, words) in
            [("0.1", "has no unit"), ("up", "does not begin with a number"), ("1 mev", "did you mean \"meV\"?")]
        {
            let said = AnyQuantity::new(text).unwrap_err().to_string();
            assert!(said.contains(words), "{said}");
        }
        let [k, b] = ["0.1 meV", "2 T"].map(|t| AnyQuantity::new(t).unwrap());
        assert_eq!(
            b.value_as(&k).unwrap_err().to_string(),
            "\"2 T\" is a magnetic field, but \"0.1 meV\" is an energy"
        );
    }
}
