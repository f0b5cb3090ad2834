//! `spins.svg` and `.png`: all spins of the path, site along x and image along y. Above the out-of-plane component m_z, below
//! the in-plane angle φ = atan2(m_y, m_x), which fades to grey where the spin points along z and has no angle.

use super::canvas::{Align, Axis, COLUMN_MM, Canvas, Colour, Frame, LIGHT_GREY, Rect, SMALL_PT, THIN_PT, Ticks};
use super::canvas::{BLACK, Text, colour_bar, cyclic, diverging, heat_map, mix};
use super::{Format, Picture, RunReport};
use crate::error::Result;
use crate::geometry::vector::Vector;
use crate::path::Path;
use std::f64::consts::PI;

/// The map of the spins as a figure.
#[derive(Clone, Copy, Debug)]
pub struct SpinsPlot(pub Picture);

impl Format for SpinsPlot {
    fn file_name(&self) -> String {
        format!("spins.{}", self.0.extension())
    }

    fn render(&self, run: &RunReport) -> Result<Vec<u8>> {
        self.0.render(&draw_spins(&run.outcome.path)?)
    }
}

const HEIGHT_MM: f64 = 92.0;
const BAR: f64 = 8.0;
/// Room right of the maps for the colour bars.
const RIGHT: f64 = 53.0;
const GAP: f64 = 10.0;
/// In-plane length from which an angle has its full colour.
const FULL: f64 = 0.25;
/// More cells than this, in x and in y, are gathered into blocks: their mean m_z, and their angle where they lie most in the plane.
const MOST: (usize, usize) = (600, 400);

/// The figure.
pub fn draw_spins(path: &Path) -> Result<Canvas> {
    let mut canvas = Canvas::new(COLUMN_MM, HEIGHT_MM);
    let cells = Cells::new(path);
    let y = Axis::cells(path.images(), 8);
    let left = Frame::left_margin(&y)?;
    let x = Axis::cells(path.sites(), 6);
    let (width, bottom) = (canvas.width() - RIGHT, canvas.height() - Frame::bottom_margin());
    let height = (bottom - 4.0 - GAP) / 2.0;
    let panel = |y0: f64| Rect { x0: left, y0, x1: width, y1: y0 + height };
    let bar = |r: Rect| Rect { x0: r.x1 + 6.0, x1: r.x1 + 6.0 + BAR, ..r };

    let upper = Frame { rect: panel(4.0), x: x.clone(), y: y.clone(), ticks: Ticks::Outward };
    heat_map(&mut canvas, upper.rect, cells.columns, cells.rows, |c, r| diverging(cells.mean_z(c, r)));
    upper_axes(&upper, &mut canvas)?;
    let labels = [(0.0, "−1"), (0.25, "−0.5"), (0.5, "0"), (0.75, "0.5"), (1.0, "1")];
    colour_bar(&mut canvas, bar(upper.rect), "m_{z}", &labels, |f| diverging(2.0 * f - 1.0))?;

    let lower = Frame { rect: panel(4.0 + height + GAP), x, y, ticks: Ticks::Outward };
    heat_map(&mut canvas, lower.rect, cells.columns, cells.rows, |c, r| in_plane(cells.most_in_plane(c, r)));
    lower.draw(&mut canvas, "Site", "Image")?;
    let mut angles = bar(lower.rect);
    angles.y1 -= 2.0 * BAR;
    let labels = [(0.0, "−180°"), (0.25, "−90°"), (0.5, "0°"), (0.75, "90°"), (1.0, "180°")];
    colour_bar(&mut canvas, angles, "φ = atan2(m_{y}, m_{x})", &labels, |f| cyclic((2.0 * f - 1.0) * PI))?;
    no_angle(&mut canvas, Rect { y0: lower.rect.y1 - BAR, ..bar(lower.rect) })?;
    Ok(canvas)
}

/// Around the upper of two panels that share their x axis.
fn upper_axes(frame: &Frame, canvas: &mut Canvas) -> Result<()> {
    frame.draw_x_ticks(canvas);
    frame.draw_y(canvas, "Image")?;
    canvas.outline(frame.rect, THIN_PT, BLACK);
    Ok(())
}

/// The key for spins without an angle.
fn no_angle(canvas: &mut Canvas, rect: Rect) -> Result<()> {
    canvas.fill(rect, LIGHT_GREY);
    canvas.outline(rect, THIN_PT, BLACK);
    let at = (rect.x1 + 2.5, (rect.y0 + rect.y1) / 2.0 + 0.36 * SMALL_PT);
    canvas.text(at, Text::new("m ∥ z", SMALL_PT).align(Align::Left))
}

/// The colour of the in-plane angle.
fn in_plane(m: Vector) -> Colour {
    let length = m[0].hypot(m[1]);
    mix(LIGHT_GREY, cyclic(libm::atan2(m[1], m[0])), length / FULL)
}

/// The spins in blocks, where there are more than anyone can see.
struct Cells<'a> {
    path: &'a Path,
    columns: usize,
    rows: usize,
}

impl<'a> Cells<'a> {
    fn new(path: &'a Path) -> Cells<'a> {
        Cells { path, columns: path.sites().min(MOST.0), rows: path.images().min(MOST.1) }
    }

    /// The spins of a block.
    fn block(&self, column: usize, row: usize) -> impl Iterator<Item = Vector> + use<'a> {
        let (path, n) = (self.path, self.path.sites());
        let range = |k: usize, cells: usize, n: usize| k * n / cells..(k + 1) * n / cells;
        let sites = range(column, self.columns, n);
        range(row, self.rows, path.images())
            .map(|k| path.image(k))
            .flat_map(move |m| sites.clone().map(move |i| [m[i], m[n + i], m[2 * n + i]]))
    }

    /// Mean m_z of a block.
    fn mean_z(&self, column: usize, row: usize) -> f64 {
        let (sum, count) = self.block(column, row).fold((0.0, 0usize), |(sum, count), m| (sum + m[2], count + 1));
        sum / count.max(1) as f64
    }

    /// The spin of a block that lies most in the plane, so that a wall shows that is thinner than a block.
    fn most_in_plane(&self, column: usize, row: usize) -> Vector {
        let length = |m: &Vector| m[0].hypot(m[1]);
        self.block(column, row).max_by(|a, b| length(a).total_cmp(&length(b))).unwrap_or([0.0, 0.0, 1.0])
    }
}
