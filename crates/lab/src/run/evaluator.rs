//! Evaluating genomes: evaluators decide where and in which order simulations run.
//!
//! An evaluator cannot change a result. An evaluation depends on its genome and its trial only, and the experiment
//! puts the results in the order of the individuals before the strategy sees them. Another evaluator, which sends
//! its jobs to other processes or machines, implements [`Evaluator`] and is registered in [`super::evaluators`].

use std::fmt::Debug;
use std::io;
use std::num::NonZero;
use std::ops::RangeInclusive;
use std::sync::{Arc, OnceLock};

use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::panics::caught;
use super::run_control::{Cancelled, RunControl};
use snakes_core::genome::Genome;
use snakes_core::score::{ExamCondition, ExamEnd, Scored, Trial, score, score_together};
use snakes_core::world::PhysicsEngine;

/// Result of evaluating one genome. An error is the message of the panic that ended the evaluation.
pub type EvaluationResult = Result<Scored, String>;

/// A genome to evaluate, and the index of its trial.
#[derive(Debug, Clone, Copy)]
pub struct Job<'a> {
    /// The genome.
    pub genome: &'a Genome,
    /// Index of the genome's trial in the batch's list of trials.
    pub trial: usize,
}

/// Evaluates batches of genomes, and examines champions.
pub trait Evaluator: Debug + Send + Sync {
    /// Evaluates each job's genome in its trial, in any order, and calls `report` with the job's index and result as soon as the
    /// result is known. `report` may be called from several threads at once.
    ///
    /// An evaluator calls [`RunControl::wait_while_paused`] before each evaluation. Genomes without a reported result are evaluated
    /// by the caller, so an evaluator that loses its workers may simply return.
    ///
    /// # Errors
    /// [`Cancelled`], if `control` was cancelled.
    fn evaluate_jobs(
        &self,
        trials: &[Trial],
        jobs: &[Job<'_>],
        control: &RunControl,
        report: &(dyn Fn(usize, EvaluationResult) + Sync),
    ) -> Result<(), Cancelled>;

    /// Works as [`Self::evaluate_jobs`], with one trial for all genomes.
    ///
    /// # Errors
    /// [`Cancelled`], if `control` was cancelled.
    fn evaluate_batch(
        &self,
        trial: &Trial,
        genomes: &[&Genome],
        control: &RunControl,
        report: &(dyn Fn(usize, EvaluationResult) + Sync),
    ) -> Result<(), Cancelled> {
        let jobs: Vec<Job<'_>> = genomes.iter().map(|genome| Job { genome, trial: 0 }).collect();
        self.evaluate_jobs(std::slice::from_ref(trial), &jobs, control, report)
    }

    /// Simulates a genome in each condition of an exam, and calls `report` with the index and the end of each. A simulation that
    /// panics counts as [`ExamEnd::CRASHED`].
    ///
    /// # Errors
    /// [`Cancelled`], if `control` was cancelled.
    fn examine_batch(
        &self,
        genome: &Genome,
        conditions: &[ExamCondition],
        control: &RunControl,
        report: &(dyn Fn(usize, ExamEnd) + Sync),
    ) -> Result<(), Cancelled>;

    /// Returns the maximum number of evaluations at the same time.
    fn workers(&self) -> usize;

    /// Returns an evaluator of the same kind with another number of workers.
    ///
    /// # Errors
    /// The workers could not be started.
    fn with_workers(&self, workers: usize) -> Result<Arc<dyn Evaluator>, WorkersError>;

    /// Describes in a few words where the evaluations run.
    fn place(&self) -> String {
        format!("threads {}", self.workers())
    }

    /// Returns the command-line flags that choose this evaluator again, each after a space. Empty for threads of this computer.
    fn flags(&self) -> String {
        String::new()
    }

    /// Returns why results that were reported earlier cannot be trusted, or `None` if there is no doubt. An evaluator with a fault
    /// cancels all batches; the work must begin again with another evaluator.
    fn fault(&self) -> Option<String> {
        None
    }

    /// Returns why this evaluator can evaluate nothing more, or `None` while it can. Results that it reported are right. Such an
    /// evaluator cancels all batches, unless it leaves the missing results to its caller.
    fn refusal(&self) -> Option<String> {
        None
    }
}

/// Error when the workers of an evaluator could not be started.
#[derive(Debug, thiserror::Error)]
#[error("threads: cannot be started: {0}")]
pub struct WorkersError(#[from] io::Error);

/// Allowed numbers of worker threads.
pub const THREADS_RANGE: RangeInclusive<usize> = 1..=1024;

/// Returns the number of processors that this program may use.
pub fn available_cores() -> usize {
    std::thread::available_parallelism().map_or(1, NonZero::get)
}

/// Evaluates a genome in a trial. A panic becomes an error with its message.
///
/// # Errors
/// The evaluation panicked.
pub fn evaluate_caught(genome: &Genome, trial: &Trial) -> EvaluationResult {
    caught(|| score(genome, trial))
}

/// Evaluates genomes on this thread, and reports each result as soon as it is known. Engines that step several snakes at once do
/// so. After a panic the remaining genomes are evaluated one by one, so that only the genome that caused it fails.
///
/// # Errors
/// [`Cancelled`], if `control` was cancelled.
pub fn evaluate_together(
    trials: &[Trial],
    jobs: &[Job<'_>],
    control: &RunControl,
    mut report: impl FnMut(usize, EvaluationResult),
) -> Result<(), Cancelled> {
    let mut is_reported = vec![false; jobs.len()];
    let mut is_cancelled = false;
    if jobs.len() > 1 {
        let pairs: Vec<_> = jobs.iter().map(|job| (job.genome, &trials[job.trial])).collect();
        let goes_on = || {
            is_cancelled = control.wait_while_paused().is_err();
            !is_cancelled
        };
        let _ = caught(|| {
            score_together(&pairs, goes_on, |index, scored| {
                is_reported[index] = true;
                report(index, Ok(scored));
            });
        });
    }
    for (index, job) in jobs.iter().enumerate() {
        if !is_reported[index] {
            control.wait_while_paused()?;
            report(index, evaluate_caught(job.genome, &trials[job.trial]));
        }
    }
    Ok(())
}

/// Returns the number of jobs that a thread takes at once with an engine that steps several snakes together. It is the share of
/// each thread, or a part of a large share, so that lanes which end early are filled again and all threads end at about the same
/// time.
fn jobs_together(jobs: usize, workers: usize) -> usize {
    let share = jobs.div_ceil(workers.max(1)).max(1);
    if share <= 32 { share } else { (share / 4).clamp(16, 64) }
}

/// Evaluates each job, and returns the results in the order of the jobs. Jobs without a report from the evaluator are evaluated on
/// this thread.
///
/// # Errors
/// [`Cancelled`], if `control` was cancelled.
pub(crate) fn evaluate_in_order(
    trials: &[Trial],
    jobs: &[Job<'_>],
    evaluator: &dyn Evaluator,
    control: &RunControl,
) -> Result<Vec<EvaluationResult>, Cancelled> {
    let results: Vec<OnceLock<EvaluationResult>> = jobs.iter().map(|_| OnceLock::new()).collect();
    evaluator.evaluate_jobs(trials, jobs, control, &|index, result| {
        // Only the first result counts.
        let _ = results[index].set(result);
    })?;
    let results = results.into_iter().zip(jobs).map(|(result, job)| {
        control.wait_while_paused()?;
        Ok(result.into_inner().unwrap_or_else(|| evaluate_caught(job.genome, &trials[job.trial])))
    });
    results.collect()
}

/// Simulates a genome in a condition of an exam. A panic counts as [`ExamEnd::CRASHED`].
pub fn examine_caught(genome: &Genome, condition: &ExamCondition) -> ExamEnd {
    caught(|| ExamEnd::of(genome, condition)).unwrap_or(ExamEnd::CRASHED)
}

/// An evaluator on threads of this process.
#[derive(Debug)]
pub struct LocalPool(ThreadPool);

impl LocalPool {
    /// Starts the worker threads.
    ///
    /// # Errors
    /// The operating system refused to start this number of threads.
    pub fn new(threads: usize) -> Result<Self, WorkersError> {
        let pool = ThreadPoolBuilder::new()
            .num_threads(threads)
            .thread_name(|index| format!("evolution-{index}"))
            .build()
            .map_err(io::Error::other)?;
        Ok(Self(pool))
    }

    /// Calls `work` on the threads with each index below `count`. Returns the results in the order of the indices.
    ///
    /// # Errors
    /// The first error of `work`. The remaining calls are skipped.
    pub(super) fn map<T: Send, E: Send>(
        &self,
        count: usize,
        work: impl Fn(usize) -> Result<T, E> + Send + Sync,
    ) -> Result<Vec<T>, E> {
        self.0.install(|| (0..count).into_par_iter().map(work).collect())
    }
}

impl Evaluator for LocalPool {
    fn evaluate_jobs(
        &self,
        trials: &[Trial],
        jobs: &[Job<'_>],
        control: &RunControl,
        report: &(dyn Fn(usize, EvaluationResult) + Sync),
    ) -> Result<(), Cancelled> {
        let side_by_side = trials.iter().all(|trial| trial.physics.engine == PhysicsEngine::Lanes);
        let many = if side_by_side { jobs_together(jobs.len(), self.workers()) } else { 1 };
        let mut order: Vec<usize> = (0..jobs.len()).collect();
        if side_by_side {
            // Snakes whose parts are joined alike are stepped together.
            order.sort_by_cached_key(|&index| {
                let Job { genome, trial } = &jobs[index];
                trials[*trial].agent.body_plan(genome).joined_parts()
            });
        }
        self.0.install(|| {
            order.par_chunks(many).try_for_each(|order| {
                let jobs: Vec<Job<'_>> = order.iter().map(|&index| jobs[index]).collect();
                evaluate_together(trials, &jobs, control, |index, result| {
                    report(order[index], result);
                })
            })
        })
    }

    fn examine_batch(
        &self,
        genome: &Genome,
        conditions: &[ExamCondition],
        control: &RunControl,
        report: &(dyn Fn(usize, ExamEnd) + Sync),
    ) -> Result<(), Cancelled> {
        self.0.install(|| {
            conditions.par_iter().enumerate().try_for_each(|(index, condition)| {
                control.wait_while_paused()?;
                report(index, examine_caught(genome, condition));
                Ok(())
            })
        })
    }

    fn workers(&self) -> usize {
        self.0.current_num_threads()
    }

    fn with_workers(&self, workers: usize) -> Result<Arc<dyn Evaluator>, WorkersError> {
        Ok(Arc::new(Self::new(workers)?))
    }
}
