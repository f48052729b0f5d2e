//! One world of an environment: a rollout whose torques come from outside, and the snake's senses.

use pyo3::prelude::*;
use snakes_core::control::{ExternalControl, Perception, SenseInfo, SenseKind};
use snakes_core::genome::{ControllerKind, Genome, GenomeSpace};
use snakes_core::rng::{Purpose, stream};
use snakes_core::score::{Evaluation, Perturbation, PerturbationRange, Rollout, Trial};
use snakes_core::world::{BodyPlan, Disqualification, JointTorque};
use snakes_lab::run::caught;

use crate::errors::{crashed, invalid};

/// Meaning of an action's number for each joint axis.
#[derive(Clone, Copy, PartialEq)]
pub enum ActionKind {
    /// The number is the target angle of a servo, in rad.
    Targets,
    /// The number is a torque, in N·m.
    Torques,
}

/// Rules that all worlds of an environment share.
pub struct WorldRules {
    pub trial: Trial,
    /// Genome that gives the snake its body. Its controller is not used.
    pub genome: Genome,
    pub actions: ActionKind,
    pub steps_per_action: u32,
    pub stiffness_nm_per_rad: f32,
    pub damping_nms_per_rad: f32,
    pub perturbation: Option<PerturbationRange>,
    /// Penalty on the reward of the step in which the snake is disqualified.
    pub disqualification_penalty: f64,
}

/// Returns the body in the middle of a space's ranges, with a controller that does nothing.
pub fn middle_body(space: &GenomeSpace, trial: &Trial) -> Genome {
    let space =
        GenomeSpace { controller: ControllerKind::Signal, points_per_s: 1.0, ..space.clone() };
    let shape = trial.genome_shape();
    // A torque in the middle of its range is 0.
    space.genome_at(&vec![0.5; space.dimension(shape)], shape)
}

impl WorldRules {
    pub fn body(&self) -> BodyPlan {
        self.trial.agent.body_plan(&self.genome)
    }

    /// Returns the greatest action of each joint axis in either direction: bend and twist, joint by joint.
    pub fn action_limits(&self) -> Vec<f32> {
        let limits = self.body().joints.into_iter().flat_map(|joint| match self.actions {
            ActionKind::Targets => [joint.bend_limit_rad, joint.twist_limit_rad],
            ActionKind::Torques => [joint.max_bend_torque_nm, joint.max_twist_torque_nm],
        });
        limits.collect()
    }

    /// Returns names and descriptions of the senses, in the order of an observation.
    pub fn senses(&self) -> Vec<(String, SenseInfo)> {
        let joints = self.trial.agent.joints();
        let kinds = std::iter::repeat_n(&SenseKind::ALL[..4], joints)
            .chain(std::iter::repeat_n(&SenseKind::ALL[4..12], joints + 1))
            .chain([&SenseKind::ALL[12..]])
            .flatten();
        kinds.enumerate().map(|(i, kind)| (Perception::name(i, joints), kind.info())).collect()
    }

    /// Draws the perturbation of an episode from its seed.
    fn draw(&self, seed: u64) -> Perturbation {
        self.perturbation.map_or_else(Perturbation::default, |range| {
            let mut rng = stream(seed, 0, 0, Purpose::Perturbation);
            range.draw(self.trial.duration_s, self.trial.agent.limbs, &mut rng)
        })
    }
}

/// Outcome of a step of an environment.
#[derive(Clone, Copy, Default)]
pub struct StepResult {
    pub reward: f64,
    pub terminated: bool,
    pub truncated: bool,
}

/// A world during an episode.
pub struct World {
    rollout: Rollout,
    control: ExternalControl,
    torques: Vec<JointTorque>,
    /// Score minus the cost of energy, after the last healthy step.
    worth: f64,
    /// Whether the simulation panicked. The world can then only be reset.
    has_crashed: bool,
}

impl World {
    /// Creates a world at the start of an episode, with its first observation.
    pub fn new(rules: &WorldRules, seed: u64) -> PyResult<Self> {
        let (trial, genome) = (&rules.trial, &rules.genome);
        let perturbation = rules.draw(seed);
        perturbation.check().map_err(|error| invalid(error.inside("perturbation")))?;
        let mut plan = trial.world_plan(genome);
        perturbation.apply(&mut plan);
        caught(|| {
            let rollout = if rules.perturbation.is_some() {
                Rollout::perturbed(genome, trial, &perturbation)
            } else {
                Rollout::new(genome, trial)
            };
            let mut control = ExternalControl::new(
                &plan.physics,
                trial.agent.senses,
                rules.stiffness_nm_per_rad,
                rules.damping_nms_per_rad,
            );
            control.observe(0, rollout.simulation());
            let torques = vec![JointTorque::default(); plan.body.joints.len()];
            let worth = f64::from(rollout.score());
            Self { rollout, control, torques, worth, has_crashed: false }
        })
        .map_err(crashed)
    }

    /// Holds an action for the physics steps of one action, or to the end of the episode.
    pub fn step(&mut self, rules: &WorldRules, limits: &[f32], action: &[f32]) -> StepResult {
        let result = caught(|| self.take_steps(rules, limits, action));
        result.unwrap_or_else(|_| {
            self.has_crashed = true;
            let reward = -rules.disqualification_penalty;
            StepResult { reward, terminated: true, truncated: false }
        })
    }

    fn take_steps(&mut self, rules: &WorldRules, limits: &[f32], action: &[f32]) -> StepResult {
        let clamped = |axis: usize| match (action.get(axis), limits.get(axis)) {
            (Some(value), Some(limit)) => value.clamp(-limit, *limit),
            _ => 0.0,
        };
        for _ in 0..rules.steps_per_action {
            let joints = 0..self.torques.len();
            let commands = joints.map(|joint| [clamped(2 * joint), clamped(2 * joint + 1)]);
            match rules.actions {
                ActionKind::Targets => self.control.pull_towards(commands, &mut self.torques),
                ActionKind::Torques => {
                    for (torque, [bend_nm, twist_nm]) in self.torques.iter_mut().zip(commands) {
                        *torque = JointTorque { bend_nm, twist_nm };
                    }
                }
            }
            if !self.rollout.advance_with(&self.torques) {
                break;
            }
            self.control.observe(self.rollout.step(), self.rollout.simulation());
            if self.rollout.is_over() {
                break;
            }
        }
        let energy_kj = f64::from(self.rollout.simulation().effort().energy_j) / 1000.0;
        let cost = f64::from(rules.trial.energy_cost_per_kj) * energy_kj;
        let worth = f64::from(self.rollout.score()) - cost;
        let mut reward = worth - self.worth;
        self.worth = worth;
        let terminated = self.is_disqualified();
        if terminated {
            reward -= rules.disqualification_penalty;
        }
        StepResult { reward, terminated, truncated: !terminated && self.rollout.is_over() }
    }

    /// Writes the values of the senses into `senses`.
    pub fn sense(&self, senses: &mut [f32]) {
        for (place, value) in senses.iter_mut().zip(self.control.perception().values()) {
            *place = value;
        }
    }

    pub fn rollout(&self) -> &Rollout {
        &self.rollout
    }

    /// Returns whether the episode has ended.
    pub fn is_over(&self) -> bool {
        self.has_crashed || self.rollout.is_over()
    }

    /// Returns whether the snake was disqualified, at less cost than [`Self::evaluation`].
    fn is_disqualified(&self) -> bool {
        self.has_crashed || self.rollout.is_over() && self.rollout.step() < self.rollout.last_step()
    }

    /// Returns the evaluation so far.
    pub fn evaluation(&self) -> Evaluation {
        let evaluation = self.rollout.evaluation();
        let crash = self.has_crashed.then_some(Disqualification::Crashed);
        Evaluation { disqualified: evaluation.disqualified.or(crash), ..evaluation }
    }
}
