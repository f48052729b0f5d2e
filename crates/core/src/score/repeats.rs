//! Several trials per evaluation. All but the first are perturbed, which rewards robust gaits.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::PerturbationRange;
use crate::check::{Invalid, within};
use crate::rng::{Purpose, stream};
use crate::schema::{
    Section, SettingGroup, Walk, choice, choices, is_default, setting_group, settings, whole,
};

setting_group! {
    /// Number of trials per evaluation, and how they differ.
    pub struct Repeats {
        /// Number of trials per evaluation. The first trial is the nominal one, the others are perturbed.
        trials: u32 = 1;
        /// How the fitness of the evaluation is made from those of its trials.
        counts: RepeatAggregate = RepeatAggregate::Mean;
        /// Source of the perturbations.
        #[serde(default, skip_serializing_if = "is_default")]
        list: PerturbationList = PerturbationList::Own;
        /// Number of varied trials by which a run chooses its champion; with 0, it chooses by the fitness alone. These trials are not a
        /// part of an evaluation.
        #[serde(default, skip_serializing_if = "is_default")]
        champion_trials: u32 = 0;
        /// Maximum perturbation of the trials after the first.
        off: PerturbationRange = PerturbationRange::default();
        /// Number of the list of a generation's perturbations, which its run draws; 0 for all other lists. Users do not set it: a
        /// champion's file contains the number of its generation.
        #[serde(default, skip_serializing_if = "is_default")]
        list_number: u32 = 0;
    }
}

choices! {
    /// The rule by which the fitness of an evaluation is made from those of its trials.
    pub enum RepeatAggregate {
        Mean = "mean", "Mean", "All trials count equally.";
        Worst = "worst", "Worst", "A snake is as good as its worst trial.";
    }
}

choices! {
    /// The source of the perturbations of the repeated trials.
    #[derive(Default)]
    pub enum PerturbationList {
        #[default]
        Own = "own", "Different for each snake",
            "Each snake has variations of its own, so none can adapt to a few fixed ones.";
        Fixed = "fixed", "The same for all",
            "All snakes of all generations have the same list, which compares them fairly.";
        Generation = "generation", "New in each generation",
            "All snakes of a generation have the same list, and each generation has another one, so none can be learned by heart.";
    }
}

impl SettingGroup for Repeats {
    fn walk(&mut self, walk: &mut Walk<'_>) {
        let Self { trials, counts, list, champion_trials, off, list_number: _ } = self;
        walk.section(Section {
            title: "Repeated trials",
            about: "Several slightly different trials per snake favour robust motion.",
        });
        settings! { walk,
            // The range ends at a hundred trials. With 15 s each, they take a second and a half.
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

    fn check_together(&self) -> Result<(), Invalid> {
        let is_drawn = self.list == PerturbationList::Generation;
        let most = if is_drawn { LARGEST_LIST_NUMBER } else { 0 };
        within("list_number", self.list_number, 0..=most)
    }
}

/// Greatest number of a list of perturbations.
const LARGEST_LIST_NUMBER: u32 = 0xff_ffff;

impl Repeats {
    /// Returns the repeats for a generation of a run with this seed.
    #[must_use]
    pub fn in_generation(&self, seed: u64, generation: u32) -> Self {
        let list_number = match self.list {
            PerturbationList::Generation => {
                stream(seed, generation, 0, Purpose::Stairs).random_range(1..=LARGEST_LIST_NUMBER)
            }
            PerturbationList::Own | PerturbationList::Fixed => 0,
        };
        Self { list_number, ..self.clone() }
    }

    /// Returns the stream of random numbers for perturbation number `number` of a genome with this hash.
    pub(super) fn stream(&self, genome_hash: u64, number: u32) -> ChaCha8Rng {
        match self.list {
            PerturbationList::Own => stream(genome_hash, 0, number, Purpose::Repeat),
            PerturbationList::Fixed => stream(0, 0, number, Purpose::Repeat),
            PerturbationList::Generation => {
                stream(u64::from(self.list_number), 0, number, Purpose::Stairs)
            }
        }
    }
}

impl RepeatAggregate {
    /// Computes the fitness of an evaluation from those of its trials.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::score::Trial;

    fn varied() -> Trial {
        let mut trial = Trial::default();
        trial.repeats.trials = 4;
        trial.repeats.list = PerturbationList::Generation;
        trial
    }

    #[test]
    fn each_generation_of_each_run_has_a_list_of_its_own() {
        let repeats = varied().repeats;
        let number = |seed, generation| repeats.in_generation(seed, generation).list_number;
        assert_eq!(number(1, 5), number(1, 5));
        assert!(number(1, 5) != number(1, 6) && number(1, 5) != number(2, 5));
        let fixed = Repeats { list: PerturbationList::Fixed, ..repeats };
        assert_eq!(fixed.in_generation(1, 5), fixed);
    }

    #[test]
    fn all_snakes_of_a_generation_have_the_same_perturbations() {
        let trial = varied();
        let draw = |generation: u32, hash: u64| {
            let repeats = trial.repeats.in_generation(1, generation);
            let draw = |number| {
                let mut rng = repeats.stream(hash, number);
                repeats.off.draw(trial.duration_s, trial.agent.limbs, &mut rng)
            };
            [1, 2, 3].map(draw)
        };
        assert_eq!(draw(1, 17), draw(1, 99));
        assert_ne!(draw(1, 17), draw(2, 17));
    }

    #[test]
    fn a_list_number_without_such_a_list_is_refused() {
        let mut trial = varied();
        trial.repeats.list_number = 77;
        trial.check().expect("that of a generation");
        trial.repeats.list = PerturbationList::Fixed;
        let error = trial.check().expect_err("refused").to_string();
        assert_eq!(error, "repeats.list_number is 77; allowed: 0 to 0");
    }
}
