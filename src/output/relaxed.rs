//! Relaxed states: `relax.json`, and the spins as files that a config's `file` states read.

use super::disk::File;
use super::number::Number;
use super::ovf_mesh::OvfMesh;
use super::spin_files::{places, vtk_points, without_idle};
use crate::drive::RelaxedState;
use crate::energy::Hamiltonian;
use crate::error::{Error, Result};
use crate::files::{self, Array, OvfData};
use crate::geometry::Vector;
use crate::lattice::Lattice;
use serde::Serialize;
use std::collections::BTreeMap;

/// The file with the numbers.
const NUMBERS: &str = "relax.json";

/// The states of a config, relaxed.
#[derive(Clone, Copy, Debug)]
pub struct RelaxReport<'a> {
    /// Name of the config.
    pub name: &'a str,
    /// Version of the program.
    pub version: &'a str,
    /// The chain.
    pub lattice: &'a Lattice,
    /// Its energy.
    pub hamiltonian: &'a Hamiltonian,
    /// The states with their names, `initial` and perhaps `final`.
    pub states: &'a [(&'static str, RelaxedState)],
    /// Both states relaxed to the same minimum; nothing if there is but one.
    pub same_minimum: Option<bool>,
    /// Kinds of files, as in a config's `output.formats`.
    pub formats: &'a [String],
    /// What was said of the config.
    pub warnings: &'a [String],
}

/// What is told of a state. Energies and eigenvalues in meV.
#[derive(Serialize)]
#[allow(non_snake_case)]
pub struct StateReport<'a> {
    name: &'a str,
    state: &'a str,
    minimum: bool,
    converged: bool,
    energy_meV: Number,
    energies_meV: BTreeMap<&'a str, Number>,
    max_torque_meV: Number,
    negative_modes: usize,
    zero_modes: usize,
    flat_modes: usize,
    noise_floor_meV: Number,
    lowest_eigenvalues_meV: Vec<Number>,
    mean_spin: [Number; 3],
    energy_as_given_meV: Number,
    max_torque_as_given_meV: Number,
    largest_rotation_rad: Number,
    left_saddle: bool,
    steps: usize,
    warnings: Vec<&'a String>,
    files: Vec<String>,
}

#[derive(Serialize)]
struct Document<'a> {
    name: &'a str,
    version: &'a str,
    same_minimum: Option<bool>,
    states: Vec<StateReport<'a>>,
}

impl<'a> RelaxReport<'a> {
    /// What is told of each state; its files are named if they are written.
    pub fn states(&self, written: bool) -> Vec<StateReport<'a>> {
        self.states.iter().map(|(which, state)| self.state(which, state, written)).collect()
    }

    fn state(&self, which: &'a str, state: &'a RelaxedState, written: bool) -> StateReport<'a> {
        let (minimum, relaxed) = (&state.minimum, &state.relaxed);
        let energies = self.hamiltonian.energies_mev(relaxed.spins.as_slice());
        StateReport {
            name: self.name,
            state: which,
            minimum: minimum.is_proven(),
            converged: relaxed.converged,
            energy_meV: Number(minimum.energy_mev),
            energies_meV: energies.into_iter().map(|(term, e)| (term, Number(e))).collect(),
            max_torque_meV: Number(minimum.max_torque_mev),
            negative_modes: minimum.spectrum.negative,
            zero_modes: minimum.spectrum.zero,
            flat_modes: minimum.spectrum.flat,
            noise_floor_meV: Number(minimum.spectrum.floor_mev),
            lowest_eigenvalues_meV: minimum.spectrum.lowest_mev.iter().copied().map(Number).collect(),
            mean_spin: relaxed.spins.mean(&self.lattice.vacant).map(Number),
            energy_as_given_meV: Number(state.given_mev),
            max_torque_as_given_meV: Number(state.given_torque_mev),
            largest_rotation_rad: Number(relaxed.largest_rotation_rad),
            left_saddle: relaxed.left.is_some(),
            steps: relaxed.steps,
            warnings: self.warnings.iter().chain(&state.warnings).collect(),
            files: if written { spin_files(which, self.formats, self.lattice) } else { Vec::new() },
        }
    }

    /// All files: the states, and `relax.json` last.
    pub fn files(&self) -> Result<Vec<File>> {
        let mut files = Vec::new();
        for (which, state) in self.states {
            for format in FORMATS.iter().filter(|f| f.is_in(self.formats)) {
                let bytes = (format.render)(self, which, &state.relaxed.spins.vectors())?;
                files.push(File { name: format.file(which, self.lattice), bytes });
            }
        }
        let document = Document {
            name: self.name,
            version: self.version,
            same_minimum: self.same_minimum,
            states: self.states(true),
        };
        let text = serde_json::to_string_pretty(&document);
        let text = text.map_err(|e| Error::Numerical(format!("{NUMBERS}: {e}")))?;
        files.push(File { name: NUMBERS.into(), bytes: (text + "\n").into_bytes() });
        Ok(files)
    }
}

/// Names of all files that are written for these states of a lattice in these formats.
pub fn relaxed_file_names(states: &[&str], formats: &[String], lattice: &Lattice) -> Vec<String> {
    let spins = states.iter().flat_map(|which| spin_files(which, formats, lattice));
    spins.chain([NUMBERS.to_string()]).collect()
}

/// Which of these formats no single state is written in: those of paths.
pub fn formats_of_paths(formats: &[String]) -> Vec<&str> {
    let of_states = |name: &str| FORMATS.iter().any(|format| format.names.contains(&name));
    formats.iter().map(String::as_str).filter(|name| !of_states(name)).collect()
}

/// A way to write a state.
struct StateFormat {
    /// Its names in `output.formats`.
    names: &'static [&'static str],
    suffix: &'static str,
    ending: fn(&Lattice) -> &'static str,
    render: fn(&RelaxReport, &str, &[Vector]) -> Result<Vec<u8>>,
}

impl StateFormat {
    fn is_in(&self, formats: &[String]) -> bool {
        formats.iter().any(|f| self.names.contains(&f.as_str()))
    }

    fn file(&self, which: &str, lattice: &Lattice) -> String {
        format!("{which}{}.{}", self.suffix, (self.ending)(lattice))
    }
}

/// All ways to write a state.
static FORMATS: &[StateFormat] = &[
    StateFormat { names: &["npz"], suffix: "", ending: |_| "npz", render: npz },
    StateFormat {
        names: &["ovf"],
        suffix: "",
        ending: |_| "ovf",
        render: |r, w, m| Ok(ovf(OvfData::Binary8, r, w, m)),
    },
    StateFormat {
        names: &["ovf_binary4"],
        suffix: "_binary4",
        ending: |_| "ovf",
        render: |r, w, m| Ok(ovf(OvfData::Binary4, r, w, m)),
    },
    StateFormat {
        names: &["ovf_text", "ovf_images"],
        suffix: "_text",
        ending: |_| "ovf",
        render: |r, w, m| Ok(ovf(OvfData::Text, r, w, m)),
    },
    StateFormat {
        names: &["csv", "spins_csv"],
        suffix: "",
        ending: |_| "csv",
        render: |_, _, m| Ok(files::write_csv([m].into_iter())),
    },
    StateFormat { names: &["vtk"], suffix: "", ending: |lattice| vtk_points(lattice).ending(), render: vtk },
];

fn spin_files(which: &str, formats: &[String], lattice: &Lattice) -> Vec<String> {
    FORMATS.iter().filter(|f| f.is_in(formats)).map(|f| f.file(which, lattice)).collect()
}

fn npz(report: &RelaxReport, _: &str, spins: &[Vector]) -> Result<Vec<u8>> {
    let numbers = spins.iter().flatten().copied().collect();
    let spins = ("spins".into(), Array { shape: vec![spins.len(), 3], numbers });
    files::write_npz(&[spins].into_iter().chain(places(report.lattice)).collect::<Vec<_>>())
}

fn ovf(data: OvfData, report: &RelaxReport, which: &str, spins: &[Vector]) -> Vec<u8> {
    let energy = report.states.iter().find(|(name, _)| *name == which).map(|(_, s)| s.minimum.energy_mev);
    let energy = energy.map_or(String::new(), |e| format!(", energy {e:?} meV"));
    let description = format!("{}: relaxed {which} state{energy}", report.name);
    OvfMesh::of(report.lattice).file(data, vec![(description, spins.to_vec())])
}

fn vtk(report: &RelaxReport, _: &str, spins: &[Vector]) -> Result<Vec<u8>> {
    Ok(vtk_points(report.lattice).file(&without_idle(report.lattice, spins.to_vec())))
}
