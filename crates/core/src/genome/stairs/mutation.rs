//! Random changes of a staircase, for stairs that evolve.

use std::ops::RangeInclusive;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::genes::{
    NOISE_SEEDS, NOISES, NOSINGS_M, RISES_M, STEPS, StairsGenome, TREADS_M, WIDTHS_M,
};
use crate::rng::drawn;
use crate::schema::check;
use crate::world::Stairs;

/// Probability that the number of steps changes.
const STEPS_CHANGE: f64 = 0.2;
/// Probability that the seed of the irregularities changes.
const SEED_CHANGE: f64 = 0.1;
/// Probability of a change of each other number, except for features.
const NUMBER_CHANGE: f64 = 0.5;
/// Probability that a landing, a missing step, ramps or steps down are added, changed or removed.
const FEATURE_CHANGE: f64 = 0.15;
/// Number of attempts to draw a change that is allowed.
const ATTEMPTS: u32 = 50;

/// The size and the kinds of a staircase's mutation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StairsChange {
    /// Factor on the greatest step of each number.
    pub strength: u32,
    /// Greatest length of all treads together, in metres.
    pub longest_m: f32,
    /// Whether a landing, a missing step, ramps and steps down may be added, changed and removed.
    pub features: bool,
}

/// Strengths of a mutation, equally likely. With the least strength alone, a snake that climbs low stairs well would find all mutants too
/// easy.
const STRENGTHS: [u32; 4] = [1, 2, 4, 8];

impl StairsChange {
    /// Draws the strength of a change.
    pub fn drawn(longest_m: f32, features: bool, rng: &mut ChaCha8Rng) -> Self {
        Self { strength: drawn(&STRENGTHS, rng), longest_m, features }
    }
}

impl StairsGenome {
    /// Returns stairs with equal steps of this rise, in metres, and with the number of steps, the mean tread and the width of other
    /// stairs, as far as the ranges allow.
    pub fn like(stairs: &Stairs, rise_m: f32) -> Self {
        Self {
            steps: stairs.steps.clamp(*STEPS.start(), *STEPS.end()),
            rise_m,
            tread_m: stairs.mean_tread_m().clamp(*TREADS_M.start(), *TREADS_M.end()),
            width_m: stairs.width_m.clamp(*WIDTHS_M.start(), *WIDTHS_M.end()),
            ..Self::default()
        }
    }

    /// Returns a mutant. Each of its numbers changes with an even chance, by at most a step of 0.1 m of rise, 0.2 m of tread, 5 % of
    /// irregularity, 0.05 m of nosing and 0.25 m of width, times the strength. The staircase is unchanged if no attempt gives an allowed
    /// one.
    #[must_use]
    pub fn mutant(&self, change: &StairsChange, rng: &mut ChaCha8Rng) -> Self {
        for _ in 0..ATTEMPTS {
            let child = self.changed(change, rng);
            if child != *self && check(&child).is_ok() && child.length_m() <= change.longest_m {
                return child;
            }
        }
        *self
    }

    /// Returns the sum of the depths of all treads, in metres.
    pub fn length_m(&self) -> f32 {
        self.stairs().treads_m()
    }

    fn changed(&self, change: &StairsChange, rng: &mut ChaCha8Rng) -> Self {
        let mut child = *self;
        if rng.random_bool(STEPS_CHANGE) {
            let by = rng.random_range(1..=change.strength.max(1));
            child.steps =
                if rng.random_bool(0.5) { self.steps + by } else { self.steps.saturating_sub(by) };
        }
        let strength = change.strength as f32;
        let mut vary = |value: &mut f32, step: f32, range: RangeInclusive<f32>| {
            if rng.random_bool(NUMBER_CHANGE) {
                let by = rng.random_range(-1.0_f32..=1.0) * step * strength;
                *value = (*value + by).clamp(*range.start(), *range.end());
            }
        };
        vary(&mut child.rise_m, 0.1, RISES_M);
        vary(&mut child.tread_m, 0.2, TREADS_M);
        vary(&mut child.rise_noise, 0.05, NOISES);
        vary(&mut child.tread_noise, 0.05, NOISES);
        vary(&mut child.nosing_m, 0.05, NOSINGS_M);
        vary(&mut child.width_m, 0.25, WIDTHS_M);
        if rng.random_bool(SEED_CHANGE) {
            child.noise_seed = rng.random_range(NOISE_SEEDS);
        }
        if change.features && rng.random_bool(FEATURE_CHANGE) {
            let step = rng.random_range(1..=child.steps.max(1));
            match drawn(&[0, 1, 2, 3], rng) {
                0 => child.landing = if self.landing > 0 { 0 } else { step },
                1 => child.missing = if self.missing > 0 { 0 } else { step },
                2 if rng.random_bool(0.5) => child.ramp = 0.0,
                2 => child.ramp = rng.random_range(0.0..=1.0),
                _ if rng.random_bool(0.5) => child.down = self.down.saturating_sub(1),
                _ => child.down = self.down + 1,
            }
        }
        child
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::{Purpose, stream};

    fn change(strength: u32, features: bool) -> StairsChange {
        StairsChange { strength, longest_m: 20.0, features }
    }

    #[test]
    fn mutants_are_allowed_fit_in_the_length_and_reach_all_features() {
        let mut rng = stream(1, 0, 0, Purpose::Study);
        let mut genome = StairsGenome { rise_m: 0.1, ..StairsGenome::default() };
        let (mut landings, mut missing, mut ramps, mut down, mut highest_m) = (0, 0, 0, 0, 0.0_f32);
        for _ in 0..3000 {
            let child = genome.mutant(&change(1, true), &mut rng);
            check(&child).expect("allowed");
            check(&child.stairs()).expect("can be built");
            assert!(child.length_m() <= 20.0);
            assert!((child.rise_m - genome.rise_m).abs() <= 0.1001);
            landings += u32::from(child.landing > 0);
            missing += u32::from(child.missing > 0);
            ramps += u32::from(child.ramp > 0.0);
            down += u32::from(child.down > 0);
            highest_m = highest_m.max(child.rise_m);
            genome = child;
        }
        assert!([landings, missing, ramps, down].iter().all(|&count| count > 100));
        assert!(highest_m > 1.0, "{highest_m}");
    }

    #[test]
    fn without_features_steps_stay_steps() {
        let mut rng = stream(2, 0, 0, Purpose::Study);
        let mut genome = StairsGenome::default();
        for _ in 0..500 {
            genome = genome.mutant(&change(4, false), &mut rng);
        }
        let StairsGenome { landing, missing, down, ramp, .. } = genome;
        assert_eq!((landing, missing, down, ramp), (0, 0, 0, 0.0));
    }
}
