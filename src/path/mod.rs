//! A path: a row of spin configurations from an initial to a final state, (image, site, xyz).

use crate::spins::Spins;
use ndarray::Array3;

/// Images along a path. Inside (image, xyz, site), so that an image is one contiguous slab of 3N numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    m: Array3<f64>,
}

impl Path {
    /// From at least two configurations of the same number of sites.
    pub fn new(images: &[Spins]) -> Path {
        let n = images[0].sites();
        let mut m = Array3::zeros((images.len(), 3, n));
        for (k, s) in images.iter().enumerate() {
            m.index_axis_mut(ndarray::Axis(0), k).assign(&s.view());
        }
        Path { m }
    }

    /// Number of images, both ends counted.
    pub fn images(&self) -> usize {
        self.m.dim().0
    }

    /// Number of sites.
    pub fn sites(&self) -> usize {
        self.m.dim().2
    }

    /// Image `k`, component-major.
    pub fn image(&self, k: usize) -> &[f64] {
        let n = 3 * self.sites();
        &self.m.as_slice().expect("standard layout")[k * n..(k + 1) * n]
    }

    /// The spins as (image, site, xyz).
    pub fn to_image_site_xyz(&self) -> Array3<f64> {
        self.m.clone().permuted_axes([0, 2, 1]).as_standard_layout().to_owned()
    }
}
