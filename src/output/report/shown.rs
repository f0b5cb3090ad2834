//! Which sites and images a page shows: all of a small path, of a large one as many as a page can hold and a browser can draw.
//!
//! Sites of a chain are thinned evenly, but even and odd ones take turns as they do in the chain: the picture of an antiferromagnet
//! stays one. Of a lattice every third, fifth, … cell in each direction is shown, with all its atoms; there are more of them, since
//! they are drawn as discs where arrows have no room.
//! Images are thinned evenly too, but those of saddles and minima stay. Sites give way first: spins between two images are
//! interpolated, and images far apart would show what never happened.

use crate::drive::Outcome;
use crate::lattice::Lattice;

/// Most images, apart from those at rest.
const IMAGES: usize = 400;
/// Most images that stay because a saddle or a minimum is there.
const AT_REST: usize = 100;
/// Most sites.
const SITES: usize = 1000;
/// Most spins, sites times images.
const SPINS: usize = 200_000;
/// Most sites of a lattice that is no row.
const LATTICE_SITES: usize = 100_000;
/// Most spins of it.
const LATTICE_SPINS: usize = 2_000_000;

/// Numbers of the images and sites that are shown, ascending.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Shown {
    pub(super) images: Vec<usize>,
    pub(super) sites: Vec<usize>,
    /// From a cell that is shown to the next.
    pub(super) stride: usize,
}

impl Shown {
    pub(super) fn of(outcome: &Outcome, lattice: &Lattice) -> Shown {
        let path = &outcome.path;
        let mut saddles: Vec<(f64, usize)> = outcome.saddles.iter().map(|s| (s.above_initial_mev, s.image)).collect();
        saddles.sort_by(|a, b| b.0.total_cmp(&a.0));
        let minima = outcome.intermediate_minima.iter().map(|m| m.image);
        let at_rest = saddles.into_iter().map(|(_, image)| image).chain(minima).take(AT_REST);
        let mut images = evenly(path.images(), IMAGES);
        images.extend(at_rest.filter(|k| *k < path.images()));
        images.sort_unstable();
        images.dedup();
        let (sites, stride) = sites_shown(lattice, path.sites(), images.len());
        Shown { sites, stride, images }
    }

    /// Those of these sites that are shown.
    pub(super) fn among(&self, sites: impl Iterator<Item = usize>) -> Vec<usize> {
        sites.filter(|i| self.sites.binary_search(i).is_ok()).collect()
    }
}

/// Which of so many sites are shown in so many images, and from a cell that is shown to the next.
pub(super) fn sites_shown(lattice: &Lattice, sites: usize, images: usize) -> (Vec<usize>, usize) {
    let most = |sites: usize, spins: usize| sites.min(spins / images.max(1)).max(2);
    match lattice.is_row() {
        true => (alternating(sites, most(SITES, SPINS)), 1),
        false => by_cells(lattice, most(LATTICE_SITES, LATTICE_SPINS)),
    }
}

/// At most `most` (≥ 2) of `count` numbers from 0 on, evenly spaced, the first and the last among them.
pub(super) fn evenly(count: usize, most: usize) -> Vec<usize> {
    if count <= most {
        return (0..count).collect();
    }
    (0..most).map(|k| (2 * k * (count - 1) + most - 1) / (2 * (most - 1))).collect()
}

/// The same, but number k is even where k is, and odd where k is.
fn alternating(count: usize, most: usize) -> Vec<usize> {
    if count <= most {
        return (0..count).collect();
    }
    // as many as leave the last one its parity
    let shown = most - (count - most) % 2;
    let mut sites: Vec<usize> = Vec::with_capacity(shown);
    for (k, near) in evenly(count, shown.max(2)).into_iter().enumerate() {
        let wanted = if near % 2 == k % 2 { near } else { near - 1 };
        sites.push(sites.last().map_or(wanted, |last| wanted.max(last + 1)));
    }
    sites
}

/// The sites of every so manieth cell in each direction, an odd number, so that no more than `most` are left; of a cell with more
/// atoms than that, all.
fn by_cells(lattice: &Lattice, most: usize) -> (Vec<usize>, usize) {
    let kept = |stride: usize| -> Vec<usize> {
        (0..lattice.sites).filter(|i| lattice.cell(*i).1.iter().all(|c| c % stride == 0)).collect()
    };
    let widest = lattice.grid.size.into_iter().fold(1, usize::max);
    let strides = (1..=widest).step_by(2).map(|stride| (kept(stride), stride));
    strides.filter(|(sites, _)| !sites.is_empty()).find(|(sites, _)| sites.len() <= most).unwrap_or((kept(1), 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_are_all_and_of_many_both_ends_stay() {
        assert_eq!(evenly(0, 5), [0usize; 0]);
        assert_eq!(evenly(5, 5), [0, 1, 2, 3, 4]);
        assert_eq!(evenly(101, 5), [0, 25, 50, 75, 100]);
        for (count, most) in [(7, 6), (1000, 999), (12_345, 400), (100_000, 2)] {
            let kept = evenly(count, most);
            assert_eq!((kept.len(), kept[0], kept[kept.len() - 1]), (most, 0, count - 1));
            assert!(kept.windows(2).all(|w| w[0] < w[1]));
        }
    }

    #[test]
    fn a_lattice_is_thinned_by_its_cells_and_keeps_all_of_a_few() {
        let text = r#"{"honeycomb": {"cells": [30, 20], "shape": {"not": {"disc": {"radius": 4}}}}}"#;
        let lattice = serde_json::from_str::<crate::lattice::LatticeSpec>(text).unwrap().resolve().unwrap();
        assert_eq!(by_cells(&lattice, 1200), ((0..lattice.sites).collect(), 1));
        let (sites, stride) = by_cells(&lattice, 140);
        assert_eq!(stride, 3);
        assert!(sites.len() <= 140 && sites.len() > 100 && sites.windows(2).all(|w| w[0] < w[1]), "{}", sites.len());
        assert!(sites.iter().all(|i| lattice.cell(*i).1[..2].iter().all(|c| c % 3 == 0)));
    }

    #[test]
    fn even_and_odd_sites_take_turns_in_what_is_shown() {
        for count in (2..60).chain([1001, 1500, 99_999, 100_000]) {
            for most in [2, 3, 10, 37, 1000] {
                let sites = alternating(count, most);
                assert!(sites.len() <= most && sites.len() + 1 >= most.min(count), "{count} {most}: {sites:?}");
                assert!(sites.iter().enumerate().all(|(k, i)| k % 2 == i % 2), "{count} {most}: {sites:?}");
                assert!(sites.windows(2).all(|w| w[0] < w[1]), "{count} {most}: {sites:?}");
                assert!(sites[0] == 0 && sites[sites.len() - 1] < count, "{count} {most}: {sites:?}");
            }
        }
        assert_eq!(alternating(100_001, 1000)[998], 100_000);
    }
}
