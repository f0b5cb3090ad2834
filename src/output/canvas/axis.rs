//! An axis: its range, its ticks at round numbers, and their labels.

use super::number::{decimal, power_of_ten};

/// How values are spread along an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Scale {
    /// Evenly.
    #[default]
    Linear,
    /// By their logarithm; values that are not positive are left out.
    Log,
}

/// A labelled tick.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// The value.
    pub at: f64,
    /// What is written there.
    pub label: String,
}

/// A range of values with its ticks.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The value at the left or bottom.
    pub min: f64,
    /// The value at the right or top.
    pub max: f64,
    /// Even or logarithmic.
    pub scale: Scale,
    /// Labelled ticks.
    pub ticks: Vec<Tick>,
}

impl Axis {
    /// From `min` to `max` with at most about `most` ticks. An empty range is widened.
    pub fn new(min: f64, max: f64, scale: Scale, most: usize) -> Axis {
        match scale {
            Scale::Linear => Axis::linear(min, max, most),
            Scale::Log => Axis::log(min, max, most),
        }
    }

    /// Even, ticks at 1, 2, 5 × 10ⁿ.
    pub fn linear(min: f64, max: f64, most: usize) -> Axis {
        let (min, max) = widened(min, max);
        let step = round_step((max - min) / most.max(1) as f64);
        Axis { min, max, scale: Scale::Linear, ticks: linear_ticks(min, max, step) }
    }

    /// Cells 0 … n−1, each from i − ½ to i + ½, ticks at whole numbers.
    pub fn cells(n: usize, most: usize) -> Axis {
        let (min, max) = (-0.5, n.max(1) as f64 - 0.5);
        let step = round_step((max - min) / most.max(1) as f64).max(1.0);
        Axis { min, max, scale: Scale::Linear, ticks: linear_ticks(min, max, step) }
    }

    /// Logarithmic, ticks at powers of ten.
    pub fn log(min: f64, max: f64, most: usize) -> Axis {
        let usable = |v: f64| if v.is_finite() && v > 0.0 { v } else { 1.0 };
        let (mut min, mut max) = (usable(min.min(max)), usable(max.max(min)));
        if max / min < 10.0 {
            let middle = (libm::log10(min) + libm::log10(max)) / 2.0;
            (min, max) = (power_of_10((middle - 0.5).floor()), power_of_10((middle + 0.5).ceil()));
        }
        let (first, last) = ((libm::log10(min) - 1e-9).ceil() as i32, (libm::log10(max) + 1e-9).floor() as i32);
        let every = (((last - first) as f64 / most.max(1) as f64).ceil() as usize).max(1);
        let decades = (first..=last)
            .filter(|n| n.rem_euclid(every as i32) == 0)
            .map(|n| Tick { at: power_of_10(f64::from(n)), label: power_of_ten(n) });
        let mut ticks: Vec<Tick> = decades.collect();
        if ticks.len() < 3 {
            let finer = finer_ticks(min, max);
            ticks = if (ticks.len() + 1..=2 * most.max(2)).contains(&finer.len()) { finer } else { ticks };
        }
        Axis { min, max, scale: Scale::Log, ticks }
    }

    /// Where `v` lies, 0 at `min` and 1 at `max`; `None` where it has no place.
    pub fn fraction(&self, v: f64) -> Option<f64> {
        let f = match self.scale {
            Scale::Linear => (v - self.min) / (self.max - self.min),
            Scale::Log if v > 0.0 => libm::log(v / self.min) / libm::log(self.max / self.min),
            Scale::Log => return None,
        };
        f.is_finite().then_some(f)
    }
}

/// 10ⁿ, the same on every machine.
fn power_of_10(n: f64) -> f64 {
    libm::pow(10.0, n)
}

/// 1, 2 and 5 of every decade.
fn finer_ticks(min: f64, max: f64) -> Vec<Tick> {
    let decades = libm::log10(min).floor() as i32..=libm::log10(max).floor() as i32;
    let tick = |n: i32, digit: f64| {
        let at = digit * power_of_10(f64::from(n));
        let label = match n {
            -3..=4 => decimal(at, (-n).max(0) as usize),
            _ if digit == 1.0 => power_of_ten(n),
            _ => format!("{digit}×{}", power_of_ten(n)),
        };
        Tick { at, label }
    };
    let all = decades.flat_map(|n| [1.0, 2.0, 5.0].map(|digit| tick(n, digit)));
    all.filter(|t| t.at >= min * (1.0 - 1e-9) && t.at <= max * (1.0 + 1e-9)).collect()
}

/// The range, or one around it if it is empty.
fn widened(min: f64, max: f64) -> (f64, f64) {
    if !(min.is_finite() && max.is_finite()) {
        return (-1.0, 1.0);
    }
    let (min, max) = (min.min(max), max.max(min));
    let size = min.abs().max(max.abs());
    if max - min > 1e-12 * size {
        (min, max)
    } else if size == 0.0 {
        (-1.0, 1.0)
    } else {
        (min - 0.5 * size, max + 0.5 * size)
    }
}

/// The next of 1, 2, 5 × 10ⁿ at or above `step`.
fn round_step(step: f64) -> f64 {
    let decade = power_of_10(libm::log10(step).floor());
    let factor = [1.0, 2.0, 5.0].into_iter().find(|f| f * decade >= step * (1.0 - 1e-9));
    factor.unwrap_or(10.0) * decade
}

/// Multiples of `step` in the range, all with the same decimals.
fn linear_ticks(min: f64, max: f64, step: f64) -> Vec<Tick> {
    let (first, last) = ((min / step - 1e-9).ceil(), (max / step + 1e-9).floor());
    if !(first.is_finite() && last.is_finite() && last - first < 100.0) {
        return Vec::new();
    }
    let values: Vec<f64> = (0..=(last - first) as i64).map(|k| (first + k as f64) * step).collect();
    let largest = values.iter().fold(0.0, |a: f64, v| a.max(v.abs()));
    values.into_iter().map(|at| Tick { at, label: tick_label(at, step, largest) }).collect()
}

/// Plain decimals where they are short, m×10ⁿ otherwise.
fn tick_label(at: f64, step: f64, largest: f64) -> String {
    let decimals = (-(libm::log10(step) + 1e-9).floor()).max(0.0) as usize;
    if decimals <= 4 && largest < 1e5 {
        return decimal(at, decimals);
    }
    let exponent = libm::log10(largest).floor() as i32;
    let scale = power_of_10(f64::from(exponent));
    let decimals = (-(libm::log10(step / scale) + 1e-9).floor()).max(0.0) as usize;
    if (at / step).abs() < 0.5 {
        "0".into()
    } else {
        format!("{}×{}", decimal(at / scale, decimals), power_of_ten(exponent))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: Axis) -> Vec<String> {
        axis.ticks.into_iter().map(|t| t.label).collect()
    }

    #[test]
    fn ticks_are_round_and_minus_is_a_minus() {
        assert_eq!(labels(Axis::linear(-0.25, 1.07, 6)), ["0.0", "0.5", "1.0"]);
        assert_eq!(labels(Axis::linear(-1.0, 1.0, 4)), ["−1.0", "−0.5", "0.0", "0.5", "1.0"]);
        assert_eq!(labels(Axis::linear(0.0, 3e-7, 3)), ["0", "1×10⁻⁷", "2×10⁻⁷", "3×10⁻⁷"]);
        assert_eq!(labels(Axis::log(0.15, 6.0, 5)), ["0.2", "0.5", "1", "2", "5"]);
        assert_eq!(labels(Axis::log(1e-12, 10.0, 7)), ["10⁻¹²", "10⁻¹⁰", "10⁻⁸", "10⁻⁶", "10⁻⁴", "10⁻²", "10⁰"]);
    }

    #[test]
    fn cells_have_whole_ticks() {
        assert_eq!(labels(Axis::cells(1, 5)), ["0"]);
        assert_eq!(labels(Axis::cells(3, 8)), ["0", "1", "2"]);
        assert_eq!(labels(Axis::cells(100_000, 5)), ["0", "20000", "40000", "60000", "80000"]);
    }

    #[test]
    fn empty_and_broken_ranges_still_make_an_axis() {
        for (min, max) in
            [(0.0, 0.0), (3.0, 3.0), (-5.0, -5.0), (f64::NAN, 1.0), (f64::INFINITY, 0.0), (1.0, 1.0 + 1e-15)]
        {
            for scale in [Scale::Linear, Scale::Log] {
                let axis = Axis::new(min, max, scale, 5);
                assert!(axis.max > axis.min && !axis.ticks.is_empty(), "{min} {max} {axis:?}");
            }
        }
    }
}
