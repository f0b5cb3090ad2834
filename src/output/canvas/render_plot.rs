//! A canvas as a file: SVG and PNG, both through plotters' backends.
//!
//! The backends know whole pixels only. So an SVG is drawn with many units a point and its root says how large it is,
//! and a PNG is drawn larger and box-averaged.

use super::palette::{Colour, WHITE};
use super::shapes::{Align, Canvas, Point, Raster, Shape, Text};
use crate::base64::base64;
use crate::error::{Error, Result};
use crate::output::font::{glyphs, named};
use plotters::backend::{BitMapBackend, DrawingBackend, SVGBackend};
use plotters::prelude::RGBColor;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontTransform, TextStyle};
use std::fmt::Write;

/// SVG units a point.
const SVG_UNITS: f64 = 20.0;
/// The SVG backend divides a font's size by this to get its em.
const SVG_SIZE_PER_EM: f64 = 1.24;
/// PNG pixels an inch.
const DPI: f64 = 300.0;
/// A PNG is drawn so many times larger.
const OVERSAMPLING: usize = 4;
/// How a figure is packed: in a twentieth of the time that the smallest file takes (the default without a filter), which it exceeds by a
/// third to a whole.
const QUICKLY: (png::Compression, png::FilterType) = (png::Compression::Fast, png::FilterType::Paeth);
/// How a raster within an SVG is packed, whose rows repeat.
const SMALL: (png::Compression, png::FilterType) = (png::Compression::Default, png::FilterType::Up);
/// How every SVG begins.
const SVG_START: &str = "<svg xmlns=\"http://www.w3.org/2000/svg\"";
/// What is around the description in an SVG.
const DESC: &str = "<desc>";
const DESC_END: &str = "</desc>";
/// Under which word a PNG has its description.
const KEYWORD: &str = "Description";
/// What an SVG asks for, best first.
const FONT_STACK: &str = "DejaVu Sans, Verdana, sans-serif";

impl Canvas {
    /// The figure as SVG.
    pub fn svg(&self) -> Result<Vec<u8>> {
        let size = ((self.width() * SVG_UNITS).round() as u32, (self.height() * SVG_UNITS).round() as u32);
        let mut text = String::new();
        let mut backend = SVGBackend::with_string(&mut text, size);
        let mut pen = Pen { backend: &mut backend, scale: SVG_UNITS, kind: Kind::Svg };
        self.shapes.iter().try_for_each(|shape| pen.draw(shape))?;
        backend.present().map_err(refused)?;
        drop(backend);
        Ok(self.finish_svg(&text)?.into_bytes())
    }

    /// The figure as PNG, 300 pixels an inch.
    pub fn png(&self) -> Result<Vec<u8>> {
        let scale = self.style.zoom() * DPI / 72.0;
        let (width, height) = ((self.width() * scale).round() as usize, (self.height() * scale).round() as usize);
        let (wide, high) = (width * OVERSAMPLING, height * OVERSAMPLING);
        let Colour(r, g, b) = self.style.colour(WHITE);
        let mut pixels = [r, g, b].repeat(wide * high);
        let scale = scale * OVERSAMPLING as f64;
        self.rasters.iter().for_each(|r| paint(&mut pixels, (wide, high), r, scale));
        let mut backend = BitMapBackend::with_buffer(&mut pixels, (wide as u32, high as u32));
        let mut pen = Pen { backend: &mut backend, scale, kind: Kind::Pixels };
        self.shapes.iter().try_for_each(|shape| pen.draw(shape))?;
        drop(backend);
        encode_png(&averaged(&pixels, width), (width, height), QUICKLY, &self.description)
    }

    /// The root in millimetres, a white ground, the rasters beneath the shapes, and the font by name.
    fn finish_svg(&self, drawn: &str) -> Result<String> {
        let (root, body) = drawn.split_once('\n').ok_or_else(|| Error::Numerical("the SVG has no root".into()))?;
        let view = root.split("viewBox=\"").nth(1).and_then(|s| s.split('"').next()).unwrap_or_default();
        let mm = |drawn: f64| (drawn * self.style.zoom() * 1e6).round() / 1e6;
        let (width, height, Colour(r, g, b)) = (mm(self.width_mm), mm(self.height_mm), self.style.colour(WHITE));
        let mut svg = format!(
            "{SVG_START} width=\"{width}mm\" height=\"{height}mm\" viewBox=\"{view}\" stroke-linejoin=\"round\">\n"
        );
        if !self.description.is_empty() {
            let _ = writeln!(svg, "{DESC}{}{DESC_END}", escaped(&self.description));
        }
        let _ = writeln!(svg, "<rect width=\"100%\" height=\"100%\" fill=\"#{r:02X}{g:02X}{b:02X}\"/>");
        for raster in &self.rasters {
            svg.push_str(&image_element(raster)?);
        }
        svg.push_str(
            &joined(body)
                .replace(" dy=\"0.76em\"", "")
                .replace("font-family=\"sans-serif\"", &format!("font-family=\"{FONT_STACK}\"")),
        );
        Ok(svg)
    }
}

/// The words that a figure drawn here carries; nothing where it carries none, or is another's.
pub fn description(file: &[u8]) -> Option<String> {
    if file.starts_with(SVG_START.as_bytes()) {
        // its second line, or there is none
        let head = String::from_utf8_lossy(&file[..file.len().min(8192)]);
        let words = head.lines().nth(1)?.strip_prefix(DESC)?.strip_suffix(DESC_END)?;
        return Some(ESCAPES.iter().rev().fold(words.to_string(), |text, (c, code)| text.replace(code, c)));
    }
    let reader = png::Decoder::new(file).read_info().ok()?;
    let chunk = reader.info().utf8_text.iter().find(|chunk| chunk.keyword == KEYWORD)?;
    chunk.get_text().ok()
}

/// Neighbouring lines of one colour and width as one path: the pieces of a dashed line are many.
fn joined(body: &str) -> String {
    const LINE: &str = "<polyline fill=\"none\" opacity=\"1\" ";
    let mut text = String::with_capacity(body.len());
    let mut open = "";
    for line in body.lines() {
        let parts = line.strip_prefix(LINE).and_then(|rest| rest.strip_suffix("\"/>")?.split_once(" points=\""));
        match parts {
            Some((stroke, points)) if stroke == open => {
                let _ = write!(text, "M{}", points.trim_end());
            }
            _ => {
                text.push_str(if open.is_empty() { "" } else { "\"/>\n" });
                open = "";
                match parts {
                    Some((stroke, points)) => {
                        let _ = write!(text, "<path fill=\"none\" {stroke} d=\"M{}", points.trim_end());
                        open = stroke;
                    }
                    None => {
                        text.push_str(&line.replace(" opacity=\"1\"", ""));
                        text.push('\n');
                    }
                }
            }
        }
    }
    text.push_str(if open.is_empty() { "" } else { "\"/>\n" });
    text
}

/// Characters that an SVG writes otherwise.
const ESCAPES: [(&str, &str); 3] = [("&", "&amp;"), ("<", "&lt;"), (">", "&gt;")];

fn escaped(text: &str) -> String {
    ESCAPES.iter().fold(text.to_string(), |text, (c, code)| text.replace(c, code))
}

/// An error of a backend.
fn refused(e: impl std::fmt::Display) -> Error {
    Error::Numerical(format!("the plot cannot be drawn: {e}"))
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Svg,
    Pixels,
}

/// Draws shapes on a backend.
struct Pen<'a, B> {
    backend: &'a mut B,
    scale: f64,
    kind: Kind,
}

impl<B: DrawingBackend> Pen<'_, B> {
    fn draw(&mut self, shape: &Shape) -> Result<()> {
        match shape {
            Shape::Line { points, width, colour } => self.line(points, *width, *colour),
            Shape::Polygon { points, colour } => self.polygon(points, *colour),
            Shape::Box { rect, colour } => {
                let (a, b) = (self.at((rect.x0, rect.y0)), self.at((rect.x1, rect.y1)));
                self.backend.draw_rect(a, b, &rgb(*colour), true).map_err(refused)
            }
            Shape::Disc { centre, radius, colour } => {
                let (centre, radius) = (self.at(*centre), (radius * self.scale).round() as u32);
                self.backend.draw_circle(centre, radius, &rgb(*colour), true).map_err(refused)
            }
            Shape::Text { at, text } => self.text(*at, text),
        }
    }

    fn at(&self, (x, y): Point) -> (i32, i32) {
        ((x * self.scale).round() as i32, (y * self.scale).round() as i32)
    }

    fn polygon(&mut self, points: &[Point], colour: Colour) -> Result<()> {
        let places: Vec<_> = points.iter().map(|&p| self.at(p)).collect();
        self.backend.fill_polygon(places, &rgb(colour)).map_err(refused)
    }

    fn line(&mut self, points: &[Point], width: f64, colour: Colour) -> Result<()> {
        match self.kind {
            Kind::Svg => {
                let places: Vec<_> = points.iter().map(|&p| self.at(p)).collect();
                let style = Color::stroke_width(&rgb(colour), (width * self.scale).round().max(1.0) as u32);
                self.backend.draw_path(places, &style).map_err(refused)
            }
            Kind::Pixels => self.bars(points, width, colour),
        }
    }

    /// A line in pixels: a bar a piece, a disc where thick pieces meet.
    fn bars(&mut self, points: &[Point], width: f64, colour: Colour) -> Result<()> {
        for pair in points.windows(2) {
            let ((ax, ay), (bx, by)) = (pair[0], pair[1]);
            let length = libm::hypot(bx - ax, by - ay);
            if length > 0.0 {
                let (nx, ny) = (-(by - ay) / length * width / 2.0, (bx - ax) / length * width / 2.0);
                self.polygon(
                    &[(ax + nx, ay + ny), (bx + nx, by + ny), (bx - nx, by - ny), (ax - nx, ay - ny)],
                    colour,
                )?;
            }
        }
        let joints = points.get(1..points.len().saturating_sub(1)).unwrap_or_default();
        for &joint in joints {
            let (centre, radius) = (self.at(joint), (width / 2.0 * self.scale).floor() as u32);
            self.backend.draw_circle(centre, radius, &rgb(colour), true).map_err(refused)?;
        }
        Ok(())
    }

    fn text(&mut self, at: Point, text: &Text) -> Result<()> {
        match self.kind {
            Kind::Svg => self.named_text(at, text),
            Kind::Pixels => self.glyphs(at, text),
        }
    }

    /// A text that the viewer sets.
    fn named_text(&mut self, at: Point, text: &Text) -> Result<()> {
        let h_pos = match text.align {
            Align::Left => HPos::Left,
            Align::Centre => HPos::Center,
            Align::Right => HPos::Right,
        };
        let turn = if text.upwards { FontTransform::Rotate270 } else { FontTransform::None };
        let colour = rgb(text.colour);
        let font = named(text.size * self.scale * SVG_SIZE_PER_EM)?.transform(turn);
        let style = TextStyle::from(font).pos(Pos::new(h_pos, VPos::Top)).color(&colour);
        let place = self.at(at);
        self.backend.draw_text(&text.text, &style, place).map_err(refused)
    }

    /// A text glyph by glyph.
    fn glyphs(&mut self, at: Point, text: &Text) -> Result<()> {
        let before = match text.align {
            Align::Left => 0.0,
            Align::Centre => text.width()? / 2.0,
            Align::Right => text.width()?,
        };
        let start = self.at(if text.upwards { (at.0, at.1 + before) } else { (at.0 - before, at.1) });
        let colour = rgb(text.colour);
        for glyph in glyphs(&text.text, text.size * self.scale)? {
            let corner = glyph.px_bounds().min;
            let mut drawn = Ok(());
            glyph.draw(|x, y, coverage| {
                let (x, y) = (corner.x as i32 + x as i32, corner.y as i32 + y as i32);
                let place = if text.upwards { (start.0 + y, start.1 - x) } else { (start.0 + x, start.1 + y) };
                let shade = Color::to_backend_color(&colour.mix(f64::from(coverage.clamp(0.0, 1.0))));
                if drawn.is_ok() && coverage > 0.0 && place.0 >= 0 && place.1 >= 0 {
                    drawn = self.backend.draw_pixel(place, shade).map_err(refused);
                }
            });
            drawn?;
        }
        Ok(())
    }
}

fn rgb(Colour(r, g, b): Colour) -> RGBColor {
    RGBColor(r, g, b)
}

/// The raster's cells on the pixels they cover.
fn paint(pixels: &mut [u8], (wide, high): (usize, usize), raster: &Raster, scale: f64) {
    let r = raster.rect;
    // pixels within the raster, and which of its cells each is in
    let inside = |pixels: usize, start: f64, length: f64, cells: usize| -> Vec<(usize, usize)> {
        let along = (0..pixels).map(|p| (p, ((p as f64 + 0.5) / scale - start) / length));
        let cell = |f: f64| ((f * cells as f64) as usize).min(cells.saturating_sub(1));
        along.filter(|(_, f)| (0.0..1.0).contains(f)).map(|(p, f)| (p, cell(f))).collect()
    };
    let columns = inside(wide, r.x0, r.width(), raster.columns);
    let Some(first) = columns.first().map(|(x, _)| *x) else { return };
    let mut line: Vec<u8> = Vec::with_capacity(3 * columns.len());
    for same in inside(high, r.y0, r.height(), raster.rows).chunk_by(|a, b| a.1 == b.1) {
        let row = &raster.rgb[3 * same[0].1 * raster.columns..][..3 * raster.columns];
        line.clear();
        columns.iter().for_each(|(_, column)| line.extend_from_slice(&row[3 * column..3 * column + 3]));
        for (y, _) in same {
            pixels[3 * (y * wide + first)..][..line.len()].copy_from_slice(&line);
        }
    }
}

/// Each pixel the mean of the block drawn for it.
fn averaged(pixels: &[u8], width: usize) -> Vec<u8> {
    const BLOCK: u16 = (OVERSAMPLING * OVERSAMPLING) as u16;
    let row_bytes = 3 * width * OVERSAMPLING;
    let mut out = Vec::with_capacity(pixels.len() / (OVERSAMPLING * OVERSAMPLING));
    let mut sums = vec![0u16; row_bytes];
    for block in pixels.chunks_exact(row_bytes * OVERSAMPLING) {
        // whole rows first, which is quick
        sums.fill(0);
        for row in block.chunks_exact(row_bytes) {
            sums.iter_mut().zip(row).for_each(|(sum, byte)| *sum += u16::from(*byte));
        }
        for cell in sums.chunks_exact(3 * OVERSAMPLING) {
            let mut sum = [BLOCK / 2; 3];
            for rgb in cell.chunks_exact(3) {
                (0..3).for_each(|c| sum[c] += rgb[c]);
            }
            out.extend_from_slice(&sum.map(|s| (s / BLOCK) as u8));
        }
    }
    out
}

/// RGB pixels as a PNG file that knows its size.
fn encode_png(
    rgb: &[u8],
    (width, height): (usize, usize),
    (compression, filter): (png::Compression, png::FilterType),
    description: &str,
) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(compression);
    encoder.set_filter(filter);
    if !description.is_empty() {
        encoder.add_itxt_chunk(KEYWORD.into(), description.into()).map_err(refused)?;
    }
    let per_metre = (DPI / 0.0254).round() as u32;
    encoder.set_pixel_dims(Some(png::PixelDimensions { xppu: per_metre, yppu: per_metre, unit: png::Unit::Meter }));
    encoder.write_header().and_then(|mut writer| writer.write_image_data(rgb)).map_err(refused)?;
    Ok(bytes)
}

/// A raster as an SVG element that carries its pixels.
fn image_element(raster: &Raster) -> Result<String> {
    let r = raster.rect;
    let data = base64(&encode_png(&raster.rgb, (raster.columns, raster.rows), SMALL, "")?);
    let unit = |v: f64| (v * SVG_UNITS).round();
    Ok(format!(
        "<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" style=\"image-rendering:pixelated\" \
         href=\"data:image/png;base64,{data}\"/>\n",
        unit(r.x0),
        unit(r.y0),
        unit(r.x1) - unit(r.x0),
        unit(r.y1) - unit(r.y0),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pieces_of_a_dashed_line_are_one_path() {
        let line = |colour: &str, points: &str| {
            format!(
                "<polyline fill=\"none\" opacity=\"1\" stroke=\"{colour}\" stroke-width=\"10\" points=\"{points} \"/>\n"
            )
        };
        let body = line("#0", "0,0 1,0")
            + &line("#0", "2,0 3,0")
            + &line("#1", "0,1 1,1")
            + "<circle opacity=\"1\"/>\n</svg>\n";
        let path = |colour: &str, d: &str| {
            format!("<path fill=\"none\" stroke=\"{colour}\" stroke-width=\"10\" d=\"{d}\"/>\n")
        };
        let expected = path("#0", "M0,0 1,0M2,0 3,0") + &path("#1", "M0,1 1,1") + "<circle/>\n</svg>\n";
        assert_eq!(joined(&body), expected);
    }

    #[test]
    fn a_figure_carries_its_description() {
        let canvas = Canvas::new(20.0, 10.0);
        assert_eq!(description(&canvas.svg().unwrap()), None);
        assert_eq!(description(&canvas.png().unwrap()), None);
        let words = "spinneb: a <b> & c – d";
        let canvas = canvas.describe(words);
        assert_eq!(description(&canvas.svg().unwrap()).as_deref(), Some(words));
        assert_eq!(description(&canvas.png().unwrap()).as_deref(), Some(words));
        assert_eq!(description(b"image,energy_meV"), None);
    }
}
