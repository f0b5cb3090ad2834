//! `spins.svg` and `.png`: all spins of the path, site along x and image along y. Above the component m_z, below the angle
//! φ = atan2(m_y, m_x) about z, which fades to grey where the spin points along z and has no angle.
//!
//! Where the spins lie along x or y much more than along z, as in a film, that axis takes the place of z, and the other two follow in
//! cyclic order: m_x and atan2(m_z, m_y), or m_y and atan2(m_x, m_z).
//!
//! Their numbers are those of `path.npz` (or `path.ovf`, or `spins.csv`).

use super::canvas::{Align, Axis, COLUMN_MM, Canvas, Colour, Frame, LIGHT_GREY, Look, Rect, SMALL_PT, THIN_PT, Ticks};
use super::canvas::{BLACK, Text, colour_bar, cyclic, diverging, heat_map, mix};
use super::{Plot, PlotData};
use crate::error::{Error, Result};
use crate::geometry::vector::Vector;
use crate::path::Path;
use std::f64::consts::PI;

/// The map of the spins as a figure.
#[derive(Clone, Copy, Debug)]
pub struct SpinsPlot;

impl Plot for SpinsPlot {
    fn name(&self) -> &'static str {
        "spins"
    }

    fn applies(&self, data: &PlotData) -> bool {
        data.path.is_some()
    }

    fn draw(&self, data: &PlotData, look: &Look) -> Result<Canvas> {
        let path = data.path.ok_or_else(|| Error::Numerical("spins: the spins are not known".into()))?;
        draw_spins(path, look)
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
pub fn draw_spins(path: &Path, look: &Look) -> Result<Canvas> {
    let mut canvas = Canvas::styled(look, HEIGHT_MM * (look.drawn_width_mm() / COLUMN_MM).max(0.85));
    let grey = look.style().colour(LIGHT_GREY);
    let cells = Cells::new(path);
    let axes = cells.order.map(|c| ["x", "y", "z"][c]);
    let y = Axis::cells(path.images(), 8);
    let left = Frame::left_margin(&y)?;
    let x = Axis::cells(path.sites(), 6);
    let (width, bottom) = (canvas.width() - RIGHT, canvas.height() - Frame::bottom_margin());
    let height = (bottom - 4.0 - GAP) / 2.0;
    let panel = |y0: f64| Rect { x0: left, y0, x1: width, y1: y0 + height };
    let bar = |r: Rect| Rect { x0: r.x1 + 6.0, x1: r.x1 + 6.0 + BAR, ..r };

    let upper = Frame { rect: panel(4.0), x: x.clone(), y: y.clone(), ticks: Ticks::Outward };
    heat_map(&mut canvas, upper.rect, cells.columns, cells.rows, |c, r| diverging(cells.mean_along(c, r)));
    upper_axes(&upper, &mut canvas)?;
    let labels = [(0.0, "−1"), (0.25, "−0.5"), (0.5, "0"), (0.75, "0.5"), (1.0, "1")];
    colour_bar(&mut canvas, bar(upper.rect), &format!("m_{{{}}}", axes[2]), &labels, |f| diverging(2.0 * f - 1.0))?;

    let lower = Frame { rect: panel(4.0 + height + GAP), x, y, ticks: Ticks::Outward };
    heat_map(&mut canvas, lower.rect, cells.columns, cells.rows, |c, r| in_plane(cells.most_in_plane(c, r), grey));
    lower.draw(&mut canvas, "Site", "Image")?;
    let mut angles = bar(lower.rect);
    angles.y1 -= 2.0 * BAR;
    let labels = [(0.0, "−180°"), (0.25, "−90°"), (0.5, "0°"), (0.75, "90°"), (1.0, "180°")];
    let angle = format!("φ = atan2(m_{{{}}}, m_{{{}}})", axes[1], axes[0]);
    colour_bar(&mut canvas, angles, &angle, &labels, |f| cyclic((2.0 * f - 1.0) * PI))?;
    no_angle(&mut canvas, Rect { y0: lower.rect.y1 - BAR, ..bar(lower.rect) }, axes[2])?;
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
fn no_angle(canvas: &mut Canvas, rect: Rect, axis: &str) -> Result<()> {
    canvas.fill(rect, LIGHT_GREY);
    canvas.outline(rect, THIN_PT, BLACK);
    let at = (rect.x1 + 2.5, (rect.y0 + rect.y1) / 2.0 + 0.36 * SMALL_PT);
    canvas.text(at, Text::new(format!("m ∥ {axis}"), SMALL_PT).align(Align::Left))
}

/// The colour of the in-plane angle.
fn in_plane(m: Vector, grey: Colour) -> Colour {
    let length = libm::hypot(m[0], m[1]);
    mix(grey, cyclic(libm::atan2(m[1], m[0])), length / FULL)
}

/// The spins in blocks, where there are more than anyone can see.
struct Cells<'a> {
    path: &'a Path,
    columns: usize,
    rows: usize,
    /// The components that are called x, y and z here: the last one is shown above, the angle is about it.
    order: [usize; 3],
}

/// Another axis than z is chosen where the spins lie along it so many times more (mean squares).
const MORE: f64 = 1.5;

/// The axis along which the spins lie most, last, with the others in cyclic order before it.
fn order(path: &Path) -> [usize; 3] {
    let n = path.sites();
    let square = |c: usize| -> f64 {
        (0..path.images()).map(|k| path.image(k)[c * n..(c + 1) * n].iter().map(|m| m * m).sum::<f64>()).sum()
    };
    let [x, y, z] = [0, 1, 2].map(square);
    let axis = if x.max(y) <= MORE * z { 2 } else { usize::from(y > x) };
    [(axis + 1) % 3, (axis + 2) % 3, axis]
}

impl<'a> Cells<'a> {
    fn new(path: &'a Path) -> Cells<'a> {
        Cells { path, columns: path.sites().min(MOST.0), rows: path.images().min(MOST.1), order: order(path) }
    }

    /// The spins of a block.
    fn block(&self, column: usize, row: usize) -> impl Iterator<Item = Vector> + use<'a> {
        let (path, n, order) = (self.path, self.path.sites(), self.order);
        let range = |k: usize, cells: usize, n: usize| k * n / cells..(k + 1) * n / cells;
        let sites = range(column, self.columns, n);
        range(row, self.rows, path.images())
            .map(|k| path.image(k))
            .flat_map(move |m| sites.clone().map(move |i| order.map(|c| m[c * n + i])))
    }

    /// Mean component of a block along the last axis.
    fn mean_along(&self, column: usize, row: usize) -> f64 {
        let (sum, count) = self.block(column, row).fold((0.0, 0usize), |(sum, count), m| (sum + m[2], count + 1));
        sum / count.max(1) as f64
    }

    /// The spin of a block that lies most in the plane, so that a wall shows that is thinner than a block.
    fn most_in_plane(&self, column: usize, row: usize) -> Vector {
        let length = |m: &Vector| libm::hypot(m[0], m[1]);
        self.block(column, row).max_by(|a, b| length(a).total_cmp(&length(b))).unwrap_or([0.0, 0.0, 1.0])
    }
}
