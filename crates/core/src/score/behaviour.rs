//! Measures of how a snake moves, which distinguish a roller from an inchworm.

use serde::{Deserialize, Serialize};

use crate::check::{Invalid, within};
use crate::control::WaveUses;
use crate::world::{Simulation, Stairs};

/// Measures of an agent's motion over a rollout.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Behaviour {
    /// Number of steps under the middle limb at the end: see [`Stairs::steps_under`].
    pub steps_climbed: u32,
    /// Mean height of the limbs' centres over the ground or tread below the middle limb, in m.
    pub mean_height_m: f32,
    /// Mean |x| of the middle limb's centre, in m.
    pub mean_sideways_m: f32,
    /// Mean share of the limbs that touch ground or stairs, from 0 to 1.
    pub contact_duty: f32,
    /// Frequency at which the controller's motion repeats, in Hz.
    pub frequency_hz: f32,
    /// Cost of transport: energy spent per weight and distance, `E / (m g d)`, for the distance d of the middle limb along the line of the
    /// stairs, treads and rises. `None` without a distance or a weight.
    #[serde(default)]
    pub cost_of_transport: Option<f32>,
    /// Climbing efficiency: share of the energy spent that lifted the snake up the steps under its middle limb, `m g Δz / E`. `None`
    /// without energy.
    #[serde(default)]
    pub climbing_efficiency: Option<f32>,
    /// How often the controller chose each wave of its library; `None` for a controller without a library.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wave_uses: Option<WaveUses>,
}

impl Behaviour {
    /// Checks every value that was read from a file.
    ///
    /// # Errors
    /// Returns the first value that is not allowed.
    pub fn check(self) -> Result<(), Invalid> {
        within("steps_climbed", self.steps_climbed, 0..=1000)?;
        for (field, value) in [
            ("mean_height_m", self.mean_height_m),
            ("mean_sideways_m", self.mean_sideways_m),
            ("contact_duty", self.contact_duty),
            ("frequency_hz", self.frequency_hz),
            ("cost_of_transport", self.cost_of_transport.unwrap_or(0.0)),
            ("climbing_efficiency", self.climbing_efficiency.unwrap_or(0.0)),
        ] {
            within(field, value, -1.0e6..=1.0e6)?;
        }
        Ok(())
    }
}

/// Data at a moment of a rollout from which its [`Behaviour`] is computed.
#[derive(Debug, Clone, Copy)]
pub struct BehaviourMoment {
    /// Position of the middle limb's centre at the moment, in m.
    pub middle_m: [f32; 3],
    /// y of the middle limb's centre at the start, in m.
    pub start_y_m: f32,
    /// Weight of the snake, in N.
    pub weight_n: f32,
    /// Energy that the joints have spent so far, in J.
    pub energy_j: f32,
    /// Frequency of the controller's motion, in Hz.
    pub frequency_hz: f32,
    /// How often each wave of the controller's library was chosen; `None` for a controller without a library.
    pub wave_uses: Option<WaveUses>,
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
    /// Adds the state of the world after a healthy step.
    pub fn observe(&mut self, simulation: &Simulation, stairs: &Stairs) {
        let body = simulation.body();
        let (mut sum_z_m, mut middle) = (0.0, [0.0; 3]);
        for (index, pose) in simulation.poses().enumerate() {
            let at = pose.translation;
            // All limbs have equal weight, whatever their numbers of parts.
            let parts = if body.springs.is_empty() {
                1
            } else {
                body.parts_of(body.parts[index].limb).len()
            };
            sum_z_m += f64::from(at.z) / parts as f64;
            if index == body.middle_part {
                middle = at.to_array();
            }
        }
        let limbs = body.limbs().max(1) as f64;
        self.height_m += sum_z_m / limbs - f64::from(stairs.surface_z_m(middle[0], middle[1]));
        self.sideways_m += f64::from(middle[0].abs());
        self.contacts += simulation.limbs_in_contact() as f64 / limbs;
        self.steps += 1;
    }

    /// Returns the behaviour over the steps so far.
    pub fn behaviour(&self, stairs: &Stairs, moment: &BehaviourMoment) -> Behaviour {
        let &BehaviourMoment { middle_m, start_y_m, weight_n, energy_j, frequency_hz, wave_uses } =
            moment;
        let mean = |sum: f64| (sum / f64::from(self.steps.max(1))) as f32;
        let steps_climbed = stairs.steps_under(middle_m);
        let climbed_m = stairs.height_m(steps_climbed);
        let way_n_m = weight_n * (middle_m[1] - start_y_m + climbed_m);
        Behaviour {
            steps_climbed,
            cost_of_transport: (way_n_m > 0.0).then(|| energy_j / way_n_m),
            climbing_efficiency: (energy_j > 0.0).then(|| weight_n * climbed_m / energy_j),
            mean_height_m: mean(self.height_m),
            mean_sideways_m: mean(self.sideways_m),
            contact_duty: mean(self.contacts),
            frequency_hz,
            wave_uses,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_contact_duty_of_soft_limbs_counts_limbs_and_not_their_parts() {
        let champion = crate::save::shipped_champion().expect("shipped").champion;
        let duty = |trial: &crate::score::Trial| {
            let mut rollout = crate::score::Rollout::new(&champion.genome, trial);
            // The snake still lies on the ground with all limbs.
            (0..6).for_each(|_| assert!(rollout.advance()));
            rollout.evaluation().behaviour.expect("measured").contact_duty
        };
        let mut soft = champion.trial.clone();
        soft.agent.youngs_modulus_pa = Some(60_000.0.into());
        assert!(duty(&champion.trial) > 0.8 && duty(&soft) > 0.8, "{}", duty(&soft));
    }

    #[test]
    fn transport_costs_energy_per_weight_and_way_and_climbing_lifts_the_weight() {
        let of = |middle_m: [f32; 3], energy_j: f32| {
            let moment = BehaviourMoment {
                middle_m,
                start_y_m: -7.0,
                weight_n: 200.0,
                energy_j,
                frequency_hz: 1.0,
                wave_uses: None,
            };
            BehaviourObserver::default().behaviour(&Stairs::default(), &moment)
        };
        // On the landing, the snake has moved 35 m forward and 5 m up.
        let landed = of([0.0, 28.0, 5.5], 16_000.0);
        assert_eq!(
            (landed.cost_of_transport, landed.climbing_efficiency),
            (Some(2.0), Some(0.0625))
        );
        let beside = of([4.0, 28.0, 0.5], 16_000.0);
        assert_eq!(beside.climbing_efficiency, Some(0.0), "on the ground beside the stairs");
        let back = of([0.0, -9.0, 0.5], 0.0);
        assert_eq!((back.cost_of_transport, back.climbing_efficiency), (None, None));
    }
}
