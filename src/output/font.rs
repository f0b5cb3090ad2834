//! The one font of all plots, embedded: a subset of DejaVu Sans (Latin, Greek, super- and subscripts, arrows, mathematics),
//! so that a plot looks the same on every machine. Its licence lies beside it.

use crate::error::{Error, Result};
use ab_glyph::{Font, FontRef, OutlinedGlyph, PxScale, ScaleFont, point};
use plotters::style::{FontDesc, FontFamily, FontStyle, register_font};
use std::sync::OnceLock;

static BYTES: &[u8] = include_bytes!("font/DejaVuSans-subset.ttf");
const FAMILY: &str = "sans-serif";

/// The font for a plotters backend, `size` in its own measure.
pub(super) fn named(size: f64) -> Result<FontDesc<'static>> {
    static REGISTERED: OnceLock<bool> = OnceLock::new();
    if *REGISTERED.get_or_init(|| register_font(FAMILY, FontStyle::Normal, BYTES).is_ok()) {
        Ok(FontDesc::new(FontFamily::SansSerif, size, FontStyle::Normal))
    } else {
        Err(unreadable())
    }
}

/// Width of `text` in em.
pub(super) fn width_em(text: &str) -> Result<f64> {
    let font = outlines()?;
    let units: f64 = text.chars().map(|c| f64::from(font.h_advance_unscaled(font.glyph_id(c)))).sum();
    Ok(units / units_per_em(font))
}

/// The first letter of `text` that the font does not have.
pub fn unknown_letter(text: &str) -> Option<char> {
    let font = outlines().ok()?;
    text.chars().find(|c| font.glyph_id(*c).0 == 0)
}

/// The glyphs of `text` with its baseline starting at (0, 0), `em` pixels an em.
pub(super) fn glyphs(text: &str, em: f64) -> Result<Vec<OutlinedGlyph>> {
    let font = outlines()?;
    let scale = PxScale::from((em * f64::from(font.height_unscaled()) / units_per_em(font)) as f32);
    let scaled = font.as_scaled(scale);
    let mut x = 0.0;
    let mut found = Vec::new();
    for id in text.chars().map(|c| font.glyph_id(c)) {
        found.extend(font.outline_glyph(id.with_scale_and_position(scale, point(x, 0.0))));
        x += scaled.h_advance(id);
    }
    Ok(found)
}

fn outlines() -> Result<&'static FontRef<'static>> {
    static FONT: OnceLock<Option<FontRef<'static>>> = OnceLock::new();
    FONT.get_or_init(|| FontRef::try_from_slice(BYTES).ok()).as_ref().ok_or_else(unreadable)
}

fn units_per_em(font: &FontRef) -> f64 {
    font.units_per_em().map_or(2048.0, f64::from)
}

fn unreadable() -> Error {
    Error::Numerical("the embedded font cannot be read".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_digit_of_dejavu_is_0_636_em_wide() {
        assert!((width_em("0").unwrap() - 0.636).abs() < 1e-3);
        assert!((width_em("00").unwrap() - 1.272).abs() < 2e-3);
    }

    #[test]
    fn the_signs_that_plots_use_are_in_the_font() {
        let font = outlines().unwrap();
        for c in "−×Δφµ∥→←°⁰¹²³⁴⁵⁶⁷⁸⁹⁻₀₁αβθλτμΩħ∂∇≤≥≈·–…".chars()
        {
            assert_ne!(font.glyph_id(c).0, 0, "{c}");
        }
    }
}
