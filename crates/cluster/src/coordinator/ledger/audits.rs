//! Checks of results: a task is computed once more, and both outcomes must have the same bits.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::wire::{TaskKind, TaskText};

/// One in this number of results of a proven worker is checked.
pub const ONE_IN: u32 = 100;

/// Which machine computes a task once more.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Checker {
    /// Another worker, by name.
    Worker(String),
    /// The coordinator's machine, whose bits decide.
    Coordinator,
}

/// A task that is computed once more.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AuditTask {
    /// Kind of the task.
    pub kind: TaskKind,
    /// Hash of the trial or the genome that the task shares with others.
    pub shared: u64,
    /// Key and text of the task.
    pub task: TaskText,
    /// Machine that computes the task.
    pub checker: Checker,
}

/// The finding of a check.
#[derive(Debug, PartialEq)]
pub enum Finding {
    /// The outcomes are equal. Holds the name of the checked worker.
    Equal(String),
    /// The coordinator's machine must repeat the check, because the outcomes differ or the other worker did not answer.
    Repeat(AuditTask),
    /// The named workers sent other bits than the coordinator's machine computed.
    Wrong(Vec<String>),
}

#[derive(Debug)]
struct Audit {
    task: AuditTask,
    /// Outcomes of the workers, by name. The first is the outcome that is checked.
    lines: Vec<(String, Arc<str>)>,
}

/// The unfinished checks, by the key of the task.
#[derive(Debug, Default)]
pub struct Audits(BTreeMap<u64, Audit>);

impl Audits {
    /// Returns the number of unfinished checks.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Begins to check an outcome of a worker. Returns the check to carry out, or `None` if the task is being checked
    /// already.
    pub fn start(&mut self, task: AuditTask, worker: &str, line: Arc<str>) -> Option<AuditTask> {
        let key = task.task.key;
        if self.0.contains_key(&key) {
            return None;
        }
        let lines = vec![(worker.to_owned(), line)];
        self.0.insert(key, Audit { task: task.clone(), lines });
        Some(task)
    }

    /// Handles the outcome that the checker of a task computed, or `None` if it did not answer.
    pub fn on_answer(&mut self, key: u64, line: Option<Arc<str>>) -> Option<Finding> {
        let mut audit = self.0.remove(&key)?;
        let suspect = audit.lines.first()?.0.clone();
        let Some(line) = line else {
            return Some(self.repeat(key, audit));
        };
        let is_equal = audit.lines.iter().all(|(_, sent)| *sent == line);
        if is_equal {
            return Some(Finding::Equal(suspect));
        }
        match audit.task.checker.clone() {
            Checker::Worker(checker) => {
                audit.lines.push((checker, line));
                Some(self.repeat(key, audit))
            }
            Checker::Coordinator => {
                let wrong = audit.lines.into_iter().filter(|(_, sent)| *sent != line);
                Some(Finding::Wrong(wrong.map(|(worker, _)| worker).collect()))
            }
        }
    }

    fn repeat(&mut self, key: u64, mut audit: Audit) -> Finding {
        audit.task.checker = Checker::Coordinator;
        let task = audit.task.clone();
        self.0.insert(key, audit);
        Finding::Repeat(task)
    }
}
