//! Slow operations on saves in background threads: copies, and batches.

use super::file_changes::LibraryChange;
use super::words::capital;
use super::{Library, name_of};
use crate::run::BackgroundTask;
use crate::save::SaveError;
use crate::save::library::FileStep;
use crate::studio::state::undo::UndoDirection;
use crate::studio::ui::notifications::Notices;

/// Maximum number of saves that are deleted, copied or restored within a frame: each is flushed to disk, which takes
/// some milliseconds.
pub(super) const MOST_AT_ONCE: usize = 8;
/// Maximum number of problems that are reported one by one.
const MOST_PROBLEMS: usize = 3;

/// Operation on saves, as past and present participle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Verb {
    pub done: &'static str,
    doing: &'static str,
}

pub(super) const DELETED: Verb = Verb { done: "deleted", doing: "Deleting" };
pub(super) const DUPLICATED: Verb = Verb { done: "duplicated", doing: "Duplicating" };
pub(super) const EXPORTED: Verb = Verb { done: "exported", doing: "Exporting" };
pub(super) const IMPORTED: Verb = Verb { done: "imported", doing: "Importing" };

/// Kind of a background operation.
#[derive(Debug)]
pub(super) enum BatchTask {
    /// A new change.
    Act(Verb),
    /// Undo or redo of the change with this label.
    Undo(UndoDirection, String),
}

impl BatchTask {
    fn doing(&self) -> &str {
        match self {
            Self::Act(verb) => verb.doing,
            Self::Undo(UndoDirection::Back, _) => "Undoing",
            Self::Undo(UndoDirection::Forth, _) => "Redoing",
        }
    }
}

/// Outcome for one save.
#[derive(Debug)]
pub(super) enum BatchOutcome {
    /// Done.
    Done(FileStep),
    /// Failed. The step is kept if it can be undone later.
    Failed(SaveError, Option<FileStep>),
    /// Cancelled before it began.
    Left(Option<FileStep>),
}

impl From<Result<FileStep, SaveError>> for BatchOutcome {
    fn from(result: Result<FileStep, SaveError>) -> Self {
        match result {
            Ok(step) => Self::Done(step),
            Err(error) => Self::Failed(error, None),
        }
    }
}

/// A background operation and its progress.
#[derive(Debug)]
pub(super) struct BatchJobs {
    task: BatchTask,
    batch: BackgroundTask<Vec<BatchOutcome>>,
}

impl BatchJobs {
    /// Whether it is long enough to show its progress.
    fn is_long(&self) -> bool {
        self.batch.total() > MOST_AT_ONCE
    }

    fn words(&self) -> String {
        format!("{} {} of {}", self.task.doing(), self.batch.done(), self.batch.total())
    }
}

impl Library {
    /// Background operations: label, such as "Deleting 1200 of 10000", and progress from 0 to 1.
    pub fn under_way(&self) -> impl Iterator<Item = (String, f32)> {
        let share = |batch: &BackgroundTask<Vec<BatchOutcome>>| {
            batch.done() as f32 / batch.total().max(1) as f32
        };
        let long = self.errands.iter().filter(|errand| errand.is_long());
        long.map(move |errand| (errand.words(), share(&errand.batch)))
    }

    /// Reason why no other operation can begin now, if any: undo steps must keep their order.
    pub fn busy(&self) -> Option<String> {
        let words = self.under_way().next()?.0;
        Some(format!("{words} saves is in progress: wait for it, or cancel it"))
    }

    pub(super) fn refuse_while_busy(&self) -> Result<(), String> {
        self.busy().map_or(Ok(()), Err)
    }

    /// Cancels all operations after the current file. Finished steps can be undone.
    pub(super) fn cancel(&self) {
        self.errands.iter().for_each(|errand| errand.batch.cancel());
    }

    /// Starts an operation on each item in the background.
    pub(super) fn send_out<I: Send + 'static>(
        &mut self,
        task: BatchTask,
        things: Vec<I>,
        act: impl Fn(I) -> BatchOutcome + Send + 'static,
        leave: impl Fn(I) -> BatchOutcome + Send + 'static,
    ) -> Result<(), String> {
        let batch = BackgroundTask::for_each(things, act, leave)
            .map_err(|error| format!("{} saves could not be started: {error}", task.doing()))?;
        self.errands.push(BatchJobs { task, batch });
        Ok(())
    }

    /// Starts to undo or redo the last large batch, in reverse order.
    pub(super) fn send_out_undo(&mut self, way: UndoDirection) -> Result<Option<String>, String> {
        let Some(LibraryChange { words, mut steps }) = self.history.take(way) else {
            return Ok(None);
        };
        steps.reverse();
        let said = format!(
            "{} of {}: {words}",
            if way == UndoDirection::Back { "Undoing" } else { "Redoing" },
            steps.len()
        );
        let saves = self.saves.clone();
        let undo = move |step: FileStep| match step.undo(&saves) {
            Ok(inverse) => BatchOutcome::Done(inverse),
            // A missing file will still be missing at the next try.
            Err(error @ SaveError::Unreadable { .. }) => BatchOutcome::Failed(error, None),
            Err(error) => BatchOutcome::Failed(error, Some(step)),
        };
        self.send_out(BatchTask::Undo(way, words), steps, undo, |step| {
            BatchOutcome::Left(Some(step))
        })?;
        Ok(Some(said))
    }

    /// Receives the results of finished operations.
    pub(super) fn take_in_errands(&mut self, notices: &mut Notices) {
        let errands = std::mem::take(&mut self.errands);
        for BatchJobs { task, batch } in errands {
            match batch.poll() {
                None => self.errands.push(BatchJobs { task, batch }),
                Some(Ok(outcomes)) => self.take_back(task, outcomes, notices),
                Some(Err(problem)) => {
                    let doing = task.doing();
                    notices.problem(format!("{doing} saves failed: {problem}"));
                    self.look_again();
                }
            }
        }
    }

    fn take_back(&mut self, task: BatchTask, outcomes: Vec<BatchOutcome>, notices: &mut Notices) {
        let total = outcomes.len();
        let (mut steps, mut left, mut problems) = (Vec::new(), Vec::new(), Vec::new());
        let mut cancelled = 0;
        for outcome in outcomes {
            match outcome {
                BatchOutcome::Done(step) => steps.push(step),
                BatchOutcome::Failed(error, step) => {
                    problems.push(error.to_string());
                    left.extend(step);
                }
                BatchOutcome::Left(step) => {
                    cancelled += 1;
                    left.extend(step);
                }
            }
        }
        let more = problems.len().saturating_sub(MOST_PROBLEMS);
        problems.into_iter().take(MOST_PROBLEMS).for_each(|problem| notices.problem(problem));
        if more > 0 {
            notices.problem(format!("{more} more saves failed."));
        }
        let cancelled = match cancelled {
            0 => String::new(),
            number => format!(" Cancelled: {number} of {total} remain."),
        };
        match task {
            BatchTask::Undo(way, words) => {
                if !left.is_empty() {
                    self.left.push((way, words.clone()));
                }
                // The steps were undone in reverse order.
                left.reverse();
                let change = self.history.settle(way, words, steps, left);
                let said = self.after_undoing(Ok(Some(change)), way);
                if let Ok(Some(said)) = said {
                    notices.info(said + &cancelled);
                }
            }
            BatchTask::Act(verb) => {
                let words = listed_steps(verb, &steps);
                match steps.first() {
                    None if cancelled.is_empty() => {}
                    None => notices.info(cancelled.trim().to_owned()),
                    Some(first) => {
                        let said = format!("{}{}", capital(&words), ending(verb, first));
                        notices.info(said + &cancelled);
                    }
                }
                self.keep(LibraryChange { words, steps });
            }
        }
    }
}

/// Label of a change: one save is named, several are counted.
fn listed_steps(verb: Verb, steps: &[FileStep]) -> String {
    match steps {
        [FileStep::Deleted { from, .. }] => format!("{} {}", verb.done, name_of(from)),
        [one] => {
            let name = one.place().map(|place| place.name()).unwrap_or_default();
            format!("{} {name}", verb.done)
        }
        several => format!("{} {} saves", verb.done, several.len()),
    }
}

/// End of the sentence that says where the saves are now.
fn ending(verb: Verb, first: &FileStep) -> String {
    if verb == DELETED {
        return ". Press Ctrl Z to undo.".to_owned();
    }
    let place = first.place();
    let folder = place.as_ref().and_then(|place| place.path()?.parent());
    folder.map_or(".".to_owned(), |folder| format!(" to {}.", folder.display()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::library::SavePlace;
    use crate::studio::commands::library::LibraryCommand;
    use crate::studio::state::library::tests::{library, own, place};

    /// A library of `count` saves, and their places.
    fn of_many(count: usize) -> (tempfile::TempDir, Library, Vec<SavePlace>) {
        let (folder, mut library) = library(&["a"]);
        for number in 1..count {
            let copy = folder.path().join(format!("b {number:05}.ron"));
            std::fs::copy(folder.path().join("a.ron"), copy).expect("copied");
        }
        assert_eq!(own(&mut library).len(), count);
        let places = library.items().iter().map(|item| item.place().clone());
        let places = places.filter(|place| place.path().is_some()).collect();
        (folder, library, places)
    }

    fn wait(library: &mut Library, notices: &mut Notices) {
        while !library.errands.is_empty() {
            library.take_in(notices);
        }
    }

    #[test]
    fn a_large_batch_is_deleted_in_the_background_and_restored_as_a_whole() {
        let (_folder, mut library, places) = of_many(300);
        let mut notices = Notices::default();
        library.apply(&LibraryCommand::Delete(places), &mut notices).expect("begun");
        assert!(library.under_way().next().expect("in progress").0.starts_with("Deleting "));
        let refusal = library.step(UndoDirection::Back).expect_err("in progress");
        assert!(refusal.contains("of 300 saves is in progress"), "{refusal}");
        wait(&mut library, &mut notices);
        assert!(own(&mut library).is_empty());
        assert_eq!(library.undoable(), Some("deleted 300 saves"));
        library.step(UndoDirection::Back).expect("begun");
        assert!(library.under_way().next().is_some());
        wait(&mut library, &mut notices);
        assert_eq!(own(&mut library).len(), 300);
        assert_eq!((library.undoable(), library.redoable()), (None, Some("deleted 300 saves")));
        library.step(UndoDirection::Forth).expect("begun");
        wait(&mut library, &mut notices);
        assert!(own(&mut library).is_empty());
    }

    /// Starts an operation and cancels it at once, repeatedly until it is cancelled before it finishes. Returns the
    /// number of finished saves.
    fn cancelled(
        library: &mut Library,
        begin: impl Fn(&mut Library, &mut Notices),
        all: usize,
        back: impl Fn(&mut Library),
        count: impl Fn(&mut Library) -> usize,
    ) -> usize {
        let mut notices = Notices::default();
        for _ in 0..50 {
            begin(library, &mut notices);
            library.apply(&LibraryCommand::Cancel, &mut notices).expect("cancelled");
            wait(library, &mut notices);
            let done = count(library);
            if done < all {
                return done;
            }
            back(library);
            wait(library, &mut notices);
        }
        panic!("it was always done before it was cancelled");
    }

    #[test]
    fn a_cancelled_batch_stops_and_its_finished_part_can_be_undone() {
        let (_folder, mut library, places) = of_many(200);
        let undo = |library: &mut Library| {
            library.step(UndoDirection::Back).expect("begun");
        };
        let duplicate = |library: &mut Library, notices: &mut Notices| {
            library.apply(&LibraryCommand::Duplicate(places.clone()), notices).expect("begun");
        };
        let copies = |library: &mut Library| own(library).len() - 200;
        if cancelled(&mut library, duplicate, 200, undo, copies) > 0 {
            undo(&mut library);
            wait(&mut library, &mut Notices::default());
        }
        assert_eq!(own(&mut library).len(), 200);
        assert_eq!(library.undoable(), None);
    }

    #[test]
    fn the_rest_of_a_cancelled_undo_is_reported_and_can_be_undone() {
        let (_folder, mut library, places) = of_many(200);
        let mut notices = Notices::default();
        library.apply(&LibraryCommand::Delete(places), &mut notices).expect("begun");
        wait(&mut library, &mut notices);
        assert!(library.take_left().is_empty());
        let undo = |library: &mut Library, _: &mut Notices| {
            library.step(UndoDirection::Back).expect("begun");
        };
        let redo = |library: &mut Library| {
            library.step(UndoDirection::Forth).expect("begun");
        };
        cancelled(&mut library, undo, 200, redo, |library| own(library).len());
        assert_eq!(library.take_left(), [(UndoDirection::Back, "deleted 200 saves".to_owned())]);
        undo(&mut library, &mut notices);
        wait(&mut library, &mut notices);
        assert_eq!(own(&mut library).len(), 200);
    }

    #[test]
    fn a_failure_does_not_stop_the_rest_of_the_batch() {
        let (folder, mut library, places) = of_many(20);
        std::fs::remove_file(folder.path().join("b 00007.ron")).expect("there");
        let mut notices = Notices::default();
        library.apply(&LibraryCommand::Delete(places), &mut notices).expect("begun");
        wait(&mut library, &mut notices);
        assert_eq!(library.undoable(), Some("deleted 19 saves"));
        assert_eq!(notices.len(), 2, "the failure, and the success");
        assert!(own(&mut library).is_empty());
        assert!(library.item(&SavePlace::Shipped("fast")).is_some());
        assert_eq!(place(&library, "fast"), SavePlace::Shipped("fast"));
    }
}
