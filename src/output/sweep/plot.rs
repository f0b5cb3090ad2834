//! `barriers.svg` and `.png`: the forward barrier against the swept key with the most values, a curve for each of the others'.
//!
//! Certified barriers are discs, others rings; a point without a barrier is left out.

use super::{Parameter, PointState, SweepIndex, word};
use crate::error::Result;
use crate::output::canvas::{BLACK, Canvas, Colour, LinePlot, Marker, SERIES, Scale, Series, sequential};
use crate::words::number;
use std::collections::BTreeSet;

/// A log scale is used for barriers that differ by more than this factor.
const WIDE: f64 = 1e3;
/// Curves in the legend where there are too many for names of their own.
const NAMED: usize = 5;

/// A longer legend has room of its own above the curves.
const CORNER: usize = 3;
/// The part of the figure's height that a line of the legend takes.
const LINE_PART: f64 = 0.075;

/// A curve: its name and its points.
struct Curve {
    name: String,
    points: Vec<usize>,
}

/// The figure; nothing where no point has a barrier.
pub fn draw_sweep(index: &SweepIndex, states: &[PointState]) -> Result<Option<Canvas>> {
    let height = |k: usize| states[k].found()?.barrier.map(|b| b.forward_mev);
    if (0..states.len()).all(|k| height(k).is_none()) {
        return Ok(None);
    }
    let parameters: Vec<Parameter> = (0..index.keys.len()).map(|k| index.parameter(k)).collect();
    let along = longest(&parameters);
    let counted = Parameter {
        column: String::new(),
        title: "point".into(),
        unit: String::new(),
        numbers: Some((0..states.len()).map(|k| k as f64).collect()),
    };
    let x = along.map_or(&counted, |k| &parameters[k]);
    let mut plot = LinePlot::new(&x.title, "Forward barrier (meV)");
    if along.is_some_and(|k| index.keys[k].log) {
        plot = plot.log_x();
    }
    let heights: Vec<f64> = (0..states.len()).filter_map(height).collect();
    let (low, high) = heights.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), e| (l.min(*e), h.max(*e)));
    if low > 0.0 && high > WIDE * low {
        plot = plot.log_y();
    }
    let curves = curves(index, &parameters, along);
    let mut doubtful = false;
    for (k, curve) in curves.iter().enumerate() {
        let colour = colour(k, curves.len());
        let at = |p: &usize| Some((x.numbers.as_ref()?[*p], height(*p)?));
        let mut line: Vec<(f64, f64)> = curve.points.iter().filter_map(at).collect();
        line.sort_by(|a, b| a.0.total_cmp(&b.0));
        let proven = |p: &usize| states[*p].found().is_some_and(|f| f.head.is_proven());
        let (sure, other): (Vec<usize>, Vec<usize>) = curve.points.iter().copied().partition(proven);
        let marks =
            |points: Vec<usize>, marker| Series::markers(points.iter().filter_map(at).collect(), marker).colour(colour);
        let mut series = Series::line(line).colour(colour).width(0.8);
        if is_named(k, curves.len()) && curves.len() > 1 {
            series = series.label(&curve.name);
        }
        plot.series.push(series);
        plot.series.push(marks(sure, if curves.len() > SERIES.len() { Marker::Dot } else { Marker::Disc }));
        let rings = marks(other, Marker::Ring);
        doubtful |= !rings.points.is_empty();
        plot.series.push(rings);
    }
    if doubtful {
        plot.series.push(Series::markers(Vec::new(), Marker::Ring).colour(BLACK).label("not certified"));
    }
    let named = plot.series.iter().filter(|s| s.label.is_some()).count();
    if named > CORNER && plot.y.scale == Scale::Linear {
        let free = LINE_PART * named as f64;
        let span = (high - low).max(1e-9 * high.abs());
        plot = plot.y_range(low - 0.06 * span, high + span * free / (1.0 - free));
    }
    plot.draw().map(Some)
}

/// The key of numbers with the most values, the last of several.
pub(super) fn longest(parameters: &[Parameter]) -> Option<usize> {
    let distinct = |numbers: &[f64]| numbers.iter().map(|x| x.to_bits()).collect::<BTreeSet<_>>().len();
    let counts = parameters.iter().enumerate().filter_map(|(k, p)| Some((k, distinct(p.numbers.as_ref()?))));
    counts.max_by_key(|(_, count)| *count).map(|(k, _)| k)
}

/// Points that differ in one key only, where there are such; otherwise one curve through all of them.
fn curves(index: &SweepIndex, parameters: &[Parameter], along: Option<usize>) -> Vec<Curve> {
    let all = || vec![Curve { name: String::new(), points: (0..index.points.len()).collect() }];
    let Some(along) = along else { return all() };
    let mut curves: Vec<Curve> = Vec::new();
    for point in 0..index.points.len() {
        let others = (0..parameters.len()).filter(|k| *k != along);
        let value = |k: usize| {
            let p = &parameters[k];
            let value = match &p.numbers {
                Some(numbers) => format!("{}{}", number(numbers[point]), p.unit),
                None => word(&index.points[point].values[k]),
            };
            format!("{} = {value}", index.keys[k].drawn())
        };
        let name = others.map(value).collect::<Vec<_>>().join(", ");
        match curves.iter_mut().find(|c| c.name == name) {
            Some(curve) => curve.points.push(point),
            None => curves.push(Curve { name, points: vec![point] }),
        }
    }
    if curves.iter().all(|c| c.points.len() < 2) { all() } else { curves }
}

fn colour(k: usize, count: usize) -> Colour {
    match count <= SERIES.len() {
        true => SERIES[k],
        false => sequential(k as f64 / (count - 1) as f64),
    }
}

/// Whether the legend has the curve: the first, the last, and some between.
fn is_named(k: usize, count: usize) -> bool {
    count <= SERIES.len() || (0..NAMED).any(|n| (n * (count - 1) + (NAMED - 1) / 2) / (NAMED - 1) == k)
}
