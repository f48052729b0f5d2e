//! Several trials per evaluation, all but the first perturbed, which rewards robust gaits.

use serde::{Deserialize, Serialize};

use super::PerturbationRange;
use crate::schema::{Choice, Choices, Section, SettingGroup, Walk, choice, whole};

/// Number of trials per evaluation, and how they differ.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Repeats {
    /// Trials per evaluation. The first is the nominal one, the others are perturbed.
    pub trials: u32,
    /// Fitness of the evaluation, made from those of its trials.
    pub counts: RepeatAggregate,
    /// Maximum perturbation of the other trials.
    pub off: PerturbationRange,
}

/// How the fitness of an evaluation is made from those of its trials.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RepeatAggregate {
    /// Their mean.
    #[default]
    Mean,
    /// The lowest of them.
    Worst,
}

impl Default for Repeats {
    fn default() -> Self {
        Self { trials: 1, counts: RepeatAggregate::Mean, off: PerturbationRange::default() }
    }
}

impl Repeats {
    /// The section of these settings.
    pub const SECTION: Section = Section {
        title: "Repeated trials",
        about: "Several slightly different trials per snake favour robust motion.",
    };
}

impl SettingGroup for Repeats {
    fn walk(&mut self, walk: &mut Walk<'_>) {
        let Self { trials, counts, off } = self;
        walk.section(Self::SECTION);
        // A hundred trials of 15 s are a second and a half.
        walk.setting(
            whole("trials", "Trials per snake", 1..=100)
                .hint("The first is exact, the others vary by the values below. Each trial takes additional time")
                .slider(1.0, 10.0),
            trials,
        );
        walk.setting(
            choice("counts", "Combined score").hint("How the results of the trials are combined"),
            counts,
        );
        walk.group("off", off);
    }
}

impl Choices for RepeatAggregate {
    const OPTIONS: &'static [Self] = &[Self::Mean, Self::Worst];

    fn choice(self) -> Choice {
        match self {
            Self::Mean => Choice::new("mean", "Mean", "All trials count equally."),
            Self::Worst => Choice::new("worst", "Worst", "A snake is as good as its worst trial."),
        }
    }
}

impl RepeatAggregate {
    /// The fitness of an evaluation whose trials have these fitnesses.
    pub(super) fn of(self, fitnesses: &[f32]) -> f32 {
        match self {
            Self::Mean => {
                let sum: f64 = fitnesses.iter().copied().map(f64::from).sum();
                (sum / fitnesses.len().max(1) as f64) as f32
            }
            Self::Worst => fitnesses.iter().copied().fold(f32::MAX, f32::min),
        }
    }
}
