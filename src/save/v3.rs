//! Format 3 of a saved champion, exactly as it stands in files: format 2, and what the champion looked like.

use serde::{Deserialize, Serialize};

use super::files::hash_of;
use super::poses::PosesV3;
use super::v2::{ChampionV2, GenomeV2, OriginV2, RecordedV2, TrialV2};
use crate::ENGINE_VERSION;
use crate::check::{Invalid, name, within};
use crate::evolve::Champion;
use crate::genome::Genome;
use crate::score::{Evaluation, Recording, Trial};

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
    pub recorded: RecordedV2,
    pub trial: TrialV2,
    pub genome: GenomeV2,
    pub poses: Option<PosesV3>,
}

impl From<ChampionV2> for ChampionV3 {
    fn from(file: ChampionV2) -> Self {
        let ChampionV2 { kind, format: _, engine, origin, recorded, trial, genome } = file;
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
            recorded: RecordedV2 {
                fitness: evaluation.fitness,
                centre_y_m: evaluation.centre_y_m,
                steps: evaluation.steps,
                trace_hash: format!("{:016x}", evaluation.trace_hash),
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
        };
        Ok((Champion { genome, trial, evaluation, origin: self.origin.into() }, recording))
    }
}
