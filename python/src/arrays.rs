//! Arrays of doubles: buffers in, byte arrays out, in the order of C.

use pyo3::buffer::PyBuffer;
use pyo3::prelude::*;
use pyo3::types::PyByteArray;

use crate::error::invalid;

/// The numbers of a buffer, copied.
pub fn numbers(py: Python<'_>, buffer: &PyBuffer<f64>) -> PyResult<Vec<f64>> {
    buffer.to_vec(py)
}

/// The rows of a buffer of `3 n` numbers, copied. `name` is its name in messages.
pub fn triples(py: Python<'_>, name: &str, buffer: &PyBuffer<f64>) -> PyResult<Vec<[f64; 3]>> {
    let numbers = buffer.to_vec(py)?;
    if !numbers.len().is_multiple_of(3) {
        return Err(invalid(format!("{name}: found {} numbers, expected three per row", numbers.len())));
    }
    Ok(numbers.chunks_exact(3).map(|row| [row[0], row[1], row[2]]).collect())
}

/// The bytes of numbers, for `numpy.frombuffer`.
pub fn bytes<'py>(py: Python<'py>, numbers: impl IntoIterator<Item = f64>) -> Bound<'py, PyByteArray> {
    let bytes: Vec<u8> = numbers.into_iter().flat_map(f64::to_ne_bytes).collect();
    PyByteArray::new(py, &bytes)
}
