//! Collections of individuals worth keeping, and the axes along which they differ.

mod descriptor;
mod elites;
mod front;

pub use descriptor::Descriptor;
pub use elites::{Addition, Archive, Elite};
pub use front::{Front, FrontMember};
