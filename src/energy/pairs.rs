//! Any bilinear coupling of single pairs, as it is imported: J, a vector D and a tensor for each bond of a cell.
//!
//! ```text
//! E = Σ m_iᵀ M m_j          M = f_J (J 1 + T) + f_D [D]×,   m_iᵀ [D]× m_j = D·(m_i × m_j)
//!   = − Σ J' m_i·m_j + Σ D'·(m_i × m_j) + Σ m_iᵀ S m_j          S symmetric, without trace
//! ```
//! f_J is what the convention has in front of J ("-J": −1), f_D what it has in front of D. Where pairs are counted in both
//! directions, the sum runs over i and j independently, and a list has each pair twice.

use super::EnergyTerm;
use super::blocks::{Block, Blocks, cross_block, multiply};
use super::choice::Choice;
use super::couplings::Couplings;
use super::dmi::Dmi;
use super::exchange::Exchange;
use super::spec::{Medium, TermBuilder};
use crate::error::{Error, Result};
use crate::field::{Components, ComponentsMut};
use crate::geometry::matrix::transposed;
use crate::geometry::{Vector, vector};
use crate::lattice::{BondFamily, Hop, Lattice, Shift, at};
use crate::profile::Profile;
use crate::registry::Described;
use crate::units::Energy;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// `{"bonds": [{"from": 0, "to": 0, "cell": [1, 0, 0], "J": "10 meV"}]}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PairsSpec {
    /// The bonds of a cell; each stands once in every cell.
    #[serde(default)]
    pub bonds: Vec<PairSpec>,
    /// A table of bonds in place of them, beside the config: columns from, to, cell_1 … cell_3, J_meV, D_x_meV … T_zz_meV, in any
    /// unit of energy.
    #[serde(default)]
    pub file: Option<String>,
    /// What the numbers mean; each pair once, E = −J m_i·m_j + D·(m_i × m_j) − m_iᵀ T m_j, if not given. A file has to have it.
    #[serde(default)]
    pub convention: Option<Convention>,
}

/// `{"from": 0, "to": 0, "cell": [1, 0, 0], "J": "10 meV"}`: a bond; so many cells on is the other atom.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct PairSpec {
    /// An atom of a cell.
    pub from: usize,
    /// The other atom.
    pub to: usize,
    /// How many cells on that is: the other atom stands in the same one if absent.
    #[serde(default)]
    pub cell: Shift,
    /// Exchange J, with sign and counting as the convention says.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub J: Option<Energy>,
    /// Vector D of the antisymmetric exchange, along x, y and z.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("components" = ["x", "y", "z"]))]
    pub D: Option<[Energy; 3]>,
    /// T, row by row: in place of J or beside it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tensor: Option<[[Energy; 3]; 3]>,
}

/// What the numbers of pairs mean.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Convention {
    /// How often the energy counts a pair.
    pub counting: Counting,
    /// What stands in front of J and T.
    pub energy: EnergyForm,
    /// What stands in front of D: +D·(m_i × m_j), or −.
    #[serde(default)]
    pub dmi: DmiForm,
}

/// How often the energy counts a pair.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum Counting {
    /// Each pair once, and it is in the list once.
    #[default]
    #[serde(rename = "once")]
    Once,
    /// Over i and j independently, so that each pair is in the list twice, once each way.
    #[serde(rename = "both directions")]
    BothDirections,
}

/// What stands in front of J.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum EnergyForm {
    /// −J m_i·m_j.
    #[default]
    #[serde(rename = "-J")]
    Minus,
    /// +J m_i·m_j.
    #[serde(rename = "+J")]
    Plus,
    /// −2J m_i·m_j.
    #[serde(rename = "-2J")]
    MinusTwice,
    /// +2J m_i·m_j.
    #[serde(rename = "+2J")]
    PlusTwice,
    /// −½J m_i·m_j.
    #[serde(rename = "-J/2")]
    MinusHalf,
    /// +½J m_i·m_j.
    #[serde(rename = "+J/2")]
    PlusHalf,
}

/// What stands in front of D.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum DmiForm {
    /// +D·(m_i × m_j).
    #[default]
    #[serde(rename = "+D")]
    Plus,
    /// −D·(m_i × m_j).
    #[serde(rename = "-D")]
    Minus,
    /// +2D·(m_i × m_j).
    #[serde(rename = "+2D")]
    PlusTwice,
    /// −2D·(m_i × m_j).
    #[serde(rename = "-2D")]
    MinusTwice,
    /// +½D·(m_i × m_j).
    #[serde(rename = "+D/2")]
    PlusHalf,
    /// −½D·(m_i × m_j).
    #[serde(rename = "-D/2")]
    MinusHalf,
}

impl EnergyForm {
    /// What the number is multiplied by in the energy.
    pub fn factor(self) -> f64 {
        match self {
            EnergyForm::Minus => -1.0,
            EnergyForm::Plus => 1.0,
            EnergyForm::MinusTwice => -2.0,
            EnergyForm::PlusTwice => 2.0,
            EnergyForm::MinusHalf => -0.5,
            EnergyForm::PlusHalf => 0.5,
        }
    }
}

impl DmiForm {
    /// What the number is multiplied by in the energy.
    pub fn factor(self) -> f64 {
        match self {
            DmiForm::Plus => 1.0,
            DmiForm::Minus => -1.0,
            DmiForm::PlusTwice => 2.0,
            DmiForm::MinusTwice => -2.0,
            DmiForm::PlusHalf => 0.5,
            DmiForm::MinusHalf => -0.5,
        }
    }
}

impl Described for PairsSpec {
    const NAME: &'static str = "pairs";
    const SUMMARY: &'static str = "single pairs of a cell, each with a J, a vector D and a tensor";
    const EXAMPLE: &'static str = r#"{"pairs": {"bonds": [{"from": 0, "to": 0, "cell": [1, 0, 0], "J": "10 meV", "D": ["0 meV", "1 meV", "0 meV"]}], "convention": {"counting": "once", "energy": "-J"}}}"#;
}

impl PairSpec {
    fn hop(&self) -> Hop {
        Hop { atoms: [self.from, self.to], shift: self.cell }
    }

    /// M of E = m_iᵀ M m_j (meV).
    fn matrix(&self, convention: Convention) -> Block {
        let [x, y, z] = self.D.map_or([0.0; 3], |d| d.map(|e| e.0));
        let turn = cross_block(vector::scale(convention.dmi.factor(), [x, y, z]));
        let (factor, j) = (convention.energy.factor(), self.J.map_or(0.0, |j| j.0));
        [0, 1, 2].map(|r| {
            [0, 1, 2].map(|c| {
                let own = if r == c { j } else { 0.0 } + self.tensor.map_or(0.0, |t| t[r][c].0);
                factor * own + turn[r][c]
            })
        })
    }

    fn check(&self, lattice: &Lattice) -> Result<()> {
        let atoms = lattice.atoms.len();
        for (key, atom) in [("from", self.from), ("to", self.to)] {
            if atom >= atoms {
                let message = format!("found atom {atom}, but a cell has {atoms}, counted from 0");
                return Err(Error::invalid(key, message));
            }
        }
        let (hop, row) = (self.hop(), lattice.is_row());
        if hop == hop.back() {
            let message = "this bond joins an atom with itself: say with \"cell\" how many cells on the other one is";
            return Err(Error::invalid("cell", message));
        }
        if (row && hop.shift[1..] != [0, 0]) || !lattice.grid.holds(hop.shift) {
            return Err(Error::invalid("cell", "no two cells of the lattice are so far apart"));
        }
        if lattice.closes(hop) {
            return Err(Error::invalid("cell", "this joins sites with images of themselves, or wraps round a ring"));
        }
        if self.J.is_none() && self.D.is_none() && self.tensor.is_none() {
            return Err(Error::invalid("", "a bond needs a \"J\", a \"D\" or a \"tensor\""));
        }
        Ok(())
    }
}

impl PairsSpec {
    /// M of each hop that leads up (meV).
    fn matrices(&self, lattice: &Lattice) -> Result<Vec<(Hop, Block)>> {
        if self.bonds.is_empty() && self.file.is_none() {
            return Err(Error::invalid("bonds", "the list is empty: give the bonds of a cell, or a \"file\" of them"));
        }
        if self.file.is_some() {
            return Err(Error::invalid(
                "file",
                "a table is read with the config that names it: give the \"bonds\" here",
            ));
        }
        let convention = self.convention.unwrap_or_default();
        let mut found: Vec<(Hop, Block)> = Vec::new();
        for (k, pair) in self.bonds.iter().enumerate() {
            pair.check(lattice).map_err(|e| e.within(&format!("bonds[{k}]")))?;
            let counted = |hop: Hop| self.bonds.iter().filter(|other| other.hop() == hop).count();
            let (own, back) = (counted(pair.hop()), counted(pair.hop().back()));
            let message = match convention.counting {
                _ if own > 1 => "this bond is in the list more than once",
                Counting::Once if back > 0 => {
                    "this bond is in the list the other way too, but the convention counts each pair \"once\""
                }
                Counting::BothDirections if back == 0 => {
                    "this bond is not in the list the other way, but the convention counts \"both directions\""
                }
                _ => {
                    let matrix = pair.matrix(convention);
                    let up = lattice.leads_up(pair.hop());
                    let (hop, matrix) =
                        if up { (pair.hop(), matrix) } else { (pair.hop().back(), transposed(&matrix)) };
                    match found.iter_mut().find(|(other, _)| *other == hop) {
                        Some((_, sum)) => (0..3).for_each(|r| sum[r] = vector::add(sum[r], matrix[r])),
                        None => found.push((hop, matrix)),
                    }
                    continue;
                }
            };
            return Err(Error::invalid(format!("bonds[{k}]"), message));
        }
        Ok(found)
    }
}

impl TermBuilder for PairsSpec {
    fn build(&self, medium: &Medium) -> Result<Box<dyn EnergyTerm>> {
        let mut pairs = Pairs {
            exchange: Exchange { families: Vec::new() },
            dmi: Dmi { directions: Vec::new(), families: Vec::new() },
            rest: Vec::new(),
        };
        for (hop, matrix) in self.matrices(medium.lattice)? {
            let family = BondFamily::new(medium.lattice, 0, hop);
            let one = medium.on_bonds(&Profile::Same(1.0), vec![family], &Choice::default(), "bonds", |x, _| Ok(x))?;
            pairs.add(&one[0], &matrix);
        }
        Ok(Box::new(pairs))
    }
}

/// The three parts of all matrices.
#[derive(Clone, Debug)]
pub struct Pairs {
    exchange: Exchange,
    dmi: Dmi,
    rest: Vec<(Block, Couplings)>,
}

impl Pairs {
    /// Adds a family, whose bonds have these multiples of a matrix.
    fn add(&mut self, of: &Couplings, matrix: &Block) {
        let times = |s: f64| Couplings { family: of.family.clone(), mev: of.mev.iter().map(|x| s * x).collect() };
        let mean = (matrix[0][0] + matrix[1][1] + matrix[2][2]) / 3.0;
        self.exchange.families.push(times(-mean));
        let half = |r: usize, c: usize| 0.5 * (matrix[r][c] - matrix[c][r]);
        let d = [half(1, 2), half(2, 0), half(0, 1)];
        if let Some(direction) = vector::unit(d) {
            self.dmi.directions.push(direction);
            self.dmi.families.push(times(vector::norm(d)));
        }
        let even = |r: usize, c: usize| 0.5 * (matrix[r][c] + matrix[c][r]) - if r == c { mean } else { 0.0 };
        let rest = [0, 1, 2].map(|r| [0, 1, 2].map(|c| even(r, c)));
        if rest.iter().flatten().any(|x| *x != 0.0) {
            self.rest.push((rest, of.clone()));
        }
    }

    fn bonds(&self) -> impl Iterator<Item = (&Block, [usize; 2], f64)> {
        self.rest.iter().flat_map(|(block, c)| c.bonds().map(move |(sites, s)| (block, sites, s)))
    }
}

impl EnergyTerm for Pairs {
    fn name(&self) -> &'static str {
        PairsSpec::NAME
    }

    fn sites(&self) -> Option<usize> {
        let rest = || self.rest.first().map(|(_, couplings)| couplings.mev.len());
        self.exchange.sites().or(self.dmi.sites()).or_else(rest)
    }

    fn fits(&self, sites: usize) -> bool {
        self.exchange.fits(sites)
            && self.dmi.fits(sites)
            && self.rest.iter().all(|(_, couplings)| couplings.mev.len() == sites)
    }

    fn reference_mev(&self) -> f64 {
        self.exchange.reference_mev()
    }

    fn add_gradient(&self, m: Components, mut g: ComponentsMut, density: &mut [f64], range: Range<usize>) {
        self.exchange.add_gradient(m, g.reborrow(), density, range.clone());
        self.dmi.add_gradient(m, g.reborrow(), density, range.clone());
        let first = range.start;
        for (block, Couplings { family, mev: s }) in &self.rest {
            for segment in family.segments(range.clone()) {
                for i in segment.sites.clone() {
                    if let Some(next) = segment.next.map(|n| at(i, n)) {
                        let pull = vector::scale(s[i], multiply(block, m.get(next)));
                        g.add(i - first, pull);
                        density[i - first] += vector::dot(m.get(i), pull);
                    }
                    if let Some(k) = segment.previous.map(|n| at(i, n)) {
                        g.add(i - first, vector::scale(s[k], multiply(block, m.get(k))));
                    }
                }
            }
        }
    }

    fn add_hessian_product(&self, m: Components, v: Components, mut out: ComponentsMut) {
        self.exchange.add_hessian_product(m, v, out.reborrow());
        self.dmi.add_hessian_product(m, v, out.reborrow());
        for (block, [i, j], s) in self.bonds() {
            out.add(i, vector::scale(s, multiply(block, v.get(j))));
            out.add(j, vector::scale(s, multiply(block, v.get(i))));
        }
    }

    fn add_blocks(&self, m: Components, blocks: &mut Blocks) {
        self.exchange.add_blocks(m, blocks);
        self.dmi.add_blocks(m, blocks);
        for (block, couplings) in &self.rest {
            let Some(bonds) = blocks.of(&couplings.family) else { continue };
            couplings.bonds().for_each(|([i, _], s)| bonds.add(i, block.map(|row| vector::scale(s, row))));
        }
    }

    fn families(&self) -> Vec<&BondFamily> {
        self.exchange.families()
    }

    fn is_quadratic(&self) -> bool {
        true
    }

    fn axes(&self) -> Vec<Vector> {
        self.dmi.axes()
    }
}
