//! Operations on the files of saves: a few files at once within a frame, or many or slow ones in the background.

use std::path::Path;

use super::{Library, name_of};
use crate::studio::state::new_file::offer_path;
use crate::studio::state::undo::{UNDO_SUBJECT, UndoDirection, UndoHistory, UndoStep};
use crate::studio::ui::notifications::Notices;
use snakes_core::save::library::{FileStep, SavePlace, read_notes};
use snakes_core::save::{SaveError, SavesFolder};
use snakes_lab::run::BackgroundTask;

/// Maximum number of files that are deleted, copied or restored within a frame. Each takes some milliseconds, because
/// it is flushed to the disk.
const MAX_AT_ONCE: usize = 8;
/// Maximum number of problems that are shown in separate messages.
const MAX_PROBLEMS: usize = 3;

/// Words for an operation when it is finished and while it is in progress.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Verb {
    done: &'static str,
    doing: &'static str,
}

pub(super) const DELETED: Verb = Verb { done: "deleted", doing: "Deleting" };
pub(super) const DUPLICATED: Verb = Verb { done: "duplicated", doing: "Duplicating" };
pub(super) const EXPORTED: Verb = Verb { done: "exported", doing: "Exporting" };
pub(super) const SAVED: Verb = Verb { done: "saved", doing: "Saving" };
pub(super) const IMPORTED: Verb = Verb { done: "imported", doing: "Importing" };

/// Task of a batch.
#[derive(Debug)]
pub(super) enum BatchTask {
    /// A new operation on saves.
    Act(Verb),
    /// Undo or redo of the step with this label.
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

    /// Returns the name of the whole operation: "Deleting saves", "Undoing".
    fn whole(&self) -> String {
        match self {
            Self::Act(verb) => format!("{} saves", verb.doing),
            Self::Undo(..) => self.doing().to_owned(),
        }
    }
}

/// Outcome of a batch for one file: the step that undoes the operation. If the operation was not executed: the error, `None` if the
/// batch was cancelled before it reached the file; and the step that is to be undone or redone later, if any.
pub(super) type BatchOutcome = Result<FileStep, (Option<String>, Option<FileStep>)>;

/// A batch that is running in the background.
#[derive(Debug)]
pub(super) struct BatchJobs {
    task: BatchTask,
    batch: BackgroundTask<Vec<BatchOutcome>>,
}

impl BatchJobs {
    /// Returns a description such as "Deleting 1200 of 10000" and the finished share from 0 to 1, if the batch is long enough to show them.
    fn progress(&self) -> Option<(String, f32)> {
        let (done, total) = (self.batch.done(), self.batch.total());
        let words = || format!("{} {done} of {total}", self.task.doing());
        (total > MAX_AT_ONCE).then(|| (words(), done as f32 / total as f32))
    }
}

impl Library {
    /// Returns description and finished share, from 0 to 1, of the long batches in progress.
    pub fn under_way(&self) -> impl Iterator<Item = (String, f32)> {
        self.batches.iter().filter_map(BatchJobs::progress)
    }

    /// Returns the reason why files cannot be changed now, if a long batch is in progress. Undo steps must be undone in order.
    pub fn busy(&self) -> Option<String> {
        let (job, (words, _)) = self.batches.iter().find_map(|job| Some((job, job.progress()?)))?;
        let noun = if matches!(job.task, BatchTask::Act(_)) { "saves" } else { "files" };
        Some(format!("{words} {noun} is in progress: wait for it, or cancel it"))
    }

    pub(super) fn refuse_while_busy(&self) -> Result<(), String> {
        self.busy().map_or(Ok(()), Err)
    }

    /// Stops all batches after their current file. Operations on finished files can be undone.
    pub(super) fn cancel(&self) {
        self.batches.iter().for_each(|job| job.batch.cancel());
    }

    /// Executes an operation on several saves: at once, or in the background if there are many.
    pub(super) fn carry_out(
        &mut self,
        verb: Verb,
        places: &[SavePlace],
        act: fn(&SavesFolder, &SavePlace) -> Result<FileStep, SaveError>,
        history: &mut UndoHistory,
        notices: &mut Notices,
    ) -> Result<(), String> {
        let saves = self.saves.clone();
        if places.len() > MAX_AT_ONCE {
            return self.send_out(verb, places.to_vec(), move |place| act(&saves, &place));
        }
        self.refuse_while_busy()?;
        let each = |place| act(&saves, place).map_err(|error| (Some(error.to_string()), None));
        let outcomes = places.iter().map(each).collect();
        self.finish(BatchTask::Act(verb), outcomes, history, notices);
        Ok(())
    }

    /// Executes an operation on several saves in the background.
    pub(super) fn send_out<I: Send + 'static>(
        &mut self,
        verb: Verb,
        things: Vec<I>,
        act: impl Fn(I) -> Result<FileStep, SaveError> + Send + 'static,
    ) -> Result<(), String> {
        let act = move |thing| act(thing).map_err(|error| (Some(error.to_string()), None));
        self.start_batch(BatchTask::Act(verb), things, act, |_| Err((None, None)))
    }

    fn start_batch<I: Send + 'static>(
        &mut self,
        task: BatchTask,
        things: Vec<I>,
        act: impl Fn(I) -> BatchOutcome + Send + 'static,
        leave: impl Fn(I) -> BatchOutcome + Send + 'static,
    ) -> Result<(), String> {
        self.refuse_while_busy()?;
        let batch = BackgroundTask::for_each(things, act, leave)
            .map_err(|error| format!("{} could not be started: {error}", task.whole()))?;
        self.batches.push(BatchJobs { task, batch });
        Ok(())
    }

    /// Undoes or redoes file operations that were removed from the history, the last one first.
    ///
    /// # Errors
    /// A long batch is in progress, or no thread can be started. The step is then put back into the history.
    pub fn step(
        &mut self,
        way: UndoDirection,
        label: String,
        mut steps: Vec<FileStep>,
        history: &mut UndoHistory,
        notices: &mut Notices,
    ) -> Result<(), String> {
        let whole = UndoStep::Files { label: label.clone(), steps: steps.clone() };
        steps.reverse();
        let saves = self.saves.clone();
        let undo = move |step: FileStep| {
            step.undo(&saves).map_err(|error| {
                // A missing file will also be missing at the next attempt.
                let is_lost = matches!(error, SaveError::Unreadable { .. });
                (Some(error.to_string()), (!is_lost).then_some(step))
            })
        };
        let count = steps.len();
        let task = BatchTask::Undo(way, label.clone());
        if count <= MAX_AT_ONCE && self.busy().is_none() {
            self.finish(task, steps.into_iter().map(undo).collect(), history, notices);
            return Ok(());
        }
        let said = format!("{}: {label}", task.doing());
        let begun = self.start_batch(task, steps, undo, |step| Err((None, Some(step))));
        match begun {
            Ok(()) => notices.update(UNDO_SUBJECT, said),
            Err(_) => history.complete(way, None, Some(whole)),
        }
        begun
    }

    /// Processes the results of finished batches.
    pub(super) fn take_in_batches(&mut self, history: &mut UndoHistory, notices: &mut Notices) {
        for BatchJobs { task, batch } in std::mem::take(&mut self.batches) {
            match batch.poll() {
                None => self.batches.push(BatchJobs { task, batch }),
                Some(Ok(outcomes)) => self.finish(task, outcomes, history, notices),
                Some(Err(problem)) => {
                    let what = task.whole();
                    notices.problem(format!("{what} ended with an error: {problem}"));
                    self.look_again();
                }
            }
        }
    }

    /// Shows messages about the outcomes of a batch, and records them in the history.
    fn finish(
        &mut self,
        task: BatchTask,
        outcomes: Vec<BatchOutcome>,
        history: &mut UndoHistory,
        notices: &mut Notices,
    ) {
        let total = outcomes.len();
        let (mut steps, mut left, mut problems) = (Vec::new(), Vec::new(), Vec::new());
        let mut cancelled = 0;
        for outcome in outcomes {
            match outcome {
                Ok(step) => steps.push(step),
                Err((error, step)) => {
                    cancelled += usize::from(error.is_none());
                    problems.extend(error);
                    left.extend(step);
                }
            }
        }
        let more = problems.len().saturating_sub(MAX_PROBLEMS);
        problems.into_iter().take(MAX_PROBLEMS).for_each(|problem| notices.problem(problem));
        if more > 0 {
            notices.problem(format!("{more} more failed."));
        }
        let mut said = match (&task, steps.first()) {
            (_, None) => String::new(),
            (BatchTask::Undo(way, label), _) => {
                format!("{}.{}", undone_in_words(*way, label, &steps), renamed_on_return(&steps))
            }
            (BatchTask::Act(verb), Some(first)) => {
                let mut said = listed_steps(*verb, &steps) + &ending(*verb, first);
                // It begins with the verb.
                said[..1].make_ascii_uppercase();
                said
            }
        };
        if cancelled > 0 {
            said.push_str(&format!(" Cancelled: {cancelled} of {total} were not processed."));
        }
        let said = said.trim().to_owned();
        let is_export = matches!(&task, BatchTask::Act(verb) if *verb == EXPORTED);
        let place = steps.first().and_then(FileStep::place).filter(|_| is_export);
        match place.as_ref().and_then(SavePlace::path) {
            _ if said.is_empty() => {}
            Some(path) => offer_path(notices, UNDO_SUBJECT, said, path),
            None => notices.update(UNDO_SUBJECT, said),
        }
        match task {
            BatchTask::Act(verb) => self.keep(listed_steps(verb, &steps), steps, history),
            BatchTask::Undo(way, label) => {
                self.look_again();
                self.point_out(steps.iter().find_map(FileStep::place));
                // A step lists its operations in the order in which they were executed.
                left.reverse();
                let step = |steps: Vec<FileStep>| {
                    let label = label.clone();
                    (!steps.is_empty()).then_some(UndoStep::Files { label, steps })
                };
                history.complete(way, step(steps), step(left));
            }
        }
    }
}

/// Returns the message after an undo or redo.
fn undone_in_words(way: UndoDirection, label: &str, steps: &[FileStep]) -> String {
    match steps {
        [FileStep::Restored { wanted, to }] => format!("{} restored", shown_name(to, wanted)),
        [FileStep::Restored { .. }, ..] => format!("{} saves restored", steps.len()),
        _ => way.taken(label),
    }
}

/// Describes the new names of restored entries whose old names were taken meanwhile.
fn renamed_on_return(steps: &[FileStep]) -> String {
    let renamed = steps.iter().filter_map(|step| match step {
        FileStep::Restored { wanted, to } if wanted != to => {
            let [wanted, to] = [wanted, to].map(|path| name_of(path));
            Some(format!(" The name {wanted} was taken, so the new name is {to}."))
        }
        _ => None,
    });
    let renamed: Vec<String> = renamed.collect();
    if renamed.len() > MAX_AT_ONCE {
        return format!(" {} names were taken, so a number was added to them.", renamed.len());
    }
    renamed.concat()
}

/// Returns the name under which the library lists the entry at `path`: the user's own name for a run, or the name of
/// the file or folder `named`.
fn shown_name(path: &Path, named: &Path) -> String {
    let is_run = path.is_dir();
    let notes = is_run.then(|| read_notes(&SavePlace::Run(path.to_owned())).ok()).flatten();
    let own_name = notes.as_ref().and_then(|notes| notes.own_name()).map(str::to_owned);
    own_name.unwrap_or_else(|| name_of(named))
}

/// Describes an operation in a few words: with the name of a single save, or with the number of saves.
fn listed_steps(verb: Verb, steps: &[FileStep]) -> String {
    match steps {
        [FileStep::Deleted { from, kept }] => format!("{} {}", verb.done, shown_name(kept, from)),
        [one] => {
            let place = one.place();
            let path = place.as_ref().and_then(SavePlace::path);
            let name = path.map_or(String::new(), |path| shown_name(path, path));
            format!("{} {name}", verb.done)
        }
        several => format!("{} {} saves", verb.done, several.len()),
    }
}

/// Returns the end of a message: how to restore the saves, or where they are.
fn ending(verb: Verb, first: &FileStep) -> String {
    if verb == DELETED {
        return ". Press Ctrl Z to undo.".to_owned();
    }
    let place = first.place();
    let folder = place.as_ref().and_then(|place| place.path()?.parent());
    folder.map_or(".".to_owned(), |folder| format!(" to {}.", folder.display()))
}

#[cfg(test)]
mod tests;
