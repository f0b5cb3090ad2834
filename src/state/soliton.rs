//! A chiral soliton: a wall of 2π, all the way round, between equal surroundings.
//!
//! ```text
//! φ_i = 4 atan exp((r_i·n − center)/w)      m_i = cos φ_i d + sin φ_i t,    w = √(J/c) sites
//! ```
//! across the normal n (along a chain r_i·n is the number i of the site):
//! the kink of the sine-Gordon equation J φ'' = c sin φ, which a helimagnet in a field B normal to its helix obeys, where c = μB
//! (I. E. Dzyaloshinskii, Sov. Phys. JETP 20, 665 (1965); Y. Togawa et al., Phys. Rev. Lett. 108, 107202 (2012),
//! doi:10.1103/PhysRevLett.108.107202). d is the direction of the surroundings, t the part of `through` normal to it. c is the
//! curvature of the energy a site as all spins turn from d towards t: μB of a field, 2K of an easy axis, so that w is the δ of a
//! domain wall in the same energy.
//!
//! "auto" is the cheapest of four senses, see [`Sense`]: both ways round the normal, and both ways by way of the normal.

use super::domain_wall::{fractions, width};
use super::sense::{Sense, along_a_domain, auto_or_direction, auto_or_direction_schema};
use super::{StateBuilder, StateContext};
use crate::energy::Hamiltonian;
use crate::error::{Error, Result};
use crate::geometry::{Direction, Vector, vector};
use crate::registry::Described;
use crate::spins::Spins;
use crate::units::Extent;
use schemars::JsonSchema;
use serde::Deserialize;
use std::f64::consts::TAU;

/// The least sine between the surroundings and a direction across them.
const ACROSS: f64 = 1e-6;

/// A turn of all spins from which the curvature is taken (rad).
const SMALL: f64 = 1e-2;

/// `{"soliton": {"center": 39.5}}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Soliton {
    /// In sites, 39.5 lies between sites 39 and 40: how far the soliton is from the origin along its normal.
    pub center: Extent,
    /// Width w of the turn in sites; that of the energy if absent. 0 is an abrupt turn.
    #[serde(default)]
    pub width: Option<Extent>,
    /// From left to right, across the soliton; +x if absent, in a chain along the chain.
    #[serde(default)]
    pub normal: Option<Direction>,
    /// Where the spins point on both sides; +z if absent.
    #[serde(default)]
    pub domain: Option<Direction>,
    /// Where the spins point a quarter of the way; "auto" (or absent): the cheapest for the energy.
    #[serde(default, deserialize_with = "auto_or_direction")]
    #[schemars(schema_with = "auto_or_direction_schema")]
    pub through: Option<Direction>,
    /// Reverse odd sites, of a cell with several atoms every other one.
    #[serde(default)]
    pub staggered: bool,
}

impl Described for Soliton {
    const NAME: &'static str = "soliton";
    const SUMMARY: &'static str = "a 2π wall at `center` (in sites), as in monoaxial helimagnets";
    const EXAMPLE: &'static str = r#"{"soliton": {"center": 5.5, "width": 1.5, "domain": [0, 0, 1]}}"#;
}

impl Soliton {
    fn surroundings(&self) -> Vector {
        self.domain.unwrap_or(Direction::Z).vector()
    }

    /// The width given, or that of the energy for a turn towards `through`.
    fn width(&self, context: &StateContext, through: Vector) -> Result<f64> {
        let given = width(self.width, context.lattice)?;
        let Some(h) = context.hamiltonian.filter(|_| given.is_none()) else {
            return Ok(given.unwrap_or(context.wall_width_sites));
        };
        let c = self.curvature(h, through)?;
        if context.exchange_mev > 0.0 && c > 1e-9 * h.stiffness_mev() {
            return Ok((context.exchange_mev / c).sqrt());
        }
        let message = "nothing holds the spins around the soliton against its turn, or no exchange joins them, so it has no \
                       width of its own: give it a \"width\" in sites, or a field";
        Err(Error::invalid("width", message))
    }

    /// d²e/dθ² (meV) of the energy a site as all spins turn by θ.
    fn curvature(&self, h: &Hamiltonian, through: Vector) -> Result<f64> {
        let turned = |angle: f64| -> Result<Spins> {
            let spin = self.spin(through, angle);
            let reversed = |i: usize| self.staggered && h.lattice().is_odd(i);
            let all: Vec<Vector> =
                (0..h.sites()).map(|i| if reversed(i) { vector::scale(-1.0, spin) } else { spin }).collect();
            Spins::from_vectors(&all)
        };
        let rest = turned(0.0)?;
        let [up, down] = [turned(SMALL)?, turned(-SMALL)?];
        let rise =
            h.difference_mev(up.as_slice(), rest.as_slice()) + h.difference_mev(down.as_slice(), rest.as_slice());
        Ok(rise / (SMALL * SMALL * h.sites() as f64))
    }

    /// A spin turned by an angle towards `through`.
    fn spin(&self, through: Vector, angle: f64) -> Vector {
        let (sin, cos) = libm::sincos(angle);
        vector::add(vector::scale(cos, self.surroundings()), vector::scale(sin, through))
    }
}

impl StateBuilder for Soliton {
    fn vectors(&self, context: &StateContext) -> Result<Vec<Vector>> {
        let d = self.surroundings();
        let open = self.senses(context);
        let through = self.through.map(Direction::vector).or(context.sense_among(&open).map(|sense| sense.through));
        let across = through.map_or([0.0; 3], |t| vector::normal_part(t, d));
        if vector::norm(across) < ACROSS {
            return Err(along_a_domain("soliton"));
        }
        let t = vector::unit_or(across, d);
        let turned = fractions("soliton", self.center, self.width(context, t)?, self.normal, context.lattice)?;
        Ok(turned.into_iter().map(|f| self.spin(t, TAU * f)).collect())
    }

    fn staggered(&self) -> bool {
        self.staggered
    }

    fn senses(&self, context: &StateContext) -> Vec<Sense> {
        if self.through.is_some() {
            return Vec::new();
        }
        let along = match self.normal {
            None if context.lattice.counts_sites() => context.lattice.direction(),
            normal => normal.unwrap_or(Direction::X),
        };
        let d = self.surroundings();
        let [u, minus_u, v, minus_v] = Sense::across(d, d, along.vector());
        vec![v, minus_v, u, minus_u]
    }
}
