//! `network.svg` and `.png`: minima as discs, saddles as lines between them, both coloured by their energy. Several saddles between two
//! minima are arcs side by side; one that leads back to where it began is left out. The numbers are those of `minima.csv`.

use super::LandscapeReport;
use crate::drive::survey::Survey;
use crate::error::Result;
use crate::network::layout;
use crate::output::canvas::{
    Align, BLACK, Canvas, LABEL_PT, MM, Rect, SMALL_PT, Text, WHITE, colour_bar, sequential, significant,
};
use std::collections::BTreeMap;

/// Height of the figure (mm).
const HEIGHT_MM: f64 = 64.0;
/// No more of the lowest minima are drawn.
const MOST_MINIMA: usize = 500;
/// By how much arcs between the same two minima are apart in their middle, and how wide all of them are at most, in steps.
const ARCS: f64 = 0.16;
const BUNDLE: f64 = 0.8;
/// Points along an arc.
const POINTS: usize = 16;
/// With no more minima than these each has its number.
const NUMBERED: usize = 60;
/// Radius of a disc with a number, and what is left around all of them (pt).
const DISC: f64 = 5.2;
const MARGIN: f64 = 10.0;
/// How often those that overlap are moved apart, at most.
const PUSHES: usize = 50;

/// What is drawn where; a step is 1 long or so.
pub struct Network {
    /// Of each minimum that is drawn, the lowest first.
    pub minima: Vec<[f64; 2]>,
    /// Of each saddle that is drawn: its number, and the point that bends its arc.
    pub saddles: Vec<(usize, [f64; 2])>,
    /// The highest energy of what is drawn, above the lowest minimum (meV).
    pub top_mev: f64,
}

impl Network {
    pub fn of(s: &Survey) -> Network {
        let mut lowest: Vec<usize> = (0..s.minima.len()).collect();
        lowest.truncate(MOST_MINIMA);
        let drawn: Vec<usize> = (0..s.saddles.len())
            .filter(|k| s.saddles[*k].minima.iter().all(|m| *m < lowest.len()))
            .filter(|k| s.saddles[*k].minima[0] != s.saddles[*k].minima[1])
            .collect();
        let pair = |k: usize| [0, 1].map(|side| s.saddles[k].minima[side]);
        let mut minima = layout(lowest.len(), &drawn.iter().map(|k| pair(*k)).collect::<Vec<_>>());
        if minima.len() <= NUMBERED {
            part(&mut minima);
        }
        let mut between: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
        for &k in &drawn {
            let [a, b] = pair(k);
            between.entry([a.min(b), a.max(b)]).or_default().push(k);
        }
        let arcs = between.iter().flat_map(|([a, b], all)| {
            let (p, q, gaps) = (minima[*a], minima[*b], (all.len() - 1) as f64);
            let gap = ARCS.min(BUNDLE / gaps.max(1.0));
            all.iter().enumerate().map(move |(k, saddle)| (*saddle, bend(p, q, gap * (k as f64 - 0.5 * gaps))))
        });
        let mut saddles: Vec<(usize, [f64; 2])> = arcs.collect();
        // the lowest lie on top
        saddles.sort_by_key(|(k, _)| std::cmp::Reverse(*k));
        let heights = saddles.iter().map(|(k, _)| s.saddle_kind(*k).above_lowest_mev);
        let own = lowest.iter().map(|k| s.minimum_kind(*k).above_lowest_mev);
        Network { top_mev: heights.chain(own).fold(0.0, f64::max), minima, saddles }
    }

    /// From 0 to 1 up to the highest energy that is drawn.
    pub fn fraction(&self, mev: f64) -> f64 {
        if self.top_mev > 0.0 { mev / self.top_mev } else { 0.0 }
    }
}

/// Moves places apart where a disc would cover another one's number.
fn part(places: &mut [[f64; 2]]) {
    let extent = [0, 1].map(|c| {
        let (low, high) = places.iter().fold((f64::MAX, f64::MIN), |(l, h), p| (p[c].min(l), p[c].max(h)));
        high - low
    });
    let apart = 2.1 * DISC * extent[0].max(extent[1]) / (HEIGHT_MM * MM - 2.0 * MARGIN);
    for _ in 0..PUSHES {
        let mut any = false;
        for (i, j) in (0..places.len()).flat_map(|j| (0..j).map(move |i| (i, j))) {
            let [p, q] = [places[i], places[j]];
            let far = libm::hypot(q[0] - p[0], q[1] - p[1]);
            if (1e-9..apart).contains(&far) {
                let push = 0.5 * (apart / far - 1.0);
                for c in 0..2 {
                    places[i][c] -= push * (q[c] - p[c]);
                    places[j][c] += push * (q[c] - p[c]);
                }
                any = true;
            }
        }
        if !any {
            break;
        }
    }
}

/// The control point of the arc that is so many steps beside the straight line in its middle.
fn bend(p: [f64; 2], q: [f64; 2], beside: f64) -> [f64; 2] {
    let along = [q[0] - p[0], q[1] - p[1]];
    let size = libm::hypot(along[0], along[1]).max(1e-9);
    // the middle of the arc is half as far from the line
    let off = 2.0 * beside;
    [0.5 * (p[0] + q[0]) - off * along[1] / size, 0.5 * (p[1] + q[1]) + off * along[0] / size]
}

pub(super) fn draw(report: &LandscapeReport) -> Result<Option<Canvas>> {
    let s = report.survey;
    if s.minima.is_empty() {
        return Ok(None);
    }
    let network = Network::of(s);
    let mut canvas = Canvas::styled(&report.look, HEIGHT_MM);
    let bar = bar(report, &network)?;
    let room = Rect { x0: MARGIN, y0: MARGIN, x1: bar.x0 - 14.0, y1: HEIGHT_MM * MM - MARGIN };
    let place = placed(&network, room);
    let colour = |mev: f64| sequential(network.fraction(mev));
    for (k, control) in &network.saddles {
        let [a, b] = s.saddles[*k].minima.map(|m| place(network.minima[m]));
        let c = place(*control);
        let at = |t: f64| {
            let weights = [(1.0 - t) * (1.0 - t), 2.0 * t * (1.0 - t), t * t];
            (
                weights[0] * a.0 + weights[1] * c.0 + weights[2] * b.0,
                weights[0] * a.1 + weights[1] * c.1 + weights[2] * b.1,
            )
        };
        let arc: Vec<(f64, f64)> = (0..=POINTS).map(|j| at(j as f64 / POINTS as f64)).collect();
        canvas.line(&arc, 0.8, colour(s.saddle_kind(*k).above_lowest_mev));
    }
    let numbered = network.minima.len() <= NUMBERED;
    let radius = if numbered { DISC } else { 2.4 };
    for (k, p) in network.minima.iter().enumerate().rev() {
        let (x, y) = place(*p);
        canvas.disc((x, y), radius, BLACK);
        canvas.disc((x, y), radius - 0.5, colour(s.minimum_kind(k).above_lowest_mev));
        if numbered {
            let text = Text::new(k.to_string(), SMALL_PT).align(Align::Centre).colour(WHITE);
            canvas.text((x, y + 0.36 * SMALL_PT), text)?;
        }
    }
    let labels = [(0.0, "0".to_string()), (1.0, significant(network.top_mev, 3))];
    let labels: Vec<(f64, &str)> = labels.iter().map(|(f, words)| (*f, words.as_str())).collect();
    colour_bar(&mut canvas, bar, TITLE, &labels, sequential)?;
    Ok(Some(canvas))
}

const TITLE: &str = "Energy (meV)";

/// Where the bar of colours stands, with room for its words at its right.
fn bar(report: &LandscapeReport, network: &Network) -> Result<Rect> {
    let words = Text::new(significant(network.top_mev, 3), SMALL_PT).width()?;
    let x1 = report.look.drawn_width_mm() * MM - words - LABEL_PT - 10.0;
    Ok(Rect { x0: x1 - 7.0, y0: 12.0, x1, y1: HEIGHT_MM * MM - 12.0 })
}

/// From the network's places to those in a rectangle, alike in both directions.
fn placed(network: &Network, room: Rect) -> impl Fn([f64; 2]) -> (f64, f64) {
    let all = || network.minima.iter().chain(network.saddles.iter().map(|(_, c)| c));
    let ends = |c: usize| all().fold([f64::INFINITY, f64::NEG_INFINITY], |e, p| [e[0].min(p[c]), e[1].max(p[c])]);
    let [x, y] = [ends(0), ends(1)];
    let scale = (room.width() / (x[1] - x[0]).max(1e-9)).min(room.height() / (y[1] - y[0]).max(1e-9)).min(60.0);
    let middle = (0.5 * (room.x0 + room.x1), 0.5 * (room.y0 + room.y1));
    move |p| (middle.0 + scale * (p[0] - 0.5 * (x[0] + x[1])), middle.1 - scale * (p[1] - 0.5 * (y[0] + y[1])))
}
