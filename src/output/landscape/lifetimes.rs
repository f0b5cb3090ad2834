//! `lifetimes.svg` and `.png`: mean times against 1000/T, on a logarithmic scale: Langer's, or those of HTST where there are none of
//! his. The numbers are those of `lifetimes.csv`; what is not drawn of them is counted. One temperature makes no figure.

use super::LandscapeReport;
use crate::drive::survey::Lifetime;
use crate::error::Result;
use crate::output::arrhenius_plot;
use crate::output::canvas::{Canvas, GREY, LinePlot, Marker, Series, turns};

/// Most lines.
const LINES: usize = 6;

pub(super) fn draw(report: &LandscapeReport) -> Result<Option<Canvas>> {
    let Some(lifetimes) = &report.survey.lifetimes else { return Ok(None) };
    if lifetimes.settings.temperatures_k.len() < 2 {
        return Ok(None);
    }
    let mut pairs: Vec<(&str, Option<&str>)> = Vec::new();
    for row in &lifetimes.rows {
        let pair = (row.from.as_str(), row.to.as_deref());
        if !pairs.contains(&pair) {
            pairs.push(pair);
        }
    }
    // ways from group to group say most
    pairs.sort_by_key(|(_, to)| to.is_none());
    let mut plot = LinePlot::new("1000 K / T", "Mean time (s)").log_y().look(&report.look);
    plot.legend_above = true;
    let (mut left_out, mut outside) = (0, 0);
    for (from, to) in pairs {
        let own = |r: &&Lifetime| r.from == from && r.to.as_deref() == to;
        let time = |r: &Lifetime| r.ln_time_s[1].or(r.ln_time_s[0]).map(libm::exp);
        let point = |r: &Lifetime| Some((1000.0 / r.temperature_k, time(r)?));
        let known: Vec<(f64, f64)> = lifetimes.rows.iter().filter(own).filter_map(point).collect();
        let is_drawn = |p: &(f64, f64)| arrhenius_plot::is_drawn(p.1);
        let mut points: Vec<(f64, f64)> = known.iter().copied().filter(is_drawn).collect();
        points.sort_by(|p, q| p.0.total_cmp(&q.0));
        if points.is_empty() || plot.series.len() == LINES {
            left_out += 1;
            continue;
        }
        outside += known.len() - points.len();
        let words = to.map_or_else(|| format!("out of {from}"), |to| format!("{from} to {to}"));
        let marker = (points.len() <= 12).then_some(Marker::Disc);
        plot.series.push(Series { marker, ..Series::line(points).label(words) });
    }
    if plot.series.is_empty() {
        return Ok(None);
    }
    // up and down may be alike
    let lines: Vec<Vec<(f64, f64)>> = plot.series.iter().map(|s| s.points.clone()).collect();
    let turns = turns(&lines.iter().map(Vec::as_slice).collect::<Vec<_>>());
    plot.series = plot.series.into_iter().zip(turns).map(|(series, turn)| series.in_turn(turn, None)).collect();
    let place = plot.series[0].points[0];
    if left_out > 0 {
        plot.series.push(Series::line(vec![place]).label(format!("{left_out} more in lifetimes.csv")).colour(GREY));
    }
    plot.series.extend(arrhenius_plot::beyond(outside, "lifetimes.csv", place));
    plot.draw().map(Some)
}
