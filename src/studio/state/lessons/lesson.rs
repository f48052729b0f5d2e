//! The parts of a lesson: texts, scenes, and the scenes' lanes or runs.

use super::prediction::{Asks, Question};
use snakes_core::genome::BodyChange;

/// A guided experiment.
#[derive(Debug)]
pub(crate) struct Lesson {
    /// Title of the lesson.
    pub title: &'static str,
    /// Question that the lesson answers.
    pub question: &'static str,
    /// Experience with the question in the report's experiment.
    pub story: &'static str,
    /// Instruction to the reader.
    pub to_try: &'static str,
    /// Observation that the reader should make.
    pub look_for: &'static str,
    /// Conclusion from all experiments of the lesson. The result of a single experiment is in its question.
    pub conclusion: &'static str,
    /// Scenes of the lesson. The first is shown at once.
    pub scenes: &'static [LessonScene],
    /// Text of the lesson's worksheet, as Markdown.
    pub worksheet: &'static str,
}

/// Scene of a lesson.
#[derive(Debug)]
pub(crate) struct LessonScene {
    /// Label of the scene's button.
    pub label: &'static str,
    /// Kind of the sides of the scene.
    pub shows: Shows,
    /// Question that the reader answers by a guess before the experiment; `None` if the scene is no experiment.
    pub question: Option<Question>,
    /// Lanes or runs to compare.
    pub sides: &'static [Side],
}

/// Kind of the sides of a scene: snakes that race, or runs that evolve.
#[derive(Debug)]
pub(crate) enum Shows {
    /// The built-in champion of this name in several worlds or bodies, one per lane.
    Champion(&'static str),
    /// Small runs, whose best snakes race afterwards.
    Runs(CommonPlan),
}

/// Preset, seed and settings that all runs of a scene share.
#[derive(Debug)]
pub(crate) struct CommonPlan {
    /// Name of the preset.
    pub preset: &'static str,
    /// Seed of the runs.
    pub seed: u64,
    /// Settings that differ from the preset in all runs.
    pub changes: SideChanges,
}

/// A lane or run that a scene compares with others.
#[derive(Debug, Clone)]
pub(crate) struct Side {
    /// Label of the lane or run.
    pub name: &'static str,
    /// Settings that differ from those of the champion, or from those that all runs of the scene have.
    pub changes: SideChanges,
    /// Change of the champion's body, with the index of the block at which it is made. The gait is not changed.
    pub body_change: Option<(BodyChange, usize)>,
    /// Number of worker threads of the run.
    pub threads: usize,
}

/// Names of changed settings, with their values as text.
type SideChanges = &'static [(&'static str, &'static str)];

/// Creates a lane, or a run that computes one snake at a time.
pub(super) const fn side(name: &'static str, changes: SideChanges) -> Side {
    Side { name, changes, body_change: None, threads: 1 }
}

/// Creates a lane with the champion's gait in a changed body.
pub(super) const fn lane_of_body(name: &'static str, change: BodyChange, block: usize) -> Side {
    Side { body_change: Some((change, block)), ..side(name, &[]) }
}

/// Returns the runs of a preset with this seed and these changed settings.
pub(super) const fn runs_of(preset: &'static str, seed: u64, changes: SideChanges) -> Shows {
    Shows::Runs(CommonPlan { preset, seed, changes })
}

/// Scene with the champion alone, without changes.
pub(super) const AS_FOUND: LessonScene = LessonScene {
    label: "A built-in champion",
    shows: Shows::Champion("climber"),
    question: None,
    sides: &[side("original", &[])],
};

pub(super) const fn furthest(finding: &'static str) -> Option<Question> {
    Some(Question { text: "Which snake gets furthest?", asks: Asks::Furthest, finding })
}

pub(super) const fn best_run(finding: &'static str) -> Option<Question> {
    Some(Question { text: "Which run's best snake gets further?", asks: Asks::BestRun, finding })
}

pub(super) const fn same_hash(finding: &'static str) -> Option<Question> {
    Some(Question {
        text: "Will both runs have the same hash (fingerprint of all results)?",
        asks: Asks::SameHash,
        finding,
    })
}
