//! A vortex: spins in the plane that turn once on the way around, and out of it in the core.
//!
//! ```text
//! tan(θ/2) = r/a for r < a,  θ = 90° outside
//! ```
//! in the coordinates of [`Texture`](super::texture::Texture): N. A. Usov, S. E. Peschany, J. Magn. Magn. Mater. 118, L290 (1993),
//! doi:10.1016/0304-8853(93)90428-5. Helicity 90° turns anticlockwise about +z; vorticity −1 is an antivortex.

use super::domain_wall::width;
use super::sense::Sense;
use super::size::least;
use super::texture::{Texture, auto_or_angle, auto_or_angle_schema, once};
use super::{StateBuilder, StateContext};
use crate::error::{Error, Result};
use crate::geometry::{Direction, Vector};
use crate::registry::Described;
use crate::units::{Angle, Extent, Place};
use schemars::JsonSchema;
use serde::Deserialize;
use std::f64::consts::FRAC_PI_2;

/// The smallest core that is looked for (spacings).
const SMALLEST: f64 = 0.3;
/// The core where no energy says how large it is (spacings).
const USUAL: f64 = 2.0;
/// A vortex is inside if a site is no further from its line than this (spacings), or than its core.
const INSIDE: f64 = 1.0;

/// `{"vortex": {"center": [10, 10]}}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Vortex {
    /// Where it is; in the middle if absent.
    #[serde(default)]
    pub center: Option<Place>,
    /// a, the radius of the core, in spacings; that of least energy if absent. 0: no core.
    #[serde(default)]
    pub radius: Option<Extent>,
    /// Direction of the core; +z if absent.
    #[serde(default)]
    pub core: Option<Direction>,
    /// Angle from the way outwards to the spins; "auto" (or absent): of 90°, −90°, 0 and 180° the cheapest for the energy.
    #[serde(default, deserialize_with = "auto_or_angle")]
    #[schemars(schema_with = "auto_or_angle_schema")]
    pub helicity: Option<Angle>,
    /// How often the spins turn on the way around; −1 is an antivortex.
    #[serde(default = "once")]
    pub vorticity: i32,
    /// Reverse odd sites, of a cell with several atoms every other one.
    #[serde(default)]
    pub staggered: bool,
}

impl Described for Vortex {
    const NAME: &'static str = "vortex";
    const SUMMARY: &'static str = "a vortex or an antivortex, with a core out of the plane";
    const EXAMPLE: &'static str = r#"{"vortex": {"center": [5.5, 0], "radius": 2, "core": [0, 0, -1]}}"#;
}

impl Vortex {
    fn texture(&self) -> Texture<'_> {
        let core = self.core.unwrap_or(Direction::Z).vector();
        Texture { center: self.center.as_ref(), core, helicity: self.helicity, vorticity: self.vorticity }
    }
}

/// θ (rad) at a distance.
fn theta(r: f64, core: f64) -> f64 {
    if r < core { 2.0 * libm::atan(r / core) } else { FRAC_PI_2 }
}

impl StateBuilder for Vortex {
    fn vectors(&self, context: &StateContext) -> Result<Vec<Vector>> {
        let texture = self.texture();
        let (around, through) = (texture.around(context)?, texture.through(context, &self.senses(context)));
        let with = |core: f64| texture.spins(&around, through, |r| theta(r, core));
        let given = width(self.radius, context.lattice).map_err(|e| e.within("radius"))?;
        let furthest = around.furthest.max(2.0 * SMALLEST);
        let core = match (given, context.hamiltonian) {
            (Some(core), _) => core,
            (None, None) => USUAL,
            (None, Some(h)) => least(SMALLEST, furthest, |a| context.energy_mev(h, with(a))).0,
        };
        if around.nearest > core.max(INSIDE) {
            let message = format!("a vortex there has its core wholly outside {}: move it inside", context.place());
            return Err(Error::invalid("center", message));
        }
        Ok(with(core))
    }

    fn staggered(&self) -> bool {
        self.staggered
    }

    fn senses(&self, _: &StateContext) -> Vec<Sense> {
        let [outwards_and_in, around] = [0, 1].map(|k| self.texture().senses().into_iter().skip(2 * k).take(2));
        around.chain(outwards_and_in).collect()
    }

    fn is_sized_by_energy(&self) -> bool {
        self.radius.is_none()
    }
}
