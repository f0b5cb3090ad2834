//! What stands in for (H − θ)⁻¹ at one configuration, where modes of eigenvalues near θ are looked for.
//!
//! ```text
//! (M + s)⁻¹,   s = c̄ − θ where that is positive, at least the stiffness of the longest wave
//! ```
//! M is the stiffness between spins (see [`StandIn`]), each held by the others with |Σ_j J_ij| at least and Σ_j |J_ij| at most, and with
//! what it feels beside them more than the average c̄: H − c̄ where all spins point one way. A mode that is bound at a wall or a core has
//! θ far below c̄, and s is its distance from the waves of the rest; the lowest of those have θ near c̄, a long wave's stiffness apart.
//! (Preconditioned eigenvalue problems: Y. Notay, Numer. Linear Algebra Appl. 9, 21 (2002), doi:10.1002/nla.246.)

use super::TangentBasis;
use super::stand_in::{StandIn, on_their_own};
use crate::energy::Hamiltonian;
use crate::linalg::multigrid::Room;
use std::sync::{Mutex, PoisonError};

/// (H − θ)⁻¹, roughly, a symmetric positive map, in the tangent coordinates of a configuration.
pub struct Resolvent<'a> {
    /// Its c is the stiffness of the longest wave.
    stand_in: StandIn,
    /// c̄ (meV).
    average: f64,
    basis: &'a TangentBasis,
    /// Memory of solutions that are done.
    rooms: Mutex<Vec<Room>>,
}

impl<'a> Resolvent<'a> {
    /// At the configuration m with gradient g and the basis of its tangent space.
    pub fn at(h: &Hamiltonian, m: &[f64], g: &[f64], basis: &'a TangentBasis) -> Resolvent<'a> {
        let mut own = on_their_own(h, m, g);
        let exchange = h.exchange_matrix();
        let by_exchange = |i: usize, own: f64| {
            let least = exchange.among_equals[i];
            own.clamp(least, exchange.rows.diagonal(i).max(least))
        };
        let base: Vec<f64> = own.iter().enumerate().map(|(i, own)| by_exchange(i, *own)).collect();
        let free = || (0..h.sites()).filter(|i| !h.is_frozen(*i));
        let average = free().map(|i| own[i] - base[i]).sum::<f64>() / free().count().max(1) as f64;
        own.iter_mut().zip(base).for_each(|(own, base)| *own = base + (*own - base - average).max(0.0));
        let stand_in = StandIn::of(h, own, h.longest_wave_mev());
        Resolvent { stand_in, average, basis, rooms: Mutex::default() }
    }

    /// Takes a vector to what this makes of it for θ.
    pub fn apply(&self, x: &mut [f64], theta: f64) {
        let mut field = vec![0.0; x.len() / 2 * 3];
        let mut out = field.clone();
        self.basis.field(x, &mut field);
        let rooms = || self.rooms.lock().unwrap_or_else(PoisonError::into_inner);
        let mut room = rooms().pop().unwrap_or_default();
        self.stand_in.solve(self.shift(theta), &field, &mut out, &mut room);
        rooms().push(room);
        x.copy_from_slice(&self.basis.coordinates(&out));
    }

    /// s, to a factor 2: so coarse that few are built.
    fn shift(&self, theta: f64) -> f64 {
        let least = self.stand_in.c;
        let levels = 0.5 * libm::log2((self.average - theta).max(least) / least);
        least * (libm::exp2(2.0 * libm::round(levels).max(1.0)) - 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::test_terms::{hamiltonian, lattice, posed};
    use crate::geometry::Direction;
    use crate::hessian::assemble;
    use crate::linalg::{Asked, Wanted, lowest_modes, orthonormal, softest};
    use crate::spins::Spins;

    #[test]
    fn where_all_spins_point_along_a_hard_axis_it_leads_to_the_lowest_mode() {
        // θ < c̄ there, and M has no inverse; the lowest mode turns all spins to the easy axis: −2K
        let lattice = lattice(r#"{"square": {"cells": [14, 12]}}"#);
        let easy = r#"{"anisotropy": {"K": "0.1 meV", "axis": [0, 0, 1]}}"#;
        let h = hamiltonian(&lattice, &[r#"{"exchange": {"J": ["1 meV"]}}"#, easy]);
        let m = Spins::uniform(h.sites(), Direction::X);
        let mut g = vec![0.0; 3 * h.sites()];
        h.energy_gradient(m.as_slice(), &mut g);
        let (basis, mut turn) = (TangentBasis::at(m.as_slice()), Vec::new());
        basis.write_rotation([0.0, 0.0, 1.0], &mut turn);
        let (hessian, turns) = (assemble(&h, m.as_slice(), &g, &basis), orthonormal(vec![turn], 0.5));
        let nearly = Resolvent::at(&h, m.as_slice(), &g, &basis);
        assert!((nearly.average + 0.1).abs() < 1e-12, "{}", nearly.average);
        let apply = |x: &mut [f64], theta: f64| nearly.apply(x, theta);
        let modes = softest(
            &hessian,
            2,
            &turns,
            Asked { wanted: Wanted::Vectors, given: &[], by_factors: true },
            &apply,
            &|| false,
        )
        .expect("they are found");
        let told = modes.iter().map(|mode| mode.value);
        // the next is the longest wave along the longer side
        let wave = -0.2 + 2.0 * (1.0 - libm::cos(std::f64::consts::PI / 14.0));
        assert!(told.zip([-0.2, wave]).all(|(value, exact)| (value - exact).abs() < 1e-11), "{modes:?}");
    }

    /// A spin, of any length, at a place.
    type Spin = fn([f64; 3]) -> [f64; 3];

    #[test]
    fn it_leads_to_the_modes_of_antiferromagnets_spirals_and_walls() {
        let square = lattice(r#"{"square": {"cells": [24, 16]}}"#);
        let easy = r#"{"anisotropy": {"K": "0.1 meV", "axis": [0, 0, 1]}}"#;
        let states: [(&str, Spin); 3] = [
            ("-1 meV", |p| [0.0, 0.0, if (p[0] + p[1]).round() as i64 % 2 == 0 { 1.0 } else { -1.0 }]),
            ("1 meV\", \"0.1 meV\", \"-0.5 meV", |p| [(1.0 * p[0]).cos(), (1.0 * p[0]).sin(), 0.2]),
            ("1 meV", |p| [1.0 / (0.4 * (p[0] - 9.3)).cosh(), 0.0, (0.4 * (p[0] - 9.3)).tanh()]),
        ];
        for (j, spin) in states {
            let h = hamiltonian(&square, &[&format!(r#"{{"exchange": {{"J": ["{j}"]}}}}"#), easy]);
            let (m, g) = posed(&h, spin);
            let basis = TangentBasis::at(m.as_slice());
            let hessian = assemble(&h, m.as_slice(), &g, &basis);
            let nearly = Resolvent::at(&h, m.as_slice(), &g, &basis);
            let apply = |x: &mut [f64], theta: f64| nearly.apply(x, theta);
            let exact = lowest_modes(&hessian, 3, &[]);
            let modes = softest(
                &hessian,
                3,
                &[],
                Asked { wanted: Wanted::Values, given: &[], by_factors: true },
                &apply,
                &|| false,
            )
            .expect("they are found");
            for (mode, exact) in modes.iter().zip(&exact) {
                assert!((mode.value - exact.value).abs() < 1e-10, "{j}: {} {}", mode.value, exact.value);
            }
        }
    }
}
