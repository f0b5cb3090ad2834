//! The display list: what is drawn, before any file format.

use super::palette::{Colour, VERMILLION};
use super::{Look, MIN_PT, MM, Rect, SMALL_PT, Style};
use crate::error::Result;
use crate::output::font::width_em;
use std::ops::Range;

/// A place on the canvas (pt), y downwards.
pub type Point = (f64, f64);

/// Which part of a text is at its place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Align {
    /// Its beginning.
    #[default]
    Left,
    /// Its middle.
    Centre,
    /// Its end.
    Right,
}

/// A line of text. `_{…}` is a subscript.
#[derive(Clone, Debug, PartialEq)]
pub struct Text {
    /// The characters.
    pub text: String,
    /// Size of the font (pt).
    pub size: f64,
    /// What is at the place.
    pub align: Align,
    /// Read from bottom to top.
    pub upwards: bool,
    /// Its colour.
    pub colour: Colour,
}

impl Text {
    /// Black, left-aligned, horizontal.
    pub fn new(text: impl Into<String>, size: f64) -> Text {
        Text { text: text.into(), size, align: Align::Left, upwards: false, colour: super::BLACK }
    }

    /// Aligned otherwise.
    pub fn align(self, align: Align) -> Text {
        Text { align, ..self }
    }

    /// Read from bottom to top.
    pub fn upwards(self) -> Text {
        Text { upwards: true, ..self }
    }

    /// In another colour.
    pub fn colour(self, colour: Colour) -> Text {
        Text { colour, ..self }
    }

    /// Its width (pt).
    pub fn width(&self) -> Result<f64> {
        runs(&self.text).iter().map(|run| run.width(self.size)).sum()
    }
}

/// A piece of text at one height.
struct Run<'a> {
    text: &'a str,
    subscript: bool,
}

impl Run<'_> {
    const SUBSCRIPT_SIZE: f64 = 0.8;
    const SUBSCRIPT_DROP: f64 = 0.22;

    fn size(&self, size: f64) -> f64 {
        if self.subscript { (size * Run::SUBSCRIPT_SIZE).max(MIN_PT) } else { size }
    }

    fn drop(&self, size: f64) -> f64 {
        if self.subscript { size * Run::SUBSCRIPT_DROP } else { 0.0 }
    }

    fn width(&self, size: f64) -> Result<f64> {
        Ok(width_em(self.text)? * self.size(size))
    }

    /// Width of the spaces before the first letter, which an SVG viewer would swallow.
    fn indent(&self, size: f64) -> Result<f64> {
        Ok(width_em(&self.text[..self.text.len() - self.text.trim_start().len()])? * self.size(size))
    }
}

/// "E_{0} (meV)" → "E", ₀"0", " (meV)".
fn runs(text: &str) -> Vec<Run<'_>> {
    let mut found = Vec::new();
    let mut rest = text;
    while let Some((before, subscript, after)) =
        rest.split_once("_{").and_then(|(before, tail)| tail.split_once('}').map(|(s, after)| (before, s, after)))
    {
        found.push(Run { text: before, subscript: false });
        found.push(Run { text: subscript, subscript: true });
        rest = after;
    }
    found.push(Run { text: rest, subscript: false });
    found.retain(|run| !run.text.is_empty());
    found
}

/// One thing drawn.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Shape {
    Line { points: Vec<Point>, width: f64, colour: Colour },
    Polygon { points: Vec<Point>, colour: Colour },
    Box { rect: Rect, colour: Colour },
    Disc { centre: Point, radius: f64, colour: Colour },
    Text { at: Point, text: Text },
}

impl Shape {
    /// The heights (pt) that it lies between.
    pub(super) fn heights(&self) -> Result<Range<f64>> {
        Ok(match self {
            Shape::Line { points, width, .. } => heights(points, width / 2.0),
            Shape::Polygon { points, .. } => heights(points, 0.0),
            Shape::Box { rect, .. } => heights(&[(rect.x0, rect.y0), (rect.x1, rect.y1)], 0.0),
            Shape::Disc { centre, radius, .. } => heights(&[*centre], *radius),
            // no letter is higher or lower than two of the font's sizes
            Shape::Text { at, text } => {
                heights(&[*at], 2.0 * text.size + if text.upwards { text.width()? } else { 0.0 })
            }
        })
    }
}

/// The heights (pt) that points and what is so near to them lie between.
pub(super) fn heights(points: &[Point], near: f64) -> Range<f64> {
    let heights = || points.iter().map(|point| point.1);
    heights().fold(f64::INFINITY, f64::min) - near..heights().fold(f64::NEG_INFINITY, f64::max) + near
}

/// A raster of colours that lies beneath all shapes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Raster {
    pub rect: Rect,
    pub columns: usize,
    pub rows: usize,
    pub rgb: Vec<u8>,
}

/// A figure under construction.
#[derive(Clone, Debug, PartialEq)]
pub struct Canvas {
    pub(super) width_mm: f64,
    pub(super) height_mm: f64,
    pub(super) style: Style,
    pub(super) description: String,
    pub(super) rasters: Vec<Raster>,
    pub(super) shapes: Vec<Shape>,
}

impl Canvas {
    /// An empty white figure.
    pub fn new(width_mm: f64, height_mm: f64) -> Canvas {
        let (style, description) = (Style::Paper, String::new());
        Canvas { width_mm, height_mm, style, description, rasters: Vec::new(), shapes: Vec::new() }
    }

    /// An empty figure that looks so; the height is that before the style's zoom.
    pub fn styled(look: &Look, height_mm: f64) -> Canvas {
        Canvas { style: look.style(), ..Canvas::new(look.drawn_width_mm(), height_mm) }
    }

    /// With words that the file carries unseen.
    pub fn describe(self, description: impl Into<String>) -> Canvas {
        Canvas { description: description.into(), ..self }
    }

    /// Its style.
    pub fn style(&self) -> Style {
        self.style
    }

    /// Width in which is drawn, before the style's zoom (pt).
    pub fn width(&self) -> f64 {
        self.width_mm * MM
    }

    /// Height in which is drawn, before the style's zoom (pt).
    pub fn height(&self) -> f64 {
        self.height_mm * MM
    }

    /// A line through points.
    pub fn line(&mut self, points: &[Point], width: f64, colour: Colour) {
        if points.len() > 1 {
            let colour = self.style.colour(colour);
            self.shapes.push(Shape::Line { points: points.to_vec(), width, colour });
        }
    }

    /// A line drawn `on` points long, then left out for `off`.
    pub fn dashed(&mut self, points: &[Point], width: f64, colour: Colour, dash: (f64, f64)) {
        self.dashed_after(0.0, points, width, colour, dash);
    }

    /// The same, with nothing drawn for `skip` points at first.
    pub fn dashed_after(&mut self, skip: f64, points: &[Point], width: f64, colour: Colour, (on, off): (f64, f64)) {
        for piece in dashes(points, skip, on, off) {
            self.line(&piece, width, colour);
        }
    }

    /// The outline of a rectangle.
    pub fn outline(&mut self, r: Rect, width: f64, colour: Colour) {
        self.line(&[(r.x0, r.y0), (r.x1, r.y0), (r.x1, r.y1), (r.x0, r.y1), (r.x0, r.y0)], width, colour);
    }

    /// A filled polygon.
    pub fn polygon(&mut self, points: &[Point], colour: Colour) {
        let colour = self.style.colour(colour);
        self.shapes.push(Shape::Polygon { points: points.to_vec(), colour });
    }

    /// A filled rectangle.
    pub fn fill(&mut self, rect: Rect, colour: Colour) {
        let colour = self.style.colour(colour);
        self.shapes.push(Shape::Box { rect, colour });
    }

    /// A filled rectangle whose colour is data, the same in every style.
    pub(in crate::output) fn cell(&mut self, rect: Rect, colour: Colour) {
        self.shapes.push(Shape::Box { rect, colour });
    }

    /// A filled circle.
    pub fn disc(&mut self, centre: Point, radius: f64, colour: Colour) {
        let colour = self.style.colour(colour);
        self.shapes.push(Shape::Disc { centre, radius, colour });
    }

    /// Coloured cells that fill a rectangle, beneath everything else; `rgb` row by row from the top.
    pub fn raster(&mut self, rect: Rect, columns: usize, rows: usize, rgb: Vec<u8>) {
        self.rasters.push(Raster { rect, columns, rows, rgb });
    }

    /// Words below the figure, which grows by as many lines as they need.
    pub fn footnote(&mut self, words: &str) -> Result<()> {
        const MARGIN: f64 = 4.0;
        let mut line = String::new();
        let mut lines = Vec::new();
        for word in words.split(' ') {
            let longer = if line.is_empty() { word.to_string() } else { format!("{line} {word}") };
            if !line.is_empty() && Text::new(&longer, SMALL_PT).width()? > self.width() - 2.0 * MARGIN {
                lines.push(std::mem::replace(&mut line, word.to_string()));
            } else {
                line = longer;
            }
        }
        lines.push(line);
        for line in lines {
            let at = (self.width() - MARGIN, self.height() + 0.76 * SMALL_PT);
            self.height_mm += (SMALL_PT + 3.0) / MM;
            self.text(at, Text::new(line, SMALL_PT).align(Align::Right).colour(VERMILLION))?;
        }
        Ok(())
    }

    /// A text with its baseline at a place.
    pub fn text(&mut self, at: Point, text: Text) -> Result<()> {
        let text = Text { colour: self.style.colour(text.colour), ..text };
        let pieces = runs(&text.text);
        if pieces.iter().all(|run| !run.subscript) {
            self.shapes.push(Shape::Text { at, text });
            return Ok(());
        }
        let mut along = match text.align {
            Align::Left => 0.0,
            Align::Centre => -text.width()? / 2.0,
            Align::Right => -text.width()?,
        };
        for run in pieces {
            let drop = run.drop(text.size);
            let along_here = along + run.indent(text.size)?;
            along += run.width(text.size)?;
            let at = if text.upwards { (at.0 + drop, at.1 - along_here) } else { (at.0 + along_here, at.1 + drop) };
            let piece =
                Text { text: run.text.trim().into(), size: run.size(text.size), align: Align::Left, ..text.clone() };
            self.shapes.push(Shape::Text { at, text: piece });
        }
        Ok(())
    }
}

/// The pieces of a dashed line.
fn dashes(points: &[Point], skip: f64, on: f64, off: f64) -> Vec<Vec<Point>> {
    let (mut pieces, mut piece) = (Vec::new(), Vec::new());
    let (mut drawing, mut left) = if skip > 0.0 { (false, skip) } else { (true, on) };
    for pair in points.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let length = libm::hypot(b.0 - a.0, b.1 - a.1);
        let at = |s: f64| (a.0 + (b.0 - a.0) * s / length, a.1 + (b.1 - a.1) * s / length);
        let mut done = 0.0;
        if drawing {
            piece.push(a);
        }
        while length - done > left {
            done += left;
            piece.push(at(done));
            if drawing {
                pieces.push(std::mem::take(&mut piece));
            }
            drawing = !drawing;
            left = if drawing { on } else { off }.max(0.1);
        }
        left -= length - done;
    }
    if let (true, Some(&last)) = (drawing, points.last()) {
        piece.push(last);
        pieces.push(piece);
    }
    pieces
}

/// What tests look at.
#[cfg(test)]
impl Canvas {
    /// The texts that are read from left to right, and the rooms that they take.
    pub fn texts(&self) -> Vec<(String, Rect)> {
        let room = |(x, y): Point, text: &Text| {
            let width = text.width().unwrap();
            let x0 = match text.align {
                Align::Left => x,
                Align::Centre => x - width / 2.0,
                Align::Right => x - width,
            };
            Rect { x0, y0: y - 0.7 * text.size, x1: x0 + width, y1: y }
        };
        let read = |shape: &'_ Shape| match shape {
            Shape::Text { at, text } if !text.upwards => Some((text.text.clone(), room(*at, text))),
            _ => None,
        };
        self.shapes.iter().filter_map(read).collect()
    }

    /// Lines of at least this width (pt).
    pub fn lines(&self, at_least: f64) -> impl Iterator<Item = &[Point]> {
        self.shapes.iter().filter_map(move |shape| match shape {
            Shape::Line { points, width, .. } if *width >= at_least => Some(points.as_slice()),
            _ => None,
        })
    }

    /// That every text is within the figure, and none touches another.
    pub fn assert_legible(&self) {
        let texts = self.texts();
        let page = Rect { x0: 0.0, y0: 0.0, x1: self.width(), y1: self.height() };
        for (k, (words, room)) in texts.iter().enumerate() {
            assert!(page.encloses(room), "{words:?} leaves the figure: {room:?}");
            for (other, beside) in &texts[k + 1..] {
                // but for the parts of one line
                assert!(room.grown(-0.1).is_apart_from(&beside.grown(-0.1)), "{words:?} touches {other:?}");
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dashed_line_is_cut_into_pieces() {
        let pieces = dashes(&[(0.0, 0.0), (5.0, 0.0)], 0.0, 2.0, 1.0);
        assert_eq!(pieces, [vec![(0.0, 0.0), (2.0, 0.0)], vec![(3.0, 0.0), (5.0, 0.0)]]);
        let pieces = dashes(&[(0.0, 0.0), (5.0, 0.0)], 1.0, 2.0, 1.0);
        assert_eq!(pieces, [vec![(1.0, 0.0), (3.0, 0.0)], vec![(4.0, 0.0), (5.0, 0.0)]]);
    }

    #[test]
    fn subscripts_are_found() {
        let pieces: Vec<_> = runs("E_{0} (meV)").iter().map(|r| (r.text.to_string(), r.subscript)).collect();
        assert_eq!(pieces, [("E".into(), false), ("0".into(), true), (" (meV)".into(), false)]);
        assert_eq!(runs("a_b").len(), 1);
    }
}
