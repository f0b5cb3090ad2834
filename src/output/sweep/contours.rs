//! Contours of values on a grid of points: marching squares, straight through each cell.

/// Where a contour crosses a cell, from one point to another.
pub(super) type Segment = [(f64, f64); 2];

/// The contour at a level of values `z[column][row]` at the columns `x` and rows `y`; cells with a corner that has no value have none.
pub(super) fn contour(x: &[f64], y: &[f64], z: &[Vec<Option<f64>>], level: f64) -> Vec<Segment> {
    let mut found = Vec::new();
    for i in 1..x.len() {
        for k in 1..y.len() {
            let corners = [(i - 1, k - 1), (i, k - 1), (i, k), (i - 1, k)];
            let Some(values) = corners.iter().map(|(i, k)| z[*i][*k]).collect::<Option<Vec<f64>>>() else { continue };
            let crossing = |side: usize| {
                let (a, b) = (side, (side + 1) % 4);
                let [above, below] = [values[a] - level, values[b] - level];
                // a corner on the level counts as above it
                ((above >= 0.0) != (below >= 0.0)).then(|| {
                    let part = above / (above - below);
                    let at = |axis: &[f64], from: usize, to: usize| axis[from] + part * (axis[to] - axis[from]);
                    (at(x, corners[a].0, corners[b].0), at(y, corners[a].1, corners[b].1))
                })
            };
            let crossings: Vec<(f64, f64)> = (0..4).filter_map(crossing).collect();
            // at a pass two lines cross the cell, each about one of two opposite corners
            found.extend(crossings.chunks_exact(2).map(|pair| [pair[0], pair[1]]));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_contours_of_a_plane_are_straight_and_end_at_the_edges() {
        let axis: Vec<f64> = (0..5).map(f64::from).collect();
        let plane = |hole: bool| -> Vec<Vec<Option<f64>>> {
            let value = |i: usize, k: usize| (!hole || i < 3).then_some(axis[i] + 2.0 * axis[k]);
            (0..5).map(|i| (0..5).map(|k| value(i, k)).collect()).collect()
        };
        let lines = contour(&axis, &axis, &plane(false), 5.0);
        assert!(lines.iter().flatten().all(|(x, y)| (x + 2.0 * y - 5.0).abs() < 1e-12), "{lines:?}");
        let length: f64 = lines.iter().map(|[a, b]| (a.0 - b.0).hypot(a.1 - b.1)).sum();
        assert!((length - 4f64.hypot(2.0)).abs() < 1e-12, "{length}");
        let ends = |lines: &[Segment]| lines.iter().flatten().map(|p| p.0).fold(0.0, f64::max);
        assert_eq!((ends(&lines), ends(&contour(&axis, &axis, &plane(true), 5.0))), (4.0, 2.0));
        assert!(contour(&axis, &axis, &plane(false), 13.0).is_empty());
    }
}
