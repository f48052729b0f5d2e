//! The servo of a network: how far its outputs move the targets of the joints, and how stiffly these are followed.

use serde::{Deserialize, Serialize};

use crate::check::{Invalid, within};
use crate::genome::gene::{Gene, GeneRange, GeneVisitor};
use crate::genome::limits::LARGEST_LIMIT_RAD;
use crate::genome::space::GenomeSpace;
use crate::genome::wave_space::{SERVO_DAMPING_RANGE, STIFFNESS_RANGE_NM_PER_RAD};

/// The servo of a controller whose outputs from -1 to 1 are target angles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ServoGenes {
    /// Torque per angle by which a joint misses its target, in N·m/rad.
    pub stiffness_nm_per_rad: f32,
    /// Torque against the joint's rate, in N·m·s/rad.
    pub damping_nms_per_rad: f32,
    /// The target angle of a bend at the output 1, in radians.
    pub bend_range_rad: f32,
    /// The same of a twist; at 0, twists are held straight.
    pub twist_range_rad: f32,
}

impl ServoGenes {
    /// Genes of zeros, with what is the same for all genomes of a space.
    pub fn zeroed(space: &GenomeSpace) -> Self {
        Self {
            stiffness_nm_per_rad: 0.0,
            damping_nms_per_rad: space.wave.servo_damping_nms_per_rad,
            bend_range_rad: space.wave.angle_range_rad,
            twist_range_rad: if twists(space) { space.wave.twist_range_rad } else { 0.0 },
        }
    }

    /// Whether the twists have outputs of their own.
    pub fn twists(&self) -> bool {
        self.twist_range_rad > 0.0
    }

    /// Visits the genes.
    pub fn genes(&mut self, space: &GenomeSpace, visit: GeneVisitor<'_>) {
        let twist_range_rad = Self::zeroed(space).twist_range_rad;
        self.genes_with(space, twist_range_rad, visit);
    }

    /// Visits the genes of a controller that holds all twists straight.
    pub fn genes_without_twist(&mut self, space: &GenomeSpace, visit: GeneVisitor<'_>) {
        self.genes_with(space, 0.0, visit);
    }

    fn genes_with(&mut self, space: &GenomeSpace, twist_range_rad: f32, visit: GeneVisitor<'_>) {
        let wave = &space.wave;
        let range =
            GeneRange::Between(wave.stiffness_min_nm_per_rad, wave.stiffness_max_nm_per_rad);
        let (field, name) = (format_args!("servo.stiffness_nm_per_rad"), format_args!("stiffness"));
        visit(Gene { field, name, unit: "N·m/rad", range }, &mut self.stiffness_nm_per_rad);
        let fixed = Self::zeroed(space);
        let mut visit_fixed = |field, name, unit, fixed, value: &mut f32| {
            let range = GeneRange::Fixed(fixed);
            visit(Gene { field, name, unit, range }, value);
        };
        let (field, name) =
            (format_args!("servo.damping_nms_per_rad"), format_args!("servo damping"));
        let value = &mut self.damping_nms_per_rad;
        visit_fixed(field, name, "N·m·s/rad", fixed.damping_nms_per_rad, value);
        let (field, name) = (format_args!("servo.bend_range_rad"), format_args!("bend range"));
        visit_fixed(field, name, "rad", fixed.bend_range_rad, &mut self.bend_range_rad);
        let (field, name) = (format_args!("servo.twist_range_rad"), format_args!("twist range"));
        visit_fixed(field, name, "rad", twist_range_rad, &mut self.twist_range_rad);
    }

    /// Checks every value.
    pub fn check(&self) -> Result<(), Invalid> {
        within(
            "servo.stiffness_nm_per_rad",
            self.stiffness_nm_per_rad,
            STIFFNESS_RANGE_NM_PER_RAD,
        )?;
        within("servo.damping_nms_per_rad", self.damping_nms_per_rad, SERVO_DAMPING_RANGE)?;
        within("servo.bend_range_rad", self.bend_range_rad, 0.0..=LARGEST_LIMIT_RAD)?;
        within("servo.twist_range_rad", self.twist_range_rad, 0.0..=LARGEST_LIMIT_RAD)
    }

    /// Widens a space so that it contains these genes.
    pub fn widen(&self, space: &mut GenomeSpace) {
        let wave = &mut space.wave;
        wave.widen_stiffness(self.stiffness_nm_per_rad);
        wave.servo_damping_nms_per_rad = self.damping_nms_per_rad;
        wave.angle_range_rad = self.bend_range_rad;
        // Without a limit above 0 a space has no twists, whatever its range.
        if self.twists() || twists(space) {
            space.wave.twist_range_rad = self.twist_range_rad;
        }
    }
}

impl ServoGenes {
    /// Widens a space so that it contains these genes of a controller that holds all twists straight.
    pub fn widen_without_twist(&self, space: &mut GenomeSpace) {
        let twist_range_rad = space.wave.twist_range_rad;
        self.widen(space);
        space.wave.twist_range_rad = twist_range_rad;
    }
}

/// Whether a space has genes of twists.
pub(super) fn twists(space: &GenomeSpace) -> bool {
    space.wave.twist_range_rad > 0.0 && space.twist_limits_rad.iter().any(|limit| *limit > 0.0)
}
