//! The one font of all plots, embedded: a subset of DejaVu Sans (Latin, Greek, super- and subscripts, arrows, mathematics),
//! so that a plot looks the same on every machine. Its licence lies beside it.

use crate::error::{Error, Result};
use plotters::style::{FontDesc, FontFamily, FontStyle, register_font};
use std::sync::OnceLock;

static BYTES: &[u8] = include_bytes!("font/DejaVuSans-subset.ttf");
const FAMILY: &str = "sans-serif";

/// Ascent plus descent in em: the size by which the raster backend measures a font.
pub(super) const HEIGHT_PER_EM: f64 = 2384.0 / 2048.0;

/// The font with `size` in the backend's own measure.
pub(super) fn font(size: f64) -> Result<FontDesc<'static>> {
    static REGISTERED: OnceLock<bool> = OnceLock::new();
    if *REGISTERED.get_or_init(|| register_font(FAMILY, FontStyle::Normal, BYTES).is_ok()) {
        Ok(FontDesc::new(FontFamily::SansSerif, size, FontStyle::Normal))
    } else {
        Err(Error::Numerical("the embedded font cannot be read".into()))
    }
}

/// Width of `text` in em.
pub(super) fn width_em(text: &str) -> Result<f64> {
    const UNITS: f64 = 2048.0;
    let ((x0, _), (x1, _)) = font(UNITS * HEIGHT_PER_EM)?
        .layout_box(text)
        .map_err(|e| Error::Numerical(format!("the text {text:?} cannot be laid out: {e}")))?;
    Ok(f64::from(x1 - x0) / UNITS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_digit_of_dejavu_is_0_636_em_wide() {
        assert!((width_em("0").unwrap() - 0.636).abs() < 1e-3);
        assert!((width_em("00").unwrap() - 1.272).abs() < 2e-3);
    }
}
