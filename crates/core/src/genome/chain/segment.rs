//! A block of an evolving body, with the joint in front of it.

use serde::{Deserialize, Serialize};

use super::limits::inertia_kg_m2;

/// Largest number of blocks in a body.
pub const MOST_SEGMENTS: u32 = 12;

/// A block of an evolving body, with the joint in front of it. The joint of the first block, the head, has genes, too:
/// they wait until a change of the body puts a block before it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Segment {
    /// Marks the block by its descent: blocks of two bodies with the same id come from the same block.
    pub id: u64,
    /// Size along the body, in metres.
    pub length_m: f32,
    /// Size across the body, in metres.
    pub width_m: f32,
    /// Height, in metres.
    pub height_m: f32,
    /// Density, in kg/m³.
    pub density_kg_m3: f32,
    /// Largest bend of its joint to either side, in radians.
    pub bend_limit_rad: f32,
    /// Largest twist of its joint to either side, in radians.
    pub twist_limit_rad: f32,
    /// Share of the torque that its joint could have by its cross-section, from 0 to 1.
    pub strength: f32,
    /// Young's modulus of its material, in Pa. None: it is rigid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub youngs_modulus_pa: Option<f32>,
}

impl Segment {
    /// Its volume, in m³.
    pub fn volume_m3(&self) -> f64 {
        f64::from(self.length_m) * f64::from(self.width_m) * f64::from(self.height_m)
    }

    /// Its mass, in kg.
    pub fn mass_kg(&self) -> f64 {
        self.volume_m3() * f64::from(self.density_kg_m3)
    }

    /// Its largest principal moment of inertia, in kg·m².
    pub fn inertia_kg_m2(&self) -> f64 {
        inertia_kg_m2(self.mass_kg(), [self.length_m, self.width_m, self.height_m])
    }
}
