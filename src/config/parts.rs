//! The materials of a chain, one or one for each region, and what they give to its sites and bonds.
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
use crate::energy::{ExchangeSpec, Medium, Part, TermSpec};
use crate::error::{Error, Result};
use crate::lattice::{Chain, Selection, SiteMoment};
use crate::profile::Profile;
use crate::units::Moment;
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
    pub(super) fn part_of_sites(&self, chain: &Chain) -> Result<Vec<usize>> {
        let mut part = vec![0; chain.sites];
        for (k, own) in self.parts.iter().enumerate() {
            let Some(name) = &own.region else { continue };
            let region = chain.region(name).map_err(|e| self.text.locate(e.within(&own.key)))?;
            for i in region.indices(chain.sites, "site")? {
                let before = std::mem::replace(&mut part[i], k);
                if before != 0 {
                    let message = format!(
                        "site {i} is in the region {} too, and a site is made of one material: let the two not overlap",
                        quoted(self.parts[before].name())
                    );
                    return Err(self.text.locate(Error::invalid(format!("lattice.chain.regions.{name}"), message)));
                }
            }
        }
        Ok(part)
    }

    /// The chain with the moments of its regions, where there are several materials.
    pub(super) fn with_moments(&self, chain: &Chain, part: &[usize]) -> Result<Chain> {
        let mut all = chain.clone();
        for (k, own) in self.parts.iter().enumerate() {
            let sites: Vec<usize> = (0..chain.sites).filter(|i| part[*i] == k).collect();
            own.material.fits(sites.len()).map_err(|e| own.locate(&self.text, e))?;
            if self.parts.len() == 1 {
                break;
            }
            let medium = Medium::new(chain, None, None);
            let values = match (&own.material.moment, &own.material.Ms) {
                (Some(m), _) => m.values(sites.len(), "site", |m, _| Ok(m.0)).map_err(|e| e.within("moment")),
                (None, Some(ms)) => {
                    ms.values(sites.len(), "site", |ms, k| medium.cell_moment(ms, sites[k])).map_err(|e| e.within("Ms"))
                }
                (None, None) => continue,
            };
            let values = values.map_err(|e| own.locate(&self.text, e))?;
            let has_own = |i: usize| chain.moments.iter().any(|m| m.sites.position(i).is_some());
            let (sites, moments) =
                sites.into_iter().zip(values).filter(|(i, _)| !has_own(*i)).map(|(i, m)| (i, Moment(m))).unzip();
            let (sites, moment) = (Selection::List(sites), Some(Profile::List(moments)));
            all.moments.push(SiteMoment { sites, moment, Ms: None });
        }
        Ok(all)
    }

    /// The parts of a chain by their materials, with their shares of the bonds between them; none where there is one material only.
    pub(super) fn divided(&self, chain: &Chain, part: &[usize]) -> Result<Vec<Part>> {
        let n = chain.sites;
        let inside = |k: usize| Part { inside: part.iter().map(|p| *p == k).collect(), shares: Vec::new() };
        let mut parts: Vec<Part> = (0..self.parts.len()).map(inside).collect();
        if parts.len() == 1 {
            return Ok(Vec::new());
        }
        let exchange: Vec<_> = (0..parts.len())
            .map(|k| {
                let medium = Medium { part: Some(parts[k].clone()), ..Medium::new(chain, None, None) };
                total(&self.parts[k].material.energy, &medium)
            })
            .collect();
        let given = total(&self.config.energy, &Medium::new(chain, None, None));
        let of = |list: &[Vec<f64>], shell: usize, i: usize| list.get(shell - 1).map_or(0.0, |j| j[i]);
        let shells = exchange.iter().map(Vec::len).max().unwrap_or(0).max(1);
        for shell in 1..=shells {
            parts.iter_mut().for_each(|p| p.shares.push(vec![1.0; n]));
            for i in 0..chain.bonds(shell) {
                let (p, q) = (part[i], part[(i + shell) % n]);
                if p == q {
                    continue;
                }
                let [a, b] = [p, q].map(|k| of(&exchange[k], shell, i));
                let [share_p, share_q] = match a * b > 0.0 {
                    true => [b / (a + b), a / (a + b)],
                    false if a == b => [0.5; 2],
                    // beyond the nearest neighbours the mean with nothing is nothing
                    false if shell > 1 && a * b == 0.0 => [0.0; 2],
                    false if of(&given, shell, i) != 0.0 => [0.0; 2],
                    false => return Err(self.apart(i, shell, [p, q], [a, b])),
                };
                parts[p].shares[shell - 1][i] = share_p;
                parts[q].shares[shell - 1][i] = share_q;
            }
        }
        Ok(parts)
    }

    /// Two materials whose exchange has no mean.
    fn apart(&self, bond: usize, shell: usize, parts: [usize; 2], j: [f64; 2]) -> Error {
        let [p, q] = parts.map(|k| quoted(self.parts[k].name()));
        let zeros = "\"0 meV\", ".repeat(shell - 1);
        let message = format!(
            "sites {bond} and {} are of the regions {p} and {q}, whose exchanges there, {:.4} meV and {:.4} meV, have no mean: say \
             what joins them in \"energy\": {{\"exchange\": {{\"J\": [{zeros}\"5 meV\"], \"bonds\": [{bond}]}}}}",
            (bond + shell) % self.chain().sites,
            j[0],
            j[1]
        );
        self.text.locate(Error::invalid("material", message))
    }
}

/// The exchange of all these terms (meV) by shell and bond. What cannot be built is told where it is built.
fn total(specs: &[TermSpec], medium: &Medium) -> Vec<Vec<f64>> {
    let exchange = |spec: &TermSpec| match spec {
        TermSpec::Exchange(exchange) => ExchangeSpec::shells(exchange, medium).ok(),
        _ => None,
    };
    let mut sum: Vec<Vec<f64>> = Vec::new();
    for shells in specs.iter().filter_map(exchange) {
        sum.resize(sum.len().max(shells.len()), vec![0.0; medium.chain.sites]);
        for (sum, shell) in sum.iter_mut().zip(shells) {
            sum.iter_mut().zip(shell).for_each(|(sum, j)| *sum += j);
        }
    }
    sum
}
