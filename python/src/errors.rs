//! The core's errors as Python exceptions: ValueError for a value that is not allowed, OSError for a file that cannot be read or
//! written.

use pyo3::PyErr;
use pyo3::exceptions::{PyOSError, PyRuntimeError, PyValueError};
use snakes_core::check::{Invalid, printable};
use snakes_core::save::SaveError;
use snakes_lab::run::WorkersError;

/// Returns the words of an error, in which names of files cannot act on a terminal.
fn shown(error: impl std::fmt::Display) -> String {
    printable(&error.to_string()).into_owned()
}

/// Returns the exception for a value that is not allowed.
pub fn invalid(error: Invalid) -> PyErr {
    PyValueError::new_err(shown(error))
}

/// Returns the exception for a value that is not allowed, given its field and a description of the allowed values.
pub fn refused(field: &str, value: impl std::fmt::Display, allowed: &str) -> PyErr {
    invalid(Invalid::new(field, value, allowed))
}

/// Returns the exception for a file that cannot be used.
pub fn unusable(error: SaveError) -> PyErr {
    match error {
        SaveError::Unreadable { .. } | SaveError::Unwritable { .. } => {
            PyOSError::new_err(shown(error))
        }
        other => PyValueError::new_err(shown(other)),
    }
}

/// Returns the exception for threads that the operating system refused to start.
pub fn no_threads(error: WorkersError) -> PyErr {
    PyRuntimeError::new_err(shown(error))
}

/// Returns the exception for a panic of the simulation that is not due to a single individual.
pub fn crashed(message: String) -> PyErr {
    PyRuntimeError::new_err(format!("the simulation failed: {message}"))
}
