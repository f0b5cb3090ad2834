//! A shape from an image: its dark pixels, laid over the box of all sites.
//!
//! ```text
//! column = ⌊w (x − x₀ + ½)/(x₁ − x₀ + 1)⌋,  row from the top = ⌊h (y₁ − y + ½)/(y₁ − y₀ + 1)⌋
//! ```
//! from the least to the greatest x and y of all sites and half a lattice constant (half a cell of a grid) beyond, so that an image with
//! a pixel a cell says each cell by itself. Any z.

use super::Lattice;
use crate::base64;
use crate::error::{Error, Result};
use crate::units::Extent;
use schemars::JsonSchema;
use serde::Deserialize;

/// How an image begins that stands in the config itself.
pub const DATA: &str = "data:image/png;base64,";
/// A darker pixel is inside, a more transparent one is not.
const HALF: u8 = 128;
/// Most pixels of an image.
const MOST: usize = 100_000_000;

/// `{"path": "mask.png"}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Picture {
    /// A PNG image beside the config, or a data URL.
    pub path: String,
}

/// Which pixels are inside, row by row from the top.
struct Mask {
    width: usize,
    height: usize,
    dark: Vec<bool>,
}

impl Picture {
    /// Which sites are inside.
    pub(super) fn inside(
        &self,
        lattice: &Lattice,
        places: impl Iterator<Item = [f64; 3]> + Clone,
    ) -> Result<Vec<bool>> {
        let mask = self.mask().map_err(|message| Error::invalid("path", message))?;
        let side = |c: usize| -> Result<(f64, f64)> {
            let half = 0.5 * lattice.coordinate_along(c, Extent::Spacings(1.0))?.abs();
            let (low, high) =
                places.clone().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (l.min(p[c]), h.max(p[c])));
            Ok((low - half, high + half))
        };
        let ([left, right], [bottom, top]) = ([side(0)?.0, side(0)?.1], [side(1)?.0, side(1)?.1]);
        let pixel = |part: f64, count: usize| ((part * count as f64) as usize).min(count - 1);
        let is_dark = |p: [f64; 3]| {
            let column = pixel((p[0] - left) / (right - left), mask.width);
            let row = pixel((top - p[1]) / (top - bottom), mask.height);
            mask.dark[row * mask.width + column]
        };
        Ok(places.map(is_dark).collect())
    }

    fn mask(&self) -> std::result::Result<Mask, String> {
        let Some(data) = self.path.strip_prefix(DATA) else {
            return Err("an image is read where a config names it: name it in the config, not in a material".into());
        };
        let bytes = base64::bytes(data).ok_or("the image's data are not base 64")?;
        let wrong = |e: png::DecodingError| format!("the image cannot be read: {e}");
        let mut decoder = png::Decoder::new(&bytes[..]);
        decoder.set_transformations(png::Transformations::normalize_to_color8());
        let mut reader = decoder.read_info().map_err(wrong)?;
        let (width, height) = (reader.info().width as usize, reader.info().height as usize);
        if width.saturating_mul(height) > MOST {
            return Err(format!("the image has {width} × {height} pixels, more than {MOST}"));
        }
        let mut pixels = vec![0; reader.output_buffer_size()];
        let frame = reader.next_frame(&mut pixels).map_err(wrong)?;
        let channels = frame.color_type.samples();
        let alpha = matches!(frame.color_type, png::ColorType::GrayscaleAlpha | png::ColorType::Rgba);
        let is_dark = |pixel: &[u8]| {
            let (colour, cover) = pixel.split_at(channels - usize::from(alpha));
            let sum: usize = colour.iter().map(|c| usize::from(*c)).sum();
            sum < usize::from(HALF) * colour.len() && cover.first().is_none_or(|a| *a >= HALF)
        };
        let dark = pixels[..frame.buffer_size()].chunks_exact(channels).map(is_dark).collect();
        Ok(Mask { width, height, dark })
    }
}
