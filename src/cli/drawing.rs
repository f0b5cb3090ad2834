//! A lattice as letters: seen from above, x to the right and y upwards, sites behind each other as one.

use crate::lattice::Lattice;
use std::collections::BTreeMap;

/// Most letters a line, and lines.
const WIDE: f64 = 71.0;
const HIGH: f64 = 29.0;
/// Places this near to each other are one (lattice constants).
const ALIKE: f64 = 1e-6;

/// What a letter stands for; of several sites under one letter the greatest is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Mark {
    Site,
    Region(u8),
    Vacant,
    Frozen,
}

impl Mark {
    fn letter(self) -> char {
        match self {
            Mark::Site => 'o',
            Mark::Region(k) => (b'a' + k) as char,
            Mark::Vacant => 'x',
            Mark::Frozen => '#',
        }
    }
}

/// The lines of the drawing, the last of them its legend; none of a row.
pub fn drawing(lattice: &Lattice) -> Vec<String> {
    if lattice.is_row() {
        return Vec::new();
    }
    let places: Vec<[f64; 3]> = (0..lattice.sites).map(|i| lattice.place(i)).collect();
    let ([(left, across), (bottom, up)], coarse) = scales(&places);
    let marks = marks(lattice);
    let mut letters: BTreeMap<(usize, usize), Mark> = BTreeMap::new();
    for (place, mark) in places.iter().zip(&marks) {
        let at = |c: usize, low: f64, unit: f64| ((place[c] - low) / unit).round() as usize;
        let there = letters.entry((at(1, bottom, up), at(0, left, across))).or_insert(*mark);
        *there = (*there).max(*mark);
    }
    let top = letters.keys().map(|(row, _)| *row).max().unwrap_or(0);
    let line = |row: usize| {
        let row = letters.range((row, 0)..(row + 1, 0));
        row.fold(String::new(), |line, ((_, column), mark)| format!("{line:<column$}{}", mark.letter()))
    };
    let mut lines: Vec<String> = (0..=top).rev().map(line).collect();
    lines.push(legend(lattice, &marks, coarse));
    lines
}

/// What each site is: where regions overlap, of the last.
fn marks(lattice: &Lattice) -> Vec<Mark> {
    let mut marks = vec![Mark::Site; lattice.sites];
    for (k, sites) in lattice.regions.values().enumerate().take(14) {
        sites.iter().for_each(|i| marks[*i] = Mark::Region(k as u8));
    }
    let frozen = lattice.frozen.iter().flat_map(|f| &f.sites);
    frozen.for_each(|i| marks[*i] = Mark::Frozen);
    (0..lattice.sites).filter(|i| lattice.vacant[*i]).for_each(|i| marks[i] = Mark::Vacant);
    marks
}

/// "o 392 sites, a 25 of region pin, # 12 frozen, x 3 vacant; x to the right, y upwards", and what is not seen.
fn legend(lattice: &Lattice, marks: &[Mark], coarse: bool) -> String {
    let named = |k: u8| lattice.regions.keys().nth(usize::from(k)).cloned().unwrap_or_default();
    let mut counts: BTreeMap<Mark, usize> = BTreeMap::new();
    marks.iter().for_each(|mark| *counts.entry(*mark).or_default() += 1);
    let part = |(mark, count): (&Mark, &usize)| {
        let what = match mark {
            Mark::Site => "sites".to_string(),
            Mark::Region(k) => format!("of region {}", named(*k)),
            Mark::Vacant => "vacant".into(),
            Mark::Frozen => "frozen".into(),
        };
        format!("{} {count} {what}", mark.letter())
    };
    let parts: Vec<String> = counts.iter().map(part).collect();
    let behind = if lattice.grid.size[2] > 1 { ", all layers along z as one" } else { "" };
    let together = if coarse { ", neighbours under one letter" } else { "" };
    format!("{}; x to the right, y upwards{behind}{together}", parts.join(", "))
}

/// Where the drawing begins along x and y, and what a letter and a line are: a line as high as two letters are wide. A letter of its
/// own for every place, where there is room for all; else whole spacings, and that it is so.
fn scales(places: &[[f64; 3]]) -> ([(f64, f64); 2], bool) {
    let axis = |c: usize| {
        let mut all: Vec<f64> = places.iter().map(|p| p[c]).collect();
        all.sort_by(f64::total_cmp);
        all.dedup_by(|b, a| *b - *a < ALIKE);
        let least = all.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min);
        (all[0], all[all.len() - 1] - all[0], if least.is_finite() { least } else { 1.0 })
    };
    let ((left, width, across), (bottom, height, up)) = (axis(0), axis(1));
    let finer = across / (2.0 * across / up).round().max(1.0);
    let fits = |unit: f64| width / unit <= WIDE;
    if height / up <= HIGH && (fits(finer) || fits(across)) {
        return ([(left, if fits(finer) { finer } else { across }), (bottom, up)], false);
    }
    let line = up * ((height / HIGH).max(2.0 * width / WIDE) / up).ceil();
    let letter = across * (width / WIDE / across).ceil().max((0.5 * line / across).round());
    ([(left, letter), (bottom, line)], true)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::LatticeSpec;

    fn drawn(text: &str) -> Vec<String> {
        drawing(&serde_json::from_str::<LatticeSpec>(text).unwrap().resolve().unwrap())
    }

    #[test]
    fn a_film_is_drawn_with_its_regions_its_frozen_and_its_vacant_sites() {
        let text = r#"{"square": {"cells": [4, 3], "vacant": [5], "frozen": [{"sites": [0, 1]}],
                      "regions": {"pin": {"box": {"from": [3], "to": [3]}}}}}"#;
        assert_eq!(
            drawn(text),
            [
                "o o o a",
                "o x o a",
                "# # o a",
                "o 6 sites, a 3 of region pin, x 1 vacant, # 2 frozen; x to the right, y upwards"
            ]
        );
        let rows =
            drawn(r#"{"triangular": {"cells": [3, 2], "shape": {"not": {"box": {"from": [0, 0], "to": [0, 0]}}}}}"#);
        assert_eq!(rows[..2], ["o o o", " o o"]);
        assert_eq!(drawn(r#"{"chain": {"sites": 5}}"#), [""; 0]);
    }

    #[test]
    fn a_large_film_fits_and_keeps_its_proportions() {
        for (text, wide, high) in [
            (r#"{"square": {"cells": [40, 40]}}"#, 40, 21),
            (r#"{"square": {"cells": [300, 300]}}"#, 51, 28),
            (r#"{"square": {"cells": [400, 40]}}"#, 68, 4),
            (r#"{"honeycomb": {"cells": [60, 60], "periodic": true}}"#, 0, 0),
            (r#"{"fcc": {"cells": [40, 8, 3]}}"#, 0, 0),
        ] {
            let lines = drawn(text);
            let widest = lines[..lines.len() - 1].iter().map(|line| line.chars().count()).max().unwrap();
            assert!(widest <= 73 && lines.len() <= 32, "{text}: {widest} × {}", lines.len());
            if wide > 0 {
                assert_eq!((widest, lines.len() - 1), (wide, high), "{text}");
                // every letter stands for as many sites as its neighbour
                assert!(lines[..high].iter().all(|line| !line.contains(' ')), "{lines:?}");
                assert!(lines[high].ends_with("y upwards, neighbours under one letter"), "{lines:?}");
            }
        }
    }
}
