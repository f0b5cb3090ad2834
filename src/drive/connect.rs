//! The whole sequence: every saddle of a path with the minima between them, from the initial to the final state.
//!
//! A saddle's two descents either end in the ends of its stretch of path, or in minima on the way; there the stretch is split,
//! and the parts are treated alike.

use super::climb::{Found, ZOOMS, zoomed};
use super::minimum::{Link, Minimum};
use super::relaxation::{Goal, Relaxation};
use super::top::tops;
use crate::band::Band;
use crate::error::Result;
use crate::path::guess::{Edge, FirstGuess, GuessContext, Sweep};
use crate::path::{Path, distance};
use crate::spins::Spins;

/// Most stretches of one path.
const MOST: usize = 600;
/// Images of a stretch, at least.
const FEWEST: usize = 9;
/// Band evaluations a stretch may take.
const EVALUATIONS: usize = 30;

/// Saddles in path order, each with its neighbours.
#[derive(Debug, Default)]
pub struct Sequence {
    /// Saddle, minimum, saddle, …
    pub links: Vec<Link>,
    /// Why the sequence does not lead from end to end; nothing if it does.
    pub gap: Option<String>,
}

/// A stretch of path between two minima, with the saddle on it if that is known already.
struct Stretch {
    a: Minimum,
    b: Minimum,
    path: Path,
    saddle: Option<Found>,
}

/// Follows a relaxed path from `a` to `b`; `saddle` is its highest saddle.
pub fn follow(
    relaxation: &mut Relaxation,
    band: &Band,
    a: Minimum,
    b: Minimum,
    saddle: Found,
    context: &GuessContext,
) -> Result<Sequence> {
    let h = band.hamiltonian();
    let c = relaxation.scales.stiffness_mev;
    let mut sequence = Sequence::default();
    // the part of the path that comes first is on top
    let mut stretches = vec![Stretch { a, b, path: band.path().clone(), saddle: Some(saddle) }];
    let mut open: Vec<(Minimum, Link)> = Vec::new();
    let mut count = 0;
    while let Some(stretch) = stretches.pop() {
        count += 1;
        if count > MOST {
            sequence.gap = Some(format!("the path has more than {MOST} stretches between minima"));
            break;
        }
        let found = match stretch.saddle {
            Some(found) => Some(found),
            None => top_of(relaxation, h, &stretch.path, c),
        };
        let Some(found) = found.filter(|f| f.is_saddle(c)) else {
            sequence.gap =
                Some("a stretch of the path between two minima shows no saddle that could be refined".into());
            close(&mut sequence, &mut open, &stretch.b, h);
            continue;
        };
        let mut link = Link::of(h, found, c)?;
        if link.before.is_same(h, &stretch.b) || link.after.is_same(h, &stretch.a) {
            link.reverse();
        }
        let left_done = link.before.is_same(h, &stretch.a);
        let right_done = link.after.is_same(h, &stretch.b);
        let astray =
            (!left_done && link.before.is_same(h, &stretch.b)) || (!right_done && link.after.is_same(h, &stretch.a));
        if astray {
            sequence.gap = Some("a descent from a saddle leads back to where it came from".into());
        }
        if !right_done && !astray {
            let path = between(&stretch.path, &link.after.spins, &stretch.b.spins, false, context)?;
            stretches.push(Stretch { a: link.after.clone(), b: stretch.b.clone(), path, saddle: None });
        }
        if !left_done && !astray {
            let path = between(&stretch.path, &stretch.a.spins, &link.before.spins, true, context)?;
            stretches.push(Stretch { a: stretch.a.clone(), b: link.before.clone(), path, saddle: None });
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
fn close(sequence: &mut Sequence, open: &mut Vec<(Minimum, Link)>, reached: &Minimum, h: &crate::energy::Hamiltonian) {
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

/// The refined top of a stretch, after a loose relaxation.
fn top_of(relaxation: &mut Relaxation, h: &crate::energy::Hamiltonian, path: &Path, c: f64) -> Option<Found> {
    let mut band = Band::new(h, path.clone());
    relaxation.run(&mut band, Goal::Loose, EVALUATIONS);
    for _ in 0..ZOOMS {
        let Some(path) = zoomed(&band, band.images() + 4) else { break };
        band = Band::new(h, path);
        relaxation.run(&mut band, Goal::Loose, EVALUATIONS);
    }
    // the highest maximum may be where a path that overshoots turns round; any other saddle on the way will do to go on from
    let hop = relaxation.scales.half_site_rad();
    let mut highest = None;
    for top in tops(&band, f64::INFINITY) {
        let found = Found::at(h, top, c, hop);
        if found.is_saddle(c) {
            return Some(found);
        }
        highest = highest.or(Some(found));
    }
    highest
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
