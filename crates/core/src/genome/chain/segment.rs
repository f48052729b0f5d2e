//! A block of an evolving body, with the joint in front of it.

use serde::{Deserialize, Serialize};

use super::limits::{check_neighbours, inertia_kg_m2};
use crate::check::{Invalid, within};
use crate::genome::limits::{
    DENSITY_RANGE_KG_M3, LARGEST_LIMIT_RAD, MODULUS_RANGE_PA, SIZE_RANGE_M,
};
use crate::world::check_softness;

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

    /// Checks every value.
    fn check(&self) -> Result<(), Invalid> {
        within("length_m", self.length_m, SIZE_RANGE_M)?;
        within("width_m", self.width_m, SIZE_RANGE_M)?;
        within("height_m", self.height_m, SIZE_RANGE_M)?;
        within("density_kg_m3", self.density_kg_m3, DENSITY_RANGE_KG_M3)?;
        within("bend_limit_rad", self.bend_limit_rad, 0.0..=LARGEST_LIMIT_RAD)?;
        within("twist_limit_rad", self.twist_limit_rad, 0.0..=LARGEST_LIMIT_RAD)?;
        within("strength", self.strength, 0.0..=1.0)?;
        let Some(modulus_pa) = self.youngs_modulus_pa else { return Ok(()) };
        within("youngs_modulus_pa", modulus_pa, MODULUS_RANGE_PA)?;
        let sides_m = [self.width_m, self.height_m];
        check_softness("youngs_modulus_pa", modulus_pa, sides_m, self.density_kg_m3)
    }
}

/// Checks that a body of these blocks can be built.
///
/// # Errors
/// Their number, a value of one, or the ratio of two neighbours is not allowed, or two have the same id.
pub fn check_segments(segments: &[Segment]) -> Result<(), Invalid> {
    within("segments", segments.len(), 2..=MOST_SEGMENTS as usize)?;
    for (index, segment) in segments.iter().enumerate() {
        let place = format!("segments[{index}]");
        segment.check().map_err(|error| error.inside(&place))?;
        if segments[..index].iter().any(|earlier| earlier.id == segment.id) {
            let field = format!("{place}.id");
            return Err(Invalid::new(
                field,
                segment.id,
                "an id that no other block of the body has",
            ));
        }
    }
    check_neighbours(segments)
}
