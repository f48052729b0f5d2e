//! Undo and redo of what was changed in the next run's plan.
//!
//! Every command that changes the plan leaves a [`UndoStep`]. Whoever drags a slider and rests on the way changes it
//! several times: between two presses of a mouse's button or a key all changes of one setting are one step.

mod follow;

use std::collections::VecDeque;

use bevy::prelude::*;

use super::wording::changes_in_words;
use crate::evolve::RunPlan;
use crate::studio::commands::Command;
use crate::studio::commands::library::LibraryCommand;
use crate::studio::schedule::FrameSet;

pub(crate) use follow::followed;

/// So many steps can be undone.
const MOST_STEPS: usize = 200;

/// The subject of a step to the plan of a run that is gone on with.
const CONTINUE: &str = "continue";

/// Something that can be undone. Whatever else is to be undone in the same order, such as a file that was deleted,
/// is a kind of its own here, with its way back and forth where commands are applied.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum UndoStep {
    /// The next run's plan was changed.
    Plan {
        /// The plan before.
        before: Box<RunPlan>,
        /// The plan after.
        after: Box<RunPlan>,
        /// What was changed, in a few words: "friction 0.5".
        label: String,
        /// What was changed, by its name: further changes of it within one drag belong to this step.
        subject: String,
    },
    /// Something was done with saves; the library knows what.
    Library {
        /// What it was, in a few words: "deleted climber".
        label: String,
    },
}

impl UndoStep {
    /// Whether it is about saves.
    fn is_of_library(&self) -> bool {
        matches!(self, Self::Library { .. })
    }

    /// Whether it was that another run is gone on with: its settings are no edit of the run under way.
    pub fn is_of_another_run(&self) -> bool {
        matches!(self, Self::Plan { subject, .. } if subject == CONTINUE)
    }

    /// What was changed, in a few words.
    pub fn label(&self) -> &str {
        match self {
            Self::Plan { label, .. } | Self::Library { label } => label,
        }
    }
}

/// Which way through the steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum UndoDirection {
    /// Undo.
    Back,
    /// Redo.
    Forth,
}

impl UndoDirection {
    /// What to say when a step was taken.
    pub fn taken(self, step: &UndoStep) -> String {
        let done = if self == Self::Back { "Undone" } else { "Redone" };
        format!("{done}: {}", step.label())
    }

    /// What to say when there is no step.
    pub fn nothing(self) -> &'static str {
        if self == Self::Back { "There is nothing to undo." } else { "There is nothing to redo." }
    }
}

/// The steps that were done, and those that were undone.
#[derive(Resource, Debug, Default)]
pub(crate) struct UndoHistory {
    /// The latest last.
    done: VecDeque<UndoStep>,
    /// The one to redo first last.
    undone: Vec<UndoStep>,
    /// Whether the latest step is complete: further changes are steps of their own.
    is_settled: bool,
}

impl UndoHistory {
    /// Notes what a command has done to the next run's plan.
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

    /// Adds a step. What was undone before cannot be redone any more.
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
            // There and back again within a drag is no step at all.
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

    /// From now on a change is a step of its own.
    pub fn settle(&mut self) {
        self.is_settled = true;
    }

    /// Takes the next step one way, to be carried out. None if there is none.
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

    /// Puts a step back to where it was taken from: not all of it could be taken.
    pub fn put_back(&mut self, way: UndoDirection, step: UndoStep) {
        match way {
            UndoDirection::Back => self.done.push_back(step),
            UndoDirection::Forth => self.undone.push(step),
        }
    }

    /// Takes the next step one way that is about saves, whatever else was done after it. Says whether there was one.
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

    /// Whether the next step one way is about saves.
    pub fn next_is_of_library(&self, way: UndoDirection) -> bool {
        let next = match way {
            UndoDirection::Back => self.done.back(),
            UndoDirection::Forth => self.undone.last(),
        };
        next.is_some_and(UndoStep::is_of_library)
    }

    /// Forgets steps about saves that the library knows nothing of any more: it can undo so many, and redo so many.
    /// Says how many it can redo that are no steps here.
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

    /// Takes all steps away while a lesson goes on, which has steps of its own.
    pub fn lend(&mut self) -> Self {
        std::mem::take(self)
    }

    /// Gives back the steps of before a lesson; of the lesson's own those stay that are about saves.
    pub fn give_back(&mut self, own: Self) {
        let lesson = std::mem::replace(self, own);
        let of_library = lesson.done.into_iter().filter(UndoStep::is_of_library);
        self.done.extend(of_library);
        self.undone.extend(lesson.undone.into_iter().filter(UndoStep::is_of_library));
        self.is_settled = true;
    }

    /// What the next step one way would undo or redo, in a few words.
    pub fn next(&self, way: UndoDirection) -> Option<&str> {
        match way {
            UndoDirection::Back => self.done.back(),
            UndoDirection::Forth => self.undone.last(),
        }
        .map(UndoStep::label)
    }
}

/// What a command has changed, by its name and in a few words; none of a command that is no edit.
fn words_of(command: &Command, before: &RunPlan, after: &RunPlan) -> Option<(String, String)> {
    let changes = || changes_in_words(&before.settings, &after.settings);
    Some(match command {
        Command::SetField { field, .. } => (field.clone(), changes()),
        Command::SetFields(_) => ("several".to_owned(), changes()),
        Command::SetPopulation(_) => ("evolution.population".to_owned(), changes()),
        Command::SetSeed(seed) => ("seed".to_owned(), format!("seed {seed}")),
        Command::SetPreset(name) => ("preset".to_owned(), format!("preset {name}")),
        Command::StorePreset(name) => ("preset".to_owned(), format!("preset {name}")),
        Command::DropChange => ("drop".to_owned(), "discarded changes".to_owned()),
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

/// The plan after a step from one plan to another is taken, beginning at what the plan is by now. A new run has
/// its own seed, which a step that was about something else leaves alone.
pub(crate) fn stepped(now: &RunPlan, from: &RunPlan, to: &RunPlan) -> RunPlan {
    let seed = if from.seed == to.seed { now.seed } else { to.seed };
    RunPlan { seed, ..to.clone() }
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<UndoHistory>()
        .add_systems(Update, settle_on_press.in_set(FrameSet::TakeIn));
}

/// Whoever presses something anew begins a new step.
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
    fn steps_about_saves_that_the_library_has_forgotten_are_forgotten() {
        let mut history = UndoHistory::default();
        history.push(of_library("deleted a"));
        history.push(of_library("deleted b"));
        assert_eq!(history.agree_with_library(1, 0), 0);
        assert_eq!(history.next(UndoDirection::Back), Some("deleted a"));
        assert!(history.take_of_library(UndoDirection::Back));
        assert!(!history.take_of_library(UndoDirection::Back));
        assert_eq!(history.agree_with_library(0, 1), 0);
        history.push(of_library("deleted c"));
        assert_eq!(history.agree_with_library(1, 1), 1, "to be forgotten there");
    }

    #[test]
    fn after_a_lesson_its_steps_about_saves_stay_and_its_others_do_not() {
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

    /// The plans of a step.
    fn plans(step: Option<UndoStep>) -> (RunPlan, RunPlan) {
        let Some(UndoStep::Plan { before, after, .. }) = step else { panic!("a step") };
        (*before, *after)
    }

    #[test]
    fn steps_go_back_and_forth_with_their_names() {
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
    fn one_drag_is_one_step_however_often_it_rests() {
        let mut history = UndoHistory::default();
        for (before, after) in [("1", "0.8"), ("0.8", "0.5"), ("0.5", "0.3")] {
            history.note(&set(after), plan(before), &plan(after));
        }
        assert_eq!(plans(history.take(UndoDirection::Back)), (plan("1"), plan("0.3")));
        assert_eq!(history.take(UndoDirection::Back), None);
        // Back to where it began it is none.
        history.note(&set("0.8"), plan("1"), &plan("0.8"));
        history.note(&set("1"), plan("0.8"), &plan("1"));
        assert_eq!(history.next(UndoDirection::Back), None);
    }

    #[test]
    fn a_new_change_ends_what_could_be_redone_and_what_changes_nothing_is_no_step() {
        let mut history = UndoHistory::default();
        history.note(&set("0.5"), plan("1"), &plan("0.5"));
        history.take(UndoDirection::Back);
        history.note(&set("1"), plan("1"), &plan("1"));
        assert!(history.next(UndoDirection::Forth).is_some(), "nothing was changed");
        history.note(&set("0.7"), plan("1"), &plan("0.7"));
        assert_eq!(history.next(UndoDirection::Forth), None);
    }

    #[test]
    fn only_so_many_steps_are_kept() {
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
    fn the_seed_of_a_new_run_is_left_alone_by_a_step_that_is_not_about_it() {
        let now = RunPlan { seed: 2, ..plan("0.5") };
        assert_eq!(stepped(&now, &plan("0.5"), &plan("1")).seed, 2);
        let other_seed = RunPlan { seed: 9, ..plan("1") };
        assert_eq!(stepped(&now, &plan("0.5"), &other_seed).seed, 9);
    }

    #[test]
    fn what_could_not_be_undone_as_a_whole_is_still_the_next_to_undo() {
        let mut history = UndoHistory::default();
        history.push(of_library("renamed a"));
        history.push(of_library("deleted 300 saves"));
        let step = history.take(UndoDirection::Back).expect("a step");
        // Some of them are back, and can be deleted again; the rest can be brought back, too.
        history.put_back(UndoDirection::Back, step);
        assert_eq!(history.agree_with_library(2, 1), 0);
        assert_eq!(history.next(UndoDirection::Back), Some("deleted 300 saves"));
        assert_eq!(history.next(UndoDirection::Forth), Some("deleted 300 saves"));
        history.take(UndoDirection::Back);
        assert_eq!(history.next(UndoDirection::Back), Some("renamed a"));
    }
}
