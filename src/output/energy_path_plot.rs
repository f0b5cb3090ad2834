//! `energy_path.svg` and `.png`: energy against the reaction coordinate, images as marks on the interpolated curve, saddles as
//! diamonds (of those that stand too close for their marks, some), the barrier as a double arrow. Several paths are laid over each
//! other, each with its barrier in the legend.
//!
//! Their numbers are those of `path.csv` (images), `profile.csv` (curve) and `summary.json` (saddles and barrier).

use super::canvas::{
    BLACK, BLUE, Canvas, Frame, GREY, LinePlot, Look, Marker, Obstacles, Point, Rect, SERIES, SMALL_PT, Series,
    THIN_PT, Text, VERMILLION, WHITE, pattern, turns,
};
use super::{Certainty, Plot, PlotData};
use crate::drive::{Barrier, Outcome};
use crate::error::{Error, Result};
use crate::stationary::ALIKE;

/// The energy path as a figure.
#[derive(Clone, Copy, Debug)]
pub struct EnergyPathPlot;

impl Plot for EnergyPathPlot {
    fn name(&self) -> &'static str {
        "energy_path"
    }

    fn draw(&self, data: &PlotData, look: &Look) -> Result<Canvas> {
        draw_energy_paths(std::slice::from_ref(&data.energy), look)
    }
}

/// An energy path to draw; points are (reaction coordinate in rad, energy above the initial state in meV).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EnergyPath {
    /// Its name, where several are drawn.
    pub name: String,
    /// The images.
    pub images: Vec<(f64, f64)>,
    /// The interpolated curve.
    pub profile: Vec<(f64, f64)>,
    /// The saddles.
    pub saddles: Vec<(f64, f64)>,
    /// The barrier.
    pub barrier: Option<Barrier>,
    /// How certain it is.
    pub certainty: Certainty,
}

impl EnergyPath {
    /// The energy path of an outcome.
    pub fn from_outcome(name: &str, outcome: &Outcome) -> EnergyPath {
        let t = &outcome.images;
        EnergyPath {
            name: name.into(),
            images: t.reaction_coordinate_rad.iter().copied().zip(t.above_initial_mev.iter().copied()).collect(),
            profile: outcome.profile.iter().map(|p| (p.reaction_coordinate_rad, p.above_initial_mev)).collect(),
            saddles: outcome.saddles.iter().map(|s| (s.reaction_coordinate_rad, s.above_initial_mev)).collect(),
            barrier: outcome.barrier,
            certainty: Certainty::of(outcome),
        }
    }

    /// The curve to draw: the profile, or the images where there is none.
    pub(super) fn curve(&self) -> &[(f64, f64)] {
        if self.profile.len() > 1 { &self.profile } else { &self.images }
    }

    /// The point of which the barrier speaks: a saddle, or else an image, an end included.
    fn top(&self) -> Option<(f64, f64)> {
        let mev = self.barrier?.forward_mev;
        let off = |p: &(f64, f64)| (p.1 - mev).abs();
        let nearest = |points: &[(f64, f64)]| points.iter().copied().min_by(|a, b| off(a).total_cmp(&off(b)));
        let saddle = self.saddles.iter().copied().find(|p| off(p) <= ALIKE * mev.abs());
        saddle.or_else(|| nearest(&self.images)).map(|p| (p.0, mev))
    }

    /// An energy of it after its sign: "= 6.298", or "≈ 6.3" where it is not certified.
    fn told(&self, mev: f64, unit: EnergyUnit) -> String {
        let sign = if self.certainty.is_certified() { "= " } else { "" };
        format!("{sign}{}", self.certainty.number(mev, unit.per_mev, 4))
    }

    /// The reaction coordinate at its end (rad).
    pub(super) fn length(&self) -> f64 {
        self.curve().last().map_or(0.0, |p| p.0)
    }

    pub(super) fn energies(&self) -> impl Iterator<Item = f64> {
        self.images.iter().chain(&self.profile).chain(&self.saddles).map(|p| p.1)
    }
}

/// One path with its barrier marked, or several with a legend.
pub fn draw_energy_paths(paths: &[EnergyPath], look: &Look) -> Result<Canvas> {
    let unit = EnergyUnit::for_paths(paths);
    let plot = plot(paths, unit).look(look);
    let (mut canvas, frame) = plot.draw_frame()?;
    match paths {
        [only] => {
            let guides = guides(only, unit, &frame);
            guides.draw_lines(&mut canvas);
            let mut obstacles = plot.draw_series(&mut canvas, &frame);
            guides.draw_labels(&mut canvas, &frame, &mut obstacles)?;
        }
        _ => {
            let obstacles = plot.draw_series(&mut canvas, &frame);
            plot.draw_legend(&mut canvas, &frame, &obstacles)?;
            for path in paths {
                for moved in path.certainty.moved_words() {
                    canvas.footnote(&format!("{}: {moved}", path.name))?;
                }
            }
        }
    }
    Ok(canvas)
}

/// The unit in which the numbers on the axis are short.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct EnergyUnit {
    name: &'static str,
    per_mev: f64,
    /// The span of energies in this unit; zero where the path is flat.
    span: f64,
}

impl EnergyUnit {
    /// Below this a path is flat (meV).
    const FLAT_MEV: f64 = 1e-9;

    fn for_paths(paths: &[EnergyPath]) -> EnergyUnit {
        EnergyUnit::for_energies(paths.iter().flat_map(EnergyPath::energies))
    }

    /// For energies above the initial state (meV).
    pub(super) fn for_energies(energies: impl Iterator<Item = f64>) -> EnergyUnit {
        let (lo, hi) = energies.fold((0.0f64, 0.0f64), |(lo, hi), e| (lo.min(e), hi.max(e)));
        let mev = hi - lo;
        let (name, per_mev) = match mev {
            ..EnergyUnit::FLAT_MEV => ("meV", 1.0),
            ..1e-4 => ("neV", 1e6),
            ..0.1 => ("µeV", 1e3),
            ..1e3 => ("meV", 1.0),
            _ => ("eV", 1e-3),
        };
        EnergyUnit { name, per_mev, span: if mev < EnergyUnit::FLAT_MEV { 0.0 } else { mev * per_mev } }
    }

    pub(super) fn name(&self) -> &'static str {
        self.name
    }

    /// Whether the energies are all the same.
    pub(super) fn is_flat(&self) -> bool {
        self.span == 0.0
    }

    /// The label of an axis of energies above the initial state.
    pub(super) fn axis_label(&self) -> String {
        format!("E − E_{{initial}} ({})", self.name)
    }

    pub(super) fn scaled(&self, points: &[(f64, f64)]) -> Vec<(f64, f64)> {
        points.iter().map(|&(x, e)| (x, e * self.per_mev)).collect()
    }
}

fn plot(paths: &[EnergyPath], unit: EnergyUnit) -> LinePlot {
    let mut plot = LinePlot::new("Reaction coordinate (rad)", unit.axis_label());
    plot.legend_above = paths.len() > 1;
    let turns = turns(&paths.iter().map(EnergyPath::curve).collect::<Vec<_>>());
    let longest = paths.iter().map(EnergyPath::length).fold(0.0, f64::max);
    for (k, path) in paths.iter().enumerate() {
        let colour = if paths.len() == 1 { BLUE } else { SERIES[k % SERIES.len()] };
        // images of many paths would hide each other, and so would those of paths on the same place
        let marker = image_marker(path.images.len()).filter(|_| paths.len() <= FEW && turns[k].of == 1);
        let mut curve = Series::line(unit.scaled(path.curve())).colour(colour);
        if paths.len() > 1 {
            curve = curve.label(legend(path, unit)).in_turn(turns[k], pattern(k));
        }
        plot.series.push(curve);
        plot.series.extend(marker.map(|m| Series::markers(unit.scaled(&path.images), m).colour(colour)));
        let saddle_colour = if paths.len() == 1 { VERMILLION } else { colour };
        let saddles = unit.scaled(&marked_saddles(&path.saddles, longest));
        plot.series.push(Series::markers(saddles, Marker::Diamond).colour(saddle_colour));
    }
    plot.y.range = Some(energy_range(paths, unit));
    if plot.series.iter().flat_map(|s| &s.points).all(|p| p.0 == 0.0) {
        plot.x.range = Some((-1.2, 1.2));
    }
    plot
}

/// Of up to so many paths the images are marked.
const FEW: usize = 3;

/// Marks of saddles are at least so far apart, in lengths of the path: two of their widths here, one beside the spins.
const APART: f64 = 0.07;

/// The first of those points of a path, (reaction coordinate, energy), that are as high as the highest, to rounding.
pub(super) fn first_of_the_highest(points: &[(f64, f64)]) -> Option<usize> {
    let highest = points.iter().map(|p| p.1).reduce(f64::max)?;
    let lowest = points.iter().map(|p| p.1).fold(0.0, f64::min);
    points.iter().position(|p| highest - p.1 <= ALIKE * (highest - lowest))
}

/// The saddles that have a mark: the highest, and to both sides of it each that has room for one beside the last.
pub(super) fn marked_saddles(saddles: &[(f64, f64)], length: f64) -> Vec<(f64, f64)> {
    let mut sorted = saddles.to_vec();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let Some(top) = first_of_the_highest(&sorted) else { return sorted };
    let mut marked = vec![sorted[top]];
    let (before, after) = sorted.split_at(top);
    for side in [&mut before.iter().rev() as &mut dyn Iterator<Item = _>, &mut after.iter()] {
        let mut last = sorted[top];
        for saddle in side.filter(|s| s.0 != sorted[top].0) {
            if (saddle.0 - last.0).abs() >= APART * length {
                last = *saddle;
                marked.push(last);
            }
        }
    }
    marked.sort_by(|a, b| a.0.total_cmp(&b.0));
    marked
}

/// Smaller where there are many, none where they would run into a band.
fn image_marker(images: usize) -> Option<Marker> {
    match images {
        0..=45 => Some(Marker::Disc),
        46..=120 => Some(Marker::Dot),
        _ => None,
    }
}

fn legend(path: &EnergyPath, unit: EnergyUnit) -> String {
    let told = match path.barrier {
        Some(b) => format!("{}: {} {}", path.name, path.certainty.number(b.forward_mev, unit.per_mev, 4), unit.name),
        None => path.name.clone(),
    };
    if path.certainty.is_certified() { told } else { format!("{told}, not certified") }
}

/// All energies, with room above for the highest mark.
fn energy_range(paths: &[EnergyPath], unit: EnergyUnit) -> (f64, f64) {
    if unit.span == 0.0 {
        return (-1.2, 1.2);
    }
    let energies = || paths.iter().flat_map(EnergyPath::energies).map(|e| e * unit.per_mev);
    let (lo, hi) = (energies().fold(0.0, f64::min), energies().fold(0.0, f64::max));
    (lo - 0.07 * unit.span, hi + 0.10 * unit.span)
}

/// A double arrow between two levels (pt).
struct Arrow {
    x: f64,
    from: f64,
    to: f64,
}

/// Everything that explains a barrier: levels and arrows, in points, and what they mean, a line each.
#[derive(Default)]
struct Guides {
    levels: Vec<[Point; 2]>,
    arrows: Vec<Arrow>,
    lines: Vec<String>,
}

/// Room that the saddle's mark takes (pt).
const MARK: f64 = 4.0;

/// The barrier from the initial state, and from the final one where its number is another.
fn guides(path: &EnergyPath, unit: EnergyUnit, frame: &Frame) -> Guides {
    let mut guides = Guides::default();
    let (Some(barrier), Some(top), Some(first), Some(last)) =
        (path.barrier, path.top(), path.images.first(), path.images.last())
    else {
        return guides;
    };
    let told = |mev: f64| format!("{} {}", path.told(mev, unit), unit.name);
    let [forward, backward] = [barrier.forward_mev, barrier.backward_mev].map(told);
    let height = |end: f64, mev: f64, shift: f64| Height { top, end, mev, shift };
    if forward == backward {
        guides.add(frame, unit, height(first.0, barrier.forward_mev, 0.0));
        guides.lines.push(format!("ΔE {forward}"));
    } else {
        guides.add(frame, unit, height(first.0, barrier.forward_mev, -1.0));
        guides.add(frame, unit, height(last.0, barrier.backward_mev, 1.0));
        guides.lines.push(format!("ΔE_{{→}} {forward}"));
        guides.lines.push(format!("ΔE_{{←}} {backward}"));
    }
    guides
}

/// The top of the path above one of its ends.
struct Height {
    top: (f64, f64),
    end: f64,
    mev: f64,
    /// On which side of the top its arrow is: −1 left, 1 right, 0 neither.
    shift: f64,
}

impl Guides {
    fn add(&mut self, frame: &Frame, unit: EnergyUnit, h: Height) {
        let place = |x: f64, e: f64| frame.place((x, e * unit.per_mev));
        let level = h.top.1 - h.mev;
        let (Some(top), Some(foot), Some(end)) = (place(h.top.0, h.top.1), place(h.top.0, level), place(h.end, level))
        else {
            return;
        };
        // an arrow without room below the saddle's mark stands beside it
        let low = foot.1 - top.1 <= 3.0 * MARK;
        let side = if low && h.shift == 0.0 { 1.0 } else { h.shift };
        let x = foot.0 + side * if low { 2.0 * MARK } else { 3.0 };
        self.levels.push([end, (x, foot.1)]);
        if low && foot.1 - top.1 > 0.5 {
            self.levels.push([top, (x, top.1)]);
            self.arrows.push(Arrow { x, from: foot.1, to: top.1 });
        } else if !low {
            self.arrows.push(Arrow { x, from: foot.1, to: top.1 + MARK });
        }
    }

    /// Beneath the curve: levels and arrows.
    fn draw_lines(&self, canvas: &mut Canvas) {
        for level in &self.levels {
            canvas.dashed(level, THIN_PT, GREY, (2.0, 2.0));
        }
        for arrow in &self.arrows {
            double_arrow(canvas, arrow);
        }
    }

    /// Beside the arrows, where nothing is covered.
    fn draw_labels(&self, canvas: &mut Canvas, frame: &Frame, obstacles: &mut Obstacles) -> Result<()> {
        for arrow in &self.arrows {
            obstacles.add_line(&[(arrow.x, arrow.from), (arrow.x, arrow.to)]);
        }
        self.levels.iter().for_each(|level| obstacles.add_line(level));
        let texts: Vec<Text> = self.lines.iter().map(|line| Text::new(line, SMALL_PT)).collect();
        let width = texts.iter().try_fold(0.0, |w: f64, t| Ok::<_, Error>(w.max(t.width()?)))?;
        let places = self.label_places(&frame.rect, width, LINE * texts.len() as f64);
        let Some((best, hits)) = obstacles.freest(&frame.rect, &places) else { return Ok(()) };
        let r = places[best];
        if hits > 0 {
            canvas.fill(r, WHITE);
        }
        for (k, text) in texts.into_iter().enumerate() {
            canvas.text((r.x0 + PADDING, r.y0 + PADDING + LINE * k as f64 + 0.8 * SMALL_PT), text)?;
        }
        Ok(())
    }

    /// Beside the arrows at many heights, the middle ones first; then anywhere in the frame, the nearest first.
    fn label_places(&self, frame: &Rect, width: f64, height: f64) -> Vec<Rect> {
        let Some(longest) = self.arrows.iter().max_by(|a, b| a.length().total_cmp(&b.length())) else {
            return grid(frame, width, height);
        };
        let (left, right) = self.arrows.iter().fold((longest.x, longest.x), |(l, r), a| (l.min(a.x), r.max(a.x)));
        let heights = [0.45, 0.4, 0.35, 0.3, 0.25, 0.2, 0.5, 0.55, 0.6, 0.65, 0.15, 0.7, 0.75, 0.8, 0.85, 0.9];
        let sides = [right + width / 2.0 + PADDING + 1.5, left - width / 2.0 - PADDING - 1.5];
        let beside = sides.into_iter().flat_map(|x| {
            heights.into_iter().map(move |t| around((x, longest.from + t * (longest.to - longest.from)), width, height))
        });
        let mut elsewhere = grid(frame, width, height);
        let distance = |r: &Rect| libm::hypot((r.x0 + r.x1) / 2.0 - longest.x, (r.y0 + r.y1) / 2.0 - longest.to);
        elsewhere.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
        beside.chain(elsewhere).collect()
    }
}

/// Distance between two lines of a label (pt).
const LINE: f64 = SMALL_PT + 2.5;
/// Free room around a label (pt).
const PADDING: f64 = 2.5;

/// The room of a label around its centre.
fn around((x, y): Point, width: f64, height: f64) -> Rect {
    Rect { x0: x - width / 2.0, y0: y - height / 2.0, x1: x + width / 2.0, y1: y + height / 2.0 }.grown(PADDING)
}

/// Places all over a frame.
fn grid(frame: &Rect, width: f64, height: f64) -> Vec<Rect> {
    let across = (1..32).flat_map(|i| (1..24).map(move |j| (f64::from(i) / 32.0, f64::from(j) / 24.0)));
    let places = across.map(|(fx, fy)| (frame.x0 + fx * frame.width(), frame.y0 + fy * frame.height()));
    places.map(|p| around(p, width, height)).filter(|r| frame.grown(-2.0).encloses(r)).collect()
}

impl Arrow {
    fn length(&self) -> f64 {
        (self.to - self.from).abs()
    }
}

/// From level to level; only a line where there is no room for heads.
fn double_arrow(canvas: &mut Canvas, arrow: &Arrow) {
    const HEAD: f64 = 4.0;
    const HALF: f64 = 1.3;
    let (up, x) = ((arrow.to - arrow.from).signum(), arrow.x);
    canvas.line(&[(x, arrow.from), (x, arrow.to)], 0.6, BLACK);
    if arrow.length() > 3.0 * HEAD {
        for (tip, inward) in [(arrow.to, -up), (arrow.from, up)] {
            canvas.polygon(&[(x, tip), (x - HALF, tip + inward * HEAD), (x + HALF, tip + inward * HEAD)], BLACK);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Heights of the levels and of the top of the highest arrow above the initial state (meV), from their places in the frame.
    fn drawn(path: &EnergyPath) -> (Vec<f64>, Vec<String>) {
        let unit = EnergyUnit::for_paths(std::slice::from_ref(path));
        let (_, frame) = plot(std::slice::from_ref(path), unit).draw_frame().unwrap();
        let guides = guides(path, unit, &frame);
        let height = |y: f64| frame.y.min + (frame.rect.y1 - y) / frame.rect.height() * (frame.y.max - frame.y.min);
        (guides.levels.iter().map(|level| height(level[0].1)).collect(), guides.lines)
    }

    fn path(forward: f64, backward: f64, saddle: f64) -> EnergyPath {
        EnergyPath {
            images: vec![(0.0, 0.0), (1.0, 6.0), (2.0, 5.0), (3.0, 1.0)],
            saddles: vec![(2.0, saddle)],
            barrier: Some(Barrier { forward_mev: forward, backward_mev: backward }),
            ..EnergyPath::default()
        }
    }

    #[test]
    fn the_highest_saddle_is_marked_and_of_the_others_those_that_have_room() {
        let valley: Vec<(f64, f64)> = (0..=100).map(|k| (f64::from(k), if k == 37 { 2.0 } else { 1.0 })).collect();
        let marked: Vec<f64> = marked_saddles(&valley, 90.0).iter().map(|p| p.0).collect();
        assert_eq!(marked, [2.0, 9.0, 16.0, 23.0, 30.0, 37.0, 44.0, 51.0, 58.0, 65.0, 72.0, 79.0, 86.0, 93.0, 100.0]);
        assert_eq!(marked_saddles(&[(8.0, 3.0), (1.0, 2.0)], 10.0), [(1.0, 2.0), (8.0, 3.0)]);
        assert_eq!(marked_saddles(&[], 10.0), []);
        // of two that differ by rounding all figures take the first
        assert_eq!(
            first_of_the_highest(&[(0.0, 0.0), (1.0, 2.0), (2.0, 1.0), (3.0, 2.0 + 1e-15), (4.0, 0.0)]),
            Some(1)
        );
    }

    fn assert_levels(path: &EnergyPath, levels: &[f64]) {
        let found = drawn(path).0;
        assert_eq!(found.len(), levels.len(), "{found:?}");
        assert!(found.iter().zip(levels).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?}");
    }

    #[test]
    fn levels_are_those_of_the_ends_whether_the_top_is_a_saddle_an_image_or_an_end() {
        assert_levels(&path(7.0, 6.0, 7.0), &[0.0, 1.0]);
        // the image at 6 meV is the barrier, the saddle lies below it
        assert_levels(&path(6.0, 5.0, 5.0), &[0.0, 1.0]);
        assert_eq!(path(6.0, 5.0, 5.0).top(), Some((1.0, 6.0)));
        // the path rises to its final end
        let uphill = EnergyPath { images: vec![(0.0, 0.0), (1.0, 2.0), (2.0, 5.0)], ..path(5.0, 0.0, 3.0) };
        assert_eq!(uphill.top(), Some((2.0, 5.0)));
        assert_levels(&uphill, &[0.0, 5.0]);
    }

    #[test]
    fn both_barriers_are_told_unless_their_numbers_are_the_same() {
        let lines = |forward, backward| drawn(&path(forward, backward, forward)).1;
        assert_eq!(lines(7.0, 7.0001), ["ΔE = 7.000 meV"]);
        assert_eq!(lines(7.0, 7.004), ["ΔE_{→} = 7.000 meV", "ΔE_{←} = 7.004 meV"]);
        let open = EnergyPath { certainty: Certainty::new(Some(0.02), [None; 2]), ..path(7.0, 7.004, 7.0) };
        assert_eq!(drawn(&open).1, ["ΔE ≈ 7.0 meV"]);
    }
}
