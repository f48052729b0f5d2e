//! Format 2 of a saved champion, exactly as it stands in files. Never changed once released: a new
//! need makes a `v3`, and this module keeps reading what it wrote.

use serde::{Deserialize, Serialize};

use crate::ENGINE_VERSION;
use crate::check::Invalid;
use crate::evolve::{Champion, Origin};
use crate::genome::{Genome, JointSignals, Signals};
use crate::score::{AgentSettings, Evaluation, Fitness, PerPart, Trial};
use crate::world::{HealthLimits, PhysicsSettings, Skin, Stairs, Surface};

/// What every file of this kind says first.
pub const KIND: &str = "snakes-and-stairs champion";
/// The number of this format.
pub const FORMAT: u32 = 2;

/// Declares a struct of the file and its translation from and to the core's struct, field by field.
/// A field the core gains or loses breaks the build here, where the decision belongs.
macro_rules! mirrors {
    ($($file:ident = $core:ident { $($field:ident: $type:ty),* $(,)? })*) => {$(
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
        #[serde(deny_unknown_fields)]
        pub struct $file { $(pub $field: $type),* }

        impl From<$core> for $file {
            fn from($core { $($field),* }: $core) -> Self {
                Self { $($field: $field.into()),* }
            }
        }

        impl From<$file> for $core {
            fn from($file { $($field),* }: $file) -> Self {
                Self { $($field: $field.into()),* }
            }
        }
    )*};
}

mirrors! {
    TrialV2 = Trial {
        duration_s: f32,
        start_y_m: f32,
        physics: PhysicsV2,
        stairs: StairsV2,
        surface: SurfaceV2,
        ground: GroundV2,
        agent: AgentV2,
        fitness: Fitness,
        health: HealthV2,
    }
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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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

impl From<Champion> for ChampionV2 {
    fn from(champion: Champion) -> Self {
        let Champion { genome, trial, evaluation, origin } = champion;
        let torques = genome.signals.joints.into_iter();
        Self {
            kind: KIND.to_owned(),
            format: FORMAT,
            engine: ENGINE_VERSION,
            origin: origin.into(),
            recorded: RecordedV2 {
                fitness: evaluation.fitness,
                centre_y_m: evaluation.centre_y_m,
                steps: evaluation.steps,
                trace_hash: format!("{:016x}", evaluation.trace_hash),
            },
            trial: trial.into(),
            genome: GenomeV2 {
                bend_limit_rad: genome.bend_limit_rad,
                twist_limit_rad: genome.twist_limit_rad,
                density_kg_m3: genome.density_kg_m3,
                points_per_s: genome.signals.points_per_s,
                torques_nm: torques
                    .map(|joint| JointTorquesV2 { bend: joint.bend_nm, twist: joint.twist_nm })
                    .collect(),
            },
        }
    }
}

impl TryFrom<ChampionV2> for Champion {
    type Error = Invalid;

    /// Translates and checks every value.
    fn try_from(file: ChampionV2) -> Result<Self, Invalid> {
        let recorded = file.recorded;
        let trace_hash = u64::from_str_radix(&recorded.trace_hash, 16).map_err(|_| {
            let start: String = recorded.trace_hash.chars().take(40).collect();
            Invalid::new("recorded.trace_hash", format!("{start:?}"), "16 hexadecimal digits")
        })?;
        crate::check::within("recorded.fitness", recorded.fitness, -1.0e6..=1.0e6)?;
        crate::check::within("recorded.centre_y_m", recorded.centre_y_m, -1.0e6..=1.0e6)?;
        let trial = Trial::from(file.trial);
        trial.check().map_err(|error| error.inside("trial"))?;
        let joints = file.genome.torques_nm.into_iter();
        let genome = Genome {
            bend_limit_rad: file.genome.bend_limit_rad,
            twist_limit_rad: file.genome.twist_limit_rad,
            density_kg_m3: file.genome.density_kg_m3,
            signals: Signals {
                points_per_s: file.genome.points_per_s,
                joints: joints
                    .map(|joint| JointSignals { bend_nm: joint.bend, twist_nm: joint.twist })
                    .collect(),
            },
        };
        trial.check_genome(&genome).map_err(|error| error.inside("genome"))?;
        let evaluation = Evaluation {
            fitness: recorded.fitness,
            centre_y_m: recorded.centre_y_m,
            disqualified: None,
            trace_hash,
            steps: recorded.steps,
        };
        Ok(Self { genome, trial, evaluation, origin: file.origin.into() })
    }
}
