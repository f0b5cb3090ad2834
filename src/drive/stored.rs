//! What the computations of a run result in, as bytes and back.
//!
//! A state is stored as its spins: its gradient and Hessian follow from them to the last bit.

use super::bytes::{Reader, Writer};
use super::climb::Found;
use super::ends::{Relaxed, WayDown};
use super::minimum::{Link, Minimum};
use super::outcome::HistoryRow;
use super::top::Top;
use super::{Scales, Stop};
use crate::energy::Evaluator;
use crate::path::Path;
use crate::saddle::{Refined, Spectrum, State, Verdict};
use crate::spins::Spins;

/// A result that can be stored. Reading gives nothing where the bytes are not such a result.
pub trait Stored: Sized {
    /// Tells the kinds of computations apart.
    const KIND: usize;

    fn write(&self, w: &mut Writer);

    fn read(r: &mut Reader, h: Evaluator) -> Option<Self>;
}

/// Spins of a chain of the Hamiltonian's length.
fn row_of(r: &mut Reader, h: Evaluator) -> Option<Vec<f64>> {
    r.row().filter(|row| row.len() == 3 * h.sites() && are_unit(row))
}

/// A unit tangent vector (3N) of such a chain.
fn tangent(r: &mut Reader, h: Evaluator) -> Option<Vec<f64>> {
    r.finite_row().filter(|row| row.len() == 3 * h.sites() && row.iter().all(|x| x.abs() < 2.0))
}

/// Whether component-major numbers are unit vectors.
pub fn are_unit(slab: &[f64]) -> bool {
    let n = slab.len() / 3;
    (0..n).all(|i| ((0..3).map(|c| slab[c * n + i].powi(2)).sum::<f64>() - 1.0).abs() < 1e-9)
}

fn spins(r: &mut Reader, h: Evaluator) -> Option<Spins> {
    row_of(r, h).map(|row| Spins::from_unit_components(&row))
}

fn way_down(r: &mut Reader) -> Option<WayDown> {
    Some(WayDown { site: r.whole()?, direction: [r.real()?, r.real()?, r.real()?], fallen_mev: r.real()? })
}

impl Stored for [Relaxed; 2] {
    const KIND: usize = 1;

    fn write(&self, w: &mut Writer) {
        for end in self {
            w.row(end.spins.as_slice());
            w.real(end.max_torque_mev);
            w.whole(end.steps);
            w.real(end.largest_rotation_rad);
            w.flag(end.left.is_some());
            if let Some(way) = &end.left {
                w.whole(way.site);
                way.direction.into_iter().for_each(|c| w.real(c));
                w.real(way.fallen_mev);
            }
            w.flag(end.converged);
        }
    }

    fn read(r: &mut Reader, h: Evaluator) -> Option<[Relaxed; 2]> {
        let mut one = || {
            Some(Relaxed {
                spins: spins(r, h)?,
                max_torque_mev: r.finite()?,
                steps: r.count()?,
                largest_rotation_rad: r.real()?,
                left: if r.flag()? { Some(way_down(r)?) } else { None },
                converged: r.flag()?,
            })
        };
        Some([one()?, one()?])
    }
}

impl Stored for Scales {
    const KIND: usize = 2;

    fn write(&self, w: &mut Writer) {
        [self.stiffness_mev, self.exchange_mev, self.wall_width_sites].into_iter().for_each(|x| w.real(x));
    }

    fn read(r: &mut Reader, _: Evaluator) -> Option<Scales> {
        Some(Scales {
            stiffness_mev: r.finite().filter(|c| *c > 0.0)?,
            exchange_mev: r.finite()?,
            wall_width_sites: r.finite()?,
        })
    }
}

const VERDICTS: [Verdict; 5] = [Verdict::Saddle, Verdict::Flat, Verdict::HigherIndex, Verdict::Left, Verdict::Stalled];

impl Stored for Found {
    const KIND: usize = 3;

    fn write(&self, w: &mut Writer) {
        let Found { top, refined } = self;
        w.row(&top.m);
        w.row(&top.tau);
        w.real(top.energy_mev);
        w.real(top.s);
        w.whole(top.image);
        w.whole(VERDICTS.iter().position(|v| *v == refined.verdict).unwrap_or(VERDICTS.len()));
        w.row(&refined.state.m);
        w.row(&refined.valley);
        w.whole(refined.steps);
        w.whole(refined.factorisations);
        w.whole(refined.index);
        w.real(refined.curvature_mev);
        w.real(refined.rotation_rad);
    }

    fn read(r: &mut Reader, h: Evaluator) -> Option<Found> {
        let top =
            Top { m: row_of(r, h)?, tau: tangent(r, h)?, energy_mev: r.finite()?, s: r.finite()?, image: r.count()? };
        let refined = Refined {
            verdict: *VERDICTS.get(r.whole()?)?,
            state: State::at(h, row_of(r, h)?),
            valley: tangent(r, h)?,
            steps: r.count()?,
            factorisations: r.count()?,
            index: r.count()?,
            curvature_mev: r.real()?,
            rotation_rad: r.real()?,
        };
        Some(Found { top, refined })
    }
}

impl Stored for Vec<Found> {
    const KIND: usize = 4;

    fn write(&self, w: &mut Writer) {
        w.whole(self.len());
        self.iter().for_each(|found| found.write(w));
    }

    fn read(r: &mut Reader, h: Evaluator) -> Option<Vec<Found>> {
        r.list(|r| Found::read(r, h))
    }
}

impl Stored for Spectrum {
    const KIND: usize = 5;

    fn write(&self, w: &mut Writer) {
        [self.negative, self.flat, self.zero].into_iter().for_each(|n| w.whole(n));
        w.real(self.floor_mev);
        w.real(self.norm_mev);
        w.row(&self.lowest_mev);
    }

    fn read(r: &mut Reader, _: Evaluator) -> Option<Spectrum> {
        Some(Spectrum {
            negative: r.count()?,
            flat: r.count()?,
            zero: r.count()?,
            floor_mev: r.finite()?,
            norm_mev: r.finite()?,
            lowest_mev: r.finite_row()?,
        })
    }
}

impl Stored for Minimum {
    const KIND: usize = 6;

    fn write(&self, w: &mut Writer) {
        w.row(self.spins.as_slice());
        w.real(self.energy_mev);
        w.real(self.max_torque_mev);
        self.spectrum.write(w);
    }

    fn read(r: &mut Reader, h: Evaluator) -> Option<Minimum> {
        Some(Minimum {
            spins: spins(r, h)?,
            energy_mev: r.finite()?,
            max_torque_mev: r.finite()?,
            spectrum: Spectrum::read(r, h)?,
        })
    }
}

impl Stored for Link {
    const KIND: usize = 7;

    fn write(&self, w: &mut Writer) {
        self.found.write(w);
        self.spectrum.write(w);
        self.before.write(w);
        self.after.write(w);
        self.fallen_mev.iter().for_each(|x| w.real(*x));
        for way in &self.ways {
            w.whole(way.len());
            way.iter().for_each(|spins| w.row(spins.as_slice()));
        }
        w.whole(usize::from(self.given));
    }

    fn read(r: &mut Reader, h: Evaluator) -> Option<Link> {
        Some(Link {
            found: Found::read(r, h)?,
            spectrum: Spectrum::read(r, h)?,
            before: Minimum::read(r, h)?,
            after: Minimum::read(r, h)?,
            fallen_mev: [r.real()?, r.real()?],
            ways: [r.list(|r| spins(r, h))?, r.list(|r| spins(r, h))?],
            given: r.count()? == 1,
        })
    }
}

impl Stored for Vec<Path> {
    const KIND: usize = 8;

    fn write(&self, w: &mut Writer) {
        w.whole(self.len());
        for path in self {
            w.whole(path.images());
            (0..path.images()).for_each(|k| w.row(path.image(k)));
        }
    }

    fn read(r: &mut Reader, h: Evaluator) -> Option<Vec<Path>> {
        r.list(|r| {
            let images = r.list(|r| spins(r, h))?;
            (images.len() >= 2).then(|| Path::new(&images))
        })
    }
}

impl Stored for Stop {
    const KIND: usize = 9;

    fn write(&self, w: &mut Writer) {
        let (word, numbers) = match *self {
            Stop::Converged { rotation, tolerance } => (0, (0, rotation, tolerance)),
            Stop::MaxEvaluations { evaluations, rotation, tolerance } => (1, (evaluations, rotation, tolerance)),
            Stop::Stalled { evaluations, rotation, tolerance } => (2, (evaluations, rotation, tolerance)),
            Stop::NotFinite => (3, (0, 0.0, 0.0)),
        };
        w.whole(word);
        w.whole(numbers.0);
        w.real(numbers.1);
        w.real(numbers.2);
    }

    fn read(r: &mut Reader, _: Evaluator) -> Option<Stop> {
        let (word, evaluations, rotation, tolerance) = (r.whole()?, r.count()?, r.finite()?, r.finite()?);
        match word {
            0 => Some(Stop::Converged { rotation, tolerance }),
            1 => Some(Stop::MaxEvaluations { evaluations, rotation, tolerance }),
            2 => Some(Stop::Stalled { evaluations, rotation, tolerance }),
            3 => Some(Stop::NotFinite),
            _ => None,
        }
    }
}

/// Rows of a history.
pub fn write_history(rows: &[HistoryRow], w: &mut Writer) {
    w.whole(rows.len());
    for row in rows {
        w.whole(row.iteration);
        w.whole(row.images);
        w.real(row.max_perpendicular_torque_mev);
        w.real(row.largest_predicted_rotation_rad);
        w.real(row.highest_image_mev);
        w.real(row.length_rad);
    }
}

pub fn read_history(r: &mut Reader) -> Option<Vec<HistoryRow>> {
    r.list(|r| {
        Some(HistoryRow {
            iteration: r.count()?,
            images: r.count()?,
            max_perpendicular_torque_mev: r.real()?,
            largest_predicted_rotation_rad: r.real()?,
            highest_image_mev: r.real()?,
            length_rad: r.real()?,
        })
    })
}
