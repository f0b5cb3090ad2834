//! What a label must not cover.

use super::frame::Rect;
use super::shapes::Point;

/// Places already taken by curves and markers.
#[derive(Clone, Debug, Default)]
pub struct Obstacles {
    points: Vec<Point>,
}

impl Obstacles {
    /// A line, taken at every point or so.
    pub fn add_line(&mut self, line: &[Point]) {
        for pair in line.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let pieces = (libm::hypot(b.0 - a.0, b.1 - a.1).ceil() as usize).clamp(1, 2000);
            self.points.extend(
                (0..pieces).map(|k| k as f64 / pieces as f64).map(|t| (a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1))),
            );
        }
        self.points.extend(line.last());
    }

    /// The edge of a rectangle and its diagonals, as a label that is already there.
    pub fn add_box(&mut self, r: Rect) {
        let rows = 1 + (r.height() / 2.0).ceil().max(0.0) as usize;
        for y in (0..=rows).map(|k| r.y0 + r.height() * k as f64 / rows as f64) {
            self.add_line(&[(r.x0, y), (r.x1, y)]);
        }
    }

    /// How much of it lies in a rectangle.
    pub fn hits(&self, rect: &Rect) -> usize {
        self.points.iter().filter(|&&p| rect.contains(p)).count()
    }

    /// The first of the rectangles that lies inside `within` with the fewest hits.
    pub fn freest(&self, within: &Rect, candidates: &[Rect]) -> Option<(usize, usize)> {
        let inside = candidates.iter().enumerate().filter(|(_, r)| within.encloses(r));
        inside.map(|(k, r)| (k, self.hits(r))).min_by_key(|&(_, hits)| hits)
    }
}
