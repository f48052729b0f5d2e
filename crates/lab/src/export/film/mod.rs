//! Files of films, frame by frame.

mod frame_folder;
mod gif;
mod video;

use super::ExportError;
use snakes_core::save::Picture;

pub use frame_folder::{FrameFolder, frame_folder_of};
pub use gif::{
    BegunGif, ESTIMATED_BYTES, GIF_FPS, GifChoice, GifChoices, GifFile, GifPalette, PAIRS,
};
pub use video::{Video, check_video_size};

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
