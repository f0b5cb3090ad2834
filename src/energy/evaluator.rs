//! An energy in use: whoever evaluates it is counted, and learns that it is to stop.

use super::Hamiltonian;
use crate::control::{Call, Control};
use crate::field::Components;
use crate::record::{Count, Fingerprint};
use crate::words::quoted;
use std::ops::{Deref, Range};

/// A [`Hamiltonian`] whose gradients are counted by a [`Control`], if there is one.
#[derive(Clone, Copy, Debug)]
pub struct Evaluator<'a> {
    hamiltonian: &'a Hamiltonian,
    control: Option<&'a Control>,
}

impl<'a> Evaluator<'a> {
    /// Counted and stopped by `control`.
    pub fn new(hamiltonian: &'a Hamiltonian, control: &'a Control) -> Evaluator<'a> {
        Evaluator { hamiltonian, control: Some(control) }
    }

    /// The energy itself.
    pub fn hamiltonian(&self) -> &'a Hamiltonian {
        self.hamiltonian
    }

    /// [`Hamiltonian::energy_gradient`], counted.
    pub fn energy_gradient(&self, m: &[f64], g: &mut [f64]) -> f64 {
        self.count();
        self.finite(m, self.hamiltonian.energy_gradient(m, g))
    }

    /// [`Hamiltonian::density_gradient`], counted.
    pub fn density_gradient<R: Send>(
        &self,
        m: &[f64],
        g: &mut [f64],
        density: &mut [f64],
        rows: impl Iterator<Item = R>,
        each: impl Fn(Range<usize>, Components, R) + Sync,
    ) -> f64 {
        self.count();
        self.finite(m, self.hamiltonian.density_gradient(m, g, density, rows, each))
    }

    /// What was counted so far.
    pub fn evaluated(&self) -> Count {
        self.control.map(Control::evaluated).unwrap_or_default()
    }

    /// Counts a Hessian.
    pub(crate) fn count_hessian(&self) {
        if let Some(control) = self.control {
            control.count_hessian();
        }
    }

    /// Whether what uses this energy is to stop.
    pub fn is_stopped(&self) -> bool {
        self.control.is_some_and(Control::is_stopped)
    }

    /// A computation of a kind, with its input, to be recorded or answered from the record.
    pub fn call(&self, kind: &str, input: impl FnOnce(Fingerprint) -> Fingerprint) -> Call<'a> {
        Call::begin(self.control, kind, input)
    }

    /// An energy; one that is not finite ends what uses it.
    fn finite(&self, m: &[f64], energy: f64) -> f64 {
        if let (false, Some(control)) = (energy.is_finite(), self.control) {
            control.give_up(|| {
                let terms = self.hamiltonian.energies_mev(m).into_iter().filter(|(_, e)| !e.is_finite());
                let names: Vec<String> = terms.map(|(name, _)| quoted(name)).collect();
                format!("an energy on the way is not a finite number, that of {}", names.join(" and of "))
            });
        }
        energy
    }

    fn count(&self) {
        if let Some(control) = self.control {
            control.count();
        }
    }
}

impl<'a> From<&'a Hamiltonian> for Evaluator<'a> {
    /// Not counted, never stopped.
    fn from(hamiltonian: &'a Hamiltonian) -> Evaluator<'a> {
        Evaluator { hamiltonian, control: None }
    }
}

impl Deref for Evaluator<'_> {
    type Target = Hamiltonian;

    fn deref(&self) -> &Hamiltonian {
        self.hamiltonian
    }
}
