//! Tables: `path.csv` (a row an image), `profile.csv` (the interpolated energy path), `history.csv` (a row an iteration), and the
//! numbers of figures that none of these has.
//!
//! Separated by commas; numbers in the shortest form that reads back to the same value.

use super::{Format, RunReport};
use crate::drive::Outcome;
use crate::error::{Error, Result};
use std::fmt::Write;

/// What `csv` writes.
pub(super) const SUMMARY: &str = "path.csv, profile.csv, history.csv: energies by image, interpolated, and by iteration; energy_terms.csv, magnetisation.csv: \
     what their figures show; with rates rates.csv";

/// All tables.
pub(super) fn formats() -> Vec<Box<dyn Format>> {
    let own: [Box<dyn Format>; 4] =
        [Box::new(PathCsv), Box::new(ProfileCsv), Box::new(HistoryCsv), Box::new(super::RatesCsv)];
    own.into_iter().chain(super::PlotTable::all().map(|table| Box::new(table) as Box<dyn Format>)).collect()
}

/// `path.csv`.
#[derive(Clone, Copy, Debug)]
pub struct PathCsv;

/// `profile.csv`.
#[derive(Clone, Copy, Debug)]
pub struct ProfileCsv;

/// `history.csv`.
#[derive(Clone, Copy, Debug)]
pub struct HistoryCsv;

impl Format for PathCsv {
    fn file_name(&self) -> String {
        "path.csv".into()
    }

    fn render(&self, run: &RunReport) -> Result<Vec<u8>> {
        let t = &run.outcome.images;
        let mut table = Table::new("path.csv");
        table.whole("image", 0..t.energy_mev.len());
        for (name, column) in path_columns(run) {
            table.real(&name, column);
        }
        table.render()
    }
}

impl Format for ProfileCsv {
    fn file_name(&self) -> String {
        "profile.csv".into()
    }

    fn render(&self, run: &RunReport) -> Result<Vec<u8>> {
        let profile = &run.outcome.profile;
        let start = start_energy(run.outcome);
        let mut table = Table::new("profile.csv");
        table.real("reaction_coordinate_rad", profile.iter().map(|p| p.reaction_coordinate_rad));
        table.real("energy_meV", profile.iter().map(|p| start + p.above_initial_mev));
        table.real("energy_above_initial_meV", profile.iter().map(|p| p.above_initial_mev));
        for (name, mev) in &run.outcome.profile_terms_mev {
            table.real(&format!("{}_above_initial_meV", column_name(name)), mev.iter().copied());
        }
        table.render()
    }
}

impl Format for HistoryCsv {
    fn file_name(&self) -> String {
        "history.csv".into()
    }

    fn render(&self, run: &RunReport) -> Result<Vec<u8>> {
        let rows = &run.outcome.history;
        let mut table = Table::new("history.csv");
        table.whole("iteration", rows.iter().map(|r| r.iteration));
        table.whole("images", rows.iter().map(|r| r.images));
        table.real("max_perpendicular_torque_meV", rows.iter().map(|r| r.max_perpendicular_torque_mev));
        table.real("largest_predicted_rotation_rad", rows.iter().map(|r| r.largest_predicted_rotation_rad));
        table.real("highest_image_above_initial_meV", rows.iter().map(|r| r.highest_image_mev));
        table.real("length_rad", rows.iter().map(|r| r.length_rad));
        table.render()
    }
}

/// The column of the topological charge.
pub(super) const CHARGE: &str = "charge";

/// The columns of `path.csv` behind the number of the image; the last is the topological charge of films and crystals.
pub(super) fn path_columns(run: &RunReport) -> Vec<(String, Vec<f64>)> {
    let (t, path) = (&run.outcome.images, &run.outcome.path);
    let mut columns = vec![
        ("reaction_coordinate_rad".into(), t.reaction_coordinate_rad.clone()),
        ("energy_meV".into(), t.energy_mev.clone()),
    ];
    columns.extend(t.terms_mev.iter().map(|(term, energy)| (format!("{}_meV", column_name(term)), energy.clone())));
    columns.push(("max_perpendicular_torque_meV".into(), t.max_perpendicular_torque_mev.clone()));
    columns.push(("energy_above_initial_meV".into(), t.above_initial_mev.clone()));
    let charges = run.lattice.triangles().charges((0..path.images()).map(|k| path.image(k)));
    columns.extend(charges.map(|charges| (CHARGE.into(), charges)));
    columns
}

/// Energy of the initial image.
fn start_energy(outcome: &Outcome) -> f64 {
    outcome.images.energy_mev.first().copied().unwrap_or(outcome.initial.energy_mev)
}

/// A term's name without what would break a header.
pub(super) fn column_name(term: &str) -> String {
    term.chars().map(|c| if c.is_whitespace() || matches!(c, ',' | '"') { '_' } else { c }).collect()
}

pub(super) enum Cell {
    Whole(usize),
    Real(f64),
    Word(String),
    Missing,
}

/// Columns under their names; a cell may be empty.
pub(super) struct Table {
    file: &'static str,
    columns: Vec<(String, Vec<Cell>)>,
}

impl Table {
    pub(super) fn new(file: &'static str) -> Table {
        Table { file, columns: Vec::new() }
    }

    pub(super) fn add(&mut self, name: &str, cells: Vec<Cell>) {
        self.columns.push((name.into(), cells));
    }

    /// A column of whole numbers.
    pub(super) fn whole(&mut self, name: &str, values: impl IntoIterator<Item = usize>) {
        self.add(name, values.into_iter().map(Cell::Whole).collect());
    }

    /// A column of numbers.
    pub(super) fn real(&mut self, name: &str, values: impl IntoIterator<Item = f64>) {
        self.add(name, values.into_iter().map(Cell::Real).collect());
    }

    /// An error where a column is too short or too long or a number is not finite.
    pub(super) fn render(&self) -> Result<Vec<u8>> {
        let rows = self.columns.first().map_or(0, |(_, cells)| cells.len());
        if let Some((name, cells)) = self.columns.iter().find(|(_, cells)| cells.len() != rows) {
            return Err(Error::Numerical(format!("{}: {name} has {} rows, not {rows}", self.file, cells.len())));
        }
        let names: Vec<&str> = self.columns.iter().map(|(name, _)| name.as_str()).collect();
        let mut text = names.join(",") + "\n";
        for row in 0..rows {
            for (k, (name, cells)) in self.columns.iter().enumerate() {
                text.push_str(if k > 0 { "," } else { "" });
                self.write_cell(&mut text, name, row, &cells[row])?;
            }
            text.push('\n');
        }
        Ok(text.into_bytes())
    }

    fn write_cell(&self, text: &mut String, name: &str, row: usize, cell: &Cell) -> Result<()> {
        let written = match cell {
            Cell::Whole(n) => write!(text, "{n}"),
            Cell::Word(word) => write!(text, "{word}"),
            Cell::Missing => Ok(()),
            Cell::Real(v) if v.is_finite() => write!(text, "{v:?}"),
            Cell::Real(v) => {
                return Err(Error::Numerical(format!(
                    "{}: {name}, row {}: {v} is not a finite number",
                    self.file,
                    row + 1
                )));
            }
        };
        written.map_err(|e| Error::Numerical(e.to_string()))
    }
}
