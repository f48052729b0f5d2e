//! Collections of individuals worth keeping, and the axes along which they differ.

mod descriptor;
mod elites;
mod front;

pub use descriptor::Descriptor;
pub use elites::{Addition, Archive, Elite};
pub use front::{Front, FrontMember};

/// Why a run keeps the axes of its archive.
pub const FIXED_LAYOUT: &str =
    "Takes effect with the next run, because it determines the layout of the archive.";
