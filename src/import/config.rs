//! A model as a config that lacks only its two ends.

use super::{Anisotropy, Atom, Model};
use crate::energy::PairSpec;
use crate::units::{Energy, FluxDensity, Length, Moment};
use serde_json::{Value, json};

impl Model {
    /// The text of the config; the model has its box ([`in_its_box`](Self::in_its_box)).
    pub fn config(&self) -> String {
        let named = self.named();
        let mut terms: Vec<String> = vec![self.pairs()];
        terms.extend(anisotropies(&named));
        let field = match self.field_t {
            [0.0, 0.0, 0.0] => String::new(),
            b => format!(",\n  \"energy\": [{}]", json!({"zeeman": {"B": b.map(FluxDensity)}})),
        };
        let comment: Vec<Value> = self.comment().into_iter().map(Value::from).collect();
        format!(
            "{{\n  \"comment\": [\n    {}\n  ],\n  \"material\": {{\n    \"name\": {},\n    \"source\": {},\n    \"energy\": [\n      \
             {}\n    ]\n  }},\n  \"lattice\": {{\n    \"crystal\": {{\n{}\n    }}\n  }}{field}\n}}\n",
            list(&comment, "\n    "),
            json!(format!("imported from {}", self.code)),
            json!(self.files.join(", ")),
            terms.join(",\n      "),
            self.crystal(&named)
        )
    }

    fn comment(&self) -> Vec<String> {
        let mut lines = vec![format!(
            "Imported from files of {}. To run it, give it an \"initial\" and a \"final\" state.",
            self.code
        )];
        lines.extend(self.convention.iter().chain(&self.notes).cloned());
        lines
    }

    /// The bonds, each once, a line each.
    fn pairs(&self) -> String {
        let bonds = self.bonds.iter().map(|bond| {
            let (j, d) = (bond.j(), bond.d());
            PairSpec {
                from: bond.hop.atoms[0],
                to: bond.hop.atoms[1],
                cell: bond.hop.shift,
                J: Some(Energy(tidy(j))),
                D: (d != [0.0; 3]).then(|| d.map(|x| Energy(tidy(x)))),
                tensor: bond.rest().map(|rest| rest.map(|row| row.map(|x| Energy(tidy(x))))),
            }
        });
        let bonds: Vec<Value> = bonds.map(|bond| json!(bond)).collect();
        let convention = r#"{"counting": "once", "energy": "-J", "dmi": "+D"}"#;
        format!(
            "{{\"pairs\": {{\"convention\": {convention}, \"bonds\": [\n        {}\n      ]}}}}",
            list(&bonds, "\n        ")
        )
    }

    fn crystal(&self, atoms: &[Atom]) -> String {
        let basis: Vec<Value> = atoms
            .iter()
            .map(|a| json!({"at": a.at.map(tidy), "species": a.species, "moment": Moment(a.moment_mub)}))
            .collect();
        let spacing =
            self.spacing_nm.map_or(String::new(), |nm| format!(",\n      \"spacing\": {}", json!(Length(tidy(nm)))));
        format!(
            "      \"vectors\": {},\n      \"basis\": [\n        {}\n      ],\n      \"cells\": {},\n      \"periodic\": {}{spacing}",
            json!(self.vectors.map(|v| v.map(tidy))),
            list(&basis, "\n        "),
            json!(self.cells.unwrap_or([1; 3])),
            json!(self.periodic.unwrap_or([false; 3])),
        )
    }

    /// The atoms with names that tell apart what differs in moment or anisotropy, so that terms can choose them.
    fn named(&self) -> Vec<Atom> {
        let same = |a: &Atom, b: &Atom| a.species != b.species || a.anisotropies == b.anisotropies;
        let fits = self.atoms.iter().all(|a| self.atoms.iter().all(|b| same(a, b)));
        let mut atoms = self.atoms.clone();
        if !fits {
            atoms.iter_mut().enumerate().for_each(|(k, atom)| atom.species = format!("{}_{}", atom.species, k + 1));
        }
        atoms
    }
}

/// The anisotropies: terms of all sites where all atoms have them, else of each species.
fn anisotropies(atoms: &[Atom]) -> Vec<String> {
    let all_alike = atoms.iter().all(|atom| atom.anisotropies == atoms[0].anisotropies);
    let mut terms = Vec::new();
    let mut done: Vec<&str> = Vec::new();
    for atom in atoms {
        if done.contains(&atom.species.as_str()) || (all_alike && !done.is_empty()) {
            continue;
        }
        done.push(&atom.species);
        for anisotropy in &atom.anisotropies {
            let (name, mut keys) = match anisotropy {
                Anisotropy::Uniaxial { k, axis } => {
                    ("anisotropy", json!({"K": Energy(tidy(*k)), "axis": axis.vector().map(tidy)}))
                }
                Anisotropy::Cubic { k } => ("cubic_anisotropy", json!({"K": Energy(tidy(*k))})),
            };
            if !all_alike {
                keys["sites"] = json!(atom.species);
            }
            terms.push(json!({ name: keys }).to_string());
        }
    }
    terms
}

/// Values, one a line.
fn list(values: &[Value], line: &str) -> String {
    values.iter().map(Value::to_string).collect::<Vec<_>>().join(&format!(",{line}"))
}

/// A number without the last digits that a change of units leaves (and −0 as 0).
fn tidy(x: f64) -> f64 {
    crate::words::rounded(x, 14) + 0.0
}
