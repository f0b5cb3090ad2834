//! Shapes in space that choose sites. Boundaries belong to the shape; a coordinate left out is unbounded.
//!
//! Numbers count lattice constants (cells of a grid by their own edges), strings carry a unit. In a chain x is the number of the
//! site.

use super::{Lattice, Picture};
use crate::error::{Error, Result};
use crate::geometry::{Vector, vector};
use crate::units::{Extent, Place};
use schemars::JsonSchema;
use serde::Deserialize;

/// A boundary is this wide (lattice constants), so that a site on it is inside whatever the rounding of its place is.
const ON_IT: f64 = 1e-9;

/// `{"disc": {"radius": 8}}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// Between two corners.
    Box(Corners),
    /// Within a distance, of any z.
    Disc(Disc),
    /// Within an ellipse of any z, or an ellipsoid.
    Ellipse(Ellipse),
    /// Inside a polygon, of any z.
    Polygon(Vec<[Extent; 2]>),
    /// Between two distances, of any z.
    Ring(Ring),
    /// The dark pixels of an image laid over all sites, of any z.
    Image(Picture),
    /// In all of these.
    All(Vec<Shape>),
    /// In any of these.
    Any(Vec<Shape>),
    /// Not in this.
    Not(Box<Shape>),
}

/// Two opposite corners, `[x]`, `[x, y]` or `[x, y, z]` each.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Corners {
    /// The one of least coordinates.
    pub from: Vec<Extent>,
    /// The one of greatest coordinates.
    pub to: Vec<Extent>,
}

/// A centre and a radius.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Disc {
    /// The middle of the box of all sites if not given.
    #[serde(default)]
    pub center: Option<Place>,
    /// Largest distance.
    pub radius: Extent,
}

/// A centre and semi-axes along x, y and z.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ellipse {
    /// The middle of the box of all sites if not given.
    #[serde(default)]
    pub center: Option<Place>,
    /// Two, or three of an ellipsoid.
    pub semi_axes: Vec<Extent>,
}

/// A centre and two radii.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ring {
    /// The middle of the box of all sites if not given.
    #[serde(default)]
    pub center: Option<Place>,
    /// Least distance.
    pub inner: Extent,
    /// Largest distance.
    pub outer: Extent,
}

impl Shape {
    /// Which sites of a lattice are inside.
    pub fn inside(&self, lattice: &Lattice) -> Result<Vec<bool>> {
        let within = |e: Error, key: &str| e.within(key);
        match self {
            Shape::Box(corners) => corners.inside(lattice).map_err(|e| within(e, "box")),
            Shape::Disc(disc) => disc.inside(lattice).map_err(|e| within(e, "disc")),
            Shape::Ellipse(ellipse) => ellipse.inside(lattice).map_err(|e| within(e, "ellipse")),
            Shape::Polygon(corners) => polygon(corners, lattice).map_err(|e| within(e, "polygon")),
            Shape::Ring(ring) => ring.inside(lattice).map_err(|e| within(e, "ring")),
            Shape::Image(picture) => {
                let places = (0..lattice.sites).map(|i| lattice.shape_place(i));
                picture.inside(lattice, places).map_err(|e| within(e, "image"))
            }
            Shape::All(shapes) => folded(shapes, lattice, true, |a, b| a && b).map_err(|e| within(e, "all")),
            Shape::Any(shapes) => folded(shapes, lattice, false, |a, b| a || b).map_err(|e| within(e, "any")),
            Shape::Not(shape) => {
                let inside = shape.inside(lattice).map_err(|e| within(e, "not"))?;
                Ok(inside.into_iter().map(|inside| !inside).collect())
            }
        }
    }
}

/// Several shapes, taken together.
fn folded(shapes: &[Shape], lattice: &Lattice, start: bool, both: fn(bool, bool) -> bool) -> Result<Vec<bool>> {
    if shapes.is_empty() {
        return Err(Error::invalid("", "the list is empty: give the shapes that it is made of"));
    }
    shapes.iter().enumerate().try_fold(vec![start; lattice.sites], |so_far, (k, shape)| {
        let inside = shape.inside(lattice).map_err(|e| e.within(&format!("[{k}]")))?;
        Ok(so_far.into_iter().zip(inside).map(|(a, b)| both(a, b)).collect())
    })
}

/// The sites of which this holds, by their places in lattice constants.
fn chosen(lattice: &Lattice, inside: impl Fn(Vector) -> bool) -> Vec<bool> {
    (0..lattice.sites).map(|i| inside(lattice.shape_place(i))).collect()
}

fn center(given: &Option<Place>, lattice: &Lattice) -> Result<Vector> {
    match given {
        Some(place) => lattice.point(place).map_err(|e| e.within("center")),
        None if lattice.is_row() => Ok([0.5 * (lattice.sites - 1) as f64, 0.0, 0.0]),
        None => Ok(lattice.middle()),
    }
}

/// A length above 0, in lattice constants.
fn length(extent: Extent, lattice: &Lattice, key: &str) -> Result<f64> {
    let length = lattice.spacings(extent).map_err(|e| e.within(key))?;
    match length > 0.0 {
        true => Ok(length),
        false => Err(Error::invalid(key, format!("found {extent}, but a length is greater than 0"))),
    }
}

impl Corners {
    fn inside(&self, lattice: &Lattice) -> Result<Vec<bool>> {
        let (mut low, mut high) = ([f64::NEG_INFINITY; 3], [f64::INFINITY; 3]);
        for (key, list, bounds) in [("from", &self.from, &mut low), ("to", &self.to, &mut high)] {
            if list.is_empty() || list.len() > 3 {
                let message = format!("found {} coordinates, but a corner is [x], [x, y] or [x, y, z]", list.len());
                return Err(Error::invalid(key, message));
            }
            for (c, extent) in list.iter().enumerate() {
                bounds[c] = lattice.coordinate_along(c, *extent).map_err(|e| e.within(&format!("{key}[{c}]")))?;
            }
        }
        if let Some(c) = (0..3).find(|c| low[*c] > high[*c]) {
            let axis = ["x", "y", "z"][c];
            return Err(Error::invalid("from", format!("{axis} is larger than in \"to\": exchange the two")));
        }
        Ok(chosen(lattice, |p| (0..3).all(|c| low[c] - ON_IT <= p[c] && p[c] <= high[c] + ON_IT)))
    }
}

impl Disc {
    fn inside(&self, lattice: &Lattice) -> Result<Vec<bool>> {
        let (center, radius) = (center(&self.center, lattice)?, length(self.radius, lattice, "radius")?);
        Ok(chosen(lattice, |p| beside(p, center) <= radius + ON_IT))
    }
}

/// Distance in the plane.
fn beside(p: Vector, q: Vector) -> f64 {
    let d = vector::sub(p, q);
    vector::norm([d[0], d[1], 0.0])
}

impl Ellipse {
    fn inside(&self, lattice: &Lattice) -> Result<Vec<bool>> {
        let center = center(&self.center, lattice)?;
        if !(2..=3).contains(&self.semi_axes.len()) {
            let message =
                format!("found {} semi-axes, but there are two, or three of an ellipsoid", self.semi_axes.len());
            return Err(Error::invalid("semi_axes", message));
        }
        let axis = |(k, extent): (usize, &Extent)| length(*extent, lattice, &format!("semi_axes[{k}]"));
        let axes: Vec<f64> = self.semi_axes.iter().enumerate().map(axis).collect::<Result<_>>()?;
        Ok(chosen(lattice, |p| {
            let parts = axes.iter().enumerate().map(|(c, a)| (p[c] - center[c]) / a);
            parts.map(|x| x * x).sum::<f64>() <= 1.0 + ON_IT
        }))
    }
}

impl Ring {
    fn inside(&self, lattice: &Lattice) -> Result<Vec<bool>> {
        let center = center(&self.center, lattice)?;
        let [inner, outer] = [length(self.inner, lattice, "inner")?, length(self.outer, lattice, "outer")?];
        if inner > outer {
            return Err(Error::invalid("inner", "the inner radius is larger than the outer one: exchange the two"));
        }
        Ok(chosen(lattice, |p| (inner - ON_IT..=outer + ON_IT).contains(&beside(p, center))))
    }
}

/// Inside or on the edges of a polygon whose last corner is joined with the first, by the parity of the edges to the right.
fn polygon(corners: &[[Extent; 2]], lattice: &Lattice) -> Result<Vec<bool>> {
    if corners.len() < 3 {
        return Err(Error::invalid("", format!("found {} corners, but a polygon has at least 3", corners.len())));
    }
    let corner = |(k, corner): (usize, &[Extent; 2])| -> Result<[f64; 2]> {
        let at = |c: usize| lattice.coordinate_along(c, corner[c]).map_err(|e| e.within(&format!("[{k}][{c}]")));
        Ok([at(0)?, at(1)?])
    };
    let corners: Vec<[f64; 2]> = corners.iter().enumerate().map(corner).collect::<Result<_>>()?;
    let edges = || (0..corners.len()).map(|k| [corners[k], corners[(k + 1) % corners.len()]]);
    let on = |p: Vector, [[x, y], [u, v]]: [[f64; 2]; 2]| {
        let (along, to) = ([u - x, v - y, 0.0], [p[0] - x, p[1] - y, 0.0]);
        let squared = vector::dot(along, along);
        let part = if squared > 0.0 { (vector::dot(along, to) / squared).clamp(0.0, 1.0) } else { 0.0 };
        vector::norm(vector::sub(to, vector::scale(part, along))) <= ON_IT
    };
    let crossed = |p: Vector, [[x, y], [u, v]]: [[f64; 2]; 2]| {
        (y > p[1]) != (v > p[1]) && p[0] < x + (p[1] - y) * (u - x) / (v - y)
    };
    Ok(chosen(lattice, |p| {
        edges().any(|edge| on(p, edge)) || edges().filter(|edge| crossed(p, *edge)).count() % 2 == 1
    }))
}

impl Lattice {
    /// Where shapes see site i (lattice constants); in a chain its number, along x.
    fn shape_place(&self, i: usize) -> Vector {
        if self.is_row() { [i as f64, 0.0, 0.0] } else { self.place(i) }
    }

    /// The lattice without the sites outside a shape.
    pub(super) fn cut(mut self, shape: Option<&Shape>) -> Result<Lattice> {
        let Some(shape) = shape else { return Ok(self) };
        let inside = shape.inside(&self).map_err(|e| e.within("shape"))?;
        if !inside.contains(&true) {
            return Err(Error::invalid("shape", "no site of the lattice is inside: no spin is left"));
        }
        self.moments_mub =
            self.moments_mub.into_iter().zip(&inside).filter(|(_, inside)| **inside).map(|(m, _)| m).collect();
        self.sites = self.moments_mub.len();
        self.vacant = vec![false; self.sites];
        self.slots = super::Slots::taken(&inside);
        Ok(self)
    }
}

#[cfg(test)]
mod tests {
    use crate::lattice::{Lattice, LatticeSpec};

    fn cut(shape: &str) -> Result<Lattice, String> {
        let text = format!(r#"{{"square": {{"cells": [9, 7], "spacing": "0.5 nm", "shape": {shape}}}}}"#);
        let spec: LatticeSpec = serde_json::from_str(&text).map_err(|e| e.to_string())?;
        spec.resolve().map_err(|e| e.to_string())
    }

    #[test]
    fn a_shape_leaves_the_sites_that_it_holds_with_its_boundary() {
        for (shape, sites) in [
            (r#"{"box": {"from": [2, 1], "to": [4, "1 nm"]}}"#, 6),
            (r#"{"box": {"from": [2], "to": [4]}}"#, 21),
            (r#"{"disc": {"radius": 2}}"#, 13),
            (r#"{"disc": {"center": [0, 0], "radius": "1 nm"}}"#, 6),
            (r#"{"ellipse": {"semi_axes": [4, 1]}}"#, 11),
            (r#"{"ring": {"inner": 1, "outer": 2}}"#, 12),
            (r#"{"polygon": [[0, 0], [4, 0], [0, 4]]}"#, 15),
            (r#"{"all": [{"disc": {"radius": 2}}, {"not": {"disc": {"radius": 1}}}]}"#, 8),
            (r#"{"any": [{"box": {"from": [0, 0], "to": [0, 0]}}, {"box": {"from": [8], "to": [8]}}]}"#, 8),
        ] {
            assert_eq!(cut(shape).unwrap().sites, sites, "{shape}");
        }
    }

    /// A data URL of an image of so many columns; 0 is black.
    fn image(columns: u32, grey: &[u8]) -> String {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, columns, grey.len() as u32 / columns);
        encoder.set_color(png::ColorType::Grayscale);
        encoder.write_header().unwrap().write_image_data(grey).unwrap();
        format!(r#"{{"image": {{"path": "data:image/png;base64,{}"}}}}"#, crate::base64::base64(&bytes))
    }

    #[test]
    fn the_dark_pixels_of_an_image_are_inside_its_top_row_at_the_greatest_y() {
        // a pixel a site: two sites of the top row, one of the bottom one
        let mut one = vec![255; 63];
        (one[0], one[8], one[54]) = (0, 100, 127);
        let lattice = cut(&image(9, &one)).unwrap();
        let found: Vec<_> = (0..lattice.sites).map(|i| lattice.cell(i).1).collect();
        assert_eq!(found, [[0, 0, 0], [0, 6, 0], [8, 6, 0]]);
        // four pixels for all: the lower right quarter, with the sites in the middle
        let quarter = cut(&image(2, &[255, 255, 255, 0])).unwrap();
        assert_eq!(quarter.sites, 5 * 4, "{:?}", (0..quarter.sites).map(|i| quarter.cell(i).1).collect::<Vec<_>>());
        assert!(cut(&image(1, &[255])).unwrap_err().contains("square.shape: no site"));
        for (path, said) in [
            ("mask.png", "square.shape.image.path: an image is read where"),
            ("data:image/png;base64,AAAA", "cannot be read"),
        ] {
            let found = cut(&format!(r#"{{"image": {{"path": "{path}"}}}}"#)).unwrap_err();
            assert!(found.contains(said), "{found}");
        }
    }

    #[test]
    fn shapes_that_cannot_be_are_refused_with_their_place() {
        for (shape, said) in [
            (r#"{"disc": {"radius": -2}}"#, "square.shape.disc.radius: found -2"),
            (r#"{"disc": {"center": [90, 0], "radius": 2}}"#, "square.shape: no site"),
            (r#"{"box": {"from": [3, 0], "to": [2, 0]}}"#, "square.shape.box.from: x is larger"),
            (r#"{"any": []}"#, "square.shape.any: the list is empty"),
            (r#"{"not": {"polygon": [[0, 0], [1, 1]]}}"#, "square.shape.not.polygon: found 2 corners"),
            (r#"{"ring": {"inner": 3, "outer": 2}}"#, "square.shape.ring.inner"),
            (r#"{"disk": {"radius": 2}}"#, "unknown variant"),
        ] {
            let found = cut(shape).unwrap_err();
            assert!(found.contains(said), "{shape}: {found}");
        }
    }
}
