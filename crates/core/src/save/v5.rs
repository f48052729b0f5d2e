//! Format 5 of a saved champion, exactly as files have it.
//!
//! Nothing has been released yet, so this is the only format that is read. **From the first release on, every released format stays
//! readable**: a struct of a released file never changes. A change gets a new struct and a new format number in a module beside this one,
//! and the old struct is converted to the new one when a file is read. The rule also holds for types of the core that files contain
//! directly: [`Genome`], [`Trial`], [`Origin`], [`Evaluation`], [`SuiteResult`] and [`crate::evolve::Settings`]. Fields may be added to
//! these types without a new format if the default of a field acts as the program did without it: see [`crate::schema::is_default`].

use serde::{Deserialize, Serialize};

use super::engine_2;
use super::poses::PosesV5;
use crate::check::{Invalid, name, within};
use crate::engine::{ENGINE_VERSION, Processors};
use crate::evolve::{Champion, Origin};
use crate::genome::Genome;
use crate::schema::is_default;
use crate::score::{Evaluation, FITNESS_RANGE, Recording, SuiteResult, Trial};
use crate::world::Disqualification;

/// Maximum number of results of an exam.
const MOST_RESULTS: usize = 100;
/// Kind that every champion's file states.
pub const KIND: &str = "snakes-and-stairs champion";
/// Number of this format.
pub const FORMAT: u32 = 5;

/// A champion with its recorded poses, if it has them, and the results of its exam.
pub type ChampionParts = (Champion, Option<Recording>, Vec<SuiteResult>);

/// Contents of the file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChampionV5 {
    pub kind: String,
    pub format: u32,
    pub engine: u32,
    #[serde(default, skip_serializing_if = "is_default")]
    pub processors: Processors,
    pub origin: Origin,
    pub recorded: Evaluation,
    /// Reason of a disqualification: of a snake that a user saved all the same, such as a policy's episode.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub disqualified: Option<Disqualification>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chosen_by: Option<f32>,
    pub trial: Trial,
    pub genome: Genome,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub exam: Vec<SuiteResult>,
    pub poses: Option<PosesV5>,
}

impl ChampionV5 {
    /// Makes the file of a champion that this engine found.
    pub fn new(champion: Champion, recording: Option<&Recording>, exam: &[SuiteResult]) -> Self {
        let Champion { genome, trial, evaluation, chosen_by, origin } = champion;
        Self {
            kind: KIND.to_owned(),
            format: FORMAT,
            engine: ENGINE_VERSION,
            processors: Processors::THIS,
            origin,
            disqualified: evaluation.disqualified,
            recorded: evaluation,
            chosen_by,
            trial,
            genome,
            exam: exam.to_vec(),
            poses: recording.map(Into::into),
        }
    }

    /// Converts and checks every value.
    pub fn into_parts(self) -> Result<ChampionParts, Invalid> {
        name("origin.preset", &self.origin.preset)?;
        let trial = match self.engine {
            ..=2 => engine_2::converted(self.trial),
            _ => self.trial,
        };
        trial.check().map_err(|error| error.inside("trial"))?;
        let genome = self.genome;
        trial.check_genome(&genome).map_err(|error| error.inside("genome"))?;
        let limbs = trial.agent.body_plan(&genome).parts.len() as u32;
        let recording = self.poses.map(|poses| poses.recording(limbs));
        let recording = recording.transpose().map_err(|error| error.inside("poses"))?;
        let evaluation = Evaluation { disqualified: self.disqualified, ..self.recorded };
        evaluation.check().map_err(|error| error.inside("recorded"))?;
        if let Some(fitness) = self.chosen_by {
            within("chosen_by", fitness, FITNESS_RANGE)?;
        }
        let (chosen_by, origin, exam) = (self.chosen_by, self.origin, self.exam);
        within("number of exam results", exam.len(), 0..=MOST_RESULTS)?;
        exam.iter().try_for_each(SuiteResult::check).map_err(|error| error.inside("exam"))?;
        Ok((Champion { genome, trial, evaluation, chosen_by, origin }, recording, exam))
    }
}
