//! `energy_terms.svg`, `.png` and `.csv`: the energy above the initial state and what each term adds to it, over the reaction
//! coordinate, all through the same interpolation (`profile.csv`), so that the terms add up to the whole between images too.
//!
//! Terms often cancel: where a wall enters, exchange and anisotropy rise, and a field's energy falls.

use super::canvas::{BLACK, Canvas, LinePlot, Look, Marker, SERIES, Series, pattern, turns};
use super::csv::Table;
use super::energy_path_plot::EnergyUnit;
use super::{Plot, PlotData, WriteTable};
use crate::error::Result;

/// The energy path by terms.
#[derive(Clone, Copy, Debug)]
pub struct EnergyTermsPlot;

/// Images are marked where there are no more.
const FEW: usize = 45;

impl Plot for EnergyTermsPlot {
    fn name(&self) -> &'static str {
        "energy_terms"
    }

    /// One term alone is the energy itself.
    fn applies(&self, data: &PlotData) -> bool {
        data.terms_mev.len() > 1
    }

    fn draw(&self, data: &PlotData, look: &Look) -> Result<Canvas> {
        let curves: Vec<Vec<(f64, f64)>> = (0..data.terms_mev.len()).map(|k| curve(data, k)).collect();
        let all = data.energy.energies().chain(curves.iter().flatten().map(|p| p.1));
        let unit = EnergyUnit::for_energies(all);
        let marker = (data.energy.images.len() <= FEW).then_some(Marker::Dot);
        let mut plot = LinePlot::new("Reaction coordinate (rad)", unit.axis_label()).look(look).legend_above();
        let lines: Vec<&[(f64, f64)]> = curves.iter().map(Vec::as_slice).chain([data.energy.curve()]).collect();
        let turns = turns(&lines);
        for (k, (name, mev)) in data.terms_mev.iter().enumerate() {
            let images: Vec<(f64, f64)> = data.coordinate().zip(mev.iter().copied()).collect();
            let colour = SERIES[k % (SERIES.len() - 1)];
            let line = Series::line(unit.scaled(lines[k])).colour(colour).label(name.replace('_', " "));
            plot.series.push(line.in_turn(turns[k], pattern(k + 1)));
            plot.series.extend(marker.map(|m| Series::markers(unit.scaled(&images), m).colour(colour)));
        }
        let (whole, turn) = (data.energy.curve(), turns[curves.len()]);
        let line = Series::line(unit.scaled(whole)).colour(BLACK).width(1.4).label("all terms");
        plot.series.push(line.in_turn(turn, None));
        if unit.is_flat() {
            plot = plot.y_range(-1.2, 1.2);
        }
        plot.draw()
    }

    fn table(&self) -> Option<WriteTable> {
        Some(table)
    }
}

/// A term's energy through the interpolation, or through the images where only these are known.
fn curve(data: &PlotData, term: usize) -> Vec<(f64, f64)> {
    match data.terms_profile_mev.get(term).filter(|mev| mev.len() == data.energy.profile.len() && mev.len() > 1) {
        Some(mev) => data.energy.profile.iter().map(|p| p.0).zip(mev.iter().copied()).collect(),
        None => data.coordinate().zip(data.terms_mev[term].1.iter().copied()).collect(),
    }
}

/// A row an image.
fn table(data: &PlotData) -> Result<Vec<u8>> {
    let mut table = Table::new("energy_terms.csv");
    table.whole("image", 0..data.energy.images.len());
    table.real("reaction_coordinate_rad", data.coordinate());
    table.real("energy_above_initial_meV", data.energy.images.iter().map(|p| p.1));
    for (name, mev) in &data.terms_mev {
        table.real(&format!("{name}_above_initial_meV"), mev.iter().copied());
    }
    table.render()
}
