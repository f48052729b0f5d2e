//! The flags and subcommands, and how they override a preset.

mod applicability;
mod body_study;
mod compare;
mod completions;
mod engine_study;
mod export;
mod families;
mod film;
mod flags;
mod manual;
mod parse;
mod poet_study;
mod render;
mod robust;
mod run;
mod stairs_study;
mod values;

pub use body_study::BodyStudyArgs;
pub use compare::CompareArgs;
pub use completions::completions;
pub use engine_study::EngineStudyArgs;
pub use export::ExportArgs;
pub use families::FamiliesArgs;
#[cfg(feature = "studio")]
pub use film::FilmArgs;
pub use flags::{Args, Subcommand};
pub use manual::manual;
pub use parse::{Parsed, parse};
pub use poet_study::PoetStudyArgs;
#[cfg(feature = "studio")]
pub use render::RenderArgs;
pub use stairs_study::StairsStudyArgs;
#[cfg(feature = "studio")]
pub use values::size;
