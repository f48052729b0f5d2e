//! The errors of films.

use crate::check::Invalid;
use crate::export::ExportError;
use crate::plot::PlotError;
use crate::save::SaveError;
use crate::studio::error::StudioError;

/// A film could not be made. Nothing is left under its name then.
#[derive(Debug, thiserror::Error)]
pub enum FilmError {
    /// The frames could not be drawn.
    #[error(transparent)]
    Studio(#[from] StudioError),
    /// The film could not be written, or the user cancelled it.
    #[error(transparent)]
    Export(#[from] ExportError),
    /// A text could not be written onto a frame.
    #[error(transparent)]
    Plot(#[from] PlotError),
    /// The program that writes .mp4 films is missing.
    #[error(
        "a .mp4 film is written by ffmpeg, which is not installed here or not in PATH; install it, or write a .gif"
    )]
    NoFfmpeg,
}

impl From<Invalid> for FilmError {
    fn from(invalid: Invalid) -> Self {
        Self::Export(invalid.into())
    }
}

impl From<SaveError> for FilmError {
    fn from(error: SaveError) -> Self {
        Self::Export(error.into())
    }
}
