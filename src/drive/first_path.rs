//! A first path on its way to become the one, or to be rejected.

use super::Stop;
use super::outcome::{HistoryRow, RejectedPath};
use crate::band::Band;
use crate::geometry::Direction;
use crate::landscape::Saddle;
use crate::path::guess::{Drift, GuessSpec, Inside};
use crate::stationary::LOWER;
use crate::units::Angle;
use crate::words::counted;

/// A first path on its way.
pub struct FirstPath<'a> {
    /// What it started from.
    pub name: String,
    /// Where it is.
    pub band: Band<'a>,
    /// How its last relaxation ended.
    pub stop: Stop,
    /// Its iterations.
    pub history: Vec<HistoryRow>,
    /// Its refined top.
    pub found: Option<Saddle>,
    /// The highest that it passes (meV above the first image), if it was followed from end to end.
    pub followed_mev: Option<f64>,
}

impl<'a> FirstPath<'a> {
    /// A band that started from `name`, with nothing known of it yet.
    pub fn new(name: String, band: Band<'a>, stop: Stop) -> FirstPath<'a> {
        FirstPath { name, band, stop, history: Vec::new(), found: None, followed_mev: None }
    }

    /// The kind of guess that it started from, the first word of its name.
    pub fn kind(&self) -> &str {
        self.name.split(' ').next().unwrap_or_default()
    }

    /// Highest image above the first (meV).
    pub fn top_mev(&self) -> f64 {
        self.band.energies_mev()[self.band.highest()] - self.band.energies_mev()[0]
    }

    /// The highest of the interpolated energy above the first image (meV): a narrow top may lie between images.
    pub fn peak_mev(&self) -> f64 {
        self.band.profile().highest_mev()
    }

    /// Its refined top, if that is stationary.
    fn stationary(&self, c: f64) -> Option<&Saddle> {
        self.found.as_ref().filter(|f| f.is_stationary(c))
    }

    /// The refined saddle above the first image (meV), or the interpolated top.
    pub fn barrier_mev(&self, c: f64) -> f64 {
        let refined = self.stationary(c).map(|f| f.refined.state.energy_mev - self.band.energies_mev()[0]);
        refined.unwrap_or(self.peak_mev())
    }

    /// 0: a saddle of index one; 1: nothing refined; 2: a saddle of higher index.
    pub fn rank(&self, c: f64) -> u8 {
        match self.stationary(c) {
            Some(f) if f.refined.index() <= 1 => 0,
            None => 1,
            Some(_) => 2,
        }
    }
}

/// Why a path was not the one, where that one passes no higher than this above its first image (meV).
pub fn rejection(c: &FirstPath, best: &FirstPath, best_mev: f64, scale: f64) -> RejectedPath {
    let found = c.stationary(scale);
    let barrier_mev = Some(c.followed_mev.unwrap_or(c.barrier_mev(scale)));
    let negative_modes = found.map(|f| f.refined.index());
    let lower = c.followed_mev.map_or(0.0, |mev| best_mev - mev);
    let evaluations = || counted(c.band.evaluations(), "evaluation", "evaluations");
    let reason = match found {
        Some(f) if f.refined.index() > 1 => "its top is a saddle of higher index".to_string(),
        Some(_) if lower > LOWER * best_mev => {
            format!("followed from end to end, it passes {lower:.1e} meV lower, but could not be proven")
        }
        Some(_) if c.followed_mev.is_some() => {
            format!("followed from end to end, it passes no lower than \"{}\"", best.name)
        }
        Some(_) => format!("its saddle is not below that of \"{}\"", best.name),
        None if c.peak_mev() < best_mev => {
            format!("after {} its images lie lower, but no saddle is known at its top", evaluations())
        }
        None => format!("its top lies above the path \"{}\" after {}", best.name, evaluations()),
    };
    RejectedPath { guess: c.name.clone(), barrier_mev, negative_modes, reason }
}

/// The config fragment of a guess, for people; with its axis, if `axis` is asked for.
pub fn describe(guess: &GuessSpec, axis: bool) -> String {
    let about = |name: String, direction: &Option<Direction>| match direction {
        Some(direction) if axis => format!("{name} about {direction}"),
        _ => name,
    };
    let at = |name: String, helicity: &Option<Angle>| match helicity {
        Some(angle) if axis => format!("{name} at {:.0}°", angle.0.to_degrees()),
        _ => name,
    };
    let rigid = |name: String, rigid: bool| if rigid { format!("{name}, all as one") } else { name };
    match guess {
        GuessSpec::Sweep(s) => rigid(at(about(format!("sweep from {}", s.from), &s.axis), &s.helicity), s.rigid),
        GuessSpec::Shrink(s) => rigid(at(about(guess.name().to_string(), &s.axis), &s.helicity), s.rigid),
        GuessSpec::Droplet(d) => {
            let (of, which) = match d.of {
                Inside::Final => ("", "from"),
                Inside::Initial => (" of the initial state", "to"),
            };
            let place = d.center.as_ref().map_or(String::new(), |center| format!(" {which} {center}"));
            rigid(at(about(format!("droplet{of}{place}"), &d.axis), &d.helicity), d.rigid)
        }
        GuessSpec::Drift(Drift { onto: Some(place), .. }) => format!("drift onto {place}"),
        GuessSpec::Drift(Drift { direction: Some(direction), .. }) => format!("drift towards {direction}"),
        GuessSpec::Geodesic(g) => about(guess.name().to_string(), &g.axis),
        other => other.name().to_string(),
    }
}
