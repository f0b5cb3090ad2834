//! How a figure looks: for paper, for slides, or on a dark ground; and how wide it is.
//!
//! Everything is drawn as for paper: text of at least [`MIN_PT`], lines of half a point. For slides all of it, text and lines and
//! marks, is drawn larger by one factor. On a dark ground the ink is light and the colours of series are brighter; the colours of
//! maps are data and stay as they are.

use super::palette::{BLACK, BLUE, Colour, GREEN, GREY, LIGHT_GREY, ORANGE, PURPLE, SKY, VERMILLION, WHITE};
use crate::error::{Error, Result};
use schemars::JsonSchema;
use serde::Deserialize;

/// Width of a figure in a journal's single column (mm).
pub const COLUMN_MM: f64 = 85.0;
/// Narrower figures have no room for their text (mm).
const NARROWEST_MM: f64 = 60.0;
/// Wider figures are no longer figures (mm): a page is 210 mm wide.
const WIDEST_MM: f64 = 250.0;

/// For what a figure is made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Style {
    /// A journal's column: black on white, text of 7 and 8 pt, 85 mm wide unless told otherwise.
    #[default]
    Paper,
    /// Half a slide: text and lines 1.7 times larger, 145 mm wide unless told otherwise.
    Slides,
    /// A dark page: light text on dark grey, otherwise as for paper.
    Dark,
}

impl Style {
    /// All styles.
    pub const ALL: [Style; 3] = [Style::Paper, Style::Slides, Style::Dark];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Style::Paper => "paper",
            Style::Slides => "slides",
            Style::Dark => "dark",
        }
    }

    /// How much larger text and lines are than on paper.
    pub fn zoom(self) -> f64 {
        match self {
            Style::Paper | Style::Dark => 1.0,
            Style::Slides => 1.7,
        }
    }

    /// What stands in for a colour that was chosen for white paper.
    pub fn colour(self, c: Colour) -> Colour {
        const DARK: [(Colour, Colour); 10] = [
            (WHITE, Colour(0x18, 0x1a, 0x1f)),
            (BLACK, Colour(0xe9, 0xe9, 0xe6)),
            (GREY, Colour(0x92, 0x96, 0x9c)),
            (LIGHT_GREY, Colour(0x3a, 0x3d, 0x43)),
            (BLUE, Colour(0x45, 0x9b, 0xe6)),
            (VERMILLION, Colour(0xff, 0x7f, 0x2e)),
            (GREEN, Colour(0x2b, 0xc4, 0x97)),
            (PURPLE, Colour(0xe6, 0x96, 0xc4)),
            (ORANGE, Colour(0xf5, 0xc1, 0x3d)),
            (SKY, Colour(0xa9, 0xdc, 0xff)),
        ];
        match self {
            Style::Paper | Style::Slides => c,
            Style::Dark => DARK.iter().find(|(light, _)| *light == c).map_or(c, |(_, dark)| *dark),
        }
    }
}

/// A style and a width that suits it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    style: Style,
    width_mm: f64,
}

impl Default for Look {
    fn default() -> Self {
        Look { style: Style::Paper, width_mm: COLUMN_MM }
    }
}

impl Look {
    /// With this width (mm), or the style's own; an error where text would have no room, or the figure no page.
    pub fn new(style: Style, width_mm: Option<f64>) -> Result<Look> {
        let width_mm = width_mm.unwrap_or(COLUMN_MM * style.zoom());
        let narrowest = NARROWEST_MM * style.zoom();
        if !(narrowest..=WIDEST_MM).contains(&width_mm) {
            let name = style.name();
            let message =
                format!("found {width_mm} mm: figures of style {name} are {narrowest} mm to {WIDEST_MM} mm wide");
            return Err(Error::invalid("width", message));
        }
        Ok(Look { style, width_mm })
    }

    /// The style.
    pub fn style(&self) -> Style {
        self.style
    }

    /// Width of the figure (mm).
    pub fn width_mm(&self) -> f64 {
        self.width_mm
    }

    /// Width in which it is drawn, before the style's zoom (mm).
    pub fn drawn_width_mm(&self) -> f64 {
        self.width_mm / self.style.zoom()
    }
}

#[cfg(test)]
mod tests {
    use super::super::palette::{SERIES, oklab_of};
    use super::*;

    /// As an eye without red (protan) or green (deutan) receptors sees it: Viénot, Brettel, Mollon, Color Res. Appl. 24, 243 (1999).
    fn seen(c: Colour, rows: [[f64; 3]; 3]) -> [f64; 3] {
        let linear = |v: u8| {
            let v = f64::from(v) / 255.0;
            if v <= 0.04045 { v / 12.92 } else { libm::pow((v + 0.055) / 1.055, 2.4) }
        };
        let rgb = [linear(c.0), linear(c.1), linear(c.2)];
        oklab_of(rows.map(|row| (0..3).map(|k| row[k] * rgb[k]).sum::<f64>().clamp(0.0, 1.0)))
    }

    #[test]
    fn series_are_told_apart_on_either_ground_by_any_colour_vision() {
        const ALL: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        const PROTAN: [[f64; 3]; 3] = [[0.11238, 0.88762, 0.0], [0.11238, 0.88762, 0.0], [0.00401, -0.00401, 1.0]];
        const DEUTAN: [[f64; 3]; 3] = [[0.29275, 0.70725, 0.0], [0.29275, 0.70725, 0.0], [-0.02234, 0.02234, 1.0]];
        for style in Style::ALL {
            for vision in [ALL, PROTAN, DEUTAN] {
                let ground = seen(style.colour(WHITE), vision);
                let colours: Vec<[f64; 3]> = SERIES.iter().map(|c| seen(style.colour(*c), vision)).collect();
                let far =
                    |a: &[f64; 3], b: &[f64; 3]| a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum::<f64>().sqrt();
                for (k, a) in colours.iter().enumerate() {
                    assert!(far(a, &ground) > 0.2, "{style:?} {k}: {}", far(a, &ground));
                    for (j, b) in colours[..k].iter().enumerate() {
                        assert!(far(a, b) > 0.055, "{style:?} {j} {k}: {}", far(a, b));
                    }
                }
            }
        }
    }

    #[test]
    fn a_width_without_room_for_text_is_refused() {
        assert_eq!(Look::new(Style::Paper, None).unwrap(), Look::default());
        assert_eq!(Look::new(Style::Slides, None).unwrap().width_mm(), 144.5);
        let message = Look::new(Style::Slides, Some(85.0)).unwrap_err().to_string();
        assert_eq!(message, "width: found 85 mm: figures of style slides are 102 mm to 250 mm wide");
        assert!(Look::new(Style::Paper, Some(f64::NAN)).is_err());
    }
}
