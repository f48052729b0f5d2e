//! A trial that is a little otherwise than it should be: who climbs only on this very stair has learned little.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use crate::check::{Invalid, within};
use crate::world::WorldPlan;

/// How far trials may be off. Each value is drawn evenly from both sides.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PerturbationRange {
    /// Share by which the friction of stairs and ground is larger or smaller.
    pub friction: f32,
    /// Share by which the steps are higher or lower.
    pub rise: f32,
    /// Share by which the limbs are heavier or lighter.
    pub density: f32,
    /// Distance of the start, along and across, in metres.
    pub start_m: f32,
    /// Turn of the snake at the start, in degrees.
    pub turn_deg: f32,
}

impl Default for PerturbationRange {
    fn default() -> Self {
        Self { friction: 0.2, rise: 0.1, density: 0.0, start_m: 0.2, turn_deg: 5.0 }
    }
}

impl PerturbationRange {
    /// Checks every field against its range.
    pub fn check(&self) -> Result<(), Invalid> {
        // Nothing may become nothing, let alone less.
        within("friction", self.friction, 0.0..=0.9)?;
        within("rise", self.rise, 0.0..=0.9)?;
        within("density", self.density, 0.0..=0.9)?;
        within("start_m", self.start_m, 0.0..=5.0)?;
        within("turn_deg", self.turn_deg, 0.0..=180.0)
    }

    /// Draws one.
    pub fn draw(&self, rng: &mut ChaCha8Rng) -> Perturbation {
        let mut off = |range: f32| rng.random_range(-range..=range);
        Perturbation {
            friction: 1.0 + off(self.friction),
            rise: 1.0 + off(self.rise),
            density: 1.0 + off(self.density),
            ahead_m: off(self.start_m),
            aside_m: off(self.start_m),
            turn_rad: off(self.turn_deg).to_radians(),
        }
    }
}

/// By how much a trial is off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Perturbation {
    /// Factor of the frictions of stairs and ground.
    pub friction: f32,
    /// Factor of the height of the steps.
    pub rise: f32,
    /// Factor of the density of the limbs.
    pub density: f32,
    /// How much nearer to the stairs the snake starts, in metres.
    pub ahead_m: f32,
    /// How far to the side it starts, in metres.
    pub aside_m: f32,
    /// How far it is turned at the start, in radians.
    pub turn_rad: f32,
}

impl Perturbation {
    /// Puts the world off by it.
    pub fn apply(&self, plan: &mut WorldPlan) {
        plan.surface.friction *= self.friction;
        plan.ground.friction *= self.friction;
        plan.stairs.rise_m *= self.rise;
        for limb in &mut plan.body.limbs {
            limb.density_kg_m3 *= self.density;
        }
        plan.start_y_m += self.ahead_m;
        plan.start_x_m += self.aside_m;
        plan.start_turn_rad += self.turn_rad;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::{Purpose, stream};

    #[test]
    fn what_is_drawn_fills_its_range_on_both_sides() {
        let range = PerturbationRange { density: 0.3, ..PerturbationRange::default() };
        let mut rng = stream(1, 0, 0, Purpose::Perturbation);
        let drawn: Vec<Perturbation> = (0..1000).map(|_| range.draw(&mut rng)).collect();
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
    }

    #[test]
    fn a_range_that_could_turn_the_world_inside_out_is_refused() {
        let range = PerturbationRange { friction: 1.5, ..PerturbationRange::default() };
        let error = range.check().expect_err("refused").to_string();
        assert_eq!(error, "friction is 1.5; allowed: 0 to 0.9");
    }
}
