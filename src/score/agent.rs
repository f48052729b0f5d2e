//! What is given of the snake: its limbs, its joints, its skin.

use serde::{Deserialize, Serialize};

use super::PerPart;
use crate::check::{Invalid, within};
use crate::genome::{DENSITY_RANGE_KG_M3, Genome, LARGEST_LIMIT_RAD};
use crate::world::{BodyPlan, JointPlan, LimbPlan, Skin};

/// The parts of the snake that do not evolve. Sizes are one per limb, the rest one per joint, from the
/// head, or one for all.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AgentSettings {
    /// Number of limbs. The report has five.
    pub limbs: u32,
    /// Width of the limbs across x, in metres.
    pub limb_width_m: PerPart,
    /// Length of the limbs along y, in metres.
    pub limb_length_m: PerPart,
    /// Height of the limbs, in metres.
    pub limb_height_m: PerPart,
    /// Density of the limbs, in kg/m³. None: it is each genome's own, and evolves.
    pub density_kg_m3: Option<PerPart>,
    /// Largest bend of the joints to either side, in radians. None: each genome's own.
    pub bend_limit_rad: Option<PerPart>,
    /// Largest twist of the joints to either side, in radians. None: each genome's own.
    pub twist_limit_rad: Option<PerPart>,
    /// Largest torque on the joints' bend axes, in N·m.
    pub max_bend_torque_nm: PerPart,
    /// Largest torque on the joints' twist axes, in N·m.
    pub max_twist_torque_nm: PerPart,
    /// Torque that resists the joints' motion, in N·m·s/rad. Without it the motion is chaotic and a
    /// child lands anywhere, whatever its parent did.
    pub joint_damping_nms_per_rad: PerPart,
    /// Constraint force mixing of the joints, in m/s per N: 0 is rigid, larger is softer.
    pub joint_cfm_m_s_per_n: PerPart,
    /// Share of a limb's angular velocity lost per second, in 1/s.
    pub angular_damping_per_s: f32,
    /// The material of the limbs.
    pub skin: Skin,
}

impl Default for AgentSettings {
    fn default() -> Self {
        Self {
            limbs: 5,
            limb_width_m: 1.0.into(),
            limb_length_m: 2.0.into(),
            limb_height_m: 1.0.into(),
            density_kg_m3: None,
            bend_limit_rad: None,
            twist_limit_rad: None,
            max_bend_torque_nm: 1000.0.into(),
            max_twist_torque_nm: 1000.0.into(),
            joint_damping_nms_per_rad: 30.0.into(),
            joint_cfm_m_s_per_n: 0.0.into(),
            angular_damping_per_s: 2.0,
            skin: Skin::default(),
        }
    }
}

impl AgentSettings {
    /// Checks every field against its range.
    pub fn check(&self) -> Result<(), Invalid> {
        // Two limbs make a joint; with more than twelve the snake is longer than the arena.
        within("limbs", self.limbs, 2..=12)?;
        // From a finger to a bus: the engine's tolerances are made for sizes around a metre.
        for (field, sizes) in [
            ("limb_width_m", &self.limb_width_m),
            ("limb_length_m", &self.limb_length_m),
            ("limb_height_m", &self.limb_height_m),
        ] {
            sizes.check(field, self.limbs as usize, 0.1..=10.0)?;
        }
        if let Some(densities) = &self.density_kg_m3 {
            densities.check("density_kg_m3", self.limbs as usize, DENSITY_RANGE_KG_M3)?;
        }
        let joints = self.joints();
        for (field, limits) in
            [("bend_limit_rad", &self.bend_limit_rad), ("twist_limit_rad", &self.twist_limit_rad)]
        {
            if let Some(limits) = limits {
                limits.check(field, joints, 0.0..=LARGEST_LIMIT_RAD)?;
            }
        }
        // A thousand times the report's torque; more would only disqualify.
        self.max_bend_torque_nm.check("max_bend_torque_nm", joints, 0.0..=1.0e6)?;
        self.max_twist_torque_nm.check("max_twist_torque_nm", joints, 0.0..=1.0e6)?;
        // At 1e5 a torque of 1000 N·m turns a joint by half a degree a second.
        self.joint_damping_nms_per_rad.check("joint_damping_nms_per_rad", joints, 0.0..=1.0e5)?;
        // At 0.1 m/s per N a report's snake comes apart under its own weight.
        self.joint_cfm_m_s_per_n.check("joint_cfm_m_s_per_n", joints, 0.0..=0.1)?;
        // At 1000 a spin is gone within a millisecond, as in tar.
        within("angular_damping_per_s", self.angular_damping_per_s, 0.0..=1000.0)?;
        self.skin.check().map_err(|error| error.inside("skin"))
    }

    /// Number of joints between the limbs.
    pub fn joints(&self) -> usize {
        self.limbs.saturating_sub(1) as usize
    }

    /// Length of the straight snake, in metres.
    pub fn length_m(&self) -> f32 {
        (0..self.limbs as usize).map(|limb| self.limb_length_m.at(limb)).sum()
    }

    /// Size of a limb across x, along y and along z, in metres; the head is 0.
    pub fn limb_size_m(&self, limb: usize) -> [f32; 3] {
        [&self.limb_width_m, &self.limb_length_m, &self.limb_height_m].map(|size| size.at(limb))
    }

    /// The body that these settings and a genome make together.
    pub fn body_plan(&self, genome: &Genome) -> BodyPlan {
        let given = |part: &Option<PerPart>, index: usize, of_genome: f32| {
            part.as_ref().map_or(of_genome, |part| part.at(index))
        };
        let limb = |index| {
            let [width_m, length_m, height_m] = self.limb_size_m(index);
            let density_kg_m3 = given(&self.density_kg_m3, index, genome.density_kg_m3);
            LimbPlan { width_m, length_m, height_m, density_kg_m3 }
        };
        let joint = |index| JointPlan {
            bend_limit_rad: given(&self.bend_limit_rad, index, genome.bend_limit_rad),
            twist_limit_rad: given(&self.twist_limit_rad, index, genome.twist_limit_rad),
            max_bend_torque_nm: self.max_bend_torque_nm.at(index),
            max_twist_torque_nm: self.max_twist_torque_nm.at(index),
            damping_nms_per_rad: self.joint_damping_nms_per_rad.at(index),
            cfm_m_s_per_n: self.joint_cfm_m_s_per_n.at(index),
        };
        BodyPlan {
            limbs: (0..self.limbs as usize).map(limb).collect(),
            joints: (0..self.joints()).map(joint).collect(),
            angular_damping_per_s: self.angular_damping_per_s,
        }
    }
}
