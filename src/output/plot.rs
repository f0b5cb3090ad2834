//! The figures of a result: each is a pure function of [`PlotData`], whether that comes from a run or from stored files.

use super::canvas::{Canvas, Look};
use super::{
    ArrheniusPlot, ConvergencePlot, EnergyPathPlot, EnergyTermsPlot, Format, MagnetisationPlot, Picture, PlotData,
    RunReport, SpinsPlot,
};
use crate::error::Result;

/// What writes the numbers of a figure as a table.
pub type WriteTable = fn(&PlotData) -> Result<Vec<u8>>;

/// A figure.
pub trait Plot: Sync {
    /// The name of its files, without the ending.
    fn name(&self) -> &'static str;

    /// Whether there is something to draw.
    fn applies(&self, _: &PlotData) -> bool {
        true
    }

    /// The figure.
    fn draw(&self, data: &PlotData, look: &Look) -> Result<Canvas>;

    /// What writes its numbers as a table, where no other file of a result has them.
    fn table(&self) -> Option<WriteTable> {
        None
    }
}

/// All figures of a result.
pub const PLOTS: &[&dyn Plot] =
    &[&EnergyPathPlot, &EnergyTermsPlot, &SpinsPlot, &MagnetisationPlot, &ConvergencePlot, &ArrheniusPlot];

/// A figure as a file.
#[derive(Clone, Copy)]
pub struct PlotFile {
    /// What is drawn.
    pub plot: &'static dyn Plot,
    /// How it is stored.
    pub picture: Picture,
}

impl PlotFile {
    /// Its name in the directory of the result.
    pub fn name(&self) -> String {
        format!("{}.{}", self.plot.name(), self.picture.extension())
    }

    /// Its bytes; they say what they are a figure of, and below it what is in doubt.
    pub fn bytes(&self, data: &PlotData, look: &Look) -> Result<Vec<u8>> {
        let mut canvas = self.plot.draw(data, look)?.describe(describe(self.plot.name(), &[&data.name]));
        for note in data.energy.certainty.notes() {
            canvas.footnote(&note)?;
        }
        self.picture.render(&canvas)
    }
}

/// The words in a figure's file that tell a figure of these results from any other.
pub fn describe(plot: &str, results: &[&str]) -> String {
    format!("spinneb: {plot} of {}", results.join(", "))
}

impl Format for PlotFile {
    fn file_name(&self) -> String {
        self.name()
    }

    fn applies(&self, run: &RunReport) -> bool {
        self.plot.applies(&PlotData::of(run))
    }

    fn render(&self, run: &RunReport) -> Result<Vec<u8>> {
        self.bytes(&PlotData::of(run), &run.look)
    }
}

/// The numbers of a figure as a file.
#[derive(Clone, Copy)]
pub struct PlotTable {
    plot: &'static dyn Plot,
    write: WriteTable,
}

impl PlotTable {
    /// Those of all figures whose numbers no other file has.
    pub fn all() -> impl Iterator<Item = PlotTable> {
        PLOTS.iter().filter_map(|plot| plot.table().map(|write| PlotTable { plot: *plot, write }))
    }

    /// Its name in the directory of the result.
    pub fn name(&self) -> String {
        format!("{}.csv", self.plot.name())
    }

    /// Its bytes; nothing where there is nothing to draw.
    pub fn bytes(&self, data: &PlotData) -> Result<Option<Vec<u8>>> {
        self.plot.applies(data).then(|| (self.write)(data)).transpose()
    }
}

impl Format for PlotTable {
    fn file_name(&self) -> String {
        self.name()
    }

    fn applies(&self, run: &RunReport) -> bool {
        self.plot.applies(&PlotData::of(run))
    }

    fn render(&self, run: &RunReport) -> Result<Vec<u8>> {
        (self.write)(&PlotData::of(run))
    }
}
