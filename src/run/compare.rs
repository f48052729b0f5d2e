//! Several methods under equal budgets, with the same seeds.

use std::sync::Mutex;
use std::sync::PoisonError;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::headless::HeadlessError;
use super::{Cancelled, Control, Experiment, pool};
use crate::check::{Invalid, within};
use crate::evolve::{Descriptor, RunPlan, Settings, StrategyKind};
use crate::genome::ControllerKind;
use crate::save::{CURVE_POINTS, ComparedBest, ComparedRun, Comparison};

/// A run that a comparison is to make.
#[derive(Debug, Clone, PartialEq)]
pub struct Contestant {
    /// The method.
    pub strategy: StrategyKind,
    /// What drives the joints.
    pub controller: ControllerKind,
    /// The seed.
    pub seed: u64,
}

impl Contestant {
    /// What it runs: the settings with its method and controller, and generations that spend the budget.
    ///
    /// The report's method gets the report's number of generations: its range halves with each, so that it would
    /// stand still in more. The others get the settings' population.
    ///
    /// # Errors
    /// The budget is too small for one generation, or the settings do not fit together.
    pub fn plan(
        &self,
        preset: &str,
        settings: &Settings,
        evaluations: u32,
    ) -> Result<RunPlan, Invalid> {
        let mut settings = settings.clone();
        settings.genome.controller = self.controller;
        let evolution = &mut settings.evolution;
        evolution.strategy = self.strategy;
        if self.strategy == StrategyKind::Halving {
            evolution.generations = REPORT_GENERATIONS;
            evolution.population = evaluations / REPORT_GENERATIONS;
        } else {
            evolution.generations = evaluations / evolution.population.max(1);
        }
        let least = evolution.population.max(REPORT_GENERATIONS);
        within("evaluations", evaluations, least..=LARGEST_BUDGET)?;
        settings.check()?;
        Ok(RunPlan::new(preset, self.seed, settings))
    }
}

/// The report's run has six generations.
const REPORT_GENERATIONS: u32 = 6;
/// The largest budget of a run.
const LARGEST_BUDGET: u32 = 10_000_000;

/// Runs everyone, each on one of so many threads, and tells `done` of each run that is finished, one at a time, and
/// `spent` of the evaluations of each generation.
///
/// # Errors
/// The interrupt key was pressed, threads could not be started, or `done` failed.
pub fn run_all(
    plans: &[RunPlan],
    threads: usize,
    control: &Control,
    spent: impl Fn(u32) + Sync,
    done: impl FnMut(ComparedRun) -> Result<(), HeadlessError> + Send,
) -> Result<(), HeadlessError> {
    let next = AtomicUsize::new(0);
    let done = Mutex::new(done);
    // Whole runs side by side: nobody waits for the slowest of a generation.
    let worker = || -> Result<(), HeadlessError> {
        let alone = pool(1)?;
        while let Some(plan) = plans.get(next.fetch_add(1, Ordering::SeqCst)) {
            let mut experiment = Experiment::new(plan.clone());
            let run = run_one(&mut experiment, plan, |experiment| {
                let report = experiment.run_generation(&alone, control)?;
                spent(report.evaluations);
                Ok(report)
            });
            let run = run.map_err(|Cancelled| HeadlessError::Cancelled { kept: None })?;
            let mut done = done.lock().unwrap_or_else(PoisonError::into_inner);
            if let Err(error) = done(run) {
                // Nobody computes what cannot be kept.
                control.cancel();
                return Err(error);
            }
        }
        Ok(())
    };
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads.min(plans.len())).map(|_| scope.spawn(worker)).collect();
        let results = workers
            .into_iter()
            .map(|worker| worker.join().unwrap_or(Err(HeadlessError::Cancelled { kept: None })));
        // What went wrong counts before who was cancelled because of it.
        let mut errors: Vec<HeadlessError> = results.filter_map(Result::err).collect();
        errors.sort_by_key(|error| matches!(error, HeadlessError::Cancelled { .. }));
        errors.into_iter().next().map_or(Ok(()), Err)
    })
}

fn run_one(
    experiment: &mut Experiment,
    plan: &RunPlan,
    mut generation: impl FnMut(&mut Experiment) -> Result<super::GenerationReport, Cancelled>,
) -> Result<ComparedRun, Cancelled> {
    let budget = plan.settings.evolution.budget();
    let mut curve = vec![None; CURVE_POINTS];
    let (mut first_on_landing, mut last_mean) = (None, None);
    while !experiment.is_over() {
        let before = experiment.evaluated();
        let report = generation(experiment)?;
        let number =
            |index: u32| u32::try_from(before).unwrap_or(u32::MAX).saturating_add(index + 1);
        first_on_landing = first_on_landing.or(report.first_on_landing.map(number));
        last_mean = report.statistics.map(|statistics| statistics.mean);
        let best = experiment.best().map(|best| best.evaluation.fitness);
        // A point of the curve is what was known when that share of the budget was spent.
        let reached = (experiment.evaluated() * CURVE_POINTS as u64).div_ceil(budget.max(1));
        curve.iter_mut().skip((reached as usize).saturating_sub(1)).for_each(|at| *at = best);
    }
    let start_y_m = plan.settings.trial.start_y_m;
    let best = experiment.best().map(|best| ComparedBest {
        fitness: best.evaluation.fitness,
        steps_climbed: best.evaluation.behaviour.map_or(0, |behaviour| behaviour.steps_climbed),
        energy_j_per_m: Descriptor::EnergyPerMetre
            .value(&best.evaluation, start_y_m)
            .filter(|energy| energy.is_finite()),
    });
    Ok(ComparedRun {
        strategy: plan.settings.evolution.strategy,
        controller: plan.settings.genome.controller,
        seed: plan.seed,
        evaluations: u32::try_from(experiment.evaluated()).unwrap_or(u32::MAX),
        best,
        first_on_landing,
        last_mean,
        curve,
        run_hash: format!("{:016x}", experiment.run_hash()),
    })
}

/// Median and quartiles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quartiles {
    /// A quarter is below.
    pub low: f64,
    /// Half is below.
    pub median: f64,
    /// Three quarters are below.
    pub high: f64,
}

impl Quartiles {
    /// Of some values, by linear interpolation between them (definition 7 of Hyndman and Fan, The American
    /// Statistician 50 (1996)); none of none.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut values: Vec<f64> = values.into_iter().collect();
        values.sort_by(f64::total_cmp);
        let last = values.len().checked_sub(1)?;
        let at = |share: f64| {
            let place = share * last as f64;
            let (below, part) = (place as usize, place - (place as usize) as f64);
            let (low, high) = (values[below], values[(below + 1).min(last)]);
            // Infinity times nothing is not a number.
            if part == 0.0 || low == high { low } else { low + (high - low) * part }
        };
        Some(Self { low: at(0.25), median: at(0.5), high: at(0.75) })
    }
}

/// One method with one controller, over all seeds.
#[derive(Debug, Clone, PartialEq)]
pub struct Row<'a> {
    /// The method.
    pub strategy: StrategyKind,
    /// What drove the joints.
    pub controller: ControllerKind,
    /// Its runs.
    pub runs: Vec<&'a ComparedRun>,
}

impl Comparison {
    /// The rows of the table, in the order of strategies and controllers.
    pub fn rows(&self) -> Vec<Row<'_>> {
        let mut rows: Vec<Row<'_>> = Vec::new();
        for run in &self.runs {
            let (strategy, controller) = (run.strategy, run.controller);
            match rows.last_mut() {
                Some(row) if (row.strategy, row.controller) == (strategy, controller) => {
                    row.runs.push(run);
                }
                _ => rows.push(Row { strategy, controller, runs: vec![run] }),
            }
        }
        rows
    }

    /// The table as text.
    pub fn text(&self) -> String {
        let mut text = format!(
            "{:<12}{:<10}{:>24}{:>18}{:>9}{:>26}{:>18}{:>13}\n",
            "strategy",
            "controller",
            "best fitness",
            "steps climbed",
            "landed",
            "evaluations to landing",
            "energy J/m",
            "last mean"
        );
        for row in self.rows() {
            let show = |quartiles: Option<Quartiles>, digits: usize| match quartiles {
                Some(Quartiles { low, median, high }) => {
                    let number = |x: f64| {
                        if x.is_finite() { format!("{x:.digits$}") } else { "-".to_owned() }
                    };
                    format!("{} [{} {}]", number(median), number(low), number(high))
                }
                None => "-".to_owned(),
            };
            let landed = row.runs.iter().filter(|run| run.first_on_landing.is_some()).count();
            text += &format!(
                "{:<12}{:<10}{:>24}{:>18}{:>9}{:>26}{:>18}{:>13}\n",
                row.strategy.name(),
                row.controller.name(),
                show(row.fitness(), 2),
                show(row.steps_climbed(), 1),
                format!("{landed}/{}", row.runs.len()),
                show(row.evaluations_to_landing(), 0),
                show(row.energy_j_per_m(), 0),
                Quartiles::of(row.runs.iter().filter_map(|run| run.last_mean))
                    .map_or("-".to_owned(), |mean| format!("{:.2}", mean.median)),
            );
        }
        text + "\nmedian [quartiles] over the seeds; who never lands counts as infinite evaluations\n"
    }

    /// The rows of the CSV file, the head first: one per run.
    pub fn records(&self) -> Vec<Vec<String>> {
        let head = [
            "strategy",
            "controller",
            "seed",
            "evaluations",
            "best_fitness",
            "steps_climbed",
            "energy_j_per_m",
            "first_on_landing",
            "last_mean",
            "run_hash",
        ];
        let mut records = vec![head.map(str::to_owned).to_vec()];
        let text = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
        for run in &self.runs {
            let best = run.best;
            records.push(vec![
                run.strategy.name().to_owned(),
                run.controller.name().to_owned(),
                run.seed.to_string(),
                run.evaluations.to_string(),
                best.map_or(String::new(), |best| best.fitness.to_string()),
                best.map_or(String::new(), |best| best.steps_climbed.to_string()),
                text(best.and_then(|best| best.energy_j_per_m)),
                run.first_on_landing.map_or(String::new(), |number| number.to_string()),
                text(run.last_mean),
                run.run_hash.clone(),
            ]);
        }
        records
    }
}

impl Row<'_> {
    /// Best fitness of each run.
    pub fn fitness(&self) -> Option<Quartiles> {
        Quartiles::of(self.runs.iter().filter_map(|run| Some(f64::from(run.best?.fitness))))
    }

    /// Steps that the best of each run climbed.
    pub fn steps_climbed(&self) -> Option<Quartiles> {
        Quartiles::of(self.runs.iter().filter_map(|run| Some(f64::from(run.best?.steps_climbed))))
    }

    /// Evaluations until the first agent on the landing. A run without one counts as infinite.
    pub fn evaluations_to_landing(&self) -> Option<Quartiles> {
        let number = |run: &&ComparedRun| run.first_on_landing.map_or(f64::INFINITY, f64::from);
        Quartiles::of(self.runs.iter().map(number))
    }

    /// Energy per metre of the best of each run, in J/m.
    pub fn energy_j_per_m(&self) -> Option<Quartiles> {
        Quartiles::of(self.runs.iter().filter_map(|run| run.best?.energy_j_per_m))
    }

    /// The learning curve: quartiles of the best fitness so far at each point of the budget at which every run
    /// has one.
    pub fn curve(&self) -> Vec<(usize, Quartiles)> {
        let at = |point: usize| {
            let values: Option<Vec<f64>> =
                self.runs.iter().map(|run| Some(f64::from((*run.curve.get(point)?)?))).collect();
            Some((point, Quartiles::of(values?)?))
        };
        (0..CURVE_POINTS).filter_map(at).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartiles_are_those_of_definition_7() {
        let quartiles = Quartiles::of([4.0, 1.0, 3.0, 2.0]).expect("four values");
        assert_eq!((quartiles.low, quartiles.median, quartiles.high), (1.75, 2.5, 3.25));
        let with_infinity = Quartiles::of([1.0, 2.0, f64::INFINITY]).expect("three values");
        assert_eq!((with_infinity.low, with_infinity.median), (1.5, 2.0));
        assert_eq!(Quartiles::of([]), None);
    }

    fn plans() -> Vec<RunPlan> {
        let mut settings = Settings::default();
        settings.trial.duration_s = 0.5;
        settings.evolution.population = 6;
        let contestant =
            |strategy| Contestant { strategy, controller: ControllerKind::Gait, seed: 3 };
        StrategyKind::ALL
            .map(|strategy| contestant(strategy).plan("test", &settings, 24).expect("allowed"))
            .to_vec()
    }

    fn compared(plans: &[RunPlan], threads: usize) -> Comparison {
        let mut comparison = Comparison::new("test", String::new(), 24, Default::default());
        let done = |run| {
            comparison.add(run);
            Ok(())
        };
        run_all(plans, threads, &Control::default(), |_| (), done).expect("not cancelled");
        comparison
    }

    #[test]
    fn everyone_spends_the_same_and_the_number_of_threads_changes_nothing() {
        let plans = plans();
        let comparison = compared(&plans, 1);
        assert_eq!(comparison.runs.len(), 6);
        assert!(comparison.runs.iter().all(|run| run.evaluations == 24));
        assert_eq!(comparison, compared(&plans, 3));
        let mut experiment = Experiment::new(plans[1].clone());
        while !experiment.is_over() {
            let alone = pool(1).expect("a pool");
            experiment.run_generation(&alone, &Control::default()).expect("not cancelled");
        }
        let ga = &comparison.runs[1];
        assert_eq!(ga.run_hash, format!("{:016x}", experiment.run_hash()), "it is the run itself");
        assert_eq!(ga.curve.last().copied().flatten(), ga.best.map(|best| best.fitness));
        assert_eq!(comparison.rows().len(), 6);
        assert_eq!(comparison.text().lines().count(), 9);
    }
}
