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
/// More cells than this are averaged, in x and in y.
const MOST: (usize, usize) = (1500, 800);

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
    heat_map(&mut canvas, upper.rect, cells.columns, cells.rows, |c, r| diverging(cells.at(c, r)[2]));
    upper_axes(&upper, &mut canvas)?;
    let labels = [(0.0, "−1"), (0.25, "−0.5"), (0.5, "0"), (0.75, "0.5"), (1.0, "1")];
    colour_bar(&mut canvas, bar(upper.rect), "m_{z}", &labels, |f| diverging(2.0 * f - 1.0))?;

    let lower = Frame { rect: panel(4.0 + height + GAP), x, y, ticks: Ticks::Outward };
    heat_map(&mut canvas, lower.rect, cells.columns, cells.rows, |c, r| in_plane(cells.at(c, r)));
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

/// The spins, averaged over blocks where there are more than anyone can see.
struct Cells {
    columns: usize,
    rows: usize,
    m: Vec<Vector>,
}

impl Cells {
    fn new(path: &Path) -> Cells {
        let (sites, images) = (path.sites(), path.images());
        let (columns, rows) = (sites.min(MOST.0), images.min(MOST.1));
        let block = |k: usize, cells: usize, n: usize| k * n / cells..(k + 1) * n / cells;
        let mut m = Vec::with_capacity(columns * rows);
        for row in 0..rows {
            for column in 0..columns {
                m.push(mean(path, block(row, rows, images), block(column, columns, sites)));
            }
        }
        Cells { columns, rows, m }
    }

    fn at(&self, column: usize, row: usize) -> Vector {
        self.m[row * self.columns + column]
    }
}

/// The mean spin of a block.
fn mean(path: &Path, images: std::ops::Range<usize>, sites: std::ops::Range<usize>) -> Vector {
    let n = path.sites();
    let count = (images.len() * sites.len()).max(1) as f64;
    let mut sum = [0.0; 3];
    for k in images {
        let image = path.image(k);
        for (c, total) in sum.iter_mut().enumerate() {
            *total += image[c * n..][sites.clone()].iter().sum::<f64>();
        }
    }
    sum.map(|total| total / count)
}
