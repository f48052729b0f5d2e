//! A block of an evolving body, with the joint in front of it.

use serde::{Deserialize, Serialize};

use super::limits::inertia_kg_m2;

/// Largest number of blocks in a body.
pub const MOST_SEGMENTS: u32 = 12;

/// A block of an evolving body, with the joint in front of it. The first block, the head, also has genes of a joint. They have no effect
/// until a change of the body puts a block in front of the head.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Segment {
    /// Id of the block by its descent: blocks of two bodies with the same id come from the same block.
    pub id: u64,
    /// Size of the block along the body, in metres.
    pub length_m: f32,
    /// Size of the block across the body, in metres.
    pub width_m: f32,
    /// Height of the block, in metres.
    pub height_m: f32,
    /// Density of the block, in kg/m³.
    pub density_kg_m3: f32,
    /// Largest bend of the block's joint to either side, in radians.
    pub bend_limit_rad: f32,
    /// Largest twist of the block's joint to either side, in radians.
    pub twist_limit_rad: f32,
    /// Strength of the block's joint, from 0 to 1, as a share of the torque that its cross-section allows.
    pub strength: f32,
    /// Young's modulus of the block's material, in Pa; `None` for a rigid block.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub youngs_modulus_pa: Option<f32>,
}

impl Segment {
    /// Returns the volume of the block, in m³.
    pub fn volume_m3(&self) -> f64 {
        f64::from(self.length_m) * f64::from(self.width_m) * f64::from(self.height_m)
    }

    /// Returns the mass of the block, in kg.
    pub fn mass_kg(&self) -> f64 {
        self.volume_m3() * f64::from(self.density_kg_m3)
    }

    /// Returns the largest principal moment of inertia of the block, in kg·m².
    pub fn inertia_kg_m2(&self) -> f64 {
        inertia_kg_m2(self.mass_kg(), [self.length_m, self.width_m, self.height_m])
    }
}
