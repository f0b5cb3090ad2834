//! `barriers.csv`: a row a point, also for those that are missing, whose cells are empty. `lifetimes.csv`: how long the states live.

use super::found::Prefactors;
use super::{Found, IndexedPoint, PointState, SweepIndex, Times, word};
use crate::error::Result;
use crate::output::csv::{Cell, Table};
use crate::rates::Way;

/// The table of a sweep: its index, a column a swept key, the barrier, what is proven of it, and where it is.
pub fn sweep_table(index: &SweepIndex, states: &[PointState]) -> Result<Vec<u8>> {
    let mut table = Table::new("barriers.csv");
    let all: Vec<usize> = (0..states.len()).collect();
    add_points(&mut table, index, &all);
    let mut column = |name: &str, cell: &dyn Fn(&Found) -> Option<Cell>| {
        let cells = states.iter().map(|s| s.found().and_then(cell).unwrap_or(Cell::Missing));
        table.add(name, cells.collect());
    };
    column("barrier_forward_meV", &|f| f.barrier.map(|b| Cell::Real(b.forward_mev)));
    column("barrier_backward_meV", &|f| f.barrier.map(|b| Cell::Real(b.backward_mev)));
    column("certified", &|f| Some(Cell::Word(f.head.certified.to_string())));
    column("converged", &|f| Some(Cell::Word(f.head.converged.to_string())));
    column("saddles", &|f| Some(Cell::Whole(f.saddles)));
    column("negative_modes", &|f| f.negative_modes.map(Cell::Whole));
    if states.iter().filter_map(PointState::found).any(|f| f.prefactors.is_some()) {
        type Of = fn(&Prefactors) -> [Option<f64>; 2];
        let theories: [(&str, Of); 2] = [("htst", |p| p.htst_hz), ("langer", |p| p.langer_hz)];
        for (theory, of) in theories {
            for (k, way) in Way::BOTH.map(Way::name).into_iter().enumerate() {
                let cell = |f: &Found| f.prefactors.as_ref().and_then(|p| of(p)[k]).map(Cell::Real);
                column(&format!("{theory}_prefactor_{way}_Hz"), &cell);
            }
        }
    }
    table.add("state", states.iter().map(|s| Cell::Word(s.word().into())).collect());
    table.add("directory", index.points.iter().map(|p| Cell::Word(p.directory.clone())).collect());
    table.render()
}

/// `lifetimes.csv`: a row a point, direction and temperature; nothing where no point has rates.
pub fn lifetime_table(index: &SweepIndex, states: &[PointState]) -> Result<Option<Vec<u8>>> {
    let of = |k: usize| states[k].found().into_iter().flat_map(move |f| f.times.iter().map(move |t| (k, f, t)));
    let rows: Vec<(usize, &Found, &Times)> = (0..states.len()).flat_map(of).collect();
    if rows.is_empty() {
        return Ok(None);
    }
    let mut table = Table::new("lifetimes.csv");
    add_points(&mut table, index, &rows.iter().map(|row| row.0).collect::<Vec<_>>());
    table.add("direction", rows.iter().map(|(.., t)| Cell::Word(t.way.name().into())).collect());
    let mut column = |name: &str, value: fn(&Times) -> Option<f64>| {
        let cell = |t: &Times| value(t).filter(|v| v.is_finite()).map_or(Cell::Missing, Cell::Real);
        table.add(name, rows.iter().map(|(.., t)| cell(t)).collect());
    };
    column("temperature_K", |t| Some(t.temperature_k));
    column("barrier_over_kT", |t| Some(t.barrier_over_kt));
    column("escape_lifetime_s", |t| t.log10_escape_s.map(libm::exp10));
    column("log10_escape_lifetime_s", |t| t.log10_escape_s);
    column("first_passage_s", |t| t.log10_passage_s.map(libm::exp10));
    column("log10_first_passage_s", |t| t.log10_passage_s);
    column("known_within_factor", |t| t.known_within);
    table.add("certified", rows.iter().map(|(_, f, _)| Cell::Word(f.head.certified.to_string())).collect());
    table.render().map(Some)
}

/// The index and the swept values of points, one a row.
fn add_points(table: &mut Table, index: &SweepIndex, rows: &[usize]) {
    table.add("index", rows.iter().map(|k| Cell::Whole(*k)).collect());
    for k in 0..index.keys.len() {
        let parameter = index.parameter(k);
        let points = || rows.iter().map(|p| &index.points[*p]);
        let cells = match &parameter.numbers {
            Some(_) if index.points.iter().all(|p| p.values[k].is_u64()) => {
                let count = |p: &IndexedPoint| p.values[k].as_u64().and_then(|n| usize::try_from(n).ok());
                points().map(|p| count(p).map_or(Cell::Missing, Cell::Whole)).collect()
            }
            Some(numbers) => rows.iter().map(|p| Cell::Real(numbers[*p])).collect(),
            None => points().map(|p| Cell::Word(quoted(&word(&p.values[k])))).collect(),
        };
        table.add(&quoted(&parameter.column), cells);
    }
}

/// A cell of a table that commas do not break.
fn quoted(text: &str) -> String {
    match text.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.into(),
    }
}
