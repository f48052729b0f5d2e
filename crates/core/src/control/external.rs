//! Senses and servos for a controller outside of this program.

use super::servo::JointServos;
use super::{ActiveSenses, Observation, Perception, Senses};
use crate::world::{JointTorque, PhysicsSettings, Simulation};

/// Senses of a snake, and servos that follow target angles, for a controller outside of this program. Such a controller observes the world
/// with it, decides, and steps a [`Rollout`](crate::score::Rollout) with torques.
#[derive(Debug, Clone)]
pub struct ExternalControl {
    observation: Observation,
    servos: JointServos,
    active: ActiveSenses,
}

impl ExternalControl {
    /// Creates the control of a world with these settings of the engine, with these active senses, and with servos of this stiffness in
    /// N·m/rad and damping in N·m·s/rad.
    pub fn new(
        physics: &PhysicsSettings,
        active: ActiveSenses,
        stiffness_nm_per_rad: f32,
        damping_nms_per_rad: f32,
    ) -> Self {
        Self {
            observation: Observation::at_start(physics),
            servos: JointServos::new(stiffness_nm_per_rad, damping_nms_per_rad),
            active,
        }
    }

    /// Observes the world before step number `step` (0 is the first). It must be called once before each step, because each call advances
    /// the filter of the contact forces.
    pub fn observe(&mut self, step: u32, world: &Simulation) {
        self.observation.update(step, world, Senses::ALL, &self.active);
    }

    /// Returns the senses at the latest observation of the world.
    pub fn perception(&self) -> &Perception {
        &self.observation.perception
    }

    /// Writes the torques of the step that begins. They turn the joints, from the head, towards these angles of bend and twist, in
    /// radians. It must be called at most once between two observations.
    pub fn pull_towards(
        &mut self,
        targets_rad: impl Iterator<Item = [f32; 2]>,
        torques: &mut [JointTorque],
    ) {
        self.servos.pull(&self.observation, targets_rad, torques);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::genome::{ControllerGenes, ControllerKind};
    use crate::score::{Rollout, Trial};

    #[test]
    fn servos_from_outside_move_a_snake_as_the_servos_of_a_gait_do() {
        let trial = Trial { duration_s: 2.0, ..Trial::default() };
        let genome = trial.random_genome_of(ControllerKind::Gait, 3);
        let ControllerGenes::Gait(gait) = genome.controller.clone() else { panic!("a gait") };
        let mut inside = Rollout::new(&genome, &trial);
        while inside.advance() {}

        let mut outside = Rollout::new(&genome, &trial);
        let (stiffness, damping) = (gait.stiffness_nm_per_rad, gait.servo_damping_nms_per_rad);
        let mut control =
            ExternalControl::new(&trial.physics, trial.agent.senses, stiffness, damping);
        let mut torques = [JointTorque::default(); 4];
        loop {
            control.observe(outside.step(), outside.simulation());
            let periods = control.observation.periods(gait.waves.frequency_hz);
            let targets = gait
                .waves
                .joints
                .iter()
                .map(|joint| [joint.bend.at(periods), joint.twist.at(periods)]);
            control.pull_towards(targets, &mut torques);
            if !outside.advance_with(&torques) {
                break;
            }
        }
        assert!(inside.step() > 60);
        assert_eq!(outside.evaluation().trace_hash, inside.evaluation().trace_hash);
        assert_eq!(outside.evaluation().effort, inside.evaluation().effort);
        let senses: Vec<f32> = control.perception().values().collect();
        assert_eq!(senses.len(), Perception::count(4));
    }
}
