//! Saddles that the symmetry of the lattice makes of one: each is a way out of its own.
//!
//! Tried are the mirror images of the lattice, the shifts of a ring, and changes of sign of the spins' x, y and z, alone and
//! together. An operation counts where it leaves the energy, the moments, the frozen sites and both minima as they are and moves
//! the saddle, rotations about a symmetry axis (and shifts, where they are zero modes) apart: those are in the volume of zero modes.

use crate::energy::Hamiltonian;
use crate::field::Components;
use crate::geometry::{Direction, Vector, vector};
use crate::lattice::{Lattice, SiteSymmetry};
use crate::sphere::{SAME, rotate_sites, turn_towards};
use crate::spins::Spins;

/// How many saddles are alike, and by what.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Equivalents {
    /// Their number, at least 1.
    pub count: usize,
    /// The symmetry that was found.
    pub by: String,
}

/// An operation on the spins of a lattice: sites mirrored or not, then signs on the components.
struct Operation<'a> {
    mirror: &'a SiteSymmetry,
    signs: Vector,
}

impl Operation<'_> {
    fn all(mirrors: &[SiteSymmetry]) -> impl Iterator<Item = Operation<'_>> {
        let signs = |k: u32| [0, 1, 2].map(|c| if k >> c & 1 == 1 { -1.0 } else { 1.0 });
        mirrors.iter().flat_map(move |mirror| (0..8).map(move |k| Operation { mirror, signs: signs(k) }))
    }

    fn apply(&self, m: &[f64]) -> Vec<f64> {
        let n = m.len() / 3;
        let at = |c: usize, i: usize| self.signs[c] * m[c * n + self.mirror.sites[i]];
        (0..3 * n).map(|k| at(k / n, k % n)).collect()
    }

    fn words(&self) -> String {
        let named = [("x", 0), ("y", 1), ("z", 2)];
        let flipped: Vec<&str> = named.iter().filter(|(_, c)| self.signs[*c] < 0.0).map(|(name, _)| *name).collect();
        let spins = format!("m_{} → −m_{}", flipped.join(""), flipped.join(""));
        let mirrored = &self.mirror.name;
        match (mirrored.is_empty(), flipped.is_empty()) {
            (false, true) => mirrored.clone(),
            (false, false) => format!("{mirrored} with {spins}"),
            _ => spins,
        }
    }
}

/// The saddles (or other states) that symmetry makes of this one, beside the same two minima. `shifts_are_free`: shifts of the ring
/// are a zero mode.
pub fn equivalent_saddles(
    h: &Hamiltonian,
    saddle: &[f64],
    minima: [&[f64]; 2],
    moments: &[f64],
    shifts_are_free: bool,
) -> Equivalents {
    let axes = h.symmetry_axes_at(saddle);
    if axes.len() > 1 {
        return Equivalents { count: 1, by: "not sought: the energy has no axis".into() };
    }
    let (ring, mirrors) = (h.lattice(), h.lattice().mirrors());
    let shifts = is_translation_symmetric(h, moments) && minima.iter().all(|m| period(ring, m) == 1);
    let sample = sample(h.sites());
    let energy_mev = h.energy_mev(&sample);
    let mut kept: Vec<Vec<f64>> = vec![saddle.to_vec()];
    let off = if shifts_are_free { SAME + 0.6 * largest_step(ring, saddle) } else { SAME };
    let mut by = Vec::new();
    for operation in Operation::all(&mirrors).skip(1) {
        let still = |m: &[f64]| same(&operation.apply(m), m, &axes, SAME);
        if !still(minima[0])
            || !still(minima[1])
            || !is_symmetric(h, moments, &sample, energy_mev, |m| operation.apply(m))
        {
            continue;
        }
        let image = operation.apply(saddle);
        let known = |k: &Vec<f64>| same(k, &image, &axes, off) || (shifts && is_shifted(ring, k, &image, &axes, off));
        if !kept.iter().any(known) {
            by.push(operation.words());
            kept.push(image);
        }
    }
    let mut count = kept.len();
    if shifts && !shifts_are_free {
        let places = period(ring, saddle);
        count *= places;
        if places > 1 {
            by.push(format!("{places} shifts of the ring"));
        }
    }
    let by = if by.is_empty() { "none found".into() } else { by.join(", ") };
    Equivalents { count, by }
}

/// Whether a ring's shift by one site leaves the energy and the moments as they are.
pub(super) fn is_translation_symmetric(h: &Hamiltonian, moments: &[f64]) -> bool {
    h.lattice().is_ring() && !h.has_frozen() && moments.iter().all(|n| *n == moments[0]) && {
        let m = sample(h.sites());
        keeps_energy(h, h.energy_mev(&m), &shifted(h.lattice(), &m, 1))
    }
}

/// After how many sites a ring's state repeats.
pub(super) fn period(ring: &Lattice, m: &[f64]) -> usize {
    let n = m.len() / 3;
    let repeats = |p: &usize| agree(m, m, SAME, |i| ring.along_ring(i, *p as isize));
    (1..n).filter(|p| n.is_multiple_of(*p)).find(repeats).unwrap_or(n)
}

/// A state without any symmetry: what leaves its energy as it is leaves all energies so.
fn sample(sites: usize) -> Vec<f64> {
    Spins::random(sites, 0x5a3e).as_slice().to_vec()
}

fn is_symmetric(
    h: &Hamiltonian,
    moments: &[f64],
    sample: &[f64],
    energy_mev: f64,
    operation: impl Fn(&[f64]) -> Vec<f64>,
) -> bool {
    // moments and frozen sites, marked in a field that only the sites' order can change
    let n = h.sites();
    let marks: Vec<f64> = (0..3 * n)
        .map(|k| match k / n {
            0 => moments[k % n],
            1 => f64::from(u8::from(h.is_frozen(k % n))),
            _ => 0.0,
        })
        .collect();
    let moved = operation(&marks);
    moved.iter().zip(&marks).all(|(a, b)| a.abs() == b.abs()) && keeps_energy(h, energy_mev, &operation(sample))
}

fn keeps_energy(h: &Hamiltonian, energy_mev: f64, m: &[f64]) -> bool {
    (energy_mev - h.energy_mev(m)).abs() <= 1e-12 * h.stiffness_mev() * (h.sites() as f64)
}

fn shifted(ring: &Lattice, m: &[f64], by: usize) -> Vec<f64> {
    let n = m.len() / 3;
    (0..3 * n).map(|k| m[k / n * n + ring.along_ring(k % n, by as isize)]).collect()
}

/// How much neighbours of a ring differ at most (rad): a state that slides freely may stand half a site beside its image.
fn largest_step(ring: &Lattice, m: &[f64]) -> f64 {
    let c = Components::new(m);
    let n = c.sites();
    (0..n).map(|i| vector::norm(vector::sub(c.get(ring.along_ring(i, 1)), c.get(i)))).fold(0.0, f64::max)
}

/// Whether a[place(i)] and b[i] are less than `off` (rad) apart for all i.
fn agree(a: &[f64], b: &[f64], off: f64, place: impl Fn(usize) -> usize) -> bool {
    let (a, b) = (Components::new(a), Components::new(b));
    (0..a.sites()).all(|i| {
        let d = vector::sub(a.get(place(i)), b.get(i));
        vector::dot(d, d) < off * off
    })
}

/// The same state but for a rotation about the axis.
fn same(a: &[f64], b: &[f64], axes: &[Vector], off: f64) -> bool {
    agree(&turned(a, b, axes), b, off, |i| i)
}

/// Whether a shift of a, turned about the axis, is b.
fn is_shifted(ring: &Lattice, a: &[f64], b: &[f64], axes: &[Vector], off: f64) -> bool {
    let n = a.len() / 3;
    if axes.is_empty() {
        return (1..n).any(|k| agree(a, b, off, |i| ring.along_ring(i, k as isize)));
    }
    // along the axis nothing turns: only where that part agrees is the whole compared
    let along = |m: &[f64], i: usize| vector::dot(Components::new(m).get(i), axes[0]);
    let fits = |k: usize| (0..n).all(|i| (along(a, ring.along_ring(i, k as isize)) - along(b, i)).abs() < off);
    (1..n).any(|k| fits(k) && same(&shifted(ring, a, k), b, axes, off))
}

/// a, turned about the axis to where it is nearest to b.
fn turned(a: &[f64], b: &[f64], axes: &[Vector]) -> Vec<f64> {
    let mut out = a.to_vec();
    if let [axis] = axes
        && let Ok(direction) = Direction::new(*axis)
    {
        let (sine, cosine) = turn_towards(Components::new(a), Components::new(b), *axis);
        rotate_sites(&mut out, 0..a.len() / 3, direction, libm::atan2(sine, cosine));
    }
    out
}
