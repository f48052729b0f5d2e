//! Reasons why the studio cannot open or ends with an error.

use std::path::PathBuf;

use snakes_core::save::SaveError;

/// Reason why the studio could not open or ended with an error.
#[derive(Debug, thiserror::Error)]
pub enum StudioError {
    /// No display or no graphics driver is available.
    #[error("no window can be opened ({0}); use --no-render to work in the terminal")]
    NoWindow(String),
    /// A picture could not be drawn.
    #[error(
        "no picture can be drawn ({0}); drawing needs a graphics driver; a software driver is enough"
    )]
    NoPicture(String),
    /// A champion cannot be simulated: its body or world is unfit.
    #[error("{0}")]
    Unfit(String),
    /// The champion with which to open the studio could not be read.
    #[error(transparent)]
    Champion(#[from] SaveError),
    /// The program panicked while the window was open.
    #[error("the studio failed: {message}; {}", match run {
        Some(folder) => format!("the run is saved; continue it with --resume {}", folder.display()),
        None => "no run was in progress".to_owned(),
    })]
    Crashed {
        /// Message of the panic.
        message: String,
        /// Folder of the current run, if it is saved.
        run: Option<PathBuf>,
    },
    /// The window closed with an error.
    #[error("the studio ended with an error (exit code {0})")]
    Ended(u8),
}
