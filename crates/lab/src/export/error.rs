//! The errors of exports.

use std::path::Path;

use snakes_core::check::Invalid;
use snakes_core::save::SaveError;

/// A champion could not be exported. Nothing is left under the file's name then.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The order is not allowed.
    #[error(transparent)]
    Invalid(#[from] Invalid),
    /// The file could not be written.
    #[error(transparent)]
    Save(#[from] SaveError),
    /// Films are drawn elsewhere: by the studio.
    #[error(
        "a film is drawn by the studio, which this program was built without; choose another format, or build it with the default features"
    )]
    Film,
    /// The user cancelled it.
    #[error("cancelled; nothing was written")]
    Cancelled,
}

impl ExportError {
    /// The error that a file cannot be written, from the reason of a library that writes it.
    pub fn unwritable<E>(path: &Path) -> impl Fn(E) -> Self
    where
        E: Into<Box<dyn std::error::Error + Send + Sync>>,
    {
        move |reason| {
            let error = match reason.into().downcast::<std::io::Error>() {
                Ok(system) => *system,
                Err(other) => std::io::Error::other(other),
            };
            Self::Save(SaveError::unwritable(path)(error))
        }
    }
}
