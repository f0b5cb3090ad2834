//! Where states are on a path.

use crate::path::Path;

/// A place on a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Reaction coordinate (rad).
    pub s: f64,
    /// The nearest image.
    pub image: usize,
}

/// The place nearest to a state (3N).
pub fn nearest(path: &Path, m: &[f64]) -> Place {
    in_order(path, &[m])[0]
}

/// The places of states that the path passes one after the other: none is before the one that comes first, and the sum of the
/// distances between the states and their images is the least. States far from a coarse path keep their order this way.
pub fn in_order(path: &Path, states: &[&[f64]]) -> Vec<Place> {
    let s = path.reaction_coordinate();
    let far: Vec<Vec<f64>> = states.iter().map(|m| path.distances_from(m)).collect();
    let images = assigned(&far);
    let mut least = 0.0;
    let place = |(image, far): (usize, &Vec<f64>)| {
        least = between(&s, far, image).max(least);
        Place { s: least, image }
    };
    images.into_iter().zip(&far).map(place).collect()
}

/// The column of each row, none before that of the row above, with the least sum of all entries; the first of equal ones.
fn assigned(cost: &[Vec<f64>]) -> Vec<usize> {
    // last[j][k]: the column ≤ k where the rows up to j end best; the sum of those rows if j ends at column k
    let mut sum = vec![0.0; cost.first().map_or(0, Vec::len)];
    let mut last: Vec<Vec<usize>> = Vec::with_capacity(cost.len());
    for row in cost {
        let (mut least, mut columns) = (0, Vec::with_capacity(row.len()));
        let ended = sum.clone();
        for k in 0..row.len() {
            sum[k] = row[k] + last.last().map_or(0.0, |before| ended[before[k]]);
            least = if sum[k] < sum[least] { k } else { least };
            columns.push(least);
        }
        last.push(columns);
    }
    let mut most = sum.len().saturating_sub(1);
    let mut columns: Vec<usize> = last
        .iter()
        .rev()
        .map(|best| {
            most = best[most];
            most
        })
        .collect();
    columns.reverse();
    columns
}

/// The reaction coordinate between image `k` and the nearer of its neighbours, by the distances from them.
fn between(s: &[f64], far: &[f64], k: usize) -> f64 {
    let (a, b) = if k + 1 < far.len() && (k == 0 || far[k + 1] < far[k - 1]) {
        (k, k + 1)
    } else {
        (k.saturating_sub(1), k.max(1).min(far.len() - 1))
    };
    let share = far[a] / (far[a] + far[b]).max(f64::MIN_POSITIVE);
    s[a] + share * (s[b] - s[a])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spins::Spins;

    #[test]
    fn rows_take_their_least_columns_where_these_are_in_order_and_the_least_sum_where_they_are_not() {
        let row = |least: usize| (0..6).map(|k| (k as f64 - least as f64).abs()).collect::<Vec<_>>();
        assert_eq!(assigned(&[row(1), row(3), row(5)]), [1, 3, 5]);
        // 4 before 2 costs two steps, however they are shared
        assert_eq!(assigned(&[row(1), row(4), row(2), row(5)]), [1, 2, 2, 5]);
        let every = |n: usize| (0..n.pow(3)).map(move |x| [x / (n * n), x / n % n, x % n]);
        let mut random = 7u64;
        for _ in 0..50 {
            let mut next = || {
                random = random.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                (random >> 40) as f64
            };
            let cost: Vec<Vec<f64>> = (0..3).map(|_| (0..5).map(|_| next()).collect()).collect();
            let sum = |c: &[usize]| c.iter().zip(&cost).map(|(k, row)| row[*k]).sum::<f64>();
            let least = every(5).filter(|c| c.is_sorted()).map(|c| sum(&c)).fold(f64::INFINITY, f64::min);
            let found = assigned(&cost);
            assert!(found.is_sorted() && sum(&found) == least, "{found:?}");
        }
    }

    #[test]
    fn states_of_the_path_are_at_their_images_and_states_beside_it_keep_their_order() {
        let at = |angle: f64| Spins::from_vectors(&[[angle.cos(), angle.sin(), 0.0]]).unwrap();
        let path = Path::new(&[0.0, 0.5, 1.0, 1.5].map(at));
        let [a, b] = [at(0.5), at(1.25)];
        let places = in_order(&path, &[a.as_slice(), b.as_slice()]);
        assert!((places[0].s - 0.5).abs() < 1e-12 && (places[1].s - 1.25).abs() < 1e-12, "{places:?}");
        let places = in_order(&path, &[b.as_slice(), a.as_slice()]);
        assert!(places[0].s <= places[1].s && places[0].image <= places[1].image, "{places:?}");
        assert_eq!(nearest(&path, a.as_slice()).image, 1);
    }
}
