//! `rates.csv`: a row for each saddle, direction and temperature; in the rows of the whole path the saddle is `all`.
//!
//! An empty cell: the theory was not asked for or refused, or the lifetime exceeds what a double holds.

use super::csv::{Cell, Table};
use super::{Format, RunReport};
use crate::error::Result;
use crate::rates::{Row, Way};

/// `rates.csv`.
#[derive(Clone, Copy, Debug)]
pub struct RatesCsv;

impl Format for RatesCsv {
    fn file_name(&self) -> String {
        "rates.csv".into()
    }

    fn applies(&self, run: &RunReport) -> bool {
        run.outcome.rates.is_some()
    }

    fn render(&self, run: &RunReport) -> Result<Vec<u8>> {
        let mut rows: Vec<(String, Way, &Row)> = Vec::new();
        if let Some(rates) = &run.outcome.rates {
            rows.extend(rates.saddles.iter().flat_map(|r| r.rows.iter().map(|row| (r.saddle.to_string(), r.way, row))));
            rows.extend(rates.transitions.iter().flat_map(|t| t.rows.iter().map(|row| ("all".into(), t.way, row))));
        }
        let mut table = Table::new("rates.csv");
        table.add("saddle", rows.iter().map(|(saddle, ..)| Cell::Word(saddle.clone())).collect());
        table.add("direction", rows.iter().map(|(_, way, _)| Cell::Word(way.name().into())).collect());
        let mut column = |name: &str, value: fn(&Row) -> Option<f64>| {
            let cell = |row: &Row| value(row).filter(|v| v.is_finite()).map_or(Cell::Missing, Cell::Real);
            table.add(name, rows.iter().map(|(_, _, row)| cell(row)).collect());
        };
        column("temperature_K", |r| Some(r.temperature_k));
        column("barrier_over_kT", |r| Some(r.barrier_over_kt));
        column("htst_rate_per_s", |r| r.ln_htst_per_s.map(libm::exp));
        column("langer_rate_per_s", |r| r.ln_langer_per_s.map(libm::exp));
        column("lifetime_s", |r| r.ln_lifetime_s().map(libm::exp));
        column("log10_lifetime_s", |r| r.ln_lifetime_s().map(|ln| ln / std::f64::consts::LN_10));
        table.render()
    }
}
