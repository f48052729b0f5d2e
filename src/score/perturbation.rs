//! Random perturbations of a trial. They show whether a gait also works in slightly different conditions.

use crate::schema::{number, setting_group};
use crate::world::WorldPlan;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

setting_group! {
    /// Maximum perturbation of each quantity. Values are drawn uniformly on both sides of the nominal one.
    #[derive(Copy)]
    pub struct PerturbationRange {
        /// Relative change of the friction of stairs and ground.
        friction: f32 = 0.2,
            // No factor may become zero or negative.
            number("Friction variation", 0.0..=0.9)
                .hint("Maximum relative change of friction: 0.2 is 20 % up or down")
                .slider(0.0, 0.9);

        /// Relative change of the height of the steps.
        rise: f32 = 0.1,
            number("Rise variation", 0.0..=0.9)
                .hint("Maximum relative change of the steps' height: 0.1 is 10 % up or down")
                .slider(0.0, 0.9);

        /// Relative change of the density of the limbs.
        density: f32 = 0.0,
            number("Density variation", 0.0..=0.9).advanced()
                .hint("Maximum relative change of the limbs' density")
                .slider(0.0, 0.9);

        /// Shift of the start, along and across, in metres.
        start_m: f32 = 0.2,
            number("Start variation", 0.0..=5.0).advanced()
                .unit("m")
                .hint("Maximum shift of the start, along and across the stairs")
                .slider(0.0, 2.0);

        /// Turn of the snake at the start, in degrees.
        turn_deg: f32 = 5.0,
            number("Start direction variation", 0.0..=180.0).advanced()
                .unit("°")
                .hint("Maximum turn of the snake at the start, to either side")
                .slider(0.0, 45.0);
    }
}

impl PerturbationRange {
    /// Draws a perturbation.
    pub fn draw(&self, rng: &mut ChaCha8Rng) -> Perturbation {
        let mut draw = |range: f32| rng.random_range(-range..=range);
        Perturbation {
            friction: 1.0 + draw(self.friction),
            rise: 1.0 + draw(self.rise),
            density: 1.0 + draw(self.density),
            ahead_m: draw(self.start_m),
            aside_m: draw(self.start_m),
            turn_rad: draw(self.turn_deg).to_radians(),
        }
    }
}

/// Deviation of one trial from the nominal one.
#[derive(Debug, Clone, Copy, PartialEq)]
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
}

impl Perturbation {
    /// Applies the perturbation to a world.
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
    fn drawn_perturbations_fill_their_range_on_both_sides() {
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
    fn a_range_that_allows_a_negative_factor_is_refused() {
        let range = PerturbationRange { friction: 1.5, ..PerturbationRange::default() };
        let error = crate::schema::check(&range).expect_err("refused").to_string();
        assert_eq!(error, "friction is 1.5; allowed: 0 to 0.9");
    }
}
