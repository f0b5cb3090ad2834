//! Figures that come out the same as SVG and as PNG.
//!
//! A [`Canvas`] is a list of things drawn, in points (1/72 inch), y downwards; [`Canvas::svg`] and [`Canvas::png`] turn it into a
//! file. [`LinePlot`] is the plot that most people want:
//!
//! ```
//! use spinneb::output::canvas::{LinePlot, Series};
//! let parabola: Vec<(f64, f64)> = (0..=50).map(|k| k as f64 / 25.0 - 1.0).map(|x| (x, 1.0 - x * x)).collect();
//! let plot = LinePlot::new("x (rad)", "E (meV)").with(Series::line(parabola).label("exact"));
//! let svg = plot.draw()?.svg()?;
//! assert!(String::from_utf8_lossy(&svg).starts_with("<svg"));
//! # Ok::<(), spinneb::error::Error>(())
//! ```

mod axis;
mod coincident;
mod frame;
mod heat_map;
mod line_plot;
mod number;
mod obstacles;
mod palette;
mod render_plot;
mod shapes;
mod style;

pub use super::font::unknown_letter;
pub use axis::{Axis, Scale, Tick};
pub use coincident::{Turn, turns};
pub use frame::{Frame, Rect, Ticks};
pub use heat_map::{colour_bar, heat_map};
pub use line_plot::{AxisLabel, LinePlot, Marker, Series, mark};
pub use number::{decimal, power_of_ten, significant};
pub use obstacles::Obstacles;
pub use palette::*;
pub use render_plot::description;
pub use shapes::{Align, Canvas, Point, Text};
pub use style::{COLUMN_MM, Look, Style};

/// Points in a millimetre.
pub const MM: f64 = 72.0 / 25.4;
/// Size of the axis labels (pt).
pub const LABEL_PT: f64 = 8.0;
/// Size of tick labels, legends and notes (pt).
pub const SMALL_PT: f64 = 7.0;
/// No text is smaller (pt), nor a subscript.
pub const MIN_PT: f64 = 7.0;
/// Thickness of frames and ticks (pt).
pub const THIN_PT: f64 = 0.5;
