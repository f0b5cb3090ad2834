//! `arrhenius.svg` and `.png`: the mean lifetime of both ends against 1000/T, by both theories, on a logarithmic scale.
//!
//! Its numbers are those of `rates.csv`, in the rows of the whole path: the lifetime by a theory is the inverse of its rate.
//! What lies beyond [`LONGEST_S`] or below [`SHORTEST_S`] is left out. Levels of 1 s and ten years are marked.

use super::canvas::{
    Align, BLUE, Canvas, Colour, GREY, LinePlot, Look, Marker, SMALL_PT, Series, THIN_PT, Text, VERMILLION,
};
use super::{Lifetimes, Plot, PlotData, RateRow};
use crate::error::Result;
use crate::rates::{TEN_YEARS_S, Way};

/// The longest lifetime that is drawn (s).
const LONGEST_S: f64 = 1e25;
/// The shortest lifetime that is drawn (s).
const SHORTEST_S: f64 = 1e-15;
/// Up to so many temperatures are marked each.
const FEW: usize = 12;

/// Lifetimes over temperature as a figure.
#[derive(Clone, Copy, Debug)]
pub struct ArrheniusPlot;

impl Plot for ArrheniusPlot {
    fn name(&self) -> &'static str {
        "arrhenius"
    }

    /// One temperature makes no curve; its rates are in `rates.csv`.
    fn applies(&self, data: &PlotData) -> bool {
        data.lifetimes.iter().any(|t| t.rows.len() > 1)
    }

    fn draw(&self, data: &PlotData, look: &Look) -> Result<Canvas> {
        draw_lifetimes(&data.lifetimes, look)
    }
}

/// The lifetimes of the whole transition, forward and (where it differs) backward.
pub fn draw_lifetimes(lifetimes: &[Lifetimes], look: &Look) -> Result<Canvas> {
    let mut plot = LinePlot::new("1000 K / T", "Mean lifetime (s)").log_y().look(look);
    let both_differ = differ(lifetimes);
    for t in lifetimes.iter().filter(|t| both_differ || t.way == Way::Forward) {
        let colour = if t.way == Way::Forward { BLUE } else { VERMILLION };
        let htst_colour = if both_differ { colour } else { VERMILLION };
        let name = |theory: &str| match both_differ {
            true => format!("{theory}, {}", t.way.name()),
            false => theory.to_string(),
        };
        plot.series.extend(curve(&t.rows, |r| r.langer_per_s, name("Langer"), colour, None));
        plot.series.extend(curve(&t.rows, |r| r.htst_per_s, name("HTST"), htst_colour, Some((3.0, 2.0))));
    }
    let (mut canvas, frame) = plot.draw_frame()?;
    for (level, words) in [(1.0, "1 s"), (TEN_YEARS_S, "10 years")] {
        let place =
            frame.place((frame.x.min, level)).filter(|p| frame.rect.grown(-8.0).contains((frame.rect.x0 + 9.0, p.1)));
        if let Some((_, y)) = place.filter(|_| !plot.series.is_empty()) {
            canvas.dashed(&[(frame.rect.x0, y), (frame.rect.x1, y)], THIN_PT, GREY, (2.0, 2.0));
            canvas.text((frame.rect.x1 - 4.0, y - 2.0), Text::new(words, SMALL_PT).align(Align::Right))?;
        }
    }
    let obstacles = plot.draw_series(&mut canvas, &frame);
    plot.draw_legend(&mut canvas, &frame, &obstacles)?;
    Ok(canvas)
}

/// Whether the two directions have different lifetimes, as far as a figure shows.
fn differ(lifetimes: &[Lifetimes]) -> bool {
    let [forward, backward] = lifetimes else { return false };
    let rate = |r: &RateRow| r.langer_per_s.or(r.htst_per_s).unwrap_or(0.0);
    forward.rows.iter().zip(&backward.rows).any(|(f, b)| (rate(f) - rate(b)).abs() > 1e-3 * rate(f).max(rate(b)))
}

/// The lifetimes by one theory that fit into the figure, from hot to cold.
fn curve(
    rows: &[RateRow],
    per_s: fn(&RateRow) -> Option<f64>,
    label: String,
    colour: Colour,
    dash: Option<(f64, f64)>,
) -> Option<Series> {
    let mut points: Vec<(f64, f64)> = rows
        .iter()
        .filter_map(|r| Some((1000.0 / r.temperature_k, 1.0 / per_s(r)?)))
        .filter(|p| (SHORTEST_S..=LONGEST_S).contains(&p.1))
        .collect();
    if points.is_empty() {
        return None;
    }
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let marker = (points.len() <= FEW).then_some(Marker::Disc);
    Some(Series { dash, marker, ..Series::line(points).label(label).colour(colour) })
}
