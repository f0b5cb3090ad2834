//! What the energies of a band show: how high it is, what differs in it, and where it has its tops.

use crate::band::Band;
use crate::stationary::LOWER;

/// Highest minus lowest energy of a band (meV).
pub fn height(band: &Band) -> f64 {
    let e = band.energies_mev();
    let (low, high) = e.iter().fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(*x), h.max(*x)));
    high - low
}

/// Heights of a band that differ by less are one (meV): by rounding, or by what changes no digit of its barrier that is told.
pub fn slack(band: &Band) -> f64 {
    (LOWER * height(band)).max(band.hamiltonian().rounding_mev())
}

/// Interior images higher than both neighbours that stand out from the valleys beside them by more than `prominence`.
pub fn prominent_maxima(e: &[f64], prominence: f64) -> Vec<usize> {
    let last = e.len() - 1;
    let is_maximum = |k: usize| e[k] > e[k - 1] && e[k] >= e[k + 1];
    let stands_out = |k: usize| {
        let mut valleys = [e[k]; 2];
        for j in (0..k).rev().take_while(|&j| e[j] <= e[k]) {
            valleys[0] = valleys[0].min(e[j]);
        }
        for j in (k + 1..=last).take_while(|&j| e[j] <= e[k]) {
            valleys[1] = valleys[1].min(e[j]);
        }
        e[k] - valleys[0].max(valleys[1]) > prominence
    };
    (1..last).filter(|&k| is_maximum(k) && stands_out(k)).collect()
}
