//! Where states are drawn in a plane: two of them as far apart as there are steps between them, as far as that goes.
//!
//! ```text
//! Σ_{i<j} w_ij (|x_i − x_j| − d_ij)² least,   w_ij = d_ij⁻²         d_ij: steps along the shortest way
//! ```
//! from the plane that holds most of the distances (classical scaling), by majorisation, state after state: E. R. Gansner, Y. Koren,
//! S. North, Graph Drawing 2004, LNCS 3383, 239, doi:10.1007/978-3-540-31843-9_25. The longest extent lies along x.

/// How far parts that nothing joins stand apart, beyond the longest way of all (steps).
const GAP: usize = 1;
/// Steps of the search for each axis of the first plane.
const ROUNDS: usize = 60;
/// Rounds of the majorisation.
const SWEEPS: usize = 150;

/// A place for each of so many states; a step is 1 long or so.
pub fn layout(states: usize, edges: &[[usize; 2]]) -> Vec<[f64; 2]> {
    let far = distances(states, edges);
    let mut places = plane(states, &far);
    for _ in 0..SWEEPS {
        (0..states).for_each(|i| places[i] = settled(&places, &far, i));
    }
    turned(places)
}

/// Steps between any two, by the shortest way.
fn distances(states: usize, edges: &[[usize; 2]]) -> Vec<f64> {
    let mut beside: Vec<Vec<usize>> = vec![Vec::new(); states];
    for &[a, b] in edges {
        beside[a].push(b);
        beside[b].push(a);
    }
    let mut steps = vec![usize::MAX; states * states];
    for from in 0..states {
        let own = &mut steps[from * states..(from + 1) * states];
        own[from] = 0;
        let (mut front, mut far) = (vec![from], 0);
        while !front.is_empty() {
            far += 1;
            let reached: Vec<usize> = front.iter().flat_map(|i| beside[*i].iter().copied()).collect();
            front = reached
                .into_iter()
                .filter(|j| {
                    own[*j] == usize::MAX && {
                        own[*j] = far;
                        true
                    }
                })
                .collect();
        }
    }
    let longest = steps.iter().copied().filter(|d| *d != usize::MAX).max().unwrap_or(0);
    steps.into_iter().map(|d| if d == usize::MAX { longest + GAP } else { d } as f64).collect()
}

/// Classical scaling: the two directions in which −½ JD²J, with the mean taken off rows and columns, is largest; states that are
/// alike to all others stand a little apart.
fn plane(states: usize, far: &[f64]) -> Vec<[f64; 2]> {
    let n = states as f64;
    let square = |i: usize, j: usize| far[i * states + j] * far[i * states + j];
    let means: Vec<f64> = (0..states).map(|i| (0..states).map(|j| square(i, j)).sum::<f64>() / n).collect();
    let mean = means.iter().sum::<f64>() / n;
    let product = |v: &[f64]| -> Vec<f64> {
        let row = |i: usize| (0..states).map(|j| -0.5 * (square(i, j) - means[i] - means[j] + mean) * v[j]).sum();
        (0..states).map(row).collect()
    };
    // any vectors that are not along the axes
    let start = |seed: f64| (0..states).map(|i| libm::sin(seed * (i + 1) as f64)).collect::<Vec<f64>>();
    let mut axes: Vec<Vec<f64>> = Vec::new();
    for seed in [1.0, 2.3] {
        let mut v = start(seed);
        let mut size = 0.0;
        for _ in 0..ROUNDS {
            let mut image = product(&v);
            for a in &axes {
                let along = a.iter().zip(&image).map(|(x, y)| x * y).sum::<f64>();
                let own = a.iter().map(|x| x * x).sum::<f64>().max(f64::MIN_POSITIVE);
                image.iter_mut().zip(a).for_each(|(y, x)| *y -= along / own * x);
            }
            size = image.iter().map(|x| x * x).sum::<f64>().sqrt();
            if size < 1e-9 {
                break;
            }
            v = image.into_iter().map(|x| x / size).collect();
        }
        let scale = if size < 1e-9 { 0.0 } else { size.sqrt() };
        axes.push(v.into_iter().map(|x| scale * x).collect());
    }
    let apart = |i: usize| 0.05 * libm::sin(2.4 * i as f64);
    (0..states).map(|i| [axes[0][i] + apart(i), axes[1][i] + apart(i + 7)]).collect()
}

/// Where a state would stand best with all others where they are.
fn settled(places: &[[f64; 2]], far: &[f64], i: usize) -> [f64; 2] {
    let states = places.len();
    let (mut sum, mut weights) = ([0.0; 2], 0.0);
    for j in (0..states).filter(|j| *j != i) {
        let d = far[i * states + j];
        let from = [0, 1].map(|c| places[i][c] - places[j][c]);
        let size = (from[0] * from[0] + from[1] * from[1]).sqrt().max(1e-9);
        let weight = 1.0 / (d * d);
        weights += weight;
        [0, 1].into_iter().for_each(|c| sum[c] += weight * (places[j][c] + d * from[c] / size));
    }
    if weights > 0.0 { sum.map(|x| x / weights) } else { places[i] }
}

/// About the middle, the longest extent along x.
fn turned(mut places: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let n = places.len().max(1) as f64;
    let middle = [0, 1].map(|c| places.iter().map(|p| p[c]).sum::<f64>() / n);
    places.iter_mut().for_each(|p| *p = [p[0] - middle[0], p[1] - middle[1]]);
    let sum = |of: fn(&[f64; 2]) -> f64| places.iter().map(of).sum::<f64>();
    let (xx, xy, yy) = (sum(|p| p[0] * p[0]), sum(|p| p[0] * p[1]), sum(|p| p[1] * p[1]));
    let (sine, cosine) = libm::sincos(0.5 * libm::atan2(2.0 * xy, xx - yy));
    places.into_iter().map(|[x, y]| [cosine * x + sine * y, cosine * y - sine * x]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
        libm::hypot(a[0] - b[0], a[1] - b[1])
    }

    #[test]
    fn a_row_lies_along_x_and_a_ring_is_round() {
        let row = layout(6, &[[0, 1], [1, 2], [2, 3], [3, 4], [4, 5]]);
        for k in 0..6 {
            assert!((apart(row[k], row[0]) - k as f64).abs() < 1e-2 && row[k][1].abs() < 0.05, "{row:?}");
        }
        let ring = layout(12, &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11].map(|k| [k, (k + 1) % 12]));
        let radius = libm::hypot(ring[0][0], ring[0][1]);
        for k in 0..12 {
            assert!((libm::hypot(ring[k][0], ring[k][1]) / radius - 1.0).abs() < 1e-3, "{ring:?}");
            assert!((apart(ring[k], ring[(k + 1) % 12]) / apart(ring[0], ring[1]) - 1.0).abs() < 1e-2, "{ring:?}");
        }
    }

    #[test]
    fn what_nothing_joins_stands_apart_and_no_two_stand_at_one_place() {
        assert_eq!((layout(0, &[]).len(), layout(1, &[])[0].map(f64::is_finite)), (0, [true; 2]));
        // a star, a pair, and one alone
        let places = layout(9, &[[0, 1], [0, 2], [0, 3], [0, 4], [0, 5], [6, 7]]);
        for i in 0..9 {
            for j in 0..i {
                assert!(apart(places[i], places[j]) > 0.5, "{i} {j} {places:?}");
            }
        }
    }
}
