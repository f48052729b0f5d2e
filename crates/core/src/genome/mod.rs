//! Genomes: the limits of the joints, the material of the body, and the genes that drive the joints.
//!
//! A genome is plain data that can be saved and loaded. [`GenomeSpace`] determines how genomes are drawn and varied; `score` combines a
//! genome with a trial and determines its effect on a body.

mod body;
mod chain;
pub mod controllers;
mod coordinates;
mod creature;
mod features;
mod fit;
mod gene;
mod individual;
mod kind;
mod limits;
mod network_space;
mod space;
mod stairs;
mod wave_space;

pub use body::BodyGenes;
pub use chain::{BodyChange, BodySpace, MOST_SEGMENTS, Segment};
pub use controllers::{ControllerGenes, JointCommands};
pub use coordinates::Coordinate;
pub use creature::{
    BodyNode, BodySide, Connection, CreatureChange, CreatureSpace, GrownPart, MOST_PARTS,
    NeuronSet, NodeJoint, bare_plan as grown_body, grow, joint_tree,
};
pub use gene::{Feature, GenomeShape};
pub use individual::Genome;
pub use kind::ControllerKind;
pub use limits::{DENSITY_RANGE_KG_M3, LARGEST_LIMIT_RAD, MODULUS_RANGE_PA};
pub use network_space::{MOST_LIBRARY_WAVES, NetworkSpace};
pub use space::{GenomeSpace, LARGEST_GENOME_TORQUES, LARGEST_TORQUE_NM, POINTS_PER_S_RANGE};
pub use stairs::{
    HELD_OUT_PER_CLASS, LANDING_M, StairsChange, StairsClass, StairsGenome, held_out,
};
pub use wave_space::{
    FREQUENCY_RANGE_HZ, MOST_HARMONICS, SERVO_DAMPING_RANGE, STIFFNESS_RANGE_NM_PER_RAD, WaveSpace,
};
