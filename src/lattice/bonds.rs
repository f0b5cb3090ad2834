//! Bonds: families of one shift each, as runs of sites whose partners stand a constant number of sites away.
//!
//! Of each row of cells the partners of a shift lie in one other row, in order; an open border leaves sites out, a periodic one
//! splits the row once. A kernel so runs over contiguous slices, whatever the lattice.

use super::grid::Shift;
use super::{Grid, Lattice};
use crate::error::{Error, Result};
use crate::geometry::vector;
use std::ops::Range;

/// Distances of shells differ by more than this part.
const SAME: f64 = 1e-9;

/// All bonds that lead from a site to the one a shift on.
#[derive(Clone, Debug, PartialEq)]
pub struct BondFamily {
    /// Whether they are nearest (1), next … neighbours.
    pub shell: usize,
    /// Ascending, without the sites that have no partner at all.
    segments: Vec<Segment>,
}

/// Sites in a row whose partners are so many sites away.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    /// The sites.
    pub sites: Range<usize>,
    /// To the partner a shift on, with which the site's own bond is; nothing where there is none.
    pub next: Option<isize>,
    /// To the partner a shift back, whose bond it is.
    pub previous: Option<isize>,
}

impl Segment {
    /// How far away the partners are, where one is as far ahead as the other is behind.
    #[inline(always)]
    pub fn even(&self) -> Option<isize> {
        self.next.filter(|n| self.previous == Some(-n))
    }
}

/// One bond.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bond {
    /// Which of its shell's families it is of.
    pub family: usize,
    /// The site whose bond it is, and its partner.
    pub sites: [usize; 2],
}

/// The site an offset away.
#[inline(always)]
pub fn at(i: usize, offset: isize) -> usize {
    (i as isize + offset) as usize
}

impl BondFamily {
    /// The bonds of a shift in a box.
    pub fn new(grid: &Grid, shell: usize, shift: Shift) -> BondFamily {
        let back = shift.map(|d| -d);
        let mut segments: Vec<Segment> = Vec::new();
        for row in 0..grid.size[1] * grid.size[2] {
            let (next, previous) = (runs(grid, row, shift), runs(grid, row, back));
            let mut cuts: Vec<usize> = next.iter().chain(&previous).flat_map(|(r, _)| [r.start, r.end]).collect();
            cuts.sort_unstable();
            cuts.dedup();
            let of = |runs: &[(Range<usize>, isize)], i| runs.iter().find(|(r, _)| r.contains(&i)).map(|(_, o)| *o);
            for cut in cuts.windows(2) {
                let (next, previous) = (of(&next, cut[0]), of(&previous, cut[0]));
                match segments.last_mut() {
                    _ if next.is_none() && previous.is_none() => {}
                    Some(s) if (s.sites.end, s.next, s.previous) == (cut[0], next, previous) => s.sites.end = cut[1],
                    _ => segments.push(Segment { sites: cut[0]..cut[1], next, previous }),
                }
            }
        }
        BondFamily { shell, segments }
    }

    /// The segments of a range of sites, cut at its ends.
    pub fn segments(&self, range: Range<usize>) -> impl Iterator<Item = Segment> + '_ {
        let first = self.segments.partition_point(|s| s.sites.end <= range.start);
        let inside = self.segments[first..].iter().take_while({
            let end = range.end;
            move |s| s.sites.start < end
        });
        inside.map(move |s| Segment { sites: s.sites.start.max(range.start)..s.sites.end.min(range.end), ..*s })
    }

    /// Every bond once, by ascending site: the site and its partner.
    pub fn bonds(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        self.bonds_of(0..usize::MAX)
    }

    /// The bonds of the sites of a range.
    pub fn bonds_of(&self, sites: Range<usize>) -> impl Iterator<Item = [usize; 2]> + '_ {
        let own = self.segments(sites).filter_map(|s| s.next.map(|next| (s.sites, next)));
        own.flat_map(|(sites, next)| sites.map(move |i| [i, at(i, next)]))
    }

    /// The site a shift on from site i.
    pub fn next(&self, i: usize) -> Option<usize> {
        self.segments(i..i + 1).find_map(|s| s.next).map(|next| at(i, next))
    }

    /// The site a shift back from site i.
    pub fn previous(&self, i: usize) -> Option<usize> {
        self.segments(i..i + 1).find_map(|s| s.previous).map(|previous| at(i, previous))
    }
}

/// The sites of a row of cells with a partner a shift on, and how far that is.
fn runs(grid: &Grid, row: usize, shift: Shift) -> Vec<(Range<usize>, isize)> {
    let ([x, y, _], n) = (grid.size, grid.size[0] as isize);
    let (Some(to_y), Some(to_z)) = (grid.step(row % y, shift[1], 1), grid.step(row / y, shift[2], 2)) else {
        return Vec::new();
    };
    let (first, base) = (row * x, ((to_z * y + to_y) * x) as isize - (row * x) as isize);
    let along = if grid.periodic[0] { shift[0].rem_euclid(n) } else { shift[0] };
    let once_round = if grid.periodic[0] { vec![along, along - n] } else { vec![along] };
    let run = |along: isize| {
        let (low, high) = ((-along).clamp(0, n) as usize, (n - along).clamp(0, n) as usize);
        (first + low..first + high, base + along)
    };
    once_round.into_iter().map(run).filter(|(sites, _)| !sites.is_empty()).collect()
}

impl Lattice {
    /// The families of the shells 1 … `shells`, shell after shell.
    pub fn families(&self, shells: usize) -> Vec<BondFamily> {
        let shifts = self.shifts(shells).into_iter().enumerate();
        shifts
            .flat_map(|(k, all)| all.into_iter().map(move |shift| (k + 1, shift)))
            .map(|(shell, shift)| BondFamily::new(&self.grid, shell, shift))
            .collect()
    }

    /// The families of one shell.
    pub fn shell(&self, shell: usize) -> Vec<BondFamily> {
        self.shifts_of(shell).into_iter().map(|shift| BondFamily::new(&self.grid, shell, shift)).collect()
    }

    /// The bonds of a shell, as they are counted: family after family, by ascending site. In a row bond i is that of site i.
    pub fn bonds(&self, shell: usize) -> Vec<Bond> {
        let families = self.shell(shell);
        let of = |(family, bonds): (usize, &BondFamily)| -> Vec<Bond> {
            bonds.bonds().map(|sites| Bond { family, sites }).collect()
        };
        families.iter().enumerate().flat_map(of).collect()
    }

    /// Refuses a shell that reaches further than the lattice does, or that wraps onto itself.
    pub fn admits(&self, shell: usize) -> Result<()> {
        let (sites, row, Grid { size, periodic }) = (self.sites, self.grid.is_row(), self.grid);
        let shifts = self.shifts_of(shell);
        let wraps = |s: &Shift| (0..3).any(|d| periodic[d] && s[d] != 0 && 2 * s[d].unsigned_abs() >= size[d]);
        let message = match shifts.iter().any(wraps) {
            true if row => {
                let most = (sites - 1) / 2;
                format!("shell {shell} wraps onto itself in a ring of {sites} sites: at most {most} shells fit")
            }
            true => format!("shell {shell} wraps onto itself in a lattice of {size:?} cells"),
            false if row && shell > 1.max(sites - 1) => {
                format!("shell {shell} reaches further than the chain of {sites} sites is long")
            }
            false if shifts.is_empty() => format!("shell {shell} reaches further than the lattice of {size:?} cells"),
            false => return Ok(()),
        };
        Err(Error::invalid("", message))
    }

    fn shifts_of(&self, shell: usize) -> Vec<Shift> {
        match self.grid.is_row() {
            true => vec![[shell as isize, 0, 0]],
            false => self.shifts(shell).pop().unwrap_or_default(),
        }
    }

    /// The shifts of the shells 1 … `shells`, by distance; in a row the distance is the number of cells.
    fn shifts(&self, shells: usize) -> Vec<Vec<Shift>> {
        if self.grid.is_row() {
            return (1..=shells as isize).map(|n| vec![[n, 0, 0]]).collect();
        }
        let length = |shift: &Shift| {
            let along = |d: usize| vector::scale(shift[d] as f64 * self.steps[d].0, self.steps[d].1.vector());
            vector::norm((0..3).map(along).fold([0.0; 3], vector::add))
        };
        let mut all: Vec<(f64, Shift)> = self.grid.shifts(shells).into_iter().map(|s| (length(&s), s)).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let by_distance = all.chunk_by(|a, b| b.0 - a.0 <= SAME * b.0);
        let mut found: Vec<Vec<Shift>> = by_distance.map(|shell| shell.iter().map(|(_, s)| *s).collect()).collect();
        found.resize(shells, Vec::new());
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::Chain;

    #[test]
    fn an_open_chain_has_one_bond_less_than_sites_and_a_ring_as_many() {
        let count = |chain: Chain, shell: usize| chain.resolve().unwrap().bonds(shell).len();
        assert_eq!([1, 2, 9].map(|shell| count(Chain::open(5), shell)), [4, 3, 0]);
        assert_eq!(count(Chain::open(1), 1), 0);
        assert_eq!(count(Chain::ring(5), 1), 5);
    }

    #[test]
    fn the_segments_of_a_family_are_what_counting_cells_gives_in_any_box() {
        let mut families = 0;
        for size in [[7, 1, 1], [9, 4, 1], [5, 6, 3], [3, 3, 3], [4, 1, 2]] {
            for border in 0..8 {
                let grid = Grid { size, periodic: [border & 1 > 0, border & 2 > 0, border & 4 > 0] };
                for shift in [[1, 0, 0], [2, 0, 0], [0, 1, 0], [-1, 1, 0], [1, 1, 0], [0, 0, 1], [1, -1, 1], [8, 0, 0]]
                {
                    let family = BondFamily::new(&grid, 1, shift);
                    for tile in [grid.cells(), 4, 5] {
                        let tiles = (0..grid.cells()).step_by(tile).map(|first| first..grid.cells().min(first + tile));
                        let segments: Vec<Segment> = tiles.flat_map(|tile| family.segments(tile)).collect();
                        let of = |i: usize| segments.iter().find(|s| s.sites.contains(&i));
                        for i in 0..grid.cells() {
                            let partner =
                                |offset: fn(&Segment) -> Option<isize>| of(i).and_then(offset).map(|o| at(i, o));
                            assert_eq!(partner(|s| s.next), grid.shifted(i, shift), "{grid:?} {shift:?} {i}");
                            assert_eq!(
                                partner(|s| s.previous),
                                grid.shifted(i, shift.map(|d| -d)),
                                "{grid:?} {shift:?} {i}"
                            );
                            assert_eq!(family.next(i), grid.shifted(i, shift));
                        }
                    }
                    families += 1;
                }
            }
        }
        assert_eq!(families, 320);
    }
}
