//! Spins of a file for the sites of a lattice.
//!
//! A mesh of nodes is the box of cells, x fastest: a node where there is no site is of no account, one at a vacant site may be empty.
//! Any other file lists the sites in their order; where it has positions too, they are those of the sites, in whatever unit.

use super::Images;
use crate::error::{Error, Result};
use crate::geometry::{Vector, vector};
use crate::lattice::Lattice;
use crate::words::counted;

/// A node farther than this from its site (lattice constants) is of another site.
const APART: f64 = 0.01;

impl Images {
    /// One of the images for the sites of a lattice; vacant sites without a spin are given their idle one. An error, that begins
    /// with what was found in the file, where the two do not fit.
    pub fn placed(&self, image: &[Vector], lattice: &Lattice) -> Result<Vec<Vector>> {
        let wrong = |message: String| Err(Error::invalid("", message));
        let (sites, kind) = (lattice.sites, if lattice.is_row() { "chain" } else { "lattice" });
        if let Some(mesh @ [x, y, z]) = self.mesh {
            let [p, q, r] = lattice.grid.size;
            let atoms = lattice.atoms.len();
            if mesh != [p, q, r] || atoms > 1 {
                let each = if atoms > 1 { format!(" of {atoms} atoms") } else { String::new() };
                return wrong(format!("has {x} × {y} × {z} nodes, but the {kind} has {p} × {q} × {r} cells{each}"));
            }
        } else if image.len() != sites {
            return wrong(format!(
                "has {}, but the {kind} has {}",
                counted(image.len(), "spin", "spins"),
                counted(sites, "site", "sites")
            ));
        } else if let Some(i) = self.misplaced(lattice) {
            return wrong(format!(
                "has node {i} at {:?}, where the {kind} has no site {i}: its sites are others",
                self.places[i]
            ));
        }
        let node = |i: usize| if self.mesh.is_some() { lattice.slots.slot(i) } else { i };
        let mut spins: Vec<Vector> = (0..sites).map(|i| image[node(i)]).collect();
        for i in (0..sites).filter(|i| lattice.vacant[*i] && spins[*i] == [0.0; 3]).collect::<Vec<_>>() {
            spins[i] = idle(lattice, i);
        }
        match spins.iter().position(|m| *m == [0.0; 3]) {
            None => Ok(spins),
            Some(i) => {
                wrong(format!("has a zero vector at node {}, where the {kind} has the spin of site {i}", node(i)))
            }
        }
    }
}

impl Images {
    /// A node that does not stand where its site does, after a shift and a change of unit; none where no positions are known.
    fn misplaced(&self, lattice: &Lattice) -> Option<usize> {
        if lattice.is_row() || lattice.sites < 2 || self.places.len() != lattice.sites {
            return None;
        }
        let sites: Vec<Vector> = (0..lattice.sites).map(|i| lattice.place(i)).collect();
        let from_middle = |all: &[Vector]| -> Vec<Vector> {
            let sum = all.iter().fold([0.0; 3], |sum, p| vector::add(sum, *p));
            all.iter().map(|p| vector::sub(*p, vector::scale(1.0 / all.len() as f64, sum))).collect()
        };
        let (nodes, sites) = (from_middle(&self.places), from_middle(&sites));
        let product = |a: &[Vector], b: &[Vector]| a.iter().zip(b).map(|(p, q)| vector::dot(*p, *q)).sum::<f64>();
        let unit = product(&nodes, &sites) / product(&sites, &sites);
        let is_near = |i: usize| vector::norm(vector::sub(nodes[i], vector::scale(unit, sites[i]))) <= APART * unit;
        (0..lattice.sites).find(|i| !is_near(*i))
    }
}

/// Where the idle spin of a vacant site points.
fn idle(lattice: &Lattice, site: usize) -> Vector {
    let given = lattice.frozen.iter().find(|f| f.sites.contains(&site)).and_then(|f| f.direction);
    given.map_or([0.0, 0.0, 1.0], |direction| direction.vector())
}
