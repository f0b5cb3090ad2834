//! A skyrmion: a core, around it a wall of 180° closed to a ring, outside it the opposite direction.
//!
//! ```text
//! θ(r) = 2 atan(sinh(r/w)/sinh(R/w))      from the core (θ = 0) by the radius R (θ = 90°) to the background (θ = 180°)
//! ```
//! in the coordinates of [`Texture`](super::texture::Texture): H.-B. Braun, Phys. Rev. B 50, 16485 (1994),
//! doi:10.1103/PhysRevB.50.16485; X. S. Wang, H. Y. Yuan, X. R. Wang, Commun. Phys. 1, 31 (2018), doi:10.1038/s42005-018-0029-0.
//! Helicity 0 or 180° is a Néel skyrmion, ±90° a Bloch skyrmion; vorticity −1 an antiskyrmion. In three dimensions it is a tube along
//! z. The topological charge (1/4π) ∫ m·(∂ₓm × ∂ᵧm) is the vorticity times the sign of the core's z.
//!
//! A width that is left out is that of least energy for the radius. A radius that is left out is the smallest at which the energy of
//! these profiles has a minimum; a minimum in which the core has all of its region, and the wall has left it, is no skyrmion.

use super::domain_wall::width;
use super::sense::Sense;
use super::size::{first_minimum, least};
use super::texture::{Around, Texture, auto_or_angle, auto_or_angle_schema, once};
use super::{StateBuilder, StateContext};
use crate::energy::Hamiltonian;
use crate::error::{Error, Result};
use crate::field::Components;
use crate::geometry::{Direction, Vector, vector};
use crate::registry::Described;
use crate::spins::Spins;
use crate::units::{Angle, Extent, Place};
use schemars::JsonSchema;
use serde::Deserialize;
use std::f64::consts::PI;

/// A skyrmion leaves no trace where no spin is turned by this share of 180°, and nothing around it where none is by less than all but it.
const NO_TRACE: f64 = 0.01;
/// Narrower than this (spacings) a wall is abrupt.
const NARROWEST: f64 = 0.2;
/// A radius that is looked for is at least this (spacings): smaller ones are single reversed spins.
const SMALLEST: f64 = 1.0;
/// One of this radius (spacings) is small, and yet has its whole charge on a lattice.
const SMALL: f64 = 2.0;

/// `{"skyrmion": {"center": [10, 10], "radius": 3}}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Skyrmion {
    /// Where it is; in the middle if absent, on a film that is periodic both ways at the site nearest to that.
    #[serde(default)]
    pub center: Option<Place>,
    /// Radius R in spacings, where the spins are across core and background; that of the energy if absent.
    #[serde(default)]
    pub radius: Option<Extent>,
    /// Width w of its wall in spacings; that of the energy if absent. 0 is an abrupt wall.
    #[serde(default)]
    pub width: Option<Extent>,
    /// Direction of the core; −z if absent. The background is opposite.
    #[serde(default)]
    pub core: Option<Direction>,
    /// Angle from the way outwards to the spins in the wall; "auto" (or absent): of 0, 180°, 90° and −90° the cheapest for the energy.
    #[serde(default, deserialize_with = "auto_or_angle")]
    #[schemars(schema_with = "auto_or_angle_schema")]
    pub helicity: Option<Angle>,
    /// How often the spins turn on the way around; −1 is an antiskyrmion.
    #[serde(default = "once")]
    pub vorticity: i32,
    /// Reverse odd sites, of a cell with several atoms every other one.
    #[serde(default)]
    pub staggered: bool,
}

impl Described for Skyrmion {
    const NAME: &'static str = "skyrmion";
    const SUMMARY: &'static str = "a skyrmion or an antiskyrmion, a tube in three dimensions";
    const EXAMPLE: &'static str =
        r#"{"skyrmion": {"center": [5, 0], "radius": 3, "width": 1.5, "helicity": "90 deg"}}"#;
}

/// A skyrmion whose places are known.
struct Placed<'a> {
    context: &'a StateContext<'a>,
    texture: Texture<'a>,
    around: Around,
    through: Vector,
    odd: Option<&'a dyn Fn(usize) -> bool>,
}

impl Placed<'_> {
    fn vectors(&self, radius: f64, width: f64) -> Vec<Vector> {
        let mut all = self.texture.spins(&self.around, self.through, |r| theta(r, radius, width));
        if let Some(odd) = self.odd {
            all.iter_mut().enumerate().filter(|(i, _)| odd(*i)).for_each(|(_, m)| *m = vector::scale(-1.0, *m));
        }
        all
    }

    /// The energy (meV) by which it is judged.
    fn energy(&self, h: &Hamiltonian, radius: f64, width: f64) -> f64 {
        self.context.energy_mev(h, self.vectors(radius, width))
    }

    /// The width of least energy for a radius, and that energy.
    fn best_width(&self, h: &Hamiltonian, radius: f64) -> (f64, f64) {
        least(NARROWEST, (2.0 * radius).max(2.0 * NARROWEST), |width| self.energy(h, radius, width))
    }

    /// Whether it fills its sites, so that its wall is hardly in them: it has less than half the charge that a small one there has.
    fn fills_its_place(&self, radius: f64, width: f64) -> bool {
        let own = |corners: &[usize; 3]| corners.iter().all(|i| self.context.is_own(*i));
        let mut triangles = self.context.lattice.triangles();
        triangles.corners.retain(own);
        let charge = |radius: f64, width: f64| {
            let all = self.texture.spins(&self.around, self.through, |r| theta(r, radius, width));
            triangles.charge(Components::new(Spins::from_unit_vectors(&all).as_slice())).abs()
        };
        let small = charge(SMALL, 0.5 * SMALL);
        radius > SMALL && small > NO_TRACE && charge(radius, width) < 0.5 * small
    }
}

/// θ (rad) at a distance.
fn theta(r: f64, radius: f64, width: f64) -> f64 {
    if width == 0.0 {
        return if r < radius { 0.0 } else { PI };
    }
    // sinh(r/w)/sinh(R/w), which neither overflows
    let grown = libm::exp(((r - radius) / width).clamp(-700.0, 700.0));
    let ratio = grown * libm::expm1(-2.0 * r / width) / libm::expm1(-2.0 * radius / width);
    2.0 * libm::atan(ratio)
}

impl Skyrmion {
    fn texture(&self) -> Texture<'_> {
        let core = self.core.unwrap_or(Direction::Z.reversed()).vector();
        Texture { center: self.center.as_ref(), core, helicity: self.helicity, vorticity: self.vorticity }
    }

    /// Radius and width (spacings).
    fn size(&self, context: &StateContext, placed: &Placed) -> Result<[f64; 2]> {
        let radius =
            self.radius.map(|given| match context.lattice.spacings(given).map_err(|e| e.within("radius"))? {
                radius if radius > 0.0 => Ok(radius),
                _ => Err(Error::invalid("radius", format!("found {given}, but a radius is greater than 0"))),
            });
        let (radius, width) = (radius.transpose()?, width(self.width, context.lattice)?);
        let of_own = |radius: f64, h: &Hamiltonian| width.unwrap_or_else(|| placed.best_width(h, radius).0);
        match (radius, width, context.hamiltonian) {
            (Some(radius), Some(width), _) => Ok([radius, width]),
            (Some(radius), None, Some(h)) => Ok([radius, of_own(radius, h)]),
            (Some(radius), None, None) => Ok([radius, context.wall_width_sites.min(radius)]),
            (None, _, None) => {
                Err(Error::invalid("radius", "without an energy a skyrmion has no radius of its own: give one"))
            }
            (None, _, Some(h)) => {
                let energy = |radius: f64| match width {
                    Some(width) => placed.energy(h, radius, width),
                    None => placed.best_width(h, radius).1,
                };
                let size =
                    first_minimum(SMALLEST, placed.around.furthest, energy).map(|radius| [radius, of_own(radius, h)]);
                size.filter(|[radius, width]| !placed.fills_its_place(*radius, *width)).ok_or_else(|| {
                    let message = format!(
                        "no size of this skyrmion is stable here, its energy falls all the way to nothing or to the whole of {}: give \
                         it a \"radius\"",
                        context.place()
                    );
                    Error::invalid("radius", message)
                })
            }
        }
    }
}

impl StateBuilder for Skyrmion {
    fn vectors(&self, context: &StateContext) -> Result<Vec<Vector>> {
        let texture = self.texture();
        let (around, through) = (texture.around(context)?, texture.through(context, &self.senses(context)));
        let is_odd = |i: usize| context.lattice.is_odd(i);
        let mut placed = Placed { context, texture, around, through, odd: self.staggered.then_some(&is_odd) };
        if self.radius.is_none() && placed.around.outside() > SMALLEST {
            let message = format!(
                "a skyrmion there has its core outside {}, and no size of its own in it: move it inside, or give it a \"radius\"",
                context.place()
            );
            return Err(Error::invalid("center", message));
        }
        let [radius, width] = self.size(context, &placed)?;
        placed.odd = None;
        if PI - theta(placed.around.nearest, radius, width) < NO_TRACE * PI {
            let key = if self.center.is_some() { "center" } else { "radius" };
            let message = format!(
                "a skyrmion there lies wholly outside {} or between its sites, and leaves no trace in it: move it inside or make it \
                 larger, or write {{\"uniform\": {{\"direction\": […]}}}}",
                context.place()
            );
            return Err(Error::invalid(key, message));
        }
        // beside its radius all spins are more of its core than of what is around it
        if placed.around.furthest < radius {
            let message = format!(
                "a skyrmion of {radius:.1} spacings is larger than {}, whose furthest site is {:.1} from its centre: make it \
                 smaller, or write {{\"uniform\": {{\"direction\": […]}}}}",
                context.place(),
                placed.around.furthest
            );
            return Err(Error::invalid("radius", message));
        }
        Ok(placed.vectors(radius, width))
    }

    fn staggered(&self) -> bool {
        self.staggered
    }

    fn senses(&self, _: &StateContext) -> Vec<Sense> {
        self.texture().senses()
    }

    fn is_sized_by_energy(&self) -> bool {
        self.radius.is_none() || self.width.is_none()
    }

    fn may_miss_senses(&self) -> bool {
        true
    }
}
