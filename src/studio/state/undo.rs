//! The common history of undo and redo: changes of the next run's plan, and file operations of the library.
//!
//! Every command that changes the plan adds an [`UndoStep`]. If the mouse rests while a slider is dragged, the plan
//! changes several times. All changes of one setting between two presses of a mouse button or a key are one step.

mod follow;

use std::collections::VecDeque;

use bevy::prelude::*;

use crate::studio::commands::{Command, PlanCommand, RunCommand};
use crate::studio::schedule::FrameSet;
use snakes_core::evolve::{RunPlan, changes_in_words};
use snakes_core::save::library::FileStep;

pub(crate) use follow::followed;

/// Maximum number of steps in the history that can be undone.
const MAX_STEPS: usize = 200;

/// Subject of messages about changes that can be undone. The message about an undo replaces that about the change.
pub(crate) const UNDO_SUBJECT: &str = "undo";

/// Subject of the step that discards the changed lanes of a what-if.
const DISCARD: &str = "discard";

/// Subject of the step that resumes another run.
const CONTINUE: &str = "continue";

/// A step that can be undone or redone.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum UndoStep {
    /// A change of the next run's plan.
    Plan(PlanStep),
    /// A change of the library's files.
    Files {
        /// Description of the change in a few words: "deleted climber".
        label: String,
        /// File operations of the step, in the order in which they were executed.
        steps: Vec<FileStep>,
    },
}

impl UndoStep {
    /// Describes the change of the step in a few words.
    pub fn label(&self) -> &str {
        match self {
            Self::Plan(PlanStep { label, .. }) | Self::Files { label, .. } => label,
        }
    }
}

/// A change of the next run's plan.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PlanStep {
    /// Plan before the change.
    pub before: Box<RunPlan>,
    /// Plan after the change.
    pub after: Box<RunPlan>,
    /// Description of the change in a few words: "friction 0.5".
    pub label: String,
    /// Name of the changed setting. Further changes of this setting during one drag are added to the step.
    subject: String,
}

impl PlanStep {
    /// Returns the message after the step was undone or redone.
    pub fn message(&self, way: UndoDirection) -> String {
        if way == UndoDirection::Back && self.subject == DISCARD {
            return "Changes restored".to_owned();
        }
        way.taken(&self.label)
    }

    /// Returns whether the step resumed another run. Its settings are then no edit of the run in progress.
    pub fn is_of_another_run(&self) -> bool {
        self.subject == CONTINUE
    }
}

/// Direction through the history: undo or redo.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum UndoDirection {
    /// Back in time: undo.
    Back,
    /// Forward in time: redo.
    Forth,
}

impl UndoDirection {
    /// Returns the message after a step with this label was undone or redone.
    pub fn taken(self, label: &str) -> String {
        let done = if self == Self::Back { "Undone" } else { "Redone" };
        format!("{done}: {label}")
    }

    /// Returns the message if there is no step in this direction.
    pub fn nothing(self) -> &'static str {
        if self == Self::Back { "There is nothing to undo." } else { "There is nothing to redo." }
    }
}

/// The history: steps that can be undone, and steps that can be redone.
#[derive(Resource, Debug, Default)]
pub(crate) struct UndoHistory {
    /// Steps that can be undone, the latest last.
    done: VecDeque<UndoStep>,
    /// Steps that can be redone, the next one last.
    undone: Vec<UndoStep>,
    /// Whether the latest step is complete, so that a further change is a separate step.
    pub is_settled: bool,
    /// Whether a step has been added since the last one was taken, so that the taken step cannot be redone.
    is_overtaken: bool,
}

impl UndoHistory {
    /// Records the effect of a command on the next run's plan.
    pub fn note(&mut self, command: &Command, before: RunPlan, after: &RunPlan) {
        if before == *after {
            return;
        }
        let Some((subject, label)) = words_of(command, &before, after) else { return };
        let (before, after) = (Box::new(before), Box::new(after.clone()));
        self.push(UndoStep::Plan(PlanStep { before, after, label, subject }));
    }

    /// Adds a step. Steps that were undone before can then not be redone.
    pub fn push(&mut self, step: UndoStep) {
        self.undone.clear();
        self.is_overtaken = true;
        let is_open = !std::mem::take(&mut self.is_settled);
        match (self.done.back_mut(), step) {
            (Some(UndoStep::Plan(last)), UndoStep::Plan(step))
                if is_open && last.subject == step.subject =>
            {
                (last.after, last.label) = (step.after, step.label);
                // A drag that returns to its start is not a step.
                if last.before == last.after {
                    self.done.pop_back();
                }
            }
            (_, step) => self.done.push_back(step),
        }
        if self.done.len() > MAX_STEPS {
            self.done.pop_front();
        }
    }

    /// Removes and returns the next step in a direction. The caller executes it, and reports the result to [`Self::complete`].
    pub fn take(&mut self, way: UndoDirection) -> Option<UndoStep> {
        (self.is_settled, self.is_overtaken) = (true, false);
        match way {
            UndoDirection::Back => self.done.pop_back(),
            UndoDirection::Forth => self.undone.pop(),
        }
    }

    /// Records the result of a step that was taken: the part `done` can be reversed, the part `left` can be tried again.
    pub fn complete(&mut self, way: UndoDirection, done: Option<UndoStep>, left: Option<UndoStep>) {
        let (undoable, redoable) = match way {
            UndoDirection::Back => (left, done),
            UndoDirection::Forth => (done, left),
        };
        self.done.extend(undoable);
        self.undone.extend(redoable.filter(|_| !self.is_overtaken));
    }

    /// Restores the history from before a lesson, and adds the file operations that were made during the lesson.
    pub fn give_back(&mut self, own: Self) {
        let lesson = std::mem::replace(self, own);
        let is_of_files = |step: &UndoStep| matches!(step, UndoStep::Files { .. });
        self.done.extend(lesson.done.into_iter().filter(is_of_files));
        self.undone.extend(lesson.undone.into_iter().filter(is_of_files));
        self.is_settled = true;
    }

    /// Returns the label of the next step in a direction, if there is one.
    pub fn next(&self, way: UndoDirection) -> Option<&str> {
        match way {
            UndoDirection::Back => self.done.back(),
            UndoDirection::Forth => self.undone.last(),
        }
        .map(UndoStep::label)
    }
}

/// Returns the subject and the label of the change that a command made; `None` if the command is no edit.
fn words_of(command: &Command, before: &RunPlan, after: &RunPlan) -> Option<(String, String)> {
    let changes = || changes_in_words(&before.settings, &after.settings);
    let (subject, label) = match command {
        Command::Plan(command) => match command {
            PlanCommand::SetField { field, .. } => return Some((field.clone(), changes())),
            PlanCommand::SetFields(_) | PlanCommand::UseWorldOfLane => ("several", changes()),
            PlanCommand::SetSeed(seed) => ("seed", format!("seed {seed}")),
            PlanCommand::SetPreset(name) | PlanCommand::StorePreset(name) => {
                ("preset", format!("preset {name}"))
            }
            PlanCommand::KeepLane(_) => ("keep", format!("kept {}", changes())),
            PlanCommand::DropChange => (DISCARD, "discarded changes".to_owned()),
            PlanCommand::StartFrom(_) | PlanCommand::StartFromSave(_) => {
                let name = after.founder.as_ref().map_or("a champion", |founder| founder.name());
                ("founder", format!("start of the next run from {name}"))
            }
            PlanCommand::ForgetFounder => {
                ("founder", "start of the next run from scratch".to_owned())
            }
            PlanCommand::ListPresets | PlanCommand::StoreStairs(_) | PlanCommand::ListStairs => {
                return None;
            }
        },
        Command::Run(RunCommand::Continue(_)) => {
            let RunPlan { preset, seed, .. } = after;
            (CONTINUE, format!("settings taken from {preset}, seed {seed}"))
        }
        _ => return None,
    };
    Some((subject.to_owned(), label))
}

/// Applies a step from one plan to another to the present plan. The seed is kept unless the step changed it, because
/// each new run gets a new seed.
pub(crate) fn stepped(now: &RunPlan, from: &RunPlan, to: &RunPlan) -> RunPlan {
    let seed = if from.seed == to.seed { now.seed } else { to.seed };
    RunPlan { seed, ..to.clone() }
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<UndoHistory>()
        .add_systems(Update, settle_on_press.in_set(FrameSet::TakeIn));
}

/// Completes the latest step whenever a mouse button or a key is pressed.
fn settle_on_press(
    buttons: Res<ButtonInput<MouseButton>>,
    keys: Res<ButtonInput<KeyCode>>,
    mut history: ResMut<UndoHistory>,
) {
    if buttons.get_just_pressed().next().is_some() || keys.get_just_pressed().next().is_some() {
        history.is_settled = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use snakes_core::evolve::{Settings, with_field};

    fn of_files(label: &str) -> UndoStep {
        UndoStep::Files { label: label.to_owned(), steps: Vec::new() }
    }

    /// Takes the next step and completes it.
    fn step(history: &mut UndoHistory, way: UndoDirection) -> Option<UndoStep> {
        let step = history.take(way)?;
        history.complete(way, Some(step.clone()), None);
        Some(step)
    }

    #[test]
    fn after_a_lesson_its_file_operations_stay_and_its_plan_steps_do_not() {
        let mut history = changed();
        let own = std::mem::take(&mut history);
        assert_eq!(history.next(UndoDirection::Back), None);
        history.note(&set("0.3"), plan("0.5"), &plan("0.3"));
        history.push(of_files("deleted a"));
        history.give_back(own);
        assert_eq!(step(&mut history, UndoDirection::Back), Some(of_files("deleted a")));
        assert!(matches!(step(&mut history, UndoDirection::Back), Some(UndoStep::Plan(_))));
        assert_eq!(step(&mut history, UndoDirection::Back), None);
    }

    fn plan(friction: &str) -> RunPlan {
        let settings = with_field(&Settings::default(), "surface.friction", friction);
        RunPlan::new("report", 1, settings.expect("allowed"))
    }

    fn set(text: &str) -> Command {
        Command::Plan(PlanCommand::set("trial.surface.friction", text))
    }

    /// Returns a history in which the friction was changed from 1 to 0.5.
    fn changed() -> UndoHistory {
        let mut history = UndoHistory::default();
        history.note(&set("0.5"), plan("1"), &plan("0.5"));
        history
    }

    #[test]
    fn a_drag_that_ends_at_its_initial_value_is_no_step() {
        let mut history = UndoHistory::default();
        history.note(&set("0.8"), plan("1"), &plan("0.8"));
        history.note(&set("1"), plan("0.8"), &plan("1"));
        assert_eq!(history.next(UndoDirection::Back), None);
    }

    #[test]
    fn a_new_change_clears_the_redo_stack_and_a_change_without_effect_is_no_step() {
        let mut history = changed();
        step(&mut history, UndoDirection::Back);
        history.note(&set("1"), plan("1"), &plan("1"));
        assert!(history.next(UndoDirection::Forth).is_some(), "nothing was changed");
        history.note(&set("0.7"), plan("1"), &plan("0.7"));
        assert_eq!(history.next(UndoDirection::Forth), None);
    }

    #[test]
    fn the_number_of_steps_is_limited() {
        let mut history = UndoHistory::default();
        for number in 0..MAX_STEPS + 50 {
            let after = plan(&format!("{}", number + 2));
            history.note(&set(""), plan(&format!("{}", number + 1)), &after);
            history.is_settled = true;
        }
        let steps = std::iter::from_fn(|| step(&mut history, UndoDirection::Back)).count();
        assert_eq!(steps, MAX_STEPS);
    }

    #[test]
    fn a_step_that_did_not_change_the_seed_keeps_the_current_one() {
        let now = RunPlan { seed: 2, ..plan("0.5") };
        assert_eq!(stepped(&now, &plan("0.5"), &plan("1")).seed, 2);
        let other_seed = RunPlan { seed: 9, ..plan("1") };
        assert_eq!(stepped(&now, &plan("0.5"), &other_seed).seed, 9);
    }

    #[test]
    fn an_incomplete_undo_can_be_continued_and_redone() {
        let mut history = UndoHistory::default();
        history.push(of_files("renamed a"));
        history.push(of_files("deleted 300 saves"));
        let step = history.take(UndoDirection::Back);
        assert_eq!(history.next(UndoDirection::Back), Some("renamed a"));
        history.complete(UndoDirection::Back, step.clone(), step);
        assert_eq!(history.next(UndoDirection::Back), Some("deleted 300 saves"));
        assert_eq!(history.next(UndoDirection::Forth), Some("deleted 300 saves"));
    }

    #[test]
    fn an_undo_that_completes_after_another_change_cannot_be_redone() {
        let mut history = UndoHistory::default();
        history.push(of_files("deleted 300 saves"));
        let step = history.take(UndoDirection::Back);
        history.note(&set("0.5"), plan("1"), &plan("0.5"));
        history.complete(UndoDirection::Back, step, None);
        assert_eq!(history.next(UndoDirection::Forth), None);
        assert_eq!(history.next(UndoDirection::Back), Some("friction 0.5"));
    }
}
