//! Pairs as a table: a bond a row, the columns named in the first line.
//!
//! ```text
//! from,to,cell_1,cell_2,cell_3,J_meV,D_x_meV,D_y_meV,D_z_meV
//! 0,0,1,0,0,10.5,0,1.2,0
//! ```
//! J, D_x … D_z and T_xx … T_zz carry their unit of energy behind the last underscore; which of them there are is up to the table.
//! Columns are parted by commas, semicolons or white space, and `#` begins a comment.

use super::pairs::{PairSpec, PairsSpec};
use crate::error::{Error, Result};
use crate::units::Energy;
use crate::words::quoted;

const PLACES: [&str; 5] = ["from", "to", "cell_1", "cell_2", "cell_3"];
const STRENGTHS: [&str; 13] =
    ["J", "D_x", "D_y", "D_z", "T_xx", "T_xy", "T_xz", "T_yx", "T_yy", "T_yz", "T_zx", "T_zy", "T_zz"];

impl PairsSpec {
    /// The bonds of a table in place of its name.
    pub fn fill(&mut self, text: &str) -> Result<()> {
        if self.convention.is_none() {
            let message = "a table needs the convention of its numbers: {\"counting\": \"once\" or \"both directions\", \"energy\": \"-J\"}";
            return Err(Error::invalid("convention", message));
        }
        if !self.bonds.is_empty() {
            return Err(Error::invalid("file", "\"bonds\" and \"file\" are two ways to say the same: keep one"));
        }
        self.bonds = parse(text).map_err(|e| e.within("file"))?;
        self.file = None;
        Ok(())
    }
}

/// The bonds of a table; an error says in which line something is wrong.
fn parse(text: &str) -> Result<Vec<PairSpec>> {
    let lines = text.lines().enumerate().map(|(k, line)| (k + 1, words(line)));
    let mut lines = lines.filter(|(_, words)| !words.is_empty());
    let Some((number, head)) = lines.next() else { return Err(Error::invalid("", "the table is empty")) };
    let head = Head::read(&head).map_err(|e| in_line(number, e))?;
    lines.map(|(number, row)| head.pair(&row).map_err(|e| in_line(number, e))).collect()
}

fn words(line: &str) -> Vec<&str> {
    let content = line.split('#').next().unwrap_or_default();
    content.split(|c: char| c.is_whitespace() || c == ',' || c == ';').filter(|word| !word.is_empty()).collect()
}

fn in_line(number: usize, error: Error) -> Error {
    Error::invalid("", format!("line {number} of the table: {error}"))
}

/// Which column is what.
struct Head {
    count: usize,
    places: [Option<usize>; 5],
    /// Each with its unit.
    strengths: [Option<(usize, String)>; 13],
}

impl Head {
    fn read(words: &[&str]) -> Result<Head> {
        let mut head = Head { count: words.len(), places: [None; 5], strengths: Default::default() };
        for (k, word) in words.iter().enumerate() {
            let taken = match PLACES.iter().position(|name| name == word) {
                Some(place) => head.places[place].replace(k).is_some(),
                None => {
                    let (name, unit) = word.rsplit_once('_').unwrap_or((word, ""));
                    let Some(strength) = STRENGTHS.iter().position(|own| *own == name) else {
                        let known = PLACES.iter().chain(&STRENGTHS).copied().collect::<Vec<_>>().join(", ");
                        let message = format!(
                            "no column is called {}: there are {known}, strengths with a unit, J_meV",
                            quoted(word)
                        );
                        return Err(Error::invalid("", message));
                    };
                    format!("1 {unit}").parse::<Energy>()?;
                    head.strengths[strength].replace((k, unit.to_string())).is_some()
                }
            };
            if taken {
                return Err(Error::invalid("", format!("the column {} is there twice", quoted(word))));
            }
        }
        match (head.places, &head.strengths) {
            ([Some(_), Some(_), ..], strengths) if strengths.iter().any(Option::is_some) => Ok(head),
            _ => Err(Error::invalid("", "the first line names the columns: from, to and a strength, J_meV, at least")),
        }
    }

    fn pair(&self, row: &[&str]) -> Result<PairSpec> {
        if row.len() != self.count {
            return Err(Error::invalid("", format!("found {} columns, the first line has {}", row.len(), self.count)));
        }
        let [from, to, first, second, third] = self.places;
        let whole = |column: Option<usize>| match column.map(|k| row[k]) {
            None => Ok(0),
            Some(word) => {
                word.parse::<isize>().map_err(|_| Error::invalid("", format!("{} is no whole number", quoted(word))))
            }
        };
        let atom = |column| {
            whole(column).and_then(|n| {
                usize::try_from(n)
                    .map_err(|_| Error::invalid("", format!("found atom {n}, but atoms are counted from 0")))
            })
        };
        let strength = |k: usize| match &self.strengths[k] {
            None => Ok(None),
            Some((column, unit)) => format!("{} {unit}", row[*column]).parse::<Energy>().map(Some),
        };
        let all = (0..13).map(strength).collect::<Result<Vec<_>>>()?;
        let some = |range: std::ops::Range<usize>| all[range].iter().any(Option::is_some);
        let at = |k: usize| all[k].unwrap_or(Energy(0.0));
        Ok(PairSpec {
            from: atom(from)?,
            to: atom(to)?,
            cell: [whole(first)?, whole(second)?, whole(third)?],
            J: all[0],
            D: some(1..4).then(|| [at(1), at(2), at(3)]),
            tensor: some(4..13).then(|| [0, 1, 2].map(|r| [0, 1, 2].map(|c| at(4 + 3 * r + c)))),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_has_a_bond_a_row_with_the_units_of_its_columns() {
        let found =
            parse("# of a film\nfrom to cell_1 J_mRy D_y_meV\n0 1 -1 1 0.5 # nearest\n\n1,0;1 2 -0.5\n").unwrap();
        assert_eq!(found.len(), 2);
        assert_eq!((found[0].from, found[0].to, found[0].cell), (0, 1, [-1, 0, 0]));
        assert!((found[0].J.unwrap().0 - 13.605693122990).abs() < 1e-12);
        assert_eq!(found[1].D, Some([Energy(0.0), Energy(-0.5), Energy(0.0)]));
        assert_eq!(found[1].tensor, None);
    }

    #[test]
    fn what_is_wrong_with_a_table_is_told_with_its_line() {
        for (text, said) in [
            ("", "the table is empty"),
            ("from,to,K_meV\n", "line 1 of the table: no column is called \"K_meV\""),
            ("from,to,J_nm\n", "line 1"),
            ("from,J_meV\n", "from, to and a strength"),
            ("from,to,J_meV\n0,0\n", "line 2 of the table: found 2 columns, the first line has 3"),
            ("from,to,J_meV\n0,x,1\n", "line 2 of the table: \"x\" is no whole number"),
            ("from,to,J_meV\n0,-1,1\n", "atoms are counted from 0"),
            ("from,to,J_meV,J_meV\n0,0,1,1\n", "twice"),
        ] {
            let found = parse(text).unwrap_err().to_string();
            assert!(found.contains(said), "{text:?}: {found}");
        }
    }
}
