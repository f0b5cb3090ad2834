//! Lines and markers in a frame.

use super::axis::{Axis, Scale};
use super::frame::{Frame, Rect, Ticks};
use super::obstacles::Obstacles;
use super::palette::{Colour, SERIES};
use super::shapes::{Canvas, Point, Text};
use super::{COLUMN_MM, Look, MM, SMALL_PT, Style, WHITE};
use crate::error::{Error, Result};

/// Height of a figure that is a column wide (mm).
const HEIGHT_MM: f64 = 60.0;
/// Room above the frame (pt).
const TOP: f64 = 4.0;
/// Length of the line in a legend (pt).
const LINE: f64 = 17.0;
/// Distance of its rows (pt).
const PITCH: f64 = SMALL_PT + 3.0;

/// The mark at a data point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    /// A filled circle.
    Disc,
    /// A small filled circle.
    Dot,
    /// A circle with a white inside.
    Ring,
    /// A filled diamond, larger than the circles.
    Diamond,
    /// A filled square.
    Square,
}

/// Points that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// The points, in data coordinates.
    pub points: Vec<(f64, f64)>,
    /// Its name in the legend; none, no entry.
    pub label: Option<String>,
    /// Thickness of the line through the points (pt); none, no line.
    pub width: Option<f64>,
    /// Length of dashes and gaps (pt); none, a full line.
    pub dash: Option<(f64, f64)>,
    /// What a dashed line leaves out before its first dash (pt).
    pub skip: f64,
    /// The mark at each point.
    pub marker: Option<Marker>,
    /// Its colour; none, the next of the palette.
    pub colour: Option<Colour>,
}

impl Series {
    /// A line through points.
    pub fn line(points: Vec<(f64, f64)>) -> Series {
        Series { points, label: None, width: Some(1.0), dash: None, skip: 0.0, marker: None, colour: None }
    }

    /// Marks at points.
    pub fn markers(points: Vec<(f64, f64)>, marker: Marker) -> Series {
        Series { points, label: None, width: None, dash: None, skip: 0.0, marker: Some(marker), colour: None }
    }

    /// With a name.
    pub fn label(self, label: impl Into<String>) -> Series {
        Series { label: Some(label.into()), ..self }
    }

    /// In this colour.
    pub fn colour(self, colour: Colour) -> Series {
        Series { colour: Some(colour), ..self }
    }

    /// With a mark at each point.
    pub fn marker(self, marker: Marker) -> Series {
        Series { marker: Some(marker), ..self }
    }

    /// With so thick a line (pt).
    pub fn width(self, width: f64) -> Series {
        Series { width: Some(width), ..self }
    }

    /// With a dashed line (pt drawn, pt left out).
    pub fn dash(self, on: f64, off: f64) -> Series {
        Series { dash: Some((on, off)), ..self }
    }
}

/// What an axis shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AxisLabel {
    /// Its label, with the unit.
    pub label: String,
    /// Even or logarithmic.
    pub scale: Scale,
    /// The range; none, what the data need and a little more.
    pub range: Option<(f64, f64)>,
}

/// A plot of series.
#[derive(Clone, Debug, PartialEq)]
pub struct LinePlot {
    /// Width of the figure, before the style's zoom (mm).
    pub width_mm: f64,
    /// Height of the figure, before the style's zoom (mm).
    pub height_mm: f64,
    /// Its style.
    pub style: Style,
    /// The legend stands above the frame, as it does where no corner has room for it.
    pub legend_above: bool,
    /// The horizontal axis.
    pub x: AxisLabel,
    /// The vertical axis.
    pub y: AxisLabel,
    /// What is plotted, later ones on top.
    pub series: Vec<Series>,
}

impl LinePlot {
    /// An empty plot one column wide.
    pub fn new(x_label: impl Into<String>, y_label: impl Into<String>) -> LinePlot {
        let axis = |label| AxisLabel { label, ..AxisLabel::default() };
        LinePlot {
            width_mm: COLUMN_MM,
            height_mm: HEIGHT_MM,
            style: Style::Paper,
            legend_above: false,
            x: axis(x_label.into()),
            y: axis(y_label.into()),
            series: Vec::new(),
        }
    }

    /// In this style and width, and as much higher as it is wider.
    pub fn look(mut self, look: &Look) -> LinePlot {
        (self.style, self.width_mm) = (look.style(), look.drawn_width_mm());
        self.height_mm = HEIGHT_MM * (self.width_mm / COLUMN_MM).max(0.85);
        self
    }

    /// With the legend above the frame.
    pub fn legend_above(mut self) -> LinePlot {
        self.legend_above = true;
        self
    }

    /// With one more series.
    pub fn with(mut self, series: Series) -> LinePlot {
        self.series.push(series);
        self
    }

    /// With a logarithmic y axis.
    pub fn log_y(mut self) -> LinePlot {
        self.y.scale = Scale::Log;
        self
    }

    /// With a logarithmic x axis.
    pub fn log_x(mut self) -> LinePlot {
        self.x.scale = Scale::Log;
        self
    }

    /// With this range of x.
    pub fn x_range(mut self, min: f64, max: f64) -> LinePlot {
        self.x.range = Some((min, max));
        self
    }

    /// With this range of y.
    pub fn y_range(mut self, min: f64, max: f64) -> LinePlot {
        self.y.range = Some((min, max));
        self
    }

    /// The finished figure. An error where a number is not finite.
    pub fn draw(&self) -> Result<Canvas> {
        let (mut canvas, frame) = self.draw_frame()?;
        let obstacles = self.draw_series(&mut canvas, &frame);
        if self.is_crowded(&frame, &obstacles)? {
            return self.clone().legend_above().draw();
        }
        self.draw_legend(&mut canvas, &frame, &obstacles)?;
        Ok(canvas)
    }

    /// The axes alone, and the frame to draw into.
    pub fn draw_frame(&self) -> Result<(Canvas, Frame)> {
        if !self.series.iter().flat_map(|s| &s.points).all(|p| p.0.is_finite() && p.1.is_finite()) {
            return Err(Error::Numerical(format!("a number to plot as {:?} is not finite", self.y.label)));
        }
        let above = if self.legend_above { self.rows(self.width_mm * MM)?.len() } else { 0 };
        let height_mm = self.height_mm + PITCH * above as f64 / MM;
        let mut canvas = Canvas { style: self.style, ..Canvas::new(self.width_mm, height_mm) };
        let frame = self.frame(&canvas, TOP + PITCH * above as f64)?;
        frame.draw(&mut canvas, &self.x.label, &self.y.label)?;
        Ok((canvas, frame))
    }

    /// The series, and the places they take.
    pub fn draw_series(&self, canvas: &mut Canvas, frame: &Frame) -> Obstacles {
        let mut obstacles = Obstacles::default();
        for (k, series) in self.series.iter().enumerate() {
            let places: Vec<Point> = series
                .points
                .iter()
                .filter_map(|&p| frame.place(p))
                .filter(|&p| frame.rect.grown(0.5).contains(p))
                .collect();
            let colour = self.colour(k);
            if let Some(width) = series.width {
                stroke(canvas, &places, width, colour, series);
                obstacles.add_line(&places);
            }
            if let Some(marker) = series.marker {
                for &p in &places {
                    mark(canvas, p, marker, colour);
                    obstacles.add_box(Rect { x0: p.0, y0: p.1, x1: p.0, y1: p.1 }.grown(2.0));
                }
            }
        }
        obstacles
    }

    /// Whether the legend is wanted in a corner, and would cover something in each.
    pub fn is_crowded(&self, frame: &Frame, obstacles: &Obstacles) -> Result<bool> {
        Ok(!self.legend_above && !self.entries().is_empty() && self.corner(frame, obstacles)?.is_none())
    }

    /// The first corner in which a legend covers nothing.
    fn corner(&self, frame: &Frame, obstacles: &Obstacles) -> Result<Option<Rect>> {
        let entries = self.entries();
        let (width, height) = (self.column(&entries)? - 4.0, PITCH * entries.len() as f64 + 2.0);
        let corners = corners(&frame.rect.grown(-5.0), width, height);
        let freest = obstacles.freest(&frame.rect, &corners).filter(|(_, hits)| *hits == 0);
        Ok(freest.map(|(k, _)| corners[k]))
    }

    /// The legend, above the frame or in a corner where it covers nothing; nothing without labels.
    pub fn draw_legend(&self, canvas: &mut Canvas, frame: &Frame, obstacles: &Obstacles) -> Result<()> {
        if self.legend_above { self.draw_rows(canvas, frame) } else { self.draw_corner(canvas, frame, obstacles) }
    }

    /// What the legend says of which series.
    fn entries(&self) -> Vec<(usize, Text)> {
        let label = |(k, s): (usize, &Series)| s.label.as_ref().map(|label| (k, Text::new(label, SMALL_PT)));
        self.series.iter().enumerate().filter_map(label).collect()
    }

    /// The legend above the frame, row by row: columns of the widest entry's width, as many as fit.
    fn rows(&self, width: f64) -> Result<Vec<Vec<(usize, Text)>>> {
        let entries = self.entries();
        let fit = (width / self.column(&entries)?.max(1.0)).floor().max(1.0) as usize;
        // rows of equal length
        let fit = entries.len().div_ceil(entries.len().div_ceil(fit).max(1)).max(1);
        Ok(entries.chunks(fit).map(<[_]>::to_vec).collect())
    }

    /// Width of a column of entries (pt).
    fn column(&self, entries: &[(usize, Text)]) -> Result<f64> {
        let widest = entries.iter().try_fold(0.0, |w: f64, (_, t)| Ok::<_, Error>(w.max(t.width()?)))?;
        Ok(LINE + 4.0 + widest + 8.0)
    }

    fn draw_rows(&self, canvas: &mut Canvas, frame: &Frame) -> Result<()> {
        let rows = self.rows(canvas.width())?;
        let column = self.column(&rows.concat())?;
        let most = rows.first().map_or(0, Vec::len) as f64;
        let left = ((frame.rect.x0 + frame.rect.x1 - column * most) / 2.0 + 4.0).max(2.0);
        let left = left.min(canvas.width() - column * most + 6.0).max(1.0);
        let top = frame.rect.y0 - 3.0 - PITCH * rows.len() as f64;
        for (row, entries) in rows.into_iter().enumerate() {
            let y = top + PITCH * (row as f64 + 0.5);
            for (place, (k, text)) in entries.into_iter().enumerate() {
                self.draw_entry(canvas, (left + column * place as f64, y), k, text)?;
            }
        }
        Ok(())
    }

    /// A piece of the line and its name.
    fn draw_entry(&self, canvas: &mut Canvas, (x, y): Point, k: usize, text: Text) -> Result<()> {
        let series = &self.series[k];
        if let Some(width) = series.width {
            stroke(canvas, &[(x + 1.0, y), (x + 1.0 + LINE, y)], width, self.colour(k), series);
        }
        if let Some(marker) = series.marker {
            mark(canvas, (x + 1.0 + LINE / 2.0, y), marker, self.colour(k));
        }
        canvas.text((x + LINE + 5.0, y + 0.36 * SMALL_PT), text)
    }

    fn draw_corner(&self, canvas: &mut Canvas, frame: &Frame, obstacles: &Obstacles) -> Result<()> {
        let Some(r) = self.corner(frame, obstacles)? else { return Ok(()) };
        for (row, (k, text)) in self.entries().into_iter().enumerate() {
            self.draw_entry(canvas, (r.x0, r.y0 + 1.0 + PITCH * (row as f64 + 0.5)), k, text)?;
        }
        Ok(())
    }

    fn colour(&self, k: usize) -> Colour {
        self.series[k].colour.unwrap_or(SERIES[k % SERIES.len()])
    }

    fn frame(&self, canvas: &Canvas, top: f64) -> Result<Frame> {
        let (x0, x1) = self.x.range.unwrap_or_else(|| self.data_range(self.x.scale, 0.03, |p| p.0));
        let (y0, y1) = self.y.range.unwrap_or_else(|| self.data_range(self.y.scale, 0.06, |p| p.1));
        let inner_height = canvas.height() - Frame::bottom_margin() - top;
        let y = Axis::new(y0, y1, self.y.scale, (inner_height / (3.0 * SMALL_PT)) as usize);
        let left = Frame::left_margin(&y)?;
        let x = Axis::new(x0, x1, self.x.scale, ((canvas.width() - left) / (4.5 * SMALL_PT)) as usize);
        let right = self.overhang(&x, canvas.width() - left)?.max(1.5 * MM);
        let rect = Rect { x0: left, y0: top, x1: canvas.width() - right, y1: top + inner_height };
        Ok(Frame { rect, x, y, ticks: Ticks::Inward })
    }

    /// How far the last x label reaches beyond the frame (pt).
    fn overhang(&self, x: &Axis, width: f64) -> Result<f64> {
        let Some(last) = x.ticks.last() else { return Ok(0.0) };
        let inside = (1.0 - x.fraction(last.at).unwrap_or(1.0)) * width;
        Ok(Text::new(&last.label, SMALL_PT).width()? / 2.0 - inside + 1.0)
    }

    /// Smallest and largest value with a margin on both sides.
    pub fn data_range(&self, scale: Scale, margin: f64, value: impl Fn(&(f64, f64)) -> f64) -> (f64, f64) {
        let values = self.series.iter().flat_map(|s| &s.points).map(value);
        let usable = values.filter(|v| scale == Scale::Linear || *v > 0.0);
        let (lo, hi) = usable.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)));
        match scale {
            _ if lo > hi => (0.0, 1.0),
            Scale::Linear => (lo - margin * (hi - lo), hi + margin * (hi - lo)),
            Scale::Log => (lo * libm::pow(lo / hi, margin), hi * libm::pow(hi / lo, margin)),
        }
    }
}

/// Upper right, upper left, lower right, lower left.
fn corners(r: &Rect, width: f64, height: f64) -> [Rect; 4] {
    let at = |x0: f64, y0: f64| Rect { x0, y0, x1: x0 + width, y1: y0 + height };
    [at(r.x1 - width, r.y0), at(r.x0, r.y0), at(r.x1 - width, r.y1 - height), at(r.x0, r.y1 - height)]
}

fn stroke(canvas: &mut Canvas, points: &[Point], width: f64, colour: Colour, series: &Series) {
    match series.dash {
        Some(dash) => canvas.dashed_after(series.skip, points, width, colour, dash),
        None => canvas.line(points, width, colour),
    }
}

/// The mark at a place.
pub fn mark(canvas: &mut Canvas, (x, y): Point, marker: Marker, colour: Colour) {
    match marker {
        Marker::Disc => canvas.disc((x, y), 1.7, colour),
        Marker::Dot => canvas.disc((x, y), 1.1, colour),
        Marker::Ring => {
            canvas.disc((x, y), 1.9, colour);
            canvas.disc((x, y), 1.2, WHITE);
        }
        Marker::Diamond => canvas.polygon(&[(x - 3.4, y), (x, y - 3.4), (x + 3.4, y), (x, y + 3.4)], colour),
        Marker::Square => canvas.fill(Rect { x0: x, y0: y, x1: x, y1: y }.grown(1.6), colour),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_legend_for_which_no_corner_is_free_stands_above_the_frame() {
        let line = |points: Vec<(f64, f64)>| LinePlot::new("x", "y").with(Series::line(points).label("a line"));
        let top = |plot: &LinePlot| plot.draw_frame().unwrap().1.rect.y0;
        let label = |plot: &LinePlot| plot.draw().unwrap().texts().into_iter().find(|t| t.0 == "a line").unwrap().1;
        let free = line(vec![(0.0, 0.0), (1.0, 1.0)]);
        assert!(label(&free).y0 > top(&free));
        let full = line((0..40).map(|k| (f64::from(k), f64::from(k % 2))).collect());
        assert!(label(&full).y1 < top(&full.clone().legend_above()));
        full.draw().unwrap().assert_legible();
    }
}
