//! What was done with saves, to be undone and done again.

use crate::save::library::Step;
use crate::save::{SaveError, SavesFolder};

/// Something a person did at once.
#[derive(Debug, Clone, PartialEq)]
pub struct Change {
    /// What it was, in a few words: "deleted climber".
    pub words: String,
    /// Its steps, in the order in which they were taken.
    pub steps: Vec<Step>,
}

/// What was done, and what was undone of it; the last is the last.
#[derive(Debug, Default)]
pub struct History {
    done: Vec<Change>,
    undone: Vec<Change>,
}

/// Of so many changes it is remembered how to undo them.
const MOST_CHANGES: usize = 200;

impl History {
    /// Keeps what was done. What was undone before cannot be done again then.
    pub fn keep(&mut self, change: Change) {
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
    pub fn steps(&self) -> (usize, usize) {
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

    /// Undoes what was done last, and returns it with the steps that were taken.
    pub fn undo(&mut self, saves: &SavesFolder) -> Result<Option<Change>, String> {
        step_back(&mut self.done, &mut self.undone, saves)
    }

    /// Does again what was undone last, and returns it with the steps that were taken.
    pub fn redo(&mut self, saves: &SavesFolder) -> Result<Option<Change>, String> {
        step_back(&mut self.undone, &mut self.done, saves)
    }
}

/// Undoes the last change of `from`; what undoes that goes to `to`. Where a step fails, those that are not undone
/// stay, unless what they are about is gone for good.
fn step_back(
    from: &mut Vec<Change>,
    to: &mut Vec<Change>,
    saves: &SavesFolder,
) -> Result<Option<Change>, String> {
    let Some(Change { words, mut steps }) = from.pop() else { return Ok(None) };
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
        from.push(Change { words: words.clone(), steps });
    }
    let change = Change { words, steps: taken };
    if !change.steps.is_empty() {
        to.push(change.clone());
    }
    problem.map_or(Ok(Some(change)), Err)
}
