//! Numbers that numpy looks at where they are.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::any::Any;
use std::sync::Arc;

/// Size of a number (bytes).
const SIZE: usize = size_of::<f64>();

/// Numbers in memory that is never written to, kept for as long as anything looks at them.
#[pyclass(frozen, module = "spinneb._core")]
pub struct Buffer {
    /// What owns the numbers.
    _owner: Arc<dyn Any + Send + Sync>,
    address: usize,
    shape: Vec<usize>,
    /// From an entry to the next, by axis (numbers).
    strides: Vec<usize>,
}

impl Buffer {
    /// A row of numbers.
    pub fn row<T: Any + Send + Sync>(owner: &Arc<T>, numbers: fn(&T) -> &[f64]) -> Buffer {
        let slice = numbers(owner);
        Buffer { address: slice.as_ptr() as usize, shape: vec![slice.len()], strides: vec![1], _owner: owner.clone() }
    }

    /// Configurations, component after component in memory, as (site, xyz), or (image, site, xyz) of several.
    pub fn spins<T: Any + Send + Sync>(
        owner: &Arc<T>,
        slab: impl FnOnce(&T) -> &[f64],
        images: Option<usize>,
    ) -> Buffer {
        let slice = slab(owner);
        let sites = slice.len() / (3 * images.unwrap_or(1));
        let (mut shape, mut strides) = (vec![sites, 3], vec![1, sites]);
        if let Some(images) = images {
            shape.insert(0, images);
            strides.insert(0, 3 * sites);
        }
        Buffer { address: slice.as_ptr() as usize, shape, strides, _owner: owner.clone() }
    }
}

#[pymethods]
impl Buffer {
    /// What numpy reads it by; see "The array interface protocol" of its manual.
    #[getter]
    fn __array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let interface = PyDict::new(py);
        let read_only = true;
        interface.set_item("version", 3)?;
        interface.set_item("typestr", if cfg!(target_endian = "little") { "<f8" } else { ">f8" })?;
        interface.set_item("data", (self.address, read_only))?;
        interface.set_item("shape", PyTuple::new(py, &self.shape)?)?;
        interface.set_item("strides", PyTuple::new(py, self.strides.iter().map(|n| n * SIZE))?)?;
        Ok(interface)
    }
}
