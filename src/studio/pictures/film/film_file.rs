//! A film that is being written, in any format.

use super::error::FilmError;
use snakes_core::save::Picture;

/// A film that is being written. If it is dropped before it is finished, no file remains.
pub trait FilmFile {
    /// Adds the next frame of the film.
    fn add(&mut self, frame: &Picture) -> Result<(), FilmError>;

    /// Completes the film, and gives it its final name.
    fn finish(self: Box<Self>) -> Result<(), FilmError>;
}
