//! One world of an environment: a rollout whose torques come from outside, and the snake's senses.

use pyo3::prelude::*;
use snakes_core::control::ExternalControl;
use snakes_core::genome::Genome;
use snakes_core::genome::controllers::RecordedActions;
use snakes_core::score::{Ending, Evaluation, Rollout};
use snakes_core::world::{Disqualification, JointTorque};
use snakes_lab::run::caught;

use crate::errors::{crashed, invalid};
use crate::world_rules::{ActionKind, WorldRules};

/// Outcome of a step of an environment.
#[derive(Clone, Copy, Default)]
pub struct StepResult {
    pub reward: f64,
    pub terminated: bool,
    pub truncated: bool,
}

/// A world during an episode.
#[derive(Clone)]
pub struct World {
    rollout: Rollout,
    control: ExternalControl,
    torques: Vec<JointTorque>,
    /// Seed of the episode's perturbation.
    pub seed: u64,
    /// The actions so far, one after another, within their limits.
    pub actions: Vec<f32>,
    /// Fitness after the last healthy step.
    fitness: f64,
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
            let (fitness, actions) = (f64::from(rollout.fitness()), Vec::new());
            Self { rollout, control, torques, seed, actions, fitness, has_crashed: false }
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
        let first = self.actions.len();
        let clamped = action.iter().zip(limits).map(|(value, limit)| value.clamp(-limit, *limit));
        self.actions.extend(clamped);
        let commands = self.actions.get(first..).unwrap_or_default().as_chunks::<2>().0;
        for _ in 0..rules.steps_per_action {
            let commands = commands.iter().copied();
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
        let fitness = f64::from(self.rollout.fitness());
        let mut reward = fitness - self.fitness;
        self.fitness = fitness;
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

    /// Returns the genome that plays the actions of the episode back.
    pub fn recorded(&self, rules: &WorldRules) -> Genome {
        let servo = [rules.stiffness_nm_per_rad, rules.damping_nms_per_rad];
        let recorded = RecordedActions {
            values: &self.actions,
            joints: self.torques.len(),
            steps_per_action: rules.steps_per_action,
            steps_per_s: rules.trial.physics.steps_per_s,
            duration_s: rules.trial.duration_s,
            servo: (rules.actions == ActionKind::Targets).then_some(servo),
        };
        Genome { controller: recorded.genes(), ..rules.genome.clone() }
    }

    /// Returns whether no step was taken yet.
    pub fn is_fresh(&self) -> bool {
        self.actions.is_empty()
    }

    /// Returns the fitness so far, as the program scores it.
    pub fn fitness(&self) -> f64 {
        self.fitness
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
        match crash {
            Some(_) => Evaluation {
                disqualified: evaluation.disqualified.or(crash),
                ending: Some(Ending::CRASHED),
                ..evaluation
            },
            None => evaluation,
        }
    }
}
