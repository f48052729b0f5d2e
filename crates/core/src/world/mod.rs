//! The physical world: stairs, surface, snake, and one [`Simulation`] that steps them.
//!
//! Axes: x across the stairs, y towards and up the stairs, z up. Units: metres, kilograms, seconds, radians, newton metres. An
//! engine moves the parts of the snake: rapier3d, or *lanes*, which computes several snakes side by side (`lanes/mod.rs` explains it). Each
//! holds the state of the parts, which is all that other code reads (`engine.rs`). This module never uses a window, a file, a thread, a
//! clock, or iteration in hash order.

mod body;
mod building_codes;
mod contact;
mod damping;
mod discontinuity;
mod effort;
mod energy;
mod engine;
mod health;
mod lanes;
mod mount;
mod physics;
mod plan;
mod pull;
mod rapier;
mod shove;
mod simulation;
mod soft_limb;
mod stair_profile;
mod stairs;
mod surface;
mod torque;
mod turning;

pub use body::{BodyPlan, JointPlan, PartPlan, SpringPlan, neighbours_pass};
pub use building_codes::{BUILDING_CODES, BuildingCode, TRUE_MM_PER_M};
pub use discontinuity::Discontinuity;
pub use effort::Effort;
pub use energy::EnergyLost;
pub use engine::{PartState, Touch, TouchedSurface};
pub use health::{Disqualification, HealthLimits};
pub use lanes::{LANES, LanesCommon, VectorLevel};
pub use mount::{Mount, joint_turn};
#[cfg(test)]
pub use physics::TESTED_RATES;
pub use physics::{PhysicsEngine, PhysicsSettings, STEP_RATES_HZ};
pub use plan::WorldPlan;
pub use pull::Pull;
pub use rapier::RapierWorld;
pub use rapier3d::math::{Pose, Rotation, Vector};
pub use rapier3d::pipeline::PhysicsWorld;
pub use shove::Shove;
pub use simulation::mirror::LimbState;
pub use simulation::observe::{ContactForce, JointState, SeenPoint};
pub use simulation::patches::{ContactPatch, SurfaceDamping};
pub use simulation::sensing::{LimbReading, SnakeReading};
pub use simulation::{LockStep, Simulation};
pub use soft_limb::{
    Elasticity, SOFTEST_M4_S2, STIFFEST_M4_S2, bending_m4_s2, check_softness, modulus_at_pa,
};
pub use stair_profile::ClimbProgress;
pub use stairs::{LEAST_RISE_M, StairBox, StairSolid, Stairs};
pub use surface::{ERP_TIME_S, Skin, Surface};
pub use torque::JointTorque;
