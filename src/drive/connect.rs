//! The whole sequence: every saddle of a path with the minima between them, from the initial to the final state.
//!
//! A saddle's two descents either end in the ends of its stretch of path, or in minima on the way; there the stretch is split,
//! and the parts are treated alike. On a row of shallow minima a stretch's top may lead to a saddle beside it that is known
//! already; then its other maxima are tried, then the way up from either end along a soft mode, and then the geodesic between
//! its ends. A saddle with one minimum on both sides (where of two walls one turns all the way round) is not on the way. Minima
//! joined by a valley that is flat to rounding have no saddle between them and count as one.

use super::climb::{ZOOMS, zoomed};
use super::relaxation::{Goal, Relaxation};
use crate::band::Band;
use crate::energy::Evaluator;
use crate::energy::recorded;
use crate::error::Result;
use crate::landscape::Doubt;
use crate::landscape::Saddle;
use crate::landscape::{Minimum, Pass};
use crate::landscape::{Peak, direction, highest, peaks};
use crate::landscape::{turned, turns};
use crate::linalg::{Mode, slab, soft_modes};
use crate::path::guess::{Edge, FirstGuess, GuessContext, Sweep};
use crate::path::{Path, distance};
use crate::sphere::rotation_of;
use crate::spins::Spins;
use crate::stationary::{State, follow_modes};
use std::borrow::Cow;

/// Most stretches of one path.
const MOST: usize = 600;
/// Most saddles off the path, both sides of which lead to one minimum or back to where the path came from.
const MOST_STRAYS: usize = 24;
/// Images of a stretch, at least.
const FEWEST: usize = 9;
/// Band evaluations a stretch may take.
const EVALUATIONS: usize = 30;
/// Energies that differ by less than this part of the largest stiffness along a whole stretch make it flat.
const FLAT: f64 = 1e-11;
/// Band evaluations until a stretch shows itself as flat.
const FLAT_EVALUATIONS: usize = 60;
/// Maxima of a stretch that are tried, at most.
const MOST_TOPS: usize = 5;
/// A saddle higher than a band's top by more than this part of the band's height is not the band's.
const ABOVE: f64 = 0.2;
/// Modes of a minimum that are followed uphill: at most so many, and below this part of c.
const SOFT_MODES: usize = 3;
const SOFT: f64 = 0.5;
/// How far from a minimum the way uphill starts (rad, any spin).
const START: f64 = 0.1;

/// Saddles in path order, each with its neighbours.
#[derive(Debug, Default)]
pub struct Sequence {
    /// Saddle, minimum, saddle, …
    pub links: Vec<Pass>,
    /// Why the sequence does not lead from end to end; nothing if it does.
    pub gap: Option<Doubt>,
}

/// A stretch of path between two minima, with the saddle on it if that is known already.
struct Stretch<'p> {
    a: Minimum,
    b: Minimum,
    path: Cow<'p, Path>,
    saddle: Option<Saddle>,
}

impl<'p> Stretch<'p> {
    /// The part up to a minimum on the way.
    fn before(&self, b: &Minimum, context: &GuessContext) -> Result<Stretch<'p>> {
        let path = Cow::Owned(between(&self.path, &self.a.spins, &b.spins, true, context)?);
        Ok(Stretch { a: self.a.clone(), b: b.clone(), path, saddle: None })
    }

    /// The part from a minimum on the way on.
    fn after(&self, a: &Minimum, context: &GuessContext) -> Result<Stretch<'p>> {
        let path = Cow::Owned(between(&self.path, &a.spins, &self.b.spins, false, context)?);
        Ok(Stretch { a: a.clone(), b: self.b.clone(), path, saddle: None })
    }

    /// The geodesic between its ends, the second turned about the symmetry axes to lie near the first.
    fn straightened(&self, h: Evaluator) -> Stretch<'p> {
        let (a, mut b) = (self.a.clone(), self.b.clone());
        b.spins = turned(&b.spins, &turns(h, &b.spins, &a.spins));
        let path = Path::new(&[a.spins.clone(), b.spins.clone()]).resampled(FEWEST);
        Stretch { a, b, path: Cow::Owned(path), saddle: None }
    }
}

/// Follows a relaxed path from `a` to `b`; `saddle` is its highest saddle.
pub fn follow(
    relaxation: &mut Relaxation,
    band: &Band,
    a: Minimum,
    b: Minimum,
    saddle: Saddle,
    context: &GuessContext,
) -> Result<Sequence> {
    let h = band.evaluator();
    let c = relaxation.scales.stiffness_mev;
    let mut sequence = Sequence::default();
    // the part of the path that comes first is on top
    let mut stretches = vec![Stretch { a, b, path: Cow::Borrowed(band.path()), saddle: Some(saddle) }];
    let mut open: Vec<(Minimum, Pass)> = Vec::new();
    let mut strays: Vec<Saddle> = Vec::new();
    let mut count = 0;
    while let Some(mut stretch) = stretches.pop() {
        count += 1;
        if count > MOST {
            sequence.gap = Some(Doubt::Stretches(MOST));
            break;
        }
        if stretch.saddle.is_none() && (stretch.a.is_identical(h, &stretch.b) || is_flat(relaxation, h, &stretch)?) {
            close(&mut sequence, &mut open, &stretch.b, h);
            continue;
        }
        let (found, again) = match stretch.saddle.take() {
            Some(found) => (Some(found), false),
            None => {
                let links = sequence.links.iter().chain(open.iter().map(|o| &o.1));
                let known: Vec<&Saddle> = links.map(|l| &l.saddle).chain(&strays).collect();
                search(relaxation, h, &mut stretch, &known, c)?
            }
        };
        let Some(found) = found.filter(|f| f.is_saddle(c)) else {
            sequence.gap = Some(Doubt::Gap);
            close(&mut sequence, &mut open, &stretch.b, h);
            continue;
        };
        let mut link = Pass::recorded(h, found, c)?;
        if link.before.is_same(h, &stretch.b) || link.after.is_same(h, &stretch.a) {
            link.reverse();
        }
        let left_done = link.before.is_same(h, &stretch.a);
        let right_done = link.after.is_same(h, &stretch.b);
        let both_done = left_done && right_done;
        // from one side of it to the other a spin or a wall turns all the way round: it is not on the way, its minimum may be
        let returns = !both_done && link.before.is_identical(h, &link.after);
        // a saddle met a second time is of use only where it joins the two ends
        let astray = (again && !both_done)
            || returns
            || (!left_done && link.before.is_same(h, &stretch.b))
            || (!right_done && link.after.is_same(h, &stretch.a));
        if astray && !again && strays.len() < MOST_STRAYS {
            if returns && !left_done && !right_done {
                stretches.push(stretch.after(&link.after, context)?);
                stretches.push(stretch.before(&link.before, context)?);
            } else {
                stretches.push(stretch);
            }
            strays.push(link.saddle);
            continue;
        }
        if astray {
            sequence.gap = Some(Doubt::Return);
        }
        if !right_done && !astray {
            stretches.push(stretch.after(&link.after, context)?);
        }
        if !left_done && !astray {
            stretches.push(stretch.before(&link.before, context)?);
            open.push((link.before.clone(), link));
            continue;
        }
        let end = if right_done { stretch.b } else { link.after.clone() };
        sequence.links.push(link);
        close(&mut sequence, &mut open, &end, h);
    }
    sequence.links.extend(open.into_iter().rev().map(|(_, link)| link));
    Ok(sequence)
}

/// Saddles that waited for the stretch before them, which is now followed to `reached`.
fn close(sequence: &mut Sequence, open: &mut Vec<(Minimum, Pass)>, reached: &Minimum, h: Evaluator) {
    let mut reached = reached.clone();
    while let Some((wanted, _)) = open.last() {
        if !wanted.is_same(h, &reached) {
            return;
        }
        if let Some((_, link)) = open.pop() {
            reached = link.after.clone();
            sequence.links.push(link);
        }
    }
}

/// Whether two minima are joined by a valley that is flat as far as double precision tells: a soliton on a ring, moved along it.
fn is_flat(relaxation: &mut Relaxation, h: Evaluator, stretch: &Stretch) -> Result<bool> {
    let flat = FLAT * h.stiffness_mev();
    if h.difference_mev(stretch.a.spins.as_slice(), stretch.b.spins.as_slice()).abs() > flat {
        return Ok(false);
    }
    let mut band = Band::new(h, stretch.path.as_ref().clone());
    relaxation.run(&mut band, Goal::Tight, FLAT_EVALUATIONS)?;
    let start = stretch.a.spins.as_slice();
    Ok(band.path().largest_rotation() < 1.0
        && (0..band.images()).all(|k| h.difference_mev(band.path().image(k), start).abs() < flat))
}

/// A saddle on a stretch, which is made straight if only then it shows one that is not known; and whether it is a known one.
fn search(
    relaxation: &mut Relaxation,
    h: Evaluator,
    stretch: &mut Stretch,
    known: &[&Saddle],
    c: f64,
) -> Result<(Option<Saddle>, bool)> {
    let is_known = |f: &Saddle| known.iter().any(|k| k.is_same(h, f));
    let found = new_saddle(relaxation, h, stretch, known, c)?;
    if found.as_ref().is_some_and(|f| !is_known(f)) {
        return Ok((found, false));
    }
    let direct = stretch.straightened(h);
    let other = new_saddle(relaxation, h, &direct, known, c)?;
    if other.as_ref().is_some_and(|f| !is_known(f)) {
        *stretch = direct;
        return Ok((other, false));
    }
    let again = found.is_some();
    Ok((found, again))
}

/// A saddle on a stretch after a loose relaxation: one that is none of the known ones, if there is any.
fn new_saddle(
    relaxation: &mut Relaxation,
    h: Evaluator,
    stretch: &Stretch,
    known: &[&Saddle],
    c: f64,
) -> Result<Option<Saddle>> {
    let mut band = Band::new(h, stretch.path.as_ref().clone());
    relaxation.run(&mut band, Goal::Loose, EVALUATIONS)?;
    for _ in 0..ZOOMS {
        let Some(path) = zoomed(&band, highest(&band).as_ref(), band.images() + 4) else { break };
        band = Band::new(h, path);
        relaxation.run(&mut band, Goal::Loose, EVALUATIONS)?;
    }
    let hop = relaxation.scales.half_site_rad();
    let is_new = |f: &Saddle| f.is_saddle(c) && !known.iter().any(|k| k.is_same(h, f));
    let tops = peaks(&band, f64::INFINITY);
    let e = band.energies_mev();
    let last = band.images() - 1;
    let highest = tops.first().map_or(e[0].max(e[last]), |top| top.energy_mev);
    // a saddle far above the band leads elsewhere
    let most = highest + ABOVE * (highest - e[0].min(e[last]));
    let mut high: Vec<Saddle> = Vec::new();
    let mut known_top = None;
    for (k, top) in tops.iter().take(MOST_TOPS).enumerate() {
        let found = Saddle::recorded(h, top.clone(), c, hop)?;
        if !is_new(&found) {
            known_top = known_top.or((k == 0).then_some(found));
        } else if found.refined.state.energy_mev <= most {
            return Ok(Some(found));
        } else {
            high.push(found);
        }
    }
    for (end, next) in [(0, 1), (last, last - 1)] {
        let input = [band.path().image(end), band.path().image(next)];
        let from_end = recorded(h, "uphill from an end", &input, || Ok(uphill(h, &band, end, next, c)))?;
        for found in from_end.into_iter().filter(is_new) {
            if found.refined.state.energy_mev <= most {
                return Ok(Some(found));
            }
            high.push(found);
        }
    }
    let lowest = high.into_iter().min_by(|p, q| p.refined.state.energy_mev.total_cmp(&q.refined.state.energy_mev));
    Ok(lowest.or(known_top))
}

/// Saddles above the minimum at one end of a band, along its soft modes towards the next image.
fn uphill(h: Evaluator, band: &Band, end: usize, next: usize, c: f64) -> Vec<Saddle> {
    let state = State::at(h, band.path().image(end).to_vec());
    let towards = state.basis.coordinates(&direction(&state.m, band.path().image(next), 1.0));
    let modes = soft_modes(&state.hessian, SOFT_MODES, &state.zeros, SOFT * c);
    let from = |mode: &Mode| {
        let along = slab::dot(&mode.vector, &towards);
        let mut tau = state.field(&mode.vector);
        if along < 0.0 {
            slab::scale(&mut tau, -1.0);
        }
        let mut v = tau.clone();
        slab::scale(&mut v, START / rotation_of(&tau));
        let refined = follow_modes(h, &state.moved(&v))?;
        let (energy_mev, s) = (refined.state.energy_mev, band.path().reaction_coordinate()[end]);
        if end > next {
            slab::scale(&mut tau, -1.0);
        }
        Some(Saddle { top: Peak { m: state.m.clone(), tau, energy_mev, s, image: end }, refined })
    };
    modes.iter().filter(|m| m.value < SOFT * c).filter_map(from).collect()
}

/// The part of a path between two states on it; a wall that moves if the part has too few images.
fn between(path: &Path, a: &Spins, b: &Spins, from_start: bool, context: &GuessContext) -> Result<Path> {
    let inner = path.images();
    let nearest = |m: &[f64]| {
        (0..inner).min_by(|&i, &j| distance(path.image(i), m).total_cmp(&distance(path.image(j), m))).unwrap_or(0)
    };
    let (first, last) = if from_start { (0, nearest(b.as_slice())) } else { (nearest(a.as_slice()), inner - 1) };
    if last >= first + 5 {
        let mut row = vec![a.clone()];
        row.extend((first + 1..last).map(|k| path.spins(k)));
        row.push(b.clone());
        return Ok(Path::new(&row).resampled((last - first + 1).max(FEWEST)));
    }
    Sweep { from: Edge::Left, width: Some(1.5), axis: None }.path(a, b, FEWEST, context)
}
