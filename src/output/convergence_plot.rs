//! `convergence.svg` and `.png`: what was left to do, iteration by iteration of the band. Above, on a logarithmic axis, the largest
//! rotation still predicted and the largest force across the path; below, the highest image above the initial state.
//!
//! Where the number of images changes a line is drawn, and the numbers stand above it. Their numbers are those of `history.csv`.

use super::canvas::{
    Align, Axis, AxisLabel, BLACK, BLUE, Canvas, Frame, GREY, LABEL_PT, LinePlot, Look, MM, Marker, Rect, SMALL_PT,
    Scale, Series, THIN_PT, Text, Tick, Ticks, VERMILLION, decimal, pattern,
};
use super::energy_path_plot::EnergyUnit;
use super::{Plot, PlotData};
use crate::drive::HistoryRow;
use crate::error::Result;

/// The convergence of the band.
#[derive(Clone, Copy, Debug)]
pub struct ConvergencePlot;

impl Plot for ConvergencePlot {
    fn name(&self) -> &'static str {
        "convergence"
    }

    fn applies(&self, data: &PlotData) -> bool {
        !data.history.is_empty()
    }

    fn draw(&self, data: &PlotData, look: &Look) -> Result<Canvas> {
        draw(&data.history, look)
    }
}

/// Height of a figure that is a column wide (mm).
const HEIGHT_MM: f64 = 88.0;
/// Room for the numbers of images (pt).
const TOP: f64 = SMALL_PT + 4.5;
/// Room for the legend (pt).
const LEGEND: f64 = SMALL_PT + 6.0;
/// Distance of the two frames (pt).
const GAP: f64 = 7.0;
/// Iterations are marked where there are no more.
const FEW: usize = 60;
/// From this ratio of the highest and lowest energy on their axis is logarithmic.
const WIDE: f64 = 15.0;

fn draw(history: &[HistoryRow], look: &Look) -> Result<Canvas> {
    let aspect = (look.drawn_width_mm() / super::canvas::COLUMN_MM).max(0.85);
    let mut canvas = Canvas::styled(look, HEIGHT_MM * aspect);
    let (left_to_do, energy) = (left_to_do(history), energy(history));
    let inner = canvas.height() - TOP - LEGEND - GAP - Frame::bottom_margin();
    let upper_height = 0.58 * inner;
    let y = |plot: &LinePlot, height: f64| {
        let (lo, hi) = plot.data_range(plot.y.scale, 0.06, |p| p.1);
        Axis::new(lo, hi, plot.y.scale, (height / (2.4 * SMALL_PT)) as usize)
    };
    let axes = [y(&left_to_do, upper_height), y(&energy, inner - upper_height)];
    let left = Frame::left_margin(&axes[0])?.max(Frame::left_margin(&axes[1])?);
    let x = iterations(history, (canvas.width() - left) / (4.0 * SMALL_PT));
    let right = canvas.width() - 1.5 * MM - 2.0;
    let [upper_y, lower_y] = axes;
    let (top, bottom) = (TOP + LEGEND, TOP + LEGEND + upper_height);
    let ticks = Ticks::Inward;
    let upper = Frame { rect: Rect { x0: left, y0: top, x1: right, y1: bottom }, x: x.clone(), y: upper_y, ticks };
    let rect = Rect { x0: left, y0: bottom + GAP, x1: right, y1: top + inner + GAP };
    let lower = Frame { rect, x, y: lower_y, ticks };

    changes_of_images(history, &mut canvas, &upper, &lower)?;
    upper.draw_x_ticks(&mut canvas);
    upper.draw_y(&mut canvas, fitting(&[&left_to_do.y.label, "Remaining"], upper_height)?)?;
    canvas.outline(upper.rect, THIN_PT, BLACK);
    let obstacles = left_to_do.draw_series(&mut canvas, &upper);
    let above = Frame { rect: Rect { y0: LEGEND, ..upper.rect }, ..upper.clone() };
    left_to_do.draw_legend(&mut canvas, &above, &obstacles)?;
    let short = energy.y.label.replace("Highest image", "Highest");
    lower.draw(&mut canvas, "Iteration", fitting(&[&energy.y.label, &short], lower.rect.height())?)?;
    energy.draw_series(&mut canvas, &lower);
    Ok(canvas)
}

fn left_to_do(history: &[HistoryRow]) -> LinePlot {
    let points = |value: fn(&HistoryRow) -> f64| history.iter().map(|r| (r.iteration as f64, value(r))).collect();
    let marked = |s: Series, marker| if history.len() <= FEW { s.marker(marker) } else { s };
    let rotation = Series::line(points(|r| r.largest_predicted_rotation_rad)).colour(BLUE).label("rotation (rad)");
    let torque = Series::line(points(|r| r.max_perpendicular_torque_mev)).colour(VERMILLION).label("torque (meV)");
    LinePlot::new("Iteration", "Largest remaining")
        .log_y()
        .legend_above()
        .with(marked(rotation, Marker::Disc))
        .with(marked(Series { dash: pattern(1), ..torque }, Marker::Square))
}

fn energy(history: &[HistoryRow]) -> LinePlot {
    let unit = EnergyUnit::for_energies(history.iter().map(|r| r.highest_image_mev));
    let points: Vec<(f64, f64)> = history.iter().map(|r| (r.iteration as f64, r.highest_image_mev)).collect();
    let (lo, hi) = points.iter().fold((f64::INFINITY, 0.0f64), |(lo, hi), p| (lo.min(p.1), hi.max(p.1)));
    let scale = if lo > 0.0 && hi > WIDE * lo { Scale::Log } else { Scale::Linear };
    let series = Series::line(unit.scaled(&points)).colour(BLUE);
    let mut plot = LinePlot::new("Iteration", "");
    plot.y = AxisLabel { label: format!("Highest image ({})", unit.name()), scale, range: None };
    plot.with(if history.len() <= FEW { series.marker(Marker::Disc) } else { series })
}

/// The first of some labels that is no longer than its axis, or the last.
fn fitting<'a>(labels: &[&'a str], length: f64) -> Result<&'a str> {
    for label in labels {
        if Text::new(*label, LABEL_PT).width()? <= length {
            return Ok(label);
        }
    }
    Ok(labels[labels.len() - 1])
}

/// From the first iteration to the last, with room on both sides.
fn iterations(history: &[HistoryRow], most: f64) -> Axis {
    let at = |row: Option<&HistoryRow>| row.map_or(1.0, |r| r.iteration as f64);
    let (first, last) = (at(history.first()), at(history.last()));
    let margin = (0.03 * (last - first)).max(0.5);
    let axis = Axis::linear(first - margin, last + margin, most as usize);
    let whole = axis.ticks.into_iter().filter(|t| t.at >= first && t.at <= last && t.at.fract() == 0.0);
    // of few iterations some ticks were between two
    let counted = |t: Tick| if t.at < 1e5 { Tick { label: decimal(t.at, 0), ..t } } else { t };
    Axis { ticks: whole.map(counted).collect(), ..axis }
}

/// Lines where the number of images changes, and the numbers wherever there is room.
fn changes_of_images(history: &[HistoryRow], canvas: &mut Canvas, upper: &Frame, lower: &Frame) -> Result<()> {
    let mut begins = upper.rect.x0;
    let mut taken = 0.0;
    for (k, row) in history.iter().enumerate() {
        let next = history.get(k + 1);
        if next.is_some_and(|next| next.images == row.images) {
            continue;
        }
        let between = |next: &HistoryRow| (row.iteration as f64 + next.iteration as f64) / 2.0;
        let ends = next
            .and_then(|next| upper.x.fraction(between(next)))
            .map_or(upper.rect.x1, |f| upper.rect.x0 + f * upper.rect.width());
        if next.is_some() {
            for r in [upper.rect, lower.rect] {
                canvas.dashed(&[(ends, r.y0), (ends, r.y1)], THIN_PT, GREY, (1.5, 1.5));
            }
        }
        let words = if taken == 0.0 { format!("{} images", row.images) } else { row.images.to_string() };
        let text = Text::new(words, SMALL_PT).align(Align::Centre);
        let (middle, half) = ((begins + ends) / 2.0, text.width()? / 2.0);
        let middle = middle.max(upper.rect.x0 + half);
        if middle - half >= taken && middle + half <= canvas.width() {
            canvas.text((middle, upper.rect.y0 - 3.0), text)?;
            taken = middle + half + 4.0;
        }
        begins = ends;
    }
    Ok(())
}
