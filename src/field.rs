//! Views of component-major vector fields: x of all sites, y of all sites, z of all sites.

use crate::geometry::Vector;

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

/// Splits a slab of 3N numbers into pieces of at most `size` sites: (first site, field) each.
pub fn split(slab: &mut [f64], size: usize) -> Vec<(usize, ComponentsMut<'_>)> {
    let whole = ComponentsMut::new(slab);
    let parts = whole.x.chunks_mut(size).zip(whole.y.chunks_mut(size)).zip(whole.z.chunks_mut(size));
    parts.enumerate().map(|(k, ((x, y), z))| (k * size, ComponentsMut { x, y, z })).collect()
}

/// v ← v − (v·m) m on every site: the part of a field that is tangent to the spheres.
pub fn project(m: &[f64], v: &mut [f64]) {
    let m = Components::new(m);
    let n = m.sites();
    let v = ComponentsMut::new(v);
    let (mx, my, mz) = (&m.x[..n], &m.y[..n], &m.z[..n]);
    let (vx, vy, vz) = (&mut v.x[..n], &mut v.y[..n], &mut v.z[..n]);
    for i in 0..n {
        let radial = mx[i] * vx[i] + my[i] * vy[i] + mz[i] * vz[i];
        vx[i] -= radial * mx[i];
        vy[i] -= radial * my[i];
        vz[i] -= radial * mz[i];
    }
}
