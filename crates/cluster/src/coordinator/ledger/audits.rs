//! Checks of results: a task is computed once more, and both outcomes must have the same bits.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::wire::{TaskKind, TaskText};

/// One in so many results of a worker that has been proven is checked.
pub const ONE_IN: u32 = 100;

/// Which machine computes a task once more.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Checker {
    /// Another worker.
    Worker(String),
    /// This machine, whose bits decide.
    Coordinator,
}

/// A task that is computed once more.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AuditTask {
    /// Its kind.
    pub kind: TaskKind,
    /// Hash of what it shares with others.
    pub shared: u64,
    /// The task.
    pub task: TaskText,
    /// Which machine computes it.
    pub checker: Checker,
}

/// The finding of a check.
#[derive(Debug, PartialEq)]
pub enum Finding {
    /// The outcomes are equal: this worker is as it should be.
    Equal(String),
    /// The check is to be repeated by this machine.
    Repeat(AuditTask),
    /// The named workers sent other bits than this machine.
    Wrong(Vec<String>),
}

#[derive(Debug)]
struct Audit {
    task: AuditTask,
    /// The workers' outcomes, the suspect's first.
    lines: Vec<(String, Arc<str>)>,
}

/// The checks that are not finished.
#[derive(Debug, Default)]
pub struct Audits(BTreeMap<u64, Audit>);

impl Audits {
    /// Number of checks.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Begins to check what a worker sent. Returns the check to be made; none if this task is being checked.
    pub fn start(&mut self, task: AuditTask, worker: &str, line: Arc<str>) -> Option<AuditTask> {
        let key = task.task.key;
        if self.0.contains_key(&key) {
            return None;
        }
        let lines = vec![(worker.to_owned(), line)];
        self.0.insert(key, Audit { task: task.clone(), lines });
        Some(task)
    }

    /// The checker of a task answered with this outcome, or not at all.
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
