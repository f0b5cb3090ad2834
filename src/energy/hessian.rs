//! The Riemannian Hessian in orthonormal tangent coordinates.
//!
//! ```text
//! H = Uᵀ A U − diag(m_i·g_i) ⊗ 1₂        A = ∂²E/∂m∂m, g = ∂E/∂m, U the 3N × 2N matrix of tangent bases
//! ```
//! (Absil, Mahony, Trumpf, LNCS 8085, 361 (2013), doi:10.1007/978-3-642-40020-9_39.) Unknown 2i + a is the component of site i
//! along its basis vector a. A row of sites whose bonds reach over r shells has a band, of half-bandwidth 2r + 1 if it is open and
//! 4r + 1 if it is closed and folded; other lattices have blocks of coupled sites, see
//! [`Lattice::layout`](crate::lattice::Lattice::layout). What a long-ranged term adds is in [`far`].

use super::blocks::{Blocks, Bonds, multiply};
use super::hamiltonian::LONG;
use super::{Hamiltonian, far};
use crate::field::{Components, ComponentsMut, tiles};
use crate::geometry::{Vector, tangent_basis, vector};
use crate::linalg::{Banded, Layout, Matrix};
use multiversion::multiversion;
use rayon::prelude::*;
use std::ops::Range;

/// Two orthonormal tangent vectors a site, each as a component-major field.
#[derive(Clone, Debug, Default)]
pub struct TangentBasis {
    first: Vec<f64>,
    second: Vec<f64>,
}

/// The basis on a tile of sites ([`crate::field::TILE`]).
#[derive(Debug)]
pub struct BasisTile<'a> {
    e: ComponentsMut<'a>,
    f: ComponentsMut<'a>,
}

impl BasisTile<'_> {
    /// Makes it the basis at the spins `m`.
    pub fn set(&mut self, m: Components) {
        let (e, f) = (&mut self.e, &mut self.f);
        write_basis(m, e.x, e.y, e.z, f.x, f.y, f.z);
    }

    /// Tangent coordinates of a vector field.
    pub fn write_coordinates(&self, v: Components, t: &mut [f64]) {
        write_coordinates(self.e.as_read(), self.f.as_read(), v, t);
    }
}

impl TangentBasis {
    /// The basis at a configuration.
    pub fn at(m: &[f64]) -> TangentBasis {
        let mut basis = TangentBasis::default();
        basis.set(m);
        basis
    }

    /// Makes it the basis at `m`, in the memory it has.
    pub fn set(&mut self, m: &[f64]) {
        self.resize(m.len() / 3);
        self.set_row(0..m.len() / 3, m);
    }

    /// Makes it a basis of so many sites, all rows of which are to be set.
    pub fn resize(&mut self, sites: usize) {
        self.first.resize(3 * sites, 0.0);
        self.second.resize(3 * sites, 0.0);
    }

    /// Makes it the basis at `m` on a row of sites.
    pub fn set_row(&mut self, row: Range<usize>, m: &[f64]) {
        let e = ComponentsMut::new(&mut self.first).into_range(row.clone());
        let f = ComponentsMut::new(&mut self.second).into_range(row.clone());
        write_basis(Components::new(m).range(row), e.x, e.y, e.z, f.x, f.y, f.z);
    }

    /// It in tiles, to be set one by one.
    pub fn tiles(&mut self) -> impl Iterator<Item = BasisTile<'_>> {
        tiles(&mut self.first).zip(tiles(&mut self.second)).map(|((_, e), (_, f))| BasisTile { e, f })
    }

    /// The two vectors at site i.
    #[inline(always)]
    pub fn pair(&self, i: usize) -> [Vector; 2] {
        let n = self.first.len() / 3;
        let vector = |slab: &[f64]| [slab[i], slab[n + i], slab[2 * n + i]];
        [vector(&self.first), vector(&self.second)]
    }

    /// The two fields on a row of sites.
    #[inline(always)]
    fn range(&self, row: Range<usize>) -> (Components<'_>, Components<'_>) {
        (Components::new(&self.first).range(row.clone()), Components::new(&self.second).range(row))
    }

    /// Tangent coordinates (2N) of a vector field (3N).
    pub fn coordinates(&self, v: &[f64]) -> Vec<f64> {
        let mut t = Vec::new();
        self.write_coordinates(v, &mut t);
        t
    }

    /// [`coordinates`](Self::coordinates) into the memory of `t`.
    pub fn write_coordinates(&self, v: &[f64], t: &mut Vec<f64>) {
        t.resize(2 * v.len() / 3, 0.0);
        write_coordinates(Components::new(&self.first), Components::new(&self.second), Components::new(v), t);
    }

    /// Tangent coordinates of a vector field on a row of sites alone.
    pub fn write_row_coordinates(&self, row: Range<usize>, v: Components, t: &mut [f64]) {
        let (e, f) = self.range(row);
        write_coordinates(e, f, v, t);
    }

    /// Tangent coordinates of u + s v on a row of sites alone.
    pub fn write_row_sum(&self, row: Range<usize>, u: Components, s: f64, v: Components, t: &mut [f64]) {
        let (e, f) = self.range(row);
        write_sum(e, f, u, s, v, t);
    }

    /// On a row of sites alone, the tangent coordinates of a vector field and of a rotation about `axis`, side by side.
    pub fn write_row_pair(&self, row: Range<usize>, v: Components, axis: Vector, both: &mut [f64]) {
        let (e, f) = self.range(row);
        write_pair(e, f, v, axis, both);
    }

    /// Writes the vector field of tangent coordinates on a row of sites alone.
    pub fn row_field(&self, row: Range<usize>, t: &[f64], v: ComponentsMut) {
        let (e, f) = self.range(row);
        write_component(t, e.x, f.x, v.x);
        write_component(t, e.y, f.y, v.y);
        write_component(t, e.z, f.z, v.z);
    }

    /// Tangent coordinates (2N) of a rotation of all spins about `axis`: a direction in which the energy does not change,
    /// where the axis is one of symmetry.
    pub fn rotation(&self, axis: Vector) -> Vec<f64> {
        let mut t = Vec::new();
        self.write_rotation(axis, &mut t);
        t
    }

    /// [`rotation`](Self::rotation) into the memory of `t`: of axis × m, whose coordinates are axis·f and −axis·e.
    pub fn write_rotation(&self, axis: Vector, t: &mut Vec<f64>) {
        t.resize(2 * self.first.len() / 3, 0.0);
        write_rotation(axis, Components::new(&self.first), Components::new(&self.second), t);
    }

    /// Writes the vector field (3N) of tangent coordinates (2N).
    pub fn field(&self, t: &[f64], v: &mut [f64]) {
        self.row_field(0..v.len() / 3, t, ComponentsMut::new(v));
    }
}

#[multiversion(targets("x86_64+avx2"))]
fn write_basis(
    m: Components,
    ex: &mut [f64],
    ey: &mut [f64],
    ez: &mut [f64],
    fx: &mut [f64],
    fy: &mut [f64],
    fz: &mut [f64],
) {
    let n = m.x.len();
    let (x, y, z) = (&m.x[..n], &m.y[..n], &m.z[..n]);
    let (ex, ey, ez) = (&mut ex[..n], &mut ey[..n], &mut ez[..n]);
    let (fx, fy, fz) = (&mut fx[..n], &mut fy[..n], &mut fz[..n]);
    for i in 0..n {
        let (e, f) = tangent_basis([x[i], y[i], z[i]]);
        (ex[i], ey[i], ez[i]) = (e[0], e[1], e[2]);
        (fx[i], fy[i], fz[i]) = (f[0], f[1], f[2]);
    }
}

#[multiversion(targets("x86_64+avx2"))]
fn write_coordinates(e: Components, f: Components, v: Components, t: &mut [f64]) {
    let n = v.x.len();
    let (vx, vy, vz) = (&v.x[..n], &v.y[..n], &v.z[..n]);
    let (ex, ey, ez) = (&e.x[..n], &e.y[..n], &e.z[..n]);
    let (fx, fy, fz) = (&f.x[..n], &f.y[..n], &f.z[..n]);
    let t = &mut t[..2 * n];
    for i in 0..n {
        t[2 * i] = ex[i] * vx[i] + ey[i] * vy[i] + ez[i] * vz[i];
        t[2 * i + 1] = fx[i] * vx[i] + fy[i] * vy[i] + fz[i] * vz[i];
    }
}

#[multiversion(targets("x86_64+avx2"))]
fn write_sum(e: Components, f: Components, u: Components, s: f64, v: Components, t: &mut [f64]) {
    let n = v.x.len();
    let (ux, uy, uz) = (&u.x[..n], &u.y[..n], &u.z[..n]);
    let (vx, vy, vz) = (&v.x[..n], &v.y[..n], &v.z[..n]);
    let (ex, ey, ez) = (&e.x[..n], &e.y[..n], &e.z[..n]);
    let (fx, fy, fz) = (&f.x[..n], &f.y[..n], &f.z[..n]);
    let t = &mut t[..2 * n];
    for i in 0..n {
        let (x, y, z) = (ux[i] + s * vx[i], uy[i] + s * vy[i], uz[i] + s * vz[i]);
        t[2 * i] = ex[i] * x + ey[i] * y + ez[i] * z;
        t[2 * i + 1] = fx[i] * x + fy[i] * y + fz[i] * z;
    }
}

#[multiversion(targets("x86_64+avx2"))]
fn write_pair(e: Components, f: Components, v: Components, axis: Vector, both: &mut [f64]) {
    let n = v.x.len();
    let (vx, vy, vz) = (&v.x[..n], &v.y[..n], &v.z[..n]);
    let (ex, ey, ez) = (&e.x[..n], &e.y[..n], &e.z[..n]);
    let (fx, fy, fz) = (&f.x[..n], &f.y[..n], &f.z[..n]);
    let both = &mut both[..4 * n];
    for i in 0..n {
        both[4 * i] = ex[i] * vx[i] + ey[i] * vy[i] + ez[i] * vz[i];
        both[4 * i + 1] = axis[0] * fx[i] + axis[1] * fy[i] + axis[2] * fz[i];
        both[4 * i + 2] = fx[i] * vx[i] + fy[i] * vy[i] + fz[i] * vz[i];
        both[4 * i + 3] = -(axis[0] * ex[i] + axis[1] * ey[i] + axis[2] * ez[i]);
    }
}

#[multiversion(targets("x86_64+avx2"))]
fn write_rotation(axis: Vector, e: Components, f: Components, t: &mut [f64]) {
    let n = e.x.len();
    let (ex, ey, ez) = (&e.x[..n], &e.y[..n], &e.z[..n]);
    let (fx, fy, fz) = (&f.x[..n], &f.y[..n], &f.z[..n]);
    let t = &mut t[..2 * n];
    for i in 0..n {
        t[2 * i] = axis[0] * fx[i] + axis[1] * fy[i] + axis[2] * fz[i];
        t[2 * i + 1] = -(axis[0] * ex[i] + axis[1] * ey[i] + axis[2] * ez[i]);
    }
}

#[multiversion(targets("x86_64+avx2"))]
fn write_component(t: &[f64], e: &[f64], f: &[f64], v: &mut [f64]) {
    let n = v.len();
    let (t, e, f) = (&t[..2 * n], &e[..n], &f[..n]);
    for i in 0..n {
        v[i] = t[2 * i] * e[i] + t[2 * i + 1] * f[i];
    }
}

/// The Riemannian Hessian at `m`, where the Euclidean gradient is `g`. A frozen site has a stiff diagonal and no couplings.
pub fn assemble(h: &Hamiltonian, m: &[f64], g: &[f64], basis: &TangentBasis) -> Matrix {
    let mut matrix = Matrix::default();
    assemble_into(h, m, g, basis, 0.0, &mut matrix);
    matrix
}

/// [`assemble`] of H + shift·1 into the memory of `matrix`.
pub fn assemble_into(h: &Hamiltonian, m: &[f64], g: &[f64], basis: &TangentBasis, shift: f64, matrix: &mut Matrix) {
    fill(h, m, g, basis, shift, true, matrix);
}

/// [`assemble_into`], quicker: what a long-ranged term does to distant sites is there to six digits only, enough
/// to steer.
pub fn assemble_shifted(h: &Hamiltonian, m: &[f64], g: &[f64], basis: &TangentBasis, shift: f64, matrix: &mut Matrix) {
    fill(h, m, g, basis, shift, false, matrix);
}

fn fill(h: &Hamiltonian, m: &[f64], g: &[f64], basis: &TangentBasis, shift: f64, precise: bool, matrix: &mut Matrix) {
    let assembly = Assembly::begin(h, m, g, shift, precise, matrix);
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
    precise: bool,
    /// So many sites have the partners of their own bonds so many sites on as the shell tells, in a row.
    plain: usize,
}

impl<'a> Assembly<'a> {
    /// Gives `matrix` its shape; all rows are to be written then, and at the end [`finish`](Self::finish)ed.
    pub fn begin(
        h: &'a Hamiltonian,
        m: &'a [f64],
        g: &'a [f64],
        shift: f64,
        precise: bool,
        matrix: &mut Matrix,
    ) -> Assembly<'a> {
        let dense = h.long_range().is_some_and(|long| long.exponentials(precise).is_none());
        let layout = if dense { &Layout::Dense } else { h.layout() };
        let plain = match layout {
            Layout::Band { .. } if !h.has_frozen() => h.sites().saturating_sub(h.reach()),
            _ => 0,
        };
        matrix.reset(layout, h.sites(), plain);
        let own = h.varying_blocks(Components::new(m));
        Assembly { h, m: Components::new(m), g: Components::new(g), own, shift, precise, plain }
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
        if let Some(long) = self.h.long_range() {
            far::add(self.h, long, basis, self.precise, matrix);
        }
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
#[multiversion(targets("x86_64+avx2"))]
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
#[multiversion(targets("x86_64+avx2"))]
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
