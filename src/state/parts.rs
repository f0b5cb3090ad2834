//! The parts of a state, each built in the sense that is its own.
//!
//! A part takes the sense that another state's has taken, where it is there in that. Otherwise it first takes the one that is cheapest
//! where it stands, see [`Surroundings`], whatever the others do: of two layers with opposite Dzyaloshinskii–Moriya interactions each
//! has a sense that is wrong for the other. Then one part after the other takes the sense of least energy of the whole, until none
//! gains by that: what little a part prefers by itself gives way to a strong coupling.

use super::sense::{Sense, Senses, cheapest};
use super::surroundings::Surroundings;
use super::{StateContext, StateSpec};
use crate::energy::Hamiltonian;
use crate::error::{Error, Result};
use crate::geometry::Vector;
use crate::lattice::Lattice;
use std::collections::HashSet;

/// The name of what is in no region, and of a state that is whole.
pub(super) const DEFAULT: &str = "default";

/// A state that some sites are of.
pub(super) struct Part<'s> {
    /// Of its region.
    pub(super) name: String,
    /// Where it stands in the config.
    pub(super) place: String,
    pub(super) spec: &'s StateSpec,
    pub(super) sites: Vec<usize>,
}

/// A part built in one of its senses, on all sites of the lattice.
struct Built {
    sense: Option<Sense>,
    vectors: Vec<Vector>,
}

/// A part in all senses that it may take, and the one that it takes.
struct Open<'p> {
    part: &'p Part<'p>,
    built: Vec<Built>,
    taken: usize,
}

impl<'s> Part<'s> {
    /// The only one of a state.
    pub(super) fn whole(spec: &'s StateSpec, lattice: &Lattice) -> Part<'s> {
        Part { name: DEFAULT.into(), place: String::new(), spec, sites: (0..lattice.sites).collect() }
    }

    /// The same in a region of some sites; names and places are told from outside.
    pub(super) fn inside(self, name: &str, place: &str, sites: &[usize]) -> Part<'s> {
        let region: HashSet<usize> = sites.iter().copied().collect();
        let both = self.sites.into_iter().filter(|i| region.contains(i)).collect();
        Part { name: format!("{name}.{}", self.name), place: format!("{place}.{}", self.place), sites: both, ..self }
    }

    /// Whether it depends on what is around it.
    fn has_a_choice(&self, context: &StateContext) -> bool {
        let member = self.spec.member();
        context.hamiltonian.is_some() && (member.is_sized_by_energy() || !member.senses(context).is_empty())
    }

    /// In the sense that another state has taken, or else in all in which it is there.
    fn choices(&self, context: &StateContext) -> Result<Vec<Built>> {
        let open = self.spec.member().senses(context);
        let built = |sense: Option<Sense>| -> Result<Built> {
            let vectors = self.spec.arranged(&StateContext { sense, ..*context });
            Ok(Built { sense, vectors: vectors.map_err(|e| self.located(e))? })
        };
        let taken = context.taken.and_then(|taken| taken.among(&self.name, &open));
        if context.hamiltonian.is_none() || open.is_empty() {
            return Ok(vec![built(taken.or(open.first().copied()))?]);
        }
        let may_miss = self.spec.member().may_miss_senses();
        match taken.map(|sense| built(Some(sense))) {
            Some(Ok(as_taken)) => return Ok(vec![as_taken]),
            Some(Err(e)) if !may_miss => return Err(e),
            _ => {}
        }
        let (mut there, mut wrong) = (Vec::new(), None);
        for sense in open {
            match built(Some(sense)) {
                Ok(one) => there.push(one),
                Err(e) if may_miss => wrong = wrong.or(Some(e)),
                Err(e) => return Err(e),
            }
        }
        wrong.filter(|_| there.is_empty()).map_or(Ok(there), Err)
    }

    fn located(&self, e: Error) -> Error {
        if self.place.is_empty() { e } else { e.within(&self.place) }
    }

    fn put(&self, built: &[Vector], all: &mut [Vector]) {
        self.sites.iter().for_each(|i| all[*i] = built[*i]);
    }
}

/// One vector a site, and the senses that the parts have taken.
pub(super) fn settled(parts: Vec<Part>, context: &StateContext) -> Result<(Vec<Vector>, Senses)> {
    let mut open = match &parts[..] {
        [whole] => vec![first_choice(whole, context)?],
        several => by_themselves(several, context)?,
    };
    let mut all = vec![[0.0, 0.0, 1.0]; context.lattice.sites];
    open.iter().for_each(|one| one.part.put(&one.built[one.taken].vectors, &mut all));
    if let (Some(h), true) = (context.hamiltonian, open.len() > 1) {
        together(h, &mut open, &mut all, context)?;
    }
    let mut senses = Senses::default();
    for one in &open {
        if let Some(sense) = one.built[one.taken].sense {
            senses.add(&one.part.name, sense);
        }
    }
    Ok((all, senses))
}

/// Each in the sense that is cheapest where it stands.
fn by_themselves<'p>(parts: &'p [Part<'p>], context: &StateContext) -> Result<Vec<Open<'p>>> {
    let mut settled = vec![None; context.lattice.sites];
    let mut open = Vec::new();
    let (choosing, fixed): (Vec<&Part>, Vec<&Part>) = parts.iter().partition(|part| part.has_a_choice(context));
    for part in fixed {
        let around = Surroundings::new(&part.sites, &vec![None; context.lattice.sites]);
        let one = first_choice(part, &StateContext { around: Some(&around), ..*context })?;
        part.sites.iter().for_each(|i| settled[*i] = Some(one.built[one.taken].vectors[*i]));
        open.push(one);
    }
    for part in choosing {
        let around = Surroundings::new(&part.sites, &settled);
        open.push(first_choice(part, &StateContext { around: Some(&around), ..*context })?);
    }
    Ok(open)
}

/// A part in the sense that is cheapest where it stands.
fn first_choice<'p>(part: &'p Part<'p>, context: &StateContext) -> Result<Open<'p>> {
    let built = part.choices(context)?;
    let taken = match context.hamiltonian {
        Some(h) if built.len() > 1 => {
            let densities: Result<Vec<Vec<f64>>> = built.iter().map(|one| density(h, one, context)).collect();
            cheapest(h, densities?.into_iter())
        }
        _ => 0,
    };
    Ok(Open { part, built, taken })
}

/// The energies of the sites that count for a part (meV).
fn density(h: &Hamiltonian, built: &Built, context: &StateContext) -> Result<Vec<f64>> {
    let vectors = built.vectors.clone();
    let Some(around) = context.around else { return Ok(h.density(context.spins(vectors)?.as_slice())) };
    Ok(around.counted(h.density(context.spins(around.surrounded(vectors))?.as_slice())))
}

/// Turns one part after the other to the sense of least energy of the whole, until none gains by more than rounding.
fn together(h: &Hamiltonian, open: &mut [Open], all: &mut [Vector], context: &StateContext) -> Result<()> {
    let mut turned = true;
    while std::mem::take(&mut turned) {
        for one in open.iter_mut().filter(|one| one.built.len() > 1) {
            // the sense that it has is the first, which stays where another one is equal to rounding
            let order: Vec<usize> =
                [one.taken].into_iter().chain((0..one.built.len()).filter(|k| *k != one.taken)).collect();
            let mut densities = Vec::new();
            for k in &order {
                one.part.put(&one.built[*k].vectors, all);
                densities.push(h.density(context.spins(all.to_vec())?.as_slice()));
            }
            let taken = order[cheapest(h, densities.into_iter())];
            turned |= taken != one.taken;
            one.taken = taken;
            one.part.put(&one.built[taken].vectors, all);
        }
    }
    Ok(())
}
