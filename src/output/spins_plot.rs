//! `spins.svg` and `.png`: all spins of the path, site along x and image along y. Above the component m_z, below the angle
//! φ = atan2(m_y, m_x) about z, which fades to grey where the spin points along z and has no angle.
//!
//! Where the spins lie along x or y much more than along z, as in a film, that axis takes the place of z, and the other two follow in
//! cyclic order: m_x and atan2(m_z, m_y), or m_y and atan2(m_x, m_z). Where the staggered mean changes more along the path than the
//! mean, as in an antiferromagnet, the map is that of (−1)^i m_i.
//!
//! A lattice that is no row has maps of its own instead ([`draw_spin_maps`]).
//!
//! Above stand the positions of the sites in nm, where they are known; on the right the reaction coordinates of the images, with the
//! saddles as diamonds. Their numbers are those of `path.npz` (or `path.ovf`, or `spins.csv`) and `path.csv`.

use super::canvas::{
    Align, Axis, BLACK, COLUMN_MM, Canvas, Colour, Frame, LABEL_PT, LIGHT_GREY, Look, MM, Marker, Rect, SMALL_PT,
    THIN_PT, Text, Ticks, VERMILLION, colour_bar, cyclic, diverging, heat_map, mark, mix,
};
use super::energy_path_plot::marked_saddles;
use super::staggered::{SiteKinds, is_staggered};
use super::{Places, Plot, PlotData, draw_spin_maps};
use crate::error::{Error, Result};
use crate::geometry::vector::Vector;
use crate::path::Path;
use std::f64::consts::PI;

/// The map of the spins as a figure.
#[derive(Clone, Copy, Debug)]
pub struct SpinsPlot;

impl Plot for SpinsPlot {
    fn name(&self) -> &'static str {
        "spins"
    }

    fn applies(&self, data: &PlotData) -> bool {
        data.path.is_some()
    }

    fn draw(&self, data: &PlotData, look: &Look) -> Result<Canvas> {
        match data.lattice {
            Some(lattice) => draw_spin_maps(data, lattice, look),
            None => draw_spins(data, look),
        }
    }
}

const HEIGHT_MM: f64 = 92.0;
const BAR: f64 = 8.0;
/// Room right of the maps for the colour bars.
const RIGHT: f64 = 53.0;
const GAP: f64 = 10.0;
/// Room above the maps, and above that for positions.
const TOP: f64 = 4.0;
const POSITIONS: f64 = SMALL_PT + LABEL_PT + 7.0;
/// Distance of a scale's numbers from the map, and of each other.
const TICK: f64 = 2.5;
const APART: f64 = 3.0;
/// In-plane length from which an angle has its full colour.
const FULL: f64 = 0.25;
/// More cells than this, in x and in y, are gathered into blocks: their mean m_z, and their angle where they lie most in the plane.
const MOST: (usize, usize) = (600, 400);

/// The figure. An error where the spins are not known.
pub fn draw_spins(data: &PlotData, look: &Look) -> Result<Canvas> {
    let path = data.path.ok_or_else(|| Error::Numerical("spins: the spins are not known".into()))?;
    let above = if data.places.is_some() { POSITIONS } else { 0.0 };
    let top = TOP + above;
    let height_mm = HEIGHT_MM * (look.drawn_width_mm() / COLUMN_MM).max(0.85) + above / MM;
    let mut canvas = Canvas::styled(look, height_mm);
    let grey = look.style().colour(LIGHT_GREY);
    let cells = Cells::new(path, &data.kinds);
    let axes = cells.order.map(|c| ["x", "y", "z"][c]);
    let y = Axis::cells(path.images(), 8);
    let left = Frame::left_margin(&y)?;
    let along = Along::of(data, path.images());
    let (width, bottom) = (canvas.width() - RIGHT - along.width()?, canvas.height() - Frame::bottom_margin());
    let x = spaced(width - left, 6, |most| Axis::cells(path.sites(), most))?;
    let height = (bottom - top - GAP) / 2.0;
    let panel = |y0: f64| Rect { x0: left, y0, x1: width, y1: y0 + height };
    let beside = width + along.width()? + 6.0;
    let bar = |r: Rect| Rect { x0: beside, x1: beside + BAR, ..r };

    let upper = Frame { rect: panel(top), x: x.clone(), y: y.clone(), ticks: Ticks::Outward };
    heat_map(&mut canvas, upper.rect, cells.columns, cells.rows, |c, r| diverging(cells.mean_along(c, r)));
    upper_axes(&upper, &mut canvas)?;
    if let Some(places) = data.places {
        positions(&upper, places, path.sites(), &mut canvas)?;
    }
    along.draw(&upper, &mut canvas)?;
    let labels = [(0.0, "−1"), (0.25, "−0.5"), (0.5, "0"), (0.75, "0.5"), (1.0, "1")];
    let component = format!("{}m_{{{}}}", if cells.staggered { "Staggered " } else { "" }, axes[2]);
    colour_bar(&mut canvas, bar(upper.rect), &component, &labels, |f| diverging(2.0 * f - 1.0))?;

    let lower = Frame { rect: panel(top + height + GAP), x, y, ticks: Ticks::Outward };
    heat_map(&mut canvas, lower.rect, cells.columns, cells.rows, |c, r| in_plane(cells.most_in_plane(c, r), grey));
    lower.draw(&mut canvas, "Site", "Image")?;
    along.draw(&lower, &mut canvas)?;
    let mut angles = bar(lower.rect);
    angles.y1 -= 2.0 * BAR;
    let labels = [(0.0, "−180°"), (0.25, "−90°"), (0.5, "0°"), (0.75, "90°"), (1.0, "180°")];
    let angle = match cells.staggered {
        true => format!("Staggered φ about {}", axes[2]),
        false => format!("φ = atan2(m_{{{}}}, m_{{{}}})", axes[1], axes[0]),
    };
    colour_bar(&mut canvas, angles, &angle, &labels, |f| cyclic((2.0 * f - 1.0) * PI))?;
    no_angle(&mut canvas, Rect { y0: lower.rect.y1 - BAR, ..bar(lower.rect) }, axes[2])?;
    Ok(canvas)
}

/// The axis along a side of this length (pt), with as many ticks as keep their labels apart.
fn spaced(length: f64, most: usize, axis: impl Fn(usize) -> Axis) -> Result<Axis> {
    for axis in (2..=most).rev().map(&axis) {
        let widths = axis.ticks.iter().map(|t| Text::new(&t.label, SMALL_PT).width()).collect::<Result<Vec<f64>>>()?;
        let places: Vec<f64> = axis.ticks.iter().filter_map(|t| axis.fraction(t.at)).map(|f| f * length).collect();
        let apart = |(w, x): (&[f64], &[f64])| x[1] - x[0] - 0.5 * (w[0] + w[1]) > APART;
        if widths.windows(2).zip(places.windows(2)).all(apart) {
            return Ok(axis);
        }
    }
    Ok(axis(1))
}

/// The positions of the sites, above a map.
fn positions(frame: &Frame, places: Places, sites: usize, canvas: &mut Canvas) -> Result<()> {
    let r = frame.rect;
    let at = |site: f64| places.first_nm + site * places.spacing_nm;
    let (min, max) = (at(-0.5), at(sites as f64 - 0.5));
    let scale = spaced(r.width(), 5, |most| Axis { min, max, ..Axis::linear(min, max, most) })?;
    for (f, tick) in scale.ticks.iter().filter_map(|t| Some((scale.fraction(t.at)?, t))) {
        let x = r.x0 + f * r.width();
        canvas.line(&[(x, r.y0), (x, r.y0 - TICK)], THIN_PT, BLACK);
        canvas.text((x, r.y0 - TICK - 2.0), Text::new(&tick.label, SMALL_PT).align(Align::Centre))?;
    }
    let middle = ((r.x0 + r.x1) / 2.0, r.y0 - TICK - SMALL_PT - 3.5);
    canvas.text(middle, Text::new("Position (nm)", LABEL_PT).align(Align::Centre))
}

/// Reaction coordinates (rad) beside the images, and the saddles.
struct Along {
    /// Of every image.
    images: Vec<f64>,
    ticks: Axis,
    saddles: Vec<f64>,
}

impl Along {
    fn of(data: &PlotData, images: usize) -> Along {
        let s: Vec<f64> = data.coordinate().collect();
        // a path without length, or a table of another one, has none
        let s = if s.len() == images && s.last() > s.first() { s } else { Vec::new() };
        let ticks = Axis::linear(0.0, s.last().copied().unwrap_or(0.0), 6);
        let saddles = marked_saddles(&data.energy.saddles, data.energy.length()).iter().map(|p| p.0).collect();
        Along { images: s, ticks, saddles }
    }

    /// Room it takes (pt).
    fn width(&self) -> Result<f64> {
        if self.images.is_empty() {
            return Ok(0.0);
        }
        let labels = self.ticks.ticks.iter().map(|t| Text::new(&t.label, SMALL_PT).width());
        Ok(labels.collect::<Result<Vec<f64>>>()?.into_iter().fold(0.0, f64::max) + TICK + LABEL_PT + 7.0)
    }

    /// The image at a reaction coordinate, with a fraction between two.
    fn image_at(&self, s: f64) -> f64 {
        let k = self.images.partition_point(|at| *at < s).clamp(1, self.images.len().max(2) - 1);
        let (Some(a), Some(b)) = (self.images.get(k - 1), self.images.get(k)) else { return 0.0 };
        let t = if b > a { ((s - a) / (b - a)).clamp(0.0, 1.0) } else { 0.0 };
        (k - 1) as f64 + t
    }

    fn draw(&self, frame: &Frame, canvas: &mut Canvas) -> Result<()> {
        if self.images.is_empty() {
            return Ok(());
        }
        let r = frame.rect;
        let height = |s: f64| frame.y.fraction(self.image_at(s)).map(|f| r.y1 - f * r.height());
        let mut last = f64::INFINITY;
        for (y, tick) in self.ticks.ticks.iter().filter_map(|t| Some((height(t.at)?, t))) {
            canvas.line(&[(r.x1, y), (r.x1 + TICK, y)], THIN_PT, BLACK);
            // images may stand close where the path is steep
            if last - y > SMALL_PT {
                canvas.text((r.x1 + TICK + 1.5, y + 0.36 * SMALL_PT), Text::new(&tick.label, SMALL_PT))?;
                last = y;
            }
        }
        let at = (r.x1 + self.width()? - 3.0, (r.y0 + r.y1) / 2.0);
        canvas.text(at, Text::new("Reaction coord. (rad)", LABEL_PT).align(Align::Centre).upwards())?;
        for y in self.saddles.iter().filter_map(|s| height(*s)) {
            mark(canvas, (r.x1, y), Marker::Diamond, VERMILLION);
        }
        Ok(())
    }
}

/// Around the upper of two panels that share their x axis.
fn upper_axes(frame: &Frame, canvas: &mut Canvas) -> Result<()> {
    frame.draw_x_ticks(canvas);
    frame.draw_y(canvas, "Image")?;
    canvas.outline(frame.rect, THIN_PT, BLACK);
    Ok(())
}

/// The key for spins without an angle.
fn no_angle(canvas: &mut Canvas, rect: Rect, axis: &str) -> Result<()> {
    canvas.fill(rect, LIGHT_GREY);
    canvas.outline(rect, THIN_PT, BLACK);
    let at = (rect.x1 + 2.5, (rect.y0 + rect.y1) / 2.0 + 0.36 * SMALL_PT);
    canvas.text(at, Text::new(format!("m ∥ {axis}"), SMALL_PT).align(Align::Left))
}

/// The colour of the in-plane angle.
fn in_plane(m: Vector, grey: Colour) -> Colour {
    let length = libm::hypot(m[0], m[1]);
    mix(grey, cyclic(libm::atan2(m[1], m[0])), length / FULL)
}

/// The spins in blocks, where there are more than anyone can see.
struct Cells<'a> {
    path: &'a Path,
    columns: usize,
    rows: usize,
    /// The components that are called x, y and z here: the last one is shown above, the angle is about it.
    order: [usize; 3],
    /// Odd sites are turned round.
    kinds: &'a SiteKinds,
    staggered: bool,
}

/// Another axis than z is chosen where the spins lie along it so many times more (mean squares).
const MORE: f64 = 1.5;

/// The axis along which the spins lie most, last, with the others in cyclic order before it.
fn order(path: &Path) -> [usize; 3] {
    let n = path.sites();
    let square = |c: usize| -> f64 {
        (0..path.images()).map(|k| path.image(k)[c * n..(c + 1) * n].iter().map(|m| m * m).sum::<f64>()).sum()
    };
    let [x, y, z] = [0, 1, 2].map(square);
    let axis = if x.max(y) <= MORE * z { 2 } else { usize::from(y > x) };
    [(axis + 1) % 3, (axis + 2) % 3, axis]
}

impl<'a> Cells<'a> {
    fn new(path: &'a Path, kinds: &'a SiteKinds) -> Cells<'a> {
        let staggered = is_staggered(path, kinds);
        let (columns, rows) = (path.sites().min(MOST.0), path.images().min(MOST.1));
        Cells { path, columns, rows, order: order(path), kinds, staggered }
    }

    /// The spins of a block.
    fn block(&self, column: usize, row: usize) -> impl Iterator<Item = Vector> + use<'a> {
        let (path, n, order) = (self.path, self.path.sites(), self.order);
        let (kinds, staggered) = (self.kinds, self.staggered);
        let range = |k: usize, cells: usize, n: usize| k * n / cells..(k + 1) * n / cells;
        let sites = range(column, self.columns, n);
        range(row, self.rows, path.images())
            .map(|k| path.image(k))
            .flat_map(move |m| sites.clone().map(move |i| order.map(|c| kinds.sign(staggered, i) * m[c * n + i])))
    }

    /// Mean component of a block along the last axis.
    fn mean_along(&self, column: usize, row: usize) -> f64 {
        let (sum, count) = self.block(column, row).fold((0.0, 0usize), |(sum, count), m| (sum + m[2], count + 1));
        sum / count.max(1) as f64
    }

    /// The spin of a block that lies most in the plane, so that a wall shows that is thinner than a block.
    fn most_in_plane(&self, column: usize, row: usize) -> Vector {
        let length = |m: &Vector| libm::hypot(m[0], m[1]);
        self.block(column, row).max_by(|a, b| length(a).total_cmp(&length(b))).unwrap_or([0.0, 0.0, 1.0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::EnergyPath;
    use crate::output::canvas::Style;
    use crate::spins::Spins;

    fn svg(data: &PlotData) -> String {
        String::from_utf8(draw_spins(data, &Look::default()).unwrap().svg().unwrap()).unwrap()
    }

    #[test]
    fn positions_coordinates_saddles_and_the_neel_order_are_on_the_map() {
        let (up, down, x) = ([0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]);
        let neel = Path::new(
            &[[up, down, up], [x, x.map(|c| -c), x], [down, up, down]].map(|v| Spins::from_vectors(&v).unwrap()),
        );
        let energy = EnergyPath {
            images: vec![(0.0, 0.0), (2.0, 1.0), (4.0, 0.0)],
            saddles: vec![(2.0, 1.0)],
            ..Default::default()
        };
        let places = Some(Places { first_nm: 1.0, spacing_nm: 2.0 });
        let data = PlotData { energy, path: Some(&neel), places, ..Default::default() };
        let cells = Cells::new(&neel, &data.kinds);
        assert!((0..3).all(|site| cells.mean_along(site, 0) == 1.0 && cells.mean_along(site, 2) == -1.0));
        let picture = svg(&data);
        for words in ["Staggered m", "Staggered φ about z", "Position (nm)", "Reaction coord. (rad)"] {
            assert!(picture.contains(words), "{words}");
        }
        assert!(picture.contains("#D55E00"), "no saddle is marked");
        let along = Along::of(&data, 3);
        assert_eq!([0.0, 1.0, 2.0, 3.0, 4.0].map(|s| along.image_at(s)), [0.0, 0.5, 1.0, 1.5, 2.0]);
        let bare = svg(&PlotData { places: None, ..data.clone() });
        assert!(!bare.contains("nm"));
        let steady =
            Path::new(&[[up, up, up], [x, x, x], [down, down, down]].map(|v| Spins::from_vectors(&v).unwrap()));
        assert!(!svg(&PlotData { path: Some(&steady), ..data }).contains("Staggered"));
    }

    #[test]
    fn numbers_along_a_narrow_map_do_not_touch() {
        let m = Spins::from_vectors(&[[0.0, 0.0, 1.0]; 120]).unwrap();
        let path = Path::new(&[m.clone(), m.clone(), m]);
        let energy = EnergyPath { images: vec![(0.0, 0.0), (30.0, 1.0), (70.0, 0.0)], ..Default::default() };
        let places = Some(Places { first_nm: 1.25, spacing_nm: 2.5 });
        let data = PlotData { energy, path: Some(&path), places, ..Default::default() };
        for width in [60.0, 85.0] {
            let look = Look::new(Style::Paper, Some(width)).unwrap();
            draw_spins(&data, &look).unwrap().assert_legible();
        }
    }
}
