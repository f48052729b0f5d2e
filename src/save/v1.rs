//! Format 1 of a saved champion, exactly as it stands in files. Never changed once released: a new
//! need makes a `v2`, and this module keeps reading what it wrote.

use serde::{Deserialize, Serialize};

use crate::ENGINE_VERSION;
use crate::check::Invalid;
use crate::evolve::{Champion, Origin};
use crate::genome::{Genome, JointSignals, Signals};
use crate::score::{AgentSettings, Evaluation, Trial};
use crate::world::{HealthLimits, PhysicsSettings, Softness, Stairs, Surface};

/// What every file of this kind says first.
pub const KIND: &str = "snakes-and-stairs champion";
/// The number of this format.
pub const FORMAT: u32 = 1;

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
    TrialV1 = Trial {
        duration_s: f32,
        start_y_m: f32,
        physics: PhysicsV1,
        stairs: StairsV1,
        surface: SurfaceV1,
        agent: AgentV1,
        health: HealthV1,
    }
    PhysicsV1 = PhysicsSettings { steps_per_s: u32, substeps: u32, gravity_m_s2: f32 }
    StairsV1 = Stairs {
        steps: u32,
        rise_m: f32,
        tread_m: f32,
        width_m: f32,
        first_riser_y_m: f32,
        landing_m: f32,
    }
    SurfaceV1 = Surface { friction: f32, bounce: f32 }
    AgentV1 = AgentSettings {
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
    SoftnessV1 = Softness { frequency_hz: f32, damping_ratio: f32 }
    HealthV1 = HealthLimits {
        joint_drift_m: f32,
        speed_m_s: f32,
        arena_half_width_m: f32,
        arena_back_m: f32,
    }
    OriginV1 = Origin { preset: String, seed: u64, generation: u32, individual: u32 }
}

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChampionV1 {
    pub kind: String,
    pub format: u32,
    pub engine: u32,
    pub origin: OriginV1,
    pub recorded: RecordedV1,
    pub trial: TrialV1,
    pub genome: GenomeV1,
}

/// What the champion reached when it was found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecordedV1 {
    pub fitness_m: f32,
    pub steps: u32,
    pub trace_hash: String,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GenomeV1 {
    pub bend_limit_rad: f32,
    pub twist_limit_rad: f32,
    pub density_kg_m3: f32,
    pub points_per_s: f32,
    pub torques_nm: Vec<JointTorquesV1>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointTorquesV1 {
    pub bend: Vec<f32>,
    pub twist: Vec<f32>,
}

impl From<Champion> for ChampionV1 {
    fn from(champion: Champion) -> Self {
        let Champion { genome, trial, evaluation, origin } = champion;
        let torques = genome.signals.joints.into_iter();
        Self {
            kind: KIND.to_owned(),
            format: FORMAT,
            engine: ENGINE_VERSION,
            origin: origin.into(),
            recorded: RecordedV1 {
                fitness_m: evaluation.fitness_m,
                steps: evaluation.steps,
                trace_hash: format!("{:016x}", evaluation.trace_hash),
            },
            trial: trial.into(),
            genome: GenomeV1 {
                bend_limit_rad: genome.bend_limit_rad,
                twist_limit_rad: genome.twist_limit_rad,
                density_kg_m3: genome.density_kg_m3,
                points_per_s: genome.signals.points_per_s,
                torques_nm: torques
                    .map(|joint| JointTorquesV1 { bend: joint.bend_nm, twist: joint.twist_nm })
                    .collect(),
            },
        }
    }
}

impl TryFrom<ChampionV1> for Champion {
    type Error = Invalid;

    /// Translates and checks every value.
    fn try_from(file: ChampionV1) -> Result<Self, Invalid> {
        let recorded = file.recorded;
        let trace_hash = u64::from_str_radix(&recorded.trace_hash, 16).map_err(|_| {
            let start: String = recorded.trace_hash.chars().take(40).collect();
            Invalid::new("recorded.trace_hash", format!("{start:?}"), "16 hexadecimal digits")
        })?;
        crate::check::within("recorded.fitness_m", recorded.fitness_m, -1.0e6..=1.0e6)?;
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
            fitness_m: recorded.fitness_m,
            disqualified: None,
            trace_hash,
            steps: recorded.steps,
        };
        Ok(Self { genome, trial, evaluation, origin: file.origin.into() })
    }
}
