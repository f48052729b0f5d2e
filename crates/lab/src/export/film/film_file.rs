//! The interface of all files of films: add frames, then finish.

use crate::export::ExportError;
use snakes_core::save::Picture;

/// A film that is being written. If it is dropped before it is finished, no file remains.
pub trait FilmFile {
    /// Adds the next frame of the film.
    ///
    /// # Errors
    /// The frame cannot be written.
    fn add(&mut self, frame: &Picture) -> Result<(), ExportError>;

    /// Completes the film, and gives it its final name.
    ///
    /// # Errors
    /// The film cannot be written.
    fn finish(self: Box<Self>) -> Result<(), ExportError>;
}
