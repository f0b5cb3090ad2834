//! Views of component-major vector fields: x of all sites, y of all sites, z of all sites.

use crate::geometry::Vector;
use multiversion::multiversion;

/// A vector field, read.
#[derive(Clone, Copy, Debug)]
pub struct Components<'a> {
    /// x components.
    pub x: &'a [f64],
    /// y components.
    pub y: &'a [f64],
    /// z components.
    pub z: &'a [f64],
}

/// A vector field, written.
#[derive(Debug)]
pub struct ComponentsMut<'a> {
    /// x components.
    pub x: &'a mut [f64],
    /// y components.
    pub y: &'a mut [f64],
    /// z components.
    pub z: &'a mut [f64],
}

impl<'a> Components<'a> {
    /// The three thirds of a slab of 3N numbers.
    #[inline]
    pub fn new(slab: &'a [f64]) -> Components<'a> {
        let n = slab.len() / 3;
        let (x, rest) = slab.split_at(n);
        let (y, z) = rest.split_at(n);
        Components { x, y, z }
    }

    /// Number of sites.
    #[inline]
    pub fn sites(&self) -> usize {
        self.x.len()
    }

    /// The sites of `range` alone.
    #[inline]
    pub fn range(&self, range: std::ops::Range<usize>) -> Components<'a> {
        Components { x: &self.x[range.clone()], y: &self.y[range.clone()], z: &self.z[range] }
    }

    /// The vector on site i.
    #[inline]
    pub fn get(&self, i: usize) -> Vector {
        [self.x[i], self.y[i], self.z[i]]
    }
}

impl<'a> ComponentsMut<'a> {
    /// The three thirds of a slab of 3N numbers.
    #[inline]
    pub fn new(slab: &'a mut [f64]) -> ComponentsMut<'a> {
        let n = slab.len() / 3;
        let (x, rest) = slab.split_at_mut(n);
        let (y, z) = rest.split_at_mut(n);
        ComponentsMut { x, y, z }
    }

    /// The sites of `range` alone.
    #[inline]
    pub fn into_range(self, range: std::ops::Range<usize>) -> ComponentsMut<'a> {
        ComponentsMut { x: &mut self.x[range.clone()], y: &mut self.y[range.clone()], z: &mut self.z[range] }
    }

    /// The field, to be read.
    #[inline]
    pub fn as_read(&self) -> Components<'_> {
        Components { x: self.x, y: self.y, z: self.z }
    }

    /// The same field again, for a shorter time.
    #[inline]
    pub fn reborrow(&mut self) -> ComponentsMut<'_> {
        ComponentsMut { x: self.x, y: self.y, z: self.z }
    }

    /// Adds `v` on site i.
    #[inline]
    pub fn add(&mut self, i: usize, v: Vector) {
        self.x[i] += v[0];
        self.y[i] += v[1];
        self.z[i] += v[2];
    }

    /// Sets site i.
    #[inline]
    pub fn set(&mut self, i: usize, v: Vector) {
        self.x[i] = v[0];
        self.y[i] = v[1];
        self.z[i] = v[2];
    }
}

/// Sites handled at a time: what belongs to them stays in the first cache.
pub const TILE: usize = 256;

/// A slab of 3N numbers in pieces of at most [`TILE`] sites: (first site, field) each.
pub fn tiles(slab: &mut [f64]) -> impl Iterator<Item = (usize, ComponentsMut<'_>)> {
    let whole = ComponentsMut::new(slab);
    let parts = whole.x.chunks_mut(TILE).zip(whole.y.chunks_mut(TILE)).zip(whole.z.chunks_mut(TILE));
    parts.enumerate().map(|(k, ((x, y), z))| (k * TILE, ComponentsMut { x, y, z }))
}

/// v ← v − (v·m) m on every site: the part of a field that is tangent to the spheres.
pub fn project(m: &[f64], v: &mut [f64]) {
    project_row(Components::new(m), ComponentsMut::new(v));
}

/// [`project`] on a row of sites.
pub fn project_row(m: Components, v: ComponentsMut) {
    project_slices(m, v.x, v.y, v.z);
}

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn project_slices(m: Components, vx: &mut [f64], vy: &mut [f64], vz: &mut [f64]) {
    let n = m.x.len();
    let (mx, my, mz) = (&m.x[..n], &m.y[..n], &m.z[..n]);
    let (vx, vy, vz) = (&mut vx[..n], &mut vy[..n], &mut vz[..n]);
    for i in 0..n {
        let radial = mx[i] * vx[i] + my[i] * vy[i] + mz[i] * vz[i];
        vx[i] -= radial * mx[i];
        vy[i] -= radial * my[i];
        vz[i] -= radial * mz[i];
    }
}
