//! `energy_terms.svg`, `.png` and `.csv`: the energy above the initial state and what each term adds to it, over the reaction
//! coordinate.
//!
//! Terms often cancel: where a wall enters, exchange and anisotropy rise, and a field's energy falls.

use super::canvas::{BLACK, Canvas, LinePlot, Look, Marker, SERIES, Series, pattern};
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
        let all = data.energy.energies().chain(data.terms_mev.iter().flat_map(|(_, e)| e.iter().copied()));
        let unit = EnergyUnit::for_energies(all);
        let marker = (data.energy.images.len() <= FEW).then_some(Marker::Dot);
        let mut plot = LinePlot::new("Reaction coordinate (rad)", unit.axis_label()).look(look).legend_above();
        for (k, (name, mev)) in data.terms_mev.iter().enumerate() {
            let points: Vec<(f64, f64)> = data.coordinate().zip(mev.iter().copied()).collect();
            let (colour, dash) = (SERIES[k % (SERIES.len() - 1)], pattern(k + 1));
            let line = Series::line(unit.scaled(&points)).colour(colour).label(name.replace('_', " "));
            plot.series.push(Series { dash, ..line });
            plot.series.extend(marker.map(|m| Series::markers(unit.scaled(&points), m).colour(colour)));
        }
        plot.series.push(Series::line(unit.scaled(data.energy.curve())).colour(BLACK).width(1.4).label("all terms"));
        if unit.is_flat() {
            plot = plot.y_range(-1.2, 1.2);
        }
        plot.draw()
    }

    fn table(&self) -> Option<WriteTable> {
        Some(table)
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
