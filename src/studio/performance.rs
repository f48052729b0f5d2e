//! What happens on the stage, step by step: a simulation, or a recording where other bits are computed.

use bevy_rapier3d::plugin::context::{
    RapierContextColliders, RapierContextJoints, RapierContextSimulation, RapierRigidBodySet,
};
use std::mem::swap;
use std::sync::Arc;

use super::exhibit::Exhibit;
use crate::score::{Evaluation, History, Recording, Rollout};
use crate::world::{Pose, Pull, Simulation, Stairs, Vector};

/// The parts of a physics context, as one bundle spawns them and one query finds them.
pub(super) type Context<'a> = (
    &'a mut RapierContextSimulation,
    &'a mut RapierContextColliders,
    &'a mut RapierContextJoints,
    &'a mut RapierRigidBodySet,
);

/// A performance on its way.
pub(super) enum Performance {
    /// The rollout that scores.
    Simulated(Box<Rollout>),
    /// What it looked like where it was recorded.
    Recorded(Recorded),
}

/// A recording on its way.
pub(super) struct Recorded {
    recording: Arc<Recording>,
    step: u32,
    last_step: u32,
    poses: Vec<Pose>,
    middle_limb: usize,
}

impl Performance {
    /// The start of an exhibit's performance.
    pub fn of(exhibit: &Exhibit) -> Self {
        match exhibit.recording() {
            Some(recording) => Self::Recorded(Recorded {
                poses: recording.at(0.0),
                recording: Arc::clone(recording),
                step: 0,
                last_step: exhibit.trial().steps(),
                middle_limb: exhibit
                    .trial()
                    .world_plan(&exhibit.champion().genome)
                    .body
                    .middle_limb(),
            }),
            None => {
                let rollout = Rollout::new(&exhibit.champion().genome, exhibit.trial());
                Self::Simulated(Box::new(rollout))
            }
        }
    }

    /// Takes one step, unless it is over. Returns whether it took one.
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

    /// Goes to where it is after `step` steps, or to its end: from the nearest keyframe of its history or, without
    /// one, from its start. What a hand did is gone. The world must not have been lent out.
    pub fn go_to(&mut self, step: u32, exhibit: &Exhibit, history: Option<&History>) {
        match self {
            Self::Simulated(rollout) => {
                **rollout = match history {
                    Some(history) => history.rollout_at(step),
                    None => Rollout::new(&exhibit.champion().genome, exhibit.trial()),
                };
                while rollout.step() < step && rollout.advance() {}
            }
            Self::Recorded(recorded) => {
                recorded.step = step.min(recorded.last_step);
                recorded.poses = recorded.recording.at(recorded.step as f32);
            }
        }
    }

    /// Lets a hand pull a limb, or no more; a recording cannot be pulled.
    pub fn pull(&mut self, pull: Option<Pull>) {
        if let Self::Simulated(rollout) = self {
            rollout.pull(pull);
        }
    }

    /// Whether a hand has interfered.
    pub fn is_disturbed(&self) -> bool {
        matches!(self, Self::Simulated(rollout) if rollout.is_disturbed())
    }

    /// How many steps it lasts, unless the agent is disqualified before.
    pub fn last_step(&self) -> u32 {
        match self {
            Self::Simulated(rollout) => rollout.last_step(),
            Self::Recorded(recorded) => recorded.last_step,
        }
    }

    /// Whether it is over.
    pub fn is_over(&self) -> bool {
        match self {
            Self::Simulated(rollout) => rollout.is_over(),
            Self::Recorded(recorded) => recorded.step >= recorded.last_step,
        }
    }

    /// Steps taken so far.
    pub fn step(&self) -> u32 {
        match self {
            Self::Simulated(rollout) => rollout.step(),
            Self::Recorded(recorded) => recorded.step,
        }
    }

    /// The poses of the limbs after the last step, head first.
    pub fn poses(&self) -> &[Pose] {
        match self {
            Self::Simulated(rollout) => rollout.poses(),
            Self::Recorded(recorded) => &recorded.poses,
        }
    }

    /// What there is to say so far. A recording knows only the result, and where the snake is.
    pub fn evaluation(&self, exhibit: &Exhibit) -> Evaluation {
        match self {
            Self::Simulated(rollout) => rollout.evaluation(),
            Self::Recorded(recorded) => Evaluation {
                centre_y_m: recorded.poses[recorded.middle_limb].translation.y,
                ..exhibit.champion().evaluation
            },
        }
    }

    /// Where the middle limb has been, if it is a recording, frame by frame, in metres.
    pub fn recorded_way_m(&self) -> Option<Vec<Vector>> {
        let Self::Recorded(recorded) = self else { return None };
        let shown = recorded.step / recorded.recording.every_steps() + 1;
        let frames = recorded.recording.frames().take(shown as usize);
        Some(frames.map(|limbs| limbs[recorded.middle_limb].translation).collect())
    }

    /// After which step the middle limb first stood on the landing, if it is a recording and it did.
    pub fn recorded_landing(&self, stairs: &Stairs) -> Option<u32> {
        let Self::Recorded(recorded) = self else { return None };
        let landed = |limbs: &[Pose]| {
            let at_m = limbs[recorded.middle_limb].translation.to_array();
            stairs.steps > 0 && stairs.steps_under(at_m) == stairs.steps
        };
        let frame = recorded.recording.frames().position(landed)?;
        Some(frame as u32 * recorded.recording.every_steps())
    }

    /// The simulated world, if it is one.
    pub fn simulation(&self) -> Option<&Simulation> {
        match self {
            Self::Simulated(rollout) => Some(rollout.simulation()),
            Self::Recorded(_) => None,
        }
    }

    /// Swaps the simulated world, if it is one, with the one in a context: lends it out, or gets it back.
    pub fn exchange(&mut self, (simulation, colliders, joints, bodies): Context<'_>) {
        let Self::Simulated(rollout) = self else { return };
        let physics = rollout.simulation_mut().physics_mut();
        swap(&mut physics.integration_parameters, &mut simulation.integration_parameters);
        swap(&mut physics.physics_pipeline, &mut simulation.pipeline);
        swap(&mut physics.islands, &mut simulation.islands);
        swap(&mut physics.broad_phase, &mut simulation.broad_phase);
        swap(&mut physics.narrow_phase, &mut simulation.narrow_phase);
        swap(&mut physics.ccd_solver, &mut simulation.ccd_solver);
        swap(&mut physics.colliders, &mut colliders.colliders);
        swap(&mut physics.impulse_joints, &mut joints.impulse_joints);
        swap(&mut physics.multibody_joints, &mut joints.multibody_joints);
        swap(&mut physics.bodies, &mut bodies.bodies);
    }
}
