//! Errors of making a film.

use crate::studio::error::StudioError;
use snakes_core::check::Invalid;
use snakes_lab::export::ExportError;
use snakes_lab::plot::PlotError;

/// Reason why a film could not be made. No file or folder with the film's name is left behind.
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
    /// The GIF would be larger than allowed, in bytes. A smaller one can be made.
    #[error("the GIF would have {0} bytes")]
    TooLarge(u64),
}

impl From<Invalid> for FilmError {
    fn from(invalid: Invalid) -> Self {
        Self::Export(invalid.into())
    }
}
