//! `arrhenius.svg` and `.png`: mean times from both ends against 1000/T, on a logarithmic scale.
//!
//! The mean first passage to the other end by both theories; with minima on the way also the mean escape over the first saddle. The
//! numbers are those of `rates.csv`, in the rows of the whole path. Where the barrier is below [`LOW_BARRIER`] k_BT they are grey,
//! or pale where it is so at all temperatures: there the theories fail by and by, and below k_BT there are none. What lies beyond
//! [`LONGEST_S`] or below [`SHORTEST_S`] is left out, and counted. Levels of 1 s and ten years are marked. One temperature makes no
//! figure.

use super::canvas::{
    BLUE, Canvas, Colour, Frame, GREY, LinePlot, Look, Marker, Obstacles, Point, Rect, SMALL_PT, Series, THIN_PT, Text,
    VERMILLION, WHITE, mix,
};
use super::{Lifetimes, Plot, PlotData, RateRow};
use crate::error::Result;
use crate::rates::{LOW_BARRIER, TEN_YEARS_S, Way};

/// The longest lifetime that is drawn (s).
const LONGEST_S: f64 = 1e25;
/// The shortest lifetime that is drawn (s).
const SHORTEST_S: f64 = 1e-15;
/// Up to so many temperatures are marked each.
const FEW: usize = 12;
/// What of the colour of a pale line is white.
const PALE: f64 = 0.55;

/// Lifetimes over temperature as a figure.
#[derive(Clone, Copy, Debug)]
pub struct ArrheniusPlot;

impl Plot for ArrheniusPlot {
    fn name(&self) -> &'static str {
        "arrhenius"
    }

    /// A curve needs times that are drawn at two temperatures; all others are in `rates.csv` alone.
    fn applies(&self, data: &PlotData) -> bool {
        let is_curve = |t: &Lifetimes| {
            let mut drawn = t.rows.iter().filter(|r| times(r).into_iter().flatten().any(is_drawn));
            drawn.next().is_some_and(|first| drawn.any(|r| r.temperature_k != first.temperature_k))
        };
        data.lifetimes.iter().any(is_curve)
    }

    fn draw(&self, data: &PlotData, look: &Look) -> Result<Canvas> {
        draw_lifetimes(&data.lifetimes, look)
    }
}

/// The times of the whole transition, forward and (where they differ) backward.
pub fn draw_lifetimes(lifetimes: &[Lifetimes], look: &Look) -> Result<Canvas> {
    let mut plot = plot(lifetimes).look(look);
    let (mut canvas, mut frame, mut obstacles) = drawn(&plot)?;
    if plot.is_crowded(&frame, &obstacles)? {
        plot.legend_above = true;
        (canvas, frame, obstacles) = drawn(&plot)?;
    }
    plot.draw_legend(&mut canvas, &frame, &obstacles)?;
    Ok(canvas)
}

/// The curves with their names.
fn plot(lifetimes: &[Lifetimes]) -> LinePlot {
    let both_differ = differ(lifetimes);
    let stops = lifetimes.iter().flat_map(|t| &t.rows).any(escapes_first);
    let axis = if stops { "Mean time (s)" } else { "Mean lifetime (s)" };
    let mut plot = LinePlot::new("1000 K / T", axis).log_y();
    plot.legend_above = stops;
    let mut outside = 0;
    for t in lifetimes.iter().filter(|t| both_differ || t.way == Way::Forward) {
        let colour = if t.way == Way::Forward { BLUE } else { VERMILLION };
        let htst_colour = if both_differ { colour } else { VERMILLION };
        let name = |what: &str| match both_differ {
            true => format!("{what}, {}", t.way.name()),
            false => what.to_string(),
        };
        let passage = |theory: &str| name(&if stops { format!("First passage, {theory}") } else { theory.to_string() });
        let mut add = |kind: usize, label: String, colour: Colour, dash: Option<(f64, f64)>| {
            let known = t.rows.iter().filter_map(|r| times(r)[kind]);
            outside += known.filter(|time| !is_drawn(*time)).count();
            plot.series.extend(curves(&t.rows, |r| times(r)[kind], label, colour, dash));
        };
        add(0, passage("Langer"), colour, None);
        add(1, passage("HTST"), htst_colour, Some((3.0, 2.0)));
        if stops {
            add(2, name("First escape"), colour, Some((0.8, 1.6)));
        }
    }
    // grey lines lie below the others, and one entry at the end of the legend stands for all
    plot.series.sort_by_key(|s| s.label.is_some());
    let Some(point) = plot.series.first().map(|s| s.points[0]) else { return plot };
    let is_pale = |s: &Series| s.label.is_some() && ![BLUE, VERMILLION].map(Some).contains(&s.colour);
    let low = match (plot.series.iter().any(|s| s.label.is_none()), plot.series.iter().any(is_pale)) {
        (false, false) => None,
        (true, false) => Some("Barrier"),
        (false, true) => Some("Pale: barrier"),
        (true, true) => Some("Grey, pale: barrier"),
    };
    let low = low.map(|which| format!("{which} below {LOW_BARRIER} k_{{B}}T"));
    plot.series.extend(low.map(|words| Series::line(vec![point]).label(words).colour(GREY)));
    plot.series.extend(beyond(outside, "rates.csv", point));
    plot
}

/// An entry of the legend, of no line, that so many times are beyond what a figure shows, and in which table they are.
pub(super) fn beyond(times: usize, table: &str, place: Point) -> Option<Series> {
    let points = if times == 1 { "point" } else { "points" };
    let words = format!("{times} {points} beyond, in {table}");
    (times > 0).then(|| Series { width: None, ..Series::line(vec![place]).label(words) })
}

/// Axes, levels and curves, and the places that these take.
fn drawn(plot: &LinePlot) -> Result<(Canvas, Frame, Obstacles)> {
    let (mut canvas, frame) = plot.draw_frame()?;
    // the curves are drawn over the levels, whose names keep clear of them
    let curves = plot.draw_series(&mut canvas.clone(), &frame);
    let mut levels = Vec::new();
    for (time_s, words) in [(1.0, "1 s"), (TEN_YEARS_S, "10 years")] {
        let place =
            frame.place((frame.x.min, time_s)).filter(|p| frame.rect.grown(-8.0).contains((frame.rect.x0 + 9.0, p.1)));
        if let Some((_, y)) = place.filter(|_| !plot.series.is_empty()) {
            levels.push(draw_level(&mut canvas, frame.rect, y, words, &curves)?);
        }
    }
    let mut obstacles = plot.draw_series(&mut canvas, &frame);
    for (line, label) in levels {
        obstacles.add_line(&line);
        obstacles.add_box(label);
    }
    Ok((canvas, frame, obstacles))
}

/// A level across the frame at the height y, its name on the hot side, where times are short, or farther where curves are in its way;
/// what both take.
fn draw_level(canvas: &mut Canvas, r: Rect, y: f64, words: &str, curves: &Obstacles) -> Result<([Point; 2], Rect)> {
    let line = [(r.x0, y), (r.x1, y)];
    canvas.dashed(&line, THIN_PT, GREY, (2.0, 2.0));
    let text = Text::new(words, SMALL_PT);
    let width = text.width()?;
    let room = r.width() - width - 10.0;
    let rooms = [0.0, 0.25, 0.5, 0.75, 1.0].map(|f| r.x0 + 5.0 + f * room).map(|x0| Rect {
        x0,
        y0: y - 2.0 - SMALL_PT,
        x1: x0 + width,
        y1: y,
    });
    let label = rooms[curves.freest(&r, &rooms).map_or(0, |(k, _)| k)];
    canvas.text((label.x0, y - 2.0), text)?;
    Ok((line, label))
}

/// Mean times (s) by Langer's theory and by HTST, and of the first escape.
fn times(r: &RateRow) -> [Option<f64>; 3] {
    [r.langer_per_s.map(|rate| 1.0 / rate), r.htst_per_s.map(|rate| 1.0 / rate), r.escape_s]
}

/// Whether a time (s) is within what a figure shows.
pub(super) fn is_drawn(time_s: f64) -> bool {
    (SHORTEST_S..=LONGEST_S).contains(&time_s)
}

/// Whether the two directions have different lifetimes, as far as a figure shows.
fn differ(lifetimes: &[Lifetimes]) -> bool {
    let [forward, backward] = lifetimes else { return false };
    let rate = |r: &RateRow| r.langer_per_s.or(r.htst_per_s).or(r.escape_s.map(|time| 1.0 / time)).unwrap_or(0.0);
    forward.rows.iter().zip(&backward.rows).any(|(f, b)| (rate(f) - rate(b)).abs() > 1e-3 * rate(f).max(rate(b)))
}

/// Whether leaving the first minimum is not the whole way, or all that is known of it.
fn escapes_first(r: &RateRow) -> bool {
    let passage = r.langer_per_s.or(r.htst_per_s);
    r.escape_s.is_some_and(|escape| passage.is_none_or(|rate| (rate * escape - 1.0).abs() > 0.01))
}

/// The times that fit into the figure, from hot to cold: a grey line up to where the barrier is high enough, and one from there.
fn curves(
    rows: &[RateRow],
    time_s: impl Fn(&RateRow) -> Option<f64>,
    label: String,
    colour: Colour,
    dash: Option<(f64, f64)>,
) -> Vec<Series> {
    let shown = |r: &RateRow| Some((1000.0 / r.temperature_k, time_s(r)?, r.barrier_over_kt < LOW_BARRIER));
    let mut points: Vec<(f64, f64, bool)> = rows.iter().filter_map(shown).collect();
    points.retain(|p| is_drawn(p.1));
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let marker = (points.len() <= FEW).then_some(Marker::Disc);
    let low = points.iter().take_while(|p| p.2).count();
    // the grey line reaches to the first point of the other
    let line =
        |part: &[(f64, f64, bool)]| Series { dash, marker, ..Series::line(part.iter().map(|p| (p.0, p.1)).collect()) };
    let grey = (low > 0).then(|| line(&points[..(low + 1).min(points.len())]).colour(GREY));
    if low == points.len() {
        // what is low all along keeps its name, and a colour of its own
        return grey.map(|line| line.label(label).colour(mix(colour, WHITE, PALE))).into_iter().collect();
    }
    grey.into_iter().chain([line(&points[low..]).label(label).colour(colour)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::canvas::Style;

    /// Ten temperatures from 5 to 50 K of a barrier in K, by both theories.
    fn lifetimes(way: Way, barrier_k: f64) -> Lifetimes {
        let row = |t: f64| {
            let rate = 1e11 * (-barrier_k / t).exp();
            let barrier_over_kt = barrier_k / t;
            RateRow {
                temperature_k: t,
                barrier_over_kt,
                htst_per_s: Some(1.5 * rate),
                langer_per_s: Some(rate),
                escape_s: None,
            }
        };
        Lifetimes { way, rows: (1..=10).map(|k| row(5.0 * f64::from(k))).collect() }
    }

    #[test]
    fn times_that_are_not_drawn_are_counted() {
        let count = |barrier_k| plot(&[lifetimes(Way::Forward, barrier_k)]).series.pop().and_then(|s| s.label);
        assert_eq!(count(240.0).as_deref(), Some("Barrier below 5 k_{B}T"));
        // above 1e25 s: at 5, 10 and 15 K, by both theories
        assert_eq!(count(1500.0).as_deref(), Some("6 points beyond, in rates.csv"));
        assert_eq!(count(20.0).as_deref(), Some("Pale: barrier below 5 k_{B}T"));
    }

    #[test]
    fn neither_legend_nor_names_of_levels_are_on_a_curve() {
        for width in [60.0, 85.0, 120.0] {
            let look = Look::new(Style::Paper, Some(width)).unwrap();
            for (forward, backward) in [(300.0, 300.0), (300.0, 250.0), (300.0, 60.0), (250.0, 1500.0), (20.0, 300.0)] {
                let both = [lifetimes(Way::Forward, forward), lifetimes(Way::Backward, backward)];
                let canvas = draw_lifetimes(&both, &look).unwrap();
                canvas.assert_legible();
                let mut curves = Obstacles::default();
                canvas.lines(1.0).for_each(|line| curves.add_line(line));
                for (words, room) in canvas.texts() {
                    assert_eq!(curves.hits(&room), 0, "{words:?} of {forward} K and {backward} K, {width} mm");
                }
                // of a barrier of 20 K all is pale, with its name
                let want = if forward == backward { 1 } else { 2 };
                assert_eq!(canvas.texts().iter().filter(|(words, _)| words.starts_with("Langer")).count(), want);
            }
        }
    }
}
