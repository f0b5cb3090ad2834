//! `disconnectivity.svg` and `.png`: which minima passes below an energy join. Each line that ends below is a minimum, and lines meet at
//! the lowest saddle between theirs; the numbers are those of `minima.csv`.

use super::LandscapeReport;
use crate::error::Result;
use crate::network::{Branch, Tree};
use crate::output::canvas::{
    Align, Axis, BLACK, BLUE, Canvas, Frame, GREY, MM, Point, Rect, SMALL_PT, THIN_PT, Text, Ticks,
};

/// Height of the figure (mm).
const HEIGHT_MM: f64 = 64.0;
/// Saddles that differ by no more than this part of the whole height are drawn at one energy.
const ALIKE: f64 = 1e-9;
/// Thickness of a branch (pt).
const LINE_PT: f64 = 0.7;
/// Room for a number below a minimum (pt).
const PITCH: f64 = 11.0;
/// So many of the lowest minima have their numbers where not all have.
const LOWEST: usize = 8;

pub(super) fn draw(report: &LandscapeReport) -> Result<Option<Canvas>> {
    let s = report.survey;
    if s.minima.is_empty() {
        return Ok(None);
    }
    let minima: Vec<f64> = (0..s.minima.len()).map(|k| s.minimum_kind(k).above_lowest_mev).collect();
    let passes: Vec<([usize; 2], f64)> = s.passes().collect();
    let top = passes.iter().map(|p| p.1).chain(minima.iter().copied()).fold(0.0, f64::max);
    let tree = Tree::of(&minima, &passes, ALIKE * top);
    let high = tree.branches.iter().map(|b| b.energy).fold(0.0, f64::max);
    let high = if high > 0.0 { high } else { 1.0 };
    let mut canvas = Canvas::styled(&report.look, HEIGHT_MM);
    let y = Axis::linear(-0.04 * high, 1.08 * high, 6);
    let x = Axis::linear(0.0, minima.len() as f64, 0);
    let rect = Rect {
        x0: Frame::left_margin(&y)?,
        y0: 5.0,
        x1: report.look.drawn_width_mm() * MM - 4.0,
        y1: HEIGHT_MM * MM - 5.0,
    };
    let frame = Frame { rect, x, y, ticks: Ticks::Outward };
    frame.draw_y(&mut canvas, "Energy (meV)")?;
    canvas.line(&[(rect.x0, rect.y0), (rect.x0, rect.y1)], THIN_PT, BLACK);
    let mut drawing = Drawing { canvas, frame, next: 0.0, leaves: Vec::new() };
    for branch in &tree.branches {
        // what no pass joins with anything ends above in the open
        let x = drawing.branch(branch)?;
        let above = if branch.energy < high { high } else { 1.05 * high };
        drawing.line((x, branch.energy), (x, above), tree.branches.len() > 1);
    }
    drawing.number(rect.width() > PITCH * minima.len() as f64)?;
    Ok(Some(drawing.canvas))
}

struct Drawing {
    canvas: Canvas,
    frame: Frame,
    /// Where the next minimum stands.
    next: f64,
    /// The minima that were drawn, and the places of their ends.
    leaves: Vec<(usize, Point)>,
}

impl Drawing {
    /// Draws what is below the top of a branch; where it stands.
    fn branch(&mut self, branch: &Branch) -> Result<f64> {
        if let Some(minimum) = branch.minimum {
            let x = self.next + 0.5;
            self.next += 1.0;
            self.leaves.extend(self.frame.place((x, branch.energy)).map(|end| (minimum, end)));
            return Ok(x);
        }
        let mut places = Vec::new();
        for part in &branch.parts {
            let x = self.branch(part)?;
            self.line((x, part.energy), (x, branch.energy), false);
            places.push(x);
        }
        let [first, last] = [places[0], places[places.len() - 1]];
        self.line((first, branch.energy), (last, branch.energy), false);
        Ok(0.5 * (first + last))
    }

    /// Writes the numbers of all minima; or, where these have no room, of the lowest, which have the lowest numbers, as far as they have.
    fn number(&mut self, all: bool) -> Result<()> {
        self.leaves.sort_by_key(|(minimum, _)| *minimum);
        let mut taken: Vec<(f64, f64)> = Vec::new();
        let count = if all { self.leaves.len() } else { LOWEST };
        for (minimum, (x, y)) in std::mem::take(&mut self.leaves).into_iter().take(count) {
            let text = Text::new(minimum.to_string(), SMALL_PT).align(Align::Centre).colour(BLUE);
            let half = 0.5 * text.width()? + 1.0;
            // beside the axis, not on it
            let x = x.max(self.frame.rect.x0 + half);
            if all || taken.iter().all(|(other, room)| (x - other).abs() > half + room) {
                taken.push((x, half));
                self.canvas.text((x, y + SMALL_PT + 1.0), text)?;
            }
        }
        Ok(())
    }

    fn line(&mut self, from: (f64, f64), to: (f64, f64), open: bool) {
        let (Some(from), Some(to)) = (self.frame.place(from), self.frame.place(to)) else { return };
        match open {
            true => self.canvas.dashed(&[from, to], LINE_PT, GREY, (2.0, 2.0)),
            false => self.canvas.line(&[from, to], LINE_PT, BLACK),
        }
    }
}
