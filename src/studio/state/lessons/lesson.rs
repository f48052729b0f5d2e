//! The parts of a lesson: texts, scenes, and their lanes or runs.

use super::prediction::{Asks, Question};
use snakes_core::genome::BodyChange;

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
        /// Preset of the runs.
        preset: &'static str,
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
    /// Change of the champion's body, whose gait stays as it is, with the index of the block that it concerns.
    pub body_change: Option<(BodyChange, usize)>,
    /// Seed of the run.
    pub seed: u64,
    /// Worker threads of the run.
    pub threads: usize,
}

pub(super) const fn lane(
    name: &'static str,
    changes: &'static [(&'static str, &'static str)],
) -> Side {
    Side { name, changes, body_change: None, seed: 1, threads: 1 }
}

/// A lane with the champion's gait in a changed body.
pub(super) const fn lane_of_body(name: &'static str, change: BodyChange, block: usize) -> Side {
    Side { name, changes: &[], body_change: Some((change, block)), seed: 1, threads: 1 }
}

pub(super) const fn run(
    name: &'static str,
    seed: u64,
    threads: usize,
    changes: &'static [(&'static str, &'static str)],
) -> Side {
    Side { name, changes, body_change: None, seed, threads }
}

/// The champion alone, without changes.
pub(super) const AS_FOUND: LessonScene = LessonScene::Lanes {
    label: "The original champion",
    champion: "climber",
    question: None,
    lanes: &[lane("original", &[])],
};

pub(super) const fn furthest(finding: &'static str) -> Question {
    Question { text: "Which snake gets furthest?", asks: Asks::Furthest, finding }
}

pub(super) const fn best_run(finding: &'static str) -> Question {
    Question { text: "Which run's best snake gets further?", asks: Asks::BestRun, finding }
}

pub(super) const fn same_hash(finding: &'static str) -> Question {
    Question { text: "Will both runs have the same hash?", asks: Asks::SameHash, finding }
}

pub(super) const fn later_bodies(finding: &'static str) -> Question {
    let text = "In which run does the body of the best snake change more often in the second half?";
    Question { text, asks: Asks::LateBodyChanges, finding }
}
