//! What was done with saves, to be undone and done again.

use crate::save::library::FileStep;
use crate::save::{SaveError, SavesFolder};
use crate::studio::state::undo::UndoDirection;

/// Something a person did at once.
#[derive(Debug, Clone, PartialEq)]
pub struct LibraryChange {
    /// What it was, in a few words: "deleted climber".
    pub words: String,
    /// Its steps, in the order in which they were taken.
    pub steps: Vec<FileStep>,
}

/// What was done, and what was undone of it; the last is the last.
#[derive(Debug, Default)]
pub struct FileHistory {
    done: Vec<LibraryChange>,
    undone: Vec<LibraryChange>,
}

/// Of so many changes it is remembered how to undo them.
const MOST_CHANGES: usize = 200;

impl FileHistory {
    /// Keeps what was done. What was undone before cannot be done again then.
    pub fn keep(&mut self, change: LibraryChange) {
        if change.steps.is_empty() {
            return;
        }
        self.undone.clear();
        self.done.push(change);
        if self.done.len() > MOST_CHANGES {
            self.done.remove(0);
        }
    }

    /// How many changes can be undone, and how many done again.
    pub fn counts(&self) -> (usize, usize) {
        (self.done.len(), self.undone.len())
    }

    /// Forgets what could be done again.
    pub fn forget_undone(&mut self) {
        self.undone.clear();
    }

    /// What undoing would undo.
    pub fn undoable(&self) -> Option<&str> {
        self.done.last().map(|change| change.words.as_str())
    }

    /// What doing again would do.
    pub fn redoable(&self) -> Option<&str> {
        self.undone.last().map(|change| change.words.as_str())
    }

    /// Undoes what was done last, or does again what was undone last; returns it with the steps that were taken.
    pub fn step(
        &mut self,
        way: UndoDirection,
        saves: &SavesFolder,
    ) -> Result<Option<LibraryChange>, String> {
        let (from, to) = self.both_ways(way);
        step_back(from, to, saves)
    }

    /// Of how many steps the next change one way is.
    pub fn steps(&self, way: UndoDirection) -> usize {
        let from = if way == UndoDirection::Back { &self.done } else { &self.undone };
        from.last().map_or(0, |change| change.steps.len())
    }

    /// Takes the next change one way out, to be undone step by step by somebody who has time. [`Self::settle`] takes in
    /// what came of it.
    pub fn take(&mut self, way: UndoDirection) -> Option<LibraryChange> {
        self.both_ways(way).0.pop()
    }

    /// Takes in what came of a change that was taken out: the steps that were taken, and those of it that are left.
    /// Returns the former.
    pub fn settle(
        &mut self,
        way: UndoDirection,
        words: String,
        taken: Vec<FileStep>,
        left: Vec<FileStep>,
    ) -> LibraryChange {
        let (from, to) = self.both_ways(way);
        if !left.is_empty() {
            from.push(LibraryChange { words: words.clone(), steps: left });
        }
        let change = LibraryChange { words, steps: taken };
        if !change.steps.is_empty() {
            to.push(change.clone());
        }
        change
    }

    /// Where changes come from that are taken one way, and where they go.
    fn both_ways(
        &mut self,
        way: UndoDirection,
    ) -> (&mut Vec<LibraryChange>, &mut Vec<LibraryChange>) {
        match way {
            UndoDirection::Back => (&mut self.done, &mut self.undone),
            UndoDirection::Forth => (&mut self.undone, &mut self.done),
        }
    }
}

/// Undoes the last change of `from`; what undoes that goes to `to`. Where a step fails, those that are not undone
/// stay, unless what they are about is gone for good.
fn step_back(
    from: &mut Vec<LibraryChange>,
    to: &mut Vec<LibraryChange>,
    saves: &SavesFolder,
) -> Result<Option<LibraryChange>, String> {
    let Some(LibraryChange { words, mut steps }) = from.pop() else { return Ok(None) };
    let mut taken = Vec::new();
    let mut problem = None;
    while let Some(step) = steps.pop() {
        match step.undo(saves) {
            Ok(inverse) => taken.push(inverse),
            Err(error) => {
                // What cannot be found will not be found the next time either.
                if !matches!(error, SaveError::Unreadable { .. }) {
                    steps.push(step);
                }
                problem = Some(error.to_string());
                break;
            }
        }
    }
    if !steps.is_empty() {
        from.push(LibraryChange { words: words.clone(), steps });
    }
    let change = LibraryChange { words, steps: taken };
    if !change.steps.is_empty() {
        to.push(change.clone());
    }
    problem.map_or(Ok(Some(change)), Err)
}
