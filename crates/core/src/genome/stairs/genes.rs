//! The numbers from which a staircase is built.

use std::fmt;
use std::ops::RangeInclusive;

use rand::RngExt;

use crate::check::{Invalid, within};
use crate::rng::{Purpose, stream};
use crate::schema::{PerPart, number, setting_group, whole};
use crate::world::Stairs;

setting_group! {
    /// The numbers from which a staircase is built. Rise and tread are those of the mean step. A staircase without irregularities and
    /// features has equal steps.
    #[derive(Copy)]
    pub struct StairsGenome {
        /// Number of steps.
        steps: u32 = 10,
            whole("Steps", STEPS).hint("Number of steps");
        /// Mean height of a step over the one below it, in metres.
        rise_m: f32 = 0.5,
            number("Rise", RISES_M).unit("m").hint("Mean height of a step over the one below it");
        /// Mean depth of a step, in metres.
        tread_m: f32 = 2.0,
            number("Tread", TREADS_M).unit("m").hint("Mean depth of a step");
        /// Greatest relative deviation of a rise from the mean.
        rise_noise: f32 = 0.0,
            number("Irregular rises", NOISES).hint("Greatest relative deviation of a rise from the mean");
        /// Greatest relative deviation of a tread from the mean.
        tread_noise: f32 = 0.0,
            number("Irregular treads", NOISES).hint("Greatest relative deviation of a tread from the mean");
        /// Seed of the deviations from the mean step.
        noise_seed: u32 = 0,
            whole("Seed of the irregularities", NOISE_SEEDS).hint("Another seed gives other deviations");
        /// How far each tread overhangs its riser, in metres; at most half of the shallowest flat tread.
        nosing_m: f32 = 0.0,
            number("Nosing", NOSINGS_M).unit("m").hint("How far each tread overhangs its riser");
        /// Width of the stairs, in metres.
        width_m: f32 = 5.0,
            number("Width", WIDTHS_M).unit("m").hint("Width of the stairs");
        /// Share of each tread, from 0 to 1, that is a ramp leading up to it; 0 makes vertical risers.
        ramp: f32 = 0.0,
            number("Ramp", 0.0..=1.0).hint("How much of each tread is a ramp that leads up to it");
        /// Number of the step whose tread is an intermediate landing of [`LANDING_M`] or more; the lowest step is 1, and 0 means no
        /// landing.
        landing: u32 = 0,
            whole("Landing", 0..=20).hint("Number of the step that is a landing on the way; 0 for none");
        /// Number of the missing step: from the second step to the last but one of those that lead up; 0 means none.
        missing: u32 = 0,
            whole("Missing step", 0..=19).hint("Number of the step that is missing; 0 for none");
        /// Number of steps at the end that lead down: at most half of all steps.
        down: u32 = 0,
            whole("Steps down", 0..=10).hint("Number of the last steps, which lead down");
    }

    fn check_together(&self) -> Result<(), Invalid> {
        within("down", self.down, 0..=self.steps / 2)?;
        let up = self.steps - self.down;
        within("landing", self.landing, 0..=self.steps)?;
        // The first step cannot be missing, because this would only make one step less.
        match self.missing {
            0 => Ok(()),
            missing if (2..up).contains(&missing) => Ok(()),
            missing if up < 3 => {
                Err(Invalid::new("missing", missing, "0 with fewer than three steps up"))
            }
            missing => Err(Invalid::new("missing", missing, format!("0, or 2 to {}", up - 1))),
        }
    }
}

/// Range of the number of steps.
pub(super) const STEPS: RangeInclusive<u32> = 3..=20;
/// Range of the mean height of steps, in metres.
pub(super) const RISES_M: RangeInclusive<f32> = 0.1..=1.2;
/// Range of the mean depth of steps, in metres.
pub(super) const TREADS_M: RangeInclusive<f32> = 0.6..=3.0;
/// Range of the relative deviations from the mean.
pub(super) const NOISES: RangeInclusive<f32> = 0.0..=0.4;
/// Range of the seed of the deviations.
pub(super) const NOISE_SEEDS: RangeInclusive<u32> = 0..=0xff_ffff;
/// Range of the depth by which treads overhang their risers, in metres.
pub(super) const NOSINGS_M: RangeInclusive<f32> = 0.0..=0.3;
/// Range of the width of the stairs, in metres.
pub(super) const WIDTHS_M: RangeInclusive<f32> = 2.5..=6.0;

/// Least depth of an intermediate landing, in metres: half the length of the snake of five blocks.
pub const LANDING_M: f32 = 5.0;
/// Least difference in height between treads that follow one another, in metres.
const LEAST_RISE_M: f32 = 0.02;
/// Least depth of a flat tread behind a ramp, in metres.
const LEAST_FLAT_M: f32 = 0.1;

impl StairsGenome {
    /// Builds the staircase of these numbers, with the first riser and the landing of the default staircase.
    pub fn stairs(&self) -> Stairs {
        let plain = Stairs {
            steps: self.steps,
            rise_m: self.rise_m.into(),
            tread_m: self.tread_m.into(),
            width_m: self.width_m,
            ..Stairs::default()
        };
        let is_regular = self.rise_noise == 0.0 && self.tread_noise == 0.0;
        let has_features = self.landing > 0 || self.missing > 0 || self.down > 0;
        let mut stairs = if is_regular && !has_features { plain } else { self.uneven(plain) };
        let slope_m = |step: u32| {
            let flat_m = LEAST_FLAT_M.max(stairs.step_rise_m(step).abs() / 2.0);
            let leads_up = stairs.step_rise_m(step) > 0.0;
            if leads_up { self.ramp * (stairs.step_tread_m(step) - flat_m).max(0.0) } else { 0.0 }
        };
        if self.ramp > 0.0 {
            stairs.slope_m = PerPart::Each((0..self.steps).map(slope_m).collect());
            stairs = stairs.with_room_for_slopes();
        }
        let flat_m = |step| stairs.step_tread_m(step) - stairs.step_slope_m(step);
        let shallowest_m = (0..self.steps).map(flat_m).fold(f32::MAX, f32::min);
        stairs.nosing_m = self.nosing_m.min(shallowest_m / 2.0);
        stairs
    }

    fn uneven(&self, plain: Stairs) -> Stairs {
        let mut rng = stream(self.noise_seed.into(), 0, 0, Purpose::StairNoise);
        let mut varied = |mean: f32, noise: f32| {
            let deviation: f32 = rng.random_range(-1.0..=1.0);
            mean * (1.0 + noise * deviation)
        };
        let (mut rises_m, mut treads_m) = (Vec::new(), Vec::new());
        for _ in 0..self.steps {
            rises_m.push(varied(self.rise_m, self.rise_noise).max(LEAST_RISE_M));
            treads_m.push(varied(self.tread_m, self.tread_noise));
        }
        if let Some(tread_m) =
            self.landing.checked_sub(1).and_then(|at| treads_m.get_mut(at as usize))
        {
            *tread_m = tread_m.max(LANDING_M);
        }
        let first_down = (self.steps - self.down) as usize;
        let missing = (self.missing as usize).checked_sub(1);
        let mut height_m = 0.0;
        let mut owed_m = 0.0;
        for (step, rise_m) in rises_m.iter_mut().enumerate() {
            if step >= first_down {
                // Height is left for the steps that follow, because each of them leads down, too.
                let left_m = (self.steps as usize - 1 - step) as f32 * LEAST_RISE_M;
                *rise_m = -lowered_m(height_m - left_m, *rise_m);
            } else if Some(step) == missing {
                // The gap is one rise deep. Behind it the stairs continue as without a gap.
                let depth_m = lowered_m(height_m, self.rise_m);
                owed_m = depth_m + *rise_m;
                *rise_m = -depth_m;
            } else {
                *rise_m += owed_m;
                owed_m = 0.0;
            }
            height_m += *rise_m;
        }
        Stairs { rise_m: PerPart::Each(rises_m), tread_m: PerPart::Each(treads_m), ..plain }
    }
}

/// Writes the shape in a line: number of steps, rise and tread, then what makes them uneven.
impl fmt::Display for StairsGenome {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { steps, rise_m, tread_m, rise_noise, tread_noise, nosing_m, .. } = self;
        write!(formatter, "{steps} steps of {rise_m:.2} × {tread_m:.2} m")?;
        if *rise_noise > 0.0 {
            write!(formatter, ", rises ±{:.0} %", rise_noise * 100.0)?;
        }
        if *tread_noise > 0.0 {
            write!(formatter, ", treads ±{:.0} %", tread_noise * 100.0)?;
        }
        if *nosing_m > 0.0 {
            write!(formatter, ", nosing {nosing_m:.2} m")?;
        }
        if self.ramp > 0.0 {
            write!(formatter, ", ramps {:.0} %", self.ramp * 100.0)?;
        }
        if self.landing > 0 {
            write!(formatter, ", landing at step {}", self.landing)?;
        }
        if self.missing > 0 {
            write!(formatter, ", step {} missing", self.missing)?;
        }
        if self.down > 0 {
            write!(formatter, ", {} down", self.down)?;
        }
        Ok(())
    }
}

/// Returns how far a step leads down, in metres, from a height of which it should lead down by `rise_m`: down to the ground, if it would
/// otherwise end close to it.
fn lowered_m(height_m: f32, rise_m: f32) -> f32 {
    if height_m - rise_m < LEAST_RISE_M { height_m } else { rise_m }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schema::check;

    #[test]
    fn equal_steps_are_plain_stairs() {
        assert_eq!(StairsGenome::default().stairs(), Stairs::default());
    }

    #[test]
    fn every_staircase_that_can_be_drawn_is_allowed() {
        let mut rng = stream(1, 0, 0, Purpose::Study);
        for number in 0..2000 {
            let steps = rng.random_range(3..=20);
            let down = rng.random_range(0..=steps / 2);
            let mut draw = |from: f32, to: f32| rng.random_range(from..=to);
            let mut genome = StairsGenome {
                steps,
                down,
                rise_m: draw(0.1, 1.2),
                tread_m: draw(0.6, 3.0),
                rise_noise: draw(0.0, 0.4),
                tread_noise: draw(0.0, 0.4),
                noise_seed: number,
                nosing_m: draw(0.0, 0.3),
                width_m: draw(2.5, 6.0),
                ramp: draw(-0.5, 1.0).max(0.0),
                ..StairsGenome::default()
            };
            genome.landing = rng.random_range(0..=steps);
            if steps - down > 2 && number % 2 == 0 {
                genome.missing = rng.random_range(2..steps - down);
            }
            check(&genome).expect("drawn from the ranges");
            let stairs = genome.stairs();
            check(&stairs).unwrap_or_else(|error| panic!("{error} of {genome:?}: {stairs:?}"));
        }
    }

    #[test]
    fn irregular_steps_down_never_reach_the_ground_too_early() {
        for noise_seed in 0..500 {
            let genome = StairsGenome {
                steps: 20,
                down: 10,
                rise_noise: 0.4,
                noise_seed,
                ..StairsGenome::default()
            };
            let stairs = genome.stairs();
            check(&stairs).unwrap_or_else(|error| panic!("{error}: {stairs:?}"));
        }
    }

    #[test]
    fn the_shape_in_words_names_what_is_uneven() {
        assert_eq!(StairsGenome::default().to_string(), "10 steps of 0.50 × 2.00 m");
        let genome = StairsGenome { rise_noise: 0.2, down: 2, ramp: 0.5, ..Default::default() };
        let expected = "10 steps of 0.50 × 2.00 m, rises ±20 %, ramps 50 %, 2 down";
        assert_eq!(genome.to_string(), expected);
    }

    #[test]
    fn a_missing_step_is_a_gap_behind_which_the_stairs_go_on() {
        let stairs = StairsGenome { missing: 3, ..StairsGenome::default() }.stairs();
        let heights_m = [2, 3, 4, 5].map(|steps| stairs.height_m(steps));
        assert_eq!(heights_m, [1.0, 0.5, 2.0, 2.5]);
    }

    #[test]
    fn a_landing_is_deep_and_the_last_steps_lead_down() {
        let genome = StairsGenome { steps: 6, down: 3, landing: 3, ..StairsGenome::default() };
        let stairs = genome.stairs();
        assert_eq!([3, 4, 6].map(|steps| stairs.height_m(steps)), [1.5, 1.0, 0.0]);
        assert_eq!((stairs.step_tread_m(2), stairs.step_tread_m(3)), (LANDING_M, 2.0));
    }

    #[test]
    fn what_cannot_be_built_is_refused() {
        let refused = |genome: StairsGenome| check(&genome).expect_err("refused").to_string();
        let plain = StairsGenome::default;
        assert_eq!(refused(StairsGenome { steps: 0, ..plain() }), "steps is 0; allowed: 3 to 20");
        assert_eq!(refused(StairsGenome { down: 6, ..plain() }), "down is 6; allowed: 0 to 5");
        let missing = refused(StairsGenome { missing: 10, ..plain() });
        assert_eq!(missing, "missing is 10; allowed: 0, or 2 to 9");
        assert!(refused(StairsGenome { rise_m: f32::NAN, ..plain() }).starts_with("rise_m is NaN"));
    }
}
