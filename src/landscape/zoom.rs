//! From a band to one that shows its top better.

use super::Peak;
use crate::band::Band;
use crate::path::Path;

/// The path with more of its images in the first or last interval, if its top is there: or, if none shows, at its higher end
/// (between two minima there is one).
pub fn zoomed(band: &Band, top: Option<&Peak>, images: usize) -> Option<Path> {
    let s = band.path().reaction_coordinate();
    let last = band.images() - 1;
    let e = band.energies_mev();
    let end = match top {
        Some(top) if top.s > s[1] && top.s < s[last - 1] => return None,
        Some(top) if top.s <= s[1] => 0,
        Some(_) => last,
        None if e[0] > e[last] => 0,
        None => last,
    };
    Some(band.path().at_places(&s, &condensed(&s, end, images)))
}

/// Places of `images` images, four times as dense within two intervals of image k as elsewhere.
fn condensed(s: &[f64], k: usize, images: usize) -> Vec<f64> {
    let weight = |i: usize| if i + 1 >= k.saturating_sub(1) && i < k + 2 { 4.0 } else { 1.0 };
    let mut warped = vec![0.0];
    for i in 0..s.len() - 1 {
        warped.push(warped[i] + weight(i) * (s[i + 1] - s[i]));
    }
    let total = warped[s.len() - 1];
    let place = |j: usize| {
        let x = total * j as f64 / (images - 1) as f64;
        let i = warped.partition_point(|w| *w <= x).clamp(1, s.len() - 1) - 1;
        s[i] + (x - warped[i]) / weight(i)
    };
    (0..images).map(place).collect()
}
