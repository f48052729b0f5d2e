//! Format 2 of a saved champion, and the parts of it that later formats share. Never changed once released:
//! a part that changes gets a new version beside it, and this module keeps reading what it wrote.

use serde::{Deserialize, Serialize};

use super::mirror::mirrors;
use crate::evolve::Origin;
use crate::score::{AgentSettings, Fitness, PerPart};
use crate::world::{HealthLimits, PhysicsSettings, Skin, Stairs, Surface};

mirrors! {
    PhysicsV2 = PhysicsSettings { steps_per_s: u32, substeps: u32, gravity_m_s2: f32 }
    StairsV2 = Stairs {
        steps: u32,
        rise_m: f32,
        tread_m: f32,
        width_m: f32,
        first_riser_y_m: f32,
        landing_m: f32,
    }
    SurfaceV2 = Surface {
        friction: f32,
        bounce: f32,
        bounce_velocity_m_s: f32,
        soft_erp: f32,
        soft_cfm_m_s_per_n: f32,
        slip_m_s_per_n: f32,
        dampen_per_s: f32,
    }
    SkinV2 = Skin { friction: f32, bounce: f32, soft_erp: f32, soft_cfm_m_s_per_n: f32 }
    AgentV2 = AgentSettings {
        limbs: u32,
        limb_width_m: PerPart,
        limb_length_m: PerPart,
        limb_height_m: PerPart,
        density_kg_m3: Option<PerPart>,
        bend_limit_rad: Option<PerPart>,
        twist_limit_rad: Option<PerPart>,
        max_bend_torque_nm: PerPart,
        max_twist_torque_nm: PerPart,
        joint_damping_nms_per_rad: PerPart,
        joint_cfm_m_s_per_n: PerPart,
        angular_damping_per_s: f32,
        skin: SkinV2,
    }
    HealthV2 = HealthLimits {
        joint_drift_m: f32,
        speed_m_s: f32,
        arena_half_width_m: f32,
        arena_back_m: f32,
    }
    OriginV2 = Origin { preset: String, seed: u64, generation: u32, individual: u32 }
}

/// The conditions of format 2.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrialV2 {
    pub duration_s: f32,
    pub start_y_m: f32,
    pub physics: PhysicsV2,
    pub stairs: StairsV2,
    pub surface: SurfaceV2,
    pub ground: GroundV2,
    pub agent: AgentV2,
    pub fitness: Fitness,
    pub health: HealthV2,
}

/// The ground's own surface, if it has one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct GroundV2(pub Option<SurfaceV2>);

impl From<Option<Surface>> for GroundV2 {
    fn from(ground: Option<Surface>) -> Self {
        Self(ground.map(Into::into))
    }
}

impl From<GroundV2> for Option<Surface> {
    fn from(ground: GroundV2) -> Self {
        ground.0.map(Into::into)
    }
}

/// The whole file.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChampionV2 {
    pub kind: String,
    pub format: u32,
    pub engine: u32,
    pub origin: OriginV2,
    pub recorded: RecordedV2,
    pub trial: TrialV2,
    pub genome: GenomeV2,
}

/// What the champion reached when it was found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecordedV2 {
    pub fitness: f32,
    pub centre_y_m: f32,
    pub steps: u32,
    pub trace_hash: String,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GenomeV2 {
    pub bend_limit_rad: f32,
    pub twist_limit_rad: f32,
    pub density_kg_m3: f32,
    pub points_per_s: f32,
    pub torques_nm: Vec<JointTorquesV2>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointTorquesV2 {
    pub bend: Vec<f32>,
    pub twist: Vec<f32>,
}
