//! The library's errors as Python's.

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use spinneb::error::Error;
use std::io;

/// An exception of the package, by its name.
fn exception(py: Python, name: &str, text: String) -> PyErr {
    let class = py.import("spinneb._errors").and_then(|module| module.getattr(name));
    match class.and_then(|class| class.call1((text.clone(),))) {
        Ok(value) => PyErr::from_value(value),
        Err(_) => PyRuntimeError::new_err(text),
    }
}

/// What the command line calls options, as Python's arguments. Whole commands that a text names stay as they are.
fn in_python(text: &str) -> String {
    text.replace("use --force", "use force=True").replace(": --force", ": force=True").replace(" with --out", "")
}

/// `ConfigError` with the text of the command line, the system's own exception, or `SpinnebError`.
pub fn raised(py: Python, error: Error) -> PyErr {
    match error {
        Error::Several(_) | Error::Config { .. } | Error::Invalid { .. } => {
            exception(py, "ConfigError", in_python(&error.to_string()))
        }
        Error::Io { source, path } if source.raw_os_error().is_some() => {
            // the system's number makes it FileNotFoundError, PermissionError …
            let number = source.raw_os_error();
            let own = io::Error::from(source.kind()).to_string();
            let told = py.import("os").and_then(|os| os.call_method1("strerror", (number,))?.extract::<String>());
            let text = told.unwrap_or(own);
            let class = py.import("builtins").and_then(|builtins| builtins.getattr("OSError"));
            match class.and_then(|class| class.call1((number, text, path))) {
                Ok(value) => PyErr::from_value(value),
                Err(error) => error,
            }
        }
        other => exception(py, "SpinnebError", in_python(&other.to_string())),
    }
}

/// A `SpinnebError`.
pub fn failed(py: Python, text: impl Into<String>) -> PyErr {
    exception(py, "SpinnebError", text.into())
}
