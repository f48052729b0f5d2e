//! Computing the outcome of a task from its text.

use std::fmt::Debug;
use std::sync::Arc;

use super::outcome::Outcome;
use super::wire::{TaskKind, WireError, line_of, parse_line};
use snakes_core::genome::Genome;
use snakes_core::score::{ExamCondition, Trial};
use snakes_lab::run::{evaluate_caught, examine_caught};

/// The trial or the genome that all tasks of a batch share, read and checked.
#[derive(Debug, Clone, PartialEq)]
pub enum Shared {
    /// The trial in which genomes are scored.
    Trial(Box<Trial>),
    /// The genome that is examined.
    Genome(Box<Genome>),
}

/// Computes the outcomes of tasks. The program itself uses only [`Simulator`]; tests use slower and wrong
/// implementations.
pub trait Compute: Debug + Send + Sync {
    /// Returns the outcome of a task, given what its batch shares.
    fn outcome(&self, shared: &Shared, task: &str) -> Outcome;
}

/// Computes the outcome of a task by simulation.
#[derive(Debug, Clone, Copy, Default)]
pub struct Simulator;

impl Shared {
    /// Reads the trial or the genome that a batch of this kind shares. The text must be exactly the text that this
    /// program would write. Otherwise it contains something unknown to this program, and its hash would not be this
    /// program's hash.
    ///
    /// # Errors
    /// The text is damaged, a value is not allowed, or it comes from another version.
    pub fn read(kind: TaskKind, text: &str) -> Result<Self, WireError> {
        let (shared, own_text) = match kind {
            TaskKind::Score => {
                let trial: Trial = parse_line(text)?;
                trial.check()?;
                let own_text = line_of(&trial);
                (Self::Trial(Box::new(trial)), own_text)
            }
            TaskKind::Examine => {
                let genome: Genome = parse_line(text)?;
                let own_text = line_of(&genome);
                (Self::Genome(Box::new(genome)), own_text)
            }
        };
        if own_text != text {
            return Err(WireError::Damaged("another version wrote it".to_owned()));
        }
        Ok(shared)
    }
}

impl Compute for Simulator {
    fn outcome(&self, shared: &Shared, task: &str) -> Outcome {
        simulated(shared, task).unwrap_or_else(|error| Outcome::Refused(error.to_string()))
    }
}

fn simulated(shared: &Shared, task: &str) -> Result<Outcome, WireError> {
    Ok(match shared {
        Shared::Trial(trial) => {
            let genome: Genome = parse_line(task)?;
            trial.check_genome(&genome).map_err(|error| error.inside("genome"))?;
            Outcome::Scored(evaluate_caught(&genome, trial))
        }
        Shared::Genome(genome) => {
            let condition: ExamCondition = parse_line(task)?;
            condition.check()?;
            condition.trial.check_genome(genome).map_err(|error| error.inside("genome"))?;
            Outcome::Examined(examine_caught(genome, &condition))
        }
    })
}

/// Returns the outcome of a task, given as text together with the text that its batch shares.
pub fn outcome_of_texts(
    compute: &Arc<dyn Compute>,
    kind: TaskKind,
    shared: &str,
    task: &str,
) -> Outcome {
    match Shared::read(kind, shared) {
        Ok(shared) => compute.outcome(&shared, task),
        Err(error) => Outcome::Refused(error.to_string()),
    }
}
