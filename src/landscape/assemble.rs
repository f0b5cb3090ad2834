//! One path through every proven saddle and every minimum between them: a stretch from each saddle down to each of its minima,
//! relaxed on its own, all stretches at once, and put together again.
//!
//! A band over many minima relaxes slowly, because its images have to share themselves among them. A stretch between a saddle
//! and a minimum has neither on the way: it starts as the descent itself and is monotone.

use super::connect::Bands;
use super::flat::{Stretch, flat_ways, turning};
use super::{Landscape, Pass, turned, turns};
use crate::band::Band;
use crate::energy::{Evaluator, recorded};
use crate::error::Result;
use crate::path::{Path, largest_angle};
use crate::sphere::SAME;
use crate::spins::Spins;
use crate::stationary::FEW;
use rayon::prelude::*;

/// A path, and which of its images are stationary and stay where they are.
pub struct Assembled {
    /// All images, both ends counted.
    pub path: Path,
    /// Saddles and minima between the ends, ascending.
    pub stops: Vec<usize>,
}

impl Assembled {
    /// A relaxed path over the same stops, where neighbouring images of a stretch are farther apart than that (rad, any spin) with
    /// another between each two of it that are more than half as far apart; None where none are. Over a flat valley the geodesic is
    /// shorter than the way: a wall is somewhere else at once, and has to go there. Images beside a wide gap slide off it, so that to
    /// fill the gap alone does not do.
    pub fn finer(&self, path: &Path, apart: f64) -> Option<Assembled> {
        let ends: Vec<usize> =
            std::iter::once(0).chain(self.stops.iter().copied()).chain([path.images() - 1]).collect();
        let (mut row, mut stops): (Vec<Spins>, Vec<usize>) = (vec![path.spins(0)], Vec::new());
        for stretch in ends.windows(2) {
            let own: Vec<Spins> = (stretch[0]..=stretch[1]).map(|k| path.spins(k)).collect();
            let own = Path::new(&own);
            let own = if own.largest_rotation() > apart { own.halved(0.5 * apart) } else { own };
            row.extend((1..own.images()).map(|k| own.spins(k)));
            stops.push(row.len() - 1);
        }
        stops.pop();
        (row.len() > path.images()).then(|| Assembled { path: Path::new(&row), stops })
    }
}

/// The path from `a` to `b` over passes, with so many images, or as many as bring neighbours within `apart` (rad, any spin). None
/// where there are no passes or fewer images than stretches.
pub fn assemble(
    land: &Landscape,
    passes: &[Pass],
    [a, b]: [&Spins; 2],
    images: Option<usize>,
    apart: f64,
    bands: &dyn Bands,
) -> Result<Option<Assembled>> {
    let h = land.evaluator();
    let Some(raw) = stretches(land, passes, a, b) else { return Ok(None) };
    let Some(counts) = counts(&raw, images, apart) else { return Ok(None) };
    let input: Vec<&[f64]> = raw.iter().map(|stretch| stretch.path().as_slice()).collect();
    let pieces: Vec<Path> = recorded(h, "stretches", &input, || {
        raw.par_iter().zip(&counts).map(|(stretch, &n)| in_place(h, stretch, n, bands)).collect()
    })?;
    let mut row: Vec<Spins> = vec![a.clone()];
    let mut stops = Vec::new();
    for (stretch, piece) in raw.iter().zip(&pieces) {
        let first = row.len();
        row.extend((1..piece.images()).map(|k| piece.spins(k)));
        // all of a turn is stationary
        let is_turn = matches!(stretch, Stretch::Turn { .. });
        stops.extend(if is_turn { first } else { row.len() - 1 }..row.len());
    }
    stops.pop();
    Ok(Some(Assembled { path: Path::new(&row), stops }))
}

/// The descents from the saddles, end to end from `a` to `b`: minimum to saddle, saddle to minimum, …; and flat ways where a pass does
/// not begin where the one before it ends.
fn stretches(land: &Landscape, passes: &[Pass], a: &Spins, b: &Spins) -> Option<Vec<Stretch>> {
    let h = land.evaluator();
    let mut pieces = Vec::new();
    let mut here = a.clone();
    let apart = |a: &Spins, b: &Spins| largest_angle(a.as_slice(), b.as_slice()) > SAME;
    for pass in passes {
        let turn = turns(h, &pass.before.spins, &here);
        let turned = |s: &Spins| turned(s, &turn);
        let before = turned(&pass.before.spins);
        if apart(&before, &here) {
            pieces.extend(flat_ways(land, &here, &before));
            here = before;
        }
        let saddle = turned(&Spins::from_unit_components(pass.saddle.spins()));
        let mut up = vec![here];
        up.extend(pass.ways[0].iter().rev().map(turned));
        up.push(saddle.clone());
        here = turned(&pass.after.spins);
        if std::ptr::eq(pass, passes.last()?) && !apart(&here, b) {
            here = b.clone();
        }
        let mut down = vec![saddle];
        down.extend(pass.ways[1].iter().map(turned));
        down.push(here.clone());
        pieces.extend([up, down].map(|row| Stretch::Way(Path::new(&row))));
    }
    if apart(&here, b) {
        pieces.extend(flat_ways(land, &here, b));
    }
    (!passes.is_empty()).then_some(pieces)
}

/// Images of each stretch, both ends counted: so many that neighbours are at most `apart` (rad, any spin), or so many that all
/// together have the number asked for.
fn counts(pieces: &[Stretch], images: Option<usize>, apart: f64) -> Option<Vec<usize>> {
    let enough = |piece: &Path| {
        let mut n = 3;
        for _ in 0..FEW {
            let far = piece.resampled(n).largest_rotation();
            if far <= apart {
                break;
            }
            n = 1 + ((n - 1) as f64 * (far / apart).min(2.0)).ceil() as usize;
        }
        n
    };
    match images {
        None => Some(pieces.par_iter().map(|piece| enough(piece.path())).collect()),
        Some(n) => shared(&pieces.iter().map(|piece| piece.path().length()).collect::<Vec<_>>(), n - 1)
            .map(|intervals| intervals.into_iter().map(|i| i + 1).collect()),
    }
}

/// `total` intervals shared out in proportion to lengths, at least one each.
fn shared(lengths: &[f64], total: usize) -> Option<Vec<usize>> {
    let mut counts = vec![1; lengths.len()];
    for _ in 0..total.checked_sub(lengths.len())? {
        let longest = |best: usize, k: usize| {
            if lengths[k] / counts[k] as f64 > lengths[best] / counts[best] as f64 { k } else { best }
        };
        let k = (0..lengths.len()).fold(0, longest);
        counts[k] += 1;
    }
    Some(counts)
}

/// A stretch between its two stationary ends with so many images, relaxed.
fn in_place(h: Evaluator, stretch: &Stretch, images: usize, bands: &dyn Bands) -> Result<Path> {
    let path = match stretch {
        Stretch::Turn { path, by } => return Ok(turning(&path.spins(0), path.spins(path.images() - 1), *by, images)),
        Stretch::Way(path) => path.resampled(images),
    };
    if path.images() < 3 {
        return Ok(path);
    }
    let mut band = Band::new(h, path);
    bands.tightly(&mut band)?;
    Ok(band.into_path())
}

#[cfg(test)]
mod tests {
    use super::shared;

    #[test]
    fn intervals_are_shared_by_length_and_every_stretch_has_one() {
        assert_eq!(shared(&[1.0, 3.0, 0.1], 8), Some(vec![2, 5, 1]));
        assert_eq!(shared(&[1.0, 1.0, 1.0], 3), Some(vec![1, 1, 1]));
        assert_eq!(shared(&[1.0, 1.0, 1.0], 2), None);
    }
}
