//! Several trials per evaluation, all but the first perturbed, which rewards robust gaits.

use super::PerturbationRange;
use crate::schema::{
    Section, SettingGroup, Walk, choice, choices, is_default, setting_group, settings, whole,
};

setting_group! {
    /// Number of trials per evaluation, and how they differ.
    pub struct Repeats {
        /// Trials per evaluation. The first is the nominal one, the others are perturbed.
        trials: u32 = 1;
        /// Fitness of the evaluation, made from those of its trials.
        counts: RepeatAggregate = RepeatAggregate::Mean;
        /// Where the perturbations come from.
        #[serde(default, skip_serializing_if = "is_default")]
        list: PerturbationList = PerturbationList::Own;
        /// Number of varied trials on which a run chooses its champion; 0: it chooses by the fitness alone. Not part of
        /// an evaluation.
        #[serde(default, skip_serializing_if = "is_default")]
        champion_trials: u32 = 0;
        /// Maximum perturbation of the other trials.
        off: PerturbationRange = PerturbationRange::default();
    }
}

choices! {
    /// How the fitness of an evaluation is made from those of its trials.
    pub enum RepeatAggregate {
        Mean = "mean", "Mean", "All trials count equally.";
        Worst = "worst", "Worst", "A snake is as good as its worst trial.";
    }
}

choices! {
    /// Where the perturbations of the repeated trials come from.
    #[derive(Default)]
    pub enum PerturbationList {
        #[default]
        Own = "own", "Own of each snake",
            "Each snake has perturbations of its own, so none can adapt to a few fixed ones.";
        Fixed = "fixed", "The same for all",
            "All snakes of all generations have the same list, which compares them fairly.";
    }
}

impl SettingGroup for Repeats {
    fn walk(&mut self, walk: &mut Walk<'_>) {
        let Self { trials, counts, list, champion_trials, off } = self;
        walk.section(Section {
            title: "Repeated trials",
            about: "Several slightly different trials per snake favour robust motion.",
        });
        settings! { walk,
            // A hundred trials of 15 s are a second and a half.
            trials: whole("Trials per snake", 1..=100)
                .hint("The first is exact, the others vary by the values below. Each trial takes additional time")
                .slider(1.0, 10.0);
            counts: choice("Combined score")
                .hint("How the results of the trials are combined");
            list: choice("Variations").advanced()
                .hint("Whether each snake has variations of its own, or all have the same");
            champion_trials: whole("Trials that choose the champion", 0..=100).advanced()
                .hint(
                    "Varied trials, the same for all, on which the two best snakes of each generation are compared. With 0, \
                     the champion is the snake with the greatest fitness. Each trial takes additional time",
                )
                .slider(0.0, 20.0);
        }
        walk.group("off", off);
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
