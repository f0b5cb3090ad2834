//! Lengths that an energy chooses: where it is least, or has its first minimum.

/// Golden section's share of an interval.
const GOLDEN: f64 = 0.618_033_988_749_894_9;
/// Steps of golden section: the interval shrinks to a part of 3e-5.
const STEPS: usize = 22;
/// From one length of a row to the next.
const NEXT: f64 = 1.2;

/// The length between two at which the energy is least, and that energy; the energy is taken to have one minimum there.
pub(super) fn least(low: f64, high: f64, energy: impl Fn(f64) -> f64) -> (f64, f64) {
    let (mut low, mut high) = (libm::log(low), libm::log(high));
    let at = |x: f64| energy(libm::exp(x));
    let inner = |low: f64, high: f64| [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
    let [mut p, mut q] = inner(low, high);
    let (mut of_p, mut of_q) = (at(p), at(q));
    for _ in 0..STEPS {
        if of_p <= of_q {
            (high, q, of_q) = (q, p, of_p);
            p = inner(low, high)[0];
            of_p = at(p);
        } else {
            (low, p, of_p) = (p, q, of_q);
            q = inner(low, high)[1];
            of_q = at(q);
        }
    }
    if of_p <= of_q { (libm::exp(p), of_p) } else { (libm::exp(q), of_q) }
}

/// The first length between two, from the smaller one, at which the energy has a minimum; nothing where it has none between them.
pub(super) fn first_minimum(low: f64, high: f64, energy: impl Fn(f64) -> f64) -> Option<f64> {
    let mut last = [(low, energy(low)), (NEXT * low, energy(NEXT * low))];
    while last[1].0 < high {
        let next = NEXT * last[1].0;
        let here = (next, energy(next));
        if last[1].1 < last[0].1 && last[1].1 <= here.1 {
            return Some(least(last[0].0, next, energy).0);
        }
        last = [last[1], here];
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_and_the_first_minimum_are_found() {
        let (x, e) = least(0.1, 50.0, |x| (x - 3.0).powi(2) + 1.0);
        assert!((x - 3.0).abs() < 1e-3 && (e - 1.0).abs() < 1e-6, "{x} {e}");
        // a barrier at 1, minima at 4 and 25
        let wells = |x: f64| f64::min((x - 4.0).powi(2), (x - 25.0).powi(2));
        let found = first_minimum(1.0, 30.0, |x| if x < 2.0 { 100.0 - x } else { wells(x) }).unwrap();
        assert!((found - 4.0).abs() < 1e-3, "{found}");
        assert_eq!(first_minimum(1.0, 30.0, |x| -x), None);
        assert_eq!(first_minimum(1.0, 30.0, |x| x), None);
    }
}
