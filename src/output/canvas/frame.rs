//! The frame of a plot: from data to places on the canvas, with axes drawn around it.

use super::axis::Axis;
use super::shapes::{Align, Canvas, Point, Text};
use super::{BLACK, LABEL_PT, SMALL_PT, THIN_PT};
use crate::error::Result;

/// A rectangle (pt), y downwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rect {
    /// Left.
    pub x0: f64,
    /// Top.
    pub y0: f64,
    /// Right.
    pub x1: f64,
    /// Bottom.
    pub y1: f64,
}

impl Rect {
    /// Width (pt).
    pub fn width(&self) -> f64 {
        self.x1 - self.x0
    }

    /// Height (pt).
    pub fn height(&self) -> f64 {
        self.y1 - self.y0
    }

    /// Whether a point lies inside.
    pub fn contains(&self, (x, y): Point) -> bool {
        x >= self.x0 && x <= self.x1 && y >= self.y0 && y <= self.y1
    }

    /// Whether another one lies outside.
    pub fn is_apart_from(&self, other: &Rect) -> bool {
        self.x1 < other.x0 || self.x0 > other.x1 || self.y1 < other.y0 || self.y0 > other.y1
    }

    /// Whether another one lies wholly inside.
    pub fn encloses(&self, other: &Rect) -> bool {
        self.contains((other.x0, other.y0)) && self.contains((other.x1, other.y1))
    }

    /// Larger by `d` on every side.
    pub fn grown(&self, d: f64) -> Rect {
        Rect { x0: self.x0 - d, y0: self.y0 - d, x1: self.x1 + d, y1: self.y1 + d }
    }
}

/// On which side of the frame the ticks are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ticks {
    /// Inside, on all four sides.
    Inward,
    /// Outside, left and below, where they cover no cells.
    Outward,
}

/// A plotting area with its two axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Where it lies.
    pub rect: Rect,
    /// Left to right.
    pub x: Axis,
    /// Bottom to top.
    pub y: Axis,
    /// Where the ticks are.
    pub ticks: Ticks,
}

impl Frame {
    const TICK: f64 = 2.5;
    const GAP: f64 = 2.5;

    /// Where a data point lies; `None` where it has no place (a logarithm of zero).
    pub fn place(&self, (x, y): (f64, f64)) -> Option<Point> {
        let (fx, fy) = (self.x.fraction(x)?, self.y.fraction(y)?);
        Some((self.rect.x0 + fx * self.rect.width(), self.rect.y1 - fy * self.rect.height()))
    }

    /// Room needed left of the frame (pt).
    pub fn left_margin(y: &Axis) -> Result<f64> {
        Ok(widest(y)? + Frame::GAP + LABEL_PT + 6.5)
    }

    /// Room needed below the frame (pt).
    pub fn bottom_margin() -> f64 {
        Frame::GAP + SMALL_PT + LABEL_PT + 7.5
    }

    /// The box, inward ticks on all sides, tick labels and axis labels.
    pub fn draw(&self, canvas: &mut Canvas, x_label: &str, y_label: &str) -> Result<()> {
        self.draw_x(canvas, x_label)?;
        self.draw_y(canvas, y_label)?;
        canvas.outline(self.rect, THIN_PT, BLACK);
        Ok(())
    }

    /// The x ticks, without labels.
    pub fn draw_x_ticks(&self, canvas: &mut Canvas) {
        let r = self.rect;
        for x in self.tick_places(&self.x).into_iter().map(|(f, _)| r.x0 + f * r.width()) {
            canvas.line(&[(x, r.y1), (x, r.y1 - self.inward())], THIN_PT, BLACK);
            if self.ticks == Ticks::Inward {
                canvas.line(&[(x, r.y0), (x, r.y0 + Frame::TICK)], THIN_PT, BLACK);
            }
        }
    }

    fn draw_x(&self, canvas: &mut Canvas, label: &str) -> Result<()> {
        let r = self.rect;
        self.draw_x_ticks(canvas);
        let baseline = r.y1 + self.gap() + 0.76 * SMALL_PT;
        for (f, text) in self.tick_places(&self.x) {
            canvas.text((r.x0 + f * r.width(), baseline), Text::new(text, SMALL_PT).align(Align::Centre))?;
        }
        let at = ((r.x0 + r.x1) / 2.0, baseline + 3.5 + LABEL_PT);
        canvas.text(at, Text::new(label, LABEL_PT).align(Align::Centre))
    }

    /// Ticks, tick labels and the label of the y axis.
    pub fn draw_y(&self, canvas: &mut Canvas, label: &str) -> Result<()> {
        let r = self.rect;
        for (f, text) in self.tick_places(&self.y) {
            let y = r.y1 - f * r.height();
            canvas.line(&[(r.x0, y), (r.x0 + self.inward(), y)], THIN_PT, BLACK);
            if self.ticks == Ticks::Inward {
                canvas.line(&[(r.x1, y), (r.x1 - Frame::TICK, y)], THIN_PT, BLACK);
            }
            canvas.text((r.x0 - self.gap(), y + 0.36 * SMALL_PT), Text::new(text, SMALL_PT).align(Align::Right))?;
        }
        let at = (r.x0 - self.gap() - widest(&self.y)? - 4.5, (r.y0 + r.y1) / 2.0);
        canvas.text(at, Text::new(label, LABEL_PT).align(Align::Centre).upwards())
    }

    /// Length of a tick into the frame (pt); negative outwards.
    fn inward(&self) -> f64 {
        if self.ticks == Ticks::Inward { Frame::TICK } else { -Frame::TICK }
    }

    /// Distance of the tick labels from the frame (pt).
    fn gap(&self) -> f64 {
        if self.ticks == Ticks::Inward { Frame::GAP } else { Frame::GAP + 1.5 }
    }

    fn tick_places<'a>(&self, axis: &'a Axis) -> Vec<(f64, &'a str)> {
        axis.ticks.iter().filter_map(|t| Some((axis.fraction(t.at)?, t.label.as_str()))).collect()
    }
}

/// Width of the widest tick label (pt).
fn widest(axis: &Axis) -> Result<f64> {
    axis.ticks.iter().try_fold(0.0, |w: f64, t| Ok(w.max(Text::new(&t.label, SMALL_PT).width()?)))
}
