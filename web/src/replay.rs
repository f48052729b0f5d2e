//! The simulation of a champion in the page.

use serde_json::{Value, json};
use snakes_core::evolve::Champion;
use snakes_core::genome::Genome;
use snakes_core::score::{Rollout, Trial};

/// A champion whose trial is being simulated.
pub struct Replay {
    rollout: Rollout,
    genome: Genome,
    trial: Trial,
    /// Whether the trial is the champion's own, without another friction.
    is_own: bool,
    recorded_hash: u64,
}

/// Returns the champion's trial with this friction of stairs and ground, or unchanged for `None`.
pub fn trial_with(champion: &Champion, friction: Option<f32>) -> Result<Trial, String> {
    let mut trial = champion.trial.clone();
    if let Some(friction) = friction {
        trial.surface.friction = friction;
        if let Some(ground) = &mut trial.ground {
            ground.friction = friction;
        }
    }
    trial.check().map_err(|error| error.to_string())?;
    Ok(trial)
}

impl Replay {
    /// Begins to simulate a champion, at the start of its trial.
    pub fn begin(champion: Champion, friction: Option<f32>) -> Result<Self, String> {
        let trial = trial_with(&champion, friction)?;
        Ok(Self {
            rollout: Rollout::new(&champion.genome, &trial),
            is_own: trial == champion.trial,
            trial,
            recorded_hash: champion.evaluation.trace_hash,
            genome: champion.genome,
        })
    }

    /// Returns the state at the start, with the poses.
    pub fn start(&self) -> Value {
        let mut state = self.state();
        state["poses"] = self.poses().collect();
        state
    }

    /// Returns position and rotation of each part, head first: seven numbers each.
    fn poses(&self) -> impl Iterator<Item = f32> + '_ {
        self.rollout.poses().iter().flat_map(|pose| {
            let (at, turn) = (pose.translation, pose.rotation);
            [at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w]
        })
    }

    /// Takes at most this number of steps, until the trial is over. Returns the state, with the poses after each step if requested.
    pub fn advance(&mut self, steps: u32, with_poses: bool) -> Value {
        let mut poses = Vec::new();
        for _ in 0..steps {
            if !self.rollout.advance() {
                break;
            }
            if with_poses {
                poses.extend(self.poses());
            }
        }
        let mut state = self.state();
        if with_poses {
            state["poses"] = poses.into();
        }
        state
    }

    /// Returns time and result so far.
    pub fn state(&self) -> Value {
        let evaluation = self.rollout.evaluation();
        let behaviour = evaluation.behaviour;
        let hash = format!("{:016x}", evaluation.trace_hash);
        json!({
            "step": self.rollout.step(),
            "last_step": self.rollout.last_step(),
            "is_over": self.rollout.is_over(),
            "fitness": evaluation.fitness,
            "meaning": self.trial.result_in_words(&self.genome, &evaluation),
            "disqualified": evaluation.disqualified.map(|reason| reason.words()),
            "steps_climbed": behaviour.map_or(0, |of| of.steps_climbed),
            "energy_j": evaluation.effort.map_or(0.0, |of| of.energy_j),
            "is_equal": self.is_own
                && self.rollout.is_over()
                && evaluation.trace_hash == self.recorded_hash,
            "hash": hash,
        })
    }
}
