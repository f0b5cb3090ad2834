//! Steps towards a saddle of index one without factors: the modes in question by iteration, the rest of Newton's step by conjugate
//! gradients.

use super::point::Point;
use super::state::State;
use super::step::Region;
use super::tolerances::{FEW, FIRST_SHIFT, LARGER, LAST_SHIFT};
use super::unfactored::Unfactored;
use crate::linalg::slab;
use std::mem::take;

impl Region<'_> {
    /// Writes the step (see [`Region::step`]) to `x`: up along the lowest mode, down along the other negative ones and all that is left;
    /// how many are negative. Where more than [`FEW`] are, down, by the least shift that leads there.
    pub(super) fn iterate(&mut self, here: &Point) -> usize {
        let h = self.h;
        let state = State { point: here.clone(), hessian: take(&mut self.hessian) };
        let mut rest = Unfactored::about(&h, here, h.longest_wave_mev());
        let force = here.field(&here.downhill());
        let mut count = self.modes.len().max(1);
        let negative = loop {
            let known: Vec<Vec<f64>> = self.modes.iter().map(|mode| here.basis.coordinates(mode)).collect();
            let modes = state.lowest_modes_beside(h, count, &known);
            self.modes = modes.iter().map(|mode| here.field(&mode.vector)).collect();
            let negative = modes.iter().filter(|mode| mode.value < 0.0).count();
            if modes.len() == count && !h.is_stopped() {
                let along: Vec<&[f64]> = self.modes.iter().map(Vec::as_slice).collect();
                if let Some(others) = rest.solve(&h, here, 0.0, &along, &force) {
                    here.basis.write_coordinates(others, &mut self.x);
                    for (k, mode) in modes.iter().enumerate() {
                        let along = -slab::dot(&mode.vector, &here.slope) / mode.value.abs();
                        slab::add_scaled(&mut self.x, if k == 0 { -along } else { along }, &mode.vector);
                    }
                    break negative;
                }
            }
            // a direction beside these is negative
            count += 1;
            if count > FEW || modes.is_empty() || h.is_stopped() {
                self.modes.clear();
                self.downhill(here, &mut rest, &force);
                break FEW + 1;
            }
        };
        self.hessian = state.hessian;
        negative
    }

    fn downhill(&mut self, here: &Point, equations: &mut Unfactored, force: &[f64]) {
        let scale = self.h.stiffness_mev();
        let mut shift = FIRST_SHIFT * scale;
        while shift < LAST_SHIFT * scale && !self.h.is_stopped() {
            if let Some(down) = equations.solve(&self.h, here, shift, &[], force) {
                here.basis.write_coordinates(down, &mut self.x);
                return;
            }
            shift *= LARGER;
        }
        here.write_downhill(&mut self.x);
    }
}
