//! Bonds: families of one hop each, as runs of sites whose partners stand a constant number of sites away.
//!
//! Of each row of cells the partners of a hop lie in one other row, in order; an open border leaves sites out, a periodic one
//! splits the row once, and so does a site that is not there. A kernel so runs over contiguous slices, whatever the lattice.

use super::{Grid, Hop, Lattice};
use crate::error::{Error, Result};
use crate::geometry::Vector;
use std::ops::Range;

/// All bonds that lead from a site to the one a hop on.
#[derive(Clone, Debug, PartialEq)]
pub struct BondFamily {
    /// Whether they are nearest (1), next … neighbours.
    pub shell: usize,
    /// From which atom of a cell to which, how many cells on.
    pub hop: Hop,
    /// From one end to the other, in the unit of positions.
    pub along: Vector,
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
    /// The bonds of a hop in a lattice.
    pub fn new(lattice: &Lattice, shell: usize, hop: Hop) -> BondFamily {
        let (grid, [from, to]) = (&lattice.grid, hop.atoms);
        let mut segments: Vec<Segment> = Vec::new();
        let runs_of = |atom: usize, row: usize, hop: Hop| -> Vec<(Range<usize>, isize)> {
            let runs = if hop.atoms[0] == atom { runs(grid, row, hop) } else { Vec::new() };
            runs.into_iter().flat_map(|(slots, offset)| lattice.slots.runs(slots, offset)).collect()
        };
        let atoms = if from == to { vec![from] } else { vec![from.min(to), from.max(to)] };
        let rows = atoms.into_iter().flat_map(|atom| (0..grid.size[1] * grid.size[2]).map(move |row| (atom, row)));
        for (atom, row) in rows {
            add_row(&mut segments, &runs_of(atom, row, hop), &runs_of(atom, row, hop.back()));
        }
        BondFamily { shell, hop, along: lattice.along(hop), segments }
    }

    /// Whether it is what its hop makes of a lattice.
    pub fn is_of(&self, lattice: &Lattice) -> bool {
        self.hop.atoms.iter().all(|atom| *atom < lattice.atoms.len())
            && BondFamily::new(lattice, self.shell, self.hop).segments == self.segments
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

/// Adds the segments of a row, from its runs towards partners a hop on and a hop back.
fn add_row(segments: &mut Vec<Segment>, next: &[(Range<usize>, isize)], previous: &[(Range<usize>, isize)]) {
    let mut cuts: Vec<usize> = next.iter().chain(previous).flat_map(|(r, _)| [r.start, r.end]).collect();
    cuts.sort_unstable();
    cuts.dedup();
    let of = |runs: &[(Range<usize>, isize)], i| {
        let run = runs.get(runs.partition_point(|(r, _)| r.end <= i));
        run.filter(|(r, _)| r.contains(&i)).map(|(_, offset)| *offset)
    };
    for cut in cuts.windows(2) {
        let (next, previous) = (of(next, cut[0]), of(previous, cut[0]));
        match segments.last_mut() {
            _ if next.is_none() && previous.is_none() => {}
            Some(s) if (s.sites.end, s.next, s.previous) == (cut[0], next, previous) => s.sites.end = cut[1],
            _ => segments.push(Segment { sites: cut[0]..cut[1], next, previous }),
        }
    }
}

/// The slots of an atom in a row of cells whose partners a hop on are in the box, and how many slots away those are, ascending.
fn runs(grid: &Grid, row: usize, Hop { atoms: [atom, to], shift }: Hop) -> Vec<(Range<usize>, isize)> {
    let ([x, y, _], n) = (grid.size, grid.size[0] as isize);
    let (Some(to_y), Some(to_z)) = (grid.step(row % y, shift[1], 1), grid.step(row / y, shift[2], 2)) else {
        return Vec::new();
    };
    let slot = |atom: usize, row: usize| ((atom * grid.cells()) + row * x) as isize;
    let (first, base) = (slot(atom, row) as usize, slot(to, to_z * y + to_y) - slot(atom, row));
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
        self.shells(shells).into_iter().map(|(shell, hop)| BondFamily::new(self, shell, hop)).collect()
    }

    /// The families of one shell.
    pub fn shell(&self, shell: usize) -> Vec<BondFamily> {
        self.hops_of(shell).into_iter().map(|hop| BondFamily::new(self, shell, hop)).collect()
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
        let (sites, row, Grid { size, periodic }) = (self.sites, self.is_row(), self.grid);
        let hops = self.hops_of(shell);
        let message = match row {
            true if periodic[0] && 2 * shell >= sites => {
                let most = (sites - 1) / 2;
                format!("shell {shell} wraps onto itself in a ring of {sites} sites: at most {most} shells fit")
            }
            true if !periodic[0] && shell > 1.max(sites - 1) => {
                format!("shell {shell} reaches further than the chain of {sites} sites is long")
            }
            false if hops.iter().any(|hop| self.closes(*hop)) => {
                let way_out = "make a periodic direction longer, or open";
                format!("shell {shell} joins sites with images of themselves in a lattice of {size:?} cells: {way_out}")
            }
            false if !hops.iter().any(|hop| self.grid.holds(hop.shift)) => {
                format!("shell {shell} reaches further than the lattice of {size:?} cells")
            }
            _ => return Ok(()),
        };
        Err(Error::invalid("", message))
    }

    fn hops_of(&self, shell: usize) -> Vec<Hop> {
        match self.is_row() {
            true => vec![Hop::ahead(shell)],
            false => self.shells(shell).into_iter().filter(|(k, _)| *k == shell).map(|(_, hop)| hop).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Direction;
    use crate::lattice::{Atom, Chain, Slots};

    #[test]
    fn an_open_chain_has_one_bond_less_than_sites_and_a_ring_as_many() {
        let count = |chain: Chain, shell: usize| chain.resolve().unwrap().bonds(shell).len();
        assert_eq!([1, 2, 9].map(|shell| count(Chain::open(5), shell)), [4, 3, 0]);
        assert_eq!(count(Chain::open(1), 1), 0);
        assert_eq!(count(Chain::ring(5), 1), 5);
    }

    #[test]
    fn the_segments_of_a_family_are_what_counting_cells_gives_in_any_box_with_any_atoms_and_sites_left_out() {
        let mut families = 0;
        for (size, atoms, holes) in [
            ([7, 1, 1], 1, 0),
            ([9, 4, 1], 1, 0),
            ([5, 6, 3], 1, 7),
            ([3, 3, 3], 3, 0),
            ([4, 1, 2], 2, 3),
            ([2, 2, 1], 2, 0),
            ([6, 5, 1], 2, 4),
        ] {
            for border in 0..8 {
                let lattice = some(size, border, atoms, holes);
                for shift in [[1, 0, 0], [2, 0, 0], [0, 1, 0], [-1, 1, 0], [1, 1, 0], [0, 0, 1], [1, -1, 1], [8, 0, 0]]
                {
                    for pair in [[0, 0], [0, atoms - 1], [atoms - 1, 0]] {
                        meets(&lattice, Hop { atoms: pair, shift });
                        families += 1;
                    }
                }
            }
        }
        assert_eq!(families, 7 * 8 * 8 * 3);
    }

    /// A box of cells with so many atoms each, every so manieth left out.
    fn some(size: [usize; 3], border: usize, atoms: usize, holes: usize) -> Lattice {
        let grid = Grid { size, periodic: [border & 1 > 0, border & 2 > 0, border & 4 > 0] };
        let steps = [Direction::X, Direction::Y, Direction::Z].map(|along| (1.0, along));
        let place = |k: usize| Atom { at: [0.1 * k as f64, 0.2 * k as f64, 0.0], species: 0 };
        let mut lattice = Lattice::of_atoms("some", grid, steps, (0..atoms).map(place).collect());
        let taken: Vec<bool> = (0..lattice.sites).map(|k| holes == 0 || k % holes != 2).collect();
        (lattice.slots, lattice.sites) = (Slots::taken(&taken), taken.iter().filter(|t| **t).count());
        lattice
    }

    fn meets(lattice: &Lattice, hop: Hop) {
        let family = BondFamily::new(lattice, 1, hop);
        let n = lattice.sites;
        let counted = |i: usize, hop: Hop| {
            let (atom, cell) = lattice.cell(i);
            let there = lattice.grid.shifted(cell, hop.shift).filter(|_| atom == hop.atoms[0])?;
            lattice.site(hop.atoms[1], there)
        };
        for tile in [n, 4, 5] {
            let tiles = (0..n).step_by(tile).map(|first| first..n.min(first + tile));
            let segments: Vec<Segment> = tiles.flat_map(|tile| family.segments(tile)).collect();
            let of = |i: usize| segments.iter().find(|s| s.sites.contains(&i));
            for i in 0..n {
                let partner = |offset: fn(&Segment) -> Option<isize>| of(i).and_then(offset).map(|o| at(i, o));
                assert_eq!(partner(|s| s.next), counted(i, hop), "{:?} {hop:?} {i}", lattice.grid);
                assert_eq!(partner(|s| s.previous), counted(i, hop.back()), "{:?} {hop:?} {i}", lattice.grid);
                assert_eq!(family.next(i), counted(i, hop));
            }
        }
    }
}
