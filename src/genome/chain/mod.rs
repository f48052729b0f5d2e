//! Bodies that evolve: chains of blocks whose number, sizes and joints are genes.

mod cross;
mod limits;
mod mutation;
mod repair;
mod segment;
mod space;
mod structure;

pub use segment::{MOST_SEGMENTS, Segment};
pub(super) use segment::{check_segments, segment_genes};
pub use space::BodySpace;
pub use structure::BodyChange;
