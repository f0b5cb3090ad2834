//! How a run gets on: a bar on a terminal, plain lines now and then elsewhere.

use super::note;
use crate::drive::{Goal, HistoryRow, Observer, Partial};
use crate::landscape::Standing;
use crate::path::Path;
use indicatif::{ProgressBar, ProgressStyle};
use std::collections::VecDeque;
use std::io::{self, IsTerminal};
use std::time::{Duration, Instant};

/// Iterations from which the time that is left is foretold.
const RECENT: usize = 12;
/// Fewer tell nothing.
const FEWEST: usize = 4;
/// How long a bar is, in parts.
const PARTS: u64 = 1000;

/// Tells of a run on stderr.
pub struct Progress<'a> {
    name: &'a str,
    quiet: bool,
    bar: Option<ProgressBar>,
    last: Instant,
    stage: String,
    decline: Decline,
    band: Option<Partial>,
}

impl<'a> Progress<'a> {
    /// Of the run of this name; silent if `quiet`.
    pub fn new(name: &'a str, quiet: bool) -> Progress<'a> {
        let bar = (!quiet && io::stderr().is_terminal()).then(|| bar(name));
        Progress {
            name,
            quiet,
            bar,
            last: Instant::now(),
            stage: String::new(),
            decline: Decline::default(),
            band: None,
        }
    }

    /// The stage that the run is in, in words.
    pub fn stage_now(&self) -> &str {
        &self.stage
    }

    /// The band as it stands, if there is one.
    pub fn band(&mut self) -> Option<Partial> {
        self.band.take()
    }

    /// What says a line without disturbing the bar.
    pub fn speaker(&self) -> Box<dyn FnMut(&str) + Send> {
        let (name, quiet, bar) = (self.name.to_string(), self.quiet, self.bar.clone());
        Box::new(move |words| {
            let line = format!("{name}: {words}");
            match &bar {
                _ if quiet => {}
                Some(bar) => bar.suspend(|| note(&line)),
                None => note(&line),
            }
        })
    }

    fn say(&mut self, words: &str) {
        if !self.quiet && self.bar.is_none() {
            note(&format!("{}: {words}", self.name));
        }
        self.last = Instant::now();
    }
}

/// How much a search has done of what it may do. That is more as long as it brings news, so once it brings none it may have done several
/// times what it may.
fn part_of_work(spent: f64) -> String {
    if spent < 1.0 {
        format!("{:.1} % of the work it may do", 1e2 * spent)
    } else {
        "all the work it may do is done".into()
    }
}

/// An angle in few digits: `0.57`, `1.8e-4`.
fn angle(radians: f64) -> String {
    if (0.01..1e3).contains(&radians) { format!("{radians:.2}") } else { format!("{radians:.1e}") }
}

impl Drop for Progress<'_> {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

impl Observer for Progress<'_> {
    fn iteration(&mut self, row: &HistoryRow) {
        self.decline.add(Instant::now(), row.largest_predicted_rotation_rad);
        let left = || self.decline.left().map_or(String::new(), |left| format!(", about {} left", rough(left)));
        let (n, images) = (row.iteration, row.images);
        let (highest, rotation) = (row.highest_image_mev, row.largest_predicted_rotation_rad);
        if let Some(bar) = &self.bar {
            // the end of a long line is not seen
            let numbers = format!("{n}: {highest:.4} meV, {rotation:.0e} rad{}", left());
            bar.set_message(format!("{numbers}; {images} images, {}", self.stage));
            bar.set_position((self.decline.done() * PARTS as f64) as u64);
        } else if self.last.elapsed() >= Duration::from_secs(1) {
            let left = left();
            self.say(&format!(
                "iteration {n}, {images} images: highest {highest:.6} meV, still turning by {} rad{left}",
                angle(rotation)
            ));
        }
    }

    fn searching(&mut self, standing: &Standing) {
        let Standing { done, wanted, spent, known: [minima, passes] } = *standing;
        let far = (done.quiet as f64 / wanted.max(1) as f64).max(spent).min(1.0);
        if let Some(bar) = &self.bar {
            bar.set_message(format!("{} climbs, {minima} minima, {passes} passes; {}", done.searches, self.stage));
            bar.set_position((far * PARTS as f64) as u64);
        } else if self.last.elapsed() >= Duration::from_secs(5) {
            self.say(&format!(
                "{} climbs, the last {} without news ({wanted} end the search); {minima} minima and {passes} passes, images counted; {}",
                done.searches,
                done.quiet,
                part_of_work(spent)
            ));
        }
    }

    fn relaxed(&mut self, path: &Path, history: &[HistoryRow]) {
        self.band = Some(Partial { path: path.clone(), history: history.to_vec() });
    }

    fn stage(&mut self, what: &str) {
        self.stage = what.into();
        self.decline = Decline::default();
        match &self.bar {
            Some(bar) => {
                bar.set_position(0);
                bar.set_message(self.stage.clone());
            }
            None => self.say(what),
        }
    }

    fn relaxing(&mut self, goal: Goal, tolerance_rad: f64) {
        self.decline = Decline { goal: (goal == Goal::Tight).then_some(tolerance_rad), ..Decline::default() };
    }
}

fn bar(name: &str) -> ProgressBar {
    let bar = ProgressBar::new(PARTS);
    if let Ok(style) = ProgressStyle::with_template("{prefix} {spinner} [{bar:16}] {wide_msg}") {
        bar.set_style(style.progress_chars("=> "));
    }
    bar.set_prefix(name.to_string());
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

/// The residual of a relaxation over time. Where its logarithm falls, the time that is left can be foretold.
#[derive(Default)]
struct Decline {
    /// Where it is to end (rad); none where another measure decides.
    goal: Option<f64>,
    first: Option<f64>,
    recent: VecDeque<(Instant, f64)>,
}

impl Decline {
    fn add(&mut self, now: Instant, residual: f64) {
        if residual > 0.0 && residual.is_finite() {
            let ln = libm::log(residual);
            self.first.get_or_insert(ln);
            self.recent.push_back((now, ln));
            if self.recent.len() > RECENT {
                self.recent.pop_front();
            }
        }
    }

    /// The part of the way that is behind, 0 to 1; 0 where it is not known.
    fn done(&self) -> f64 {
        let (Some(goal), Some(first), Some((_, now))) = (self.goal, self.first, self.recent.back()) else { return 0.0 };
        let way = first - libm::log(goal);
        if way > 0.0 { ((first - now) / way).clamp(0.0, 1.0) } else { 0.0 }
    }

    /// The time until the goal, by the straight line through the recent logarithms; none where they do not fall.
    fn left(&self) -> Option<Duration> {
        let (goal, (start, _)) = (libm::log(self.goal?), self.recent.front()?);
        if self.recent.len() < FEWEST {
            return None;
        }
        let points: Vec<(f64, f64)> =
            self.recent.iter().map(|(at, ln)| (at.duration_since(*start).as_secs_f64(), *ln)).collect();
        let count = points.len() as f64;
        let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
        let (t, y) = (mean(|p| p.0), mean(|p| p.1));
        let spread: f64 = points.iter().map(|p| (p.0 - t) * (p.0 - t)).sum();
        let slope = points.iter().map(|p| (p.0 - t) * (p.1 - y)).sum::<f64>() / spread;
        let (now, ln) = points.last()?;
        // seen from the last point, a slow decline foretells a time that is worth nothing
        let left = (goal - ln) / slope;
        (slope < 0.0 && left >= 0.0 && left < 100.0 * now.max(1.0)).then(|| Duration::from_secs_f64(left))
    }
}

/// A time in words, no more precise than it is.
fn rough(time: Duration) -> String {
    match time.as_secs() {
        s @ 0..=99 => format!("{s} s"),
        s @ 100..=5999 => format!("{} min", (s + 30) / 60),
        s => format!("{} h", (s + 1800) / 3600),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A decline with these residuals, one a second.
    fn decline(goal: Option<f64>, residuals: &[f64]) -> Decline {
        let start = Instant::now();
        let mut decline = Decline { goal, ..Decline::default() };
        for (k, residual) in residuals.iter().enumerate() {
            decline.add(start + Duration::from_secs(k as u64), *residual);
        }
        decline
    }

    #[test]
    fn the_time_left_is_that_of_the_straight_line_to_the_goal() {
        let half = decline(Some(1e-6), &[1e-1, 1e-2, 1e-3, 1e-4]);
        assert!((half.left().unwrap().as_secs_f64() - 2.0).abs() < 1e-6, "{:?}", half.left());
        assert!((half.done() - 0.6).abs() < 1e-12);
    }

    #[test]
    fn no_time_is_foretold_where_it_cannot_be_known() {
        assert_eq!(decline(None, &[1e-1, 1e-2, 1e-3, 1e-4]).left(), None);
        assert_eq!(decline(Some(1e-6), &[1e-1, 1e-2, 1e-3]).left(), None);
        assert_eq!(decline(Some(1e-6), &[1e-4, 1e-3, 1e-2, 1e-1]).left(), None);
        assert_eq!(decline(Some(1e-6), &[1e-1; 8]).left(), None);
        assert_eq!(decline(Some(1e-6), &[f64::NAN, 0.0, 1e-1, 1e-2, 1e-3]).left(), None);
        let slow: Vec<f64> = (0..8).map(|k| 0.1 - 1e-6 * f64::from(k)).collect();
        assert_eq!(decline(Some(1e-6), &slow).left(), None);
    }

    #[test]
    fn a_search_has_never_done_more_than_it_may() {
        let said = [0.0123, 0.9996, 1.0, 16.417].map(part_of_work);
        let done = "all the work it may do is done";
        assert_eq!(said, ["1.2 % of the work it may do", "100.0 % of the work it may do", done, done]);
    }

    #[test]
    fn times_are_rough() {
        let said = [7, 99, 100, 3600, 7200].map(|s| rough(Duration::from_secs(s)));
        assert_eq!(said, ["7 s", "99 s", "2 min", "60 min", "2 h"]);
    }
}
