//! What evolves: the limits of the joints, the material of the body, the torque signals.
//!
//! Plain data that can be written down and read back. How a genome is drawn and varied is in
//! [`GenomeSpace`]; what it does to a body is decided in `score`, where it meets a trial.

mod signal;
mod space;

pub use signal::{JointSignals, Signals};
pub use space::{
    DENSITY_RANGE_KG_M3, GenomeSpace, LARGEST_GENOME_TORQUES, LARGEST_LIMIT_RAD, POINTS_PER_S_RANGE,
};

/// One individual.
#[derive(Debug, Clone, PartialEq)]
pub struct Genome {
    /// Largest bend of every joint to either side, in radians.
    pub bend_limit_rad: f32,
    /// Largest twist of every joint to either side, in radians.
    pub twist_limit_rad: f32,
    /// Density of the material, in kg/m³.
    pub density_kg_m3: f32,
    /// The torques that drive the joints.
    pub signals: Signals,
}
