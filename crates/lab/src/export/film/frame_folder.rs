//! A film as a folder of numbered pictures.

use std::path::{Path, PathBuf};

use super::film_file::FilmFile;
use crate::export::ExportError;
use snakes_core::save::{Picture, UnfinishedFolder};

/// A folder of numbered pictures that is being written.
pub struct FrameFolder {
    folder: UnfinishedFolder,
    name: String,
    digits: usize,
    next: usize,
}

/// Minimum number of digits in the names of frames.
const LEAST_DIGITS: usize = 4;

/// Returns the folder of frames for the path of a .png file: `climb-frames` for `climb.png`.
pub fn frame_folder_of(path: &Path) -> PathBuf {
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!("{name}-frames"))
}

impl FrameFolder {
    /// Creates the folder of a film with this number of frames.
    ///
    /// # Errors
    /// The folder cannot be created, or exists and has files in it.
    pub fn begin(path: &Path, frames: usize) -> Result<Self, ExportError> {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let folder = UnfinishedFolder::create(&frame_folder_of(path))?;
        let digits = frames.to_string().len().max(LEAST_DIGITS);
        Ok(Self { folder, name, digits, next: 1 })
    }
}

impl FilmFile for FrameFolder {
    fn add(&mut self, frame: &Picture) -> Result<(), ExportError> {
        let (number, digits) = (self.next, self.digits);
        self.next += 1;
        let name = format!("{}-{number:0digits$}.png", self.name);
        Ok(self.folder.store_picture(&name, frame)?)
    }

    fn finish(self: Box<Self>) -> Result<(), ExportError> {
        Ok(self.folder.finish()?)
    }
}
