//! Undo and redo of file operations on saves.

use crate::save::library::FileStep;
use crate::save::{SaveError, SavesFolder};
use crate::studio::state::undo::UndoDirection;

/// One user action on one or several saves.
#[derive(Debug, Clone, PartialEq)]
pub struct LibraryChange {
    /// Label: "deleted climber".
    pub words: String,
    /// Its steps, in the order in which they were taken.
    pub steps: Vec<FileStep>,
}

/// Undo and redo stacks; the latest change is last.
#[derive(Debug, Default)]
pub struct FileHistory {
    done: Vec<LibraryChange>,
    undone: Vec<LibraryChange>,
}

/// Maximum number of changes that can be undone.
const MOST_CHANGES: usize = 200;

impl FileHistory {
    /// Records a change and clears the redo stack.
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

    /// Numbers of changes that can be undone and redone.
    pub fn counts(&self) -> (usize, usize) {
        (self.done.len(), self.undone.len())
    }

    /// Clears the redo stack.
    pub fn forget_undone(&mut self) {
        self.undone.clear();
    }

    /// Label of the next change to undo.
    pub fn undoable(&self) -> Option<&str> {
        self.done.last().map(|change| change.words.as_str())
    }

    /// Label of the next change to redo.
    pub fn redoable(&self) -> Option<&str> {
        self.undone.last().map(|change| change.words.as_str())
    }

    /// Undoes the last change or redoes the last undone one. Returns it with the steps taken.
    pub fn step(
        &mut self,
        way: UndoDirection,
        saves: &SavesFolder,
    ) -> Result<Option<LibraryChange>, String> {
        let (from, to) = self.both_ways(way);
        step_back(from, to, saves)
    }

    /// Number of steps of the next change in a direction.
    pub fn steps(&self, way: UndoDirection) -> usize {
        let from = if way == UndoDirection::Back { &self.done } else { &self.undone };
        from.last().map_or(0, |change| change.steps.len())
    }

    /// Removes the next change in a direction, for a background task. [`Self::settle`] records its result.
    pub fn take(&mut self, way: UndoDirection) -> Option<LibraryChange> {
        self.both_ways(way).0.pop()
    }

    /// Records the result of a change from [`Self::take`]: the steps taken and the steps left. Returns the former.
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

    /// Source and destination of a change in a direction.
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

/// Undoes the last change of `from` and pushes its inverse to `to`. After a failure the remaining steps stay in `from`,
/// except a step whose file no longer exists.
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
                // A missing file will still be missing at the next try.
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
