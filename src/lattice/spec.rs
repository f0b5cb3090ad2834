//! A lattice as written in a config: `{"chain": {…}}`. One file a kind.

use super::{Bcc, Chain, Crystal, Cubic, Fcc, Hcp, Honeycomb, Kagome, Lattice, Mesh, Square, Triangular};
use crate::error::Result;
use crate::registry::family;

family! {
    /// A lattice as written in a config.
    LatticeSpec as LatticeKind {
        Chain(Chain),
        Square(Square),
        Triangular(Triangular),
        Honeycomb(Honeycomb),
        Kagome(Kagome),
        Cubic(Cubic),
        Bcc(Bcc),
        Fcc(Fcc),
        Hcp(Hcp),
        Crystal(Crystal),
        Grid(Mesh),
    }
}

/// A lattice's config that becomes a lattice.
pub trait LatticeKind {
    /// Number of sites, those included that a shape leaves out, if that can be.
    fn checked_sites(&self) -> Result<usize>;

    /// The lattice; an error, with its place, where something cannot be.
    fn resolve(&self) -> Result<Lattice>;

    /// The key that says how large it is.
    fn extent(&self) -> &'static str {
        "cells"
    }
}

impl LatticeSpec {
    /// Number of sites, those included that a shape leaves out, if that can be.
    pub fn sites(&self) -> Result<usize> {
        self.member().checked_sites().map_err(|e| e.within(self.name()))
    }

    /// The lattice; an error, with its place, where something cannot be.
    pub fn resolve(&self) -> Result<Lattice> {
        self.member().resolve().map_err(|e| e.within(self.name()))
    }

    /// Where a config says how large it is.
    pub fn extent(&self) -> String {
        format!("lattice.{}.{}", self.name(), self.member().extent())
    }
}
