//! The servo of a network: how far the network's outputs move the targets of the joints, and how stiffly the joints follow them.

use serde::{Deserialize, Serialize};

use crate::genome::gene::{GeneRange, Genes, Quantity};
use crate::genome::limits::LIMIT;
use crate::genome::space::GenomeSpace;
use crate::genome::wave_space::{SERVO_DAMPING, STIFFNESS};

/// The servo of a controller whose outputs from -1 to 1 determine target angles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ServoGenes {
    /// Torque per angle between a joint and its target, in N·m/rad.
    pub stiffness_nm_per_rad: f32,
    /// Torque against the joint's rate, per rate, in N·m·s/rad.
    pub damping_nms_per_rad: f32,
    /// Target angle of a bend at the output 1, in radians.
    pub bend_range_rad: f32,
    /// Target angle of a twist at the output 1, in radians; with 0, twists are held straight.
    pub twist_range_rad: f32,
}

/// Quantity of the range of twists if all twists are held straight.
const NO_ANGLE: Quantity = Quantity::new("rad", 0.0..=0.0);

impl ServoGenes {
    /// Returns genes with the stiffness 0, and with the values that are the same for all genomes of a space.
    pub fn zeroed(space: &GenomeSpace) -> Self {
        Self {
            stiffness_nm_per_rad: 0.0,
            damping_nms_per_rad: space.wave.servo_damping_nms_per_rad,
            bend_range_rad: space.wave.angle_range_rad,
            twist_range_rad: if twists(space) { space.wave.twist_range_rad } else { 0.0 },
        }
    }

    /// Returns whether the controller has outputs for the twists.
    pub fn twists(&self) -> bool {
        self.twist_range_rad > 0.0
    }

    /// Visits the genes of the servo.
    pub fn genes(&mut self, space: &GenomeSpace, genes: &mut Genes<'_>) {
        let twist_range_rad = Self::zeroed(space).twist_range_rad;
        self.genes_with((LIMIT, twist_range_rad), space, genes);
    }

    /// Visits the genes of a controller that holds all twists straight.
    pub fn genes_without_twist(&mut self, space: &GenomeSpace, genes: &mut Genes<'_>) {
        self.genes_with((NO_ANGLE, 0.0), space, genes);
    }

    fn genes_with(
        &mut self,
        (of_twist, twist_range_rad): (Quantity, f32),
        space: &GenomeSpace,
        genes: &mut Genes<'_>,
    ) {
        let Self { stiffness_nm_per_rad, damping_nms_per_rad, .. } = self;
        let fixed = Self::zeroed(space);
        let damping = GeneRange::Fixed(fixed.damping_nms_per_rad);
        let bend = GeneRange::Fixed(fixed.bend_range_rad);
        let twist = GeneRange::Fixed(twist_range_rad);
        genes.inside("servo.", "", |genes| {
            let range = space.wave.stiffnesses();
            genes.gene("stiffness_nm_per_rad", "stiffness", STIFFNESS, range, stiffness_nm_per_rad);
            let field = "damping_nms_per_rad";
            genes.gene(field, "servo damping", SERVO_DAMPING, damping, damping_nms_per_rad);
            genes.gene("bend_range_rad", "bend range", LIMIT, bend, &mut self.bend_range_rad);
            let value = &mut self.twist_range_rad;
            genes.gene("twist_range_rad", "twist range", of_twist, twist, value);
        });
    }

    /// Widens a space so that it contains these genes.
    pub fn widen(&self, space: &mut GenomeSpace) {
        space.wave.angle_range_rad = self.bend_range_rad;
        // A space whose twist limits are all 0 has no twists, whatever its twist range is.
        if self.twists() || twists(space) {
            space.wave.twist_range_rad = self.twist_range_rad;
        }
    }

    /// Widens a space so that it contains these genes of a controller that holds all twists straight.
    pub fn widen_without_twist(&self, space: &mut GenomeSpace) {
        let twist_range_rad = space.wave.twist_range_rad;
        self.widen(space);
        space.wave.twist_range_rad = twist_range_rad;
    }
}

/// Returns whether genomes of a space have outputs for twists.
pub(super) fn twists(space: &GenomeSpace) -> bool {
    space.wave.twist_range_rad > 0.0 && space.twist_limits_rad.iter().any(|limit| *limit > 0.0)
}
