//! Format 3 of a saved champion, exactly as it stands in files: format 2, what the champion looked like, and
//! what its run demanded of it.

use serde::{Deserialize, Serialize};

use super::files::hash_of;
use super::mirror::mirrors;
use super::poses::PosesV3;
use super::v2::{ChampionV2, GenomeV2, OriginV2, RecordedV2, TrialV2};
use crate::ENGINE_VERSION;
use crate::check::{Invalid, name, within};
use crate::evolve::Champion;
use crate::genome::Genome;
use crate::score::{Evaluation, Recording, Trial};
use crate::world::Effort;

/// What every file of this kind says first.
pub const KIND: &str = "snakes-and-stairs champion";
/// The number of this format.
pub const FORMAT: u32 = 3;

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChampionV3 {
    pub kind: String,
    pub format: u32,
    pub engine: u32,
    pub origin: OriginV2,
    pub recorded: RecordedV3,
    pub trial: TrialV2,
    pub genome: GenomeV2,
    pub poses: Option<PosesV3>,
}

/// What the champion reached when it was found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecordedV3 {
    pub fitness: f32,
    pub centre_y_m: f32,
    pub steps: u32,
    pub trace_hash: String,
    /// None in what formats 1 and 2 recorded.
    pub effort: Option<EffortV3>,
}

mirrors! {
    EffortV3 = Effort {
        energy_j: f32,
        top_speed_m_s: f32,
        joint_drift_m: f32,
        sideways_m: f32,
    }
}

impl EffortV3 {
    /// Checks every value.
    pub fn check(&self) -> Result<(), Invalid> {
        for (field, value) in [
            ("energy_j", self.energy_j),
            ("top_speed_m_s", self.top_speed_m_s),
            ("joint_drift_m", self.joint_drift_m),
            ("sideways_m", self.sideways_m),
        ] {
            within(field, value, 0.0..=1.0e12)?;
        }
        Ok(())
    }
}

impl From<RecordedV2> for RecordedV3 {
    fn from(file: RecordedV2) -> Self {
        let RecordedV2 { fitness, centre_y_m, steps, trace_hash } = file;
        Self { fitness, centre_y_m, steps, trace_hash, effort: None }
    }
}

impl From<ChampionV2> for ChampionV3 {
    fn from(file: ChampionV2) -> Self {
        let ChampionV2 { kind, format: _, engine, origin, recorded, trial, genome } = file;
        let recorded = recorded.into();
        Self { kind, format: FORMAT, engine, origin, recorded, trial, genome, poses: None }
    }
}

impl ChampionV3 {
    /// The file of a champion that this engine found.
    pub fn new(champion: Champion, recording: Option<&Recording>) -> Self {
        let Champion { genome, trial, evaluation, origin } = champion;
        Self {
            kind: KIND.to_owned(),
            format: FORMAT,
            engine: ENGINE_VERSION,
            origin: origin.into(),
            recorded: RecordedV3 {
                fitness: evaluation.fitness,
                centre_y_m: evaluation.centre_y_m,
                steps: evaluation.steps,
                trace_hash: format!("{:016x}", evaluation.trace_hash),
                effort: evaluation.effort.map(Into::into),
            },
            trial: trial.into(),
            genome: genome.into(),
            poses: recording.map(Into::into),
        }
    }

    /// Translates and checks every value.
    pub fn into_parts(self) -> Result<(Champion, Option<Recording>), Invalid> {
        let recorded = self.recorded;
        let trace_hash = hash_of("recorded.trace_hash", &recorded.trace_hash)?;
        name("origin.preset", &self.origin.preset)?;
        within("recorded.fitness", recorded.fitness, -1.0e6..=1.0e6)?;
        within("recorded.centre_y_m", recorded.centre_y_m, -1.0e6..=1.0e6)?;
        if let Some(effort) = &recorded.effort {
            effort.check().map_err(|error| error.inside("recorded.effort"))?;
        }
        let trial = Trial::from(self.trial);
        trial.check().map_err(|error| error.inside("trial"))?;
        let genome = Genome::from(self.genome);
        trial.check_genome(&genome).map_err(|error| error.inside("genome"))?;
        let recording = self.poses.map(|poses| poses.recording(trial.agent.limbs));
        let recording = recording.transpose().map_err(|error| error.inside("poses"))?;
        let evaluation = Evaluation {
            fitness: recorded.fitness,
            centre_y_m: recorded.centre_y_m,
            disqualified: None,
            trace_hash,
            steps: recorded.steps,
            effort: recorded.effort.map(Into::into),
        };
        Ok((Champion { genome, trial, evaluation, origin: self.origin.into() }, recording))
    }
}
