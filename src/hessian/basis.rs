//! Orthonormal bases of the tangent planes, and coordinates in them.

use crate::field::{Components, ComponentsMut, tiles};
use crate::geometry::{Vector, tangent_basis};
use multiversion::multiversion;
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
    pub(super) fn range(&self, row: Range<usize>) -> (Components<'_>, Components<'_>) {
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

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
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

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
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

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
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

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
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

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
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

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn write_component(t: &[f64], e: &[f64], f: &[f64], v: &mut [f64]) {
    let n = v.len();
    let (t, e, f) = (&t[..2 * n], &e[..n], &f[..n]);
    for i in 0..n {
        v[i] = t[2 * i] * e[i] + t[2 * i + 1] * f[i];
    }
}
