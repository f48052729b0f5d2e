//! Files of films, frame by frame.

mod film_file;
mod frame_folder;
mod gif;
mod video;

pub use film_file::FilmFile;
pub use frame_folder::{FrameFolder, frame_folder_of};
pub use gif::{
    BegunGif, ESTIMATED_BYTES, GIF_FPS, GifChoice, GifChoices, GifFile, GifPalette, PAIRS,
};
pub use video::{Video, check_video_size};
