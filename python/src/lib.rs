//! `spinneb._core`: what the Python package asks of the library.
//!
//! Everything runs on a pool of threads of its own, none of which outlives its call, so that a process can fork afterwards; the
//! thread that called waits, looks for signals and tells of the progress. Arrays of results are views of the library's own memory.

mod buffer;
mod config;
mod errors;
mod handing;
mod landscape;
mod outcome;
mod recorded;
mod supervise;
mod term;

use pyo3::prelude::*;
use spinneb::cli;
use spinneb::config::schema;
use std::ffi::OsString;

/// The program `spinneb`: does what a command line asks for and returns its exit code.
#[pyfunction]
fn main(py: Python, program: Vec<OsString>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| cli::main(&program, arguments))
}

/// The JSON Schema of a config.
#[pyfunction]
fn config_schema() -> String {
    schema()
}

#[pymodule]
fn _core(module: &Bound<PyModule>) -> PyResult<()> {
    module.add("version", spinneb::config::VERSION)?;
    module.add_class::<buffer::Buffer>()?;
    module.add_class::<config::Config>()?;
    module.add_class::<outcome::Outcome>()?;
    module.add_class::<landscape::Landscape>()?;
    module.add_function(wrap_pyfunction!(outcome::read, module)?)?;
    module.add_function(wrap_pyfunction!(main, module)?)?;
    module.add_function(wrap_pyfunction!(config_schema, module)?)
}
