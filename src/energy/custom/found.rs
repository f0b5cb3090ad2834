//! What a custom term does not say of itself, found by asking it at random states.

use super::check::{acts_as_its_blocks, random_tangent};
use super::{Custom, CustomEnergy, Reach, wrong};
use crate::error::Result;
use crate::field::{Components, ComponentsMut};
use crate::lattice::{BondFamily, Hop, Lattice};
use crate::linalg::slab;
use crate::spins::Spins;

/// A reach is looked for up to so many lattice constants.
const FURTHEST: f64 = 4.0;
/// So many sites may all act on each other.
const MOST_ALL: usize = 600;
/// A gradient is linear if it departs from that by less than this part.
const LINEAR: f64 = 1e-10;

/// Whether the energy is of second degree, which is asked for or checked: then g(a) + g(b) = g(a + b) + g(0).
pub(super) fn is_quadratic(energy: &dyn CustomEnergy, sites: usize) -> Result<bool> {
    let said = energy.is_quadratic();
    if said == Some(false) {
        return Ok(false);
    }
    let gradient = |m: &[f64]| {
        let mut g = vec![0.0; m.len()];
        energy.gradient(Components::new(m), ComponentsMut::new(&mut g));
        g
    };
    let [a, b] = [21, 22].map(|seed| Spins::random(sites, seed).as_slice().to_vec());
    let sum: Vec<f64> = a.iter().zip(&b).map(|(a, b)| 1.5 * a + b).collect();
    let [ga, gb, both, none] = [&a, &b, &sum, &vec![0.0; 3 * sites]].map(|m| gradient(m));
    let apart = (0..3 * sites).map(|k| (1.5 * ga[k] + gb[k] - both[k] - 1.5 * none[k]).abs()).fold(0.0, f64::max);
    let scale = slab::max_abs(&ga).max(slab::max_abs(&gb)).max(slab::max_abs(&both));
    // a number that is none makes this false
    let linear = apart <= LINEAR * scale && both.iter().chain(&none).all(|x| x.is_finite());
    match said {
        Some(true) if !linear => Err(wrong(
            energy.name(),
            "it is said to be quadratic, but its gradient is not linear in the components of the spins",
        )),
        _ => Ok(linear),
    }
}

impl Custom {
    /// Sets the bonds that it acts over: those within its reach, or the fewest that are enough.
    pub(super) fn find_families(&mut self, lattice: &Lattice) -> Result<()> {
        match self.energy.reach() {
            Reach::Within(reach) => {
                if !(reach >= 0.0 && reach.is_finite()) {
                    return Err(wrong(self.energy.name(), format!("found a reach of {reach}, expected 0 or more")));
                }
                self.set_families(families(lattice, reach));
                match self.is_enough() {
                    true => Ok(()),
                    false => Err(wrong(
                        self.energy.name(),
                        format!("it acts between sites further apart than its reach of {reach}"),
                    )),
                }
            }
            Reach::All => self.join_all(lattice),
            Reach::Unknown => {
                let mut lengths = vec![0.0];
                lengths.extend(hops(lattice, FURTHEST).into_iter().map(|(length, _)| length * (1.0 + 1e-9)));
                lengths.dedup_by(|a, b| (*a - *b).abs() < 1e-6);
                for length in lengths {
                    self.set_families(families(lattice, length));
                    if self.is_enough() {
                        return Ok(());
                    }
                    if self.neighbours.classes() == self.sites {
                        break;
                    }
                }
                self.join_all(lattice)
            }
        }
    }

    fn join_all(&mut self, lattice: &Lattice) -> Result<()> {
        if self.sites > MOST_ALL {
            let message = format!(
                "it acts between sites more than {FURTHEST} lattice constants apart: give its \"reach\"; at most {MOST_ALL} sites \
                 may all act on each other, here there are {}",
                self.sites
            );
            return Err(wrong(self.energy.name(), message));
        }
        self.set_families(families(lattice, f64::INFINITY));
        match self.is_enough() {
            true => Ok(()),
            false => {
                Err(wrong(self.energy.name(), "its gradient is not that of an energy: its Hessian is not symmetric"))
            }
        }
    }

    /// Whether the blocks of its bonds are its whole Hessian.
    fn is_enough(&self) -> bool {
        let m = Spins::random(self.sites, 23);
        let v = random_tangent(m.as_slice(), 24);
        acts_as_its_blocks(self, &self.families, m.as_slice(), &v)
    }
}

/// The families of all hops no longer than that, in lattice constants; in a row one for each number of sites, up to there.
fn families(lattice: &Lattice, reach: f64) -> Vec<BondFamily> {
    let hops = hops(lattice, reach.min(1e9)).into_iter();
    hops.enumerate().map(|(k, (_, hop))| BondFamily::new(lattice, k + 1, hop)).collect()
}

fn hops(lattice: &Lattice, reach: f64) -> Vec<(f64, Hop)> {
    lattice.hops_within(reach)
}
