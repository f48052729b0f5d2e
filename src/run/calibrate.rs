//! Searches for what the report left free, so that its protocol learns as it says.
//!
//! What the report states stays as it is: population, parents, mutation range and halving, torque range
//! and step, limit lists, the stairs, the start. What it leaves free is in [`knobs`]. A candidate runs
//! the whole protocol with several seeds; the search starts from the settings it is given and draws
//! candidates near the best that it has, now and then from anywhere. Test what it finds with other seeds: `snakes table1`.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::table1::{REPORT_MEANS, SeedResult, run_seed};
use super::{Cancelled, Experiment, GenerationReport};
use crate::check::Invalid;
use crate::evolve::{RunPlan, Settings, with_field};
use crate::rng::{Purpose, stream};

/// A setting that the search may turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Knob {
    /// The setting's name, as `--set` takes it.
    pub field: &'static str,
    /// Least value.
    pub least: f32,
    /// Greatest value.
    pub most: f32,
}

/// What the report leaves free, each with the range that is searched. The density is a range of its
/// own, `density` to `density` times `spread`, so it is two knobs here.
const KNOBS: [Knob; 9] = [
    Knob { field: "trial.duration_s", least: 2.0, most: 12.0 },
    Knob { field: "genome.points_per_s", least: 1.0, most: 60.0 },
    Knob { field: DENSITY, least: 0.3, most: 10.0 },
    Knob { field: DENSITY_SPREAD, least: 1.0, most: 2.0 },
    Knob { field: "agent.joint_damping_nms_per_rad", least: 5.0, most: 500.0 },
    Knob { field: "agent.angular_damping_per_s", least: 1.0, most: 1000.0 },
    Knob { field: "surface.friction", least: 0.2, most: 8.0 },
    Knob { field: "surface.bounce", least: 0.0, most: 0.8 },
    Knob { field: "surface.dampen_per_s", least: 0.0, most: 3.0 },
];
const DENSITY: &str = "density";
const DENSITY_SPREAD: &str = "density spread";

/// What the search may turn, and within which range.
pub fn knobs() -> &'static [Knob] {
    &KNOBS
}

/// A point of the search, and how it did.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// The values of the knobs, in the order of [`knobs`].
    pub values: Vec<f32>,
    /// The settings with these values.
    pub settings: Settings,
    /// One result per seed. A hopeless candidate is given up before its last seed.
    pub seeds: Vec<SeedResult>,
    /// How good it is: larger is better. See [`score`].
    pub score: f64,
}

/// The search.
pub struct Calibration {
    base: Settings,
    seed: u64,
    tries: u32,
    best: Vec<Candidate>,
}

/// How many of the best candidates the search stays near.
const KEPT: usize = 6;
/// One candidate in so many is drawn from anywhere, the others near the best.
const EXPLORE_ONE_IN: u32 = 6;
/// A candidate near another differs in each knob by up to this share.
const STRIDE: f32 = 0.35;

impl Calibration {
    /// A search that starts from `base`, the first candidate, and draws its numbers from `seed`.
    pub fn new(base: Settings, seed: u64) -> Self {
        Self { base, seed, tries: 0, best: Vec::new() }
    }

    /// The best candidate so far.
    pub fn best(&self) -> Option<&Candidate> {
        self.best.first()
    }

    /// The next point to try: the base first.
    ///
    /// # Errors
    /// The base is such that a knob within its range is not allowed.
    pub fn next_point(&mut self) -> Result<(Vec<f32>, Settings), Invalid> {
        let mut rng = stream(self.seed, 0, self.tries, Purpose::Calibration);
        self.tries += 1;
        let values = if self.tries == 1 {
            self.base_values()
        } else if self.best.is_empty() || rng.random_range(0..EXPLORE_ONE_IN) == 0 {
            KNOBS.iter().map(|knob| knob.anywhere(&mut rng)).collect()
        } else {
            let parent = &self.best[rng.random_range(0..self.best.len())].values;
            let pairs = KNOBS.iter().zip(parent);
            pairs.map(|(knob, &value)| knob.near(value, &mut rng)).collect()
        };
        let settings = self.with_values(&values)?;
        Ok((values, settings))
    }

    /// Takes a result in. Returns its place among the best, the first being 0.
    pub fn take_in(&mut self, candidate: Candidate) -> Option<usize> {
        let place = self.best.partition_point(|better| better.score >= candidate.score);
        if place == KEPT {
            return None;
        }
        self.best.insert(place, candidate);
        self.best.truncate(KEPT);
        Some(place)
    }

    /// The score below which a candidate is not worth another seed.
    pub fn hopeless_below(&self) -> f64 {
        self.best.first().map_or(f64::MIN, |best| best.score - GIVE_UP_MARGIN)
    }

    fn base_values(&self) -> Vec<f32> {
        let (trial, genome) = (&self.base.trial, &self.base.genome);
        vec![
            trial.duration_s,
            genome.points_per_s,
            genome.density_min_kg_m3,
            genome.density_max_kg_m3 / genome.density_min_kg_m3,
            trial.agent.joint_damping_nms_per_rad.at(0),
            trial.agent.angular_damping_per_s,
            trial.surface.friction,
            trial.surface.bounce,
            trial.surface.dampen_per_s,
        ]
    }

    fn with_values(&self, values: &[f32]) -> Result<Settings, Invalid> {
        let mut settings = self.base.clone();
        let mut density = (settings.genome.density_min_kg_m3, 1.0);
        for (knob, &value) in KNOBS.iter().zip(values) {
            match knob.field {
                DENSITY => density.0 = value,
                DENSITY_SPREAD => density.1 = value,
                field => settings = with_field(&settings, field, &value.to_string())?,
            }
        }
        settings.genome.density_min_kg_m3 = density.0;
        settings.genome.density_max_kg_m3 = density.0 * density.1;
        settings.check()?;
        Ok(settings)
    }
}

/// One seed differs from the next by some metres; a candidate this far behind will not catch up.
const GIVE_UP_MARGIN: f64 = 3.0;

/// How good a candidate is: the mean over its seeds of the last generation's mean, where a seed counts
/// for no more than a little above the report (a good seed must not buy a bad one out), less half a
/// metre for each generation in which the mean fell.
pub fn score(seeds: &[SeedResult]) -> f64 {
    const ENOUGH_M: f64 = REPORT_MEANS[REPORT_MEANS.len() - 1] + 2.0;
    const FALL_COSTS_M: f64 = 0.5;
    let one = |seed: &SeedResult| {
        let means: Vec<f64> = seed.means.iter().map(|mean| mean.unwrap_or(-100.0)).collect();
        let falls = means.windows(2).filter(|pair| pair[1] <= pair[0]).count() as f64;
        means.last().copied().unwrap_or(-100.0).min(ENOUGH_M) - falls * FALL_COSTS_M
    };
    seeds.iter().map(one).sum::<f64>() / seeds.len().max(1) as f64
}

impl Knob {
    /// Anywhere in its range; evenly by ratio where the range does not begin at 0.
    fn anywhere(self, rng: &mut ChaCha8Rng) -> f32 {
        if self.least > 0.0 {
            let logarithm = rng.random_range(libm::logf(self.least)..=libm::logf(self.most));
            self.rounded(libm::expf(logarithm))
        } else if rng.random_range(0..2) == 0 {
            0.0
        } else {
            self.rounded(rng.random_range(self.least..=self.most))
        }
    }

    /// Near a value.
    fn near(self, value: f32, rng: &mut ChaCha8Rng) -> f32 {
        self.rounded(value * libm::expf(rng.random_range(-STRIDE..=STRIDE)))
    }

    /// Three digits are enough to write into a preset.
    fn rounded(self, value: f32) -> f32 {
        let unit = if value >= 100.0 {
            1.0
        } else if value >= 10.0 {
            10.0
        } else {
            100.0
        };
        (libm::roundf(value * unit) / unit).clamp(self.least, self.most)
    }
}

/// Runs the protocol with a candidate's settings and the given seeds, giving up when it is hopeless.
///
/// # Errors
/// [`Cancelled`], if `run` was.
pub fn try_candidate(
    (values, settings): (Vec<f32>, Settings),
    seeds: std::ops::RangeInclusive<u64>,
    hopeless_below: f64,
    mut run: impl FnMut(&mut Experiment) -> Result<GenerationReport, Cancelled>,
) -> Result<Candidate, Cancelled> {
    let mut results = Vec::new();
    for seed in seeds {
        let plan = RunPlan::new("calibration", seed, settings.clone());
        results.push(run_seed(plan, &mut run)?);
        if score(&results) < hopeless_below {
            break;
        }
    }
    Ok(Candidate { score: score(&results), values, settings, seeds: results })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn candidate(score: f64) -> Candidate {
        let settings = Settings::default();
        Candidate { values: vec![1.0; KNOBS.len()], settings, seeds: Vec::new(), score }
    }

    #[test]
    fn every_candidate_is_allowed_and_keeps_what_the_report_states() {
        let base = Settings::default();
        let mut search = Calibration::new(base.clone(), 1);
        for _ in 0..100 {
            let (values, settings) = search.next_point().expect("allowed");
            search.take_in(Candidate { values, settings: settings.clone(), ..candidate(0.0) });
            assert_eq!(settings.evolution, base.evolution);
            assert_eq!(settings.trial.stairs, base.trial.stairs);
            assert_eq!(settings.trial.start_y_m, base.trial.start_y_m);
            assert_eq!(settings.genome.torque_range_nm, base.genome.torque_range_nm);
            assert_eq!(settings.genome.torque_step_nm, base.genome.torque_step_nm);
            assert_eq!(settings.genome.bend_limits_rad, base.genome.bend_limits_rad);
            assert_eq!(settings.genome.twist_limits_rad, base.genome.twist_limits_rad);
        }
    }

    #[test]
    fn the_base_is_tried_first_and_the_best_are_kept_in_order() {
        let base = Settings::default();
        let mut search = Calibration::new(base.clone(), 1);
        assert_eq!(search.next_point().expect("allowed").1, base);
        for score in [1.0, 3.0, 2.0, 0.0, 5.0, 4.0] {
            search.take_in(candidate(score));
        }
        assert_eq!(search.take_in(candidate(-1.0)), None);
        assert_eq!(search.take_in(candidate(6.0)), Some(0));
        let scores: Vec<f64> = search.best.iter().map(|candidate| candidate.score).collect();
        assert_eq!(scores, [6.0, 5.0, 4.0, 3.0, 2.0, 1.0]);
    }

    #[test]
    fn a_seed_that_falls_or_fails_costs_what_it_should() {
        let seed = |means: &[f64]| SeedResult {
            seed: 1,
            means: means.iter().copied().map(Some).collect(),
            disqualified: Vec::new(),
            run_hash: 0,
        };
        assert_eq!(score(&[seed(&[-7.0, 2.0, 8.0])]), 8.0);
        assert_eq!(score(&[seed(&[-7.0, 9.0, 8.0])]), 7.5);
        let good_and_bad = [seed(&[-7.0, 2.0, 20.0]), seed(&[-7.0, 0.0, 0.95])];
        assert_eq!(score(&good_and_bad), 5.5);
    }
}
