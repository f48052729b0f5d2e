//! Measures of how a snake moves, which distinguish a roller from an inchworm.

use crate::world::{Simulation, Stairs};

/// Measures of an agent's motion over a rollout.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Behaviour {
    /// Steps under the middle limb at the end: see [`Stairs::steps_under`].
    pub steps_climbed: u32,
    /// Mean height of the limbs' centres over the ground or tread below the middle limb, in m.
    pub mean_height_m: f32,
    /// Mean |x| of the middle limb's centre, in m.
    pub mean_sideways_m: f32,
    /// Share of limbs that touch ground or stairs, from 0 to 1, on average.
    pub contact_duty: f32,
    /// Frequency at which the controller's motion repeats, in Hz.
    pub frequency_hz: f32,
}

/// Accumulates a [`Behaviour`] step by step.
#[derive(Debug, Clone, Default)]
pub struct BehaviourObserver {
    height_m: f64,
    sideways_m: f64,
    contacts: f64,
    steps: u32,
}

impl BehaviourObserver {
    /// Takes in the state of the world after a healthy step.
    pub fn observe(&mut self, simulation: &Simulation, stairs: &Stairs) {
        let middle_limb = simulation.body().middle_limb();
        let (mut sum_z_m, mut middle, mut limbs) = (0.0, [0.0; 3], 0);
        for (index, pose) in simulation.poses().enumerate() {
            let at = pose.translation;
            sum_z_m += f64::from(at.z);
            limbs += 1;
            if index == middle_limb {
                middle = at.to_array();
            }
        }
        let limbs = f64::from(limbs.max(1));
        self.height_m += sum_z_m / limbs - f64::from(stairs.surface_z_m(middle[0], middle[1]));
        self.sideways_m += f64::from(middle[0].abs());
        self.contacts += simulation.limbs_in_contact() as f64 / limbs;
        self.steps += 1;
    }

    /// The behaviour so far. `middle_m` is the present position of the middle limb's centre.
    pub fn behaviour(&self, stairs: &Stairs, middle_m: [f32; 3], frequency_hz: f32) -> Behaviour {
        let mean = |sum: f64| (sum / f64::from(self.steps.max(1))) as f32;
        Behaviour {
            steps_climbed: stairs.steps_under(middle_m),
            mean_height_m: mean(self.height_m),
            mean_sideways_m: mean(self.sideways_m),
            contact_duty: mean(self.contacts),
            frequency_hz,
        }
    }
}
