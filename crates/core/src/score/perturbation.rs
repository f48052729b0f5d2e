//! Random perturbations of a trial. They show whether a gait also works in slightly different conditions.

use super::faults::{DriveFaults, SidePushes};
use crate::check::{Invalid, within};
use crate::genome::StairsGenome;
use crate::schema::{check, is_default, setting_group};
use crate::world::{PhysicsSettings, STEP_RATES_HZ, Shove, Stairs, WorldPlan};

setting_group! {
    /// The deviation of one trial from the nominal one; by default, none.
    #[derive(Copy)]
    pub struct Perturbation {
        /// Factor on the friction of stairs and ground.
        friction: f32 = 1.0;
        /// Factor on the height of the steps.
        rise: f32 = 1.0;
        /// Factor on the density of the limbs.
        density: f32 = 1.0;
        /// Shift of the start towards the stairs, in metres.
        ahead_m: f32 = 0.0;
        /// Shift of the start along x, in metres.
        aside_m: f32 = 0.0;
        /// Turn of the snake at the start, in radians.
        turn_rad: f32 = 0.0;
        /// Factor on the depth of the steps.
        tread: f32 = 1.0;
        /// Factor on the number of physics steps per second.
        step_rate: f32 = 1.0;
        /// Shove during the trial; `None` for no shove.
        shove: Option<Shove> = None;
        /// Stairs that replace those of the trial; the factors apply to them, too. `None`: the stairs of the trial.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        stairs: Option<StairsGenome> = None;
        /// Factor on gravity.
        #[serde(default = "one", skip_serializing_if = "is_one")]
        gravity: f32 = 1.0;
        /// Least restitution of stairs and ground.
        #[serde(default, skip_serializing_if = "is_default")]
        bounce: f32 = 0.0;
        /// Addition to the softness (CFM) of stairs and ground, in m/s per N.
        #[serde(default, skip_serializing_if = "is_default")]
        softness_m_s_per_n: f32 = 0.0;
        /// Factor on the damping of the joints.
        #[serde(default = "one", skip_serializing_if = "is_one")]
        joint_damping: f32 = 1.0;
        /// Faults of the drives; `None` for none.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        drives: Option<DriveFaults> = None;
        /// Pushes from the side; `None` for none.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pushes: Option<SidePushes> = None;
    }
}

/// Returns the factor that changes nothing.
fn one() -> f32 {
    1.0
}

fn is_one(factor: &f32) -> bool {
    *factor == 1.0
}

impl Perturbation {
    /// Checks that every value is in a range that perturbations can have.
    ///
    /// # Errors
    /// Returns an error for a value that no range of perturbations can draw.
    pub fn check(&self) -> Result<(), Invalid> {
        for (field, factor) in [
            ("friction", self.friction),
            ("rise", self.rise),
            ("density", self.density),
            ("tread", self.tread),
            ("gravity", self.gravity),
            ("joint_damping", self.joint_damping),
        ] {
            within(field, factor, 0.0..=2.0)?;
        }
        within("bounce", self.bounce, 0.0..=1.0)?;
        within("softness_m_s_per_n", self.softness_m_s_per_n, 0.0..=1.0)?;
        let drives = self.drives.map_or(Ok(()), |drives| drives.check());
        drives.map_err(|error| error.inside("drives"))?;
        let pushes = self.pushes.map_or(Ok(()), |pushes| pushes.check());
        pushes.map_err(|error| error.inside("pushes"))?;
        within("step_rate", self.step_rate, 0.01..=100.0)?;
        within("ahead_m", self.ahead_m, -10.0..=10.0)?;
        within("aside_m", self.aside_m, -10.0..=10.0)?;
        within("turn_rad", self.turn_rad, -4.0..=4.0)?;
        self.stairs.map_or(Ok(()), |stairs| check(&stairs).map_err(|e| e.inside("stairs")))?;
        self.shove.map_or(Ok(()), |shove| shove.check().map_err(|error| error.inside("shove")))
    }

    /// Applies the perturbation to a world, except for shove, drives and pushes, which act during the trial.
    pub fn apply(&self, plan: &mut WorldPlan) {
        for surface in [&mut plan.surface, &mut plan.ground] {
            surface.friction *= self.friction;
            surface.bounce = surface.bounce.max(self.bounce);
            surface.soft_cfm_m_s_per_n += self.softness_m_s_per_n;
        }
        plan.physics.gravity_m_s2 *= self.gravity;
        for joint in &mut plan.body.joints {
            joint.damping_nms_per_rad *= self.joint_damping;
        }
        if let Some(stairs) = &self.stairs {
            let Stairs { first_riser_y_m, landing_m, .. } = plan.stairs;
            plan.stairs = Stairs { first_riser_y_m, landing_m, ..stairs.stairs() };
        }
        plan.stairs.rise_m = plan.stairs.rise_m.map(|rise_m| rise_m * self.rise);
        for limb in &mut plan.body.parts {
            limb.density_kg_m3 *= self.density;
        }
        plan.start_y_m += self.ahead_m;
        plan.start_x_m += self.aside_m;
        plan.start_turn_rad += self.turn_rad;
        plan.stairs.tread_m = plan.stairs.tread_m.map(|tread_m| tread_m * self.tread);
        plan.stairs.slope_m = plan.stairs.slope_m.map(|slope_m| slope_m * self.tread);
        let PhysicsSettings { steps_per_s, .. } = &mut plan.physics;
        let rate = (*steps_per_s as f32 * self.step_rate).round() as u32;
        *steps_per_s = rate.clamp(*STEP_RATES_HZ.start(), *STEP_RATES_HZ.end());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::{Purpose, stream};
    use crate::schema::PerPart;
    use crate::score::{PerturbationRange, Rollout, StairsVariation, Trial};
    use crate::world::Vector;
    use std::collections::BTreeSet;

    #[test]
    fn a_perturbed_world_may_have_any_stairs() {
        let range = PerturbationRange {
            stairs: StairsVariation::Drawn,
            rise: 0.0,
            ..PerturbationRange::default()
        };
        let trial = Trial::default();
        let genome = trial.random_genome(0);
        let mut steps = BTreeSet::new();
        for number in 0..50 {
            let drawn = range.draw(10.0, 5, &mut stream(number, 0, 0, Purpose::Stairs));
            drawn.check().expect("allowed");
            let mut plan = trial.world_plan(&genome);
            drawn.apply(&mut plan);
            check(&plan.stairs).expect("can be built");
            assert_eq!(plan.stairs.first_riser_y_m, trial.stairs.first_riser_y_m);
            let expected = drawn.stairs.expect("drawn").stairs();
            assert_eq!(plan.stairs.rise_m, expected.rise_m);
            steps.insert(plan.stairs.steps);
        }
        assert!(steps.len() > 4);
        let own = PerturbationRange::default().draw(10.0, 5, &mut stream(1, 0, 0, Purpose::Stairs));
        assert_eq!(own.stairs, None);
    }

    #[test]
    fn a_perturbed_world_has_its_own_steps_and_step_rate() {
        let trial = Trial::default();
        let genome = trial.random_genome(0);
        let mut plan = trial.world_plan(&genome);
        let off = Perturbation { tread: 0.9, step_rate: 2.0, rise: 1.1, ..Perturbation::default() };
        off.apply(&mut plan);
        assert_eq!(plan.stairs.rise_m, PerPart::All(0.55));
        assert_eq!((plan.stairs.step_tread_m(0), plan.physics.steps_per_s), (1.8, 120));
        let slow = Perturbation { step_rate: 0.1, ..Perturbation::default() };
        slow.apply(&mut plan);
        assert_eq!(plan.physics.steps_per_s, 20, "the lowest that is allowed");
        let mut rollout = Rollout::perturbed(&genome, &trial, &off);
        while rollout.advance() {}
        assert_eq!(rollout.step(), 2 * trial.steps(), "the same duration");
    }

    #[test]
    fn a_shove_acts_from_its_moment_on() {
        let trial = Trial::default();
        let genome = trial.random_genome(0);
        let shove = Shove { limb: 2, at_s: 1.0, change_m_s: Vector::Z * 2.0 };
        let shoved = Perturbation { shove: Some(shove), ..Perturbation::default() };
        let mut plain = Rollout::new(&genome, &trial);
        let mut shoved = Rollout::perturbed(&genome, &trial, &shoved);
        while plain.step() < 60 {
            assert!(plain.advance() && shoved.advance());
        }
        assert_eq!(plain.poses(), shoved.poses());
        assert!(plain.advance() && shoved.advance());
        let up_m = shoved.middle_m().z - plain.middle_m().z;
        // The shove changes the velocity by 2 m/s, of which the joints take a part.
        assert!(up_m > 0.005, "{up_m} m higher");
    }
}
