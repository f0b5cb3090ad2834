//! `arrhenius.svg` and `.png`: the mean lifetime of both ends against 1000/T, by both theories, on a logarithmic scale.
//!
//! What lies beyond [`LONGEST_S`] or below [`SHORTEST_S`] is left out. Levels of 1 s and ten years are marked.

use super::canvas::{Align, BLUE, Canvas, Colour, GREY, LinePlot, Marker, SMALL_PT, Series, THIN_PT, Text, VERMILLION};
use super::{Format, Picture, RunReport};
use crate::error::{Error, Result};
use crate::rates::{Rates, Row, TEN_YEARS_S, Way};

/// The longest lifetime that is drawn (s).
const LONGEST_S: f64 = 1e25;
/// The shortest lifetime that is drawn (s).
const SHORTEST_S: f64 = 1e-15;
/// Up to so many temperatures are marked each.
const FEW: usize = 12;

/// Lifetimes over temperature as a figure.
#[derive(Clone, Copy, Debug)]
pub struct ArrheniusPlot(pub Picture);

impl Format for ArrheniusPlot {
    fn file_name(&self) -> String {
        format!("arrhenius.{}", self.0.extension())
    }

    fn applies(&self, run: &RunReport) -> bool {
        run.outcome.rates.is_some()
    }

    fn render(&self, run: &RunReport) -> Result<Vec<u8>> {
        let rates = run.outcome.rates.as_ref();
        let rates = rates.ok_or_else(|| Error::Numerical("arrhenius: no rates were computed".into()))?;
        self.0.render(&draw_lifetimes(rates)?)
    }
}

/// The lifetimes of the whole transition, forward and (where it differs) backward.
pub fn draw_lifetimes(rates: &Rates) -> Result<Canvas> {
    let mut plot = LinePlot::new("1000 K / T", "Mean lifetime (s)").log_y();
    let both_differ = differ(rates);
    for t in rates.transitions.iter().filter(|t| both_differ || t.way == Way::Forward) {
        let colour = if t.way == Way::Forward { BLUE } else { VERMILLION };
        let htst_colour = if both_differ { colour } else { VERMILLION };
        let name = |theory: &str| match both_differ {
            true => format!("{theory}, {}", t.way.name()),
            false => theory.to_string(),
        };
        plot.series.extend(curve(&t.rows, |r| r.ln_langer_per_s, name("Langer"), colour, None));
        plot.series.extend(curve(&t.rows, |r| r.ln_htst_per_s, name("HTST"), htst_colour, Some((3.0, 2.0))));
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
fn differ(rates: &Rates) -> bool {
    let [forward, backward] = &rates.transitions[..] else { return false };
    let ln = |r: &Row| r.ln_lifetime_s().unwrap_or(0.0);
    forward.rows.iter().zip(&backward.rows).any(|(f, b)| (ln(f) - ln(b)).abs() > 1e-3)
}

/// The lifetimes by one theory that fit into the figure, from hot to cold.
fn curve(
    rows: &[Row],
    ln_rate: fn(&Row) -> Option<f64>,
    label: String,
    colour: Colour,
    dash: Option<(f64, f64)>,
) -> Option<Series> {
    let mut points: Vec<(f64, f64)> = rows
        .iter()
        .filter_map(|r| Some((1000.0 / r.temperature_k, libm::exp(-ln_rate(r)?))))
        .filter(|p| (SHORTEST_S..=LONGEST_S).contains(&p.1))
        .collect();
    if points.is_empty() {
        return None;
    }
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let marker = (points.len() <= FEW).then_some(Marker::Disc);
    Some(Series { dash, marker, ..Series::line(points).label(label).colour(colour) })
}
