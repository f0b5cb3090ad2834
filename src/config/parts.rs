//! The materials of a lattice, one or one for each region, and what they give to its sites and bonds.
//!
//! A site takes the moment and the terms of its own region's material. On a bond between two regions with the exchange J and J′ each
//! bond term of a material counts with the share of the other's exchange:
//!
//! ```text
//! J J′/(J + J′) + J′ J/(J + J′) = 2 J J′/(J + J′)          D J′/(J + J′) + D′ J/(J + J′)
//! ```
//! for the two halves of the bond are springs in series, which turn by angles as 1/J and 1/J′. (S. V. Patankar, Numerical Heat
//! Transfer and Fluid Flow, 1980, §4.2-3.) Where J and J′ are not of one sign there is no such mean, and a term of the config has to
//! say what joins the two.

use super::Loaded;
use super::material::{DEFAULT, Material};
use super::text::Text;
use crate::energy::{Couplings, Medium, Part, TermSpec};
use crate::error::{Error, Result};
use crate::lattice::{BondFamily, Lattice};
use crate::words::quoted;

/// A material of a config.
#[derive(Clone, Debug)]
pub struct PartMaterial {
    /// Its region; nothing where it is the only one or the default.
    pub region: Option<String>,
    /// What it says.
    pub material: Material,
    /// Its own file, if it has one.
    pub text: Option<Text>,
    /// Its key in the config: `material`, `material.default`, `material.top`.
    pub key: String,
}

impl PartMaterial {
    /// The error with its place, in the material's own file or in the config.
    pub(super) fn locate(&self, config: &Text, error: Error) -> Error {
        match &self.text {
            Some(own) => own.locate(error),
            None => config.locate(error.within(&self.key)),
        }
    }

    fn name(&self) -> &str {
        self.region.as_deref().unwrap_or(DEFAULT)
    }
}

impl Loaded {
    /// Which of the materials each site is made of.
    pub(super) fn part_of_sites(&self) -> Result<Vec<usize>> {
        let mut part = vec![0; self.lattice.sites];
        for (k, own) in self.parts.iter().enumerate() {
            let Some(name) = &own.region else { continue };
            for i in self.lattice.named(name).map_err(|e| self.text.locate(e.within(&own.key)))? {
                let before = std::mem::replace(&mut part[i], k);
                if before != 0 {
                    let message = format!(
                        "site {i} is in the region {} too, and a site is made of one material: let the two not overlap",
                        quoted(self.parts[before].name())
                    );
                    return Err(self
                        .text
                        .locate(Error::invalid(format!("lattice.{}.regions.{name}", self.lattice.kind), message)));
                }
            }
        }
        Ok(part)
    }

    /// The lattice with the moments of its regions, where there are several materials.
    pub(super) fn with_moments(&self, part: &[usize]) -> Result<Lattice> {
        let (lattice, mut all) = (&self.lattice, self.lattice.clone());
        for (k, own) in self.parts.iter().enumerate() {
            let sites: Vec<usize> = (0..lattice.sites).filter(|i| part[*i] == k).collect();
            own.material.fits(sites.len()).map_err(|e| own.locate(&self.text, e))?;
            if self.parts.len() == 1 {
                break;
            }
            let medium = Medium::new(lattice, None, None);
            let values = match (&own.material.moment, &own.material.Ms) {
                (Some(m), _) => {
                    m.values(lattice.places_of(&sites), "site", |m, _| Ok(m.0)).map_err(|e| e.within("moment"))
                }
                (None, Some(ms)) => ms
                    .values(lattice.places_of(&sites), "site", |ms, k| medium.cell_moment(ms, sites[k]))
                    .map_err(|e| e.within("Ms")),
                (None, None) => continue,
            };
            for (i, moment) in sites.iter().zip(values.map_err(|e| own.locate(&self.text, e))?) {
                all.moments_mub[*i].get_or_insert(moment);
            }
        }
        Ok(all)
    }

    /// The parts of a lattice by their materials, with their shares of the bonds between them; none where there is one material only.
    pub(super) fn divided(&self, lattice: &Lattice, part: &[usize]) -> Result<Vec<Part>> {
        let inside = |k: usize| Part { inside: part.iter().map(|p| *p == k).collect(), shares: Vec::new() };
        let mut parts: Vec<Part> = (0..self.parts.len()).map(inside).collect();
        if parts.len() == 1 {
            return Ok(Vec::new());
        }
        let exchange: Vec<_> = (0..parts.len())
            .map(|k| {
                let medium = Medium { part: Some(parts[k].clone()), ..Medium::new(lattice, None, None) };
                total(&self.parts[k].material.energy, &medium)
            })
            .collect();
        let given = total(&self.config.energy, &Medium::new(lattice, None, None));
        let mut families: Vec<&BondFamily> = Vec::new();
        let joined = lattice.shell(1);
        for family in joined.iter().chain(exchange.iter().flatten().map(|c| &c.family)) {
            if !families.iter().any(|known| known.hop == family.hop) {
                families.push(family);
            }
        }
        for family in families {
            let mev = |list: &[Couplings], i: usize| -> f64 {
                list.iter().filter(|c| c.family.hop == family.hop).map(|c| c.mev[i]).sum()
            };
            let mut shares = vec![vec![1.0; lattice.sites]; parts.len()];
            for [i, j] in family.bonds() {
                let [p, q] = [i, j].map(|i| part[i]);
                if p == q {
                    continue;
                }
                // of a bond that leaves a part half belongs to it
                let [a, b] = [p, q].map(|k| mev(&exchange[k], i));
                [shares[p][i], shares[q][i]] = match a * b > 0.0 {
                    true => [b / (a + b), a / (a + b)],
                    false if a == b => [0.5; 2],
                    // beyond the nearest neighbours the mean with nothing is nothing
                    false if family.shell > 1 && a * b == 0.0 => [0.0; 2],
                    false if mev(&given, i) != 0.0 => [0.0; 2],
                    false => return Err(self.apart([i, j], family.shell, [p, q], [2.0 * a, 2.0 * b])),
                };
            }
            parts.iter_mut().zip(shares).for_each(|(part, shares)| part.shares.push((family.hop, shares)));
        }
        Ok(parts)
    }

    /// Two materials whose exchange has no mean.
    fn apart(&self, sites: [usize; 2], shell: usize, parts: [usize; 2], j: [f64; 2]) -> Error {
        let [p, q] = parts.map(|k| quoted(self.parts[k].name()));
        let zeros = "\"0 meV\", ".repeat(shell - 1);
        let message = format!(
            "sites {} and {} are of the regions {p} and {q}, whose exchanges there, {:.4} meV and {:.4} meV, have no mean: say \
             what joins them in \"energy\": {{\"exchange\": {{\"J\": [{zeros}\"5 meV\"], \"bonds\": [{}]}}}}",
            sites[0], sites[1], j[0], j[1], sites[0]
        );
        self.text.locate(Error::invalid("material", message))
    }
}

/// The exchange of all these terms (meV). What cannot be built is told where it is built.
fn total(specs: &[TermSpec], medium: &Medium) -> Vec<Couplings> {
    let exchange = |spec: &TermSpec| match spec {
        TermSpec::Exchange(exchange) => exchange.couplings(medium).ok(),
        _ => None,
    };
    specs.iter().filter_map(exchange).flatten().collect()
}
