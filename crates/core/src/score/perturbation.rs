//! Random perturbations of a trial. They show whether a gait also works in slightly different conditions.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use crate::check::{Invalid, within};
use crate::genome::StairsGenome;
use crate::schema::{check, choice, choices, is_default, number, setting_group};
use crate::world::{PhysicsSettings, STEP_RATES_HZ, Shove, Stairs, Vector, WorldPlan};

setting_group! {
    /// Maximum perturbation of each quantity. Values are drawn uniformly on both sides of the nominal value.
    #[derive(Copy)]
    pub struct PerturbationRange {
        /// Maximum relative change of the friction of stairs and ground.
        friction: f32 = 0.2,
            // The range ends at 0.9, so that no factor becomes zero or negative.
            number("Friction variation", 0.0..=0.9)
                .hint("Maximum relative change of friction: 0.2 is 20 % up or down")
                .slider(0.0, 0.9);

        /// Maximum relative change of the height of the steps.
        rise: f32 = 0.1,
            number("Rise variation", 0.0..=0.9)
                .hint("Maximum relative change of the steps' height: 0.1 is 10 % up or down")
                .slider(0.0, 0.9);

        /// Maximum relative change of the density of the limbs.
        density: f32 = 0.0,
            number("Density variation", 0.0..=0.9).advanced()
                .hint("Maximum relative change of the limbs' density")
                .slider(0.0, 0.9);

        /// Maximum shift of the start along y and along x, in metres.
        start_m: f32 = 0.2,
            number("Start variation", 0.0..=5.0).advanced()
                .unit("m")
                .hint("Maximum shift of the start, along and across the stairs")
                .slider(0.0, 2.0);

        /// Maximum turn of the snake at the start, in degrees.
        turn_deg: f32 = 5.0,
            number("Start direction variation", 0.0..=180.0).advanced()
                .unit("°")
                .hint("Maximum turn of the snake at the start, to either side")
                .slider(0.0, 45.0);

        /// Maximum relative change of the depth of the steps.
        #[serde(default, skip_serializing_if = "is_default")]
        tread: f32 = 0.0,
            number("Tread variation", 0.0..=0.9).advanced()
                .hint("Maximum relative change of the steps' depth: 0.1 is 10 % up or down")
                .slider(0.0, 0.9);

        /// Maximum relative change of the number of physics steps per second.
        #[serde(default, skip_serializing_if = "is_default")]
        step_rate: f32 = 0.0,
            number("Step rate variation", 0.0..=0.9).advanced()
                .hint(
                    "Maximum relative change of the physics steps per second. A motion that only works at one step rate \
                     exploits the simulation",
                )
                .slider(0.0, 0.9);

        /// Largest change of a limb's velocity by a shove, in m/s; 0 for no shove.
        #[serde(default, skip_serializing_if = "is_default")]
        shove_m_s: f32 = 0.0,
            number("Shove", 0.0..=10.0).advanced()
                .unit("m/s")
                .hint(
                    "Maximum change of one limb's velocity at a random moment between a fifth and three fifths of the \
                     trial, backwards, to either side or upwards",
                )
                .slider(0.0, 5.0);

        /// Stairs of the perturbed trials.
        #[serde(default, skip_serializing_if = "is_default")]
        stairs: StairsVariation = StairsVariation::Own,
            choice("Stairs of the variations").advanced()
                .hint("Whether the varied trials stand on the stairs of the trial or on any others");
    }
}

choices! {
    /// Which stairs perturbed trials have.
    #[derive(Default)]
    pub enum StairsVariation {
        #[default]
        Own = "own", "Those of the trial", "The varied trials have the stairs of the trial, higher or deeper at most.";
        /// Stairs drawn by [`StairsGenome::random`].
        Drawn = "drawn", "Any others",
            "Each varied trial has stairs of its own: equal, irregular, steep as in a house, or with nosing.";
    }
}

impl PerturbationRange {
    /// Draws a perturbation of a trial of this length, in seconds, for a snake with this number of limbs.
    pub fn draw(&self, duration_s: f32, limbs: u32, rng: &mut ChaCha8Rng) -> Perturbation {
        let mut draw = |range: f32| rng.random_range(-range..=range);
        Perturbation {
            friction: 1.0 + draw(self.friction),
            rise: 1.0 + draw(self.rise),
            density: 1.0 + draw(self.density),
            ahead_m: draw(self.start_m),
            aside_m: draw(self.start_m),
            turn_rad: draw(self.turn_deg).to_radians(),
            tread: 1.0 + draw(self.tread),
            step_rate: 1.0 + draw(self.step_rate),
            shove: (self.shove_m_s > 0.0).then(|| {
                let change_m_s = rng.random_range(0.0..=self.shove_m_s);
                let moment_s = [0.2, 0.6].map(|share| share * duration_s);
                draw_shove(change_m_s, moment_s, limbs, rng)
            }),
            stairs: (self.stairs == StairsVariation::Drawn).then(|| StairsGenome::random(rng)),
        }
    }
}

/// Draws a shove of one of `limbs` limbs by `change_m_s`, in m/s, between two moments, in s. Its direction is backwards, to either side or
/// upwards.
pub fn draw_shove(
    change_m_s: f32,
    [first_s, last_s]: [f32; 2],
    limbs: u32,
    rng: &mut ChaCha8Rng,
) -> Shove {
    let directions = [Vector::NEG_Y, Vector::NEG_X, Vector::X, Vector::Z];
    let at_s = rng.random_range(first_s..=last_s);
    let limb = rng.random_range(0..limbs) as usize;
    let direction = directions[rng.random_range(0..directions.len() as u32) as usize];
    Shove { limb, at_s, change_m_s: direction * change_m_s }
}

/// The deviation of one trial from the nominal one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Perturbation {
    /// Factor on the friction of stairs and ground.
    pub friction: f32,
    /// Factor on the height of the steps.
    pub rise: f32,
    /// Factor on the density of the limbs.
    pub density: f32,
    /// Shift of the start towards the stairs, in metres.
    pub ahead_m: f32,
    /// Shift of the start along x, in metres.
    pub aside_m: f32,
    /// Turn of the snake at the start, in radians.
    pub turn_rad: f32,
    /// Factor on the depth of the steps.
    pub tread: f32,
    /// Factor on the number of physics steps per second.
    pub step_rate: f32,
    /// Shove during the trial; `None` for no shove.
    pub shove: Option<Shove>,
    /// Stairs that replace those of the trial; the factors apply to them, too. `None`: the stairs of the trial.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stairs: Option<StairsGenome>,
}

/// The perturbation that changes nothing.
impl Default for Perturbation {
    fn default() -> Self {
        Self {
            friction: 1.0,
            rise: 1.0,
            density: 1.0,
            ahead_m: 0.0,
            aside_m: 0.0,
            turn_rad: 0.0,
            tread: 1.0,
            step_rate: 1.0,
            shove: None,
            stairs: None,
        }
    }
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
        ] {
            within(field, factor, 0.0..=2.0)?;
        }
        within("step_rate", self.step_rate, 0.01..=100.0)?;
        within("ahead_m", self.ahead_m, -10.0..=10.0)?;
        within("aside_m", self.aside_m, -10.0..=10.0)?;
        within("turn_rad", self.turn_rad, -4.0..=4.0)?;
        self.stairs.map_or(Ok(()), |stairs| check(&stairs).map_err(|e| e.inside("stairs")))?;
        self.shove.map_or(Ok(()), |shove| shove.check().map_err(|error| error.inside("shove")))
    }

    /// Applies the perturbation to a world, except for the shove.
    pub fn apply(&self, plan: &mut WorldPlan) {
        plan.surface.friction *= self.friction;
        plan.ground.friction *= self.friction;
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
    use crate::genome::GenomeSpace;
    use crate::rng::{Purpose, stream};
    use crate::schema::PerPart;
    use crate::score::{Rollout, Trial};
    use std::collections::BTreeSet;

    #[test]
    fn drawn_perturbations_fill_their_range_on_both_sides() {
        let range = PerturbationRange {
            density: 0.3,
            tread: 0.1,
            step_rate: 0.5,
            shove_m_s: 2.0,
            ..PerturbationRange::default()
        };
        let mut rng = stream(1, 0, 0, Purpose::Perturbation);
        let drawn: Vec<Perturbation> = (0..1000).map(|_| range.draw(10.0, 5, &mut rng)).collect();
        let span = |of: fn(&Perturbation) -> f32, least: f32, most: f32| {
            let values = || drawn.iter().map(of);
            assert!(values().all(|value| (least..=most).contains(&value)));
            let width = values().fold(f32::MIN, f32::max) - values().fold(f32::MAX, f32::min);
            assert!(width > (most - least) * 0.95, "{width} of {least} to {most}");
        };
        span(|p| p.friction, 0.8, 1.2);
        span(|p| p.rise, 0.9, 1.1);
        span(|p| p.density, 0.7, 1.3);
        span(|p| p.ahead_m, -0.2, 0.2);
        span(|p| p.aside_m, -0.2, 0.2);
        span(|p| p.turn_rad, -5.0_f32.to_radians(), 5.0_f32.to_radians());
        span(|p| p.tread, 0.9, 1.1);
        span(|p| p.step_rate, 0.5, 1.5);
        let shove = |p: &Perturbation| p.shove.expect("a shove in each");
        span(|p| p.shove.map_or(0.0, |shove| shove.at_s), 2.0, 6.0);
        span(|p| p.shove.map_or(0.0, |shove| shove.change_m_s.length()), 0.0, 2.0);
        let limbs: BTreeSet<usize> = drawn.iter().map(|p| shove(p).limb).collect();
        assert_eq!(limbs, BTreeSet::from([0, 1, 2, 3, 4]));
        assert!(drawn.iter().all(|p| shove(p).change_m_s.y <= 0.0 && shove(p).change_m_s.z >= 0.0));
    }

    #[test]
    fn a_perturbed_world_may_have_any_stairs() {
        let range = PerturbationRange {
            stairs: StairsVariation::Drawn,
            rise: 0.0,
            ..PerturbationRange::default()
        };
        let trial = Trial::default();
        let genome = GenomeSpace::default()
            .random_genome(trial.genome_shape(), &mut stream(1, 1, 0, Purpose::Birth));
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
        let mut rng = stream(1, 1, 0, Purpose::Birth);
        let trial = Trial::default();
        let genome = GenomeSpace::default().random_genome(trial.genome_shape(), &mut rng);
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
        let mut rng = stream(1, 1, 0, Purpose::Birth);
        let trial = Trial::default();
        let genome = GenomeSpace::default().random_genome(trial.genome_shape(), &mut rng);
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
