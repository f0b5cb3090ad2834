//! Neighbours by distance.
//!
//! Shell 1 are the nearest partners, shell 2 the next nearest, and so on; where there are species, for each pair of these by itself.
//! Distances are those of the unbounded lattice, along the directions of more than one cell: a shell is the same in a small box as in
//! a large one. A bond leads up: to larger z, of the same z to larger y, of the same y to larger x; in a row ahead.

use super::{BondFamily, Lattice, Shift};
use crate::error::{Error, Result};
use crate::geometry::matrix::determinant;
use crate::geometry::{Vector, vector};

/// Distances of shells differ by more than this part.
const SAME: f64 = 1e-9;
/// The search for partners goes on so much further each time.
const FURTHER: f64 = 1.5;

/// The way from an atom of a cell to one so many cells on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Hop {
    /// From this atom to that.
    pub atoms: [usize; 2],
    /// So many cells on.
    pub shift: Shift,
}

impl Hop {
    /// So many sites ahead in a row.
    pub fn ahead(sites: usize) -> Hop {
        Hop { atoms: [0; 2], shift: [sites as isize, 0, 0] }
    }

    /// The way back.
    pub fn back(self) -> Hop {
        Hop { atoms: [self.atoms[1], self.atoms[0]], shift: self.shift.map(|d| -d) }
    }
}

impl Lattice {
    /// From one end of a bond to the other, in the unit of positions.
    pub fn along(&self, hop: Hop) -> Vector {
        let [from, to] = hop.atoms.map(|a| self.atoms[a].at);
        self.to([0, 1, 2].map(|d| hop.shift[d] as f64 + (to[d] - from[d])))
    }

    /// The squared length of a bond, in lattice constants.
    pub fn squared_length(&self, hop: Hop) -> f64 {
        if self.is_row() {
            return (hop.shift[0] * hop.shift[0]) as f64;
        }
        let (r, a) = (self.along(hop), self.spacing_nm.unwrap_or(1.0));
        vector::dot(r, r) / (a * a)
    }

    /// Whether a bond joins a site that a staggered state reverses with one that it does not.
    pub fn joins_sublattices(&self, hop: Hop) -> bool {
        match self.atoms.len() {
            1 => hop.shift.iter().sum::<isize>() % 2 != 0,
            _ => hop.atoms[0] % 2 != hop.atoms[1] % 2,
        }
    }

    /// Whether a bond leads up.
    pub fn leads_up(&self, hop: Hop) -> bool {
        if self.is_row() {
            return hop.shift[0] > 0;
        }
        let r = self.along(hop);
        let least = SAME * vector::norm(r);
        r.iter().rev().find(|c| c.abs() > least).is_some_and(|c| *c > 0.0)
    }

    /// The hops of the shells 1 … `shells`, shell after shell: each bond one way.
    pub fn shells(&self, shells: usize) -> Vec<(usize, Hop)> {
        if self.is_row() {
            return (1..=shells).map(|n| (n, Hop::ahead(n))).collect();
        }
        let (bounded, mut radius) = (self.shortest_step() == 0.0, self.shortest_step().max(self.cell_width()));
        loop {
            let (within, known) = (self.hops(radius), self.pairs());
            let ranked = self.ranked(&within);
            let all = |pair: &usize| ranked.iter().any(|(shell, hop)| *shell > shells && self.pair(*hop) == *pair);
            if bounded || shells == 0 || known.iter().all(all) {
                return ranked.into_iter().filter(|(shell, _)| *shell <= shells).collect();
            }
            radius *= FURTHER;
        }
    }

    /// The families of the shell of that number among the bonds that join two selections of sites.
    pub fn shell_between(&self, shell: usize, ends: [&[bool]; 2]) -> Result<Vec<BondFamily>> {
        let joins = |family: &BondFamily| {
            let [a, b] = ends;
            family.bonds().any(|[i, j]| (a[i] && b[j]) || (b[i] && a[j]))
        };
        let (mut radius, mut found, mut done) = (self.shortest_step().max(self.cell_width()), 0, 0.0);
        let diagonal: f64 = (0..3).map(|d| self.steps[d].0 * (self.grid.size[d] + 1) as f64).sum();
        while radius > 0.0 && done < diagonal {
            let hops = self.hops(radius);
            for alike in hops.chunk_by(|a, b| b.0 - a.0 <= SAME * b.0).filter(|alike| alike[0].0 > done * (1.0 + SAME))
            {
                let held =
                    alike.iter().map(|(_, hop)| *hop).filter(|hop| self.grid.holds(hop.shift) && !self.closes(*hop));
                let families: Vec<BondFamily> =
                    held.map(|hop| BondFamily::new(self, shell, hop)).filter(&joins).collect();
                found += usize::from(!families.is_empty());
                if found == shell && !families.is_empty() {
                    return Ok(families);
                }
            }
            (done, radius) = (radius, FURTHER * radius);
        }
        let message = match found {
            0 => "there are no bonds between these two".into(),
            1 => "there is only 1 shell of bonds between these two".into(),
            _ => format!("there are only {found} shells of bonds between these two"),
        };
        Err(Error::invalid("", message))
    }

    /// Whether a hop leads from a site to an image of itself; in a ring, whether it is half way round or further.
    pub fn closes(&self, hop: Hop) -> bool {
        match self.is_row() {
            true => self.grid.periodic[0] && 2 * hop.shift[0].unsigned_abs() >= self.sites,
            false => hop.atoms[0] == hop.atoms[1] && self.grid.closes(hop.shift),
        }
    }

    /// The shortest step along a direction that extends; 0 where none does.
    fn shortest_step(&self) -> f64 {
        let steps = (0..3).filter(|d| self.grid.extends(*d)).map(|d| self.steps[d].0);
        steps.min_by(f64::total_cmp).unwrap_or(0.0)
    }

    /// A length within which all atoms of a cell are of each other.
    fn cell_width(&self) -> f64 {
        let apart = |a: usize, b: usize| vector::norm(self.along(Hop { atoms: [a, b], shift: [0; 3] }));
        let atoms = 0..self.atoms.len();
        atoms.clone().flat_map(|a| atoms.clone().map(move |b| [a, b])).map(|[a, b]| apart(a, b)).fold(0.0, f64::max)
    }

    /// Hops no longer than so many lattice constants (in a row, sites), with their lengths, the shortest first; none that leads out
    /// of the lattice, or from a site to itself.
    pub fn hops_within(&self, reach: f64) -> Vec<(f64, Hop)> {
        if self.is_row() {
            let most = if self.grid.periodic[0] { self.sites / 2 } else { self.sites.saturating_sub(1) };
            let near = (reach * (1.0 + SAME)).min(most as f64) as usize;
            return (1..=near).map(|n| (n as f64, Hop::ahead(n))).collect();
        }
        let diagonal: f64 = (0..3).map(|d| self.steps[d].0 * (self.grid.size[d] + 1) as f64).sum();
        let a = self.spacing_nm.unwrap_or(1.0);
        let held = |(_, hop): &(f64, Hop)| self.grid.holds(hop.shift) && !self.closes(*hop);
        self.hops((reach * a).min(diagonal)).into_iter().filter(held).map(|(r, hop)| (r / a, hop)).collect()
    }

    /// All hops that lead up and are no longer than that, with their lengths, the shortest first.
    fn hops(&self, radius: f64) -> Vec<(f64, Hop)> {
        let most = self.cells_within(radius);
        let range = |d: usize| -most[d]..=most[d];
        let shifts = || range(2).flat_map(|c| range(1).flat_map(move |b| range(0).map(move |a| [a, b, c])));
        let atoms = 0..self.atoms.len();
        let pairs = atoms.clone().flat_map(|from| atoms.clone().map(move |to| [from, to]));
        let all = pairs.flat_map(|atoms| shifts().map(move |shift| Hop { atoms, shift }));
        let long = all.filter(|hop| self.leads_up(*hop)).map(|hop| (vector::norm(self.along(hop)), hop));
        let mut found: Vec<(f64, Hop)> = long.filter(|(length, _)| *length <= radius * (1.0 + SAME)).collect();
        found.sort_by(|(a, p), (b, q)| a.total_cmp(b).then(p.cmp(q)));
        // the same length to rounding: in the order of the hops
        let alike = found.chunk_by_mut(|a, b| b.0 - a.0 <= SAME * b.0);
        alike.for_each(|shell| shell.sort_by_key(|(_, hop)| *hop));
        found
    }

    /// How many cells away, along each direction, an atom within a radius is at most.
    fn cells_within(&self, radius: f64) -> [isize; 3] {
        let [a, b, c] = self.steps.map(|(length, along)| vector::scale(length, along.vector()));
        let volume = determinant(&[a, b, c]).abs();
        let faces = [vector::cross(b, c), vector::cross(c, a), vector::cross(a, b)].map(vector::norm);
        let beside = |d: usize| {
            let at = self.atoms.iter().map(|atom| atom.at[d]);
            at.clone().fold(f64::MIN, f64::max) - at.fold(f64::MAX, f64::min)
        };
        let most = |d: usize| (radius * faces[d] / volume + beside(d)).ceil() as isize;
        [0, 1, 2].map(|d| if self.grid.extends(d) { most(d) } else { 0 })
    }

    /// Hops with the numbers of their shells, by pairs of species.
    fn ranked(&self, hops: &[(f64, Hop)]) -> Vec<(usize, Hop)> {
        let mut last: Vec<(f64, usize)> = vec![(0.0, 0); self.species.len().max(1).pow(2)];
        let mut ranked = Vec::with_capacity(hops.len());
        for (length, hop) in hops {
            let (before, shell) = &mut last[self.pair(*hop)];
            if length - *before > SAME * length {
                *shell += 1;
            }
            *before = *length;
            ranked.push((*shell, *hop));
        }
        ranked.sort_by_key(|(shell, _)| *shell);
        ranked
    }

    /// The pair of species that a hop joins, as a number.
    fn pair(&self, hop: Hop) -> usize {
        let [a, b] = hop.atoms.map(|atom| self.atoms[atom].species);
        a.min(b) * self.species.len() + a.max(b)
    }

    /// The pairs of species that there are.
    fn pairs(&self) -> Vec<usize> {
        let atoms = 0..self.atoms.len();
        let all = atoms.clone().flat_map(|a| atoms.clone().map(move |b| Hop { atoms: [a, b], shift: [0; 3] }));
        let mut pairs: Vec<usize> = all.map(|hop| self.pair(hop)).collect();
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }
}
