//! Texts and scenes of the lessons. Tests in [`super`] check that the conclusions are true.

mod report;
mod senses;

use crate::evolve::{RunPlan, Settings, with_fields};
use crate::save::library::{SavePlace, load_entry};
use crate::save::load_preset;
use crate::studio::stage::staged_champion::StagedChampion;

use super::prediction::{Asks, Question};

/// A guided experiment.
#[derive(Debug)]
pub(crate) struct Lesson {
    /// Title.
    pub title: &'static str,
    /// Question that it answers.
    pub question: &'static str,
    /// Experience from the original experiment.
    pub story: &'static str,
    /// Instruction.
    pub to_try: &'static str,
    /// Observation to make.
    pub look_for: &'static str,
    /// Conclusion from all experiments together. What each of them shows is in its question.
    pub conclusion: &'static str,
    /// Scenes; the first is shown at once.
    pub scenes: &'static [LessonScene],
    /// Text of the worksheet, as Markdown.
    pub worksheet: &'static str,
}

/// Scene of a lesson.
#[derive(Debug)]
pub(crate) enum LessonScene {
    /// A champion in several worlds.
    Lanes {
        /// Label of its button.
        label: &'static str,
        /// Name of a built-in champion.
        champion: &'static str,
        /// Question to answer by a guess before the race.
        question: Option<Question>,
        /// Worlds, one per lane.
        lanes: &'static [Side],
    },
    /// Small runs whose best snakes race afterwards.
    Runs {
        /// Label of its button.
        label: &'static str,
        /// Question to answer by a guess before the runs.
        question: Question,
        /// Runs.
        runs: &'static [Side],
    },
}

impl LessonScene {
    /// Label of its button.
    pub fn label(&self) -> &'static str {
        match self {
            Self::Lanes { label, .. } | Self::Runs { label, .. } => label,
        }
    }

    /// Question to answer by a guess before its experiment.
    pub fn question(&self) -> Option<&Question> {
        match self {
            Self::Lanes { question, .. } => question.as_ref(),
            Self::Runs { question, .. } => Some(question),
        }
    }

    /// Its lanes or runs.
    pub fn sides(&self) -> &'static [Side] {
        match self {
            Self::Lanes { lanes, .. } => lanes,
            Self::Runs { runs, .. } => runs,
        }
    }
}

/// Lane or run that is compared with others.
#[derive(Debug, Clone)]
pub(crate) struct Side {
    /// Label.
    pub name: &'static str,
    /// Changed settings with their values.
    pub changes: &'static [(&'static str, &'static str)],
    /// Seed of the run.
    pub seed: u64,
    /// Worker threads of the run.
    pub threads: usize,
}

const fn lane(name: &'static str, changes: &'static [(&'static str, &'static str)]) -> Side {
    Side { name, changes, seed: 1, threads: 1 }
}

const fn run(
    name: &'static str,
    seed: u64,
    threads: usize,
    changes: &'static [(&'static str, &'static str)],
) -> Side {
    Side { name, changes, seed, threads }
}

/// The champion alone, without changes.
const AS_FOUND: LessonScene = LessonScene::Lanes {
    label: "The original champion",
    champion: "climber",
    question: None,
    lanes: &[lane("original", &[])],
};

const fn furthest(finding: &'static str) -> Question {
    Question { text: "Which snake gets furthest?", asks: Asks::Furthest, finding }
}

const fn best_run(finding: &'static str) -> Question {
    Question { text: "Which run's best snake gets further?", asks: Asks::BestRun, finding }
}

const fn same_hash(finding: &'static str) -> Question {
    Question { text: "Will both runs have the same hash?", asks: Asks::SameHash, finding }
}

/// Why a snake that ends further may not have more fitness.
pub(crate) const FITNESS_OF_THE_LANDED: &str = "Fitness is the distance, but it stops counting at 26.00 m, where the \
    whole snake is on the landing.";

/// All lessons. Only findings and conclusions may state a result: the other texts are read before the experiments.
pub(crate) const LESSONS: [Lesson; 7] = [
    report::FRICTION,
    report::FRAME_RATE,
    report::JOINT_LIMITS,
    report::MUTATIONS,
    report::REPETITION,
    senses::LEARNED_BY_HEART,
    senses::BLINDFOLD,
];

/// A built-in champion in each of these worlds.
pub(super) fn champions(
    champion: &'static str,
    lanes: &[Side],
) -> Result<Vec<StagedChampion>, String> {
    let place = SavePlace::Shipped(champion);
    let (loaded, _) = load_entry(&place).map_err(|error| error.to_string())?;
    let original = StagedChampion::from_lesson(&loaded.champion).named("original".to_owned());
    lanes
        .iter()
        .map(|Side { name, changes, .. }| {
            let settings = Settings { trial: original.trial().clone(), ..Settings::default() };
            let settings = with_fields(&settings, changes.iter().copied())
                .map_err(|error| error.to_string())?;
            let same = original.clone().named("The same snake".to_owned());
            let changed = same.in_world(&settings.trial, (*name).to_owned());
            let staged = if changed.is_changed() { changed } else { original.clone() };
            staged.check().map_err(|error| error.to_string())?;
            Ok(staged)
        })
        .collect()
}

/// Plan and thread count of a run: the preset "quick" with changes.
pub(super) fn plan(side: &Side) -> Result<(RunPlan, usize), String> {
    let preset = load_preset("quick").map_err(|error| error.to_string())?;
    let settings = with_fields(&preset.settings, side.changes.iter().copied())
        .map_err(|error| error.to_string())?;
    Ok((RunPlan::new(&preset.name, side.seed, settings), side.threads))
}
