//! The tables of a stored result, read back: `path.csv`, `profile.csv`, `history.csv`.

use crate::error::{Error, Result};
use crate::words::quoted;

/// Columns under their names, all of the same length.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Columns {
    /// The file, for messages.
    file: String,
    columns: Vec<(String, Vec<f64>)>,
}

impl Columns {
    /// From a table with a header; every cell a finite number. Two ends in one minimum have no band, and tables of it no rows.
    pub(super) fn read(file: &str, text: &str) -> Result<Columns> {
        let wrong = |line: usize, message: String| Error::invalid(format!("{file}: line {line}"), message);
        let mut lines = text.lines().enumerate();
        let header = lines.next().map(|(_, line)| line).filter(|line| !line.trim().is_empty());
        let header = header.ok_or_else(|| wrong(1, format!("there is no header: {WAY_OUT}")))?;
        let mut columns: Vec<(String, Vec<f64>)> = header.split(',').map(|name| (name.trim().into(), vec![])).collect();
        if !text.ends_with('\n') {
            return Err(wrong(
                text.lines().count(),
                format!("the last line has no end, so it is cut short: {WAY_OUT}"),
            ));
        }
        for (k, line) in lines {
            let cells: Vec<&str> = line.split(',').collect();
            if cells.len() != columns.len() {
                let (found, wanted) = (cells.len(), columns.len());
                return Err(wrong(k + 1, format!("found {found} cells, expected {wanted}: {WAY_OUT}")));
            }
            for ((name, column), cell) in columns.iter_mut().zip(cells) {
                let number = cell.trim().parse().ok().filter(|v: &f64| v.is_finite());
                let message = || format!("{name}: found {}, expected a number: {WAY_OUT}", quoted(cell));
                column.push(number.ok_or_else(|| wrong(k + 1, message()))?);
            }
        }
        Ok(Columns { file: file.into(), columns })
    }

    /// From arrays under their names.
    pub(super) fn from_arrays(file: &str, columns: Vec<(String, Vec<f64>)>) -> Result<Columns> {
        let (file, length) = (file.to_string(), columns.first().map_or(0, |(_, c)| c.len()));
        if let Some((name, column)) = columns.iter().find(|(_, c)| c.len() != length) {
            let found = column.len();
            return Err(Error::invalid(file, format!("the array {name} has {found} numbers, not {length}: {WAY_OUT}")));
        }
        Ok(Columns { file, columns })
    }

    /// Number of rows.
    pub(super) fn rows(&self) -> usize {
        self.columns.first().map_or(0, |(_, c)| c.len())
    }

    /// All columns.
    pub(super) fn all(&self) -> &[(String, Vec<f64>)] {
        &self.columns
    }

    /// The column of this name.
    pub(super) fn named(&self, name: &str) -> Result<&[f64]> {
        let found = self.columns.iter().find(|(n, _)| n == name).map(|(_, c)| &c[..]);
        found.ok_or_else(|| Error::invalid(&self.file, format!("there is no column {}: {WAY_OUT}", quoted(name))))
    }

    /// Two columns as points.
    pub(super) fn points(&self, x: &str, y: &str) -> Result<Vec<(f64, f64)>> {
        Ok(self.named(x)?.iter().copied().zip(self.named(y)?.iter().copied()).collect())
    }
}

/// What to do about a file that is damaged.
pub(super) const WAY_OUT: &str = "the file is damaged; `spinneb run` on the result's config.json, with --force and --out naming \
                                  its folder, writes it anew";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_read_to_the_last_bit() {
        let columns = Columns::read("t.csv", "a,b_meV\n1,0.30000000000000004\n2,-1e-13\n").unwrap();
        assert_eq!(columns.points("a", "b_meV").unwrap(), [(1.0, 0.1 + 0.2), (2.0, -1e-13)]);
        assert_eq!(columns.rows(), 2);
    }

    #[test]
    fn what_is_damaged_is_named_with_its_line() {
        for (text, said) in [
            ("", "t.csv: line 1: there is no header"),
            ("a,b\n1,2\n3\n", "t.csv: line 3: found 1 cells, expected 2"),
            ("a,b\n1,2\n3,x\n", "t.csv: line 3: b: found \"x\", expected a number"),
            ("a,b\n1,NaN\n", "t.csv: line 2: b: found \"NaN\", expected a number"),
            ("a,b\n1,2\n3,4", "t.csv: line 3: the last line has no end"),
        ] {
            let message = Columns::read("t.csv", text).unwrap_err().to_string();
            assert!(message.starts_with(said), "{message}");
        }
        let columns = Columns::read("t.csv", "a\n1\n").unwrap();
        assert!(columns.named("c").unwrap_err().to_string().starts_with("t.csv: there is no column \"c\""));
    }
}
