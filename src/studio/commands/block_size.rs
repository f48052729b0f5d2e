//! The editable numbers of a body's block.

use snakes_core::genome::Segment;
use snakes_core::world::modulus_at_pa;

/// An editable number of a body's block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum BlockSize {
    /// Length of the block, in metres.
    Length,
    /// Width of the block, in metres.
    Width,
    /// Height of the block, in metres.
    Height,
    /// Density of the block, in kg/m³.
    Density,
    /// Largest bend of the joint in front of the block, in radians.
    BendLimit,
    /// Largest twist of the joint in front of the block, in radians.
    TwistLimit,
    /// Strength of the joint in front of the block, as a share of its possible torque.
    Strength,
    /// Young's modulus of the block, in Pa. Setting it makes a rigid block soft.
    Modulus,
}

impl BlockSize {
    /// Returns Young's modulus for a block that has just become soft, in Pa. Relative to its length, it bends about as
    /// much as a block of the preset `squishy`, which has 40,000 Pa.
    pub fn usual_modulus_pa(segment: &Segment) -> f32 {
        const SQUISHY_M4_S2: f32 = 370.0;
        let sides_m = [segment.width_m, segment.height_m];
        let modulus_pa = modulus_at_pa(SQUISHY_M4_S2, sides_m, segment.density_kg_m3);
        (modulus_pa / 100.0).round() * 100.0
    }

    /// Returns a mutable reference to this number in a block.
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
