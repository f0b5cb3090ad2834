//! `magnetisation.svg`, `.png` and `.csv`: the mean of the spins along the path, over the reaction coordinate.
//!
//! The mean is ⟨m⟩ = Σ m_i / N over the sites that have a spin, whatever their moments. Its component along an axis e is the thick
//! line: e is the direction in which ⟨m⟩ differs between the two ends, or else the Cartesian axis along which it changes most; a
//! Cartesian axis within 8° takes its place. Where
//! the staggered mean ⟨(−1)^i m_i⟩ changes more, as in an antiferromagnet, it takes the place of the mean.

use super::canvas::{BLUE, Canvas, GREEN, LinePlot, Look, Marker, PURPLE, SKY, Series, VERMILLION, decimal, pattern};
use super::csv::Table;
use super::energy_path_plot::marked_saddles;
use super::staggered::{is_staggered, largest_change, means};
use super::{Plot, PlotData, WriteTable};
use crate::error::{Error, Result};
use crate::geometry::vector::{Vector, dot, sub, unit};

/// The mean spin along the path.
#[derive(Clone, Copy, Debug)]
pub struct MagnetisationPlot;

/// Up to so many images are marked.
const FEW: usize = 45;
/// Ends whose means differ by less choose no axis.
const SAME: f64 = 1e-3;
/// An axis whose cosine with a Cartesian one differs from 1 by no more is it (8°).
const CARTESIAN: f64 = 1e-2;
const NAMES: [&str; 3] = ["x", "y", "z"];

impl Plot for MagnetisationPlot {
    fn name(&self) -> &'static str {
        "magnetisation"
    }

    fn applies(&self, data: &PlotData) -> bool {
        data.path.is_some()
    }

    fn draw(&self, data: &PlotData, look: &Look) -> Result<Canvas> {
        let mean = Mean::of(data)?;
        let along = mean.along_axis();
        let s: Vec<f64> = data.coordinate().collect();
        let label = if mean.staggered { "Staggered mean of m" } else { "Mean of m" };
        let mut plot = LinePlot::new("Reaction coordinate (rad)", label).look(look).legend_above();
        let colours = [GREEN, PURPLE, SKY];
        for c in (0..3).filter(|c| mean.cartesian() != Some(*c)) {
            let points = s.iter().copied().zip(mean.shown().iter().map(|m| m[c])).collect();
            let line = Series::line(points).colour(colours[c]).width(0.8).label(format!("m_{{{}}}", NAMES[c]));
            plot.series.push(Series { dash: pattern(c + 1), ..line });
        }
        let points: Vec<(f64, f64)> = s.iter().copied().zip(along.iter().copied()).collect();
        let marker = (points.len() <= FEW).then_some(Marker::Disc);
        let marked = marked_saddles(&data.energy.saddles, data.energy.length());
        let saddles = marked.iter().filter_map(|p| Some((p.0, at(&points, p.0)?))).collect();
        plot.series
            .insert(0, Series { marker, ..Series::line(points).colour(BLUE).width(1.4).label(mean.axis_name()) });
        plot.series.push(Series::markers(saddles, Marker::Diamond).colour(VERMILLION).label("saddle"));
        let (lo, hi) = plot.data_range(plot.y.scale, 0.06, |p| p.1);
        // what does not change is a line in the middle, not noise
        let middle = (lo + hi) / 2.0;
        plot.y_range(lo.min(middle - 0.01), hi.max(middle + 0.01)).draw()
    }

    fn table(&self) -> Option<WriteTable> {
        Some(table)
    }
}

/// A row an image.
fn table(data: &PlotData) -> Result<Vec<u8>> {
    let mean = Mean::of(data)?;
    let mut table = Table::new("magnetisation.csv");
    table.whole("image", 0..mean.uniform.len());
    table.real("reaction_coordinate_rad", data.coordinate());
    for (kind, means) in [("mean", &mean.uniform), ("staggered_mean", &mean.alternating)] {
        (0..3).for_each(|c| table.real(&format!("{kind}_m_{}", NAMES[c]), means.iter().map(|m| m[c])));
    }
    table.real("shown_along_axis", mean.along_axis());
    (0..3).for_each(|c| table.real(&format!("axis_{}", NAMES[c]), mean.uniform.iter().map(|_| mean.axis[c])));
    table.render()
}

/// The mean spin of every image.
struct Mean {
    uniform: Vec<Vector>,
    alternating: Vec<Vector>,
    /// Whether the second of these is shown.
    staggered: bool,
    axis: Vector,
}

impl Mean {
    fn of(data: &PlotData) -> Result<Mean> {
        let path = data.path.ok_or_else(|| Error::Numerical("magnetisation: the spins are not known".into()))?;
        if path.images() != data.energy.images.len() {
            let (spins, table) = (path.images(), data.energy.images.len());
            return Err(Error::Numerical(format!("magnetisation: spins of {spins} images, energies of {table}")));
        }
        let [uniform, alternating] = [false, true].map(|staggered| means(path, staggered, &data.kinds));
        let staggered = is_staggered(path, &data.kinds);
        let axis = axis(if staggered { &alternating } else { &uniform });
        Ok(Mean { uniform, alternating, staggered, axis })
    }

    fn shown(&self) -> &[Vector] {
        if self.staggered { &self.alternating } else { &self.uniform }
    }

    fn along_axis(&self) -> Vec<f64> {
        self.shown().iter().map(|m| dot(*m, self.axis)).collect()
    }

    /// Which Cartesian axis it is, if it is one.
    fn cartesian(&self) -> Option<usize> {
        (0..3).find(|c| self.axis[*c] > 1.0 - CARTESIAN)
    }

    fn axis_name(&self) -> String {
        match self.cartesian() {
            Some(c) => format!("m_{{{}}}", NAMES[c]),
            None => format!("m·e, e = ({})", self.axis.map(|v| decimal(v, 2)).join(", ")),
        }
    }
}

/// Where the mean goes: positive along the Cartesian axis that is nearest.
fn axis(means: &[Vector]) -> Vector {
    let mut cartesian = [0.0; 3];
    cartesian[largest_change(means).0] = 1.0;
    let (Some(first), Some(last)) = (means.first(), means.last()) else { return cartesian };
    let d = sub(*last, *first);
    let largest = (0..3).fold(0, |a, b| if d[b].abs() > d[a].abs() { b } else { a });
    match unit(d).filter(|_| dot(d, d).sqrt() > SAME) {
        Some(e) if e[largest].abs() > 1.0 - CARTESIAN => {
            let mut exact = [0.0; 3];
            exact[largest] = 1.0;
            exact
        }
        Some(e) => e.map(|v| v * e[largest].signum()),
        None => cartesian,
    }
}

/// The value of a polygon at x.
fn at(points: &[(f64, f64)], x: f64) -> Option<f64> {
    let pair = points.windows(2).find(|p| p[0].0 <= x && x <= p[1].0)?;
    let ((x0, y0), (x1, y1)) = (pair[0], pair[1]);
    if x1 > x0 { Some(y0 + (y1 - y0) * (x - x0) / (x1 - x0)) } else { Some(y0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::test_terms;
    use crate::output::staggered::SiteKinds;
    use crate::path::Path;
    use crate::spins::Spins;

    fn data(path: &Path) -> PlotData<'_> {
        let images = (0..path.images()).map(|k| (k as f64, 0.0)).collect();
        PlotData {
            energy: super::super::EnergyPath { images, ..Default::default() },
            path: Some(path),
            ..Default::default()
        }
    }

    fn path(images: &[&[Vector]]) -> Path {
        Path::new(&images.iter().map(|v| Spins::from_vectors(v).unwrap()).collect::<Vec<_>>())
    }

    #[test]
    fn the_axis_is_the_one_along_which_the_ends_differ() {
        let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let minus = |v: Vector| v.map(|c| -c);
        let reversal = path(&[&[x, x], &[y, y], &[minus(x), minus(x)]]);
        let mean = Mean::of(&data(&reversal)).unwrap();
        assert_eq!((mean.axis_name().as_str(), mean.staggered), ("m_{x}", false));
        assert_eq!(mean.along_axis(), [1.0, 0.0, -1.0]);
        let tilted = path(&[&[x, x], &[z, z]]);
        assert_eq!(Mean::of(&data(&tilted)).unwrap().axis_name(), "m·e, e = (0.71, 0.00, −0.71)");
        // a whole turn: the ends are alike, and y changes as much as x
        let turn = path(&[&[x], &[y], &[minus(x)], &[minus(y)], &[x]]);
        assert_eq!(Mean::of(&data(&turn)).unwrap().axis_name(), "m_{y}");
    }

    #[test]
    fn on_a_film_the_sublattices_are_those_of_a_staggered_state() {
        let lattice = test_terms::lattice(r#"{"square": {"cells": [4, 2]}}"#);
        let up = |i: usize| [0.0, 0.0, if lattice.is_odd(i) { -1.0 } else { 1.0 }];
        let neel: Vec<Vector> = (0..8).map(up).collect();
        let turned: Vec<Vector> = neel.iter().map(|m| m.map(|c| -c)).collect();
        let film = path(&[&neel, &turned]);
        let mean = Mean::of(&PlotData { kinds: SiteKinds::of(&lattice), ..data(&film) }).unwrap();
        assert!(mean.staggered);
        assert_eq!(mean.along_axis(), [1.0, -1.0]);
    }

    #[test]
    fn an_antiferromagnet_shows_its_staggered_mean_and_a_vacancy_counts_for_nothing() {
        let (up, down, x) = ([0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]);
        let neel = path(&[&[up, down, up], &[x, x, x], &[down, up, x]]);
        let vacant = PlotData { kinds: SiteKinds { vacant: vec![false, false, true], odd: Vec::new() }, ..data(&neel) };
        let mean = Mean::of(&vacant).unwrap();
        assert!(mean.staggered);
        assert_eq!(mean.along_axis(), [1.0, 0.0, -1.0]);
    }
}
