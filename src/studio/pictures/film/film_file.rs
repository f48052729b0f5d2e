//! A film that is being written, whatever its format.

use super::error::FilmError;
use snakes_core::save::Picture;

/// A film that is being written. Dropped before it is finished, it leaves nothing behind.
pub trait FilmFile {
    /// Adds the next frame.
    fn add(&mut self, frame: &Picture) -> Result<(), FilmError>;

    /// Completes the film under its name.
    fn finish(self: Box<Self>) -> Result<(), FilmError>;
}
