//! The numbers of a block of a body.

use snakes_core::genome::Segment;
use snakes_core::world::modulus_at_pa;

/// A number of a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum BlockSize {
    /// Length, in metres.
    Length,
    /// Width, in metres.
    Width,
    /// Height, in metres.
    Height,
    /// Density, in kg/m³.
    Density,
    /// Largest bend of the joint in front of it, in radians.
    BendLimit,
    /// Largest twist of that joint, in radians.
    TwistLimit,
    /// Share of the torque that the joint could have.
    Strength,
    /// Young's modulus, in Pa. To set it makes a rigid block soft.
    Modulus,
}

impl BlockSize {
    /// Young's modulus of a block that has just become soft, in Pa: a block of any size then bends by a similar part of its
    /// length as those of the preset `squishy`, which have 40,000 Pa.
    pub fn usual_modulus_pa(segment: &Segment) -> f32 {
        const SQUISHY_M4_S2: f32 = 370.0;
        let sides_m = [segment.width_m, segment.height_m];
        let modulus_pa = modulus_at_pa(SQUISHY_M4_S2, sides_m, segment.density_kg_m3);
        (modulus_pa / 100.0).round() * 100.0
    }

    /// The number in a block.
    pub fn of_mut(self, segment: &mut Segment) -> &mut f32 {
        match self {
            Self::Length => &mut segment.length_m,
            Self::Width => &mut segment.width_m,
            Self::Height => &mut segment.height_m,
            Self::Density => &mut segment.density_kg_m3,
            Self::BendLimit => &mut segment.bend_limit_rad,
            Self::TwistLimit => &mut segment.twist_limit_rad,
            Self::Strength => &mut segment.strength,
            Self::Modulus => {
                let usual_pa = Self::usual_modulus_pa(segment);
                segment.youngs_modulus_pa.get_or_insert(usual_pa)
            }
        }
    }
}
