//! Lines that lie on each other take turns: each is drawn where the others leave a gap, so that all of them are seen.

use super::line_plot::Series;

/// Lines that differ by less than this share of the range of all are the same to the eye.
const SAME: f64 = 4e-3;
/// What one of them draws at a time (pt).
const PIECE: f64 = 4.0;

/// Which of the lines on the same place one is, and how many they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Turn {
    /// Counted from 0.
    pub place: usize,
    /// 1 for a line that lies on no other.
    pub of: usize,
}

/// The turns of lines, points from left to right.
pub fn turns(lines: &[&[(f64, f64)]]) -> Vec<Turn> {
    let all = || lines.iter().copied().flatten();
    let span = |value: fn(&(f64, f64)) -> f64| {
        let (lo, hi) = all().map(value).fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)));
        SAME * (hi - lo).max(0.0)
    };
    let near = (span(|p| p.0), span(|p| p.1));
    // the first line that each lies on
    let first: Vec<usize> =
        (0..lines.len()).map(|k| (0..k).find(|&j| coincide(lines[j], lines[k], near)).unwrap_or(k)).collect();
    let count = |upto: usize, j: usize| first[..upto].iter().filter(|f| **f == j).count();
    (0..lines.len()).map(|k| Turn { place: count(k, first[k]), of: count(lines.len(), first[k]) }).collect()
}

impl Series {
    /// Drawn where the others on the same place leave a gap; otherwise with its own dashes.
    pub fn in_turn(self, turn: Turn, dash: Option<(f64, f64)>) -> Series {
        if turn.of < 2 {
            return Series { dash, ..self };
        }
        let gap = PIECE * (turn.of - 1) as f64;
        Series { dash: Some((PIECE, gap)), skip: PIECE * turn.place as f64, ..self }
    }
}

/// Whether two lines have the same ends and neither strays from the other at any of its points.
fn coincide(a: &[(f64, f64)], b: &[(f64, f64)], near: (f64, f64)) -> bool {
    let (Some(a0), Some(b0), Some(a1), Some(b1)) = (a.first(), b.first(), a.last(), b.last()) else { return false };
    let on = |line: &[(f64, f64)], p: &(f64, f64)| (at(line, p.0) - p.1).abs() <= near.1;
    (a0.0 - b0.0).abs() <= near.0
        && (a1.0 - b1.0).abs() <= near.0
        && a.iter().all(|p| on(b, p))
        && b.iter().all(|p| on(a, p))
}

/// The value of a line at x; beyond its ends that of the end.
fn at(line: &[(f64, f64)], x: f64) -> f64 {
    let k = line.partition_point(|p| p.0 < x).clamp(1, line.len().max(2) - 1);
    let (Some(p), Some(q)) = (line.get(k - 1), line.get(k)) else { return line.first().map_or(0.0, |p| p.1) };
    let t = if q.0 > p.0 { ((x - p.0) / (q.0 - p.0)).clamp(0.0, 1.0) } else { 0.0 };
    p.1 + t * (q.1 - p.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_on_each_other_take_turns_and_others_do_not() {
        let line = |count: usize, slope: f64| {
            (0..count).map(|k| k as f64 / (count - 1) as f64).map(|x| (x, slope * x * x)).collect::<Vec<_>>()
        };
        let lines = [line(50, 1.0), line(80, 1.0), line(50, 0.9), line(50, 1.001), vec![], vec![(0.0, 0.0)]];
        let found = turns(&lines.iter().map(Vec::as_slice).collect::<Vec<_>>());
        let turn = |place, of| Turn { place, of };
        assert_eq!(found, [turn(0, 3), turn(1, 3), turn(0, 1), turn(2, 3), turn(0, 1), turn(0, 1)]);
        let drawn = Series::line(vec![]).in_turn(found[3], None);
        assert_eq!((drawn.dash, drawn.skip), (Some((PIECE, 2.0 * PIECE)), 2.0 * PIECE));
        assert_eq!(Series::line(vec![]).in_turn(found[2], None).dash, None);
    }
}
