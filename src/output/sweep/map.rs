//! `lifetime_map.svg` and `.png`: the mean first passage from the initial to the final state over the swept key and temperature.
//!
//! A cell a point and temperature, coloured by the decimal logarithm of the mean first passage to the final state, with contours at
//! powers of ten, interpolated over the key and 1/T, in which they are nearly straight. Grey: no time, because the barrier is below
//! k_BT, nothing is proven, or there is no result. The numbers are those of `lifetimes.csv`.

use super::contours::contour;
use super::plot::longest;
use super::{Parameter, PointState, SweepIndex};
use crate::error::Result;
use crate::output::canvas::{
    Align, Axis, BLACK, Canvas, Frame, GREY, Look, Obstacles, Point, Rect, SMALL_PT, Scale, THIN_PT, Text, Ticks,
    WHITE, colour_bar, mix, power_of_ten, sequential,
};
use crate::rates::Way;
use std::collections::BTreeSet;

/// Most contours.
const CONTOURS: usize = 8;
/// Room for the colour bar and its title (pt).
const BAR: f64 = 46.0;
/// Width of the bar and its distance from the map (pt).
const BAR_WIDTH: f64 = 8.0;
const GAP: f64 = 7.0;
/// Height of the figure (mm).
const HEIGHT_MM: f64 = 62.0;

/// The map; nothing where not one key alone has several numbers for values, or there are no times at several temperatures.
pub fn draw_map(index: &SweepIndex, states: &[PointState]) -> Result<Option<Canvas>> {
    let parameters: Vec<Parameter> = (0..index.keys.len()).map(|k| index.parameter(k)).collect();
    let Some(key) = longest(&parameters) else { return Ok(None) };
    let constant = |k: usize| index.points.iter().all(|p| p.values[k] == index.points[0].values[k]);
    if !(0..parameters.len()).all(|k| k == key || constant(k)) {
        return Ok(None);
    }
    let Some(map) = Map::of(&parameters[key], states) else { return Ok(None) };
    map.draw(&parameters[key].title, index.keys[key].log).map(Some)
}

/// A piece of a contour in the figure.
type Line = [Point; 2];

/// Times over a key and temperature.
struct Map {
    /// Values of the key, ascending.
    x: Vec<f64>,
    /// Temperatures (K), ascending.
    kelvin: Vec<f64>,
    /// log₁₀ of the mean first passage in s, of each value by temperature.
    log10_s: Vec<Vec<Option<f64>>>,
}

impl Map {
    fn of(parameter: &Parameter, states: &[PointState]) -> Option<Map> {
        let numbers = parameter.numbers.as_ref()?;
        let ascending = |of: BTreeSet<u64>| {
            let mut all: Vec<f64> = of.into_iter().map(f64::from_bits).collect();
            all.sort_by(f64::total_cmp);
            all
        };
        let times = |k: usize| states[k].found().into_iter().flat_map(|f| &f.times).filter(|t| t.way == Way::Forward);
        let x = ascending(numbers.iter().map(|x| x.to_bits()).collect());
        let kelvin = ascending((0..states.len()).flat_map(times).map(|t| t.temperature_k.to_bits()).collect());
        let mut log10_s = vec![vec![None; kelvin.len()]; x.len()];
        for k in (0..states.len()).filter(|k| states[*k].found().is_some_and(|f| f.head.is_proven())) {
            let column = x.iter().position(|x| *x == numbers[k])?;
            for time in times(k) {
                let row = kelvin.iter().position(|t| *t == time.temperature_k)?;
                log10_s[column][row] = time.log10_passage_s.filter(|t| t.is_finite());
            }
        }
        let any = log10_s.iter().flatten().any(Option::is_some);
        (any && x.len() > 1 && kelvin.len() > 1).then_some(Map { x, kelvin, log10_s })
    }

    fn range(&self) -> (f64, f64) {
        let all = self.log10_s.iter().flatten().flatten();
        let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), t| (l.min(*t), h.max(*t)));
        if high - low < 0.1 { (low - 0.5, high + 0.5) } else { (low, high) }
    }

    fn draw(&self, title: &str, log: bool) -> Result<Canvas> {
        let mut canvas = Canvas::styled(&Look::default(), HEIGHT_MM);
        let scale = if log { Scale::Log } else { Scale::Linear };
        let (columns, rows) = (edges(&self.x, log), edges(&self.kelvin, false));
        let axis = |edges: &[f64], scale| Axis::new(edges[0], edges[edges.len() - 1], scale, 5);
        let (x, y) = (axis(&columns, scale), axis(&rows, Scale::Linear));
        let rect = Rect {
            x0: Frame::left_margin(&y)?,
            y0: 8.0,
            x1: canvas.width() - BAR - GAP,
            y1: canvas.height() - Frame::bottom_margin() - SMALL_PT - 4.0,
        };
        let frame = Frame { rect, x, y, ticks: Ticks::Outward };
        let (low, high) = self.range();
        let part = |t: f64| (t - low) / (high - low);
        self.fill(&mut canvas, &frame, [&columns, &rows], &part);
        let levels = levels(low, high);
        self.contours(&mut canvas, &frame, &levels)?;
        frame.draw(&mut canvas, title, "Temperature (K)")?;
        let names: Vec<(f64, String)> = levels.iter().map(|n| (part(f64::from(*n)), power_of_ten(*n))).collect();
        let labels: Vec<(f64, &str)> = names.iter().map(|(at, name)| (*at, name.as_str())).collect();
        let bar = Rect { x0: rect.x1 + GAP, x1: rect.x1 + GAP + BAR_WIDTH, ..rect };
        colour_bar(&mut canvas, bar, "Mean first passage (s)", &labels, colour)?;
        if self.log10_s.iter().flatten().any(Option::is_none) {
            let words = "Grey: no lifetime (barrier below k_{B}T, or not proven)";
            canvas.text((rect.x0, canvas.height() - 3.0), Text::new(words, SMALL_PT))?;
        }
        Ok(canvas)
    }

    fn fill(&self, canvas: &mut Canvas, frame: &Frame, [columns, rows]: [&[f64]; 2], part: &dyn Fn(f64) -> f64) {
        for (i, column) in self.log10_s.iter().enumerate() {
            for (k, time) in column.iter().enumerate() {
                let corners = [(columns[i], rows[k]), (columns[i + 1], rows[k + 1])].map(|at| frame.place(at));
                let [Some((x0, y1)), Some((x1, y0))] = corners else { continue };
                // under the neighbours that are drawn later, so that no seam shows
                let under = Rect { x0, y0: (y0 - 0.5).max(frame.rect.y0), x1: (x1 + 0.5).min(frame.rect.x1), y1 };
                canvas.cell(under, time.map_or(mix(GREY, WHITE, 0.6), |t| colour(part(t))));
            }
        }
    }

    /// Contours with their powers of ten on them, where these hide no other.
    fn contours(&self, canvas: &mut Canvas, frame: &Frame, levels: &[i32]) -> Result<()> {
        let inverse: Vec<f64> = self.kelvin.iter().map(|t| 1.0 / t).collect();
        let place = |(x, beta): (f64, f64)| frame.place((x, 1.0 / beta));
        let placed = |[a, b]: [(f64, f64); 2]| Some([place(a)?, place(b)?]);
        let of = |level: &i32| contour(&self.x, &inverse, &self.log10_s, f64::from(*level));
        let lines: Vec<Vec<Line>> = levels.iter().map(|n| of(n).into_iter().filter_map(placed).collect()).collect();
        lines.iter().flatten().for_each(|line| canvas.line(line, THIN_PT, BLACK));
        let mut labels: Vec<(Rect, String)> = Vec::new();
        for (n, level) in levels.iter().enumerate() {
            let name = power_of_ten(*level);
            let wide = Text::new(&name, SMALL_PT).width()?;
            let wanted = frame.rect.x0 + frame.rect.width() * if n % 2 == 0 { 0.35 } else { 0.65 };
            let middle = |[a, b]: &Line| (0.5 * (a.0 + b.0), 0.5 * (a.1 + b.1));
            let off = |line: &&Line| (middle(line).0 - wanted).abs();
            let mut places: Vec<&Line> = lines[n].iter().collect();
            places.sort_by(|p, q| off(p).total_cmp(&off(q)));
            let mut others = Obstacles::default();
            let of_others = lines.iter().enumerate().filter(|(k, _)| *k != n).flat_map(|(_, lines)| lines);
            of_others.for_each(|line| others.add_line(line));
            let (half, high) = (0.5 * wide + 1.5, 0.5 * SMALL_PT + 0.8);
            let about = |(x, y): Point| Rect { x0: x - half, y0: y - high, x1: x + half, y1: y + high };
            let is_free = |own: &Rect| {
                let is_apart = labels.iter().all(|(other, _)| own.is_apart_from(other));
                frame.rect.encloses(own) && is_apart && others.hits(own) == 0
            };
            let own = places.into_iter().map(|line| about(middle(line))).find(is_free);
            labels.extend(own.map(|own| (own, name)));
        }
        for (own, name) in labels {
            canvas.fill(own, WHITE);
            let at = (0.5 * (own.x0 + own.x1), 0.5 * (own.y0 + own.y1) + 0.36 * SMALL_PT);
            canvas.text(at, Text::new(name, SMALL_PT).align(Align::Centre))?;
        }
        Ok(())
    }
}

/// Light enough at both ends for black lines.
fn colour(part: f64) -> crate::output::canvas::Colour {
    mix(sequential(part.clamp(0.0, 1.0)), WHITE, 0.25)
}

/// Powers of ten from a low to a high one, not too many.
fn levels(low: f64, high: f64) -> Vec<i32> {
    let whole = |step: i32| {
        let first = (low / f64::from(step)).ceil() as i32;
        let last = (high / f64::from(step)).floor() as i32;
        (first..=last).map(|n| n * step).collect::<Vec<_>>()
    };
    let steps = [1, 2, 3, 5, 10, 20, 50, 100, 200, 500];
    steps.into_iter().map(whole).find(|all| all.len() <= CONTOURS).unwrap_or_default()
}

/// Edges of cells about values: halfway between them, and as far beyond the outer ones.
fn edges(values: &[f64], log: bool) -> Vec<f64> {
    let to = |x: &f64| if log { libm::log(*x) } else { *x };
    let back = |x: f64| if log { libm::exp(x) } else { x };
    let at: Vec<f64> = values.iter().map(to).collect();
    let last = at.len() - 1;
    let inner = at.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
    let all = [1.5 * at[0] - 0.5 * at[1]].into_iter().chain(inner).chain([1.5 * at[last] - 0.5 * at[last - 1]]);
    let mut edges: Vec<f64> = all.map(back).collect();
    // no cell reaches below no temperature
    if values[0] >= 0.0 {
        edges[0] = edges[0].max(0.0);
    }
    edges
}
