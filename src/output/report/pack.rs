//! Numbers in a page: columns as 32-bit floats, spins as two small integers each.
//!
//! A unit vector is a point of an octahedron, |x| + |y| + |z| = 1, unfolded on a square (Z. H. Cigolle and others, Journal of
//! Computer Graphics Techniques 3 (2), 2014); its two coordinates are whole multiples of 1/[`SCALE`], which keeps a direction to
//! 3e-4 rad. From image to image only the steps are kept, as zigzag numbers (0, −1, 1, −2, …), the low bytes of all and then the high
//! ones, compressed by zlib: most spins of a path stand still most of the time.

use crate::base64::base64;
use crate::error::{Error, Result};
use crate::geometry::Vector;
use crate::path::Path;
use flate2::{Compression, write::ZlibEncoder};
use std::io::Write;

/// Steps from the middle of the square to its edge.
pub(super) const SCALE: f64 = 8191.0;

/// Numbers in base64, four bytes each, low byte first. An error where one is not finite.
pub(super) fn column(name: &str, values: impl Iterator<Item = f64>) -> Result<String> {
    let mut bytes = Vec::new();
    for (k, v) in values.enumerate() {
        let short = v as f32;
        if !short.is_finite() {
            return Err(Error::Numerical(format!("report.html: {name}, row {}: {v} is not a finite number", k + 1)));
        }
        bytes.extend(short.to_le_bytes());
    }
    Ok(base64(&bytes))
}

/// The spins of these images and sites.
pub(super) fn packed(path: &Path, images: &[usize], sites: &[usize]) -> Result<String> {
    let (mut low, mut high) = (Vec::new(), Vec::new());
    let mut before = vec![[0i32; 2]; sites.len()];
    let n = path.sites();
    for &k in images {
        let m = path.image(k);
        for (&i, old) in sites.iter().zip(&mut before) {
            let new = octahedral([m[i], m[n + i], m[2 * n + i]]);
            for (new, old) in new.iter().zip(old.iter_mut()) {
                let step = new - *old;
                let [first, second, ..] = ((step << 1) ^ (step >> 31)).to_le_bytes();
                low.push(first);
                high.push(second);
                *old = *new;
            }
        }
    }
    let compressed = || {
        let mut zlib = ZlibEncoder::new(Vec::new(), Compression::best());
        zlib.write_all(&low)?;
        zlib.write_all(&high)?;
        zlib.finish()
    };
    compressed().map(|bytes| base64(&bytes)).map_err(|e| Error::Numerical(format!("report.html: {e}")))
}

/// A unit vector as a point of the square, in steps of 1/[`SCALE`].
fn octahedral([x, y, z]: Vector) -> [i32; 2] {
    let size = x.abs() + y.abs() + z.abs();
    let (u, v) = (x / size, y / size);
    let fold = |a: f64, b: f64| (1.0 - b.abs()).copysign(a);
    let (u, v) = if z < 0.0 { (fold(u, v), fold(v, u)) } else { (u, v) };
    [u, v].map(|c| (c * SCALE).round() as i32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{angle, vector::unit};
    use crate::spins::Spins;
    use std::io::Read;

    /// Undoes [`octahedral`], as the page does.
    fn unfolded([u, v]: [i32; 2]) -> Vector {
        let (u, v) = (f64::from(u) / SCALE, f64::from(v) / SCALE);
        let z = 1.0 - u.abs() - v.abs();
        let sign = |a: f64| if a < 0.0 { -1.0 } else { 1.0 };
        let (x, y) = if z < 0.0 { ((1.0 - v.abs()) * sign(u), (1.0 - u.abs()) * sign(v)) } else { (u, v) };
        unit([x, y, z]).unwrap()
    }

    fn bytes(text: &str) -> Vec<u8> {
        crate::base64::bytes(text).unwrap()
    }

    fn vectors(count: usize, phase: f64) -> Vec<Vector> {
        let spiral = |k: usize| {
            let (z, phi) = (1.0 - 2.0 * k as f64 / (count - 1) as f64, 2.4 * k as f64 + phase);
            let across = (1.0 - z * z).max(0.0).sqrt();
            [across * libm::cos(phi), across * libm::sin(phi), z]
        };
        (0..count).map(spiral).collect()
    }

    #[test]
    fn a_direction_is_kept_to_3e4_rad_and_an_axis_exactly() {
        for m in vectors(5000, 0.0) {
            assert!(angle(m, unfolded(octahedral(m))) < 3e-4, "{m:?}");
        }
        for m in [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [-0.0, -0.0, -1.0]] {
            assert!(angle(m, unfolded(octahedral(m))) == 0.0, "{m:?}");
        }
    }

    #[test]
    fn spins_that_are_packed_are_found_again() {
        let images: Vec<Vec<Vector>> = (0..9).map(|k| vectors(40, 0.7 * f64::from(k))).collect();
        let path = Path::new(&images.iter().map(|m| Spins::from_vectors(m).unwrap()).collect::<Vec<_>>());
        let (shown_images, shown_sites) = (vec![0, 3, 8], vec![0, 5, 6, 39]);
        let packed = bytes(&packed(&path, &shown_images, &shown_sites).unwrap());
        let mut plain = Vec::new();
        flate2::read::ZlibDecoder::new(&packed[..]).read_to_end(&mut plain).unwrap();
        let (low, high) = plain.split_at(plain.len() / 2);
        assert_eq!(low.len(), 2 * shown_images.len() * shown_sites.len());
        let mut now = vec![0i32; 2 * shown_sites.len()];
        let mut at = 0;
        for k in shown_images {
            for value in &mut now {
                let zigzag = i32::from(low[at]) | i32::from(high[at]) << 8;
                *value += (zigzag >> 1) ^ -(zigzag & 1);
                at += 1;
            }
            for (j, i) in shown_sites.iter().enumerate() {
                assert!(angle(images[k][*i], unfolded([now[2 * j], now[2 * j + 1]])) < 3e-4, "image {k}, site {i}");
            }
        }
    }

    #[test]
    fn columns_are_32_bit_floats_and_what_is_not_finite_has_a_place() {
        let values = [0.0, -1.5, 6.297777507, 1e-30];
        let found: Vec<f32> = bytes(&column("e", values.into_iter()).unwrap())
            .chunks(4)
            .map(|c| f32::from_le_bytes([c[0], c[1], c[2], c[3]]))
            .collect();
        assert_eq!(found, values.map(|v| v as f32));
        let error = column("e", [0.0, f64::NAN].into_iter()).unwrap_err().to_string();
        assert_eq!(error, "report.html: e, row 2: NaN is not a finite number");
    }
}
