//! A replay, step by step: a live simulation, or a recording made by another engine version.

use std::sync::Arc;

use super::staged_champion::StagedChampion;
use snakes_core::score::{Evaluation, KeyframeHistory, Recording, Rollout};
use snakes_core::world::{Pose, Pull, Simulation, Stairs, Vector};

/// A replay in progress: simulated or recorded.
#[derive(Clone)]
pub(crate) enum Replay {
    /// A live rollout, which computes a score.
    Simulated(Box<Rollout>),
    /// A recording that another engine version made.
    Recorded(PendingRecording),
}

/// A recording in progress.
#[derive(Clone)]
pub(crate) struct PendingRecording {
    recording: Arc<Recording>,
    step: u32,
    last_step: u32,
    poses: Vec<Pose>,
    middle_part: usize,
}

impl Replay {
    /// Starts a replay of a champion.
    pub fn of(staged: &StagedChampion) -> Self {
        match staged.recording() {
            Some(recording) => Self::Recorded(PendingRecording {
                poses: recording.at(0.0),
                recording: Arc::clone(recording),
                step: 0,
                last_step: staged.trial().steps(),
                middle_part: staged.body().middle_part,
            }),
            None => Self::Simulated(Box::new(staged.rollout())),
        }
    }

    /// Takes one step unless the replay is over. Returns whether it took one.
    pub fn advance(&mut self) -> bool {
        match self {
            Self::Simulated(rollout) => rollout.advance(),
            Self::Recorded(recorded) => {
                let goes_on = recorded.step < recorded.last_step;
                if goes_on {
                    recorded.step += 1;
                    recorded.poses = recorded.recording.at(recorded.step as f32);
                }
                goes_on
            }
        }
    }

    /// Goes to the state after `step` steps, at most to the end. Starts from the nearest keyframe of the history, or
    /// from the start without a history. The effect of any pull is lost.
    pub fn go_to(&mut self, step: u32, staged: &StagedChampion, history: Option<&KeyframeHistory>) {
        match self {
            Self::Simulated(rollout) => **rollout = undisturbed_at(step, staged, history),
            Self::Recorded(recorded) => {
                recorded.step = step.min(recorded.last_step);
                recorded.poses = recorded.recording.at(recorded.step as f32);
            }
        }
    }

    /// Returns the rollout after `step` steps without any pull, simulated by this engine.
    pub fn rollout_at(
        &self,
        step: u32,
        staged: &StagedChampion,
        history: Option<&KeyframeHistory>,
    ) -> Rollout {
        if let Self::Simulated(rollout) = self
            && rollout.step() == step
            && !rollout.is_disturbed()
        {
            return (**rollout).clone();
        }
        undisturbed_at(step, staged, history)
    }

    /// Sets or clears the pull on a limb. A recording ignores pulls.
    pub fn pull(&mut self, pull: Option<Pull>) {
        if let Self::Simulated(rollout) = self {
            rollout.pull(pull);
        }
    }

    /// Returns whether the mouse has pulled the snake.
    pub fn is_disturbed(&self) -> bool {
        matches!(self, Self::Simulated(rollout) if rollout.is_disturbed())
    }

    /// Returns the last step of the replay if the snake is not disqualified earlier.
    pub fn last_step(&self) -> u32 {
        match self {
            Self::Simulated(rollout) => rollout.last_step(),
            Self::Recorded(recorded) => recorded.last_step,
        }
    }

    /// Returns whether the replay has ended.
    pub fn is_over(&self) -> bool {
        match self {
            Self::Simulated(rollout) => rollout.is_over(),
            Self::Recorded(recorded) => recorded.step >= recorded.last_step,
        }
    }

    /// Returns the number of steps taken so far.
    pub fn step(&self) -> u32 {
        match self {
            Self::Simulated(rollout) => rollout.step(),
            Self::Recorded(recorded) => recorded.step,
        }
    }

    /// Returns the poses of the limbs after the last step, from head to tail.
    pub fn poses(&self) -> &[Pose] {
        match self {
            Self::Simulated(rollout) => rollout.poses(),
            Self::Recorded(recorded) => &recorded.poses,
        }
    }

    /// Returns the evaluation so far. For a recording, this is the recorded result with the current position.
    pub fn evaluation(&self, staged: &StagedChampion) -> Evaluation {
        match self {
            Self::Simulated(rollout) => rollout.evaluation(),
            Self::Recorded(recorded) => Evaluation {
                centre_y_m: recorded.poses[recorded.middle_part].translation.y,
                ..staged.champion().evaluation
            },
        }
    }

    /// Returns the path of the middle limb in a recording so far, frame by frame, in metres; `None` for a simulation.
    pub fn recorded_way_m(&self) -> Option<Vec<Vector>> {
        let Self::Recorded(recorded) = self else { return None };
        let shown = recorded.step / recorded.recording.every_steps() + 1;
        let frames = recorded.recording.frames().take(shown as usize);
        Some(frames.map(|parts| parts[recorded.middle_part].translation).collect())
    }

    /// Returns the step at which the middle limb of a recording first stood on the landing, if it did.
    pub fn recorded_landing(&self, stairs: &Stairs) -> Option<u32> {
        let Self::Recorded(recorded) = self else { return None };
        let landed = |parts: &[Pose]| {
            let at_m = parts[recorded.middle_part].translation.to_array();
            stairs.steps > 0 && stairs.steps_under(at_m) == stairs.steps
        };
        let frame = recorded.recording.frames().position(landed)?;
        Some(frame as u32 * recorded.recording.every_steps())
    }

    /// Returns the rollout, or `None` for a recording.
    pub fn rollout(&self) -> Option<&Rollout> {
        match self {
            Self::Simulated(rollout) => Some(rollout),
            Self::Recorded(_) => None,
        }
    }

    /// Returns the simulated world, or `None` for a recording.
    pub fn simulation(&self) -> Option<&Simulation> {
        self.rollout().map(Rollout::simulation)
    }
}

/// Simulates a champion without any pull to the state after `step` steps, at most to the end.
fn undisturbed_at(
    step: u32,
    staged: &StagedChampion,
    history: Option<&KeyframeHistory>,
) -> Rollout {
    let mut rollout = history.map_or_else(|| staged.rollout(), |of| of.rollout_at(step));
    while rollout.step() < step && rollout.advance() {}
    rollout
}
