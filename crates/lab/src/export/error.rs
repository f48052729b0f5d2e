//! Errors of exports.

use std::path::Path;

use snakes_core::check::Invalid;
use snakes_core::save::SaveError;

/// Why a champion could not be exported. The file's name then has no new file.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The format, its number of champions, or the file's name is not allowed.
    #[error(transparent)]
    Invalid(#[from] Invalid),
    /// The file could not be written.
    #[error(transparent)]
    Save(#[from] SaveError),
    /// The format is a film, which only the studio can draw.
    #[error(
        "a film is drawn by the studio, which this program was built without; choose another format, or build it with the default features"
    )]
    Film,
    /// The program that writes .mp4 films is missing.
    #[error(
        "a .mp4 film is written by ffmpeg, which is not installed here or not in PATH; install it, or write a .gif"
    )]
    NoFfmpeg,
    /// The system refused to start the program that writes .mp4 films, or a thread for it.
    #[error("ffmpeg: cannot be started: {0}")]
    Ffmpeg(std::io::Error),
    /// The user cancelled the export.
    #[error("cancelled; nothing was written")]
    Cancelled,
}

impl ExportError {
    /// Returns a function that turns a library's reason into the error that the file at `path` cannot be written.
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
