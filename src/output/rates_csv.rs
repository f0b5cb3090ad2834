//! `rates.csv`: a row for each saddle, direction and temperature; in the rows of the whole path the saddle is `all`.
//!
//! A saddle's rows have the lifetime of its own transition. Those of the whole path have the mean first passage to the other end, of
//! which the rates are the inverse, and the mean escape over the first saddle. An empty cell: it is not of that row, the theory was
//! not asked for or refused, the barrier is below k_BT, or the time exceeds what a double holds.

use super::csv::{Cell, Table};
use super::{Format, RunReport};
use crate::error::Result;
use crate::rates::{Row, Way};

/// Saddle, direction, its row, and the escape beside it in a row of the whole path.
type Line<'a> = (String, Way, &'a Row, Option<&'a Row>);

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
        let mut rows: Vec<Line> = Vec::new();
        if let Some(rates) = &run.outcome.rates {
            rows.extend(
                rates.saddles.iter().flat_map(|r| r.rows.iter().map(|row| (r.saddle.to_string(), r.way, row, None))),
            );
            rows.extend(
                rates
                    .transitions
                    .iter()
                    .flat_map(|t| t.rows.iter().map(|row| ("all".into(), t.way, &row.passage, Some(&row.escape)))),
            );
        }
        let mut table = Table::new("rates.csv");
        table.add("saddle", rows.iter().map(|(saddle, ..)| Cell::Word(saddle.clone())).collect());
        table.add("direction", rows.iter().map(|(_, way, ..)| Cell::Word(way.name().into())).collect());
        let mut column = |name: &str, value: &dyn Fn(&Line) -> Option<f64>| {
            let cell = |line| value(line).filter(|v| v.is_finite()).map_or(Cell::Missing, Cell::Real);
            table.add(name, rows.iter().map(cell).collect());
        };
        column("temperature_K", &|l| Some(l.2.temperature_k));
        column("barrier_over_kT", &|l| Some(l.2.barrier_over_kt));
        column("htst_rate_per_s", &|l| l.2.ln_htst_per_s.map(libm::exp));
        column("langer_rate_per_s", &|l| l.2.ln_langer_per_s.map(libm::exp));
        let mut times = |name: &str, ln: &dyn Fn(&Line) -> Option<f64>| {
            column(name, &|l| ln(l).map(libm::exp));
            column(&format!("log10_{name}"), &|l| ln(l).map(|ln| ln / std::f64::consts::LN_10));
        };
        times("lifetime_s", &|l| l.2.ln_lifetime_s().filter(|_| l.3.is_none()));
        times("escape_lifetime_s", &|l| l.3.and_then(Row::ln_lifetime_s));
        times("first_passage_s", &|l| l.2.ln_lifetime_s().filter(|_| l.3.is_some()));
        column("known_within_factor", &|l| l.2.known_within);
        table.render()
    }
}
