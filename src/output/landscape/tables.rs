//! Tables of all states: `minima.csv`, `saddles.csv`, `lifetimes.csv`; their spins in `landscape.npz`.

use super::LandscapeReport;
use crate::drive::survey::Lifetime;
use crate::error::Result;
use crate::files::{self, Array};
use crate::geometry::Vector;
use crate::output::csv::{CHARGE, Cell, Table};
use crate::spins::Spins;

/// A row a minimum: number, kind (its `id` in `landscape.json`), energy, mean spin, and the charge of films and crystals; where one
/// stands for all its places by translations, their number.
pub(super) fn minima(report: &LandscapeReport) -> Result<Vec<u8>> {
    let s = report.survey;
    let kind = |k: usize| s.minimum_kind(k);
    let all = || 0..s.minima.len();
    let mut table = Table::new("minima.csv");
    table.whole("minimum", all());
    table.whole("kind", all().map(|k| s.minima[k].kind));
    table.real("energy_meV", all().map(|k| kind(k).energy_mev));
    table.real("above_lowest_meV", all().map(|k| kind(k).above_lowest_mev));
    let means: Vec<Vector> = s.minima.iter().map(|m| m.spins.mean(&report.lattice.vacant)).collect();
    for (c, name) in ["mean_spin_x", "mean_spin_y", "mean_spin_z"].into_iter().enumerate() {
        table.real(name, means.iter().map(|mean| mean[c]));
    }
    if let Some(charges) = report.lattice.triangles().charges(s.minima.iter().map(|m| m.spins.as_slice())) {
        table.real(CHARGE, charges);
    }
    if s.has_places() {
        table.whole("places", all().map(|k| kind(k).places));
    }
    table.render()
}

/// A row a saddle: number, kind, energy, the two minima beside it and what the saddle is above them.
pub(super) fn saddles(report: &LandscapeReport) -> Result<Vec<u8>> {
    let s = report.survey;
    let above = |k: usize| s.saddle_kind(k).above_lowest_mev;
    let of_minimum = |k: usize, side: usize| s.minimum_kind(s.saddles[k].minima[side]).above_lowest_mev;
    let all = || 0..s.saddles.len();
    let mut table = Table::new("saddles.csv");
    table.whole("saddle", all());
    table.whole("kind", all().map(|k| s.saddles[k].kind));
    table.whole("minimum_a", all().map(|k| s.saddles[k].minima[0]));
    table.whole("minimum_b", all().map(|k| s.saddles[k].minima[1]));
    table.real("energy_meV", all().map(|k| s.saddle_kind(k).energy_mev));
    table.real("above_lowest_meV", all().map(above));
    table.real("barrier_from_a_meV", all().map(|k| above(k) - of_minimum(k, 0)));
    table.real("barrier_from_b_meV", all().map(|k| above(k) - of_minimum(k, 1)));
    if s.has_places() {
        table.whole("places", all().map(|k| s.saddle_kind(k).places));
    }
    table.render()
}

/// A row a pair of groups (`anywhere`: until the group is left) and temperature. An empty cell: the time exceeds what a double holds,
/// or there is none; `reason` says why.
pub(super) fn lifetimes(report: &LandscapeReport) -> Result<Vec<u8>> {
    let rows: &[Lifetime] = report.survey.lifetimes.as_ref().map_or(&[], |l| &l.rows);
    let mut table = Table::new("lifetimes.csv");
    let words = |word: String| Cell::Word(format!("\"{}\"", word.replace('"', "\"\"")));
    table.add("from", rows.iter().map(|r| words(r.from.clone())).collect());
    table.add("to", rows.iter().map(|r| words(r.to.clone().unwrap_or("anywhere".into()))).collect());
    table.real("temperature_K", rows.iter().map(|r| r.temperature_k));
    let real = |x: Option<f64>| x.filter(|x| x.is_finite()).map_or(Cell::Missing, Cell::Real);
    table.add("climb_meV", rows.iter().map(|r| real(Some(r.climb_mev))).collect());
    for (k, theory) in ["htst", "langer"].into_iter().enumerate() {
        let ln = |r: &Lifetime| r.ln_time_s[k];
        table.add(&format!("{theory}_time_s"), rows.iter().map(|r| real(ln(r).map(libm::exp))).collect());
        let digits = |r: &Lifetime| real(ln(r).map(|ln| ln / std::f64::consts::LN_10));
        table.add(&format!("log10_{theory}_time_s"), rows.iter().map(digits).collect());
    }
    table.add("known_within_factor", rows.iter().map(|r| real(r.known_within)).collect());
    table.add("reason", rows.iter().map(|r| r.reason.clone().map_or(Cell::Missing, words)).collect());
    table.render()
}

/// Spins as (state, site, xyz), energies and what joins what.
pub(super) fn npz(report: &LandscapeReport) -> Result<Vec<u8>> {
    let s = report.survey;
    let sites = report.lattice.sites;
    let spins = |all: Vec<&Spins>| {
        let shape = vec![all.len(), sites, 3];
        Array { shape, numbers: all.into_iter().flat_map(|spins| spins.vectors().into_iter().flatten()).collect() }
    };
    let list = |numbers: Vec<f64>| Array { shape: vec![numbers.len()], numbers };
    let ends = s.saddles.iter().flat_map(|x| x.minima).map(|k| k as f64).collect();
    let arrays = [
        ("minima", spins(s.minima.iter().map(|m| &m.spins).collect())),
        ("minima_meV", list(s.minima.iter().map(|m| s.minimum_kinds[m.kind].energy_mev).collect())),
        ("minima_kind", list(s.minima.iter().map(|m| m.kind as f64).collect())),
        ("saddles", spins(s.saddles.iter().map(|x| &x.spins).collect())),
        ("saddles_meV", list(s.saddles.iter().map(|x| s.saddle_kinds[x.kind].energy_mev).collect())),
        ("saddles_kind", list(s.saddles.iter().map(|x| x.kind as f64).collect())),
        ("saddles_minima", Array { shape: vec![s.saddles.len(), 2], numbers: ends }),
    ];
    files::write_npz(&arrays.map(|(name, array)| (name.to_string(), array)))
}
