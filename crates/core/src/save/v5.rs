//! Format 5 of a saved champion, exactly as it stands in files.
//!
//! Nothing has been released yet, so this is the only format that is read. **From the first release on, every
//! released format stays readable**: a struct that stands in a released file never changes. A change gets a new
//! struct and a new format number in a module beside this one, and the old struct is translated into the new one
//! when a file is read. The same rule holds for what files contain as it is: [`Genome`], [`Trial`] and
//! [`crate::evolve::Settings`]. To these, settings may be added without a new format if their defaults act as the
//! program did without them: see [`crate::schema::is_default`].

use serde::{Deserialize, Serialize};

use super::engine_2;
use super::file_structs::file_structs;
use super::files::hash_of;
use super::poses::PosesV5;
use crate::check::{Invalid, name, quoted, within};
use crate::control::WaveUses;
use crate::engine::{ENGINE_VERSION, Processors};
use crate::evolve::{Champion, Origin};
use crate::genome::Genome;
use crate::schema::is_default;
use crate::score::{
    Behaviour, Evaluation, ExamSuite, FITNESS_RANGE, Recording, SuiteResult, Trial,
};
use crate::world::Effort;

/// The kind that every champion's file states.
pub const KIND: &str = "snakes-and-stairs champion";
/// The number of this format.
pub const FORMAT: u32 = 5;

/// A champion with its recorded poses, if it has them, and the results of its exam.
pub type ChampionParts = (Champion, Option<Recording>, Vec<SuiteResult>);

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChampionV5 {
    pub kind: String,
    pub format: u32,
    pub engine: u32,
    #[serde(default, skip_serializing_if = "is_default")]
    pub processors: Processors,
    pub origin: OriginV5,
    pub recorded: RecordedV5,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chosen_by: Option<f32>,
    pub trial: Trial,
    pub genome: Genome,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub exam: Vec<ExamV5>,
    pub poses: Option<PosesV5>,
}

/// The champion's evaluation when it was found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(missing_docs, reason = "the fields are those of Evaluation, which explains them")]
pub struct RecordedV5 {
    pub fitness: f32,
    pub centre_y_m: f32,
    pub steps: u32,
    pub trace_hash: String,
    /// None, if it was not measured.
    pub effort: Option<EffortV5>,
    /// None, if it was not measured.
    pub behaviour: Option<BehaviourV5>,
}

file_structs! {
    OriginV5 = Origin { preset: String, seed: u64, generation: u32, individual: u32 }
    ExamV5 = SuiteResult {
        suite: ExamSuite,
        trials: u32,
        landed: u32,
        disqualified: u32,
        median_steps: f32,
        kept: f32,
        each: Vec<(String, f32)>,
    }
    EffortV5 = Effort {
        energy_j: f32,
        top_speed_m_s: f32,
        joint_drift_m: f32,
        sideways_m: f32,
    }
    BehaviourV5 = Behaviour {
        steps_climbed: u32,
        mean_height_m: f32,
        mean_sideways_m: f32,
        contact_duty: f32,
        frequency_hz: f32,
        // Engine 2 did not measure these.
        #[serde(default)]
        cost_of_transport: Option<f32>,
        #[serde(default)]
        climbing_efficiency: Option<f32>,
        // Only controllers with a library of waves have these.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        wave_uses: Option<WaveUses>,
    }
}

/// Maximum number of results of an exam, and of conditions in each.
const MOST_RESULTS: usize = 100;

impl ExamV5 {
    /// Checks every value.
    fn check(&self) -> Result<(), Invalid> {
        within("trials", self.trials, 1..=1_000_000)?;
        within("landed", self.landed, 0..=self.trials)?;
        within("disqualified", self.disqualified, 0..=self.trials)?;
        within("median_steps", self.median_steps, 0.0..=1000.0)?;
        within("kept", self.kept, 0.0..=1.0e6)?;
        within("number of conditions", self.each.len(), 0..=MOST_RESULTS)?;
        for (label, kept) in &self.each {
            if label.is_empty() || label.chars().count() > 40 || label.contains(char::is_control) {
                let allowed = "1 to 40 characters without control characters";
                return Err(Invalid::new("condition", quoted(label), allowed));
            }
            within("kept", *kept, 0.0..=1.0e6)?;
        }
        Ok(())
    }
}

impl EffortV5 {
    /// Checks every value.
    fn check(&self) -> Result<(), Invalid> {
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

impl BehaviourV5 {
    /// Checks every value.
    fn check(&self) -> Result<(), Invalid> {
        within("steps_climbed", self.steps_climbed, 0..=1000)?;
        for (field, value) in [
            ("mean_height_m", self.mean_height_m),
            ("mean_sideways_m", self.mean_sideways_m),
            ("contact_duty", self.contact_duty),
            ("frequency_hz", self.frequency_hz),
            ("cost_of_transport", self.cost_of_transport.unwrap_or(0.0)),
            ("climbing_efficiency", self.climbing_efficiency.unwrap_or(0.0)),
        ] {
            within(field, value, -1.0e6..=1.0e6)?;
        }
        Ok(())
    }
}

impl ChampionV5 {
    /// The file of a champion that this engine found.
    pub fn new(champion: Champion, recording: Option<&Recording>, exam: &[SuiteResult]) -> Self {
        let Champion { genome, trial, evaluation, chosen_by, origin } = champion;
        Self {
            kind: KIND.to_owned(),
            format: FORMAT,
            engine: ENGINE_VERSION,
            processors: Processors::THIS,
            origin: origin.into(),
            recorded: evaluation.into(),
            chosen_by,
            trial,
            genome,
            exam: exam.iter().cloned().map(Into::into).collect(),
            poses: recording.map(Into::into),
        }
    }

    /// Translates and checks every value.
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
        let evaluation = self.recorded.evaluation().map_err(|error| error.inside("recorded"))?;
        if let Some(fitness) = self.chosen_by {
            within("chosen_by", fitness, FITNESS_RANGE)?;
        }
        let (chosen_by, origin) = (self.chosen_by, self.origin.into());
        within("number of exam results", self.exam.len(), 0..=MOST_RESULTS)?;
        self.exam.iter().try_for_each(|result| result.check().map_err(|e| e.inside("exam")))?;
        let exam = self.exam.into_iter().map(Into::into).collect();
        Ok((Champion { genome, trial, evaluation, chosen_by, origin }, recording, exam))
    }
}

impl RecordedV5 {
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

impl From<Evaluation> for RecordedV5 {
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
