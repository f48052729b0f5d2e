//! Lets a body come to rest before a trial, so that no body gains by falling over at its start.

use super::Simulation;
use crate::world::{Disqualification, Effort, JointTorque, Vector};

/// Longest time in which a body may come to rest, in s.
const LONGEST_S: f32 = 2.0;
/// Time for which the body has to stay at rest, in s.
const REST_S: f32 = 0.25;
/// Greatest speed of the centre of mass that counts as rest, in m/s.
const REST_SPEED_M_S: f32 = 0.02;
/// Greatest displacement of a limb's centre that counts as rest, in m.
const REST_WAY_M: f32 = 0.001;
/// Greatest displacement of the centre of mass along y while the body settles, in m.
const LARGEST_SHIFT_M: f32 = 0.5;

impl Simulation {
    /// Steps the world without commanded torques, but with all damping, until the body rests. Its energy and effort count from then on.
    /// The method follows Sims (1994), whose creatures begin when their centre of mass is at rest.
    ///
    /// Returns an error if the body breaks a limit, shifts along the stairs, or does not come to rest in time.
    pub fn settle(&mut self) -> Result<(), Disqualification> {
        let step_s = self.plan.physics.step_s();
        let [longest, rest] =
            [LONGEST_S, REST_S].map(|time_s| libm::roundf(time_s / step_s) as u32);
        let start_y_m = self.centre_of_mass().0.y;
        let torques = vec![JointTorque::default(); self.body().joints.len()];
        let (mut since, mut rested) = (self.places(), 0);
        for _ in 0..longest {
            self.apply(&torques);
            self.advance();
            self.check_health()?;
            let (centre, velocity) = self.centre_of_mass();
            if (centre.y - start_y_m).abs() > LARGEST_SHIFT_M {
                return Err(Disqualification::FellOver);
            }
            let places = self.places();
            let mut ways = places.iter().zip(&since).map(|(now, before)| now.distance(*before));
            if velocity.length() < REST_SPEED_M_S && ways.all(|way_m| way_m < REST_WAY_M) {
                rested += 1;
            } else {
                (since, rested) = (places, 0);
            }
            if rested >= rest {
                self.effort = Effort::default();
                self.begin_balance();
                return Ok(());
            }
        }
        Err(Disqualification::FellOver)
    }

    fn places(&self) -> Vec<Vector> {
        self.poses().map(|pose| pose.translation).collect()
    }

    /// Returns the position of the centre of mass in metres, and its velocity in m/s.
    fn centre_of_mass(&self) -> (Vector, Vector) {
        let (mut place, mut velocity, mut mass_kg) = (Vector::ZERO, Vector::ZERO, 0.0);
        let limbs = self.body().parts.iter().zip(self.poses().zip(self.velocities()));
        for (limb, (pose, [linear, _])) in limbs {
            place += pose.translation * limb.mass_kg();
            velocity += linear * limb.mass_kg();
            mass_kg += limb.mass_kg();
        }
        (place / mass_kg, velocity / mass_kg)
    }
}
