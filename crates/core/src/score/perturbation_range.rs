//! Ranges of random perturbations, and how one is drawn.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::faults::{DriveFaults, MOST_DELAY_STEPS, SidePushes};
use super::perturbation::Perturbation;
use crate::genome::StairsGenome;
use crate::schema::{choice, choices, is_default, number, setting_group, whole};
use crate::world::{Shove, Vector};

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
                .hint("Maximum relative change of the blocks' density")
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

        /// Largest change of a block's velocity by a shove, in m/s; 0 for no shove.
        #[serde(default, skip_serializing_if = "is_default")]
        shove_m_s: f32 = 0.0,
            number("Shove", 0.0..=10.0).advanced()
                .unit("m/s")
                .hint(
                    "Maximum change of one block's velocity at a random moment between a fifth and three fifths of the \
                     trial, backwards, to either side or upwards",
                )
                .slider(0.0, 5.0);

        /// Maximum relative change of gravity.
        #[serde(default, skip_serializing_if = "is_default")]
        gravity: f32 = 0.0,
            number("Gravity variation", 0.0..=0.9).advanced()
                .hint("Maximum relative change of gravity: 0.05 is 5 % up or down")
                .slider(0.0, 0.3);

        /// Maximum restitution of stairs and ground.
        #[serde(default, skip_serializing_if = "is_default")]
        bounce: f32 = 0.0,
            number("Bounce variation", 0.0..=1.0).advanced()
                .hint("Maximum bounce of stairs and ground, if it is more than their own")
                .slider(0.0, 1.0);

        /// Maximum addition to the softness (CFM) of stairs and ground, in m/s per N.
        #[serde(default, skip_serializing_if = "is_default")]
        softness_m_s_per_n: f32 = 0.0,
            number("Softness variation", 0.0..=1.0).advanced()
                .unit("m/s per N")
                .hint("Maximum addition to the softness of stairs and ground")
                .slider(0.0, 1.0)
                .logarithmic_from(1.0e-5);

        /// Maximum relative change of the damping of the joints.
        #[serde(default, skip_serializing_if = "is_default")]
        joint_damping: f32 = 0.0,
            number("Joint damping variation", 0.0..=0.9).advanced()
                .hint("Maximum relative change of the damping of the joints, the same for all")
                .slider(0.0, 0.9);

        /// Maximum relative change of the torques of a joint axis.
        #[serde(default, skip_serializing_if = "is_default")]
        torque: f32 = 0.0,
            number("Torque variation", 0.0..=0.9).advanced()
                .hint("Maximum relative change of the torques of a joint; each joint has its own")
                .slider(0.0, 0.9);

        /// Maximum torque that is added to the torques of a joint axis, as a share of its greatest torque.
        #[serde(default, skip_serializing_if = "is_default")]
        torque_offset: f32 = 0.0,
            number("Torque offset", 0.0..=0.9).advanced()
                .hint("Maximum constant torque that is added at a joint, as a share of its greatest torque; each joint has its own")
                .slider(0.0, 0.5);

        /// Maximum random torque of a step, as a share of the greatest torque of the joint axis.
        #[serde(default, skip_serializing_if = "is_default")]
        torque_noise: f32 = 0.0,
            number("Torque noise", 0.0..=0.9).advanced()
                .hint("Maximum random torque that is added in each step, as a share of the joint's greatest torque")
                .slider(0.0, 0.5);

        /// Maximum number of steps by which torques are late.
        #[serde(default, skip_serializing_if = "is_default")]
        delay_steps: u32 = 0,
            whole("Delay", 0..=MOST_DELAY_STEPS).advanced()
                .hint("Maximum number of physics steps by which torques are late")
                .slider(0.0, 5.0);

        /// Largest change of a block's velocity by a push from the side, in m/s; 0 for no pushes.
        #[serde(default, skip_serializing_if = "is_default")]
        push_m_s: f32 = 0.0,
            number("Pushes from the side", 0.0..=10.0).advanced()
                .unit("m/s")
                .hint("Maximum change of a block's velocity to the left or to the right, once in each second")
                .slider(0.0, 3.0);

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
            ..self.draw_reality(rng)
        }
    }

    /// Draws the differences between two models of the same world: gravity, contacts, joints, drives, pushes. A kind of
    /// difference that the range does not have takes no random number.
    fn draw_reality(&self, rng: &mut ChaCha8Rng) -> Perturbation {
        let mut around_one =
            |range: f32| if range > 0.0 { 1.0 + rng.random_range(-range..=range) } else { 1.0 };
        let [gravity, joint_damping] = [around_one(self.gravity), around_one(self.joint_damping)];
        let mut up_to = |most: f32| if most > 0.0 { rng.random_range(0.0..=most) } else { 0.0 };
        let [bounce, softness_m_s_per_n] = [up_to(self.bounce), up_to(self.softness_m_s_per_n)];
        let [gain, offset, noise] = [self.torque, self.torque_offset, self.torque_noise];
        let is_faulty = gain + offset + noise > 0.0 || self.delay_steps > 0;
        let drives = is_faulty.then(|| DriveFaults {
            gain,
            offset,
            noise,
            delay_steps: rng.random_range(0..=self.delay_steps),
            seed: rng.random(),
        });
        let pushes = (self.push_m_s > 0.0)
            .then(|| SidePushes { change_m_s: self.push_m_s, seed: rng.random() });
        let none = Perturbation::default();
        Perturbation { gravity, bounce, softness_m_s_per_n, joint_damping, drives, pushes, ..none }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::{Purpose, stream};
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
        let range = PerturbationRange {
            gravity: 0.1,
            bounce: 0.3,
            softness_m_s_per_n: 0.001,
            joint_damping: 0.4,
            torque: 0.2,
            delay_steps: 2,
            push_m_s: 1.0,
            ..range
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
        span(|p| p.gravity, 0.9, 1.1);
        span(|p| p.bounce, 0.0, 0.3);
        span(|p| p.softness_m_s_per_n, 0.0, 0.001);
        span(|p| p.joint_damping, 0.6, 1.4);
        span(|p| p.drives.map_or(0.0, |drives| drives.delay_steps as f32), 0.0, 2.0);
        let seeds = drawn.iter().filter_map(|p| Some([p.drives?.seed, p.pushes?.seed]));
        assert_eq!(seeds.collect::<BTreeSet<[u64; 2]>>().len(), drawn.len(), "each has its own");
        assert!(drawn.iter().all(|p| p.check().is_ok()));
        let shove = |p: &Perturbation| p.shove.expect("a shove in each");
        span(|p| p.shove.map_or(0.0, |shove| shove.at_s), 2.0, 6.0);
        span(|p| p.shove.map_or(0.0, |shove| shove.change_m_s.length()), 0.0, 2.0);
        let limbs: BTreeSet<usize> = drawn.iter().map(|p| shove(p).limb).collect();
        assert_eq!(limbs, BTreeSet::from([0, 1, 2, 3, 4]));
        assert!(drawn.iter().all(|p| shove(p).change_m_s.y <= 0.0 && shove(p).change_m_s.z >= 0.0));
    }
}
