//! The evaluation of an individual: the result of its rollout.

use serde::{Deserialize, Serialize};

use super::behaviour::Behaviour;
use super::ending::Ending;
use super::fitness::FITNESS_RANGE;
use crate::check::{Invalid, hex_hash, within};
use crate::world::{Disqualification, Effort, Stairs};

/// The result of a rollout.
///
/// In files, a disqualification is stored beside the evaluation; the ending names its reason, too.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Evaluation {
    /// Fitness by the trial's measure: see [`Fitness`](super::Fitness) for the unit. For a disqualified agent, it is the fitness after the
    /// last healthy step.
    pub fitness: f32,
    /// y of the middle limb's centre at the end, in metres, whatever the measure of fitness.
    pub centre_y_m: f32,
    /// Reason of the disqualification; `None` for a healthy agent.
    #[serde(skip)]
    pub disqualified: Option<Disqualification>,
    /// Number of healthy physics steps taken.
    pub steps: u32,
    /// Hash (XXH3, 64 bits) over the bits of every part's pose after every healthy step, including the last. Files store it as 16
    /// hexadecimal digits.
    #[serde(with = "hex_hash")]
    pub trace_hash: u64,
    /// Energy, speeds and distances over the healthy steps. `None` in records without these measurements.
    pub effort: Option<Effort>,
    /// Measures of the motion. `None` in records without these measurements.
    pub behaviour: Option<Behaviour>,
    /// How the trial ended. `None` in records of earlier versions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ending: Option<Ending>,
}

impl Evaluation {
    /// Returns a healthy evaluation with this fitness, for tests.
    pub fn of_fitness(fitness: f32) -> Self {
        Self {
            fitness,
            centre_y_m: fitness,
            disqualified: None,
            trace_hash: 0,
            steps: 1,
            effort: None,
            behaviour: None,
            ending: None,
        }
    }

    /// Returns the evaluation of an individual whose simulation panicked.
    pub fn void() -> Self {
        Self {
            fitness: 0.0,
            centre_y_m: 0.0,
            disqualified: Some(Disqualification::Crashed),
            trace_hash: 0,
            steps: 0,
            effort: None,
            behaviour: None,
            ending: Some(Ending::CRASHED),
        }
    }

    /// Checks every value that was read from a file.
    ///
    /// # Errors
    /// Returns the first value that is not allowed.
    pub fn check(&self) -> Result<(), Invalid> {
        within("fitness", self.fitness, FITNESS_RANGE)?;
        within("centre_y_m", self.centre_y_m, -1.0e6..=1.0e6)?;
        let effort = self.effort.map_or(Ok(()), Effort::check);
        effort.map_err(|error| error.inside("effort"))?;
        let behaviour = self.behaviour.map_or(Ok(()), Behaviour::check);
        behaviour.map_err(|error| error.inside("behaviour"))?;
        let ending = self.ending.map_or(Ok(()), |ending| ending.check());
        ending.map_err(|error| error.inside("ending"))
    }

    /// Returns whether both evaluations have the same bits. A value that one of them lacks is not compared.
    pub fn agrees_with(&self, other: &Self) -> bool {
        fn agree<T: PartialEq>(a: Option<T>, b: Option<T>) -> bool {
            a.is_none() || b.is_none() || a == b
        }
        let bare =
            |evaluation: &Self| Self { effort: None, behaviour: None, ending: None, ..*evaluation };
        bare(self) == bare(other)
            && agree(self.effort, other.effort)
            && agree(self.behaviour, other.behaviour)
            && agree(self.ending, other.ending)
    }

    /// Returns whether the agent was not disqualified and ended with all steps of the stairs under its middle limb.
    pub fn is_on_landing(&self, stairs: &Stairs) -> bool {
        let climbed = self.behaviour.map_or(0, |behaviour| behaviour.steps_climbed);
        self.disqualified.is_none() && stairs.steps > 0 && climbed == stairs.steps
    }
}
