//! Exchange of four spins.
//!
//! ```text
//! product:  E = − Σ K (m_i·m_j)(m_k·m_l)
//! ring:     E = − Σ K [ (m_i·m_j)(m_k·m_l) + (m_i·m_l)(m_j·m_k) − (m_i·m_k)(m_j·m_l) ]
//! 1 − pq = (1 − p) + p (1 − q),   1 − m_i·m_j = ½|m_i − m_j|²
//! ```
//! Each quadruple i, j, k, l of the list stands once in every cell. (M. Takahashi, J. Phys. C 10, 1289 (1977),
//! doi:10.1088/0022-3719/10/8/031; as the ring form is used for films: S. Heinze et al., Nat. Phys. 7, 713 (2011),
//! doi:10.1038/nphys2045.) Energies are counted from those of spins that are all alike.

use super::EnergyTerm;
use super::blocks::{Block, Blocks};
use super::spec::{Medium, TermBuilder};
use crate::error::{Error, Result};
use crate::field::{Components, ComponentsMut};
use crate::geometry::{Vector, vector};
use crate::lattice::{BondFamily, Hop, Lattice, Shift};
use crate::registry::Described;
use crate::units::Energy;
use schemars::JsonSchema;
use serde::Deserialize;
use std::ops::Range;

/// `{"quads": [{"K": "0.1 meV", "cells": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], "ring": true}]}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FourSpinSpec {
    /// The quadruples; each stands once in every cell.
    pub quads: Vec<QuadSpec>,
}

/// `{"K": "0.1 meV", "cells": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]}`: four sites and their energy.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct QuadSpec {
    /// Energy of the quadruple, the K of the formulas; positive: parallel spins are lower.
    pub K: Energy,
    /// The cells of i, j, k and l, from the cell of the quadruple.
    pub cells: [Shift; 4],
    /// Which atoms of their cells they are; the first of each if not given.
    #[serde(default)]
    pub atoms: [usize; 4],
    /// The form of a ring.
    #[serde(default)]
    pub ring: bool,
}

impl Described for FourSpinSpec {
    const NAME: &'static str = "four_spin";
    const SUMMARY: &'static str = "exchange −K (m_i·m_j)(m_k·m_l) of four spins, or its ring form";
    const EXAMPLE: &'static str = r#"{"four_spin": {"quads": [{"K": "0.1 meV", "cells": [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]], "ring": true}]}}"#;
}

impl TermBuilder for FourSpinSpec {
    fn build(&self, medium: &Medium) -> Result<Box<dyn EnergyTerm>> {
        if self.quads.is_empty() {
            return Err(Error::invalid("quads", "the list is empty: give the quadruples of a cell"));
        }
        let mut term = FourSpin::none(medium.lattice.sites);
        for (k, quad) in self.quads.iter().enumerate() {
            let within = |e: Error| e.within(&format!("quads[{k}]"));
            quad.check(medium.lattice).map_err(within)?;
            for sites in quad.sites(medium.lattice) {
                let acts = |i: &usize| !medium.lattice.vacant[*i];
                if sites.iter().all(acts) {
                    quad.products(sites, quad.K.0 * medium.share(sites)).for_each(|product| term.push(product));
                }
            }
            quad.hops().for_each(|hop| term.join(medium.lattice, hop));
        }
        term.touch();
        Ok(Box::new(term))
    }
}

impl QuadSpec {
    /// The four atoms, each with its cell.
    fn places(&self) -> [(usize, Shift); 4] {
        [0, 1, 2, 3].map(|k| (self.atoms[k], self.cells[k]))
    }

    fn check(&self, lattice: &Lattice) -> Result<()> {
        let atoms = lattice.atoms.len();
        if let Some(k) = self.atoms.iter().position(|atom| *atom >= atoms) {
            let message = format!("found atom {}, but a cell has {atoms}, counted from 0", self.atoms[k]);
            return Err(Error::invalid(format!("atoms[{k}]"), message));
        }
        match self.hops().find(|hop| lattice.closes(*hop)) {
            Some(_) => Err(Error::invalid(
                "cells",
                "two of the four are one site here, or wrap round a ring: give four that differ",
            )),
            None if self.sites(lattice).next().is_none() => {
                Err(Error::invalid("cells", "no four sites of the lattice stand like this"))
            }
            None => Ok(()),
        }
    }

    /// From each of the four to each that comes after it.
    fn hops(&self) -> impl Iterator<Item = Hop> + '_ {
        let places = self.places();
        let pairs = (0..4).flat_map(|b| (0..b).map(move |a| [a, b]));
        pairs.map(move |[a, b]| {
            let ((from, first), (to, second)) = (places[a], places[b]);
            Hop { atoms: [from, to], shift: [0, 1, 2].map(|d| second[d] - first[d]) }
        })
    }

    /// The quadruples of all cells.
    fn sites<'a>(&'a self, lattice: &'a Lattice) -> impl Iterator<Item = [usize; 4]> + 'a {
        (0..lattice.grid.cells()).filter_map(|cell| {
            let cell = lattice.grid.cell(cell);
            let site = |(atom, by): (usize, Shift)| lattice.site(atom, lattice.grid.shifted(cell, by)?);
            let [i, j, k, l] = self.places().map(site);
            Some([i?, j?, k?, l?])
        })
    }

    /// The products that they are in.
    fn products(&self, [i, j, k, l]: [usize; 4], mev: f64) -> impl Iterator<Item = Product> {
        let all = [([i, j, k, l], mev), ([i, l, j, k], mev), ([i, k, j, l], -mev)];
        let count = if self.ring { 3 } else { 1 };
        all.into_iter().take(count).map(|(sites, mev)| Product { sites: sites.map(|i| i as u32), mev })
    }
}

/// −K (m_i·m_j)(m_k·m_l).
#[derive(Clone, Copy, Debug)]
struct Product {
    sites: [u32; 4],
    mev: f64,
}

impl Product {
    /// The sites, that in slot s first with its partner, then the other two.
    fn seen_from(&self, slot: usize) -> [usize; 4] {
        let order = [[0, 1, 2, 3], [1, 0, 2, 3], [2, 3, 0, 1], [3, 2, 0, 1]][slot];
        order.map(|k| self.sites[k] as usize)
    }
}

/// Products of four spins.
#[derive(Clone, Debug)]
pub struct FourSpin {
    products: Vec<Product>,
    families: Vec<BondFamily>,
    /// Where the entries of each site in `touching` begin, and where the last ones end.
    starts: Vec<usize>,
    /// Products and the slots in them.
    touching: Vec<(u32, u8)>,
}

impl FourSpin {
    fn none(sites: usize) -> FourSpin {
        FourSpin { products: Vec::new(), families: Vec::new(), starts: vec![0; sites + 1], touching: Vec::new() }
    }

    fn push(&mut self, product: Product) {
        self.products.push(product);
    }

    /// Notes the bonds of a hop as coupled.
    fn join(&mut self, lattice: &Lattice, hop: Hop) {
        let hop = if lattice.leads_up(hop) { hop } else { hop.back() };
        if !self.families.iter().any(|family| family.hop == hop) {
            self.families.push(BondFamily::new(lattice, 0, hop));
        }
    }

    /// Lists the products of each site.
    fn touch(&mut self) {
        let entries =
            self.products.iter().enumerate().flat_map(|(k, p)| (0..4).map(move |s| (p.sites[s], k as u32, s as u8)));
        let mut all: Vec<(u32, u32, u8)> = entries.collect();
        all.sort_unstable();
        for (site, ..) in &all {
            self.starts[*site as usize + 1] += 1;
        }
        (1..self.starts.len()).for_each(|i| self.starts[i] += self.starts[i - 1]);
        self.touching = all.into_iter().map(|(_, product, slot)| (product, slot)).collect();
    }

    /// For each pair of slots of a product: the sites, and ∂²E by the first (rows) and the second (columns).
    fn curvatures(&self, p: &Product, m: Components) -> impl Iterator<Item = ([usize; 2], Block)> {
        let [i, j, k, l] = p.seen_from(0);
        let [a, b, c, d] = [i, j, k, l].map(|i| m.get(i));
        let isotropic = |s: f64| [0, 1, 2].map(|r| [0, 1, 2].map(|c| if r == c { s } else { 0.0 }));
        let outer = |u: Vector, v: Vector| u.map(|x| vector::scale(-p.mev * x, v));
        [
            ([i, j], isotropic(-p.mev * vector::dot(c, d))),
            ([k, l], isotropic(-p.mev * vector::dot(a, b))),
            ([i, k], outer(b, d)),
            ([i, l], outer(b, c)),
            ([j, k], outer(a, d)),
            ([j, l], outer(a, c)),
        ]
        .into_iter()
    }
}

impl EnergyTerm for FourSpin {
    fn name(&self) -> &'static str {
        FourSpinSpec::NAME
    }

    fn sites(&self) -> Option<usize> {
        Some(self.starts.len() - 1)
    }

    fn reference_mev(&self) -> f64 {
        -self.products.iter().map(|p| p.mev).sum::<f64>()
    }

    fn add_gradient(&self, m: Components, mut g: ComponentsMut, density: &mut [f64], range: Range<usize>) {
        for i in range.clone() {
            for (k, slot) in &self.touching[self.starts[i]..self.starts[i + 1]] {
                let p = &self.products[*k as usize];
                let [a, b, c, d] = p.seen_from(*slot as usize).map(|i| m.get(i));
                g.add(i - range.start, vector::scale(-p.mev * vector::dot(c, d), b));
                if *slot == 0 {
                    let apart = |u: Vector, v: Vector| 0.5 * vector::dot(vector::sub(u, v), vector::sub(u, v));
                    density[i - range.start] += p.mev * (apart(a, b) + vector::dot(a, b) * apart(c, d));
                }
            }
        }
    }

    fn add_hessian_product(&self, m: Components, v: Components, mut out: ComponentsMut) {
        for p in &self.products {
            for ([i, j], block) in self.curvatures(p, m) {
                out.add(i, super::multiply(&block, v.get(j)));
                out.add(j, super::multiply(&crate::geometry::matrix::transposed(&block), v.get(i)));
            }
        }
    }

    fn add_blocks(&self, m: Components, blocks: &mut Blocks) {
        for p in &self.products {
            for (sites, block) in self.curvatures(p, m) {
                blocks.add_bond(sites, block);
            }
        }
    }

    fn families(&self) -> Vec<&BondFamily> {
        self.families.iter().collect()
    }

    fn is_quadratic(&self) -> bool {
        self.products.is_empty()
    }

    fn axes(&self) -> Vec<Vector> {
        Vec::new()
    }
}
