//! The flags and subcommands, and how they override a preset.

mod applicability;
mod completions;
mod export;
mod film;
mod flags;
mod manual;
mod parse;
mod render;
mod robust;
mod run;
mod study;
mod values;

pub use completions::completions;
pub use export::ExportArgs;
#[cfg(feature = "studio")]
pub use film::FilmArgs;
pub use flags::{Args, Subcommand};
pub use manual::manual;
pub use parse::{Parsed, parse};
#[cfg(feature = "studio")]
pub use render::RenderArgs;
pub use study::StudyArgs;
pub use values::number;
#[cfg(feature = "studio")]
pub use values::size;
