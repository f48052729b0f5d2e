//! Undo and redo of changes of the next run's plan and of saves.
//!
//! Every command that changes the plan adds an [`UndoStep`]. A slider that rests during a drag changes the plan several
//! times: until the next key or mouse button press, all changes of one setting are one step.

mod follow;

use std::collections::VecDeque;

use bevy::prelude::*;

use super::wording::changes_in_words;
use crate::evolve::RunPlan;
use crate::studio::commands::Command;
use crate::studio::commands::library::LibraryCommand;
use crate::studio::schedule::FrameSet;

pub(crate) use follow::followed;

/// Maximum number of steps that can be undone.
const MOST_STEPS: usize = 200;

/// Subject of the step that discards the changes of a what-if.
const DISCARD: &str = "discard";

/// Subject of the step that resumes another run.
const CONTINUE: &str = "continue";

/// A change that can be undone. Other kinds of changes, such as deleted files, are variants of their own, carried out
/// where commands are applied.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum UndoStep {
    /// The next run's plan was changed.
    Plan {
        /// The plan before.
        before: Box<RunPlan>,
        /// The plan after.
        after: Box<RunPlan>,
        /// Label: "friction 0.5".
        label: String,
        /// Name of the changed setting: further changes of it within one drag join this step.
        subject: String,
    },
    /// A change of saves; the library has the details.
    Library {
        /// Label: "deleted climber".
        label: String,
    },
}

impl UndoStep {
    /// Whether it is a change of saves.
    fn is_of_library(&self) -> bool {
        matches!(self, Self::Library { .. })
    }

    /// Whether it resumed another run: its settings are no edit of the current run.
    pub fn is_of_another_run(&self) -> bool {
        matches!(self, Self::Plan { subject, .. } if subject == CONTINUE)
    }

    /// Label of the change.
    pub fn label(&self) -> &str {
        match self {
            Self::Plan { label, .. } | Self::Library { label } => label,
        }
    }
}

/// Direction through the steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum UndoDirection {
    /// Undo.
    Back,
    /// Redo.
    Forth,
}

impl UndoDirection {
    /// Message after a step.
    pub fn taken(self, step: &UndoStep) -> String {
        match (self, step) {
            (Self::Back, UndoStep::Plan { subject, .. }) if subject == DISCARD => {
                "Changes restored".to_owned()
            }
            (Self::Back, _) => format!("Undone: {}", step.label()),
            (Self::Forth, _) => format!("Redone: {}", step.label()),
        }
    }

    /// Message if there is no step.
    pub fn nothing(self) -> &'static str {
        if self == Self::Back { "There is nothing to undo." } else { "There is nothing to redo." }
    }
}

/// Undo and redo stacks.
#[derive(Resource, Debug, Default)]
pub(crate) struct UndoHistory {
    /// Undo stack; the latest step is last.
    done: VecDeque<UndoStep>,
    /// Redo stack; the next step to redo is last.
    undone: Vec<UndoStep>,
    /// Whether the latest step is complete: a further change is a new step.
    is_settled: bool,
}

impl UndoHistory {
    /// Records a command's change of the next run's plan.
    pub fn note(&mut self, command: &Command, before: RunPlan, after: &RunPlan) {
        if before == *after {
            return;
        }
        let Some((subject, label)) = words_of(command, &before, after) else { return };
        self.push(UndoStep::Plan {
            before: Box::new(before),
            after: Box::new(after.clone()),
            label,
            subject,
        });
    }

    /// Adds a step and clears the redo stack.
    pub fn push(&mut self, step: UndoStep) {
        self.undone.clear();
        let is_open = !std::mem::take(&mut self.is_settled);
        let joined = match (self.done.back(), &step) {
            (
                Some(UndoStep::Plan { before, subject: earlier, .. }),
                UndoStep::Plan { after, label, subject, .. },
            ) if is_open && earlier == subject => Some(UndoStep::Plan {
                before: before.clone(),
                after: after.clone(),
                label: label.clone(),
                subject: subject.clone(),
            }),
            _ => None,
        };
        if let Some(joined) = joined {
            self.done.pop_back();
            // A drag that returns to its start is not a step.
            let is_none =
                matches!(&joined, UndoStep::Plan { before, after, .. } if before == after);
            self.done.extend((!is_none).then_some(joined));
        } else {
            self.done.push_back(step);
        }
        if self.done.len() > MOST_STEPS {
            self.done.pop_front();
        }
    }

    /// Completes the latest step: the next change is a new step.
    pub fn settle(&mut self) {
        self.is_settled = true;
    }

    /// Takes the next step in a direction, to be carried out; `None` if there is none.
    pub fn take(&mut self, way: UndoDirection) -> Option<UndoStep> {
        self.is_settled = true;
        let step = match way {
            UndoDirection::Back => self.done.pop_back()?,
            UndoDirection::Forth => self.undone.pop()?,
        };
        match way {
            UndoDirection::Back => self.undone.push(step.clone()),
            UndoDirection::Forth => self.done.push_back(step.clone()),
        }
        Some(step)
    }

    /// Puts a step back that was only partly carried out.
    pub fn put_back(&mut self, way: UndoDirection, step: UndoStep) {
        match way {
            UndoDirection::Back => self.done.push_back(step),
            UndoDirection::Forth => self.undone.push(step),
        }
    }

    /// Takes the next change of saves in a direction, skipping other steps. Returns whether there was one.
    pub fn take_of_library(&mut self, way: UndoDirection) -> bool {
        match way {
            UndoDirection::Back => {
                let place = self.done.iter().rposition(UndoStep::is_of_library);
                let step = place.and_then(|place| self.done.remove(place));
                self.undone.extend(step);
                place.is_some()
            }
            UndoDirection::Forth => {
                let place = self.undone.iter().rposition(UndoStep::is_of_library);
                let step = place.map(|place| self.undone.remove(place));
                self.done.extend(step);
                place.is_some()
            }
        }
    }

    /// Whether the next step in a direction is a change of saves.
    pub fn next_is_of_library(&self, way: UndoDirection) -> bool {
        let next = match way {
            UndoDirection::Back => self.done.back(),
            UndoDirection::Forth => self.undone.last(),
        };
        next.is_some_and(UndoStep::is_of_library)
    }

    /// Removes changes of saves that exceed the library's own numbers of undoable and redoable changes. Returns how
    /// many changes the library can redo that are no steps here.
    pub fn agree_with_library(&mut self, undoable: usize, redoable: usize) -> usize {
        let count = |steps: &mut dyn Iterator<Item = &UndoStep>| {
            steps.filter(|step| step.is_of_library()).count()
        };
        while count(&mut self.done.iter()) > undoable {
            let place = self.done.iter().rposition(UndoStep::is_of_library);
            place.and_then(|place| self.done.remove(place));
        }
        while count(&mut self.undone.iter()) > redoable {
            let place = self.undone.iter().position(UndoStep::is_of_library);
            place.map(|place| self.undone.remove(place));
        }
        redoable - count(&mut self.undone.iter())
    }

    /// Takes all steps away during a lesson, which has its own.
    pub fn lend(&mut self) -> Self {
        std::mem::take(self)
    }

    /// Restores the steps from before a lesson; the lesson's changes of saves are kept.
    pub fn give_back(&mut self, own: Self) {
        let lesson = std::mem::replace(self, own);
        let of_library = lesson.done.into_iter().filter(UndoStep::is_of_library);
        self.done.extend(of_library);
        self.undone.extend(lesson.undone.into_iter().filter(UndoStep::is_of_library));
        self.is_settled = true;
    }

    /// Label of the next step in a direction.
    pub fn next(&self, way: UndoDirection) -> Option<&str> {
        match way {
            UndoDirection::Back => self.done.back(),
            UndoDirection::Forth => self.undone.last(),
        }
        .map(UndoStep::label)
    }
}

/// Subject and label of a command's change; `None` if the command is no edit.
fn words_of(command: &Command, before: &RunPlan, after: &RunPlan) -> Option<(String, String)> {
    let changes = || changes_in_words(&before.settings, &after.settings);
    Some(match command {
        Command::SetField { field, .. } => (field.clone(), changes()),
        Command::SetFields(_) => ("several".to_owned(), changes()),
        Command::SetPopulation(_) => ("evolution.population".to_owned(), changes()),
        Command::SetSeed(seed) => ("seed".to_owned(), format!("seed {seed}")),
        Command::SetPreset(name) => ("preset".to_owned(), format!("preset {name}")),
        Command::StorePreset(name) => ("preset".to_owned(), format!("preset {name}")),
        Command::DropChange => (DISCARD.to_owned(), "discarded changes".to_owned()),
        Command::StartFrom(_) | Command::Library(LibraryCommand::StartFrom(_)) => {
            let name = after.founder.as_ref().map_or("a champion", |founder| founder.name());
            ("founder".to_owned(), format!("start of the next run from {name}"))
        }
        Command::ForgetFounder => {
            ("founder".to_owned(), "start of the next run from scratch".to_owned())
        }
        Command::Continue(_) => {
            let RunPlan { preset, seed, .. } = after;
            (CONTINUE.to_owned(), format!("the settings of {preset}, seed {seed}"))
        }
        _ => return None,
    })
}

/// The plan after a step from `from` to `to`, starting at `now`. The seed stays unless the step changed it, since a new
/// run has a new seed.
pub(crate) fn stepped(now: &RunPlan, from: &RunPlan, to: &RunPlan) -> RunPlan {
    let seed = if from.seed == to.seed { now.seed } else { to.seed };
    RunPlan { seed, ..to.clone() }
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<UndoHistory>()
        .add_systems(Update, settle_on_press.in_set(FrameSet::TakeIn));
}

/// A new key or mouse button press completes the latest step.
fn settle_on_press(
    buttons: Res<ButtonInput<MouseButton>>,
    keys: Res<ButtonInput<KeyCode>>,
    mut history: ResMut<UndoHistory>,
) {
    if buttons.get_just_pressed().next().is_some() || keys.get_just_pressed().next().is_some() {
        history.settle();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::{Settings, with_field};

    fn of_library(label: &str) -> UndoStep {
        UndoStep::Library { label: label.to_owned() }
    }

    #[test]
    fn changes_of_saves_that_the_library_has_dropped_are_removed() {
        let mut history = UndoHistory::default();
        history.push(of_library("deleted a"));
        history.push(of_library("deleted b"));
        assert_eq!(history.agree_with_library(1, 0), 0);
        assert_eq!(history.next(UndoDirection::Back), Some("deleted a"));
        assert!(history.take_of_library(UndoDirection::Back));
        assert!(!history.take_of_library(UndoDirection::Back));
        assert_eq!(history.agree_with_library(0, 1), 0);
        history.push(of_library("deleted c"));
        assert_eq!(history.agree_with_library(1, 1), 1, "to be removed there");
    }

    #[test]
    fn after_a_lesson_only_its_changes_of_saves_are_kept() {
        let mut history = UndoHistory::default();
        history.note(&set("0.5"), plan("1"), &plan("0.5"));
        let own = history.lend();
        assert_eq!(history.next(UndoDirection::Back), None);
        history.note(&set("0.3"), plan("0.5"), &plan("0.3"));
        history.push(of_library("deleted a"));
        history.give_back(own);
        assert_eq!(history.take(UndoDirection::Back), Some(of_library("deleted a")));
        assert!(matches!(history.take(UndoDirection::Back), Some(UndoStep::Plan { .. })));
        assert_eq!(history.take(UndoDirection::Back), None);
    }

    /// A plan with this friction.
    fn plan(friction: &str) -> RunPlan {
        let settings = with_field(&Settings::default(), "surface.friction", friction);
        RunPlan::new("report", 1, settings.expect("allowed"))
    }

    fn set(text: &str) -> Command {
        Command::SetField { field: "trial.surface.friction".to_owned(), text: text.to_owned() }
    }

    /// Plans before and after a step.
    fn plans(step: Option<UndoStep>) -> (RunPlan, RunPlan) {
        let Some(UndoStep::Plan { before, after, .. }) = step else { panic!("a step") };
        (*before, *after)
    }

    #[test]
    fn steps_are_undone_and_redone_with_their_labels() {
        let mut history = UndoHistory::default();
        history.note(&set("0.5"), plan("1"), &plan("0.5"));
        history.settle();
        history.note(&set("0.2"), plan("0.5"), &plan("0.2"));
        assert_eq!(history.next(UndoDirection::Back), Some("friction 0.2"));
        let step = history.take(UndoDirection::Back);
        assert_eq!(
            UndoDirection::Back.taken(step.as_ref().expect("a step")),
            "Undone: friction 0.2"
        );
        assert_eq!(plans(step), (plan("0.5"), plan("0.2")));
        assert_eq!(plans(history.take(UndoDirection::Back)), (plan("1"), plan("0.5")));
        assert_eq!(history.take(UndoDirection::Back), None);
        assert_eq!(plans(history.take(UndoDirection::Forth)), (plan("1"), plan("0.5")));
        assert_eq!(history.next(UndoDirection::Forth), Some("friction 0.2"));
    }

    #[test]
    fn one_drag_is_one_step_even_if_it_rests() {
        let mut history = UndoHistory::default();
        for (before, after) in [("1", "0.8"), ("0.8", "0.5"), ("0.5", "0.3")] {
            history.note(&set(after), plan(before), &plan(after));
        }
        assert_eq!(plans(history.take(UndoDirection::Back)), (plan("1"), plan("0.3")));
        assert_eq!(history.take(UndoDirection::Back), None);
        // A drag that returns to its start is not a step.
        history.note(&set("0.8"), plan("1"), &plan("0.8"));
        history.note(&set("1"), plan("0.8"), &plan("1"));
        assert_eq!(history.next(UndoDirection::Back), None);
    }

    #[test]
    fn a_new_change_clears_the_redo_stack_and_a_change_without_effect_is_no_step() {
        let mut history = UndoHistory::default();
        history.note(&set("0.5"), plan("1"), &plan("0.5"));
        history.take(UndoDirection::Back);
        history.note(&set("1"), plan("1"), &plan("1"));
        assert!(history.next(UndoDirection::Forth).is_some(), "nothing was changed");
        history.note(&set("0.7"), plan("1"), &plan("0.7"));
        assert_eq!(history.next(UndoDirection::Forth), None);
    }

    #[test]
    fn the_number_of_steps_is_limited() {
        let mut history = UndoHistory::default();
        for number in 0..MOST_STEPS + 50 {
            let after = plan(&format!("{}", number + 2));
            history.note(&set(""), plan(&format!("{}", number + 1)), &after);
            history.settle();
        }
        let steps = std::iter::from_fn(|| history.take(UndoDirection::Back)).count();
        assert_eq!(steps, MOST_STEPS);
    }

    #[test]
    fn a_step_that_did_not_change_the_seed_keeps_the_current_one() {
        let now = RunPlan { seed: 2, ..plan("0.5") };
        assert_eq!(stepped(&now, &plan("0.5"), &plan("1")).seed, 2);
        let other_seed = RunPlan { seed: 9, ..plan("1") };
        assert_eq!(stepped(&now, &plan("0.5"), &other_seed).seed, 9);
    }

    #[test]
    fn a_partly_undone_step_is_still_the_next_to_undo() {
        let mut history = UndoHistory::default();
        history.push(of_library("renamed a"));
        history.push(of_library("deleted 300 saves"));
        let step = history.take(UndoDirection::Back).expect("a step");
        // Some are restored and can be deleted again; the rest can still be restored.
        history.put_back(UndoDirection::Back, step);
        assert_eq!(history.agree_with_library(2, 1), 0);
        assert_eq!(history.next(UndoDirection::Back), Some("deleted 300 saves"));
        assert_eq!(history.next(UndoDirection::Forth), Some("deleted 300 saves"));
        history.take(UndoDirection::Back);
        assert_eq!(history.next(UndoDirection::Back), Some("renamed a"));
    }
}
