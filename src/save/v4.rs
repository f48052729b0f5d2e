//! Format 4 of a saved champion, exactly as it stands in files: format 3, and what drives the joints may be a wave
//! or a gait, energy may cost, several trials may make an evaluation, and how the snake went about it is recorded.

use serde::{Deserialize, Serialize};

use super::files::hash_of;
use super::mirror::mirrors;
use super::poses::PosesV3;
use super::v2::{
    AgentV2, GenomeV2, GroundV2, HealthV2, JointTorquesV2, OriginV2, PhysicsV2, StairsV2,
    SurfaceV2, TrialV2,
};
use super::v3::{ChampionV3, EffortV3, KIND, RecordedV3};
use crate::ENGINE_VERSION;
use crate::check::{Invalid, name, within};
use crate::evolve::Champion;
use crate::genome::{
    Controller, Gait, Genome, Harmonic, JointSignals, JointWaves, Signals, Wave, Waves,
};
use crate::score::{
    Behaviour, Counts, Evaluation, FITNESS_RANGE, Fitness, PerturbationRange, Recording, Repeats,
    Trial,
};

/// The number of this format.
pub const FORMAT: u32 = 4;

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChampionV4 {
    pub kind: String,
    pub format: u32,
    pub engine: u32,
    pub origin: OriginV2,
    pub recorded: RecordedV4,
    pub trial: TrialV4,
    pub genome: GenomeV4,
    pub poses: Option<PosesV3>,
}

/// What the champion reached when it was found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecordedV4 {
    pub fitness: f32,
    pub centre_y_m: f32,
    pub steps: u32,
    pub trace_hash: String,
    /// None in what formats 1 and 2 recorded.
    pub effort: Option<EffortV3>,
    /// None in what formats before 4 recorded.
    pub behaviour: Option<BehaviourV4>,
}

mirrors! {
    BehaviourV4 = Behaviour {
        steps_climbed: u32,
        mean_height_m: f32,
        mean_sideways_m: f32,
        contact_duty: f32,
        frequency_hz: f32,
    }
    TrialV4 = Trial {
        duration_s: f32,
        start_y_m: f32,
        physics: PhysicsV2,
        stairs: StairsV2,
        surface: SurfaceV2,
        ground: GroundV2,
        agent: AgentV2,
        fitness: Fitness,
        energy_cost_per_kj: f32,
        repeats: RepeatsV4,
        health: HealthV2,
    }
    GenomeV4 = Genome {
        bend_limit_rad: f32,
        twist_limit_rad: f32,
        density_kg_m3: f32,
        controller: ControllerV4,
    }
    RepeatsV4 = Repeats { trials: u32, counts: Counts, off: OffV4 }
    OffV4 = PerturbationRange {
        friction: f32,
        rise: f32,
        density: f32,
        start_m: f32,
        turn_deg: f32,
    }
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum ControllerV4 {
    Signal {
        points_per_s: f32,
        torques_nm: Vec<JointTorquesV2>,
    },
    /// Waves of torque, in N·m.
    Wave {
        frequency_hz: f32,
        joints: Vec<JointWavesV4>,
    },
    /// Waves of target angles, in radians.
    Gait {
        stiffness_nm_per_rad: f32,
        servo_damping_nms_per_rad: f32,
        frequency_hz: f32,
        joints: Vec<JointWavesV4>,
    },
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointWavesV4 {
    pub bend: WaveV4,
    pub twist: WaveV4,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WaveV4 {
    pub offset: f32,
    /// Amplitude and phase, in radians, of each term.
    pub terms: Vec<(f32, f32)>,
}

impl From<Wave> for WaveV4 {
    fn from(Wave { offset, harmonics }: Wave) -> Self {
        let terms = harmonics.into_iter().map(|term| (term.amplitude, term.phase_rad)).collect();
        Self { offset, terms }
    }
}

impl From<WaveV4> for Wave {
    fn from(WaveV4 { offset, terms }: WaveV4) -> Self {
        let term = |(amplitude, phase_rad)| Harmonic { amplitude, phase_rad };
        Self { offset, harmonics: terms.into_iter().map(term).collect() }
    }
}

fn joints_v4(waves: Waves) -> Vec<JointWavesV4> {
    let joint =
        |JointWaves { bend, twist }| JointWavesV4 { bend: bend.into(), twist: twist.into() };
    waves.joints.into_iter().map(joint).collect()
}

fn waves(frequency_hz: f32, joints: Vec<JointWavesV4>) -> Waves {
    let joint =
        |JointWavesV4 { bend, twist }| JointWaves { bend: bend.into(), twist: twist.into() };
    Waves { frequency_hz, joints: joints.into_iter().map(joint).collect() }
}

impl From<Controller> for ControllerV4 {
    fn from(controller: Controller) -> Self {
        match controller {
            Controller::Signal(Signals { points_per_s, joints }) => {
                let joint = |JointSignals { bend_nm, twist_nm }| JointTorquesV2 {
                    bend: bend_nm,
                    twist: twist_nm,
                };
                let torques_nm = joints.into_iter().map(joint).collect();
                Self::Signal { points_per_s, torques_nm }
            }
            Controller::Wave(waves) => {
                Self::Wave { frequency_hz: waves.frequency_hz, joints: joints_v4(waves) }
            }
            Controller::Gait(Gait { waves, stiffness_nm_per_rad, servo_damping_nms_per_rad }) => {
                Self::Gait {
                    stiffness_nm_per_rad,
                    servo_damping_nms_per_rad,
                    frequency_hz: waves.frequency_hz,
                    joints: joints_v4(waves),
                }
            }
        }
    }
}

impl From<ControllerV4> for Controller {
    fn from(controller: ControllerV4) -> Self {
        match controller {
            ControllerV4::Signal { points_per_s, torques_nm } => {
                let joint = |JointTorquesV2 { bend, twist }| JointSignals {
                    bend_nm: bend,
                    twist_nm: twist,
                };
                let joints = torques_nm.into_iter().map(joint).collect();
                Self::Signal(Signals { points_per_s, joints })
            }
            ControllerV4::Wave { frequency_hz, joints } => Self::Wave(waves(frequency_hz, joints)),
            ControllerV4::Gait {
                stiffness_nm_per_rad,
                servo_damping_nms_per_rad,
                frequency_hz,
                joints,
            } => Self::Gait(Gait {
                waves: waves(frequency_hz, joints),
                stiffness_nm_per_rad,
                servo_damping_nms_per_rad,
            }),
        }
    }
}

impl BehaviourV4 {
    /// Checks every value.
    pub fn check(&self) -> Result<(), Invalid> {
        within("steps_climbed", self.steps_climbed, 0..=1000)?;
        for (field, value) in [
            ("mean_height_m", self.mean_height_m),
            ("mean_sideways_m", self.mean_sideways_m),
            ("contact_duty", self.contact_duty),
            ("frequency_hz", self.frequency_hz),
        ] {
            within(field, value, -1.0e6..=1.0e6)?;
        }
        Ok(())
    }
}

impl From<TrialV2> for TrialV4 {
    fn from(trial: TrialV2) -> Self {
        let TrialV2 {
            duration_s,
            start_y_m,
            physics,
            stairs,
            surface,
            ground,
            agent,
            fitness,
            health,
        } = trial;
        Self {
            duration_s,
            start_y_m,
            physics,
            stairs,
            surface,
            ground,
            agent,
            fitness,
            energy_cost_per_kj: 0.0,
            repeats: Repeats::default().into(),
            health,
        }
    }
}

impl From<GenomeV2> for GenomeV4 {
    fn from(genome: GenomeV2) -> Self {
        let GenomeV2 { bend_limit_rad, twist_limit_rad, density_kg_m3, points_per_s, torques_nm } =
            genome;
        let controller = ControllerV4::Signal { points_per_s, torques_nm };
        Self { bend_limit_rad, twist_limit_rad, density_kg_m3, controller }
    }
}

impl From<ChampionV3> for ChampionV4 {
    fn from(file: ChampionV3) -> Self {
        let ChampionV3 { kind, format: _, engine, origin, recorded, trial, genome, poses } = file;
        let RecordedV3 { fitness, centre_y_m, steps, trace_hash, effort } = recorded;
        let behaviour = None;
        let recorded = RecordedV4 { fitness, centre_y_m, steps, trace_hash, effort, behaviour };
        let (trial, genome) = (trial.into(), genome.into());
        Self { kind, format: FORMAT, engine, origin, recorded, trial, genome, poses }
    }
}

impl ChampionV4 {
    /// The file of a champion that this engine found.
    pub fn new(champion: Champion, recording: Option<&Recording>) -> Self {
        let Champion { genome, trial, evaluation, origin } = champion;
        Self {
            kind: KIND.to_owned(),
            format: FORMAT,
            engine: ENGINE_VERSION,
            origin: origin.into(),
            recorded: evaluation.into(),
            trial: trial.into(),
            genome: genome.into(),
            poses: recording.map(Into::into),
        }
    }

    /// Translates and checks every value.
    pub fn into_parts(self) -> Result<(Champion, Option<Recording>), Invalid> {
        name("origin.preset", &self.origin.preset)?;
        let trial = Trial::from(self.trial);
        trial.check().map_err(|error| error.inside("trial"))?;
        let genome = Genome::from(self.genome);
        trial.check_genome(&genome).map_err(|error| error.inside("genome"))?;
        let recording = self.poses.map(|poses| poses.recording(trial.agent.limbs));
        let recording = recording.transpose().map_err(|error| error.inside("poses"))?;
        let evaluation = self.recorded.evaluation().map_err(|error| error.inside("recorded"))?;
        Ok((Champion { genome, trial, evaluation, origin: self.origin.into() }, recording))
    }
}

impl RecordedV4 {
    /// Translates and checks every value.
    pub fn evaluation(self) -> Result<Evaluation, Invalid> {
        let trace_hash = hash_of("trace_hash", &self.trace_hash)?;
        within("fitness", self.fitness, FITNESS_RANGE)?;
        within("centre_y_m", self.centre_y_m, -1.0e6..=1.0e6)?;
        if let Some(effort) = &self.effort {
            effort.check().map_err(|error| error.inside("effort"))?;
        }
        if let Some(behaviour) = &self.behaviour {
            behaviour.check().map_err(|error| error.inside("behaviour"))?;
        }
        Ok(Evaluation {
            fitness: self.fitness,
            centre_y_m: self.centre_y_m,
            disqualified: None,
            trace_hash,
            steps: self.steps,
            effort: self.effort.map(Into::into),
            behaviour: self.behaviour.map(Into::into),
        })
    }
}

impl From<Evaluation> for RecordedV4 {
    fn from(evaluation: Evaluation) -> Self {
        Self {
            fitness: evaluation.fitness,
            centre_y_m: evaluation.centre_y_m,
            steps: evaluation.steps,
            trace_hash: format!("{:016x}", evaluation.trace_hash),
            effort: evaluation.effort.map(Into::into),
            behaviour: evaluation.behaviour.map(Into::into),
        }
    }
}
