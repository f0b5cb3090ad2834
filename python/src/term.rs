//! Energy terms written in Python.

use crate::buffer::Buffer;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use spinneb::energy::{CustomEnergy, Reach};
use spinneb::field::{Components, ComponentsMut};
use std::sync::{Arc, Mutex};

/// The first exception that a term of a run has raised.
#[derive(Clone, Debug, Default)]
pub struct Trouble(Arc<Mutex<Option<PyErr>>>);

impl Trouble {
    fn note(&self, error: PyErr) {
        if let Ok(mut first) = self.0.lock() {
            first.get_or_insert(error);
        }
    }

    /// Raises it, once.
    pub fn raise(&self) -> PyResult<()> {
        match self.0.lock().ok().and_then(|mut first| first.take()) {
            Some(error) => Err(error),
            None => Ok(()),
        }
    }
}

/// A `Term` of the package: it answers with the bytes of its numbers.
#[derive(Debug)]
pub struct Term {
    name: String,
    quadratic: Option<bool>,
    reach: Reach,
    has_hessian: bool,
    own: Py<PyAny>,
    trouble: Trouble,
}

impl Term {
    /// From the Python object.
    pub fn new(own: &Bound<PyAny>, trouble: &Trouble) -> PyResult<Term> {
        let reach = own.getattr("reach")?;
        let reach = match (reach.is_none(), reach.extract::<f64>()) {
            (true, _) => Reach::Unknown,
            (_, Ok(number)) => Reach::Within(number),
            _ if reach.extract::<String>()? == "dense" => Reach::All,
            _ => {
                return Err(PyValueError::new_err(format!(
                    "reach is a number of sites, \"dense\" or None, found {reach}"
                )));
            }
        };
        Ok(Term {
            name: own.getattr("name")?.extract()?,
            quadratic: own.getattr("quadratic")?.extract()?,
            reach,
            has_hessian: !own.getattr("hessian")?.is_none(),
            own: own.clone().unbind(),
            trouble: trouble.clone(),
        })
    }

    /// Calls a method with fields of vectors; its numbers, or none where it raises.
    fn ask(&self, method: &str, fields: &[Components], out: &mut [f64]) {
        let answer = Python::attach(|py| -> PyResult<()> {
            let fields: Vec<Buffer> = fields.iter().map(field).collect();
            let value = match fields.len() {
                1 => self.own.call_method1(py, method, (fields.into_iter().next(),))?,
                _ => self.own.call_method1(py, method, (fields,))?,
            };
            let bytes = value.cast_bound::<PyBytes>(py)?.as_bytes();
            for (number, bytes) in out.iter_mut().zip(bytes.as_chunks().0) {
                *number = f64::from_ne_bytes(*bytes);
            }
            Ok(())
        });
        if let Err(error) = answer {
            self.trouble.note(error);
            out.fill(f64::NAN);
        }
    }

    fn ask_for_field(&self, method: &str, fields: &[Components], out: ComponentsMut) {
        let n = out.x.len();
        let mut all = vec![0.0; 3 * n];
        self.ask(method, fields, &mut all);
        out.x.copy_from_slice(&all[..n]);
        out.y.copy_from_slice(&all[n..2 * n]);
        out.z.copy_from_slice(&all[2 * n..]);
    }
}

fn field(v: &Components) -> Buffer {
    Buffer::spins(&Arc::new([v.x, v.y, v.z].concat()), |numbers: &Vec<f64>| numbers, None)
}

impl CustomEnergy for Term {
    fn name(&self) -> &str {
        &self.name
    }

    fn energy(&self, m: Components, density: &mut [f64]) {
        self.ask("_energy", &[m], density);
    }

    fn gradient(&self, m: Components, g: ComponentsMut) {
        self.ask_for_field("_gradient", &[m], g);
    }

    fn is_quadratic(&self) -> Option<bool> {
        self.quadratic
    }

    fn reach(&self) -> Reach {
        self.reach
    }

    fn hessian_product(&self, m: Components, v: Components, out: ComponentsMut) -> bool {
        if self.has_hessian {
            self.ask_for_field("_hessian", &[m, v], out);
        }
        self.has_hessian
    }
}
