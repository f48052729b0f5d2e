//! Files of films, frame by frame.

mod film_file;
mod frame_folder;
mod gif;
mod video;

pub use film_file::FilmFile;
pub use frame_folder::{FrameFolder, frame_folder_of};
pub use gif::{
    BegunGif, GIF_FPS, GifChoice, GifChoices, GifFile, GifPalette, MOST_MB, PAIRS, most_estimated,
};
pub use video::{Video, check_video_size};
