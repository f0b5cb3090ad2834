//! The anisotropy of single sites: what the terms of each site alone make of its sphere.
//!
//! ```text
//! E(m) = ½ mᵀ A m + ½ [E_h(m) + E_h(−m)]      A: block of the terms of second order; E_h: those of single sites of higher order
//! ```
//! A field, which is odd in m, drops out. Of the second order alone the eigenvalues of A say everything: the gap between the two lowest
//! is the curvature at the minima ±m₀, and half of it the barrier between them. Of higher orders the sphere is looked at in a set of
//! directions: the lowest of them leads to a minimum, whose least curvature is the gap, and the lowest way from there to its reverse
//! leads over the pass.

use super::{Blocks, EnergyTerm, Hamiltonian, multiply};
use crate::field::{Components, ComponentsMut};
use crate::geometry::{Vector, exp, tangent_basis, vector};
use crate::linalg::{eigenvalues_symmetric, slab};
use rayon::prelude::*;
use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

/// Directions on half a sphere.
const HALF: usize = 256;
/// Directions that are no further apart than so many times their mean distance are neighbours.
const NEAR: f64 = 1.5;
/// Newton's steps to a stationary direction at most, and the longest of them (rad).
const STEPS: usize = 40;
const LONGEST: f64 = 0.1;
/// Steps that are shorter end the search (rad).
const SHORT: f64 = 1e-9;
/// A slope of less than this part of the larger curvature where a search began is rest: at the pass itself there may be none.
const RESTS: f64 = 1e-6;
/// A curvature of less than this part of the other is none.
const FLAT: f64 = 1e-9;
/// Directions in which sites of one kind have the same energies, to the bit.
const GENERIC: [Vector; 3] = [[0.8, 0.48, 0.36], [-0.48, 0.36, 0.8], [0.36, -0.8, -0.48]];

/// What the terms of a site alone make of its sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SiteAnisotropy {
    /// Least curvature at the lowest minimum (meV): 2K of an easy axis.
    pub gap_mev: f64,
    /// Barrier from there to the reverse (meV): K of an easy axis.
    pub barrier_mev: f64,
}

/// The anisotropy of each site; `of_shape` counts magnetostatics as between spins that are all alike.
pub fn site_anisotropies(h: &Hamiltonian, of_shape: bool) -> Vec<SiteAnisotropy> {
    let others = h.coupling().pairs().filter(|_| of_shape).map(|pairs| pairs.sums_of_others());
    let mut forms: Vec<Vec<f64>> = h.constant_blocks().sites().map(|b| b.concat()).collect();
    for (form, other) in forms.iter_mut().zip(others.iter().flatten()) {
        slab::add_scaled(form, 1.0, &other.concat());
    }
    let is_higher =
        |t: &&dyn EnergyTerm| !t.is_quadratic() && t.families().is_empty() && t.coupling().pairs().is_none();
    let higher: Vec<&dyn EnergyTerm> = h.terms().iter().map(|t| &**t).filter(is_higher).collect();
    if higher.is_empty() {
        return forms.iter().map(|form| of_form(form)).collect();
    }
    OnSite { forms, higher }.anisotropies()
}

/// Of the second order alone.
fn of_form(form: &[f64]) -> SiteAnisotropy {
    let e = eigenvalues_symmetric(form, 3);
    SiteAnisotropy { gap_mev: e[1] - e[0], barrier_mev: 0.5 * (e[1] - e[0]) }
}

/// The energies of all sites, each alone.
struct OnSite<'a> {
    forms: Vec<Vec<f64>>,
    higher: Vec<&'a dyn EnergyTerm>,
}

/// A site's energy about a direction.
struct Local {
    energy: f64,
    /// Along the two vectors of the tangent basis.
    slope: [f64; 2],
    /// xx, xy, yy in that basis.
    curvature: [f64; 3],
}

impl OnSite<'_> {
    fn anisotropies(&self) -> Vec<SiteAnisotropy> {
        let (kind_of, firsts) = self.kinds();
        let directions = directions();
        let mut energies = vec![vec![0.0; HALF]; firsts.len()];
        for (d, direction) in directions.iter().take(HALF).enumerate() {
            let all = self.energies(&self.along(|_| *direction));
            firsts.iter().zip(&mut energies).for_each(|(i, of_kind)| of_kind[d] = all[*i]);
        }
        let near = neighbours(&directions);
        let places: Vec<[usize; 2]> = energies.par_iter().map(|e| lowest_and_pass(e, &near)).collect();
        let [minima, passes] = [(0, 1.0), (1, -1.0)].map(|(which, sign)| {
            let sampled = self.along(|i| directions[places[kind_of[i]][which]]);
            self.settled(&sampled, self.stationary(sampled.clone(), sign))
        });
        let (minima, passes) = (self.locals(&minima), self.locals(&passes));
        let of = |(minimum, pass): (&Local, &Local)| SiteAnisotropy {
            gap_mev: split(minimum.curvature).0[0].max(0.0),
            barrier_mev: (pass.energy - minimum.energy).max(0.0),
        };
        minima.iter().zip(&passes).map(of).collect()
    }

    /// The kind of every site, and the first site of each kind.
    fn kinds(&self) -> (Vec<usize>, Vec<usize>) {
        let energies = GENERIC.map(|d| self.energies(&self.along(|_| d)));
        let mut known: HashMap<[u64; 3], usize> = HashMap::new();
        let mut firsts = Vec::new();
        let kind = |i: usize| {
            *known.entry([0, 1, 2].map(|k| energies[k][i].to_bits())).or_insert_with(|| {
                firsts.push(i);
                firsts.len() - 1
            })
        };
        ((0..self.forms.len()).map(kind).collect(), firsts)
    }

    /// Each site along a direction.
    fn along(&self, direction: impl Fn(usize) -> Vector) -> Vec<f64> {
        let n = self.forms.len();
        let mut m = vec![0.0; 3 * n];
        (0..n).for_each(|i| ComponentsMut::new(&mut m).set(i, direction(i)));
        m
    }

    /// Energy and gradient of the higher orders at m.
    fn higher_at(&self, m: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let n = self.forms.len();
        let (mut density, mut g) = (vec![0.0; n], vec![0.0; 3 * n]);
        for term in &self.higher {
            term.add_gradient(Components::new(m), ComponentsMut::new(&mut g), &mut density, 0..n);
        }
        (density, g)
    }

    fn energies(&self, m: &[f64]) -> Vec<f64> {
        self.both(m, &reversed(m)).into_iter().map(|(energy, _)| energy).collect()
    }

    /// Energy and gradient of every site.
    fn both(&self, m: &[f64], back: &[f64]) -> Vec<(f64, Vector)> {
        let ((e, g), (e_back, g_back)) = (self.higher_at(m), self.higher_at(back));
        let (m, g, g_back) = (Components::new(m), Components::new(&g), Components::new(&g_back));
        let at = |(i, form): (usize, &Vec<f64>)| {
            let linear = multiply(&block(form), m.get(i));
            let own = vector::scale(0.5, vector::sub(g.get(i), g_back.get(i)));
            (0.5 * vector::dot(m.get(i), linear) + 0.5 * (e[i] + e_back[i]), vector::add(linear, own))
        };
        self.forms.iter().enumerate().map(at).collect()
    }

    fn locals(&self, m: &[f64]) -> Vec<Local> {
        let back = reversed(m);
        let mut blocks = Blocks::zeros(self.forms.len(), Vec::new());
        for term in &self.higher {
            term.add_blocks(Components::new(m), &mut blocks);
            term.add_blocks(Components::new(&back), &mut blocks);
        }
        let of = |(i, (energy, gradient)): (usize, (f64, Vector))| {
            let at = Components::new(m).get(i);
            let (x, y) = tangent_basis(at);
            let (form, higher) = (block(&self.forms[i]), blocks.at_site(i));
            let image = |v| vector::add(multiply(&form, v), vector::scale(0.5, multiply(&higher, v)));
            let (of_x, of_y, bent) = (image(x), image(y), vector::dot(at, gradient));
            Local {
                energy,
                slope: [vector::dot(x, gradient), vector::dot(y, gradient)],
                curvature: [vector::dot(x, of_x) - bent, vector::dot(x, of_y), vector::dot(y, of_y) - bent],
            }
        };
        self.both(m, &back).into_iter().enumerate().map(of).collect()
    }

    /// By Newton's steps to directions where each energy is stationary: down along the stiffer direction, and along the softer one down
    /// (`sign` 1, to a minimum) or up (−1, to a pass).
    fn stationary(&self, mut m: Vec<f64>, sign: f64) -> Vec<f64> {
        for _ in 0..STEPS {
            let locals = self.locals(&m);
            let mut moved = ComponentsMut::new(&mut m);
            let mut longest: f64 = 0.0;
            for (i, local) in locals.iter().enumerate() {
                let at = moved.as_read().get(i);
                let (x, y) = tangent_basis(at);
                let [a, b] = newton(local, sign);
                let step = vector::add(vector::scale(a, x), vector::scale(b, y));
                longest = longest.max(vector::norm(step));
                moved.set(i, exp(at, vector::scale((LONGEST / vector::norm(step)).min(1.0), step)));
            }
            if longest < SHORT {
                break;
            }
        }
        m
    }

    /// The directions that were found, where the energies are stationary there; else those that the search set out from.
    fn settled(&self, from: &[f64], found: Vec<f64>) -> Vec<f64> {
        let rests = |(local, before): (&Local, &Local)| {
            let [low, high] = split(before.curvature).0;
            libm::hypot(local.slope[0], local.slope[1]) <= RESTS * low.abs().max(high.abs())
        };
        let rest: Vec<bool> = self.locals(&found).iter().zip(&self.locals(from)).map(rests).collect();
        self.along(|i| Components::new(if rest[i] { &found } else { from }).get(i))
    }
}

/// A Newton step in the tangent basis; the softer direction is climbed where `sign` is −1.
fn newton(local: &Local, sign: f64) -> [f64; 2] {
    let (values, axis) = split(local.curvature);
    let [s, t] = local.slope;
    let along = [axis[0] * s + axis[1] * t, axis[0] * t - axis[1] * s];
    let stiffest = values[0].abs().max(values[1].abs());
    // along a ring of minima there is nowhere to go
    let is_flat = |k: usize| values[k].abs() <= FLAT * stiffest;
    let step =
        |k: usize, sign: f64| if is_flat(k) { 0.0 } else { (-sign * along[k] / values[k].abs()).clamp(-1.0, 1.0) };
    let [u, v] = [step(0, sign), step(1, 1.0)];
    [axis[0] * u - axis[1] * v, axis[1] * u + axis[0] * v]
}

/// Eigenvalues of a symmetric 2 × 2 matrix (xx, xy, yy), ascending, and the vector of the first.
fn split([xx, xy, yy]: [f64; 3]) -> ([f64; 2], [f64; 2]) {
    let (mean, half, apart) = (0.5 * (xx + yy), 0.5 * (xx - yy), libm::hypot(0.5 * (xx - yy), xy));
    let (sin, cos) = libm::sincos(0.5 * libm::atan2(xy, half));
    ([mean - apart, mean + apart], [-sin, cos])
}

fn block(form: &[f64]) -> super::Block {
    [0, 1, 2].map(|r| [form[3 * r], form[3 * r + 1], form[3 * r + 2]])
}

fn reversed(m: &[f64]) -> Vec<f64> {
    m.iter().map(|x| -x).collect()
}

/// Directions spread evenly over half a sphere along a golden spiral, and then their reverses.
fn directions() -> Vec<Vector> {
    let golden = PI * (3.0 - 5f64.sqrt());
    let one = |k: usize| {
        let z = (k as f64 + 0.5) / HALF as f64;
        let (sin, cos) = libm::sincos((golden * k as f64) % TAU);
        let across = (1.0 - z * z).sqrt();
        [across * cos, across * sin, z]
    };
    let half: Vec<Vector> = (0..HALF).map(one).collect();
    half.iter().copied().chain(half.iter().map(|d| vector::scale(-1.0, *d))).collect()
}

fn neighbours(directions: &[Vector]) -> Vec<Vec<usize>> {
    let chord = NEAR * (4.0 * PI / directions.len() as f64).sqrt();
    let is_near = |a: Vector, b: Vector| vector::norm(vector::sub(a, b)) < chord;
    let of = |a: &Vector| (0..directions.len()).filter(|j| is_near(*a, directions[*j])).collect();
    directions.iter().map(of).collect()
}

/// The lowest direction, and the highest on the lowest way from there to its reverse, by the energies on half the sphere: directions join
/// their neighbours from the lowest on, until these two are joined.
fn lowest_and_pass(energies: &[f64], near: &[Vec<usize>]) -> [usize; 2] {
    let mut order: Vec<usize> = (0..2 * HALF).collect();
    order.sort_by(|a, b| energies[a % HALF].total_cmp(&energies[b % HALF]));
    let lowest = order[0];
    let mut group: Vec<Option<usize>> = vec![None; 2 * HALF];
    for &place in &order {
        group[place] = Some(place);
        for &beside in &near[place] {
            if let Some(old) = group[beside] {
                group.iter_mut().filter(|g| **g == Some(old)).for_each(|g| *g = Some(place));
            }
        }
        if group[lowest] == group[(lowest + HALF) % (2 * HALF)] {
            return [lowest, place];
        }
    }
    [lowest, lowest]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::{Anisotropy, CubicAnisotropy, Zeeman};
    use crate::geometry::Direction;
    use crate::lattice::Chain;

    fn found(terms: Vec<Box<dyn EnergyTerm>>) -> SiteAnisotropy {
        let chain = Chain::open(2).resolve().unwrap();
        let all = site_anisotropies(&Hamiltonian::new(&chain, terms).unwrap(), true);
        assert_eq!(all[0], all[1]);
        all[0]
    }

    fn close(found: SiteAnisotropy, gap: f64, barrier: f64) {
        let apart = (found.gap_mev - gap).abs().max((found.barrier_mev - barrier).abs());
        assert!(apart < 1e-12, "{found:?}, expected {gap} and {barrier}");
    }

    fn along(axis: Vector, k: f64, k2: f64) -> Box<dyn EnergyTerm> {
        Box::new(Anisotropy { axis: Direction::new(axis).unwrap().vector(), k: vec![k; 2], k2: vec![k2; 2] })
    }

    fn axial(k: f64, k2: f64) -> Box<dyn EnergyTerm> {
        along([1.0, 2.0, 3.0], k, k2)
    }

    fn cubic(k: f64) -> Box<dyn EnergyTerm> {
        let (s, c) = libm::sincos(0.4);
        Box::new(CubicAnisotropy { axes: [[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]], k: vec![k; 2] })
    }

    #[test]
    fn the_second_order_has_a_gap_of_2_k_and_a_barrier_of_k() {
        close(found(vec![axial(0.5, 0.0)]), 1.0, 0.5);
        close(found(vec![axial(-0.5, 0.0)]), 0.0, 0.0);
    }

    #[test]
    fn the_fourth_order_is_seen_at_its_minima() {
        // on the ring of its pass it has no curvature at all
        for axis in [[1.0, 2.0, 3.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]] {
            close(found(vec![along(axis, 0.0, 0.5)]), 2.0, 0.5);
        }
        // a hill at c² = 0.3 between the pole and a ring of minima that are higher
        close(found(vec![axial(-0.3, 0.5)]), 1.4, 0.245);
        // edges, over face diagonals; diagonals, over face diagonals
        close(found(vec![cubic(0.8)]), 1.6, 0.2);
        close(found(vec![cubic(-0.6)]), 0.8, 0.05);
    }

    #[test]
    fn a_field_is_no_anisotropy() {
        let field = || Box::new(Zeeman::uniform(2, [0.3, 0.1, 0.7]));
        close(found(vec![cubic(0.8), field()]), 1.6, 0.2);
        close(found(vec![axial(0.5, 0.0), field()]), 1.0, 0.5);
    }

    #[test]
    fn small_higher_orders_change_the_second_by_little() {
        // 2 (K + 2 K₂) at the pole; the barrier is K + K₂
        close(found(vec![axial(0.5, 1e-6)]), 1.0 + 4e-6, 0.5 + 1e-6);
    }
}
