//! The flags and commands, and how they override a preset.

mod completions;
mod export;
mod film;
mod flags;
mod groups;
mod manual;
mod parse;
mod robust;
mod run;
mod study;
mod task;
mod values;

pub use completions::completions;
pub use export::ExportArgs;
#[cfg(feature = "studio")]
pub use film::{FPS, FilmArgs, GIF_MB, SPEED};
#[cfg(feature = "cluster")]
pub use groups::CredentialFlags;
pub use manual::manual;
pub use parse::{Parsed, parse};
pub use robust::{ExamArgs, PerturbationArgs};
pub use study::StudyArgs;
pub use task::{Args, Task};
pub use values::number_if;
#[cfg(feature = "studio")]
pub use values::{number, size};
