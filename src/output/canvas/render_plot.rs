//! A canvas as a file: SVG and PNG, both through plotters' backends.
//!
//! The backends know whole pixels only. So an SVG is drawn with many units a point and its root says how large it is,
//! and a PNG is drawn larger and box-averaged, band by band.

use super::palette::{Colour, WHITE};
use super::shapes::{Align, Canvas, Point, Raster, Shape, Text, heights};
use crate::base64::base64;
use crate::error::{Error, Result};
use crate::output::font::{glyphs, named};
use plotters::backend::{BitMapBackend, DrawingBackend, SVGBackend};
use plotters::prelude::RGBColor;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontTransform, TextStyle};
use std::fmt::Write;
use std::ops::Range;

/// SVG units a point.
const SVG_UNITS: f64 = 20.0;
/// The SVG backend divides a font's size by this to get its em.
const SVG_SIZE_PER_EM: f64 = 1.24;
/// PNG pixels an inch.
const DPI: f64 = 300.0;
/// A PNG is drawn so many times larger.
const OVERSAMPLING: usize = 4;
/// Rows of a PNG that are drawn at once: few enough that what is drawn stays near the processor.
const BAND: usize = 64;
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
        let mut pen = Pen { backend: &mut backend, scale: SVG_UNITS, kind: Kind::Svg, rows: 0..size.1 as i32 };
        self.shapes.iter().try_for_each(|shape| pen.draw(shape))?;
        backend.present().map_err(refused)?;
        drop(backend);
        Ok(self.finish_svg(&text)?.into_bytes())
    }

    /// The figure as PNG, 300 pixels an inch.
    pub fn png(&self) -> Result<Vec<u8>> {
        let scale = self.style.zoom() * DPI / 72.0;
        let size = ((self.width() * scale).round() as usize, (self.height() * scale).round() as usize);
        encode_png(&self.pixels(size, scale, BAND)?, size, QUICKLY, &self.description)
    }

    /// Its pixels (red, green, blue), `scale` of them a point, drawn so many rows at a time.
    fn pixels(&self, (width, height): (usize, usize), scale: f64, band: usize) -> Result<Vec<u8>> {
        let wide = width * OVERSAMPLING;
        let Colour(r, g, b) = self.style.colour(WHITE);
        let ground = [r, g, b].repeat(wide);
        let scale = scale * OVERSAMPLING as f64;
        let mut rgb = Vec::with_capacity(3 * width * height);
        let shapes: Vec<(&Shape, Range<f64>)> =
            self.shapes.iter().map(|shape| Ok((shape, shape.heights()?))).collect::<Result<_>>()?;
        let mut drawn = vec![0; ground.len() * band * OVERSAMPLING];
        for top in (0..height).step_by(band) {
            let rows = top * OVERSAMPLING..height.min(top + band) * OVERSAMPLING;
            let pixels = &mut drawn[..ground.len() * rows.len()];
            pixels.chunks_exact_mut(ground.len()).for_each(|row| row.copy_from_slice(&ground));
            self.rasters.iter().for_each(|r| paint(pixels, wide, &rows, r, scale));
            let mut backend = BitMapBackend::with_buffer(pixels, (wide as u32, rows.len() as u32));
            let rows = rows.start as i32..rows.end as i32;
            let mut pen = Pen { backend: &mut backend, scale, kind: Kind::Pixels, rows };
            for (shape, heights) in &shapes {
                if pen.reaches(heights) {
                    pen.draw(shape)?;
                }
            }
            drop(backend);
            average(pixels, &ground, &mut rgb);
        }
        Ok(rgb)
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
    /// Rows of the figure that the backend has.
    rows: Range<i32>,
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
            Shape::Disc { centre, radius, colour } => self.disc(*centre, (radius * self.scale).round(), *colour),
            Shape::Text { at, text } => self.text(*at, text),
        }
    }

    fn at(&self, (x, y): Point) -> (i32, i32) {
        ((x * self.scale).round() as i32, ((y * self.scale).round() as i32).saturating_sub(self.rows.start))
    }

    /// Whether what lies between these heights (pt) is, with a pixel around it, within the backend in part.
    fn reaches(&self, heights: &Range<f64>) -> bool {
        let [top, bottom] = [heights.start, heights.end].map(|y| self.at((0.0, y)).1);
        bottom >= -1 && top <= self.rows.len() as i32
    }

    fn polygon(&mut self, points: &[Point], colour: Colour) -> Result<()> {
        let places: Vec<_> = points.iter().map(|&p| self.at(p)).collect();
        self.backend.fill_polygon(places, &rgb(colour)).map_err(refused)
    }

    fn disc(&mut self, centre: Point, radius: f64, colour: Colour) -> Result<()> {
        self.backend.draw_circle(self.at(centre), radius as u32, &rgb(colour), true).map_err(refused)
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
            if length > 0.0 && self.reaches(&heights(pair, width / 2.0)) {
                let (nx, ny) = (-(by - ay) / length * width / 2.0, (bx - ax) / length * width / 2.0);
                self.polygon(
                    &[(ax + nx, ay + ny), (bx + nx, by + ny), (bx - nx, by - ny), (ax - nx, ay - ny)],
                    colour,
                )?;
            }
        }
        let joints = points.get(1..points.len().saturating_sub(1)).unwrap_or_default();
        for &joint in joints {
            if self.reaches(&heights(&[joint], width / 2.0)) {
                self.disc(joint, (width / 2.0 * self.scale).floor(), colour)?;
            }
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
            let (corner, end) = (glyph.px_bounds().min, glyph.px_bounds().max);
            let (top, bottom) = if text.upwards { (-end.x, -corner.x) } else { (corner.y, end.y) };
            if start.1 + (bottom as i32) < 0 || start.1 + top as i32 > self.rows.len() as i32 {
                continue;
            }
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

/// The raster's cells on the pixels they cover, of these rows.
fn paint(pixels: &mut [u8], wide: usize, rows: &Range<usize>, raster: &Raster, scale: f64) {
    let r = raster.rect;
    // pixels within the raster, and which of its cells each is in
    let inside = |pixels: Range<usize>, start: f64, length: f64, cells: usize| -> Vec<(usize, usize)> {
        let along = pixels.map(|p| (p, ((p as f64 + 0.5) / scale - start) / length));
        let cell = |f: f64| ((f * cells as f64) as usize).min(cells.saturating_sub(1));
        along.filter(|(_, f)| (0.0..1.0).contains(f)).map(|(p, f)| (p, cell(f))).collect()
    };
    let columns = inside(0..wide, r.x0, r.width(), raster.columns);
    let Some(first) = columns.first().map(|(x, _)| *x) else { return };
    let mut line: Vec<u8> = Vec::with_capacity(3 * columns.len());
    for same in inside(rows.clone(), r.y0, r.height(), raster.rows).chunk_by(|a, b| a.1 == b.1) {
        let row = &raster.rgb[3 * same[0].1 * raster.columns..][..3 * raster.columns];
        line.clear();
        columns.iter().for_each(|(_, column)| line.extend_from_slice(&row[3 * column..3 * column + 3]));
        for (y, _) in same {
            pixels[3 * ((y - rows.start) * wide + first)..][..line.len()].copy_from_slice(&line);
        }
    }
}

/// Each pixel the mean of the block drawn for it, after those that there are; most are the ground's.
fn average(pixels: &[u8], ground: &[u8], out: &mut Vec<u8>) {
    const BLOCK: u16 = (OVERSAMPLING * OVERSAMPLING) as u16;
    const STRETCH: usize = 3 * OVERSAMPLING * 16;
    let mut sums = [0; STRETCH];
    for block in pixels.chunks_exact(ground.len() * OVERSAMPLING) {
        for (start, plain) in (0..).step_by(STRETCH).zip(ground.chunks(STRETCH)) {
            let rows = || block.chunks_exact(ground.len()).map(|row| &row[start..start + plain.len()]);
            if rows().all(|row| row == plain) {
                out.extend_from_slice(&plain[..plain.len() / OVERSAMPLING]);
                continue;
            }
            let sums = &mut sums[..plain.len()];
            // whole rows first, which is quick
            sums.fill(0);
            for row in rows() {
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
    }
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
    use super::super::Rect;
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
    fn a_figure_is_the_same_in_bands_of_any_height() {
        let colour = Colour(30, 60, 200);
        let mut canvas = Canvas::new(20.0, 30.0);
        let rect = Rect { x0: 3.0, y0: 2.0, x1: 50.0, y1: 80.0 };
        canvas.rasters.push(Raster { rect, columns: 2, rows: 3, rgb: (0..18).map(|c| 10 * c).collect() });
        let across = vec![(1.0, 1.0), (40.0, 33.3), (20.0, 60.0), (20.0, 84.0)];
        canvas.shapes = vec![
            Shape::Polygon { points: vec![(5.0, 4.0), (55.0, 30.0), (10.0, 70.0)], colour: Colour(200, 90, 0) },
            Shape::Line { points: across, width: 1.5, colour },
            Shape::Box { rect: Rect { x0: 30.0, y0: 10.0, x1: 31.0, y1: 75.0 }, colour },
            Shape::Disc { centre: (12.0, 40.0), radius: 7.0, colour },
            Shape::Text { at: (2.0, 50.0), text: Text::new("E_{0} (meV)", 9.0) },
            Shape::Text { at: (50.0, 70.0), text: Text::new("gjpq Å upwards", 8.0).upwards() },
        ];
        let size = (83, 125);
        let whole = canvas.pixels(size, 1.5, size.1).unwrap();
        assert!(whole.iter().any(|c| *c != 255));
        for band in [1, 7, 64] {
            assert!(canvas.pixels(size, 1.5, band).unwrap() == whole, "{band}");
        }
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
