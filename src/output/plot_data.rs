//! What figures are drawn from: taken from an outcome, or read back from the files of a result ([`super::StoredRun`]).

use super::csv::column_name;
use super::rates_summary::{PassageEntry, TransitionEntry, transitions};
use super::staggered::SiteKinds;
use super::{EnergyPath, RunReport};
use crate::drive::HistoryRow;
use crate::lattice::Lattice;
use crate::path::Path;
use crate::rates::Way;

/// The numbers of one result's figures.
#[derive(Clone, Debug, Default)]
pub struct PlotData<'a> {
    /// Name of the run.
    pub name: String,
    /// Energies along the path.
    pub energy: EnergyPath,
    /// Energy of each term above that of the initial image (meV), image by image, under the name of its column in `path.csv`.
    pub terms_mev: Vec<(String, Vec<f64>)>,
    /// The same at the points of the interpolated energy path; empty where that is not known.
    pub terms_profile_mev: Vec<Vec<f64>>,
    /// The spins, where they are known.
    pub path: Option<&'a Path>,
    /// Sites without a spin, and those that a staggered state reverses.
    pub kinds: SiteKinds,
    /// Where the sites are, if that is known.
    pub places: Option<Places>,
    /// The lattice, where that is no row: maps draw its sites at their places.
    pub lattice: Option<&'a Lattice>,
    /// One row a band iteration.
    pub history: Vec<HistoryRow>,
    /// Mean times from both ends to the other, where rates were asked for.
    pub lifetimes: Vec<Lifetimes>,
}

/// Positions of the sites of a chain: site i at `first_nm` + i · `spacing_nm`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Places {
    /// Of site 0 (nm): the middle of its cell, or 0 for an atom.
    pub first_nm: f64,
    /// From site to site (nm).
    pub spacing_nm: f64,
}

impl Places {
    /// Of a chain with a spacing.
    pub fn of(lattice: &Lattice) -> Option<Places> {
        let spacing_nm = lattice.spacing_nm?;
        Some(Places { first_nm: lattice.first() * spacing_nm, spacing_nm })
    }
}

/// Rates of leaving one end of the path.
#[derive(Clone, Debug, PartialEq)]
pub struct Lifetimes {
    /// Which end: forward leaves the initial state.
    pub way: Way,
    /// One entry a temperature.
    pub rows: Vec<RateRow>,
}

/// Rates at one temperature; none where a theory was not asked for or has none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RateRow {
    /// Temperature (K).
    pub temperature_k: f64,
    /// ΔE/k_BT of the whole path.
    pub barrier_over_kt: f64,
    /// One over the mean first passage, by harmonic transition-state theory (1/s).
    pub htst_per_s: Option<f64>,
    /// The same by Langer's theory (1/s).
    pub langer_per_s: Option<f64>,
    /// Mean escape over the first saddle (s).
    pub escape_s: Option<f64>,
}

impl<'a> PlotData<'a> {
    /// Of a run.
    pub fn of(run: &RunReport<'a>) -> PlotData<'a> {
        let outcome = run.outcome;
        let transitions = outcome.rates.as_ref().map(transitions).unwrap_or_default();
        PlotData {
            name: run.name.into(),
            energy: EnergyPath::from_outcome(run.name, outcome),
            terms_mev: outcome.images.terms_mev.iter().map(|(name, e)| (column_name(name), above_first(e))).collect(),
            terms_profile_mev: outcome.profile_terms_mev.iter().map(|(_, mev)| mev.clone()).collect(),
            path: Some(&outcome.path),
            kinds: SiteKinds::of(run.lattice),
            places: Places::of(run.lattice),
            lattice: Some(run.lattice).filter(|lattice| !lattice.is_row()),
            history: outcome.history.clone(),
            lifetimes: transitions.iter().map(Lifetimes::of).collect(),
        }
    }

    /// The reaction coordinate of every image (rad).
    pub fn coordinate(&self) -> impl Iterator<Item = f64> + '_ {
        self.energy.images.iter().map(|p| p.0)
    }
}

impl Lifetimes {
    pub(super) fn of(transition: &TransitionEntry) -> Lifetimes {
        let row = |t: &PassageEntry| RateRow {
            temperature_k: t.temperature_K.0,
            barrier_over_kt: t.barrier_over_kT.0,
            htst_per_s: t.htst_rate_per_s.map(|rate| rate.0),
            langer_per_s: t.langer_rate_per_s.map(|rate| rate.0),
            escape_s: t.escape_lifetime_s.map(|time| time.0),
        };
        Lifetimes { way: transition.direction, rows: transition.temperatures.iter().map(row).collect() }
    }
}

/// The energies less the first of them.
pub(super) fn above_first(energies: &[f64]) -> Vec<f64> {
    energies.iter().map(|e| e - energies.first().unwrap_or(&0.0)).collect()
}
