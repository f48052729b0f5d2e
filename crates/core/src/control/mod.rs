//! Controllers: from genes and observations to torques.
//!
//! A new kind of controller needs a file in this folder, a line in `controller_of`, and genes, which are registered in
//! `genome/controllers`.

mod activity;
mod controller;
mod ctrnn;
mod decision_activity;
mod decision_clock;
mod decisions;
mod external;
mod gait;
mod grown;
mod joint_decisions;
mod limb_activity;
mod limb_neurons;
mod network;
mod observation;
mod part_neurons;
mod perception;
mod posture_choice;
mod postures;
mod reflex;
mod rewards;
mod rules;
mod sense;
mod servo;
mod signal;
mod situation;
mod targets;
mod wave;
mod wave_choice;
mod wave_uses;

use decision_activity::RulePlace;

pub use activity::{
    Activity, NetworkActivity, NetworkLink, NetworkNode, NodeColumn, ReflexActivity, ReflexPush,
};
pub use controller::Controller;
pub use decision_activity::{ActiveRule, DecisionActivity, PostureWorth};
pub use external::ExternalControl;
pub use limb_activity::{ActiveLimb, LimbActivity};
pub use observation::{Observation, Senses};
pub use perception::{JointSenses, LimbSenses, Perception, SnakeSenses};
pub use sense::{ActiveSenses, SenseInfo, SenseKind, SenseOrgan, SensePlace};
pub use wave_choice::{ActiveWave, ActiveWaveRule, WaveChoiceActivity};
pub use wave_uses::WaveUses;

use crate::genome::{ControllerGenes, Genome};
use crate::learn::Episode;
use crate::world::{BodyPlan, JointTorque, PhysicsSettings, Simulation, WorldPlan};

/// Creates the controller that a genome encodes for its body, in its state before the first step.
fn controller_of(genome: &Genome, body: &BodyPlan) -> Box<dyn Controller> {
    match &genome.controller {
        ControllerGenes::Signal(signals) => Box::new(signal::SignalPlayer(signals.clone())),
        ControllerGenes::Wave(waves) => Box::new(wave::WavePlayer(waves.clone())),
        ControllerGenes::Gait(gait) => Box::new(gait::GaitFollower::new(gait.clone())),
        ControllerGenes::Targets(genes) => Box::new(targets::TargetFollower::new(genes.clone())),
        ControllerGenes::Reflex(genes) => Box::new(reflex::ReflexFollower::new(genes.clone())),
        ControllerGenes::Modular(genes) => Box::new(network::ModularController::new(genes.clone())),
        ControllerGenes::Central(genes) => Box::new(network::CentralController::new(genes.clone())),
        ControllerGenes::Rules(genes) => Box::new(rules::RuleFollower::new(genes.clone())),
        ControllerGenes::Ctrnn(genes) => Box::new(ctrnn::CtrnnController::new(genes.clone())),
        ControllerGenes::Grown(genes) => Box::new(grown::GrownController::new(genes.clone())),
        ControllerGenes::LimbNeurons(genes) => {
            Box::new(limb_neurons::LimbNeuronController::new(genes.clone()))
        }
        ControllerGenes::PartNeurons(genes) => {
            Box::new(part_neurons::PartNeuronController::new(genes.clone(), genome, body))
        }
        ControllerGenes::Decisions(genes) => {
            Box::new(decisions::DecisionController::new(genes.clone()))
        }
        ControllerGenes::JointDecisions(genes) => {
            Box::new(joint_decisions::JointDecisionController::new(genes.clone()))
        }
    }
}

/// A controller in a world: it observes the world, then acts. A clone continues with the state of the original.
#[derive(Clone)]
pub struct ControlLoop {
    controller: Box<dyn Controller>,
    observation: Observation,
    active: ActiveSenses,
}

impl ControlLoop {
    /// Creates the control loop of a genome in a world of this plan, with these active senses.
    pub fn new(genome: &Genome, plan: &WorldPlan, active: ActiveSenses) -> Self {
        Self::of(controller_of(genome, &plan.body), &plan.physics, active)
    }

    fn of(
        controller: Box<dyn Controller>,
        physics: &PhysicsSettings,
        active: ActiveSenses,
    ) -> Self {
        Self { controller, observation: Observation::at_start(physics), active }
    }

    /// Continues in a world with other settings of the engine, but the same step length, and with other active senses.
    pub fn continue_in(&mut self, physics: &PhysicsSettings, active: ActiveSenses) {
        self.observation.take_lead(physics);
        self.active = active;
    }

    /// Writes the torques of step number `step` (0 is the first), one per joint from the head.
    pub fn act(&mut self, step: u32, world: &Simulation, torques: &mut [JointTorque]) {
        self.observation.update(step, world, self.controller.needs(), &self.active);
        self.controller.act(&self.observation, torques);
    }

    /// Returns how often each wave of a library was chosen so far; `None` for a controller without a library.
    pub fn wave_uses(&self) -> Option<WaveUses> {
        self.controller.wave_uses()
    }

    /// Ends the episode after step number `step - 1`, the last, and returns the experience of a controller that learns from it; otherwise
    /// `None`.
    pub fn finish(
        &mut self,
        step: u32,
        world: &Simulation,
        is_disqualified: bool,
    ) -> Option<Episode> {
        if !is_disqualified {
            self.observation.update(step, world, self.controller.needs(), &self.active);
        }
        self.controller.finish(&self.observation, is_disqualified)
    }

    /// Returns the state of the controller for display at a joint; the first joint is 0. See [`Controller::activity`].
    pub fn activity(&self, joint: usize) -> Option<Activity> {
        self.controller.activity(&self.observation, joint)
    }

    /// Returns the senses that work now.
    pub fn active_senses(&self) -> ActiveSenses {
        self.active
    }

    /// Returns the senses before the last step; empty for a controller that does not sense its surroundings.
    pub fn perception(&self) -> &Perception {
        &self.observation.perception
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::score::Trial;

    /// A controller that counts its steps, and expects joint states only if it needs them.
    #[derive(Clone)]
    struct Counter {
        senses: Senses,
        acted: f32,
    }

    impl Controller for Counter {
        fn needs(&self) -> Senses {
            self.senses
        }

        fn act(&mut self, observation: &Observation, torques: &mut [JointTorque]) {
            let sensed = if self.senses.joints { torques.len() } else { 0 };
            assert_eq!(observation.joints.len(), sensed);
            self.acted += 1.0;
            torques[0].bend_nm = self.acted;
        }
    }

    #[test]
    fn a_clone_continues_with_the_state_of_its_controller() {
        for joints in [false, true] {
            let trial = Trial::default();
            let genome = trial.random_genome(0);
            let world = Simulation::new(&trial.world_plan(&genome));
            let mut torques = vec![JointTorque::default(); world.joint_states().len()];
            let counter = Counter { senses: Senses { joints, ..Senses::default() }, acted: 0.0 };
            let active = ActiveSenses::default();
            let mut original = ControlLoop::of(Box::new(counter), &trial.physics, active);
            original.act(0, &world, &mut torques);
            let mut clone = original.clone();
            for step in 1..4 {
                original.act(step, &world, &mut torques);
            }
            assert_eq!(torques[0].bend_nm, 4.0);
            clone.act(1, &world, &mut torques);
            assert_eq!(torques[0].bend_nm, 2.0, "not affected by the original");
        }
    }
}
