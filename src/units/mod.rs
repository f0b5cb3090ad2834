//! Physical quantities: strings with a unit outside, plain numbers in one set of units inside.
//!
//! Inside are meV, μ_B, T, nm, K, ps and rad; what is given as a density stays in SI (J/m, J/m², J/m³, A/m) until a
//! lattice says how large a cell is. Constants are CODATA 2022.
//!
//! A quantity is read from a string only, `"13 pJ/m"`. Powers of ten are applied in decimal and equal constants cancel,
//! so `"10 meV"` is exactly 10 and what was written is what is computed with.

mod any;
mod extent;
mod parse;
mod pattern;

pub use any::AnyQuantity;
pub use extent::{Extent, Place};

use crate::error::{Error, Result};
use crate::words::number;
use parse::Wanted;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, Deserializer};
use serde::ser::{Serialize, Serializer};
use std::borrow::Cow;
use std::fmt;
use std::str::FromStr;

/// Bohr magneton in meV/T.
pub const MU_B_MEV_PER_T: f64 = 5.7883817982e-2;
/// Elementary charge in C; also 1 eV in J.
pub const E_CHARGE: f64 = 1.602176634e-19;
/// Reduced Planck constant in meV ps.
pub const HBAR: f64 = 0.6582119569;
/// Magnetic constant in N/A² (T m/A).
pub const MU_0: f64 = 1.25663706127e-6;
/// Rydberg energy in meV.
pub const RYDBERG: f64 = 13605.693122990;
/// Boltzmann constant in meV/K.
pub const K_B: f64 = 8.617333262e-2;

/// The digits of the elementary charge: 1 meV is E_DIGITS · 1e-22 J.
const E_DIGITS: f64 = 1.602176634;

/// The schema of a quantity: a number with a unit of its dimension, in a string.
macro_rules! schema {
    ($name:ident, $wanted:ident) => {
        impl JsonSchema for $name {
            fn schema_name() -> Cow<'static, str> {
                stringify!($name).into()
            }

            fn json_schema(_: &mut SchemaGenerator) -> Schema {
                json_schema!({
                    "type": "string",
                    "description": format!("a number with its unit: {}", $name::UNITS),
                    "pattern": pattern::of(&parse::$wanted),
                    "examples": [parse::$wanted.example],
                })
            }
        }
    };
}

/// A newtype over one number, read from and written as a string with a unit.
macro_rules! quantity {
    ($(#[$doc:meta])* $name:ident, $wanted:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
        pub struct $name(pub f64);

        impl $name {
            /// The units that fit, in words.
            pub const UNITS: &'static str = parse::$wanted.units;
        }

        impl From<f64> for $name {
            fn from(value: f64) -> Self {
                $name(value)
            }
        }

        impl From<$name> for f64 {
            fn from(quantity: $name) -> f64 {
                quantity.0
            }
        }

        impl FromStr for $name {
            type Err = Error;

            fn from_str(text: &str) -> Result<Self> {
                parse::$wanted.parse(text).map(|(value, _)| $name(value))
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "{} {}", number(self.0), parse::$wanted.kinds[0].unit)
            }
        }

        impl Serialize for $name {
            fn serialize<S: Serializer>(&self, s: S) -> std::result::Result<S::Ok, S::Error> {
                written(self.0, self, s)
            }
        }

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(d: D) -> std::result::Result<Self, D::Error> {
                read(&parse::$wanted, d).map(|(value, _)| $name(value))
            }
        }

        schema!($name, $wanted);
    };
}

quantity! {
    /// An energy in meV.
    Energy, ENERGY
}
quantity! {
    /// A magnetic moment in μ_B.
    Moment, MOMENT
}
quantity! {
    /// A magnetic field B in T. Given as H in A/m it is B = μ₀H; 1 Oe is 1 G is 0.1 mT, as in vacuum.
    FluxDensity, FLUX_DENSITY
}
quantity! {
    /// An exchange stiffness in J/m.
    ExchangeStiffness, EXCHANGE_STIFFNESS
}
quantity! {
    /// An energy per area in J/m².
    SurfaceEnergy, SURFACE_ENERGY
}
quantity! {
    /// An energy per volume in J/m³.
    EnergyDensity, ENERGY_DENSITY
}
quantity! {
    /// A magnetisation in A/m.
    Magnetisation, MAGNETISATION
}
quantity! {
    /// A length in nm.
    Length, LENGTH
}
quantity! {
    /// A temperature in K.
    Temperature, TEMPERATURE
}
quantity! {
    /// A time in ps.
    Time, TIME
}
quantity! {
    /// An angle in rad.
    Angle, ANGLE
}

/// An energy of a site, given for the site itself or for a volume: the unit says which.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SiteEnergy {
    /// For each site.
    PerSite(Energy),
    /// For each volume; the cell's volume is the lattice's.
    PerVolume(EnergyDensity),
}

/// An energy of a bond, given for the bond itself or for an area: the unit says which.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BondEnergy {
    /// For each bond.
    PerBond(Energy),
    /// For each area; the chain's cross-section is the lattice's.
    PerArea(SurfaceEnergy),
}

/// A choice between two quantities made by the dimension of the unit.
macro_rules! sum {
    ($name:ident, $wanted:ident, $first:ident($a:ident), $second:ident($b:ident)) => {
        impl $name {
            /// The units that fit, in words.
            pub const UNITS: &'static str = parse::$wanted.units;

            fn chosen((value, kind): (f64, usize)) -> Self {
                if kind == 0 { $name::$first($a(value)) } else { $name::$second($b(value)) }
            }

            fn value(self) -> f64 {
                match self {
                    $name::$first(q) => q.0,
                    $name::$second(q) => q.0,
                }
            }
        }

        impl FromStr for $name {
            type Err = Error;

            fn from_str(text: &str) -> Result<Self> {
                parse::$wanted.parse(text).map($name::chosen)
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                match self {
                    $name::$first(q) => q.fmt(f),
                    $name::$second(q) => q.fmt(f),
                }
            }
        }

        impl Serialize for $name {
            fn serialize<S: Serializer>(&self, s: S) -> std::result::Result<S::Ok, S::Error> {
                written(self.value(), self, s)
            }
        }

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(d: D) -> std::result::Result<Self, D::Error> {
                read(&parse::$wanted, d).map($name::chosen)
            }
        }

        schema!($name, $wanted);
    };
}

sum!(SiteEnergy, SITE_ENERGY, PerSite(Energy), PerVolume(EnergyDensity));
sum!(BondEnergy, BOND_ENERGY, PerBond(Energy), PerArea(SurfaceEnergy));

impl Energy {
    /// An energy given in J.
    pub fn from_joules(joules: f64) -> Energy {
        Energy(joules * 1e22 / E_DIGITS)
    }

    /// In J.
    pub fn joules(self) -> f64 {
        self.0 * 1e-22 * E_DIGITS
    }

    /// The temperature E/k_B.
    pub fn temperature(self) -> Temperature {
        Temperature(self.0 / K_B)
    }
}

impl Temperature {
    /// The energy k_B T.
    pub fn energy(self) -> Energy {
        Energy(self.0 * K_B)
    }
}

impl Moment {
    /// The energy μ B.
    pub fn in_field(self, b: FluxDensity) -> Energy {
        Energy(self.0 * b.0 * MU_B_MEV_PER_T)
    }
}

impl ExchangeStiffness {
    /// The energy A·l over a length in nm (a cross-section over a spacing).
    pub fn over_length(self, nm: f64) -> Energy {
        Energy(self.0 * nm * 1e13 / E_DIGITS)
    }
}

impl SurfaceEnergy {
    /// The energy of an area in nm².
    pub fn over_area(self, nm2: f64) -> Energy {
        Energy(self.0 * nm2 * 1e4 / E_DIGITS)
    }
}

impl EnergyDensity {
    /// The energy of a volume in nm³.
    pub fn in_volume(self, nm3: f64) -> Energy {
        Energy(self.0 * nm3 * 1e-5 / E_DIGITS)
    }
}

impl Magnetisation {
    /// The moment of a volume in nm³.
    pub fn in_volume(self, nm3: f64) -> Moment {
        // 1 A/m nm³ = 1e-27 J/T, and μ_B = MU_B_MEV_PER_T · 1e-22 · E_DIGITS J/T.
        Moment(self.0 * nm3 * 1e-5 / (E_DIGITS * MU_B_MEV_PER_T))
    }
}

/// A quantity of each kind, as it may be written.
pub fn examples() -> impl Iterator<Item = &'static str> {
    parse::WANTED.iter().map(|wanted| wanted.example)
}

/// Writes a quantity, refusing what could not be read again.
fn written<S: Serializer>(value: f64, shown: &dyn fmt::Display, s: S) -> std::result::Result<S::Ok, S::Error> {
    if value.is_finite() {
        s.collect_str(shown)
    } else {
        Err(serde::ser::Error::custom(format!("{shown} is not finite")))
    }
}

/// Reads a quantity from a string; everything else is refused with what would do.
fn read<'de, D: Deserializer<'de>>(wanted: &'static Wanted, d: D) -> std::result::Result<(f64, usize), D::Error> {
    struct Reader(&'static Wanted);

    impl<'de> serde::de::Visitor<'de> for Reader {
        type Value = (f64, usize);

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            write!(f, "{} with its unit, such as \"{}\"", self.0.name, self.0.example)
        }

        fn visit_str<E: serde::de::Error>(self, text: &str) -> std::result::Result<Self::Value, E> {
            self.0.parse(text).map_err(E::custom)
        }

        fn visit_i64<E: serde::de::Error>(self, x: i64) -> std::result::Result<Self::Value, E> {
            Err(E::custom(
                self.0.bare(&format!("found the number {x}, but {} needs its unit", self.0.name), &x.to_string()),
            ))
        }

        fn visit_u64<E: serde::de::Error>(self, x: u64) -> std::result::Result<Self::Value, E> {
            Err(E::custom(
                self.0.bare(&format!("found the number {x}, but {} needs its unit", self.0.name), &x.to_string()),
            ))
        }

        fn visit_f64<E: serde::de::Error>(self, x: f64) -> std::result::Result<Self::Value, E> {
            let x = number(x);
            Err(E::custom(self.0.bare(&format!("found the number {x}, but {} needs its unit", self.0.name), &x)))
        }
    }

    d.deserialize_any(Reader(wanted))
}

#[cfg(test)]
mod tests;
