//! Collections of individuals worth keeping, and the axes along which they differ.

mod axis;
mod bodies;
mod descriptor;
mod elites;
mod front;

pub use axis::{ArchiveAxis, AxisScale};
pub use bodies::{body_archive, body_cell, feasible_cells};
pub use descriptor::Descriptor;
pub use elites::{Addition, Archive, Elite, EliteGenes};
pub use front::{Front, FrontMember};

/// Reason why the axes of an archive cannot change during a run.
pub const FIXED_LAYOUT: &str =
    "Takes effect with the next run, because it determines the layout of the archive.";
