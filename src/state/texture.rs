//! Spins around a line: what skyrmions and vortices have in common.
//!
//! ```text
//! m = cos θ(r) c + sin θ(r) (cos vφ t + sin vφ k × t)        (r, φ) polar coordinates about the line, along z
//! ```
//! c is the direction of the core, v the vorticity, k the direction along ±c that is not below the plane, and t, where the spins of
//! φ = 0 point, is x turned about k by the helicity (x and y tilted with k, where k is not z).

use super::StateContext;
use super::sense::Sense;
use crate::error::{Error, Result};
use crate::geometry::{Direction, Quaternion, Vector, vector};
use crate::lattice::Lattice;
use crate::units::{self, Angle};
use serde::de::{self, Deserialize, Deserializer, IntoDeserializer, Visitor};
use std::fmt;

/// A site stands on the line if it is no further away (spacings).
const ON_THE_LINE: f64 = 1e-9;

/// A texture but for θ(r).
pub(super) struct Texture<'a> {
    pub(super) center: Option<&'a units::Place>,
    pub(super) core: Vector,
    pub(super) helicity: Option<Angle>,
    pub(super) vorticity: i32,
}

/// Where all sites are about the line. Many are equally far away, and θ is computed once for all of them.
pub(super) struct Around {
    /// The distances that there are (spacings), in rising order.
    radii: Vec<f64>,
    places: Vec<Place>,
    /// The least and the greatest distance of a site of its own.
    pub(super) nearest: f64,
    pub(super) furthest: f64,
}

/// Where a site is: which distance is its own, and cos vφ and sin vφ.
struct Place {
    ring: usize,
    turned: [f64; 2],
}

impl Around {
    /// How much further away than the nearest site of all the nearest of its own is (spacings).
    pub(super) fn outside(&self) -> f64 {
        self.nearest - self.radii.first().copied().unwrap_or(self.nearest)
    }
}

impl Texture<'_> {
    /// Where all sites are.
    pub(super) fn around(&self, context: &StateContext) -> Result<Around> {
        if self.vorticity == 0 {
            return Err(Error::invalid("vorticity", "found 0, but spins turn at least once around: give 1 or -1"));
        }
        let lattice = context.lattice;
        let center = match self.center {
            Some(place) => lattice.point(place).map_err(|e| e.within("center"))?,
            None => middle(lattice),
        };
        let periods = lattice.periods();
        let away = |i: usize| {
            let [x, y, _] = periods.shortest(vector::sub(lattice.place(i), center));
            ([x, y], (x * x + y * y).sqrt())
        };
        let sites: Vec<([f64; 2], f64)> = (0..lattice.sites).map(away).collect();
        let own = || sites.iter().enumerate().filter(|(i, _)| context.is_own(*i)).map(|(_, (_, r))| *r);
        let (nearest, furthest) = (own().fold(f64::INFINITY, f64::min), own().fold(0.0, f64::max));
        let mut radii: Vec<f64> = sites.iter().map(|(_, r)| *r).collect();
        radii.sort_unstable_by(f64::total_cmp);
        radii.dedup();
        let place = |([x, y], r): ([f64; 2], f64)| {
            let phi = if r > ON_THE_LINE { libm::atan2(y, x) } else { 0.0 };
            let (sin, cos) = libm::sincos(f64::from(self.vorticity) * phi);
            Place { ring: radii.partition_point(|ring| *ring < r), turned: [cos, sin] }
        };
        let places = sites.into_iter().map(place).collect();
        Ok(Around { radii, places, nearest, furthest })
    }

    /// The axes x, y and k of the spins.
    fn axes(&self) -> [Vector; 3] {
        let [x, y, z] = self.core;
        let below = [z, y, x].into_iter().find(|c| *c != 0.0).is_some_and(|c| c < 0.0);
        let k = if below { vector::scale(-1.0, self.core) } else { self.core };
        let tilt = Quaternion::from_rotation([0.0, 0.0, 1.0], k, Direction::Y);
        [tilt.rotate([1.0, 0.0, 0.0]), tilt.rotate([0.0, 1.0, 0.0]), k]
    }

    /// The senses that are open to it: outwards, inwards, and both ways round; none where the helicity is given.
    pub(super) fn senses(&self) -> Vec<Sense> {
        let ([x, y, _], back) = (self.axes(), |v: Vector| vector::scale(-1.0, v));
        let open = [x, back(x), y, back(y)].map(|through| Sense { from: self.core, through });
        if self.helicity.is_some() { Vec::new() } else { open.into() }
    }

    /// Where the spins of φ = 0 point in the middle of their turn.
    pub(super) fn through(&self, context: &StateContext, open: &[Sense]) -> Vector {
        let [x, y, _] = self.axes();
        match self.helicity {
            Some(Angle(helicity)) => {
                let (sin, cos) = libm::sincos(helicity);
                vector::add(vector::scale(cos, x), vector::scale(sin, y))
            }
            None => context.sense_among(open).map_or(x, |sense| sense.through),
        }
    }

    /// The spins, from θ(r) (rad).
    pub(super) fn spins(&self, around: &Around, through: Vector, theta: impl Fn(f64) -> f64) -> Vec<Vector> {
        let across = vector::cross(self.axes()[2], through);
        let rings: Vec<(f64, f64)> = around.radii.iter().map(|r| libm::sincos(theta(*r))).collect();
        let spin = |place: &Place| {
            let (sin, cos) = rings[place.ring];
            let [c, s] = place.turned.map(|part| sin * part);
            let turned = vector::add(vector::scale(c, through), vector::scale(s, across));
            let m = vector::add(vector::scale(cos, self.core), turned);
            vector::unit_or(m, self.core)
        };
        around.places.iter().map(spin).collect()
    }
}

/// The middle of a lattice; where it is periodic across the line, and no place is its middle more than another, the site nearest to
/// that: halfway between two sites a state may rest where it is lowest neither there nor beside a site.
fn middle(lattice: &Lattice) -> Vector {
    let middle = lattice.middle();
    let periodic = (0..2).all(|d| lattice.grid.periodic[d] && lattice.grid.size[d] > 1);
    let away = |i: &usize| {
        let [x, y, _] = vector::sub(lattice.place(*i), middle);
        (x * x + y * y).sqrt()
    };
    let nearer = |i: usize, j: usize| if away(&j) < away(&i) - ON_THE_LINE { j } else { i };
    if periodic { lattice.place((1..lattice.sites).fold(0, nearer)) } else { middle }
}

/// Reads `"auto"`, which is nothing, or an angle.
pub(super) fn auto_or_angle<'de, D: Deserializer<'de>>(d: D) -> std::result::Result<Option<Angle>, D::Error> {
    struct Seen;
    impl Visitor<'_> for Seen {
        type Value = Option<Angle>;
        fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
            f.write_str("\"auto\" or an angle, such as \"90 deg\"")
        }
        fn visit_str<E: de::Error>(self, word: &str) -> std::result::Result<Self::Value, E> {
            if word == "auto" { Ok(None) } else { Angle::deserialize(word.into_deserializer()).map(Some) }
        }
        fn visit_f64<E: de::Error>(self, x: f64) -> std::result::Result<Self::Value, E> {
            Angle::deserialize(x.into_deserializer()).map(Some)
        }
        fn visit_i64<E: de::Error>(self, x: i64) -> std::result::Result<Self::Value, E> {
            Angle::deserialize(x.into_deserializer()).map(Some)
        }
        fn visit_u64<E: de::Error>(self, x: u64) -> std::result::Result<Self::Value, E> {
            Angle::deserialize(x.into_deserializer()).map(Some)
        }
        fn visit_unit<E: de::Error>(self) -> std::result::Result<Self::Value, E> {
            Ok(None)
        }
    }
    d.deserialize_any(Seen)
}

/// The schema of [`auto_or_angle`].
pub(super) fn auto_or_angle_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
    use schemars::JsonSchema;
    let angle = Angle::json_schema(generator);
    schemars::json_schema!({"anyOf": [{"const": "auto"}, angle], "default": "auto"})
}

/// The vorticity where none is given.
pub(super) fn once() -> i32 {
    1
}
