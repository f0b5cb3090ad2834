//! `barriers.csv`: a row a point, also for those that are missing, whose cells are empty.

use super::found::Prefactors;
use super::{Found, IndexedPoint, PointState, SweepIndex, word};
use crate::error::Result;
use crate::output::csv::{Cell, Table};
use crate::rates::Way;

/// The table of a sweep: its index, a column a swept key, the barrier, what is proven of it, and where it is.
pub fn sweep_table(index: &SweepIndex, states: &[PointState]) -> Result<Vec<u8>> {
    let mut table = Table::new("barriers.csv");
    table.add("index", (0..states.len()).map(Cell::Whole).collect());
    for k in 0..index.keys.len() {
        let parameter = index.parameter(k);
        let cells = match &parameter.numbers {
            Some(_) if index.points.iter().all(|p| p.values[k].is_u64()) => {
                let count = |p: &IndexedPoint| p.values[k].as_u64().and_then(|n| usize::try_from(n).ok());
                index.points.iter().map(|p| count(p).map_or(Cell::Missing, Cell::Whole)).collect()
            }
            Some(numbers) => numbers.iter().copied().map(Cell::Real).collect(),
            None => index.points.iter().map(|p| Cell::Word(quoted(&word(&p.values[k])))).collect(),
        };
        table.add(&quoted(&parameter.column), cells);
    }
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

/// A cell of a table that commas do not break.
fn quoted(text: &str) -> String {
    match text.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.into(),
    }
}
