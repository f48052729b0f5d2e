//! The flags and subcommands, and how they override a preset.

mod applicability;
mod compare;
mod families;
mod flags;
mod parse;
mod render;
mod robust;
mod run;
mod values;

pub use compare::CompareArgs;
pub use families::FamiliesArgs;
pub use flags::{Args, Subcommand};
pub use parse::{Parsed, parse};
#[cfg(feature = "studio")]
pub use render::RenderArgs;
#[cfg(feature = "studio")]
pub use values::size;
