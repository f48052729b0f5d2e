//! Generations: reproducible for any evaluator, resumable, robust against panics.

use super::*;
use crate::run::{EvaluationResult, Job, LocalPool, WorkersError, evaluate_caught};
use snakes_core::evolve::Settings;
use snakes_core::genome::Genome;
use snakes_core::score::{ExamCondition, ExamEnd, PerturbationList, Trial, evaluate};

fn small(seed: u64) -> Experiment {
    let mut settings = Settings::default();
    settings.evolution.population = 12;
    settings.evolution.generations = 3;
    settings.trial.duration_s = 1.0;
    Experiment::new(RunPlan::new("test", seed, settings))
}

/// Runs all generations that are left, on this number of threads.
pub fn finish(mut experiment: Experiment, threads: usize) -> Experiment {
    let evaluator = LocalPool::new(threads).expect("threads");
    while !experiment.is_over() {
        experiment.run_generation(&evaluator, &RunControl::default()).expect("not cancelled");
    }
    experiment
}

fn hash_with(threads: usize, seed: u64) -> u64 {
    finish(small(seed), threads).run_hash()
}

#[test]
fn the_number_of_threads_does_not_change_the_run_hash() {
    let one = hash_with(1, 1);
    assert_eq!(one, hash_with(2, 1));
    assert_eq!(one, hash_with(4, 1));
    assert_ne!(one, hash_with(1, 2), "the seed does");
}

#[test]
fn a_cancelled_generation_leaves_the_experiment_as_it_was() {
    let mut experiment = small(1);
    let evaluator = LocalPool::new(2).expect("threads");
    let cancelled = RunControl::default();
    cancelled.cancel();
    assert_eq!(experiment.run_generation(&evaluator, &cancelled), Err(Cancelled));
    assert_eq!(experiment.finished(), 0);
    assert_eq!(finish(experiment, 2).run_hash(), hash_with(1, 1));
}

/// An evaluator that panics on one genome, leaves out another, and reports in descending order.
#[derive(Debug)]
struct TestEvaluator {
    fails_on: Genome,
    leaves_out: usize,
}

impl Evaluator for TestEvaluator {
    fn evaluate_jobs(
        &self,
        trials: &[Trial],
        jobs: &[Job<'_>],
        _: &RunControl,
        report: &(dyn Fn(usize, EvaluationResult) + Sync),
    ) -> Result<(), Cancelled> {
        for (index, &Job { genome, trial }) in jobs.iter().enumerate().rev() {
            if *genome == self.fails_on {
                report(index, Err("index out of bounds".to_owned()));
            } else if index != self.leaves_out {
                report(index, evaluate_caught(genome, &trials[trial]));
            }
        }
        Ok(())
    }

    fn examine_batch(
        &self,
        _: &Genome,
        _: &[ExamCondition],
        _: &RunControl,
        _: &(dyn Fn(usize, ExamEnd) + Sync),
    ) -> Result<(), Cancelled> {
        Ok(())
    }

    fn workers(&self) -> usize {
        1
    }

    fn with_workers(&self, workers: usize) -> Result<Arc<dyn Evaluator>, WorkersError> {
        Ok(Arc::new(LocalPool::new(workers)?))
    }
}

#[test]
fn an_evaluation_that_panics_is_void_and_counted_and_its_genome_kept() {
    let mut experiment = small(1);
    let control = RunControl::default();
    let local = LocalPool::new(1).expect("threads");
    let healthy = small(1).run_generation(&local, &control).expect("not cancelled");
    let champion = healthy.champion.expect("one is healthy");
    let evaluator = TestEvaluator { fails_on: champion.genome.clone(), leaves_out: usize::MAX };
    let report = experiment.run_generation(&evaluator, &control).expect("not cancelled");
    assert_eq!((report.crashed, report.disqualified), (1, healthy.record.disqualified + 1));
    let crash = report.crashes.first().expect("reported");
    assert_eq!(crash.individual.genome, champion.genome);
    assert_eq!(crash.individual.origin, champion.origin);
    assert!(crash.message.contains("index out of bounds"), "{}", crash.message);
    assert_ne!(report.champion, Some(champion), "another is the best");
    assert!(!experiment.is_over(), "and the run continues");
    experiment.run_generation(&evaluator, &control).expect("not cancelled");
}

#[test]
fn results_are_complete_and_in_order_for_any_evaluator() {
    let (mut experiment, control) = (small(1), RunControl::default());
    let fails_on = small(2).strategy.ask().remove(0).genome;
    let evaluator = TestEvaluator { fails_on, leaves_out: 7 };
    while !experiment.is_over() {
        experiment.run_generation(&evaluator, &control).expect("not cancelled");
        assert_eq!(control.done(), 12);
    }
    assert_eq!(experiment.run_hash(), hash_with(1, 1));
}

#[test]
fn known_evaluations_are_not_repeated_and_change_nothing() {
    let evaluator = LocalPool::new(2).expect("threads");
    let noted = std::sync::Mutex::new(Vec::new());
    let note = |_, individual, evaluation: &Evaluation| {
        noted.lock().expect("no panic").push((individual, *evaluation));
    };
    let mut first = small(1);
    first
        .run_generation_recording(&evaluator, &RunControl::default(), note)
        .expect("not cancelled");
    let mut noted = noted.into_inner().expect("no panic");
    noted.truncate(7);
    let progress = SavedProgress {
        changes: Vec::new(),
        records: Vec::new(),
        champions: Vec::new(),
        knowledge: None,
        evaluations: noted.clone(),
        lineage: Vec::new(),
    };
    let mut again = Experiment::resumed(first.plan.clone(), &progress).expect("it fits");
    let made = std::sync::atomic::AtomicU32::new(0);
    let count = |_, individual, _: &Evaluation| {
        assert!(noted.iter().all(|(known, _)| *known != individual));
        made.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
    };
    again
        .run_generation_recording(&evaluator, &RunControl::default(), count)
        .expect("not cancelled");
    assert_eq!(made.into_inner(), 5);
    assert_eq!(again.run_hash(), first.run_hash());
}

#[test]
fn the_last_generation_is_kept_with_its_parents_and_the_best_has_its_ancestry() {
    let experiment = finish(small(1), 2);
    let generation = experiment.generation().expect("kept");
    assert_eq!((generation.number, generation.genomes.len()), (3, 12));
    let best = experiment.best().expect("one is healthy");
    let line = experiment.ancestry().line;
    assert_eq!(line.len() as u32, best.origin.generation, "back to the first generation");
    assert_eq!(line[0].fitness, Some(best.evaluation.fitness));
    assert_eq!(line[0].genome.as_deref(), Some(&best.genome));
    assert_eq!(experiment.ancestry().spreads.len(), 3);
    let parents = experiment.parents();
    assert_eq!(parents.len(), 4, "the report has four");
    assert!(parents.iter().all(|(_, children)| *children == 3));
}

#[test]
fn the_champion_scores_the_same_when_evaluated_again() {
    let mut experiment = small(3);
    let evaluator = LocalPool::new(2).expect("threads");
    let report =
        experiment.run_generation(&evaluator, &RunControl::default()).expect("not cancelled");
    let champion = report.champion.expect("one is healthy");
    assert_eq!(evaluate(&champion.genome, &champion.trial), champion.evaluation);
    assert_eq!(experiment.best(), Some(&champion));
}

#[test]
fn individuals_of_varied_generations_score_the_same_again_in_their_own_trials() {
    let mut settings = Settings::default();
    settings.evolution.population = 6;
    settings.evolution.generations = 2;
    settings.trial.duration_s = 1.0;
    settings.trial.repeats.trials = 3;
    settings.trial.repeats.list = PerturbationList::Generation;
    let mut experiment = Experiment::new(RunPlan::new("test", 1, settings));
    let evaluator = LocalPool::new(1).expect("threads");
    let mut numbers = Vec::new();
    while !experiment.is_over() {
        let report = experiment.run_generation(&evaluator, &RunControl::default());
        let champion = report.expect("not cancelled").champion.expect("one is healthy");
        for individual in experiment.leaders().iter().chain([&champion]) {
            let again = evaluate(&individual.genome, &individual.trial);
            assert_eq!(again, individual.evaluation);
        }
        numbers.push(champion.trial.repeats.list_number);
    }
    assert!(numbers[0] != numbers[1] && !numbers.contains(&0), "{numbers:?}");
}
