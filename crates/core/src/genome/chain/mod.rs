//! Bodies that evolve: chains of blocks whose number, sizes and joints are genes.

mod cross;
mod genes;
mod limits;
mod mutation;
mod repair;
mod segment;
mod space;
mod structure;

pub(super) use genes::segment_genes;
pub(super) use limits::{
    EVOLVED_INERTIA_RATIO, INERTIA_RATIO, MASS_RATIO, check_pair, inertia_kg_m2, ratio,
};
pub(super) use segment::check_segments;
pub use segment::{MOST_SEGMENTS, Segment};
pub use space::BodySpace;
pub use structure::BodyChange;
