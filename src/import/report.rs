//! What is told of a model: the convention, bonds by shell, and energies to compare with a paper.

use super::{Bond, Model, Spiral};
use crate::geometry::{Vector, vector};

/// Bonds as long as each other to this part are of one shell.
const ALIKE: f64 = 1e-4;
/// Shells that are told.
const SHELLS: usize = 24;
/// Steps of q from 0 to half a reciprocal vector, among which the lowest spiral is looked for.
const STEPS: i32 = 60;

/// The bonds of a shell between two species.
struct Shell<'a> {
    species: [&'a str; 2],
    distance: f64,
    bonds: Vec<&'a Bond>,
}

impl Model {
    /// Rows of a key and a value; a row without a key goes on with the one before.
    pub fn report(&self) -> Vec<(&'static str, String)> {
        let mut rows = vec![("files", self.files.join(", "))];
        rows.extend(under("convention", self.convention.clone()));
        rows.push(("lattice", self.lattice()));
        rows.extend(under("atoms", self.kinds()));
        rows.extend(under("shells", self.shells()));
        rows.extend(under("energies", self.energies()));
        rows.extend(under("note", self.notes.clone()));
        rows
    }

    fn lattice(&self) -> String {
        let spacing = self.spacing_nm.map_or(String::new(), |nm| format!(", spacing {nm:.6} nm"));
        let ([a, b, c], periodic) = (self.cells.unwrap_or([1; 3]), self.periodic.unwrap_or([false; 3]));
        let flags = periodic.map(|flag| if flag { "periodic" } else { "open" }).join(", ");
        let atoms = self.atoms.len();
        format!("{a} × {b} × {c} cells, {flags}, {atoms} atom{} a cell{spacing}", if atoms == 1 { "" } else { "s" })
    }

    /// "2 Fe, 2.2 μ_B".
    fn kinds(&self) -> Vec<String> {
        let mut kinds: Vec<(usize, String)> = Vec::new();
        for atom in &self.atoms {
            let kind = format!("{}, {} μ_B", atom.species, atom.moment_mub);
            match kinds.iter_mut().find(|(_, other)| *other == kind) {
                Some((count, _)) => *count += 1,
                None => kinds.push((1, kind)),
            }
        }
        kinds.into_iter().map(|(count, kind)| format!("{count} {kind}")).collect()
    }

    fn shells(&self) -> Vec<String> {
        let mut shells: Vec<Shell> = Vec::new();
        for bond in &self.bonds {
            let mut species = bond.hop.atoms.map(|atom| self.atoms[atom].species.as_str());
            species.sort_unstable();
            let distance = vector::norm(self.along(bond.hop));
            let near = |s: &&mut Shell| s.species == species && (s.distance - distance).abs() <= ALIKE * distance;
            match shells.iter_mut().find(near) {
                Some(shell) => shell.bonds.push(bond),
                None => shells.push(Shell { species, distance, bonds: vec![bond] }),
            }
        }
        shells.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        let mut rows: Vec<String> = shells.iter().take(SHELLS).map(|shell| self.shell(shell)).collect();
        if shells.len() > SHELLS {
            rows.push(format!(
                "… and {} more, up to {:.4} away",
                shells.len() - SHELLS,
                shells[shells.len() - 1].distance
            ));
        }
        rows
    }

    /// "Fe–Fe, 0.2482 nm: 8 neighbours, J 36.99 meV, |D| 0.1 meV".
    fn shell(&self, shell: &Shell) -> String {
        let [a, b] = shell.species;
        let of = |name: &str| self.atoms.iter().filter(|atom| atom.species == name).count() as f64;
        let ends = if a == b { 2.0 } else { 1.0 } * shell.bonds.len() as f64;
        let neighbours = match a == b {
            true => format!("{} neighbours an atom", short(ends / of(a))),
            false => format!("{} {b} about a {a}, {} {a} about a {b}", short(ends / of(a)), short(ends / of(b))),
        };
        let range = |values: Vec<f64>| {
            let (low, high) = values.iter().fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(*x), h.max(*x)));
            let alike = high - low <= 1e-9 * high.abs().max(low.abs());
            if alike { format!("{high:.6} meV") } else { format!("{low:.6} to {high:.6} meV") }
        };
        let j = range(shell.bonds.iter().map(|bond| bond.j()).collect());
        let sizes: Vec<f64> = shell.bonds.iter().map(|bond| vector::norm(bond.d())).collect();
        let d = if sizes.iter().all(|d| *d == 0.0) { String::new() } else { format!(", |D| {}", range(sizes)) };
        let rest = shell.bonds.iter().any(|bond| bond.rest().is_some());
        let rest = if rest { ", and a symmetric tensor" } else { "" };
        let (scale, unit) = self.spacing_nm.map_or((1.0, "(unit of the cell)"), |nm| (nm, "nm"));
        format!("{a}–{b}, {:.4} {unit}: {neighbours}, J {j}{d}{rest}", scale * shell.distance)
    }

    fn energies(&self) -> Vec<String> {
        let mut rows = vec!["meV an atom, where no border is near, each bond once".to_string()];
        for (name, m) in [("x", [1.0, 0.0, 0.0]), ("y", [0.0, 1.0, 0.0]), ("z", [0.0, 0.0, 1.0])] {
            let [bonds, own, field] = self.ferromagnet_mev(m);
            let parts = format!("bonds {bonds:.6}, anisotropy {own:.6}, field {field:.6}");
            rows.push(format!("ferromagnet along {name} {:>16.6}   ({parts})", bonds + own + field));
        }
        for direction in 0..3 {
            rows.extend(self.spirals(direction));
        }
        rows.push(
            "spirals are averaged over their phase and stand in no field; q in units of a reciprocal vector".into(),
        );
        rows
    }

    /// Cycloids and helices along a reciprocal vector: one of four cells both ways, and the lowest.
    fn spirals(&self, direction: usize) -> Vec<String> {
        if self.bonds.iter().all(|bond| bond.hop.shift[direction] == 0) {
            return Vec::new();
        }
        let q = |steps: f64| -> Vector {
            [0, 1, 2].map(|d| if d == direction { 0.5 * steps / f64::from(STEPS) } else { 0.0 })
        };
        let energy = |spiral: Spiral| self.spiral_mev(spiral).iter().sum::<f64>();
        let mut rows = Vec::new();
        for (kind, of) in [("cycloid", Model::cycloid as fn(&Model, Vector) -> Option<Spiral>), ("helix", Model::helix)]
        {
            let sense = |steps: f64| {
                // q < 0: the same plane, run through the other way
                let spiral = of(self, q(steps.abs().max(1e-3)))?;
                // what rounding leaves of 0 is not to be printed as −0
                let mev = energy(Spiral { q: q(steps), ..spiral });
                Some(if mev.abs() < 5e-7 { 0.0 } else { mev })
            };
            let quarter = 0.5 * f64::from(STEPS);
            let both = [quarter, -quarter].map(|steps| sense(steps).unwrap_or(f64::NAN));
            let all = (-STEPS..=STEPS).filter_map(|s| Some((f64::from(s), sense(f64::from(s))?)));
            let Some((steps, lowest)) = all.min_by(|a, b| a.1.total_cmp(&b.1)) else { continue };
            let (lowest_q, number) = (0.5 * steps / f64::from(STEPS), direction + 1);
            rows.push(format!(
                "{kind:<7} along b{number} {:>16.6} {:>16.6}   (q = ¼, −¼), lowest {lowest:.6} at q = {lowest_q:.4}",
                both[0], both[1]
            ));
        }
        rows
    }
}

/// A count that is whole for most lattices.
fn short(x: f64) -> String {
    if x.fract() == 0.0 { format!("{x}") } else { format!("{x:.2}") }
}

/// Rows, the first of which has the key.
fn under(key: &'static str, values: Vec<String>) -> Vec<(&'static str, String)> {
    values.into_iter().enumerate().map(|(k, value)| (if k == 0 { key } else { "" }, value)).collect()
}
