//! Bodies that evolve: chains of blocks whose number, sizes and joints are genes.

mod check;
mod cross;
mod genes;
mod limits;
mod mutation;
mod repair;
mod segment;
mod space;
mod structure;

pub(super) use check::check_segments;
pub(super) use genes::{segment_genes, waiting_genes};
pub(super) use limits::{
    EVOLVED_INERTIA_RATIO, INERTIA_RATIO, MASS_RATIO, check_pair, inertia_kg_m2, ratio,
};
pub use segment::{MOST_SEGMENTS, Segment};
pub use space::BodySpace;
pub use structure::BodyChange;
