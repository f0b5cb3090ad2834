//! What the numbers of a file mean, as `--convention` says it: words of [`pairs`](crate::energy::PairsSpec), `"once, -J, +D"`.

use crate::energy::{Convention, Counting, DmiForm, EnergyForm};
use crate::error::{Error, Result};
use crate::words::quoted;
use serde::Deserialize;
use serde::de::IntoDeserializer;
use serde::de::value::Error as Refused;

/// What the user says of the convention; what is left out is the format's own.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Told {
    /// How often the energy counts a pair.
    pub counting: Option<Counting>,
    /// What stands in front of J.
    pub energy: Option<EnergyForm>,
    /// What stands in front of D.
    pub dmi: Option<DmiForm>,
    /// What stands in front of the K of cubic anisotropy, K (α₁²α₂² + α₂²α₃² + α₃²α₁²), of UppASD.
    pub cubic: Option<f64>,
}

impl Told {
    /// From words with commas or spaces between them.
    pub fn parse(text: &str) -> Result<Told> {
        let mut told = Told::default();
        for word in text.replace("both directions", "both").split([',', ' ']).filter(|word| !word.is_empty()) {
            let twice = match word {
                "both" => told.counting.replace(Counting::BothDirections).is_some(),
                "once" => told.counting.replace(Counting::Once).is_some(),
                "+K" => told.cubic.replace(1.0).is_some(),
                "-K" => told.cubic.replace(-1.0).is_some(),
                _ => match (known::<EnergyForm>(word), known::<DmiForm>(word)) {
                    (Some(energy), _) => told.energy.replace(energy).is_some(),
                    (_, Some(dmi)) => told.dmi.replace(dmi).is_some(),
                    _ => return Err(Error::invalid("--convention", unknown(word))),
                },
            };
            if twice {
                let message = format!("{} says a second time what was said before", quoted(word));
                return Err(Error::invalid("--convention", message));
            }
        }
        if told == Told::default() {
            return Err(Error::invalid("--convention", unknown(text)));
        }
        Ok(told)
    }

    /// Refuses a sign of K, where a format has no two.
    pub fn no_cubic(&self) -> Result<()> {
        match self.cubic {
            None => Ok(()),
            Some(_) => Err(Error::invalid("--convention", "the sign of K is not open in this format")),
        }
    }

    /// That of a format, changed by what is told.
    pub fn over(&self, own: Convention) -> Convention {
        Convention {
            counting: self.counting.unwrap_or(own.counting),
            energy: self.energy.unwrap_or(own.energy),
            dmi: self.dmi.unwrap_or(own.dmi),
        }
    }
}

fn known<'de, T: Deserialize<'de>>(word: &'de str) -> Option<T> {
    let word = IntoDeserializer::<Refused>::into_deserializer(word);
    T::deserialize(word).ok()
}

fn unknown(word: &str) -> String {
    format!(
        "found {}, but a convention says how pairs are counted, \"once\" or \"both directions\", what stands in front of J, \
         one of -J, +J, -2J, +2J, -J/2, +J/2, and in front of D, one of +D, -D, +2D, -2D, +D/2, -D/2 (of UppASD's cubic K, +K or -K): \"once, -J, +D\"",
        quoted(word)
    )
}

/// "E = −Σ J m_i·m_j − Σ D·(m_i × m_j), both directions": what a convention is, and what J and D are multiplied by to be those of
/// a bond counted once, E = −J m_i·m_j + D·(m_i × m_j).
pub fn in_words(c: Convention, dmi: bool) -> [String; 2] {
    let counted = match c.counting {
        Counting::Once => "each pair once",
        Counting::BothDirections => "i and j independently, each pair in both directions",
    };
    let each = match c.counting {
        Counting::Once => 1.0,
        Counting::BothDirections => 2.0,
    };
    let (j, d) = (c.energy.factor(), c.dmi.factor());
    let in_front = |factor: f64, name: &str| {
        let size = if factor.abs() == 1.0 { String::new() } else { format!("{} ", factor.abs()) };
        format!("{} Σ {size}{name}", if factor < 0.0 { "−" } else { "+" })
    };
    let anti = if dmi { format!(" {}·(m_i × m_j)", in_front(d, "D")) } else { String::new() };
    let formula = format!("E = {} m_i·m_j{anti}, {counted}", in_front(j, "J"));
    let times = |x: f64| format!("{x}").replace('-', "−");
    let anti = if dmi { format!(", D is multiplied by {}", times(each * d)) } else { String::new() };
    [formula, format!("J is multiplied by {}{anti}", times(-each * j))]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_a_convention_are_read_in_any_order() {
        let told = Told::parse("-D, both directions").unwrap();
        assert_eq!(told.counting, Some(Counting::BothDirections));
        assert_eq!((told.energy, told.dmi), (None, Some(DmiForm::Minus)));
        assert_eq!(Told::parse("+J/2 once").unwrap().energy, Some(EnergyForm::PlusHalf));
        for wrong in ["", "twice", "once, once", "-J +J", "J"] {
            assert!(Told::parse(wrong).unwrap_err().to_string().starts_with("--convention: "), "{wrong}");
        }
    }

    #[test]
    fn a_convention_is_told_with_its_factors() {
        let own = Convention { counting: Counting::BothDirections, energy: EnergyForm::MinusHalf, dmi: DmiForm::Minus };
        let [formula, factors] = in_words(own, true);
        assert!(formula.starts_with("E = − Σ 0.5 J m_i·m_j − Σ D·(m_i × m_j), i and j"), "{formula}");
        assert_eq!(factors, "J is multiplied by 1, D is multiplied by −2");
    }
}
