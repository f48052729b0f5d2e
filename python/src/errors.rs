//! The core's errors as Python exceptions: a value that is not allowed is a ValueError, a file that cannot be read or
//! written an OSError.

use pyo3::PyErr;
use pyo3::exceptions::{PyOSError, PyRuntimeError, PyValueError};
use snakes_core::check::Invalid;
use snakes_core::save::SaveError;
use snakes_lab::run::WorkersError;

/// A value that is not allowed.
pub fn invalid(error: Invalid) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// A value that is not allowed, by its field and the values that are.
pub fn refused(field: &str, value: impl std::fmt::Display, allowed: &str) -> PyErr {
    invalid(Invalid::new(field, value, allowed))
}

/// A file that cannot be used.
pub fn unusable(error: SaveError) -> PyErr {
    match error {
        SaveError::Unreadable { .. } | SaveError::Unwritable { .. } => {
            PyOSError::new_err(error.to_string())
        }
        other => PyValueError::new_err(other.to_string()),
    }
}

/// The system refused to start threads.
pub fn no_threads(error: WorkersError) -> PyErr {
    PyRuntimeError::new_err(error.to_string())
}

/// The simulation panicked where no single individual is to blame.
pub fn crashed(message: String) -> PyErr {
    PyRuntimeError::new_err(format!("the simulation failed: {message}"))
}
