//! The sum of the terms, on a lattice.

use super::construction::{constant_blocks, fit, stiffness_mev, twice};
use super::exchange_matrix::ExchangeMatrix;
use super::{Blocks, Coupling, EnergyTerm, symmetry_axes};
use crate::error::{Error, Result};
use crate::field::{Components, ComponentsMut, TILE, project_row, tiles};
use crate::geometry::{Vector, vector};
use crate::lattice::Lattice;
use crate::linalg::{Layout, slab};
use multiversion::multiversion;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

/// From this many sites on, the tiles of one image are shared among threads.
pub const LONG: usize = 32 * 1024;
/// Sites in one pass where gradients are not kept.
const ROW: usize = 64;
/// Factors of no more than so many solutions' arithmetic are quicker than an iteration with those of one unknown a site.
const CHEAP: f64 = 4.0;
/// Tiles of a long chain that are worth waking a thread for.
const TILES: usize = 16;

/// The energy of the spins of a lattice: named terms, their sum, its derivatives and its symmetry.
#[derive(Debug)]
pub struct Hamiltonian {
    lattice: Arc<Lattice>,
    sites: usize,
    frozen: Vec<bool>,
    has_frozen: bool,
    terms: Vec<Box<dyn EnergyTerm>>,
    /// The term that joins all pairs of sites.
    long: Option<usize>,
    /// Which terms are asked for all sites together.
    whole: Vec<bool>,
    blocks: Blocks,
    exchange: OnceLock<ExchangeMatrix>,
    layout: Layout,
    forgoes_factors: bool,
    reach: usize,
    stiffness: f64,
    axes: Vec<Vector>,
}

/// Unit vectors whose vector product is shorter are parallel.
const PARALLEL: f64 = 1e-6;
impl Hamiltonian {
    /// The sum of `terms` on `lattice`; an error where one does not fit it, by its number of sites, the lengths of its arrays or its bonds,
    /// or two reach from all sites to all.
    pub fn new(lattice: &Lattice, terms: Vec<Box<dyn EnergyTerm>>) -> Result<Hamiltonian> {
        for term in &terms {
            fit(lattice, term.as_ref()).map_err(|message| Error::invalid(term.name(), message))?;
        }
        let mut long = terms.iter().enumerate().filter(|(_, t)| t.coupling().pairs().is_some());
        let (long, second) = (long.next().map(|(k, _)| k), long.next());
        if let (Some(first), Some((_, second))) = (long, second) {
            return Err(twice(terms[first].name(), second.name()));
        }
        let (sites, frozen) = (lattice.sites, lattice.is_frozen());
        let blocks = constant_blocks(lattice, &terms);
        let reach = if lattice.is_row() { blocks.bond.len() } else { 0 };
        let mut h = Hamiltonian {
            lattice: Arc::new(lattice.clone()),
            sites,
            has_frozen: frozen.contains(&true),
            frozen,
            axes: symmetry_axes(&terms, sites),
            layout: lattice.layout(&blocks.bond.iter().map(|bonds| &bonds.family).collect::<Vec<_>>()),
            blocks,
            forgoes_factors: false,
            exchange: OnceLock::new(),
            whole: terms.iter().map(|t| t.is_whole()).collect(),
            terms,
            long,
            reach,
            stiffness: 0.0,
        };
        let gradient = |m: &[f64], g: &mut [f64]| {
            h.energy_gradient(m, g);
        };
        h.stiffness = stiffness_mev(&h.blocks, h.is_quadratic(), gradient);
        Ok(h)
    }

    /// Where the spins are.
    pub fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// The same, to be held on to.
    pub fn shared_lattice(&self) -> &Arc<Lattice> {
        &self.lattice
    }

    /// Number of sites.
    pub fn sites(&self) -> usize {
        self.sites
    }

    /// In a row, how many sites away the furthest partner with a block is, where a long-ranged term goes on; 0 in other lattices.
    pub fn reach(&self) -> usize {
        self.reach
    }

    /// The stiffness (meV) of the longest wave that the lattice holds, roughly: that of the stiffest spin over the square of its length.
    pub fn longest_wave_mev(&self) -> f64 {
        let length = self.lattice.sites_along() as f64;
        self.stiffness / (length * length)
    }

    /// The couplings between spins, of one unknown a site.
    pub fn exchange_matrix(&self) -> &ExchangeMatrix {
        self.exchange.get_or_init(|| ExchangeMatrix::of(&self.blocks, &self.frozen))
    }

    /// How a matrix of its bonds is kept, a long-ranged term apart.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// From now on no matrix of its bonds is factorised, as where memory would not hold the factors: equations are solved and modes
    /// found by iteration, and negative directions are bounded, not counted. Only of lattices whose factors are sparse.
    pub fn forgo_factors(&mut self) {
        self.forgoes_factors = self.has_dear_factors();
    }

    /// Whether it does.
    pub fn forgoes_factors(&self) -> bool {
        self.forgoes_factors
    }

    /// Whether factors of a matrix of its bonds take so long that solutions by iteration are quicker.
    pub fn has_dear_factors(&self) -> bool {
        self.solutions_a_factor() > CHEAP
    }

    /// The arithmetic of factors of a matrix of its bonds, in those of a solution by them, where it is of blocks; else 0.
    pub fn solutions_a_factor(&self) -> f64 {
        if let Layout::Sparse(plan) = &self.layout { plan.solutions() } else { 0.0 }
    }

    /// Whether site `i` never moves.
    pub fn is_frozen(&self, i: usize) -> bool {
        self.frozen[i]
    }

    /// Whether any site never moves.
    pub fn has_frozen(&self) -> bool {
        self.has_frozen
    }

    /// Which sites are coupled: as by the term that joins all pairs, if there is one.
    pub fn coupling(&self) -> Coupling<'_> {
        self.long.map_or(Coupling::Local, |k| self.terms[k].coupling())
    }

    /// The terms, in the order of the config.
    pub fn terms(&self) -> &[Box<dyn EnergyTerm>] {
        &self.terms
    }

    /// The largest stiffness or torque that a site can feel (meV), roughly; also the stiffness given to frozen sites.
    pub fn stiffness_mev(&self) -> f64 {
        self.stiffness
    }

    /// What the Hessian is uncertain by (meV), rounding apart: what long-ranged and custom terms leave out.
    pub fn hessian_error_mev(&self) -> f64 {
        self.coupling().error_mev() + self.terms.iter().map(|t| t.hessian_error_mev()).sum::<f64>()
    }

    /// Unit vectors about which a rotation of all spins leaves every term as it is: none, one, or x, y and z.
    pub fn symmetry_axes(&self) -> &[Vector] {
        &self.axes
    }

    /// Axes that the terms single out, no two of them parallel.
    pub fn own_axes(&self) -> Vec<Vector> {
        let mut own: Vec<Vector> = Vec::new();
        for axis in self.axes.iter().copied().chain(self.terms.iter().flat_map(|t| t.axes())) {
            if own.iter().all(|known| vector::norm(vector::cross(*known, axis)) > PARALLEL) {
                own.push(axis);
            }
        }
        own
    }

    /// The symmetry axes that also leave the frozen spins of `m` as they are.
    pub fn symmetry_axes_at(&self, m: &[f64]) -> Vec<Vector> {
        let m = Components::new(m);
        let frozen: Vec<Vector> = (0..self.sites).filter(|&i| self.frozen[i]).map(|i| m.get(i)).collect();
        let fixed = |axis: &Vector| frozen.iter().all(|s| vector::norm(vector::cross(*axis, *s)) < 1e-12);
        if self.axes.len() == 3 && !frozen.is_empty() {
            return frozen.first().copied().filter(|s| fixed(s)).into_iter().collect();
        }
        self.axes.iter().copied().filter(fixed).collect()
    }

    /// Energy of the terms' reference states (meV): E = reference + energy above it.
    pub fn reference_mev(&self) -> f64 {
        self.terms.iter().map(|t| t.reference_mev()).sum()
    }

    /// Energy above the reference (meV), and the Euclidean gradient ∂E/∂m (meV) in `g`.
    ///
    /// # Panics
    /// Where one of the two is not of three numbers a site.
    pub fn energy_gradient(&self, m: &[f64], g: &mut [f64]) -> f64 {
        self.assert_fields([m, g]);
        let far = self.add_far(m, g);
        let tile = |(first, g): (usize, ComponentsMut)| -> f64 {
            let mut density = [0.0; TILE];
            let density = &mut density[..g.x.len()];
            self.near_tile(m, first, g, density);
            slab::sum(density)
        };
        far.map_or(0.0, |density| slab::sum(&density)) + self.total(tiles(g), tile)
    }

    /// The same, and the energy density of every site above the reference (meV). `each` is called for every tile of sites, with
    /// its gradient, as soon as that is known, and with what there is for that tile in `rows`.
    ///
    /// # Panics
    /// Where `m` or `g` is not of three numbers a site, or `density` not of one.
    pub fn density_gradient<R: Send>(
        &self,
        m: &[f64],
        g: &mut [f64],
        density: &mut [f64],
        rows: impl Iterator<Item = R>,
        each: impl Fn(Range<usize>, Components, R) + Sync,
    ) -> f64 {
        self.assert_fields([m, g]);
        assert_eq!(density.len(), self.sites, "densities are one number a site");
        let far = self.add_far(m, g);
        let tile = |(((first, mut g), density), row): (((usize, ComponentsMut), &mut [f64]), R)| -> f64 {
            density.fill(0.0);
            self.near_tile(m, first, g.reborrow(), density);
            let sites = first..first + density.len();
            if let Some(far) = &far {
                slab::add_scaled(density, 1.0, &far[sites.clone()]);
            }
            each(sites, g.as_read(), row);
            slab::sum(density)
        };
        self.total(tiles(g).zip(density.chunks_mut(TILE)).zip(rows), tile)
    }

    /// Fields of another number of sites would be read wrongly without a sign of it.
    fn assert_fields<const N: usize>(&self, fields: [&[f64]; N]) {
        for field in fields {
            assert_eq!(field.len(), 3 * self.sites, "a field is three numbers a site");
        }
    }

    /// The sum of what `tile` gives for every tile of sites; of long chains they are done side by side.
    fn total<T: Send>(&self, tiles: impl Iterator<Item = T>, tile: impl Fn(T) -> f64 + Send + Sync) -> f64 {
        let sums: Vec<f64> = if self.sites >= LONG {
            tiles.collect::<Vec<_>>().into_par_iter().with_min_len(TILES).map(tile).collect()
        } else {
            tiles.map(tile).collect()
        };
        slab::sum(&sums)
    }

    /// The terms that are asked for all sites together.
    fn whole_terms(&self) -> impl Iterator<Item = &dyn EnergyTerm> {
        self.terms.iter().zip(&self.whole).filter(|(_, whole)| **whole).map(|(t, _)| &**t)
    }

    /// What the terms that are asked for all sites together add: their gradient in `g`, and their density.
    fn add_far(&self, m: &[f64], g: &mut [f64]) -> Option<Vec<f64>> {
        self.whole.contains(&true).then(|| {
            g.fill(0.0);
            let mut density = vec![0.0; self.sites];
            for t in self.whole_terms() {
                t.add_gradient(Components::new(m), ComponentsMut::new(g), &mut density, 0..self.sites);
            }
            density
        })
    }

    /// The other terms on the sites from `first` on: their gradient, added to that of the whole ones, and their densities,
    /// added to `density`.
    fn near_tile(&self, m: &[f64], first: usize, mut g: ComponentsMut, density: &mut [f64]) {
        let range = first..first + g.x.len();
        if !self.whole.contains(&true) {
            g.x.fill(0.0);
            g.y.fill(0.0);
            g.z.fill(0.0);
        }
        for (t, _) in self.terms.iter().zip(&self.whole).filter(|(_, whole)| !**whole) {
            t.add_gradient(Components::new(m), g.reborrow(), density, range.clone());
        }
    }

    /// −∂E/∂m on the tangent planes (meV), zero on frozen sites, from the Euclidean gradient.
    pub fn force(&self, m: &[f64], g: &[f64], force: &mut [f64]) {
        self.force_row(0, Components::new(m), Components::new(g), ComponentsMut::new(force));
    }

    /// [`force`](Self::force) on a row of sites, from site `first` on.
    pub fn force_row(&self, first: usize, m: Components, g: Components, mut force: ComponentsMut) {
        let negate = |f: &mut [f64], g: &[f64]| f.iter_mut().zip(g).for_each(|(f, g)| *f = -g);
        negate(force.x, g.x);
        negate(force.y, g.y);
        negate(force.z, g.z);
        project_row(m, force.reborrow());
        self.hold_frozen_row(first, force);
    }

    /// Clears a vector field on the frozen sites.
    pub fn hold_frozen(&self, v: &mut [f64]) {
        self.hold_frozen_row(0, ComponentsMut::new(v));
    }

    /// Clears a row of a vector field, from site `first` on, on the frozen sites.
    pub fn hold_frozen_row(&self, first: usize, mut v: ComponentsMut) {
        if self.has_frozen {
            for i in (0..v.x.len()).filter(|i| self.frozen[first + i]) {
                v.set(i, [0.0; 3]);
            }
        }
    }

    /// Energy density of every site above the reference (meV).
    ///
    /// # Panics
    /// Where `m` is not of three numbers a site.
    pub fn density(&self, m: &[f64]) -> Vec<f64> {
        self.assert_fields([m]);
        let mut density = vec![0.0; self.sites];
        let mut gradient = [0.0; 3 * ROW];
        for (k, density) in density.chunks_mut(ROW).enumerate() {
            let gradient = ComponentsMut::new(&mut gradient[..3 * density.len()]);
            self.near_tile(m, k * ROW, gradient, density);
        }
        self.whole_terms().for_each(|t| super::add_density(t, m, &mut density));
        density
    }

    /// Total energy by name of term (meV); terms of one name are added up.
    pub fn energies_mev(&self, m: &[f64]) -> Vec<(&str, f64)> {
        let mut sums: Vec<(&str, f64)> = Vec::new();
        for t in &self.terms {
            let e = t.reference_mev() + slab::sum(&super::density_of(t.as_ref(), m));
            match sums.iter_mut().find(|(name, _)| *name == t.name()) {
                Some((_, sum)) => *sum += e,
                None => sums.push((t.name(), e)),
            }
        }
        sums
    }

    /// Total energy (meV).
    ///
    /// # Panics
    /// Where `m` is not of three numbers a site.
    pub fn energy_mev(&self, m: &[f64]) -> f64 {
        self.reference_mev() + slab::sum(&self.density(m))
    }

    /// E(a) − E(b) (meV), summed from differences of densities.
    ///
    /// # Panics
    /// Where one of the two is not of three numbers a site.
    pub fn difference_mev(&self, a: &[f64], b: &[f64]) -> f64 {
        let mut d = self.density(a);
        slab::add_scaled(&mut d, -1.0, &self.density(b));
        slab::sum(&d)
    }

    /// H v of the Riemannian Hessian (meV) for a tangent field v: P (A v) − (m·g) v.
    ///
    /// # Panics
    /// Where one of the four is not of three numbers a site.
    pub fn hessian_product(&self, m: &[f64], g: &[f64], v: &[f64], out: &mut [f64]) {
        self.assert_fields([m, g, v, out]);
        out.fill(0.0);
        let (mc, gc, vc) = (Components::new(m), Components::new(g), Components::new(v));
        for t in &self.terms {
            t.add_hessian_product(mc, vc, ComponentsMut::new(out));
        }
        let o = ComponentsMut::new(out);
        curve(mc, gc, vc, o.x, o.y, o.z);
        self.hold_frozen(out);
    }

    /// Hessian blocks that do not depend on the configuration (all of them, if every term is quadratic).
    pub fn constant_blocks(&self) -> &Blocks {
        &self.blocks
    }

    fn is_quadratic(&self) -> bool {
        self.terms.iter().all(|t| t.is_quadratic())
    }

    /// All Hessian blocks at `m`, or `None` where they are the constant ones.
    pub fn varying_blocks(&self, m: Components) -> Option<Blocks> {
        if self.is_quadratic() {
            return None;
        }
        let mut blocks = self.blocks.clone();
        for t in self.terms.iter().filter(|t| !t.is_quadratic()) {
            t.add_blocks(m, &mut blocks);
        }
        Some(blocks)
    }
}

/// P o − (m·g) v of a tangent field v, in place of o.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn curve(m: Components, g: Components, v: Components, ox: &mut [f64], oy: &mut [f64], oz: &mut [f64]) {
    let n = m.x.len();
    let [m, g, v] = [m, g, v].map(|f| f.range(0..n));
    let (ox, oy, oz) = (&mut ox[..n], &mut oy[..n], &mut oz[..n]);
    for i in 0..n {
        let bent = m.x[i] * g.x[i] + m.y[i] * g.y[i] + m.z[i] * g.z[i];
        let radial = m.x[i] * ox[i] + m.y[i] * oy[i] + m.z[i] * oz[i];
        ox[i] -= radial * m.x[i] + bent * v.x[i];
        oy[i] -= radial * m.y[i] + bent * v.y[i];
        oz[i] -= radial * m.z[i] + bent * v.z[i];
    }
}
