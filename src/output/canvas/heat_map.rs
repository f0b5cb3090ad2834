//! Coloured cells, and the bar that explains their colours.

use super::frame::Rect;
use super::palette::Colour;
use super::shapes::{Canvas, Text};
use super::{BLACK, LABEL_PT, SMALL_PT, THIN_PT};
use crate::error::Result;

/// Up to so many cells are drawn as rectangles, more as an image.
const RECTANGLES: usize = 1000;
/// An image has at least so many pixels a side, for viewers that would blur it.
const PIXELS: usize = 800;

/// Fills `rect` with `columns` × `rows` cells; row 0 is at the bottom.
pub fn heat_map(canvas: &mut Canvas, rect: Rect, columns: usize, rows: usize, colour: impl Fn(usize, usize) -> Colour) {
    if columns == 0 || rows == 0 {
        return;
    }
    if columns * rows <= RECTANGLES {
        rectangles(canvas, rect, columns, rows, colour)
    } else {
        image(canvas, rect, columns, rows, colour)
    }
}

/// Each cell reaches under its right and upper neighbours, so that no seam shows.
fn rectangles(canvas: &mut Canvas, r: Rect, columns: usize, rows: usize, colour: impl Fn(usize, usize) -> Colour) {
    let x = |c: usize| r.x0 + r.width() * c as f64 / columns as f64;
    let y = |k: usize| r.y1 - r.height() * k as f64 / rows as f64;
    for row in 0..rows {
        for column in 0..columns {
            let (x1, y0) = ((x(column + 1) + 0.5).min(r.x1), (y(row + 1) - 0.5).max(r.y0));
            canvas.cell(Rect { x0: x(column), y0, x1, y1: y(row) }, colour(column, row));
        }
    }
}

/// Every cell a whole number of pixels.
fn image(canvas: &mut Canvas, r: Rect, columns: usize, rows: usize, colour: impl Fn(usize, usize) -> Colour) {
    let (wide, high) = (PIXELS.div_ceil(columns), PIXELS.div_ceil(rows));
    let mut rgb = Vec::with_capacity(3 * columns * wide * rows * high);
    for row in (0..rows).rev() {
        let line: Vec<u8> = (0..columns)
            .flat_map(|column| {
                let Colour(r, g, b) = colour(column, row);
                std::iter::repeat_n([r, g, b], wide).flatten()
            })
            .collect();
        (0..high).for_each(|_| rgb.extend_from_slice(&line));
    }
    canvas.raster(r, columns * wide, rows * high, rgb);
}

/// A bar of colours for values from bottom (0) to top (1), with labels at fractions of its height and a title beside it.
pub fn colour_bar(
    canvas: &mut Canvas,
    rect: Rect,
    title: &str,
    labels: &[(f64, &str)],
    colour: impl Fn(f64) -> Colour,
) -> Result<()> {
    // as a small image: many more rectangles than the map itself may have would be a large file
    const STEPS: usize = 256;
    const WIDE: usize = 32;
    let step = |k: usize| colour((k as f64 + 0.5) / STEPS as f64);
    let rgb = (0..STEPS).rev().map(step).flat_map(|Colour(r, g, b)| std::iter::repeat_n([r, g, b], WIDE).flatten());
    canvas.raster(rect, WIDE, STEPS, rgb.collect());
    canvas.outline(rect, THIN_PT, BLACK);
    let mut widest: f64 = 0.0;
    for &(f, label) in labels {
        let y = rect.y1 - f * rect.height();
        canvas.line(&[(rect.x1, y), (rect.x1 - 1.5, y)], THIN_PT, BLACK);
        let text = Text::new(label, SMALL_PT);
        widest = widest.max(text.width()?);
        canvas.text((rect.x1 + 2.5, y + 0.36 * SMALL_PT), text)?;
    }
    let at = (rect.x1 + 2.5 + widest + 2.5 + 0.76 * LABEL_PT, (rect.y0 + rect.y1) / 2.0);
    canvas.text(at, Text::new(title, LABEL_PT).align(super::Align::Centre).upwards())
}
