//! Writing a Hessian: row by row where it is a band, and what is left bond by bond.

use super::TangentBasis;
use super::far;
use crate::energy::{Blocks, Bonds, Hamiltonian, LONG, multiply};
use crate::field::Components;
use crate::geometry::vector;
use crate::linalg::{Banded, Layout, Matrix};
use multiversion::multiversion;
use rayon::prelude::*;
use std::ops::Range;

/// The Riemannian Hessian at `m`, where the Euclidean gradient is `g`. A frozen site has a stiff diagonal and no couplings.
pub fn assemble(h: &Hamiltonian, m: &[f64], g: &[f64], basis: &TangentBasis) -> Matrix {
    let mut matrix = Matrix::default();
    assemble_into(h, m, g, basis, 0.0, &mut matrix);
    matrix
}

/// [`assemble`] of H + shift·1 into the memory of `matrix`.
pub fn assemble_into(h: &Hamiltonian, m: &[f64], g: &[f64], basis: &TangentBasis, shift: f64, matrix: &mut Matrix) {
    let assembly = Assembly::begin(h, m, g, shift, matrix);
    assembly.write_all(basis, matrix);
    assembly.finish(basis, matrix);
}

/// A Hessian that is written row by row of sites.
#[derive(Debug)]
pub struct Assembly<'a> {
    h: &'a Hamiltonian,
    m: Components<'a>,
    g: Components<'a>,
    /// The blocks, where they are not the constant ones.
    own: Option<Blocks>,
    shift: f64,
    /// So many sites have the partners of their own bonds so many sites on as the shell tells, in a row.
    plain: usize,
}

impl<'a> Assembly<'a> {
    /// Gives `matrix` its shape; all rows are to be written then, and at the end [`finish`](Self::finish)ed.
    pub fn begin(h: &'a Hamiltonian, m: &'a [f64], g: &'a [f64], shift: f64, matrix: &mut Matrix) -> Assembly<'a> {
        let dense = h.coupling().pairs().is_some() && h.coupling().tail().is_none();
        let layout = if dense { &Layout::Dense } else { h.layout() };
        let plain = match layout {
            Layout::Band { .. } if !h.has_frozen() => h.sites().saturating_sub(h.reach()),
            _ => 0,
        };
        matrix.reset(layout, h.sites(), plain);
        let own = h.varying_blocks(Components::new(m));
        Assembly { h, m: Components::new(m), g: Components::new(g), own, shift, plain }
    }

    /// Writes a row of sites, with the basis there and as many sites on as the bonds reach.
    pub fn write_rows(&self, basis: &TangentBasis, row: Range<usize>, matrix: &mut Matrix) {
        let row = row.start..row.end.min(self.plain);
        if let (Matrix::Band(band, places), false) = (matrix, row.is_empty()) {
            match places.moved() {
                None => self.parts(basis).write_plain(row.clone(), band.columns_of(row)),
                Some(places) => self.parts(basis).add_placed(row, places, band),
            }
        }
    }

    /// Writes all rows of sites; of long open chains side by side.
    fn write_all(&self, basis: &TangentBasis, matrix: &mut Matrix) {
        let columns = match matrix {
            Matrix::Band(band, places) if self.h.sites() >= LONG && places.moved().is_none() => {
                band.columns_of(0..self.plain)
            }
            _ => return self.write_rows(basis, 0..self.h.sites(), matrix),
        };
        let size = columns.len() / self.plain.max(1);
        let parts = self.parts(basis);
        columns.par_chunks_mut((size * PART).max(1)).enumerate().for_each(|(k, columns)| {
            let first = k * PART;
            parts.write_plain(first..first + columns.len() / size, columns);
        });
    }

    /// Adds all that [`write_rows`](Self::write_rows) has not written, whatever rows it was given.
    pub fn finish(&self, basis: &TangentBasis, matrix: &mut Matrix) {
        self.parts(basis).add_rest(self.plain, matrix);
        far::add(self.h, basis, matrix);
    }

    fn parts<'b>(&'b self, basis: &'b TangentBasis) -> Parts<'b> {
        let blocks = self.own.as_ref().unwrap_or(self.h.constant_blocks());
        Parts { h: self.h, m: self.m, g: self.g, blocks, basis, shift: self.shift }
    }
}

/// Sites in one pass of the kernels.
const ROW: usize = 64;
/// Sites of a long chain that are worth waking a thread for.
const PART: usize = 4096;

/// (ee, fe, ff) of a row of sites.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn diagonals(parts: &Parts, row: Range<usize>, out: &mut [[f64; ROW]; 4]) {
    let n = row.len().min(ROW);
    let [xx, yy, zz, yz, zx, xy] = [0, 1, 2, 3, 4, 5].map(|c: usize| &parts.blocks.site[c][row.clone()][..n]);
    let (m, g) = (parts.m.range(row.clone()), parts.g.range(row.clone()));
    let (e, f) = parts.basis.range(row);
    let [ee, fe, ff, _] = out;
    for i in 0..n {
        let radial = m.x[i] * g.x[i] + m.y[i] * g.y[i] + m.z[i] * g.z[i];
        let stiff = parts.shift - radial;
        let ax = xx[i] * e.x[i] + xy[i] * e.y[i] + zx[i] * e.z[i];
        let ay = xy[i] * e.x[i] + yy[i] * e.y[i] + yz[i] * e.z[i];
        let az = zx[i] * e.x[i] + yz[i] * e.y[i] + zz[i] * e.z[i];
        let bx = xx[i] * f.x[i] + xy[i] * f.y[i] + zx[i] * f.z[i];
        let by = xy[i] * f.x[i] + yy[i] * f.y[i] + yz[i] * f.z[i];
        let bz = zx[i] * f.x[i] + yz[i] * f.y[i] + zz[i] * f.z[i];
        ee[i] = e.x[i] * ax + e.y[i] * ay + e.z[i] * az + stiff;
        fe[i] = f.x[i] * ax + f.y[i] * ay + f.z[i] * az;
        ff[i] = f.x[i] * bx + f.y[i] * by + f.z[i] * bz + stiff;
    }
}

/// The couplings (e e', e f', f e', f f') of a row of sites to their partners' e' and f', n sites on.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn couplings(parts: &Parts, bonds: &Bonds, n: usize, row: Range<usize>, out: &mut [[f64; ROW]; 4]) {
    let length = row.len().min(ROW);
    let ((e, f), (p, q)) = (parts.basis.range(row.clone()), parts.basis.range(row.start + n..row.end + n));
    let j = &bonds.isotropic[row.clone()][..length];
    let [ep, eq, fp, fq] = out;
    for i in 0..length {
        ep[i] = j[i] * (e.x[i] * p.x[i] + e.y[i] * p.y[i] + e.z[i] * p.z[i]);
        eq[i] = j[i] * (e.x[i] * q.x[i] + e.y[i] * q.y[i] + e.z[i] * q.z[i]);
        fp[i] = j[i] * (f.x[i] * p.x[i] + f.y[i] * p.y[i] + f.z[i] * p.z[i]);
        fq[i] = j[i] * (f.x[i] * q.x[i] + f.y[i] * q.y[i] + f.z[i] * q.z[i]);
    }
    if !bonds.rest.is_empty() {
        for (i, block) in bonds.rest[row].iter().enumerate() {
            let (e, f) = (e.get(i), f.get(i));
            let (ap, aq) = (multiply(block, p.get(i)), multiply(block, q.get(i)));
            ep[i] += vector::dot(e, ap);
            eq[i] += vector::dot(e, aq);
            fp[i] += vector::dot(f, ap);
            fq[i] += vector::dot(f, aq);
        }
    }
}

/// What a Hessian is made of.
struct Parts<'a> {
    h: &'a Hamiltonian,
    m: Components<'a>,
    g: Components<'a>,
    blocks: &'a Blocks,
    basis: &'a TangentBasis,
    shift: f64,
}

impl Parts<'_> {
    /// (ee, fe, ff) of a site.
    #[inline(always)]
    fn diagonal(&self, i: usize) -> (f64, f64, f64) {
        let [e, f] = self.basis.pair(i);
        let block = self.blocks.at_site(i);
        let stiff = self.shift - vector::dot(self.m.get(i), self.g.get(i));
        let (ae, af) = (multiply(&block, e), multiply(&block, f));
        (vector::dot(e, ae) + stiff, vector::dot(f, ae), vector::dot(f, af) + stiff)
    }

    /// The couplings of site i to its partner j of a shell: rows (e, f) of j, columns (e, f) of i.
    #[inline(always)]
    fn coupling(&self, bonds: &Bonds, i: usize, j: usize) -> [[f64; 2]; 2] {
        let ([e, f], [p, q]) = (self.basis.pair(i), self.basis.pair(j));
        let (ap, aq) = (bonds.multiply(i, p), bonds.multiply(i, q));
        [[vector::dot(e, ap), vector::dot(f, ap)], [vector::dot(e, aq), vector::dot(f, aq)]]
    }

    /// Writes the columns of sites all of whose later partners come after them in the band, as in a chain, whose family k leads
    /// k + 1 sites on: the entries from the diagonal down, row after row of sites.
    fn write_plain(&self, sites: Range<usize>, columns: &mut [f64]) {
        let mut entries = [[0.0; ROW]; 4];
        let size = columns.len() / sites.len();
        for (first, columns) in sites.clone().step_by(ROW).zip(columns.chunks_mut(size * ROW)) {
            let here = first..sites.end.min(first + ROW);
            diagonals(self, here.clone(), &mut entries);
            let [ee, fe, ff, _] = &entries;
            for (i, pair) in columns.chunks_exact_mut(size).enumerate() {
                let (second, last) = (pair.len() / 2, pair.len() - 1);
                (pair[0], pair[1], pair[second], pair[last]) = (ee[i], fe[i], ff[i], 0.0);
            }
            for (k, bonds) in self.blocks.bond.iter().enumerate() {
                couplings(self, bonds, k + 1, here.clone(), &mut entries);
                let [ee, ef, fe, ff] = &entries;
                for (i, pair) in columns.chunks_exact_mut(size).enumerate() {
                    let second = pair.len() / 2 - 1;
                    (pair[2 * k + 2], pair[second + 2 * k + 2]) = (ee[i], fe[i]);
                    (pair[2 * k + 3], pair[second + 2 * k + 3]) = (ef[i], ff[i]);
                }
            }
        }
    }

    /// Adds what [`write_plain`](Self::write_plain) writes to a band in which the sites stand elsewhere.
    fn add_placed(&self, sites: Range<usize>, places: &[usize], band: &mut Banded) {
        let mut entries = [[0.0; ROW]; 4];
        for first in sites.clone().step_by(ROW) {
            let here = first..sites.end.min(first + ROW);
            diagonals(self, here.clone(), &mut entries);
            let [ee, fe, ff, _] = &entries;
            for (i, place) in places[here.clone()].iter().enumerate() {
                band.add(2 * place, 2 * place, ee[i]);
                band.add(2 * place + 1, 2 * place, fe[i]);
                band.add(2 * place + 1, 2 * place + 1, ff[i]);
            }
            for (k, bonds) in self.blocks.bond.iter().enumerate() {
                couplings(self, bonds, k + 1, here.clone(), &mut entries);
                let [ee, ef, fe, ff] = &entries;
                let pairs = places[here.clone()].iter().zip(&places[here.start + k + 1..]);
                for (i, (place, partner)) in pairs.enumerate() {
                    band.add_block(*partner, *place, [[ee[i], fe[i]], [ef[i], ff[i]]]);
                }
            }
        }
    }

    /// Adds the sites from `first` on and the bonds that start there, wherever their partners are.
    fn add_rest(&self, first: usize, matrix: &mut Matrix) {
        let (sites, h) = (first..self.h.sites(), self.h);
        for i in sites.clone() {
            let (ee, fe, ff) = match h.is_frozen(i) {
                true => (h.stiffness_mev() + self.shift, 0.0, h.stiffness_mev() + self.shift),
                false => self.diagonal(i),
            };
            matrix.add(2 * i, 2 * i, ee);
            matrix.add(2 * i + 1, 2 * i, fe);
            matrix.add(2 * i + 1, 2 * i + 1, ff);
        }
        for bonds in &self.blocks.bond {
            let free = bonds.family.bonds_of(sites.clone()).filter(|[i, j]| !h.is_frozen(*i) && !h.is_frozen(*j));
            for [i, j] in free {
                matrix.add_block(j, i, self.coupling(bonds, i, j));
            }
        }
    }
}
