//! Format 1 of a saved champion, as engine 1 wrote it. Only read, and turned into format 2.

use serde::Deserialize;

use super::v2::{
    AgentV2, ChampionV2, GenomeV2, GroundV2, HealthV2, JointTorquesV2, OriginV2, PhysicsV2,
    RecordedV2, SkinV2, StairsV2, SurfaceV2, TrialV2,
};
use crate::score::{Fitness, PerPart};
use crate::world::{Skin, Surface};

/// Declares structs of the file.
macro_rules! file {
    ($($name:ident { $($field:ident: $type:ty),* $(,)? })*) => {$(
        #[derive(Debug, Clone, PartialEq, Deserialize)]
        #[serde(deny_unknown_fields)]
        pub struct $name { $($field: $type),* }
    )*};
}

file! {
    ChampionV1 {
        kind: String,
        format: u32,
        engine: u32,
        origin: OriginV1,
        recorded: RecordedV1,
        trial: TrialV1,
        genome: GenomeV1,
    }
    OriginV1 { preset: String, seed: u64, generation: u32, individual: u32 }
    RecordedV1 { fitness_m: f32, steps: u32, trace_hash: String }
    TrialV1 {
        duration_s: f32,
        start_y_m: f32,
        physics: PhysicsV1,
        stairs: StairsV1,
        surface: SurfaceV1,
        agent: AgentV1,
        health: HealthV1,
    }
    PhysicsV1 { steps_per_s: u32, substeps: u32, gravity_m_s2: f32 }
    StairsV1 {
        steps: u32,
        rise_m: f32,
        tread_m: f32,
        width_m: f32,
        first_riser_y_m: f32,
        landing_m: f32,
    }
    SurfaceV1 { friction: f32, bounce: f32 }
    AgentV1 {
        limbs: u32,
        limb_width_m: f32,
        limb_length_m: f32,
        limb_height_m: f32,
        max_bend_torque_nm: f32,
        max_twist_torque_nm: f32,
        joint_damping_nms_per_rad: f32,
        joint_softness: SoftnessV1,
        angular_damping_per_s: f32,
    }
    SoftnessV1 { frequency_hz: f32, damping_ratio: f32 }
    HealthV1 { joint_drift_m: f32, speed_m_s: f32, arena_half_width_m: f32, arena_back_m: f32 }
    GenomeV1 {
        bend_limit_rad: f32,
        twist_limit_rad: f32,
        density_kg_m3: f32,
        points_per_s: f32,
        torques_nm: Vec<JointTorquesV1>,
    }
    JointTorquesV1 { bend: Vec<f32>, twist: Vec<f32> }
}

impl From<ChampionV1> for ChampionV2 {
    /// What format 1 could not say gets the value with which engine 1 computed, as near as format 2 can
    /// say it.
    fn from(file: ChampionV1) -> Self {
        let ChampionV1 { kind, format: _, engine, origin, recorded, trial, genome } = file;
        Self {
            kind,
            format: 2,
            engine,
            origin: OriginV2 {
                preset: origin.preset,
                seed: origin.seed,
                generation: origin.generation,
                individual: origin.individual,
            },
            recorded: RecordedV2 {
                fitness: recorded.fitness_m,
                centre_y_m: recorded.fitness_m,
                steps: recorded.steps,
                trace_hash: recorded.trace_hash,
            },
            trial: trial_v2(trial, genome.density_kg_m3),
            genome: GenomeV2 {
                bend_limit_rad: genome.bend_limit_rad,
                twist_limit_rad: genome.twist_limit_rad,
                density_kg_m3: genome.density_kg_m3,
                points_per_s: genome.points_per_s,
                torques_nm: genome
                    .torques_nm
                    .into_iter()
                    .map(|joint| JointTorquesV2 { bend: joint.bend, twist: joint.twist })
                    .collect(),
            },
        }
    }
}

fn trial_v2(trial: TrialV1, density_kg_m3: f32) -> TrialV2 {
    let TrialV1 { duration_s, start_y_m, physics, stairs, surface, agent, health } = trial;
    let SurfaceV1 { friction, bounce } = surface;
    TrialV2 {
        duration_s,
        start_y_m,
        physics: PhysicsV2 {
            steps_per_s: physics.steps_per_s,
            substeps: physics.substeps,
            gravity_m_s2: physics.gravity_m_s2,
        },
        stairs: StairsV2 {
            steps: stairs.steps,
            rise_m: stairs.rise_m,
            tread_m: stairs.tread_m,
            width_m: stairs.width_m,
            first_riser_y_m: stairs.first_riser_y_m,
            landing_m: stairs.landing_m,
        },
        surface: SurfaceV2::from(Surface { friction, bounce, ..Default::default() }),
        ground: GroundV2(None),
        fitness: Fitness::Centre,
        agent: AgentV2 {
            limbs: agent.limbs,
            joint_cfm_m_s_per_n: PerPart::All(joint_cfm(
                &agent,
                physics.steps_per_s,
                density_kg_m3,
            )),
            limb_width_m: agent.limb_width_m.into(),
            limb_length_m: agent.limb_length_m.into(),
            limb_height_m: agent.limb_height_m.into(),
            density_kg_m3: None,
            bend_limit_rad: None,
            twist_limit_rad: None,
            max_bend_torque_nm: agent.max_bend_torque_nm.into(),
            max_twist_torque_nm: agent.max_twist_torque_nm.into(),
            joint_damping_nms_per_rad: agent.joint_damping_nms_per_rad.into(),
            angular_damping_per_s: agent.angular_damping_per_s,
            skin: SkinV2::from(Skin::default()),
        },
        health: HealthV2 {
            joint_drift_m: health.joint_drift_m,
            speed_m_s: health.speed_m_s,
            arena_half_width_m: health.arena_half_width_m,
            arena_back_m: health.arena_back_m,
        },
    }
}

/// A joint's spring of format 1 as CFM: of a spring kp and a damper kd, `CFM = 1 / (h·kp + kd)`. What
/// format 1 called rigid is rigid. The effective mass is that of two limbs pulled apart.
fn joint_cfm(agent: &AgentV1, steps_per_s: u32, density_kg_m3: f32) -> f32 {
    const RIGID_HZ: f32 = 1.0e4;
    const SOFTEST_JOINT: f32 = 0.1;
    let SoftnessV1 { frequency_hz, damping_ratio } = agent.joint_softness;
    if frequency_hz >= RIGID_HZ {
        return 0.0;
    }
    let volume_m3 = agent.limb_width_m * agent.limb_length_m * agent.limb_height_m;
    let reduced_kg = volume_m3 * density_kg_m3 / 2.0;
    let angular_frequency = std::f32::consts::TAU * frequency_hz;
    let kp_n_per_m = angular_frequency * angular_frequency * reduced_kg;
    let kd_ns_per_m = 2.0 * damping_ratio * angular_frequency * reduced_kg;
    // Softer than format 2 allows would come apart under its own weight.
    let cfm_m_s_per_n = 1.0 / (kp_n_per_m / steps_per_s as f32 + kd_ns_per_m);
    if cfm_m_s_per_n < SOFTEST_JOINT { cfm_m_s_per_n } else { SOFTEST_JOINT }
}
