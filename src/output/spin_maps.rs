//! The spins of a lattice that is no row, at their true places: maps of the first image, the one halfway up, the highest, the one
//! halfway down and the last.
//!
//! Hue is the angle atan2(m_y, m_x) in the plane, lightness is m_z: nearly white along +z, nearly black along −z, as in the page; a wheel
//! tells the colours. Each site colours its cell ([`SiteCell`]); where no site is, it is grey. Of a lattice with several layers along z
//! the middle one is shown.

use super::PlotData;
use super::canvas::{
    Align, BLACK, Canvas, Colour, GREY, LABEL_PT, LIGHT_GREY, Look, MM, Rect, SMALL_PT, THIN_PT, Text, WHITE,
    direction, mix,
};
use super::energy_path_plot::first_of_the_highest;
use super::site_cells::SiteCell;
use crate::error::{Error, Result};
use crate::field::Components;
use crate::geometry::Vector;
use crate::lattice::Lattice;
use crate::words::rounded;
use std::f64::consts::PI;

/// Where the sites are.
struct SitePlaces {
    /// Positions, one a site.
    at: Vec<Vector>,
    /// Which of the cells each site has.
    atoms: Vec<usize>,
    /// What the sites colour, one an atom of the lattice's cell.
    cells: Vec<SiteCell>,
}

impl SitePlaces {
    fn of(lattice: &Lattice) -> SitePlaces {
        SitePlaces {
            at: (0..lattice.sites).map(|i| lattice.position(i)).collect(),
            atoms: (0..lattice.sites).map(|i| lattice.cell(i).0).collect(),
            cells: SiteCell::of(lattice),
        }
    }
}

/// Maps in a row of the figure, and in one of strips: those this much lower than wide, and lower still.
const COLUMNS: usize = 3;
const STRIPS: [(f64, usize); 2] = [(0.2, 1), (0.5, 2)];
/// Between maps, and above each for its title.
const GAP: f64 = 6.0;
const TITLE: f64 = SMALL_PT + 5.0;
/// The room around all.
const MARGIN: f64 = 4.0;
/// Distance of lines below the maps, and of the first from the bar.
const LINE: f64 = SMALL_PT + 2.0;
const BESIDE: f64 = 4.0;
/// Pixels across a map.
const PIXELS: f64 = 260.0;
/// A map is at most so many times as high as wide.
const HIGHEST: f64 = 1.6;

/// The figure. An error where the spins are not known.
pub fn draw_spin_maps(data: &PlotData, lattice: &Lattice, look: &Look) -> Result<Canvas> {
    let path = data.path.ok_or_else(|| Error::Numerical("spins: the spins are not known".into()))?;
    let places = SitePlaces::of(lattice);
    let layer = Layer::of(&places, &data.kinds.vacant);
    let maps = maps(&data.energy.images, path.images());
    let title = |(image, role): &(usize, &str)| Text::new(format!("{role} (image {image})"), SMALL_PT);
    let widest = maps.iter().try_fold(0.0, |w: f64, map| Ok::<_, Error>(w.max(title(map).width()?)))?;
    let plan = Plan::of(Canvas::styled(look, 10.0).width(), layer.size, maps.len(), widest);
    let left = MARGIN + plan.left(layer.size);
    let end = left + plan.scale * round_part(layer.size[0]);
    let below = below(&layer, lattice.unit(), look.drawn_width_mm() * MM - MARGIN - end)?;
    let mut canvas = Canvas::styled(look, (plan.height + LINE * (below.len() - 1) as f64) / MM);
    for (k, map) in maps.iter().enumerate() {
        let (rect, image) = (plan.map(k, layer.size), &map.0);
        canvas.text(((rect.x0 + rect.x1) / 2.0, rect.y0 - 3.0), title(map).align(Align::Centre))?;
        layer.draw(&mut canvas, rect, Components::new(path.image(*image)));
        canvas.outline(rect, THIN_PT, BLACK);
    }
    wheel(&mut canvas, plan.wheel)?;
    let base = plan.height - MARGIN;
    canvas.line(&[(left, base - 0.35 * SMALL_PT), (end, base - 0.35 * SMALL_PT)], 1.6, BLACK);
    for (k, words) in below.into_iter().enumerate() {
        let x = if k == 0 { end + BESIDE } else { left };
        canvas.text((x, base + LINE * k as f64), Text::new(words, SMALL_PT))?;
    }
    Ok(canvas)
}

/// What is said below the maps, line by line, the first beside the bar, where there is so much room (pt).
fn below(layer: &Layer, unit: &str, room: f64) -> Result<Vec<String>> {
    let (bar, axes) = (format!("{} {unit}", round_part(layer.size[0])), "x to the right, y upwards");
    let line = format!("{bar}, {axes}");
    let fits = BESIDE + Text::new(&line, SMALL_PT).width()? <= room;
    let first = if fits { vec![line] } else { vec![bar, axes.into()] };
    Ok(first.into_iter().chain(layer.words(unit)).collect())
}

/// Where maps and wheel are.
struct Plan {
    columns: usize,
    /// Room for each map.
    wide: f64,
    high: f64,
    /// Points a unit of length.
    scale: f64,
    wheel: Rect,
    height: f64,
}

impl Plan {
    /// Three maps in a row, or two of strips, and the wheel in the place of one more; of flat strips one, and the wheel below them.
    /// Fewer where titles so wide (pt) would touch.
    fn of(width: f64, size: [f64; 2], maps: usize, title: f64) -> Plan {
        let share = |columns: usize| (width - 2.0 * MARGIN - (columns - 1) as f64 * GAP) / columns as f64;
        let columns = STRIPS.iter().find(|(low, _)| size[1] < low * size[0]).map_or(COLUMNS, |(_, columns)| *columns);
        let columns = (2..=columns).rev().find(|columns| title < share(*columns) + 0.5 * GAP).unwrap_or(1);
        let wide = share(columns);
        let scale = (wide / size[0]).min(HIGHEST * wide / size[1]);
        let room = 0.8 * share(COLUMNS);
        let own = columns == 1;
        let high = scale * size[1];
        let rows = (maps + usize::from(!own)).div_ceil(columns);
        let below = rows as f64 * (high + TITLE + GAP);
        let mut plan =
            Plan { columns, wide, high, scale, wheel: Rect { x0: 0.0, y0: 0.0, x1: 0.0, y1: 0.0 }, height: 0.0 };
        let (x, y) = if own { ((width - share(COLUMNS)) / 2.0, MARGIN + TITLE + below) } else { plan.corner(maps) };
        // among the maps it may need more room than they
        let more = if own { room + TITLE + GAP } else { (room - high).max(0.0) };
        let across = if own { share(COLUMNS) } else { wide };
        plan.wheel = Rect { x0: x, y0: y, x1: x + across, y1: y + if own { room } else { room.max(high) } };
        plan.height = 2.0 * MARGIN + below - GAP + TITLE + more;
        plan
    }

    fn corner(&self, k: usize) -> (f64, f64) {
        let (column, row) = ((k % self.columns) as f64, (k / self.columns) as f64);
        (MARGIN + column * (self.wide + GAP), MARGIN + TITLE + row * (self.high + TITLE + GAP))
    }

    /// From the left of the room to the map.
    fn left(&self, size: [f64; 2]) -> f64 {
        (self.wide - self.scale * size[0]) / 2.0
    }

    /// The k-th map, in the middle of its column.
    fn map(&self, k: usize, size: [f64; 2]) -> Rect {
        let ((x, y), [w, h]) = (self.corner(k), size.map(|length| self.scale * length));
        let x0 = x + self.left(size);
        Rect { x0, y0: y, x1: x0 + w, y1: y + h }
    }
}

/// A round length, of about a quarter of another one.
fn round_part(length: f64) -> f64 {
    let power = libm::pow(10.0, (0.3 * length).log10().floor());
    let steps = [5.0, 2.0, 1.0].into_iter().map(|step| step * power);
    rounded(steps.into_iter().find(|x| *x <= 0.3 * length).unwrap_or(power), 1)
}

/// The images that are shown, each with what it is; points of the path are (reaction coordinate, energy).
fn maps(points: &[(f64, f64)], images: usize) -> Vec<(usize, &'static str)> {
    let last = images.saturating_sub(1);
    if points.len() != images || images < 3 {
        return [(0, "Initial"), (last, "Final")].into_iter().take(images.min(2)).collect();
    }
    let top = first_of_the_highest(points).unwrap_or(0);
    let half = |a: usize, b: usize| {
        let middle = 0.5 * (points[a].0 + points[b].0);
        (a..=b).min_by(|i, j| (points[*i].0 - middle).abs().total_cmp(&(points[*j].0 - middle).abs())).unwrap_or(a)
    };
    let mut all =
        vec![(0, "Initial"), (half(0, top), "Before"), (top, "Highest"), (half(top, last), "After"), (last, "Final")];
    all.dedup_by_key(|(image, _)| *image);
    all
}

/// The sites that are shown: of one layer along z.
struct Layer<'a> {
    places: &'a SitePlaces,
    /// Which sites.
    sites: Vec<usize>,
    /// The corner of least coordinates, and the width and height.
    low: [f64; 2],
    size: [f64; 2],
    /// Its height, where there are others.
    z: Option<f64>,
}

impl Layer<'_> {
    fn of<'a>(places: &'a SitePlaces, vacant: &[bool]) -> Layer<'a> {
        let heights = places.at.iter().map(|p| p[2]);
        let (bottom, top) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), z| (l.min(z), h.max(z)));
        let middle = 0.5 * (bottom + top);
        let near = |p: &Vector| (p[2] - middle).abs();
        let least = places.at.iter().map(near).fold(f64::INFINITY, f64::min);
        let z = places.at.iter().find(|p| near(p) <= least * (1.0 + 1e-9)).map_or(middle, |p| p[2]);
        let is_shown = |i: &usize| (places.at[*i][2] - z).abs() < 1e-6 && !vacant.get(*i).is_some_and(|v| *v);
        let sites: Vec<usize> = (0..places.at.len()).filter(is_shown).collect();
        let extent = |c: usize| {
            let bounds = sites.iter().map(|i| (places.at[*i][c], &places.cells[places.atoms[*i]]));
            bounds.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), (x, cell)| {
                (l.min(x + cell.low[c]), h.max(x + cell.high[c]))
            })
        };
        let [x, y] = [extent(0), extent(1)];
        let z = (top - bottom > 1e-6).then_some(z);
        Layer { places, sites, low: [x.0, y.0], size: [x.1 - x.0, y.1 - y.0], z }
    }

    fn draw(&self, canvas: &mut Canvas, rect: Rect, m: Components) {
        let scale = PIXELS / self.size[0].max(self.size[1]);
        let [columns, rows] = self.size.map(|x| (scale * x).ceil().max(1.0) as usize);
        let [light, grey] = [LIGHT_GREY, GREY].map(|c| canvas.style().colour(c));
        let Colour(r, g, b) = mix(light, grey, 0.3);
        let mut rgb = [r, g, b].repeat(columns * rows);
        for &i in &self.sites {
            let Colour(r, g, b) = direction(m.get(i));
            for pixel in self.pixels(i, [columns, rows]) {
                rgb[3 * pixel..3 * pixel + 3].copy_from_slice(&[r, g, b]);
            }
        }
        canvas.raster(rect, columns, rows, rgb);
    }

    /// The pixels whose middle is in the cell of a site, by rows from the top.
    fn pixels(&self, i: usize, [columns, rows]: [usize; 2]) -> impl Iterator<Item = usize> {
        let (at, cell) = (self.places.at[i], &self.places.cells[self.places.atoms[i]]);
        let edge = [self.size[0] / columns as f64, self.size[1] / rows as f64];
        let across =
            move |c: usize, end: f64, of: usize| (((at[c] + end - self.low[c]) / edge[c]).max(0.0) as usize).min(of);
        let range = move |c: usize, of: usize| across(c, cell.low[c], of)..(across(c, cell.high[c], of) + 1).min(of);
        let middle = move |c: usize, k: usize| self.low[c] + (k as f64 + 0.5) * edge[c] - at[c];
        let inside = move |(x, y): &(usize, usize)| cell.holds([middle(0, *x), middle(1, *y)]);
        let all = range(1, rows).flat_map(move |y| range(0, columns).map(move |x| (x, y)));
        all.filter(inside).map(move |(x, y)| (rows - 1 - y) * columns + x)
    }

    /// Which layer of several the maps show. A line of its own: with the rest it is wider than the figure.
    fn words(&self, unit: &str) -> Option<String> {
        self.z.map(|z| format!("the layer at z = {} {unit}", rounded(z, 6)))
    }
}

/// All colours: the direction in the plane around the middle, where m_z is 1; at the rim it is −1.
fn wheel(canvas: &mut Canvas, room: Rect) -> Result<()> {
    const SIDE: usize = 200;
    let radius = 0.5 * (room.width() - 26.0).min(room.height() - 2.0 * TITLE);
    let (x, y) = ((room.x0 + room.x1) / 2.0, room.y0 + radius + TITLE / 2.0);
    let mut rgb = Vec::with_capacity(3 * SIDE * SIDE);
    let page = canvas.style().colour(WHITE);
    for row in 0..SIDE {
        for column in 0..SIDE {
            let place = |k: usize| 2.0 * (k as f64 + 0.5) / SIDE as f64 - 1.0;
            let (a, b) = (place(column), -place(row));
            let out = libm::hypot(a, b);
            let Colour(r, g, b) = if out > 1.0 { page } else { direction(on_wheel([a, b])) };
            rgb.extend([r, g, b]);
        }
    }
    canvas.raster(Rect { x0: x - radius, y0: y - radius, x1: x + radius, y1: y + radius }, SIDE, SIDE, rgb);
    canvas.text((x + radius + 2.5, y + 0.36 * SMALL_PT), Text::new("+x", SMALL_PT))?;
    canvas.text((x, y - radius - 2.5), Text::new("+y", SMALL_PT).align(Align::Centre))?;
    let below = |line: f64| (x, y + radius + line * (LABEL_PT + 1.0));
    canvas.text(below(1.0), Text::new("centre m_{z} = 1,", SMALL_PT).align(Align::Centre))?;
    canvas.text(below(2.0), Text::new("rim m_{z} = −1", SMALL_PT).align(Align::Centre))
}

/// The direction at a place on the wheel, whose radius is 1: by the angle from z, for by m_z those along z would be a point that
/// nobody sees.
fn on_wheel([a, b]: [f64; 2]) -> Vector {
    let out = libm::hypot(a, b);
    let across = libm::sin(PI * out) / out.max(1e-9);
    [across * a, across * b, libm::cos(PI * out)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::LatticeSpec;
    use crate::output::EnergyPath;
    use crate::output::canvas::Style;
    use crate::path::Path;
    use crate::spins::Spins;

    /// Two by three sites, 2 nm apart, the first vacant.
    fn film() -> Lattice {
        let lattice = r#"{"square": {"cells": [2, 3], "spacing": "2 nm"}}"#;
        serde_json::from_str::<LatticeSpec>(lattice).unwrap().resolve().unwrap()
    }

    #[test]
    fn each_site_colours_its_cell_and_a_vacant_one_nothing() {
        let places = SitePlaces::of(&film());
        let layer = Layer::of(&places, &[true]);
        assert_eq!((layer.sites.len(), layer.low, layer.size), (5, [-1.0, -1.0], [4.0, 6.0]));
        let pixels = |i: usize| layer.pixels(i, [4, 6]).collect::<Vec<_>>();
        assert_eq!((pixels(1), pixels(4)), (vec![22, 23, 18, 19], vec![4, 5, 0, 1]));
        let mut all: Vec<usize> = layer.sites.iter().flat_map(|i| pixels(*i)).collect();
        all.sort_unstable();
        assert!(all.len() == 20 && all.windows(2).all(|pair| pair[0] < pair[1]), "{all:?}");
        assert_eq!(layer.words("nm"), None);
    }

    #[test]
    fn of_several_layers_the_middle_one_is_shown() {
        let lattice = r#"{"cubic": {"cells": [2, 2, 3]}}"#;
        let lattice = serde_json::from_str::<LatticeSpec>(lattice).unwrap().resolve().unwrap();
        let places = SitePlaces::of(&lattice);
        let middle = Layer::of(&places, &[]);
        assert_eq!((middle.z, middle.words("a")), (Some(1.0), Some("the layer at z = 1 a".into())));
    }

    #[test]
    fn spins_along_the_axis_are_light_and_dark_and_the_others_have_a_hue() {
        let [up, down, x, y] = [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(|m| {
            let Colour(r, g, b) = direction(m);
            [r, g, b]
        });
        assert!(up.iter().all(|c| *c > 200) && down.iter().all(|c| *c < 90), "{up:?} {down:?}");
        let spread = |c: [u8; 3]| c.iter().max().unwrap() - c.iter().min().unwrap();
        assert!(spread(x) > 80 && spread(y) > 80 && x[0] > x[2] && x != y, "{x:?} {y:?}");
    }

    #[test]
    fn the_middle_of_the_wheel_has_the_colour_of_spins_along_the_axis() {
        let apart = |[a, b]: [f64; 2], m: Vector| {
            let (Colour(r, g, b), Colour(x, y, z)) = (direction(on_wheel([a, b])), direction(m));
            [(r, x), (g, y), (b, z)].into_iter().map(|(one, other)| one.abs_diff(other)).max().unwrap()
        };
        for place in [[5e-3, 5e-3], [-5e-3, 5e-3], [5e-3, -5e-3]] {
            assert!(apart(place, [0.0, 0.0, 1.0]) < 12, "{place:?}");
        }
        assert!(apart([0.0, 0.5], [0.0, 1.0, 0.0]) < 2 && apart([1.0, 0.0], [0.0, 0.0, -1.0]) < 2);
    }

    #[test]
    fn the_maps_are_the_ends_the_top_and_what_is_halfway() {
        let points: Vec<(f64, f64)> =
            [0.0, 1.0, 3.0, 9.0, 4.0, 1.0, 0.5].into_iter().enumerate().map(|(k, e)| (k as f64, e)).collect();
        let shown = maps(&points, 7);
        assert_eq!(shown.iter().map(|m| m.0).collect::<Vec<_>>(), [0, 1, 3, 4, 6]);
        assert_eq!(shown[2].1, "Highest");
        assert_eq!(maps(&points[..2], 2).len(), 2);
    }

    #[test]
    fn strips_are_below_each_other_and_nothing_overlaps() {
        for (size, columns) in [([16.0, 2.0], 1), ([10.0, 4.0], 2), ([5.0, 5.0], 3), ([2.0, 9.0], 3)] {
            let plan = Plan::of(241.0, size, 5, 70.0);
            assert_eq!(plan.columns, columns, "{size:?}");
            let mut rects: Vec<Rect> = (0..5).map(|k| plan.map(k, size)).collect();
            rects.push(plan.wheel);
            for (k, a) in rects.iter().enumerate() {
                assert!(a.x0 > 0.0 && a.x1 < 241.0 && a.y0 > 0.0 && a.y1 < plan.height, "{size:?} {k}");
                let apart = |b: &Rect| {
                    a.x1 <= b.x0 || b.x1 <= a.x0 || a.y1 + TITLE <= b.y0 + 1e-9 || b.y1 + TITLE <= a.y0 + 1e-9
                };
                assert!(rects[k + 1..].iter().all(apart), "{size:?} {k}");
            }
        }
        assert_eq!([6.75, 16.2, 40.0, 0.9].map(round_part), [2.0, 2.0, 10.0, 0.2]);
    }

    #[test]
    fn a_film_is_drawn_with_its_size_and_a_wheel() {
        let [up, x, down] =
            [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]].map(|m| Spins::from_vectors(&[m; 6]).unwrap());
        let path = Path::new(&[up, x, down]);
        let energy = EnergyPath { images: vec![(0.0, 0.0), (1.0, 2.0), (2.0, 0.0)], ..Default::default() };
        let data = PlotData { energy, path: Some(&path), ..Default::default() };
        let canvas = draw_spin_maps(&data, &film(), &Look::default()).unwrap();
        let svg = String::from_utf8(canvas.svg().unwrap()).unwrap();
        for words in ["Initial", "Highest", "Final", "1 nm, x to the right", "+x"] {
            assert!(svg.contains(words), "{words}");
        }
    }

    #[test]
    fn texts_of_a_narrow_figure_do_not_touch() {
        let lattice = r#"{"cubic": {"cells": [12, 12, 3]}}"#;
        let lattice = serde_json::from_str::<LatticeSpec>(lattice).unwrap().resolve().unwrap();
        let up = Spins::from_vectors(&[[0.0, 0.0, 1.0]; 432]).unwrap();
        let path = Path::new(&vec![up; 21]);
        let images = (0..21i32).map(|k| (f64::from(k), f64::from(10 - (k - 10).abs()))).collect();
        let energy = EnergyPath { images, ..Default::default() };
        let data = PlotData { energy, path: Some(&path), ..Default::default() };
        for width in [60.0, 70.0, 85.0] {
            let look = Look::new(Style::Paper, Some(width)).unwrap();
            draw_spin_maps(&data, &lattice, &look).unwrap().assert_legible();
        }
    }
}
