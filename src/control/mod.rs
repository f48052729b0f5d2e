//! From genes, and what the agent feels, to torques: what the snake's joints are told in each step.

mod gait;
mod signal;

use gait::Servo;
use signal::SignalPlayer;

use crate::genome::{Controller, Genome, Wave, Waves};
use crate::world::{JointState, JointTorque};

/// A controller at work in one world.
#[derive(Debug, Clone)]
pub struct Driver {
    kind: Kind,
    steps_per_s: f64,
}

#[derive(Debug, Clone)]
enum Kind {
    Signal(SignalPlayer),
    Wave(Waves),
    Gait { waves: Waves, servo: Servo },
}

impl Driver {
    /// What drives a genome in a world that takes `steps_per_s` steps a second.
    pub fn new(genome: &Genome, steps_per_s: u32) -> Self {
        let kind = match &genome.controller {
            Controller::Signal(signals) => {
                Kind::Signal(SignalPlayer::new(signals.clone(), steps_per_s))
            }
            Controller::Wave(waves) => Kind::Wave(waves.clone()),
            Controller::Gait(gait) => {
                Kind::Gait { waves: gait.waves.clone(), servo: Servo::new(gait) }
            }
        };
        Self { kind, steps_per_s: f64::from(steps_per_s) }
    }

    /// Whether it wants to know how the joints stand.
    pub fn feels(&self) -> bool {
        matches!(self.kind, Kind::Gait { .. })
    }

    /// Writes the torques of step number `step` (0 is the first), one per joint from the head. `felt` is how
    /// the joints stand, for a driver that wants to know; they are clamped to the joints' limits later.
    pub fn torques(&self, step: u32, felt: &[JointState], torques: &mut [JointTorque]) {
        match &self.kind {
            Kind::Signal(player) => player.torques(step, torques),
            Kind::Wave(waves) => {
                let turns = self.turns(step, waves);
                for (torque, joint) in torques.iter_mut().zip(&waves.joints) {
                    torque.bend_nm = joint.bend.at(turns);
                    torque.twist_nm = joint.twist.at(turns);
                }
            }
            Kind::Gait { waves, servo } => {
                let turns = self.turns(step, waves);
                let joints = waves.joints.iter().zip(felt);
                for (torque, (joint, state)) in torques.iter_mut().zip(joints) {
                    let pull = |wave: &Wave, angle_rad, rate_rad_s| {
                        servo.torque_nm(wave.at(turns), angle_rad, rate_rad_s)
                    };
                    torque.bend_nm = pull(&joint.bend, state.bend_rad, state.bend_rad_s);
                    torque.twist_nm = pull(&joint.twist, state.twist_rad, state.twist_rad_s);
                }
            }
        }
    }

    /// Periods of the fundamental that have passed when a step begins.
    fn turns(&self, step: u32, waves: &Waves) -> f64 {
        f64::from(waves.frequency_hz) * f64::from(step) / self.steps_per_s
    }
}
